#include "core/study/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/base/parallel.h"
#include "core/geometry/triangles.h"
#include "core/mesh/validate.h"
#include "core/natural/boundary_distance.h"
#include "core/natural/layer_correction.h"
#include "core/natural/layers.h"
#include "core/natural/neighborhood.h"
#include "core/natural/spread_metric.h"
#include "core/natural/thickness_detector.h"
#include "core/optimize/adapt.h"
#include "core/sizing/sizing_field.h"
#include "core/study/assembly.h"
#include "core/study/first_mesh.h"
#include "core/study/forecast.h"
#include "core/study/join.h"
#include "core/study/measure.h"
#include "core/study/request.h"

namespace lamella {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr double kFirstMeshShare = 0.15;  // of the progress; the iterations share the rest
constexpr double kMinGuardShare = 0.3;
constexpr double kAskedScale = kAskedFiner * kAskedFiner;  // of the metric
constexpr double kSettled = 0.05;                          // relative change of the node count

constexpr double kGained = 0.02;  // relative rise of the score that is worth another iteration

/// 1 when the mesh has the layers asked: the 5 % quantile and the mean both count. A body without
/// thin walls has nothing to measure and is content.
double layers_score(const LayerStats& layers, int asked) {
  if (layers.places == 0) return 1;
  return std::min({1.0, layers.p5 / (0.9 * asked), layers.mean / asked});
}

/// The loop of one body: `begin` makes the first mesh, each `step` one iteration.
class BodyLoop {
 public:
  BodyLoop(const Study& study, const Part& part, const SolverField* field, double across)
      : study_(study),
        part_(part),
        field_(field),
        across_(across),
        options_(study.options),
        settings_(settings_of(study, part.name)) {
    outcome_.name = part.name;
    outcome_.layers_asked = settings_.layers;
    outcome_.cad_volume = part.cad_volume;
    outcome_.chord_tolerance = chord_tolerance_of(study, part);
    natural_ = natural_params(study, part);
    outcome_.h_min = natural_.h_min;
    flow_h_min_ = flow_h_min(study, natural_.h_min);
    outcome_.notes = part.notes;
  }

  /// Null when the study has no groups on this body.
  const FaceGroups* groups() const { return groups_.get(); }

  Result<void> begin(const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                     const Progress& progress) {
    const auto start = Clock::now();
    Result<SizingField> sizing = SizingField::make(sizing_of(study_, part_.name), part_.surface);
    if (!sizing) return sizing.error();
    sizing_ = std::move(*sizing);
    if (Result<void> divided = divide_faces(); !divided) return divided.error();
    Result<FirstMesh> first = first_mesh(shape(), meshers, progress.portion(0, 0.7, "first mesh"));
    if (!first) return first.error();
    outcome_.first_mesh_by = first->made_by;
    outcome_.notes.insert(outcome_.notes.end(), first->notes.begin(), first->notes.end());
    detector_ = make_detector(options_.detector, part_.surface);
    chords_ = chords_of(study_, part_, progress.portion(0.7, 0.72));
    if (progress.cancelled()) return cancelled_error();
    if (Result<void> enough = look_ahead(first->mesh, progress.portion(0.72, 0.8)); !enough)
      return enough;
    return accept(std::move(first->mesh), start, progress.portion(0.8, 1));
  }

  bool done() const { return done_; }

