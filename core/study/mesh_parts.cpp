#include "core/study/mesh_parts.h"

#include <algorithm>
#include <map>

#include "core/geometry/soup.h"
#include "core/mesh/boundary.h"
#include "core/study/measure.h"
#include "core/study/request.h"

namespace lamella {
namespace {

/// Whether it is a name that an export makes by itself ("walls", "NAME walls", "a|b").
bool is_made(const std::string& group) {
  return group == group_kind_name(GroupKind::walls) || group.ends_with(" walls") ||
         group.find('|') != std::string::npos;
}

/// Divides the faces by the group of their facets, which names them.
void divide_by_group(const std::vector<std::int32_t>& facet_group,
                     const std::vector<std::string>& names, ReferenceSurface<3>& surface) {
  std::map<std::array<std::int32_t, 2>, std::int32_t> faces;  // (patch, group)
  surface.faces.clear();
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const std::int32_t group = facet_group[f];
    const auto [face, added] = faces.try_emplace({surface.facet_face[f], group},
                                                 static_cast<std::int32_t>(surface.faces.size()));
    if (added) surface.faces.push_back({names.at(static_cast<std::size_t>(group))});
    surface.facet_face[f] = face->second;
  }
}

}  // namespace

Result<std::vector<Part>> parts_of_mesh(const SimplexMesh<3>& mesh, const Progress& progress) {
  std::vector<Part> parts;
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    if (progress.cancelled()) return cancelled_error();
    const SimplexMesh<3> body = extract_body(mesh, static_cast<std::int32_t>(b));
    if (body.elements.empty()) continue;
    Part part;
    part.name = mesh.bodies[b];
    if (part.name == kBackground) {
      // Taken by what will be around all bodies of a study.
      part.name += " 1";
      part.notes.push_back("It was called \"" + mesh.bodies[b] + "\", which no body can be.");
    }
    part.surface = surface_of_facets(body);
    if (const Result<void> closed = check_closed(part.surface); !closed)
      return Error{Code::bad_input,
                   "body \"" + part.name + "\" of the mesh: " + closed.error().message,
                   "Check the mesh (lamella-cli check)."};
    find_features(part.surface, SoupParams{}.feature_angle);
    divide_by_group(body.facet_group, body.groups, part.surface);
    part.cad_volume = enclosed_measure(part.surface);
    for (const SurfaceFace& face : part.surface.faces)
      if (!is_made(face.name) &&
          std::find(part.groups.begin(), part.groups.end(), face.name) == part.groups.end())
        part.groups.push_back(face.name);
    part.notes.emplace_back("Its shape is the boundary of a mesh, chords and all.");
    parts.push_back(std::move(part));
    progress.report(static_cast<double>(b + 1) / static_cast<double>(mesh.bodies.size()));
  }
  if (parts.empty())
    return Error{Code::bad_input, "the mesh has no element", "Give one of tetrahedra."};
  return parts;
}

void add_groups_of_file(const Part& part, Study& study) {
  for (const std::string& name : part.groups) {
    const bool taken =
        std::any_of(study.groups.begin(), study.groups.end(), [&](const BoundaryGroup& group) {
          return (group.body.empty() || group.body == part.name) &&
                 std::find(group.face_names.begin(), group.face_names.end(), name) !=
                     group.face_names.end();
        });
    if (taken) continue;
    BoundaryGroup group;
    group.name = name;
    group.kind = group_kind_of(name);
    group.body = part.name;
    group.face_names = {name};
    study.groups.push_back(std::move(group));
  }
}

}  // namespace lamella
