#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "core/optimize/adapt.h"
#include "core/optimize/packed.h"
#include "core/optimize/topology.h"

namespace lamella {

/// A face of a cavity as the star operator sees it: the new element is `element` with the node at
/// `place` replaced by the apex, which keeps the orientation.
template <int D>
struct CavityFace {
  std::array<NodeId, D> nodes;  ///< the face; node 0 among them for a virtual one
  std::int32_t element;
  std::int32_t place;
  bool contains(NodeId n) const {
    for (NodeId m : nodes)
      if (m == n) return true;
    return false;
  }
};

/// What the quality of {face, apex} needs of a real face, computed once a cavity (design of the
/// kernel: sum of e e^T = ((D+1)/D) P_F + D w w^T with w = apex - center).
template <int D>
struct RealFace : CavityFace<D> {
  Vec<D> normal;  ///< inward; normal . (apex - center) = D! times the signed measure
  Vec<D> center;
  double normal2;        ///< |normal|^2
  PackedDual<D> edges;   ///< ((D+1)/D) times the sum of e e^T over the face's edges
  Packed<D> metric_sum;  ///< sum of what the nodes carry into the metric of an element
};

/// The two numbers that the star compares. `quality` is c(T) of (3.7), the shape multiplied by the
/// relaxation; `energy` is 1 / shape + w (h^D + h^-D - 2): smooth, 1 for the unit equilateral
/// element, infinite for a flat one.
struct Rating {
  double quality = -1;
  double energy = std::numeric_limits<double>::infinity();
};

/// Qualities of a star, sorted from the worst as far as someone has looked.
class SortedQualities {
 public:
  void clear() {
    values_.clear();
    sorted_ = 0;
  }
  void add(double quality) { values_.push_back(quality); }
  /// Several, some of which may be infinite: those are none.
  template <std::size_t N>
  void add(const double (&qualities)[N]) {
    values_.insert(values_.end(), qualities, qualities + N);
  }
  std::size_t size() const { return values_.size(); }
  /// The i-th from the worst, when those before it were asked for already; +infinity behind the
  /// last.
  double at(std::size_t i) {
    if (i >= values_.size()) return std::numeric_limits<double>::infinity();
    if (i == sorted_) {
      const auto begin = values_.begin() + static_cast<std::ptrdiff_t>(i);
      std::iter_swap(begin, std::min_element(begin, values_.end()));
      ++sorted_;
    }
    return values_[i];
  }

 private:
  std::vector<double> values_;
  std::size_t sorted_ = 0;
};

/// Whether the qualities `a` go before `b` in the order (3.9): sorted from the worst, the first
/// difference decides, and the shorter list is padded with +infinity.
inline bool goes_before(SortedQualities& a, SortedQualities& b) {
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const double x = a.at(i), y = b.at(i);
    if (x != y) return x > y;
  }
  return false;
}

/// h^D, given h^2.
template <int D>
double power_of_size(double h2) {
  if constexpr (D == 2) return h2;
  if constexpr (D == 3) return h2 * std::sqrt(h2);
  return h2 * h2;
}

/// Energy of a typical element of a good mesh: what an additional element must be worth.
template <int D>
inline constexpr double typical_energy = D == 2   ? 1.02
                                         : D == 3 ? 1.2
                                                  : 1.38;
/// Weight w of the size in the energy.
template <int D>
inline constexpr double usual_size_weight = D == 2   ? 1.8
                                            : D == 3 ? 0.7
                                                     : 0.6;

/// Rates the element {face, apex}. Negative quality for an ill oriented or flat one.
template <int D>
struct RatingKernel {
  static constexpr double mean = 1.0 / (D + 1);
  /// Of the shape in the densest metric: a mean ratio of .3 in it counts as much as c(T) of .45.
  static constexpr double strictness = 2.8;
  double relaxation = 1;  ///< of the shape
  double size_weight = usual_size_weight<D>;
  MetricMean element_mean = MetricMean::m;
  SizeAverage size_average = SizeAverage::l2;
  const std::vector<Vec<D>>* points = nullptr;
  /// [node] what elements average, M itself; where set, the quality is bounded by `strictness`
  /// times the shape in the densest metric of the nodes as well.
  const std::vector<Packed<D>>* metrics = nullptr;

