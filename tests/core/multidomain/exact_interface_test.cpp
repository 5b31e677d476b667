#include "core/multidomain/exact_interface.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>
#include <stop_token>

#include "core/geometry/locator.h"
#include "core/geometry/soup.h"
#include "core/mesh/boundary.h"
#include "core/mesh/interfaces.h"
#include "core/mesh/quality.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"
#include "core/multidomain/balance.h"
#include "core/multidomain/hold.h"
#include "tests/support/adapt_cases.h"
#include "tests/support/sample_surfaces.h"

namespace lamella {
namespace {

using testing::box_surface;
using testing::moved;
using testing::sphere_surface;
using testing::turn;

constexpr double far_size = 0.2, near_size = 0.05;

/// Regions in the unit box with their surfaces.
struct Case {
  std::vector<Region<3>> regions;
  std::vector<ReferenceSurface<3>> surfaces;
  std::vector<double> volumes;  ///< of the regions within the box, without the background
  std::vector<double> areas;    ///< of the curved part of their borders
  double tolerance = 0.01;

  void add(const std::string& name, ZonePtr<3> zone, ReferenceSurface<3> surface, double volume,
           double area = 0) {
    regions.push_back({name, std::move(zone)});
    surfaces.push_back(std::move(surface));
    volumes.push_back(volume);
    areas.push_back(area);
  }
  void add_box(const std::string& name, const Vec<3>& low, const Vec<3>& high, double volume,
               const Mat<3>& rotation = Mat<3>::Identity()) {
    const Vec<3> size = high - low, center = 0.5 * (low + high);
    const auto centered = moved<3>(box_surface(size), Mat<3>::Identity(), Vec<3>(-0.5 * size));
    ReferenceSurface<3> s = moved<3>(centered, rotation, center);
    find_features(s, 0.6);
    add(name, surface_zone<3>(s), s, volume);
  }
  void add_ball(const std::string& name, const Vec<3>& center, double radius, double volume) {
    add(name, ball_zone<3>(center, radius), sphere_surface(radius, 4, center), volume,
        4 * std::numbers::pi * radius * radius);
  }
};

double ball_volume(double r) { return 4.0 / 3 * std::numbers::pi * r * r * r; }

Case ball_in_box() {
  Case c;
  c.add_ball("ball", {0.5, 0.5, 0.5}, 0.3, ball_volume(0.3));
  return c;
}

Case tilted_plate(double azimuth) {
  Case c;
  const double degree = std::numbers::pi / 180;
  c.add_box("plate", {0.2, 0.25, 0.42}, {0.8, 0.75, 0.58}, 0.6 * 0.5 * 0.16,
            turn(azimuth * degree, {0, 0, 1}) * turn(30 * degree, {0, 1, 0}));
  return c;
}

/// The second ball is what the first leaves of it.
Case overlapping_balls() {
  Case c;
  const double r = 0.24, s = 0.22, d = 0.2;
  // The lens that two balls share.
  const double lens = std::numbers::pi * std::pow(r + s - d, 2) *
                      (d * d + 2 * d * s - 3 * s * s + 2 * d * r + 6 * r * s - 3 * r * r) /
                      (12 * d);
  c.add_ball("first", {0.4, 0.5, 0.5}, r, ball_volume(r));
  c.add_ball("second", {0.6, 0.5, 0.5}, s, ball_volume(s) - lens);
  return c;
}

Case touching_boxes() {
  Case c;
  c.add_box("large", {0.2, 0.2, 0.2}, {0.5, 0.8, 0.8}, 0.3 * 0.6 * 0.6);
  c.add_box("small", {0.5, 0.3, 0.35}, {0.8, 0.7, 0.7}, 0.3 * 0.4 * 0.35);
  return c;
}

Case nested_boxes() {
  Case c;
  c.add_box("core", {0.35, 0.35, 0.35}, {0.65, 0.65, 0.65}, 0.027);
  c.add_box("shell", {0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}, 0.216 - 0.027);
  return c;
}

/// Its border ends at the wall.
Case half_space() {
  Case c;
  const Vec<3> normal = Vec<3>(1, 0.4, 0.3).normalized();
  const double offset = normal.dot(Vec<3>(0.45, 0.5, 0.5));
  const Mat<3> r = Eigen::Quaterniond::FromTwoVectors(Vec<3>::UnitX(), normal).toRotationMatrix();
  auto s = moved<3>(box_surface({4, 4, 4}), r, Vec<3>(offset * normal - r * Vec<3>(4, 2, 2)));
  find_features(s, 0.6);
  c.add("half", half_space_zone<3>(normal, offset), s, 0.45);
  return c;
}

Case rod_through_the_box() {
  Case c;
  constexpr int n = 96;
  constexpr double radius = 0.2;
  std::vector<Vec<2>> circle;
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * std::numbers::pi * i / n;
    circle.push_back({0.5 + radius * std::cos(phi), 0.5 + radius * std::sin(phi)});
  }
  auto s = moved<3>(testing::prism_surface(circle, 2), Mat<3>::Identity(), Vec<3>(0, -0.5, 0));
  find_features(s, 0.6);
  c.add("rod", cylinder_zone({0.5, -0.5, 0.5}, {0.5, 1.5, 0.5}, radius), s,
        std::numbers::pi * radius * radius, 2 * std::numbers::pi * radius);
  return c;
}

/// Small across the faces of the surfaces, large along them.
MetricFunction<3> tight(const Case& c) {
  auto locators = std::make_shared<std::vector<Locator<3>>>();
  std::vector<int> faces;
  for (const auto& s : c.surfaces) {
    locators->emplace_back(s);
    faces.push_back(static_cast<int>(s.faces.size()));
  }
  return [locators, faces](const Vec<3>& x) {
    Mat<3> m = isotropic_metric<3>(far_size);
    for (std::size_t z = 0; z < faces.size(); ++z)
      for (int f = 0; f < faces[z]; ++f) {
        const auto on = (*locators)[z].nearest_on_face(x, f);
        const double d = std::sqrt(on->distance2);
        const Vec<3> n = d > 1e-9 ? Vec<3>((x - on->point) / d) : (*locators)[z].normal(on->facet);
        const double h = near_size + 0.5 * std::max(0.0, d - 2 * near_size);
        if (h < far_size)
          m += (eigenvalue_from_size(h) - eigenvalue_from_size(far_size)) * n * n.transpose();
      }
    Spectrum<3> s = spectrum<3>(m);
    s.values = s.values.cwiseMin(eigenvalue_from_size(near_size));
    return Metric<3>(s.vectors * s.values.asDiagonal() * s.vectors.transpose());
  };
}

Adapted<3> fuzzy_mesh(const MetricFunction<3>& metric) {
  Adapted<3> fuzzy{unit_box<3>(5), {}, {}};
  for (int i = 0; i < 3; ++i) {
    auto next = adapt<3>(fuzzy.mesh, {}, nullptr, {}, {}, metric);
    EXPECT_TRUE(next.ok());
    fuzzy = std::move(*next);
  }
  return fuzzy;
}

Exact made_exact(const Case& c, const ExactParams& given = {}) {
  const MetricFunction<3> metric = tight(c);
  const Adapted<3> fuzzy = fuzzy_mesh(metric);
  ExactParams params = given;
  params.adapt.chord_tolerance = c.tolerance;
  auto exact = exact_interfaces(fuzzy.mesh, fuzzy.metric, Partition<3>(c.regions), c.surfaces,
                                params, {}, metric);
  if (!exact.ok()) {
    ADD_FAILURE() << exact.error().message;
    return {};
  }
  return std::move(*exact);
}

/// A lattice of points of a simplex.
template <std::size_t N>
std::vector<Vec<3>> lattice(const std::array<Vec<3>, N>& p, int order) {
  std::vector<Vec<3>> points;
  for (int i = 0; i <= order; ++i)
    for (int j = 0; i + j <= order; ++j)
      for (int k = 0; i + j + k <= order; ++k) {
        const int l = order - i - j - k;
        if constexpr (N == 4)
          points.push_back((i * p[0] + j * p[1] + k * p[2] + l * p[3]) / order);
        else if (k == 0)
          points.push_back((i * p[0] + j * p[1] + l * p[2]) / order);
      }
  return points;
}

bool is_interface(const SimplexMesh<3>& mesh, std::size_t f) {
  return mesh.groups[mesh.facet_group[f]].find('|') != std::string::npos;
}

/// Interfaces lie on the borders, on the CAD faces that they name.
void expect_on_surface(const SimplexMesh<3>& mesh, const ReferenceSurface<3>& surface,
                       const Partition<3>& partition, double tolerance) {
  const Locator<3> locator(surface);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (!is_interface(mesh, f)) continue;
    for (const Vec<3>& x : lattice(mesh.corners(mesh.facets[f]), 3)) {
      ASSERT_LE(std::abs(partition.border(x).distance), tolerance) << x.transpose();
      const auto on = locator.nearest_on_face(x, mesh.facet_face[f]);
      ASSERT_TRUE(on.has_value());
      ASSERT_LE(on->distance2, tolerance * tolerance) << x.transpose();
    }
  }
}

