#include "core/io/medit.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "core/base/atomic_file.h"
#include "core/io/medit_binary.h"
#include "core/io/words.h"
#include "core/mesh/interfaces.h"

namespace lamella {
namespace {

constexpr std::size_t kPollEvery = 1 << 14;

/// A section of simplices: node ids as in the file, from 1, and a reference each.
template <int N>
struct Section {
  std::vector<std::array<NodeId, N>> nodes;
  std::vector<std::int32_t> refs;
};

/// What a .mesh file holds that we use.
struct Content {
  int dimension = 0;
  std::vector<std::array<double, 4>> points;  ///< as many coordinates as the dimension; else 0
  Section<2> edges;
  Section<3> triangles;
  Section<4> tetrahedra;
  Section<5> pentatopes;
};

/// Reads the sections one word after the other; the first failure ends the reading.
class Reader {
 public:
  Reader(const std::filesystem::path& file, std::string_view text, const Progress& progress)
      : file_(file), words_(text), progress_(progress) {}

  Words& words() { return words_; }

  Error error(const std::string& finding, const std::string& hint = {}) const {
    return {Code::bad_input,
            file_.string() + ", line " + std::to_string(words_.line()) + ": " + finding, hint};
  }
  Error expected(const std::string& what) const {
    if (words_.last().empty())
      return {Code::bad_input,
              file_.string() + " is truncated: it ends where " + what + " should be.",
              "Check that it was written or copied completely."};
    return error("'" + std::string(words_.last().substr(0, 40)) + "' where " + what +
                 " should be.");
  }
  bool cancelled(std::size_t i) const {
    if (i % kPollEvery != 0) return false;
    progress_.report(words_.fraction());
    return progress_.cancelled();
  }

  Result<std::size_t> count(const char* section) {
    std::int64_t n = 0;
    if (!words_.read(n)) return expected(std::string("the number of ") + section);
    // Each entry takes two characters at least: more cannot be in the file.
    if (n < 0 || static_cast<double>(n) > static_cast<double>(words_.size()))
      return error("there cannot be " + std::to_string(n) + " " + section + ".",
                   "The file is damaged or truncated.");
    return static_cast<std::size_t>(n);
  }

  /// Skips an unknown section: everything up to the next keyword.
  void skip() {
    for (;;) {
      const std::string_view word = words_.peek();
      if (word.empty() || (std::isalpha(static_cast<unsigned char>(word[0])) && !is_number(word)))
        return;
      words_.next();
    }
  }

  template <int N>
  std::optional<Error> simplices(const char* section, Section<N>& out) {
    const auto n = count(section);
    if (!n) return n.error();
    out.nodes.resize(*n);
    out.refs.resize(*n);
    for (std::size_t i = 0; i < *n; ++i) {
      if (cancelled(i)) return cancelled_error();
      for (NodeId& v : out.nodes[i]) {
        std::int64_t id = 0;
        if (!words_.read(id)) return expected(std::string("a node of ") + section);
        if (id < 1 || id > limit_)
          return error("node " + std::to_string(id) + " of " + section + " " +
                       std::to_string(i + 1) + " is out of range: the mesh has " +
                       std::to_string(limit_) + " vertices.");
        v = static_cast<NodeId>(id);
      }
      std::int64_t ref = 0;
      if (!words_.read(ref)) return expected(std::string("a reference of ") + section);
      out.refs[i] = static_cast<std::int32_t>(ref);
    }
    return {};
  }

  std::optional<Error> vertices(Content& out) {
    const auto n = count("vertices");
    if (!n) return n.error();
    out.points.assign(*n, {});
    limit_ = static_cast<std::int64_t>(*n);
    for (std::size_t i = 0; i < *n; ++i) {
      if (cancelled(i)) return cancelled_error();
      for (int k = 0; k < out.dimension; ++k)
        if (!words_.read(out.points[i][k]) || !std::isfinite(out.points[i][k]))
          return expected("a coordinate");
      double ref = 0;
      if (!words_.read(ref)) return expected("the reference of a vertex");
    }
    return {};
  }

