#include "core/multidomain/balance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/geometry/simplex.h"

namespace lamella {
namespace {

/// Cosine between the normals of facet and border above which it is smooth at a node.
constexpr double smooth_turn = 0.8;
constexpr int rounds = 3;
/// Of an element's volume: what a round must leave of it.
constexpr double least_left = 0.5;

/// Barycentric weights whose mean is exact for quadratic functions on a triangle.
constexpr std::array<std::array<double, 3>, 3> middles{
    {{0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}};

struct NodeShare {
  double area = 0;     ///< a third of the facets around, mm^2
  double missing = 0;  ///< what they lack, mm^3
  std::int32_t zone = -1;
  std::int32_t group = -1;
  bool moves = true;
};

}  // namespace

std::size_t balance_borders(SimplexMesh<3>& mesh, const Partition<3>& partition,
                            std::span<const std::int32_t> first_face, double most, int threads,
                            const Progress& progress) {
  const auto zone_of = [&](std::size_t f) {
    const auto it = std::upper_bound(first_face.begin(), first_face.end(), mesh.facet_face[f]);
    return static_cast<std::int32_t>(it - first_face.begin()) - 1;
  };
  std::vector<NodeShare> shares(mesh.points.size());
  std::vector<std::size_t> facets;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const std::int32_t zone = zone_of(f);
    if (zone >= 0) facets.push_back(f);
    for (NodeId n : mesh.facets[f]) {
      NodeShare& s = shares[n];
      if (s.zone < 0) s.zone = zone, s.group = mesh.facet_group[f];
      s.moves = s.moves && zone >= 0 && s.zone == zone && s.group == mesh.facet_group[f];
    }
  }
  std::vector<char> rough(facets.size());
  const auto find_rough = [&](std::size_t i) {
    const auto p = mesh.corners(mesh.facets[facets[i]]);
    const Vec<3> normal = facet_normal<3>(p).normalized();
    const Zone<3>& zone = partition.zone(zone_of(facets[i]));
    for (const Vec<3>& x : p)
      rough[i] |= std::abs(zone.at(x).normal.dot(normal)) < smooth_turn ? 1 : 0;
  };
  if (!parallel_each(facets.size(), threads, progress.portion(0, 0.25), find_rough)) return 0;
  for (std::size_t i = 0; i < facets.size(); ++i)
    if (rough[i])
      for (NodeId n : mesh.facets[facets[i]]) shares[n].moves = false;

  const std::vector<Vec<3>> before = mesh.points;
  std::vector<double> depth(facets.size());  // mean signed distance of a facet
  for (int round = 0; round < rounds; ++round) {
    const Progress own = progress.portion(0.25 * (round + 1), 0.25 * (round + 2));
    const auto distances = [&](std::size_t i) {
      const auto p = mesh.corners(mesh.facets[facets[i]]);
      const Zone<3>& zone = partition.zone(zone_of(facets[i]));
      depth[i] = 0;
      for (const auto& w : middles)
        depth[i] += zone.distance(w[0] * p[0] + w[1] * p[1] + w[2] * p[2]) / 3;
    };
    if (!parallel_each(facets.size(), threads, own, distances)) break;
    for (NodeShare& s : shares) s.area = s.missing = 0;
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const auto& nodes = mesh.facets[facets[i]];
      const double area = facet_normal<3>(mesh.corners(nodes)).norm() / 2;
      const auto moving =
          std::count_if(nodes.begin(), nodes.end(), [&](NodeId n) { return shares[n].moves; });
      for (NodeId n : nodes) {
        shares[n].area += area / 3;
        if (shares[n].moves) shares[n].missing -= depth[i] * area / static_cast<double>(moving);
      }
    }
    std::vector<double> volume(mesh.elements.size());
    for (std::size_t e = 0; e < volume.size(); ++e)
      volume[e] = signed_measure<3>(mesh.corners(mesh.elements[e]));
    const std::vector<Vec<3>> start = mesh.points;
    parallel_each(mesh.node_count(), threads, {}, [&](std::size_t i) {
      const NodeShare& s = shares[i + 1];
      if (!s.moves || s.zone < 0 || !(s.area > 0)) return;
      const Vec<3> normal = partition.zone(s.zone).at(before[i + 1]).normal;
      const Vec<3> to = start[i + 1] + s.missing / s.area * normal - before[i + 1];
      const double far = to.norm();
      mesh.points[i + 1] = before[i + 1] + to * (far > most ? most / far : 1);
    });
    // Nodes of an element that lost too much go back, which may cost others theirs.
    for (bool any = true; any;) {
      any = false;
      for (std::size_t e = 0; e < volume.size(); ++e) {
        if (signed_measure<3>(mesh.corners(mesh.elements[e])) >= least_left * volume[e]) continue;
        for (NodeId n : mesh.elements[e]) {
          any = any || mesh.points[n] != start[n];
          mesh.points[n] = start[n];
        }
      }
    }
  }
  std::size_t moved = 0;
  for (std::size_t n = 1; n < before.size(); ++n) moved += mesh.points[n] != before[n];
  return moved;
}

}  // namespace lamella
