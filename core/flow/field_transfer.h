#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

struct TransferredField {
  std::vector<double> values;  ///< [node * components + component], the virtual node too
  std::size_t outside = 0;     ///< nodes that take what is nearest
  double farthest = 0;         ///< mm, of these from the mesh of the field
};

/// A field at the nodes of one mesh, linear in between, at the nodes of another of the same body.
/// Errors: bad_input (field of another length, or meshes that do not lie on one another: another
/// unit or place), cancelled.
Result<TransferredField> transfer_field(const SimplexMesh<3>& from,
                                        const std::vector<double>& values, int components,
                                        const SimplexMesh<3>& to, int threads = 0,
                                        const Progress& progress = {});

}  // namespace lamella
