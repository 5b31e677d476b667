#include "core/study/assembly_members.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/parallel.h"
#include "core/geometry/soup.h"
#include "core/geometry/triangles.h"
#include "core/mesh/boundary.h"
#include "core/mesh/interfaces.h"
#include "core/mesh/sample_meshes.h"
#include "core/multidomain/overlap.h"
#include "core/natural/boundary_distance.h"
#include "core/optimize/ease.h"
#include "core/study/domain.h"
#include "core/study/first_mesh.h"
#include "core/study/join.h"
#include "core/study/measure.h"
#include "core/study/request.h"
#include "core/study/zone_surface.h"

namespace lamella {

namespace {

constexpr int kCells = 6;          // of the first mesh of a box, along its longest side
constexpr double kOfLayer = 0.25;  // size across a fuzzy border, of the layer there
constexpr double kMinGuardShare = 0.3;
// Of poor elements: quality, and the shares of the tolerance that nodes leave curved and all
// borders by.
constexpr EaseParams kEased[] = {{0.3, 0.05, 0}, {0.2, 0.25, 0.25}};
constexpr double kUnseen = 0.01;  // of the tolerance: what lies deeper in others is no border

Box<3> box_of(const ReferenceSurface<3>& surface) {
  Box<3> box;
  for (const Vec<3>& p : surface.points) box.add(p);
  return box;
}

class Layout {
 public:
  Layout(const Study& study, const std::vector<Part>& parts)
      : study_(study), options_(study.options), parts_(parts) {
    if (const auto* body = std::get_if<DomainBody>(&study.domain->shape)) background_ = body->name;
  }

  Result<Assembly> run(const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                       const Progress& progress) {
    if (Result<void> possible = check(); !possible) return possible.error();
    Result<StudyZone> hull = domain_hull(study_, parts_);
    if (!hull) return hull.error();
    hull_ = std::move(*hull);
    // The natural size will do where faces of the mesh are the border.
    assembly_.border_share = options_.interfaces == Interfaces::exact ? 1 : kOfLayer;
    const Part* domain = part_called(background_);
    const Box<3> box = domain ? box_of(domain->surface) : make_zone(hull_, {hull_})->box();
    assembly_.chord_tolerance = options_.chord_tolerance.value_or(1e-3 * (box.hi - box.lo).norm());
    if (Result<void> added = add_bodies(); !added) return added.error();
    if (Result<void> meshed = mesh_domain(domain, meshers, progress); !meshed)
      return meshed.error();
    if (Result<void> found = find_shares(progress); !found) return found.error();
    add_background(domain);
    for (Member& member : assembly_.members)
      if (Result<void> ready = prepare(member); !ready) return ready.error();
    if (Result<void> chosen = choose_bodies(); !chosen) return chosen.error();
    tell_overlaps();
    return std::move(assembly_);
  }

 private:
  Result<void> check() const {
    if (options_.detector != Detector::geometric)
      return Error{Code::usage, "One mesh of several bodies needs the geometric detector.",
                   "Leave the detector out."};
    if (options_.progressive)
      return Error{Code::usage, "One mesh of several bodies asks for all layers at once.",
                   "Leave progressive out."};
    return {};
  }

  const Part* part_called(const std::string& name) const {
    for (const Part& part : parts_)
      if (part.name == name) return &part;
    return nullptr;
  }

