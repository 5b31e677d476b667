#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

#include "app/cli_commands.h"
#include "app/cli_common.h"
#include "app/cli_metric_field.h"
#include "app/services.h"
#include "core/base/freed_memory.h"
#include "core/io/facet_sides.h"
#include "core/mesh/interfaces.h"
#include "core/mesh/quality.h"
#include "core/metric/analytic.h"
#include "core/metric/intersect.h"
#include "core/optimize/adapt.h"
#include "core/optimize/background_metric.h"
#include "core/optimize/boundary_model.h"
#include "core/optimize/metric_conditioning.h"

namespace lamella::cli {

namespace {

namespace fs = std::filesystem;

MetricMean mean_called(const std::string& name) {
  static const std::map<std::string, MetricMean> kMeans = {{"m", MetricMean::m},
                                                           {"root", MetricMean::root},
                                                           {"size", MetricMean::size},
                                                           {"log", MetricMean::log},
                                                           {"h", MetricMean::h}};
  return kMeans.at(name);
}

/// Ids of the names asked, each once.
Result<std::vector<std::int32_t>> ids_of(const std::vector<std::string>& asked,
                                         const std::vector<std::string>& known,
                                         const std::string& what) {
  std::vector<std::int32_t> ids;
  for (const std::string& name : asked) {
    const auto at = std::find(known.begin(), known.end(), name);
    if (at == known.end()) {
      std::string listed;
      for (const std::string& k : known) listed += (listed.empty() ? "\"" : ", \"") + k + "\"";
      return Error{Code::usage, "The mesh has no " + what + " called \"" + name + "\".",
                   "It has: " + listed + "."};
    }
    ids.push_back(static_cast<std::int32_t>(at - known.begin()));
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

template <int D>
Result<AdaptParams> params_of(const AdaptCommand& c, const SimplexMesh<D>& mesh) {
  AdaptParams p;
  p.mean = mean_called(c.mean);
  p.element_mean = mean_called(c.element_mean);
  p.size_average = c.size_average == "l1" ? SizeAverage::l1 : SizeAverage::l2;
  p.chord_tolerance = c.chord_tolerance;
  if (c.sweeps) p.sweeps = *c.sweeps;
  if (c.threads) p.threads = *c.threads;
  p.memory_limit = c.memory;
  p.treat_blocking = c.split_blocking;
  p.seed = c.seed;
  Result<std::vector<std::int32_t>> groups = ids_of(c.freeze_groups, mesh.groups, "boundary group");
  if (!groups) return groups.error();
  p.frozen_groups = std::move(*groups);
  Result<std::vector<std::int32_t>> bodies = ids_of(c.freeze_bodies, mesh.bodies, "body");
  if (!bodies) return bodies.error();
  p.frozen_bodies = std::move(*bodies);
  return p;
}

ConditionParams conditions_of(const AdaptCommand& c) {
  ConditionParams p;
  p.h_min = c.h_min;
  p.h_max = c.h_max;
  p.max_anisotropy = c.max_anisotropy;
  p.gradation = c.gradation;
  p.gradation_kind =
      c.gradation_kind == "isotropic" ? GradationKind::isotropic : GradationKind::intersection;
  p.elements = c.elements;
  if (c.threads) p.threads = *c.threads;
  return p;
}

void tell_conditioning(const ConditionReport& r, const ConditionParams& params, int iteration,
                       Console& console) {
  Json steps = Json::array();
  for (const ConditionStep& s : r.steps) {
    char line[300];
    std::snprintf(
        line, sizeof line,
        "    %-10s %10s nodes, sizes by %.3g (mean %.3g), anisotropy lost %.3g (mean kept "
        "%.3g), elements %.4g -> %.4g%s",
        step_name(s.kind), grouped(s.nodes).c_str(), s.size_largest, s.size_mean, s.anisotropy_lost,
        s.anisotropy_mean, s.elements_before, s.elements_after, s.settled ? "" : ", not settled");
    console.say(line);
    Json step = {{"step", step_name(s.kind)},
                 {"nodes", s.nodes},
                 {"size_largest", s.size_largest},
                 {"size_mean", s.size_mean},
                 {"anisotropy_lost", s.anisotropy_lost},
                 {"anisotropy_mean", s.anisotropy_mean},
                 {"elements_before", s.elements_before},
                 {"elements_after", s.elements_after}};
    if (s.kind == ConditionStep::Kind::gradation) {
      step["sweeps"] = s.sweeps;
      step["settled"] = s.settled;
    }
    steps.push_back(std::move(step));
  }
  if (!r.elements_reached)
    console.say("    the bounds leave no way to " + short_number(*params.elements, 6) +
                " elements: the metric asks for " + short_number(r.elements_after, 6));
  console.emit(dump({{"phase", "conditioning"},
                     {"iteration", iteration},
                     {"scale", r.scale},
                     {"elements_before", r.elements_before},
                     {"elements_after", r.elements_after},
                     {"elements_reached", r.elements_reached},
                     {"steps", steps}}));
}

/// The metric that is asked of each adaption: where it comes from, and its conditioning.
template <int D>
class AskedMetric {
 public:
  AskedMetric(const AdaptCommand& command, Console& console)
      : command_(command), console_(console), conditions_(conditions_of(command)) {}

  /// Reads or parses it; a nodal metric is conditioned here, once, on the mesh it came with.
  Result<void> start(const SimplexMesh<D>& mesh, MetricField<D>&& given, const Progress& progress) {
    nodal_ = std::move(given);
    if (nodal_.empty()) {
      Result<MetricField<D>> metric = metric_of<D>(mesh, command_.sol, command_.metric, &analytic_);
      if (!metric) return metric.error();
      nodal_ = std::move(*metric);
    }
    if (analytic_) return {};
    if (conditions_.any()) {
      Result<Conditioned<D>> r = condition_metric<D>(mesh, nodal_, conditions_, progress);
      if (!r) return r.error();
      tell_conditioning(r->report, conditions_, 1, console_);
      nodal_ = std::move(r->metric);
    }
    if (!command_.background) return {};
    Result<MetricFunction<D>> background =
        background_metric<D>(mesh, nodal_, mean_called(command_.mean), progress);
    if (!background) return background.error();
    function_ = std::move(*background);
    return {};
  }

  /// Makes it ready for the next adaption: an analytic metric is conditioned anew on each mesh.
  Result<void> prepare(Adapted<D>& current, int iteration, const Progress& progress) {
    const SimplexMesh<D>& mesh = current.mesh;
    if (!analytic_) return {};
    if (!conditions_.any()) {
      function_ = analytic_;
      return {};
    }
    Result<Conditioned<D>> r =
        condition_metric<D>(mesh, sample_metric<D>(analytic_, mesh.points), conditions_, progress);
    if (!r) return r.error();
    tell_conditioning(r->report, conditions_, iteration, console_);
    current.metric = std::move(r->metric);
    // Bounds hold anywhere; the gradation is known on the mesh only, which may miss what the
    // analytic metric asks between the nodes: both count.
    const MetricFunction<D> bounded = [f = analytic_, p = conditions_,
                                       s = r->report.scale](const Vec<D>& x) {
      return bounded_metric<D>(f(x), p, s);
    };
    function_ = bounded;
    if (!conditions_.gradation) return {};
    Result<MetricFunction<D>> graded =
        background_metric<D>(mesh, current.metric, mean_called(command_.mean), progress);
    if (!graded) return graded.error();
    function_ = [bounded, g = std::move(*graded)](const Vec<D>& x) {
      return intersect<D>(g(x), bounded(x));
    };
    return {};
  }

  const MetricFunction<D>& function() const { return function_; }
  /// At the nodes of the first mesh.
  const MetricField<D>& nodal() const { return nodal_; }

 private:
  const AdaptCommand& command_;
  Console& console_;
  ConditionParams conditions_;
  MetricFunction<D> analytic_;  ///< empty for a nodal metric
  MetricFunction<D> function_;  ///< what `adapt` asks; empty: the metric is carried along
  MetricField<D> nodal_;
};

void tell_iteration(int i, const CheckReport& check, const AdaptReport& r, Console& console) {
  char line[240];
  std::snprintf(line, sizeof line,
                "%3d %10s nodes %10s elements   quality mean %.3f worst %.3f   unit edges %.1f %%",
                i, grouped(check.mesh.nodes).c_str(), grouped(check.mesh.elements).c_str(),
                check.quality.mean, check.quality.min, 100 * check.unit_edges);
  console.say(line);
  std::snprintf(line, sizeof line, "    %s splits, %s collapses, %s swaps, %s moves in %d sweeps%s",
                grouped(r.splits).c_str(), grouped(r.collapses).c_str(), grouped(r.swaps).c_str(),
                grouped(r.moves).c_str(), r.sweeps, r.settled ? ", settled" : "");
  console.say(line);
  if (r.blocking > 0)
    console.say("    " + grouped(r.blocking) + " blocking faces, " + grouped(r.blocking_treated) +
                " opened");
  Json json = report_json(check, true);
  json["phase"] = "iteration";
  json["iteration"] = i;
  json["adaption"] = {{"splits", r.splits},
                      {"collapses", r.collapses},
                      {"swaps", r.swaps},
                      {"moves", r.moves},
                      {"sweeps", r.sweeps},
                      {"settled", r.settled},
                      {"forecast_nodes", r.forecast_nodes},
                      {"forecast_memory", r.forecast_memory},
                      {"blocking", r.blocking},
                      {"blocking_treated", r.blocking_treated}};
  console.emit(dump(json));
}

ReferenceSurface<3> walls_of(const SimplexMesh<3>& mesh) {
  const SimplexMesh<3> whole = with_interfaces(mesh);
  ReferenceSurface<3> walls;
  walls.points = whole.points;
  walls.facets.assign(whole.facets.begin(), whole.facets.end());
  return walls;
}

/// How far the boundary and the interfaces moved from those of the mesh given.
Result<void> tell_boundary(const SimplexMesh<3>& before, const SimplexMesh<3>& after, int threads,
                           const Progress& progress, Console& console) {
  const ReferenceSurface<3> from = walls_of(before), to = walls_of(after);
  Result<FarthestPoint> there = farthest_point(to, from, 0, threads, progress.portion(0, 0.5));
  if (!there) return there.error();
  Result<FarthestPoint> back = farthest_point(from, to, 0, threads, progress.portion(0.5, 1));
  if (!back) return back.error();
  const auto place = [](const Vec<3>& x) {
    return "(" + short_number(x[0], 4) + ", " + short_number(x[1], 4) + ", " +
           short_number(x[2], 4) + ")";
  };
  console.say("boundary within " + short_number(there->distance, 3) + " mm of the mesh given, at " +
              place(there->place) + "; its boundary within " + short_number(back->distance, 3) +
              " mm of the new one, at " + place(back->place));
  console.emit(dump({{"phase", "boundary"},
                     {"boundary_to_given", farthest_json(*there)},
                     {"given_to_boundary", farthest_json(*back)}}));
  return {};
}

/// Other programs need not list the boundary: what is missing becomes the group "unnamed".
void tell_boundary_listed(SimplexMesh<3>& mesh, Console& console) {
  const std::size_t before = mesh.facets.size();
  list_boundary(mesh);
  if (mesh.facets.size() > before)
    console.say(grouped(mesh.facets.size() - before) +
                " boundary faces are in no group of the file: they are \"unnamed\"");
}

/// Whether the .sol that goes with a .mesh written is the one read, for another mesh.
bool overwrites_metric(const AdaptCommand& c) {
  const auto same = [](const fs::path& a, const fs::path& b) {
    std::error_code ec;
    return fs::equivalent(a, b, ec);
  };
  const fs::path output = c.output;
  return !c.sol.empty() && names_medit(output) && !same(output, c.mesh) &&
         same(fs::path(output).replace_extension(".sol"), c.sol);
}

/// What the boundary is held to through all iterations: the mesh given. Where it has borders
/// between bodies, which follow the mesh at hand, each iteration gets its share of the tolerance
/// instead.
template <int D>
class FirstBoundary {
 public:
  FirstBoundary(SimplexMesh<D>& mesh, AdaptParams& params, int iterations) {
    if (iterations < 2) return;
    if constexpr (D < 4) {
      if (mesh.bodies.size() < 2) {
        surface_ = own_surface<D>(mesh, params.feature_angle);
        for (std::size_t f = 0; f < mesh.facets.size(); ++f)
          face_[surface_->facet_face[f]] = mesh.facet_face[f];
        mesh.facet_face = surface_->facet_face;
        return;
      }
      Eigen::AlignedBox<double, D> box;
      for (std::size_t v = 1; v < mesh.points.size(); ++v) box.extend(mesh.points[v]);
      params.chord_tolerance =
          params.chord_tolerance.value_or(1e-3 * box.diagonal().norm()) / iterations;
    }
  }

  const ReferenceSurface<D>* surface() const { return surface_ ? &*surface_ : nullptr; }
  /// The faces as the mesh given numbers them.
  void restore_faces(SimplexMesh<D>& mesh) const {
    if (!surface_) return;
    for (std::int32_t& face : mesh.facet_face)
      if (const auto known = face_.find(face); known != face_.end()) face = known->second;
  }

 private:
  std::optional<ReferenceSurface<D>> surface_;
  std::map<std::int32_t, std::int32_t> face_;  // [patch]
};

template <int D>
int adapt_mesh(const SimplexMesh<D>& mesh, MetricField<D>&& given, const AdaptCommand& c,
               Console& console) {
  const Progress progress = console.progress();
  if (Result<void> known = check_output_name(c.output, D); !known)
    return console.fail(known.error());
  if (overwrites_metric(c))
    return console.fail({Code::usage,
                         "\"" + c.output + "\" keeps its metric in \"" + c.sol +
                             "\", which is read and would be lost.",
                         "Give the output another name."});
  Result<AdaptParams> params = params_of<D>(c, mesh);
  if (!params) return console.fail(params.error());
  AskedMetric<D> asked(c, console);
  if (Result<void> done = asked.start(mesh, std::move(given), progress.portion(0, 0)); !done)
    return console.fail(done.error());

  Adapted<D> current{mesh, asked.nodal(), {}};
  const FirstBoundary<D> first(current.mesh, *params, c.iterations);
  int adapted = 0;
  bool cancelled = false;
  while (adapted < c.iterations && !cancelled) {
    const int i = adapted + 1;
    const Progress round = progress.portion((i - 1.0) / c.iterations, 1.0 * i / c.iterations,
                                            "adaption " + std::to_string(i));
    Result<void> ready = asked.prepare(current, i, round.portion(0, 0.05));
    const MetricFunction<D> at = asked.function();
    Result<Adapted<D>> next = ready
                                  ? adapt<D>(current.mesh, at ? MetricField<D>{} : current.metric,
                                             first.surface(), *params, round.portion(0.05, 0.9), at)
                                  : Result<Adapted<D>>(ready.error());
    if (!next) {
      if (next.error().code != Code::cancelled || adapted == 0) return console.fail(next.error());
      cancelled = true;
      break;
    }
    current = std::move(*next);
    give_back_freed_memory();
    ++adapted;
    cancelled = current.report.cancelled;
    // The field that was transported drifts; a function is known exactly at the new nodes.
    if (asked.function()) current.metric = sample_metric<D>(asked.function(), current.mesh.points);
    // A cancelled mesh is told about all the same.
    Result<CheckReport> report =
        check<D>(current.mesh, current.metric, cancelled ? Progress{} : round.portion(0.9, 1));
    if (!report) {
      if (report.error().code != Code::cancelled) return console.fail(report.error());
      cancelled = true;
      break;
    }
    tell_iteration(i, *report, current.report, console);
  }
  first.restore_faces(current.mesh);
  if constexpr (D == 3) {
    if (!cancelled) {
      const Result<void> told =
          tell_boundary(mesh, current.mesh, params->threads, progress.portion(1, 1), console);
      if (!told && told.error().code != Code::cancelled) return console.fail(told.error());
      cancelled = !told.ok();
    }
  }
  if (Result<void> done =
          write_any<D>(c.output, std::move(current.mesh), std::move(current.metric));
      !done)
    return console.fail(done.error());
  console.say("wrote " + c.output);
  console.emit(dump({{"phase", "written"}, {"file", c.output}}));
  if (cancelled)
    return console.fail({Code::cancelled, "Cancelled; the mesh as far as it got was written.", ""});
  return 0;
}

}  // namespace

int run_adapt(const AdaptCommand& c, Console& console) {
  if (c.sol.empty() && c.metric.empty()) {
    Result<MeshContent> content = read_content(c.mesh, console.progress().portion(0, 0));
    if (!content) return console.fail(of_input(content.error()));
    Result<MetricField<3>> metric = metric_in_file(*content, c.field);
    if (!metric) return console.fail(metric.error());
    tell_boundary_listed(content->mesh, console);
    return adapt_mesh<3>(content->mesh, std::move(*metric), c, console);
  }
  Result<AnyMesh> mesh = read_any(c.mesh, nullptr, console.progress().portion(0, 0));
  if (!mesh) return console.fail(of_input(mesh.error()));
  if (auto* solid = std::get_if<SimplexMesh<3>>(&*mesh)) tell_boundary_listed(*solid, console);
  return std::visit(
      [&]<int D>(const SimplexMesh<D>& m) {
        return adapt_mesh<D>(m, MetricField<D>{}, c, console);
      },
      *mesh);
}

}  // namespace lamella::cli
