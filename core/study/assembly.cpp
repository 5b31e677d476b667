#include "core/study/assembly.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/base/parallel.h"
#include "core/geometry/soup.h"
#include "core/geometry/triangles.h"
#include "core/mesh/interfaces.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"
#include "core/metric/intersect.h"
#include "core/multidomain/chord_metric.h"
#include "core/multidomain/exact_interface.h"
#include "core/multidomain/interface_metric.h"
#include "core/multidomain/overlap.h"
#include "core/natural/boundary_distance.h"
#include "core/natural/layer_correction.h"
#include "core/natural/medial_ball.h"
#include "core/natural/natural_metric.h"
#include "core/optimize/adapt.h"
#include "core/sizing/sizing_field.h"
#include "core/study/domain.h"
#include "core/study/first_mesh.h"
#include "core/study/measure.h"
#include "core/study/request.h"
#include "core/study/zone_surface.h"

namespace lamella {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFirstMeshShare = 0.1;  // of the progress
constexpr double kAskedScale = kAskedFiner * kAskedFiner;
constexpr double kSettledNodes = 0.03, kSettledError = 0.03;  // relative changes
constexpr int kReportDepth = 6;      // bisections for the figures that are reported
constexpr int kCells = 6;            // of the first mesh of a box, along its longest side
constexpr double kOfLayer = 0.25;    // size across a fuzzy border, of the thinnest layer
constexpr double kOfLayerCut = 0.5;  // the same of a border that the mesh is cut along
constexpr double kSlope = 1;         // growth of that size with the distance
constexpr double kGrowth = 0.7;      // of a neighbor's sizes with the distance in its metric: ln 2
constexpr double kChordShare = 0.6;  // of the tolerance, that chords of borders are asked for
constexpr int kRoundsToCut = 2;      // adaptions to fuzzy borders before the mesh is cut

/// A body or what is around all of them: a region of the partition.
struct Member {
  Part part;  ///< its surface, the whole of it whatever lies over it
  NaturalParams natural;
  std::unique_ptr<const NaturalDetector> detector;
  SizingField sizing;
  LayerCorrection correction;
  std::unique_ptr<const FaceGroups> groups;  ///< null: the study has none on it
  double interface_size = 0;
  bool endless = false;  ///< a formula that ends with the domain only: the mesh finds its edges
};

class AssemblyLoop {
 public:
  explicit AssemblyLoop(const Study& study) : study_(study), options_(study.options) {}

  Result<void> begin(const std::vector<Part>& parts,
                     const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                     const Progress& progress) {
    const auto start = Clock::now();
    if (options_.detector != Detector::geometric)
      return Error{Code::usage, "One mesh of several bodies needs the geometric detector.",
                   "Leave the detector out."};
    Result<SimplexMesh<3>> first = lay_out(parts, meshers, progress.portion(0, 0.5, "first mesh"));
    if (!first) return first.error();
    return accept(std::move(*first), start, progress.portion(0.5, 1));
  }

