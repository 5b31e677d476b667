#include "core/multidomain/interface_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "core/base/parallel.h"
#include "core/mesh/boundary.h"
#include "core/mesh/element_locator.h"
#include "core/multidomain/border_fit.h"
#include "core/multidomain/border_sides.h"
#include "core/multidomain/cut_mesh.h"
#include "core/multidomain/cut_topology.h"
#include "core/multidomain/feature_chains.h"
#include "core/multidomain/pierced.h"

namespace lamella {
namespace {

/// Of the tolerance: how far an edge may dip through a border, and through a smooth one, where the
/// chord of a curved border does.
constexpr double dip_share = 0.03;
constexpr double smooth_dip_share = 0.3;
/// Of the tolerance: nodes of feature edges this near to a border count as on it. Edges at them may
/// dip as far.
constexpr double feature_share = 0.5;
/// Cosine between normals of a border above which it is smooth.
constexpr double smooth_turn = 0.8;
/// Of the tolerance: what the straight pieces of a feature line may take.
constexpr double chain_share = 0.2;
/// Of the error of chords: what a chord over two of them lies deep at most, 4, and a margin.
constexpr double crease_of_chords = 8;
/// Rounds of looking for edges that cross a border, for elements that it passes through, and of
/// the tolerance: how deep.
constexpr int split_rounds = 12, pierced_rounds = 12;
constexpr double pierced_share = 0.8;
/// The least barycentric weight of a node there.
constexpr double least_weight = 0.08;
/// Metric distance from a node within which there is no other to open an element.
constexpr double heap = 0.1;
/// Metric length above which edges near a border are halved.
constexpr double long_edge = 1.4;
constexpr int shorten_rounds = 3;
/// Of the tolerance: how deep an element at a border is when either side will do, away from feature
/// edges.
constexpr double doubt_share = 1;

using Element = CutTopology::Element;
using Weights = CutTopology::Weights;

/// Points of features that were followed: those of the next are the same where they are nearer than
/// `reach` mm, as on both edges of a step that is lower than the tolerance.
class Followed {
 public:
  explicit Followed(double reach) : reach_(reach) {}
  void add(const std::vector<Vec<3>>& points) {
    for (const Vec<3>& x : points) cells_[cell(x)].push_back(x);
  }
  Vec<3> near(const Vec<3>& x) const {
    const Cell middle = cell(x);
    Vec<3> nearest = x;
    double least = reach_;
    for (int k = 0; k < 27; ++k) {
      const auto found =
          cells_.find({middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1});
      if (found == cells_.end()) continue;
      for (const Vec<3>& y : found->second)
        if (const double d = (y - x).norm(); d < least) {
          least = d;
          nearest = y;
        }
    }
    return nearest;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell(const Vec<3>& x) const {
    Cell c{};
    for (int k = 0; k < 3; ++k) c[k] = static_cast<std::int64_t>(std::floor(x[k] / reach_));
    return c;
  }
  double reach_;
  std::map<Cell, std::vector<Vec<3>>> cells_;
};

class Cutter {
 public:
  Cutter(const SimplexMesh<3>& mesh, const MetricField<3>& metric, const Partition<3>& partition,
         const CutParams& params, const MetricFunction<3>& metric_at)
      : partition_(partition),
        params_(params),
        initial_(mesh.elements),
        locator_(mesh),
        wall_(surface_of_facets(mesh)),
        mesh_(mesh, metric, partition, params, metric_at),
        followed_(shared_share * params.tolerance) {}

  bool cut(int zone, const ReferenceSurface<3>& surface, const Progress& progress) {
    zone_ = zone;
    if (!measure(progress.portion(0, 0.05))) return false;
    if (!shorten(progress.portion(0.05, 0.1))) return false;
    if (!follow_features(surface, progress.portion(0.1, 0.4))) return false;
    if (!measure(progress.portion(0.4, 0.5))) return false;
    if (!snap(progress.portion(0.5, 0.7))) return false;
    fit().bow();
    if (!split(1, progress.portion(0.7, 0.8))) return false;
    if (!open_pierced(progress.portion(0.8, 0.9))) return false;
    tag();
    return fit().bend(progress.portion(0.9, 1));
  }