/// Every region has its volume, exactly where it has flat sides.
void expect_volumes(const SimplexMesh<3>& mesh, const Case& c) {
  const std::vector<double> volumes = test::volumes(mesh);
  for (std::size_t k = 0; k < c.volumes.size(); ++k)
    EXPECT_NEAR(volumes[k], c.volumes[k], 1e-9 + c.tolerance * c.areas[k]) << mesh.bodies[k];
}

/// What is promised of every case. `sharp`: surfaces of flat sides, which must come out exactly.
void expect_exact(const Case& c, bool sharp) {
  const Partition<3> partition(c.regions);
  const Exact exact = made_exact(c);
  const SimplexMesh<3>& mesh = exact.mesh;
  const Result<void> good = validate(mesh);
  ASSERT_TRUE(good.ok()) << good.error().message;
  EXPECT_EQ(mesh.bodies, partition.names());
  EXPECT_EQ(exact.lost, 0u);
  const std::vector<double> volumes = test::volumes(mesh);
  double total = 0;
  for (double v : volumes) total += v;
  EXPECT_NEAR(total, 1, 1e-12);
  expect_volumes(mesh, c);
  expect_on_surface(mesh, exact.surface, partition, sharp ? 1e-9 : c.tolerance);

  // Every interface is listed, and nothing else behind the wall.
  const auto listed = list_interfaces(mesh);
  EXPECT_EQ(listed.given, listed.mesh.facets.size());

  const auto quality = element_qualities<3>(mesh, exact.metric);
  EXPECT_GE(*std::min_element(quality.begin(), quality.end()), 0.2);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const Vec<3>& x : lattice(mesh.corners(mesh.elements[e]), 4))
      if (std::abs(partition.border(x).distance) > (sharp ? 1e-9 : c.tolerance)) {
        ASSERT_EQ(partition.region_of(x), mesh.element_body[e]) << x.transpose();
      }

  // And back: no part of the borders is missing.
  ReferenceSurface<3> found;
  found.points = mesh.points;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    if (is_interface(mesh, f)) {
      found.facets.push_back(mesh.facets[f]);
      found.facet_face.push_back(0);
    }
  const Locator<3> locator(found);
  for (const auto& s : c.surfaces)
    for (const auto& f : s.facets)
      for (const Vec<3>& x : lattice<3>({s.points[f[0]], s.points[f[1]], s.points[f[2]]},
                                        s.facets.size() > 100 ? 2 : 24)) {
        if (x.minCoeff() < 0 || x.maxCoeff() > 1) continue;
        if (partition.border(x).distance > 0.1 * c.tolerance) continue;  // hidden
        const double most = sharp ? 1e-9 : c.tolerance;
        ASSERT_TRUE(locator.nearest(x, most).has_value()) << x.transpose();
      }
}

