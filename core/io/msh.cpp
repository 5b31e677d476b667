#include "core/io/msh.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>

#include "core/base/atomic_file.h"

namespace lamella {

namespace {

constexpr int kTriangle = 2, kTetrahedron = 4;

/// Appends numbers as the 4.1 format wants them, in text or binary, and hands full blocks on.
class Writer {
 public:
  Writer(std::ostream& out, bool binary) : out_(out), binary_(binary) {}
  ~Writer() { flush(); }

  void text(std::string_view s) { buffer_.append(s); }
  void integer(std::int32_t v) { number(v); }
  void size(std::uint64_t v) { number(v); }
  void real(double v) { number(v); }
  /// Ends a record: a line in text, nothing in binary.
  void end() {
    if (!binary_ && !buffer_.empty()) buffer_.back() = '\n';
    if (buffer_.size() > (1u << 20)) flush();
  }
  /// Ends a section's data, so that the next keyword begins a line.
  void close() {
    if (binary_) buffer_.push_back('\n');
  }

 private:
  template <class T>
  void number(T v) {
    if (binary_) {
      char raw[sizeof(T)];
      std::memcpy(raw, &v, sizeof(T));
      buffer_.append(raw, sizeof(T));
    } else {
      char digits[32];
      const auto end = std::to_chars(digits, digits + sizeof digits, v).ptr;
      buffer_.append(digits, end).push_back(' ');
    }
  }
  void flush() {
    out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
  }
  std::ostream& out_;
  bool binary_;
  std::string buffer_;
};

/// A physical name stands between double quotes on one line.
std::string quotable(std::string name) {
  for (char& c : name) {
    if (c == '"') c = '\'';
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return name;
}

struct SurfaceEntity {
  std::int32_t group, face;
  std::vector<std::int32_t> facets;
};

/// One entity per (group, CAD face), in that order.
std::vector<SurfaceEntity> surface_entities(const SimplexMesh<3>& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::int32_t>> by_face;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    by_face[{mesh.facet_group[f], mesh.facet_face[f]}].push_back(static_cast<std::int32_t>(f));
  std::vector<SurfaceEntity> entities;
  for (auto& [key, facets] : by_face)
    entities.push_back({key.first, key.second, std::move(facets)});
  return entities;
}

struct Box {
  Vec<3> low = Vec<3>::Constant(1e300), high = Vec<3>::Constant(-1e300);
  void add(const Vec<3>& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  void write(Writer& w) const {
    for (int i = 0; i < 3; ++i) w.real(low[i]);
    for (int i = 0; i < 3; ++i) w.real(high[i]);
  }
};

/// Nodes by the entity that owns them: the first surface they lie on, else the body.
struct Owners {
  std::vector<std::vector<NodeId>> surface, volume;
};

Owners owners_of(const SimplexMesh<3>& mesh, const std::vector<SurfaceEntity>& surfaces) {
  Owners owners;
  owners.surface.resize(surfaces.size());
  owners.volume.resize(mesh.bodies.size());
  std::vector<std::int32_t> owner(mesh.points.size(), -1);
  const auto count = static_cast<std::int32_t>(surfaces.size());
  for (std::int32_t s = 0; s < count; ++s)
    for (const std::int32_t f : surfaces[s].facets)
      for (const NodeId v : mesh.facets[f])
        if (owner[v] < 0) owner[v] = s;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const NodeId v : mesh.elements[e])
      if (owner[v] < 0) owner[v] = count + mesh.element_body[e];
  for (NodeId v = 1; v < static_cast<NodeId>(mesh.points.size()); ++v) {
    // A node of no element belongs to the first body, so that numbers stay as they are.
    const std::int32_t o = owner[v] < 0 ? count : owner[v];
    (o < count ? owners.surface[o] : owners.volume[o - count]).push_back(v);
  }
  return owners;
}

void write_names(const SimplexMesh<3>& mesh, Writer& w) {
  const std::size_t bodies = mesh.bodies.size();
  w.text("$PhysicalNames\n" + std::to_string(bodies + mesh.groups.size()) + "\n");
  for (std::size_t b = 0; b < bodies; ++b)
    w.text("3 " + std::to_string(b + 1) + " \"" + quotable(mesh.bodies[b]) + "\"\n");
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    w.text("2 " + std::to_string(bodies + g + 1) + " \"" + quotable(mesh.groups[g]) + "\"\n");
  w.text("$EndPhysicalNames\n");
}

void write_entities(const SimplexMesh<3>& mesh, const std::vector<SurfaceEntity>& surfaces,
                    Writer& w) {
  w.text("$Entities\n");
  w.size(0);
  w.size(0);
  w.size(surfaces.size());
  w.size(mesh.bodies.size());
  w.end();
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    Box box;
    for (const std::int32_t f : surfaces[s].facets)
      for (const NodeId v : mesh.facets[f]) box.add(mesh.points[v]);
    w.integer(static_cast<std::int32_t>(s + 1));
    box.write(w);
    w.size(1);
    w.integer(static_cast<std::int32_t>(mesh.bodies.size()) + surfaces[s].group + 1);
    w.size(0);
    w.end();
  }
  std::vector<Box> boxes(mesh.bodies.size());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const NodeId v : mesh.elements[e]) boxes[mesh.element_body[e]].add(mesh.points[v]);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    w.integer(static_cast<std::int32_t>(b + 1));
    boxes[b].write(w);
    w.size(1);
    w.integer(static_cast<std::int32_t>(b + 1));
    w.size(0);
    w.end();
  }
  w.close();
  w.text("$EndEntities\n");
}

