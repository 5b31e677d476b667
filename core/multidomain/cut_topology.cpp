#include "core/multidomain/cut_topology.h"

#include <algorithm>
#include <bit>

namespace lamella {
namespace {

/// No move may bring an element below this quality, or below half of what was there before.
constexpr double poor_quality = 0.05;
/// Metric distance from an edge or a face within which a new point takes its place.
constexpr double close = 0.12;
/// Of what a part of a split element has when the point lies on the edge or face: the least.
constexpr double least_part = 0.2;
/// Of the tolerance: nodes this near to a border lie on it.
constexpr double on_share = 0.02;
/// Of the tolerance: features this near to each other are one.
constexpr double merge_share = 0.5;

}  // namespace

CutTopology::CutTopology(const SimplexMesh<3>& mesh, const MetricField<3>& field,
                         const Partition<3>& partition, const CutParams& params,
                         const MetricFunction<3>& metric_at)
    : first_interface(static_cast<std::int32_t>(mesh.facets.size())),
      on(on_share * params.tolerance),
      merge(merge_share * params.tolerance),
      partition_(partition),
      metric_at_(metric_at),
      snap_(params.snap) {
  auto elements = mesh.elements;
  std::vector<std::int32_t> label(elements.size(), partition.background());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    elements.push_back(Topology<3>::virtual_element(mesh.facets[f]));
    label.push_back(static_cast<std::int32_t>(f));
  }
  topo = Topology<3>::from(mesh.points, std::move(elements), std::move(label));
  metric.resize(mesh.points.size());
  for (std::size_t n = 1; n < metric.size(); ++n)
    metric[n] = Packed<3>::from(metric_at ? metric_at(mesh.points[n]) : field[n]);
  locked.assign(mesh.points.size(), 0);
  Box<3> box;
  for (std::size_t n = 1; n < mesh.points.size(); ++n) box.add(mesh.points[n]);
  exact = 1e-10 * (box.hi - box.lo).norm();
}

CutTopology::Weights CutTopology::weights_in(std::int32_t e, const Vec<3>& x) const {
  const Corners<3> p = corners(topo.elements[e]);
  const Vec<3> w = edge_matrix<3>(p).inverse() * (x - p[0]);
  return {1 - w.sum(), w[0], w[1], w[2]};
}

