#include "core/natural/layer_correction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/mesh/adjacency.h"

namespace lamella {
namespace {

constexpr int kSmoothings = 2;   // single places scatter by 10 % about what their surroundings have
constexpr double kFinest = 1.6;  // bounds of the factor
constexpr double kCoarsest = 0.75;
constexpr double kDivided = 2;  // sizes up to so many times the smallest

}  // namespace

struct LayerCorrection::Field {
  std::vector<std::array<NodeId, 4>> elements;
  std::vector<double> log_factor;  // [node]
  ElementLocator<3> locator;
};

Result<LayerCorrection> LayerCorrection::learn(const LayerCorrection& before,
                                               const SimplexMesh<3>& mesh,
                                               const std::vector<double>& layers, double wanted,
                                               int threads, const Progress& progress) {
  const std::size_t count = mesh.points.size();
  std::vector<double> change(count, 0.0);
  std::vector<char> known(count, 0);
  for (std::size_t n = 1; n < count; ++n) {
    if (!(layers[n] > 0)) continue;
    change[n] = std::log(wanted / layers[n]);
    known[n] = 1;
  }
  const auto edges = unique_edges<3>(mesh.elements, count);
  std::vector<double> sum(count), weight(count);
  for (int i = 0; i < kSmoothings; ++i) {
    if (progress.cancelled()) return cancelled_error();
    progress.report(0.3 * i / kSmoothings);
    for (std::size_t n = 0; n < count; ++n) {
      weight[n] = known[n];
      sum[n] = known[n] ? change[n] : 0;
    }
    for (const auto& [a, b] : edges) {
      if (!known[a] || !known[b]) continue;
      sum[a] += change[b];
      sum[b] += change[a];
      weight[a] += 1;
      weight[b] += 1;
    }
    for (std::size_t n = 1; n < count; ++n)
      if (known[n]) change[n] = sum[n] / weight[n];
  }
  const auto add_before = [&](std::size_t i) {
    double& sum_of_changes = change[i + 1];
    sum_of_changes = std::clamp(sum_of_changes + std::log(before.at(mesh.points[i + 1])),
                                std::log(kCoarsest), std::log(kFinest));
  };
  if (!parallel_each(mesh.node_count(), threads, progress.portion(0.3, 0.6), add_before))
    return cancelled_error();
  LayerCorrection after;
  after.field_ = std::make_shared<const Field>(
      Field{mesh.elements, std::move(change), ElementLocator<3>(mesh, progress.portion(0.6, 1))});
  if (progress.cancelled()) return cancelled_error();
  return after;
}

double LayerCorrection::at(const Vec<3>& x) const {
  if (!field_) return 1;
  const Located<3> at = field_->locator.locate(x);
  double log_factor = 0;
  for (int k = 0; k < 4; ++k)
    log_factor += at.weights[k] * field_->log_factor[field_->elements[at.element][k]];
  return std::exp(log_factor);
}

Metric<3> LayerCorrection::apply(const Vec<3>& x, const Metric<3>& asked, double h_min) const {
  const double factor = at(x);
  if (factor == 1) return asked;
  const Eigen::SelfAdjointEigenSolver<Mat<3>> eigen(asked);
  Vec<3> lambda = eigen.eigenvalues();
  const double least = lambda[2] / (kDivided * kDivided);
  const double most = h_min > 0 ? std::max(lambda[2], 1 / (h_min * h_min))
                                : std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
    if (lambda[k] >= least) lambda[k] = std::min(factor * factor * lambda[k], most);
  return eigen.eigenvectors() * lambda.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace lamella