void write_nodes(const SimplexMesh<3>& mesh, const Owners& owners, Writer& w) {
  w.text("$Nodes\n");
  w.size(owners.surface.size() + owners.volume.size());
  w.size(mesh.node_count());
  w.size(1);
  w.size(mesh.node_count());
  w.end();
  const auto block = [&](int dimension, std::size_t index, const std::vector<NodeId>& nodes) {
    w.integer(dimension);
    w.integer(static_cast<std::int32_t>(index + 1));
    w.integer(0);
    w.size(nodes.size());
    w.end();
    for (const NodeId v : nodes) {
      w.size(static_cast<std::uint64_t>(v));
      w.end();
    }
    for (const NodeId v : nodes) {
      for (int i = 0; i < 3; ++i) w.real(mesh.points[v][i]);
      w.end();
    }
  };
  for (std::size_t s = 0; s < owners.surface.size(); ++s) block(2, s, owners.surface[s]);
  for (std::size_t b = 0; b < owners.volume.size(); ++b) block(3, b, owners.volume[b]);
  w.close();
  w.text("$EndNodes\n");
}

void write_elements(const SimplexMesh<3>& mesh, const std::vector<SurfaceEntity>& surfaces,
                    Writer& w) {
  std::vector<std::vector<std::int32_t>> by_body(mesh.bodies.size());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    by_body[mesh.element_body[e]].push_back(static_cast<std::int32_t>(e));

  w.text("$Elements\n");
  const std::uint64_t count = mesh.facets.size() + mesh.elements.size();
  w.size(surfaces.size() + by_body.size());
  w.size(count);
  w.size(1);
  w.size(count);
  w.end();
  std::uint64_t tag = 0;
  const auto block = [&](int dimension, std::size_t index, int type,
                         const std::vector<std::int32_t>& ids, const auto& simplices) {
    w.integer(dimension);
    w.integer(static_cast<std::int32_t>(index + 1));
    w.integer(type);
    w.size(ids.size());
    w.end();
    for (const std::int32_t id : ids) {
      w.size(++tag);
      for (const NodeId v : simplices[id]) w.size(static_cast<std::uint64_t>(v));
      w.end();
    }
  };
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    block(2, s, kTriangle, surfaces[s].facets, mesh.facets);
  for (std::size_t b = 0; b < by_body.size(); ++b)
    block(3, b, kTetrahedron, by_body[b], mesh.elements);
  w.close();
  w.text("$EndElements\n");
}

