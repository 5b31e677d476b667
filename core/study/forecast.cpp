#include "core/study/forecast.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>

#include "core/natural/natural_metric.h"
#include "core/natural/spread_metric.h"
#include "core/study/first_mesh.h"
#include "core/study/flow_round.h"
#include "core/study/request.h"

namespace lamella {
namespace {

/// Bytes a node takes at the most while the flow is solved (measured, rounded up).
constexpr double kFlowBytesANode = 3000;
/// The same of a facet while it is filled (a ribbed tray of 72,000 triangles: 740 and 3,100).
constexpr double kGenerateBytesAFacet = 1000, kNetgenBytesAFacet = 4000;

/// What was asked so far, from any thread.
class Asked {
 public:
  const Metric<3>* find(const Vec<3>& x) const {
    const std::scoped_lock lock(mutex_);
    const auto at = metrics_.find(key(x));
    return at == metrics_.end() ? nullptr : &at->second;
  }
  Metric<3> keep(const Vec<3>& x, const Metric<3>& metric) {
    const std::scoped_lock lock(mutex_);
    return metrics_.emplace(key(x), metric).first->second;
  }
  SpreadMetric spread(int threads, const Progress& progress) const {
    std::vector<Vec<3>> points{Vec<3>::Zero()};
    MetricField<3> metrics{Metric<3>::Identity()};
    for (const auto& [x, metric] : metrics_) {
      points.emplace_back(x[0], x[1], x[2]);
      metrics.push_back(metric);
    }
    return SpreadMetric::from(points, metrics, {.threads = threads}, progress);
  }

 private:
  static std::array<double, 3> key(const Vec<3>& x) { return {x[0], x[1], x[2]}; }

  mutable std::mutex mutex_;
  std::map<std::array<double, 3>, Metric<3>> metrics_;
};

}  // namespace

double flow_memory(double nodes) { return 1e-6 * kFlowBytesANode * nodes; }

double first_mesh_memory(std::size_t facets, bool by_netgen) {
  return 1e-6 * (by_netgen ? kNetgenBytesAFacet : kGenerateBytesAFacet) *
         static_cast<double>(facets);
}

Result<void> within_memory(const std::string& what, double needed, std::optional<double> allowed,
                           const std::string& hint) {
  if (!allowed || needed <= *allowed) return {};
  const auto whole = [](double x) { return std::to_string(std::llround(std::ceil(x))); };
  return Error{Code::memory,
               what + " " + whole(needed) + " MB are to be expected, above the " + whole(*allowed) +
                   " MB allowed.",
               hint};
}

std::optional<FlowForecast> forecast_flow(const Study& study, const std::string& body,
                                          const MeshForecast& mesh) {
  if (!has_flow(study, body)) return std::nullopt;
  FlowForecast out;
  const bool solved = !study.flow->field;
  out.solves = solved ? study.flow->rounds + 1 : 0;
  const double growth = study.flow->rounds > 0 ? study.flow->growth : 1;
  out.mesh.elements = growth * mesh.elements;
  out.mesh.nodes = growth * mesh.nodes;
  out.mesh.memory = std::max(growth * mesh.memory, solved ? flow_memory(out.mesh.nodes) : 0);
  return out;
}

Result<SizingForecast> forecast_body(const Study& study, const SimplexMesh<3>& first,
                                     const MetricFunction<3>& natural, const ChordField& chords,
                                     const SizingField& sizing, const Progress& progress) {
  ForecastParams params;
  params.threads = study.options.threads;
  // Where sizes change is not known before the metric was asked all over the body.
  Asked asked;
  const auto alone = [&](const Vec<3>& x) -> Metric<3> {
    if (const Metric<3>* known = asked.find(x)) return *known;
    return asked.keep(x, chords.at(kWantedLayers * kWantedLayers * natural(x), x));
  };
  const Result<SizingForecast> unspread =
      forecast_mesh(first, alone, sizing, params, progress.portion(0, 0.7));
  if (!unspread) return unspread.error();
  const SpreadMetric spread = asked.spread(study.options.threads, progress.portion(0.7, 0.75));
  return forecast_mesh(
      first, [&](const Vec<3>& x) { return spread.at(alone(x), x); }, sizing, params,
      progress.portion(0.75, 1));
}

Result<std::vector<FirstMesh>> first_meshes(
    const std::vector<Part>& parts, const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
    const Progress& progress) {
  std::vector<FirstMesh> meshes;
  const auto count = static_cast<double>(parts.size());
  for (const Part& part : parts) {
    const auto at = static_cast<double>(meshes.size());
    Result<FirstMesh> first =
        first_mesh(part, meshers, progress.portion(at / count, (at + 1) / count, "first mesh"));
    if (!first) return first.error();
    meshes.push_back(std::move(*first));
  }
  return meshes;
}

Result<std::vector<BodyForecast>> forecast_from(const std::vector<FirstMesh>& first,
                                                const Study& study, const std::vector<Part>& parts,
                                                const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  if (Result<void> good = check_request(study, parts); !good) return good.error();
  std::vector<BodyForecast> bodies;
  const auto count = static_cast<double>(parts.size());
  for (const Part& part : parts) {
    const std::size_t b = bodies.size();
    const auto at = static_cast<double>(b);
    Result<SizingField> sizing = SizingField::make(sizing_of(study, part.name), part.surface);
    if (!sizing) return sizing.error();
    const auto start = Clock::now();
    const NaturalDetector detector(part.surface);
    const NaturalParams natural = natural_params(study, part);
    const Progress own = progress.portion(at / count, (at + 1) / count);
    const auto chords = chords_of(study, part, own.portion(0, 0.2));
    Result<SizingForecast> mesh = forecast_body(
        study, first[b].mesh, [&](const Vec<3>& x) { return detector.at(x, natural).metric; },
        *chords, *sizing, own.portion(0.2, 1));
    if (!mesh) return mesh.error();
    bodies.push_back({part.name, *mesh, forecast_flow(study, part.name, mesh->corrected),
                      std::chrono::duration<double>(Clock::now() - start).count()});
  }
  return bodies;
}

Result<std::vector<BodyForecast>> forecast_study(
    const Study& study, const std::vector<Part>& parts,
    const std::vector<std::shared_ptr<const VolumeMesher>>& meshers, const Progress& progress) {
  if (Result<void> good = check_request(study, parts); !good) return good.error();
  if (study.domain)
    return Error{Code::usage, "One mesh of all bodies cannot be forecast.",
                 "Run one iteration, or leave the domain out: a mesh a body can be."};
  Result<std::vector<FirstMesh>> first = first_meshes(parts, meshers, progress.portion(0, 0.7));
  if (!first) return first.error();
  return forecast_from(*first, study, parts, progress.portion(0.7, 1));
}

}  // namespace lamella
