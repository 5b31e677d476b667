#include "core/io/abaqus.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/io/facet_sides.h"
#include "core/io/lines.h"
#include "core/io/words.h"

namespace lamella {

namespace {

constexpr std::size_t kPollEvery = 1 << 14;
constexpr std::int64_t kMostInSet = 1 << 28;
/// Face of a C3D4 opposite to a vertex: S1 is 1-2-3, S2 1-4-2, S3 2-4-3, S4 3-4-1.
constexpr std::array<int, 4> kFaceOfVertex = {3, 4, 2, 1};

/// Numbers, sixteen a line.
void write_list(TextBuilder& out, const std::vector<std::int32_t>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out << numbers[i] << (i % 16 == 15 || i + 1 == numbers.size() ? ",\n" : ", ");
}

std::string upper(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

/// A keyword line: its name in capitals, and its parameters by names in capitals.
struct Keyword {
  std::string name;
  std::map<std::string, std::string> parameters;

  explicit Keyword(std::string_view line) {
    for (const std::string_view part : between_commas(line)) {
      const std::size_t equals = part.find('=');
      if (name.empty())
        name = upper(trimmed(part));
      else if (equals == part.npos)
        parameters[upper(trimmed(part))];
      else
        parameters[upper(trimmed(part.substr(0, equals)))] = trimmed(part.substr(equals + 1));
    }
  }
  std::string value(const std::string& key) const {
    const auto at = parameters.find(key);
    return at == parameters.end() ? std::string() : at->second;
  }
};

class Reader {
 public:
  Reader(const std::filesystem::path& file, std::string_view text) : file_(file), lines_(text) {}

  Result<MeshContent> read(const Progress& progress) {
    std::string_view line;
    while (lines_.next(line)) {
      if (line.rfind("**", 0) == 0 || trimmed(line).empty()) continue;
      if (line[0] == '*') {
        keyword_ = Keyword(line);
        begin_keyword();
        continue;
      }
      if (lines_.number() % kPollEvery == 0) {
        progress.report(lines_.fraction());
        if (progress.cancelled()) return cancelled_error();
      }
      if (!data(line))
        return Error{
            Code::bad_input,
            "\"" + file_.string() + "\", line " + std::to_string(lines_.number()) + ": " +
                (finding_.empty() ? "not what *" + keyword_.name.substr(1) + " needs" : finding_) +
                ".",
            "The file may be damaged, or use more of the format than is read."};
    }
    return assemble();
  }

 private:
  struct Set {
    std::string name;
    std::vector<std::int64_t> elements;
  };
  struct Face {
    std::int64_t element;
    std::string set;  ///< instead of an element
    int local;
    std::int32_t group;
  };

  Set& set_called(const std::string& name) {
    for (Set& set : sets_)
      if (upper(set.name) == upper(name)) return set;
    sets_.push_back({name, {}});
    return sets_.back();
  }
  void begin_keyword() {
    tetrahedra_ = keyword_.name == "*ELEMENT" && upper(keyword_.value("TYPE")) == "C3D4";
    faces_ = keyword_.name == "*SURFACE" &&
             (keyword_.value("TYPE").empty() || upper(keyword_.value("TYPE")) == "ELEMENT");
    if (faces_) groups_.push_back(keyword_.value("NAME"));
  }
  bool data(std::string_view line) {
    if (keyword_.name == "*NODE") return node(line);
    if (tetrahedra_) return element(line);
    if (keyword_.name == "*ELSET") return element_set(line);
    if (faces_) return face(line);
    return true;
  }
  bool node(std::string_view line) {
    const auto parts = between_commas(line);
    std::int64_t number = 0;
    Vec<3> x = Vec<3>::Zero();
    if (parts.size() < 4 || !parse(parts[0], number)) return false;
    for (int k = 0; k < 3; ++k)
      if (!parts[k + 1].empty() && !parse(parts[k + 1], x[k])) return false;
    nodes_.add(number);
    mesh_.points.push_back(x);
    return true;
  }
  bool element(std::string_view line) {
    const auto parts = between_commas(line);
    std::int64_t number = 0;
    if (parts.size() < 5 || !parse(parts[0], number)) return false;
    SimplexMesh<3>::Element e;
    for (int k = 0; k < 4; ++k) {
      std::int64_t v = 0;
      if (!parse(parts[k + 1], v)) return false;
      e[k] = nodes_.of(v);
      if (e[k] == 0) return finding_ = "node " + std::to_string(v) + " is not there", false;
    }
    elements_.add(number);
    mesh_.elements.push_back(e);
    if (const std::string set = keyword_.value("ELSET"); !set.empty())
      set_called(set).elements.push_back(number);
    return true;
  }
  bool element_set(std::string_view line) {
    const auto parts = between_commas(line);
    std::vector<std::int64_t> members;
    std::int64_t first = 0, last = 0, step = 1;
    if (keyword_.parameters.count("GENERATE")) {
      if (parts.size() < 2 || !parse(parts[0], first) || !parse(parts[1], last)) return false;
      if (parts.size() > 2 && !parts[2].empty() && (!parse(parts[2], step) || step < 1))
        return false;
      if (last < first || last - first > kMostInSet) return false;
      for (; first <= last; first += step) members.push_back(first);
    } else {
      for (const std::string_view part : parts) {
        if (parse(part, first)) {
          members.push_back(first);
        } else if (!part.empty()) {
          const Set& other = set_called(std::string(part));
          members.insert(members.end(), other.elements.begin(), other.elements.end());
        }
      }
    }
    Set& set = set_called(keyword_.value("ELSET"));
    set.elements.insert(set.elements.end(), members.begin(), members.end());
    // Sets of each other, again and again, could grow without end.
    return static_cast<std::int64_t>(set.elements.size()) <= kMostInSet;
  }
  bool face(std::string_view line) {
    const auto parts = between_commas(line);
    if (parts.size() < 2) return false;
    const std::string side = upper(parts[1]);
    if (side.size() != 2 || side[0] != 'S' || side[1] < '1' || side[1] > '4') return false;
    const auto local = std::find(kFaceOfVertex.begin(), kFaceOfVertex.end(), side[1] - '0') -
                       kFaceOfVertex.begin();
    Face face{0, {}, static_cast<int>(local), static_cast<std::int32_t>(groups_.size()) - 1};
    if (!parse(parts[0], face.element)) face.set = parts[0];
    listed_.push_back(std::move(face));
    return true;
  }

  Result<MeshContent> assemble() {
    if (mesh_.elements.empty())
      return Error{Code::bad_input, "\"" + file_.string() + "\" holds no tetrahedra (C3D4).",
                   "Only volume meshes of linear tetrahedra can be used."};
    mesh_.element_body.assign(mesh_.elements.size(), -1);
    mesh_.bodies.clear();
    for (const Set& set : sets_) {
      const auto body = static_cast<std::int32_t>(mesh_.bodies.size());
      if (set.elements.size() >= mesh_.elements.size() && sets_.size() > 1) continue;
      bool used = false;
      for (const std::int64_t number : set.elements)
        if (const std::int32_t e = elements_.of(number); e > 0 && mesh_.element_body[e - 1] < 0) {
          mesh_.element_body[e - 1] = body;
          used = true;
        }
      if (used) mesh_.bodies.push_back(set.name);
    }
    bool without = false;
    for (std::int32_t& body : mesh_.element_body)
      if (body < 0) {
        body = static_cast<std::int32_t>(mesh_.bodies.size());
        without = true;
      }
    if (without) {
      // A set of all elements is a body when nothing tells them apart.
      const bool all = mesh_.bodies.empty() && !sets_.empty();
      mesh_.bodies.push_back(all ? sets_.back().name : "body");
    }
    mesh_.groups = groups_;
    const auto list = [&](std::int64_t number, const Face& face) {
      const std::int32_t e = elements_.of(number);
      if (e == 0) return;
      mesh_.facets.push_back(opposite_facet<3>(mesh_.elements[e - 1], face.local));
      mesh_.facet_group.push_back(face.group);
      mesh_.facet_face.push_back(face.group);
    };
    for (const Face& face : listed_) {
      if (face.set.empty()) {
        list(face.element, face);
      } else {
        for (const std::int64_t number : set_called(face.set).elements) list(number, face);
      }
    }
    list_boundary(mesh_);
    MeshContent content;
    content.mesh = std::move(mesh_);
    return content;
  }

  const std::filesystem::path& file_;
  Lines lines_;
  Keyword keyword_{""};
  bool tetrahedra_ = false, faces_ = false;
  std::string finding_;
  FileNumbers nodes_, elements_;
  std::vector<Set> sets_;
  std::vector<std::string> groups_;
  std::vector<Face> listed_;
  SimplexMesh<3> mesh_;
};

}  // namespace

Result<void> write_abaqus(const SimplexMesh<3>& mesh, const MeshFields& fields,
                          const std::filesystem::path& file, const Progress& progress) {
  TextBuilder out;
  out << "** Lamella " << version() << ", lengths in " << unit_name(fields.unit)
      << "\n*NODE, NSET=NALL\n";
  for (std::size_t v = 1; v < mesh.points.size(); ++v) {
    out << v;
    for (int k = 0; k < 3; ++k) out << ", " << mesh.points[v][k];
    out << '\n';
  }
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.3);
  out << "*ELEMENT, TYPE=C3D4, ELSET=EALL\n";
  std::vector<std::vector<std::int32_t>> of_body(mesh.bodies.size());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    out << e + 1;
    for (const NodeId v : mesh.elements[e]) out << ", " << v;
    out << '\n';
    of_body[mesh.element_body[e]].push_back(static_cast<std::int32_t>(e + 1));
  }
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.6);
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    if (of_body[b].empty()) continue;
    out << "*ELSET, ELSET=" << mesh.bodies[b] << '\n';
    write_list(out, of_body[b]);
  }
  const std::vector<FacetSide> sides = facet_sides(mesh);
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    std::vector<std::int32_t> nodes;
    bool begun = false;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      if (mesh.facet_group[f] != static_cast<std::int32_t>(g) || sides[f].element < 0) continue;
      if (!begun) out << "*SURFACE, NAME=" << mesh.groups[g] << ", TYPE=ELEMENT\n";
      begun = true;
      out << sides[f].element + 1 << ", S" << kFaceOfVertex[sides[f].local] << '\n';
      nodes.insert(nodes.end(), mesh.facets[f].begin(), mesh.facets[f].end());
    }
    if (!begun) continue;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    out << "*NSET, NSET=" << mesh.groups[g] << '\n';
    write_list(out, nodes);
  }
  progress.report(0.8);
  return write_file(file, out.text());
}

Result<MeshContent> read_abaqus(const std::filesystem::path& file, const Progress& progress) {
  const Result<std::string> text = read_file(file);
  if (!text) return text.error();
  return Reader(file, *text).read(progress);
}

}  // namespace lamella
