#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "core/base/progress.h"
#include "core/geometry/simplex.h"

namespace lamella {

/// Axis-aligned box, mm; empty as built.
template <int D>
struct Box {
  Vec<D> lo = Vec<D>::Constant(std::numeric_limits<double>::infinity());
  Vec<D> hi = Vec<D>::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec<D>& p) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  void add(const Box& b) {
    lo = lo.cwiseMin(b.lo);
    hi = hi.cwiseMax(b.hi);
  }
  /// Half the measure of the boundary: what the surface area heuristic weighs.
  double half_area() const {
    const Vec<D> e = (hi - lo).cwiseMax(0.0);
    if constexpr (D == 2) return e[0] + e[1];
    if constexpr (D == 3) return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
    if constexpr (D == 4) return e[0] * e[1] * (e[2] + e[3]) + e[2] * e[3] * (e[0] + e[1]);
  }
};

/// Flat four-wide bounding volume hierarchy built by a binned surface area heuristic.
///
/// The boxes are float, rounded outward, and every query widens them by its own rounding: a box is
/// never missed, and what is inside a leaf is decided in double by the caller. A leaf is a block of
/// up to four primitives, `order[4 b .. 4 b + 3]`, a short block repeating its last one.
template <int D>
class Bvh {
 public:
  static constexpr int kWide = 4;
  /// Node index when >= 0, else block `~ref`.
  using Ref = std::int32_t;
  static constexpr Ref kNothing = std::numeric_limits<Ref>::max();

  explicit Bvh(const Vec<D>& center = Vec<D>::Zero()) : center_(center) {}

  /// Adds a tree over `items` (indices into `boxes`, reordered) and returns its root. A cancelled
  /// tree lacks items: ask `progress` before it is used.
  Ref build(const std::vector<Box<D>>& boxes, std::span<std::int32_t> items,
            const Progress& progress = {});

  const std::vector<std::int32_t>& order() const { return order_; }

  /// Visits blocks by growing distance while it is below `bound2` (mm^2), which `visit(block)` may
  /// lower.
  template <class Visit>
  void near(Ref root, const Vec<D>& x, double& bound2, Visit&& visit) const;

  /// Visits blocks along the ray from x by growing entry, as long as it is below `t_max`, which
  /// `visit(block)` may lower.
  template <class Visit>
  void along(Ref root, const Vec<D>& x, const Vec<D>& u, double& t_max, Visit&& visit) const;

 private:
  static constexpr int kBins = 16;
  static constexpr int kStack = 320;
  static constexpr int kDeep = 60;  // from here on split at the median: bounds the stack

  struct Node {
    alignas(16) float bound[2][D][kWide];  // lower, upper
    Ref child[kWide];
  };

  Ref make_block(std::span<const std::int32_t> items);
  Ref make_node(const std::vector<Box<D>>& boxes, std::span<std::int32_t> items, int depth,
                const Progress& progress);
  std::size_t split(const std::vector<Box<D>>& boxes, std::span<std::int32_t> items,
                    bool median) const;

  Vec<D> center_;
  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
};

template <int D>
typename Bvh<D>::Ref Bvh<D>::build(const std::vector<Box<D>>& boxes, std::span<std::int32_t> items,
                                   const Progress& progress) {
  if (items.empty()) return kNothing;
  if (items.size() <= kWide) return make_block(items);
  return make_node(boxes, items, 0, progress);
}

template <int D>
typename Bvh<D>::Ref Bvh<D>::make_block(std::span<const std::int32_t> items) {
  const auto block = static_cast<Ref>(order_.size() / kWide);
  for (std::size_t k = 0; k < kWide; ++k) order_.push_back(items[std::min(k, items.size() - 1)]);
  return ~block;
}