  /// Errors: cancelled; failed when there is nothing better than the first mesh to fall back to.
  Result<void> step(const Progress& progress) {
    const auto start = Clock::now();
    natural_.layers = layers_of_iteration(static_cast<int>(outcome_.records.size()));
    AdaptParams params;
    // What the tessellation has left of the tolerance.
    params.chord_tolerance = std::max(outcome_.chord_tolerance - part_.chord_error,
                                      kMinGuardShare * outcome_.chord_tolerance);
    params.seed = options_.seed;
    params.threads = options_.threads;
    params.memory_limit = options_.memory;
    // Asked at every accepted point, a detector that can answer there keeps walls from blurring
    // into their neighbors: two rounds reach what the nodal field does not in six.
    MetricFunction<3> asked_at;
    MetricField<3> asked;
    if (const MetricFunction<3> natural = detector_->function(natural_)) {
      asked_at = [this, natural](const Vec<3>& x) -> Metric<3> {
        return sized(x, correction_.apply(x, natural(x), natural_.h_min)) * kAskedScale;
      };
    } else {
      asked = current_.metric;
      for (std::size_t i = 1; i < asked.size(); ++i)
        asked[i] =
            correction_.apply(current_.mesh.points[i], asked[i], natural_.h_min) * kAskedScale;
    }
    Result<Adapted<3>> adapted = adapt<3>(current_.mesh, asked, &shape().surface, params,
                                          progress.portion(0, 0.8), asked_at);
    if (!adapted) return give_up(adapted.error());
    if (adapted->report.cancelled) return cancelled_error();
    if (Result<void> valid = validate<3>(adapted->mesh); !valid) return give_up(valid.error());
    return accept(std::move(adapted->mesh), start, progress.portion(0.8, 1));
  }

  bool wants_flow() const { return has_flow(study_, part_.name); }

  bool has_flow_fields() const { return current_.flow != nullptr; }

  /// The flow through the best mesh, from where rounds of correction start: it becomes the last of
  /// the records. A flow that cannot be solved is a note. Errors: those of the detector; cancelled.
  Result<void> begin_flow(const Progress& progress) {
    current_ = best_;
    if (best_record_ + 1 != outcome_.records.size()) {
      const IterationRecord best = outcome_.records[best_record_];
      outcome_.notes.push_back("The flow starts from the mesh of iteration " +
                               std::to_string(best.iteration) + ", which has the best layers.");
      best_record_ = outcome_.records.size();
      outcome_.records.push_back(best);
      outcome_.records.back().iteration = static_cast<int>(best_record_);
    }
    natural_.layers = settings_.layers;
    Result<NaturalField> field =
        detector_->field(current_.mesh, natural_, progress.portion(0, 0.3));
    if (!field) return field.error();
    natural_at_nodes_ = std::move(field->metric);
    Result<void> solved = solve_flow(progress.portion(0.3, 1));
    if (!solved && solved.error().code != Code::cancelled) {
      outcome_.notes.push_back(who() + solved.error().message + " The mesh is the natural one.");
      return {};
    }
    if (!solved) return solved;
    if (std::string note = outside_note(*current_.flow); !note.empty())
      outcome_.notes.push_back(who() + note);
    best_.flow = current_.flow;
    put_flow(outcome_.records[best_record_]);
    return {};
  }

  /// One round: the metric corrected by the flow of the round before, the mesh adapted to it, and
  /// the flow through that. Errors: as `step`.
  Result<void> flow_step(const Progress& progress) {
    if (!current_.flow) return {};
    const IterationRecord before = outcome_.records[best_record_];
    const std::shared_ptr<const FlowFields> flow = current_.flow;
    MetricField<3> natural = natural_at_nodes_;
    const auto ask = [&](std::size_t i) {
      const Vec<3>& x = current_.mesh.points[i + 1];
      natural[i + 1] = sizing_.apply(
          x, of_part(x, correction_.apply(x, natural_at_nodes_[i + 1], natural_.h_min)));
    };
    if (!parallel_each(current_.mesh.node_count(), options_.threads, progress.portion(0, 0.02),
                       ask))
      return cancelled_error();
    Result<FlowCorrection> made =
        flow_correction(current_.mesh, natural, *flow, *study_.flow, of_flow_, flow_h_min_,
                        options_.threads, progress.portion(0.02, 0.1, "flow"));
    if (!made) return give_up(made.error());
    of_flow_ = std::move(made->field);
    for (std::size_t i = 1; i < natural.size(); ++i)
      current_.metric[i] = sized(current_.mesh.points[i], natural_at_nodes_[i]);
    const std::size_t records = outcome_.records.size();
    if (Result<void> stepped = step(progress.portion(0.1, 0.7)); !stepped) return stepped;
    if (outcome_.records.size() == records) return {};  // given up
    if (Result<void> solved = solve_flow(progress.portion(0.7, 1)); !solved) {
      if (solved.error().code == Code::cancelled) return solved;
      outcome_.notes.push_back(who() + solved.error().message);
      return {};
    }
    best_.flow = current_.flow;
    put_flow(outcome_.records.back());
    tell_flow(before, *flow, *made);
    return {};
  }

