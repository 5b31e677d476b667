#include "core/io_cgns/cgns.h"

#include <cgnslib.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/io/facet_sides.h"
#include "core/io/read_in_child.h"

namespace lamella {

namespace {

constexpr std::array<const char*, 3> kCoordinates = {"CoordinateX", "CoordinateY", "CoordinateZ"};
constexpr std::array<const char*, 6> kMetricNames = {"MetricXX", "MetricYY", "MetricZZ",
                                                     "MetricXY", "MetricYZ", "MetricXZ"};
constexpr std::array<std::array<int, 2>, 6> kTensor = {
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

/// An open file; every call of the library counts its failures here.
class File {
 public:
  File(const std::filesystem::path& path, int mode) {
    good_ = cg_open(path.c_str(), mode, &id_) == CG_OK;
    if (!good_) id_ = 0;
  }
  ~File() { close(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  operator int() const { return id_; }
  bool good() const { return good_; }
  void operator()(int status) { good_ = good_ && status == CG_OK; }
  void close() {
    if (id_ != 0 && cg_close(id_) != CG_OK) good_ = false;
    id_ = 0;
  }

 private:
  int id_ = 0;
  bool good_ = false;
};

CGNS_ENUMT(BCType_t) condition_of(const std::string& group) {
  std::string name = group;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto has = [&](const char* word) { return name.find(word) != name.npos; };
  if (has("symm")) return CGNS_ENUMV(BCSymmetryPlane);
  if (has("gate") || has("inlet")) return CGNS_ENUMV(BCInflow);
  if (has("vent") || has("outlet") || has("opening")) return CGNS_ENUMV(BCOutflow);
  return CGNS_ENUMV(BCWall);
}

/// Corners of those that belong to `owner`, one after the other.
template <class Simplices>
std::vector<cgsize_t> corners_of(const Simplices& simplices,
                                 const std::vector<std::int32_t>& owners, std::size_t owner) {
  std::vector<cgsize_t> corners;
  for (std::size_t i = 0; i < simplices.size(); ++i)
    if (owners[i] == static_cast<std::int32_t>(owner))
      corners.insert(corners.end(), simplices[i].begin(), simplices[i].end());
  return corners;
}

/// Base and zone are the only ones, with number 1.
void write_mesh(const SimplexMesh<3>& mesh, const MeshFields& fields, File& file) {
  int id = 0;
  file(cg_base_write(file, "Base", 3, 3, &id));
  file(cg_goto(file, 1, "end"));
  file(cg_descriptor_write("Generator", ("Lamella " + version()).c_str()));
  file(cg_dataclass_write(CGNS_ENUMV(Dimensional)));
  file(cg_units_write(CGNS_ENUMV(Kilogram),
                      fields.unit == LengthUnit::m ? CGNS_ENUMV(Meter) : CGNS_ENUMV(Millimeter),
                      CGNS_ENUMV(Second), CGNS_ENUMV(Kelvin), CGNS_ENUMV(Radian)));
  cgsize_t size[3] = {static_cast<cgsize_t>(mesh.node_count()),
                      static_cast<cgsize_t>(mesh.elements.size()), 0};
  file(cg_zone_write(file, 1, "Zone", size, CGNS_ENUMV(Unstructured), &id));
  std::vector<double> values;
  for (int k = 0; k < 3; ++k) {
    values.clear();
    for (std::size_t v = 1; v < mesh.points.size(); ++v) values.push_back(mesh.points[v][k]);
    file(cg_coord_write(file, 1, 1, CGNS_ENUMV(RealDouble), kCoordinates[k], values.data(), &id));
    file(cg_goto(file, 1, "Zone_t", 1, "GridCoordinates_t", 1, "DataArray_t", id, "end"));
    const float exponents[5] = {0, 1, 0, 0, 0};
    file(cg_exponents_write(CGNS_ENUMV(RealSingle), exponents));
  }
  cgsize_t next = 1;
  const auto section = [&](const std::string& name, CGNS_ENUMT(ElementType_t) type,
                           const std::vector<cgsize_t>& corners, int nodes) {
    const cgsize_t last = next + static_cast<cgsize_t>(corners.size()) / nodes - 1;
    file(cg_section_write(file, 1, 1, name.c_str(), type, next, last, 0, corners.data(), &id));
    file(cg_family_write(file, 1, name.c_str(), &id));
    std::array<cgsize_t, 2> range = {next, last};
    next = last + 1;
    return range;
  };
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b)
    if (const auto corners = corners_of(mesh.elements, mesh.element_body, b); !corners.empty())
      section(mesh.bodies[b], CGNS_ENUMV(TETRA_4), corners, 4);
  // A boundary condition is of faces with one cell: others would make the zone leak.
  std::vector<bool> inner(mesh.groups.size(), false);
  const std::vector<FacetSide> sides = facet_sides(mesh);
  for (std::size_t f = 0; f < sides.size(); ++f)
    if (sides[f].other >= 0) inner[mesh.facet_group[f]] = true;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    const auto corners = corners_of(mesh.facets, mesh.facet_group, g);
    if (corners.empty()) continue;
    const auto range = section(mesh.groups[g], CGNS_ENUMV(TRI_3), corners, 3);
    if (inner[g]) continue;
    const int family = id;
    file(cg_fambc_write(file, 1, family, "FamBC", condition_of(mesh.groups[g]), &id));
    int condition = 0;
    file(cg_boco_write(file, 1, 1, mesh.groups[g].c_str(), CGNS_ENUMV(FamilySpecified),
                       CGNS_ENUMV(PointRange), 2, range.data(), &condition));
    file(cg_boco_gridlocation_write(file, 1, 1, condition, CGNS_ENUMV(FaceCenter)));
    file(cg_goto(file, 1, "Zone_t", 1, "ZoneBC_t", 1, "BC_t", condition, "end"));
    file(cg_famname_write(mesh.groups[g].c_str()));
  }
}

void write_fields(const SimplexMesh<3>& mesh, const MeshFields& fields, File& file) {
  int solution = 0, id = 0;
  std::vector<double> values;
  if (fields.metric) {
    file(cg_sol_write(file, 1, 1, "Metric", CGNS_ENUMV(Vertex), &solution));
    for (int c = 0; c < 6; ++c) {
      values.clear();
      for (std::size_t v = 1; v < mesh.points.size(); ++v)
        values.push_back((*fields.metric)[v](kTensor[c][0], kTensor[c][1]));
      file(cg_field_write(file, 1, 1, solution, CGNS_ENUMV(RealDouble), kMetricNames[c],
                          values.data(), &id));
      file(cg_goto(file, 1, "Zone_t", 1, "FlowSolution_t", solution, "DataArray_t", id, "end"));
      const float exponents[5] = {0, -2, 0, 0, 0};
      file(cg_exponents_write(CGNS_ENUMV(RealSingle), exponents));
    }
  }
  if (fields.of_elements.empty()) return;
  file(cg_sol_write(file, 1, 1, "Elements", CGNS_ENUMV(CellCenter), &solution));
  for (const ElementField& field : fields.of_elements) {
    values.clear();
    for (std::size_t b = 0; b < mesh.bodies.size(); ++b)
      for (std::size_t e = 0; e < mesh.elements.size(); ++e)
        if (mesh.element_body[e] == static_cast<std::int32_t>(b)) values.push_back(field.values[e]);
    file(cg_field_write(file, 1, 1, solution, CGNS_ENUMV(RealDouble), field.name.c_str(),
                        values.data(), &id));
    file(cg_goto(file, 1, "Zone_t", 1, "FlowSolution_t", solution, "DataArray_t", id, "end"));
    file(cg_dataclass_write(CGNS_ENUMV(NondimensionalParameter)));
  }
}

void read_sections(File& file, std::size_t nodes, SimplexMesh<3>& mesh) {
  mesh.bodies.clear();
  mesh.groups.clear();
  int sections = 0;
  file(cg_nsections(file, 1, 1, &sections));
  for (int s = 1; s <= sections && file.good(); ++s) {
    char name[33] = {};
    CGNS_ENUMT(ElementType_t) type = CGNS_ENUMV(ElementTypeNull);
    cgsize_t first = 0, last = 0;
    int boundary = 0, parents = 0;
    file(cg_section_read(file, 1, 1, s, name, &type, &first, &last, &boundary, &parents));
    const bool solid = type == CGNS_ENUMV(TETRA_4);
    if (!file.good() || (!solid && type != CGNS_ENUMV(TRI_3))) continue;
    const std::size_t corners = solid ? 4 : 3;
    if (last < first) return file(CG_ERROR);
    std::vector<cgsize_t> ids(static_cast<std::size_t>(last - first + 1) * corners);
    file(cg_elements_read(file, 1, 1, s, ids.data(), nullptr));
    for (std::size_t at = 0; at < ids.size() && file.good(); at += corners) {
      std::array<NodeId, 4> v{};
      for (std::size_t k = 0; k < corners; ++k) {
        if (ids[at + k] < 1 || static_cast<std::size_t>(ids[at + k]) > nodes) return file(CG_ERROR);
        v[k] = static_cast<NodeId>(ids[at + k]);
      }
      if (solid) {
        mesh.elements.push_back(v);
        mesh.element_body.push_back(static_cast<std::int32_t>(mesh.bodies.size()));
      } else {
        mesh.facets.push_back({v[0], v[1], v[2]});
        mesh.facet_group.push_back(static_cast<std::int32_t>(mesh.groups.size()));
      }
    }
    (solid ? mesh.bodies : mesh.groups).push_back(name);
  }
  mesh.facet_face = mesh.facet_group;
  if (mesh.groups.empty()) mesh.groups = {"walls"};
}

/// Only those whose length fits; a solver may have added others.
void read_fields(File& file, MeshContent& out) {
  int solutions = 0;
  if (cg_nsols(file, 1, 1, &solutions) != CG_OK) return;
  for (int s = 1; s <= solutions; ++s) {
    char name[33] = {};
    CGNS_ENUMT(GridLocation_t) place = CGNS_ENUMV(GridLocationNull);
    int fields = 0;
    if (cg_sol_info(file, 1, 1, s, name, &place) != CG_OK ||
        cg_nfields(file, 1, 1, s, &fields) != CG_OK)
      continue;
    const bool at_nodes = place == CGNS_ENUMV(Vertex);
    if (!at_nodes && place != CGNS_ENUMV(CellCenter)) continue;
    const std::size_t count = at_nodes ? out.mesh.node_count() : out.mesh.elements.size();
    const cgsize_t first = 1, last = static_cast<cgsize_t>(count);
    MetricField<3> metric(out.mesh.points.size(), Metric<3>::Identity());
    int components = 0;
    for (int f = 1; f <= fields; ++f) {
      char field[33] = {};
      CGNS_ENUMT(DataType_t) type = CGNS_ENUMV(DataTypeNull);
      std::vector<double> values(count);
      if (cg_field_info(file, 1, 1, s, f, &type, field) != CG_OK ||
          cg_field_read(file, 1, 1, s, field, CGNS_ENUMV(RealDouble), &first, &last,
                        values.data()) != CG_OK)
        continue;
      if (!at_nodes) {
        out.of_elements.push_back({field, std::move(values)});
        continue;
      }
      for (std::size_t c = 0; c < 6; ++c) {
        if (std::strcmp(kMetricNames[c], field) != 0) continue;
        ++components;
        const auto [i, j] = kTensor[c];
        for (std::size_t v = 0; v < count; ++v)
          metric[v + 1](i, j) = metric[v + 1](j, i) = values[v];
      }
    }
    if (components == 6) out.metric = std::move(metric);
  }
}

}  // namespace

Result<void> write_cgns(const SimplexMesh<3>& mesh, const MeshFields& fields,
                        const std::filesystem::path& file, const Progress& progress) {
  if (progress.cancelled()) return cancelled_error();
  Result<AtomicFile> target = AtomicFile::create(file);
  if (!target) return target.error();
  const auto failure = [&] {
    return Error{Code::io, "\"" + file.string() + "\": writing failed (" + cg_get_error() + ").",
                 "Check the space on the disk."};
  };
  cg_set_file_type(CG_FILE_HDF5);
  File open(target->temporary(), CG_MODE_WRITE);
  if (!open.good()) return failure();
  write_mesh(mesh, fields, open);
  progress.report(0.6);
  if (progress.cancelled()) return cancelled_error();
  write_fields(mesh, fields, open);
  open.close();
  if (!open.good()) return failure();
  return target->commit();
}

Result<MeshContent> read_cgns(const std::filesystem::path& file, const Progress& progress) {
  const auto refuse = [&](const std::string& finding, const std::string& hint) {
    return Error{Code::bad_input, "\"" + file.string() + "\": " + finding + ".", hint};
  };
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file, ec))
    return Error{Code::io, "\"" + file.string() + "\": there is no such file.",
                 "Check the name and the folder."};
  File open(file, CG_MODE_READ);
  if (!open.good()) return refuse("not a CGNS file that can be read", "It may be truncated.");
  char name[33] = {};
  int cells = 0, space = 0;
  CGNS_ENUMT(ZoneType_t) kind = CGNS_ENUMV(ZoneTypeNull);
  cgsize_t size[9] = {};
  open(cg_base_read(open, 1, name, &cells, &space));
  open(cg_zone_type(open, 1, 1, &kind));
  open(cg_zone_read(open, 1, 1, name, size));
  if (!open.good() || space != 3 || kind != CGNS_ENUMV(Unstructured) || size[0] < 4)
    return refuse("it holds no unstructured zone in 3D", "Only tetrahedra can be used.");
  MeshContent content;
  SimplexMesh<3>& mesh = content.mesh;
  if (cg_goto(open, 1, "end") == CG_OK) {
    CGNS_ENUMT(MassUnits_t) mass;
    CGNS_ENUMT(LengthUnits_t) length;
    CGNS_ENUMT(TimeUnits_t) time;
    CGNS_ENUMT(TemperatureUnits_t) temperature;
    CGNS_ENUMT(AngleUnits_t) angle;
    if (cg_units_read(&mass, &length, &time, &temperature, &angle) == CG_OK &&
        length == CGNS_ENUMV(Meter))
      content.unit = LengthUnit::m;
  }
  const cgsize_t first = 1;
  mesh.points.resize(static_cast<std::size_t>(size[0]) + 1, Vec<3>::Zero());
  std::vector<double> values(static_cast<std::size_t>(size[0]));
  for (int k = 0; k < 3; ++k) {
    open(cg_coord_read(open, 1, 1, kCoordinates[k], CGNS_ENUMV(RealDouble), &first, &size[0],
                       values.data()));
    for (std::size_t v = 0; v < values.size(); ++v) mesh.points[v + 1][k] = values[v];
  }
  progress.report(0.4);
  if (progress.cancelled()) return cancelled_error();
  if (open.good()) read_sections(open, mesh.node_count(), mesh);
  if (!open.good())
    return refuse("the file is damaged", "It may be truncated; write or copy it again.");
  if (mesh.elements.empty())
    return refuse("it holds no tetrahedra", "Only volume meshes of tetrahedra can be used.");
  read_fields(open, content);
  list_boundary(mesh);
  return content;
}

MeshFormat cgns_format() {
  MeshFormat format;
  format.name = "cgns";
  format.title = "CGNS";
  format.endings = {".cgns"};
  format.filling = format.metric = true;
  // Labels have 32 bytes, "filling " included.
  format.names = {.any = false, .marks = "_-.", .longest = 24, .shared = true};
  format.write = [](const SimplexMesh<3>& mesh, const MeshFields& fields,
                    const std::filesystem::path& file,
                    const Progress& progress) -> Result<MeshFormat::Notes> {
    if (Result<void> done = write_cgns(mesh, fields, file, progress); !done) return done.error();
    return MeshFormat::Notes{};
  };
  // The library believes the lengths that a damaged file states, and can crash of it.
  format.read = [](const std::filesystem::path& file, const Progress& progress) {
    return read_in_child(file, read_cgns, progress);
  };
  return format;
}

}  // namespace lamella