  Result<void> step(const Progress& progress) {
    const auto start = Clock::now();
    if (exact_) return step_exact(start, progress);
    // The last of the rounds before the cut, or the only one there is.
    const int rounds = std::min(kRoundsToCut, options_.iterations);
    const bool cut =
        options_.interfaces == Interfaces::exact && static_cast<int>(records_.size()) >= rounds;
    const AdaptParams params = adapt_params();
    MetricFunction<3> asked_at;
    if (options_.capture == Capture::distance)
      asked_at = [captured = captured_at()](const Vec<3>& x) -> Metric<3> {
        return captured(x) * kAskedScale;
      };
    MetricField<3> asked = current_.metric;
    for (std::size_t i = 1; i < asked.size(); ++i) asked[i] *= kAskedScale;
    Result<Adapted<3>> adapted =
        adapt<3>(current_.mesh, asked, domain_surface_ ? &*domain_surface_ : nullptr, params,
                 progress.portion(0, cut ? 0.4 : 0.7), asked_at);
    if (!adapted) return adapted.error();
    if (adapted->report.cancelled) return cancelled_error();
    if (Result<void> valid = validate<3>(adapted->mesh); !valid) return valid.error();
    if (!cut) return accept(std::move(adapted->mesh), start, progress.portion(0.7, 1));
    ExactParams exact;
    exact.adapt = params;
    std::vector<ReferenceSurface<3>> surfaces;
    for (std::size_t m = 0; m + 1 < members_.size(); ++m)
      surfaces.push_back(members_[m].endless ? ReferenceSurface<3>{} : members_[m].part.surface);
    Result<Exact> made =
        exact_interfaces(adapted->mesh, adapted->metric, *partition_, surfaces, exact,
                         progress.portion(0.4, 0.75, "cutting along the borders"), natural_alone());
    if (!made) return made.error();
    if (made->adapt.cancelled) return cancelled_error();
    SimplexMesh<3> mesh = std::move(made->mesh);
    for (int region = partition_->background(); region >= 0; --region)
      if (body_of_[region] < 0) mesh = drop_body<3>(mesh, region);
    if (mesh.elements.empty())
      return Error{Code::usage, "Nothing is left of the mesh.", "Drop fewer bodies."};
    put_in_groups(mesh, made->surface);
    if (Result<void> valid = validate<3>(mesh); !valid) return valid.error();
    if (made->lost > 0)
      outcomes_.front().notes.push_back(std::to_string(made->lost) +
                                        " pieces of sharp edges could not be followed.");
    exact_ = std::make_unique<const ReferenceSurface<3>>(std::move(made->surface));
    return accept(std::move(mesh), start, progress.portion(0.75, 1));
  }

  const MeshState& current() const { return current_; }
  const IterationRecord& last_record() const { return records_.back(); }
  bool settled() const { return settled_; }
  bool converged() const {
    return settled_ && std::all_of(outcomes_.begin(), outcomes_.end(), [&](const BodyOutcome& b) {
             return b.name == members_.back().part.name || b.layers.places == 0 ||
                    b.layers.mean >= b.layers_asked;
           });
  }

  /// Closes the books, the figures with a finer division at the borders than in the loop.
  Result<std::vector<BodyOutcome>> finish(const Progress& progress) {
    for (std::size_t m = 0; exact_ && m + 1 < members_.size(); ++m) {
      if (body_of_[m] < 0) continue;
      const SimplexMesh<3> body = extract_body(current_.mesh, body_of_[m]);
      if (body.elements.empty()) continue;
      Result<BoundaryDistance> distance =
          boundary_distance(body, members_[m].part.surface, options_.threads, progress);
      if (!distance) return distance.error();
      outcomes_[m].boundary_distance = *distance;
    }
    if (exact_) {
      std::vector<BodyOutcome> kept;
      for (std::size_t m = 0; m < outcomes_.size(); ++m)
        if (body_of_[m] >= 0) kept.push_back(outcomes_[m]);
      return kept;
    }
    FillingParams params;
    params.depth = kReportDepth;
    params.threads = options_.threads;
    Result<Filling> filling = filling_ratios<3>(current_.mesh, *partition_, params, progress);
    if (filling) count(filling_errors<3>(current_.mesh, *filling));
    return outcomes_;
  }

 private:
  AdaptParams adapt_params() const {
    AdaptParams params;
    params.chord_tolerance = chord_tolerance_;
    params.seed = options_.seed;
    params.threads = options_.threads;
    params.memory_limit = options_.memory;
    return params;
  }

  /// What is asked where the faces of the mesh are the borders: edges along them are chords.
  Metric<3> exact_at(const Vec<3>& x) const {
    return with_chords(natural_at(x), *partition_, x, kChordShare * chord_tolerance_, kGrowth);
  }
  MetricFunction<3> natural_alone() const {
    return [this](const Vec<3>& x) -> Metric<3> { return exact_at(x) * kAskedScale; };
  }

  Result<void> step_exact(Clock::time_point start, const Progress& progress) {
    Result<Adapted<3>> adapted =
        adapt<3>(current_.mesh, current_.metric, exact_.get(), adapt_params(),
                 progress.portion(0, 0.7), natural_alone());
    if (!adapted) return adapted.error();
    if (adapted->report.cancelled) return cancelled_error();
    if (Result<void> valid = validate<3>(adapted->mesh); !valid) return valid.error();
    return accept(std::move(adapted->mesh), start, progress.portion(0.7, 1));
  }