/// `value(node, component)`; the components are 1 or 9, all Gmsh knows for our fields.
template <class Value>
void write_node_data(const std::string& name, int components, std::size_t nodes, Writer& w,
                     const Value& value) {
  w.text("$NodeData\n1\n\"" + name + "\"\n1\n0\n3\n0\n" + std::to_string(components) + "\n" +
         std::to_string(nodes) + "\n");
  for (NodeId v = 1; v <= static_cast<NodeId>(nodes); ++v) {
    w.integer(v);
    for (int c = 0; c < components; ++c) w.real(value(v, c));
    w.end();
  }
  w.close();
  w.text("$EndNodeData\n");
}

/// Reads numbers in text or binary; after the first failure everything reads as zero.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  bool failed() const { return failed_; }
  void fail() { failed_ = true; }
  bool at_end() const { return at_ >= bytes_.size(); }
  void set_binary(bool binary) { binary_ = binary; }
  std::size_t left() const { return bytes_.size() - at_; }

  /// Next line without its end.
  std::string_view line() {
    if (at_end()) return fail(), std::string_view{};
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string_view text = bytes_.substr(at_, end - at_);
    at_ = std::min(end + 1, bytes_.size());
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return text;
  }
  /// Next line that is not blank; empty at the end of the file.
  std::string_view keyword() {
    while (!at_end()) {
      const std::string_view text = line();
      if (text.find_first_not_of(" \t") != std::string_view::npos) return text;
    }
    return {};
  }
  /// Leaves the section `name`, from anywhere inside.
  void leave(std::string_view name) {
    const std::size_t end = bytes_.find("$End" + std::string(name), at_);
    if (end == std::string_view::npos) {
      fail();
      at_ = bytes_.size();
      return;
    }
    at_ = end;
    line();
  }
  template <class T>
  T text_number() {
    while (at_ < bytes_.size() && std::isspace(static_cast<unsigned char>(bytes_[at_]))) ++at_;
    T v{};
    const auto [end, ec] = std::from_chars(bytes_.data() + at_, bytes_.data() + bytes_.size(), v);
    if (ec != std::errc{}) return fail(), T{};
    at_ = static_cast<std::size_t>(end - bytes_.data());
    return v;
  }
  std::int32_t integer() { return number<std::int32_t>(); }
  double real() { return number<double>(); }
  std::uint64_t size() { return number<std::uint64_t>(); }
  /// A count of records of at least `least` bytes each in text: one that cannot fit is a failure.
  std::size_t count(std::size_t least) {
    const std::uint64_t n = size();
    if (n > left() / least + 1) return fail(), 0;
    return failed_ ? 0 : static_cast<std::size_t>(n);
  }
  std::string quoted() {
    const std::size_t open = bytes_.find('"', at_);
    const std::size_t close = open == std::string_view::npos ? open : bytes_.find('"', open + 1);
    if (close == std::string_view::npos) return fail(), std::string{};
    at_ = close + 1;
    return std::string(bytes_.substr(open + 1, close - open - 1));
  }

 private:
  template <class T>
  T number() {
    if (failed_) return T{};
    if (!binary_) return text_number<T>();
    if (left() < sizeof(T)) return fail(), T{};
    T v;
    std::memcpy(&v, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return v;
  }
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool binary_ = false, failed_ = false;
};

/// What a file says before it is put together.
struct Raw {
  std::map<std::pair<int, std::int32_t>, std::string> names;      // (dimension, tag)
  std::map<std::pair<int, std::int32_t>, std::int32_t> physical;  // entity -> first physical tag
  std::vector<std::uint64_t> tags;
  std::vector<Vec<3>> points;
  struct Simplices {
    int dimension;
    std::int32_t entity;
    std::vector<std::uint64_t> nodes;
  };
  std::vector<Simplices> blocks;
  std::map<std::string, std::pair<int, std::vector<std::pair<std::int32_t, std::vector<double>>>>>
      data;
};

