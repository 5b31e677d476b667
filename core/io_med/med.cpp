#include "core/io_med/med.h"

#include <med.h>

#include <algorithm>
#include <map>

#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/io/facet_sides.h"
#include "core/io/read_in_child.h"

namespace lamella {

namespace {

constexpr const char* kMesh = "mesh";
constexpr const char* kMetric = "metric";
constexpr std::array<const char*, 6> kComponents = {"xx", "yy", "zz", "xy", "yz", "xz"};
constexpr std::array<std::array<int, 2>, 6> kTensor = {
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
/// MED lists a tetrahedron with its base seen from the other side.
constexpr std::array<int, 4> kCorner = {0, 2, 1, 3};

/// An open file; every call of the library counts its failures here.
class File {
 public:
  File(const std::filesystem::path& path, med_access_mode mode)
      : id_(MEDfileOpen(path.c_str(), mode)), good_(id_ >= 0) {}
  ~File() { close(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  operator med_idt() const { return id_; }
  bool good() const { return good_; }
  template <class Status>
  void operator()(Status status) {
    good_ = good_ && status >= 0;
  }
  void close() {
    if (id_ >= 0 && MEDfileClose(id_) < 0) good_ = false;
    id_ = -1;
  }

 private:
  med_idt id_;
  bool good_;
};

/// Texts of a fixed width side by side.
std::string padded(const std::vector<std::string>& texts, std::size_t width) {
  std::string all;
  for (const std::string& text : texts) {
    all += text.substr(0, width);
    all.resize(all.size() + width - std::min(width, text.size()), ' ');
  }
  return all;
}

/// One of them, without the blanks behind it.
std::string one_of(const std::string& all, std::size_t i, std::size_t width) {
  std::string text = i * width < all.size() ? all.substr(i * width, width) : std::string();
  text.resize(std::min(text.size(), std::min(text.find('\0'), text.size())));
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

void write_mesh(const SimplexMesh<3>& mesh, const MeshFields& fields, File& file) {
  const std::string unit = unit_name(fields.unit);
  const std::string axes = padded({"x", "y", "z"}, MED_SNAME_SIZE);
  const std::string units = padded({unit, unit, unit}, MED_SNAME_SIZE);
  file(MEDfileCommentWr(file, ("Lamella " + version()).c_str()));
  file(MEDmeshCr(file, kMesh, 3, 3, MED_UNSTRUCTURED_MESH, ("lengths in " + unit).c_str(), "",
                 MED_SORT_DTIT, MED_CARTESIAN, axes.c_str(), units.c_str()));
  std::vector<med_float> points;
  points.reserve(3 * mesh.node_count());
  for (std::size_t v = 1; v < mesh.points.size(); ++v)
    points.insert(points.end(), mesh.points[v].data(), mesh.points[v].data() + 3);
  file(MEDmeshNodeCoordinateWr(file, kMesh, MED_NO_DT, MED_NO_IT, 0, MED_FULL_INTERLACE,
                               static_cast<med_int>(mesh.node_count()), points.data()));

  file(MEDfamilyCr(file, kMesh, "FAMILLE_ZERO", 0, 0, ""));
  const auto bodies = static_cast<med_int>(mesh.bodies.size());
  const auto family = [&](med_int number, const std::string& group) {
    file(MEDfamilyCr(file, kMesh, ("FAM_" + std::to_string(-number)).c_str(), number, 1,
                     padded({group}, MED_LNAME_SIZE).c_str()));
  };
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b)
    family(-1 - static_cast<med_int>(b), mesh.bodies[b]);
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    family(-1 - bodies - static_cast<med_int>(g), mesh.groups[g]);

  std::vector<med_int> nodes, families;
  const auto cells = [&](med_geometry_type type, std::size_t count) {
    if (count == 0) return;
    const auto n = static_cast<med_int>(count);
    file(MEDmeshElementConnectivityWr(file, kMesh, MED_NO_DT, MED_NO_IT, 0, MED_CELL, type,
                                      MED_NODAL, MED_FULL_INTERLACE, n, nodes.data()));
    file(MEDmeshEntityFamilyNumberWr(file, kMesh, MED_NO_DT, MED_NO_IT, MED_CELL, type, n,
                                     families.data()));
    nodes.clear();
    families.clear();
  };
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    for (const int k : kCorner) nodes.push_back(mesh.elements[e][k]);
    families.push_back(-1 - mesh.element_body[e]);
  }
  cells(MED_TETRA4, mesh.elements.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    nodes.insert(nodes.end(), mesh.facets[f].begin(), mesh.facets[f].end());
    families.push_back(-1 - bodies - mesh.facet_group[f]);
  }
  cells(MED_TRIA3, mesh.facets.size());
}

void write_field(File& file, const std::string& name, const std::vector<std::string>& components,
                 const std::string& unit, med_entity_type entity, med_geometry_type type,
                 const std::vector<med_float>& values) {
  const auto n = static_cast<med_int>(components.size());
  const std::vector<std::string> units(components.size(), unit);
  file(MEDfieldCr(file, name.c_str(), MED_FLOAT64, n, padded(components, MED_SNAME_SIZE).c_str(),
                  padded(units, MED_SNAME_SIZE).c_str(), "", kMesh));
  file(MEDfieldValueWr(file, name.c_str(), MED_NO_DT, MED_NO_IT, 0, entity, type,
                       MED_FULL_INTERLACE, MED_ALL_CONSTITUENT,
                       static_cast<med_int>(values.size()) / n,
                       reinterpret_cast<const unsigned char*>(values.data())));
}

void write_fields(const MeshFields& fields, File& file) {
  std::vector<med_float> values;
  if (fields.metric) {
    for (std::size_t v = 1; v < fields.metric->size(); ++v)
      for (const auto& [i, j] : kTensor) values.push_back((*fields.metric)[v](i, j));
    write_field(file, kMetric, {kComponents.begin(), kComponents.end()},
                std::string(unit_name(fields.unit)) + "^-2", MED_NODE, MED_NONE, values);
  }
  for (const ElementField& field : fields.of_elements)
    write_field(file, field.name, {"ratio"}, "", MED_CELL, MED_TETRA4, field.values);
}

/// Group of each family: its name, or that of the family where it is in none.
std::map<med_int, std::string> read_families(File& file, const std::string& mesh) {
  std::map<med_int, std::string> groups;
  const med_int count = MEDnFamily(file, mesh.c_str());
  for (med_int i = 1; i <= count; ++i) {
    const med_int n = MEDnFamilyGroup(file, mesh.c_str(), static_cast<int>(i));
    if (n < 0) continue;
    std::string names(static_cast<std::size_t>(n) * MED_LNAME_SIZE + 1, '\0');
    char family[MED_NAME_SIZE + 1] = {};
    med_int number = 0;
    if (MEDfamilyInfo(file, mesh.c_str(), static_cast<int>(i), family, &number, names.data()) < 0)
      continue;
    groups[number] = n > 0 ? one_of(names, 0, MED_LNAME_SIZE) : std::string(family);
  }
  return groups;
}

/// Names for the families used, or of the writer's own numbering, by descending number.
void name_them(const std::vector<med_int>& families, const std::map<med_int, std::string>& groups,
               const char* otherwise, std::vector<std::int32_t>& owner,
               std::vector<std::string>& names) {
  std::map<med_int, std::int32_t, std::greater<>> index;
  for (const med_int family : families) index[family];
  names.clear();
  for (auto& [family, i] : index) {
    i = static_cast<std::int32_t>(names.size());
    const auto at = groups.find(family);
    names.push_back(family == 0 || at == groups.end() ? otherwise : at->second);
  }
  for (const med_int family : families) owner.push_back(index[family]);
}

class Reader {
 public:
  Reader(File& file, std::string mesh) : file_(file), mesh_(std::move(mesh)) {}

  void read_points(SimplexMesh<3>& mesh) {
    const med_int n = count(MED_NODE, MED_NONE, MED_COORDINATE, MED_NO_CMODE);
    if (n < 4) return file_(-1);
    std::vector<med_float> points(3 * static_cast<std::size_t>(n));
    file_(MEDmeshNodeCoordinateRd(file_, mesh_.c_str(), MED_NO_DT, MED_NO_IT, MED_FULL_INTERLACE,
                                  points.data()));
    for (std::size_t i = 0; i < points.size(); i += 3)
      mesh.points.emplace_back(points[i], points[i + 1], points[i + 2]);
  }
  /// `nodes` corners each, and the families.
  void read_cells(med_geometry_type type, std::size_t corners, std::size_t nodes,
                  std::vector<med_int>& ids, std::vector<med_int>& families) {
    const med_int n = count(MED_CELL, type, MED_CONNECTIVITY, MED_NODAL);
    if (n <= 0) return;
    ids.resize(corners * static_cast<std::size_t>(n));
    families.assign(static_cast<std::size_t>(n), 0);
    file_(MEDmeshElementConnectivityRd(file_, mesh_.c_str(), MED_NO_DT, MED_NO_IT, MED_CELL, type,
                                       MED_NODAL, MED_FULL_INTERLACE, ids.data()));
    if (count(MED_CELL, type, MED_FAMILY_NUMBER, MED_NODAL) > 0)
      file_(MEDmeshEntityFamilyNumberRd(file_, mesh_.c_str(), MED_NO_DT, MED_NO_IT, MED_CELL, type,
                                        families.data()));
    for (const med_int id : ids)
      if (id < 1 || static_cast<std::size_t>(id) > nodes) return file_(-1);
  }
  void read_fields(MeshContent& out) {
    const med_int fields = MEDnField(file_);
    for (int i = 1; i <= fields; ++i) {
      const med_int n = MEDfieldnComponent(file_, i);
      if (n < 1) continue;
      std::string components(static_cast<std::size_t>(n) * MED_SNAME_SIZE + 1, '\0');
      std::string units = components;
      char name[MED_NAME_SIZE + 1] = {}, of_mesh[MED_NAME_SIZE + 1] = {};
      char time_unit[MED_SNAME_SIZE + 1] = {};
      med_bool local = MED_FALSE;
      med_field_type type = MED_FLOAT64;
      med_int steps = 0;
      if (MEDfieldInfo(file_, i, name, of_mesh, &local, &type, components.data(), units.data(),
                       time_unit, &steps) < 0 ||
          type != MED_FLOAT64 || mesh_ != of_mesh)
        continue;
      if (n == 1) read_of_elements(name, out);
      if (n == 6 && std::string(name) == kMetric) read_metric(out);
    }
  }

 private:
  med_int count(med_entity_type entity, med_geometry_type type, med_data_type data,
                med_connectivity_mode mode) {
    med_bool changed = MED_FALSE, moved = MED_FALSE;
    return MEDmeshnEntity(file_, mesh_.c_str(), MED_NO_DT, MED_NO_IT, entity, type, data, mode,
                          &changed, &moved);
  }
  bool values_of(const char* name, med_entity_type entity, med_geometry_type type,
                 std::size_t expected, std::size_t components, std::vector<med_float>& values) {
    if (MEDfieldnValue(file_, name, MED_NO_DT, MED_NO_IT, entity, type) !=
        static_cast<med_int>(expected))
      return false;
    values.resize(expected * components);
    return MEDfieldValueRd(file_, name, MED_NO_DT, MED_NO_IT, entity, type, MED_FULL_INTERLACE,
                           MED_ALL_CONSTITUENT,
                           reinterpret_cast<unsigned char*>(values.data())) >= 0;
  }
  void read_of_elements(const char* name, MeshContent& out) {
    ElementField field{name, {}};
    if (values_of(name, MED_CELL, MED_TETRA4, out.mesh.elements.size(), 1, field.values))
      out.of_elements.push_back(std::move(field));
  }
  void read_metric(MeshContent& out) {
    std::vector<med_float> values;
    if (!values_of(kMetric, MED_NODE, MED_NONE, out.mesh.node_count(), 6, values)) return;
    out.metric.assign(out.mesh.points.size(), Metric<3>::Identity());
    for (std::size_t v = 1; v < out.metric.size(); ++v)
      for (std::size_t c = 0; c < 6; ++c) {
        const auto [i, j] = kTensor[c];
        out.metric[v](i, j) = out.metric[v](j, i) = values[6 * (v - 1) + c];
      }
  }

  File& file_;
  std::string mesh_;
};

}  // namespace

Result<void> write_med(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const Progress& progress) {
  if (progress.cancelled()) return cancelled_error();
  Result<AtomicFile> target = AtomicFile::create(file);
  if (!target) return target.error();
  const Error failure{Code::io, "\"" + file.string() + "\": writing failed.",
                      "Check the space on the disk."};
  File open(target->temporary(), MED_ACC_CREAT);
  if (!open.good()) return failure;
  write_mesh(mesh, fields, open);
  progress.report(0.6);
  if (progress.cancelled()) return cancelled_error();
  write_fields(fields, open);
  open.close();
  if (!open.good()) return failure;
  return target->commit();
}

Result<MeshContent> read_med(const std::filesystem::path& file, const Progress& progress) {
  const auto refuse = [&](const std::string& finding, const std::string& hint) {
    return Error{Code::bad_input, "\"" + file.string() + "\": " + finding + ".", hint};
  };
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file, ec))
    return Error{Code::io, "\"" + file.string() + "\": there is no such file.",
                 "Check the name and the folder."};
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // failures are told by us
  med_bool is_hdf = MED_FALSE, is_med = MED_FALSE;
  if (MEDfileCompatibility(file.c_str(), &is_hdf, &is_med) < 0 || !is_hdf || !is_med)
    return refuse("not a MED file that can be read", "It may be truncated or of another version.");
  File open(file, MED_ACC_RDONLY);
  if (!open.good() || MEDnMesh(open) < 1)
    return refuse("it holds no mesh", "It may be truncated or of another kind.");
  char name[MED_NAME_SIZE + 1] = {}, text[MED_COMMENT_SIZE + 1] = {};
  char time_unit[MED_SNAME_SIZE + 1] = {};
  const med_int axes = MEDmeshnAxis(open, 1);
  if (axes != 3) return refuse("it holds no mesh in 3D", "Only tetrahedra can be used.");
  std::string axis_names(3 * MED_SNAME_SIZE + 1, '\0'), axis_units = axis_names;
  med_int space = 0, dimension = 0, steps = 0;
  med_mesh_type kind = MED_UNSTRUCTURED_MESH;
  med_sorting_type sorting = MED_SORT_DTIT;
  med_axis_type axis = MED_CARTESIAN;
  open(MEDmeshInfo(open, 1, name, &space, &dimension, &kind, text, time_unit, &sorting, &steps,
                   &axis, axis_names.data(), axis_units.data()));
  MeshContent content;
  SimplexMesh<3>& mesh = content.mesh;
  if (one_of(axis_units, 0, MED_SNAME_SIZE) == "m") content.unit = LengthUnit::m;
  std::vector<med_int> ids, families, triangles, triangle_families;
  if (Reader reader(open, name); open.good()) {
    reader.read_points(mesh);
    progress.report(0.3);
    if (open.good()) reader.read_cells(MED_TETRA4, 4, mesh.node_count(), ids, families);
    if (open.good())
      reader.read_cells(MED_TRIA3, 3, mesh.node_count(), triangles, triangle_families);
    if (progress.cancelled()) return cancelled_error();
    if (!open.good())
      return refuse("the file is damaged", "It may be truncated; write or copy it again.");
    if (ids.empty())
      return refuse("it holds no tetrahedra", "Only volume meshes of tetrahedra can be used.");
    for (std::size_t at = 0; at < ids.size(); at += 4) {
      SimplexMesh<3>::Element e;
      for (std::size_t k = 0; k < 4; ++k) e[kCorner[k]] = static_cast<NodeId>(ids[at + k]);
      mesh.elements.push_back(e);
    }
    for (std::size_t at = 0; at < triangles.size(); at += 3)
      mesh.facets.push_back({static_cast<NodeId>(triangles[at]),
                             static_cast<NodeId>(triangles[at + 1]),
                             static_cast<NodeId>(triangles[at + 2])});
    const auto groups = read_families(open, name);
    name_them(families, groups, "body", mesh.element_body, mesh.bodies);
    name_them(triangle_families, groups, "walls", mesh.facet_group, mesh.groups);
    mesh.facet_face = mesh.facet_group;
    reader.read_fields(content);
  }
  list_boundary(mesh);
  return content;
}

MeshFormat med_format() {
  MeshFormat format;
  format.name = "med";
  format.title = "MED (Salome, Code_Aster)";
  format.endings = {".med"};
  format.filling = format.metric = true;
  // A field's name has 64 bytes, "filling " included, and is a path for HDF5.
  format.names = {.never = "/", .longest = 56, .shared = true};
  format.write = [](const SimplexMesh<3>& mesh, const MeshFields& fields,
                    const std::filesystem::path& file,
                    const Progress& progress) -> Result<MeshFormat::Notes> {
    if (Result<void> done = write_med(mesh, fields, file, progress); !done) return done.error();
    return MeshFormat::Notes{};
  };
  // The library believes the lengths that a damaged file states, and can crash of it.
  format.read = [](const std::filesystem::path& file, const Progress& progress) {
    return read_in_child(file, read_med, progress);
  };
  return format;
}

}  // namespace lamella