  const MeshState& best() const { return best_; }
  const IterationRecord& last_record() const { return outcome_.records.back(); }
  std::size_t record_count() const { return outcome_.records.size(); }
  const MeshState& current() const { return current_; }
  bool converged() const { return converged_; }

  /// Closes the books on the best mesh.
  Result<BodyOutcome> finish(const Progress& progress) {
    const IterationRecord& best = outcome_.records[best_record_];
    outcome_.layers = best.layers;
    outcome_.below = best_.below;
    outcome_.mesh_volume = best.volume;
    Result<BoundaryDistance> distance =
        boundary_distance(best_.mesh, part_.surface, options_.threads, progress);
    if (!distance) return distance.error();
    outcome_.boundary_distance = *distance;
    if (best.layers.places > 0 && best.layers.p5 < 0.9 * settings_.layers)
      outcome_.notes.push_back(
          "At some places the walls have fewer layers than asked: 5 % of their area below " +
          std::to_string(best.layers.p5).substr(0, 4) + largest_place() + ".");
    if (Result<void> told = tell_boundary_layers(progress); !told) return told.error();
    if (best_record_ + 1 != outcome_.records.size())
      outcome_.notes.push_back("The mesh of iteration " + std::to_string(best.iteration) +
                               " was kept: later ones had fewer layers.");
    return outcome_;
  }

 private:
  Result<void> solve_flow(const Progress& progress) {
    const auto find = [&]() -> Result<FlowFields> {
      if (field_)
        return field_on(current_.mesh, *field_, study_.flow->method, across_, options_.threads,
                        progress);
      const std::shared_ptr<const MeshState> named = join({&current_}, {part_.name}, {groups()});
      return flow_through(named->mesh, flow_case_of(study_, part_.name), study_.flow->method,
                          options_.threads, progress);
    };
    Result<FlowFields> flow = find();
    if (!flow) return flow.error();
    current_.flow = std::make_shared<const FlowFields>(std::move(*flow));
    return {};
  }

  void put_flow(IterationRecord& record) const {
    record.flow_rate = current_.flow->rate();
    record.flow_pressure = current_.flow->highest_pressure();
  }

  /// What notes of the flow begin with.
  std::string who() const { return field_ ? "Solver's field: " : "Flow: "; }

  void tell_flow(const IterationRecord& before, const FlowFields& old, const FlowCorrection& made) {
    if (field_) return outcome_.notes.push_back(field_note(old, *current_.flow, made));
    const IterationRecord& after = outcome_.records.back();
    char text[240];
    std::snprintf(text, sizeof text,
                  "Corrected by the flow: %.4g instead of %.4g elements asked for; %.6g instead of "
                  "%.6g mm3/s at %.6g instead of %.6g MPa.",
                  made.elements_after, made.elements_before, after.flow_rate, before.flow_rate,
                  after.flow_pressure, before.flow_pressure);
    outcome_.notes.push_back(text);
  }

  /// The metric asked where the natural one, corrected for the layers or not, is `natural`.
  Metric<3> sized(const Vec<3>& x, const Metric<3>& natural) const {
    return sizing_.apply(x, of_flow_.apply(x, of_part(x, natural), flow_h_min_));
  }

  /// The same without what the flow and the user ask.
  Metric<3> of_part(const Vec<3>& x, const Metric<3>& natural) const {
    return spread_.at(chords_->at(natural, x), x);
  }

