#include "core/study/mesh_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/geometry/soup.h"
#include "tests/support/three_bodies.h"

namespace lamella {
namespace {

using Corners = std::array<std::array<double, 3>, 3>;

/// The facets in a plane x = const by their corners, whatever their order.
std::set<Corners> facets_at(const ReferenceSurface<3>& surface, double x) {
  std::set<Corners> found;
  for (const auto& facet : surface.facets) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec<3>& p = surface.points[static_cast<std::size_t>(facet[k])];
      corners[k] = {p[0], p[1], p[2]};
    }
    std::sort(corners.begin(), corners.end());
    if (corners[0][0] == x && corners[2][0] == x) found.insert(corners);
  }
  return found;
}

std::set<std::string> face_names(const Part& part) {
  std::set<std::string> names;
  for (const SurfaceFace& face : part.surface.faces) names.insert(face.name);
  return names;
}

TEST(MeshParts, BodiesAreTakenByTheirBoundaries) {
  const test::ThreeBodies three;
  const Result<std::vector<Part>> parts = parts_of_mesh(three.mesh);
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  ASSERT_EQ(parts->size(), 3u);
  for (std::size_t b = 0; b < 3; ++b) {
    const Part& part = (*parts)[b];
    EXPECT_EQ(part.name, three.mesh.bodies[b]);
    EXPECT_TRUE(check_closed(part.surface).ok());
    EXPECT_NEAR(part.cad_volume, 16, 1e-12);
    // A box: twelve edges of 2, 4 and 2 mm on the grid of the mesh, eight corners, six sides.
    EXPECT_EQ(part.surface.feature_edges.size(), 4u * (2 + 4 + 3));
    EXPECT_EQ(part.surface.corners.size(), 8u);
    EXPECT_EQ(part.surface.faces.size(), 6u);
  }
  EXPECT_EQ(face_names((*parts)[0]),
            (std::set<std::string>{"gate", "symmetry", "walls", "cover|insert"}));
  EXPECT_EQ((*parts)[0].groups.size(), 2u);
  EXPECT_EQ((*parts)[1].groups, (std::vector<std::string>{"symmetry"}));
  // Where two touch they have the same triangles.
  const auto common = facets_at((*parts)[0].surface, 2);
  EXPECT_EQ(common.size(), 24u);
  EXPECT_EQ(common, facets_at((*parts)[1].surface, 2));
}

TEST(MeshParts, AFlatSideIsDividedWhereGroupsMeet) {
  SimplexMesh<3> mesh = box_mesh<3>({4, 2, 2}, Vec<3>::Zero(), Vec<3>(4, 2, 2));
  mesh.groups.push_back("inlet");
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    double x = 0;
    for (const NodeId v : mesh.facets[f]) x += mesh.points[static_cast<std::size_t>(v)][0] / 3;
    if (mesh.facet_face[f] == 5 && x < 2) mesh.facet_group[f] = 1;
  }
  const Result<std::vector<Part>> parts = parts_of_mesh(mesh);
  ASSERT_TRUE(parts.ok());
  const ReferenceSurface<3>& surface = parts->front().surface;
  EXPECT_EQ(surface.faces.size(), 7u);
  double area = 0;
  for (std::size_t f = 0; f < surface.facets.size(); ++f)
    if (surface.faces[static_cast<std::size_t>(surface.facet_face[f])].name == "inlet")
      area += facet_area(surface, f);
  EXPECT_NEAR(area, 4, 1e-12);
}

TEST(MeshParts, GroupsComeAlongUnlessTheStudyHasThem) {
  const test::ThreeBodies three;
  const std::vector<Part> parts = parts_of_mesh(three.mesh).value();
  Study study;
  BoundaryGroup mine;
  mine.name = "in";
  mine.body = "cover";
  mine.face_names = {"gate"};
  study.groups.push_back(mine);
  for (const Part& part : parts) add_groups_of_file(part, study);
  std::multiset<std::string> names;
  for (const BoundaryGroup& group : study.groups) {
    names.insert(group.name + " of " + group.body);
    EXPECT_EQ(group.kind, group.name == "in" ? GroupKind::other : group_kind_of(group.name));
    const auto part = std::find_if(parts.begin(), parts.end(),
                                   [&](const Part& p) { return p.name == group.body; });
    EXPECT_TRUE(facets_of(group, part->surface).ok());
  }
  EXPECT_EQ(names,
            (std::multiset<std::string>{"in of cover", "symmetry of cover", "symmetry of insert",
                                        "symmetry of runner", "vent of runner"}));
}

TEST(MeshParts, ABackgroundBecomesABodyOfItsOwn) {
  SimplexMesh<3> mesh = two_body_box<3>(2);
  mesh.bodies = {"tray", "background"};
  const std::vector<Part> parts = parts_of_mesh(mesh).value();
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].name, "tray");
  EXPECT_EQ(parts[1].name, "background 1");
}

TEST(MeshParts, ABodyWithoutElementsIsNone) {
  SimplexMesh<3> mesh = unit_box<3>(2);
  mesh.bodies.push_back("empty");
  ASSERT_EQ(parts_of_mesh(mesh).value().size(), 1u);
  mesh.elements.clear();
  mesh.element_body.clear();
  EXPECT_EQ(parts_of_mesh(mesh).error().code, Code::bad_input);
}

}  // namespace
}  // namespace lamella
