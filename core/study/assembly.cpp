#include "core/study/assembly.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/base/parallel.h"
#include "core/mesh/interfaces.h"
#include "core/mesh/validate.h"
#include "core/metric/intersect.h"
#include "core/multidomain/balance.h"
#include "core/multidomain/chord_depth.h"
#include "core/multidomain/chord_metric.h"
#include "core/multidomain/exact_interface.h"
#include "core/multidomain/interface_cut.h"
#include "core/multidomain/interface_metric.h"
#include "core/optimize/adapt.h"
#include "core/study/assembly_members.h"
#include "core/study/join.h"
#include "core/study/measure.h"
#include "core/study/request.h"

namespace lamella {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFirstMeshShare = 0.1;  // of the progress
constexpr double kAskedScale = kAskedFiner * kAskedFiner;
constexpr double kSettledNodes = 0.03, kSettledError = 0.03;  // relative changes
constexpr int kReportDepth = 6;     // bisections for the figures that are reported
constexpr double kSlope = 1;        // growth of sizes across fuzzy borders with the distance
constexpr double kGrowth = 0.7;     // of a neighbor's sizes with the distance in its metric: ln 2
constexpr double kOffBorder = 0.8;  // of the tolerance, that nodes may leave borders for volumes
constexpr int kReturns = 4;  // times that nodes which left borders go back where it is too far

/// Regions of fuzzy interfaces are names of elements: nothing is to be held at their steps.
SimplexMesh<3> as_one_body(SimplexMesh<3> mesh) {
  mesh.bodies = {"domain"};
  std::fill(mesh.element_body.begin(), mesh.element_body.end(), 0);
  return mesh;
}

class AssemblyLoop {
 public:
  AssemblyLoop(const Study& study, const SolverField* field)
      : study_(study), options_(study.options), field_(field) {}

  Result<void> begin(const std::vector<Part>& parts,
                     const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                     const Progress& progress) {
    const auto start = Clock::now();
    Result<Assembly> laid = lay_out(study_, parts, meshers, progress.portion(0, 0.5, "first mesh"));
    if (!laid) return laid.error();
    SimplexMesh<3> first = std::move(laid->first);
    of_ = std::move(*laid);
    const bool asked = std::any_of(of_.members.begin(), of_.members.end(),
                                   [](const Member& m) { return m.interface_asked.has_value(); });
    at_borders_ = asked ? captured_at() : [this](const Vec<3>& x) { return natural_at(x); };
    return accept(std::move(first), start, progress.portion(0.5, 1));
  }

  /// Errors: cancelled; failed when there is no adapted mesh to fall back to. Later ones end the
  /// loop with a note.
  Result<void> step(const Progress& progress) {
    Result<void> done = exact_                                     ? step_exact(progress)
                        : options_.interfaces == Interfaces::exact ? step_cut(progress)
                                                                   : step_fuzzy(progress);
    if (done || done.error().code == Code::cancelled || records_.size() < 2) return done;
    of_.outcomes.front().notes.push_back("Iteration " + std::to_string(records_.size()) + ": " +
                                         done.error().message + " The mesh before it was kept.");
    failed_ = true;
    return {};
  }

  /// The flow through each body that has one. What cannot be solved is a note. Errors: cancelled.
  Result<void> solve_flow(const Progress& progress) {
    if (!exact_) {
      of_.outcomes.front().notes.push_back(who() + "only in a mesh with exact interfaces.");
      return {};
    }
    auto all = std::make_shared<FlowFields>();
    all->resize(current_.mesh.points.size(), current_.mesh.elements.size());
    for (std::size_t m = 0; m < of_.members.size(); ++m) {
      const std::string& name = of_.members[m].part.name;
      if (!flows(m)) continue;
      std::vector<NodeId> node;
      const SimplexMesh<3> body = extract_body(current_.mesh, of_.body_of[m], &node);
      const FlowMethod method = study_.flow->method;
      const Result<FlowFields> flow =
          field_ ? field_on(body, *field_, method, diagonal_of_nodes(current_.mesh),
                            options_.threads, share(m, progress))
                 : flow_through(body, flow_case_of(study_, name), method, options_.threads,
                                share(m, progress));
      if (!flow && flow.error().code == Code::cancelled) return flow.error();
      if (!flow) {
        std::vector<std::string>& notes = of_.outcomes[m].notes;
        const std::string note = who() + flow.error().message;
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
        continue;
      }
      all->put(*flow, node, elements_of(m));
    }
    if (all->openings.empty() && all->components == 0) return {};
    records_.back().flow_rate = all->rate();
    records_.back().flow_pressure = all->highest_pressure();
    current_.flow = std::move(all);
    return {};
  }

