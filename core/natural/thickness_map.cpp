#include "core/natural/thickness_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/base/parallel.h"
#include "core/natural/medial_ball.h"

namespace lamella {
namespace {

/// A surface of many walls is not divided beyond this.
constexpr std::size_t most_facets = 200000;
/// How far a point moves towards the middle of its triangles before it is judged: a border belongs
/// to two faces, and this tells which of them is asked.
constexpr double inward = 0.02;

/// The triangles of the surface, each face with points of its own.
ThicknessMap separate_faces(const ReferenceSurface<3>& surface) {
  std::vector<std::pair<std::int32_t, std::int32_t>> uses;  // face, vertex
  uses.reserve(3 * surface.facets.size());
  for (std::size_t f = 0; f < surface.facets.size(); ++f)
    for (const std::int32_t v : surface.facets[f]) uses.emplace_back(surface.facet_face[f], v);
  std::sort(uses.begin(), uses.end());
  uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
  ThicknessMap map;
  map.points.reserve(uses.size());
  for (const auto& use : uses)
    map.points.push_back(surface.points[static_cast<std::size_t>(use.second)]);
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    std::array<std::int32_t, 3> facet;
    for (std::size_t k = 0; k < 3; ++k)
      facet[k] = static_cast<std::int32_t>(
          std::lower_bound(uses.begin(), uses.end(),
                           std::pair(surface.facet_face[f], surface.facets[f][k])) -
          uses.begin());
    map.facets.push_back(facet);
    map.facet_of.push_back(static_cast<std::int32_t>(f));
  }
  return map;
}

/// Halves every side that is longer than `spacing`, seen alike from both its triangles. False when
/// there was none.
bool divide(ThicknessMap& map, double spacing) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middle;
  const auto half = [&](std::int32_t a, std::int32_t b) -> std::int32_t {
    const Vec<3>& p = map.points[static_cast<std::size_t>(a)];
    const Vec<3>& q = map.points[static_cast<std::size_t>(b)];
    if ((p - q).norm() <= spacing) return -1;
    const auto [it, fresh] = middle.try_emplace(std::minmax(a, b), 0);
    if (fresh) {
      it->second = static_cast<std::int32_t>(map.points.size());
      const Vec<3> m = 0.5 * (p + q);
      map.points.push_back(m);
    }
    return it->second;
  };
  ThicknessMap next;
  const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t of) {
    next.facets.push_back({a, b, c});
    next.facet_of.push_back(of);
  };
  for (std::size_t f = 0; f < map.facets.size(); ++f) {
    const std::array<std::int32_t, 3> corner = map.facets[f];
    const std::int32_t of = map.facet_of[f];
    std::array<std::int32_t, 3> mid;  // of the side that begins at the corner
    for (std::size_t k = 0; k < 3; ++k) mid[k] = half(corner[k], corner[(k + 1) % 3]);
    const auto halved =
        std::count_if(mid.begin(), mid.end(), [](std::int32_t m) { return m >= 0; });
    if (halved == 0) {
      add(corner[0], corner[1], corner[2], of);
    } else if (halved == 3) {
      add(mid[0], mid[1], mid[2], of);
      for (std::size_t k = 0; k < 3; ++k) add(corner[k], mid[k], mid[(k + 2) % 3], of);
    } else {
      // Turned so that the first side is halved, and with two of them the last one is not.
      std::size_t s = 0;
      while (mid[s] < 0 || (halved == 2 && mid[(s + 2) % 3] >= 0)) ++s;
      const std::int32_t a = corner[s], b = corner[(s + 1) % 3], c = corner[(s + 2) % 3];
      const std::int32_t ab = mid[s], bc = mid[(s + 1) % 3];
      if (halved == 1) {
        add(a, ab, c, of);
        add(ab, b, c, of);
      } else {
        add(ab, b, bc, of);
        add(a, ab, bc, of);
        add(a, bc, c, of);
      }
    }
  }
  map.facets = std::move(next.facets);
  map.facet_of = std::move(next.facet_of);
  return !middle.empty();
}

}  // namespace

Result<ThicknessMap> thickness_map(const ReferenceSurface<3>& surface, double spacing,
                                   const Progress& progress) {
  const Locator<3> locator(surface);
  if (locator.empty())
    return Error{Code::bad_input, "The body has no surface to measure its walls on.", ""};
  if (!(spacing > 0)) spacing = locator.diagonal() / 100;
  ThicknessMap map = separate_faces(surface);
  while (map.facets.size() < most_facets / 4 && divide(map, spacing))
    if (progress.cancelled()) return cancelled_error();

  std::vector<Vec<3>> middle(map.points.size(), Vec<3>::Zero());
  std::vector<double> count(map.points.size(), 0);
  for (const auto& facet : map.facets) {
    Vec<3> center = Vec<3>::Zero();
    for (const std::int32_t p : facet) center += map.points[static_cast<std::size_t>(p)] / 3;
    for (const std::int32_t p : facet) {
      middle[static_cast<std::size_t>(p)] += center;
      ++count[static_cast<std::size_t>(p)];
    }
  }
  map.thickness.assign(map.points.size(), 0);
  const bool complete = parallel_each(
      map.points.size(), 0, progress,
      [&](std::size_t i) {
        const Vec<3> x = map.points[i] + inward * (middle[i] / count[i] - map.points[i]);
        double radius = std::numeric_limits<double>::infinity();
        for (const MedialBall& ball : medial_balls(locator, x))
          radius = std::min(radius, ball.radius);
        map.thickness[i] = 2 * radius;
      },
      16);
  if (!complete) return cancelled_error();
  return map;
}

}  // namespace lamella
