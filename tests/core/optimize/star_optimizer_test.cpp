#include "core/optimize/star_optimizer.h"

#include <random>

#include "core/mesh/quality.h"
#include "tests/support/adapt_cases.h"
#include "tests/support/work_meshes.h"

namespace lamella::test {
namespace {

template <class T>
class StarOptimizers : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(StarOptimizers, Dimensions);

/// The box with its inner nodes shaken: no two elements are alike.
template <int D>
SimplexMesh<D> shaken_box(int cells, std::mt19937& rng) {
  SimplexMesh<D> mesh = unit_box<D>(cells);
  const double step = 0.25 / cells / std::sqrt(D);
  for (std::size_t n = 1; n < mesh.points.size(); ++n)
    if (mesh.points[n].minCoeff() > 0 && mesh.points[n].maxCoeff() < 1)
      mesh.points[n] += step * random_vector<D>(rng);
  EXPECT_TRUE(validate(mesh).ok());
  return mesh;
}

template <int D>
Rating rate(const RatingKernel<D>& kernel, const std::vector<Vec<D>>& points,
            const std::vector<Packed<D>>& metric, const std::array<NodeId, D + 1>& nodes) {
  Topology<D> topo;
  topo.points = points;
  topo.elements = {nodes};
  RealFace<D> face;
  fill_real_face(face, topo, 0, 0, metric);
  return kernel(face, points[nodes[0]], metric[nodes[0]]);
}

TYPED_TEST(StarOptimizers, TheKernelRatesAsTheDefinitionsDo) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(60 + D);
  RatingKernel<D> kernel;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Vec<D>> points{Vec<D>::Zero()};
    MetricField<D> metric{Metric<D>::Identity()};
    std::vector<Packed<D>> packed{Packed<D>::zero()};
    for (int k = 0; k <= D; ++k) {
      points.push_back(random_vector<D>(rng));
      metric.push_back(random_metric<D>(rng, 10));
      packed.push_back(Packed<D>::from(metric.back()));
    }
    std::array<NodeId, D + 1> nodes;
    Corners<D> p;
    for (int k = 0; k <= D; ++k) p[k] = points[nodes[k] = k + 1];
    const Rating rating = rate<D>(kernel, points, packed, nodes);
    const auto expected = element_quality<D>(p, mean_metric<D>(metric, nodes));
    if (expected.shape <= 0) {
      EXPECT_LT(rating.quality, 0);
      EXPECT_TRUE(std::isinf(rating.energy));
      continue;
    }
    EXPECT_NEAR(rating.quality, expected.quality, 1e-9 * expected.quality);
    // 1 / shape + w (h^D + h^-D - 2): from the size of (3.6), which is the smaller of both.
    const double energy =
        1 / expected.shape + usual_size_weight<D> * (expected.size + 1 / expected.size - 2);
    EXPECT_NEAR(rating.energy, energy, 1e-9 * energy);
  }
}

