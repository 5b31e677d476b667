#pragma once

#include "core/io/export_certificate.h"
#include "core/io/mesh_format.h"

namespace lamella {

/// A mesh with all that belongs to it, in any format. What a format has no place for goes into
/// files beside it: FILE.json (names, unit, provenance, filling ratios of elements that more than
/// one body fills) and, for the metric, FILE.sol or, of a .mesh, the .sol that Medit looks for.

/// Takes the nodes that no element uses out of the mesh and of its fields, such as those in the
/// middle of edges when elements of second order were read by their corners.
void drop_unused_nodes(MeshContent& content);

/// FILE.json.
std::filesystem::path sidecar_of(const std::filesystem::path& file);

/// Writes the mesh, reads it again and compares: names, counts, areas, volumes, and the metric and
/// the filled volumes where there are some. `fields.provenance` is a JSON object, its arrays
/// "bodies" and "groups" as those of the mesh; it becomes part of the sidecar. `unit` is that of
/// the file. Errors: io, cancelled; failed when the file reads back otherwise.
Result<ExportCertificate> write_mesh_file(const MeshFormat& format, const SimplexMesh<3>& mesh,
                                          const MeshFields& fields,
                                          const std::filesystem::path& file,
                                          LengthUnit unit = LengthUnit::mm,
                                          const Progress& progress = {});

/// A mesh of tetrahedra in mm, with the names and the fields of the files beside it, if these were
/// written with it. Errors: io, bad_input.
Result<MeshContent> read_mesh_file(const MeshFormat& format, const std::filesystem::path& file,
                                   const Progress& progress = {});

/// Takes names, unit, metric and filling ratios from the sidecar, if there is one that was written
/// with this mesh, and turns all lengths into mm. Errors: bad_input (a file beside
/// it is damaged).
Result<void> complete(MeshContent& content, const std::filesystem::path& file);

}  // namespace lamella
