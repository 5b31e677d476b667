#include "core/geometry/self_intersection.h"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"

namespace lamella {
namespace {

using Corners = std::array<Vec<3>, 3>;

struct Box3 {
  Vec<3> low = Vec<3>::Constant(1e300);
  Vec<3> high = Vec<3>::Constant(-1e300);
  void add(const Box3& b) {
    low = low.cwiseMin(b.low);
    high = high.cwiseMax(b.high);
  }
  bool meets(const Box3& b) const {
    return (low.array() <= b.high.array()).all() && (b.low.array() <= high.array()).all();
  }
};

/// Binary tree over boxes: node n holds items [begin, end), its children are n + 1 and `second`.
struct Tree {
  struct Node {
    Box3 box;
    std::int32_t begin, end;
    std::int32_t second;  // 0 in a leaf
  };
  std::vector<Node> nodes;
  std::vector<std::int32_t> items;
  const std::vector<Box3>& boxes;

  explicit Tree(const std::vector<Box3>& all) : items(all.size()), boxes(all) {
    std::iota(items.begin(), items.end(), 0);
    if (!items.empty()) build(0, static_cast<std::int32_t>(items.size()));
  }

  void build(std::int32_t begin, std::int32_t end) {
    constexpr std::int32_t kLeaf = 8;
    const std::size_t me = nodes.size();
    nodes.push_back({{}, begin, end, 0});
    for (std::int32_t i = begin; i < end; ++i) nodes[me].box.add(boxes[items[i]]);
    if (end - begin <= kLeaf) return;
    int axis = 0;
    (nodes[me].box.high - nodes[me].box.low).maxCoeff(&axis);
    const std::int32_t middle = begin + (end - begin) / 2;
    std::nth_element(items.begin() + begin, items.begin() + middle, items.begin() + end,
                     [&](std::int32_t i, std::int32_t j) {
                       const double x = boxes[i].low[axis] + boxes[i].high[axis];
                       const double y = boxes[j].low[axis] + boxes[j].high[axis];
                       return x != y ? x < y : i < j;
                     });
    build(begin, middle);
    nodes[me].second = static_cast<std::int32_t>(nodes.size());
    build(middle, end);
  }
};

double six_volumes(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c, const Vec<3>& d) {
  return (a - d).dot((b - d).cross(c - d));
}

/// Segment pq crosses the inside of the triangle, beyond the rounding of the determinants.
bool crosses(const Vec<3>& p, const Vec<3>& q, const Corners& t, double noise) {
  const double below = six_volumes(t[0], t[1], t[2], p);
  const double above = six_volumes(t[0], t[1], t[2], q);
  if (std::abs(below) <= noise || std::abs(above) <= noise || (below > 0) == (above > 0)) {
    return false;
  }
  double side[3];
  for (int k = 0; k < 3; ++k) side[k] = six_volumes(p, q, t[k], t[(k + 1) % 3]);
  for (const double s : side) {
    if (std::abs(s) <= noise || (s > 0) != (side[0] > 0)) return false;
  }
  return true;
}

class Judge {
 public:
  Judge(const std::vector<Vec<3>>& points, const std::vector<std::array<std::int32_t, 3>>& facets)
      : points_(points), facets_(facets) {}

  bool intersect(std::int32_t f, std::int32_t g) const {
    const auto& a = facets_[f];
    const auto& b = facets_[g];
    int common = 0;
    int last_a = 0;
    int last_b = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (a[i] != b[j]) continue;
        ++common;
        last_a = i;
        last_b = j;
      }
    }
    if (common == 3) return true;
    const Corners p = corners(a);
    const Corners q = corners(b);
    if (common == 2) return folded(p, q);
    double reach = 0;
    for (int k = 0; k < 3; ++k) {
      reach = std::max({reach, (p[k] - p[0]).norm(), (q[k] - p[0]).norm()});
    }
    const double noise = 1e-14 * reach * reach * reach;
    if (common == 1) {
      return crosses(p[(last_a + 1) % 3], p[(last_a + 2) % 3], q, noise) ||
             crosses(q[(last_b + 1) % 3], q[(last_b + 2) % 3], p, noise);
    }
    for (int k = 0; k < 3; ++k) {
      if (crosses(p[k], p[(k + 1) % 3], q, noise) || crosses(q[k], q[(k + 1) % 3], p, noise)) {
        return true;
      }
    }
    return false;
  }