  /// What the boundary layers asked by hand came to.
  Result<void> tell_boundary_layers(const Progress& progress) {
    SimplexMesh<3> mesh;
    for (const SizingObject& object : sizing_of(study_, part_.name)) {
      const auto* asked = std::get_if<BoundaryLayer>(&object.asks);
      if (!asked) continue;
      if (mesh.facets.empty()) {
        mesh = best_.mesh;
        for (std::int32_t& face : mesh.facet_face)
          if (groups_) face = groups_->cad_face[static_cast<std::size_t>(face)];
      }
      const auto* faces = std::get_if<FacesShape>(&object.shape);
      const Result<Layers> layers = measure_boundary_layer(
          mesh, faces ? picked_faces(*faces, part_.surface) : std::vector<std::int32_t>{},
          asked->thickness, asked->layers, options_.threads, progress);
      if (!layers) return layers.error();
      char text[200];
      std::snprintf(text, sizeof text,
                    "Boundary layer of %.4g mm: %.2f elements across in the mean, 5 %% below "
                    "%.2f, of %d asked.",
                    asked->thickness, layers->stats.mean, layers->stats.p5, asked->layers);
      outcome_.notes.push_back(text);
    }
    return {};
  }

  /// The part, its faces divided where the study's groups cover them in part.
  const Part& shape() const { return grouped_ ? *grouped_ : part_; }
  Result<void> divide_faces() {
    const std::vector<BoundaryGroup> groups = groups_of(study_, part_.name);
    if (groups.empty()) return {};
    Result<GroupedSurface> grouped = group_faces(groups, part_.surface);
    if (!grouped) return grouped.error();
    groups_ = std::make_unique<const FaceGroups>(std::move(grouped->groups));
    Part part = part_;
    part.surface = std::move(grouped->surface);
    grouped_ = std::make_unique<const Part>(std::move(part));
    return {};
  }

  /// Forecasts the mesh of the end; a detector that needs a mesh forecasts nothing. Errors: memory
  /// when the budget would not do, before anything is spent.
  Result<void> look_ahead(const SimplexMesh<3>& first, const Progress& progress) {
    const MetricFunction<3> natural = detector_->function(natural_);
    if (!natural) return {};
    Result<SizingForecast> made =
        forecast_body(study_, first, natural, *chords_, sizing_, progress);
    if (!made) return made.error();
    forecast_ = made->corrected;
    // With the flow, which solves on the mesh and then refines it.
    const std::optional<FlowForecast> flow = forecast_flow(study_, part_.name, forecast_);
    const MeshForecast& most = flow ? flow->mesh : forecast_;
    return within_memory("Body \"" + part_.name + "\": about " +
                             std::to_string(std::llround(most.nodes)) + " nodes and",
                         most.memory, options_.memory,
                         "Allow more memory, ask for fewer layers, or raise h_min or a size.");
  }

  /// n, or less in the first iterations of a progressive run; the last two get n.
  int layers_of_iteration(int i) const {
    const bool early = options_.progressive && i + 1 < options_.iterations && of_flow_.empty();
    return early ? std::min(settings_.layers, i + 1) : settings_.layers;
  }

  std::string largest_place() const {
    if (best_.below.empty()) return "";
    return "; the largest such place is near " + place_text(best_.below.front().at) + " mm";
  }