  std::optional<CutMesh> result(const SimplexMesh<3>& original, const Progress& progress) const {
    std::optional<CutMesh> out =
        mesh_of_cut(mesh_, original, partition_, params_.threads, progress);
    if (out) out->lost = lost_;
    return out;
  }

 private:
  BorderFit fit() { return {mesh_, partition_, zone_, params_, phi_}; }
  double phi_at(const Vec<3>& x) const { return partition_.zone(zone_).distance(x); }
  /// The element that contains x, seen from the place of x in the mesh that was given.
  std::optional<std::int32_t> locate(const Vec<3>& x) const {
    const auto start = locator_.locate(x);
    if (!start.inside && start.distance2 > mesh_.exact * mesh_.exact) return std::nullopt;
    // Elements only became smaller: what contains x touches a node nearby.
    std::vector<NodeId> front(initial_[start.element].begin(), initial_[start.element].end());
    std::set<NodeId> seen(front.begin(), front.end());
    double best = -std::numeric_limits<double>::infinity();
    std::optional<std::int32_t> found;
    for (int ring = 0; ring < 12 && best < -1e-9; ++ring) {
      std::vector<NodeId> next;
      for (NodeId n : front)
        for (auto e : mesh_.topo.around.of(n)) {
          if (mesh_.topo.is_virtual(e)) continue;
          const Weights w = mesh_.weights_in(e, x);
          const double least = *std::min_element(w.begin(), w.end());
          const bool better = least > best + 1e-12;
          if (better && (least < -1e-9 || mesh_.active(e) || !found)) {
            best = least;
            found = e;
          }
          for (NodeId v : mesh_.topo.elements[e])
            if (seen.insert(v).second) next.push_back(v);
        }
      front = std::move(next);
    }
    // Nodes of the wall may be off it.
    if (!found || (best < -1e-6 && (inside_of(*found, x).first - x).norm() > 2 * mesh_.on))
      return std::nullopt;
    return found;
  }

  /// The point in the element, moved into it where it is outside, and its weights.
  std::pair<Vec<3>, Weights> inside_of(std::int32_t e, const Vec<3>& x) const {
    Weights w = mesh_.weights_in(e, x);
    const bool outside = *std::min_element(w.begin(), w.end()) < -1e-6;
    double sum = 0;
    for (double& k : w) {
      if (k < 1e-9) k = 0;
      sum += k;
    }
    if (!outside) return {x, w};
    Vec<3> y = Vec<3>::Zero();
    for (int k = 0; k < 4; ++k) y += (w[k] /= sum) * at(mesh_.topo.elements[e][k]);
    return {y, w};
  }

  /// Whether x lies in the domain and in no zone of higher priority.
  bool reachable(const Vec<3>& x) const {
    const auto place = locator_.locate(x);
    if (!place.inside && place.distance2 > mesh_.exact * mesh_.exact) return false;
    for (int k = 0; k < zone_; ++k) {
      const Box<3>& box = partition_.box(k);
      if ((x - x.cwiseMax(box.lo).cwiseMin(box.hi)).norm() > mesh_.on) continue;
      if (partition_.zone(k).distance(x) < -mesh_.on) return false;
    }
    return true;
  }

  /// The point of a feature, on borders that were cut already and on the wall where they are near.
  Vec<3> shared(const Vec<3>& x) const {
    const double reach = shared_share * params_.tolerance;
    return onto_wall(wall_, partition_, onto_borders(partition_, zone_, x, reach), reach, mesh_.on);
  }
  bool follow_features(const ReferenceSurface<3>& surface, const Progress& progress) {
    double deep = params_.tolerance;
    if (!params_.chord_error.empty())
      deep =
          std::max(deep, crease_of_chords * params_.chord_error[static_cast<std::size_t>(zone_)]);
    const auto chains =
        feature_chains(with_creases(surface, deep), chain_share * params_.tolerance);
    for (std::int32_t c : surface.corners) {
      if (progress.cancelled()) return false;
      const Vec<3> x = followed_.near(shared(surface.points[c]));
      if (reachable(x)) place(x);
      followed_.add({x});
    }
    for (std::size_t i = 0; i < chains.size(); ++i) {
      NodeId reached = 0;
      std::vector<Vec<3>> points;
      for (const Vec<3>& x : chains[i]) points.push_back(followed_.near(shared(x)));
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        if (progress.cancelled()) return false;
        reached = follow(points[k], points[k + 1], reached);
      }
      followed_.add(points);
      progress.report(static_cast<double>(i + 1) / static_cast<double>(chains.size()));
    }
    return true;
  }

