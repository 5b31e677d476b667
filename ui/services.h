#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/cad/load_parts.h"
#include "core/io/export_certificate.h"
#include "core/io/mesh_format.h"
#include "core/natural/thickness_map.h"
#include "core/optimize/generate.h"
#include "core/study/forecast.h"
#include "core/study/run.h"
#include "core/study/study_field.h"

namespace lamella::ui {

/// What the window asks of the rest of the program. The window knows no reader, no mesher and no
/// writer: whoever starts it hands these over. All of them are called from the worker thread.
struct Services {
  /// The bodies of a STEP or STL file.
  std::function<Result<std::vector<Part>>(const std::filesystem::path&, const LoadParams&,
                                          const Progress&)>
      load_parts;
  /// The first-mesh makers for a seed, in the order to try.
  std::function<std::vector<std::shared_ptr<const VolumeMesher>>(std::uint64_t)> meshers;
  /// The main loop, see core/study/run.h.
  std::function<Result<Outcome>(const Study&, const std::vector<Part>&,
                                const std::vector<std::shared_ptr<const VolumeMesher>>&, Progress,
                                IterationSink, std::shared_ptr<const SolverField>)>
      run;
  /// The result of another solver, with its fields at the nodes.
  ResultReader read_result;
  /// The mesh to expect, from first meshes made before, see core/study/forecast.h.
  std::function<Result<std::vector<BodyForecast>>(const std::vector<FirstMesh>&, const Study&,
                                                  const std::vector<Part>&, const Progress&)>
      forecast;
  /// Of meshes, as the dialogs offer them.
  MeshFormats formats;
  /// Writes a mesh.
  std::function<Result<ExportCertificate>(const std::filesystem::path&, const MeshState&,
                                          const Study&, const ExportOptions&, const Progress&)>
      export_mesh;
  /// Writes a part made by code and names the file: plate, ribbed_tray, curved_shell, t_junction
  /// or twisted_tube.
  std::function<Result<std::filesystem::path>(const std::string& name)> sample_part;
  /// Wall thickness on a surface, before there is a mesh, see core/natural/thickness_map.h.
  std::function<Result<ThicknessMap>(const ReferenceSurface<3>&, const Progress&)> thickness_map;
  /// A volume mesh to look at; fields the file has not are left empty.
  std::function<Result<MeshState>(const std::filesystem::path&)> read_mesh;
};

}  // namespace lamella::ui
