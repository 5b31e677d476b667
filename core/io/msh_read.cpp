#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>
#include <map>
#include <optional>

#include "core/base/atomic_file.h"
#include "core/io/mesh_file.h"
#include "core/io/msh.h"

namespace lamella {

namespace {

// Those of second order count by their corners.
constexpr int kTriangle = 2, kTetrahedron = 4, kTriangle2 = 9, kTetrahedron2 = 11;

/// What elements are called that are solid and no tetrahedra; null for all others.
const char* solid_called(std::int32_t type) {
  if (type == 5 || type == 12 || type == 17) return "hexahedra";
  if (type == 6 || type == 13 || type == 18) return "prisms";
  if (type == 7 || type == 14 || type == 19) return "pyramids";
  if (type == 29) return "tetrahedra of third order";
  return nullptr;
}

/// Reads numbers in text or binary, a piece of the file at a time; after the first failure
/// everything reads as zero.
class Reader {
 public:
  /// `size` is that of the file; nothing when it is no regular one, which is then read whole.
  Reader(std::istream& stream, std::optional<std::uint64_t> size) : stream_(stream) {
    left_in_stream_ = size.value_or(std::numeric_limits<std::uint64_t>::max());
    if (size) return;
    while (fill(window_.size() + 1)) {
    }
    left_in_stream_ = 0;
  }

  bool failed() const { return failed_; }
  void fail() { failed_ = true; }
  bool at_end() { return !fill(1); }
  void set_binary(bool binary) { binary_ = binary; }
  std::uint64_t left() const { return window_.size() - at_ + left_in_stream_; }

  /// Next line without its end; valid until more is read.
  std::string_view line() {
    if (at_end()) return fail(), std::string_view{};
    const std::size_t length = find('\n', 0);
    std::string_view text(window_.data() + at_, length);
    at_ = std::min(at_ + length + 1, window_.size());
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
    const std::string end = "$End" + std::string(name);
    while (fill(end.size())) {
      const std::size_t at = window_.find(end, at_);
      if (at != window_.npos) {
        at_ = at;
        line();
        return;
      }
      at_ = window_.size() - end.size() + 1;
    }
    fail();
    at_ = window_.size();
  }
  template <class T>
  T text_number() {
    while (fill(1) && std::isspace(static_cast<unsigned char>(window_[at_]))) ++at_;
    fill(kLongestNumber);
    T v{};
    const auto [end, ec] =
        std::from_chars(window_.data() + at_, window_.data() + window_.size(), v);
    if (ec != std::errc{}) return fail(), T{};
    at_ = static_cast<std::size_t>(end - window_.data());
    return v;
  }
  std::int32_t integer() { return number<std::int32_t>(); }
  double real() { return number<double>(); }
  std::uint64_t size() { return number<std::uint64_t>(); }
  /// Number of a node or of an element; more than there can be in a mesh of ours is a failure.
  std::uint32_t tag() {
    const std::uint64_t n = size();
    if (n > std::numeric_limits<std::uint32_t>::max()) return fail(), 0;
    return static_cast<std::uint32_t>(n);
  }
  /// A count of records of at least `least` bytes each in text: one that cannot fit is a failure.
  std::size_t count(std::size_t least) {
    const std::uint64_t n = size();
    if (n > left() / least + 1) return fail(), 0;
    return failed_ ? 0 : static_cast<std::size_t>(n);
  }
  std::string quoted() {
    const std::size_t open = find('"', 0);
    const std::size_t close = find('"', open + 1);
    if (at_ + close >= window_.size()) return fail(), std::string{};
    std::string text = window_.substr(at_ + open + 1, close - open - 1);
    at_ += close + 1;
    return text;
  }

 private:
  static constexpr std::size_t kPiece = 1 << 18, kLongestNumber = 512;

