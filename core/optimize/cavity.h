#pragma once

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
  Packed<D> metric_sum;  ///< sum of the nodal metrics
};

/// c(T)^2 with c of (3.7), the shape multiplied by `relax` (1: plain): the value the star compares.
/// Negative for an ill oriented or flat element.
template <int D>
struct QualityKernel {
  double relax2 = 1;

  double operator()(const RealFace<D>& f, const Vec<D>& apex, const Packed<D>& apex_metric) const {
    const Vec<D> w = apex - f.center;
    const double volume = f.normal.dot(w);
    if (volume <= 0 || volume * volume <= 1e-22 * f.normal2 * w.squaredNorm()) return -1;
    Packed<D> m = f.metric_sum;
    m += apex_metric;
    PackedDual<D> e = f.edges;
    e.add_outer(D, w);
    constexpr double mean = 1.0 / (D + 1);
    const double h2 = trace_product(m, e) * (2.0 * mean / (D * (D + 1)));
    double det_scale = 1, hd = 1;
    for (int k = 0; k < D; ++k) {
      det_scale *= mean;
      hd *= h2;
    }
    constexpr double two_d = 1 << D;
    const double shape2 = relax2 * two_d * mean * volume * volume * m.det() * det_scale / hd;
    return std::min(shape2, std::min(hd, 1 / hd));
  }
};

template <int D>
void fill_real_face(RealFace<D>& f, const Topology<D>& topo, std::int32_t element, int place,
                    const std::vector<Packed<D>>& metric) {
  f.element = element;
  f.place = place;
  f.nodes = opposite_facet<D>(topo.elements[element], place);
  std::array<Vec<D>, D> p;
  f.center.setZero();
  f.metric_sum = metric[f.nodes[0]];
  for (int k = 0; k < D; ++k) {
    p[k] = topo.points[f.nodes[k]];
    f.center += p[k];
    if (k) f.metric_sum += metric[f.nodes[k]];
  }
  f.center *= 1.0 / D;
  f.normal = -facet_normal<D>(p);
  f.normal2 = f.normal.squaredNorm();
  f.edges = PackedDual<D>::zero();
  for (int i = 0; i < D; ++i)
    for (int j = i + 1; j < D; ++j) f.edges.add_outer((D + 1.0) / D, Vec<D>(p[j] - p[i]));
}

}  // namespace lamella