  /// One round: the metric of each body corrected by its flow, and the mesh adapted to it.
  /// Errors: as `step`.
  Result<void> flow_step(const Progress& progress) {
    if (!current_.flow) return {};
    for (std::size_t m = 0; m < of_.members.size(); ++m) {
      if (!flows(m)) continue;
      if (Result<void> corrected = correct_by_flow(m, share(m, progress.portion(0, 0.1)));
          !corrected)
        return corrected;
    }
    if (Result<void> stepped = step(progress.portion(0.1, 0.7)); !stepped || failed_)
      return stepped;
    return solve_flow(progress.portion(0.7, 1));
  }

  const MeshState& current() const { return current_; }
  const IterationRecord& last_record() const { return records_.back(); }
  bool settled() const { return settled_; }
  bool wants_flow() const {
    for (std::size_t m = 0; m < of_.members.size(); ++m)
      if (flows(m)) return true;
    return false;
  }
  bool failed() const { return failed_; }
  const StudyOverlaps& overlaps() const { return of_.overlaps; }
  bool converged() const {
    return settled_ && !failed_ &&
           std::all_of(of_.outcomes.begin(), of_.outcomes.end(), [&](const BodyOutcome& b) {
             return b.name == of_.members.back().part.name || b.layers.places == 0 ||
                    b.layers.mean >= b.layers_asked;
           });
  }

  /// Closes the books, the figures with a finer division at the borders than in the loop.
  Result<std::vector<BodyOutcome>> finish(const Progress& progress) {
    if (exact_ || of_.wall)
      if (Result<void> balanced = balance(progress); !balanced) return balanced.error();
    for (std::size_t m = 0; exact_ && m < of_.members.size(); ++m) {
      if (of_.body_of[m] < 0) continue;
      const SimplexMesh<3> body = extract_body(current_.mesh, of_.body_of[m]);
      if (!body.elements.empty()) of_.outcomes[m].mesh_volume = volume_of(body);
    }
    if (exact_) {
      std::vector<BodyOutcome> kept;
      for (std::size_t m = 0; m < of_.outcomes.size(); ++m)
        if (of_.body_of[m] >= 0) kept.push_back(of_.outcomes[m]);
      return kept;
    }
    FillingParams params;
    params.depth = kReportDepth;
    params.threads = options_.threads;
    Result<Filling> filling = filling_ratios<3>(current_.mesh, *of_.partition, params, progress);
    if (filling) count(filling_errors<3>(current_.mesh, *filling));
    if (of_.full) of_.outcomes.pop_back();
    return of_.outcomes;
  }

 private:
  static double volume_of(const SimplexMesh<3>& body) {
    double volume = 0;
    for (const auto& e : body.elements) volume += signed_measure<3>(body.corners(e));
    return volume;
  }