  /// Regions and the first mesh of the domain.
  Result<SimplexMesh<3>> lay_out(const std::vector<Part>& parts,
                                 const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                                 const Progress& progress) {
    const auto& domain = study_.domain->shape;
    const auto* body = std::get_if<DomainBody>(&domain);
    std::string background = body ? body->name : kBackground;
    std::vector<Region<3>> regions;
    std::optional<Part> outside;  // the domain, where it is a body
    for (const Part& part : parts) {
      if (body && part.name == body->name) {
        outside = part;
        continue;
      }
      Member member;
      member.part = part;
      if (const std::vector<BoundaryGroup> groups = groups_of(study_, part.name); !groups.empty()) {
        Result<GroupedSurface> grouped = group_faces(groups, part.surface);
        if (!grouped) return grouped.error();
        member.part.surface = std::move(grouped->surface);
        member.groups = std::make_unique<const FaceGroups>(std::move(grouped->groups));
      }
      members_.push_back(std::move(member));
      regions.push_back({part.name, surface_zone<3>(part.surface)});
    }
    for (const StudyZone& zone : study_.zones) {
      if (zone.name == background) continue;
      regions.push_back({zone.name, make_zone(zone, study_.zones)});
    }
    Result<StudyZone> hull = domain_hull(study_, parts);
    if (!hull) return hull.error();
    const double diagonal = domain_diagonal(*hull, outside);
    chord_tolerance_ = options_.chord_tolerance.value_or(1e-3 * diagonal);
    for (const StudyZone& zone : study_.zones) {
      if (zone.name == background) continue;
      Result<ReferenceSurface<3>> surface =
          zone_surface(zone, study_.zones, *hull, chord_tolerance_);
      if (!surface) return surface.error();
      Member member;
      member.part.name = zone.name;
      member.endless = std::holds_alternative<ZoneHalfSpace>(zone.shape) ||
                       std::holds_alternative<ZoneCell>(zone.shape);
      member.part.surface = std::move(*surface);
      member.part.cad_volume = enclosed_measure(member.part.surface);
      members_.push_back(std::move(member));
    }
    if (members_.empty())
      return Error{Code::usage, "The domain holds no body.", "Add a part or a zone to the study."};

    Result<SimplexMesh<3>> first = domain_mesh(*hull, outside, meshers, progress);
    if (!first) return first.error();
    // What is around the bodies has the domain's wall, and theirs from the other side.
    Member around;
    around.part.name = background;
    around.part.surface = boundary_surface(*first, 0);
    double volume = enclosed_measure(around.part.surface);
    if (outside) volume = outside->cad_volume;
    for (const Member& member : members_) {
      append_reversed(member.part.surface, around.part.surface);
      volume -= member.part.cad_volume;
    }
    around.part.cad_volume = volume;
    members_.push_back(std::move(around));
    partition_ = std::make_unique<Partition<3>>(std::move(regions), background);
    for (Member& member : members_)
      if (Result<void> ready = prepare(member); !ready) return ready.error();
    if (Result<void> chosen = choose_bodies(); !chosen) return chosen.error();
    if (Result<void> told = tell_overlaps(*hull, progress); !told) return told.error();
    return first;
  }

  /// Overlaps and gaps go to the notes; of what two bodies share the first keeps the volume.
  Result<void> tell_overlaps(const StudyZone& hull, const Progress& progress) {
    OverlapOptions options;
    options.threads = options_.threads;
    options.contact = chord_tolerance_;
    options.gap_width = 2 * chord_tolerance_;
    options.within = make_zone(hull, study_.zones)->box();
    if (domain_surface_) {
      options.within = Box<3>{};
      for (const Vec<3>& p : domain_surface_->points) options.within->add(p);
    }
    Result<OverlapReport> report = find_overlaps(*partition_, options, progress);
    if (!report) return report.error();
    const auto number = [](double x) {
      char text[32];
      std::snprintf(text, sizeof text, "%.4g", x);
      return std::string(text);
    };
    for (const Overlap& o : report->overlaps) {
      outcomes_[o.second].cad_volume -= o.volume;
      outcomes_[o.second].notes.push_back("Overlaps \"" + outcomes_[o.first].name + "\" by " +
                                          number(o.volume) + " mm3, up to " + number(o.depth) +
                                          " mm deep at " + place_text(o.place) +
                                          " mm, which belongs to the latter.");
      outcomes_.back().cad_volume += o.volume;
    }
    for (const Gap& g : report->gaps)
      outcomes_[g.first].notes.push_back("A gap of " + number(g.volume) + " mm3 towards \"" +
                                         outcomes_[g.second].name + "\", " + number(g.least_width) +
                                         " mm wide at " + place_text(g.place) + " mm.");
    return {};
  }

