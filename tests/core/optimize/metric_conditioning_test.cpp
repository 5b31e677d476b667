#include "core/optimize/metric_conditioning.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/mesh/adjacency.h"
#include "core/mesh/quality.h"
#include "core/mesh/sample_meshes.h"
#include "core/metric/analytic.h"
#include "tests/support/random_metric.h"

namespace lamella {
namespace {

using Kind = ConditionStep::Kind;
constexpr std::array kKinds = {GradationKind::isotropic, GradationKind::intersection};

template <class T>
class MetricConditioningAnyDimension : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(MetricConditioningAnyDimension, Dimensions);

template <int D>
SimplexMesh<D> mesh_of() {
  return unit_box<D>(D == 2 ? 12 : D == 3 ? 6 : 2);
}

/// Random axes and sizes in [1/ratio, 1].
template <int D>
MetricField<D> random_field(const SimplexMesh<D>& mesh, double ratio) {
  std::mt19937 rng(11);
  MetricField<D> field(mesh.points.size(), Metric<D>::Identity());
  for (std::size_t n = 1; n < field.size(); ++n) field[n] = test::random_metric<D>(rng, ratio);
  return field;
}

template <int D>
Conditioned<D> conditioned(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                           const ConditionParams& params) {
  Result<Conditioned<D>> r = condition_metric<D>(mesh, metric, params);
  EXPECT_TRUE(r.ok()) << (r.ok() ? "" : r.error().message);
  return std::move(*r);
}

/// Both have the same eigenvectors.
template <int D>
void expect_same_axes(const Metric<D>& a, const Metric<D>& b) {
  EXPECT_LT((a * b - b * a).norm(), 1e-9 * (a * b).norm());
}

/// a >= (1 - slack) b as quadratic forms.
template <int D>
bool above(const Metric<D>& a, const Metric<D>& b, double slack) {
  const Mat<D> l = b.llt().matrixL();
  const Mat<D> inverse = l.inverse();
  const Mat<D> seen = inverse * a * inverse.transpose();
  return spectrum<D>(Mat<D>(0.5 * (seen + seen.transpose()))).values[0] >= 1 - slack;
}

/// visit(p, q, e) for every edge in both directions, e from p to q.
template <int D, class Visit>
void for_each_way(const SimplexMesh<D>& mesh, Visit visit) {
  for (const auto& [a, b] : unique_edges<D>(mesh.elements, mesh.points.size())) {
    visit(a, b, Vec<D>(mesh.points[b] - mesh.points[a]));
    visit(b, a, Vec<D>(mesh.points[a] - mesh.points[b]));
  }
}

TYPED_TEST(MetricConditioningAnyDimension, BoundsHoldKeepDirectionsAndChangeNothingTwice) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const auto field = random_field<D>(mesh, 1000);
  ConditionParams params;
  params.h_min = 0.01;
  params.h_max = 0.5;
  params.max_anisotropy = 5;
  const auto once = conditioned<D>(mesh, field, params);
  for (std::size_t n = 1; n < field.size(); ++n) {
    const Vec<D> before = sizes<D>(field[n]), after = sizes<D>(once.metric[n]);
    expect_same_axes<D>(field[n], once.metric[n]);
    // The definition, size by size: no small size is lost to the bound of the anisotropy.
    const Vec<D> inside = before.cwiseMax(0.01).cwiseMin(0.5);
    EXPECT_LT((after - inside.cwiseMin(5 * inside[0])).norm(), 1e-9);
    EXPECT_LT((bounded_metric<D>(field[n], params) - once.metric[n]).norm(),
              1e-12 * once.metric[n].norm());
  }
  const auto twice = conditioned<D>(mesh, once.metric, params);
  EXPECT_EQ(twice.metric, once.metric);
  for (const ConditionStep& step : twice.report.steps) {
    EXPECT_EQ(step.nodes, 0u) << step_name(step.kind);
    EXPECT_EQ(step.size_largest, 1);
    EXPECT_EQ(step.anisotropy_lost, 1);
  }
}

TYPED_TEST(MetricConditioningAnyDimension, WithoutAnythingAskedNothingChanges) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const auto field = random_field<D>(mesh, 100);
  const auto r = conditioned<D>(mesh, field, {});
  EXPECT_EQ(r.metric, field);
  EXPECT_TRUE(r.report.steps.empty());
  const double forecast =
      allocation_factor<D>(mesh, field) * static_cast<double>(mesh.elements.size());
  EXPECT_NEAR(r.report.elements_before, forecast, 1e-9 * forecast);
  EXPECT_EQ(r.report.elements_after, r.report.elements_before);
  EXPECT_FALSE(ConditionParams{}.any());
}

