#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/cad/load_parts.h"
#include "core/io/export_certificate.h"
#include "core/optimize/generate.h"
#include "core/study/report.h"
#include "core/study/run.h"

namespace lamella {

/// The one place where the programs meet the adapters: readers, meshers and exporters.

/// The bodies of the inputs (their files as paths in `files`), in order and as `study_parts` calls
/// them. Each STL has the unit of its input. Errors: those of load_parts; a missing file is
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

/// Endings of the formats `export_mesh` knows: .msh .vtu .mesh .stl.
const std::vector<std::string>& export_endings();
/// Error: usage, naming the endings, when the file's ending is none of them.
Result<void> check_export_name(const std::filesystem::path& file);

/// Writes the mesh in the format of the file's ending, reads it again and compares. Medit and STL
/// carry less than the others: the metric goes to a .sol file beside a .mesh, the names to a .json.
/// Errors: usage (ending), io, cancelled; failed when the file reads back otherwise.
Result<ExportCertificate> export_mesh(const std::filesystem::path& file, const MeshState& state,
                                      const Study& study, const std::vector<InputFile>& inputs = {},
                                      const Progress& progress = {});

/// A mesh of tetrahedra (.msh, .vtu, .mesh) with the fields its file has; the others are empty.
/// Errors: io, bad_input.
Result<MeshState> read_mesh(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace lamella
