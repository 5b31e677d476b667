#include "core/io/unv.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "core/base/atomic_file.h"
#include "core/io/facet_sides.h"
#include "core/io/lines.h"
#include "core/io/words.h"

namespace lamella {

namespace {

constexpr std::size_t kPollEvery = 1 << 14;
constexpr std::int64_t kTetrahedron = 111, kTriangle = 91, kPlaneTriangle = 41;

/// Right-justified.
void justified(TextBuilder& out, std::string_view digits, std::size_t width) {
  constexpr std::string_view kBlanks = "                         ";
  out << kBlanks.substr(0, width - std::min(width, digits.size())) << digits;
}

/// In ten columns.
void column(TextBuilder& out, std::int64_t value) {
  char digits[24];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  justified(out, {digits, static_cast<std::size_t>(end - digits)}, 10);
}

template <class... Values>
void record(TextBuilder& out, Values... values) {
  (column(out, values), ...);
  out << '\n';
}

/// In 25 columns, with seventeen digits, so that it reads back to the same value.
void real(TextBuilder& out, double value) {
  char digits[40];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::scientific, 16).ptr;
  if (char* e = std::find(digits, end, 'e'); e != end) *e = 'D';
  justified(out, {digits, static_cast<std::size_t>(end - digits)}, 25);
}

void begin(TextBuilder& out, int set) {
  out << "    -1\n";
  char number[16];
  std::snprintf(number, sizeof number, "%6d\n", set);
  out << number;
}

/// Elements of each body, then triangles of each group.
void write_groups(TextBuilder& out, int set, const SimplexMesh<3>& mesh) {
  begin(out, set);
  std::int64_t number = 0;
  const auto write = [&](const std::string& name, const std::vector<std::int64_t>& elements) {
    if (elements.empty()) return;
    record(out, ++number, 0, 0, 0, 0, 0, 0, static_cast<std::int64_t>(elements.size()));
    out << name << '\n';
    for (std::size_t i = 0; i < elements.size(); ++i) {
      for (const std::int64_t value :
           {std::int64_t{8}, elements[i], std::int64_t{0}, std::int64_t{0}})
        column(out, value);
      if (i % 2 == 1 || i + 1 == elements.size()) out << '\n';
    }
  };
  const auto lists = [](const std::vector<std::int32_t>& owner, std::size_t count,
                        std::size_t before) {
    std::vector<std::vector<std::int64_t>> all(count);
    for (std::size_t i = 0; i < owner.size(); ++i)
      all[owner[i]].push_back(static_cast<std::int64_t>(before + i + 1));
    return all;
  };
  const auto bodies = lists(mesh.element_body, mesh.bodies.size(), 0);
  for (std::size_t b = 0; b < bodies.size(); ++b) write(mesh.bodies[b], bodies[b]);
  const auto groups = lists(mesh.facet_group, mesh.groups.size(), mesh.elements.size());
  for (std::size_t g = 0; g < groups.size(); ++g) write(mesh.groups[g], groups[g]);
  out << "    -1\n";
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, std::string_view text) : file_(file), lines_(text) {}

  Result<MeshContent> read(const Progress& progress) {
    std::string_view line;
    while (lines_.next(line)) {
      if (trimmed(line) != "-1") continue;
      std::int64_t set = 0;
      if (!lines_.next(line)) break;
      if (!parse(line, set)) return damaged("the number of a data set");
      bool good = true;
      if (set == 164) good = units();
      if (set == 2411) good = nodes();
      if (set == 2412) good = elements(progress);
      if (set == 2452 || set == 2467 || set == 2477) good = groups();
      if (progress.cancelled()) return cancelled_error();
      if (!good) return damaged("what the data set " + std::to_string(set) + " needs");
      while (trimmed(line_) != "-1")
        if (!lines_.next(line_)) return damaged("the end of a data set");
      line_ = {};
    }
    return assemble();
  }

 private:
  struct Group {
    std::string name;
    std::vector<std::int64_t> elements;
  };

  Error damaged(const std::string& expected) const {
    return {Code::bad_input,
            "\"" + file_.string() + "\", line " + std::to_string(lines_.number()) + ": " +
                expected + " should be here.",
            "The file may be damaged or truncated."};
  }
  /// False at the end of the data set, whose last line is kept.
  bool line() { return lines_.next(line_) && trimmed(line_) != "-1"; }
  bool integers(std::vector<std::int64_t>& values) const {
    values.clear();
    for (std::size_t at = 0; at < line_.size(); at += 10) {
      const std::string_view field = columns(line_, at, 10);
      if (field.empty()) break;
      std::int64_t value = 0;
      if (!parse(field, value)) return false;
      values.push_back(value);
    }
    return true;
  }
  bool units() {
    double factor = 0;
    if (!line() || !line() || !parse(columns(line_, 0, 25), factor)) return false;
    if (std::abs(factor - 1) < 1e-6) unit_ = LengthUnit::m;
    return true;
  }
  bool nodes() {
    std::vector<std::int64_t> head;
    while (line()) {
      if (!integers(head) || head.empty() || !line()) return false;
      Vec<3> x;
      for (int k = 0; k < 3; ++k)
        if (!parse(columns(line_, 25 * static_cast<std::size_t>(k), 25), x[k])) return false;
      nodes_.add(head[0]);
      mesh_.points.push_back(x);
    }
    return true;
  }
  bool elements(const Progress& progress) {
    std::vector<std::int64_t> head, ids;
    while (line()) {
      if (lines_.number() % kPollEvery < 2) {
        progress.report(lines_.fraction());
        if (progress.cancelled()) return true;
      }
      if (!integers(head) || head.size() < 6) return false;
      // Beams have a record of their own between.
      if ((head[1] == 21 || head[1] == 22 || head[1] == 24) && !line()) return false;
      std::vector<std::int64_t> all;
      while (static_cast<std::int64_t>(all.size()) < head[5]) {
        if (!line() || !integers(ids) || ids.empty()) return false;
        all.insert(all.end(), ids.begin(), ids.end());
      }
      const bool solid = head[1] == kTetrahedron;
      if (!solid && head[1] != kTriangle && head[1] != kPlaneTriangle) continue;
      if (all.size() != (solid ? 4u : 3u)) return false;
      std::array<NodeId, 4> v{};
      for (std::size_t k = 0; k < all.size(); ++k)
        if (v[k] = nodes_.of(all[k]); v[k] == 0) return false;
      if (solid) {
        tetrahedra_.add(head[0]);
        mesh_.elements.push_back(v);
      } else {
        triangles_.add(head[0]);
        mesh_.facets.push_back({v[0], v[1], v[2]});
      }
    }
    return true;
  }
  bool groups() {
    std::vector<Group> found;
    std::vector<std::int64_t> values;
    while (line()) {
      if (!integers(values) || values.size() < 8 || !line()) return false;
      Group group{std::string(trimmed(line_)), {}};
      const std::int64_t count = values[7];
      for (std::int64_t i = 0; i < count;) {
        if (!line() || !integers(values) || values.empty() || values.size() % 4 != 0) return false;
        for (std::size_t k = 0; k < values.size(); k += 4, ++i)
          if (values[k] == 8) group.elements.push_back(values[k + 1]);
      }
      found.push_back(std::move(group));
    }
    if (groups_.empty()) groups_ = std::move(found);
    return true;
  }