TEST(ExactInterface, ABallInABox) { expect_exact(ball_in_box(), false); }
TEST(ExactInterface, ATiltedPlate) { expect_exact(tilted_plate(35), true); }
TEST(ExactInterface, APlateTiltedTheOtherWay) { expect_exact(tilted_plate(125), true); }
TEST(ExactInterface, OverlappingBallsMeetInALine) { expect_exact(overlapping_balls(), false); }
TEST(ExactInterface, ABoxThatTouchesABox) { expect_exact(touching_boxes(), true); }
TEST(ExactInterface, ABoxInABoxIsSharp) { expect_exact(nested_boxes(), true); }
TEST(ExactInterface, AnInterfaceMayEndAtTheWall) { expect_exact(half_space(), true); }
TEST(ExactInterface, ARodThroughTheBox) { expect_exact(rod_through_the_box(), false); }

TEST(ExactInterface, VolumesFollowTheTolerance) {
  Case c = ball_in_box();
  c.tolerance = 0.002;
  const Exact exact = made_exact(c);
  // A chord of the tolerance t takes at most t times the area.
  EXPECT_NEAR(test::volumes(exact.mesh)[0], c.volumes[0], c.tolerance * c.areas[0]);
  expect_on_surface(exact.mesh, exact.surface, Partition<3>(c.regions), 1.05 * c.tolerance);
}

