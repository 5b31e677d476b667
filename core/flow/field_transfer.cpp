#include "core/flow/field_transfer.h"

#include <cstdio>

#include "core/base/parallel.h"
#include "core/geometry/bvh.h"
#include "core/mesh/element_locator.h"

namespace lamella {
namespace {

/// Farther from the mesh of the field, in diagonals of the box, a node is elsewhere.
constexpr double kElsewhere = 0.05;
/// Diagonals of the two boxes that differ more are in other units: a centimeter is 10 mm.
constexpr double kOtherUnit = 8;

double diagonal_of_nodes(const SimplexMesh<3>& mesh) {
  Box<3> box;
  for (const auto& e : mesh.elements)
    for (const NodeId n : e) box.add(mesh.points[n]);
  return (box.hi - box.lo).norm();
}

}  // namespace

Result<TransferredField> transfer_field(const SimplexMesh<3>& from,
                                        const std::vector<double>& values, int components,
                                        const SimplexMesh<3>& to, int threads,
                                        const Progress& progress) {
  const auto k = static_cast<std::size_t>(components);
  if (from.elements.empty() || to.elements.empty())
    return Error{Code::bad_input, "A mesh has no elements.", ""};
  if (values.size() != k * from.points.size())
    return Error{Code::bad_input, "The field is not one of the nodes of its mesh.", ""};
  const ElementLocator<3> locator(from, progress.portion(0, 0.5));
  if (progress.cancelled()) return cancelled_error();
  TransferredField out;
  out.values.assign(k * to.points.size(), 0);
  std::vector<double> distance(to.points.size(), 0);
  if (!parallel_each(to.node_count(), threads, progress.portion(0.5, 1), [&](std::size_t i) {
        const std::size_t n = i + 1;
        const Located<3> place = locator.locate(to.points[n]);
        const auto& e = from.elements[static_cast<std::size_t>(place.element)];
        for (std::size_t v = 0; v < 4; ++v)
          for (std::size_t c = 0; c < k; ++c)
            out.values[k * n + c] += place.weights[v] * values[k * e[v] + c];
        distance[n] = std::sqrt(place.distance2);
      }))
    return cancelled_error();
  const double size = diagonal_of_nodes(to), other = diagonal_of_nodes(from);
  std::size_t elsewhere = 0;
  for (const double d : distance) {
    out.farthest = std::max(out.farthest, d);
    // What the chords of two meshes of one curved boundary differ by is not outside.
    out.outside += d > 1e-3 * size;
    elsewhere += d > kElsewhere * size;
  }
  if (2 * elsewhere > to.node_count() || other > kOtherUnit * size || size > kOtherUnit * other) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "The mesh of the field, %.4g across, does not lie on this one, %.4g mm across.",
                  other, size);
    return Error{Code::bad_input, text, "It may be in another unit, or of another part."};
  }
  return out;
}

}  // namespace lamella