TYPED_TEST(StarOptimizers, TheDensestMetricBoundsTheQualityWhereItIsAsked) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(65 + D);
  RatingKernel<D> plain, strict;
  int bounded = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Vec<D>> points{Vec<D>::Zero()};
    MetricField<D> metric{Metric<D>::Identity()};
    std::vector<Packed<D>> packed{Packed<D>::zero()};
    std::array<NodeId, D + 1> nodes;
    Corners<D> p;
    int densest = 1;
    for (int k = 0; k <= D; ++k) {
      points.push_back(random_vector<D>(rng));
      metric.push_back(random_metric<D>(rng, 100) * std::pow(4.0, trial % (D + 1) == k));
      packed.push_back(Packed<D>::from(metric.back()));
      p[k] = points[nodes[k] = k + 1];
      if (metric.back().determinant() > metric[densest].determinant()) densest = k + 1;
    }
    // Of unit size, so that shapes decide.
    const Mat<D> average = mean_metric<D>(metric, nodes);
    double size2 = 0;
    for (int i = 0; i <= D; ++i)
      for (int j = 0; j < i; ++j) size2 += (p[i] - p[j]).dot(average * (p[i] - p[j]));
    size2 *= 2.0 / (D * (D + 1));
    for (int k = 0; k <= D; ++k) p[k] = points[k + 1] /= std::sqrt(size2);
    int dense = 0;
    for (int k = 1; k <= D + 1; ++k)
      dense += metric[k].determinant() > 0.8 * metric[densest].determinant();
    const auto own = element_quality<D>(p, metric[densest]);
    if (own.shape <= 0 || dense > 1) continue;
    strict.metrics = &packed;
    const double mean = rate<D>(plain, points, packed, nodes).quality;
    const double bound = RatingKernel<D>::strictness * own.shape;
    const double expected = std::min(mean, bound);
    EXPECT_NEAR(rate<D>(strict, points, packed, nodes).quality, expected, 1e-9 * expected);
    bounded += bound < mean;
  }
  EXPECT_GT(bounded, 3);
}

TYPED_TEST(StarOptimizers, TheUnitEquilateralElementIsTheBest) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(70 + D);
  const auto simplex = equilateral_simplex<D>(1);
  const Metric<D> m = random_metric<D>(rng, 10);
  const Mat<D> map = metric_power<D>(m, -0.5);  // makes it unit and equilateral in m
  auto points = simplex.points;
  for (auto& x : points) x = map * x;
  const std::vector<Packed<D>> metric(points.size(), Packed<D>::from(m));
  const RatingKernel<D> kernel;
  const Rating best = rate<D>(kernel, points, metric, simplex.elements[0]);
  EXPECT_NEAR(best.quality, 1, 1e-12);
  EXPECT_NEAR(best.energy, 1, 1e-12);
  for (int trial = 0; trial < 100; ++trial) {
    auto other = points;
    for (std::size_t n = 1; n < other.size(); ++n) other[n] += 0.05 * (map * random_vector<D>(rng));
    const Rating r = rate<D>(kernel, other, metric, simplex.elements[0]);
    EXPECT_LT(r.quality, 1);
    EXPECT_GT(r.energy, 1);
  }
}

/// A mesh in the hands of the optimizer, as one block.
template <int D>
class Bench {
 public:
  Bench(SimplexMesh<D> mesh, const MetricFunction<D>& metric)
      : mesh_(std::move(mesh)), work_(work_mesh<D>(mesh_, metric, model_)) {}

  /// One sweep over the nodes with something new around. Returns the number of operations.
  std::size_t sweep(const SweepParams& params) {
    const BlockPartition<D> partition(work_, 0, 1);
    EXPECT_EQ(partition.count(), 1);
    std::vector<Block<D>> blocks{partition.extract(work_, 0)};
    StarOptimizer<D> star(std::move(blocks[0]), model_, adapt_, at_nodes_, std::sqrt(D));
    const std::size_t operations = star.sweep(params, {});
    blocks[0] = star.take();
    work_ = merge(work_, blocks, 1);
    return operations;
  }
  void calm_all() { work_.dirty.assign(work_.points.size(), 0); }
  void wake_all() { work_.dirty.assign(work_.points.size(), 1); }
  SimplexMesh<D> mesh() const { return simplex_mesh<D>(work_, model_); }
  std::size_t real_elements() const { return mesh().elements.size(); }
  std::vector<Rating> ratings() const {
    RatingKernel<D> kernel;
    std::vector<Rating> all;
    Topology<D> topo;
    topo.points = work_.points;
    topo.elements = work_.elements;
    for (std::size_t e = 0; e < work_.elements.size(); ++e) {
      const auto& nodes = work_.elements[e];
      if (nodes[0] == 0) continue;
      RealFace<D> face;
      fill_real_face(face, topo, static_cast<std::int32_t>(e), 0, work_.metric);
      all.push_back(kernel(face, work_.points[nodes[0]], work_.metric[nodes[0]]));
    }
    return all;
  }
  std::vector<double> sorted_qualities() const {
    std::vector<double> q;
    for (const Rating& r : ratings()) q.push_back(r.quality);
    std::sort(q.begin(), q.end());
    return q;
  }