 private:
  static bool is_number(std::string_view word) {
    double value;
    return Words(word).read(value);  // "nan" and "inf" begin with a letter
  }

  const std::filesystem::path& file_;
  Words words_;
  const Progress& progress_;
  std::int64_t limit_ = 0;  ///< number of vertices
};

/// The whole file as text; refuses an empty one.
Result<std::string> read_text(const std::filesystem::path& file) {
  auto text = read_file(file);
  if (!text) return text.error();
  if (std::string_view(*text).substr(0, 64).find('\0') != std::string_view::npos)
    return text_of_medit_binary(file, *text);
  if (Words(*text).next().empty())
    return Error{Code::bad_input, file.string() + " is empty.",
                 "Check that it was written or copied completely."};
  return text;
}

/// The first words both file types begin with. Leaves the reader after "Dimension d".
Result<int> read_header(Reader& reader, const std::filesystem::path& file) {
  Words& words = reader.words();
  std::int64_t version = 0, dimension = 0;
  if (words.next() != "MeshVersionFormatted" || !words.read(version))
    return Error{
        Code::bad_input,
        file.string() + " is not a Medit file: it does not begin with MeshVersionFormatted.",
        "Check the type of the file."};
  if (words.next() != "Dimension") return reader.expected("the keyword Dimension");
  if (!words.read(dimension)) return reader.expected("the dimension");
  if (dimension < 2 || dimension > 4)
    return reader.error("the dimension is " + std::to_string(dimension) + " instead of 2, 3 or 4.");
  return static_cast<int>(dimension);
}

Result<Content> read_content(const std::filesystem::path& file, const Progress& progress) {
  const auto text = read_text(file);
  if (!text) return text.error();
  Reader reader(file, *text, progress);
  const auto dimension = read_header(reader, file);
  if (!dimension) return dimension.error();
  Content content;
  content.dimension = *dimension;
  bool has_vertices = false;
  for (;;) {
    const std::string_view word = reader.words().next();
    std::optional<Error> error;
    if (word.empty() || word == "End") break;
    const bool uses_nodes =
        word == "Edges" || word == "Triangles" || word == "Tetrahedra" || word == "Pentatopes";
    if (uses_nodes && !has_vertices)
      return reader.error("the section " + std::string(word) + " comes before Vertices.");
    if (word == "Vertices") {
      error = reader.vertices(content);
      has_vertices = true;
    } else if (word == "Edges") {
      error = reader.simplices("Edges", content.edges);
    } else if (word == "Triangles") {
      error = reader.simplices("Triangles", content.triangles);
    } else if (word == "Tetrahedra") {
      error = reader.simplices("Tetrahedra", content.tetrahedra);
    } else if (word == "Pentatopes") {
      error = reader.simplices("Pentatopes", content.pentatopes);
    } else if (std::isalpha(static_cast<unsigned char>(word[0]))) {
      reader.skip();
    } else {
      return reader.expected("a keyword");
    }
    if (error) return *error;
  }
  if (!has_vertices)
    return Error{Code::bad_input, file.string() + " has no vertices.",
                 "Check that it was written completely."};
  return content;
}

/// Index of each reference among the sorted distinct ones, with their names "ref r".
std::vector<std::int32_t> name_refs(const std::vector<std::int32_t>& refs,
                                    std::vector<std::string>& names) {
  std::vector<std::int32_t> distinct = refs;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  names.clear();
  for (const std::int32_t r : distinct) names.push_back("ref " + std::to_string(r));
  std::vector<std::int32_t> index(refs.size());
  for (std::size_t i = 0; i < refs.size(); ++i)
    index[i] = static_cast<std::int32_t>(
        std::lower_bound(distinct.begin(), distinct.end(), refs[i]) - distinct.begin());
  return index;
}

template <int D>
SimplexMesh<D> assemble(const Content& content, Section<D + 1> elements, Section<D> facets) {
  SimplexMesh<D> mesh;
  mesh.points.reserve(content.points.size() + 1);
  for (const auto& x : content.points) mesh.points.push_back(Eigen::Map<const Vec<D>>(x.data()));
  mesh.elements = std::move(elements.nodes);
  mesh.element_body = name_refs(elements.refs, mesh.bodies);
  const bool listed = !facets.nodes.empty();
  mesh.facets = std::move(facets.nodes);
  mesh.facet_face = std::move(facets.refs);
  mesh.facet_group.assign(mesh.facets.size(), 0);
  rebuild_with_interfaces(mesh);  // what is not listed gets face, that is reference, 0
  if (listed) mesh.facet_group = name_refs(mesh.facet_face, mesh.groups);
  if (mesh.groups.empty()) mesh.groups = {"walls"};
  return mesh;
}

/// Elements with a node twice would make faces without meaning.
template <int N>
std::optional<Error> repeated_node(const std::filesystem::path& file, const Section<N>& section,
                                   const char* name) {
  for (std::size_t i = 0; i < section.nodes.size(); ++i) {
    auto s = section.nodes[i];
    std::sort(s.begin(), s.end());
    if (std::adjacent_find(s.begin(), s.end()) != s.end())
      return Error{Code::bad_input,
                   file.string() + ": entry " + std::to_string(i + 1) + " of " + name +
                       " has the same node twice.",
                   "Remove degenerate elements with the program that wrote the file."};
  }
  return {};
}

Error no_elements(const std::filesystem::path& file, const char* kind) {
  return {Code::bad_input, file.string() + " has no " + kind + ".",
          "Only simplices are read: convert hexahedra and quadrilaterals first."};
}

/// All nodes at the same z.
bool is_planar(const Content& content) {
  return std::all_of(content.points.begin(), content.points.end(),
                     [&](const auto& x) { return x[2] == content.points[0][2]; });
}

/// Names of the sections by dimension: elements, and the boundary one below.
constexpr std::array<const char*, 4> kSections = {"Edges", "Triangles", "Tetrahedra", "Pentatopes"};

/// References for the names: the numbers in "ref r" if all names are such and distinct, else the
/// positions from 1.
std::vector<std::int32_t> refs_of(const std::vector<std::string>& names) {
  std::vector<std::int32_t> refs;
  for (const std::string& name : names) {
    Words words(name);
    std::int64_t ref = 0;
    if (words.next() == "ref" && words.read(ref) && words.next().empty() &&
        std::find(refs.begin(), refs.end(), ref) == refs.end())
      refs.push_back(static_cast<std::int32_t>(ref));
  }
  if (refs.size() == names.size()) return refs;
  refs.resize(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) refs[i] = static_cast<std::int32_t>(i + 1);
  return refs;
}

template <std::size_t N>
bool write_section(TextBuilder& out, const char* name,
                   const std::vector<std::array<NodeId, N>>& nodes,
                   const std::vector<std::int32_t>& index, const std::vector<std::int32_t>& refs,
                   const Progress& progress) {
  out << '\n' << name << '\n' << nodes.size() << '\n';
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i % kPollEvery == 0 && progress.cancelled()) return false;
    for (const NodeId v : nodes[i]) out << v << ' ';
    out << refs[index[i]] << '\n';
  }
  return true;
}

}  // namespace

