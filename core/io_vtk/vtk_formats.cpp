#include "core/io_vtk/vtk_formats.h"

#include "core/io_vtk/vtu.h"

namespace lamella {

std::vector<MeshFormat> vtk_formats() {
  MeshFormat vtu;
  vtu.name = "vtu";
  vtu.title = "VTK VTU";
  vtu.endings = {".vtu"};
  vtu.filling = vtu.metric = vtu.provenance = vtu.names.exact = true;
  vtu.write = [](const SimplexMesh<3>& mesh, const MeshFields& fields,
                 const std::filesystem::path& file,
                 const Progress& progress) -> Result<MeshFormat::Notes> {
    if (Result<void> done = write_vtu(mesh, fields, file, progress); !done) return done.error();
    return MeshFormat::Notes{};
  };
  vtu.read = [](const std::filesystem::path& file, const Progress&) { return read_vtu(file); };
  return {vtu};
}

}  // namespace lamella
