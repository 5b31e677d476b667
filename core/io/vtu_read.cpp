#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <map>
#include <span>
#include <string>

#include "core/io/vtu.h"

namespace lamella {

namespace {

constexpr std::uint8_t kTriangle = 5, kTetrahedron = 10;
constexpr std::size_t kLongestXml = 1 << 20;
constexpr std::uint64_t kLargestBlock = 1 << 26, kMostBlocks = 1ull << 32;
/// No stream of zlib unpacks to more than so many times its length.
constexpr std::uint64_t kMostPacked = 1032;
constexpr std::int32_t kMostNames = 100000;

using Attributes = std::map<std::string, std::string, std::less<>>;

/// Text of an attribute; false for what can not be told without a parser.
bool unescape(std::string_view text, std::string& out) {
  static const std::map<std::string, char, std::less<>> known = {
      {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
  out.clear();
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '&') {
      out += text[at];
      continue;
    }
    const std::size_t end = text.find(';', at);
    if (end == text.npos) return false;
    const std::string_view name = text.substr(at + 1, end - at - 1);
    at = end;
    if (const auto it = known.find(name); it != known.end()) {
      out += it->second;
      continue;
    }
    int code = 0;
    if (name.size() < 2 || name[0] != '#') return false;
    const bool hex = name[1] == 'x';
    const char* const last = name.data() + name.size();
    const auto [stop, ec] = std::from_chars(name.data() + (hex ? 2 : 1), last, code, hex ? 16 : 10);
    if (ec != std::errc{} || stop != last || code < 1 || code > 127) return false;
    out += static_cast<char>(code);
  }
  return true;
}

struct Tag {
  std::string name;  ///< "/Cells" where one ends
  Attributes attributes;
};

/// The tags of the text in front of the data; false where it is not as simple as that.
bool tags_of(std::string_view xml, std::vector<Tag>& tags) {
  for (std::size_t at = xml.find('<'); at != xml.npos; at = xml.find('<', at)) {
    const std::size_t end = xml.find('>', at);
    if (end == xml.npos) return false;
    std::string_view inside = xml.substr(at + 1, end - at - 1);
    at = end;
    if (inside.empty() || inside[0] == '!') return false;
    if (inside[0] == '?') continue;
    Tag tag;
    const std::size_t name = std::min(inside.find_first_of(" \t\r\n"), inside.size());
    tag.name = inside.substr(0, name);
    inside.remove_prefix(name);
    for (;;) {
      const std::size_t first = inside.find_first_not_of(" \t\r\n");
      if (first == inside.npos || inside[first] == '/') break;
      const std::size_t equal = inside.find("=\"", first);
      if (equal == inside.npos) return false;
      const std::size_t close = inside.find('"', equal + 2);
      if (close == inside.npos) return false;
      std::string& value = tag.attributes[std::string(inside.substr(first, equal - first))];
      if (!unescape(inside.substr(equal + 2, close - equal - 2), value)) return false;
      inside.remove_prefix(close + 1);
    }
    tags.push_back(std::move(tag));
  }
  return true;
}

struct Array {
  std::string name, type;
  std::uint64_t components = 1, tuples = 0, offset = 0;

  bool is_tensor() const { return components == 6 || components == 9; }
};

/// What the XML tells, and the bytes behind it.
class File {
 public:
  explicit File(std::ifstream& stream) : stream_(stream) {}

  std::uint64_t points = 0, cells = 0;
  std::map<std::string, std::vector<Array>, std::less<>> arrays;  ///< by section, as "PointData"

