#include "core/optimize/work_mesh.h"

#include <numeric>

#include "tests/support/adapt_cases.h"
#include "tests/support/work_meshes.h"

namespace lamella::test {
namespace {

/// An element by the places of its nodes, so that numbering does not matter; NaN-free and exact.
template <int D>
struct Placed {
  std::array<std::array<double, D>, D + 1> corners;
  bool is_virtual;
  bool odd;  ///< of the permutation that sorts its nodes: the orientation
  std::int32_t label;
  auto operator<=>(const Placed&) const = default;
};

template <int D>
std::array<double, D> place(const Vec<D>& x) {
  std::array<double, D> a;
  for (int k = 0; k < D; ++k) a[k] = x[k];
  return a;
}

template <int D>
std::vector<Placed<D>> placed(const WorkMesh<D>& mesh) {
  std::vector<Placed<D>> all;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    Placed<D> p{{}, mesh.elements[e][0] == 0, false, mesh.label[e]};
    for (int k = 0; k <= D; ++k) {
      // The virtual node has no place: one that sorts before all others.
      p.corners[k].fill(-1e300);
      if (mesh.elements[e][k] != 0) p.corners[k] = place<D>(mesh.points[mesh.elements[e][k]]);
    }
    for (int i = 0; i <= D; ++i)
      for (int j = 0; j < i; ++j) p.odd = p.odd != (p.corners[j] > p.corners[i]);
    std::sort(p.corners.begin(), p.corners.end());
    all.push_back(p);
  }
  std::sort(all.begin(), all.end());
  return all;
}

template <int D>
struct PlacedNode {
  std::array<double, D> at;
  std::array<double, D*(D + 1) / 2> metric;
  std::array<double, D> asked;
  char fixed, dirty;
  auto operator<=>(const PlacedNode&) const = default;
};

template <int D>
std::vector<PlacedNode<D>> placed_nodes(const WorkMesh<D>& mesh) {
  std::vector<PlacedNode<D>> all;
  for (std::size_t n = 1; n < mesh.points.size(); ++n)
    all.push_back({place<D>(mesh.points[n]), mesh.metric[n].c,
                   mesh.asked.empty() ? std::array<double, D>{} : place<D>(mesh.asked[n]),
                   mesh.fixed[n], mesh.dirty[n]});
  std::sort(all.begin(), all.end());
  return all;
}

template <int D>
void expect_same_up_to_numbering(const WorkMesh<D>& a, const WorkMesh<D>& b) {
  EXPECT_EQ(a.asked.empty(), b.asked.empty());
  EXPECT_TRUE(placed(a) == placed(b));
  EXPECT_TRUE(placed_nodes(a) == placed_nodes(b));
}

template <int D>
void expect_identical(const WorkMesh<D>& a, const WorkMesh<D>& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.label, b.label);
  EXPECT_EQ(a.fixed, b.fixed);
  EXPECT_EQ(a.dirty, b.dirty);
  EXPECT_EQ(a.asked, b.asked);
}

template <class T>
class WorkMeshes : public testing::Test {
 protected:
  static constexpr int dim = T::value;

  /// More elements than fit in one block; every third node clean; two bodies; every node asked at
  /// a place of its own.
  WorkMesh<dim> mesh() const {
    WorkMesh<dim> work = work_mesh<dim>(box_, metric_, model_);
    std::mt19937 rng(dim);
    work.asked = work.points;
    for (std::size_t n = 1; n < work.points.size(); ++n) {
      work.dirty[n] = rng() % 3 != 0;
      work.asked[n] += 1e-3 * random_vector<dim>(rng);
    }
    return work;
  }
  std::vector<Block<dim>> blocks(const WorkMesh<dim>& work,
                                 const BlockPartition<dim>& partition) const {
    std::vector<Block<dim>> all;
    for (int i = 0; i < partition.count(); ++i) all.push_back(partition.extract(work, i));
    return all;
  }

