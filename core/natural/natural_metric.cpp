#include "core/natural/natural_metric.h"

#include "core/base/parallel.h"
#include "core/geometry/locator.h"
#include "core/natural/ellipsoid_fit.h"
#include "core/natural/medial_ball.h"

namespace lamella {
namespace {

/// Share of the division by n: 1 up to the ratio 1 + alpha, 0 from twice that, linear in log
/// between.
double division_share(double ratio, double alpha) {
  const double full = 1 + alpha;
  return std::clamp(1 - std::log(ratio / full) / std::log(2.0), 0.0, 1.0);
}

}  // namespace

struct NaturalDetector::Impl {
  Locator<3> locator;
};

NaturalDetector::NaturalDetector(const ReferenceSurface<3>& surface)
    : impl_(new Impl{Locator<3>(surface)}) {}
NaturalDetector::~NaturalDetector() = default;
NaturalDetector::NaturalDetector(NaturalDetector&&) noexcept = default;

Natural NaturalDetector::at(const Vec<3>& x, const NaturalParams& params) const {
  const MedialBall ball = climb_to_medial_ball(impl_->locator, x);
  const SeenAxes seen = EllipsoidFit::at(impl_->locator, ball.center, ball.radius);
  const double h_max = params.h_max > 0 ? params.h_max : impl_->locator.diagonal();

  Natural natural;
  natural.thickness = 2 * ball.radius;
  natural.direction = seen.axis.col(0);
  natural.metric.setZero();
  for (int k = 0; k < 3; ++k) {
    const double ratio = seen.length[k] / seen.length[0];
    const double phi = division_share(ratio, params.alpha);
    // Divided axes get the full width over n, the others half the semi-axis.
    const double h = std::clamp(
        natural.thickness * ratio * std::pow(1.0 / params.layers, phi) * std::pow(0.25, 1 - phi),
        params.h_min, h_max);
    natural.metric += seen.axis.col(k) * seen.axis.col(k).transpose() / (h * h);
  }
  return natural;
}

Result<NaturalField> NaturalDetector::field(const SimplexMesh<3>& mesh, const NaturalParams& params,
                                            const Progress& progress) const {
  if (const auto ok = check_params(params); !ok) return ok.error();
  if (impl_->locator.empty())
    return Error{Code::bad_input, "The body has no surface to measure its walls on.", ""};
  const std::size_t n = mesh.points.size();
  NaturalField field{MetricField<3>(n, Metric<3>::Identity()), std::vector<double>(n, 0.0),
                     std::vector<Vec<3>>(n, Vec<3>::UnitX())};
  const bool complete = parallel_each(
      n - 1, params.threads, progress,
      [&](std::size_t i) {
        const Natural natural = at(mesh.points[i + 1], params);
        field.metric[i + 1] = natural.metric;
        field.thickness[i + 1] = natural.thickness;
        field.direction[i + 1] = natural.direction;
      },
      16);
  if (!complete) return cancelled_error();
  return field;
}

MetricFunction<3> NaturalDetector::function(const NaturalParams& params) const {
  return [this, params](const Vec<3>& x) { return at(x, params).metric; };
}

}  // namespace lamella