 private:
  SimplexMesh<D> mesh_;
  BoundaryModel<D> model_{mesh_, nullptr, 1e-3, 0.7};
  AdaptParams adapt_;
  MetricFunction<D> at_nodes_;  // none: the metric is carried by the nodes
  WorkMesh<D> work_;
};

/// (3.9): b is no worse than a, the shorter list padded with +infinity; differences below
/// rounding are none.
testing::AssertionResult no_worse(const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    if (i >= b.size()) return testing::AssertionSuccess();
    if (i >= a.size()) return testing::AssertionFailure() << "an element more, number " << i;
    if (std::abs(a[i] - b[i]) <= 1e-12) continue;
    if (b[i] > a[i]) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << "element " << i << " fell from " << a[i] << " to " << b[i];
  }
  return testing::AssertionSuccess();
}

SortedQualities of(const std::vector<double>& list) {
  SortedQualities qualities;
  for (const double q : list) qualities.add(q);
  return qualities;
}

TEST(Order, IsAStrictWeakOrderOfSortedLists) {
  // Few values and lengths, so that ties and prefixes abound.
  std::vector<std::vector<double>> lists;
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) {
    std::vector<double> list(random() % 4);
    for (double& q : list) q = 0.25 * static_cast<double>(1 + random() % 3);
    lists.push_back(std::move(list));
  }
  const auto before = [](const auto& a, const auto& b) {
    SortedQualities first = of(a), second = of(b);
    return goes_before(first, second);
  };
  const auto equal = [&](const auto& a, const auto& b) { return !before(a, b) && !before(b, a); };
  const auto sorted = [](auto list) {
    std::sort(list.begin(), list.end());
    return list;
  };
  for (const auto& a : lists) {
    EXPECT_FALSE(before(a, a));
    for (const auto& b : lists) {
      EXPECT_FALSE(before(a, b) && before(b, a));
      EXPECT_EQ(equal(a, b), sorted(a) == sorted(b)) << "distinct lists are told apart";
      for (const auto& c : lists) {
        EXPECT_TRUE(before(a, c) || !before(a, b) || !before(b, c));
        EXPECT_TRUE(equal(a, c) || !equal(a, b) || !equal(b, c));
      }
    }
  }
}

TEST(Order, ThePrefixGoesFirstAndTheWorstElementDecides) {
  SortedQualities shorter = of({0.5, 0.3}), longer = of({0.3, 0.9, 0.5}),
                  worse = of({0.9, 0.2, 0.9});
  EXPECT_TRUE(goes_before(shorter, longer));
  EXPECT_TRUE(goes_before(longer, worse));
  EXPECT_FALSE(goes_before(worse, shorter));
}

TYPED_TEST(StarOptimizers, TheOrderNeverFalls) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(80 + D);
  for (const auto& [name, metric] : metrics<D>(D == 2 ? 0.07 : D == 3 ? 0.2 : 0.5, rng)) {
    SCOPED_TRACE(name);
    Bench<D> bench(shaken_box<D>(D == 2 ? 9 : D == 3 ? 4 : 2, rng), metric);
    SweepParams params;
    params.criterion = Criterion::order;
    auto before = bench.sorted_qualities();
    std::size_t operations = 0;
    for (int i = 0; i < 6; ++i) {
      operations += bench.sweep(params);
      const auto after = bench.sorted_qualities();
      EXPECT_TRUE(no_worse(before, after)) << "sweep " << i;
      before = after;
    }
    EXPECT_GT(operations, 20u);
    expect_valid(bench.mesh());
  }
}