TYPED_TEST(MetricConditioningAnyDimension, GradationOfAnIsotropicMetricIsTheShortestPath) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const double beta = 1.4;
  // One small size in a corner: h grows by ln(beta) times the way along the edges.
  std::vector<double> h(mesh.points.size(), 1);
  h[1] = 0.01;
  h[mesh.points.size() / 2] = 0.1;
  MetricField<D> field(mesh.points.size(), Metric<D>::Identity());
  for (std::size_t n = 1; n < field.size(); ++n) field[n] = isotropic_metric<D>(h[n]);
  for (bool shorter = true; shorter;) {
    shorter = false;
    for_each_way<D>(mesh, [&](NodeId p, NodeId q, const Vec<D>& e) {
      const double way = h[p] + std::log(beta) * e.norm();
      if (way < h[q]) h[q] = way, shorter = true;
    });
  }
  for (const GradationKind kind : kKinds) {
    ConditionParams params;
    params.gradation = beta;
    params.gradation_kind = kind;
    const auto r = conditioned<D>(mesh, field, params);
    ASSERT_EQ(r.report.steps.size(), 1u);
    EXPECT_TRUE(r.report.steps[0].settled);
    const double tolerance = kind == GradationKind::isotropic ? 1e-9 : 2e-3;
    for (std::size_t n = 1; n < field.size(); ++n) {
      const Vec<D> after = sizes<D>(r.metric[n]);
      EXPECT_NEAR(after[0], h[n], tolerance * h[n]);
      EXPECT_NEAR(after[D - 1], h[n], tolerance * h[n]);
    }
  }
}

TYPED_TEST(MetricConditioningAnyDimension, IsotropicGradationBoundsEveryEdgeAndKeepsShapes) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const auto field = random_field<D>(mesh, 30);
  ConditionParams params;
  params.gradation = 1.5;
  params.gradation_kind = GradationKind::isotropic;
  const auto r = conditioned<D>(mesh, field, params);
  const ConditionStep& step = r.report.steps.at(0);
  EXPECT_TRUE(step.settled);
  EXPECT_GT(step.nodes, mesh.node_count() / 4);
  EXPECT_GT(step.size_largest, 1.5);
  EXPECT_NEAR(step.anisotropy_lost, 1, 1e-9);
  EXPECT_NEAR(step.anisotropy_mean, 1, 1e-9);
  for_each_way<D>(mesh, [&](NodeId p, NodeId q, const Vec<D>& e) {
    const double hp = e.norm() / metric_length<D>(e, r.metric[p]);
    const double hq = e.norm() / metric_length<D>(e, r.metric[q]);
    EXPECT_LE(hq, (hp + std::log(1.5) * e.norm()) * (1 + 1e-9));
  });
  for (std::size_t n = 1; n < field.size(); ++n) {
    const Vec<D> ratio = sizes<D>(r.metric[n]).cwiseQuotient(sizes<D>(field[n]));
    EXPECT_LE(ratio[0], 1 + 1e-12);
    EXPECT_LT((ratio.array() / ratio[0] - 1).abs().maxCoeff(), 1e-9);
    expect_same_axes<D>(field[n], r.metric[n]);
  }
}

TYPED_TEST(MetricConditioningAnyDimension, IntersectionGradationBoundsEveryEdgeAndNeverCoarsens) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const auto field = random_field<D>(mesh, 30);
  ConditionParams params;
  params.gradation = 1.5;
  params.max_anisotropy = 40;  // held in the fixed point too
  const auto r = conditioned<D>(mesh, field, params);
  const ConditionStep& step = r.report.steps.at(1);
  EXPECT_EQ(step.kind, Kind::gradation);
  EXPECT_TRUE(step.settled);
  EXPECT_GT(step.nodes, mesh.node_count() / 4);
  for_each_way<D>(mesh, [&](NodeId p, NodeId q, const Vec<D>& e) {
    const double growth = 1 + std::log(1.5) * metric_length<D>(e, r.metric[p]);
    EXPECT_TRUE(above<D>(r.metric[q], r.metric[p] / (growth * growth), 1.1e-3));
  });
  for (std::size_t n = 1; n < field.size(); ++n) {
    EXPECT_TRUE(above<D>(r.metric[n], field[n], 1e-9));
    const Vec<D> h = sizes<D>(r.metric[n]);
    EXPECT_LE(h[D - 1], 40 * h[0] * (1 + 1e-9));
  }
}

