#include "core/optimize/work_mesh.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"

namespace lamella {
namespace {

/// Elements of a block: large enough that little lies on its rim, small enough for the cache.
constexpr std::size_t block_elements = 24000;
/// Rounds in a row that a node of an edge longer than this, in the metric, may be locked.
constexpr int patience = 2;
constexpr double very_long = 4;
/// Elements, or nodes, that a thread takes at once.
constexpr std::size_t range = 32768;
/// Nodes that stay in one leaf when they are sorted in space.
constexpr std::size_t leaf_nodes = 32;
/// Block of a node that no element has named yet.
constexpr std::int32_t unseen = -2;

/// Halves nodes recursively across the direction in which most elements lie.
template <int D>
class Bisection {
 public:
  Bisection(const WorkMesh<D>& mesh, std::vector<NodeId>& nodes, double share)
      : mesh_(mesh), nodes_(nodes), share_(share) {}

  /// Cuts [first, last) `depth` times; told each end with its path.
  template <class Leaf>
  void cut(std::size_t first, std::size_t last, int depth, int path, const Leaf& leaf) const {
    if (depth == 0) return leaf(first, last, path);
    const auto middle =
        first + static_cast<std::size_t>(share_ * static_cast<double>(last - first));
    halve(first, middle, last);
    const auto low = [&] { cut(first, middle, depth - 1, 2 * path, leaf); };
    const auto high = [&] { cut(middle, last, depth - 1, 2 * path + 1, leaf); };
    if (last - first > 20000) {
      tbb::parallel_invoke(low, high);
    } else {
      low();
      high();
    }
  }
  /// Cuts until no leaf holds more than a few nodes.
  void sort(std::size_t first, std::size_t last) const {
    if (last - first <= leaf_nodes) return;
    const std::size_t middle = first + (last - first) / 2;
    halve(first, middle, last);
    if (last - first > 20000) {
      tbb::parallel_invoke([&] { sort(first, middle); }, [&] { sort(middle, last); });
    } else {
      sort(first, middle);
      sort(middle, last);
    }
  }

 private:
  void halve(std::size_t first, std::size_t middle, std::size_t last) const {
    Vec<D> lo = Vec<D>::Constant(1e300), hi = -lo, density = Vec<D>::Zero();
    for (std::size_t i = first; i < last; ++i) {
      const Vec<D>& x = mesh_.points[nodes_[i]];
      lo = lo.cwiseMin(x);
      hi = hi.cwiseMax(x);
    }
    const std::size_t stride = 1 + (last - first) / 1024;
    for (std::size_t i = first; i < last; i += stride)
      for (int k = 0; k < D; ++k)
        density[k] += std::sqrt(mesh_.metric[nodes_[i]].c[Packed<D>::index(k, k)]);
    int axis;
    (hi - lo).cwiseProduct(density).maxCoeff(&axis);
    std::nth_element(nodes_.begin() + static_cast<std::ptrdiff_t>(first),
                     nodes_.begin() + static_cast<std::ptrdiff_t>(middle),
                     nodes_.begin() + static_cast<std::ptrdiff_t>(last),
                     [this, axis](NodeId a, NodeId b) {
                       const double x = mesh_.points[a][axis], y = mesh_.points[b][axis];
                       return x != y ? x < y : a < b;
                     });
  }