  NodeId place(const Vec<3>& x) {
    const auto e = locate(x);
    if (!e) return 0;
    const auto [y, w] = inside_of(*e, x);
    return mesh_.bring_node(*e, w, y);
  }

  /// Makes the segment a chain of edges as far as it is reachable; `from`: the node at p, or 0, and
  /// returned that at q.
  NodeId follow(const Vec<3>& p, const Vec<3>& q, NodeId from) {
    constexpr int samples = 16;
    int next = 0;
    NodeId now = from;
    while (true) {
      if (now == 0) {
        // Start in the middle of what is reachable, and look back first.
        while (next <= samples && !reachable(p + (q - p) * next / samples)) ++next;
        if (next > samples) return 0;
        const int first = next;
        while (next + 1 <= samples && reachable(p + (q - p) * (next + 1) / samples)) ++next;
        const int begin = first == 0 ? 0 : (first + next) / 2;
        now = place(p + (q - p) * begin / samples);
        if (now == 0) {
          ++lost_;
          next = begin + 1;
          continue;
        }
        if (begin > 0) walk(now, p);
        next = begin;
      }
      const auto [end, arrived] = walk(now, q);
      if (arrived) return end;
      const double t = (at(end) - p).dot(q - p) / (q - p).squaredNorm();
      next = std::max(next + 1, static_cast<int>(std::ceil(t * samples + 0.01)));
      now = 0;
    }
  }

  /// Goes from a node towards x, making edges of the way, as far as the background reaches.
  std::pair<NodeId, bool> walk(NodeId from, const Vec<3>& x) {
    NodeId now = from;
    for (int step = 0; step < 4000; ++step) {
      const Vec<3> way = x - at(now);
      const double left = way.norm();
      if (left <= std::max(mesh_.exact, 0.1 * mesh_.on)) return {now, true};
      // The element into which the way leads: x = now + sum w_k (p_k - now).
      double best = -1e-7;
      std::int32_t into = -1;
      Weights weights{};
      for (auto e : mesh_.topo.around.of(now)) {
        if (!mesh_.active(e)) continue;
        const Element& nodes = mesh_.topo.elements[e];
        Mat<3> a;
        std::array<int, 3> place{};
        for (int k = 0, j = 0; k < 4; ++k)
          if (nodes[k] != now) {
            place[j] = k;
            a.col(j++) = at(nodes[k]) - at(now);
          }
        const Vec<3> w = a.inverse() * way;
        const double least = w.minCoeff() / w.cwiseAbs().maxCoeff();
        if (!(least > best)) continue;
        best = least;
        into = e;
        weights = {};
        for (int j = 0; j < 3; ++j) weights[place[j]] = w[j];
        if (best > 1e-7) break;
      }
      if (into < 0) return {now, false};
      const Element nodes = mesh_.topo.elements[into];
      const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
      const double largest = *std::max_element(weights.begin(), weights.end());
      for (double& w : weights)
        if (w < 1e-7 * largest) w = 0;
      Vec<3> target = x;
      if (sum > 1 - 1e-9) {
        const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
        for (double& w : weights) w /= all;
        target = sum > 1 + 1e-9 ? Vec<3>(at(now) + way / sum) : x;
      } else {
        for (int k = 0; k < 4; ++k)
          if (nodes[k] == now) weights[k] = 1 - sum;
      }
      const bool last = sum <= 1 + 1e-9 && sum > 1 - 1e-9;
      const NodeId reached = mesh_.bring_node(into, weights, target, now, x);
      if (reached == 0 || reached == now) {
        ++lost_;
        return {now, false};
      }
      mesh_.features.insert(mesh_.key(now, reached));
      if (last) return {reached, true};
      if ((x - at(reached)).norm() >= left) {
        ++lost_;
        return {reached, false};
      }
      now = reached;
    }
    ++lost_;
    return {now, false};
  }

