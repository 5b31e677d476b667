#include "core/mesh/fitness.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/quality.h"

namespace lamella {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

double degrees_of(double cosine) { return kDegrees * std::acos(std::clamp(cosine, -1.0, 1.0)); }

/// Smallest and largest cosine of the angles between two faces; a flat element has -1 and 1.
std::array<double, 2> dihedral_cosines(const Corners<3>& p) {
  std::array<Vec<3>, 4> normal;
  for (int k = 0; k < 4; ++k) {
    const Vec<3>&a = p[(k + 1) % 4], &b = p[(k + 2) % 4], &c = p[(k + 3) % 4];
    normal[k] = (b - a).cross(c - a);
    if (normal[k].dot(p[k] - a) > 0) normal[k] = -normal[k];
    const double size = normal[k].norm();
    if (!(size > 0)) return {-1, 1};
    normal[k] /= size;
  }
  std::array<double, 2> range = {1, -1};
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      const double cosine = -normal[i].dot(normal[j]);
      range = {std::min(range[0], cosine), std::max(range[1], cosine)};
    }
  return range;
}

Vec<3> mean(const auto& points) {
  Vec<3> sum = Vec<3>::Zero();
  for (const Vec<3>& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Of a face whose middle is `off` from where a line meets it.
double skewness(const std::array<Vec<3>, 3>& face, const Vec<3>& off, double least_reach) {
  const double distance = off.norm();
  if (!(distance > 0)) return 0;
  const Vec<3> middle = mean(face);
  double reach = least_reach;
  for (const Vec<3>& p : face) reach = std::max(reach, std::abs(off.dot(p - middle)) / distance);
  return distance / reach;
}

/// Of a boundary face: the line is its normal through the element's center.
double boundary_skewness(const std::array<Vec<3>, 3>& face, const Corners<3>& element) {
  const Vec<3> normal = (face[1] - face[0]).cross(face[2] - face[0]).normalized();
  const Vec<3> to_middle = mean(face) - mean(element);
  const Vec<3> along = normal.dot(to_middle) * normal;
  return skewness(face, to_middle - along, 0.4 * along.norm());
}

struct FaceShape {
  double cosine = 1;  // of the angle between normal and centers' line
  double skewness = 0;
  double smoothness = 1;
};

FaceShape face_shape(const std::array<Vec<3>, 3>& face, const Corners<3>& owner,
                     const Corners<3>& neighbor) {
  FaceShape shape;
  const Vec<3> from = mean(owner), across = mean(neighbor) - from;
  const Vec<3> middle = mean(face);
  const Vec<3> normal = (face[1] - face[0]).cross(face[2] - face[0]);
  const double through = std::abs(across.dot(normal)), size = across.norm() * normal.norm();
  if (!(size > 0)) return shape;
  shape.cosine = through / size;
  const double volume = std::abs(signed_measure<3>(owner));
  const double other = std::abs(signed_measure<3>(neighbor));
  if (const double larger = std::max(volume, other); larger > 0)
    shape.smoothness = std::min(volume, other) / larger;
  if (!(through > 0)) return shape;
  shape.skewness = skewness(
      face, Vec<3>(middle - from - ((middle - from).dot(normal) / across.dot(normal)) * across),
      0.2 * across.norm());
  return shape;
}

/// Edges of the boundary faces with the number of facets around each.
void count_edges(const std::vector<std::array<NodeId, 3>>& boundary, Fitness& found) {
  std::vector<std::array<NodeId, 2>> edges;
  edges.reserve(3 * boundary.size());
  for (const auto& f : boundary)  // ascending
    for (const auto& e : {std::array{f[0], f[1]}, std::array{f[0], f[2]}, std::array{f[1], f[2]}})
      edges.push_back(e);
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j] == edges[i]) ++j;
    found.free_edges += (j - i) % 2;
    found.crossed_edges += j - i > 2;
    i = j;
  }
}

std::string text(const char* format, double value) {
  char line[64];
  std::snprintf(line, sizeof line, format, value);
  return line;
}

}  // namespace