TYPED_TEST(MetricConditioningAnyDimension, IntersectionGradationKeepsSharedAxes) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  std::mt19937 rng(4);
  const Mat<D> axes = test::random_rotation<D>(rng);
  MetricField<D> field(mesh.points.size(), Metric<D>::Identity());
  for (std::size_t n = 1; n < field.size(); ++n) {
    Vec<D> h;
    for (int k = 0; k < D; ++k) h[k] = std::pow(0.01, test::uniform(rng, 0, 1));
    field[n] = metric_from_sizes<D>(axes, h);
  }
  ConditionParams params;
  params.gradation = 1.3;
  const auto r = conditioned<D>(mesh, field, params);
  EXPECT_GT(r.report.steps.at(0).nodes, 0u);
  for (std::size_t n = 1; n < field.size(); ++n) {
    const Mat<D> seen = axes.transpose() * r.metric[n] * axes;
    const Mat<D> rest = seen - Mat<D>(seen.diagonal().asDiagonal());
    EXPECT_LT(rest.norm(), 1e-9 * seen.norm());
    // Along a shared axis no size falls below the smallest there.
    for (int k = 0; k < D; ++k) EXPECT_LE(seen(k, k), 1e4 * (1 + 1e-9));
  }
}

TYPED_TEST(MetricConditioningAnyDimension, TurningAndRenumberingTurnAndRenumberTheResult) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const auto field = random_field<D>(mesh, 20);
  std::mt19937 rng(9);
  const Mat<D> turn = test::random_rotation<D>(rng);
  std::vector<NodeId> id(mesh.points.size());
  std::iota(id.begin(), id.end(), 0);
  for (std::size_t n = id.size() - 1; n > 1; --n) std::swap(id[n], id[1 + rng() % n]);
  SimplexMesh<D> other = mesh;
  MetricField<D> turned = field;
  for (std::size_t n = 1; n < id.size(); ++n) {
    other.points[id[n]] = turn * mesh.points[n];
    turned[id[n]] = turn * field[n] * turn.transpose();
  }
  for (auto& e : other.elements)
    for (NodeId& n : e) n = id[n];
  std::reverse(other.elements.begin(), other.elements.end());
  for (const GradationKind kind : kKinds) {
    ConditionParams params;
    params.h_min = 0.06;
    params.max_anisotropy = 8;
    params.gradation = 1.4;
    params.gradation_kind = kind;
    params.elements = 5000;
    const auto a = conditioned<D>(mesh, field, params);
    const auto b = conditioned<D>(other, turned, params);
    EXPECT_NEAR(a.report.scale, b.report.scale, 1e-6 * a.report.scale);
    for (std::size_t n = 1; n < id.size(); ++n) {
      const Metric<D> back = turn.transpose() * b.metric[id[n]] * turn;
      EXPECT_LT((back - a.metric[n]).norm(), 2e-3 * a.metric[n].norm());
    }
  }
}