/// Nodes of an element by its Gmsh type; 0: a type we do not know.
int nodes_of_type(std::int32_t type) {
  static const std::map<std::int32_t, int> known = {
      {1, 2},   {2, 3},   {3, 4},   {4, 4},   {5, 8},   {6, 6},   {7, 5},  {8, 3},
      {9, 6},   {10, 9},  {11, 10}, {12, 27}, {13, 18}, {14, 14}, {15, 1}, {16, 8},
      {17, 20}, {18, 15}, {19, 13}, {20, 9},  {21, 10}, {26, 4},  {29, 20}};
  const auto it = known.find(type);
  return it == known.end() ? 0 : it->second;
}

void read_names(Reader& r, Raw& raw) {
  const auto n = r.text_number<std::size_t>();
  for (std::size_t i = 0; i < n && !r.failed(); ++i) {
    const int dimension = r.text_number<int>();
    const auto tag = r.text_number<std::int32_t>();
    raw.names[{dimension, tag}] = r.quoted();
  }
}

void read_entities(Reader& r, Raw& raw) {
  std::array<std::size_t, 4> counts{};
  for (std::size_t& n : counts) n = r.count(4);
  for (int dimension = 0; dimension < 4; ++dimension)
    for (std::size_t i = 0; i < counts[dimension] && !r.failed(); ++i) {
      const std::int32_t tag = r.integer();
      for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) r.real();
      const std::size_t physicals = r.count(2);
      for (std::size_t k = 0; k < physicals && !r.failed(); ++k) {
        const std::int32_t physical = r.integer();
        if (k == 0) raw.physical[{dimension, tag}] = std::abs(physical);
      }
      if (dimension == 0) continue;
      const std::size_t bounds = r.count(2);
      for (std::size_t k = 0; k < bounds && !r.failed(); ++k) r.integer();
    }
}

void read_nodes(Reader& r, Raw& raw) {
  const std::size_t blocks = r.count(4);
  const std::size_t total = r.count(8);
  r.size();
  r.size();
  raw.tags.reserve(total);
  raw.points.reserve(total);
  for (std::size_t b = 0; b < blocks && !r.failed(); ++b) {
    const int dimension = r.integer();
    r.integer();
    const bool parametric = r.integer() != 0;
    const std::size_t n = r.count(8);
    for (std::size_t i = 0; i < n && !r.failed(); ++i) raw.tags.push_back(r.size());
    for (std::size_t i = 0; i < n && !r.failed(); ++i) {
      Vec<3> x;
      for (int k = 0; k < 3; ++k) x[k] = r.real();
      for (int k = 0; parametric && k < dimension; ++k) r.real();
      raw.points.push_back(x);
    }
  }
}

void read_elements(Reader& r, Raw& raw) {
  const std::size_t blocks = r.count(4);
  for (int i = 0; i < 3; ++i) r.size();
  for (std::size_t b = 0; b < blocks && !r.failed(); ++b) {
    Raw::Simplices block;
    block.dimension = r.integer();
    block.entity = r.integer();
    const std::int32_t type = r.integer();
    const std::size_t n = r.count(4);
    const int nodes = nodes_of_type(type);
    if (nodes == 0) return r.fail();
    const bool wanted = type == kTriangle || type == kTetrahedron;
    if (wanted) block.nodes.reserve(n * nodes);
    for (std::size_t i = 0; i < n && !r.failed(); ++i) {
      r.size();
      for (int k = 0; k < nodes; ++k) {
        const std::uint64_t v = r.size();
        if (wanted) block.nodes.push_back(v);
      }
    }
    if (wanted) raw.blocks.push_back(std::move(block));
  }
}

