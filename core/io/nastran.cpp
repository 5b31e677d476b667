#include "core/io/nastran.h"

#include <algorithm>
#include <map>

#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/io/facet_sides.h"
#include "core/io/lines.h"
#include "core/io/words.h"

namespace lamella {

namespace {

constexpr std::size_t kPollEvery = 1 << 14;

/// Left-justified in a field.
void field(TextBuilder& out, std::string_view text, std::size_t width) {
  out << text;
  for (std::size_t n = text.size(); n < width; ++n) out << ' ';
}

void number(TextBuilder& out, std::int64_t value) {
  char digits[24];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  field(out, std::string_view(digits, static_cast<std::size_t>(end - digits)), 8);
}

/// As many digits as sixteen columns hold, with the point that Nastran wants in a real number.
std::string real16(double value) {
  char digits[40];
  auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  for (int precision = 16;; --precision) {
    std::string text(digits, end);
    if (text.find('.') == text.npos) {
      const std::size_t e = text.find('e');
      text.insert(e == text.npos ? text.size() : e, ".");
    }
    if (text.size() <= 16) {
      std::replace(text.begin(), text.end(), 'e', 'E');
      return text;
    }
    end =
        std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, precision)
            .ptr;
  }
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, std::string_view text) : file_(file), lines_(text) {}

  Result<MeshContent> read(const Progress& progress) {
    std::string_view line;
    while (lines_.next(line)) {
      if (lines_.number() % kPollEvery == 0) {
        progress.report(lines_.fraction());
        if (progress.cancelled()) return cancelled_error();
      }
      if (line.empty()) continue;
      if (line[0] == '$') {
        name(line);
        continue;
      }
      if (trimmed(line) == "ENDDATA") break;
      if (!card(line))
        return Error{Code::bad_input,
                     "\"" + file_.string() + "\", line " + std::to_string(lines_.number()) +
                         ": a card that cannot be understood.",
                     "The file may be damaged, or use more of the format than is read."};
    }
    return assemble();
  }

 private:
  /// $HMNAME COMP, a number, and the name between quotes.
  void name(std::string_view line) {
    if (line.rfind("$HMNAME COMP", 0) != 0) return;
    const std::size_t open = line.find('"'), close = line.rfind('"');
    std::int64_t property = 0;
    if (open == line.npos || close <= open || !parse(line.substr(12, open - 12), property)) return;
    names_[property] = line.substr(open + 1, close - open - 1);
  }

  /// The fields of a card and of its continuations.
  bool card(std::string_view line) {
    const std::string_view first = line.substr(0, line.find_first_of(" ,\t*"));
    const bool grid = first == "GRID", solid = first == "CTETRA", shell = first == "CTRIA3";
    if (!grid && !solid && !shell) return true;
    fields_.clear();
    add_fields(line);
    std::string_view more;
    while (lines_.next(more)) {
      if (more.empty() || std::string_view(" +*,").find(more[0]) == std::string_view::npos) {
        lines_.back();
        break;
      }
      add_fields(more);
    }
    return grid ? node() : simplex(solid);
  }
  void add_fields(std::string_view line) {
    if (line.find(',') != line.npos) {
      const auto parts = between_commas(line);
      for (std::size_t i = 1; i < parts.size() && i < 9; ++i) fields_.push_back(parts[i]);
      return;
    }
    const bool wide = columns(line, 0, 8).find('*') != std::string_view::npos;
    const std::size_t width = wide ? 16 : 8;
    for (std::size_t i = 0; i < (wide ? 4u : 8u); ++i)
      fields_.push_back(columns(line, 8 + width * i, width));
  }
  bool node() {
    std::int64_t id = 0;
    Vec<3> x = Vec<3>::Zero();
    if (fields_.size() < 5 || !parse(fields_[0], id)) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (!fields_[2 + k].empty() && !parse(fields_[2 + k], x[static_cast<int>(k)])) return false;
    nodes_.add(id);
    mesh_.points.push_back(x);
    return true;
  }
  bool simplex(bool solid) {
    const std::size_t corners = solid ? 4 : 3;
    std::int64_t id = 0, property = 0;
    while (!fields_.empty() && fields_.back().empty()) fields_.pop_back();
    if (fields_.size() < 2 + corners || !parse(fields_[0], id)) return false;
    if (solid && fields_.size() > 6) return true;  // with nodes on its edges
    if (fields_[1].empty())
      property = id;
    else if (!parse(fields_[1], property))
      return false;
    std::array<NodeId, 4> v{};
    for (std::size_t k = 0; k < corners; ++k) {
      std::int64_t node = 0;
      if (!parse(fields_[2 + k], node)) return false;
      // Cards come in any order: nodes may follow.
      if (node < 1 || node > INT32_MAX) return false;
      v[k] = static_cast<NodeId>(node);
    }
    if (solid) {
      mesh_.elements.push_back(v);
      solids_.push_back(property);
    } else {
      mesh_.facets.push_back({v[0], v[1], v[2]});
      shells_.push_back(property);
    }
    return true;
  }

