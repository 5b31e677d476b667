#include "core/flow/solver_field.h"

#include <algorithm>
#include <cmath>

#include "core/flow/indicators.h"
#include "core/geometry/bvh.h"

namespace lamella {

Result<SolverField> solver_field(MeshContent content, const std::string& name, double unit,
                                 const std::string& file) {
  std::string known;
  for (NodeField& field : content.of_nodes) {
    known += (known.empty() ? "" : ", ") + field.name;
    if (field.name != name) continue;
    const auto k = static_cast<std::size_t>(field.components);
    std::vector<char> used(content.mesh.points.size(), 0);
    for (const auto& e : content.mesh.elements)
      for (const NodeId n : e) used[n] = 1;
    std::size_t bad = 0, all = 0;
    for (std::size_t n = 1; n < used.size(); ++n) {
      if (!used[n]) continue;
      ++all;
      const auto at = field.values.begin() + static_cast<std::ptrdiff_t>(k * n);
      bad += !std::all_of(at, at + field.components, [](double v) { return std::isfinite(v); });
    }
    if (bad > 0)
      return Error{Code::bad_input,
                   "\"" + file + "\": the field \"" + name + "\" has no number at " +
                       std::to_string(bad) + " of " + std::to_string(all) + " nodes.",
                   "Cut these places out, or fill them, in the program that wrote the file."};
    for (Vec<3>& p : content.mesh.points) p *= unit;
    return SolverField{std::move(content.mesh), std::move(field)};
  }
  return Error{Code::usage, "\"" + file + "\" has no field \"" + name + "\".",
               known.empty() ? "It has none at all." : "It has: " + known + "."};
}

void elements_to_nodes(MeshContent& content) {
  for (ElementField& of : content.of_elements) {
    const auto known = [&](const NodeField& f) { return f.name == of.name; };
    if (std::any_of(content.of_nodes.begin(), content.of_nodes.end(), known)) continue;
    content.of_nodes.push_back(
        {std::move(of.name), 1, nodal_means<3, double>(content.mesh, of.values)});
  }
  content.of_elements.clear();
}

const FileUnit& likely_unit(double across, double size) {
  const auto misfit = [&](const FileUnit& unit) {
    return std::abs(std::log(across * unit.mm / size));
  };
  return *std::min_element(
      std::begin(kFileUnits), std::end(kFileUnits),
      [&](const FileUnit& a, const FileUnit& b) { return misfit(a) < misfit(b); });
}

double diagonal_of_nodes(const SimplexMesh<3>& mesh) {
  Box<3> box;
  for (const auto& e : mesh.elements)
    for (const NodeId n : e) box.add(mesh.points[n]);
  return mesh.elements.empty() ? 0 : (box.hi - box.lo).norm();
}

}  // namespace lamella
