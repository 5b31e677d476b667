#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/cad/load_parts.h"
#include "core/io/export_certificate.h"
#include "core/io/mesh_format.h"
#include "core/optimize/generate.h"
#include "core/study/report.h"
#include "core/study/run.h"

namespace lamella {

/// The one place where the programs meet the adapters: readers, meshers and exporters.

/// Whether a file is one of a mesh that this build can read, by its ending.
bool names_mesh(const std::filesystem::path& file);

/// `load_parts`, or the bodies of a mesh in any format, as core/study/mesh_parts.h has them.
/// Errors: those of both, and of reading the mesh.
Result<std::vector<Part>> load_bodies(const std::filesystem::path& file, const LoadParams& params,
                                      const Progress& progress = {});

/// The bodies of the inputs (their files as paths in `files`), in order and as `study_parts` calls
/// them. Each STL has the unit of its input. Errors: those of load_bodies; a missing file is
/// bad_input.
Result<std::vector<Part>> load_all(const std::vector<std::filesystem::path>& files,
                                   const Study& study, const LoadParams& params,
                                   const Progress& progress = {});

/// Which engine makes the first mesh.
enum class MesherChoice {
  automatic,    ///< algorithm 2.1, and Netgen where it stalls
  topological,  ///< algorithm 2.1 alone
  netgen        ///< Netgen alone
};
std::vector<std::shared_ptr<const VolumeMesher>> meshers_for(MesherChoice choice,
                                                             std::uint64_t seed = 1);

/// All formats of this build, those whose library is missing with their reason.
const MeshFormats& mesh_formats();

/// Error: usage when the file's ending (or the format asked) names none, or the folder is missing.
Result<void> check_export_name(const std::filesystem::path& file,
                               const ExportOptions& options = {});

/// Writes the mesh, reads it again and compares (core/io/mesh_file.h). An OpenFOAM case without the
/// ending .foam is a folder, which is made. Errors: usage (ending), io, cancelled; failed when the
/// file reads back otherwise.
Result<ExportCertificate> export_mesh(const std::filesystem::path& file, const MeshState& state,
                                      const Study& study, const std::vector<InputFile>& inputs = {},
                                      const Progress& progress = {},
                                      const ExportOptions& options = {});

/// Reads a mesh and writes it as another file, with all its fields and what is known of where it
/// comes from. Errors: those of read_mesh and export_mesh.
Result<ExportCertificate> convert_mesh(const std::filesystem::path& from,
                                       const std::filesystem::path& to,
                                       const ExportOptions& options = {},
                                       const Progress& progress = {});

/// A mesh file with all that it holds. Errors: io, bad_input.
Result<MeshContent> read_content(const std::filesystem::path& file, const Progress& progress = {});

/// What any solver has written, with all its numbers and vectors at the nodes (`of_nodes`): VTU and
/// VTK in any layout and of any cells, other formats as `read_content` reads them, numbers of
/// elements averaged at the nodes. Errors: bad_input, io, cancelled.
Result<MeshContent> read_result(const std::filesystem::path& file, const Progress& progress = {});

/// A mesh of tetrahedra with the fields its file has; the others are empty. Errors: io, bad_input.
Result<MeshState> read_mesh(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace lamella
