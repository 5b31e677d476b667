#include "core/mesh/slice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"
#include "tests/support/random_metric.h"

namespace lamella {
namespace {

template <int D>
MeshReport valid_report(const SimplexMesh<D>& mesh) {
  const auto report = inspect(mesh);
  EXPECT_TRUE(report->valid()) << report->first_finding;
  return *report;
}

/// Moves the inner nodes of a unit box of n cells by up to a share of the cell.
template <int D>
void jitter(SimplexMesh<D>& mesh, int n, std::mt19937& rng) {
  for (std::size_t v = 1; v < mesh.points.size(); ++v) {
    Vec<D>& x = mesh.points[v];
    if (x.minCoeff() == 0 || x.maxCoeff() == 1) continue;
    for (int k = 0; k < D; ++k) x[k] += test::uniform(rng, -0.1, 0.1) / n;
  }
}

/// The same mesh with its nodes numbered at random.
template <int D>
void renumber(SimplexMesh<D>& mesh, std::mt19937& rng) {
  std::vector<NodeId> id(mesh.points.size());
  std::iota(id.begin(), id.end(), 0);
  std::shuffle(id.begin() + 1, id.end(), rng);
  auto points = mesh.points;
  for (std::size_t v = 0; v < id.size(); ++v) points[id[v]] = mesh.points[v];
  mesh.points = points;
  for (auto& e : mesh.elements)
    for (NodeId& v : e) v = id[v];
  for (auto& f : mesh.facets)
    for (NodeId& v : f) v = id[v];
}

template <int D>
void check_unit_box() {
  std::mt19937 rng(3);
  for (const bool jittered : {false, true}) {
    auto mesh = unit_box<D>(4);
    if (jittered) jitter(mesh, 4, rng);
    if (jittered) renumber(mesh, rng);
    // Through nodes, through both ends, near nodes, anywhere.
    std::vector<double> values = {0, 1, 0.5, 0.25, 0.5 + 1e-12, 0.5 - 1e-7, 0.75 + 1e-5};
    for (int i = 0; i < 10; ++i) values.push_back(test::uniform(rng, 0, 1));
    for (int i = 0; i < 10; ++i) values.push_back(mesh.points[1 + 7 * i][D - 1]);
    for (const double value : values) {
      const auto cut = slice<D>(mesh, value);
      ASSERT_TRUE(cut.ok()) << cut.error().message;
      const auto report = valid_report(cut->mesh);
      EXPECT_NEAR(report.volume, 1, 1e-12) << value;
      EXPECT_NEAR(report.boundary_area, 2 * (D - 1), 1e-12) << value;
    }
  }
}

TEST(Slice, OfAUnitBoxIsAUnitBoxWhereverItIsCut) {
  check_unit_box<4>();
  check_unit_box<3>();
}

/// Integral over x_(D-1) of the measure of the slices: a polynomial of degree D - 1 <= 3 between
/// nodes, for which two Gauss points are exact.
template <int D>
void check_integral(SimplexMesh<D> mesh) {
  std::mt19937 rng(11);
  // No facet and no edge along the hyperplane.
  const Mat<D> rotation = test::random_rotation<D>(rng);
  for (Vec<D>& x : mesh.points) x = rotation * x;
  std::vector<double> levels;
  for (std::size_t v = 1; v < mesh.points.size(); ++v) levels.push_back(mesh.points[v][D - 1]);
  std::sort(levels.begin(), levels.end());
  double measure = 0;
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    const double middle = (levels[i] + levels[i + 1]) / 2, half = (levels[i + 1] - levels[i]) / 2;
    if (half < 1e-6) continue;
    for (const double g : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}) {
      const auto cut = slice<D>(mesh, middle + g * half);
      ASSERT_TRUE(cut.ok()) << cut.error().message;
      measure += half * valid_report(cut->mesh).volume;
    }
  }
  const double whole = valid_report(mesh).volume;
  EXPECT_NEAR(measure, whole, 1e-9 * whole);
}

TEST(Slice, SlicesSumToTheMeasureOfTheMesh) {
  check_integral<4>(equilateral_simplex<4>());
  check_integral<4>(unit_box<4>(1));
  check_integral<4>(ball_mesh<4>(2, 1.5));
  check_integral<3>(ball_mesh<3>(4, 1.5));
  check_integral<3>(l_shape<3>(2));
}

TEST(Slice, SidesKeepTheirGroupsAndCadFaces) {
  auto mesh = unit_box<4>(2);
  mesh.groups = {"x0", "x1", "y0", "y1", "z0", "z1", "t0", "t1"};
  mesh.facet_group = mesh.facet_face;
  for (const double time : {0.0, 0.3, 0.5, 1.0}) {
    const auto cut = slice<4>(mesh, time);
    ASSERT_TRUE(cut.ok());
    EXPECT_EQ(cut->mesh.groups, mesh.groups);
    std::array<double, 8> area{};
    for (std::size_t f = 0; f < cut->mesh.facets.size(); ++f) {
      const Vec<3> normal = facet_normal<3>(cut->mesh.corners(cut->mesh.facets[f])) / 2;
      const int side = cut->mesh.facet_group[f];
      EXPECT_EQ(cut->mesh.facet_face[f], side);
      area[side] += normal.norm();
      // The side lies where its name says.
      EXPECT_NEAR(normal.normalized()[side / 2], side % 2 ? 1 : -1, 1e-12);
    }
    for (int side = 0; side < 6; ++side) EXPECT_NEAR(area[side], 1, 1e-12) << time;
    EXPECT_EQ(area[6] + area[7], 0) << time;
  }
}