  /// The last touch to exact borders and to the wall, all that a mesh of fuzzy ones has: what was
  /// adapted again would go back onto them. Where that takes a body too far from its surface nodes
  /// go back at once. Qualities are those of the mesh that is handed out. Errors: cancelled.
  Result<void> balance(const Progress& progress) {
    if (std::exchange(balanced_, true)) return {};
    MeshState state = current_;
    const std::size_t moved =
        balance_borders(state.mesh, *of_.partition, first_face_,
                        {kOffBorder * of_.mesh_tolerance, of_.mesh_tolerance, of_.domain.get(),
                         options_.threads, &state.metric, border_depths()},
                        progress);
    for (int i = 0; exact_; ++i) {
      Result<std::vector<Vec<3>>> far =
          of_.measure_distances(state.mesh, options_.threads, progress);
      if (!far) return far.error();
      if (i == kReturns || !put_back(state.mesh, current_.mesh.points, *far, of_.chord_tolerance))
        break;
    }
    const Result<bool> eased =
        exact_ ? of_.ease(state.mesh, state.metric, options_.threads, progress) : false;
    if (!eased) return eased.error();
    if (moved == 0 && !*eased) return {};
    if (!validate<3>(state.mesh).ok()) {
      if (!exact_) return {};
      const auto before = of_.measure_distances(current_.mesh, options_.threads, progress);
      return before ? Result<void>{} : before.error();
    }
    const Result<IterationRecord> measured = measure(state, progress);
    if (!measured) return measured.error();
    IterationRecord& last = records_.back();
    last.volume = measured->volume;
    last.quality_mean = measured->quality_mean;
    last.quality_min = measured->quality_min;
    last.conformity = measured->conformity;
    last.unit_edges = measured->unit_edges;
    for (BodyOutcome& body : of_.outcomes) body.records.back() = last;
    current_ = std::move(state);
    return {};
  }

  /// [CAD face] of the triangles of parts below the shape they stand for; zones are exact.
  std::vector<double> border_depths() const {
    std::vector<double> all;
    for (std::size_t m = 0; m < first_face_.size(); ++m) {
      const Part& part = of_.members[m].part;
      if (std::any_of(study_.zones.begin(), study_.zones.end(),
                      [&](const StudyZone& z) { return z.name == part.name; }))
        continue;
      const std::vector<double> own = chord_depths(part.surface, part.cad_volume);
      const auto from = static_cast<std::size_t>(first_face_[m]);
      if (all.size() < from + own.size()) all.resize(from + own.size(), 0);
      std::copy(own.begin(), own.end(), all.begin() + static_cast<std::ptrdiff_t>(from));
    }
    return all;
  }

  bool flows(std::size_t m) const {
    return of_.body_of[m] >= 0 && has_flow(study_, of_.members[m].part.name);
  }
  Progress share(std::size_t m, const Progress& progress) const {
    const auto count = static_cast<double>(of_.members.size()), at = static_cast<double>(m);
    return progress.portion(at / count, (at + 1) / count);
  }

  /// What notes of the flow begin with.
  std::string who() const { return field_ ? "Solver's field: " : "Flow: "; }

  /// Of the body of a region in the current mesh.
  std::vector<std::size_t> elements_of(std::size_t m) const {
    std::vector<std::size_t> elements;
    for (std::size_t e = 0; e < current_.mesh.elements.size(); ++e)
      if (current_.mesh.element_body[e] == of_.body_of[m]) elements.push_back(e);
    return elements;
  }

  Result<void> correct_by_flow(std::size_t m, const Progress& progress) {
    Member& member = of_.members[m];
    std::vector<NodeId> node;
    const SimplexMesh<3> body = extract_body(current_.mesh, of_.body_of[m], &node);
    const FlowFields flow = current_.flow->of(node, elements_of(m));
    // A body that the field does not lie on.
    if (field_ && !(flow.mean_indicator() > 0)) return {};
    MetricField<3> natural(body.points.size(), Metric<3>::Identity());
    const auto ask = [&](std::size_t i) {
      const Vec<3>& x = body.points[i + 1];
      natural[i + 1] = member.sizing.apply(
          x, learnt_from(member, x, member.detector->at(x, member.natural).metric));
    };
    if (!parallel_each(body.node_count(), options_.threads, progress.portion(0, 0.5), ask))
      return cancelled_error();
    Result<FlowCorrection> made = flow_correction(body, natural, flow, *study_.flow, member.of_flow,
                                                  flow_h_min(study_, member.natural.h_min),
                                                  options_.threads, progress.portion(0.5, 1));
    if (!made) return made.error();
    member.of_flow = std::move(made->field);
    char text[120];
    std::snprintf(text, sizeof text,
                  "Corrected by the %s: %.4g instead of %.4g elements asked for.",
                  field_ ? "solver's field" : "flow", made->elements_after, made->elements_before);
    of_.outcomes[m].notes.emplace_back(text);
    return {};
  }