  /// Parts and zones but the domain, and the partition that they make.
  Result<void> add_bodies() {
    std::vector<Region<3>> regions;
    double chord_error = 0;
    for (const RankedBody& body : by_rank(study_, parts_)) {
      Member member;
      if (body.part) {
        const Part& part = *body.part;
        chord_error = std::max(chord_error, part.chord_error);
        if (part.name == background_) continue;
        member.part = part;
        if (Result<void> divided = divide(member.part, member.groups); !divided) return divided;
        assembly_.members.push_back(std::move(member));
        regions.push_back({part.name, surface_zone<3>(part.surface)});
        continue;
      }
      const StudyZone& zone = *body.zone;
      if (zone.name == background_) continue;
      member.part.name = zone.name;
      member.part.chord_error = tessellation_share * assembly_.chord_tolerance;
      Result<ReferenceSurface<3>> surface =
          zone_surface(zone, study_.zones, hull_, member.part.chord_error);
      if (!surface) return surface.error();
      chord_error = std::max(chord_error, member.part.chord_error);
      member.endless = std::holds_alternative<ZoneHalfSpace>(zone.shape) ||
                       std::holds_alternative<ZoneCell>(zone.shape);
      member.part.surface = std::move(*surface);
      member.part.cad_volume = zone_volume(zone, member.part.surface, hull_);
      assembly_.members.push_back(std::move(member));
      // There is nothing between the cells.
      assembly_.full = assembly_.full || std::holds_alternative<ZoneCell>(zone.shape);
      regions.push_back({zone.name, make_zone(zone, study_.zones)});
    }
    if (assembly_.members.empty())
      return Error{Code::usage, "The domain holds no body.", "Add a part or a zone to the study."};
    assembly_.partition = std::make_unique<Partition<3>>(regions, background_);
    regions_ = std::move(regions);
    const Part* domain = part_called(background_);
    assembly_.domain = domain ? surface_zone<3>(domain->surface) : make_zone(hull_, {hull_});
    assembly_.mesh_tolerance = std::max(assembly_.chord_tolerance - chord_error,
                                        kMinGuardShare * assembly_.chord_tolerance);
    return {};
  }

  /// Faces of the part divided where the study's groups cover them in part.
  Result<void> divide(Part& part, std::unique_ptr<const FaceGroups>& groups) const {
    const std::vector<BoundaryGroup> asked = groups_of(study_, part.name);
    if (asked.empty()) return {};
    Result<GroupedSurface> grouped = group_faces(asked, part.surface);
    if (!grouped) return grouped.error();
    part.surface = std::move(grouped->surface);
    groups = std::make_unique<const FaceGroups>(std::move(grouped->groups));
    return {};
  }

  /// A box is meshed right away, anything else from its surface.
  Result<void> mesh_domain(const Part* domain,
                           const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                           const Progress& progress) {
    if (const auto* box = std::get_if<ZoneBox>(&hull_.shape); box && !domain) {
      const Vec<3> side = box->high - box->low;
      std::array<int, 3> cells{};
      for (int k = 0; k < 3; ++k)
        cells[k] = std::max(2, static_cast<int>(std::lround(kCells * side[k] / side.maxCoeff())));
      first_mesh_by_ = "box";
      assembly_.first = box_mesh<3>(cells, box->low, box->high);
      return {};
    }
    Part part;
    std::unique_ptr<const FaceGroups> groups;
    if (domain) {
      part = *domain;
      if (Result<void> divided = divide(part, groups); !divided) return divided;
    } else {
      part.name = hull_.name;
      Result<ReferenceSurface<3>> surface =
          zone_surface(hull_, {hull_}, hull_, tessellation_share * assembly_.chord_tolerance);
      if (!surface) return surface.error();
      part.surface = std::move(*surface);
    }
    Result<FirstMesh> first = first_mesh(part, meshers, progress);
    if (!first) return first.error();
    first_mesh_by_ = first->made_by;
    assembly_.first = std::move(first->mesh);
    if (groups) put_in_groups(*groups, 0, assembly_.first);
    assembly_.wall = std::move(part.surface);
    return {};
  }

