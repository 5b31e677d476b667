#include "app/window_services.h"

#include "app/services.h"
#include "core/cad/sample_parts.h"

namespace lamella {

ui::Services window_services(const std::filesystem::path& sample_folder) {
  ui::Services services;
  services.load_parts = [](const std::filesystem::path& file, const LoadParams& params,
                           const Progress& progress) {
    return load_bodies(file, params, progress);
  };
  services.meshers = [](std::uint64_t seed) { return meshers_for(MesherChoice::automatic, seed); };
  services.run = run;
  services.read_result = read_result;
  services.forecast = forecast_from;
  services.formats = mesh_formats();
  services.export_mesh = [](const std::filesystem::path& file, const MeshState& state,
                            const Study& study, const ExportOptions& options,
                            const Progress& progress) {
    return export_mesh(file, state, study, inputs_of(study), progress, options);
  };
  services.sample_part =
      [folder = sample_folder](const std::string& name) -> Result<std::filesystem::path> {
    std::error_code ec;
    std::filesystem::create_directories(folder, ec);
    const std::filesystem::path file = folder / (name + ".step");
    if (const Result<void> written = write_sample(name, file); !written) return written.error();
    return file;
  };
  services.thickness_map = [](const ReferenceSurface<3>& surface, const Progress& progress) {
    return thickness_map(surface, 0, progress);
  };
  services.read_mesh = [](const std::filesystem::path& file) { return read_mesh(file); };
  return services;
}

}  // namespace lamella