void read_node_data(Reader& r, Raw& raw) {
  std::string name;
  for (auto n = r.text_number<std::size_t>(); n > 0 && !r.failed(); --n) {
    const std::string text = r.quoted();
    if (name.empty()) name = text;
  }
  for (auto n = r.text_number<std::size_t>(); n > 0 && !r.failed(); --n) r.text_number<double>();
  std::vector<std::int32_t> tags;
  for (auto n = r.text_number<std::size_t>(); n > 0 && !r.failed(); --n)
    tags.push_back(r.text_number<std::int32_t>());
  if (tags.size() < 3 || tags[1] < 1 || tags[1] > 9 || tags[2] < 0) return r.fail();
  r.line();
  auto& [components, values] = raw.data[name];
  components = tags[1];
  for (std::int32_t i = 0; i < tags[2] && !r.failed(); ++i) {
    const std::int32_t node = r.integer();
    std::vector<double> v(components);
    for (double& x : v) x = r.real();
    values.emplace_back(node, std::move(v));
  }
}

/// Our node ids 1, 2, .. for the tags of a file, in the order of the tags.
class NodeNumbers {
 public:
  explicit NodeNumbers(std::vector<std::uint64_t> tags) : tags_(std::move(tags)) {
    std::sort(tags_.begin(), tags_.end());
  }
  /// 0: there is no such node.
  NodeId of(std::uint64_t tag) const {
    if (tag > 0 && tag <= tags_.size() && tags_[tag - 1] == tag) return static_cast<NodeId>(tag);
    const auto it = std::lower_bound(tags_.begin(), tags_.end(), tag);
    if (it == tags_.end() || *it != tag) return 0;
    return static_cast<NodeId>(it - tags_.begin()) + 1;
  }

 private:
  std::vector<std::uint64_t> tags_;
};

/// Index of the physical `tag` among the names of its dimension; grows `names` where the file gives
/// none.
std::int32_t index_of(std::map<std::int32_t, std::int32_t>& indices,
                      std::vector<std::string>& names, std::int32_t tag, const char* stem) {
  const auto [it, fresh] = indices.try_emplace(tag, static_cast<std::int32_t>(names.size()));
  if (fresh) names.push_back(std::string(stem) + " " + std::to_string(tag));
  return it->second;
}

/// False when an element uses a node that is not in the file.
bool assemble(const Raw& raw, MshContent& out) {
  SimplexMesh<3>& mesh = out.mesh;
  mesh.bodies.clear();
  mesh.groups.clear();
  const NodeNumbers numbers(raw.tags);
  mesh.points.resize(raw.points.size() + 1);
  for (std::size_t i = 0; i < raw.points.size(); ++i)
    mesh.points[numbers.of(raw.tags[i])] = raw.points[i];

  std::map<std::int32_t, std::int32_t> bodies, groups;
  for (const auto& [key, name] : raw.names) {
    if (key.first == 3) {
      bodies[key.second] = static_cast<std::int32_t>(mesh.bodies.size());
      mesh.bodies.push_back(name);
    } else if (key.first == 2) {
      groups[key.second] = static_cast<std::int32_t>(mesh.groups.size());
      mesh.groups.push_back(name);
    }
  }
  for (const Raw::Simplices& block : raw.blocks) {
    const auto it = raw.physical.find({block.dimension, block.entity});
    const std::int32_t tag = it == raw.physical.end() ? block.entity : it->second;
    const bool solid = block.dimension == 3;
    const std::size_t corners = solid ? 4 : 3;
    const std::int32_t index = solid ? index_of(bodies, mesh.bodies, tag, "body")
                                     : index_of(groups, mesh.groups, tag, "group");
    for (std::size_t at = 0; at + corners <= block.nodes.size(); at += corners) {
      std::array<NodeId, 4> v{};
      for (std::size_t k = 0; k < corners; ++k) {
        v[k] = numbers.of(block.nodes[at + k]);
        if (v[k] == 0) return false;
      }
      if (solid) {
        mesh.elements.push_back(v);
        mesh.element_body.push_back(index);
      } else {
        mesh.facets.push_back({v[0], v[1], v[2]});
        mesh.facet_group.push_back(index);
        mesh.facet_face.push_back(block.entity - 1);
      }
    }
  }
  for (const auto& [name, field] : raw.data) {
    const auto& [components, values] = field;
    const bool is_metric = name == "metric" && components == 9;
    if (!is_metric && !(name == "thickness" && components == 1)) continue;
    if (is_metric)
      out.metric.assign(mesh.points.size(), Metric<3>::Identity());
    else
      out.thickness.assign(mesh.points.size(), 0);
    for (const auto& [tag, v] : values) {
      const NodeId node = numbers.of(static_cast<std::uint64_t>(tag));
      if (node == 0) return false;
      if (is_metric)
        out.metric[node] = Eigen::Map<const Metric<3>>(v.data());
      else
        out.thickness[node] = v[0];
    }
  }
  return true;
}

}  // namespace

