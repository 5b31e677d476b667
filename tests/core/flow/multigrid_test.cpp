#include "core/flow/multigrid.h"

#include <gtest/gtest.h>

#include <random>

#include "core/flow/stokes_system.h"
#include "tests/support/flow_meshes.h"

namespace lamella::flow {
namespace {

/// The Laplacian of a channel, fixed at its walls.
Csr laplacian(int cells, double stretch) {
  const auto mesh = test::channel<3>(2 * stretch, cells, stretch);
  FlowCase<3> flow;
  flow.gates = {{"gate", 1.0, {}}};
  flow.vents = {"vent"};
  const auto system = assemble<3>(mesh, flow, {});
  EXPECT_TRUE(system.ok());
  return velocity_matrix<3>(*system, system->wall);
}

Eigen::MatrixXd dense(const Csr& a) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.rows(), a.columns);
  for (std::int32_t i = 0; i < a.rows(); ++i)
    for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) out(i, a.column[e]) = a.value[e];
  return out;
}

template <int K>
std::vector<Vec<K>> random(std::size_t n, int seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> any;
  std::vector<Vec<K>> out(n);
  for (Vec<K>& x : out) x = Vec<K>::NullaryExpr([&] { return any(rng); });
  return out;
}

double dot(const std::vector<Vec<1>>& a, const std::vector<Vec<1>>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i][0] * b[i][0];
  return sum;
}

TEST(Sparse, ProductAndTransposeAreThoseOfMatrices) {
  std::mt19937 rng(1);
  const auto make = [&](std::int32_t rows, std::int32_t columns) {
    Csr a;
    a.columns = columns;
    for (std::int32_t i = 0; i < rows; ++i) {
      for (std::int32_t j = 0; j < columns; ++j)
        if (rng() % 4 == 0) {
          a.column.push_back(j);
          a.value.push_back(static_cast<double>(rng() % 100) - 50);
        }
      a.start.push_back(static_cast<std::int32_t>(a.column.size()));
    }
    return a;
  };
  const Csr a = make(37, 23), b = make(23, 41);
  EXPECT_EQ(dense(transpose(a)), dense(a).transpose());
  EXPECT_EQ(dense(product(a, b)), dense(a) * dense(b));
}

TEST(Multigrid, ACycleIsSymmetricPositiveAndBelowTheInverse) {
  const Csr a = laplacian(12, 50);
  const auto n = static_cast<std::size_t>(a.rows());
  auto v = Multigrid::build(a, {});
  ASSERT_TRUE(v);
  ASSERT_GT(v->levels(), 1);
  const auto x = random<1>(n, 1), y = random<1>(n, 2);
  std::vector<Vec<1>> vx(n), vy(n), ax(n), vax(n);
  v->apply<1>(x, vx);
  v->apply<1>(y, vy);
  EXPECT_NEAR(dot(vx, y), dot(x, vy), 1e-10 * std::abs(dot(vx, x)));
  EXPECT_GT(dot(vx, x), 0);
  // The eigenvalues of V A are at most 1, so A V A <= A.
  multiply<1>(a, x, ax);
  v->apply<1>(ax, vax);
  EXPECT_LE(dot(ax, vax), dot(ax, x) * (1 + 1e-10));
}

TEST(Multigrid, SeveralColumnsAreEachTheirOwn) {
  const Csr a = laplacian(10, 2);
  const auto n = static_cast<std::size_t>(a.rows());
  auto v = Multigrid::build(a, {});
  ASSERT_TRUE(v);
  const auto three = random<3>(n, 4);
  std::vector<Vec<3>> all(n);
  v->apply<3>(three, all);
  for (int k = 0; k < 3; ++k) {
    std::vector<Vec<1>> one(n), found(n);
    for (std::size_t i = 0; i < n; ++i) one[i][0] = three[i][k];
    v->apply<1>(one, found);
    for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(found[i][0], all[i][k], 1e-12);
  }
}

// One cycle after another, x += V (b - A x), converges as fast on a finer mesh and on stretched
// elements.
TEST(Multigrid, ConvergesAlikeOnFineAndStretchedMeshes) {
  for (const double stretch : {1.0, 50.0, 100.0})
    for (const int cells : {8, 16}) {
      const Csr a = laplacian(cells, stretch);
      const auto n = static_cast<std::size_t>(a.rows());
      auto v = Multigrid::build(a, {});
      ASSERT_TRUE(v);
      EXPECT_LT(v->complexity(), 2.5);
      auto e = random<1>(n, 3);
      std::vector<Vec<1>> ae(n), d(n);
      double before = 0, energy = 0;
      for (int it = 0; it < 12; ++it) {
        multiply<1>(a, e, ae);
        before = energy;
        energy = dot(e, ae);
        v->apply<1>(ae, d);
        for (std::size_t i = 0; i < n; ++i) e[i] -= d[i];
      }
      EXPECT_LT(std::sqrt(energy / before), 0.65) << stretch << " " << cells;
    }
}

TEST(Multigrid, CancelIsHeard) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(Multigrid::build(laplacian(4, 1), Progress({}, stop.get_token())));
}

}  // namespace
}  // namespace lamella::flow
