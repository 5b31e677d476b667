#include "core/natural/layer_correction.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/box_mesh.h"

namespace lamella {
namespace {

constexpr double nobody = std::numeric_limits<double>::quiet_NaN();

LayerCorrection learnt(const LayerCorrection& before, const SimplexMesh<3>& mesh,
                       const std::vector<double>& layers, double wanted) {
  const auto result = LayerCorrection::learn(before, mesh, layers, wanted);
  EXPECT_TRUE(result);
  return *result;
}

TEST(LayerCorrection, KnowsNothingAtFirst) {
  const LayerCorrection none;
  EXPECT_EQ(none.at({1, 2, 3}), 1);
  const Metric<3> m = Vec<3>(1, 2, 3).asDiagonal();
  EXPECT_EQ(none.apply({1, 2, 3}, m, 0), m);
}

TEST(LayerCorrection, AsksForWhatIsMissingAndNoMore) {
  const auto mesh = test::box_mesh(4, 4, 2);
  const LayerCorrection once = learnt({}, mesh, std::vector<double>(mesh.points.size(), 4.0), 4.4);
  EXPECT_NEAR(once.at({2.2, 1.7, 0.6}), 1.1, 1e-12);
  // A mesh that has what is wanted leaves the factor that made it.
  const LayerCorrection twice =
      learnt(once, mesh, std::vector<double>(mesh.points.size(), 4.4), 4.4);
  EXPECT_NEAR(twice.at({2.2, 1.7, 0.6}), 1.1, 1e-12);
}

TEST(LayerCorrection, StaysWithinItsBounds) {
  const auto mesh = test::box_mesh(2, 2, 2);
  const std::size_t n = mesh.points.size();
  EXPECT_NEAR(learnt({}, mesh, std::vector<double>(n, 1.0), 100).at({1, 1, 1}), 1.6, 1e-12);
  EXPECT_NEAR(learnt({}, mesh, std::vector<double>(n, 100.0), 1).at({1, 1, 1}), 0.75, 1e-12);
}

TEST(LayerCorrection, LeavesAloneWhatWasNotMeasured) {
  const auto mesh = test::box_mesh(8, 2, 2);
  std::vector<double> layers(mesh.points.size(), nobody);
  for (std::size_t i = 1; i < layers.size(); ++i)
    if (mesh.points[i][0] < 3.5) layers[i] = 3;
  const LayerCorrection half = learnt({}, mesh, layers, 4);
  EXPECT_NEAR(half.at({1.3, 1, 1}), 4.0 / 3, 1e-12);
  EXPECT_NEAR(half.at({6.5, 1, 1}), 1, 1e-12);
}

TEST(LayerCorrection, DividesOnlyTheSizesThatAreDivided) {
  const auto mesh = test::box_mesh(2, 2, 2);
  const LayerCorrection finer = learnt({}, mesh, std::vector<double>(mesh.points.size(), 4.0), 5);
  const Vec<3> sizes(0.1, 0.15, 1);
  const Metric<3> asked = sizes.cwiseProduct(sizes).cwiseInverse().asDiagonal();
  const Metric<3> got = finer.apply({1, 1, 1}, asked, 0);
  const Vec<3> now = got.diagonal().cwiseSqrt().cwiseInverse();
  EXPECT_NEAR(now[0], 0.1 / 1.25, 1e-12);
  EXPECT_NEAR(now[1], 0.15 / 1.25, 1e-12);
  EXPECT_NEAR(now[2], 1, 1e-12);
  EXPECT_NEAR((got - Metric<3>(got.diagonal().asDiagonal())).norm(), 0, 1e-9);
  // The smallest size holds, also where the detector went there already.
  EXPECT_NEAR(1 / std::sqrt(finer.apply({1, 1, 1}, asked, 0.09)(0, 0)), 0.09, 1e-12);
  EXPECT_NEAR(1 / std::sqrt(finer.apply({1, 1, 1}, asked, 0.1)(0, 0)), 0.1, 1e-12);
}

TEST(LayerCorrection, StopsWhenCancelled) {
  const auto mesh = test::box_mesh(2, 2, 2);
  std::stop_source stop;
  stop.request_stop();
  const auto result = LayerCorrection::learn({}, mesh, std::vector<double>(mesh.points.size(), 4.0),
                                             5, 0, Progress({}, stop.get_token()));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Code::cancelled);
}

}  // namespace
}  // namespace lamella