  bool open() {
    size_ = static_cast<std::uint64_t>(stream_.seekg(0, std::ios::end).tellg());
    std::string xml(std::min<std::uint64_t>(size_, kLongestXml), '\0');
    stream_.seekg(0).read(xml.data(), static_cast<std::streamsize>(xml.size()));
    if (!stream_ || !ends_well()) return false;
    const std::size_t appended = xml.find("<AppendedData");
    const std::size_t begin = xml.find('_', std::min(appended, xml.size()));
    if (begin == xml.npos) return false;
    data_ = begin + 1;
    std::vector<Tag> tags;
    return tags_of(std::string_view(xml).substr(0, begin), tags) && take(tags);
  }
  const Array* find(std::string_view section, std::string_view name) const {
    const auto of = arrays.find(section);
    if (of == arrays.end()) return nullptr;
    const auto at = std::find_if(of->second.begin(), of->second.end(),
                                 [&](const Array& a) { return a.name == name; });
    return at == of->second.end() ? nullptr : &*at;
  }
  /// Calls `sink(first, values)` for each piece of an array of so many values of this type; false
  /// when it has another length, is damaged, or `sink` says so.
  template <class T, class Sink>
  bool each(const Array& array, std::uint64_t count, const Sink& sink) {
    Blocks blocks;
    if (!blocks_of(array, blocks) || blocks.bytes != count * sizeof(T) ||
        blocks.length % sizeof(T) != 0)
      return false;
    std::vector<Bytef> packed;
    std::vector<T> values;
    std::uint64_t first = 0;
    for (std::size_t b = 0; b < blocks.packed.size(); ++b) {
      const std::uint64_t bytes = std::min(blocks.length, blocks.bytes - b * blocks.length);
      packed.resize(blocks.packed[b]);
      values.resize(bytes / sizeof(T));
      stream_.read(reinterpret_cast<char*>(packed.data()),
                   static_cast<std::streamsize>(packed.size()));
      uLongf got = bytes;
      if (!stream_ ||
          ::uncompress(reinterpret_cast<Bytef*>(values.data()), &got, packed.data(),
                       packed.size()) != Z_OK ||
          got != bytes || !sink(first, std::span<const T>(values)))
        return false;
      first += values.size();
    }
    return true;
  }
  /// Whether so many values can be behind the array at all: memory is taken only then.
  bool holds(const Array& array, std::uint64_t bytes) {
    Blocks blocks;
    return blocks_of(array, blocks) && blocks.bytes == bytes;
  }
  bool strings(const Array& array, std::vector<std::string>& out) {
    Blocks blocks;
    std::string text;
    if (array.type != "String" || !blocks_of(array, blocks) ||
        !each<char>(array, blocks.bytes, [&](std::uint64_t, std::span<const char> piece) {
          text.append(piece.data(), piece.size());
          return true;
        }))
      return false;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = text.find('\0', at);
      if (end == text.npos) return false;
      out.push_back(text.substr(at, end - at));
      at = end + 1;
    }
    return out.size() == array.tuples;
  }

 private:
  struct Blocks {
    std::vector<std::uint64_t> packed;    ///< bytes of each in the file
    std::uint64_t length = 0, bytes = 0;  ///< unpacked: of one but the last, of all
  };

