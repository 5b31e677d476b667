#include "core/optimize/generate.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "core/mesh/sample_meshes.h"
#include "core/optimize/certificate.h"
#include "tests/support/test_surfaces.h"

namespace lamella {
namespace {

/// Theorem 2.2 makes the certificate the whole proof; the rest is the contract of VolumeMesher.
template <int D>
void expect_meshed(const ReferenceSurface<D>& surface, const GenerateParams& params = {}) {
  const auto mesh = generate<D>(surface, params);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const auto valid = certify<D>(*mesh, surface);
  EXPECT_TRUE(valid.ok()) << valid.error().message;
  EXPECT_EQ(mesh->facets.size(), surface.facets.size());
  EXPECT_EQ(mesh->facet_face, surface.facet_face);
  EXPECT_EQ(mesh->facet_group.size(), surface.facets.size());
  EXPECT_EQ(mesh->element_body.size(), mesh->element_count());
  ASSERT_GE(mesh->node_count(), surface.points.size());
  for (std::size_t i = 0; i < surface.points.size(); ++i)
    EXPECT_EQ(mesh->points[i + 1], surface.points[i]);
}

ReferenceSurface<3> real_part(const std::string& name) {
  const std::string path = std::string(LAMELLA_REAL_PARTS) + "/" + name;
  return std::filesystem::exists(path) ? test::ascii_stl(path) : ReferenceSurface<3>{};
}

/// Closed polygon of n corners at the given radii, counterclockwise when `outward`.
ReferenceSurface<2> star_polygon(int n, double r_even, double r_odd, bool outward = true) {
  ReferenceSurface<2> s;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n, r = i % 2 ? r_odd : r_even;
    s.points.emplace_back(r * std::cos(a), r * std::sin(a));
    s.facets.push_back({i, (i + 1) % n});
  }
  // Outward normals are on the right of the walk, and facet_normal of a 2D facet is on its left.
  if (outward)
    for (auto& f : s.facets) std::swap(f[0], f[1]);
  s.facet_face.assign(s.facets.size(), 0);
  s.faces.resize(1);
  return s;
}

TEST(Generate, MeshesConvexBodies) {
  expect_meshed<3>(test::box(1, 1, 1));
  expect_meshed<3>(test::box(4, 5, 3));
  expect_meshed<3>(test::sphere(12, 3.0));
}

TEST(Generate, MeshesThinBodies) {
  expect_meshed<3>(test::box(30, 30, 1, Vec<3>(1, 1, 0.3)));
  expect_meshed<3>(test::box(12, 12, 1, Vec<3>(1, 1, 1e-3)));
}

TEST(Generate, MeshesConcaveBodies) {
  expect_meshed<3>(test::ell(4));
  expect_meshed<3>(test::tee(4));
  expect_meshed<3>(test::cells(11, 4, 4, Vec<3>::Ones(),
                               [](int i, int, int k) { return k == 0 || i % 2 == 0; }));
}

TEST(Generate, MeshesATunnel) {
  expect_meshed<3>(
      test::cells(3, 3, 4, Vec<3>::Ones(), [](int i, int j, int) { return i != 1 || j != 1; }));
}

TEST(Generate, MeshesABodyWithACavity) {
  expect_meshed<3>(test::joined(test::sphere(6, 1.0), test::sphere(5, 0.6, true)));
}

/// A void of a box, at a place.
ReferenceSurface<3> slit(const Vec<3>& size, const Vec<3>& at) {
  ReferenceSurface<3> s = test::box(1, 1, 1, size);
  for (auto& p : s.points) p += at;
  for (auto& f : s.facets) std::swap(f[0], f[1]);
  return s;
}

/// Slits that divide the body nearly in two stall algorithm 2.1 on all shells at once: a star
/// cannot turn a shell inside out.
TEST(Generate, MeshesABodyFullOfSlits) {
  ReferenceSurface<3> surface = test::box(3, 3, 3, Vec<3>::Constant(20.0 / 3));
  for (int k = 0; k < 8; ++k)
    surface = test::joined(surface, slit({19, 0.1, 18.9}, {0.4, 2 + 2.0 * k + 0.01 * k * k, 0.3}));
  expect_meshed<3>(surface);
}

TEST(Generate, MeshesVoidsThatNearlyTouch) {
  ReferenceSurface<3> surface = test::box(1, 1, 1, Vec<3>::Constant(10));
  surface = test::joined(surface, slit({4, 4, 4}, {1, 1, 1}));
  surface = test::joined(surface, slit({4, 0.05, 4}, {1, 5.002, 1}));
  surface = test::joined(surface, slit({0.01, 8, 8}, {9.98, 0.5, 0.7}));
  expect_meshed<3>(surface);
}

TEST(Generate, WorksFarFromTheOrigin) {
  auto surface = test::tee(3);
  for (auto& p : surface.points) p += Vec<3>(1e4, -2e4, 5e3);
  expect_meshed<3>(surface);
}

TEST(Generate, MeshesPolygons) {
  expect_meshed<2>(star_polygon(40, 1.0, 1.0));
  expect_meshed<2>(star_polygon(40, 1.0, 0.3));
  auto ring = star_polygon(30, 1.0, 0.8);
  const auto hole = star_polygon(16, 0.4, 0.3, false);
  const auto shift = static_cast<std::int32_t>(ring.points.size());
  ring.points.insert(ring.points.end(), hole.points.begin(), hole.points.end());
  for (const auto& f : hole.facets) ring.facets.push_back({f[0] + shift, f[1] + shift});
  ring.facet_face.assign(ring.facets.size(), 0);
  expect_meshed<2>(ring);
}

/// The boundary of a mesh as a surface of its own.
template <int D>
ReferenceSurface<D> boundary_of(const SimplexMesh<D>& mesh) {
  ReferenceSurface<D> s;
  std::vector<std::int32_t> number(mesh.points.size(), -1);
  for (const auto& f : mesh.facets) {
    std::array<std::int32_t, D> g;
    for (int k = 0; k < D; ++k) {
      if (number[f[k]] < 0) {
        number[f[k]] = static_cast<std::int32_t>(s.points.size());
        s.points.push_back(mesh.points[f[k]]);
      }
      g[k] = number[f[k]];
    }
    s.facets.push_back(g);
  }
  s.facet_face = mesh.facet_face;
  return s;
}

TEST(Generate, MeshesInFourDimensions) {
  expect_meshed<4>(boundary_of(unit_box<4>(1)));
  expect_meshed<4>(boundary_of(unit_box<4>(2)));
  expect_meshed<4>(boundary_of(l_shape<4>(1)));
}

TEST(Generate, MeshesRealParts) {
  int found = 0;
  for (const char* name : {"netgen_hinge_ascii.stl", "prusa_mini_cable_cover_ascii.stl"}) {
    const auto surface = real_part(name);
    if (surface.facets.empty()) continue;
    ++found;
    expect_meshed<3>(surface);
  }
  if (!found) GTEST_SKIP() << "no real part under " << LAMELLA_REAL_PARTS;
}

TEST(Generate, SameSeedSameMesh) {
  const auto surface = test::tee(3);
  GenerateParams params;
  params.seed = 7;
  const auto a = generate<3>(surface, params), b = generate<3>(surface, params);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->elements, b->elements);
  EXPECT_EQ(a->points, b->points);
}

