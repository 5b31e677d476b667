#include <numeric>

#include "core/mesh/quality.h"
#include "tests/support/adapt_cases.h"

namespace lamella::test {
namespace {

template <class T>
class AdaptProperties : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(AdaptProperties, Dimensions);

template <class T>
class AdaptInPlaneAndSpace : public testing::Test {};
using PlaneAndSpace =
    testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(AdaptInPlaneAndSpace, PlaneAndSpace);

TYPED_TEST(AdaptProperties, EveryFlatDomainKeepsItsShapeUnderEveryMetric) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(D);
  const auto all = metrics<D>(D == 2 ? 0.08 : D == 3 ? 0.25 : 0.7, rng);
  for (const auto& [mesh_name, mesh] : flat_meshes<D>(2))
    for (const auto& [metric_name, metric] : all) {
      SCOPED_TRACE(mesh_name + ", " + metric_name);
      const auto out = adapted<D>(mesh, metric);
      expect_valid(out.mesh);
      expect_same_shape(mesh, out.mesh);
      EXPECT_EQ(out.metric.size(), out.mesh.points.size());
      EXPECT_GT(out.report.splits + out.report.collapses + out.report.swaps + out.report.moves, 0u);
    }
}

TYPED_TEST(AdaptProperties, CornersStay) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(D);
  const auto box = unit_box<D>(2);
  for (const auto& [name, metric] : metrics<D>(1.5, rng)) {
    SCOPED_TRACE(name);
    const auto out = adapted<D>(box, metric);
    for (int corner = 0; corner < 1 << D; ++corner) {
      Vec<D> x;
      for (int k = 0; k < D; ++k) x[k] = corner >> k & 1;
      EXPECT_TRUE(has_point<D>(out.mesh, x)) << x.transpose();
    }
  }
  const auto simplex = equilateral_simplex<D>(1);
  const auto out = adapted<D>(simplex, [](const Vec<D>&) { return isotropic_metric<D>(0.5); });
  for (std::size_t n = 1; n < simplex.points.size(); ++n)
    EXPECT_TRUE(has_point<D>(out.mesh, simplex.points[n]));
}

TYPED_TEST(AdaptInPlaneAndSpace, AGroupThatEndsWithinAFlatSideKeepsItsArea) {
  constexpr int D = TypeParam::value;
  const auto mesh =
      with_gate<D>(unit_box<D>(2), [](const Vec<D>& x) { return x[0] == 0 && x[1] < 0.5; });
  std::mt19937 rng(D);
  for (const auto& [name, metric] : metrics<D>(D == 2 ? 0.1 : 0.3, rng)) {
    SCOPED_TRACE(name);
    const auto out = adapted<D>(mesh, metric);
    expect_valid(out.mesh);
    expect_same_shape(mesh, out.mesh);
  }
}

TYPED_TEST(AdaptProperties, ABallStaysValid) {
  constexpr int D = TypeParam::value;
  const auto ball = ball_mesh<D>(2, 1);
  std::mt19937 rng(D);
  for (const auto& [name, metric] : metrics<D>(D == 2 ? 0.15 : D == 3 ? 0.4 : 0.8, rng)) {
    SCOPED_TRACE(name);
    const auto out = adapted<D>(ball, metric);
    expect_valid(out.mesh);
    // The default chord tolerance bounds the change, 1e-3 of the box diagonal.
    const double volume = volumes(ball)[0], area = inspect(ball)->boundary_area;
    EXPECT_NEAR(volumes(out.mesh)[0], volume, 2e-3 * std::sqrt(D) * area);
  }
}

/// What does not depend on where the mesh lies nor how it is numbered.
struct Figures {
  double quality, unit_edges, nodes;
};

template <int D>
Figures figures(const SimplexMesh<D>& mesh, const MetricFunction<D>& metric) {
  const auto field = sample_metric<D>(metric, mesh.points);
  const auto c = element_qualities<D>(mesh, field);
  std::size_t unit = 0, edges = 0;
  for (const auto& e : mesh.elements)
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j, ++edges)
        unit += is_unit_length(edge_length<D>(Vec<D>(mesh.points[e[j]] - mesh.points[e[i]]),
                                              field[e[i]], field[e[j]]));
  return {std::accumulate(c.begin(), c.end(), 0.0) / static_cast<double>(c.size()),
          static_cast<double>(unit) / static_cast<double>(edges),
          static_cast<double>(mesh.node_count())};
}

/// `a` differs from what some seeds give by no more than 5 % beyond what they differ themselves.
void expect_alike(const std::vector<Figures>& seeds, const Figures& a) {
  const auto within = [&](double Figures::*figure) {
    double low = seeds[0].*figure, high = low;
    for (const Figures& s : seeds) {
      low = std::min(low, s.*figure);
      high = std::max(high, s.*figure);
    }
    EXPECT_GE(a.*figure, 0.95 * low);
    EXPECT_LE(a.*figure, 1.05 * high);
  };
  within(&Figures::quality);
  within(&Figures::unit_edges);
  within(&Figures::nodes);
}

