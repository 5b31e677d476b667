#include "app/services.h"

#include <algorithm>
#include <cctype>

#include "core/geometry/soup.h"
#include "core/io/medit.h"
#include "core/io/msh.h"
#include "core/io/stl.h"
#include "core/io_vtk/vtu.h"
#include "core/netgen/netgen_mesher.h"
#include "core/study/measure.h"

namespace lamella {

namespace {

namespace fs = std::filesystem;

std::string ending_of(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// The whole boundary, bodies side by side.
ReferenceSurface<3> whole_boundary(const SimplexMesh<3>& mesh) {
  ReferenceSurface<3> surface;
  for (const Vec<3>& x : mesh.points) surface.points.push_back(x);
  for (const auto& f : mesh.facets) surface.facets.push_back({f[0], f[1], f[2]});
  surface.facet_face.assign(surface.facets.size(), 0);
  surface.faces.resize(1);
  return surface;
}

/// Area and enclosed volume of triangles, as a body and a group without names.
MeshSummary summary_of(const std::vector<std::array<Vec<3>, 3>>& triangles) {
  MeshSummary s;
  double area = 0, volume = 0;
  for (const auto& t : triangles) {
    const Vec<3> normal = facet_normal<3>(t);
    area += 0.5 * normal.norm();
    volume += t[0].dot(normal) / 6;
  }
  s.bodies = {{"", 1, volume}};
  s.groups = {{"", triangles.size(), area}};
  return s;
}

MeshSummary summary_of_boundary(const SimplexMesh<3>& mesh) {
  std::vector<std::array<Vec<3>, 3>> triangles;
  for (const auto& f : mesh.facets) triangles.push_back(mesh.corners(f));
  return summary_of(triangles);
}

Result<ExportCertificate> export_msh(const fs::path& file, const MeshState& state,
                                     const MeshFields& fields, const Progress& progress) {
  if (Result<void> done = write_msh(state.mesh, fields, file, {}, progress); !done)
    return done.error();
  Result<MshContent> back = read_msh(file);
  if (!back) return back.error();
  return certify(file.filename().string(), "Gmsh MSH 4.1", summarize(state.mesh),
                 summarize(back->mesh));
}

Result<ExportCertificate> export_vtu(const fs::path& file, const MeshState& state,
                                     const MeshFields& fields, const Progress& progress) {
  if (Result<void> done = write_vtu(state.mesh, fields, file, progress); !done) return done.error();
  Result<VtuContent> back = read_vtu(file);
  if (!back) return back.error();
  return certify(file.filename().string(), "VTK VTU", summarize(state.mesh), summarize(back->mesh));
}

Result<ExportCertificate> export_medit(const fs::path& file, const MeshState& state,
                                       const Study& study, const std::vector<InputFile>& inputs,
                                       const Progress& progress) {
  if (Result<void> done = write_medit<3>(state.mesh, file, progress); !done) return done.error();
  std::string format = "Medit";
  if (!state.metric.empty()) {
    if (Result<void> done = write_sol<3>(state.metric, fs::path(file).replace_extension(".sol"));
        !done)
      return done.error();
    format = "Medit, metric in .sol, names in .json";
  }
  if (Result<void> done =
          write_sidecar(study, state.mesh, inputs, fs::path(file).replace_extension(".json"));
      !done)
    return done.error();
  Result<SimplexMesh<3>> back = read_medit<3>(file);
  if (!back) return back.error();
  return certify(file.filename().string(), format, summarize(state.mesh), summarize(*back), false);
}

Result<ExportCertificate> export_stl(const fs::path& file, const MeshState& state) {
  if (Result<void> done = write_stl(whole_boundary(state.mesh), file); !done) return done.error();
  auto back = read_stl(file);
  if (!back) return back.error();
  // Binary STL holds single precision.
  return certify(file.filename().string(), "STL, boundary only", summary_of_boundary(state.mesh),
                 summary_of(*back), false, 1e-4);
}

constexpr const char* kFilling = "filling ";

/// The filling ratio of each body, "filling NAME".
std::vector<ElementField> filling_fields(const MeshState& state) {
  std::vector<ElementField> fields;
  for (std::size_t b = 0; b < state.mesh.bodies.size(); ++b) {
    ElementField field{kFilling + state.mesh.bodies[b], {}};
    for (std::size_t e = 0; e < state.mesh.elements.size(); ++e)
      field.values.push_back(state.filling->ratio(e, static_cast<std::int32_t>(b)));
    fields.push_back(std::move(field));
  }
  return fields;
}

/// What `filling_fields` says; null unless every body has its field.
std::shared_ptr<const Filling> filling_of(const std::vector<ElementField>& fields,
                                          const SimplexMesh<3>& mesh) {
  if (mesh.bodies.empty()) return nullptr;
  std::vector<const ElementField*> of_body;
  for (const std::string& body : mesh.bodies) {
    const auto it = std::find_if(fields.begin(), fields.end(), [&](const ElementField& field) {
      return field.name == kFilling + body;
    });
    if (it == fields.end()) return nullptr;
    of_body.push_back(&*it);
  }
  auto filling = std::make_shared<Filling>();
  filling->regions = static_cast<int>(of_body.size());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    for (std::size_t b = 0; b < of_body.size(); ++b)
      if (const double ratio = of_body[b]->values[e]; ratio > 0)
        filling->shares.push_back({static_cast<std::int32_t>(b), static_cast<float>(ratio)});
    filling->first.push_back(static_cast<std::uint32_t>(filling->shares.size()));
  }
  return filling;
}

}  // namespace

Result<std::vector<Part>> load_all(const std::vector<fs::path>& files, const Study& study,
                                   const LoadParams& params, const Progress& progress) {
  std::vector<Part> all;
  const auto count = static_cast<double>(std::max<std::size_t>(1, files.size()));
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto at = static_cast<double>(i);
    LoadParams own = params;
    own.unit = study.inputs[i].unit;
    Result<std::vector<Part>> parts =
        load_parts(files[i], own, progress.portion(at / count, (at + 1) / count, "reading"));
    if (!parts) {
      // Whatever keeps an input from being read, it is the input that is bad.
      Error error = parts.error();
      if (error.code == Code::io) error.code = Code::bad_input;
      return error;
    }
    for (Part& part : *parts) all.push_back(std::move(part));
  }
  return study_parts(std::move(all), study.left_out);
}