  /// Takes the mesh as the next state, with metric, layers and record.
  Result<void> accept(SimplexMesh<3> mesh, Clock::time_point start, const Progress& progress) {
    MeshState next;
    next.mesh = std::move(mesh);
    Result<NaturalField> field = detector_->field(next.mesh, natural_, progress.portion(0, 0.55));
    if (!field) return field.error();
    next.metric = std::move(field->metric);
    if (!of_flow_.empty()) natural_at_nodes_ = next.metric;
    std::vector<char> by_hand(next.mesh.points.size(), 0);
    MetricField<3> unspread(next.mesh.points.size());
    const auto correct = [&](std::size_t i) {
      const Vec<3>& x = next.mesh.points[i + 1];
      unspread[i + 1] = chords_->at(next.metric[i + 1], x);
      const Metric<3> alone = spread_.at(unspread[i + 1], x);
      next.metric[i + 1] = sizing_.apply(x, of_flow_.apply(x, alone, flow_h_min_));
      by_hand[i + 1] = next.metric[i + 1] != alone;
    };
    if (!parallel_each(next.mesh.node_count(), options_.threads, progress.portion(0.55, 0.58),
                       correct))
      return cancelled_error();
    if (!outcome_.records.empty()) {
      // The first mesh is too coarse to tell where sizes change.
      spread_ = SpreadMetric::from(next.mesh.points, unspread, {.threads = options_.threads},
                                   progress.portion(0.58, 0.6));
      if (progress.cancelled()) return cancelled_error();
    }
    next.thickness = std::move(field->thickness);
    Result<IterationRecord> record = measure(next, progress.portion(0.6, 0.75));
    if (!record) return record.error();
    Result<Layers> layers = measure_layers(next.mesh, part_.surface, settings_.layers,
                                           options_.threads, progress.portion(0.75, 0.95));
    if (!layers) return layers.error();
    next.layers = std::move(layers->at_node);
    if (!outcome_.records.empty() && of_flow_.empty())
      if (Result<void> learnt = learn(next, by_hand, progress.portion(0.95, 1)); !learnt)
        return learnt;
    next.below = std::move(layers->below);
    record->layers = layers->stats;
    record->layers_by_nodes = average_layers(layer_numbers(next.mesh));
    record->iteration = static_cast<int>(outcome_.records.size());
    record->seconds = seconds_since(start);
    record->forecast_nodes = forecast_.nodes;
    record->forecast_memory = forecast_.memory;

    const double score = layers_score(record->layers, settings_.layers);
    if (!outcome_.records.empty() && of_flow_.empty()) {
      const auto before = static_cast<double>(outcome_.records.back().nodes);
      const double change = std::abs(static_cast<double>(record->nodes) - before) / before;
      const bool settled =
          record->iteration > 1 && change < kSettled && natural_.layers == settings_.layers;
      // Where the user asks for less than the natural metric, fewer layers are what he wants.
      const bool enough = sizing_.may_coarsen() || record->layers.places == 0 ||
                          record->layers.mean >= settings_.layers;
      converged_ = settled && enough;
      done_ =
          options_.until_settled && settled && (score >= 1 || score < (1 + kGained) * best_score_);
    }
    // Among meshes as good the latest is the most conforming one. The first mesh has no layers to
    // speak of: anything adapted goes before it. What the flow corrects is asked for beyond layers.
    if (record->iteration <= 1 || !of_flow_.empty() || score >= (1 - kGained) * best_score_) {
      best_ = next;
      best_score_ = std::max(score, record->iteration <= 1 ? 0.0 : best_score_);
      best_record_ = outcome_.records.size();
    }
    current_ = std::move(next);
    outcome_.records.push_back(*record);
    return {};
  }

  /// Where layers are what the walls ask, not what the user does by hand.
  Result<void> learn(const MeshState& made, const std::vector<char>& by_hand,
                     const Progress& progress) {
    std::vector<double> layers = made.layers;
    for (std::size_t i = 0; i < layers.size(); ++i)
      if (by_hand[i]) layers[i] = std::numeric_limits<double>::quiet_NaN();
    Result<LayerCorrection> learnt =
        LayerCorrection::learn(correction_, made.mesh, layers, kWantedLayers * natural_.layers,
                               options_.threads, progress);
    if (!learnt) return learnt.error();
    correction_ = std::move(*learnt);
    return {};
  }

  /// An iteration that failed ends the body with what it has; without any adapted mesh it is an
  /// error.
  Result<void> give_up(const Error& error) {
    if (error.code == Code::cancelled) return error;
    const std::string place =
        "Body \"" + part_.name + "\", iteration " + std::to_string(outcome_.records.size()) + ": ";
    if (outcome_.records.size() == 1) return Error{error.code, place + error.message, error.hint};
    outcome_.notes.push_back(place + error.message + " The mesh before it was kept.");
    done_ = true;
    converged_ = false;
    return {};
  }