  Result<MeshContent> assemble() {
    if (mesh_.elements.empty())
      return Error{Code::bad_input, "\"" + file_.string() + "\" holds no tetrahedra (type 111).",
                   "Only volume meshes of linear tetrahedra can be used."};
    mesh_.bodies.clear();
    mesh_.groups.clear();
    mesh_.element_body.assign(mesh_.elements.size(), -1);
    mesh_.facet_group.assign(mesh_.facets.size(), -1);
    for (const Group& group : groups_) {
      const auto take = [&](const FileNumbers& numbers, std::vector<std::int32_t>& owner,
                            std::vector<std::string>& names) {
        bool used = false;
        for (const std::int64_t number : group.elements)
          if (const std::int32_t i = numbers.of(number); i > 0 && owner[i - 1] < 0) {
            owner[i - 1] = static_cast<std::int32_t>(names.size());
            used = true;
          }
        if (used) names.push_back(group.name);
      };
      take(tetrahedra_, mesh_.element_body, mesh_.bodies);
      take(triangles_, mesh_.facet_group, mesh_.groups);
    }
    const auto rest = [](std::vector<std::int32_t>& owner, std::vector<std::string>& names,
                         const char* name) {
      if (std::find(owner.begin(), owner.end(), -1) == owner.end()) return;
      std::replace(owner.begin(), owner.end(), -1, static_cast<std::int32_t>(names.size()));
      names.push_back(name);
    };
    rest(mesh_.element_body, mesh_.bodies, "body");
    rest(mesh_.facet_group, mesh_.groups, "walls");
    mesh_.facet_face = mesh_.facet_group;
    list_boundary(mesh_);
    MeshContent content;
    content.mesh = std::move(mesh_);
    content.unit = unit_;
    return content;
  }

  const std::filesystem::path& file_;
  Lines lines_;
  std::string_view line_;
  LengthUnit unit_ = LengthUnit::mm;
  FileNumbers nodes_, tetrahedra_, triangles_;
  std::vector<Group> groups_;
  SimplexMesh<3> mesh_;
};

}  // namespace

Result<void> write_unv(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const Progress& progress) {
  TextBuilder out;
  begin(out, 164);
  const bool meters = fields.unit == LengthUnit::m;
  char line[80];
  std::snprintf(line, sizeof line, "%10d%-20s%10d\n", meters ? 1 : 10,
                meters ? "SI: Meter (newton)" : "mm (newton)", 2);
  out << line;
  // What divides values of the file to make them SI: length, force, temperature and its offset.
  real(out, meters ? 1 : 1000);
  real(out, 1);
  real(out, 1);
  out << '\n';
  real(out, 273.15);
  out << "\n    -1\n";

  begin(out, 2411);
  for (std::size_t v = 1; v < mesh.points.size(); ++v) {
    record(out, static_cast<std::int64_t>(v), 1, 1, 11);
    for (int k = 0; k < 3; ++k) real(out, mesh.points[v][k]);
    out << '\n';
  }
  out << "    -1\n";
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.3);

  begin(out, 2412);
  std::int64_t number = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const std::int64_t body = mesh.element_body[e] + 1;
    record(out, ++number, kTetrahedron, body, body, 7, 4);
    const auto& v = mesh.elements[e];
    record(out, v[0], v[1], v[2], v[3]);
  }
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto property = static_cast<std::int64_t>(mesh.bodies.size()) + mesh.facet_group[f] + 1;
    record(out, ++number, kTriangle, property, 1, 7, 3);
    const auto& v = mesh.facets[f];
    record(out, v[0], v[1], v[2]);
  }
  out << "    -1\n";
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.7);
  write_groups(out, 2467, mesh);
  write_groups(out, 2477, mesh);
  return write_file(file, out.text());
}

Result<MeshContent> read_unv(const std::filesystem::path& file, const Progress& progress) {
  const Result<std::string> text = read_file(file);
  if (!text) return text.error();
  return Reader(file, *text).read(progress);
}

}  // namespace lamella
