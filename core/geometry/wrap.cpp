#include "core/geometry/wrap.h"

#include <cmath>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

#include "core/base/parallel.h"
#include "core/geometry/foot.h"
#include "core/geometry/locator.h"
#include "core/geometry/repair.h"
#include "core/geometry/self_intersection.h"
#include "core/geometry/thin_out.h"
#include "core/geometry/winding.h"

namespace lamella {
namespace {

using Facet = std::array<std::int32_t, 3>;
using Key = std::uint64_t;

// Corner c of a cube lies at (c & 1, c >> 1 & 1, c >> 2); edge e runs from corner kEdges[e][0]
// along axis e / 4. The corners of a face turn left seen from outside.
constexpr int kEdges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                               {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                              {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

int edge_between(int a, int b) {
  const int low = std::min(a, b);
  const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  for (int e = 4 * axis; e < 4 * axis + 4; ++e)
    if (kEdges[e][0] == low) return e;
  return -1;
}

/// Windings such that the volume is inside: alike within a shell, and outward for shells that no
/// other one is around.
Triangles oriented(const Triangles& in) {
  Triangles t = in;
  drop_degenerate(t);
  drop_duplicates(t);
  const Result<Shells> shells = orient(t, nullptr);
  if (!shells || shells->count == 0) return t;
  std::vector<std::vector<std::int32_t>> members(shells->count);
  std::vector<double> volume(shells->count, 0), area(shells->count, 0);
  std::vector<char> open(shells->count, 0);
  for_each_edge(edge_uses(t.facets), [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2)
      for (const EdgeUse& use : edge) open[shells->of_facet[use.facet]] = 1;
  });
  const Vec<3> origin = t.points[t.facets.empty() ? 0 : t.facets[0][0]];
  for (std::size_t f = 0; f < t.facets.size(); ++f)
    members[shells->of_facet[f]].push_back(static_cast<std::int32_t>(f));
  for (std::int32_t s = 0; s < shells->count; ++s) {
    Vec<3> center = Vec<3>::Zero();
    for (const std::int32_t f : members[s]) center += t.corners(f)[0] - origin;
    center = origin + center / static_cast<double>(members[s].size());
    for (const std::int32_t f : members[s]) {
      const auto p = t.corners(f);
      volume[s] += (p[0] - center).dot((p[1] - center).cross(p[2] - center));
      area[s] += 0.5 * facet_normal<3>(p).norm();
    }
  }
  const WindingNumber all(t.points, t.facets);
  std::vector<char> turn(shells->count, 0);
  for (std::int32_t s = 0; s < shells->count; ++s) {
    // A flat open shell has no inside of its own.
    if (volume[s] >= (open[s] ? -1e-3 * std::pow(area[s], 1.5) : 0)) continue;
    std::vector<Facet> mine;
    for (const std::int32_t f : members[s]) mine.push_back(t.facets[f]);
    const WindingNumber own(t.points, mine);
    const auto p = t.corners(members[s][0]);
    const Vec<3> x = (p[0] + p[1] + p[2]) / 3;
    turn[s] = all(x) - own(x) < 0.5;  // nothing is around it: no void
  }
  for (std::size_t f = 0; f < t.facets.size(); ++f)
    if (turn[shells->of_facet[f]]) std::swap(t.facets[f][1], t.facets[f][2]);
  return t;
}

/// Halves of a triangle, cut through its longest edge.
std::array<std::array<Vec<3>, 3>, 2> halves(const std::array<Vec<3>, 3>& p) {
  int k = 0;
  for (int e = 1; e < 3; ++e)
    if ((p[(e + 1) % 3] - p[e]).squaredNorm() > (p[(k + 1) % 3] - p[k]).squaredNorm()) k = e;
  const Vec<3>&a = p[k], &b = p[(k + 1) % 3], &c = p[(k + 2) % 3];
  const Vec<3> m = 0.5 * (a + b);
  return {{{a, m, c}, {m, b, c}}};
}

/// The same surface in facets not longer than `longest`, which cluster well: they need not fit
/// together.
Triangles chopped(const Triangles& t, double longest) {
  Triangles out;
  std::vector<std::array<Vec<3>, 3>> todo;
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    todo.assign(1, t.corners(f));
    while (!todo.empty()) {
      const auto p = todo.back();
      todo.pop_back();
      const double square = std::max(
          {(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
      if (square <= longest * longest) {
        const auto first = static_cast<std::int32_t>(out.points.size());
        out.points.insert(out.points.end(), p.begin(), p.end());
        out.facets.push_back({first, first + 1, first + 2});
        continue;
      }
      for (const auto& half : halves(p)) todo.push_back(half);
    }
  }
  return out;
}

/// Grid of cubes: which vertices lie inside, for the cells that the boundary passes.
class Grid {
 public:
  Grid(const Triangles& t, double spacing)
      : t_(t), h(spacing), winding_(winding_of(chopped(t, 5 * spacing))) {
    Vec<3> low = Vec<3>::Constant(1e300), high = -low;
    for (const Facet& f : t.facets)
      for (const std::int32_t v : f) {
        low = low.cwiseMin(t.points[v]);
        high = high.cwiseMax(t.points[v]);
      }
    // Planes of a part are seldom this far from its box.
    origin_ = low - 2.3719 * h * Vec<3>::Ones();
    for (int k = 0; k < 3; ++k) n_[k] = static_cast<Key>((high[k] - low[k]) / h) + 6;
  }

  /// Finds the cells; false when cancelled.
  bool fill(const Progress& progress) {
    std::vector<Key> frontier = cells_at_facets();
    while (!frontier.empty()) {
      std::vector<Key> fresh;
      for (const Key c : frontier)
        for (int k = 0; k < 8; ++k) {
          const Key v = vertex(c, k);
          if (id_.emplace(v, static_cast<std::int32_t>(id_.size())).second) fresh.push_back(v);
        }
      const std::size_t before = value_.size();
      value_.resize(before + fresh.size());
      if (!parallel_each(fresh.size(), 0, progress, [&](std::size_t i) {
            value_[before + i] =
                on_border(fresh[i]) ? 0.0f : static_cast<float>(winding_(place(fresh[i])));
          }))
        return false;
      for (const Key c : frontier) known_.insert(c);
      cells_.insert(cells_.end(), frontier.begin(), frontier.end());
      // The boundary leaves a cell through the faces with both signs.
      std::vector<Key> next;
      for (const Key c : frontier) {
        const std::array<Key, 3> at = split(c);
        for (int face = 0; face < 6; ++face) {
          int count = 0;
          for (const int k : kFaces[face]) count += inside(c, k);
          if (count == 0 || count == 4) continue;
          const int axis = face < 2 ? 2 : face < 4 ? 1 : 0;
          const bool up = face % 2 == 1;
          if ((up && at[axis] + 2 >= n_[axis]) || (!up && at[axis] == 0)) continue;
          const Key g = up ? c + stride(axis) : c - stride(axis);
          if (known_.count(g) == 0) next.push_back(g);
        }
      }
      std::sort(next.begin(), next.end());
      next.erase(std::unique(next.begin(), next.end()), next.end());
      frontier = std::move(next);
    }
    std::sort(cells_.begin(), cells_.end());
    return true;
  }

  const std::vector<Key>& cells() const { return cells_; }
  /// A vertex has the number of the cell above it.
  Key vertex(Key cell, int corner) const {
    return cell + (corner & 1) + (corner >> 1 & 1) * stride(1) + (corner >> 2) * stride(2);
  }
  Key stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? n_[0] : n_[0] * n_[1]; }
  Vec<3> place(Key v) const {
    const std::array<Key, 3> at = split(v);
    return origin_ + h * Vec<3>(static_cast<double>(at[0]), static_cast<double>(at[1]),
                                static_cast<double>(at[2]));
  }
  float value(Key v) const { return value_[id_.at(v)]; }
  bool inside(Key cell, int corner) const { return value(vertex(cell, corner)) > 0.5f; }
  double winding(const Vec<3>& x) const { return winding_(x); }
  double spacing() const { return h; }

 private:
  static WindingNumber winding_of(const Triangles& t) { return {t.points, t.facets}; }

  std::array<Key, 3> split(Key v) const {
    return {v % n_[0], v / n_[0] % n_[1], v / (n_[0] * n_[1])};
  }
  bool on_border(Key v) const {
    const std::array<Key, 3> at = split(v);
    for (int k = 0; k < 3; ++k)
      if (at[k] == 0 || at[k] + 1 >= n_[k]) return true;
    return false;
  }

  std::vector<Key> cells_at_facets() const {
    std::vector<Key> cells;
    std::vector<std::array<Vec<3>, 3>> todo;
    for (std::size_t f = 0; f < t_.facets.size(); ++f) {
      const std::size_t first = cells.size();
      todo.assign(1, t_.corners(f));
      while (!todo.empty()) {
        const auto p = todo.back();
        todo.pop_back();
        const Vec<3> low = (p[0].cwiseMin(p[1]).cwiseMin(p[2]) - origin_) / h;
        const Vec<3> high = (p[0].cwiseMax(p[1]).cwiseMax(p[2]) - origin_) / h;
        if ((high - low).maxCoeff() > 4) {
          for (const auto& half : halves(p)) todo.push_back(half);
          continue;
        }
        std::array<Key, 3> a, b;
        for (int k = 0; k < 3; ++k) {
          a[k] = static_cast<Key>(low[k]);
          b[k] = static_cast<Key>(high[k]);
        }
        for (Key z = a[2]; z <= b[2]; ++z)
          for (Key y = a[1]; y <= b[1]; ++y)
            for (Key x = a[0]; x <= b[0]; ++x) {
              const Key c = x + n_[0] * (y + n_[1] * z);
              const Vec<3> middle = place(c) + 0.5 * h * Vec<3>::Ones();
              // Half the diagonal of a cell is 0.866 h.
              if ((foot_on_facet(p, middle).point - middle).squaredNorm() <= 0.8 * h * h)
                cells.push_back(c);
            }
      }
      std::sort(cells.begin() + static_cast<std::ptrdiff_t>(first), cells.end());
      cells.erase(std::unique(cells.begin() + static_cast<std::ptrdiff_t>(first), cells.end()),
                  cells.end());
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
  }

  const Triangles& t_;
  double h;
  WindingNumber winding_;
  Vec<3> origin_;
  std::array<Key, 3> n_;
  std::unordered_map<Key, std::int32_t> id_;
  std::vector<float> value_;
  std::unordered_set<Key> known_;
  std::vector<Key> cells_;
};

/// Where the boundary crosses an edge of the grid.
struct Crossing {
  Vec<3> point;
  Vec<3> normal;  // of the facet there; zero across a hole
};

/// The boundary within one cell: a ring of crossings, and a point amid them where the ring is long
/// or the surface has an edge or a corner.
struct Ring {
  std::vector<std::int32_t> crossings;
  Vec<3> middle;   // mean of the crossings
  Vec<3> feature;  // where the planes of the facets meet
  bool sharp = false;
  std::int32_t center = -1;  // vertex, once built
};

class Surfacer {
 public:
  Surfacer(const Grid& grid, const Locator<3>& file) : grid_(grid), file_(file) {}

  bool find(const Progress& progress) {
    std::vector<Key> edges;
    for (const Key c : grid_.cells())
      for (int e = 0; e < 12; ++e)
        if (grid_.inside(c, kEdges[e][0]) != grid_.inside(c, kEdges[e][1]))
          edges.push_back(3 * grid_.vertex(c, kEdges[e][0]) + e / 4);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    crossings_.resize(edges.size());
    halfway_.resize(edges.size());
    if (!parallel_each(edges.size(), 0, progress.portion(0, 0.7), [&](std::size_t i) {
          crossings_[i] = cross(edges[i]);
          const Key v = edges[i] / 3;
          halfway_[i] = 0.5 * (grid_.place(v) +
                               grid_.place(v + grid_.stride(static_cast<int>(edges[i] % 3))));
        }))
      return false;
    for (const Key c : grid_.cells()) add_rings(c, edges);
    return parallel_each(rings_.size(), 0, progress.portion(0.7, 1),
                         [&](std::size_t r) { find_feature(rings_[r]); });
  }

  /// The surface without what was undone; `bridging` tells vertices that no facet holds.
  Triangles build() {
    Triangles t;
    bridging.clear();
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      t.points.push_back(undone_.count(static_cast<std::int32_t>(i)) > 0 ? halfway_[i]
                                                                         : crossings_[i].point);
      bridging.push_back(crossings_[i].normal.isZero());
    }
    const auto edge_points = static_cast<std::int32_t>(t.points.size());
    ring_of_.clear();
    for (std::size_t r = 0; r < rings_.size(); ++r) {
      Ring& ring = rings_[r];
      const std::size_t n = ring.crossings.size();
      ring.center = -1;
      if (!ring.sharp && n == 3) {
        t.facets.push_back({ring.crossings[0], ring.crossings[1], ring.crossings[2]});
        continue;
      }
      if (!ring.sharp && n == 4) {
        const auto& c = ring.crossings;
        const auto square = [&](int i, int j) {
          return (t.points[c[i]] - t.points[c[j]]).squaredNorm();
        };
        const int s = square(0, 2) <= square(1, 3) ? 0 : 1;
        t.facets.push_back({c[s], c[s + 1], c[s + 2]});
        t.facets.push_back({c[s + 2], c[(s + 3) % 4], c[s]});
        continue;
      }
      ring.center = static_cast<std::int32_t>(t.points.size());
      t.points.push_back(ring.sharp ? ring.feature : ring.middle);
      bridging.push_back(bridging[ring.crossings[0]]);
      ring_of_.push_back(static_cast<std::int32_t>(r));
      for (std::size_t k = 0; k < n; ++k)
        t.facets.push_back({ring.center, ring.crossings[k], ring.crossings[(k + 1) % n]});
    }
    join_features(t, edge_points);
    return t;
  }

  /// Gives up the sharp points of facets that cross, or moves their points to the grid's middles.
  void undo(const Triangles& t, const std::vector<std::array<std::int32_t, 2>>& pairs) {
    const auto edge_points = static_cast<std::int32_t>(crossings_.size());
    for (const auto& pair : pairs) {
      bool gave_up = false;
      for (const std::int32_t f : pair)
        for (const std::int32_t v : t.facets[f])
          if (v >= edge_points && rings_[ring_of_[v - edge_points]].sharp) {
            rings_[ring_of_[v - edge_points]].sharp = false;
            gave_up = true;
          }
      if (gave_up) continue;
      for (const std::int32_t f : pair)
        for (const std::int32_t v : t.facets[f])
          if (v < edge_points) undone_.insert(v);
    }
    for (Ring& ring : rings_)
      if (std::any_of(ring.crossings.begin(), ring.crossings.end(),
                      [&](std::int32_t c) { return undone_.count(c) > 0; })) {
        ring.sharp = false;
        ring.middle.setZero();
        for (const std::int32_t c : ring.crossings)
          ring.middle += (undone_.count(c) > 0 ? halfway_[c] : crossings_[c].point) /
                         static_cast<double>(ring.crossings.size());
      }
  }

  std::vector<char> bridging;

 private:
  Crossing cross(Key edge) const {
    const int axis = static_cast<int>(edge % 3);
    const double h = grid_.spacing();
    const Key low = edge / 3, high = low + grid_.stride(axis);
    const bool up = grid_.value(low) > 0.5f;
    const Key from = up ? low : high, to = up ? high : low;  // from inside to outside
    const Vec<3> a = grid_.place(from);
    const Vec<3> u = (up ? 1.0 : -1.0) * Vec<3>::Unit(axis);
    const auto at = [&](double t) -> Vec<3> { return a + std::clamp(t, 0.01 * h, 0.99 * h) * u; };
    double begin = -1e-9 * h;
    for (int k = 0; k < 64; ++k) {
      const auto hit = file_.exit(a, u, begin, h * (1 + 1e-9));
      if (!hit) break;
      const double beyond = hit->t + 1e-5 * h;
      if (beyond >= h || grid_.winding(a + beyond * u) < 0.5)
        return {at(hit->t), file_.normal(hit->facet)};
      begin = beyond;
    }
    const double wa = grid_.value(from), wb = grid_.value(to);
    const Vec<3> x = at(h * (wa - 0.5) / (wa - wb));
    // A facet wound inward is no exit, but near.
    if (const auto near = file_.nearest(x, 0.5 * h)) {
      const double t = (near->point - a).dot(u);
      if (t > 0 && t < h && (near->point - a - t * u).norm() < 0.05 * h)
        return {at(t), file_.normal(near->facet)};
    }
    return {x, Vec<3>::Zero()};
  }

  void add_rings(Key c, const std::vector<Key>& edges) {
    std::array<bool, 8> in;
    int count = 0;
    for (int k = 0; k < 8; ++k) count += in[k] = grid_.inside(c, k);
    if (count == 0 || count == 8) return;
    // Each run of inside corners around a face is cut off, from the edge that enters it to the one
    // that leaves it: both cells at the face agree.
    std::array<int, 12> next;
    next.fill(-1);
    for (const auto& face : kFaces) {
      for (int k = 0; k < 4; ++k) {
        if (in[face[k]] || !in[face[(k + 1) % 4]]) continue;
        int j = k + 1;
        while (in[face[(j + 1) % 4]]) ++j;
        next[edge_between(face[k], face[(k + 1) % 4])] =
            edge_between(face[j % 4], face[(j + 1) % 4]);
      }
    }
    for (int e = 0; e < 12; ++e) {
      if (next[e] < 0) continue;
      Ring ring;
      ring.middle.setZero();
      for (int at = e; next[at] >= 0;) {
        const Key key = 3 * grid_.vertex(c, kEdges[at][0]) + at / 4;
        ring.crossings.push_back(static_cast<std::int32_t>(
            std::lower_bound(edges.begin(), edges.end(), key) - edges.begin()));
        ring.middle += crossings_[ring.crossings.back()].point;
        const int then = next[at];
        next[at] = -1;
        at = then;
      }
      ring.middle /= static_cast<double>(ring.crossings.size());
      ring.feature = grid_.place(c) + 0.5 * grid_.spacing() * Vec<3>::Ones();  // for now: the cell
      rings_.push_back(std::move(ring));
    }
  }

  void find_feature(Ring& ring) const {
    constexpr double kSharp = 0.88;  // cosine of the largest angle of a smooth place
    constexpr double kFlat = 0.02;   // of the largest eigenvalue: no plane in this direction
    const Vec<3> cell = ring.feature;
    double least = 1;
    for (const std::int32_t i : ring.crossings)
      for (const std::int32_t j : ring.crossings) {
        if (crossings_[i].normal.isZero()) return;
        least = std::min(least, crossings_[i].normal.dot(crossings_[j].normal));
      }
    if (least > kSharp) return;
    Mat<3> a = Mat<3>::Zero();
    Vec<3> b = Vec<3>::Zero();
    for (const std::int32_t i : ring.crossings) {
      const Vec<3>& n = crossings_[i].normal;
      a += n * n.transpose();
      b += n * n.dot(crossings_[i].point - ring.middle);
    }
    const Eigen::SelfAdjointEigenSolver<Mat<3>> solver(a);
    Vec<3> move = Vec<3>::Zero();
    for (int k = 0; k < 3; ++k) {
      const double l = solver.eigenvalues()[k];
      if (l > kFlat * solver.eigenvalues()[2])
        move += solver.eigenvectors().col(k) * (solver.eigenvectors().col(k).dot(b) / l);
    }
    const Vec<3> x = ring.middle + move;
    if ((x - cell).cwiseAbs().maxCoeff() > 0.55 * grid_.spacing()) return;
    ring.feature = x;
    ring.sharp = true;
  }

  /// Edges between two cells whose sharp points face each other are flipped to join these.
  void join_features(Triangles& t, std::int32_t edge_points) const {
    const auto sharp = [&](std::int32_t v) {
      return v >= edge_points && rings_[ring_of_[v - edge_points]].sharp;
    };
    const std::vector<EdgeUse> uses = edge_uses(t.facets);
    std::unordered_set<Key> made;
    std::vector<char> changed(t.facets.size(), 0);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
      if (edge.size() != 2 || sharp(edge[0].a) || sharp(edge[0].b)) return;
      const std::int32_t f = edge[0].facet, g = edge[1].facet;
      if (changed[f] || changed[g]) return;
      const auto apex = [&](std::int32_t of) {
        for (const std::int32_t v : t.facets[of])
          if (v != edge[0].a && v != edge[0].b) return v;
        return t.facets[of][0];
      };
      const std::int32_t p = apex(f), q = apex(g);
      if (p == q || !sharp(p) || !sharp(q) || has_edge(uses, p, q)) return;
      if (!made.insert((static_cast<Key>(std::min(p, q)) << 32) | static_cast<Key>(std::max(p, q)))
               .second)
        return;
      const std::int32_t a = edge[0].forward ? edge[0].a : edge[0].b;
      const std::int32_t b = edge[0].forward ? edge[0].b : edge[0].a;
      t.facets[f] = {a, q, p};
      t.facets[g] = {q, b, p};
      changed[f] = changed[g] = 1;
    });
  }

  const Grid& grid_;
  const Locator<3>& file_;
  std::vector<Crossing> crossings_;
  std::vector<Vec<3>> halfway_;
  std::vector<Ring> rings_;
  std::vector<std::int32_t> ring_of_;  // [vertex - number of crossings]
  std::unordered_set<std::int32_t> undone_;
};

/// Drops shells of less than two cells. Returns how many.
std::size_t drop_specks(Triangles& t, double least) {
  const Result<Shells> shells = orient(t, nullptr);
  if (!shells) return 0;
  std::vector<double> volume(shells->count, 0);
  std::vector<Vec<3>> origin(shells->count);
  std::vector<char> seen(shells->count, 0);
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    const std::int32_t s = shells->of_facet[f];
    const auto p = t.corners(f);
    if (!seen[s]) origin[s] = p[0];
    seen[s] = 1;
    volume[s] += (p[0] - origin[s]).dot((p[1] - origin[s]).cross(p[2] - origin[s])) / 6;
  }
  std::size_t f = 0;
  std::erase_if(t.facets,
                [&](const Facet&) { return std::abs(volume[shells->of_facet[f++]]) < least; });
  return static_cast<std::size_t>(
      std::count_if(volume.begin(), volume.end(), [&](double v) { return std::abs(v) < least; }));
}

void drop_unused(Triangles& t, std::vector<char>& tag) {
  std::vector<std::int32_t> id(t.points.size(), -1);
  std::vector<Vec<3>> points;
  std::vector<char> kept;
  for (Facet& f : t.facets)
    for (std::int32_t& v : f) {
      if (id[v] < 0) {
        id[v] = static_cast<std::int32_t>(points.size());
        points.push_back(t.points[v]);
        kept.push_back(tag[v]);
      }
      v = id[v];
    }
  t.points = std::move(points);
  tag = std::move(kept);
}

void farther(Deviation& worst, double distance, const Vec<3>& place) {
  if (distance > worst.distance) worst = {distance, place};
}

void measure(const Triangles& file, const Locator<3>& file_locator, const Grid& grid,
             const std::vector<char>& bridging, Wrapped& out, const Progress& progress) {
  const Triangles& w = out.surface;
  std::vector<Deviation> each(w.facets.size());
  std::vector<double> bridged(w.facets.size(), 0);
  parallel_each(w.facets.size(), 0, progress.portion(0, 0.5), [&](std::size_t f) {
    const auto p = w.corners(f);
    if (bridging[w.facets[f][0]] || bridging[w.facets[f][1]] || bridging[w.facets[f][2]]) {
      bridged[f] = 0.5 * facet_normal<3>(p).norm();
      return;
    }
    for (const Vec<3>& x : {p[0], p[1], p[2], Vec<3>((p[0] + p[1]) / 2), Vec<3>((p[1] + p[2]) / 2),
                            Vec<3>((p[2] + p[0]) / 2), Vec<3>((p[0] + p[1] + p[2]) / 3)})
      farther(each[f], std::sqrt(file_locator.nearest(x)->distance2), x);
  });
  for (const Deviation& d : each) farther(out.to_file, d.distance, d.place);
  out.bridged_area = std::accumulate(bridged.begin(), bridged.end(), 0.0);

  const Locator<3> mine(plain_surface(w));
  const double h = grid.spacing(), off = 1e-3 * h;
  const Triangles pieces = chopped(file, 0.7 * h);
  each.assign(pieces.facets.size(), {});
  parallel_each(pieces.facets.size(), 0, progress.portion(0.5, 0.8), [&](std::size_t f) {
    const auto p = pieces.corners(f);
    const Vec<3> x = (p[0] + p[1] + p[2]) / 3;
    each[f] = {std::sqrt(mine.nearest(x)->distance2), x};
  });
  // Walls inside the volume do not count: the farthest first, until one is found that bounds it.
  std::vector<std::size_t> order(each.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t f, std::size_t g) {
    return each[f].distance != each[g].distance ? each[f].distance > each[g].distance : f < g;
  });
  constexpr std::size_t kBlock = 256;
  std::array<char, kBlock> bounds;
  for (std::size_t first = 0; first < order.size() && !progress.cancelled(); first += kBlock) {
    const std::size_t count = std::min(kBlock, order.size() - first);
    parallel_each(
        count, 0, progress,
        [&](std::size_t k) {
          const std::size_t f = order[first + k];
          const Vec<3> n = facet_normal<3>(pieces.corners(f)).stableNormalized();
          const Vec<3>& x = each[f].place;
          bounds[k] = (grid.winding(x + off * n) > 0.5) != (grid.winding(x - off * n) > 0.5);
        },
        8);
    const auto end = bounds.begin() + static_cast<std::ptrdiff_t>(count);
    const auto found = std::find(bounds.begin(), end, 1);
    if (found == end) continue;
    out.from_file = each[order[first + static_cast<std::size_t>(found - bounds.begin())]];
    return;
  }
}

}  // namespace