  AdaptParams adapt_params() const {
    AdaptParams params;
    params.chord_tolerance = of_.mesh_tolerance;
    params.seed = options_.seed;
    params.threads = options_.threads;
    params.memory_limit = options_.memory;
    return params;
  }

  /// What is asked where the faces of the mesh are the borders: edges along them are chords.
  Metric<3> exact_at(const Vec<3>& x) const {
    return chords_ ? chords_->at(at_borders_(x), x) : at_borders_(x);
  }
  MetricFunction<3> asked_exact() const {
    return [this](const Vec<3>& x) -> Metric<3> { return exact_at(x) * kAskedScale; };
  }

  Result<void> step_fuzzy(const Progress& progress) {
    const auto start = Clock::now();
    MetricFunction<3> asked_at;
    if (options_.capture == Capture::distance)
      asked_at = [captured = captured_at()](const Vec<3>& x) -> Metric<3> {
        return captured(x) * kAskedScale;
      };
    MetricField<3> asked;
    if (!asked_at) asked = current_.metric;
    for (Metric<3>& m : asked) m *= kAskedScale;
    Result<Adapted<3>> adapted = adapt<3>(as_one_body(current_.mesh), asked, wall(), adapt_params(),
                                          progress.portion(0, 0.7), asked_at);
    if (!adapted) return adapted.error();
    if (adapted->report.cancelled) return cancelled_error();
    if (Result<void> valid = validate<3>(adapted->mesh); !valid) return valid.error();
    return accept(std::move(adapted->mesh), start, progress.portion(0.7, 1));
  }

  /// From the first mesh to one that is cut along the borders.
  Result<void> step_cut(const Progress& progress) {
    const auto start = Clock::now();
    ExactParams exact;
    exact.adapt = adapt_params();
    exact.wall = wall();
    std::vector<ReferenceSurface<3>> surfaces;
    for (std::size_t m = 0; m + 1 < of_.members.size(); ++m) {
      surfaces.push_back(of_.borders_of(of_.members[m]));
      exact.chord_error.push_back(of_.members[m].part.chord_error);
    }
    Result<Exact> made =
        exact_interfaces(as_one_body(current_.mesh), {}, *of_.partition, surfaces, exact,
                         progress.portion(0, 0.7, "cutting along the borders"), asked_exact());
    if (!made) return made.error();
    if (made->adapt.cancelled) return cancelled_error();
    SimplexMesh<3> mesh = std::move(made->mesh);
    first_face_ = made->first_face;
    for (std::size_t m = 0; m < first_face_.size(); ++m)
      if (of_.members[m].groups) put_in_groups(*of_.members[m].groups, first_face_[m], mesh);
    for (int region = of_.partition->background(); region >= 0; --region)
      if (of_.body_of[region] < 0) mesh = drop_body<3>(mesh, region);
    name_walls(mesh);
    if (Result<void> valid = validate<3>(mesh); !valid) return valid.error();
    if (made->lost > 0)
      of_.outcomes.front().notes.push_back(std::to_string(made->lost) +
                                           " pieces of sharp edges could not be followed.");
    chords_ = std::move(made->chords);
    exact_ = std::make_unique<const ReferenceSurface<3>>(std::move(made->surface));
    Result<void> accepted = accept(std::move(mesh), start, progress.portion(0.7, 1));
    if (!accepted) exact_.reset();  // the mesh that stays is the first one
    return accepted;
  }

  Result<void> step_exact(const Progress& progress) {
    const auto start = Clock::now();
    Result<Adapted<3>> adapted = adapt<3>(current_.mesh, {}, exact_.get(), adapt_params(),
                                          progress.portion(0, 0.7), asked_exact());
    if (!adapted) return adapted.error();
    if (adapted->report.cancelled) return cancelled_error();
    if (Result<void> valid = validate<3>(adapted->mesh); !valid) return valid.error();
    return accept(std::move(adapted->mesh), start, progress.portion(0.7, 1));
  }