  /// What is around the bodies has the domain's wall, and theirs from the other side.
  void add_background(const Part* domain) {
    Member around;
    around.part.name = background_;
    around.part.surface = surface_of_facets(assembly_.first);
    around.bounds = around.part.surface;
    const Box<3> box = box_of(around.part.surface);
    double volume = domain ? domain->cad_volume : enclosed_measure(around.part.surface);
    bool known = true;
    for (Member& member : assembly_.members) {
      // Of a body that the domain cuts no volume is known; none compares itself with it.
      const Box<3> own = box_of(member.part.surface);
      const double rounding = 1e-9 * (box.hi - box.lo).norm();
      const bool inside =
          (own.lo - box.lo).minCoeff() >= -rounding && (box.hi - own.hi).minCoeff() >= -rounding;
      if (!inside) member.part.cad_volume = 0;
      known = known && inside;
      volume -= member.part.cad_volume;
      append_reversed(member.part.surface, *assembly_.domain, *around.bounds);
      if (!inside && !member.endless) append(around.part.surface, bounds_of(member));
    }
    around.part.cad_volume = known ? volume : 0;
    assembly_.members.push_back(std::move(around));
  }

  static ReferenceSurface<3>& bounds_of(Member& member) {
    if (!member.bounds) member.bounds = member.part.surface;
    return *member.bounds;
  }

  /// Of what two bodies share the first keeps the volume, and bounds the other.
  Result<void> find_shares(const Progress& progress) {
    OverlapOptions options;
    options.threads = options_.threads;
    options.contact = assembly_.chord_tolerance;
    options.gap_width = 2 * assembly_.chord_tolerance;
    options.within = box_of(surface_of_facets(assembly_.first));
    Result<OverlapReport> report = find_overlaps(*assembly_.partition, options, progress);
    if (!report) return report.error();
    for (const Overlap& o : report->overlaps) {
      const auto left = intersection_zone<3>({regions_[o.second].zone, assembly_.domain});
      append_reversed(assembly_.members[o.first].part.surface, *left,
                      bounds_of(assembly_.members[o.second]));
    }
    shares_ = std::move(*report);
    return {};
  }

  /// Detector, sizes by hand and size across borders of a member, and its entry in the books.
  Result<void> prepare(Member& member) {
    const ReferenceSurface<3>& surface = member.part.surface;
    const BodySettings settings = settings_of(study_, member.part.name);
    member.natural = natural_params(study_, member.part);
    if (member.part.name == kBackground && !names_background(study_))
      member.natural.layers = kBackgroundLayers;
    member.detector = std::make_unique<NaturalDetector>(member.walls());
    Result<SizingField> sizing = SizingField::make(sizing_of(study_, member.part.name), surface);
    if (!sizing) return sizing.error();
    member.sizing = std::move(*sizing);
    member.interface_asked = settings.interface_size;
    if (settings.interface_size)
      member.interface_size = *settings.interface_size;
    else if (options_.interfaces == Interfaces::fuzzy)
      member.interface_size = assembly_.border_share * thinnest_layer(member);
    BodyOutcome outcome;
    outcome.name = member.part.name;
    outcome.layers_asked = member.natural.layers;
    outcome.cad_volume = member.part.cad_volume;
    outcome.chord_tolerance = assembly_.chord_tolerance;
    outcome.h_min = member.natural.h_min;
    outcome.interface_size = member.interface_size;
    outcome.first_mesh_by = first_mesh_by_;
    outcome.notes = member.part.notes;
    if (member.groups && options_.interfaces == Interfaces::fuzzy)
      outcome.notes.emplace_back(
          "Its groups are not in the mesh: fuzzy interfaces have no faces that could be in them.");
    assembly_.outcomes.push_back(std::move(outcome));
    return {};
  }

  /// The 5 % quantile of the smallest natural size on what bounds the member, mm.
  double thinnest_layer(const Member& member) const {
    constexpr std::size_t kSamples = 2000;
    const ReferenceSurface<3>& s = member.walls();
    const auto region = static_cast<int>(&member - assembly_.members.data());
    const std::size_t stride = s.facets.size() / kSamples + 1;
    std::vector<double> found((s.facets.size() + stride - 1) / stride);
    parallel_each(found.size(), options_.threads, {}, [&](std::size_t i) {
      const auto& f = s.facets[i * stride];
      const Vec<3> middle = (s.points[f[0]] + s.points[f[1]] + s.points[f[2]]) / 3;
      found[i] = assembly_.beyond(region, middle) > assembly_.chord_tolerance
                     ? std::numeric_limits<double>::infinity()
                     : sizes<3>(member.detector->at(middle, member.natural).metric)[0];
    });
    found.erase(std::remove(found.begin(), found.end(), std::numeric_limits<double>::infinity()),
                found.end());
    std::sort(found.begin(), found.end());
    return found.empty() ? diagonal_of(s.points) : found[found.size() / 20];
  }