std::vector<std::shared_ptr<const VolumeMesher>> meshers_for(MesherChoice choice,
                                                             std::uint64_t seed) {
  std::vector<std::shared_ptr<const VolumeMesher>> meshers;
  if (choice != MesherChoice::netgen) {
    GenerateParams params;
    params.seed = seed;
    meshers.push_back(topological_mesher(params));
  }
  if (choice != MesherChoice::topological) meshers.push_back(netgen_mesher());
  return meshers;
}

const std::vector<std::string>& export_endings() {
  static const std::vector<std::string> endings = {".msh", ".vtu", ".mesh", ".stl"};
  return endings;
}

Result<void> check_export_name(const fs::path& file) {
  const auto& endings = export_endings();
  if (std::find(endings.begin(), endings.end(), ending_of(file)) == endings.end())
    return Error{Code::usage,
                 "\"" + file.string() + "\": the ending names no format that can be written.",
                 "Use .msh (Gmsh), .vtu (VTK), .mesh (Medit) or .stl (boundary)."};
  std::error_code ec;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!fs::is_directory(folder, ec))
    return Error{Code::usage, "\"" + file.string() + "\": the folder does not exist.",
                 "Create it first."};
  return {};
}

Result<ExportCertificate> export_mesh(const fs::path& file, const MeshState& state,
                                      const Study& study, const std::vector<InputFile>& inputs,
                                      const Progress& progress) {
  if (Result<void> known = check_export_name(file); !known) return known.error();
  MeshFields fields;
  if (!state.metric.empty()) fields.metric = &state.metric;
  if (!state.thickness.empty()) fields.thickness = &state.thickness;
  if (!state.layers.empty()) fields.layers = &state.layers;
  if (!state.quality.empty()) fields.quality = &state.quality;
  const std::string ending = ending_of(file);
  if (state.filling && ending == ".vtu") fields.of_elements = filling_fields(state);
  Result<ExportCertificate> proof = ending == ".msh"   ? export_msh(file, state, fields, progress)
                                    : ending == ".vtu" ? export_vtu(file, state, fields, progress)
                                    : ending == ".mesh"
                                        ? export_medit(file, state, study, inputs, progress)
                                        : export_stl(file, state);
  if (proof && !proof->agrees)
    return Error{Code::failed,
                 "\"" + file.string() + "\" does not read back as written: " + proof->finding,
                 "Please report this with the part."};
  return proof;
}

Result<MeshState> read_mesh(const fs::path& file, const Progress& progress) {
  MeshState state;
  const std::string ending = ending_of(file);
  if (ending == ".msh") {
    Result<MshContent> content = read_msh(file);
    if (!content) return content.error();
    state.mesh = std::move(content->mesh);
    state.metric = std::move(content->metric);
    state.thickness = std::move(content->thickness);
  } else if (ending == ".vtu") {
    Result<VtuContent> content = read_vtu(file);
    if (!content) return content.error();
    state.mesh = std::move(content->mesh);
    state.metric = std::move(content->metric);
    state.thickness = std::move(content->thickness);
    state.layers = std::move(content->layers);
    state.quality = std::move(content->quality);
    state.filling = filling_of(content->of_elements, state.mesh);
  } else if (ending == ".mesh") {
    Result<SimplexMesh<3>> mesh = read_medit<3>(file, progress);
    if (!mesh) return mesh.error();
    state.mesh = std::move(*mesh);
  } else {
    return Error{Code::bad_input,
                 "\"" + file.string() + "\": the ending names no mesh that can be read.",
                 "Give a .msh (Gmsh 4.1), .vtu (VTK) or .mesh (Medit) file."};
  }
  return state;
}

}  // namespace lamella