  /// Detector, sizes by hand and size across borders of a member, and its entry in the books.
  Result<void> prepare(Member& member) {
    const ReferenceSurface<3>& surface = member.part.surface;
    const BodySettings settings = settings_of(study_, member.part.name);
    member.natural = natural_params(study_, member.part);
    if (member.part.name == kBackground && !names_background(study_))
      member.natural.layers = kBackgroundLayers;
    member.detector = std::make_unique<NaturalDetector>(surface);
    Result<SizingField> sizing = SizingField::make(sizing_of(study_, member.part.name), surface);
    if (!sizing) return sizing.error();
    member.sizing = std::move(*sizing);
    member.interface_size = settings.interface_size.value_or(
        (options_.interfaces == Interfaces::exact ? kOfLayerCut : kOfLayer) *
        thinnest_layer(member));
    BodyOutcome outcome;
    outcome.name = member.part.name;
    outcome.layers_asked = member.natural.layers;
    outcome.cad_volume = member.part.cad_volume;
    outcome.chord_tolerance = chord_tolerance_;
    outcome.h_min = member.natural.h_min;
    outcome.interface_size = member.interface_size;
    outcome.first_mesh_by = first_mesh_by_;
    outcome.notes = member.part.notes;
    outcomes_.push_back(std::move(outcome));
    return {};
  }

  /// The 5 % quantile of the smallest natural size on the surface, mm.
  double thinnest_layer(const Member& member) const {
    constexpr std::size_t kSamples = 2000;
    const ReferenceSurface<3>& s = member.part.surface;
    const std::size_t stride = s.facets.size() / kSamples + 1;
    std::vector<double> found((s.facets.size() + stride - 1) / stride);
    parallel_each(found.size(), options_.threads, {}, [&](std::size_t i) {
      const auto& f = s.facets[i * stride];
      const Vec<3> middle = (s.points[f[0]] + s.points[f[1]] + s.points[f[2]]) / 3;
      found[i] = sizes<3>(member.detector->at(middle, member.natural).metric)[0];
    });
    std::sort(found.begin(), found.end());
    return found.empty() ? diagonal_of(s.points) : found[found.size() / 20];
  }

  double domain_diagonal(const StudyZone& hull, const std::optional<Part>& outside) const {
    if (outside) return diagonal_of(outside->surface.points);
    const Box<3> box = make_zone(hull, {hull})->box();
    return (box.hi - box.lo).norm();
  }

  /// A box is meshed right away, anything else from its surface.
  Result<SimplexMesh<3>> domain_mesh(
      const StudyZone& hull, const std::optional<Part>& outside,
      const std::vector<std::shared_ptr<const VolumeMesher>>& meshers, const Progress& progress) {
    if (const auto* box = std::get_if<ZoneBox>(&hull.shape); box && !outside) {
      const Vec<3> side = box->high - box->low;
      std::array<int, 3> cells{};
      for (int k = 0; k < 3; ++k)
        cells[k] = std::max(2, static_cast<int>(std::lround(kCells * side[k] / side.maxCoeff())));
      first_mesh_by_ = "box";
      return box_mesh<3>(cells, box->low, box->high);
    }
    Part part;
    if (outside) {
      part = *outside;
    } else {
      part.name = hull.name;
      Result<ReferenceSurface<3>> surface = zone_surface(hull, {hull}, hull, chord_tolerance_);
      if (!surface) return surface.error();
      part.surface = std::move(*surface);
    }
    Result<FirstMesh> first = first_mesh(part, meshers, progress);
    if (!first) return first.error();
    first_mesh_by_ = first->made_by;
    domain_surface_ = std::move(part.surface);
    return std::move(first->mesh);
  }

