#include "core/natural/ellipsoid_fit.h"

#include <numbers>

namespace lamella {
namespace {

constexpr int kPairs = 40;       // of opposite rays
constexpr int kPlanePairs = 12;  // of opposite rays in the plane of the long axes
constexpr double kNear = 8;  // the first fit cuts its rays here: what is longer is measured again
constexpr double kFar = 20;  // rays and axes end at so many radii
constexpr double kThin = 3;  // a second axis that much longer than the first: plainly a thin wall
constexpr double kLong = 2;  // an axis that much longer than the first is measured again

template <class M>
auto pseudo_inverse(const M& m) {
  return ((m.transpose() * m).inverse() * m.transpose()).eval();
}

struct Table {
  std::array<Vec<3>, kPairs> u;
  Eigen::Matrix<double, 6, kPairs> inverse;  // of the rows (uu, vv, ww, 2uv, 2uw, 2vw)
  Eigen::Matrix<double, 3, kPlanePairs> plane_inverse;

  Table() {
    // A spiral of equal areas; the golden angle keeps neighbors apart.
    Eigen::Matrix<double, kPairs, 6> rows;
    for (int i = 0; i < kPairs; ++i) {
      const double z = (i + 0.5) / kPairs, phi = i * 2 * std::numbers::pi / std::numbers::phi;
      const double radius = std::sqrt(1 - z * z);
      u[i] = {radius * std::cos(phi), radius * std::sin(phi), z};
      rows.row(i) << u[i][0] * u[i][0], u[i][1] * u[i][1], u[i][2] * u[i][2], 2 * u[i][0] * u[i][1],
          2 * u[i][0] * u[i][2], 2 * u[i][1] * u[i][2];
    }
    inverse = pseudo_inverse(rows);
    Eigen::Matrix<double, kPlanePairs, 3> plane;
    for (int i = 0; i < kPlanePairs; ++i) {
      const Vec<2> v = plane_direction(i);
      plane.row(i) << v[0] * v[0], v[1] * v[1], 2 * v[0] * v[1];
    }
    plane_inverse = pseudo_inverse(plane);
  }

  static Vec<2> plane_direction(int i) {
    const double phi = std::numbers::pi * (i + 0.5) / kPlanePairs;
    return {std::cos(phi), std::sin(phi)};
  }
};

const Table& table() {
  static const Table t;
  return t;
}

/// 1/(d(u) d(-u)), both cut at `far`.
double inverse_product(const Locator<3>& surface, const Vec<3>& c, const Vec<3>& u, double far) {
  double product = 1;
  for (const double side : {1.0, -1.0}) {
    const auto hit = surface.exit(c, side * u, 0, far);
    product *= hit ? hit->t : far;
  }
  return 1 / product;
}

double length_of(double eigenvalue, double far) {
  return 1 / std::sqrt(std::max(eigenvalue, 1 / (far * far)));
}

/// The second and the third axis by rays in their own plane, which the short rays of a thin wall
/// would drown.
void measure_plane(const Locator<3>& surface, const Vec<3>& c, double far, SeenAxes& seen) {
  const Vec<3> e2 = seen.axis.col(1), e3 = seen.axis.col(2);
  Eigen::Matrix<double, kPlanePairs, 1> f;
  for (int i = 0; i < kPlanePairs; ++i) {
    const Vec<2> v = Table::plane_direction(i);
    f[i] = inverse_product(surface, c, v[0] * e2 + v[1] * e3, far);
  }
  const Vec<3> m = table().plane_inverse * f;
  Mat<2> plane;
  plane << m[0], m[2], m[2], m[1];
  const Eigen::SelfAdjointEigenSolver<Mat<2>> eigen(plane);
  for (int k = 0; k < 2; ++k) {
    const Vec<2> v = eigen.eigenvectors().col(1 - k);
    seen.length[1 + k] = std::max(seen.length[0], length_of(eigen.eigenvalues()[1 - k], far));
    seen.axis.col(1 + k) = v[0] * e2 + v[1] * e3;
  }
}

}  // namespace

std::span<const Vec<3>> EllipsoidFit::directions() { return table().u; }

SeenAxes EllipsoidFit::at(const Locator<3>& surface, const Vec<3>& c, double r,
                          const Vec<3>& across) {
  const Table& t = table();
  const double far = kFar * r;
  if (!across.isZero()) {
    SeenAxes seen;
    seen.length[0] = r;
    seen.axis.col(0) = across;
    seen.axis.col(1) = across.unitOrthogonal();
    seen.axis.col(2) = across.cross(seen.axis.col(1));
    measure_plane(surface, c, far, seen);
    if (seen.length[1] > kThin * r) return seen;
  }
  Eigen::Matrix<double, kPairs, 1> f;
  for (int i = 0; i < kPairs; ++i) f[i] = inverse_product(surface, c, t.u[i], kNear * r);
  const Eigen::Matrix<double, 6, 1> m = t.inverse * f;
  Mat<3> fitted;
  fitted << m[0], m[3], m[4], m[3], m[1], m[5], m[4], m[5], m[2];

  // Eigenvalues come by growing value, that is the longest axis first.
  const Eigen::SelfAdjointEigenSolver<Mat<3>> eigen(fitted);
  SeenAxes seen;
  for (int k = 0; k < 3; ++k) {
    seen.length[k] = length_of(eigen.eigenvalues()[2 - k], far);
    seen.axis.col(k) = eigen.eigenvectors().col(2 - k);
  }
  if (seen.length[1] > kLong * seen.length[0]) {
    measure_plane(surface, c, far, seen);
  } else if (seen.length[2] > kLong * seen.length[0]) {
    seen.length[2] =
        std::max(seen.length[1], 1 / std::sqrt(inverse_product(surface, c, seen.axis.col(2), far)));
  }
  return seen;
}

}  // namespace lamella