  /// The signed distance of the zone at the nodes of the background.
  bool measure(const Progress& progress) {
    std::vector<char> wanted(mesh_.topo.points.size(), 0);
    for (std::int32_t e = 0; e < mesh_.count(); ++e)
      if (mesh_.active(e))
        for (NodeId n : mesh_.topo.elements[e]) wanted[n] = 1;
    phi_.assign(mesh_.topo.points.size(), 0);
    slack_.assign(phi_.size(), 0);
    nodes_.clear();
    for (std::size_t n = 1; n < wanted.size(); ++n)
      if (wanted[n]) nodes_.push_back(static_cast<NodeId>(n));
    const Box<3>& box = partition_.box(zone_);
    return parallel_each(nodes_.size(), params_.threads, progress, [&](std::size_t i) {
      const NodeId n = nodes_[i];
      const Vec<3>& x = at(n);
      // Far from the box its distance tells enough.
      const double beyond = (x - x.cwiseMax(box.lo).cwiseMin(box.hi)).norm();
      phi_[n] = mesh_.metric[n].quad(Vec<3>::Constant(beyond)) > 100 ? beyond : phi_at(x);
      if (std::abs(phi_[n]) <= mesh_.exact ||
          (mesh_.locked[n] && std::abs(phi_[n]) <= feature_share * params_.tolerance) ||
          (std::abs(phi_[n]) <= shared_share * params_.tolerance &&
           !mesh_.hold(std::array{n}).zones.empty())) {
        slack_[n] = std::abs(phi_[n]);
        phi_[n] = 0;
      }
    });
  }

  /// Halves the edges near the border that are longer than asked: their elements reach past a
  /// curved border, and what is cut out of them folds.
  bool shorten(const Progress& progress) {
    std::size_t first = 1;
    for (int round = 0; round < shorten_rounds; ++round) {
      if (progress.cancelled()) return false;
      const std::vector<std::array<NodeId, 2>> edges = mesh_.edges_from(first);
      std::vector<std::pair<double, std::size_t>> far;
      for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto [a, b] = edges[i];
        const Vec<3> e = at(b) - at(a);
        if (std::min(std::abs(phi_[a]), std::abs(phi_[b])) > e.norm()) continue;
        const double length2 = 0.5 * (mesh_.metric[a].quad(e) + mesh_.metric[b].quad(e));
        if (length2 > long_edge * long_edge) far.emplace_back(-length2, i);
      }
      std::sort(far.begin(), far.end());
      first = mesh_.topo.points.size();
      for (const auto& [negative, i] : far) {
        const auto [a, b] = edges[i];
        const Vec<3> x = 0.5 * (at(a) + at(b));
        const Hold h = mesh_.hold(edges[i]);
        if (h.allows(partition_, x, mesh_.on) &&
            mesh_.split_at(edges[i], x, std::array{0.5, 0.5}) != 0)
          phi_.push_back(phi_at(x));
      }
      if (mesh_.topo.points.size() == first) break;
    }
    return true;
  }

  bool snap(const Progress& progress) {
    std::vector<std::pair<double, NodeId>> near;
    for (NodeId n : nodes_) {
      if (phi_[n] == 0 || mesh_.locked[n]) continue;
      const ZoneDistance<3> d = partition_.zone(zone_).at(at(n));
      const double across = std::abs(d.distance) * std::sqrt(mesh_.metric[n].quad(d.normal));
      if (across < params_.snap) near.emplace_back(across, n);
    }
    std::sort(near.begin(), near.end());
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (i % 256 == 0) {
        if (progress.cancelled()) return false;
        progress.report(static_cast<double>(i) / static_cast<double>(near.size()));
      }
      const NodeId n = near[i].second;
      Hold h = mesh_.hold(std::array{n});
      h.add_zone(zone_);
      const auto x = h.settle(partition_, at(n), mesh_.on);
      if (!x || mesh_.metric[n].quad(*x - at(n)) > 1) continue;
      if (mesh_.move(n, *x)) phi_[n] = 0;
    }
    // What may not move but is there within a share of the tolerance is left there.
    for (NodeId n : nodes_)
      if (std::abs(phi_[n]) <= mesh_.on) phi_[n] = 0;
    return true;
  }