  const Study& study_;
  const Part& part_;
  const SolverField* field_;  ///< in place of a flow; may be null
  const double across_;       ///< mm, of all parts
  const StudyOptions& options_;
  const BodySettings settings_;
  double flow_h_min_ = 0;
  NaturalParams natural_;
  std::unique_ptr<ThicknessDetector> detector_;
  SizingField sizing_;
  std::unique_ptr<const FaceGroups> groups_;
  std::unique_ptr<const Part> grouped_;
  std::unique_ptr<const ChordField> chords_;
  LayerCorrection correction_;
  SpreadMetric spread_;
  CorrectionField of_flow_;
  MetricField<3> natural_at_nodes_;  ///< of the current mesh, where a flow will correct it
  MeshForecast forecast_;
  MeshState current_, best_;
  double best_score_ = 0;
  std::size_t best_record_ = 0;
  bool done_ = false, converged_ = false;
  BodyOutcome outcome_;
};

/// A report that cannot be made is left out: the mesh does not need it.
void look_for_overlaps(const Study& study, const std::vector<Part>& parts, const Progress& progress,
                       Outcome& outcome) {
  Study of_parts = study;
  of_parts.zones.clear();
  OverlapOptions options;
  for (const BodyOutcome& body : outcome.bodies)
    options.contact = std::max(options.contact, body.chord_tolerance);
  options.gap_width = 2 * options.contact;
  if (Result<StudyOverlaps> found = study_overlaps(of_parts, parts, options, progress); found)
    outcome.overlaps = std::move(*found);
}

}  // namespace