/// Twice: once alone knows the metric at a few nodes only.
template <int D>
Figures twice(const SimplexMesh<D>& mesh, const MetricFunction<D>& metric, std::uint64_t seed = 1) {
  AdaptParams params;
  params.seed = seed;
  return figures<D>(adapted<D>(adapted<D>(mesh, metric, params).mesh, metric, params).mesh, metric);
}

template <int D>
SimplexMesh<D> renumbered(const SimplexMesh<D>& mesh, std::mt19937& rng) {
  const auto shuffle = [&rng](auto& v) {
    for (std::size_t i = v.size(); i > 1; --i) std::swap(v[i - 1], v[rng() % i]);
  };
  std::vector<NodeId> order(mesh.node_count());
  std::iota(order.begin(), order.end(), 1);
  shuffle(order);
  std::vector<NodeId> id(mesh.points.size(), 0);
  SimplexMesh<D> out = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) {
    out.points[i + 1] = mesh.points[order[i]];
    id[order[i]] = static_cast<NodeId>(i + 1);
  }
  std::vector<std::size_t> places(mesh.elements.size());
  std::iota(places.begin(), places.end(), 0);
  shuffle(places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    auto e = mesh.elements[places[i]];
    for (NodeId& n : e) n = id[n];
    // An even permutation keeps the orientation.
    const auto turn = static_cast<std::ptrdiff_t>(rng() % 3);
    std::rotate(e.begin(), e.begin() + turn, e.begin() + 3);
    out.elements[i] = e;
    out.element_body[i] = mesh.element_body[places[i]];
  }
  for (auto& f : out.facets)
    for (NodeId& n : f) n = id[n];
  return out;
}

TYPED_TEST(AdaptInPlaneAndSpace, PlaceSizeAndNumberingChangeNoFigure) {
  constexpr int D = TypeParam::value;
  std::mt19937 rng(40 + D);
  const auto mesh = unit_box<D>(2);
  for (const auto& [name, metric] : metrics<D>(D == 2 ? 0.03 : 0.1, rng)) {
    SCOPED_TRACE(name);
    std::vector<Figures> seeds;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) seeds.push_back(twice<D>(mesh, metric, seed));

    const Mat<D> turn = random_rotation<D>(rng);
    const Vec<D> shift = 5 * random_vector<D>(rng);
    const double scale = std::exp(uniform(rng, -4, 4));
    SimplexMesh<D> other = mesh;
    for (std::size_t n = 1; n < mesh.points.size(); ++n)
      other.points[n] = scale * (turn * mesh.points[n] + shift);
    const MetricFunction<D> there = [&, at = metric](const Vec<D>& x) {
      const Vec<D> here = turn.transpose() * (x / scale - shift);
      return Metric<D>(turn * at(here) * turn.transpose() / (scale * scale));
    };
    expect_alike(seeds, twice<D>(other, there));
    expect_alike(seeds, twice<D>(renumbered<D>(mesh, rng), metric));
  }
}

TYPED_TEST(AdaptInPlaneAndSpace, CoarseningUndoesRefinementAndASecondTimeChangesLittle) {
  constexpr int D = TypeParam::value;
  const double h = D == 2 ? 0.02 : 0.07;
  const auto uniform = [](double size) {
    return MetricFunction<D>([size](const Vec<D>&) { return isotropic_metric<D>(size); });
  };
  const auto box = unit_box<D>(2);
  const auto fine = adapted<D>(box, uniform(h));
  const auto coarse = adapted<D>(fine.mesh, uniform(2 * h));
  expect_valid(coarse.mesh);
  expect_same_shape(box, coarse.mesh);
  // Inner nodes of a box with an edge of n sizes are as n^D: those on the boundary lower the
  // ratio.
  const double ratio =
      static_cast<double>(fine.mesh.node_count()) / static_cast<double>(coarse.mesh.node_count());
  EXPECT_LT(ratio, 1.1 * (1 << D));
  EXPECT_GT(ratio, 0.65 * (1 << D));
  // From a coarse mesh the same size is reached as from a fine one.
  const auto direct = adapted<D>(box, uniform(2 * h));
  const auto nodes = static_cast<double>(coarse.mesh.node_count());
  EXPECT_NEAR(static_cast<double>(direct.mesh.node_count()), nodes, 0.1 * nodes);

  const auto again = adapted<D>(coarse.mesh, uniform(2 * h));
  EXPECT_NEAR(static_cast<double>(again.mesh.node_count()), nodes, 0.03 * nodes);
  const auto first = figures<D>(coarse.mesh, uniform(2 * h));
  const auto second = figures<D>(again.mesh, uniform(2 * h));
  EXPECT_GT(second.quality, 0.99 * first.quality);
  EXPECT_GT(second.unit_edges, 0.99 * first.unit_edges);
}

}  // namespace
}  // namespace lamella::test
