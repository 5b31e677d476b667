#pragma once

#include <optional>
#include <span>

#include "core/metric/metric.h"

namespace lamella {

/// The four metrics of table 4.1.
enum class Interpolation {
  m1,  ///< least squares (4.29), projected onto eigenvalues >= h_max^-2
  m2,  ///< tensor of the points, scaled, (4.50) to (4.52)
  m3,  ///< mean of M_T^(-1/2) over the star of the center, (4.61)
  m4   ///< axes of M3, mean of the sorted sizes, (4.62) as R D R^T
};

/// alpha of (4.8): the share of a point in the area of the faces, or the same for all.
enum class PointWeights { area, uniform };

struct EllipticParams {
  PointWeights weights = PointWeights::area;
  bool edge_middles = false;  ///< the middles of the faces' edges join the points
  double h_max = 0;           ///< mm, largest size of M1; 0: diameter of the points
};

template <int D>
struct EllipticFit {
  Metric<D> metric;
  Interpolation method = Interpolation::m2;
  double error = 0;        ///< largest | ||S' - C||_M^2 - 1 | over the points, (4.63)
  bool projected = false;  ///< M1 had an eigenvalue below h_max^-2
};

/// The metric whose unit ball around the center of a hull passes as near as can be to its points
/// (section 4.2). One object serves many hulls one after another without allocating anew.
///
/// M1 is exact for points on an ellipsoid around the center. M2 follows every linear map of the
/// points when the weights are uniform. M3 and M4 look at the faces alone.
template <int D>
class EllipticInterpolation {
 public:
  using Face = std::array<std::int32_t, D>;

  explicit EllipticInterpolation(const EllipticParams& params = {}) : params_(params) {}

  /// The hull's points and faces (indices into the points, in any order), center (4.7). Area
  /// weights and edge middles need the faces.
  void set(std::span<const Vec<D>> points, std::span<const Face> faces);
  /// With a center of the caller's.
  void set(std::span<const Vec<D>> points, std::span<const Face> faces, const Vec<D>& center);

  const Vec<D>& center() const { return center_; }
  /// The minimizer of (4.9) without constraint, of least norm when there are several: symmetric,
  /// not always positive. Unset when there is no point off the center.
  std::optional<Mat<D>> least_squares() const;
  /// Unset when the method gives no positive definite metric: M2 to M4 where the points lie in a
  /// hyperplane with the center, M2 where all but a speck of the area does; M1 only without least
  /// squares.
  std::optional<EllipticFit<D>> fit(Interpolation method) const;
  /// M2, else M4, else M1.
  std::optional<EllipticFit<D>> fit() const;
  /// (4.63) of any metric.
  double error(const Metric<D>& metric) const;

 private:
  void set_points(std::span<const Vec<D>> points, std::span<const Face> faces);
  void set_center(const Vec<D>& center);
  Mat<D> tensor() const;
  std::optional<Metric<D>> star_metric(Interpolation method) const;

  EllipticParams params_;
  Vec<D> center_ = Vec<D>::Zero();
  std::vector<Vec<D>> offset_;  ///< [point] from the center, edge middles last
  std::vector<double> weight_;  ///< [point], of sum 1; 0 everywhere when all faces are flat
  std::vector<Face> faces_;
  std::vector<std::array<std::int32_t, 2>> edges_;  ///< scratch
};

}  // namespace lamella
