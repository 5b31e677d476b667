#pragma once

#include <span>

#include "core/mesh/simplex_mesh.h"
#include "core/optimize/packed.h"

namespace lamella {

/// The mesh between two rounds of the optimizer: plain arrays, real and virtual elements together
/// as in Topology. Interfaces between bodies have virtual elements too.
template <int D>
struct WorkMesh {
  using Element = std::array<NodeId, D + 1>;

  std::vector<Vec<D>> points{Vec<D>::Zero()};  ///< [node]; entry 0 is the virtual node
  std::vector<Packed<D>> metric{Packed<D>{}};  ///< [node]
  std::vector<Vec<D>> asked{Vec<D>::Zero()};   ///< [node] where the metric function was asked last
  std::vector<char> fixed{0};                  ///< [node] never moves nor disappears
  std::vector<char> dirty{0};                  ///< [node] has surroundings not looked at yet
  std::vector<char> waits;  ///< [node] rounds in a row that it was locked; or empty
  std::vector<Element> elements;
  std::vector<std::int32_t> label;  ///< [element] body; of a virtual one: tag

  std::size_t node_count() const { return points.size() - 1; }
};

/// Work on one block of the mesh: its elements in a numbering of its own. Nodes that other blocks
/// share are locked: nothing may remove them, nor any element around them that is not here.
template <int D>
struct Block {
  WorkMesh<D> mesh;
  std::vector<NodeId> shared;  ///< [local node 1..] global id of a locked node, else 0
};

/// Cuts the mesh into blocks of whole elements, by halving the nodes across the direction in which
/// most elements lie. A function of the mesh and the round alone, so that threads do not matter;
/// `round` shifts the cuts. Elements so large that they meet several blocks wherever the cuts are
/// would never be looked at: what is around nodes that have waited at very long edges is a block of
/// its own.
template <int D>
class BlockPartition {
 public:
  BlockPartition(const WorkMesh<D>& mesh, int round, int threads);
  /// By hand: [element] its block, of `count` blocks.
  BlockPartition(const WorkMesh<D>& mesh, const std::vector<std::int32_t>& home, int count,
                 int threads);
  int count() const { return static_cast<int>(first_.size()) - 1; }
  /// Whether the block has dirty nodes.
  bool pending(int block) const { return pending_[block] != 0; }
  Block<D> extract(const WorkMesh<D>& mesh, int block) const;

 private:
  void fill(const WorkMesh<D>& mesh, const std::vector<std::int32_t>& home, int count, int threads);

  std::vector<std::int32_t> order_;       // elements, by block
  std::vector<std::int32_t> first_;       // [block] into order_
  std::vector<std::int32_t> node_block_;  // [node] -1 where blocks meet
  std::vector<char> pending_;
};

/// The whole mesh as one block; `mesh` is left empty.
template <int D>
Block<D> whole_block(WorkMesh<D>& mesh) {
  Block<D> b;
  b.mesh = std::move(mesh);
  b.shared.assign(b.mesh.points.size(), 0);
  return b;
}

/// The mesh made of what became of all blocks. Nodes are numbered anew: shared ones first, then
/// block by block.
template <int D>
WorkMesh<D> merge(const WorkMesh<D>& before, std::vector<Block<D>>& blocks, int threads);

/// Numbers the nodes so that near ones have near numbers, and the elements after them.
template <int D>
void sort_in_space(WorkMesh<D>& mesh);

}  // namespace lamella
