#include "core/io_vtk/vtk_formats.h"

#include "core/io/read_in_child.h"
#include "core/io/vtu.h"
#include "core/io_vtk/exodus.h"
#include "core/io_vtk/vtu.h"

namespace lamella {

namespace {

/// A writer without notes.
auto plain(Result<void> (*write)(const SimplexMesh<3>&, const MeshFields&,
                                 const std::filesystem::path&, const Progress&)) {
  return [write](const SimplexMesh<3>& mesh, const MeshFields& fields,
                 const std::filesystem::path& file,
                 const Progress& progress) -> Result<MeshFormat::Notes> {
    if (Result<void> done = write(mesh, fields, file, progress); !done) return done.error();
    return MeshFormat::Notes{};
  };
}

}  // namespace

std::vector<MeshFormat> vtk_formats() {
  MeshFormat vtu;
  vtu.name = "vtu";
  vtu.title = "VTK VTU";
  vtu.endings = {".vtu"};
  vtu.filling = vtu.metric = vtu.provenance = vtu.names.exact = true;
  vtu.write = plain(write_vtu);
  // VTK and its netCDF believe the lengths that a damaged file states.
  vtu.read = [](const std::filesystem::path& file,
                const Progress& progress) -> Result<MeshContent> {
    if (auto content = read_appended_vtu(file, progress)) return std::move(*content);
    return read_in_child(
        file, [](const std::filesystem::path& f, const Progress&) { return read_vtu(f); },
        progress);
  };
  MeshFormat exodus;
  exodus.name = "exodus";
  exodus.title = "Exodus II";
  exodus.endings = {".exo", ".e"};
  exodus.filling = exodus.metric = true;
  exodus.names = {.longest = 60, .shared = true};  // 80 with "filling "
  exodus.write = plain(write_exodus);
  exodus.read = [](const std::filesystem::path& file, const Progress& progress) {
    return read_in_child(file, read_exodus, progress);
  };
  return {vtu, exodus};
}

}  // namespace lamella
