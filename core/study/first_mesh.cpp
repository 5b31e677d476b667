#include "core/study/first_mesh.h"

#include "core/mesh/validate.h"

namespace lamella {

Result<FirstMesh> first_mesh(const Part& part,
                             const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                             const Progress& progress) {
  FirstMesh first;
  Error last{Code::failed, "No mesher was given.", ""};
  const double width = 1.0 / static_cast<double>(std::max<std::size_t>(1, meshers.size()));
  for (std::size_t i = 0; i < meshers.size(); ++i) {
    const double begin = width * static_cast<double>(i);
    Result<SimplexMesh<3>> mesh =
        meshers[i]->generate(part.surface, progress.portion(begin, begin + width));
    if (mesh) {
      Result<void> valid = validate<3>(*mesh, progress.portion(begin + width, begin + width));
      if (valid) {
        first.mesh = std::move(*mesh);
        first.made_by = meshers[i]->name();
        return first;
      }
      mesh = valid.error();
    }
    if (mesh.error().code == Code::cancelled) return mesh.error();
    first.notes.push_back("First mesh: " + meshers[i]->name() +
                          " gave up: " + mesh.error().message);
    last = mesh.error();
  }
  return Error{Code::failed,
               "Body \"" + part.name + "\": no first mesh could be made. " + last.message,
               last.hint.empty() ? "Try another chord tolerance, or repair the part." : last.hint};
}

}  // namespace lamella
