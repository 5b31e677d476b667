#include "core/io/mesh_file.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/io/facet_sides.h"
#include "core/io/medit.h"
#include "core/io/stl.h"
#include "core/mesh/boundary.h"

namespace lamella {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kSame = 1e-9;

/// A mesh and its fields: those of someone else, or a copy that differs.
struct Carried {
  const SimplexMesh<3>* mesh = nullptr;
  MeshFields fields;

  /// The copy, for changes; meshes are large, so there is none until it is asked for.
  struct Copy {
    SimplexMesh<3> mesh;
    MetricField<3> metric;
    std::vector<double> thickness, layers;
  };
  Copy& copy() {
    if (own_) return *own_;
    own_ = std::make_unique<Copy>();
    own_->mesh = *mesh;
    mesh = &own_->mesh;
    const auto take = [](const auto*& field, auto& own) {
      if (!field) return;
      own = *field;
      field = &own;
    };
    take(fields.metric, own_->metric);
    take(fields.thickness, own_->thickness);
    take(fields.layers, own_->layers);
    return *own_;
  }

 private:
  std::unique_ptr<Copy> own_;
};

void scale(double factor, std::vector<Vec<3>>& points, MetricField<3>& metric,
           std::vector<double>& thickness) {
  for (Vec<3>& x : points) x *= factor;
  for (std::size_t v = 1; v < metric.size(); ++v) metric[v] /= factor * factor;
  for (double& t : thickness) t *= factor;
}

std::optional<std::string> body_of(const ElementField& field) {
  if (field.name.rfind(kFillingField, 0) != 0) return {};
  return field.name.substr(kFillingField.size());
}

bool has_unused_nodes(const SimplexMesh<3>& mesh) {
  std::vector<bool> used(mesh.points.size(), false);
  for (const auto& element : mesh.elements)
    for (const NodeId v : element) used[v] = true;
  return std::find(used.begin() + 1, used.end(), false) != used.end();
}

/// What must read back, in mm and by its own names: all of the boundary, no unused nodes where the
/// format wants none, no faces between bodies where it has no place for them.
Carried what_is_carried(const MeshFormat& format, const SimplexMesh<3>& mesh,
                        const MeshFields& fields) {
  Carried out;
  out.mesh = &mesh;
  out.fields = fields;
  if (!boundary_is_listed(mesh)) list_boundary(out.copy().mesh);
  if (format.compact && has_unused_nodes(mesh)) {
    Carried::Copy& own = out.copy();
    const std::vector<NodeId> new_id = compact_nodes<3>(own.mesh);
    if (fields.metric) compact_field(new_id, own.metric);
    if (fields.thickness) compact_field(new_id, own.thickness);
    if (fields.layers) compact_field(new_id, own.layers);
  }
  if (!format.groups && !format.boundary_only) {
    SimplexMesh<3>& own = out.copy().mesh;
    const std::vector<FacetSide> sides = facet_sides(own);
    std::size_t kept = 0;
    for (std::size_t f = 0; f < sides.size(); ++f) {
      if (sides[f].element < 0 || sides[f].other >= 0) continue;
      own.facets[kept] = own.facets[f];
      own.facet_group[kept] = own.facet_group[f];
      own.facet_face[kept++] = own.facet_face[f];
    }
    own.facets.resize(kept);
    own.facet_group.resize(kept);
    own.facet_face.resize(kept);
  }
  return out;
}

/// The same with names as the format holds them and lengths in its unit.
Carried as_in_file(const MeshFormat& format, const Carried& carried, LengthUnit unit) {
  Carried out;
  out.mesh = carried.mesh;
  out.fields = carried.fields;
  out.fields.unit = unit;
  std::vector<std::string> taken;
  const std::vector<std::string> bodies = names_in_file(carried.mesh->bodies, format.names, taken);
  if (!format.names.shared) taken.clear();
  const std::vector<std::string> groups = names_in_file(carried.mesh->groups, format.names, taken);
  for (ElementField& field : out.fields.of_elements)
    if (const auto body = body_of(field))
      for (std::size_t b = 0; b < bodies.size(); ++b)
        if (carried.mesh->bodies[b] == *body) field.name = std::string(kFillingField) + bodies[b];
  if (bodies != carried.mesh->bodies || groups != carried.mesh->groups) {
    out.copy().mesh.bodies = bodies;
    out.copy().mesh.groups = groups;
  }
  if (unit == LengthUnit::m) {
    Carried::Copy& own = out.copy();
    scale(1e-3, own.mesh.points, own.metric, own.thickness);
  }
  return out;
}

/// Ratios of the elements that one body does not fill alone, as [element, ratio, ratio, ..].
Json mixed_elements(const MeshFields& fields) {
  Json names = Json::array(), list = Json::array();
  std::vector<const ElementField*> ratios;
  for (const ElementField& field : fields.of_elements)
    if (const auto body = body_of(field)) {
      names.push_back(*body);
      ratios.push_back(&field);
    }
  if (ratios.empty()) return {};
  for (std::size_t e = 0; e < ratios[0]->values.size(); ++e) {
    if (std::all_of(ratios.begin(), ratios.end(),
                    [&](auto* f) { return f->values[e] == 0 || f->values[e] == 1; }))
      continue;
    Json entry = {e + 1};
    for (const ElementField* field : ratios) entry.push_back(field->values[e]);
    list.push_back(std::move(entry));
  }
  return {{"note",
           "The body of an element is the one that fills most of it. Here are the elements "
           "that several bodies fill: number, and the share of each body."},
          {"bodies", std::move(names)},
          {"elements", std::move(list)}};
}

/// [reference, how many in a row]
Json runs_of(const std::vector<std::int32_t>& indices) {
  Json runs = Json::array();
  for (std::size_t i = 0; i < indices.size();) {
    std::size_t end = i;
    while (end < indices.size() && indices[end] == indices[i]) ++end;
    runs.push_back({indices[i] + 1, end - i});
    i = end;
  }
  return runs;
}

fs::path metric_file(const MeshFormat& format, const fs::path& file) {
  return format.name == "medit" ? fs::path(file).replace_extension(".sol")
                                : fs::path(file.string() + ".sol");
}

/// One line for each entry of the lists, which may be long.
std::string layout(const Json& json) {
  std::string text = "{";
  const auto dump = [](const Json& j) {
    return j.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  bool first = true;
  for (const auto& [key, value] : json.items()) {
    text += (first ? "\n  " : ",\n  ") + Json(key).dump() + ": ";
    first = false;
    if (value.is_array() && !value.empty()) {
      text += "[";
      for (std::size_t i = 0; i < value.size(); ++i)
        text += (i ? ",\n    " : "\n    ") + dump(value[i]);
      text += "\n  ]";
    } else {
      text += dump(value);
    }
  }
  return text + "\n}\n";
}

Result<void> write_sidecar(const MeshFormat& format, const Carried& carried, const Carried& written,
                           const fs::path& file) {
  const MeshFields& fields = carried.fields;
  Json json =
      fields.provenance.empty() ? Json::object() : Json::parse(fields.provenance, nullptr, false);
  if (!json.is_object()) json = Json::object();
  json["program"] = "Lamella " + version();
  json["file"] = file.filename().string();
  json["format"] = format.title;
  json["unit"] = unit_name(written.fields.unit);
  json["nodes"] = written.mesh->node_count();
  json["elements"] = written.mesh->element_count();
  const auto list = [&](const char* key, const std::vector<std::string>& names,
                        const std::vector<std::string>& in_file) {
    Json entries = Json::array();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto number = reference_of(in_file[i]);
      Json entry = {{"reference", format.names.references ? number.value_or(0) : i + 1},
                    {"name", names[i]}};
      if (in_file[i] != names[i]) entry["name_in_file"] = in_file[i];
      if (json.contains(key) && i < json[key].size())
        for (const auto& [k, v] : json[key][i].items())
          if (!entry.contains(k)) entry[k] = v;
      entries.push_back(std::move(entry));
    }
    json[key] = std::move(entries);
  };
  list("bodies", carried.mesh->bodies, written.mesh->bodies);
  list("groups", carried.mesh->groups, written.mesh->groups);
  if (!format.bodies) json["element_bodies"] = runs_of(carried.mesh->element_body);
  if (!format.groups) json["facet_groups"] = runs_of(carried.mesh->facet_group);
  if (fields.metric && !format.metric)
    json["metric"] = metric_file(format, file).filename().string();
  if (!format.filling)
    if (Json filling = mixed_elements(fields); !filling.is_null())
      json["filling"] = std::move(filling);
  return write_file(sidecar_of(file), layout(json));
}

/// References (from 1) of elements or facets that the file tells nothing of.
void take_runs(const Json& runs, const Json& entries, std::vector<std::string>& names,
               std::vector<std::int32_t>& of) {
  std::vector<std::string> listed;
  for (const Json& entry : entries) listed.push_back(entry.value("name", ""));
  std::vector<std::int32_t> all;
  for (const Json& run : runs) {
    const std::size_t index = run.at(0).get<std::size_t>() - 1, count = run.at(1);
    if (index >= listed.size() || count > of.size() - all.size()) return;
    all.insert(all.end(), count, static_cast<std::int32_t>(index));
  }
  if (all.size() != of.size()) return;
  names = std::move(listed);
  of = std::move(all);
}

/// Names of the sidecar, by what they are called in the file.
void rename(const Json& entries, std::vector<std::string>& names, std::vector<std::int32_t>& of) {
  std::vector<std::string> all;
  std::vector<std::int32_t> place(names.size(), -1);
  for (const Json& entry : entries) {
    const std::string name = entry.value("name", "");
    const auto at = std::find(names.begin(), names.end(), entry.value("name_in_file", name));
    if (at != names.end()) place[at - names.begin()] = static_cast<std::int32_t>(all.size());
    all.push_back(name);
  }
  // What the sidecar does not know comes behind.
  for (std::size_t i = 0; i < names.size(); ++i)
    if (place[i] < 0 && std::find(of.begin(), of.end(), static_cast<std::int32_t>(i)) != of.end()) {
      place[i] = static_cast<std::int32_t>(all.size());
      all.push_back(names[i]);
    }
  for (std::int32_t& index : of) index = place[index];
  names = std::move(all);
}

void restore_filling(const Json& filling, MeshContent& content) {
  const SimplexMesh<3>& mesh = content.mesh;
  for (std::size_t k = 0; k < filling.at("bodies").size(); ++k) {
    const std::string name = filling.at("bodies")[k];
    ElementField field{std::string(kFillingField) + name, {}};
    for (const std::int32_t body : mesh.element_body)
      field.values.push_back(mesh.bodies[body] == name ? 1 : 0);
    for (const Json& entry : filling.at("elements"))
      if (const std::size_t e = entry.at(0); e >= 1 && e <= field.values.size())
        field.values[e - 1] = entry.at(k + 1);
    content.of_elements.push_back(std::move(field));
  }
}

/// What of a sidecar belongs to the mesh and not to the file.
std::string provenance_of(Json json) {
  for (const char* key : {"file", "format", "unit", "nodes", "elements", "metric", "filling",
                          "element_bodies", "facet_groups"})
    json.erase(key);
  for (const char* list : {"bodies", "groups"})
    if (json.contains(list))
      for (Json& entry : json[list]) entry.erase("reference"), entry.erase("name_in_file");
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Error damaged(const fs::path& file, const std::string& finding) {
  return {Code::bad_input, "\"" + sidecar_of(file).string() + "\" is damaged: " + finding,
          "Write the mesh again, or remove this file: names are then those of the mesh."};
}

/// The sidecar, if it was written with this mesh; else null.
Result<Json> sidecar_for(const MeshContent& content, const fs::path& file) {
  std::error_code ec;
  if (!fs::is_regular_file(sidecar_of(file), ec)) return Json{};
  const Result<std::string> text = read_file(sidecar_of(file));
  if (!text) return text.error();
  Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded()) return damaged(file, "it is no JSON.");
  if (!json.is_object() || !json.contains("nodes") || !json.contains("elements") ||
      json["nodes"] != content.mesh.node_count() ||
      json["elements"] != content.mesh.element_count())
    return Json{};
  return json;
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

void compare_fields(const SimplexMesh<3>& mesh, const MeshFields& fields, const MeshContent& back,
                    ExportCertificate& proof) {
  if (fields.metric) {
    double worst = back.metric.size() == fields.metric->size() ? 0 : 1;
    for (std::size_t v = 1; worst < 1 && v < back.metric.size(); ++v)
      worst = std::max(worst, ((*fields.metric)[v] - back.metric[v]).cwiseAbs().maxCoeff() /
                                  (*fields.metric)[v].cwiseAbs().maxCoeff());
    if (!(worst <= kSame)) proof.finding += " The metric reads back otherwise.";
  }
  const auto volume = [](const SimplexMesh<3>& m, const ElementField& field) {
    double sum = 0;
    for (std::size_t e = 0; e < m.elements.size(); ++e)
      sum += field.values[e] * signed_measure<3>(m.corners(m.elements[e]));
    return sum;
  };
  for (const ElementField& field : fields.of_elements) {
    if (!body_of(field)) continue;
    const auto at = std::find_if(back.of_elements.begin(), back.of_elements.end(),
                                 [&](const ElementField& f) { return f.name == field.name; });
    const double written = volume(mesh, field);
    if (at == back.of_elements.end() || at->values.size() != mesh.elements.size() ||
        !(std::abs(volume(back.mesh, *at) - written) <= kSame * std::abs(written)))
      proof.finding += " \"" + field.name + "\" reads back otherwise.";
  }
  proof.agrees = proof.finding.empty();
}

/// The first element or facet that is none: a node of it is unknown, or there twice. Empty if none.
template <std::size_t N>
std::string fault_of(const std::vector<std::array<NodeId, N>>& simplices, std::size_t nodes,
                     const std::string& what) {
  for (std::size_t k = 0; k < simplices.size(); ++k) {
    auto v = simplices[k];
    std::sort(v.begin(), v.end());
    if (v[0] < 1 || static_cast<std::size_t>(v[N - 1]) >= nodes)
      return what + " " + std::to_string(k + 1) + " names a node that is not there.";
    if (std::adjacent_find(v.begin(), v.end()) != v.end())
      return what + " " + std::to_string(k + 1) + " has one node twice.";
  }
  return {};
}

}  // namespace

void drop_unused_nodes(MeshContent& content) {
  const std::vector<NodeId> new_id = compact_nodes<3>(content.mesh);
  const auto move = [&](auto& field) {
    if (!field.empty()) compact_field(new_id, field);
  };
  move(content.metric);
  move(content.thickness);
  move(content.layers);
  for (TensorField& field : content.tensors)
    if (field.of_nodes) move(field.values);
  for (NodeField& field : content.of_nodes) {
    const auto n = static_cast<std::size_t>(field.components);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < new_id.size(); ++i)
      if (new_id[i] >= 0)
        for (std::size_t c = 0; c < n; ++c) field.values[kept++] = field.values[n * i + c];
    field.values.resize(kept);
  }
}