  const WorkMesh<D>& mesh_;
  std::vector<NodeId>& nodes_;
  double share_;
};

std::vector<NodeId> all_nodes(std::size_t count) {
  std::vector<NodeId> nodes(count);
  std::iota(nodes.begin(), nodes.end(), 1);
  return nodes;
}

/// Numbers of nodes, wanted by one thread again and again.
std::vector<NodeId>& node_map(std::size_t size) {
  static thread_local std::vector<NodeId> map;
  if (map.size() < size) map.resize(size, 0);
  return map;
}

/// [node] whether it has waited at the end of a very long edge; empty when none has.
template <int D>
std::vector<char> stuck_nodes(const WorkMesh<D>& mesh, int threads) {
  if (mesh.waits.empty()) return {};
  std::vector<char> stuck(mesh.points.size(), 0);
  std::atomic<bool> any = false;
  constexpr double limit = very_long * very_long * very_long * very_long;
  parallel_ranges(mesh.elements.size(), range, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t e = first; e < last; ++e)
      for (NodeId a : mesh.elements[e]) {
        if (a == 0 || mesh.waits[a] < patience) continue;
        for (NodeId b : mesh.elements[e]) {
          if (b == 0) continue;
          const Vec<D> edge = mesh.points[b] - mesh.points[a];
          if (!(mesh.metric[a].quad(edge) * mesh.metric[b].quad(edge) > limit)) continue;
          std::atomic_ref(stuck[a]).store(1, std::memory_order_relaxed);
          any = true;
        }
      }
  });
  if (!any) stuck.clear();
  return stuck;
}

}  // namespace

template <int D>
BlockPartition<D>::BlockPartition(const WorkMesh<D>& mesh, int round, int threads) {
  int depth = 0;
  while ((mesh.elements.size() >> depth) > block_elements) ++depth;
  const std::size_t count = std::size_t{1} << depth;
  node_block_.assign(mesh.points.size(), 0);
  if (depth > 0) {
    std::vector<NodeId> nodes = all_nodes(mesh.node_count());
    constexpr double shares[] = {0.5, 0.43, 0.57, 0.47, 0.4};
    const Bisection<D> bisection(mesh, nodes, shares[round % 5]);
    thread_arena(threads).execute([&] {
      bisection.cut(0, nodes.size(), depth, 0, [&](std::size_t first, std::size_t last, int path) {
        for (std::size_t i = first; i < last; ++i) node_block_[nodes[i]] = path;
      });
    });
  }
  // An element belongs to the last of its nodes' blocks.
  std::vector<std::int32_t> home(mesh.elements.size(), 0);
  const std::vector<char> stuck = depth > 0 ? stuck_nodes(mesh, threads) : std::vector<char>{};
  if (depth > 0)
    parallel_ranges(home.size(), range, threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t e = first; e < last; ++e)
        for (NodeId n : mesh.elements[e]) {
          if (n != 0) home[e] = std::max(home[e], node_block_[n]);
          if (!stuck.empty() && stuck[n]) home[e] = static_cast<std::int32_t>(count);
        }
    });
  fill(mesh, home, static_cast<int>(count) + (stuck.empty() ? 0 : 1), threads);
}

template <int D>
BlockPartition<D>::BlockPartition(const WorkMesh<D>& mesh, const std::vector<std::int32_t>& home,
                                  int count, int threads) {
  node_block_.resize(mesh.points.size());
  fill(mesh, home, count, threads);
}

template <int D>
void BlockPartition<D>::fill(const WorkMesh<D>& mesh, const std::vector<std::int32_t>& home,
                             int count, int threads) {
  // [range, block] elements, then where they begin in order_.
  const std::size_t ranges = (home.size() + range - 1) / range;
  std::vector<std::int32_t> next(ranges * count, 0);
  parallel_ranges(home.size(), range, threads, [&](std::size_t first, std::size_t last) {
    std::int32_t* own = next.data() + first / range * count;
    for (std::size_t e = first; e < last; ++e) ++own[home[e]];
  });
  first_.assign(count + 1, 0);
  std::int32_t total = 0;
  for (int b = 0; b < count; ++b) {
    for (std::size_t r = 0; r < ranges; ++r) total += std::exchange(next[r * count + b], total);
    first_[b + 1] = total;
  }
  order_.resize(home.size());
  std::fill(node_block_.begin(), node_block_.end(), unseen);
  parallel_ranges(home.size(), range, threads, [&](std::size_t first, std::size_t last) {
    std::int32_t* own = next.data() + first / range * count;
    for (std::size_t e = first; e < last; ++e) {
      const std::int32_t block = home[e];
      order_[own[block]++] = static_cast<std::int32_t>(e);
      for (NodeId n : mesh.elements[e]) {
        if (n == 0) continue;
        const std::atomic_ref seen(node_block_[n]);
        std::int32_t in = seen.load(std::memory_order_relaxed);
        if (in == block || in == -1) continue;
        if (in == unseen && seen.compare_exchange_strong(in, block, std::memory_order_relaxed))
          continue;
        if (in != block) seen.store(-1, std::memory_order_relaxed);
      }
    }
  });
  pending_.assign(count, 0);
  for (std::size_t n = 1; n < mesh.points.size(); ++n)
    if (mesh.dirty[n] && node_block_[n] >= 0) pending_[node_block_[n]] = 1;
}