  double slack(NodeId n) const {
    return static_cast<std::size_t>(n) < slack_.size() ? slack_[n] : 0;
  }
  /// Where the edge crosses the border, as a share of it.
  std::optional<double> crossing(NodeId a, NodeId b) const {
    const Vec<3> e = at(b) - at(a);
    const double length = e.norm();
    if (std::abs(phi_[a]) + std::abs(phi_[b]) >= length && phi_[a] * phi_[b] >= 0)
      return std::nullopt;
    const double dip = dip_share * params_.tolerance + std::max(slack(a), slack(b));
    double deep = std::numeric_limits<double>::infinity();
    double t0 = 0, f0 = phi_[a], t1 = 1, f1 = phi_[b];
    if (!(f0 * f1 < 0)) {
      constexpr int samples = 8;
      double last_t = 0, last = f0;
      std::array<double, 2> most{std::max(f0, f1), std::max(-f0, -f1)};  // outside, inside
      bool found = false;
      for (int i = 1; i <= samples; ++i) {
        const double t = static_cast<double>(i) / samples;
        const double f = i == samples ? phi_[b] : phi_at(at(a) + t * e);
        if (std::abs(f) <= dip && i < samples) continue;
        if (f == 0) continue;
        if (!found && last * f < 0) {
          t0 = last_t, f0 = last, t1 = t, f1 = f;
          found = true;
        }
        double& side = most[f < 0 ? 1 : 0];
        side = std::max(side, std::abs(f));
        last_t = t;
        last = f;
      }
      if (!found) return std::nullopt;
      deep = std::min(most[0], most[1]);
    }
    // Regula falsi, Illinois.
    double t = t0;
    for (int i = 0; i < 60; ++i) {
      t = t0 - f0 * (t1 - t0) / (f1 - f0);
      if (!(t > std::min(t0, t1) && t < std::max(t0, t1))) t = 0.5 * (t0 + t1);
      const double f = phi_at(at(a) + t * e);
      if (std::abs(f) <= 1e-3 * mesh_.on || std::abs(t1 - t0) < 1e-12) break;
      if (f * f1 < 0) {
        t0 = t1;
        f0 = f1;
      } else {
        f0 *= 0.5;
      }
      t1 = t;
      f1 = f;
    }
    if (deep <= smooth_dip_share * params_.tolerance) {
      const Zone<3>& zone = partition_.zone(zone_);
      const Vec<3> normal = zone.at(at(a) + t * e).normal;
      if (normal.dot(zone.at(at(a)).normal) > smooth_turn &&
          normal.dot(zone.at(at(b)).normal) > smooth_turn)
        return std::nullopt;
    }
    return t;
  }

  /// Splits the edges that cross the border, those between nodes before `first` excepted: they are
  /// known not to.
  bool split(std::size_t first, const Progress& progress) {
    for (int round = 0; round < split_rounds; ++round) {
      if (progress.cancelled()) return false;
      progress.report(static_cast<double>(round) / split_rounds);
      const std::vector<std::array<NodeId, 2>> edges = mesh_.edges_from(first);
      std::vector<double> where(edges.size(), -1);
      if (!parallel_each(edges.size(), params_.threads, {}, [&](std::size_t i) {
            if (const auto t = crossing(edges[i][0], edges[i][1])) where[i] = *t;
          }))
        return false;
      first = mesh_.topo.points.size();
      bool any = false;
      for (std::size_t i = 0; i < edges.size(); ++i) {
        if (where[i] <= 0) continue;
        const auto [a, b] = edges[i];
        const double t = where[i];
        const std::array<double, 2> share{1 - t, t};
        const Vec<3> x = (1 - t) * at(a) + t * at(b);
        if (!(phi_[a] * phi_[b] < 0) && fit().crowded(edges[i], x)) continue;
        any = true;
        NodeId n = 0;
        Hold h = mesh_.hold(edges[i]);
        if (!h.free()) {
          h.add_zone(zone_);
          const auto y = h.settle(partition_, x, mesh_.on);
          if (y && (*y - x).norm() < 0.3 * (at(b) - at(a)).norm())
            n = mesh_.split_at(edges[i], *y, share);
        }
        if (n == 0) mesh_.split_at(edges[i], x, share);
      }
      phi_.resize(mesh_.topo.points.size(), 0);
      if (!any) break;
    }
    return true;
  }