TEST(ExactInterface, TheLineWhereThreeRegionsMeetLiesOnBothSurfaces) {
  const Case c = overlapping_balls();
  const Exact exact = made_exact(c);
  std::map<std::array<NodeId, 2>, std::set<std::int32_t>> groups;
  const SimplexMesh<3>& mesh = exact.mesh;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(mesh.facets[f][k], mesh.facets[f][(k + 1) % 3]);
      groups[{a, b}].insert(mesh.facet_group[f]);
    }
  // A circle in the plane of equal powers.
  const double r = 0.24, s = 0.22, d = 0.2, along = (d * d + r * r - s * s) / (2 * d);
  const double radius = std::sqrt(r * r - along * along);
  double length = 0;
  for (const auto& [edge, around] : groups) {
    if (around.size() < 2) continue;
    EXPECT_EQ(around.size(), 3u);
    const Vec<3> a = mesh.points[edge[0]], b = mesh.points[edge[1]];
    length += (b - a).norm();
    for (const Vec<3>& x : {a, b}) {
      EXPECT_NEAR(x[0], 0.4 + along, c.tolerance);
      EXPECT_NEAR(std::hypot(x[1] - 0.5, x[2] - 0.5), radius, c.tolerance);
    }
  }
  EXPECT_NEAR(length, 2 * std::numbers::pi * radius, 0.05 * length);
}

TEST(ExactInterface, DoesNotDependOnThreads) {
  ExactParams one, two;
  one.adapt.threads = 1;
  two.adapt.threads = 2;
  const Exact a = made_exact(overlapping_balls(), one), b = made_exact(overlapping_balls(), two);
  EXPECT_EQ(a.mesh.points, b.mesh.points);
  EXPECT_EQ(a.mesh.elements, b.mesh.elements);
  EXPECT_EQ(a.mesh.element_body, b.mesh.element_body);
  EXPECT_EQ(a.mesh.facet_face, b.mesh.facet_face);
}

TEST(ExactInterface, ARegionWithoutSurfaceIsItsOwn) {
  Case c = ball_in_box();
  c.surfaces[0] = {};
  const MetricFunction<3> metric = tight(ball_in_box());
  const Adapted<3> fuzzy = fuzzy_mesh(metric);
  ExactParams params;
  params.adapt.chord_tolerance = c.tolerance;
  const auto exact = exact_interfaces(fuzzy.mesh, fuzzy.metric, Partition<3>(c.regions), c.surfaces,
                                      params, {}, metric);
  ASSERT_TRUE(exact.ok());
  ASSERT_TRUE(validate(exact->mesh).ok());
  expect_on_surface(exact->mesh, exact->surface, Partition<3>(c.regions), 2 * c.tolerance);
}

