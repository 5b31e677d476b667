#include "core/flow/correction_field.h"

#include <gtest/gtest.h>

#include "core/flow/correction.h"
#include "core/mesh/sample_meshes.h"

namespace lamella {
namespace {

SimplexMesh<3> cube() { return box_mesh<3>({3, 3, 3}, Vec<3>::Zero(), Vec<3>::Ones()); }

TEST(CorrectionField, AnEmptyOneChangesNothing) {
  const Metric<3> asked = Vec<3>(1, 2, 3).asDiagonal();
  EXPECT_EQ(CorrectionField().apply(Vec<3>::Zero(), asked, 1), asked);
  EXPECT_EQ(CorrectionField().factor(Vec<3>::Zero()), 1);
}

TEST(CorrectionField, IsExactWhereTheFieldIsLinear) {
  const SimplexMesh<3> mesh = cube();
  std::vector<Mat<3>> tensors(mesh.points.size(), Mat<3>::Zero());
  std::vector<double> factors(mesh.points.size(), 1);
  for (std::size_t n = 1; n < tensors.size(); ++n) {
    tensors[n](0, 0) = 5 * mesh.points[n][1];
    factors[n] = 1 - 0.5 * mesh.points[n][2];
  }
  const auto added = CorrectionField::adding(mesh, tensors);
  const auto scaled = CorrectionField::scaling(mesh, factors);
  ASSERT_TRUE(added.ok() && scaled.ok());
  const Vec<3> x(0.31, 0.47, 0.83);
  Metric<3> expected = Metric<3>::Identity();
  expected(0, 0) += 5 * x[1];
  EXPECT_LT((added->apply(x, Metric<3>::Identity(), 1e-3) - expected).norm(), 1e-12);
  EXPECT_NEAR(scaled->factor(x), 1 - 0.5 * x[2], 1e-12);
  EXPECT_NEAR(scaled->apply(x, Metric<3>::Identity(), 1e-3)(1, 1), 1 / std::pow(1 - 0.5 * x[2], 2),
              1e-12);
}

TEST(CorrectionField, HMinBoundsTheCorrectionAndLeavesWhatWasFinerBefore) {
  const SimplexMesh<3> mesh = cube();
  const auto field = CorrectionField::adding(
      mesh, std::vector<Mat<3>>(mesh.points.size(), Mat<3>(Vec<3>(0, 0, 900).asDiagonal())));
  ASSERT_TRUE(field.ok());
  const Vec<3> x(0.5, 0.5, 0.5);
  EXPECT_NEAR(field->apply(x, Metric<3>::Identity(), 0.1)(2, 2), 100, 1e-9);
  const Metric<3> fine = Vec<3>(400, 1, 1).asDiagonal();
  EXPECT_NEAR(field->apply(x, fine, 0.1)(0, 0), 400, 1e-9);
  EXPECT_NEAR(field->apply(x, fine, 0.1)(2, 2), 400, 1e-9);
}

TEST(RefineEvenly, NeverCoarsensAndKeepsItsBudget) {
  const SimplexMesh<3> mesh = cube();
  const MetricField<3> metric = own_metric<3>(mesh);
  std::vector<double> indicator;
  for (const auto& e : mesh.elements) indicator.push_back(0.01 + mesh.points[e[0]][0]);
  const std::vector<double> ones(mesh.points.size(), 1);
  UniformizeParams params;
  for (const double beta : {1.0, 0.5, 0.1}) {
    params.beta = beta;
    params.elements.reset();
    const auto free = refine_evenly<3>(mesh, metric, indicator, ones, params);
    ASSERT_TRUE(free.ok());
    params.elements = 1.3 * free->elements_before;
    const auto held = refine_evenly<3>(mesh, metric, indicator, ones, params);
    ASSERT_TRUE(held.ok());
    EXPECT_LE(held->elements_after, *params.elements);
    EXPECT_GE(held->elements_after, std::min(0.99 * *params.elements, free->elements_after));
    for (std::size_t n = 1; n < held->factors.size(); ++n) {
      EXPECT_LE(held->factors[n], 1);
      EXPECT_GE(held->factors[n], free->factors[n] - 1e-12);
    }
  }
  // What is even already stays; what was refined too much is given back.
  params = {};
  const std::vector<double> even(mesh.elements.size(), 2.5);
  const auto same = refine_evenly<3>(mesh, metric, even, ones, params);
  ASSERT_TRUE(same.ok());
  for (std::size_t n = 1; n < ones.size(); ++n) EXPECT_NEAR(same->factors[n], 1, 1e-12);
  const auto twice = refine_evenly<3>(mesh, metric, indicator,
                                      std::vector<double>(mesh.points.size(), 0.5), params);
  ASSERT_TRUE(twice.ok());
  EXPECT_GT(*std::max_element(twice->factors.begin() + 1, twice->factors.end()), 0.5);
}

}  // namespace
}  // namespace lamella
