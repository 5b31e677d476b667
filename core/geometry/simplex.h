#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lamella {

/// Point or vector of R^D, in mm.
template <int D>
using Vec = Eigen::Matrix<double, D, 1>;
/// Square matrix of R^D.
template <int D>
using Mat = Eigen::Matrix<double, D, D>;

constexpr int factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

/// Matrix whose columns are the edge vectors from the first vertex.
template <int D>
Mat<D> edge_matrix(const std::array<Vec<D>, D + 1>& p) {
  Mat<D> a;
  for (int k = 0; k < D; ++k) a.col(k) = p[k + 1] - p[0];
  return a;
}

/// Signed measure det(S1-S0, ..., SD-S0)/D!, eq. (1.9); positive when well oriented (A.28).
template <int D>
double signed_measure(const std::array<Vec<D>, D + 1>& p) {
  return edge_matrix<D>(p).determinant() / factorial(D);
}

/// Vector normal to the facet (p_0 .. p_{D-1}), of length (D-1)! times its measure (A.2.2): for
/// every apex v, det(p_1-p_0, .., p_{D-1}-p_0, v-p_0) = normal . (v-p_0). For a facet listed as
/// SimplexMesh lists the boundary it points outward.
template <int D>
Vec<D> facet_normal(const std::array<Vec<D>, D>& p) {
  if constexpr (D == 2) {
    const Vec<2> e = p[1] - p[0];
    return {-e[1], e[0]};
  } else if constexpr (D == 3) {
    return (p[1] - p[0]).cross(p[2] - p[0]);
  } else {
    Mat<D> a;
    for (int k = 0; k + 1 < D; ++k) a.col(k) = p[k + 1] - p[0];
    Vec<D> n;
    for (int i = 0; i < D; ++i) {
      a.col(D - 1) = Vec<D>::Unit(i);
      n[i] = a.determinant();
    }
    return n;
  }
}

/// Measure of the unit equilateral D-simplex: sqrt(D+1) / (D! 2^(D/2)), the inverse of (3.5).
inline double unit_simplex_measure(int d) {
  return std::sqrt(d + 1.0) / (factorial(d) * std::pow(2.0, 0.5 * d));
}

}  // namespace lamella
