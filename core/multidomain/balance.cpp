#include "core/multidomain/balance.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/geometry/simplex.h"
#include "core/mesh/quality.h"

namespace lamella {
namespace {

/// Cosine between the normals of facet and border above which it is smooth at a node.
constexpr double smooth_turn = 0.8;
constexpr int rounds = 3;
/// Of an element's volume: what a round must leave of it.
constexpr double least_left = 0.5;
/// c(T) below which an element gets no worse.
constexpr double poor_quality = 0.3;
/// Of the way allowed: steps below are rounding.
constexpr double least_step = 1e-6;
/// Points of a facet, to an edge, where its distance is asked.
constexpr int samples = 4;
/// Of the way from the middle of a facet to its corners: where the border's normal is asked.
constexpr double inner_share = 0.7;
/// Borders that turn by less at a node are one; of what they lack, what a step may miss.
constexpr double least_turn = 0.25, missed_share = 0.3;
constexpr int wall = -1, none = -2;  // in place of a zone

/// Barycentric weights whose mean is exact for quadratic functions on a triangle.
constexpr std::array<std::array<double, 3>, 3> middles{
    {{0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}};

/// What the facets of a smooth part of a border around a node have of it.
struct Share {
  int zone = none;
  Vec<3> normal = Vec<3>::Zero();
  double area = 0;     ///< a third of the facets, mm^2
  double missing = 0;  ///< what they lack, mm^3
};

struct NodeShares {
  static constexpr std::size_t most = 5;
  std::array<Share, most> of;
  std::size_t count = 0;
  bool moves = true;

  /// The share of facets of the zone that look there; null where there is none.
  Share* find(int zone, const Vec<3>& normal) {
    for (std::size_t k = 0; k < count; ++k)
      if (of[k].zone == zone && of[k].normal.dot(normal) > smooth_turn) return &of[k];
    return nullptr;
  }
  /// Too many borders hold the node.
  void add(int zone, const Vec<3>& normal) {
    if (find(zone, normal)) return;
    if (count == most) {
      moves = false;
      return;
    }
    of[count].zone = zone;
    of[count++].normal = normal;
  }
};

class Balance {
 public:
  Balance(SimplexMesh<3>& mesh, const Partition<3>& partition,
          std::span<const std::int32_t> first_face, const BalanceParams& params)
      : mesh_(mesh),
        partition_(partition),
        first_face_(first_face),
        params_(params),
        shares_(mesh.points.size()) {}

  std::size_t run(const Progress& progress) {
    for (std::size_t f = 0; f < mesh_.facets.size(); ++f) {
      if (zone_of(f) != wall || params_.domain)
        facets_.push_back(f);
      else
        for (NodeId n : mesh_.facets[f]) shares_[n].moves = false;
    }
    before_ = mesh_.points;
    far_.resize(facets_.size());
    normals_.assign(facets_.size(), Vec<3>::Zero());
    if (!find_shares(progress.portion(0, 0.25))) return 0;
    for (int round = 0; round < rounds; ++round)
      if (!step(progress.portion(0.25 * (round + 1), 0.25 * (round + 2)))) break;
    std::size_t moved = 0;
    for (std::size_t n = 1; n < before_.size(); ++n) moved += mesh_.points[n] != before_[n];
    return moved;
  }

 private:
  int zone_of(std::size_t f) const {
    const auto it = std::upper_bound(first_face_.begin(), first_face_.end(), mesh_.facet_face[f]);
    return static_cast<int>(it - first_face_.begin()) - 1;
  }
  const Zone<3>& zone(int k) const { return k == wall ? *params_.domain : partition_.zone(k); }

  /// The largest distance of a facet from its border, outside and inside of it.
  std::array<double, 2> far(std::size_t f) const {
    const auto p = mesh_.corners(mesh_.facets[f]);
    const Zone<3>& border = zone(zone_of(f));
    std::array<double, 2> most{};
    for (int i = 0; i <= samples; ++i)
      for (int j = 0; i + j <= samples; ++j) {
        const double d =
            border.distance((i * p[0] + j * p[1] + (samples - i - j) * p[2]) / samples);
        double& side = most[d < 0 ? 1 : 0];
        side = std::max(side, std::abs(d));
      }
    return most;
  }
  bool too_far(std::size_t i) const {
    const auto now = far(facets_[i]);
    for (int side = 0; side < 2; ++side)
      if (now[side] > std::max(params_.tolerance, far_[i][side])) return true;
    return false;
  }

  /// Whether an element is poor, and more so than with the points before.
  bool gets_poor(const std::array<NodeId, 4>& e, const std::vector<Vec<3>>& before) const {
    if (!params_.metric ||
        std::all_of(e.begin(), e.end(), [&](NodeId n) { return mesh_.points[n] == before[n]; }))
      return false;
    const Metric<3> m = mean_metric<3>(*params_.metric, e);
    const double now = quality<3>(mesh_.corners(e), m);
    return now < poor_quality &&
           now < quality<3>({before[e[0]], before[e[1]], before[e[2]], before[e[3]]}, m);
  }

  /// The smooth parts of borders at the nodes; nodes of facets over an edge stay.
  bool find_shares(const Progress& progress) {
    std::vector<char> rough(facets_.size());
    const auto look = [&](std::size_t i) {
      const auto p = mesh_.corners(mesh_.facets[facets_[i]]);
      const Vec<3> normal = facet_normal<3>(p).normalized(), middle = (p[0] + p[1] + p[2]) / 3;
      const Zone<3>& border = zone(zone_of(facets_[i]));
      for (const Vec<3>& x : p) {
        const Vec<3> of_border = border.at(middle + inner_share * (x - middle)).normal;
        const double cosine = of_border.dot(normal);
        rough[i] |= std::abs(cosine) < smooth_turn;
        normals_[i] += cosine < 0 ? -normal : normal;
      }
      normals_[i].normalize();
      far_[i] = far(facets_[i]);
    };
    if (!parallel_each(facets_.size(), params_.threads, progress, look)) return false;
    for (std::size_t i = 0; i < facets_.size(); ++i)
      for (NodeId n : mesh_.facets[facets_[i]]) {
        if (rough[i]) shares_[n].moves = false;
        shares_[n].add(zone_of(facets_[i]), normals_[i]);
      }
    return true;
  }

  /// Where the node goes for what its borders lack, from where it was: the shortest step that has
  /// all of it along their normals.
  Vec<3> asked(const NodeShares& s, NodeId n) const {
    const Vec<3> x = mesh_.points[n] - before_[n];
    const auto rows = static_cast<Eigen::Index>(s.count);
    Eigen::MatrixXd a(rows, 3);
    Eigen::VectorXd b(rows);
    for (Eigen::Index k = 0; k < rows; ++k) {
      const Share& of = s.of[static_cast<std::size_t>(k)];
      a.row(k) = of.normal.transpose();
      b[k] = of.area > 0 ? of.missing / of.area : 0;
    }
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(least_turn);
    const Vec<3> step = svd.solve(b);
    const bool met = (a * step - b).cwiseAbs().maxCoeff() <= missed_share * b.cwiseAbs().maxCoeff();
    return met ? Vec<3>(x + step) : x;
  }

  bool step(const Progress& progress) {
    std::vector<double> depth(facets_.size());  // mean signed distance of a facet
    const auto distances = [&](std::size_t i) {
      const auto p = mesh_.corners(mesh_.facets[facets_[i]]);
      const Zone<3>& border = zone(zone_of(facets_[i]));
      for (const auto& w : middles)
        depth[i] += border.distance(w[0] * p[0] + w[1] * p[1] + w[2] * p[2]) / 3;
      const auto face = static_cast<std::size_t>(mesh_.facet_face[facets_[i]]);
      if (face < params_.depth.size()) depth[i] -= params_.depth[face];
    };
    if (!parallel_each(facets_.size(), params_.threads, progress, distances)) return false;
    for (NodeShares& s : shares_)
      for (Share& of : s.of) of.area = of.missing = 0;
    for (std::size_t i = 0; i < facets_.size(); ++i) {
      const auto& nodes = mesh_.facets[facets_[i]];
      const int zone = zone_of(facets_[i]);
      const double area = facet_normal<3>(mesh_.corners(nodes)).norm() / 2;
      const auto moving =
          std::count_if(nodes.begin(), nodes.end(), [&](NodeId n) { return shares_[n].moves; });
      for (NodeId n : nodes) {
        if (!shares_[n].moves) continue;
        Share* share = shares_[n].find(zone, normals_[i]);
        if (!share) continue;
        share->area += area / 3;
        share->missing -= depth[i] * area / static_cast<double>(moving);
      }
    }
    std::vector<double> volume(mesh_.elements.size());
    for (std::size_t e = 0; e < volume.size(); ++e)
      volume[e] = signed_measure<3>(mesh_.corners(mesh_.elements[e]));
    const std::vector<Vec<3>> start = mesh_.points;
    std::vector<Vec<3>> next = start;
    parallel_each(mesh_.node_count(), params_.threads, {}, [&](std::size_t i) {
      const NodeShares& s = shares_[i + 1];
      if (!s.moves || s.count == 0) return;
      const Vec<3> to = asked(s, static_cast<NodeId>(i + 1));
      // A node of a wall that was itself made of chords starts that far inside.
      double inside = 0;
      for (const Share& of : s.of)
        if (of.zone == wall) inside = std::abs(params_.domain->distance(before_[i + 1]));
      const double way = to.norm(), most = params_.most + inside;
      if (way > least_step * params_.most)
        next[i + 1] = before_[i + 1] + to * (way > most ? most / way : 1);
    });
    mesh_.points = std::move(next);
    // Nodes of an element that lost too much go back, and of a facet that is too far, which may
    // cost others theirs.
    for (bool any = true; any;) {
      any = false;
      const auto back = [&](const auto& nodes) {
        for (NodeId n : nodes) {
          any = any || mesh_.points[n] != start[n];
          mesh_.points[n] = start[n];
        }
      };
      for (std::size_t e = 0; e < volume.size(); ++e)
        if (signed_measure<3>(mesh_.corners(mesh_.elements[e])) < least_left * volume[e] ||
            gets_poor(mesh_.elements[e], start))
          back(mesh_.elements[e]);
      std::vector<char> off(facets_.size(), 0);
      parallel_each(facets_.size(), params_.threads, {}, [&](std::size_t i) {
        const auto& nodes = mesh_.facets[facets_[i]];
        if (std::any_of(nodes.begin(), nodes.end(),
                        [&](NodeId n) { return mesh_.points[n] != start[n]; }))
          off[i] = too_far(i);
      });
      for (std::size_t i = 0; i < facets_.size(); ++i)
        if (off[i]) back(mesh_.facets[facets_[i]]);
    }
    return true;
  }

  SimplexMesh<3>& mesh_;
  const Partition<3>& partition_;
  const std::span<const std::int32_t> first_face_;
  const BalanceParams& params_;
  std::vector<NodeShares> shares_;          ///< [node]
  std::vector<std::size_t> facets_;         ///< of borders that are known
  std::vector<Vec<3>> before_;              ///< [node]
  std::vector<std::array<double, 2>> far_;  ///< [of facets_] mm, before
  std::vector<Vec<3>> normals_;             ///< [of facets_] outward of their zone
};

}  // namespace

std::size_t balance_borders(SimplexMesh<3>& mesh, const Partition<3>& partition,
                            std::span<const std::int32_t> first_face, const BalanceParams& params,
                            const Progress& progress) {
  return Balance(mesh, partition, first_face, params).run(progress);
}

bool put_back(SimplexMesh<3>& mesh, const std::vector<Vec<3>>& points,
              const std::vector<Vec<3>>& places, double reach) {
  bool any = false;
  for (const auto& e : mesh.elements) {
    Box<3> box;
    for (NodeId n : e) box.add(mesh.points[n]);
    if (std::none_of(places.begin(), places.end(), [&](const Vec<3>& x) {
          return (x - x.cwiseMax(box.lo).cwiseMin(box.hi)).norm() <= reach;
        }))
      continue;
    for (NodeId n : e) {
      any = any || mesh.points[n] != points[n];
      mesh.points[n] = points[n];
    }
  }
  return any;
}

}  // namespace lamella