  /// Which regions stay, numbered anew.
  Result<void> choose_bodies() {
    std::vector<Member>& members = assembly_.members;
    assembly_.body_of.assign(members.size(), 0);
    std::vector<std::string> dropped = study_.dropped;
    if (std::holds_alternative<DomainBodies>(study_.domain->shape) || assembly_.full)
      dropped.push_back(background_);
    for (const std::string& name : dropped) {
      const auto it = std::find_if(members.begin(), members.end(),
                                   [&](const Member& m) { return m.part.name == name; });
      if (it == members.end())
        return Error{Code::usage, "There is no body \"" + name + "\" that could be dropped.",
                     "What is around the bodies is called \"" + background_ + "\"."};
      assembly_.body_of[it - members.begin()] = -1;
    }
    if (dropped.size() > (assembly_.full ? 1 : 0) && options_.interfaces == Interfaces::fuzzy)
      return Error{Code::usage, "Bodies can be dropped from a mesh with exact interfaces only.",
                   "Ask for exact interfaces, or give a domain around the bodies."};
    std::int32_t next = 0;
    for (std::int32_t& body : assembly_.body_of)
      if (body >= 0) body = next++;
    if (next == 0) return Error{Code::usage, "Nothing is left of the mesh.", "Drop fewer bodies."};
    return {};
  }

  /// Overlaps and gaps go to the notes, and from the volumes what others keep.
  void tell_overlaps() {
    std::vector<BodyOutcome>& of = assembly_.outcomes;
    for (const Overlap& o : shares_.overlaps) {
      if (of[o.second].cad_volume > 0) of[o.second].cad_volume -= o.volume;
      if (of.back().cad_volume > 0) of.back().cad_volume += o.volume;
      of[o.second].notes.push_back("Overlaps \"" + of[o.first].name + "\" by " +
                                   length_text(o.volume) + " mm3, up to " + length_text(o.depth) +
                                   " mm deep at " + place_text(o.place) +
                                   " mm, which belongs to the latter.");
    }
    for (const Gap& g : shares_.gaps)
      of[g.first].notes.push_back("A gap of " + length_text(g.volume) + " mm3 towards \"" +
                                  of[g.second].name + "\", " + length_text(g.least_width) +
                                  " mm wide at " + place_text(g.place) + " mm.");
    assembly_.overlaps = {assembly_.partition->names(), std::move(shares_)};
  }

  const Study& study_;
  const StudyOptions& options_;
  const std::vector<Part>& parts_;
  std::string background_ = kBackground;
  StudyZone hull_;
  OverlapReport shares_;
  std::vector<Region<3>> regions_;
  std::string first_mesh_by_;
  Assembly assembly_;
};

}  // namespace

double Assembly::beyond(int region, const Vec<3>& x) const {
  return std::max(partition->distance(region, x), domain->at(x).distance);
}

Result<std::vector<Vec<3>>> Assembly::measure_distances(const SimplexMesh<3>& mesh, int threads,
                                                        const Progress& progress) {
  std::vector<Vec<3>> too_far;
  const ReferenceSurface<3> all = surface_of_facets(with_interfaces(mesh));
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (body_of[m] < 0) continue;
    const SimplexMesh<3> body = extract_body(mesh, body_of[m]);
    if (body.elements.empty()) continue;
    Covered covered;
    if (members[m].bounds)
      covered = [&](const Vec<3>& x) {
        return beyond(static_cast<int>(m), x) - kUnseen * chord_tolerance;
      };
    // Where two others touch, what bounds this one is a border between them.
    const ReferenceSurface<3> own = surface_of_facets(body);
    const ReferenceSurface<3>& walls = members[m].walls();
    const Result<FarthestPoint> to = farthest_point(own, walls, 0, threads, progress);
    if (!to) return to.error();
    const Result<FarthestPoint> from =
        farthest_point(walls, covered ? all : own, 0, threads, progress, covered);
    if (!from) return from.error();
    for (const FarthestPoint& far : {*to, *from})
      if (far.distance > chord_tolerance) too_far.push_back(far.place);
    outcomes[m].boundary_distance = {*to, *from};
  }
  return too_far;
}

