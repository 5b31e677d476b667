#include "core/flow/field_transfer.h"

#include <cstdio>

#include "core/base/parallel.h"
#include "core/flow/solver_field.h"
#include "core/geometry/simplex.h"
#include "core/geometry/triangles.h"
#include "core/mesh/element_locator.h"

namespace lamella {
namespace {

/// Farther from the mesh of the field, in diagonals of the box, a node is elsewhere.
constexpr double kElsewhere = 0.05;
/// Diagonals of the two boxes that differ more are in other units: a centimeter is 10 mm.
constexpr double kOtherUnit = 8;

/// What the extents of the field's mesh and of what it is to cover say of its unit.
Result<void> check_extent(double field, double across) {
  if (field <= kOtherUnit * across && across <= kOtherUnit * field) return {};
  char text[200];
  std::snprintf(text, sizeof text,
                "The mesh of the field, %.4g mm across, does not lie on this one, %.4g mm across.",
                field, across);
  std::string hint = "It may be in another unit, or of another part.";
  for (const double factor : {10.0, 25.4, 1000.0})
    for (const double times : {factor, 1 / factor}) {
      if (std::abs(std::log(field * times / across)) > std::log(1.3)) continue;
      char more[80];
      std::snprintf(more, sizeof more, " Lengths %.4g times as long would fit.", times);
      hint += more;
    }
  return Error{Code::bad_input, text, hint};
}

Result<void> check_share(double away, double farthest) {
  if (away <= 0.5) return {};
  char text[200];
  std::snprintf(text, sizeof text,
                "The mesh of the field does not lie on this one: %.0f %% are away from it, up to "
                "%.4g mm.",
                100 * away, farthest);
  return Error{Code::bad_input, text, "It may be shifted, in another unit, or of another part."};
}

}  // namespace

Result<TransferredField> transfer_field(const SimplexMesh<3>& from,
                                        const std::vector<double>& values, int components,
                                        const SimplexMesh<3>& to, int threads,
                                        const Progress& progress, std::optional<double> across) {
  const auto k = static_cast<std::size_t>(components);
  if (from.elements.empty() || to.elements.empty())
    return Error{Code::bad_input, "A mesh has no elements.", ""};
  if (values.size() != k * from.points.size())
    return Error{Code::bad_input, "The field is not one of the nodes of its mesh.", ""};
  const double size = diagonal_of_nodes(to);
  if (Result<void> fits = check_extent(diagonal_of_nodes(from), across.value_or(size)); !fits)
    return fits.error();
  const ElementLocator<3> locator(from, progress.portion(0, 0.5));
  if (progress.cancelled()) return cancelled_error();
  TransferredField out;
  out.values.assign(k * to.points.size(), 0);
  std::vector<double> distance(to.node_count(), 0);
  if (!parallel_each(to.node_count(), threads, progress.portion(0.5, 1), [&](std::size_t i) {
        const std::size_t n = i + 1;
        const Located<3> place = locator.locate(to.points[n]);
        const auto& e = from.elements[static_cast<std::size_t>(place.element)];
        for (std::size_t v = 0; v < 4; ++v)
          for (std::size_t c = 0; c < k; ++c)
            out.values[k * n + c] += place.weights[v] * values[k * e[v] + c];
        distance[i] = std::sqrt(place.distance2);
      }))
    return cancelled_error();
  std::size_t away = 0;
  for (const double d : distance) {
    out.farthest = std::max(out.farthest, d);
    // What the chords of two meshes of one curved boundary differ by is not outside.
    out.outside += d > 1e-3 * size;
    away += d > kElsewhere * size;
  }
  const double share = static_cast<double>(away) / static_cast<double>(to.node_count());
  if (Result<void> there = check_share(share, out.farthest); !there) return there.error();
  return out;
}

Result<void> check_place(const SimplexMesh<3>& from, const ReferenceSurface<3>& surface,
                         double across, int threads, const Progress& progress) {
  if (from.elements.empty()) return Error{Code::bad_input, "A mesh has no elements.", ""};
  if (Result<void> fits = check_extent(diagonal_of_nodes(from), across); !fits) return fits;
  const ElementLocator<3> locator(from, progress.portion(0, 0.5));
  if (progress.cancelled()) return cancelled_error();
  const double size = diagonal_of(surface.points);
  // Points spread over the area: large facets have many.
  constexpr double kPoints = 2000;
  std::vector<Vec<3>> points;
  std::vector<double> area;
  double all = 0;
  const auto corners = [&](std::size_t f) {
    std::array<Vec<3>, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = surface.points[static_cast<std::size_t>(surface.facets[f][k])];
    return p;
  };
  for (std::size_t f = 0; f < surface.facets.size(); ++f) all += facet_normal<3>(corners(f)).norm();
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const std::array<Vec<3>, 3> p = corners(f);
    const double own = facet_normal<3>(p).norm();
    const int parts =
        std::max(1, static_cast<int>(std::sqrt(kPoints * own / std::max(all, 1e-300))));
    for (int i = 0; i < parts; ++i)
      for (int j = 0; i + j < parts; ++j) {
        points.push_back(p[0] + (i + 1.0 / 3) / parts * (p[1] - p[0]) +
                         (j + 1.0 / 3) / parts * (p[2] - p[0]));
        area.push_back(2 * own / (parts * (parts + 1)));
      }
  }
  std::vector<double> distance(points.size(), 0);
  if (!parallel_each(points.size(), threads, progress.portion(0.5, 1), [&](std::size_t i) {
        distance[i] = std::sqrt(locator.locate(points[i]).distance2);
      }))
    return cancelled_error();
  double away = 0, farthest = 0;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (distance[i] > kElsewhere * size) away += area[i];
    farthest = std::max(farthest, distance[i]);
  }
  return check_share(all > 0 ? away / all : 0, farthest);
}

}  // namespace lamella
