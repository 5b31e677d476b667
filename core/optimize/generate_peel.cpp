#include "core/optimize/generate_peel.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace lamella {
namespace {

constexpr double kGood = 2e-3;    // shape, 1 for the regular simplex, that is worth a step any time
constexpr double kFlat = 1e-6;    // shape below which an element has no side
constexpr double kDepth = 0.3;    // of the body's width below a vertex: where its new point goes
constexpr double kSpread = 0.25;  // of the depth, at random: points in one plane make flat elements
constexpr double kMost = 1e-6;    // of the cube of the diagonal: volume that a step may turn over
constexpr int kHub = 60;          // facets around a node that takes no more

using Facet = std::array<NodeId, 3>;

constexpr int kJoinGood = 3, kNewPoint = 2, kJoin = 1, kInverts = 0, kNothing = -1;

/// What a step is worth: well oriented ones first, the least volume of them first; a new point only
/// where nothing good is left; then what turns the least volume inside out.
struct Worth {
  int rank = kNothing;
  double value = 0;
  bool operator<(const Worth& o) const { return rank != o.rank ? rank < o.rank : value < o.value; }
};

struct Step {
  Worth worth;
  NodeId to = 0;  // 0: a new point
  Vec<3> point = Vec<3>::Zero();
};

class Peeling {
 public:
  Peeling(Bridged<3> boundary, FoldedMesh<3>& mesh, const Locator<3>& surface, std::uint64_t seed)
      : out_(std::move(boundary)), mesh_(mesh), surface_(surface), seed_(seed) {
    around_.resize(mesh.node_end());
    facets_ = std::move(out_.facets);
    alive_.assign(facets_.size(), 1);
    left_ = facets_.size();
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (const NodeId n : facets_[f]) around_[n].push_back(static_cast<int>(f));
    grow();
  }

  Bridged<3> run(const Progress& progress) {
    const double first = static_cast<double>(left_);
    const double most = kMost * std::pow(surface_.diagonal(), 3);
    for (NodeId n = 1; n < static_cast<NodeId>(around_.size()); ++n) push(n);
    for (std::size_t steps = 0; !queue_.empty() && left_ > 4; ++steps) {
      if (steps % 256 == 0) {
        if (progress.cancelled()) break;
        progress.report(1 - static_cast<double>(left_) / first);
      }
      const Entry top = queue_.top();
      queue_.pop();
      if (top.version != version_[top.node] || around_[top.node].empty()) continue;
      // Edges elsewhere may have come or gone since.
      Step step = best_step(top.node);
      if (step.worth.rank == kNothing) continue;
      if (step.worth.rank > kInverts && !stays_inside(top.node, step))
        step.worth = {kInverts, -volume_of(top.node, step)};
      if (step.worth < top.worth) {
        queue_.push({step.worth, top.node, top.version});
        continue;
      }
      if (step.worth.rank == kInverts && -step.worth.value > most) break;
      take(top.node, step);
    }
    out_.facets.clear();
    for (std::size_t f = 0; f < facets_.size(); ++f)
      if (alive_[f]) out_.facets.push_back(facets_[f]);
    return std::move(out_);
  }

 private:
  struct Entry {
    Worth worth;
    NodeId node;
    unsigned version;
    bool operator<(const Entry& o) const {
      if (worth < o.worth) return true;
      if (o.worth < worth) return false;
      return node > o.node;
    }
  };

  void grow() {
    const auto n = static_cast<std::size_t>(mesh_.node_end());
    around_.resize(n);
    version_.resize(n, 0);
    mark_.resize(n, 0);
  }

  double random(NodeId n) const {
    std::uint64_t z = (seed_ + static_cast<std::uint64_t>(n)) * 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

  /// The neighbors of n in the order of the facets around it; false where these are no disk.
  bool take_ring(NodeId n) {
    const auto& facets = around_[n];
    ring_.clear();
    if (facets.size() < 3) return false;
    sides_.clear();
    for (const int f : facets) {
      const Facet& v = facets_[f];
      const int k = v[0] == n ? 0 : v[1] == n ? 1 : 2;
      sides_.push_back({v[(k + 1) % 3], v[(k + 2) % 3]});
    }
    NodeId next = sides_[0][0];
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      ring_.push_back(next);
      const auto it =
          std::find_if(sides_.begin(), sides_.end(), [&](const auto& s) { return s[0] == next; });
      if (it == sides_.end()) return false;
      next = (*it)[1];
      (*it)[0] = 0;
    }
    return next == ring_[0];
  }