fs::path sidecar_of(const fs::path& file) { return file.string() + ".json"; }

Result<void> complete(MeshContent& content, const fs::path& file) {
  const Result<Json> sidecar = sidecar_for(content, file);
  if (!sidecar) return sidecar.error();
  const Json& json = *sidecar;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  try {
    if (json.is_object()) {
      SimplexMesh<3>& mesh = content.mesh;
      if (json.contains("bodies")) {
        const std::vector<std::string> before = mesh.bodies;
        if (json.contains("element_bodies"))
          take_runs(json.at("element_bodies"), json.at("bodies"), mesh.bodies, mesh.element_body);
        else
          rename(json["bodies"], mesh.bodies, mesh.element_body);
        for (ElementField& field : content.of_elements)
          if (const auto body = body_of(field))
            for (const Json& entry : json["bodies"])
              if (entry.value("name_in_file", entry.value("name", "")) == *body)
                field.name = std::string(kFillingField) + entry.value("name", "");
      }
      if (json.contains("facet_groups"))
        take_runs(json.at("facet_groups"), json.at("groups"), mesh.groups, mesh.facet_group);
      else if (json.contains("groups"))
        rename(json["groups"], mesh.groups, mesh.facet_group);
      if (json.value("unit", "mm") == "m") content.unit = LengthUnit::m;
      if (content.metric.empty() && json.contains("metric")) {
        // It may have been moved away; the mesh is good without.
        const fs::path beside = folder / json["metric"].get<std::string>();
        std::error_code ec;
        if (fs::exists(beside, ec)) {
          Result<MetricField<3>> metric = read_sol<3>(beside, mesh.node_count());
          if (!metric) return metric.error();
          content.metric = std::move(*metric);
        }
      }
      if (json.contains("filling")) restore_filling(json.at("filling"), content);
      content.provenance = provenance_of(json);
    }
  } catch (const Json::exception& error) {
    return damaged(file, error.what());
  }
  if (content.unit == LengthUnit::m) {
    scale(1e3, content.mesh.points, content.metric, content.thickness);
    for (TensorField& field : content.tensors)
      for (Metric<3>& m : field.values) m /= 1e6;
    content.unit = LengthUnit::mm;
  }
  return {};
}