TEST(Generate, AnySeedEndsInAMesh) {
  const auto surface = test::ell(3);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) expect_meshed<3>(surface, {.seed = seed});
}

TEST(Generate, KeepsNodeNumbersWhenAPointHasNoFacet) {
  auto surface = test::box(2, 2, 2);
  surface.points.emplace_back(9, 9, 9);
  expect_meshed<3>(surface);
}

TEST(Generate, RefusesAnOpenSurface) {
  auto surface = test::box(2, 2, 2);
  surface.facets.pop_back();
  const auto mesh = generate<3>(surface);
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, Code::bad_input);
  EXPECT_NE(mesh.error().message.find("not closed"), std::string::npos);
}

TEST(Generate, RefusesWrongWindings) {
  auto one = test::box(2, 2, 2);
  std::swap(one.facets[5][0], one.facets[5][1]);
  auto all = test::box(2, 2, 2);
  for (auto& f : all.facets) std::swap(f[0], f[1]);
  for (const auto& surface : {one, all, ReferenceSurface<3>{}}) {
    const auto mesh = generate<3>(surface);
    ASSERT_FALSE(mesh.ok());
    EXPECT_EQ(mesh.error().code, Code::bad_input);
  }
}

TEST(Generate, SaysWhereASurfaceTouchesItself) {
  const auto surface =
      test::cells(2, 2, 1, Vec<3>::Ones(), [](int i, int j, int) { return i == j; });
  const auto mesh = generate<3>(surface);
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, Code::failed);
  EXPECT_NE(mesh.error().message.find("touches itself near"), std::string::npos);
}

TEST(Generate, SaysWhereASurfaceCrossesItself) {
  auto other = test::box(2, 2, 2);
  for (auto& p : other.points) p += Vec<3>(0.5, 0.6, 0.7);
  const auto mesh = generate<3>(test::joined(test::box(2, 2, 2), other));
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, Code::failed);
  EXPECT_NE(mesh.error().message.find("crosses itself"), std::string::npos);
}

TEST(Generate, NamesTheExcessVolumeWhenTimeIsShort) {
  const auto mesh = generate<3>(test::joined(test::sphere(16, 1.0), test::sphere(16, 0.9, true)),
                                {.time_limit = 0.02});
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, Code::failed);
  EXPECT_NE(mesh.error().message.find("excess volume"), std::string::npos) << mesh.error().message;
}

TEST(Generate, StopsWhenCancelled) {
  std::stop_source stop;
  stop.request_stop();
  const auto mesh = generate<3>(test::tee(3), {}, Progress({}, stop.get_token()));
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, Code::cancelled);
}

TEST(Generate, StandsBehindTheMesherInterface) {
  const auto mesher = topological_mesher();
  EXPECT_EQ(mesher->name(), "algorithm 2.1");
  const auto mesh = mesher->generate(test::box(2, 2, 2), {});
  ASSERT_TRUE(mesh.ok());
  EXPECT_TRUE(certify<3>(*mesh, test::box(2, 2, 2)).ok());
}

TEST(Certificate, SeesWhatIsNotAMesh) {
  const auto surface = test::box(2, 2, 2);
  const auto mesh = generate<3>(surface);
  ASSERT_TRUE(mesh.ok());
  auto hole = *mesh;
  hole.elements.pop_back();
  EXPECT_FALSE(certify<3>(hole, surface).ok());
  auto inverted = *mesh;
  std::swap(inverted.elements[3][0], inverted.elements[3][1]);
  EXPECT_FALSE(certify<3>(inverted, surface).ok());
  auto twice = *mesh;
  twice.elements.push_back(twice.elements.front());
  EXPECT_FALSE(certify<3>(twice, surface).ok());
  auto turned = surface;
  std::swap(turned.facets[0][0], turned.facets[0][1]);
  EXPECT_FALSE(certify<3>(*mesh, turned).ok());
  auto more = surface;
  more.facets.pop_back();
  EXPECT_FALSE(certify<3>(*mesh, more).ok());
}

}  // namespace
}  // namespace lamella