Result<void> write_msh(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const MshParams& params,
                       const Progress& progress) {
  Result<AtomicFile> target = AtomicFile::create(file);
  if (!target) return target.error();
  {
    Writer w(target->stream(), params.binary);
    w.text(std::string("$MeshFormat\n4.1 ") + (params.binary ? "1" : "0") + " 8\n");
    if (params.binary) {
      w.integer(1);
      w.close();
    }
    w.text("$EndMeshFormat\n");
    write_names(mesh, w);
    const std::vector<SurfaceEntity> surfaces = surface_entities(mesh);
    write_entities(mesh, surfaces, w);
    if (progress.cancelled()) return cancelled_error();
    write_nodes(mesh, owners_of(mesh, surfaces), w);
    progress.report(0.3);
    if (progress.cancelled()) return cancelled_error();
    write_elements(mesh, surfaces, w);
    progress.report(0.7);
    if (progress.cancelled()) return cancelled_error();
    if (fields.metric)
      write_node_data("metric", 9, mesh.node_count(), w,
                      [&](NodeId v, int c) { return (*fields.metric)[v](c / 3, c % 3); });
    if (fields.thickness)
      write_node_data("thickness", 1, mesh.node_count(), w,
                      [&](NodeId v, int) { return (*fields.thickness)[v]; });
  }
  if (Result<void> done = target->commit(); !done) return done;
  progress.report(1);
  return {};
}

Result<MshContent> read_msh(const std::filesystem::path& file) {
  Result<std::string> bytes = read_file(file);
  if (!bytes) return bytes.error();
  const auto refuse = [&](const std::string& finding, const std::string& hint) {
    return Error{Code::bad_input, "\"" + file.string() + "\": " + finding + ".", hint};
  };
  Reader r(*bytes);
  if (r.keyword() != "$MeshFormat")
    return refuse("not a Gmsh file, it does not begin with $MeshFormat",
                  "Check that the file is an MSH file.");
  const double version = r.text_number<double>();
  const bool binary = r.text_number<int>() != 0;
  const int width = r.text_number<int>();
  if (version != 4.1 || width != 8)
    return refuse("MSH version other than 4.1", "Convert it: gmsh -save -format msh41 FILE.");
  r.line();
  r.set_binary(binary);
  if (binary && r.integer() != 1)
    return refuse("written by a machine of the other byte order", "Save it as text there.");
  r.leave("MeshFormat");

  Raw raw;
  std::string section;
  while (!r.failed()) {
    const std::string_view key = r.keyword();
    if (key.empty()) break;
    if (key[0] != '$') return refuse("no section where one should begin", "The file is damaged.");
    section = std::string(key.substr(1));
    if (section == "PhysicalNames") read_names(r, raw);
    if (section == "Entities") read_entities(r, raw);
    if (section == "Nodes") read_nodes(r, raw);
    if (section == "Elements") read_elements(r, raw);
    if (section == "NodeData") read_node_data(r, raw);
    if (!r.failed()) r.leave(section);
  }
  if (r.failed())
    return refuse("the section $" + section + " is damaged or the file ends within it",
                  "The file may be truncated; write or copy it again.");
  MshContent content;
  if (!assemble(raw, content))
    return refuse("an element or a value refers to a node that is not there",
                  "The file is damaged; write it again.");
  if (content.mesh.elements.empty())
    return refuse("it holds no tetrahedra", "Only volume meshes of tetrahedra can be used.");
  return content;
}

}  // namespace lamella
