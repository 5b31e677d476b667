#include "core/natural/elliptic_interpolation.h"

#include <algorithm>
#include <numbers>

#include "core/geometry/simplex.h"

namespace lamella {
namespace {

/// Smallest over largest eigenvalue from which on a matrix counts as singular: sizes then differ
/// by more than 1e6.
constexpr double kSingular = 1e-13;

template <int D>
bool is_regular(const Vec<D>& ascending) {
  return std::isfinite(ascending[D - 1]) && ascending[0] > kSingular * ascending[D - 1];
}

template <int D>
Mat<D> rebuilt(const Mat<D>& axes, const Vec<D>& values) {
  const Mat<D> m = axes * values.asDiagonal() * axes.transpose();
  return 0.5 * (m + m.transpose());
}

}  // namespace

template <int D>
void EllipticInterpolation<D>::set_points(std::span<const Vec<D>> points,
                                          std::span<const Face> faces) {
  offset_.assign(points.begin(), points.end());
  faces_.assign(faces.begin(), faces.end());
  weight_.assign(points.size(), 0.0);
  if (params_.edge_middles) {
    edges_.clear();
    for (const Face& f : faces)
      for (int i = 0; i < D; ++i)
        for (int j = i + 1; j < D; ++j)
          edges_.push_back({std::min(f[i], f[j]), std::max(f[i], f[j])});
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    for (const auto& [a, b] : edges_) offset_.push_back(0.5 * (points[a] + points[b]));
    weight_.resize(offset_.size(), 0.0);
  }
  if (params_.weights == PointWeights::uniform) {
    std::fill(weight_.begin(), weight_.end(), 1.0 / static_cast<double>(offset_.size()));
    return;
  }
  // With edge middles (4.8) is taken on the faces cut at them: a corner keeps one small face of
  // 2^(D-1).
  const double corner = params_.edge_middles ? 1.0 / (D * (1 << (D - 1))) : 1.0 / D;
  const double middle = (1 - D * corner) / (0.5 * D * (D - 1));
  double total = 0;
  for (const Face& f : faces) {
    std::array<Vec<D>, D> p;
    for (int k = 0; k < D; ++k) p[k] = points[f[k]];
    const double area = facet_normal<D>(p).norm();
    total += area;
    for (int i = 0; i < D; ++i) {
      weight_[f[i]] += corner * area;
      for (int j = i + 1; params_.edge_middles && j < D; ++j) {
        const std::array<std::int32_t, 2> edge{std::min(f[i], f[j]), std::max(f[i], f[j])};
        const auto at = std::lower_bound(edges_.begin(), edges_.end(), edge) - edges_.begin();
        weight_[points.size() + static_cast<std::size_t>(at)] += middle * area;
      }
    }
  }
  for (double& w : weight_) w = total > 0 ? w / total : 0;
}

template <int D>
void EllipticInterpolation<D>::set_center(const Vec<D>& center) {
  center_ = center;
  for (Vec<D>& p : offset_) p -= center;
}

template <int D>
void EllipticInterpolation<D>::set(std::span<const Vec<D>> points, std::span<const Face> faces) {
  set_points(points, faces);
  // Seen from the first point, so that a hull far from the origin keeps its digits.
  Vec<D> center = points.empty() ? Vec<D>::Zero().eval() : points[0];
  const Vec<D> origin = center;
  for (std::size_t i = 0; i < offset_.size(); ++i) center += weight_[i] * (offset_[i] - origin);
  set_center(center);
}

template <int D>
void EllipticInterpolation<D>::set(std::span<const Vec<D>> points, std::span<const Face> faces,
                                   const Vec<D>& center) {
  set_points(points, faces);
  set_center(center);
}

template <int D>
double EllipticInterpolation<D>::error(const Metric<D>& metric) const {
  double worst = 0;
  for (const Vec<D>& y : offset_) worst = std::max(worst, std::abs(y.dot(metric * y) - 1));
  return worst;
}

template <int D>
Mat<D> EllipticInterpolation<D>::tensor() const {
  Mat<D> sum = Mat<D>::Zero();
  for (std::size_t i = 0; i < offset_.size(); ++i)
    sum.noalias() += weight_[i] * offset_[i] * offset_[i].transpose();
  return sum;
}

template <int D>
std::optional<Mat<D>> EllipticInterpolation<D>::least_squares() const {
  constexpr int kTerms = D * (D + 1) / 2;
  using Terms = Eigen::Matrix<double, kTerms, 1>;
  using Normal = Eigen::Matrix<double, kTerms, kTerms>;

  // The minimizer follows linear maps of the points: mapped to a round cloud, the system is well
  // conditioned whatever the anisotropy. A flat cloud is only scaled.
  const Spectrum<D> cloud = spectrum<D>(tensor());
  if (!(cloud.values[D - 1] > 0) || !std::isfinite(cloud.values[D - 1])) return std::nullopt;
  Vec<D> stretch = Vec<D>::Constant(1 / std::sqrt(cloud.values[D - 1]));
  if (is_regular<D>(cloud.values)) stretch = cloud.values.cwiseSqrt().cwiseInverse();
  const Mat<D> to_round = rebuilt<D>(cloud.vectors, stretch);

  Normal normal = Normal::Zero();
  Terms right = Terms::Zero();
  for (std::size_t i = 0; i < offset_.size(); ++i) {
    const Vec<D> y = to_round * offset_[i];
    Terms terms;  // scaled such that the norm of the solution is that of the matrix
    for (int a = 0, t = 0; a < D; ++a)
      for (int b = a; b < D; ++b) terms[t++] = (a == b ? 1 : std::numbers::sqrt2) * y[a] * y[b];
    normal.noalias() += weight_[i] * terms * terms.transpose();
    right.noalias() += weight_[i] * terms;
  }
  const Eigen::SelfAdjointEigenSolver<Normal> solver(normal);
  Terms solution = Terms::Zero();
  for (int k = 0; k < kTerms; ++k)
    if (solver.eigenvalues()[k] > 1e-10 * solver.eigenvalues()[kTerms - 1])
      solution += solver.eigenvectors().col(k) *
                  (solver.eigenvectors().col(k).dot(right) / solver.eigenvalues()[k]);
  Mat<D> m;
  for (int a = 0, t = 0; a < D; ++a)
    for (int b = a; b < D; ++b, ++t)
      m(a, b) = m(b, a) = a == b ? solution[t] : solution[t] / std::numbers::sqrt2;
  return Mat<D>(to_round * m * to_round);
}

template <int D>
std::optional<Metric<D>> EllipticInterpolation<D>::star_metric(Interpolation method) const {
  // M_T^(-1/2) exists for flat elements too; those at the center's own faces are.
  Mat<D> mean = Mat<D>::Zero();
  Vec<D> mean_sizes = Vec<D>::Zero();
  for (const Face& f : faces_) {
    std::array<Vec<D>, D + 1> p;
    p[0] = Vec<D>::Zero();
    for (int k = 0; k < D; ++k) p[k + 1] = offset_[f[k]];
    const Spectrum<D> s = spectrum<D>(simplex_metric_inverse<D>(p));
    const Vec<D> h = s.values.cwiseMax(0).cwiseSqrt();
    mean += rebuilt<D>(s.vectors, h);
    mean_sizes += h;
  }
  if (faces_.empty()) return std::nullopt;
  const Spectrum<D> s = spectrum<D>(mean / static_cast<double>(faces_.size()));
  const Vec<D> h =
      method == Interpolation::m3 ? s.values : mean_sizes / static_cast<double>(faces_.size());
  // Sizes whose squares would be singular.
  if (!is_regular<D>(s.values.cwiseMax(0).cwiseAbs2()) || !is_regular<D>(h.cwiseAbs2()))
    return std::nullopt;
  return rebuilt<D>(s.vectors, h.cwiseAbs2().cwiseInverse());
}

template <int D>
std::optional<EllipticFit<D>> EllipticInterpolation<D>::fit(Interpolation method) const {
  EllipticFit<D> fit;
  fit.method = method;
  if (method == Interpolation::m1) {
    const std::optional<Mat<D>> m = least_squares();
    if (!m || !m->allFinite()) return std::nullopt;
    double reach2 = 0;
    for (const Vec<D>& y : offset_) reach2 = std::max(reach2, y.squaredNorm());
    const double least = params_.h_max > 0 ? eigenvalue_from_size(params_.h_max) : 0.25 / reach2;
    const Spectrum<D> s = spectrum<D>(*m);
    fit.projected = s.values[0] < least;
    fit.metric = fit.projected ? rebuilt<D>(s.vectors, s.values.cwiseMax(least)) : *m;
  } else if (method == Interpolation::m2) {
    const Spectrum<D> s = spectrum<D>(tensor());
    if (!is_regular<D>(s.values)) return std::nullopt;
    fit.metric = rebuilt<D>(s.vectors, s.values.cwiseInverse());
    double square = 0, fourth = 0;
    for (std::size_t i = 0; i < offset_.size(); ++i) {
      const double q = offset_[i].dot(fit.metric * offset_[i]);
      square += weight_[i] * q;
      fourth += weight_[i] * q * q;
    }
    fit.metric *= square / fourth;
  } else {
    const std::optional<Metric<D>> m = star_metric(method);
    if (!m) return std::nullopt;
    fit.metric = *m;
  }
  fit.error = error(fit.metric);
  return fit;
}

template <int D>
std::optional<EllipticFit<D>> EllipticInterpolation<D>::fit() const {
  for (const auto method : {Interpolation::m2, Interpolation::m4, Interpolation::m1})
    if (std::optional<EllipticFit<D>> one = fit(method)) return one;
  return std::nullopt;
}

template class EllipticInterpolation<2>;
template class EllipticInterpolation<3>;
template class EllipticInterpolation<4>;

}  // namespace lamella