template <int D>
Block<D> BlockPartition<D>::extract(const WorkMesh<D>& mesh, int block) const {
  Block<D> b;
  auto& local = node_map(mesh.points.size());
  std::vector<NodeId> nodes;
  for (std::int32_t i = first_[block]; i < first_[block + 1]; ++i)
    for (NodeId n : mesh.elements[order_[i]])
      if (n != 0 && local[n] == 0) {
        local[n] = 1;
        nodes.push_back(n);
      }
  std::sort(nodes.begin(), nodes.end());
  b.shared.push_back(0);
  if (mesh.asked.empty()) b.mesh.asked.clear();
  for (NodeId n : nodes) {
    local[n] = static_cast<NodeId>(b.mesh.points.size());
    b.mesh.points.push_back(mesh.points[n]);
    b.mesh.metric.push_back(mesh.metric[n]);
    if (!mesh.asked.empty()) b.mesh.asked.push_back(mesh.asked[n]);
    b.mesh.fixed.push_back(mesh.fixed[n]);
    b.mesh.dirty.push_back(mesh.dirty[n]);
    b.shared.push_back(node_block_[n] < 0 ? n : 0);
  }
  const auto size = static_cast<std::size_t>(first_[block + 1] - first_[block]);
  b.mesh.elements.reserve(size);
  b.mesh.label.reserve(size);
  for (std::int32_t i = first_[block]; i < first_[block + 1]; ++i) {
    auto e = mesh.elements[order_[i]];
    for (NodeId& n : e)
      if (n != 0) n = local[n];
    b.mesh.elements.push_back(e);
    b.mesh.label.push_back(mesh.label[order_[i]]);
  }
  for (NodeId n : nodes) local[n] = 0;
  return b;
}

