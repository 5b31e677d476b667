#include "core/natural/boundary_distance.h"
#include "tests/support/adapt_cases.h"
#include "tests/support/solids.h"

/// Bodies whose exact shape is known, remeshed at three sizes.
namespace lamella::test {
namespace {

/// Whether all points of a border between two faces of the body with hole and boss lie on a line.
bool straight(const std::array<int, 2>& faces) { return faces[1] <= 5 && faces[0] < 4; }

void expect_fidelity(const Solid& solid) {
  SCOPED_TRACE(solid.name);
  const double chord_error = std::max(mesh_off(solid, solid.mesh), shape_off(solid, solid.mesh));
  AdaptParams params;
  params.chord_tolerance = 0.5 * chord_error;
  for (const double h : {0.1, 0.16, 0.3}) {
    SCOPED_TRACE(h);
    const auto metric = [h](const Vec<3>&) { return isotropic_metric<3>(h); };
    const auto out = adapted<3>(solid.mesh, metric, params, &solid.surface);
    expect_valid(out.mesh);
    // What adaption adds to the error of the tessellation is no more than that.
    EXPECT_LE(std::abs(volume_of(out.mesh) - volume_of(solid.mesh)), solid.lost);
    EXPECT_LE(boundary_distance(out.mesh, solid.surface)->largest(),
              *params.chord_tolerance * (1 + 1e-9));
    const double asked = chord_error + *params.chord_tolerance;
    EXPECT_LE(mesh_off(solid, out.mesh), asked);
    EXPECT_LE(shape_off(solid, out.mesh), asked);
    const FeatureFindings found = compare_features(solid, out.mesh, *params.chord_tolerance);
    EXPECT_EQ(found.changed, 0u) << found.off / *params.chord_tolerance << " of the tolerance";
    EXPECT_EQ(found.corners_lost, 0u);
    EXPECT_EQ(found.after.size(), found.before.size());
    for (const auto& [faces, length] : found.before)
      if (straight(faces)) {
        EXPECT_NEAR(found.after.at(faces), length, 1e-9);
      }
  }
}

TEST(AdaptFidelity, ASphereIsKept) { expect_fidelity(sphere_solid(12)); }
TEST(AdaptFidelity, ATorusIsKept) { expect_fidelity(torus_solid(6, 36)); }
TEST(AdaptFidelity, ABoxWithHoleAndBossIsKept) {
  const Solid solid = drilled_boss_solid(3);
  // Eight edges of the box around, four upright; the other borders are circles.
  double edges = 0;
  for (const auto& [faces, length] : compare_features(solid, solid.mesh, 1).before)
    if (straight(faces)) edges += length;
  EXPECT_NEAR(edges, 16 + 4 * 0.6, 1e-12);
  expect_fidelity(solid);
}

}  // namespace
}  // namespace lamella::test
