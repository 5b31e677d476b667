#include "core/io_vtk/exodus.h"

#include <vtk_exodusII.h>

#include <algorithm>

#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/io/facet_sides.h"

namespace lamella {

namespace {

constexpr int kLongestName = 80;
/// Side of a TETRA opposite to a vertex: 1 is 1-2-4, 2 is 2-3-4, 3 is 1-4-3, 4 is 1-3-2.
constexpr std::array<int, 4> kSideOfVertex = {2, 3, 1, 4};
constexpr std::array<const char*, 6> kMetricNames = {"metric_xx", "metric_yy", "metric_zz",
                                                     "metric_xy", "metric_yz", "metric_xz"};
constexpr std::array<std::array<int, 2>, 6> kTensor = {
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

/// An open file; every call of the library counts its failures here.
class File {
 public:
  explicit File(int id) : id_(id) {}
  ~File() { close(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  operator int() const { return id_; }
  bool good() const { return good_; }
  void operator()(int status) { good_ = good_ && status >= 0; }
  void close() {
    if (id_ >= 0 && ex_close(id_) < 0) good_ = false;
    id_ = -1;
  }

 private:
  int id_;
  bool good_ = true;
};

/// Names as the library takes them.
class Names {
 public:
  explicit Names(std::vector<std::string> names) : names_(std::move(names)) {
    for (std::string& name : names_) pointers_.push_back(name.data());
  }
  char** data() { return pointers_.data(); }
  int count() const { return static_cast<int>(names_.size()); }

 private:
  std::vector<std::string> names_;
  std::vector<char*> pointers_;
};

/// Entries of each owner, where there are some.
std::vector<std::vector<std::int32_t>> lists_of(const std::vector<std::int32_t>& owner,
                                                std::size_t count) {
  std::vector<std::vector<std::int32_t>> lists(count);
  for (std::size_t i = 0; i < owner.size(); ++i)
    lists[owner[i]].push_back(static_cast<std::int32_t>(i));
  return lists;
}

void write_mesh(const SimplexMesh<3>& mesh, const std::vector<std::vector<std::int32_t>>& bodies,
                const MeshFields& fields, File& file) {
  auto groups = lists_of(mesh.facet_group, mesh.groups.size());
  const auto used = [](const auto& lists) {
    return std::count_if(lists.begin(), lists.end(), [](const auto& l) { return !l.empty(); });
  };
  const std::string title = "Lamella " + version() + ", lengths in " + unit_name(fields.unit);
  ex_set_max_name_length(file, kLongestName);
  file(ex_put_init(file, title.c_str(), 3, static_cast<std::int64_t>(mesh.node_count()),
                   static_cast<std::int64_t>(mesh.elements.size()), used(bodies), 0, used(groups)));
  std::vector<double> x[3];
  for (int k = 0; k < 3; ++k)
    for (std::size_t v = 1; v < mesh.points.size(); ++v) x[k].push_back(mesh.points[v][k]);
  file(ex_put_coord(file, x[0].data(), x[1].data(), x[2].data()));

  // Elements are numbered block by block.
  std::vector<int> number(mesh.elements.size());
  int next = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].empty()) continue;
    std::vector<int> nodes;
    for (const std::int32_t e : bodies[b]) {
      number[e] = ++next;
      nodes.insert(nodes.end(), mesh.elements[e].begin(), mesh.elements[e].end());
    }
    const auto id = static_cast<ex_entity_id>(b + 1);
    file(ex_put_block(file, EX_ELEM_BLOCK, id, "TETRA", static_cast<std::int64_t>(bodies[b].size()),
                      4, 0, 0, 0));
    file(ex_put_conn(file, EX_ELEM_BLOCK, id, nodes.data(), nullptr, nullptr));
    file(ex_put_name(file, EX_ELEM_BLOCK, id, mesh.bodies[b].c_str()));
  }
  const std::vector<FacetSide> sides = facet_sides(mesh);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].empty()) continue;
    std::vector<int> elements, local;
    for (const std::int32_t f : groups[g]) {
      if (sides[f].element < 0) continue;
      elements.push_back(number[sides[f].element]);
      local.push_back(kSideOfVertex[sides[f].local]);
    }
    const auto id = static_cast<ex_entity_id>(g + 1);
    file(ex_put_set_param(file, EX_SIDE_SET, id, static_cast<std::int64_t>(elements.size()), 0));
    file(ex_put_set(file, EX_SIDE_SET, id, elements.data(), local.data()));
    file(ex_put_name(file, EX_SIDE_SET, id, mesh.groups[g].c_str()));
  }
}