TEST(ExactInterface, BodiesStayOnTheirSurfacesWhenTheBackgroundIsDropped) {
  for (const Case& c : {touching_boxes(), overlapping_balls()}) {
    const Exact exact = made_exact(c);
    const Partition<3> partition(c.regions);
    const SimplexMesh<3> bodies = drop_body(exact.mesh, partition.background());
    ASSERT_TRUE(validate(bodies).ok());
    EXPECT_EQ(bodies.bodies.size(), 2u);
    const bool sharp = c.areas[0] == 0;
    for (double h : {0.06, 0.3}) {
      const MetricField<3> metric(bodies.points.size(), isotropic_metric<3>(h));
      AdaptParams params;
      params.chord_tolerance = c.tolerance;
      const auto again = adapt<3>(bodies, metric, &exact.surface, params);
      ASSERT_TRUE(again.ok());
      ASSERT_TRUE(validate(again->mesh).ok());
      expect_on_surface(again->mesh, exact.surface, partition, sharp ? 1e-9 : c.tolerance);
      expect_volumes(again->mesh, c);
      // Every facet was an interface.
      for (std::size_t f = 0; f < again->mesh.facets.size(); ++f)
        ASSERT_TRUE(is_interface(again->mesh, f));
    }
  }
}

/// What elements were counted to before has borders in steps: they must leave no trace.
TEST(ExactInterface, BodiesOfTheMeshGivenDoNotMatter) {
  const Case c = ball_in_box();
  const MetricFunction<3> metric = tight(c);
  SimplexMesh<3> mesh = fuzzy_mesh(metric).mesh;
  const Partition<3> partition(c.regions);
  mesh.bodies = partition.names();
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const auto p = mesh.corners(mesh.elements[e]);
    mesh.element_body[e] = partition.region_of((p[0] + p[1] + p[2] + p[3]) / 4);
  }
  ExactParams params;
  params.adapt.chord_tolerance = c.tolerance;
  const auto exact =
      exact_interfaces(mesh, MetricField<3>(mesh.points.size(), Metric<3>::Identity()), partition,
                       c.surfaces, params, {}, metric);
  ASSERT_TRUE(exact.ok());
  ASSERT_TRUE(validate(exact->mesh).ok());
  expect_volumes(exact->mesh, c);
  const auto quality = element_qualities<3>(exact->mesh, exact->metric);
  EXPECT_GE(*std::min_element(quality.begin(), quality.end()), 0.2);
}

TEST(ExactInterface, TellsWhatIsWrong) {
  const Case c = ball_in_box();
  const SimplexMesh<3> mesh = unit_box<3>(2);
  const MetricField<3> metric(mesh.points.size(), isotropic_metric<3>(0.5));
  const auto missing = exact_interfaces(mesh, metric, Partition<3>(c.regions), {});
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, Code::bad_input);
  const auto empty = exact_interfaces({}, {}, Partition<3>(c.regions), c.surfaces);
  ASSERT_FALSE(empty.ok());
  EXPECT_EQ(empty.error().code, Code::bad_input);
  std::stop_source stop;
  stop.request_stop();
  const auto cancelled = exact_interfaces(mesh, metric, Partition<3>(c.regions), c.surfaces, {},
                                          Progress({}, stop.get_token()));
  ASSERT_FALSE(cancelled.ok());
  EXPECT_EQ(cancelled.error().code, Code::cancelled);
}