std::vector<std::array<NodeId, 2>> CutTopology::edges_from(std::size_t first) const {
  std::vector<std::array<NodeId, 2>> edges;
  for (std::int32_t e = 0; e < count(); ++e) {
    if (!active(e)) continue;
    const Element& nodes = topo.elements[e];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j)
        if (static_cast<std::size_t>(std::max(nodes[i], nodes[j])) >= first)
          edges.push_back(key(nodes[i], nodes[j]));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

Hold CutTopology::hold(std::span<const NodeId> nodes) const {
  Hold h;
  h.origin = at(nodes[0]);
  for (auto e : topo.around.of(nodes[0])) {
    if (!topo.is_virtual(e)) continue;
    const Element& v = topo.elements[e];
    if (!std::all_of(nodes.begin(), nodes.end(), [&](NodeId n) { return Topology<3>::has(v, n); }))
      continue;
    if (is_wall(e)) {
      h.add_plane(facet_normal<3>({at(v[1]), at(v[2]), at(v[3])}));
    } else {
      h.add_zone(topo.label[e] - first_interface);
    }
  }
  return h;
}

double CutTopology::quality_of(const Element& e, NodeId moved, const Vec<3>& x) const {
  Corners<3> p;
  Packed<3> m = Packed<3>::zero();
  for (int k = 0; k < 4; ++k) {
    p[k] = e[k] == moved ? x : at(e[k]);
    m += metric[e[k]];
  }
  for (double& c : m.c) c *= 0.25;
  return quality<3>(p, m.full());
}

bool CutTopology::move(NodeId n, const Vec<3>& x) {
  double before = 1, after = 1;
  for (auto e : topo.around.of(n)) {
    if (topo.is_virtual(e)) continue;
    before = std::min(before, quality_of(topo.elements[e], 0, x));
    after = std::min(after, quality_of(topo.elements[e], n, x));
  }
  if (after < std::min(poor_quality, 0.5 * before) || after <= 0) return false;
  topo.points[n] = x;
  ++moves;
  return true;
}

NodeId CutTopology::add_node(const Vec<3>& x, std::span<const NodeId> of,
                             std::span<const double> weights) {
  const NodeId n = topo.add_node(x);
  Packed<3> c = Packed<3>::zero();
  for (std::size_t k = 0; k < of.size(); ++k) c.add(weights[k], carrier_.carry(metric[of[k]]));
  metric.push_back(metric_at_ ? Packed<3>::from(metric_at_(x)) : carrier_.metric(c));
  locked.push_back(0);
  return n;
}

NodeId CutTopology::split_at(std::span<const NodeId> of, const Vec<3>& x,
                             std::span<const double> weights) {
  star_.clear();
  for (auto e : topo.around.of(of[0]))
    if (std::all_of(of.begin(), of.end(),
                    [&](NodeId n) { return Topology<3>::has(topo.elements[e], n); }))
      star_.push_back(e);
  for (auto e : star_) {
    if (topo.is_virtual(e)) continue;
    auto p = corners(topo.elements[e]);
    const double whole = signed_measure<3>(p);
    for (int k = 0; k < 4; ++k) {
      const auto place = std::find(of.begin(), of.end(), topo.elements[e][k]);
      if (place == of.end()) continue;
      const Vec<3> kept = p[k];
      p[k] = x;
      const double share = weights[static_cast<std::size_t>(place - of.begin())];
      if (!(signed_measure<3>(p) > least_part * share * whole)) return 0;
      p[k] = kept;
    }
  }
  const NodeId n = add_node(x, of, weights);
  for (auto e : star_) {
    const Element old = topo.elements[e];
    const std::int32_t label = topo.label[e];
    topo.remove(e);
    for (NodeId gone : of) {
      Element next = old;
      std::replace(next.begin(), next.end(), gone, n);
      topo.add(next, label);
    }
  }
  if (of.size() == 2 && features.erase(key(of[0], of[1])) > 0) {
    features.insert(key(of[0], n));
    features.insert(key(n, of[1]));
  }
  return n;
}

/// The point of the sub-simplex that has the weights of its nodes.
Vec<3> CutTopology::nearest_in(const Element& nodes, unsigned bits, const Weights& weights) const {
  Vec<3> x = Vec<3>::Zero();
  double sum = 0;
  for (int k = 0; k < 4; ++k)
    if (bits >> k & 1) {
      x += weights[k] * at(nodes[k]);
      sum += weights[k];
    }
  return x / sum;
}

NodeId CutTopology::bring_node(std::int32_t e, const Weights& weights, const Vec<3>& x, NodeId from,
                               const Vec<3>& goal) {
  const auto onwards = [&](const Vec<3>& y) {
    return from == 0 || (goal - y).norm() < (goal - at(from)).norm();
  };
  const Element nodes = topo.elements[e];
  Packed<3> m = Packed<3>::zero();
  for (NodeId n : nodes) m.add(0.25, metric[n]);
  std::array<int, 4> order{0, 1, 2, 3};
  std::array<double, 4> far{};
  for (int k = 0; k < 4; ++k) far[k] = m.quad(at(nodes[k]) - x);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return far[a] < far[b]; });
  for (int k : order) {
    const NodeId n = nodes[k];
    const double d = (at(n) - x).norm();
    if (d <= exact || (locked[n] && d <= merge && n != from && onwards(at(n)))) {
      if (!locked[n] && hold_allows(std::array{n}, x)) topo.points[n] = x;
      return lock(n);
    }
    if (far[k] > snap_ * snap_ || locked[n] || weights[k] <= 0) continue;
    if (hold_allows(std::array{n}, x) && move(n, x)) return lock(n);
  }
  // The sub-simplices of fewest nodes first.
  for (int size = 2; size <= 4; ++size) {
    struct Choice {
      unsigned bits;
      double far2;
    };
    std::vector<Choice> choices;
    for (unsigned bits = 1; bits < 16; ++bits) {
      if (std::popcount(bits) != size) continue;
      bool fits = true;
      for (int k = 0; k < 4; ++k) fits = fits && ((bits >> k & 1) == 0 || weights[k] > 0);
      if (fits) choices.push_back({bits, m.quad(x - nearest_in(nodes, bits, weights))});
    }
    std::sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
      return a.far2 != b.far2 ? a.far2 < b.far2 : a.bits < b.bits;
    });
    for (const Choice& c : choices) {
      std::vector<NodeId> of;
      std::vector<double> share;
      double sum = 0;
      for (int k = 0; k < 4; ++k)
        if (c.bits >> k & 1) {
          of.push_back(nodes[k]);
          share.push_back(weights[k]);
          sum += weights[k];
        }
      for (double& s : share) s /= sum;
      if (size < 4) {
        const double off = (x - nearest_in(nodes, c.bits, weights)).norm();
        const bool there = off <= exact;
        if (!there && size == 2 && features.contains(key(of[0], of[1]))) {
          // What runs along another feature joins it.
          const Vec<3> along = at(of[1]) - at(of[0]);
          const double t = (x - at(of[0])).dot(along) / along.squaredNorm();
          const Vec<3> y = at(of[0]) + t * along;
          if (!(t > 0.01 && t < 0.99) || (y - x).norm() > merge || !onwards(y)) continue;
          if (const NodeId n = split_at(of, y, std::array{1 - t, t})) return lock(n);
          continue;
        }
        if (!there && c.far2 > close * close) continue;
        if (!there && !hold_allows(of, x)) continue;
      }
      if (const NodeId n = split_at(of, x, share)) return lock(n);
    }
  }
  return 0;
}

}  // namespace lamella