template <int D>
typename Bvh<D>::Ref Bvh<D>::make_node(const std::vector<Box<D>>& boxes,
                                       std::span<std::int32_t> items, int depth,
                                       const Progress& progress) {
  if (progress.cancelled()) return make_block(items.first(kWide));
  struct Group {
    std::span<std::int32_t> items;
    Box<D> box;
  };
  const auto bounded = [&](std::span<std::int32_t> part) {
    Group p{part, {}};
    for (const auto i : part) p.box.add(boxes[i]);
    return p;
  };
  std::vector<Group> parts{bounded(items)};
  while (parts.size() < kWide) {
    int widest = -1;
    double cost = -1;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const double c = parts[k].box.half_area();
      if (parts[k].items.size() > kWide && c > cost) {
        widest = static_cast<int>(k);
        cost = c;
      }
    }
    if (widest < 0) break;
    const auto whole = parts[widest].items;
    const auto at = split(boxes, whole, depth > kDeep);
    parts[widest] = bounded(whole.first(at));
    parts.insert(parts.begin() + widest + 1, bounded(whole.subspan(at)));
  }

  const auto index = static_cast<Ref>(nodes_.size());
  nodes_.emplace_back();
  constexpr float inf = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < kWide; ++k) {
    Ref child = kNothing;
    if (k < parts.size())
      child = parts[k].items.size() <= kWide
                  ? make_block(parts[k].items)
                  : make_node(boxes, parts[k].items, depth + 1, progress);
    Node& node = nodes_[index];
    node.child[k] = child;
    for (int a = 0; a < D; ++a) {
      node.bound[0][a][k] = inf;
      node.bound[1][a][k] = -inf;
      if (k >= parts.size()) continue;
      node.bound[0][a][k] =
          std::nextafter(static_cast<float>(parts[k].box.lo[a] - center_[a]), -inf);
      node.bound[1][a][k] =
          std::nextafter(static_cast<float>(parts[k].box.hi[a] - center_[a]), inf);
    }
  }
  return index;
}

template <int D>
std::size_t Bvh<D>::split(const std::vector<Box<D>>& boxes, std::span<std::int32_t> items,
                          bool median) const {
  Box<D> centers;
  const auto twice_center = [&](std::int32_t i) -> Vec<D> { return boxes[i].lo + boxes[i].hi; };
  for (const auto i : items) centers.add(twice_center(i));

  int best_axis = -1;
  int best_bin = 0;
  double best = std::numeric_limits<double>::infinity();
  const auto bin_of = [&](std::int32_t i, int axis) {
    const double width = centers.hi[axis] - centers.lo[axis];
    const double s = (boxes[i].lo[axis] + boxes[i].hi[axis] - centers.lo[axis]) / width;
    return std::clamp(static_cast<int>(s * kBins), 0, kBins - 1);
  };
  const auto blocks = [](std::size_t n) { return static_cast<double>((n + kWide - 1) / kWide); };
  for (int axis = 0; axis < D && !median; ++axis) {
    if (!(centers.hi[axis] - centers.lo[axis] > 0)) continue;
    std::array<Box<D>, kBins> box;
    std::array<std::size_t, kBins> count{};
    for (const auto i : items) {
      const int b = bin_of(i, axis);
      box[b].add(boxes[i]);
      ++count[b];
    }
    std::array<double, kBins> right{};
    Box<D> sum;
    std::size_t n = 0;
    for (int b = kBins - 1; b > 0; --b) {
      sum.add(box[b]);
      n += count[b];
      right[b] = n == 0 ? 0 : sum.half_area() * blocks(n);
    }
    sum = {};
    n = 0;
    for (int b = 0; b + 1 < kBins; ++b) {
      sum.add(box[b]);
      n += count[b];
      if (n == 0 || n == items.size()) continue;
      const double cost = sum.half_area() * blocks(n) + right[b + 1];
      if (cost < best) {
        best = cost;
        best_axis = axis;
        best_bin = b;
      }
    }
  }
  if (best_axis >= 0) {
    const auto middle = std::stable_partition(items.begin(), items.end(), [&](std::int32_t i) {
      return bin_of(i, best_axis) <= best_bin;
    });
    return static_cast<std::size_t>(middle - items.begin());
  }
  // All centers in one place, or too deep already.
  int axis = 0;
  (centers.hi - centers.lo).maxCoeff(&axis);
  std::stable_sort(items.begin(), items.end(), [&](std::int32_t a, std::int32_t b) {
    return twice_center(a)[axis] < twice_center(b)[axis];
  });
  return items.size() / 2;
}

