#include "core/multidomain/chord_depth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/geometry/simplex.h"
#include "core/geometry/soup.h"

namespace lamella {
namespace {

/// What the angles tell may be so many times too much or too little.
constexpr double trust = 2;

}  // namespace

std::vector<double> chord_depths(const ReferenceSurface<3>& surface, double volume) {
  std::int32_t faces = 0;
  for (const std::int32_t f : surface.facet_face) faces = std::max(faces, f + 1);
  std::vector<double> lacks(static_cast<std::size_t>(faces), 0), area = lacks;
  using Edge = std::array<std::int32_t, 2>;
  const auto key = [](std::int32_t a, std::int32_t b) {
    return Edge{std::min(a, b), std::max(a, b)};
  };
  std::set<Edge> features;
  for (const auto& e : surface.feature_edges) features.insert(key(e[0], e[1]));
  std::map<Edge, std::vector<std::size_t>> edges;
  std::vector<Vec<3>> normals(surface.facets.size());
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const auto& v = surface.facets[f];
    normals[f] =
        facet_normal<3>({surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]});
    area[surface.facet_face[f]] += normals[f].norm() / 2;
    for (int k = 0; k < 3; ++k) edges[key(v[k], v[(k + 1) % 3])].push_back(f);
  }
  for (const auto& [e, around] : edges) {
    if (around.size() != 2 || features.count(e) > 0) continue;
    const Vec<3> along = surface.points[e[1]] - surface.points[e[0]];
    const double length = along.norm();
    const Vec<3>&a = normals[around[0]], &b = normals[around[1]];
    if (length == 0 || a.isZero() || b.isZero()) continue;
    double turn = std::atan2(a.cross(b).norm(), a.dot(b));
    // Hollow where the one looks over the other.
    const auto& v = surface.facets[around[1]];
    for (const std::int32_t n : v)
      if (n != e[0] && n != e[1] && a.dot(surface.points[n] - surface.points[e[0]]) > 0)
        turn = -turn;
    // Strips of width h on a cylinder lack length * turn * h^2 / 12 at each edge, on both sides of
    // it together; equilateral triangles on a sphere as much.
    for (const std::size_t f : around) {
      const double height = normals[f].norm() / length;
      lacks[surface.facet_face[f]] += length * turn * height * height / 24;
    }
  }
  double told = 0;
  for (const double l : lacks) told += l;
  const double missing = volume - enclosed_measure(surface);
  const double scale = told == 0 ? 0 : missing / told;
  std::vector<double> depths(lacks.size(), 0);
  if (scale < 1 / trust || scale > trust) return depths;
  for (std::size_t f = 0; f < depths.size(); ++f)
    if (area[f] > 0) depths[f] = scale * lacks[f] / area[f];
  return depths;
}

}  // namespace lamella