Result<AnyMesh> read_medit(const std::filesystem::path& file, const Progress& progress) {
  auto read = read_content(file, progress.portion(0, 0.8));
  if (!read) return read.error();
  Content content = std::move(*read);
  AnyMesh mesh;
  std::optional<Error> error;
  if (content.dimension == 4) {
    error = content.pentatopes.nodes.empty()
                ? no_elements(file, "pentatopes")
                : repeated_node(file, content.pentatopes, "Pentatopes");
    if (!error)
      mesh = assemble<4>(content, std::move(content.pentatopes), std::move(content.tetrahedra));
  } else if (content.dimension == 3 && !content.tetrahedra.nodes.empty()) {
    error = repeated_node(file, content.tetrahedra, "Tetrahedra");
    if (!error)
      mesh = assemble<3>(content, std::move(content.tetrahedra), std::move(content.triangles));
  } else if (content.triangles.nodes.empty()) {
    error = no_elements(file, content.dimension == 3 ? "tetrahedra" : "triangles");
  } else if (content.dimension == 3 && !is_planar(content)) {
    error =
        Error{Code::bad_input, file.string() + " is a surface: it has triangles, no tetrahedra.",
              "Fill it first: lamella-cli generate."};
  } else {
    error = repeated_node(file, content.triangles, "Triangles");
    if (!error) mesh = assemble<2>(content, std::move(content.triangles), std::move(content.edges));
  }
  if (error) return *error;
  progress.report(1);
  return mesh;
}