TYPED_TEST(MetricConditioningAnyDimension, TheElementsAskedAreReachedUnderAllBounds) {
  constexpr int D = TypeParam::value;
  const auto mesh = mesh_of<D>();
  const auto field = random_field<D>(mesh, 10);
  const double before = conditioned<D>(mesh, field, {}).report.elements_before;
  for (const double share : {0.1, 1.0, 30.0}) {
    ConditionParams params;
    params.elements = share * before;
    const auto plain = conditioned<D>(mesh, field, params);
    EXPECT_TRUE(plain.report.elements_reached);
    EXPECT_NEAR(plain.report.elements_after, share * before, 0.01 * share * before);
    EXPECT_NEAR(plain.report.scale, std::pow(share, -1.0 / D), 0.01 * plain.report.scale);

    params.h_max = 0.6;
    params.h_min = 0.02;
    params.max_anisotropy = 4;
    params.gradation = 1.6;
    for (const GradationKind kind : kKinds) {
      params.gradation_kind = kind;
      const auto bounded = conditioned<D>(mesh, field, params);
      // Sizes of 0.6 and .1 of the elements exclude each other.
      const double least = 1 / unit_simplex_measure(D) / std::pow(0.6, D);
      EXPECT_EQ(bounded.report.elements_reached, 1.01 * share * before > least);
      if (!bounded.report.elements_reached) continue;
      EXPECT_NEAR(bounded.report.elements_after, share * before, 0.01 * share * before);
      for (std::size_t n = 1; n < field.size(); ++n) {
        const Vec<D> h = sizes<D>(bounded.metric[n]);
        EXPECT_GE(h[0], 0.02 * (1 - 1e-9));
        EXPECT_LE(h[D - 1], 0.6 * (1 + 1e-9));
      }
      // What the report forecasts is what the metric says.
      EXPECT_NEAR(allocation_factor<D>(mesh, bounded.metric) * mesh.elements.size(),
                  bounded.report.elements_after, 1e-9 * bounded.report.elements_after);
    }
  }
}

TYPED_TEST(MetricConditioningAnyDimension, TheThreadsChangeNothing) {
  constexpr int D = TypeParam::value;
  const auto mesh = unit_box<D>(D == 2 ? 60 : D == 3 ? 14 : 5);
  const auto field = random_field<D>(mesh, 20);
  for (const GradationKind kind : kKinds) {
    ConditionParams params;
    params.h_min = 0.06;
    params.gradation = 1.4;
    params.gradation_kind = kind;
    params.elements = 1e5;
    params.threads = 1;
    const auto one = conditioned<D>(mesh, field, params);
    params.threads = 2;
    const auto two = conditioned<D>(mesh, field, params);
    EXPECT_EQ(one.metric, two.metric);
    EXPECT_EQ(one.report.elements_after, two.report.elements_after);
    EXPECT_EQ(one.report.steps.back().size_mean, two.report.steps.back().size_mean);
  }
}

TEST(MetricConditioning, TheReportCountsWhatEachStepDid) {
  const auto mesh = unit_box<2>(4);
  MetricField<2> field(mesh.points.size(), metric_from_sizes<2>(Mat<2>::Identity(), {0.1, 0.4}));
  field[3] = metric_from_sizes<2>(Mat<2>::Identity(), {0.005, 0.4});
  field[7] = metric_from_sizes<2>(Mat<2>::Identity(), {0.1, 2});
  ConditionParams params;
  params.h_min = 0.01;
  params.h_max = 1;
  params.max_anisotropy = 5;
  const auto r = conditioned<2>(mesh, field, params);
  const auto& steps = r.report.steps;
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].kind, Kind::h_min);
  EXPECT_EQ(steps[0].nodes, 1u);
  EXPECT_NEAR(steps[0].size_largest, 2, 1e-9);
  EXPECT_NEAR(steps[0].anisotropy_lost, 2, 1e-9);
  EXPECT_EQ(steps[1].kind, Kind::h_max);
  EXPECT_EQ(steps[1].nodes, 1u);
  EXPECT_NEAR(steps[1].size_mean, 2, 1e-9);
  EXPECT_EQ(steps[2].kind, Kind::anisotropy);
  EXPECT_EQ(steps[2].nodes, 2u);  // 0.01 x 0.4 -> 0.05, a factor of 8; 0.1 x 1 -> 0.5, of 2
  EXPECT_NEAR(steps[2].size_largest, 8, 1e-9);
  EXPECT_NEAR(steps[2].size_mean, 4, 1e-9);
  EXPECT_NEAR(steps[2].anisotropy_lost, 8, 1e-9);
  EXPECT_NEAR(steps[2].anisotropy_mean, 0.25, 1e-9);
  EXPECT_EQ(steps[0].elements_before, r.report.elements_before);
  EXPECT_EQ(steps[1].elements_before, steps[0].elements_after);
  EXPECT_EQ(steps[2].elements_before, steps[1].elements_after);
  EXPECT_EQ(r.report.elements_after, steps[2].elements_after);
  EXPECT_LT(steps[0].elements_after, steps[0].elements_before);
  EXPECT_GT(steps[1].elements_after, steps[1].elements_before);
}