  /// Sees to it that so many bytes can be looked at; false when the file has no more.
  bool fill(std::size_t bytes) {
    if (window_.size() - at_ >= bytes) return true;
    if (left_in_stream_ == 0) return false;
    window_.erase(0, at_);
    at_ = 0;
    while (window_.size() < bytes && left_in_stream_ > 0) {
      const std::size_t before = window_.size();
      const auto piece = static_cast<std::size_t>(
          std::min<std::uint64_t>(std::max(kPiece, before), left_in_stream_));
      window_.resize(before + piece);
      stream_.read(window_.data() + before, static_cast<std::streamsize>(piece));
      const auto got = static_cast<std::size_t>(stream_.gcount());
      window_.resize(before + got);
      left_in_stream_ = got < piece ? 0 : left_in_stream_ - got;
    }
    return window_.size() >= bytes;
  }
  /// How far from here the character is, `from` at least; without it, where the file ends.
  std::size_t find(char c, std::size_t from) {
    for (;;) {
      const std::size_t at = window_.find(c, at_ + from);
      if (at != window_.npos) return at - at_;
      from = std::max(from, window_.size() - at_);
      if (!fill(from + 1)) return window_.size() - at_;
    }
  }
  template <class T>
  T number() {
    if (failed_) return T{};
    if (!binary_) return text_number<T>();
    if (!fill(sizeof(T))) return fail(), T{};
    T v;
    std::memcpy(&v, window_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return v;
  }
  std::istream& stream_;
  std::uint64_t left_in_stream_ = 0;
  std::string window_;
  std::size_t at_ = 0;
  bool binary_ = false, failed_ = false;
};

/// What a file says before it is put together.
struct Raw {
  std::map<std::pair<int, std::int32_t>, std::string> names;      // (dimension, tag)
  std::map<std::pair<int, std::int32_t>, std::int32_t> physical;  // entity -> first physical tag
  std::vector<std::uint32_t> tags;
  std::vector<Vec<3>> points;
  /// A stretch of `elements` or `facets`.
  struct Block {
    int dimension = 0;
    std::int32_t entity = 0;
    std::int32_t physical = 0;  ///< of version 2.2; 0: that of the entity
    std::size_t count = 0;
  };
  std::vector<Block> blocks;
  // With the tags of the nodes; a tag above the largest NodeId stands there as a negative one.
  std::vector<SimplexMesh<3>::Element> elements;
  std::vector<SimplexMesh<3>::Facet> facets;
  std::vector<std::uint32_t> element_tags;
  struct Field {
    std::string name;
    enum class Of { nodes, elements, corners } of = Of::nodes;
    int components = 1;
    std::vector<std::uint32_t> tags;
    std::vector<double> values;  ///< so many for each tag, of corners four times as many
  };
  std::vector<Field> fields;
  bool second_order = false;
  const char* other_solid = nullptr;  ///< a kind that cannot be used