  struct InRegion {
    Metric<3> metric;
    /// The region is thinner there than what a mesh within the tolerance has to resolve: the slit
    /// between a hole and the screw in it, each with triangles of its own.
    bool closes;
  };
  InRegion natural_in(int region, const Vec<3>& x) const {
    const Member& member = of_.members[region];
    const auto found = member.detector->at(x, member.natural);
    const Metric<3> metric =
        member.sizing.apply(x, member.of_flow.apply(x, learnt_from(member, x, found.metric),
                                                    flow_h_min(study_, member.natural.h_min)));
    // Nothing is between cells.
    return {metric, !of_.full && found.thickness < shared_share * of_.mesh_tolerance};
  }
  static Metric<3> learnt_from(const Member& member, const Vec<3>& x, const Metric<3>& natural) {
    return member.correction.apply(x, natural, member.natural.h_min);
  }

  /// The natural metric of the region that x lies in, refined towards the sizes beyond its borders
  /// as they come near: M_b / (1 + l ln 2)^2 at the distance l in the metric of the neighbor.
  /// Regions ask for nothing where they close.
  Metric<3> natural_at(const Vec<3>& x) const {
    const int own = of_.partition->region_of(x);
    const InRegion here = natural_in(own, x);
    bool asks = !here.closes;
    Metric<3> metric = here.metric;
    const double beside = 0.1 * of_.mesh_tolerance;
    std::vector<Border<3>> near;
    of_.partition->borders(x, asks ? 3 * sizes<3>(metric)[0] / kGrowth : 2 * of_.mesh_tolerance,
                           near);
    for (const auto& [zone, border] : near) {
      const Vec<3> there = x + (border.distance + beside) * border.normal;
      const int other = of_.partition->region_of(there);
      if (other == own || (exact_ && of_.body_of[other] < 0)) continue;
      const auto [beyond, closes] = natural_in(other, there);
      if (closes) continue;
      const double length = border.distance * std::sqrt(border.normal.dot(beyond * border.normal));
      const Metric<3> from_there = beyond / std::pow(1 + kGrowth * length, 2);
      metric = asks ? intersect<3>(metric, from_there) : from_there;
      asks = true;
    }
    return metric;
  }

  /// What bounds a body towards a dropped one is its wall.
  void name_walls(SimplexMesh<3>& mesh) const {
    std::vector<std::string> groups;
    std::vector<std::int32_t> number;
    for (std::string name : mesh.groups) {
      for (std::size_t m = 0; m < of_.members.size(); ++m) {
        if (of_.body_of[m] >= 0) continue;
        const std::string& gone = of_.members[m].part.name;
        for (const Member& kept : of_.members)
          if (name == kept.part.name + "|" + gone || name == gone + "|" + kept.part.name)
            name = kept.part.name + " walls";
      }
      number.push_back(group_called(name, groups));
    }
    mesh.groups = std::move(groups);
    for (std::int32_t& group : mesh.facet_group) group = number[group];
  }

  /// Of a domain that is no box.
  const ReferenceSurface<3>* wall() const { return of_.wall ? &*of_.wall : nullptr; }

  std::vector<double> interface_sizes() const {
    std::vector<double> sizes;
    for (const Member& member : of_.members) sizes.push_back(member.interface_size);
    return sizes;
  }

  MetricFunction<3> captured_at() const {
    std::vector<std::optional<double>> asked;
    for (const Member& member : of_.members) asked.push_back(member.interface_asked);
    return interface_metric_at<3>(
        *of_.partition, [this](const Vec<3>& x) { return natural_at(x); }, std::move(asked),
        of_.border_share, kSlope);
  }

