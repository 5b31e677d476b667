#pragma once

#include "core/geometry/simplex.h"

namespace lamella {

/// Nearest point of one facet to a query: the point, and which of the facet's vertices carry it
/// (bit k: vertex k). All bits: inside the facet; one bit: a vertex.
template <int D>
struct Foot {
  Vec<D> point;
  unsigned carriers;
};

template <int D>
Foot<D> foot_on_segment(const Vec<D>& a, const Vec<D>& b, const Vec<D>& x, unsigned bit_a = 1,
                        unsigned bit_b = 2) {
  const Vec<D> e = b - a;
  const double s = e.dot(x - a);
  const double length2 = e.squaredNorm();
  if (s <= 0 || length2 == 0) return {a, bit_a};
  if (s >= length2) return {b, bit_b};
  return {a + (s / length2) * e, bit_a | bit_b};
}

inline Foot<2> foot_on_facet(const std::array<Vec<2>, 2>& p, const Vec<2>& x) {
  return foot_on_segment<2>(p[0], p[1], x);
}

inline Foot<3> foot_on_facet(const std::array<Vec<3>, 3>& p, const Vec<3>& x) {
  // Regions of Voronoi: a vertex, an edge, or the face, told apart by signs of dot products.
  const Vec<3> ab = p[1] - p[0], ac = p[2] - p[0], ax = x - p[0];
  const double d1 = ab.dot(ax), d2 = ac.dot(ax);
  if (d1 <= 0 && d2 <= 0) return {p[0], 1};
  const Vec<3> bx = x - p[1];
  const double d3 = ab.dot(bx), d4 = ac.dot(bx);
  if (d3 >= 0 && d4 <= d3) return {p[1], 2};
  const Vec<3> cx = x - p[2];
  const double d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d6 >= 0 && d5 <= d6) return {p[2], 4};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return foot_on_segment<3>(p[0], p[1], x, 1, 2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return foot_on_segment<3>(p[0], p[2], x, 1, 4);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return foot_on_segment<3>(p[1], p[2], x, 2, 4);
  const double sum = va + vb + vc;
  if (sum > 0) return {p[0] + (vb / sum) * ab + (vc / sum) * ac, 7};
  // A facet without area: the nearest of its edges.
  Foot<3> best = foot_on_segment<3>(p[0], p[1], x, 1, 2);
  for (const auto& f :
       {foot_on_segment<3>(p[0], p[2], x, 1, 4), foot_on_segment<3>(p[1], p[2], x, 2, 4)})
    if ((f.point - x).squaredNorm() < (best.point - x).squaredNorm()) best = f;
  return best;
}

}  // namespace lamella
