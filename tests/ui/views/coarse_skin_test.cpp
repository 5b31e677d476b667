#include "ui/views/coarse_skin.h"

#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkMapper.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include <QTest>
#include <QWidget>
#include <cmath>

#include "core/mesh/sample_meshes.h"
#include "tests/ui/looks_apart.h"
#include "tests/ui/window_fixture.h"
#include "ui/views/mesh_skin.h"

namespace lamella::ui {
namespace {

/// A block of 12 x 8 x 4 with far more triangles than it needs, colored by element.
std::shared_ptr<const MeshState> block() {
  auto state = std::make_shared<MeshState>();
  state->mesh = box_mesh<3>({24, 16, 8}, Vec<3>::Zero(), Vec<3>(12, 8, 4));
  for (std::size_t e = 0; e < state->mesh.elements.size(); ++e) {
    const auto corners = state->mesh.corners(state->mesh.elements[e]);
    state->quality.push_back(corners[0][0] < 6 ? 0.1 : 0.9);
  }
  return state;
}

Vec<3> point(vtkPolyData& data, vtkIdType p) {
  Vec<3> at;
  data.GetPoint(p, at.data());
  return at;
}

TEST(CoarseSkin, HasFewTrianglesOnTheSameSurfaceWithItsColors) {
  const auto prepared = prepare_mesh(block(), {});
  vtkPolyData& fine = *prepared->skin;
  ASSERT_EQ(fine.GetNumberOfCells(), 4 * (24 * 16 + 24 * 8 + 16 * 8));
  fine.GetCellData()->SetActiveScalars("quality");
  const auto coarse = with_scalars(coarse_skin(fine, 600), fine);
  EXPECT_LT(coarse->GetNumberOfCells(), 900);
  EXPECT_GT(coarse->GetNumberOfCells(), 200);
  auto* colors = vtkFloatArray::SafeDownCast(coarse->GetCellData()->GetScalars());
  ASSERT_NE(colors, nullptr);
  ASSERT_EQ(colors->GetNumberOfTuples(), coarse->GetNumberOfCells());

  double bounds[6];
  coarse->GetBounds(bounds);
  const double block_bounds[6] = {0, 12, 0, 8, 0, 4};
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(bounds[k], block_bounds[k], 0.05) << k;
  double area = 0, volume = 0;
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < coarse->GetNumberOfCells(); ++c) {
    coarse->GetCellPoints(c, corners);
    ASSERT_EQ(corners->GetNumberOfIds(), 3);
    const Vec<3> a = point(*coarse, corners->GetId(0)), b = point(*coarse, corners->GetId(1)),
                 d = point(*coarse, corners->GetId(2));
    const Vec<3> middle = (a + b + d) / 3, normal = (b - a).cross(d - a) / 2;
    area += normal.norm();
    volume += a.dot(b.cross(d)) / 6;
    if (std::abs(middle[0] - 6) > 1.5) {
      EXPECT_FLOAT_EQ(colors->GetValue(c), middle[0] < 6 ? 0.1F : 0.9F);
    }
  }
  // Edges and corners stay where they are, and faces look outward.
  EXPECT_NEAR(area, 2 * (12 * 8 + 12 * 4 + 8 * 4), 4);
  EXPECT_NEAR(volume, 12 * 8 * 4, 4);
}

TEST(CoarseSkin, OfNothingIsNothing) {
  vtkNew<vtkPolyData> nothing;
  EXPECT_EQ(coarse_skin(*nothing, 100).surface->GetNumberOfCells(), 0);
}

vtkIdType drawn_triangles(vtkRenderer& renderer) {
  vtkIdType count = 0;
  vtkActorCollection* actors = renderer.GetActors();
  actors->InitTraversal();
  while (vtkActor* actor = actors->GetNextActor())
    if (auto* data = vtkPolyData::SafeDownCast(actor->GetMapper()->GetInput());
        data && actor->GetVisibility())
      count += data->GetNumberOfPolys();
  return count;
}

TEST(CoarseSkin, IsWhatASceneShowsWhileItMoves) {
  VtkView view;
  Scene scene(*view.renderer());
  view.resize(480, 300);
  view.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&view, patience));
  const auto state = block();
  scene.set_mesh(state);
  scene.set_color_by(ColorBy::quality, 4, "");
  view.look(Vec<3>(-1, 1, -1).normalized(), Vec<3>::UnitZ(), scene.bounds());
  const auto picture = [&] {
    view.update();
    QTest::qWait(50);
    return view.grab().toImage();
  };
  const vtkIdType all = drawn_triangles(*view.renderer());
  EXPECT_EQ(all, 4 * (24 * 16 + 24 * 8 + 16 * 8));
  const QImage with_edges = picture();
  scene.set_edges(false);
  const QImage fine = picture();

  scene.set_moving(true, 1500);
  const vtkIdType fast = drawn_triangles(*view.renderer());
  EXPECT_LE(fast, 1500);
  EXPECT_GT(fast, 300);
  const QImage coarse = picture();
  EXPECT_NE(coarse, fine);
  EXPECT_LT(looks_apart(coarse, fine), 0.06) << "the same body in the same colors";
  // Other colors, another cut: what moves follows.
  scene.set_color_by(ColorBy::body, 4, "");
  EXPECT_GT(looks_apart(coarse, picture()), 0.1);
  scene.set_sections({Section{Vec<3>(6, 4, 2), Vec<3>::UnitX()}});
  EXPECT_LT(scene.shown_elements(), state->mesh.element_count());
  EXPECT_GT(looks_apart(coarse, picture()), 0.1);
  scene.set_sections({});
  scene.set_color_by(ColorBy::quality, 4, "");
  scene.set_edges(true);
  scene.set_moving(false, 1500);
  EXPECT_EQ(drawn_triangles(*view.renderer()), all);
  EXPECT_LT(looks_apart(picture(), with_edges), 0.001);
  EXPECT_GT(looks_apart(coarse, with_edges), 0.001);
  scene.set_moving(true, 100000);
  EXPECT_EQ(drawn_triangles(*view.renderer()), all) << "few enough to be drawn as they are";
}