  /// Takes the mesh as the next state, with filling, metric, layers and record.
  Result<void> accept(SimplexMesh<3> mesh, Clock::time_point start, const Progress& progress) {
    MeshState next;
    next.mesh = std::move(mesh);
    if (exact_) return accept_exact(std::move(next), start, progress);
    FillingParams filling_params;
    filling_params.threads = options_.threads;
    Result<Filling> filling =
        filling_ratios<3>(next.mesh, *of_.partition, filling_params, progress.portion(0, 0.1));
    if (!filling) return filling.error();
    next.mesh.bodies = of_.partition->names();
    if (of_.full) next.mesh.bodies.pop_back();
    for (std::size_t e = 0; e < next.mesh.elements.size(); ++e)
      next.mesh.element_body[e] = filling->main_region(e);
    if (Result<void> asked = ask(next, *filling, progress.portion(0.1, 0.4)); !asked) return asked;
    Result<IterationRecord> record = measure(next, progress.portion(0.4, 0.5));
    if (!record) return record.error();
    count(filling_errors<3>(next.mesh, *filling));
    if (Result<void> measured = measure_bodies(next, progress.portion(0.5, 1)); !measured)
      return measured;
    record->mixed = filling->mixed_count();
    for (const BodyOutcome& body : of_.outcomes)
      record->interface_error = std::max(record->interface_error, body.interface_error);
    next.filling = std::make_shared<const Filling>(std::move(*filling));
    keep(std::move(next), *record, start);
    return {};
  }

  /// The same where every element belongs to one body.
  Result<void> accept_exact(MeshState next, Clock::time_point start, const Progress& progress) {
    next.metric.assign(next.mesh.points.size(), Metric<3>::Identity());
    next.thickness.assign(next.mesh.points.size(), 0);
    const auto at_node = [&](std::size_t i) {
      const Vec<3>& x = next.mesh.points[i + 1];
      const Member& member = of_.members[of_.partition->region_of(x)];
      next.metric[i + 1] = exact_at(x);
      next.thickness[i + 1] = member.detector->at(x, member.natural).thickness;
    };
    if (!parallel_each(next.mesh.node_count(), options_.threads, progress.portion(0, 0.3), at_node))
      return cancelled_error();
    Result<IterationRecord> record = measure(next, progress.portion(0.3, 0.4));
    if (!record) return record.error();
    next.layers.assign(next.mesh.points.size(), std::numeric_limits<double>::quiet_NaN());
    const std::size_t bodies = of_.members.size();
    for (std::size_t m = 0; m < bodies; ++m) {
      if (of_.body_of[m] < 0) continue;
      const double from = 0.4 + 0.6 * static_cast<double>(m) / static_cast<double>(bodies);
      const double to = 0.4 + 0.6 * static_cast<double>(m + 1) / static_cast<double>(bodies);
      if (Result<void> measured = measure_exact(m, next, progress.portion(from, to)); !measured)
        return measured;
    }
    keep(std::move(next), *record, start);
    return {};
  }

  /// Volume, layers and what is learnt from them, of the elements of one body.
  Result<void> measure_exact(std::size_t m, MeshState& state, const Progress& progress) {
    BodyOutcome& outcome = of_.outcomes[m];
    Member& member = of_.members[m];
    std::vector<NodeId> old_id;
    const SimplexMesh<3> body = extract_body(state.mesh, of_.body_of[m], &old_id);
    outcome.interface_error = 0;
    outcome.mesh_volume = volume_of(body);
    if (body.elements.empty()) return {};
    Result<Layers> layers = measure_layers(body, member.walls(), outcome.layers_asked,
                                           options_.threads, progress.portion(0, 0.7));
    if (!layers) return layers.error();
    outcome.layers = layers->stats;
    outcome.below = layers->below;
    state.below.insert(state.below.end(), layers->below.begin(), layers->below.end());
    for (std::size_t i = 1; i < old_id.size(); ++i)
      if (std::isfinite(layers->at_node[i])) state.layers[old_id[i]] = layers->at_node[i];
    if (!member.of_flow.empty()) return {};  // it asks for more than layers
    Result<LayerCorrection> learnt = LayerCorrection::learn(
        member.correction, body, layers->at_node, kWantedLayers * outcome.layers_asked,
        options_.threads, progress.portion(0.7, 1));
    if (!learnt) return learnt.error();
    member.correction = std::move(*learnt);
    return {};
  }

