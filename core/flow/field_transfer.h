#pragma once

#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

struct TransferredField {
  std::vector<double> values;  ///< [node * components + component], the virtual node too
  std::size_t outside = 0;     ///< nodes that take what is nearest
  double farthest = 0;         ///< mm, of these from the mesh of the field
};

/// A field at the nodes of one mesh, linear in between, at the nodes of another of the same body.
/// `across` (mm) is the extent of all that the field is to cover, where `to` is a part of it.
/// Errors: bad_input (field of another length, or meshes that do not lie on one another: another
/// unit or place), cancelled.
Result<TransferredField> transfer_field(const SimplexMesh<3>& from,
                                        const std::vector<double>& values, int components,
                                        const SimplexMesh<3>& to, int threads = 0,
                                        const Progress& progress = {},
                                        std::optional<double> across = {});

/// Whether half of the area of a surface, at least, lies on the mesh of a field, as above. Errors:
/// bad_input, cancelled.
Result<void> check_place(const SimplexMesh<3>& from, const ReferenceSurface<3>& surface,
                         double across, int threads = 0, const Progress& progress = {});

}  // namespace lamella