TEST(CoarseSkin, IsWhatAMeshThatArrivesIsFirstDrawnAs) {
  VtkView view;
  Scene scene(*view.renderer());
  QObject::connect(&view, &VtkView::moving_changed, [&](bool on) { scene.set_moving(on, 1500); });
  view.resize(480, 300);
  view.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&view, patience));
  const auto state = block();
  SkinChoice choice;
  choice.fast = 1500;
  const auto prepared = prepare_mesh(state, choice);
  ASSERT_TRUE(prepared->coarse);
  scene.set_mesh(state, prepared);
  view.look(Vec<3>(-1, 1, -1).normalized(), Vec<3>::UnitZ(), scene.bounds());
  const vtkIdType all = drawn_triangles(*view.renderer());
  const QImage at_once = view.grab().toImage();
  ASSERT_EQ(all, 4 * (24 * 16 + 24 * 8 + 16 * 8));

  scene.set_mesh(nullptr, nullptr);
  view.draw_in_steps(true);
  view.arrive();
  scene.set_mesh(state, prepared);
  EXPECT_EQ(drawn_triangles(*view.renderer()), prepared->coarse->surface->GetNumberOfPolys())
      << "the one that was prepared";
  view.update();
  // At rest comes all of it, and smooth edges in a turn of their own: what one turn draws.
  ASSERT_TRUE(QTest::qWaitFor([&] { return drawn_triangles(*view.renderer()) == all; }, patience));
  QTest::qWait(500);
  EXPECT_EQ(view.grab().toImage(), at_once);
}

}  // namespace
}  // namespace lamella::ui
