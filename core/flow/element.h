#pragma once

#include "core/geometry/simplex.h"

namespace lamella::flow {

/// What P1 functions need of an element.
template <int D>
struct ElementShape {
  std::array<Vec<D>, D + 1> gradient;  ///< of the barycentric coordinates, mm^-1
  double measure = 0;                  ///< |T|, mm^D
};

/// The element must not be flat.
template <int D>
ElementShape<D> element_shape(const std::array<Vec<D>, D + 1>& p) {
  ElementShape<D> out;
  const Mat<D> edges = edge_matrix<D>(p);
  const Mat<D> inverse = edges.inverse();
  out.measure = std::abs(edges.determinant()) / factorial(D);
  out.gradient[0].setZero();
  for (int k = 0; k < D; ++k) {
    out.gradient[k + 1] = inverse.row(k).transpose();
    out.gradient[0] -= out.gradient[k + 1];
  }
  return out;
}

}  // namespace lamella::flow