  /// Of the simplices between the facets of the ring around n and x, without those at ring_[skip].
  Worth worth_of(NodeId n, const Vec<3>& x, int skip, double limit) const {
    const auto k = static_cast<int>(ring_.size());
    const Vec<3>& p = mesh_.point(n);
    double worst = std::numeric_limits<double>::infinity(), inverted = 0, volume = 0;
    const double px = (p - x).squaredNorm();
    for (int i = 0; i < k; ++i) {
      const int j = i + 1 == k ? 0 : i + 1;
      if (i == skip || j == skip) continue;
      const Vec<3>&a = mesh_.point(ring_[i]), &b = mesh_.point(ring_[j]);
      const Vec<3> normal = facet_normal<3>({p, a, b});
      const double v = normal.dot(p - x);
      const double l2 = px + (a - x).squaredNorm() + (b - x).squaredNorm() + (p - a).squaredNorm() +
                        (p - b).squaredNorm() + (a - b).squaredNorm();
      // 6^(3/2) sqrt(2) / 2: of the regular simplex, whose 6 V is 1/sqrt(2) of its edge's cube.
      const double shape = 20.78 * v / (l2 * std::sqrt(l2));
      worst = std::min(worst, shape);
      if (v < 0) inverted -= v;
      volume += v;
      if (inverted > limit) return {kNothing, 0};
    }
    if (worst > kGood) return {kJoinGood, -volume};
    if (worst > kFlat) return {kJoin, worst};
    return {kInverts, -inverted};
  }

  Step best_step(NodeId n) {
    Step best;
    if (!take_ring(n)) return best;
    const auto k = static_cast<int>(ring_.size());
    for (int j = 0; j < k; ++j) {
      const NodeId v = ring_[j];
      if (static_cast<int>(around_[v].size()) + k > kHub && left_ > 4 * kHub) continue;
      const double limit =
          best.worth.rank == kInverts ? -best.worth.value : std::numeric_limits<double>::infinity();
      const Worth w = worth_of(n, mesh_.point(v), j, limit);
      if (w.rank != kNothing && best.worth < w && may_join(j)) best = {w, v, Vec<3>::Zero()};
    }
    if (best.worth.rank < kNewPoint && mesh_.on_surface(n)) {
      const Step below = new_point(n);
      if (best.worth < below.worth) best = below;
    }
    return best;
  }

  const Vec<3>& target(const Step& step) const {
    return step.to ? mesh_.point(step.to) : step.point;
  }

  /// Whether the new facets of a step lie in the body, as far as their middles tell.
  bool stays_inside(NodeId n, const Step& step) {
    if (!take_ring(n)) return false;
    const Vec<3>& x = target(step);
    const auto k = static_cast<int>(ring_.size());
    const double slack = 1e-6 * surface_.diagonal();
    for (int i = 0; i < k; ++i) {
      const Vec<3>&a = mesh_.point(ring_[i]), &b = mesh_.point(ring_[(i + 1) % k]);
      if (ring_[i] == step.to) continue;
      if (surface_.signed_distance(0.5 * (a + x)) > slack) return false;
      if (surface_.signed_distance((a + b + x) / 3) > slack) return false;
    }
    return true;
  }

  double volume_of(NodeId n, const Step& step) const {
    double sum = 0;
    for (const int f : around_[n])
      sum += std::abs(facet_normal<3>({mesh_.point(facets_[f][0]), mesh_.point(facets_[f][1]),
                                       mesh_.point(facets_[f][2])})
                          .dot(mesh_.point(n) - target(step)));
    return sum;
  }