  void keep(MeshState next, IterationRecord record, Clock::time_point start) {
    record.iteration = static_cast<int>(records_.size());
    std::vector<const LayerStats*> layers;  // of the bodies, not of what is around them
    for (std::size_t m = 0; m + 1 < of_.outcomes.size(); ++m)
      layers.push_back(&of_.outcomes[m].layers);
    record.layers = join(layers);
    record.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const auto change = [](double a, double b) { return std::abs(a - b) / std::max(b, 1e-300); };
    // What the flow asks for is more than what has settled.
    const bool corrected = std::any_of(of_.members.begin(), of_.members.end(),
                                       [](const Member& m) { return !m.of_flow.empty(); });
    if (!corrected) settled_ = false;
    // Fuzzy and exact interfaces cannot be compared.
    if (!corrected && record.iteration > 1 && (record.mixed > 0) == (records_.back().mixed > 0)) {
      const IterationRecord& before = records_.back();
      const double nodes =
          change(static_cast<double>(record.nodes), static_cast<double>(before.nodes));
      const double error =
          record.mixed > 0 ? change(record.interface_error, before.interface_error) : 0;
      settled_ = nodes < kSettledNodes && error < kSettledError &&
                 (exact_ != nullptr) == (options_.interfaces == Interfaces::exact);
    }
    current_ = std::move(next);
    records_.push_back(record);
    for (BodyOutcome& body : of_.outcomes) body.records.push_back(record);
  }

  /// The metric asked and the wall thickness at the nodes.
  Result<void> ask(MeshState& state, const Filling& filling, const Progress& progress) const {
    const std::size_t count = state.mesh.points.size();
    state.metric.assign(count, Metric<3>::Identity());
    state.thickness.assign(count, 0);
    const bool by_distance = options_.capture == Capture::distance;
    const MetricFunction<3> captured = captured_at();
    const auto at_node = [&](std::size_t i) {
      const Vec<3>& x = state.mesh.points[i + 1];
      const Member& member = of_.members[of_.partition->region_of(x)];
      const Natural natural = member.detector->at(x, member.natural);
      state.thickness[i + 1] = natural.thickness;
      state.metric[i + 1] = by_distance ? captured(x) : member.sizing.apply(x, natural.metric);
    };
    if (!parallel_each(count - 1, options_.threads, progress, at_node)) return cancelled_error();
    if (by_distance) return {};
    InterfaceParams params;
    params.h_min = interface_sizes();
    params.round = static_cast<int>(records_.size());
    params.threads = options_.threads;
    Result<MetricField<3>> metric =
        interface_metric<3>(state.mesh, filling, state.metric, params, progress);
    if (!metric) return metric.error();
    state.metric = std::move(*metric);
    return {};
  }

  Result<void> measure_bodies(MeshState& state, const Progress& progress) {
    const auto count = static_cast<double>(of_.members.size());
    state.layers.assign(state.mesh.points.size(), std::numeric_limits<double>::quiet_NaN());
    state.below.clear();
    std::vector<int> region(state.mesh.points.size(), -1);
    parallel_each(state.mesh.node_count(), options_.threads, {}, [&](std::size_t i) {
      region[i + 1] = of_.partition->region_of(state.mesh.points[i + 1]);
    });
    for (std::size_t m = 0; m < of_.members.size(); ++m) {
      const auto at = static_cast<double>(m);
      const auto inside = [&](const Vec<3>& x) {
        return of_.partition->region_of(x) == static_cast<int>(m);
      };
      Result<Layers> layers = measure_layers_within(
          state.mesh, of_.members[m].walls(), of_.outcomes[m].layers_asked, options_.threads,
          progress.portion(at / count, (at + 1) / count), inside);
      if (!layers) return layers.error();
      of_.outcomes[m].layers = layers->stats;
      of_.outcomes[m].below = layers->below;
      state.below.insert(state.below.end(), layers->below.begin(), layers->below.end());
      for (std::size_t i = 1; i < state.layers.size(); ++i)
        if (region[i] == static_cast<int>(m)) state.layers[i] = layers->at_node[i];
    }
    return {};
  }