TEST(Slice, BodiesKeepTheirShare) {
  const auto mesh = two_body_box<4>(2);
  for (const double time : {0.0, 0.37, 0.5}) {
    const auto cut = slice<4>(mesh, time);
    ASSERT_TRUE(cut.ok());
    EXPECT_EQ(cut->mesh.bodies, mesh.bodies);
    for (std::size_t e = 0; e < cut->mesh.elements.size(); ++e) {
      double x = 0;
      for (const NodeId v : cut->mesh.elements[e]) x += cut->mesh.points[v][0] / 4;
      EXPECT_EQ(cut->mesh.element_body[e], x > 0.5 ? 1 : 0) << time;
    }
  }
}

TEST(Slice, WhereTheDomainEndsOnTheHyperplaneTheClosedCrossSectionCounts) {
  // The L of the plane x, y turned so that x is the last axis: narrower beyond x = 1, or before.
  for (const bool mirrored : {false, true}) {
    auto mesh = l_shape<4>(1);
    for (std::size_t v = 1; v < mesh.points.size(); ++v) {
      Vec<4>& x = mesh.points[v];
      x = mirrored ? Vec<4>(x[1], x[2], x[3], 2 - x[0]) : Vec<4>(x[1], x[2], x[3], x[0]);
    }
    // Three axes turned round is odd: one reflection makes up for it.
    if (!mirrored)
      for (auto& e : mesh.elements) std::swap(e[0], e[1]);
    mesh.facets.clear();
    const auto volume_at = [&](double value) {
      const auto cut = slice<4>(mesh, value);
      EXPECT_TRUE(cut.ok());
      return valid_report(cut->mesh).volume;
    };
    EXPECT_NEAR(volume_at(1), 2, 1e-12);
    EXPECT_NEAR(volume_at(mirrored ? 1.5 : 0.5), 2, 1e-12);
    EXPECT_NEAR(volume_at(mirrored ? 0.5 : 1.5), 1, 1e-12);
  }
}

TEST(Slice, TheMetricIsTheBlockOfSpaceOfTheInterpolatedOne) {
  std::mt19937 rng(5);
  const auto mesh = unit_box<4>(3);
  // Linear in x: interpolation is exact.
  const Metric<4> m0 = test::random_metric<4>(rng, 10);
  std::array<Metric<4>, 4> slope;
  for (auto& s : slope) s = test::random_metric<4>(rng, 10);
  const auto at = [&](const Vec<4>& x) {
    Metric<4> m = m0;
    for (int k = 0; k < 4; ++k) m += x[k] * slope[k];
    return m;
  };
  MetricField<4> metric;
  for (const Vec<4>& x : mesh.points) metric.push_back(at(x));
  for (const double time : {1 / 3.0, 0.4}) {
    const auto cut = slice<4>(mesh, time, metric);
    ASSERT_TRUE(cut.ok());
    ASSERT_EQ(cut->metric.size(), cut->mesh.points.size());
    for (std::size_t v = 1; v < cut->metric.size(); ++v) {
      Vec<4> x;
      x << cut->mesh.points[v], time;
      EXPECT_LT((cut->metric[v] - at(x).topLeftCorner<3, 3>()).norm(), 1e-12 * at(x).norm());
    }
  }
  EXPECT_TRUE(slice<4>(mesh, 0.4)->metric.empty());
}

TEST(Slice, RefusesWhatHasNoCrossSection) {
  const auto mesh = unit_box<4>(1);
  for (const double value : {-0.1, 1.1, std::nan("")}) {
    const auto cut = slice<4>(mesh, value);
    ASSERT_FALSE(cut.ok()) << value;
    EXPECT_EQ(cut.error().code, Code::usage);
    EXPECT_NE(cut.error().message.find("from 0 to 1"), std::string::npos) << cut.error().message;
  }
  EXPECT_EQ(slice<4>({}, 0).error().code, Code::usage);
  // A corner alone has no measure.
  const auto simplex = equilateral_simplex<4>();
  double top = -1;
  for (std::size_t v = 1; v < simplex.points.size(); ++v) top = std::max(top, simplex.points[v][3]);
  EXPECT_FALSE(slice<4>(simplex, top).ok());
  EXPECT_EQ(slice<4>(mesh, 0.5, MetricField<4>(3)).error().code, Code::bad_input);
  std::stop_source source;
  source.request_stop();
  EXPECT_EQ(slice<4>(mesh, 0.5, {}, Progress({}, source.get_token())).error().code,
            Code::cancelled);
}

}  // namespace
}  // namespace lamella
