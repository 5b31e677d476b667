#include "core/natural/natural_metric.h"

#include <limits>

#include "core/base/parallel.h"
#include "core/geometry/locator.h"
#include "core/metric/intersect.h"
#include "core/natural/ellipsoid_fit.h"
#include "core/natural/medial_ball.h"

namespace lamella {
namespace {

/// 1 up to the ratio `full`, 0 from twice that, linear in log between.
double share_up_to(double full, double ratio) {
  return std::clamp(1 - std::log(ratio / full) / std::log(2.0), 0.0, 1.0);
}

/// By what the full width along an axis is divided, (4.68) and section 4.4.3, when it is `ratio`
/// times as long as the shortest. An axis that is not divided gets half its semi-axis.
double divisor(const NaturalParams& p, double ratio) {
  const double first = share_up_to(1 + p.alpha, ratio);
  const double second = p.layers2 ? share_up_to(1 + p.alpha + p.alpha2, ratio) : 0;
  const double n2 = p.layers2.value_or(1), n3 = p.layers3.value_or(4);
  return std::pow(p.layers, first) *
         std::pow(std::pow(n2, second) * std::pow(n3, 1 - second), 1 - first);
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
  const double h_max = params.h_max > 0 ? params.h_max : impl_->locator.diagonal();
  Natural natural;
  natural.thickness = std::numeric_limits<double>::infinity();
  for (const MedialBall& ball : medial_balls(impl_->locator, x)) {
    const SeenAxes seen = EllipsoidFit::at(impl_->locator, ball.center, ball.radius, ball.across);
    const double thickness = 2 * ball.radius;
    Metric<3> metric = Metric<3>::Zero();
    double longest = h_max;
    for (int k = 0; k < 3; ++k) {
      const double ratio = seen.length[k] / seen.length[0];
      const double h =
          std::clamp(thickness * ratio / divisor(params, ratio), params.h_min, longest);
      // Axes come from the shortest on.
      if (k == 0 && params.max_anisotropy > 0) longest = std::min(h_max, params.max_anisotropy * h);
      metric += seen.axis.col(k) * seen.axis.col(k).transpose() / (h * h);
    }
    // Walls that meet at a re-entrant edge all get their layers there.
    const bool first = !std::isfinite(natural.thickness);
    natural.metric = first ? metric : intersect<3>(natural.metric, metric);
    if (thickness >= natural.thickness) continue;
    natural.thickness = thickness;
    natural.direction = seen.axis.col(0);
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