  /// A border may pass through an element and cross none of its edges, as a rounded corner smaller
  /// than the element does: it gets a node on the border there.
  bool open_pierced(const Progress& progress) {
    std::size_t first = 1;
    for (int round = 0; round < pierced_rounds; ++round) {
      if (progress.cancelled()) return false;
      std::vector<std::int32_t> near;
      for (std::int32_t e = 0; e < mesh_.count(); ++e) {
        if (!mesh_.active(e)) continue;
        const Element& nodes = mesh_.topo.elements[e];
        if (static_cast<std::size_t>(*std::max_element(nodes.begin(), nodes.end())) < first)
          continue;
        double least = std::numeric_limits<double>::infinity(), longest2 = 0;
        for (int i = 0; i < 4; ++i) {
          least = std::min(least, std::abs(phi_[nodes[i]]));
          for (int j = 0; j < i; ++j)
            longest2 = std::max(longest2, (at(nodes[i]) - at(nodes[j])).squaredNorm());
        }
        if (least * least < longest2) near.push_back(e);
      }
      std::vector<std::optional<Pierced>> where(near.size());
      if (!parallel_each(near.size(), params_.threads, progress, [&](std::size_t i) {
            const Element& v = mesh_.topo.elements[near[i]];
            where[i] = pierced_at(partition_.zone(zone_), mesh_.corners(v),
                                  {phi_[v[0]], phi_[v[1]], phi_[v[2]], phi_[v[3]]},
                                  pierced_share * params_.tolerance);
          }))
        return false;
      first = mesh_.topo.points.size();
      std::vector<std::size_t> order;
      for (std::size_t i = 0; i < near.size(); ++i)
        if (where[i]) order.push_back(i);
      std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        return where[i]->depth > where[j]->depth;
      });
      // Neighbors are pierced at the same place: they wait for what comes of this one.
      std::vector<char> used(first, 0);
      for (std::size_t i : order) {
        const Element nodes = mesh_.topo.elements[near[i]];
        if (!mesh_.topo.alive(near[i]) ||
            std::any_of(nodes.begin(), nodes.end(), [&](NodeId n) { return used[n] != 0; }))
          continue;
        const Weights w = mesh_.weights_in(near[i], where[i]->point);
        std::vector<NodeId> of;
        std::vector<double> share;
        double sum = 0;
        for (int k = 0; k < 4; ++k)
          if (w[k] > least_weight) {
            of.push_back(nodes[k]);
            share.push_back(w[k]);
            sum += w[k];
          }
        if (of.size() < 2 || !mesh_.hold(of).free()) continue;
        // Nodes in a heap would help nobody.
        if (std::any_of(nodes.begin(), nodes.end(), [&](NodeId n) {
              return mesh_.metric[n].quad(at(n) - where[i]->point) < heap * heap;
            }))
          continue;
        Vec<3> x = Vec<3>::Zero();
        double reach = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < of.size(); ++k) {
          share[k] /= sum;
          x += share[k] * at(of[k]);
        }
        for (NodeId n : of) reach = std::min(reach, (at(n) - x).norm());
        // On the border, unless that is far.
        const ZoneDistance<3> d = partition_.zone(zone_).at(x);
        const Vec<3> foot = x - d.distance * d.normal;
        const bool settles =
            std::abs(d.distance) < 0.5 * reach && std::abs(phi_at(foot)) <= mesh_.on;
        if (fit().crowded(of, settles ? foot : x)) continue;
        if (settles && mesh_.split_at(of, foot, share) != 0) {
          phi_.push_back(0);
        } else {
          if (mesh_.split_at(of, x, share) == 0) continue;
          phi_.push_back(std::abs(d.distance) <= mesh_.on ? 0 : d.distance);
        }
        for (NodeId n : nodes) used[n] = 1;
      }
      if (mesh_.topo.points.size() == first) break;
      if (!split(first, {})) return false;
    }
    return true;
  }

  /// Which side the elements of the background are on, and which may go to either.
  void tag() {
    std::vector<std::int32_t> active;
    for (std::int32_t e = 0; e < mesh_.count(); ++e)
      if (mesh_.active(e)) active.push_back(e);
    std::vector<char> side(active.size()), doubt(active.size());
    parallel_each(active.size(), params_.threads, {}, [&](std::size_t i) {
      const Element& nodes = mesh_.topo.elements[active[i]];
      double most = 0, least = std::numeric_limits<double>::infinity(), longest2 = 0;
      for (int k = 0; k < 4; ++k) {
        const double phi = phi_[nodes[k]];
        if (std::abs(phi) > std::abs(most)) most = phi;
        least = std::min(least, std::abs(phi));
        for (int j = 0; j < k; ++j)
          longest2 = std::max(longest2, (at(nodes[k]) - at(nodes[j])).squaredNorm());
      }
      side[i] = most < 0;
      // Elsewhere the border is too far to come in.
      if (least * least >= longest2) return;
      const DepthIn in = depth_in(partition_.zone(zone_), mesh_.corners(nodes));
      // A corner may look over the border from the other side.
      if (std::abs(in.mean) > std::abs(most)) side[i] = in.mean < 0;
      const bool feature =
          std::any_of(nodes.begin(), nodes.end(), [&](NodeId n) { return mesh_.locked[n] != 0; });
      // A slit between the border and that of another zone that it became one with.
      const Corners<3> p = mesh_.corners(nodes);
      const bool closed =
          feature && most == 0 &&
          std::any_of(nodes.begin(), nodes.end(), [&](NodeId n) { return slack(n) > mesh_.on; }) &&
          partition_.region_of((p[0] + p[1] + p[2] + p[3]) / 4) == partition_.background();
      const double limit = feature && !closed ? dip_share : doubt_share;
      doubt[i] = std::max(in.most, std::abs(most)) <= limit * params_.tolerance;
    });
    std::vector<std::int32_t> doubtful;
    std::vector<char> inside(static_cast<std::size_t>(mesh_.count()), 0);
    for (std::size_t i = 0; i < active.size(); ++i) {
      inside[active[i]] = side[i];
      if (doubt[i]) doubtful.push_back(active[i]);
    }
    BorderSides sides(mesh_, inside);
    sides.settle(doubtful);
    const std::int32_t count = mesh_.count();
    for (std::int32_t e = 0; e < count; ++e) {
      if (!inside[e]) continue;
      for (int k = 0; k < 4; ++k) {
        const std::int32_t next = sides.across(e, k);
        if (next >= 0 && !inside[next])
          mesh_.topo.add(Topology<3>::virtual_element(opposite_facet<3>(mesh_.topo.elements[e], k)),
                         mesh_.first_interface + zone_);
      }
    }
    for (std::int32_t e = 0; e < count; ++e)
      if (inside[e]) mesh_.topo.label[e] = zone_;
  }

  const Vec<3>& at(NodeId n) const { return mesh_.at(n); }

  const Partition<3>& partition_;
  const CutParams& params_;
  const std::vector<Element>& initial_;
  ElementLocator<3> locator_;
  Locator<3> wall_;  ///< of the domain
  CutTopology mesh_;
  Followed followed_;
  int zone_ = 0;
  std::vector<double> phi_;    ///< [node] of the zone that is being cut
  std::vector<double> slack_;  ///< [node that was there before edges were split] how far off it is
  std::vector<NodeId> nodes_;  ///< of the background
  std::size_t lost_ = 0;
};

}  // namespace

Result<CutMesh> cut_interfaces(const SimplexMesh<3>& mesh, const MetricField<3>& metric,
                               const Partition<3>& partition,
                               const std::vector<ReferenceSurface<3>>& surfaces,
                               const CutParams& params, const Progress& progress,
                               const MetricFunction<3>& metric_at) {
  Cutter cutter(mesh, metric, partition, params, metric_at);
  const int zones = partition.background();
  for (int k = 0; k < zones; ++k)
    if (!cutter.cut(k, surfaces[k],
                    progress.portion(0.95 * k / zones, 0.95 * (k + 1) / zones, "cutting")))
      return cancelled_error();
  std::optional<CutMesh> cut = cutter.result(mesh, progress.portion(0.95, 1));
  if (!cut) return cancelled_error();
  return std::move(*cut);
}

}  // namespace lamella