  Metric<3> natural_in(int region, const Vec<3>& x) const {
    const Member& member = members_[region];
    return member.sizing.apply(
        x, member.correction.apply(x, member.detector->at(x, member.natural).metric,
                                   member.natural.h_min));
  }

  /// The natural metric of the region that x lies in, refined towards the sizes beyond its borders
  /// as they come near: M_b / (1 + l ln 2)^2 at the distance l in the metric of the neighbor.
  Metric<3> natural_at(const Vec<3>& x) const {
    const int own = partition_->region_of(x);
    Metric<3> metric = natural_in(own, x);
    const double beside = 0.1 * chord_tolerance_;
    std::vector<Border<3>> near;
    partition_->borders(x, 3 * sizes<3>(metric)[0] / kGrowth, near);
    for (const auto& [zone, border] : near) {
      const Vec<3> there = x + (border.distance + beside) * border.normal;
      const int other = partition_->region_of(there);
      if (other == own || (exact_ && body_of_[other] < 0)) continue;
      const Metric<3> beyond = natural_in(other, there);
      const double length = border.distance * std::sqrt(border.normal.dot(beyond * border.normal));
      metric = intersect<3>(metric, beyond / std::pow(1 + kGrowth * length, 2));
    }
    return metric;
  }

  /// Which regions stay, numbered anew. Errors: usage (an unknown name).
  Result<void> choose_bodies() {
    body_of_.assign(members_.size(), 0);
    std::vector<std::string> dropped = study_.dropped;
    if (std::holds_alternative<DomainBodies>(study_.domain->shape))
      dropped.push_back(members_.back().part.name);
    for (const std::string& name : dropped) {
      const auto it = std::find_if(members_.begin(), members_.end(),
                                   [&](const Member& m) { return m.part.name == name; });
      if (it == members_.end())
        return Error{Code::usage, "There is no body \"" + name + "\" that could be dropped.",
                     "What is around the bodies is called \"" + members_.back().part.name + "\"."};
      body_of_[it - members_.begin()] = -1;
    }
    if (!dropped.empty() && options_.interfaces == Interfaces::fuzzy)
      return Error{Code::usage, "Bodies can be dropped from a mesh with exact interfaces only.",
                   "Ask for exact interfaces, or give a domain around the bodies."};
    std::int32_t next = 0;
    for (std::int32_t& body : body_of_)
      if (body >= 0) body = next++;
    return {};
  }

  /// Faces of a body that belong to a group of the study are put in it, and what bounds a body
  /// towards a dropped one are its walls.
  void put_in_groups(SimplexMesh<3>& mesh, const ReferenceSurface<3>& surface) const {
    const auto group_called = [&](const std::string& name) {
      auto it = std::find(mesh.groups.begin(), mesh.groups.end(), name);
      if (it == mesh.groups.end()) it = mesh.groups.insert(it, name);
      return static_cast<std::int32_t>(it - mesh.groups.begin());
    };
    // Endless zones bring faces of their own: those of parts cannot be told by number then.
    const bool numbered =
        std::none_of(members_.begin(), members_.end(), [](const Member& m) { return m.endless; });
    std::size_t first = surface.faces.size();
    for (std::size_t m = members_.size() - 1; numbered && m-- > 0;) {
      const Member& member = members_[m];
      first -= member.part.surface.faces.size();
      for (std::size_t f = 0; member.groups && f < mesh.facets.size(); ++f) {
        const auto face = static_cast<std::size_t>(mesh.facet_face[f]);
        if (face < first || face >= first + member.groups->face_group.size()) continue;
        const std::int32_t group = member.groups->face_group[face - first];
        if (group >= 0) mesh.facet_group[f] = group_called(member.groups->names[group]);
      }
    }
    for (std::string& name : mesh.groups)
      for (std::size_t m = 0; m < members_.size(); ++m) {
        if (body_of_[m] >= 0) continue;
        const std::string& gone = members_[m].part.name;
        const std::size_t bar = name.find('|');
        if (bar == std::string::npos) continue;
        if (name.substr(bar + 1) == gone)
          name = name.substr(0, bar) + " walls";
        else if (name.substr(0, bar) == gone)
          name = name.substr(bar + 1) + " walls";
      }
  }