void write_fields(const SimplexMesh<3>& mesh, const std::vector<std::vector<std::int32_t>>& bodies,
                  const MeshFields& fields, File& file) {
  if (!fields.metric && fields.of_elements.empty()) return;
  const double time = 0;
  if (fields.metric) {
    Names names({kMetricNames.begin(), kMetricNames.end()});
    file(ex_put_variable_param(file, EX_NODAL, names.count()));
    file(ex_put_variable_names(file, EX_NODAL, names.count(), names.data()));
  }
  if (!fields.of_elements.empty()) {
    std::vector<std::string> list;
    for (const ElementField& field : fields.of_elements) list.push_back(field.name);
    Names names(std::move(list));
    file(ex_put_variable_param(file, EX_ELEM_BLOCK, names.count()));
    file(ex_put_variable_names(file, EX_ELEM_BLOCK, names.count(), names.data()));
  }
  file(ex_put_time(file, 1, &time));
  std::vector<double> values;
  for (int c = 0; fields.metric && c < 6; ++c) {
    values.clear();
    for (std::size_t v = 1; v < mesh.points.size(); ++v)
      values.push_back((*fields.metric)[v](kTensor[c][0], kTensor[c][1]));
    file(ex_put_var(file, 1, EX_NODAL, c + 1, 1, static_cast<std::int64_t>(values.size()),
                    values.data()));
  }
  for (std::size_t i = 0; i < fields.of_elements.size(); ++i)
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (bodies[b].empty()) continue;
      values.clear();
      for (const std::int32_t e : bodies[b]) values.push_back(fields.of_elements[i].values[e]);
      file(ex_put_var(file, 1, EX_ELEM_BLOCK, static_cast<int>(i + 1),
                      static_cast<ex_entity_id>(b + 1), static_cast<std::int64_t>(values.size()),
                      values.data()));
    }
}

std::string name_of(int file, ex_entity_type type, int id, const char* stem) {
  char name[kLongestName + 1] = {};
  if (ex_get_name(file, type, id, name) < 0 || name[0] == '\0')
    return std::string(stem) + " " + std::to_string(id);
  return name;
}

std::vector<std::string> variable_names(int file, ex_entity_type type) {
  int count = 0;
  if (ex_get_variable_param(file, type, &count) < 0 || count <= 0) return {};
  Names names(std::vector<std::string>(static_cast<std::size_t>(count),
                                       std::string(kLongestName + 1, '\0')));
  if (ex_get_variable_names(file, type, count, names.data()) < 0) return {};
  std::vector<std::string> list;
  for (int i = 0; i < count; ++i) list.emplace_back(names.data()[i]);
  return list;
}