  bool ends_well() {
    std::string tail(std::min<std::uint64_t>(size_, 64), '\0');
    stream_.seekg(static_cast<std::streamoff>(size_ - tail.size()));
    stream_.read(tail.data(), static_cast<std::streamsize>(tail.size()));
    return stream_ && tail.find("</VTKFile>") != tail.npos;
  }
  static bool number(const Tag& tag, std::string_view key, std::uint64_t& out) {
    const auto at = tag.attributes.find(key);
    if (at == tag.attributes.end()) return false;
    const std::string& text = at->second;
    const auto [stop, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
    return ec == std::errc{} && stop == text.data() + text.size();
  }
  static bool is_section(std::string_view name) {
    constexpr std::string_view known[] = {"FieldData", "PointData", "CellData", "Points", "Cells"};
    return std::find(std::begin(known), std::end(known), name) != std::end(known);
  }
  bool take(const std::vector<Tag>& tags) {
    bool appended = false;
    int pieces = 0;
    std::string section;
    for (const Tag& tag : tags) {
      const auto is = [&](const char* key, std::string_view value) {
        const auto at = tag.attributes.find(key);
        return at != tag.attributes.end() && at->second == value;
      };
      if (tag.name == "VTKFile") {
        if (!is("type", "UnstructuredGrid") || !is("byte_order", "LittleEndian") ||
            !is("compressor", "vtkZLibDataCompressor"))
          return false;
        if (!is("header_type", "UInt32") && !is("header_type", "UInt64")) return false;
        word_ = is("header_type", "UInt32") ? 4 : 8;
      } else if (tag.name == "Piece") {
        if (++pieces > 1 || !number(tag, "NumberOfPoints", points) ||
            !number(tag, "NumberOfCells", cells))
          return false;
      } else if (tag.name == "AppendedData") {
        appended = is("encoding", "raw");
      } else if (tag.name == "DataArray" || tag.name == "Array") {
        Array array;
        if (!is("format", "appended") || !number(tag, "offset", array.offset)) return false;
        const auto text = [&](const char* key) {
          const auto at = tag.attributes.find(key);
          return at == tag.attributes.end() ? std::string() : at->second;
        };
        array.name = text("Name");
        array.type = text("type");
        if (tag.attributes.contains("NumberOfComponents") &&
            !number(tag, "NumberOfComponents", array.components))
          return false;
        number(tag, "NumberOfTuples", array.tuples);
        arrays[section].push_back(std::move(array));
      } else if (is_section(tag.name)) {
        section = tag.name;
      }
    }
    // More of either does not fit the numbers of nodes.
    constexpr std::uint64_t most = std::numeric_limits<NodeId>::max() - 1;
    return word_ > 0 && appended && pieces == 1 && points <= most && cells <= most;
  }
  bool blocks_of(const Array& array, Blocks& out) {
    const std::uint64_t begin = data_ + array.offset;
    if (array.offset > size_ || begin > size_) return false;
    stream_.seekg(static_cast<std::streamoff>(begin));
    std::uint64_t left = size_ - begin;
    const auto word = [&] {
      std::uint64_t value = 0;
      stream_.read(reinterpret_cast<char*>(&value), word_);
      left -= std::min<std::uint64_t>(left, static_cast<std::uint64_t>(word_));
      return value;
    };
    const std::uint64_t count = word();
    out.length = word();
    const std::uint64_t last = word();
    if (!stream_ || count > left || count > kMostBlocks || out.length > kLargestBlock ||
        last > out.length)
      return false;
    std::uint64_t all = 0;
    for (std::uint64_t b = 0; b < count && stream_; ++b) {
      out.packed.push_back(word());
      if (out.packed.back() > left) return false;
      all += out.packed.back();
    }
    out.bytes = count * out.length - (last > 0 ? out.length - last : 0);
    return stream_ && all <= left && (count > 0 || last == 0) && out.bytes <= kMostPacked * all;
  }

  std::ifstream& stream_;
  std::uint64_t size_ = 0, data_ = 0;
  std::streamsize word_ = 0;  ///< bytes of a number in front of the blocks
};

/// Reads all that a mesh of ours has; false when there is something else.
class Reader {
 public:
  Reader(File& file, MeshContent& out, const Progress& progress)
      : file_(file), out_(out), progress_(progress) {}

  bool read() {
    return count_solids() && read_points() && read_cells() && step(0.5) && read_names() &&
           read_ids() && step(0.7) && read_node_fields() && read_cell_fields() && step(1);
  }