  void name_them(const std::vector<std::int64_t>& properties, const char* stem,
                 std::vector<std::int32_t>& owner, std::vector<std::string>& names) const {
    std::map<std::int64_t, std::int32_t> index;
    for (const std::int64_t property : properties) index[property];
    names.clear();
    for (auto& [property, i] : index) {
      i = static_cast<std::int32_t>(names.size());
      const auto at = names_.find(property);
      names.push_back(at == names_.end() ? stem + std::to_string(property) : at->second);
    }
    for (const std::int64_t property : properties) owner.push_back(index[property]);
  }

  Result<MeshContent> assemble() {
    const auto refuse = [&](const std::string& finding, const std::string& hint) {
      return Error{Code::bad_input, "\"" + file_.string() + "\" " + finding, hint};
    };
    if (mesh_.elements.empty())
      return refuse("holds no tetrahedra (CTETRA).",
                    "Only volume meshes of linear tetrahedra can be used.");
    bool good = true;
    const auto renumber = [&](auto& simplices) {
      for (auto& simplex : simplices)
        for (NodeId& v : simplex) good = (v = nodes_.of(v)) != 0 && good;
    };
    renumber(mesh_.elements);
    renumber(mesh_.facets);
    if (!good)
      return refuse("has an element of a node that is not there.",
                    "The file may be damaged or truncated.");
    name_them(solids_, "solid ", mesh_.element_body, mesh_.bodies);
    name_them(shells_, "shell ", mesh_.facet_group, mesh_.groups);
    mesh_.facet_face = mesh_.facet_group;
    list_boundary(mesh_);
    MeshContent content;
    content.mesh = std::move(mesh_);
    return content;
  }

  const std::filesystem::path& file_;
  Lines lines_;
  std::vector<std::string_view> fields_;
  FileNumbers nodes_;
  std::map<std::int64_t, std::string> names_;
  std::vector<std::int64_t> solids_, shells_;
  SimplexMesh<3> mesh_;
};

}  // namespace

Result<void> write_nastran(const SimplexMesh<3>& mesh, const MeshFields& fields,
                           const std::filesystem::path& file, const Progress& progress) {
  TextBuilder out;
  out << "$ Lamella " << version() << ", lengths in " << unit_name(fields.unit) << '\n'
      << "$ Material and shell thickness are only there to be replaced.\nBEGIN BULK\n"
      << "MAT1    1       1.              0.3\n";
  const auto property = [&](std::int64_t id, const std::string& name, bool solid) {
    const std::string digits = std::to_string(id);
    out << "$HMNAME COMP" << std::string(20 - std::min<std::size_t>(20, digits.size()), ' ')
        << digits << '"' << name << "\"\n";
    field(out, solid ? "PSOLID" : "PSHELL", 8);
    number(out, id);
    out << (solid ? "1\n" : "1       1.\n");
  };
  const auto bodies = static_cast<std::int64_t>(mesh.bodies.size());
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b)
    property(static_cast<std::int64_t>(b + 1), mesh.bodies[b], true);
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    property(bodies + static_cast<std::int64_t>(g + 1), mesh.groups[g], false);
  for (std::size_t v = 1; v < mesh.points.size(); ++v) {
    out << "GRID*   ";
    field(out, std::to_string(v), 32);
    field(out, real16(mesh.points[v][0]), 16);
    out << real16(mesh.points[v][1]) << "\n*       " << real16(mesh.points[v][2]) << '\n';
  }
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.4);
  std::int64_t id = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    out << "CTETRA  ";
    number(out, ++id);
    number(out, mesh.element_body[e] + 1);
    for (const NodeId v : mesh.elements[e]) number(out, v);
    out << '\n';
  }
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    out << "CTRIA3  ";
    number(out, ++id);
    number(out, bodies + mesh.facet_group[f] + 1);
    for (const NodeId v : mesh.facets[f]) number(out, v);
    out << '\n';
  }
  out << "ENDDATA\n";
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.8);
  return write_file(file, out.text());
}

Result<MeshContent> read_nastran(const std::filesystem::path& file, const Progress& progress) {
  const Result<std::string> text = read_file(file);
  if (!text) return text.error();
  return Reader(file, *text).read(progress);
}

}  // namespace lamella
