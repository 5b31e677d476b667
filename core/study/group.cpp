#include "core/study/group.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <span>

#include "core/geometry/edge_table.h"
#include "core/geometry/locator.h"
#include "core/geometry/soup.h"

namespace lamella {

namespace {

const std::array<std::string, 5> kKinds = {"other", "gate", "vent", "symmetry", "walls"};

Error refuse(const BoundaryGroup& group, const std::string& finding, const std::string& hint) {
  return {Code::usage, "Group \"" + group.name + "\": " + finding + ".", hint};
}

double angle_between(const Vec<3>& a, const Vec<3>& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Marks what the flood reaches.
void spread(const Flood& flood, const ReferenceSurface<3>& surface, std::vector<char>& covered) {
  const Locator<3> locator(surface);
  const auto start = locator.nearest(flood.point);
  if (!start) return;
  std::vector<std::array<std::int32_t, 3>> across(surface.facets.size(), {-1, -1, -1});
  const auto link = [&](std::int32_t f, std::int32_t g) {
    *std::find(across[f].begin(), across[f].end(), -1) = g;
  };
  for_each_edge(edge_uses(surface.facets), [&](std::span<const EdgeUse> uses) {
    if (uses.size() != 2) return;
    const std::int32_t f = uses[0].facet, g = uses[1].facet;
    if (angle_between(locator.normal(f), locator.normal(g)) > flood.angle) return;
    link(f, g);
    link(g, f);
  });
  std::vector<char> reached(surface.facets.size(), 0);
  std::vector<std::int32_t> open = {start->facet};
  reached[start->facet] = 1;
  while (!open.empty()) {
    const std::int32_t f = open.back();
    open.pop_back();
    covered[f] = 1;
    for (const std::int32_t g : across[f])
      if (g >= 0 && !reached[g]) {
        reached[g] = 1;
        open.push_back(g);
      }
  }
}

/// Makes the borders between facets of different groups feature edges, and the vertices where they
/// end, meet or turn corners.
void sharpen_borders(const std::vector<std::int32_t>& facet_group, ReferenceSurface<3>& surface) {
  auto& edges = surface.feature_edges;
  std::vector<std::int32_t> touched;
  for_each_edge(edge_uses(surface.facets), [&](std::span<const EdgeUse> uses) {
    if (std::all_of(uses.begin(), uses.end(), [&](const EdgeUse& use) {
          return facet_group[use.facet] == facet_group[uses[0].facet];
        }))
      return;
    edges.push_back({uses[0].a, uses[0].b});
    touched.insert(touched.end(), {uses[0].a, uses[0].b});
  });
  for (auto& edge : edges)
    if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::sort(touched.begin(), touched.end());
  const std::vector<std::int32_t> kinks = kinks_of_features(surface);
  std::set_intersection(touched.begin(), touched.end(), kinks.begin(), kinks.end(),
                        std::back_inserter(surface.corners));
  auto& corners = surface.corners;
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
}

}  // namespace

std::string group_kind_name(GroupKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

GroupKind group_kind_of(const std::string& name) {
  const auto it = std::find(kKinds.begin(), kKinds.end(), name);
  return it == kKinds.end() ? GroupKind::other : static_cast<GroupKind>(it - kKinds.begin());
}

Result<std::vector<std::int32_t>> facets_of(const BoundaryGroup& group,
                                            const ReferenceSurface<3>& surface) {
  const auto count = static_cast<std::int32_t>(surface.faces.size());
  std::vector<char> face_covered(surface.faces.size(), 0);
  for (const std::int32_t face : group.faces) {
    if (face < 0 || face >= count)
      return refuse(group, "there is no face " + std::to_string(face),
                    "The part has the faces 0 to " + std::to_string(count - 1) + ".");
    face_covered[face] = 1;
  }
  for (const std::string& name : group.face_names) {
    bool found = false;
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
      if (!name.empty() && surface.faces[f].name == name) {
        face_covered[f] = 1;
        found = true;
      }
    if (!found)
      return refuse(group, "no face is called \"" + name + "\"",
                    "Names come with the file; pick the faces by number where it has none.");
  }
  std::vector<char> covered(surface.facets.size(), 0);
  for (std::size_t f = 0; f < covered.size(); ++f) covered[f] = face_covered[surface.facet_face[f]];
  for (const Flood& flood : group.floods) {
    if (!(flood.angle > 0) || !flood.point.allFinite())
      return refuse(group, "the angle of a flood must be positive", "0.35 is usual.");
    spread(flood, surface, covered);
  }
  std::vector<std::int32_t> facets;
  for (std::size_t f = 0; f < covered.size(); ++f)
    if (covered[f]) facets.push_back(static_cast<std::int32_t>(f));
  if (facets.empty()) return refuse(group, "it has no face", "Pick at least one.");
  return facets;
}

Result<GroupedSurface> group_faces(const std::vector<BoundaryGroup>& groups,
                                   const ReferenceSurface<3>& surface) {
  GroupedSurface grouped{surface, {}};
  ReferenceSurface<3>& s = grouped.surface;
  FaceGroups& of = grouped.groups;
  std::vector<std::int32_t> facet_group(s.facets.size(), -1);
  for (const BoundaryGroup& group : groups) {
    if (group.name.empty()) return refuse(group, "it has no name", "Give it one, as \"gate\".");
    Result<std::vector<std::int32_t>> facets = facets_of(group, surface);
    if (!facets) return facets.error();
    auto name = std::find(of.names.begin(), of.names.end(), group.name);
    if (name == of.names.end()) name = of.names.insert(name, group.name);
    const auto id = static_cast<std::int32_t>(name - of.names.begin());
    bool any = false;
    for (const std::int32_t f : *facets) {
      if (facet_group[f] < 0) facet_group[f] = id;
      any = any || facet_group[f] == id;
    }
    if (!any)
      return refuse(group, "all of its faces belong to groups before it",
                    "Take them out of one of the groups.");
  }
  // The first group met on a face keeps its number; facets of others get a new face.
  const auto cad_faces = static_cast<std::int32_t>(s.faces.size());
  constexpr std::int32_t unmet = -2;
  of.face_group.assign(s.faces.size(), unmet);
  for (std::int32_t f = 0; f < cad_faces; ++f) of.cad_face.push_back(f);
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> divided;  // (face, group)
  for (std::size_t f = 0; f < s.facets.size(); ++f) {
    const std::int32_t face = s.facet_face[f];
    if (of.face_group[face] == unmet) of.face_group[face] = facet_group[f];
    if (of.face_group[face] == facet_group[f]) continue;
    const auto [it, added] =
        divided.try_emplace({face, facet_group[f]}, static_cast<std::int32_t>(s.faces.size()));
    if (added) {
      s.faces.push_back(s.faces[static_cast<std::size_t>(face)]);
      of.face_group.push_back(facet_group[f]);
      of.cad_face.push_back(face);
    }
    s.facet_face[f] = it->second;
  }
  for (std::int32_t& group : of.face_group) group = std::max(group, -1);
  sharpen_borders(facet_group, s);
  return grouped;
}

}  // namespace lamella