 private:
  Corners corners(const std::array<std::int32_t, 3>& f) const {
    return {points_[f[0]], points_[f[1]], points_[f[2]]};
  }
  /// Two facets at one edge with opposite normals lie on each other.
  static bool folded(const Corners& p, const Corners& q) {
    const Vec<3> n = facet_normal<3>(p).stableNormalized();
    const Vec<3> m = facet_normal<3>(q).stableNormalized();
    return n.dot(m) < 0 && n.cross(m).norm() < 1e-6;
  }

  const std::vector<Vec<3>>& points_;
  const std::vector<std::array<std::int32_t, 3>>& facets_;
};

std::vector<Box3> boxes_of(const std::vector<Vec<3>>& points,
                           const std::vector<std::array<std::int32_t, 3>>& facets) {
  std::vector<Box3> boxes(facets.size());
  for (std::size_t f = 0; f < boxes.size(); ++f)
    for (const std::int32_t v : facets[f]) boxes[f].add({points[v], points[v]});
  return boxes;
}

/// Calls found(g) for every facet g > f that crosses f.
template <class Found>
void partners(const Tree& tree, const Judge& judge, std::int32_t f,
              std::vector<std::int32_t>& stack, Found&& found) {
  const Box3& box = tree.boxes[f];
  stack.assign(1, 0);
  while (!stack.empty()) {
    const std::int32_t n = stack.back();
    stack.pop_back();
    const Tree::Node& node = tree.nodes[n];
    if (!node.box.meets(box)) continue;
    if (node.second > 0) {
      stack.push_back(node.second);
      stack.push_back(n + 1);
      continue;
    }
    for (std::int32_t i = node.begin; i < node.end; ++i) {
      const std::int32_t g = tree.items[i];
      if (g > f && tree.boxes[g].meets(box) && judge.intersect(f, g)) found(g);
    }
  }
}

}  // namespace

SelfIntersections find_self_intersections(const ReferenceSurface<3>& surface,
                                          const Progress& progress) {
  const std::vector<Box3> boxes = boxes_of(surface.points, surface.facets);
  const Tree tree(boxes);
  const Judge judge(surface.points, surface.facets);
  SelfIntersections found;
  std::vector<std::int32_t> stack;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(boxes.size()); ++f) {
    if (f % 1024 == 0 && progress.cancelled()) break;
    partners(tree, judge, f, stack, [&](std::int32_t) {
      if (found.pairs++ == 0) found.place = surface.points[surface.facets[f][0]];
    });
  }
  return found;
}

std::vector<std::array<std::int32_t, 2>> self_intersecting_pairs(
    const std::vector<Vec<3>>& points, const std::vector<std::array<std::int32_t, 3>>& facets,
    const Progress& progress) {
  const std::vector<Box3> boxes = boxes_of(points, facets);
  const Tree tree(boxes);
  const Judge judge(points, facets);
  constexpr std::size_t kBlock = 256;
  std::vector<std::vector<std::array<std::int32_t, 2>>> blocks((facets.size() + kBlock - 1) /
                                                               kBlock);
  parallel_each(
      blocks.size(), 0, progress,
      [&](std::size_t b) {
        std::vector<std::int32_t> stack;
        for (std::size_t i = b * kBlock; i < std::min(facets.size(), (b + 1) * kBlock); ++i) {
          const auto f = static_cast<std::int32_t>(i);
          const std::size_t first = blocks[b].size();
          partners(tree, judge, f, stack, [&](std::int32_t g) { blocks[b].push_back({f, g}); });
          std::sort(blocks[b].begin() + static_cast<std::ptrdiff_t>(first), blocks[b].end());
        }
      },
      1);
  std::vector<std::array<std::int32_t, 2>> all;
  for (const auto& block : blocks) all.insert(all.end(), block.begin(), block.end());
  return all;
}

}  // namespace lamella