  /// Whether ring_[j] has no edge yet to the nodes it would get edges to.
  bool may_join(int j) {
    const auto k = static_cast<int>(ring_.size());
    const NodeId v = ring_[j];
    ++stamp_;
    for (const int f : around_[v])
      for (const NodeId m : facets_[f]) mark_[m] = stamp_;
    for (int i = 0; i < k; ++i) {
      if (i == j || i == (j + 1) % k || (i + 1) % k == j) continue;
      if (mark_[ring_[i]] == stamp_) return false;
    }
    if (k > 3) return true;
    // The facet that closes the hole must be new.
    const NodeId a = ring_[(j + 1) % 3], b = ring_[(j + 2) % 3];
    return std::none_of(around_[v].begin(), around_[v].end(), [&](int f) {
      const Facet& g = facets_[f];
      return std::count(g.begin(), g.end(), a) == 1 && std::count(g.begin(), g.end(), b) == 1;
    });
  }

  Step new_point(NodeId n) const {
    const auto k = static_cast<int>(ring_.size());
    const Vec<3>& p = mesh_.point(n);
    Vec<3> inward = Vec<3>::Zero();
    double edge = 0;
    for (int i = 0; i < k; ++i) {
      const Vec<3>&a = mesh_.point(ring_[i]), &b = mesh_.point(ring_[(i + 1) % k]);
      const Vec<3> ea = a - p, eb = b - p;
      const double angle = std::atan2(ea.cross(eb).norm(), ea.dot(eb));
      inward -= angle * facet_normal<3>({p, a, b}).stableNormalized();
      edge += ea.norm() / k;
    }
    if (!(inward.norm() > 0)) return {};
    inward.normalize();
    const auto hit = surface_.exit(p, inward, 1e-9 * surface_.diagonal());
    double depth = std::min(edge, hit ? kDepth * hit->t : edge);
    depth *= 1 - kSpread * random(n);
    for (int attempt = 0; attempt < 3; ++attempt, depth *= 0.3) {
      const Vec<3> x = p + depth * inward;
      const Worth w = worth_of(n, x, -1, 0);
      if (w.rank >= kJoin) return {{kNewPoint, w.value}, 0, x};
    }
    return {};
  }

  void take(NodeId n, const Step& step) {
    if (!take_ring(n)) return;
    NodeId v = step.to;
    if (v == 0) {
      v = mesh_.add_node(step.point);
      grow();
    }
    const std::vector<NodeId> ring = ring_;
    for (const int f : around_[n]) {
      Facet& nodes = facets_[f];
      const bool degenerate = std::find(nodes.begin(), nodes.end(), v) != nodes.end();
      if (!degenerate) out_.elements.push_back({nodes[1], nodes[0], nodes[2], v});
      for (const NodeId m : nodes)
        if (m != n && degenerate) std::erase(around_[m], f);
      if (degenerate) {
        alive_[f] = 0;
        --left_;
        continue;
      }
      for (NodeId& m : nodes)
        if (m == n) m = v;
      around_[v].push_back(f);
    }
    around_[n].clear();
    for (const NodeId m : ring) push(m);
    if (step.to == 0) push(v);
  }

  void push(NodeId n) {
    ++version_[n];
    if (around_[n].empty()) return;
    const Step step = best_step(n);
    if (step.worth.rank != kNothing) queue_.push({step.worth, n, version_[n]});
  }

  Bridged<3> out_;
  FoldedMesh<3>& mesh_;
  const Locator<3>& surface_;
  std::uint64_t seed_;
  std::vector<Facet> facets_;
  std::vector<char> alive_;
  std::size_t left_;
  std::vector<std::vector<int>> around_;  // [node] facets
  std::vector<unsigned> version_, mark_;
  unsigned stamp_ = 0;
  std::priority_queue<Entry> queue_;
  std::vector<NodeId> ring_;
  std::vector<std::array<NodeId, 2>> sides_;
};

}  // namespace

Bridged<3> peel(Bridged<3> boundary, FoldedMesh<3>& mesh, const Locator<3>& surface,
                std::uint64_t seed, const Progress& progress) {
  return Peeling(std::move(boundary), mesh, surface, seed).run(progress);
}

}  // namespace lamella
