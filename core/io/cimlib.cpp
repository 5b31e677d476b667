#include "core/io/cimlib.h"

#include "core/base/atomic_file.h"
#include "core/io/facet_sides.h"
#include "core/io/words.h"

namespace lamella {

namespace {

constexpr std::size_t kPollEvery = 1 << 14;

}  // namespace

Result<void> write_cimlib(const SimplexMesh<3>& mesh, const std::filesystem::path& file,
                          const Progress& progress) {
  const std::vector<FacetSide> sides = facet_sides(mesh);
  std::vector<SimplexMesh<3>::Facet> boundary;
  for (std::size_t f = 0; f < sides.size(); ++f)
    if (sides[f].element >= 0 && sides[f].other < 0)
      boundary.push_back(opposite_facet<3>(mesh.elements[sides[f].element], sides[f].local));
  TextBuilder out;
  out << mesh.node_count() << " 3 " << mesh.elements.size() + boundary.size() << " 4\n";
  for (std::size_t v = 1; v < mesh.points.size(); ++v)
    out << mesh.points[v][0] << ' ' << mesh.points[v][1] << ' ' << mesh.points[v][2] << '\n';
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.4);
  for (const auto& e : mesh.elements)
    out << e[0] << ' ' << e[1] << ' ' << e[2] << ' ' << e[3] << '\n';
  for (const auto& f : boundary) out << f[0] << ' ' << f[1] << ' ' << f[2] << " 0\n";
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.8);
  return write_file(file, out.text());
}

Result<MeshContent> read_cimlib(const std::filesystem::path& file, const Progress& progress) {
  const Result<std::string> text = read_file(file);
  if (!text) return text.error();
  Words words(*text);
  const auto refuse = [&](const std::string& finding) {
    return Error{
        Code::bad_input,
        "\"" + file.string() + "\", line " + std::to_string(words.line()) + ": " + finding + ".",
        "The file may be truncated or of another kind."};
  };
  std::int64_t nodes = 0, dimension = 0, elements = 0, corners = 0;
  if (!words.read(nodes) || !words.read(dimension) || !words.read(elements) || !words.read(corners))
    return refuse("it does not begin with nodes, dimension, elements and corners");
  if (dimension != 3 || corners != 4) return refuse("not a mesh of tetrahedra");
  const auto room = static_cast<std::int64_t>(words.size());
  if (nodes < 4 || elements < 1 || nodes > room || elements > room)
    return refuse("numbers of nodes and elements that cannot be");
  MeshContent content;
  SimplexMesh<3>& mesh = content.mesh;
  mesh.points.reserve(static_cast<std::size_t>(nodes) + 1);
  for (std::int64_t i = 0; i < nodes; ++i) {
    Vec<3> x;
    for (int k = 0; k < 3; ++k)
      if (!words.read(x[k]) || !std::isfinite(x[k])) return refuse("no coordinate");
    mesh.points.push_back(x);
  }
  for (std::int64_t i = 0; i < elements; ++i) {
    if (i % kPollEvery == 0) {
      progress.report(words.fraction());
      if (progress.cancelled()) return cancelled_error();
    }
    std::array<NodeId, 4> e{};
    for (int k = 0; k < 4; ++k) {
      std::int64_t v = 0;
      if (!words.read(v) || v < (k == 3 ? 0 : 1) || v > nodes)
        return refuse("no node of an element");
      e[k] = static_cast<NodeId>(v);
    }
    if (e[3] == 0)
      mesh.facets.push_back({e[0], e[1], e[2]});
    else
      mesh.elements.push_back(e);
  }
  if (mesh.elements.empty()) return refuse("no tetrahedra");
  mesh.element_body.assign(mesh.elements.size(), 0);
  mesh.facet_group.assign(mesh.facets.size(), 0);
  mesh.facet_face.assign(mesh.facets.size(), 0);
  list_boundary(mesh);
  return content;
}

}  // namespace lamella