Result<Wrapped> wrap(const Triangles& triangles, const WrapParams& params,
                     const Progress& progress) {
  const Triangles file = oriented(triangles);
  const Error nothing{Code::bad_input, "the surface encloses nothing that could be wrapped",
                      "Use a finer grid, or export the part again."};
  if (file.facets.empty()) return nothing;
  double area = 0;
  std::vector<Vec<3>> used;
  for (std::size_t f = 0; f < file.facets.size(); ++f) {
    const auto p = file.corners(f);
    area += 0.5 * facet_normal<3>(p).norm();
    used.insert(used.end(), p.begin(), p.end());
  }
  const double diagonal = diagonal_of(used);
  if (!(diagonal > 0)) return nothing;
  Wrapped out;
  // About 1 kB for each cell that the surface passes.
  const double coarsest = std::sqrt(area * 1e-3 / std::max(1.0, params.memory));
  out.spacing = std::max(params.spacing > 0 ? params.spacing : diagonal / 160, coarsest);

  Grid grid(file, out.spacing);
  if (!grid.fill(progress.portion(0, 0.3))) return cancelled_error();
  const Locator<3> locator(plain_surface(file));
  Surfacer surfacer(grid, locator);
  if (!surfacer.find(progress.portion(0.3, 0.5))) return cancelled_error();
  constexpr int kRounds = 20;
  for (int round = 0;; ++round) {
    out.surface = surfacer.build();
    const auto pairs =
        self_intersecting_pairs(out.surface.points, out.surface.facets, progress.portion(0.5, 0.6));
    if (progress.cancelled()) return cancelled_error();
    if (pairs.empty()) break;
    if (round == kRounds)
      return Error{Code::failed,
                   "the wrap of the surface still crosses itself near " +
                       place_text(out.surface.points[out.surface.facets[pairs[0][0]][0]]),
                   "Use another spacing of the grid."};
    surfacer.undo(out.surface, pairs);
  }
  out.specks = drop_specks(out.surface, 2 * std::pow(out.spacing, 3));
  if (out.surface.facets.empty()) return nothing;
  std::vector<char> bridging = surfacer.bridging;
  drop_unused(out.surface, bridging);
  const double thinning = params.thinning < 0 ? 0.05 * out.spacing : params.thinning;
  if (thinning > 0) {
    thin_out(out.surface, {thinning, 12 * out.spacing}, progress.portion(0.6, 0.8));
    drop_unused(out.surface, bridging);
  }
  if (progress.cancelled()) return cancelled_error();
  measure(file, locator, grid, bridging, out, progress.portion(0.8, 1));
  if (progress.cancelled()) return cancelled_error();
  return out;
}

}  // namespace lamella
