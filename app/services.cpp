#include "app/services.h"

#include <algorithm>

#include "core/flow/solver_field.h"
#include "core/io/mesh_file.h"
#include "core/io_vtk/vtk_formats.h"
#include "core/io_vtk/vtu.h"
#ifdef LAMELLA_WITH_MED
#include "core/io_med/med.h"
#endif
#ifdef LAMELLA_WITH_CGNS
#include "core/io_cgns/cgns.h"
#endif
#include "core/netgen/netgen_mesher.h"
#include "core/study/measure.h"
#include "core/study/mesh_parts.h"

namespace lamella {

namespace {

namespace fs = std::filesystem;

/// The filling ratio of each body, "filling NAME".
std::vector<ElementField> filling_fields(const MeshState& state) {
  std::vector<ElementField> fields;
  for (std::size_t b = 0; b < state.mesh.bodies.size(); ++b) {
    ElementField field{std::string(kFillingField) + state.mesh.bodies[b], {}};
    for (std::size_t e = 0; e < state.mesh.elements.size(); ++e)
      field.values.push_back(state.filling->ratio(e, static_cast<std::int32_t>(b)));
    fields.push_back(std::move(field));
  }
  return fields;
}

/// What `filling_fields` says; null unless every body has its field and one element is mixed.
std::shared_ptr<const Filling> filling_of(const std::vector<ElementField>& fields,
                                          const SimplexMesh<3>& mesh) {
  if (mesh.bodies.empty()) return nullptr;
  std::vector<const ElementField*> of_body;
  for (const std::string& body : mesh.bodies) {
    const auto it = std::find_if(fields.begin(), fields.end(), [&](const ElementField& field) {
      return field.name == std::string(kFillingField) + body;
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
  if (filling->mixed_count() == 0) return nullptr;
  return filling;
}

const char* const kVelocity = "velocity";
const char* const kPressure = "pressure";
const char* const kShear = "shear_rate";
const char* const kIndicator = "flow_indicator";
/// The field of another solver is called "field NAME".
constexpr std::string_view kSolverField = "field ";

void add_flow(const FlowFields& flow, MeshFields& fields) {
  if (flow.components > 0) {
    NodeField field{std::string(kSolverField) + flow.field, flow.components, flow.number};
    if (flow.components == 3)
      for (const Vec<3>& v : flow.velocity)
        field.values.insert(field.values.end(), v.begin(), v.end());
    fields.of_nodes.push_back(std::move(field));
    fields.of_elements.push_back({kIndicator, flow.indicator});
    return;
  }
  NodeField velocity{kVelocity, 3, {}};
  for (const Vec<3>& v : flow.velocity)
    velocity.values.insert(velocity.values.end(), v.begin(), v.end());
  fields.of_nodes.push_back(std::move(velocity));
  fields.of_nodes.push_back({kPressure, 1, flow.pressure});
  fields.of_elements.push_back({kShear, flow.shear});
  fields.of_elements.push_back({kIndicator, flow.indicator});
}

/// What `add_flow` says; null where a field is missing.
std::shared_ptr<const FlowFields> flow_of(const MeshContent& content) {
  auto flow = std::make_shared<FlowFields>();
  for (const NodeField& field : content.of_nodes) {
    if (field.name == kPressure && field.components == 1) flow->pressure = field.values;
    const bool of_solver = field.name.rfind(kSolverField, 0) == 0;
    if (of_solver) {
      flow->field = field.name.substr(kSolverField.size());
      flow->components = field.components;
      if (field.components == 1) flow->number = field.values;
    }
    if ((!of_solver && field.name != kVelocity) || field.components != 3) continue;
    for (std::size_t i = 0; i + 2 < field.values.size(); i += 3)
      flow->velocity.emplace_back(field.values[i], field.values[i + 1], field.values[i + 2]);
  }
  for (const ElementField& field : content.of_elements) {
    if (field.name == kShear) flow->shear = field.values;
    if (field.name == kIndicator) flow->indicator = field.values;
  }
  const std::size_t nodes = content.mesh.points.size(), elements = content.mesh.elements.size();
  if (flow->components > 0 && flow->indicator.size() == elements) {
    flow->resize(nodes, elements);
    return flow;
  }
  if (flow->velocity.size() != nodes || flow->pressure.size() != nodes ||
      flow->shear.size() != elements || flow->indicator.size() != elements)
    return nullptr;
  return flow;
}

Result<const MeshFormat*> format_for(const fs::path& file, const ExportOptions& options) {
  return options.format.empty() ? mesh_formats().of_file(file)
                                : mesh_formats().called(options.format);
}

Result<ExportCertificate> write(const fs::path& file, const SimplexMesh<3>& mesh,
                                const MeshFields& fields, const ExportOptions& options,
                                const Progress& progress) {
  const MeshFormat& format = **format_for(file, options);
  fs::path target = file;
  if (format.name == "openfoam" && file.extension() != ".foam") {
    std::error_code ec;
    fs::create_directories(file, ec);
    target = file / (fs::weakly_canonical(file, ec).filename().string() + ".foam");
  }
  return write_mesh_file(format, mesh, fields, target, options.unit, progress);
}

}  // namespace

bool names_mesh(const fs::path& file) {
  const Result<const MeshFormat*> format = mesh_formats().of_file(file);
  return format && (*format)->read;
}

Result<std::vector<Part>> load_bodies(const fs::path& file, const LoadParams& params,
                                      const Progress& progress) {
  if (!names_mesh(file)) return load_parts(file, params, progress);
  const Result<MeshContent> content = read_content(file, progress.portion(0, 0.5));
  if (!content) return content.error();
  Result<std::vector<Part>> parts = parts_of_mesh(content->mesh, progress.portion(0.5, 1));
  if (parts || parts.error().code == Code::cancelled) return parts;
  Error error = parts.error();
  error.message = file.filename().string() + ": " + error.message;
  return error;
}

Result<std::vector<Part>> load_all(const std::vector<fs::path>& files, const Study& study,
                                   const LoadParams& params, const Progress& progress) {
  std::vector<Part> all;
  const auto count = static_cast<double>(std::max<std::size_t>(1, files.size()));
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto at = static_cast<double>(i);
    LoadParams own = params;
    own.unit = study.inputs[i].unit;
    Result<std::vector<Part>> parts =
        load_bodies(files[i], own, progress.portion(at / count, (at + 1) / count, "reading"));
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

const MeshFormats& mesh_formats() {
  static const MeshFormats formats = [] {
    MeshFormats all;
    all.add(own_formats());
    all.add(vtk_formats());
#ifdef LAMELLA_WITH_MED
    all.add({med_format()});
#else
    all.add_missing("med", ".med", "This build knows no MED files: libmedC was not there.");
#endif
#ifdef LAMELLA_WITH_CGNS
    all.add({cgns_format()});
#else
    all.add_missing("cgns", ".cgns", "This build knows no CGNS files: libcgns was not there.");
#endif
    return all;
  }();
  return formats;
}

Result<void> check_export_name(const fs::path& file, const ExportOptions& options) {
  const Result<const MeshFormat*> format = format_for(file, options);
  if (!format) return format.error();
  std::error_code ec;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!fs::is_directory(folder, ec))
    return Error{Code::usage, "\"" + file.string() + "\": the folder does not exist.",
                 "Create it first."};
  return {};
}

Result<ExportCertificate> export_mesh(const fs::path& file, const MeshState& state,
                                      const Study& study, const std::vector<InputFile>& inputs,
                                      const Progress& progress, const ExportOptions& options) {
  if (Result<void> known = check_export_name(file, options); !known) return known.error();
  MeshFields fields;
  if (!state.metric.empty()) fields.metric = &state.metric;
  if (!state.thickness.empty()) fields.thickness = &state.thickness;
  if (!state.layers.empty()) fields.layers = &state.layers;
  if (!state.quality.empty()) fields.quality = &state.quality;
  if (state.filling) fields.of_elements = filling_fields(state);
  if (state.flow) add_flow(*state.flow, fields);
  fields.provenance = provenance_json(study, state.mesh, inputs);
  return write(file, state.mesh, fields, options, progress);
}

Result<MeshContent> read_content(const fs::path& file, const Progress& progress) {
  std::error_code ec;
  fs::path source = file;
  if (fs::is_directory(file / "constant" / "polyMesh", ec))
    source = file / (fs::weakly_canonical(file, ec).filename().string() + ".foam");
  const Result<const MeshFormat*> format = mesh_formats().of_file(source);
  if (!format) {
    Error error = format.error();
    error.code = Code::bad_input;
    return error;
  }
  return read_mesh_file(**format, source, progress);
}

Result<MeshContent> read_result(const fs::path& file, const Progress& progress) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  // The endings of VTK, lists of files too, which are refused there.
  for (const char* known : {".vtu", ".vtk", ".pvtu", ".pvd", ".vtm", ".vtmb", ".vtp", ".series"})
    if (ending == known) return read_vtk_result(file, progress);
  Result<MeshContent> content = read_content(file, progress);
  if (content) elements_to_nodes(*content);
  return content;
}

Result<ExportCertificate> convert_mesh(const fs::path& from, const fs::path& to,
                                       const ExportOptions& options, const Progress& progress) {
  if (Result<void> known = check_export_name(to, options); !known) return known.error();
  Result<MeshContent> content = read_content(from, progress.portion(0, 0.4));
  if (!content) {
    // Whatever keeps an input from being read, it is the input that is bad.
    Error error = content.error();
    if (error.code == Code::io) error.code = Code::bad_input;
    return error;
  }
  MeshFields fields;
  if (!content->metric.empty()) fields.metric = &content->metric;
  if (!content->thickness.empty()) fields.thickness = &content->thickness;
  if (!content->layers.empty()) fields.layers = &content->layers;
  if (!content->quality.empty()) fields.quality = &content->quality;
  fields.of_nodes = std::move(content->of_nodes);
  fields.of_elements = std::move(content->of_elements);
  fields.provenance = std::move(content->provenance);
  if (fields.provenance.empty()) {
    std::vector<InputFile> inputs;
    if (Result<InputFile> input = describe_input(from); input) inputs.push_back(std::move(*input));
    fields.provenance = provenance_json(Study{}, content->mesh, inputs);
  }
  return write(to, content->mesh, fields, options, progress.portion(0.4, 1));
}

Result<MeshState> read_mesh(const fs::path& file, const Progress& progress) {
  Result<MeshContent> content = read_content(file, progress);
  if (!content) return content.error();
  MeshState state;
  state.filling = filling_of(content->of_elements, content->mesh);
  state.flow = flow_of(*content);
  state.mesh = std::move(content->mesh);
  state.metric = std::move(content->metric);
  state.thickness = std::move(content->thickness);
  state.layers = std::move(content->layers);
  state.quality = std::move(content->quality);
  return state;
}

}  // namespace lamella
