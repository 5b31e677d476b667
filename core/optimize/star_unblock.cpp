#include <algorithm>

#include "core/optimize/star_optimizer.h"

namespace lamella {

template <int D>
std::size_t StarOptimizer<D>::open_blocking(const Progress& progress) {
  set_weights(1, 0, false);
  std::vector<char> on_wall(topo_.points.size(), 0);
  for (std::size_t e = 0; e < topo_.elements.size(); ++e)
    if (topo_.alive(static_cast<std::int32_t>(e)) && topo_.is_virtual(static_cast<std::int32_t>(e)))
      for (NodeId n : topo_.elements[e]) on_wall[n] = 1;
  const std::size_t before = counts_.splits;
  const auto count = static_cast<NodeId>(on_wall.size());
  std::vector<NodeId> partners;
  const auto insert = [&](const Apex& apex) {
    rate_all(apex);
    for (int i = 0; i < faces_.size(); ++i)
      if (rates_[i].quality <= 0) return;
    replace_cavity(apex, 0);
    ++counts_.splits;
  };
  for (NodeId s = 1; s < count && !progress.cancelled(); ++s) {
    if (!on_wall[s] || topo_.around.empty(s)) continue;
    partners.clear();
    ++mark_value_;
    for (auto e : topo_.around.of(s))
      for (NodeId n : topo_.elements[e])
        if (n > s && n < count && on_wall[n] && mark_[n] != mark_value_) {
          mark_[n] = mark_value_;
          partners.push_back(n);
        }
    for (NodeId n : partners) {
      star_.clear();
      bool inner = true;
      for (auto e : topo_.around.of(s))
        if (Topology<D>::has(topo_.elements[e], n)) {
          star_.push_back(e);
          inner = inner && !topo_.is_virtual(e) && !model_.frozen_body(topo_.label[e]);
        }
      if (!inner || star_.empty()) continue;
      open_cavity(star_, s, n);
      Packed<D> c = Packed<D>::zero();
      c.add(0.5, carried(s));
      c.add(0.5, carried(n));
      insert(new_point(0.5 * (topo_.points[s] + topo_.points[n]), carrier_.metric(c)));
    }
  }
  for (std::int32_t e = 0; e < static_cast<std::int32_t>(topo_.elements.size()); ++e) {
    if (progress.cancelled()) break;
    for (int k = 0; k <= D && topo_.alive(e) && !topo_.is_virtual(e); ++k) {
      const Facet face = opposite_facet<D>(topo_.elements[e], k);
      if (!std::all_of(face.begin(), face.end(), [&](NodeId n) { return n < count && on_wall[n]; }))
        continue;
      std::int32_t other = -1;
      for (auto i : topo_.around.of(face[0])) {
        if (i == e || !std::all_of(face.begin(), face.end(), [&](NodeId n) {
              return Topology<D>::has(topo_.elements[i], n);
            }))
          continue;
        other = topo_.is_virtual(i) || model_.frozen_body(topo_.label[i]) ? -2 : i;
        if (other == -2) break;
      }
      if (other < 0) continue;
      open_pair(e, other, face);
      Packed<D> c = Packed<D>::zero();
      Vec<D> x = Vec<D>::Zero();
      for (NodeId n : face) {
        x += topo_.points[n] / D;
        c.add(1.0 / D, carried(n));
      }
      insert(new_point(x, carrier_.metric(c)));
    }
  }
  return counts_.splits - before;
}

/// The cavity of two elements that share the face.
template <int D>
void StarOptimizer<D>::open_pair(std::int32_t e, std::int32_t other, const Facet& face) {
  cavity_ = {e, other};
  faces_.open(nodes());
  virtual_faces_.clear();
  for (std::int32_t i : cavity_)
    for (int k = 0; k <= D; ++k)
      if (std::find(face.begin(), face.end(), topo_.elements[i][k]) != face.end()) faces_.add(i, k);
}

#define LAMELLA_INSTANTIATE(D) \
  template std::size_t StarOptimizer<D>::open_blocking(const Progress&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