TEST(ExactInterface, ASlitThinnerThanTheToleranceCloses) {
  Case c;
  const double slit = 0.3 * c.tolerance;
  c.add_box("large", {0.2, 0.2, 0.2}, {0.5, 0.8, 0.8}, 0.3 * 0.6 * 0.6);
  c.add_box("small", {0.5 + slit, 0.3, 0.35}, {0.8, 0.7, 0.7}, (0.3 - slit) * 0.4 * 0.35);
  const Exact exact = made_exact(c);
  ASSERT_TRUE(validate(exact.mesh).ok());
  for (int k = 0; k < 2; ++k)
    EXPECT_NEAR(test::volumes(exact.mesh)[k], c.volumes[k], slit * 0.4 * 0.35) << k;
  // They share the face between them.
  double shared = 0;
  for (std::size_t f = 0; f < exact.mesh.facets.size(); ++f)
    if (exact.mesh.groups[exact.mesh.facet_group[f]] == "large|small")
      shared += 0.5 * facet_normal<3>(exact.mesh.corners(exact.mesh.facets[f])).norm();
  EXPECT_GT(shared, 0.9 * 0.4 * 0.35);
  EXPECT_LT(shared, 1.002 * 0.4 * 0.35);
}

TEST(BalanceBorders, ABallKeepsItsVolume) {
  const Case c = ball_in_box();
  const Exact exact = made_exact(c);
  const Partition<3> partition(c.regions);
  SimplexMesh<3> mesh = exact.mesh;
  EXPECT_GT(balance_borders(mesh, partition, exact.first_face, {c.tolerance, c.tolerance}), 100u);
  ASSERT_TRUE(validate(mesh).ok());
  EXPECT_LT(std::abs(test::volumes(mesh)[0] - c.volumes[0]),
            0.2 * std::abs(test::volumes(exact.mesh)[0] - c.volumes[0]));
  expect_on_surface(mesh, exact.surface, partition, c.tolerance);
  SimplexMesh<3> again = exact.mesh;
  balance_borders(again, partition, exact.first_face, {c.tolerance, c.tolerance, nullptr, 1});
  EXPECT_EQ(mesh.points, again.points);
  // What is asked may be less.
  again = exact.mesh;
  balance_borders(again, partition, exact.first_face, {1e-3 * c.tolerance, c.tolerance});
  for (std::size_t n = 1; n < again.points.size(); ++n)
    ASSERT_LE((again.points[n] - exact.mesh.points[n]).norm(), 1.01e-3 * c.tolerance);
}

TEST(OntoWall, EndsOfLinesGoToTheWallAlongTheirBorders) {
  const Partition<3> halves({{"low", half_space_zone<3>(Vec<3>(1, 0, 1), 1.3)},
                             {"side", half_space_zone<3>(Vec<3>(0, 1, 0), 0.25)}});
  const Locator<3> wall(box_surface({1, 1, 1}));
  const double reach = 0.01, on = 1e-4;
  // Below the top, on both borders: up along the line that they share.
  const Vec<3> end = onto_wall(wall, halves, {0.306, 0.25, 0.994}, reach, on);
  EXPECT_LT((end - Vec<3>(0.3, 0.25, 1)).norm(), 1e-9);
  // On none: the nearest point; too far: as it was.
  EXPECT_LT((onto_wall(wall, halves, {0.6, 0.6, 0.994}, reach, on) - Vec<3>(0.6, 0.6, 1)).norm(),
            1e-12);
  EXPECT_EQ(onto_wall(wall, halves, {0.4, 0.25, 0.9}, reach, on), Vec<3>(0.4, 0.25, 0.9));
}

TEST(BalanceBorders, FlatSidesAndSharpEdgesStay) {
  const Case c = touching_boxes();
  const Exact exact = made_exact(c);
  SimplexMesh<3> mesh = exact.mesh;
  balance_borders(mesh, Partition<3>(c.regions), exact.first_face, {c.tolerance, c.tolerance});
  for (std::size_t n = 1; n < mesh.points.size(); ++n)
    ASSERT_LT((mesh.points[n] - exact.mesh.points[n]).norm(), 1e-9);
}

}  // namespace
}  // namespace lamella