Result<Outcome> run(const Study& study, const std::vector<Part>& parts,
                    const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                    Progress progress, IterationSink on_iteration,
                    std::shared_ptr<const SolverField> field) {
  const auto start = Clock::now();
  if (Result<void> good = check_request(study, parts); !good) return good.error();
  // Before hours of meshing; the same for one mesh of all bodies.
  if (Result<void> good = check_field(study, parts, field.get(), progress.portion(0, 0)); !good)
    return good.error();
  const SolverField* used = study.flow && study.flow->field ? field.get() : nullptr;
  if (study.domain) return run_assembly(study, parts, meshers, progress, on_iteration, used);

  Outcome outcome;
  std::vector<BodyLoop> bodies;
  bodies.reserve(parts.size());
  std::vector<std::string> names;
  for (const Part& part : parts) {
    bodies.emplace_back(study, part, used, extent_of(parts));
    names.push_back(part.name);
  }
  const auto joined = [&](auto&& state_of) {
    std::vector<const MeshState*> states;
    std::vector<const FaceGroups*> groups;
    for (const BodyLoop& body : bodies) {
      states.push_back(&state_of(body));
      groups.push_back(body.groups());
    }
    return join(states, names, groups);
  };
  const auto tell = [&](int iteration, Clock::time_point since) {
    std::vector<const IterationRecord*> records;
    for (const BodyLoop& body : bodies) records.push_back(&body.last_record());
    IterationRecord all = join(records);
    all.iteration = iteration;
    all.seconds = seconds_since(since);
    outcome.records.push_back(all);
    if (on_iteration)
      on_iteration(all, joined([](const BodyLoop& b) -> const MeshState& { return b.current(); }));
  };
  const auto count = static_cast<double>(bodies.size());

  const Progress first = progress.portion(0, kFirstMeshShare, "first mesh");
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto at = static_cast<double>(b);
    if (Result<void> made = bodies[b].begin(meshers, first.portion(at / count, (at + 1) / count));
        !made)
      return made.error();
  }
  tell(0, start);

  const bool flows =
      std::any_of(bodies.begin(), bodies.end(), [](const BodyLoop& b) { return b.wants_flow(); });
  const int rounds = flows ? study.flow->rounds : 0;
  const int iterations = study.options.iterations;
  // Each round of the flow takes as long as an iteration, the first flow half of it.
  const double width = (0.97 - kFirstMeshShare) / (iterations + rounds + (flows ? 0.5 : 0.0));
  for (int i = 1; i <= iterations && !outcome.cancelled; ++i) {
    if (std::all_of(bodies.begin(), bodies.end(), [](const BodyLoop& b) { return b.done(); }))
      break;
    const auto since = Clock::now();
    const Progress round =
        progress.portion(kFirstMeshShare + width * (i - 1), kFirstMeshShare + width * i,
                         "iteration " + std::to_string(i));
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (bodies[b].done()) continue;
      const auto at = static_cast<double>(b);
      Result<void> stepped = bodies[b].step(round.portion(at / count, (at + 1) / count));
      if (stepped) continue;
      if (stepped.error().code != Code::cancelled) return stepped.error();
      outcome.cancelled = true;
      break;
    }
    if (!outcome.cancelled) tell(i, since);
  }
  const auto record_count = [&] {
    std::size_t count_all = 0;
    for (const BodyLoop& body : bodies) count_all += body.record_count();
    return count_all;
  };
  const auto flowing = [&] {
    return std::any_of(bodies.begin(), bodies.end(),
                       [](const BodyLoop& b) { return b.has_flow_fields(); });
  };
  for (int i = 0; flows && i <= rounds && !outcome.cancelled; ++i) {
    const std::size_t before = record_count();
    const auto since = Clock::now();
    const double from = kFirstMeshShare + width * (iterations + (i == 0 ? 0 : i - 0.5));
    const Progress round =
        progress.portion(from, from + (i == 0 ? 0.5 : 1) * width,
                         i == 0 ? kFlowPhase : kFlowPhase + (" " + std::to_string(i)));
    for (std::size_t b = 0; b < bodies.size() && !outcome.cancelled; ++b) {
      if (!bodies[b].wants_flow()) continue;
      const auto at = static_cast<double>(b);
      const Progress part = round.portion(at / count, (at + 1) / count);
      const Result<void> done = i == 0 ? bodies[b].begin_flow(part) : bodies[b].flow_step(part);
      if (!done && done.error().code != Code::cancelled) return done.error();
      outcome.cancelled = !done;
    }
    if (outcome.cancelled) break;
    const bool more = record_count() > before;
    if (more) {
      tell(outcome.records.back().iteration + 1, since);
    } else if (i == 0) {  // of the mesh that was told already
      std::vector<const IterationRecord*> last;
      for (const BodyLoop& body : bodies) last.push_back(&body.last_record());
      const IterationRecord all = join(last);
      outcome.records.back().flow_rate = all.flow_rate;
      outcome.records.back().flow_pressure = all.flow_pressure;
      if (on_iteration && flowing())
        on_iteration(outcome.records.back(),
                     joined([](const BodyLoop& b) -> const MeshState& { return b.current(); }));
    }
    if (!flowing() || (i > 0 && !more)) break;  // there is nothing to correct by, or all gave up
  }

  outcome.state = joined([](const BodyLoop& b) -> const MeshState& { return b.best(); });
  // The books are closed after a cancel too; what that takes is bounded by one pass over the mesh.
  outcome.converged = !outcome.cancelled;
  for (BodyLoop& body : bodies) {
    Result<BodyOutcome> closed =
        body.finish(outcome.cancelled ? Progress{} : progress.portion(0.97, 1, "closing"));
    if (!closed) {
      outcome.cancelled = true;
      closed = body.finish(Progress{});
    }
    outcome.converged = outcome.converged && body.converged();
    outcome.bodies.push_back(std::move(*closed));
  }
  if (outcome.bodies.size() > 1) {
    for (BodyOutcome& body : outcome.bodies)
      body.notes.emplace_back(
          "Bodies are meshed one by one: where they touch, nodes are not shared.");
    look_for_overlaps(study, parts, progress.portion(1, 1), outcome);
  }
  outcome.seconds = seconds_since(start);
  progress.report(1);
  return outcome;
}

}  // namespace lamella