  /// (3.2) and (3.4), the fast case.
  bool plain() const {
    return element_mean == MetricMean::m && size_average == SizeAverage::l2 && !metrics;
  }
  /// Metric of the element, (3.2), (3.12) or (3.16), from the sum of what its nodes carry.
  Packed<D> element_metric(const RealFace<D>& f, const Packed<D>& apex_carried) const {
    Packed<D> m = f.metric_sum;
    m += apex_carried;
    for (double& c : m.c) c *= mean;
    if (element_mean == MetricMean::m) [[likely]]
      return m;
    if (element_mean == MetricMean::log) return Packed<D>::from(metric_exp<D>(m.full()));
    const Mat<D> r = element_mean == MetricMean::root ? m.full() : Mat<D>(m.full().inverse());
    return Packed<D>::from(r * r);
  }
  /// Mean length of the edges in the metric, squared: what an L1 average takes for h^2.
  double plain_size2(const RealFace<D>& f, const Vec<D>& apex, const Packed<D>& m) const {
    double sum = 0;
    for (int i = 0; i < D; ++i) {
      const Vec<D>& p = (*points)[f.nodes[i]];
      sum += std::sqrt(m.quad(apex - p));
      for (int j = i + 1; j < D; ++j) sum += std::sqrt(m.quad((*points)[f.nodes[j]] - p));
    }
    sum *= 2.0 / (D * (D + 1));
    return sum * sum;
  }

  /// The least shape of {face, apex} in the densest metric of its nodes, and in those that are as
  /// dense but for a few percent.
  double shape_in_densest(const RealFace<D>& f, const Packed<D>& apex, const PackedDual<D>& e,
                          double volume) const {
    std::array<const Packed<D>*, D + 1> own;
    std::array<double, D + 1> det;
    own[D] = &apex;
    for (int k = 0; k < D; ++k) own[k] = &(*metrics)[f.nodes[k]];
    for (int k = 0; k <= D; ++k) det[k] = own[k]->det();
    const double dense = 0.9 * *std::max_element(det.begin(), det.end());
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= D; ++k)
      if (det[k] >= dense)
        least = std::min(least, std::sqrt(det[k]) / power_of_size<D>(trace_product(*own[k], e)));
    constexpr double edges = 0.5 * D * (D + 1);
    return least * volume * std::sqrt((1 << D) * mean) * power_of_size<D>(edges);
  }

  Rating operator()(const RealFace<D>& f, const Vec<D>& apex, const Packed<D>& apex_carried) const {
    const Vec<D> w = apex - f.center;
    const double volume = f.normal.dot(w);
    if (volume <= 0 || volume * volume <= 1e-22 * f.normal2 * w.squaredNorm()) return {};
    const Packed<D> m = element_metric(f, apex_carried);
    PackedDual<D> e = f.edges;
    e.add_outer(D, w);
    double h2 = trace_product(m, e) * (2.0 / (D * (D + 1)));
    if (size_average == SizeAverage::l1) h2 = plain_size2(f, apex, m);
    const double h = power_of_size<D>(h2);
    const double inverse = 1 / h;
    // |T|_M over the measure of the unit simplex.
    const double v = volume * std::sqrt(m.det() * ((1 << D) * mean));
    const double shape = v * inverse;
    double quality = std::min(relaxation * shape, std::min(h, inverse));
    if (metrics)
      quality = std::min(quality, strictness * shape_in_densest(f, apex_carried, e, volume));
    return {quality, 1 / shape + size_weight * (h + inverse - 2)};
  }
};

template <int D>
void fill_real_face(RealFace<D>& f, const Topology<D>& topo, std::int32_t element, int place,
                    const std::vector<Packed<D>>& carried) {
  f.element = element;
  f.place = place;
  f.nodes = opposite_facet<D>(topo.elements[element], place);
  std::array<Vec<D>, D> p;
  f.center.setZero();
  f.metric_sum = carried[f.nodes[0]];
  for (int k = 0; k < D; ++k) {
    p[k] = topo.points[f.nodes[k]];
    f.center += p[k];
    if (k) f.metric_sum += carried[f.nodes[k]];
  }
  f.center *= 1.0 / D;
  f.normal = -facet_normal<D>(p);
  f.normal2 = f.normal.squaredNorm();
  f.edges = PackedDual<D>::zero();
  for (int i = 0; i < D; ++i)
    for (int j = i + 1; j < D; ++j) f.edges.add_outer((D + 1.0) / D, Vec<D>(p[j] - p[i]));
}

}  // namespace lamella