  SimplexMesh<dim> box_ = two_body_box<dim>(dim == 2 ? 180 : dim == 3 ? 22 : 6);
  MetricFunction<dim> metric_ = [](const Vec<dim>& x) {
    return isotropic_metric<dim>(0.05 + 0.1 * std::abs(x[0]));
  };
  BoundaryModel<dim> model_{box_, nullptr, 1e-3, 0.7};
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(WorkMeshes, Dimensions);

TYPED_TEST(WorkMeshes, MergingUntouchedBlocksGivesTheMeshBack) {
  constexpr int D = TypeParam::value;
  const auto work = this->mesh();
  for (int round = 0; round < 5; ++round) {
    const BlockPartition<D> partition(work, round, 1);
    ASSERT_GT(partition.count(), 1);
    auto blocks = this->blocks(work, partition);
    expect_same_up_to_numbering(work, merge(work, blocks, 1));
  }
}

TYPED_TEST(WorkMeshes, EveryElementIsInOneBlockAndLockedNodesAreThoseOfSeveral) {
  constexpr int D = TypeParam::value;
  const auto work = this->mesh();
  const BlockPartition<D> partition(work, 1, 1);
  const auto blocks = this->blocks(work, partition);
  WorkMesh<D> together;
  together.points = work.points;
  std::vector<int> blocks_of(work.points.size(), 0);
  std::map<std::array<double, D>, NodeId> number;
  for (std::size_t n = 1; n < work.points.size(); ++n)
    number[place<D>(work.points[n])] = static_cast<NodeId>(n);
  for (const auto& b : blocks) {
    std::vector<NodeId> global(b.mesh.points.size(), 0);
    for (std::size_t n = 1; n < global.size(); ++n) {
      global[n] = number.at(place<D>(b.mesh.points[n]));
      ++blocks_of[global[n]];
    }
    for (std::size_t e = 0; e < b.mesh.elements.size(); ++e) {
      auto nodes = b.mesh.elements[e];
      for (NodeId& n : nodes) n = global[n];
      together.elements.push_back(nodes);
      together.label.push_back(b.mesh.label[e]);
    }
    EXPECT_EQ(b.shared.size(), b.mesh.points.size());
  }
  EXPECT_TRUE(placed(together) == placed(work));
  std::size_t locked = 0;
  for (const auto& b : blocks)
    for (std::size_t n = 1; n < b.shared.size(); ++n) {
      const NodeId global = number.at(place<D>(b.mesh.points[n]));
      EXPECT_EQ(b.shared[n], blocks_of[global] > 1 ? global : 0);
      locked += b.shared[n] != 0;
    }
  EXPECT_GT(locked, 0u);
  // Blocks are there to share little.
  EXPECT_LT(static_cast<double>(locked), (D == 2 ? 0.1 : 0.7) * work.node_count());
}

TYPED_TEST(WorkMeshes, ABlockIsPendingWhenANodeOfItsOwnIsDirty) {
  constexpr int D = TypeParam::value;
  auto work = this->mesh();
  std::fill(work.dirty.begin(), work.dirty.end(), 0);
  const BlockPartition<D> clean(work, 0, 1);
  for (int i = 0; i < clean.count(); ++i) EXPECT_FALSE(clean.pending(i));
  const auto blocks = this->blocks(work, clean);
  const auto& some = blocks.back();
  std::size_t own = 1;
  while (some.shared[own] != 0) ++own;
  const auto at = std::find(work.points.begin() + 1, work.points.end(), some.mesh.points[own]);
  work.dirty[at - work.points.begin()] = 1;
  const BlockPartition<D> touched(work, 0, 1);
  for (int i = 0; i < touched.count(); ++i) EXPECT_EQ(touched.pending(i), i + 1 == touched.count());
}

TYPED_TEST(WorkMeshes, RoundsShiftTheCuts) {
  constexpr int D = TypeParam::value;
  const auto work = this->mesh();
  const BlockPartition<D> a(work, 0, 1), b(work, 1, 1);
  EXPECT_NE(a.extract(work, 0).mesh.points.size(), b.extract(work, 0).mesh.points.size());
}

TYPED_TEST(WorkMeshes, NoNodeOfLongEdgesIsLockedThreeTimesInARowWhereverTheCutsAre) {
  constexpr int D = TypeParam::value;
  auto work = this->mesh();
  for (auto& m : work.metric) m = Packed<D>::from(isotropic_metric<D>(1e-3));
  std::map<std::array<double, D>, int> in_a_row;
  int longest = 0;
  for (int round = 0; round < 6; ++round) {
    const BlockPartition<D> partition(work, 0, 1);  // the same cuts again and again
    auto blocks = this->blocks(work, partition);
    std::map<std::array<double, D>, int> now;
    for (const auto& b : blocks)
      for (std::size_t n = 1; n < b.shared.size(); ++n) {
        if (b.shared[n] == 0) continue;
        const auto at = place<D>(b.mesh.points[n]);
        const auto before = in_a_row.find(at);
        now[at] = 1 + (before == in_a_row.end() ? 0 : before->second);
        longest = std::max(longest, now[at]);
      }
    in_a_row.swap(now);
    work = merge(work, blocks, 1);
  }
  EXPECT_EQ(longest, 2);
}

TYPED_TEST(WorkMeshes, ThreadsDoNotMatter) {
  constexpr int D = TypeParam::value;
  const auto work = this->mesh();
  const BlockPartition<D> partition(work, 2, 1);
  auto one = this->blocks(work, partition);
  const auto first = merge(work, one, 1);
  for (int threads : {2, 7}) {
    const BlockPartition<D> other(work, 2, threads);
    ASSERT_EQ(other.count(), partition.count());
    auto many = this->blocks(work, other);
    expect_identical(first, merge(work, many, threads));
  }
}

TYPED_TEST(WorkMeshes, SortingInSpaceRenumbersOnlyAndBringsNeighborsTogether) {
  constexpr int D = TypeParam::value;
  auto work = this->mesh();
  // Numbers without any order in space.
  std::mt19937 rng(7);
  std::vector<NodeId> id(work.points.size());
  std::iota(id.begin(), id.end(), 0);
  for (std::size_t i = id.size() - 1; i > 1; --i) std::swap(id[i], id[1 + rng() % i]);
  auto shuffled = work;
  for (std::size_t n = 1; n < id.size(); ++n) {
    shuffled.points[id[n]] = work.points[n];
    shuffled.metric[id[n]] = work.metric[n];
    shuffled.asked[id[n]] = work.asked[n];
    shuffled.fixed[id[n]] = work.fixed[n];
    shuffled.dirty[id[n]] = work.dirty[n];
  }
  for (auto& e : shuffled.elements)
    for (NodeId& n : e) n = id[n];
  const auto spread = [](const WorkMesh<D>& m) {
    double sum = 0;
    for (const auto& e : m.elements) sum += std::abs(static_cast<double>(e[D]) - e[D - 1]);
    return sum / static_cast<double>(m.elements.size());
  };
  auto sorted = shuffled;
  sort_in_space(sorted);
  expect_same_up_to_numbering(work, sorted);
  EXPECT_LT(spread(sorted), 0.4 * spread(shuffled));
  auto again = shuffled;
  sort_in_space(again);
  expect_identical(sorted, again);
}

}  // namespace
}  // namespace lamella::test