/// What the blocks hold; `place` gets the element of each number of the file, -1 for other kinds.
void read_blocks(File& file, int count, MeshContent& out, std::vector<std::int32_t>& place) {
  SimplexMesh<3>& mesh = out.mesh;
  mesh.bodies.clear();
  std::vector<int> ids(static_cast<std::size_t>(count));
  file(ex_get_ids(file, EX_ELEM_BLOCK, ids.data()));
  const std::vector<std::string> variables = variable_names(file, EX_ELEM_BLOCK);
  for (const std::string& name : variables) out.of_elements.push_back({name, {}});
  for (const int id : ids) {
    char type[kLongestName + 1] = {};
    int elements = 0, nodes = 0, edges = 0, faces = 0, attributes = 0;
    file(ex_get_block(file, EX_ELEM_BLOCK, id, type, &elements, &nodes, &edges, &faces,
                      &attributes));
    if (!file.good() || elements < 0) return;
    const std::string kind = std::string(type).substr(0, 3);
    if (nodes != 4 || (kind != "TET" && kind != "tet")) {
      place.insert(place.end(), static_cast<std::size_t>(elements), -1);
      continue;
    }
    std::vector<int> corners(static_cast<std::size_t>(elements) * 4);
    file(ex_get_conn(file, EX_ELEM_BLOCK, id, corners.data(), nullptr, nullptr));
    for (std::size_t at = 0; at < corners.size(); at += 4) {
      SimplexMesh<3>::Element e;
      for (std::size_t k = 0; k < 4; ++k) {
        e[k] = corners[at + k];
        if (e[k] < 1 || static_cast<std::size_t>(e[k]) > mesh.node_count()) return file(-1);
      }
      place.push_back(static_cast<std::int32_t>(mesh.elements.size()));
      mesh.elements.push_back(e);
      mesh.element_body.push_back(static_cast<std::int32_t>(mesh.bodies.size()));
    }
    mesh.bodies.push_back(name_of(file, EX_ELEM_BLOCK, id, "block"));
    for (std::size_t i = 0; i < variables.size(); ++i) {
      std::vector<double> values(static_cast<std::size_t>(elements), 0);
      // A variable need not be there for every block.
      ex_get_var(file, 1, EX_ELEM_BLOCK, static_cast<int>(i + 1), id, elements, values.data());
      auto& all = out.of_elements[i].values;
      all.insert(all.end(), values.begin(), values.end());
    }
  }
}

void read_sides(File& file, int count, const std::vector<std::int32_t>& place,
                SimplexMesh<3>& mesh) {
  mesh.groups.clear();
  std::vector<int> ids(static_cast<std::size_t>(count));
  if (count > 0) file(ex_get_ids(file, EX_SIDE_SET, ids.data()));
  for (const int id : ids) {
    int sides = 0, factors = 0;
    file(ex_get_set_param(file, EX_SIDE_SET, id, &sides, &factors));
    if (!file.good() || sides < 0) return;
    std::vector<int> elements(static_cast<std::size_t>(sides)), local(elements.size());
    if (sides > 0) file(ex_get_set(file, EX_SIDE_SET, id, elements.data(), local.data()));
    const auto group = static_cast<std::int32_t>(mesh.groups.size());
    for (std::size_t i = 0; i < elements.size() && file.good(); ++i) {
      if (elements[i] < 1 || static_cast<std::size_t>(elements[i]) > place.size()) return file(-1);
      const std::int32_t e = place[static_cast<std::size_t>(elements[i]) - 1];
      const auto vertex = std::find(kSideOfVertex.begin(), kSideOfVertex.end(), local[i]);
      if (e < 0 || vertex == kSideOfVertex.end()) continue;
      mesh.facets.push_back(
          opposite_facet<3>(mesh.elements[e], static_cast<int>(vertex - kSideOfVertex.begin())));
      mesh.facet_group.push_back(group);
      mesh.facet_face.push_back(group);
    }
    mesh.groups.push_back(name_of(file, EX_SIDE_SET, id, "side set"));
  }
}