Result<Fitness> fitness(const SimplexMesh<3>& mesh, const Progress& progress) {
  Fitness found;
  const std::size_t n = mesh.elements.size();
  found.elements = n;
  std::vector<double> aspect(n);
  std::vector<std::array<double, 2>> cosines(n);
  if (!parallel_each(
          n, 0, progress.portion(0, 0.3),
          [&](std::size_t e) {
            const Corners<3> p = mesh.corners(mesh.elements[e]);
            aspect[e] = aspect_ratio<3>(p);
            cosines[e] = dihedral_cosines(p);
          },
          1024))
    return cancelled_error();
  std::array<double, 2> range = n > 0 ? std::array<double, 2>{1, -1} : std::array<double, 2>{1, 1};
  for (std::size_t e = 0; e < n; ++e) {
    found.aspect_over_50 += aspect[e] > 50;
    range = {std::min(range[0], cosines[e][0]), std::max(range[1], cosines[e][1])};
  }
  found.dihedral_max = degrees_of(range[0]);
  found.dihedral_min = degrees_of(range[1]);
  found.aspect = stats_of(std::move(aspect));

  const std::vector<FaceUse<3>> uses = face_uses<3>(mesh.elements, mesh.points.size());
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.5);
  struct Inner {
    std::array<NodeId, 3> nodes;
    std::int32_t owner, neighbor;
  };
  std::vector<Inner> inner;
  inner.reserve(2 * n);
  std::vector<std::array<NodeId, 3>> boundary;
  DisjointSets together(n);
  bool stopped = false;
  for_each_face<3>(uses, [&](std::size_t first, std::size_t last) {
    if (first % 65536 == 0) stopped = stopped || progress.cancelled();
    if (stopped) return;
    if (last - first == 1) {
      boundary.push_back(uses[first].nodes);
      found.boundary_skewness =
          std::max(found.boundary_skewness,
                   boundary_skewness(mesh.corners(uses[first].nodes),
                                     mesh.corners(mesh.elements[uses[first].element])));
      return;
    }
    for (std::size_t k = first + 1; k < last; ++k)
      together.join(uses[first].element, uses[k].element);
    inner.push_back({uses[first].nodes, uses[first].element, uses[first + 1].element});
  });
  if (stopped) return cancelled_error();
  std::vector<FaceShape> shapes(inner.size());
  if (!parallel_each(
          inner.size(), 0, progress.portion(0.5, 0.9),
          [&](std::size_t f) {
            const auto& [nodes, owner, neighbor] = inner[f];
            shapes[f] = face_shape(mesh.corners(nodes), mesh.corners(mesh.elements[owner]),
                                   mesh.corners(mesh.elements[neighbor]));
          },
          1024))
    return cancelled_error();

  double least = 1, sum = 0;
  std::vector<double> skewness, smoothness;
  skewness.reserve(shapes.size());
  smoothness.reserve(shapes.size());
  for (const FaceShape& s : shapes) {
    least = std::min(least, s.cosine);
    sum += s.cosine;
    found.beyond_70 += s.cosine < std::cos(70 / kDegrees);
    skewness.push_back(s.skewness);
    smoothness.push_back(s.smoothness);
  }
  found.inner_faces = shapes.size();
  found.non_orthogonality = degrees_of(least);
  if (!shapes.empty())
    found.non_orthogonality_mean = degrees_of(sum / static_cast<double>(shapes.size()));
  found.skewness = stats_of(std::move(skewness));
  found.smoothness = stats_of(std::move(smoothness));
  for (std::size_t e = 0; e < n; ++e)
    found.regions += together.root(static_cast<std::int32_t>(e)) == static_cast<std::int32_t>(e);
  count_edges(boundary, found);
  progress.report(1);
  return found;
}

std::vector<FitnessLine> fitness_lines(const Fitness& f, std::size_t bodies,
                                       std::optional<double> layers) {
  std::vector<FitnessLine> lines;
  const auto count = [](std::size_t value) { return std::to_string(value); };
  lines.push_back({"Finite elements", "angles between faces",
                   text("%.1f", f.dihedral_min) + " to " + text("%.1f degrees", f.dihedral_max), "",
                   true, ""});
  lines.push_back({"Finite elements", "free edges of the boundary", count(f.free_edges), "none",
                   f.free_edges == 0, "The boundary is not closed: check the mesh."});

  const char* const kCorrect =
      "The solver needs non-orthogonal correctors and limited schemes; or cap the anisotropy "
      "(--max-anisotropy).";
  lines.push_back({"OpenFOAM", "non-orthogonality, largest",
                   text("%.1f degrees", f.non_orthogonality), "at most 70", f.beyond_70 == 0,
                   kCorrect});
  lines.push_back({"OpenFOAM", "non-orthogonality, mean",
                   text("%.1f degrees", f.non_orthogonality_mean), "", true, ""});
  lines.push_back({"OpenFOAM", "faces beyond 70 degrees",
                   count(f.beyond_70) + " of " + count(f.inner_faces), "", true, ""});
  lines.push_back({"OpenFOAM", "skewness, largest",
                   text("%.2f", std::max(f.skewness.max, f.boundary_skewness)), "at most 4",
                   std::max(f.skewness.max, f.boundary_skewness) <= 4,
                   "Cap the anisotropy (--max-anisotropy), or let the mesh iterate further."});

  lines.push_back(
      {"Moldflow", "aspect ratio, largest", text("%.1f", f.aspect.max), "at most 50",
       f.aspect_over_50 == 0,
       count(f.aspect_over_50) + " of " + count(f.elements) +
           " elements are beyond: ask fewer layers, or cap the anisotropy (--max-anisotropy)."});
  if (layers)
    lines.push_back({"Moldflow", "rows of elements across walls, 5 % quantile",
                     text("%.1f", *layers), "at least 3", *layers >= 3, "Ask n = 4 or more."});
  lines.push_back({"Moldflow", "connectivity regions", count(f.regions),
                   "at most " + count(std::max<std::size_t>(1, bodies)),
                   f.regions <= std::max<std::size_t>(1, bodies),
                   "Parts of the mesh hang together by less than a face, or not at all."});
  lines.push_back({"Moldflow", "edges of the boundary with more than two facets",
                   count(f.crossed_edges), "none", f.crossed_edges == 0,
                   "Walls of the part touch along an edge."});

  lines.push_back({"Moldex3D", "orthogonality, largest angle",
                   text("%.1f degrees", f.non_orthogonality), "", true, ""});
  lines.push_back({"Moldex3D", "skewness, mean and largest",
                   text("%.2f", f.skewness.mean) + ", " + text("%.2f", f.skewness.max), "", true,
                   ""});
  lines.push_back({"Moldex3D", "smoothness, 5 % quantile and mean",
                   text("%.2f", f.smoothness.p5) + ", " + text("%.2f", f.smoothness.mean), "", true,
                   ""});
  return lines;
}

}  // namespace lamella