  std::vector<double> interface_sizes() const {
    std::vector<double> sizes;
    for (const Member& member : members_) sizes.push_back(member.interface_size);
    return sizes;
  }

  MetricFunction<3> captured_at() const {
    return interface_metric_at<3>(
        *partition_, [this](const Vec<3>& x) { return natural_at(x); }, interface_sizes(), kSlope);
  }

  /// Takes the mesh as the next state, with filling, metric, layers and record.
  Result<void> accept(SimplexMesh<3> mesh, Clock::time_point start, const Progress& progress) {
    MeshState next;
    next.mesh = std::move(mesh);
    if (exact_) return accept_exact(std::move(next), start, progress);
    FillingParams filling_params;
    filling_params.threads = options_.threads;
    Result<Filling> filling =
        filling_ratios<3>(next.mesh, *partition_, filling_params, progress.portion(0, 0.1));
    if (!filling) return filling.error();
    next.mesh.bodies = partition_->names();
    for (std::size_t e = 0; e < next.mesh.elements.size(); ++e)
      next.mesh.element_body[e] = filling->main_region(e);
    if (Result<void> asked = ask(next, *filling, progress.portion(0.1, 0.4)); !asked) return asked;
    Result<IterationRecord> record = measure(next, progress.portion(0.4, 0.5));
    if (!record) return record.error();
    count(filling_errors<3>(next.mesh, *filling));
    if (Result<void> measured = measure_bodies(next, progress.portion(0.5, 1)); !measured)
      return measured;
    record->mixed = filling->mixed_count();
    for (const BodyOutcome& body : outcomes_)
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
      const Member& member = members_[partition_->region_of(x)];
      next.metric[i + 1] = exact_at(x);
      next.thickness[i + 1] = member.detector->at(x, member.natural).thickness;
    };
    if (!parallel_each(next.mesh.node_count(), options_.threads, progress.portion(0, 0.3), at_node))
      return cancelled_error();
    Result<IterationRecord> record = measure(next, progress.portion(0.3, 0.4));
    if (!record) return record.error();
    next.layers.assign(next.mesh.points.size(), std::numeric_limits<double>::quiet_NaN());
    const std::size_t bodies = members_.size();
    for (std::size_t m = 0; m < bodies; ++m) {
      if (body_of_[m] < 0) continue;
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
    BodyOutcome& outcome = outcomes_[m];
    Member& member = members_[m];
    std::vector<NodeId> old_id;
    const SimplexMesh<3> body = extract_body(state.mesh, body_of_[m], &old_id);
    outcome.interface_error = 0;
    outcome.mesh_volume = 0;
    for (const auto& e : body.elements) outcome.mesh_volume += signed_measure<3>(body.corners(e));
    if (body.elements.empty()) return {};
    Result<Layers> layers = measure_layers(body, member.part.surface, outcome.layers_asked,
                                           options_.threads, progress.portion(0, 0.7));
    if (!layers) return layers.error();
    outcome.layers = layers->stats;
    outcome.below = layers->below;
    state.below.insert(state.below.end(), layers->below.begin(), layers->below.end());
    for (std::size_t i = 1; i < old_id.size(); ++i)
      if (std::isfinite(layers->at_node[i])) state.layers[old_id[i]] = layers->at_node[i];
    Result<LayerCorrection> learnt = LayerCorrection::learn(
        member.correction, body, layers->at_node, kWantedLayers * outcome.layers_asked,
        options_.threads, progress.portion(0.7, 1));
    if (!learnt) return learnt.error();
    member.correction = std::move(*learnt);
    return {};
  }