  /// Corners to take of an element; 0: it does not matter.
  int corners_of(std::int32_t type) {
    second_order = second_order || type == kTetrahedron2;
    if (!other_solid) other_solid = solid_called(type);
    if (type == kTriangle || type == kTriangle2) return 3;
    return type == kTetrahedron || type == kTetrahedron2 ? 4 : 0;
  }
  /// Reads the nodes of an element, of which the corners are kept.
  void read_nodes_of(Reader& r, std::uint32_t tag, int nodes, int corners) {
    SimplexMesh<3>::Element v{};
    for (int k = 0; k < nodes; ++k)
      if (const std::uint32_t node = r.tag(); k < corners) v[k] = static_cast<NodeId>(node);
    if (corners == 4) {
      elements.push_back(v);
      element_tags.push_back(tag);
    } else if (corners == 3) {
      facets.push_back({v[0], v[1], v[2]});
    }
    if (corners > 0) ++blocks.back().count;
  }
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
    for (std::size_t i = 0; i < n && !r.failed(); ++i) raw.tags.push_back(r.tag());
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
    Raw::Block block;
    block.dimension = r.integer();
    block.entity = r.integer();
    const std::int32_t type = r.integer();
    const std::size_t n = r.count(4);
    const int nodes = nodes_of_type(type);
    if (nodes == 0) return r.fail();
    const int corners = n > 0 ? raw.corners_of(type) : 0;
    if (corners > 0) {
      block.dimension = corners - 1;
      raw.blocks.push_back(block);
    }
    if (corners == 4) {
      raw.elements.reserve(raw.elements.size() + n);
      raw.element_tags.reserve(raw.element_tags.size() + n);
    }
    for (std::size_t i = 0; i < n && !r.failed(); ++i) {
      const std::uint32_t tag = r.tag();
      raw.read_nodes_of(r, tag, nodes, corners);
    }
  }
}

void read_nodes_22(Reader& r, Raw& raw) {
  const std::size_t n = r.count(8);
  raw.tags.reserve(n);
  raw.points.reserve(n);
  for (std::size_t i = 0; i < n && !r.failed(); ++i) {
    raw.tags.push_back(r.tag());
    Vec<3> x;
    for (int k = 0; k < 3; ++k) x[k] = r.real();
    raw.points.push_back(x);
  }
}

void read_elements_22(Reader& r, Raw& raw) {
  const std::size_t n = r.count(8);
  raw.elements.reserve(n);
  raw.element_tags.reserve(n);
  for (std::size_t i = 0; i < n && !r.failed(); ++i) {
    const std::uint32_t tag = r.tag();
    const std::int32_t type = r.integer();
    const std::int32_t count = r.integer();
    std::int32_t tags[2] = {0, 0};
    for (std::int32_t k = 0; k < count && !r.failed(); ++k) {
      const std::int32_t t = r.integer();
      if (k < 2) tags[k] = t;
    }
    const int nodes = nodes_of_type(type);
    if (nodes == 0) return r.fail();
    const int corners = raw.corners_of(type);
    if (corners == 0) {
      for (int k = 0; k < nodes; ++k) r.integer();
      continue;
    }
    const int dimension = corners - 1;
    if (raw.blocks.empty() || raw.blocks.back().dimension != dimension ||
        raw.blocks.back().entity != tags[1] || raw.blocks.back().physical != tags[0])
      raw.blocks.push_back({dimension, tags[1], tags[0], 0});
    raw.read_nodes_of(r, tag, nodes, corners);
  }
}

void read_data(Reader& r, Raw& raw, Raw::Field::Of of) {
  Raw::Field field;
  field.of = of;
  for (auto n = r.text_number<std::size_t>(); n > 0 && !r.failed(); --n) {
    const std::string text = r.quoted();
    if (field.name.empty()) field.name = text;
  }
  for (auto n = r.text_number<std::size_t>(); n > 0 && !r.failed(); --n) r.text_number<double>();
  std::vector<std::int32_t> tags;
  for (auto n = r.text_number<std::size_t>(); n > 0 && !r.failed(); --n)
    tags.push_back(r.text_number<std::int32_t>());
  if (tags.size() < 3 || tags[1] < 1 || tags[1] > 9 || tags[2] < 0) return r.fail();
  r.line();
  field.components = tags[1];
  const auto count = static_cast<std::size_t>(tags[2]);
  if (count > r.left() / 4 + 1) return r.fail();
  field.tags.reserve(count);
  field.values.reserve(count * static_cast<std::size_t>(field.components));
  for (std::int32_t i = 0; i < tags[2] && !r.failed(); ++i) {
    const auto tag = static_cast<std::uint32_t>(r.integer());
    const bool of_corners = of == Raw::Field::Of::corners;
    const std::int32_t nodes = of_corners ? r.integer() : 1;
    if (nodes < 0 || nodes > 1000) return r.fail();
    // Of tetrahedra, of first and second order, the corners come first.
    const bool used = !of_corners || nodes == 4 || nodes == 10;
    if (used) field.tags.push_back(tag);
    for (std::int32_t k = 0; k < nodes; ++k)
      for (int c = 0; c < field.components; ++c)
        if (const double value = r.real(); used && k < 4) field.values.push_back(value);
  }
  raw.fields.push_back(std::move(field));
}

/// Numbers 1, 2, .. for the tags of a file, in the order of the tags.
class Numbers {
 public:
  explicit Numbers(std::vector<std::uint32_t> tags) : tags_(std::move(tags)) {
    std::sort(tags_.begin(), tags_.end());
  }
  /// 0: there is no such tag.
  NodeId of(std::uint32_t tag) const {
    if (tag > 0 && tag <= tags_.size() && tags_[tag - 1] == tag) return static_cast<NodeId>(tag);
    const auto it = std::lower_bound(tags_.begin(), tags_.end(), tag);
    if (it == tags_.end() || *it != tag) return 0;
    return static_cast<NodeId>(it - tags_.begin()) + 1;
  }

