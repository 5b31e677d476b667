#pragma once

#include "core/geometry/simplex.h"

namespace lamella {

/// Symmetric matrix of R^D packed as its upper triangle, row by row: what the inner loops of the
/// optimizer read and write.
template <int D>
struct Packed {
  static constexpr int size = D * (D + 1) / 2;
  std::array<double, size> c;

  static constexpr int index(int i, int j) { return i * D - i * (i - 1) / 2 + (j - i); }

  static Packed from(const Mat<D>& m) {
    Packed p;
    for (int i = 0, k = 0; i < D; ++i)
      for (int j = i; j < D; ++j) p.c[k++] = 0.5 * (m(i, j) + m(j, i));
    return p;
  }
  Mat<D> full() const {
    Mat<D> m;
    for (int i = 0, k = 0; i < D; ++i)
      for (int j = i; j < D; ++j, ++k) m(i, j) = m(j, i) = c[k];
    return m;
  }
  Packed& operator+=(const Packed& o) {
    for (int k = 0; k < size; ++k) c[k] += o.c[k];
    return *this;
  }
  void add(double w, const Packed& o) {
    for (int k = 0; k < size; ++k) c[k] += w * o.c[k];
  }
  static Packed zero() {
    Packed p;
    p.c.fill(0);
    return p;
  }

  /// v^T M v.
  double quad(const Vec<D>& v) const {
    double s = 0;
    for (int i = 0, k = 0; i < D; ++i) {
      s += c[k++] * v[i] * v[i];
      for (int j = i + 1; j < D; ++j) s += 2 * c[k++] * v[i] * v[j];
    }
    return s;
  }
  /// M v.
  Vec<D> times(const Vec<D>& v) const {
    Vec<D> r = Vec<D>::Zero();
    for (int i = 0, k = 0; i < D; ++i) {
      r[i] += c[k++] * v[i];
      for (int j = i + 1; j < D; ++j, ++k) {
        r[i] += c[k] * v[j];
        r[j] += c[k] * v[i];
      }
    }
    return r;
  }
  double det() const {
    if constexpr (D == 2) {
      return c[0] * c[2] - c[1] * c[1];
    } else if constexpr (D == 3) {
      return c[0] * (c[3] * c[5] - c[4] * c[4]) - c[1] * (c[1] * c[5] - c[4] * c[2]) +
             c[2] * (c[1] * c[4] - c[3] * c[2]);
    } else {
      return full().determinant();
    }
  }
};

/// Like Packed, with the off-diagonal entries doubled, so that trace(M E) is a plain dot product.
template <int D>
struct PackedDual {
  std::array<double, Packed<D>::size> c;

  static PackedDual zero() {
    PackedDual p;
    p.c.fill(0);
    return p;
  }
  /// Adds w v v^T.
  void add_outer(double w, const Vec<D>& v) {
    for (int i = 0, k = 0; i < D; ++i) {
      c[k++] += w * v[i] * v[i];
      for (int j = i + 1; j < D; ++j) c[k++] += 2 * w * v[i] * v[j];
    }
  }
};

template <int D>
double trace_product(const Packed<D>& m, const PackedDual<D>& e) {
  double s = 0;
  for (int k = 0; k < Packed<D>::size; ++k) s += m.c[k] * e.c[k];
  return s;
}

}  // namespace lamella