  void keep(MeshState next, IterationRecord record, Clock::time_point start) {
    record.iteration = static_cast<int>(records_.size());
    sum_layers(record);
    record.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const auto change = [](double a, double b) { return std::abs(a - b) / std::max(b, 1e-300); };
    settled_ = false;
    // Fuzzy and exact interfaces cannot be compared.
    if (record.iteration > 1 && (record.mixed > 0) == (records_.back().mixed > 0)) {
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
    for (BodyOutcome& body : outcomes_) body.records.push_back(record);
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
      const Member& member = members_[partition_->region_of(x)];
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
    const auto count = static_cast<double>(members_.size());
    state.layers.assign(state.mesh.points.size(), std::numeric_limits<double>::quiet_NaN());
    state.below.clear();
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const auto at = static_cast<double>(m);
      Result<Layers> layers =
          measure_layers_within(state.mesh, members_[m].part.surface, outcomes_[m].layers_asked,
                                options_.threads, progress.portion(at / count, (at + 1) / count));
      if (!layers) return layers.error();
      outcomes_[m].layers = layers->stats;
      outcomes_[m].below = layers->below;
      state.below.insert(state.below.end(), layers->below.begin(), layers->below.end());
      for (std::size_t i = 1; i < state.layers.size(); ++i)
        if (partition_->region_of(state.mesh.points[i]) == static_cast<int>(m))
          state.layers[i] = layers->at_node[i];
    }
    return {};
  }

  void count(const std::vector<FillingError>& errors) {
    for (std::size_t m = 0; m < errors.size(); ++m) {
      outcomes_[m].mesh_volume = errors[m].volume;
      outcomes_[m].interface_error = errors[m].relative_l2;
    }
  }

  /// Of the bodies, not of what is around them.
  void sum_layers(IterationRecord& record) const {
    double places = 0;
    bool first = true;
    LayerStats& all = record.layers;
    for (std::size_t m = 0; m + 1 < members_.size(); ++m) {
      const LayerStats& of = outcomes_[m].layers;
      if (of.places == 0) continue;
      const auto p = static_cast<double>(of.places);
      all.mean += p * of.mean;
      all.share_reached += p * of.share_reached;
      all.p5 = first ? of.p5 : std::min(all.p5, of.p5);
      all.p50 = first ? of.p50 : std::min(all.p50, of.p50);
      all.p95 = std::max(all.p95, of.p95);
      all.places += of.places;
      places += p;
      first = false;
    }
    if (places > 0) {
      all.mean /= places;
      all.share_reached /= places;
    }
  }

  const Study& study_;
  const StudyOptions& options_;
  std::vector<Member> members_;  // [region], what is around the bodies last
  std::unique_ptr<const Partition<3>> partition_;
  std::optional<ReferenceSurface<3>> domain_surface_;
  /// What holds the boundary and the interfaces, once the mesh was cut.
  std::unique_ptr<const ReferenceSurface<3>> exact_;
  std::vector<std::int32_t> body_of_;  // [region] body of the exact mesh, -1: dropped
  double chord_tolerance_ = 0;
  std::string first_mesh_by_;
  MeshState current_;
  std::vector<BodyOutcome> outcomes_;  // [region]
  std::vector<IterationRecord> records_;
  bool settled_ = false;
};

}  // namespace

Result<Outcome> run_assembly(const Study& study, const std::vector<Part>& parts,
                             const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                             const Progress& progress, const IterationSink& on_iteration) {
  const auto start = Clock::now();
  Outcome outcome;
  AssemblyLoop loop(study);
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
  for (int i = 1; i <= iterations && !outcome.cancelled; ++i) {
    const double width = (0.97 - kFirstMeshShare) / iterations;
    const Progress round =
        progress.portion(kFirstMeshShare + width * (i - 1), kFirstMeshShare + width * i,
                         "iteration " + std::to_string(i));
    const Result<void> stepped = loop.step(round);
    if (!stepped && stepped.error().code != Code::cancelled) return stepped.error();
    outcome.cancelled = !stepped;
    if (stepped) tell();
    if (study.options.until_settled && loop.settled()) break;
  }
  Result<std::vector<BodyOutcome>> closed =
      loop.finish(outcome.cancelled ? Progress{} : progress.portion(0.97, 1));
  if (!closed) {
    outcome.cancelled = true;
    closed = loop.finish(Progress{});
  }
  outcome.bodies = std::move(*closed);
  outcome.converged = !outcome.cancelled && loop.converged();
  outcome.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  progress.report(1);
  return outcome;
}

}  // namespace lamella