template <int D>
Result<SimplexMesh<D>> read_medit(const std::filesystem::path& file, const Progress& progress) {
  auto any = read_medit(file, progress);
  if (!any) return any.error();
  if (auto* mesh = std::get_if<SimplexMesh<D>>(&*any)) return std::move(*mesh);
  return Error{Code::bad_input, file.string() + " is not a " + std::to_string(D) + "D mesh.", ""};
}

template <int D>
Result<void> write_medit(const SimplexMesh<D>& mesh, const std::filesystem::path& file,
                         const Progress& progress) {
  if (is_medit_binary(file)) {
    if constexpr (D == 4)
      return Error{Code::usage, "\"" + file.string() + "\": .meshb knows no 4D mesh.",
                   "Use .mesh."};
    else if (progress.cancelled())
      return cancelled_error();
    else
      return write_file(file, medit_binary<D>(mesh, refs_of(mesh.bodies), refs_of(mesh.groups)));
  }
  TextBuilder out;
  out << "MeshVersionFormatted 2\n\nDimension " << D << "\n\nVertices\n"
      << mesh.node_count() << '\n';
  for (std::size_t i = 1; i < mesh.points.size(); ++i) {
    if (i % kPollEvery == 0) {
      if (progress.cancelled()) return cancelled_error();
      progress.report(0.4 * static_cast<double>(i) / static_cast<double>(mesh.points.size()));
    }
    for (int k = 0; k < D; ++k) out << mesh.points[i][k] << ' ';
    out << "0\n";
  }
  if (!write_section(out, kSections[D - 1], mesh.elements, mesh.element_body, refs_of(mesh.bodies),
                     progress) ||
      !write_section(out, kSections[D - 2], mesh.facets, mesh.facet_group, refs_of(mesh.groups),
                     progress))
    return cancelled_error();
  out << "\nEnd\n";
  progress.report(0.9);
  return write_file(file, out.text());
}