TYPED_TEST(StarOptimizers, MovesNeverRaiseTheEnergy) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(90 + D);
  for (const auto& [name, metric] : metrics<D>(D == 2 ? 0.1 : D == 3 ? 0.2 : 0.4, rng)) {
    SCOPED_TRACE(name);
    Bench<D> bench(shaken_box<D>(D == 2 ? 9 : D == 3 ? 5 : 3, rng), metric);
    SweepParams params;
    params.criterion = Criterion::energy;
    params.moves_only = true;
    const auto sum = [&] {
      double s = 0;
      for (const Rating& r : bench.ratings()) s += r.energy;
      return s;
    };
    const double worst = bench.sorted_qualities()[0];
    double before = sum();
    const std::size_t elements = bench.real_elements();
    std::size_t operations = 0;
    for (int i = 0; i < 4; ++i) {
      operations += bench.sweep(params);
      ASSERT_EQ(bench.real_elements(), elements);
      const double after = sum();
      EXPECT_LE(after, before * (1 + 1e-12)) << "sweep " << i;
      before = after;
    }
    EXPECT_GT(operations, 0u);
    // No element falls below 0.3 for the sake of the average.
    EXPECT_GE(bench.sorted_qualities()[0], std::min(worst, 0.3) - 1e-12);
  }
}

TYPED_TEST(StarOptimizers, TheEnergyCriterionSparesTheWorst) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(100 + D);
  for (const auto& [name, metric] : metrics<D>(D == 2 ? 0.07 : D == 3 ? 0.2 : 0.5, rng)) {
    SCOPED_TRACE(name);
    Bench<D> bench(shaken_box<D>(D == 2 ? 9 : D == 3 ? 4 : 2, rng), metric);
    SweepParams params;
    params.criterion = Criterion::energy;
    for (double temperature : {0.0, 0.5}) {
      params.temperature = temperature;
      for (int i = 0; i < 3; ++i) {
        const double before = bench.sorted_qualities()[0];
        bench.wake_all();
        bench.sweep(params);
        EXPECT_GE(bench.sorted_qualities()[0], std::min(before, 0.3) - 1e-12);
      }
    }
    expect_valid(bench.mesh());
  }
}

TYPED_TEST(StarOptimizers, TheEnergyAboveThatOfTypicalElementsNeverRises) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(120 + D);
  for (const double h : {D == 4 ? 0.35 : 0.1, D == 4 ? 0.8 : 0.3})
    for (const auto& [name, metric] : metrics<D>(h, rng)) {
      SCOPED_TRACE(name);
      Bench<D> bench(shaken_box<D>(D == 2 ? 9 : D == 3 ? 4 : 2, rng), metric);
      SweepParams params;
      params.criterion = Criterion::energy;
      const auto sum = [&] {
        double s = 0;
        for (const Rating& r : bench.ratings()) s += r.energy - typical_energy<D>;
        return s;
      };
      double before = sum();
      std::size_t operations = 0;
      for (int i = 0; i < 6; ++i) {
        operations += bench.sweep(params);
        const double after = sum();
        EXPECT_LE(after, before + 1e-12 * std::abs(before)) << "sweep " << i;
        before = after;
      }
      EXPECT_GT(operations, 0u);
    }
}

TYPED_TEST(StarOptimizers, ASweepWithNothingNewDoesNothing) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(110 + D);
  Bench<D> bench(shaken_box<D>(3 - (D == 4), rng),
                 [](const Vec<D>&) { return isotropic_metric<D>(0.2); });
  const auto before = bench.mesh();
  bench.calm_all();
  EXPECT_EQ(bench.sweep({}), 0u);
  EXPECT_EQ(bench.mesh().points, before.points);
  EXPECT_EQ(as_sets(bench.mesh().elements), as_sets(before.elements));
  bench.wake_all();
  EXPECT_GT(bench.sweep({}), 0u);
}

}  // namespace
}  // namespace lamella::test
