#include "core/multidomain/border_fit.h"

#include <algorithm>
#include <optional>

#include "core/base/parallel.h"

namespace lamella {
namespace {

/// Of the tolerance: how far the middle of an interface's edge may lie from the border; facets add
/// to it.
constexpr double bend_share = 0.6;
/// The same of the points of an interface's facet.
constexpr double face_share = 0.7;
/// Rounds of halving edges that are too far.
constexpr int bend_rounds = 4;
/// Of the tolerance: how near to a node on the border there is no need for another.
constexpr double beside_share = 0.5;
/// Cosine between normals at the nodes of a smooth border, and at nodes next to each other.
constexpr double bow_turn = 0.3;
constexpr double smooth_turn = 0.8;

using Element = CutTopology::Element;

}  // namespace

bool BorderFit::crowded(std::span<const NodeId> of, const Vec<3>& x) const {
  const double near = beside_share * params_.tolerance;
  const Zone<3>& zone = partition_.zone(zone_);
  std::optional<Vec<3>> normal;
  bool found = false;
  for (auto e : mesh_.topo.around.of(of[0])) {
    const Element& nodes = mesh_.topo.elements[e];
    if (mesh_.topo.is_virtual(e) ||
        !std::all_of(of.begin(), of.end(), [&](NodeId n) { return Topology<3>::has(nodes, n); }))
      continue;
    for (NodeId n : nodes) {
      if (mesh_.locked[n]) return false;
      if (found || !(static_cast<std::size_t>(n) >= phi_.size() || phi_[n] == 0) ||
          (at(n) - x).norm() > near)
        continue;
      if (!normal) normal = zone.at(x).normal;
      found = zone.at(at(n)).normal.dot(*normal) >= smooth_turn;
    }
  }
  return found;
}

void BorderFit::bow() {
  const Zone<3>& zone = partition_.zone(zone_);
  std::size_t first = 1;
  for (int round = 0; round < bend_rounds; ++round) {
    std::vector<std::array<NodeId, 2>> edges = mesh_.edges_from(first);
    std::erase_if(edges, [&](const auto& e) { return phi_[e[0]] != 0 || phi_[e[1]] != 0; });
    std::vector<double> off(edges.size(), 0);
    parallel_each(edges.size(), params_.threads, {}, [&](std::size_t i) {
      const Vec<3>&a = at(edges[i][0]), &b = at(edges[i][1]);
      const double d = std::abs(distance(0.5 * (a + b)));
      if (d <= bend_share * params_.tolerance || d > 0.3 * (b - a).norm()) return;
      if (zone.at(a).normal.dot(zone.at(b).normal) >= bow_turn) off[i] = d;
    });
    std::vector<std::pair<double, std::size_t>> far;
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (off[i] > 0) far.emplace_back(-off[i], i);
    std::sort(far.begin(), far.end());
    first = mesh_.topo.points.size();
    for (const auto& [negative, i] : far) {
      const auto [a, b] = edges[i];
      const Vec<3> x = 0.5 * (at(a) + at(b));
      Hold h = mesh_.hold(edges[i]);
      h.add_zone(zone_);
      const auto y = h.settle(partition_, x, mesh_.on);
      if (!y || (*y - x).norm() > 0.3 * (at(b) - at(a)).norm() || crowded(edges[i], *y)) continue;
      const Vec<3> normal = zone.at(*y).normal;
      if (std::min(normal.dot(zone.at(at(a)).normal), normal.dot(zone.at(at(b)).normal)) <= 0)
        continue;
      if (mesh_.split_at(edges[i], *y, std::array{0.5, 0.5}) != 0) phi_.push_back(0);
    }
    if (mesh_.topo.points.size() == first) break;
  }
}

bool BorderFit::bend(const Progress& progress) {
  return bend_edges(progress.portion(0, 0.5)) && bend_faces(progress.portion(0.5, 1));
}

bool BorderFit::bend_edges(const Progress& progress) {
  const std::int32_t label = interface();
  std::size_t first = 1;
  for (int round = 0; round < bend_rounds; ++round) {
    if (progress.cancelled()) return false;
    progress.report(static_cast<double>(round) / bend_rounds);
    std::vector<std::array<NodeId, 2>> edges;
    for (std::int32_t e = 0; e < mesh_.count(); ++e) {
      if (!mesh_.topo.alive(e) || !mesh_.topo.is_virtual(e) || mesh_.topo.label[e] != label)
        continue;
      const Element& v = mesh_.topo.elements[e];
      for (int i = 1; i < 4; ++i) {
        const NodeId a = v[i], b = v[1 + i % 3];
        if (static_cast<std::size_t>(std::max(a, b)) >= first) edges.push_back(mesh_.key(a, b));
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<double> off(edges.size(), 0);
    if (!parallel_each(edges.size(), params_.threads, {}, [&](std::size_t i) {
          off[i] = std::abs(distance(0.5 * (at(edges[i][0]) + at(edges[i][1]))));
        }))
      return false;
    first = mesh_.topo.points.size();
    std::vector<std::pair<double, std::size_t>> far;
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (off[i] > bend_share * params_.tolerance) far.emplace_back(-off[i], i);
    std::sort(far.begin(), far.end());
    for (const auto& [negative, i] : far) {
      const auto [a, b] = edges[i];
      const Vec<3> x = 0.5 * (at(a) + at(b));
      const auto y = mesh_.hold(edges[i]).settle(partition_, x, mesh_.on);
      if (!y || (*y - x).norm() > 0.3 * (at(b) - at(a)).norm() || crowded(edges[i], *y)) continue;
      if (!same_sheet(edges[i], *y)) continue;
      mesh_.split_at(edges[i], *y, std::array{0.5, 0.5});
    }
    if (mesh_.topo.points.size() == first) break;
  }
  return true;
}

/// Whether a point of the border belongs to the facets of the interface that contain the nodes,
/// and not to the other side of a thin wall or a wedge.
bool BorderFit::same_sheet(std::span<const NodeId> of, const Vec<3>& y) const {
  const Vec<3> normal = partition_.zone(zone_).at(y).normal;
  for (auto e : mesh_.topo.around.of(of[0])) {
    const Element& v = mesh_.topo.elements[e];
    if (!mesh_.topo.is_virtual(e) || mesh_.topo.label[e] != interface() ||
        !std::all_of(of.begin(), of.end(), [&](NodeId n) { return Topology<3>::has(v, n); }))
      continue;
    if (facet_normal<3>({at(v[1]), at(v[2]), at(v[3])}).dot(normal) < 0) return false;
  }
  return true;
}

/// Puts a node into the facets of the interface whose inner points are too far from the border.
bool BorderFit::bend_faces(const Progress& progress) {
  const std::int32_t label = interface();
  for (int round = 0; round < bend_rounds; ++round) {
    if (progress.cancelled()) return false;
    std::vector<std::int32_t> facets;
    for (std::int32_t e = 0; e < mesh_.count(); ++e)
      if (mesh_.topo.alive(e) && mesh_.topo.is_virtual(e) && mesh_.topo.label[e] == label)
        facets.push_back(e);
    std::vector<std::array<double, 3>> worst(facets.size());
    std::vector<double> off(facets.size(), 0);
    if (!parallel_each(facets.size(), params_.threads, {}, [&](std::size_t i) {
          constexpr int order = 6;
          const Element& v = mesh_.topo.elements[facets[i]];
          for (int j = 1; j < order; ++j)
            for (int k = 1; j + k < order; ++k) {
              const std::array<double, 3> w{j / 6.0, k / 6.0, (order - j - k) / 6.0};
              const double d =
                  std::abs(distance(w[0] * at(v[1]) + w[1] * at(v[2]) + w[2] * at(v[3])));
              if (d <= off[i]) continue;
              off[i] = d;
              worst[i] = w;
            }
        }))
      return false;
    bool any = false;
    for (std::size_t i = 0; i < facets.size(); ++i) {
      if (off[i] <= face_share * params_.tolerance || !mesh_.topo.alive(facets[i])) continue;
      const Element v = mesh_.topo.elements[facets[i]];
      const std::array<NodeId, 3> of{v[1], v[2], v[3]};
      const auto& w = worst[i];
      const Vec<3> x = w[0] * at(v[1]) + w[1] * at(v[2]) + w[2] * at(v[3]);
      const auto y = mesh_.hold(of).settle(partition_, x, mesh_.on);
      if (y && !crowded(of, *y) && same_sheet(of, *y) && mesh_.split_at(of, *y, w) != 0) any = true;
    }
    if (!any) break;
  }
  return true;
}

}  // namespace lamella