  void count(const std::vector<FillingError>& errors) {
    for (std::size_t m = 0; m < errors.size(); ++m) {
      of_.outcomes[m].mesh_volume = errors[m].volume;
      of_.outcomes[m].interface_error = errors[m].relative_l2;
    }
  }

  const Study& study_;
  const StudyOptions& options_;
  const SolverField* field_;  ///< in place of a flow; may be null
  Assembly of_;
  /// What holds the boundary and the interfaces, once the mesh was cut.
  std::unique_ptr<const ReferenceSurface<3>> exact_;
  std::shared_ptr<const ChordField> chords_;  ///< since then
  std::vector<std::int32_t> first_face_;      ///< [region] of its CAD faces, since then
  MetricFunction<3> at_borders_;              ///< natural, and what is asked across exact borders
  MeshState current_;
  std::vector<IterationRecord> records_;
  bool settled_ = false, failed_ = false, balanced_ = false;
};

}  // namespace

Result<Outcome> run_assembly(const Study& study, const std::vector<Part>& parts,
                             const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                             const Progress& progress, const IterationSink& on_iteration,
                             const SolverField* field) {
  const auto start = Clock::now();
  Outcome outcome;
  AssemblyLoop loop(study, field);
  const auto tell = [&] {
    outcome.records.push_back(loop.last_record());
    outcome.state = std::make_shared<const MeshState>(loop.current());
    if (on_iteration) on_iteration(loop.last_record(), outcome.state);
  };
  if (Result<void> begun =
          loop.begin(parts, meshers, progress.portion(0, kFirstMeshShare, "first mesh"));
      !begun)
    return begun.error();
  tell();
  const int iterations = study.options.iterations;
  const bool flows = loop.wants_flow();
  const int rounds = flows ? study.flow->rounds : 0;
  const double width = (0.97 - kFirstMeshShare) / (iterations + rounds + (flows ? 0.5 : 0.0));
  for (int i = 1; i <= iterations && !outcome.cancelled; ++i) {
    const Progress round =
        progress.portion(kFirstMeshShare + width * (i - 1), kFirstMeshShare + width * i,
                         "iteration " + std::to_string(i));
    const Result<void> stepped = loop.step(round);
    if (!stepped && stepped.error().code != Code::cancelled) return stepped.error();
    outcome.cancelled = !stepped;
    if (stepped && !loop.failed()) tell();
    if (loop.failed() || (study.options.until_settled && loop.settled())) break;
  }
  for (int i = 0; flows && i <= rounds && !outcome.cancelled && !loop.failed(); ++i) {
    if (i > 0 && !loop.current().flow) break;  // there is nothing to correct by
    const double from = kFirstMeshShare + width * (iterations + (i == 0 ? 0 : i - 0.5));
    const Progress round = progress.portion(from, from + (i == 0 ? 0.5 : 1) * width, "flow");
    const Result<void> done = i == 0 ? loop.solve_flow(round) : loop.flow_step(round);
    if (!done && done.error().code != Code::cancelled) return done.error();
    outcome.cancelled = !done;
    if (!done || loop.failed()) break;
    if (i > 0) {
      tell();
    } else {  // the same mesh, now with its flow
      outcome.records.back() = loop.last_record();
      outcome.state = std::make_shared<const MeshState>(loop.current());
      if (on_iteration && outcome.state->flow) on_iteration(loop.last_record(), outcome.state);
    }
  }
  Result<std::vector<BodyOutcome>> closed =
      loop.finish(outcome.cancelled ? Progress{} : progress.portion(0.97, 1));
  if (!closed) {
    outcome.cancelled = true;
    closed = loop.finish(Progress{});
  }
  outcome.bodies = std::move(*closed);
  outcome.state = std::make_shared<const MeshState>(loop.current());
  outcome.records.back() = loop.last_record();
  outcome.overlaps = loop.overlaps();
  outcome.converged = !outcome.cancelled && loop.converged();
  outcome.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  progress.report(1);
  return outcome;
}

}  // namespace lamella
