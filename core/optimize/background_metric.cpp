#include "core/optimize/background_metric.h"

#include <cassert>

#include "core/base/parallel.h"
#include "core/mesh/element_locator.h"
#include "core/optimize/metric_carrier.h"

namespace lamella {
namespace {

template <int D>
struct Background {
  std::vector<typename SimplexMesh<D>::Element> elements;
  std::vector<Packed<D>> carried;  ///< [node]
  MetricCarrier<D> carrier;
  ElementLocator<D> locator;

  Metric<D> at(const Vec<D>& x) const {
    assert(x.allFinite());
    const Located<D> place = locator.locate(x);
    const auto& e = elements[place.element];
    Packed<D> sum = Packed<D>::zero();
    for (int k = 0; k <= D; ++k) sum.add(place.weights[k], carried[e[k]]);
    return carrier.metric(sum).full();
  }
};

}  // namespace

template <int D>
Result<MetricFunction<D>> background_metric(const SimplexMesh<D>& mesh,
                                            const MetricField<D>& metric, MetricMean mean,
                                            const Progress& progress) {
  if (mesh.elements.empty())
    return Error{Code::bad_input, "The background mesh has no elements.",
                 "Give the mesh that the metric was made on."};
  if (Result<void> good = check_metric<D>(metric, mesh.node_count()); !good) return good.error();

  const MetricCarrier<D> carrier(mean);
  std::vector<Packed<D>> carried(metric.size(), Packed<D>::zero());
  if (!parallel_each(metric.size() - 1, 0, progress.portion(0, 0.2), [&](std::size_t i) {
        carried[i + 1] = carrier.carry(Packed<D>::from(metric[i + 1]));
      }))
    return cancelled_error();
  auto background = std::make_shared<const Background<D>>(
      Background<D>{mesh.elements, std::move(carried), carrier,
                    ElementLocator<D>(mesh, progress.portion(0.2, 1))});
  if (progress.cancelled()) return cancelled_error();
  progress.report(1);
  return MetricFunction<D>([background](const Vec<D>& x) { return background->at(x); });
}

template Result<MetricFunction<2>> background_metric(const SimplexMesh<2>&, const MetricField<2>&,
                                                     MetricMean, const Progress&);
template Result<MetricFunction<3>> background_metric(const SimplexMesh<3>&, const MetricField<3>&,
                                                     MetricMean, const Progress&);
template Result<MetricFunction<4>> background_metric(const SimplexMesh<4>&, const MetricField<4>&,
                                                     MetricMean, const Progress&);

}  // namespace lamella