template <int D>
Result<MetricField<D>> read_sol(const std::filesystem::path& file, std::size_t nodes,
                                const Progress& progress) {
  const auto text = read_text(file);
  if (!text) return text.error();
  Reader reader(file, *text, progress);
  const auto dimension = read_header(reader, file);
  if (!dimension) return dimension.error();
  if (*dimension != D)
    return Error{Code::bad_input,
                 file.string() + " is for " + std::to_string(*dimension) + "D, the mesh is " +
                     std::to_string(D) + "D.",
                 "Give the .sol file that was written for this mesh."};
  Words& words = reader.words();
  for (;;) {
    const std::string_view word = words.next();
    if (word.empty() || word == "End")
      return Error{Code::bad_input, file.string() + " has no section SolAtVertices.",
                   "Only nodal fields are read."};
    if (word == "SolAtVertices") break;
    reader.skip();
  }
  const auto n = reader.count("nodal values");
  if (!n) return n.error();
  if (*n != nodes)
    return Error{Code::bad_input,
                 file.string() + " has " + std::to_string(*n) + " nodal values, the mesh has " +
                     std::to_string(nodes) + " nodes.",
                 "Give the .sol file that was written for this mesh."};
  std::int64_t fields = 0, type = 0;
  if (!words.read(fields)) return reader.expected("the number of fields");
  if (fields != 1) return reader.error(std::to_string(fields) + " fields where one is expected.");
  if (!words.read(type)) return reader.expected("the type of the field");
  if (type != 1 && type != 3)
    return reader.error("a field of type " + std::to_string(type) +
                        "; a size (1) or a metric (3) is expected.");
  MetricField<D> metric(nodes + 1, Metric<D>::Identity());
  for (std::size_t i = 1; i <= nodes; ++i) {
    if (reader.cancelled(i)) return cancelled_error();
    if (type == 1) {
      double h = 0;
      if (!words.read(h)) return reader.expected("a size");
      if (!(h > 0) || !std::isfinite(h))
        return reader.error("the size of node " + std::to_string(i) + " is not positive.");
      metric[i] = isotropic_metric<D>(h);
    } else {
      for (int row = 0; row < D; ++row)
        for (int col = 0; col <= row; ++col) {
          double value = 0;
          if (!words.read(value)) return reader.expected("an entry of a metric");
          metric[i](row, col) = metric[i](col, row) = value;
        }
      if (!is_spd<D>(metric[i]))
        return reader.error(
            "the matrix of node " + std::to_string(i) + " is not positive definite.",
            std::string("The order of entries is m11 m12 m22") + (D > 2 ? " m13 m23 m33" : "") +
                (D > 3 ? " m14 m24 m34 m44." : "."));
    }
  }
  progress.report(1);
  return metric;
}

template <int D>
Result<void> write_sol(const MetricField<D>& metric, const std::filesystem::path& file,
                       const Progress& progress) {
  TextBuilder out;
  out << "MeshVersionFormatted 2\n\nDimension " << D << "\n\nSolAtVertices\n"
      << (metric.empty() ? 0 : metric.size() - 1) << "\n1 3\n";
  for (std::size_t i = 1; i < metric.size(); ++i) {
    if (i % kPollEvery == 0) {
      if (progress.cancelled()) return cancelled_error();
      progress.report(0.9 * static_cast<double>(i) / static_cast<double>(metric.size()));
    }
    for (int row = 0; row < D; ++row)
      for (int col = 0; col <= row; ++col)
        out << metric[i](row, col) << (row == D - 1 && col == row ? '\n' : ' ');
  }
  out << "\nEnd\n";
  return write_file(file, out.text());
}

template Result<SimplexMesh<2>> read_medit<2>(const std::filesystem::path&, const Progress&);
template Result<SimplexMesh<3>> read_medit<3>(const std::filesystem::path&, const Progress&);
template Result<SimplexMesh<4>> read_medit<4>(const std::filesystem::path&, const Progress&);
template Result<void> write_medit<2>(const SimplexMesh<2>&, const std::filesystem::path&,
                                     const Progress&);
template Result<void> write_medit<3>(const SimplexMesh<3>&, const std::filesystem::path&,
                                     const Progress&);
template Result<void> write_medit<4>(const SimplexMesh<4>&, const std::filesystem::path&,
                                     const Progress&);
template Result<MetricField<2>> read_sol<2>(const std::filesystem::path&, std::size_t,
                                            const Progress&);
template Result<MetricField<3>> read_sol<3>(const std::filesystem::path&, std::size_t,
                                            const Progress&);
template Result<MetricField<4>> read_sol<4>(const std::filesystem::path&, std::size_t,
                                            const Progress&);
template Result<void> write_sol<2>(const MetricField<2>&, const std::filesystem::path&,
                                   const Progress&);
template Result<void> write_sol<3>(const MetricField<3>&, const std::filesystem::path&,
                                   const Progress&);
template Result<void> write_sol<4>(const MetricField<4>&, const std::filesystem::path&,
                                   const Progress&);

}  // namespace lamella