void read_metric(File& file, MeshContent& out) {
  const std::vector<std::string> names = variable_names(file, EX_NODAL);
  const auto nodes = static_cast<std::int64_t>(out.mesh.node_count());
  MetricField<3> metric(out.mesh.points.size(), Metric<3>::Identity());
  std::vector<double> values(out.mesh.node_count());
  for (int c = 0; c < 6; ++c) {
    const auto at = std::find(names.begin(), names.end(), kMetricNames[c]);
    if (at == names.end() || ex_get_var(file, 1, EX_NODAL, static_cast<int>(at - names.begin()) + 1,
                                        1, nodes, values.data()) < 0)
      return;
    for (std::size_t v = 0; v < values.size(); ++v)
      metric[v + 1](kTensor[c][0], kTensor[c][1]) = metric[v + 1](kTensor[c][1], kTensor[c][0]) =
          values[v];
  }
  out.metric = std::move(metric);
}

}  // namespace

Result<void> write_exodus(const SimplexMesh<3>& mesh, const MeshFields& fields,
                          const std::filesystem::path& file, const Progress& progress) {
  if (progress.cancelled()) return cancelled_error();
  Result<AtomicFile> target = AtomicFile::create(file);
  if (!target) return target.error();
  const Error failure{Code::io, "\"" + file.string() + "\": writing failed.",
                      "Check the space on the disk."};
  ex_opts(EX_NULLVERBOSE);  // failures are told by us
  int word = 8, stored = 8;
  const int id =
      ex_create(target->temporary().c_str(), EX_CLOBBER | EX_64BIT_OFFSET, &word, &stored);
  if (id < 0) return failure;
  File open(id);
  const auto bodies = lists_of(mesh.element_body, mesh.bodies.size());
  write_mesh(mesh, bodies, fields, open);
  progress.report(0.6);
  if (progress.cancelled()) return cancelled_error();
  write_fields(mesh, bodies, fields, open);
  open.close();
  if (!open.good()) return failure;
  return target->commit();
}

Result<MeshContent> read_exodus(const std::filesystem::path& file, const Progress& progress) {
  const auto refuse = [&](const std::string& finding, const std::string& hint) {
    return Error{Code::bad_input, "\"" + file.string() + "\": " + finding + ".", hint};
  };
  // The library tells no difference between a missing file and a bad one.
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file, ec))
    return Error{Code::io, "\"" + file.string() + "\": there is no such file.",
                 "Check the name and the folder."};
  ex_opts(EX_NULLVERBOSE);
  int word = 8, stored = 0;
  float version = 0;
  const int id = ex_open(file.c_str(), EX_READ, &word, &stored, &version);
  if (id < 0) return refuse("not an Exodus II file", "It may be truncated or of another kind.");
  File open(id);
  ex_set_max_name_length(open, kLongestName);
  char title[MAX_LINE_LENGTH + 1] = {};
  int dimension = 0, nodes = 0, elements = 0, blocks = 0, node_sets = 0, side_sets = 0;
  open(ex_get_init(open, title, &dimension, &nodes, &elements, &blocks, &node_sets, &side_sets));
  if (!open.good() || dimension != 3 || nodes < 4 || blocks < 1)
    return refuse("it holds no mesh in 3D", "Only volume meshes of tetrahedra can be used.");
  MeshContent content;
  content.mesh.points.resize(static_cast<std::size_t>(nodes) + 1, Vec<3>::Zero());
  std::vector<double> x[3];
  for (auto& axis : x) axis.resize(static_cast<std::size_t>(nodes));
  open(ex_get_coord(open, x[0].data(), x[1].data(), x[2].data()));
  for (std::size_t v = 0; v < x[0].size(); ++v)
    content.mesh.points[v + 1] = Vec<3>(x[0][v], x[1][v], x[2][v]);
  progress.report(0.3);
  if (progress.cancelled()) return cancelled_error();
  std::vector<std::int32_t> place;
  read_blocks(open, blocks, content, place);
  if (open.good()) read_sides(open, side_sets, place, content.mesh);
  if (!open.good())
    return refuse("the file is damaged", "It may be truncated; write or copy it again.");
  if (content.mesh.elements.empty())
    return refuse("it holds no tetrahedra", "Only volume meshes of tetrahedra can be used.");
  read_metric(open, content);
  list_boundary(content.mesh);
  return content;
}

}  // namespace lamella
