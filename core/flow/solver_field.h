#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/io/mesh_fields.h"

namespace lamella {

/// A field that another solver has found, on its mesh in mm.
struct SolverField {
  SimplexMesh<3> mesh;
  NodeField field;
};

/// The field `name` of what was read from `file`, a length of which is `unit` mm. Errors: usage (no
/// such field; the hint names those there are), bad_input (NaN or infinity at nodes of elements).
Result<SolverField> solver_field(MeshContent content, const std::string& name, double unit,
                                 const std::string& file);

/// Numbers of the elements become fields of the nodes, behind those there are: the mean of the
/// elements around, weighted by their volumes. Names that nodes have already are left out.
void elements_to_nodes(MeshContent& content);

/// Units that other programs write lengths in, and what they are in mm.
struct FileUnit {
  std::string_view name;
  double mm;
};
inline constexpr FileUnit kFileUnits[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"inch", 25.4}};

/// That in which a mesh `across` units in extent comes nearest to a body of `size` mm.
const FileUnit& likely_unit(double across, double size);

/// Diagonal of the box of the nodes that elements use.
double diagonal_of_nodes(const SimplexMesh<3>& mesh);

}  // namespace lamella