namespace bvh_detail {

using Float4 [[gnu::vector_size(16)]] = float;

inline Float4 load(const float* p) {
  Float4 v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
inline Float4 smaller(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 larger(Float4 a, Float4 b) { return a > b ? a : b; }
inline Float4 all(float v) { return Float4{v, v, v, v}; }

/// Squared distances of a point to four boxes, `bound[lower, upper][axis]`, rounded down. `c` is
/// the point and the boxes are seen from the center.
template <int D>
class BoxDistance {
 public:
  explicit BoxDistance(const Vec<D>& c) {
    const double slack = c.cwiseAbs().maxCoeff() * 0x1p-22;
    for (int a = 0; a < D; ++a) {
      above_[a] = all(static_cast<float>(c[a] + slack));
      below_[a] = all(static_cast<float>(c[a] - slack));
    }
  }
  Float4 to(const float (&bound)[2][D][4]) const {
    Float4 d2 = all(0);
    for (int a = 0; a < D; ++a) {
      const Float4 out =
          larger(larger(load(bound[0][a]) - above_[a], below_[a] - load(bound[1][a])), all(0));
      d2 += out * out;
    }
    return d2;
  }

 private:
  Float4 above_[D], below_[D];
};

struct Entry {
  float key;
  std::int32_t ref;
};

/// Pushes the children whose key is below the bound, nearest on top.
inline int push(Entry* stack, int top, Float4 key, const std::int32_t* child, float bound) {
  alignas(16) float k4[4];
  __builtin_memcpy(k4, &key, sizeof k4);
  // Appended without branches, then sorted: mostly none or one is left to sort.
  const int bottom = top;
  for (int k = 0; k < 4; ++k) {
    stack[top] = {k4[k], child[k]};
    top += k4[k] < bound;
  }
  for (int i = bottom + 1; i < top; ++i) {
    const Entry e = stack[i];
    int at = i;
    for (; at > bottom && stack[at - 1].key < e.key; --at) stack[at] = stack[at - 1];
    stack[at] = e;
  }
  return top;
}

}  // namespace bvh_detail

template <int D>
template <class Visit>
void Bvh<D>::near(Ref root, const Vec<D>& x, double& bound2, Visit&& visit) const {
  using namespace bvh_detail;
  if (root == kNothing) return;
  const BoxDistance<D> distance(x - center_);
  const auto bound = [&] { return static_cast<float>(std::min(bound2, 1e38)) * 1.000002f; };

  Entry stack[kStack];
  int top = 0;
  stack[top++] = {0, root};
  while (top > 0) {
    const Entry e = stack[--top];
    if (!(e.key < bound())) continue;
    if (e.ref < 0) {
      visit(~e.ref);
      continue;
    }
    const Node& node = nodes_[e.ref];
    top = push(stack, top, distance.to(node.bound), node.child, bound());
  }
}

template <int D>
template <class Visit>
void Bvh<D>::along(Ref root, const Vec<D>& x, const Vec<D>& u, double& t_max, Visit&& visit) const {
  using namespace bvh_detail;
  if (root == kNothing) return;
  const Vec<D> c = x - center_;
  const double slack = c.cwiseAbs().maxCoeff() * 0x1p-22;
  Float4 near_origin[D], far_origin[D], inverse[D];
  int sign[D];
  for (int a = 0; a < D; ++a) {
    const bool negative = std::signbit(u[a]);
    sign[a] = negative ? 1 : 0;
    const double safe = std::abs(u[a]) > 1e-15 ? u[a] : (negative ? -1e-15 : 1e-15);
    inverse[a] = all(static_cast<float>(1 / safe));
    near_origin[a] = all(static_cast<float>(c[a] + (negative ? -slack : slack)));
    far_origin[a] = all(static_cast<float>(c[a] - (negative ? -slack : slack)));
  }
  constexpr float inf = std::numeric_limits<float>::infinity();
  const auto bound = [&] { return static_cast<float>(std::min(t_max, 1e38)) * 1.000002f; };

  Entry stack[kStack];
  int top = 0;
  stack[top++] = {0, root};
  while (top > 0) {
    const Entry e = stack[--top];
    if (!(e.key < bound())) continue;
    if (e.ref < 0) {
      visit(~e.ref);
      continue;
    }
    const Node& node = nodes_[e.ref];
    Float4 enter = all(0);
    Float4 leave = all(inf);
    for (int a = 0; a < D; ++a) {
      const Float4 t0 = (load(node.bound[sign[a]][a]) - near_origin[a]) * inverse[a];
      const Float4 t1 = (load(node.bound[1 - sign[a]][a]) - far_origin[a]) * inverse[a];
      enter = larger(t0, enter);
      leave = smaller(t1, leave);
    }
    // The factor covers the rounding of the divisions above.
    const Float4 key = enter <= leave * 1.000002f ? enter : all(inf);
    top = push(stack, top, key, node.child, bound());
  }
}

}  // namespace lamella
