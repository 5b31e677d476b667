// Writes FOLDER/TARGET/..: what each fuzz target starts from, by Lamella's own writers.

#include <fstream>

#include "core/cad/load_parts.h"
#include "core/cad/sample_parts.h"
#include "core/io/mesh_file.h"
#include "core/io/stl.h"
#include "core/project/project_file.h"
#include "core/study/study_file.h"
#include "tests/fuzz/target.h"
#include "tests/support/three_bodies.h"

namespace {

namespace fs = std::filesystem;

void must(bool done, const char* what) { lamella::test::require(done, what); }

void write_meshes(const fs::path& folder) {
  using namespace lamella;
  const test::ThreeBodies plain, odd = test::three_bodies_of_odd_names();
  for (const MeshFormat& format : own_formats()) {
    if (format.boundary_only || format.name == "openfoam") continue;
    // Both versions of MSH have one reader.
    const fs::path own = folder / (format.name == "msh22" ? "msh" : format.name);
    fs::create_directories(own);
    for (const auto* made : {&plain, &odd}) {
      const fs::path file = test::fuzz_folder() / ("m" + format.endings.front());
      must(write_mesh_file(format, made->mesh, made->with_metric(), file).ok(), "a mesh");
      fs::copy_file(file, own / (format.name + (made == &plain ? "_plain" : "_odd_names")),
                    fs::copy_options::overwrite_existing);
    }
  }
}

void write_parts(const fs::path& folder) {
  using namespace lamella;
  fs::create_directories(folder / "step");
  fs::create_directories(folder / "stl");
  const fs::path step = test::fuzz_folder() / "plate.step";
  must(write_sample("plate", step).ok(), "a STEP file");
  fs::copy_file(step, folder / "step" / "plate", fs::copy_options::overwrite_existing);
  const auto parts = load_parts(step);
  must(parts.ok(), "a part");
  const ReferenceSurface<3>& s = parts->front().surface;
  const fs::path stl = test::fuzz_folder() / "plate.stl";
  must(write_stl(s, stl).ok(), "an STL");
  fs::copy_file(stl, folder / "stl" / "binary", fs::copy_options::overwrite_existing);
  std::ofstream text(folder / "stl" / "text");
  text << "solid plate\n";
  for (const auto& f : s.facets) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const auto v : f) text << "vertex " << s.points[v].transpose() << "\n";
    text << "endloop\nendfacet\n";
  }
  text << "endsolid plate\n";
}

void write_projects(const fs::path& folder) {
  using namespace lamella;
  fs::create_directories(folder / "project");
  ProjectContent content;
  content.study.name = "s";
  const fs::path part = test::fuzz_folder() / "a.stl";
  must(write_file(part, "solid a").ok(), "a part");
  content.study.inputs = {{part.string(), 25.4}};
  must(identify(content.study.inputs[0], part).ok(), "its hash");
  content.study.bodies = {{"a", 3}};
  const fs::path file = test::fuzz_folder() / "s.json";
  must(save_project(content, file).ok(), "a study");
  fs::copy_file(file, folder / "project" / "text", fs::copy_options::overwrite_existing);
  content.study.embed_inputs = true;
  content.report_json = "{}";
  content.write_mesh = [](const fs::path& vtu) { return write_file(vtu, "a mesh"); };
  const fs::path packed = test::fuzz_folder() / "s.lamella";
  must(save_project(content, packed).ok(), "a project");
  fs::copy_file(packed, folder / "project" / "packed", fs::copy_options::overwrite_existing);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: lamella_fuzz_seeds FOLDER\n");
    return 2;
  }
  write_meshes(arguments[1]);
  write_parts(arguments[1]);
  write_projects(arguments[1]);
  return 0;
}
