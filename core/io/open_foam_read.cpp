#include <algorithm>
#include <charconv>
#include <optional>

#include "core/base/atomic_file.h"
#include "core/io/open_foam.h"

namespace lamella {

namespace {

namespace fs = std::filesystem;

/// Words of an OpenFOAM file: brackets and semicolons are words of their own, comments are none.
class FoamWords {
 public:
  explicit FoamWords(std::string_view text) : text_(text) {}

  /// Empty at the end.
  std::string_view next() {
    skip();
    if (at_ >= text_.size()) return {};
    const std::size_t begin = at_;
    if (is_mark(text_[at_])) return text_.substr(at_++, 1);
    if (text_[at_] == '"') {
      at_ = std::min(text_.find('"', at_ + 1), text_.size() - 1) + 1;
      return text_.substr(begin, at_ - begin);
    }
    while (at_ < text_.size() && !is_mark(text_[at_]) && !is_blank(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  bool expect(std::string_view word) { return next() == word; }
  template <class T>
  bool read(T& value) {
    skip();
    const auto [end, ec] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (ec != std::errc{}) return false;
    at_ = static_cast<std::size_t>(end - text_.data());
    return true;
  }
  /// A list: its length and the bracket that opens it. More entries than characters cannot be.
  bool list(std::size_t& length) { return read(length) && length <= text_.size() && expect("("); }
  /// Up to and with the word; false when it is not there.
  bool pass(std::string_view word) {
    for (std::string_view w = next(); !w.empty(); w = next())
      if (w == word) return true;
    return false;
  }
  /// Behind the header. False when there is none, or the rest is binary.
  bool header() {
    if (!expect("FoamFile") || !expect("{")) return false;
    bool ascii = true;
    for (std::string_view w = next(); w != "}"; w = next()) {
      if (w.empty()) return false;
      if (w == "format") ascii = next() == "ascii";
    }
    return ascii;
  }

 private:
  static bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' '; }
  static bool is_mark(char c) {
    return std::string_view("(){};[]").find(c) != std::string_view::npos;
  }
  void skip() {
    while (at_ < text_.size()) {
      if (is_blank(text_[at_])) {
        ++at_;
      } else if (text_.compare(at_, 2, "//") == 0) {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (text_.compare(at_, 2, "/*") == 0) {
        at_ = std::min(text_.find("*/", at_ + 2), text_.size() - 2) + 2;
      } else {
        return;
      }
    }
  }
  std::string_view text_;
  std::size_t at_ = 0;
};

struct Patch {
  std::string name;
  std::size_t first = 0, count = 0;
};
struct Zone {
  std::string name;
  std::vector<std::int32_t> members;
  std::vector<std::int32_t> flipped;
};

bool read_list(FoamWords& words, std::vector<std::int32_t>& list) {
  std::size_t n = 0;
  if (!words.list(n)) return false;
  list.resize(n);
  for (std::int32_t& value : list)
    if (!words.read(value)) return false;
  return words.expect(")");
}

bool read_points(FoamWords& words, SimplexMesh<3>& mesh) {
  std::size_t n = 0;
  if (!words.list(n)) return false;
  mesh.points.reserve(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    Vec<3> x;
    if (!words.expect("(") || !words.read(x[0]) || !words.read(x[1]) || !words.read(x[2]) ||
        !words.expect(")"))
      return false;
    mesh.points.push_back(x);
  }
  return true;
}

/// Node ids from 1.
bool read_faces(FoamWords& words, std::size_t nodes, std::vector<std::array<NodeId, 3>>& faces) {
  std::size_t n = 0;
  if (!words.list(n)) return false;
  faces.resize(n);
  for (auto& face : faces) {
    std::size_t corners = 0;
    if (!words.list(corners) || corners != 3) return false;
    for (NodeId& v : face) {
      if (!words.read(v) || v < 0 || static_cast<std::size_t>(v) >= nodes) return false;
      ++v;
    }
    if (!words.expect(")")) return false;
  }
  return true;
}

bool read_patches(FoamWords& words, std::vector<Patch>& patches) {
  std::size_t n = 0;
  if (!words.list(n)) return false;
  for (std::size_t i = 0; i < n; ++i) {
    Patch patch{std::string(words.next()), 0, 0};
    if (!words.expect("{")) return false;
    for (std::string_view w = words.next(); w != "}"; w = words.next()) {
      if (w.empty()) return false;
      if (w == "nFaces" && !words.read(patch.count)) return false;
      if (w == "startFace" && !words.read(patch.first)) return false;
    }
    patches.push_back(std::move(patch));
  }
  return true;
}

bool read_zones(FoamWords& words, std::vector<Zone>& zones) {
  std::size_t n = 0;
  if (!words.list(n)) return false;
  for (std::size_t i = 0; i < n; ++i) {
    Zone zone{std::string(words.next()), {}, {}};
    if (!words.expect("{")) return false;
    for (std::string_view w = words.next(); w != "}"; w = words.next()) {
      if (w.empty()) return false;
      if (w == "cellLabels" || w == "faceLabels" || w == "flipMap") {
        words.next();  // List<label>
        if (!read_list(words, w == "flipMap" ? zone.flipped : zone.members)) return false;
      }
    }
    zones.push_back(std::move(zone));
  }
  return true;
}

/// The cells from their faces. False when one is no tetrahedron.
bool make_cells(const std::vector<std::array<NodeId, 3>>& faces,
                const std::vector<std::int32_t>& owner, const std::vector<std::int32_t>& neighbor,
                SimplexMesh<3>& mesh) {
  std::int32_t cells = 0;
  for (const auto* labels : {&owner, &neighbor})
    for (const std::int32_t cell : *labels) {
      if (cell < 0 || static_cast<std::size_t>(cell) > faces.size()) return false;
      cells = std::max(cells, cell + 1);
    }
  mesh.elements.assign(static_cast<std::size_t>(cells), {0, 0, 0, 0});
  std::vector<std::int8_t> count(mesh.elements.size(), 0);
  const auto add = [&](std::int32_t cell, const std::array<NodeId, 3>& outward) {
    auto& e = mesh.elements[cell];
    if (count[cell]++ == 0) {
      // {outward facet, apex} would be ill oriented.
      e = {outward[0], outward[2], outward[1], 0};
      return;
    }
    for (const NodeId v : outward)
      if (std::find(e.begin(), e.begin() + 3, v) == e.begin() + 3) {
        if (e[3] != 0 && e[3] != v) count[cell] = 100;
        e[3] = v;
      }
  };
  for (std::size_t f = 0; f < faces.size(); ++f) {
    add(owner[f], faces[f]);
    if (f < neighbor.size()) add(neighbor[f], {faces[f][0], faces[f][2], faces[f][1]});
  }
  return std::all_of(count.begin(), count.end(), [](std::int8_t n) { return n == 4; }) &&
         std::all_of(mesh.elements.begin(), mesh.elements.end(),
                     [](const auto& e) { return e[3] != 0; });
}

/// Values of `internalField`, uniform or not; `each` reads one.
template <class Each>
bool read_field(FoamWords& words, std::size_t expected, const Each& each) {
  if (!words.header() || !words.pass("internalField")) return false;
  if (words.next() != "nonuniform") return false;
  words.next();  // List<..>
  std::size_t n = 0;
  if (!words.list(n) || n != expected) return false;
  for (std::size_t i = 0; i < n; ++i)
    if (!each(i)) return false;
  return words.expect(")");
}

class Case {
 public:
  explicit Case(const fs::path& file) : root_(file.has_parent_path() ? file.parent_path() : ".") {}

  Result<MeshContent> read(const Progress& progress) {
    MeshContent content;
    content.unit = LengthUnit::m;
    SimplexMesh<3>& mesh = content.mesh;
    std::vector<std::array<NodeId, 3>> faces;
    std::vector<std::int32_t> owner, neighbor;
    std::vector<Patch> patches;
    std::vector<Zone> cells, zones;
    std::optional<Error> error;
    const auto part = [&](const char* name, bool needed, const auto& read) {
      if (!error && progress.cancelled()) error = cancelled_error();
      if (!error) error = this->part(name, needed, read);
    };
    part("points", true, [&](FoamWords& w) { return read_points(w, mesh); });
    part("faces", true, [&](FoamWords& w) { return read_faces(w, mesh.node_count(), faces); });
    progress.report(0.5);
    part("owner", true, [&](FoamWords& w) { return read_list(w, owner); });
    part("neighbour", true, [&](FoamWords& w) { return read_list(w, neighbor); });
    part("boundary", true, [&](FoamWords& w) { return read_patches(w, patches); });
    part("cellZones", false, [&](FoamWords& w) { return read_zones(w, cells); });
    part("faceZones", false, [&](FoamWords& w) { return read_zones(w, zones); });
    if (error) return *error;
    if (owner.size() != faces.size() || neighbor.size() > owner.size())
      return damaged("owner", "its length is not that of the faces");
    if (!make_cells(faces, owner, neighbor, mesh))
      return damaged("faces", "a cell is no tetrahedron");

    mesh.element_body.assign(mesh.elements.size(), -1);
    mesh.bodies.clear();
    mesh.groups.clear();
    for (const Zone& zone : cells) {
      const auto body = static_cast<std::int32_t>(mesh.bodies.size());
      mesh.bodies.push_back(zone.name);
      for (const std::int32_t cell : zone.members) {
        if (cell < 0 || static_cast<std::size_t>(cell) >= mesh.elements.size())
          return damaged("cellZones", "there is no such cell");
        mesh.element_body[cell] = body;
      }
    }
    if (std::find(mesh.element_body.begin(), mesh.element_body.end(), -1) !=
        mesh.element_body.end()) {
      std::replace(mesh.element_body.begin(), mesh.element_body.end(), -1,
                   static_cast<std::int32_t>(mesh.bodies.size()));
      mesh.bodies.push_back("body");
    }
    for (const Patch& patch : patches)
      for (std::size_t i = 0; i < patch.count; ++i)
        if (!add_facet(patch.name, faces, patch.first + i, false, mesh))
          return damaged("boundary", "there is no such face");
    for (const Zone& zone : zones)
      for (std::size_t i = 0; i < zone.members.size(); ++i)
        if (!add_facet(zone.name, faces, static_cast<std::size_t>(zone.members[i]),
                       i < zone.flipped.size() && zone.flipped[i] != 0, mesh))
          return damaged("faceZones", "there is no such face");
    if (mesh.groups.empty()) mesh.groups = {"walls"};
    progress.report(0.8);
    if (Result<void> done = fields(content); !done) return done.error();
    return content;
  }

 private:
  Error damaged(const std::string& name, const std::string& finding) const {
    return {Code::bad_input,
            "\"" + (root_ / "constant" / "polyMesh" / name).string() + "\": " + finding + ".",
            "Only cases of tetrahedra in ASCII can be used; convert with foamFormatConvert."};
  }
  template <class Read>
  std::optional<Error> part(const char* name, bool needed, const Read& read) const {
    const fs::path file = root_ / "constant" / "polyMesh" / name;
    std::error_code ec;
    if (!needed && !fs::exists(file, ec)) return {};
    const Result<std::string> text = read_file(file);
    if (!text) return text.error();
    FoamWords words(*text);
    if (!words.header()) return damaged(name, "not an OpenFOAM file in ASCII");
    if (!read(words)) return damaged(name, "the file is damaged, or a face is no triangle");
    return {};
  }
  static bool add_facet(const std::string& group, const std::vector<std::array<NodeId, 3>>& faces,
                        std::size_t face, bool flipped, SimplexMesh<3>& mesh) {
    if (face >= faces.size()) return false;
    const auto at = std::find(mesh.groups.begin(), mesh.groups.end(), group);
    const auto index = static_cast<std::int32_t>(at - mesh.groups.begin());
    if (at == mesh.groups.end()) mesh.groups.push_back(group);
    auto facet = faces[face];
    if (flipped) std::swap(facet[1], facet[2]);
    mesh.facets.push_back(facet);
    mesh.facet_group.push_back(index);
    mesh.facet_face.push_back(index);
    return true;
  }
  /// Those that Lamella writes; what a solver made of them since is no concern of a mesh.
  Result<void> fields(MeshContent& content) const {
    std::error_code ec;
    for (const std::string& body : content.mesh.bodies) {
      const fs::path file = root_ / "0" / ("alpha." + body);
      if (!fs::exists(file, ec)) continue;
      const Result<std::string> text = read_file(file);
      if (!text) return text.error();
      FoamWords words(*text);
      ElementField field{std::string(kFillingField) + body,
                         std::vector<double>(content.mesh.elements.size())};
      if (read_field(words, field.values.size(),
                     [&](std::size_t e) { return words.read(field.values[e]); }))
        content.of_elements.push_back(std::move(field));
    }
    if (const fs::path file = root_ / "0" / "metric"; fs::exists(file, ec)) {
      const Result<std::string> text = read_file(file);
      if (!text) return text.error();
      FoamWords words(*text);
      MetricField<3> metric(content.mesh.points.size(), Metric<3>::Identity());
      if (read_field(words, content.mesh.node_count(), [&](std::size_t v) {
            Metric<3>& m = metric[v + 1];
            double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
            if (!words.expect("(") || !words.read(xx) || !words.read(xy) || !words.read(xz) ||
                !words.read(yy) || !words.read(yz) || !words.read(zz) || !words.expect(")"))
              return false;
            m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
            return true;
          }))
        content.metric = std::move(metric);
    }
    return {};
  }

  fs::path root_;
};

}  // namespace

Result<MeshContent> read_open_foam(const fs::path& file, const Progress& progress) {
  return Case(file).read(progress);
}

}  // namespace lamella