Result<MeshContent> read_mesh_file(const MeshFormat& format, const fs::path& file,
                                   const Progress& progress) {
  if (!format.read)
    return Error{Code::bad_input,
                 "\"" + file.string() + "\": " + format.title + " holds no tetrahedra.",
                 "Fill it first: lamella-cli generate."};
  Result<MeshContent> content = format.read(file, progress);
  if (!content) return content.error();
  for (const Vec<3>& x : content->mesh.points)
    if (!x.allFinite())
      return Error{Code::bad_input, "\"" + file.string() + "\": a coordinate is no number.",
                   "The file is damaged; write it again."};
  for (const auto& finding :
       {fault_of(content->mesh.elements, content->mesh.points.size(), "Element"),
        fault_of(content->mesh.facets, content->mesh.points.size(), "Facet")})
    if (!finding.empty())
      return Error{Code::bad_input, "\"" + file.string() + "\": " + finding,
                   "The file is damaged; write it again."};
  if (Result<void> done = complete(*content, file); !done) return done.error();
  return content;
}

Result<ExportCertificate> write_mesh_file(const MeshFormat& format, const SimplexMesh<3>& mesh,
                                          const MeshFields& fields, const fs::path& file,
                                          LengthUnit unit, const Progress& progress) {
  if (format.meters) unit = LengthUnit::m;
  const Carried carried = what_is_carried(format, mesh, fields);
  std::optional<Carried> written = as_in_file(format, carried, unit);
  if (progress.cancelled()) return cancelled_error();
  Result<MeshFormat::Notes> notes =
      format.write(*written->mesh, written->fields, file, progress.portion(0.1, 0.6));
  if (!notes) return notes.error();
  ExportCertificate proof;
  const std::string name = file.filename().string();
  if (format.boundary_only) {
    auto back = read_stl(file);
    if (!back) return back.error();
    std::vector<std::array<Vec<3>, 3>> triangles;
    for (const auto& f : written->mesh->facets) triangles.push_back(written->mesh->corners(f));
    // Binary STL holds single precision.
    proof = certify(name, format.title, summary_of(triangles), summary_of(*back), false, 1e-4);
  } else {
    // First what belongs beside the file: reading it again needs that.
    if (!format.provenance)
      if (Result<void> done = write_sidecar(format, carried, *written, file); !done)
        return done.error();
    if (fields.metric && !format.metric)
      if (Result<void> done = write_sol<3>(*written->fields.metric, metric_file(format, file));
          !done)
        return done.error();
    written.reset();
    Result<MeshContent> back = read_mesh_file(format, file, progress.portion(0.6, 0.9));
    if (!back) return back.error();
    proof = certify(name, format.title, summarize(*carried.mesh), summarize(back->mesh));
    compare_fields(*carried.mesh, carried.fields, *back, proof);
  }
  proof.notes = std::move(*notes);
  if (!proof.agrees)
    return Error{Code::failed,
                 "\"" + file.string() + "\" does not read back as written: " + proof.finding,
                 "Please report this with the part."};
  progress.report(1);
  return proof;
}

}  // namespace lamella
