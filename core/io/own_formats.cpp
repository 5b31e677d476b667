#include <cstdio>

#include "core/geometry/surface.h"
#include "core/io/abaqus.h"
#include "core/io/cimlib.h"
#include "core/io/medit.h"
#include "core/io/mesh_format.h"
#include "core/io/msh.h"
#include "core/io/nastran.h"
#include "core/io/open_foam.h"
#include "core/io/stl.h"
#include "core/io/unv.h"
#include "core/mesh/fitness.h"

namespace lamella {

namespace {

namespace fs = std::filesystem;
using Notes = MeshFormat::Notes;

Result<Notes> without_notes(const Result<void>& done) {
  return done ? Result<Notes>(Notes{}) : Result<Notes>(done.error());
}

/// A writer that takes mesh, fields, file and progress.
template <class Write>
auto plain(const Write& write) {
  return [write](const SimplexMesh<3>& mesh, const MeshFields& fields, const fs::path& file,
                 const Progress& progress) {
    return without_notes(write(mesh, fields, file, progress));
  };
}

MeshFormat msh() {
  MeshFormat f;
  f.name = "msh";
  f.title = "Gmsh MSH 4.1";
  f.endings = {".msh"};
  f.filling = f.metric = true;
  f.names = {.longest = 100};
  f.write = [](const SimplexMesh<3>& mesh, const MeshFields& fields, const fs::path& file,
               const Progress& p) { return without_notes(write_msh(mesh, fields, file, {}, p)); };
  f.read = [](const fs::path& file, const Progress&) { return read_msh(file); };
  return f;
}

MeshFormat msh22() {
  MeshFormat f = msh();
  f.name = "msh22";
  f.title = "Gmsh MSH 2.2";
  f.endings = {".msh2"};
  f.write = plain(write_msh22);
  return f;
}

MeshFormat medit() {
  MeshFormat f;
  f.name = "medit";
  f.title = "Medit";
  f.endings = {".mesh", ".meshb"};
  f.names = {.references = true};
  f.write = [](const SimplexMesh<3>& mesh, const MeshFields&, const fs::path& file,
               const Progress& p) { return without_notes(write_medit<3>(mesh, file, p)); };
  f.read = [](const fs::path& file, const Progress& p) -> Result<MeshContent> {
    Result<SimplexMesh<3>> mesh = read_medit<3>(file, p);
    if (!mesh) return mesh.error();
    MeshContent content;
    content.mesh = std::move(*mesh);
    return content;
  };
  return f;
}

MeshFormat open_foam() {
  MeshFormat f;
  f.name = "openfoam";
  f.title = "OpenFOAM case";
  f.endings = {".foam"};
  f.filling = f.metric = f.meters = f.compact = true;
  f.names = {.any = false, .marks = "_-.", .shared = true};
  f.write = [](const SimplexMesh<3>& mesh, const MeshFields& fields, const fs::path& file,
               const Progress& progress) -> Result<Notes> {
    if (auto done = write_open_foam(mesh, fields, file, progress.portion(0, 0.8)); !done)
      return done.error();
    const Result<Fitness> found = fitness(mesh, progress.portion(0.8, 1));
    if (!found) return found.error();
    char line[240];
    std::snprintf(line, sizeof line,
                  "non-orthogonality: largest %.1f degrees, mean %.1f; %zu of %zu inner faces are "
                  "beyond 70",
                  found->non_orthogonality, found->non_orthogonality_mean, found->beyond_70,
                  found->inner_faces);
    Notes notes = {line};
    if (found->beyond_70 > 0)
      notes.push_back(
          "beyond 70 degrees OpenFOAM needs non-orthogonal correctors and limited schemes; adapt "
          "the mesh with a smaller --max-anisotropy, or mesh with one, if the solver does not "
          "converge");
    return notes;
  };
  f.read = read_open_foam;
  return f;
}

MeshFormat abaqus() {
  MeshFormat f;
  f.name = "abaqus";
  f.title = "Abaqus, CalculiX";
  f.endings = {".inp"};
  f.names = {.any = false, .marks = "_-", .longest = 72, .shared = true};
  f.write = plain(write_abaqus);
  f.read = read_abaqus;
  return f;
}

MeshFormat unv() {
  MeshFormat f;
  f.name = "unv";
  f.title = "I-deas universal";
  f.endings = {".unv"};
  f.names = {.any = false, .marks = "_-.", .longest = 40, .shared = true};
  f.write = plain(write_unv);
  f.read = read_unv;
  return f;
}

MeshFormat nastran() {
  MeshFormat f;
  f.name = "nastran";
  f.title = "Nastran bulk data";
  f.endings = {".bdf", ".nas"};
  f.names = {.longest = 60, .shared = true};
  f.write = plain(write_nastran);
  f.read = read_nastran;
  return f;
}

MeshFormat cimlib() {
  MeshFormat f;
  f.name = "cimlib";
  f.title = "CIMlib, Rem3D";
  f.endings = {".t"};
  f.bodies = f.groups = false;
  f.compact = true;
  f.write = [](const SimplexMesh<3>& mesh, const MeshFields&, const fs::path& file,
               const Progress& p) { return without_notes(write_cimlib(mesh, file, p)); };
  f.read = read_cimlib;
  return f;
}

MeshFormat stl() {
  MeshFormat f;
  f.name = "stl";
  f.title = "STL, boundary only";
  f.endings = {".stl"};
  f.bodies = f.groups = false;
  f.boundary_only = true;
  f.write = [](const SimplexMesh<3>& mesh, const MeshFields&, const fs::path& file,
               const Progress&) {
    // The whole boundary, bodies side by side.
    ReferenceSurface<3> surface;
    surface.points = mesh.points;
    for (const auto& facet : mesh.facets) surface.facets.push_back(facet);
    surface.facet_face.assign(surface.facets.size(), 0);
    surface.faces.resize(1);
    return without_notes(write_stl(surface, file));
  };
  return f;
}

}  // namespace

std::vector<MeshFormat> own_formats() {
  return {msh(), msh22(), open_foam(), abaqus(), medit(), unv(), nastran(), cimlib(), stl()};
}

}  // namespace lamella
