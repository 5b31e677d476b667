#include <QComboBox>
#include <QLineEdit>
#include <QSlider>
#include <QSpinBox>
#include <algorithm>

#include "core/study/domain.h"
#include "tests/ui/window_fixture.h"
#include "ui/panels/form.h"
#include "ui/session/asked_sizes.h"
#include "ui/session/wall_map.h"
#include "ui/views/compare_view.h"

namespace lamella::ui {
namespace {

using LookTest = WindowFixture;

TEST_F(LookTest, WallsAreColoredByThicknessBeforeThereIsAMesh) {
  open_part("t_junction");
  const QImage plain = window_.view().picture();
  window_.view().set_color_by(ColorBy::thickness);
  const WallMap& walls = window_.view().walls();
  EXPECT_FALSE(window_.view().scene()->has(ColorBy::thickness));
  ASSERT_TRUE(QTest::qWaitFor([&] { return !walls.maps().empty(); }, patience));
  QTest::qWait(50);
  ASSERT_TRUE(window_.view().scene()->has(ColorBy::thickness));
  const Legend legend = window_.view().scene()->legend();
  EXPECT_TRUE(legend.is_length);
  EXPECT_GT(legend.low, 0);
  EXPECT_GT(legend.high, legend.low);
  EXPECT_GT(difference(plain, window_.view().picture()), 0.03);
  picture("walls");
  // A click still finds the CAD face below it.
  const auto picked = window_.view().scene()->pick(view()->width() / 2.0, view()->height() / 2.0);
  ASSERT_TRUE(picked.has_value());
  EXPECT_TRUE(picked->face.has_value());
  // The mesh brings its own, and coloring by body takes it away.
  run();
  EXPECT_TRUE(walls.status().isEmpty());
  window_.view().set_color_by(ColorBy::body);
  EXPECT_TRUE(window_.view().scene()->legend().title.isEmpty());
}

TEST_F(LookTest, SizesAskedAreShownBeforeThereIsAMesh) {
  open_part("plate");
  window_.view().set_color_by(ColorBy::size);
  const WallMap& walls = window_.view().walls();
  ASSERT_TRUE(QTest::qWaitFor([&] { return !walls.maps().empty(); }, patience));
  const auto range = [](const WallMap::Maps& maps) {
    const auto& of = maps[0]->thickness;
    const auto [low, high] = std::minmax_element(of.begin(), of.end());
    return std::pair(*low, *high);
  };
  const auto wall = range(walls.maps());
  // The wall over n, wherever the sizes are within their bounds.
  session().select(0);
  find<QSpinBox>("layers")->setValue(5);
  EXPECT_NEAR(range(asked_sizes(session(), walls.maps())).second, wall.second / 5,
              1e-9 * wall.second);
  EXPECT_TRUE(window_.view().scene()->has(ColorBy::size));
  const QImage natural = window_.view().picture();
  // A correction is in force inside its shape, and never coarser outside.
  Study study = session().study();
  SizingObject object;
  object.name = "near the gate";
  object.shape = SphereShape{walls.maps()[0]->points[0], wall.first};
  object.asks = SizeCorrection{.size = wall.first / 50};
  study.sizing.push_back(object);
  session().edit("size", study);
  const auto maps = asked_sizes(session(), walls.maps());
  EXPECT_NEAR(maps[0]->thickness[0], wall.first / 50, 1e-9 * wall.first);
  for (std::size_t p = 0; p < maps[0]->thickness.size(); ++p)
    EXPECT_LE(maps[0]->thickness[p], walls.maps()[0]->thickness[p] / 5 * (1 + 1e-9));
  EXPECT_GT(difference(natural, window_.view().picture()), 0.01);
  picture("sizes-asked");
  // The mesh tells what its metric asks for.
  run();
  EXPECT_TRUE(window_.view().scene()->has(ColorBy::size));
  EXPECT_TRUE(window_.view().scene()->legend().is_length);
}

TEST_F(LookTest, AViewThatMovesIsDrawnCoarserAndWellAtRest) {
  open_part("plate");
  run();
  view()->look(Vec<3>(1, 1, -1), Vec<3>::UnitZ(), window_.view().bounds());
  const QImage before = window_.view().picture();
  QTest::keyClick(view(), Qt::Key_Left);
  EXPECT_TRUE(view()->moving());
  // A picture, like a click, never sees what is drawn in a hurry.
  const QImage turned = window_.view().picture();
  EXPECT_FALSE(view()->moving());
  EXPECT_GT(difference(before, turned), 0.01);
  QTest::keyClick(view(), Qt::Key_Plus);
  EXPECT_TRUE(view()->moving());
  // It comes to rest by itself.
  EXPECT_TRUE(QTest::qWaitFor([&] { return !view()->moving(); }, patience));
  const QImage at_rest = view()->grab().toImage();
  QTest::qWait(100);
  EXPECT_LT(difference(at_rest, view()->grab().toImage()), 1e-3);
}

TEST_F(LookTest, WhatIsInSightStaysSoInANarrowerView) {
  open_part("plate");
  const auto sides = [&] {
    const auto b = window_.view().bounds();
    double left = 1e9, right = -1e9;
    for (int corner = 0; corner < 8; ++corner) {
      const double x =
          view()
              ->project(Vec<3>(b[corner & 1], b[2 + (corner >> 1 & 1)], b[4 + (corner >> 2)]))
              .x();
      left = std::min(left, x);
      right = std::max(right, x);
    }
    return std::pair(left, view()->width() - right);
  };
  const QSize before = view()->size();
  const auto margins = sides();
  EXPECT_GT(std::min(margins.first, margins.second), 0);
  view()->setFixedSize(before.width() / 3, before.height());
  QTest::qWait(50);
  EXPECT_GT(std::min(sides().first, sides().second), 0);
  view()->setFixedSize(before);
  QTest::qWait(50);
  EXPECT_NEAR(sides().first, margins.first, 0.5);
}

TEST_F(LookTest, MeasuringWallsIsStoppedByEscapeAndByARun) {
  open_part("ribbed_tray");
  window_.view().set_color_by(ColorBy::thickness);
  const WallMap& walls = window_.view().walls();
  ASSERT_TRUE(walls.busy());
  QTest::keyClick(&window_.view(), Qt::Key_Escape);
  ASSERT_TRUE(QTest::qWaitFor([&] { return !walls.busy(); }, patience));
  EXPECT_TRUE(walls.maps().empty());
  EXPECT_FALSE(walls.status().isEmpty());
  window_.view().set_color_by(ColorBy::body);
  window_.view().set_color_by(ColorBy::thickness);
  ASSERT_TRUE(walls.busy());
  action(Act::run)->trigger();
  ASSERT_TRUE(QTest::qWaitFor([&] { return !walls.busy(); }, patience));
  ASSERT_TRUE(wait_idle());
  EXPECT_TRUE(walls.maps().empty());
}

TEST_F(LookTest, TwoViewsShareCameraAndCutsAndShowDifferentIterations) {
  open_part("plate");
  EXPECT_FALSE(action(Act::compare)->isEnabled());
  run();
  ASSERT_TRUE(action(Act::compare)->isEnabled());
  action(Act::compare)->setChecked(true);
  CompareView* other = window_.view().compared();
  ASSERT_NE(other, nullptr);
  QTest::qWait(100);
  EXPECT_EQ(other->iteration(), session().shown() - 1);
  const auto elements = [&](int k) {
    return session().iterations()[std::size_t(k)].state->mesh.element_count();
  };
  EXPECT_EQ(other->scene().shown_elements(), elements(other->iteration()));
  find<QComboBox>("compared")->setCurrentIndex(1);
  EXPECT_EQ(other->iteration(), 0);
  EXPECT_EQ(other->scene().shown_elements(), elements(0));
  // The slider moves the right one only.
  find<QSlider>("iteration_slider")->setValue(3);
  EXPECT_EQ(other->iteration(), 0);
  EXPECT_EQ(window_.view().scene()->shown_elements(), elements(3));

  const QImage before = other->vtk_view()->grab().toImage();
  action(Act::view_top)->trigger();
  EXPECT_TRUE(QTest::qWaitFor(
      [&] { return difference(before, other->vtk_view()->grab().toImage()) > 0.001; }, patience));
  const Vec<3> corner(40, 30, 2);
  const auto from_middle = [&](VtkView* v) { return v->project(corner).y() - v->height() / 2.0; };
  EXPECT_NEAR(from_middle(other->vtk_view()) / other->vtk_view()->height(),
              from_middle(view()) / view()->height(), 1e-6);
  action(Act::section)->setChecked(true);
  QTest::qWait(100);
  EXPECT_LT(other->scene().shown_elements(), elements(0));
  EXPECT_LT(window_.view().scene()->shown_elements(), elements(3));
  action(Act::view_iso)->trigger();
  window_.view().set_color_by(ColorBy::quality);
  QTest::qWait(100);
  EXPECT_EQ(other->scene().legend().title, window_.view().scene()->legend().title);
  picture("compare");
  action(Act::compare)->setChecked(false);
  EXPECT_EQ(window_.view().compared(), nullptr);
  // Another part while two views are open: there is nothing to compare any more.
  action(Act::compare)->setChecked(true);
  EXPECT_TRUE(session().mesh_unsaved());
  session().save(folder_ / "s.lamella");
  ASSERT_TRUE(wait_idle());
  EXPECT_FALSE(session().mesh_unsaved() || session().modified());  // nothing is asked
  open_part("plate");
  QTest::qWait(100);
  EXPECT_FALSE(action(Act::compare)->isEnabled());
  EXPECT_EQ(window_.view().compared(), nullptr);
}

TEST_F(LookTest, BodiesByFormulaAreMadeEditedRenamedAndUndone) {
  action(Act::zone_ball)->trigger();
  ASSERT_EQ(study().zones.size(), 1u);
  ASSERT_TRUE(study().domain.has_value());
  EXPECT_TRUE(session().can_run());
  ASSERT_TRUE(
      QTest::qWaitFor([&] { return !session().shapes()[0].surface.points.empty(); }, patience));
  EXPECT_TRUE(window_.view().isVisible());
  find<LengthBox>("zone_radius")->setValue(3);
  const auto ball = [&] { return std::get<ZoneBall>(study().zones[0].shape); };
  EXPECT_EQ(ball().radius, 3);
  find<PointBox>("zone_center")->set_point({1, 2, 3});
  Q_EMIT find<PointBox>("zone_center")->edited();
  EXPECT_EQ(ball().center, Vec<3>(1, 2, 3));

  auto* name = find<QLineEdit>("zone_name");
  name->setText("grain");
  Q_EMIT name->editingFinished();
  EXPECT_EQ(study().zones[0].name, "grain");
  EXPECT_EQ(session().body(0).name, "grain");

  action(Act::zone_box)->trigger();
  ASSERT_EQ(study().zones.size(), 2u);
  EXPECT_EQ(session().item().index, 1);
  name->setText("grain");  // taken
  Q_EMIT name->editingFinished();
  EXPECT_EQ(study().zones[1].name, "box");
  EXPECT_EQ(name->text(), "box");
  action(Act::zone_cylinder)->trigger();
  action(Act::zone_half_space)->trigger();
  ASSERT_EQ(study().zones.size(), 4u);
  // What is around the bodies comes last.
  EXPECT_EQ(study().bodies.size(), 5u);
  QTest::qWait(300);
  picture("zones");
  session().select(0);
  QTest::qWait(50);
  picture("zone");
  for (int k = 0; k < 20 && !study().zones.empty(); ++k) session().undo_stack()->undo();
  EXPECT_TRUE(session().empty());
}

TEST_F(LookTest, ABodyByFormulaIsMovedByItsKnob) {
  open_part("plate");
  action(Act::zone_ball)->trigger();
  ASSERT_TRUE(
      QTest::qWaitFor([&] { return !session().shapes()[1].surface.points.empty(); }, patience));
  QTest::qWait(100);
  const auto center = [&] { return std::get<ZoneBall>(study().zones[0].shape).center; };
  const Vec<3> before = center();
  const QPoint knob = view()->project(before).toPoint();
  const int steps = session().undo_stack()->count();
  QTest::mousePress(view(), Qt::LeftButton, {}, knob);
  for (int k = 1; k <= 4; ++k) {
    const QPointF to = knob + QPoint(10 * k, 0);
    QMouseEvent move(QEvent::MouseMove, to, view()->mapToGlobal(to), Qt::NoButton, Qt::LeftButton,
                     {});
    QCoreApplication::sendEvent(view(), &move);
  }
  QTest::mouseRelease(view(), Qt::LeftButton, {}, knob + QPoint(40, 0));
  EXPECT_GT((center() - before).norm(), 0.1);
  EXPECT_EQ(session().undo_stack()->count(), steps + 1);
  session().undo_stack()->undo();
  EXPECT_EQ(center(), before);
}

}  // namespace
}  // namespace lamella::ui