 private:
  bool step(double fraction) const {
    progress_.report(fraction);
    return !progress_.cancelled();
  }
  bool count_solids() {
    const Array* types = file_.find("Cells", "types");
    bool behind = false;
    return types && types->type == "UInt8" &&
           file_.each<std::uint8_t>(*types, file_.cells,
                                    [&](std::uint64_t, auto values) {
                                      for (const std::uint8_t type : values) {
                                        if (type != kTriangle && (type != kTetrahedron || behind))
                                          return false;
                                        behind = type == kTriangle;
                                        solids_ += behind ? 0 : 1;
                                      }
                                      return true;
                                    }) &&
           solids_ > 0;
  }
  bool read_points() {
    const Array* points = file_.find("Points", "Points");
    const auto& all = file_.arrays["Points"];
    if (!points && all.size() == 1) points = &all[0];
    if (!points || points->components != 3) return false;
    // A slot for the virtual node comes before.
    return numbers(*points, file_.points * 3, [&](std::uint64_t n) {
      out_.mesh.points.resize(n / 3 + 1);
      return out_.mesh.points.data()->data() + 3;
    });
  }
  /// Numbers of double precision, straight to where `place(count)` says.
  template <class Place>
  bool numbers(const Array& array, std::uint64_t count, const Place& place) {
    if (array.type != "Float64" || !file_.holds(array, count * sizeof(double))) return false;
    double* const to = place(count);
    return file_.each<double>(array, count, [&](std::uint64_t first, auto values) {
      std::copy(values.begin(), values.end(), to + first);
      return true;
    });
  }
  template <class Sink>
  bool integers(const Array* array, std::uint64_t count, const Sink& sink) {
    if (!array || array->components != 1) return false;
    if (array->type == "Int32") return file_.each<std::int32_t>(*array, count, sink);
    return array->type == "Int64" && file_.each<std::int64_t>(*array, count, sink);
  }
  bool read_cells() {
    const std::uint64_t facets = file_.cells - solids_;
    const bool regular = integers(
        file_.find("Cells", "offsets"), file_.cells, [&](std::uint64_t first, auto values) {
          for (std::size_t i = 0; i < values.size(); ++i) {
            const std::uint64_t c = first + i + 1;
            const std::uint64_t end = c <= solids_ ? 4 * c : 3 * c + solids_;
            if (static_cast<std::uint64_t>(values[i]) != end) return false;
          }
          return true;
        });
    const Array* ids = file_.find("Cells", "connectivity");
    const std::uint64_t count = 4 * solids_ + 3 * facets;
    if (!regular || !ids ||
        !file_.holds(*ids,
                     count * (ids->type == "Int64" ? sizeof(std::int64_t) : sizeof(std::int32_t))))
      return false;
    SimplexMesh<3>& mesh = out_.mesh;
    mesh.elements.resize(solids_);
    mesh.facets.resize(facets);
    return integers(ids, count, [&](std::uint64_t first, auto values) {
      for (std::size_t k = 0; k < values.size(); ++k) {
        if (values[k] < 0 || static_cast<std::uint64_t>(values[k]) >= file_.points) return false;
        const auto node = static_cast<NodeId>(values[k] + 1);
        std::uint64_t i = first + k;
        if (i < 4 * solids_) {
          mesh.elements[i / 4][i % 4] = node;
        } else {
          i -= 4 * solids_;
          mesh.facets[i / 3][i % 3] = node;
        }
      }
      return true;
    });
  }
  bool read_names() {
    const auto strings = [&](const char* name, std::vector<std::string>& out) {
      out.clear();
      const Array* array = file_.find("FieldData", name);
      return !array || file_.strings(*array, out);
    };
    std::vector<std::string> unit, provenance;
    if (!strings("body_names", out_.mesh.bodies) || !strings("group_names", out_.mesh.groups) ||
        !strings("unit", unit) || !strings("provenance", provenance))
      return false;
    if (!unit.empty() && unit[0] == "m") out_.unit = LengthUnit::m;
    if (!provenance.empty()) out_.provenance = provenance[0];
    return true;
  }
  /// Of the cells from `begin` on; there is none of the others. `names` bounds them.
  bool ids(const char* name, std::uint64_t begin, std::uint64_t end, std::int32_t most,
           std::vector<std::int32_t>& out) {
    out.assign(end - begin, 0);
    const Array* array = file_.find("CellData", name);
    if (!array) return true;
    return integers(array, file_.cells, [&](std::uint64_t first, auto values) {
      for (std::size_t k = 0; k < values.size(); ++k) {
        const std::uint64_t c = first + k;
        if (c < begin || c >= end) continue;
        if (values[k] >= most) return false;
        out[c - begin] = static_cast<std::int32_t>(std::max<std::int64_t>(0, values[k]));
      }
      return true;
    });
  }
  bool read_ids() {
    SimplexMesh<3>& mesh = out_.mesh;
    const auto named = [](const std::vector<std::int32_t>& of, std::vector<std::string>& names) {
      const std::int32_t most = of.empty() ? -1 : *std::max_element(of.begin(), of.end());
      while (static_cast<std::int64_t>(names.size()) <= most)
        names.push_back("number " + std::to_string(names.size()));
    };
    if (!ids("body", 0, solids_, kMostNames, mesh.element_body) ||
        !ids("group", solids_, file_.cells, kMostNames, mesh.facet_group) ||
        !ids("face", solids_, file_.cells, std::numeric_limits<std::int32_t>::max(),
             mesh.facet_face))
      return false;
    named(mesh.element_body, mesh.bodies);
    named(mesh.facet_group, mesh.groups);
    return true;
  }
  /// The first `taken` of `count` matrices, to `values` from `at` on.
  bool tensors(const Array& array, std::uint64_t count, std::uint64_t taken, std::size_t at,
               std::vector<Metric<3>>& values) {
    const std::uint64_t n = array.components;
    if (array.type != "Float64" || !file_.holds(array, count * n * sizeof(double))) return false;
    values.assign(at + taken, Metric<3>::Identity());
    const bool good = file_.each<double>(array, count * n, [&](std::uint64_t first, auto piece) {
      for (std::size_t k = 0; k < piece.size(); ++k) {
        const std::uint64_t tuple = (first + k) / n, c = (first + k) % n;
        if (tuple >= taken) break;
        Metric<3>& m = values[at + tuple];
        if (n == 9) {
          m(static_cast<int>(c / 3), static_cast<int>(c % 3)) = piece[k];
        } else {
          const auto [i, j] = kVtkTensor[c];
          m(i, j) = m(j, i) = piece[k];
        }
      }
      return true;
    });
    if (n == 9)
      for (std::size_t i = at; i < values.size(); ++i)
        values[i] = Metric<3>((values[i] + values[i].transpose()) / 2);
    return good;
  }
  bool read_node_fields() {
    for (const Array& array : file_.arrays["PointData"]) {
      if (array.name.empty()) continue;
      if (array.is_tensor()) {
        std::vector<Metric<3>> values;
        if (!tensors(array, file_.points, file_.points, 1, values)) return false;
        if (array.name == "metric")
          out_.metric = std::move(values);
        else
          out_.tensors.push_back({array.name, true, std::move(values)});
        continue;
      }
      if (array.components != 1 && array.components != 3) continue;
      std::vector<double> values;
      if (!numbers(array, file_.points * array.components, [&](std::uint64_t n) {
            values.resize(n + array.components);
            return values.data() + array.components;
          }))
        return false;
      if (array.name == "thickness" && array.components == 1)
        out_.thickness = std::move(values);
      else if (array.name == "layers" && array.components == 1)
        out_.layers = std::move(values);
      else
        out_.of_nodes.push_back(
            {array.name, static_cast<int>(array.components), std::move(values)});
    }
    return true;
  }
  bool read_cell_fields() {
    for (const Array& array : file_.arrays["CellData"]) {
      if (array.name == "body" || array.name == "group" || array.name == "face" ||
          array.name.empty())
        continue;
      if (array.is_tensor()) {
        TensorField field{array.name, false, {}};
        if (!tensors(array, file_.cells, solids_, 0, field.values)) return false;
        out_.tensors.push_back(std::move(field));
        continue;
      }
      if (array.components != 1 || (array.type != "Float64" && array.name != "quality")) continue;
      std::vector<double> values;
      if (!numbers(array, file_.cells, [&](std::uint64_t n) {
            values.resize(n);
            return values.data();
          }))
        return false;
      values.resize(solids_);
      if (array.name == "quality")
        out_.quality = std::move(values);
      else
        out_.of_elements.push_back({array.name, std::move(values)});
    }
    return true;
  }

  File& file_;
  MeshContent& out_;
  const Progress& progress_;
  std::uint64_t solids_ = 0;
};

}  // namespace

std::optional<MeshContent> read_appended_vtu(const std::filesystem::path& file,
                                             const Progress& progress) {
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file, ec)) return {};
  std::ifstream stream(file, std::ios::binary);
  File open(stream);
  MeshContent content;
  if (!stream || !open.open() || !Reader(open, content, progress).read()) return {};
  return content;
}

}  // namespace lamella
