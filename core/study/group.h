#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/surface.h"

namespace lamella {

/// What a part of the boundary is to a simulation.
enum class GroupKind { other, gate, vent, symmetry, walls };

/// "other", "gate", "vent", "symmetry" or "walls".
std::string group_kind_name(GroupKind kind);
/// The kind called `name`; `other` when it is none of them.
GroupKind group_kind_of(const std::string& name);

/// The facets that can be reached from the one nearest to `point` (mm) across edges where neighbors
/// meet at no more than `angle` radians.
struct Flood {
  Vec<3> point = Vec<3>::Zero();
  double angle = 0.35;
};

/// A named part of the boundary of one body: the union of what its lists name.
struct BoundaryGroup {
  std::string name;
  GroupKind kind = GroupKind::other;
  std::string body{};                     ///< part name; empty: the only part there is
  std::vector<std::int32_t> faces{};      ///< CAD face ids
  std::vector<std::string> face_names{};  ///< all faces that have one of these names
  std::vector<Flood> floods{};
  std::optional<double> pressure{};  ///< MPa, of a gate; neither this nor a rate: 1
  std::optional<double> rate{};      ///< mm^3/s into the body, of a gate, in place of the pressure
};

/// The facets of `surface` that the group covers, in rising order, whatever body it names.
/// Errors: usage, naming the group (no such face, an angle that is not positive, nothing covered).
Result<std::vector<std::int32_t>> facets_of(const BoundaryGroup& group,
                                            const ReferenceSurface<3>& surface);

/// Which group a face belongs to, and which face of the part it is a piece of.
struct FaceGroups {
  std::vector<std::string> names;        ///< of the groups
  std::vector<std::int32_t> face_group;  ///< [face] index into `names`; -1: none
  std::vector<std::int32_t> cad_face;    ///< [face] of the part
};

/// A surface on which every face belongs to one group or none: faces that a group covers in part
/// are divided, the new ones behind the old, and borders of groups are feature edges.
struct GroupedSurface {
  ReferenceSurface<3> surface;
  FaceGroups groups;
};

/// Of two groups that cover the same facet the first has it. Groups of one name become one.
/// Errors: those of facets_of; usage (no name, nothing left by the groups before it).
Result<GroupedSurface> group_faces(const std::vector<BoundaryGroup>& groups,
                                   const ReferenceSurface<3>& surface);

}  // namespace lamella