template <int D>
WorkMesh<D> merge(const WorkMesh<D>& before, std::vector<Block<D>>& blocks, int threads) {
  WorkMesh<D> out;
  std::vector<NodeId> shared(before.points.size(), 0);
  for (const auto& b : blocks)
    for (NodeId n : b.shared)
      if (n != 0) shared[n] = 1;
  NodeId next = 1;
  for (std::size_t n = 1; n < shared.size(); ++n)
    if (shared[n]) shared[n] = next++;
  std::vector<NodeId> base(blocks.size());
  std::vector<std::size_t> element_base(blocks.size());
  std::size_t elements = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    base[i] = next;
    element_base[i] = elements;
    elements += blocks[i].mesh.elements.size();
    for (std::size_t n = 1; n < blocks[i].shared.size(); ++n)
      if (blocks[i].shared[n] == 0) ++next;
  }
  out.points.resize(next);
  out.metric.resize(next);
  out.asked.resize(before.asked.empty() ? 0 : next);
  out.fixed.resize(next, 0);
  out.dirty.resize(next, 0);
  out.waits.resize(next, 0);
  out.elements.resize(elements);
  out.label.resize(elements);
  for (std::size_t n = 1; n < shared.size(); ++n) {
    const NodeId to = shared[n];
    if (to == 0) continue;
    out.points[to] = before.points[n];
    out.metric[to] = before.metric[n];
    if (!before.asked.empty()) out.asked[to] = before.asked[n];
    out.fixed[to] = before.fixed[n];
    const int waited = before.waits.empty() ? 0 : before.waits[n];
    out.waits[to] = static_cast<char>(std::min(waited + 1, patience));
  }
  for (const auto& b : blocks)
    for (std::size_t n = 1; n < b.shared.size(); ++n)
      if (b.shared[n] != 0 && b.mesh.dirty[n]) out.dirty[shared[b.shared[n]]] = 1;
  parallel_each(
      blocks.size(), threads, {},
      [&](std::size_t i) {
        Block<D>& b = blocks[i];
        std::vector<NodeId> id(b.shared.size(), 0);
        NodeId free = base[i];
        for (std::size_t n = 1; n < id.size(); ++n) {
          if (b.shared[n] != 0) {
            id[n] = shared[b.shared[n]];
            continue;
          }
          id[n] = free;
          out.points[free] = b.mesh.points[n];
          out.metric[free] = b.mesh.metric[n];
          if (!before.asked.empty()) out.asked[free] = b.mesh.asked[n];
          out.fixed[free] = b.mesh.fixed[n];
          out.dirty[free] = b.mesh.dirty[n];
          ++free;
        }
        for (std::size_t e = 0; e < b.mesh.elements.size(); ++e) {
          auto nodes = b.mesh.elements[e];
          for (NodeId& n : nodes) n = id[n];
          out.elements[element_base[i] + e] = nodes;
          out.label[element_base[i] + e] = b.mesh.label[e];
        }
        b = {};
      },
      1);
  return out;
}

template <int D>
void sort_in_space(WorkMesh<D>& mesh) {
  std::vector<NodeId> nodes = all_nodes(mesh.node_count());
  Bisection<D>(mesh, nodes, 0.5).sort(0, nodes.size());
  std::vector<NodeId> id(mesh.points.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) id[nodes[i]] = static_cast<NodeId>(i + 1);
  const auto reorder = [&nodes](auto& values) {
    if (values.empty()) return;
    auto sorted = values;
    for (std::size_t i = 0; i < nodes.size(); ++i) sorted[i + 1] = values[nodes[i]];
    values.swap(sorted);
  };
  reorder(mesh.points);
  reorder(mesh.metric);
  reorder(mesh.asked);
  reorder(mesh.fixed);
  reorder(mesh.dirty);
  reorder(mesh.waits);
  for (auto& e : mesh.elements)
    for (NodeId& n : e) n = id[n];
  // Elements follow their lowest node.
  std::vector<std::int32_t> first(mesh.points.size() + 1, 0);
  const auto key = [](const auto& e) {
    NodeId low = e[D];
    for (NodeId n : e)
      if (n != 0) low = std::min(low, n);
    return low;
  };
  for (const auto& e : mesh.elements) ++first[key(e) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  auto elements = mesh.elements;
  auto label = mesh.label;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const std::int32_t to = first[key(elements[e])]++;
    mesh.elements[to] = elements[e];
    mesh.label[to] = label[e];
  }
}

template struct WorkMesh<2>;
template struct WorkMesh<3>;
template struct WorkMesh<4>;
template class BlockPartition<2>;
template class BlockPartition<3>;
template class BlockPartition<4>;
template WorkMesh<2> merge(const WorkMesh<2>&, std::vector<Block<2>>&, int);
template WorkMesh<3> merge(const WorkMesh<3>&, std::vector<Block<3>>&, int);
template WorkMesh<4> merge(const WorkMesh<4>&, std::vector<Block<4>>&, int);
template void sort_in_space(WorkMesh<2>&);
template void sort_in_space(WorkMesh<3>&);
template void sort_in_space(WorkMesh<4>&);

}  // namespace lamella