TEST(MetricConditioning, AThinLayerKeepsItsAnisotropyUnderTheIntersection) {
  // Thin across z near the middle, long in the plane: growth across must not shrink the plane.
  const auto mesh = box_mesh<3>({4, 4, 60}, Vec<3>::Zero(), Vec<3>::Ones());
  const auto asked = *named_metric<3>("linear");
  const auto field = sample_metric<3>(asked, mesh.points);
  ConditionParams params;
  params.gradation = 1.1;  // the metric itself grows faster
  const auto r = conditioned<3>(mesh, field, params);
  EXPECT_GT(r.report.steps.at(0).nodes, mesh.node_count() / 4);
  for (std::size_t n = 1; n < field.size(); ++n) {
    const Mat<3>& m = r.metric[n];
    EXPECT_NEAR(size_from_eigenvalue(m(0, 0)), 0.1, 1e-3);
    EXPECT_NEAR(size_from_eigenvalue(m(1, 1)), 0.1, 1e-3);
    EXPECT_LE(size_from_eigenvalue(m(2, 2)), size_from_eigenvalue(field[n](2, 2)) * (1 + 1e-9));
  }
}

TEST(MetricConditioning, APlateauOfTheBoundsIsCrossed) {
  // All sizes are above h_max until the scale is below 1/100.
  const auto mesh = unit_box<2>(6);
  const MetricField<2> field(mesh.points.size(), isotropic_metric<2>(100));
  ConditionParams params;
  params.h_max = 1;
  params.elements = 3000;
  const auto r = conditioned<2>(mesh, field, params);
  EXPECT_TRUE(r.report.elements_reached);
  EXPECT_NEAR(r.report.elements_after, 3000, 30);
  params.h_min = 0.5;
  const auto coarse = conditioned<2>(mesh, field, params);
  EXPECT_FALSE(coarse.report.elements_reached);
  EXPECT_NEAR(coarse.report.elements_after, 4 / unit_simplex_measure(2), 1e-6);
}

TEST(MetricConditioning, TellsWhatCannotBeAsked) {
  const auto mesh = unit_box<3>(2);
  MetricField<3> field(mesh.points.size(), Metric<3>::Identity());
  const auto code = [&](auto set) {
    ConditionParams params;
    set(params);
    const auto r = condition_metric<3>(mesh, field, params);
    return r.ok() ? Code::failed : r.error().code;
  };
  EXPECT_EQ(code([](auto& p) { p.h_min = 0; }), Code::usage);
  EXPECT_EQ(code([](auto& p) { p.h_max = -1; }), Code::usage);
  EXPECT_EQ(code([](auto& p) { p.h_min = 2, p.h_max = 1; }), Code::usage);
  EXPECT_EQ(code([](auto& p) { p.max_anisotropy = 0.5; }), Code::usage);
  EXPECT_EQ(code([](auto& p) { p.gradation = 1; }), Code::usage);
  EXPECT_EQ(code([](auto& p) { p.elements = 0; }), Code::usage);
  EXPECT_EQ(condition_metric<3>({}, {}, {}).error().code, Code::bad_input);
  field[4] = -field[4];
  EXPECT_EQ(condition_metric<3>(mesh, field, {}).error().code, Code::bad_input);
  field.pop_back();
  EXPECT_EQ(condition_metric<3>(mesh, field, {}).error().code, Code::bad_input);
}

TEST(MetricConditioning, HonorsCancel) {
  const auto mesh = unit_box<3>(8);
  const auto field = random_field<3>(mesh, 100);
  ConditionParams params;
  params.gradation = 1.2;
  params.elements = 1e6;
  for (const double when : {0.0, 0.05, 0.3, 0.8}) {
    std::stop_source stop;
    const Progress progress(
        [&](double f, std::string_view) {
          if (f >= when) stop.request_stop();
        },
        stop.get_token());
    if (when == 0) stop.request_stop();
    const auto r = condition_metric<3>(mesh, field, params, progress);
    ASSERT_FALSE(r.ok()) << when;
    EXPECT_EQ(r.error().code, Code::cancelled);
  }
}

}  // namespace
}  // namespace lamella