 private:
  std::vector<std::uint32_t> tags_;
};

/// Index of the physical `tag` among the names of its dimension; grows `names` where the file gives
/// none.
std::int32_t index_of(std::map<std::int32_t, std::int32_t>& indices,
                      std::vector<std::string>& names, std::int32_t tag, const char* stem) {
  const auto [it, fresh] = indices.try_emplace(tag, static_cast<std::int32_t>(names.size()));
  if (fresh) names.push_back(std::string(stem) + " " + std::to_string(tag));
  return it->second;
}

Metric<3> matrix_of(const Raw::Field& field, std::size_t i) {
  const Metric<3> m = Eigen::Map<const Metric<3>>(&field.values[9 * i]);
  return (m + m.transpose()) / 2;
}

/// False when a value is of a node that is not in the file.
bool take_nodes(const Raw::Field& field, const Numbers& numbers, MeshContent& out) {
  const bool is_metric = field.name == "metric" && field.components == 9;
  if (field.components == 9 && !is_metric) {
    TensorField tensor{field.name, true,
                       std::vector<Metric<3>>(out.mesh.points.size(), Metric<3>::Identity())};
    for (std::size_t i = 0; i < field.tags.size(); ++i) {
      const NodeId node = numbers.of(field.tags[i]);
      if (node == 0) return false;
      tensor.values[node] = matrix_of(field, i);
    }
    out.tensors.push_back(std::move(tensor));
    return true;
  }
  if (!is_metric && !(field.name == "thickness" && field.components == 1)) {
    if (field.components != 1 && field.components != 3) return true;
    const auto n = static_cast<std::size_t>(field.components);
    NodeField further{field.name, field.components,
                      std::vector<double>(n * out.mesh.points.size(), 0)};
    for (std::size_t i = 0; i < field.tags.size(); ++i) {
      const NodeId node = numbers.of(field.tags[i]);
      if (node == 0) return false;
      for (std::size_t c = 0; c < n; ++c)
        further.values[static_cast<std::size_t>(node) * n + c] = field.values[n * i + c];
    }
    out.of_nodes.push_back(std::move(further));
    return true;
  }
  if (is_metric)
    out.metric.assign(out.mesh.points.size(), Metric<3>::Identity());
  else
    out.thickness.assign(out.mesh.points.size(), 0);
  for (std::size_t i = 0; i < field.tags.size(); ++i) {
    const NodeId node = numbers.of(field.tags[i]);
    if (node == 0) return false;
    if (is_metric)
      out.metric[node] = matrix_of(field, i);
    else
      out.thickness[node] = field.values[i];
  }
  return true;
}

/// The same of elements. What has no value gets 0.
bool take_elements(const Raw::Field& field, const Raw& raw, MeshContent& out) {
  if (field.components != 1 && field.components != 9) return true;
  const std::vector<std::uint32_t>& tags = raw.element_tags;
  const Numbers numbers(tags);
  std::vector<std::size_t> element(tags.size() + 1);
  for (std::size_t e = 0; e < tags.size(); ++e) element[numbers.of(tags[e])] = e;
  if (field.components == 9) {
    TensorField tensor{field.name, false,
                       std::vector<Metric<3>>(tags.size(), Metric<3>::Identity())};
    for (std::size_t i = 0; i < field.tags.size(); ++i)
      if (const NodeId number = numbers.of(field.tags[i]); number > 0)
        tensor.values[element[number]] = matrix_of(field, i);
    out.tensors.push_back(std::move(tensor));
    return true;
  }
  ElementField values{field.name, std::vector<double>(tags.size(), 0)};
  for (std::size_t i = 0; i < field.tags.size(); ++i)
    if (const NodeId number = numbers.of(field.tags[i]); number > 0)
      values.values[element[number]] = field.values[i];
  out.of_elements.push_back(std::move(values));
  return true;
}

/// Values that elements have at their corners, each on its own: the mean at the nodes.
void take_corners(const Raw::Field& field, const Raw& raw, MeshContent& out) {
  if (field.components != 1 && field.components != 3) return;
  const auto n = static_cast<std::size_t>(field.components);
  const Numbers numbers(raw.element_tags);
  std::vector<std::size_t> element(raw.element_tags.size() + 1);
  for (std::size_t e = 0; e < raw.element_tags.size(); ++e)
    element[numbers.of(raw.element_tags[e])] = e;
  NodeField means{field.name, field.components, std::vector<double>(n * out.mesh.points.size(), 0)};
  std::vector<int> count(out.mesh.points.size(), 0);
  for (std::size_t i = 0; i < field.tags.size(); ++i) {
    const NodeId number = numbers.of(field.tags[i]);
    if (number == 0) continue;
    const auto& corners = out.mesh.elements[element[number]];
    for (std::size_t k = 0; k < 4; ++k) {
      ++count[corners[k]];
      for (std::size_t c = 0; c < n; ++c)
        means.values[n * corners[k] + c] += field.values[n * (4 * i + k) + c];
    }
  }
  for (std::size_t v = 1; v < count.size(); ++v)
    for (std::size_t c = 0; c < n && count[v] > 1; ++c) means.values[n * v + c] /= count[v];
  out.of_nodes.push_back(std::move(means));
}

/// False when an element uses a node that is not in the file.
bool assemble(Raw& raw, MeshContent& out) {
  SimplexMesh<3>& mesh = out.mesh;
  mesh.bodies.clear();
  mesh.groups.clear();
  const Numbers numbers(raw.tags);
  mesh.points.resize(raw.points.size() + 1);
  for (std::size_t i = 0; i < raw.points.size(); ++i)
    mesh.points[numbers.of(raw.tags[i])] = raw.points[i];
  raw.points = {};

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
  const auto number = [&](auto& simplices) {
    for (auto& simplex : simplices)
      for (NodeId& v : simplex)
        if ((v = numbers.of(static_cast<std::uint32_t>(v))) == 0) return false;
    return true;
  };
  mesh.elements = std::move(raw.elements);
  mesh.facets = std::move(raw.facets);
  if (!number(mesh.elements) || !number(mesh.facets)) return false;
  mesh.element_body.reserve(mesh.elements.size());
  for (const Raw::Block& block : raw.blocks) {
    const auto it = raw.physical.find({block.dimension, block.entity});
    const std::int32_t tag = block.physical != 0        ? block.physical
                             : it == raw.physical.end() ? block.entity
                                                        : it->second;
    if (block.dimension == 3) {
      const std::int32_t index = index_of(bodies, mesh.bodies, tag, "body");
      mesh.element_body.insert(mesh.element_body.end(), block.count, index);
    } else {
      const std::int32_t index = index_of(groups, mesh.groups, tag, "group");
      mesh.facet_group.insert(mesh.facet_group.end(), block.count, index);
      mesh.facet_face.insert(mesh.facet_face.end(), block.count, block.entity - 1);
    }
  }
  for (Raw::Field& field : raw.fields) {
    if (field.of == Raw::Field::Of::corners)
      take_corners(field, raw, out);
    else if (!(field.of == Raw::Field::Of::nodes ? take_nodes(field, numbers, out)
                                                 : take_elements(field, raw, out)))
      return false;
    field = {};  // meshes are large: nothing is kept twice for longer than needed
  }
  return true;
}

}  // namespace

Result<MeshContent> read_msh(const std::filesystem::path& file) {
  Result<std::ifstream> stream = open_to_read(file);
  if (!stream) return stream.error();
  const auto refuse = [&](const std::string& finding, const std::string& hint) {
    return Error{Code::bad_input, "\"" + file.string() + "\": " + finding + ".", hint};
  };
  std::error_code ec;
  const bool regular = std::filesystem::is_regular_file(file, ec);
  const std::uint64_t size = regular ? std::filesystem::file_size(file, ec) : 0;
  Reader r(*stream, regular ? std::optional(size) : std::nullopt);
  if (r.keyword() != "$MeshFormat")
    return refuse("not a Gmsh file, it does not begin with $MeshFormat",
                  "Check that the file is an MSH file.");
  const double version = r.text_number<double>();
  const bool binary = r.text_number<int>() != 0;
  const int width = r.text_number<int>();
  const bool old = version >= 2 && version < 3;
  if ((version != 4.1 && !old) || width != 8)
    return refuse("MSH version other than 4.1 and 2", "Convert it: gmsh -save -format msh41 FILE.");
  if (old && binary)
    return refuse("a binary file of MSH version 2", "Convert it: gmsh -save -format msh41 FILE.");
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
    if (section == "Nodes") old ? read_nodes_22(r, raw) : read_nodes(r, raw);
    if (section == "Elements") old ? read_elements_22(r, raw) : read_elements(r, raw);
    if (section == "NodeData") read_data(r, raw, Raw::Field::Of::nodes);
    if (section == "ElementData") read_data(r, raw, Raw::Field::Of::elements);
    if (section == "ElementNodeData") read_data(r, raw, Raw::Field::Of::corners);
    if (!r.failed()) r.leave(section);
  }
  if (r.failed())
    return refuse("the section $" + section + " is damaged or the file ends within it",
                  "The file may be truncated; write or copy it again.");
  if (raw.other_solid)
    return refuse(std::string("it holds ") + raw.other_solid,
                  "Only tetrahedra of first and second order can be used.");
  MeshContent content;
  if (!assemble(raw, content))
    return refuse("an element or a value refers to a node that is not there",
                  "The file is damaged; write it again.");
  if (content.mesh.elements.empty())
    return refuse("it holds no tetrahedra", "Only volume meshes of tetrahedra can be used.");
  if (raw.second_order) drop_unused_nodes(content);
  return content;
}

}  // namespace lamella