Result<bool> Assembly::ease(SimplexMesh<3>& mesh, MetricField<3>& metric, int threads,
                            const Progress& progress) {
  const std::vector<Vec<3>> points = mesh.points;
  const MetricField<3> before = metric;
  std::size_t moves = 0;
  for (const auto& [quality, off, across] : kEased)
    moves +=
        ease_poor(mesh, metric, {quality, off * mesh_tolerance, across * mesh_tolerance}, progress);
  if (moves == 0) return false;
  const std::vector<BodyOutcome> old = outcomes;
  const Result<std::vector<Vec<3>>> far = measure_distances(mesh, threads, progress);
  if (!far) return far.error();
  for (std::size_t m = 0; m < old.size(); ++m) {
    const double most = std::max(old[m].boundary_distance.largest(), chord_tolerance);
    if (outcomes[m].boundary_distance.largest() <= most) continue;
    mesh.points = points;
    metric = before;
    outcomes = old;
    return false;
  }
  return true;
}

ReferenceSurface<3> Assembly::borders_of(const Member& member) const {
  ReferenceSurface<3> s = member.part.surface;
  if (!member.endless) return s;
  const double on = 1e-9 * diagonal_of(s.points);
  std::map<std::array<std::int32_t, 2>, int> edges;
  std::size_t kept = 0;
  for (std::size_t f = 0; f < s.facets.size(); ++f) {
    const auto v = s.facets[f];
    const Vec<3> middle = (s.points[v[0]] + s.points[v[1]] + s.points[v[2]]) / 3;
    if (domain->at(middle).distance >= -on) continue;
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(v[k], v[(k + 1) % 3]);
      ++edges[{a, b}];
    }
    s.facet_face[kept] = s.facet_face[f];
    s.facets[kept++] = v;
  }
  s.facets.resize(kept);
  s.facet_face.resize(kept);
  std::set<std::int32_t> held;
  const auto gone = [&](const std::array<std::int32_t, 2>& e) {
    const auto [a, b] = std::minmax(e[0], e[1]);
    const auto it = edges.find({a, b});
    if (it == edges.end() || it->second < 2) return true;
    held.insert({a, b});
    return false;
  };
  s.feature_edges.erase(std::remove_if(s.feature_edges.begin(), s.feature_edges.end(), gone),
                        s.feature_edges.end());
  const auto loose = [&](std::int32_t c) { return held.count(c) == 0; };
  s.corners.erase(std::remove_if(s.corners.begin(), s.corners.end(), loose), s.corners.end());
  return s;
}

void put_in_groups(const FaceGroups& of, std::int32_t first_face, SimplexMesh<3>& mesh) {
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const std::int32_t face = mesh.facet_face[f] - first_face;
    if (face < 0 || static_cast<std::size_t>(face) >= of.face_group.size()) continue;
    const std::int32_t group = of.face_group[face];
    if (group >= 0) mesh.facet_group[f] = group_called(of.names[group], mesh.groups);
  }
}

Result<Assembly> lay_out(const Study& study, const std::vector<Part>& parts,
                         const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                         const Progress& progress) {
  return Layout(study, parts).run(meshers, progress);
}

}  // namespace lamella
