#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"

namespace lamella {

/// An OpenFOAM case around `file`, NAME.foam, an empty file that ParaView opens: in its folder
/// constant/polyMesh (in m, which the coordinates must be), cell zones for the bodies, patches for
/// the groups and face zones for what of them lies within the mesh; 0/alpha.BODY for each body's
/// filling ratio and 0/metric for the metric at the points. The type of a patch follows its name:
/// "symm" in it makes a symmetry; gate, vent, inlet, outlet and opening a patch; all else is a
/// wall. The files of system/ are written where there are none. All boundary faces must be listed,
/// all nodes be used. An older polyMesh is replaced. Errors: io; cancelled.
Result<void> write_open_foam(const SimplexMesh<3>& mesh, const MeshFields& fields,
                             const std::filesystem::path& file, const Progress& progress = {});

/// "patch", "wall" or "symmetry".
std::string patch_type(const std::string& group);

/// A case of tetrahedra in ASCII. Coordinates are in m. Errors: io; bad_input (other cells, binary,
/// damaged).
Result<MeshContent> read_open_foam(const std::filesystem::path& file,
                                   const Progress& progress = {});

}  // namespace lamella
