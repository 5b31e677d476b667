#include <algorithm>

#include "core/io/stl.h"
#include "core/study/study_file.h"
#include "core/study/zone_surface.h"
#include "tests/ui/window_fixture.h"
#include "ui/commands/study_edits.h"
#include "ui/panels/banner.h"

namespace lamella::ui {
namespace {

/// A window with a plate of 40 x 30 x 2 whose file others change.
class ReloadTest : public WindowFixture {
 protected:
  ReloadTest() {
    write({40, 30, 2}, false);
    session().open({file_}, false, 1);
    EXPECT_TRUE(wait_idle());
    EXPECT_EQ(session().parts().size(), 1u);
    // What is asked near the gate: a group, a ball, and a face with a size of its own.
    const std::int32_t gate = face_at(40);
    add_group(session(), GroupKind::gate, session().body(0).name, {gate});
    add_sizing(session(), session().body(0).name, "near gate", SphereShape{{40, 15, 1}, 5});
    add_sizing(session(), session().body(0).name, "gate face", FacesShape{{gate}});
    edit_sizing(session(), 0, "Size %1", [](SizingObject& object) {
      object.asks = SizeCorrection{0.25, {}, 1.4, true};
    });
    session().select(0);
    session().edit_selection("n", [](BodySettings& body) { body.layers = 5; });
  }

  /// The plate, its facets in the other order where `backwards`: its faces have other numbers then.
  void write(const Vec<3>& size, bool backwards) {
    const StudyZone zone{"plate", ZoneBox{Vec<3>::Zero(), size}};
    auto surface = zone_surface(zone, {zone}, zone, 0.1);
    ASSERT_TRUE(surface);
    if (backwards) std::reverse(surface->facets.begin(), surface->facets.end());
    ASSERT_TRUE(write_stl(*surface, file_));
  }
  /// Number of the face across x at this place.
  std::int32_t face_at(double x) {
    const auto& surface = session().parts()[0].surface;
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
      bool on = true;
      for (const std::int32_t v : surface.facets[f])
        on = on && std::abs(surface.points[static_cast<std::size_t>(v)][0] - x) < 1e-4;
      if (on) return surface.facet_face[f];
    }
    ADD_FAILURE() << "no face at " << x;
    return -1;
  }
  double thickness() { return session().parts()[0].cad_volume / (40 * 30); }
  void expect_corrections(std::int32_t gate) {
    EXPECT_EQ(session().body(0).layers, 5);
    ASSERT_EQ(study().groups.size(), 1u);
    EXPECT_EQ(study().groups[0].kind, GroupKind::gate);
    EXPECT_EQ(study().groups[0].faces, std::vector<std::int32_t>{gate});
    ASSERT_EQ(study().sizing.size(), 2u);
    const auto& ball = std::get<SphereShape>(study().sizing[0].shape);
    EXPECT_LT((ball.center - Vec<3>(40, 15, 1)).norm(), 1e-12);
    EXPECT_EQ(ball.radius, 5);
    const auto& asks = std::get<SizeCorrection>(study().sizing[0].asks);
    EXPECT_EQ(asks.size, 0.25);
    EXPECT_EQ(asks.gradation, 1.4);
    EXPECT_TRUE(asks.keep_directions);
    EXPECT_EQ(std::get<FacesShape>(study().sizing[1].shape).ids, std::vector<std::int32_t>{gate});
  }
  void reload() {
    action(Act::reload)->trigger();
    ASSERT_TRUE(wait_idle());
  }

  std::filesystem::path file_ = folder_ / "plate.stl";
};

TEST_F(ReloadTest, CorrectionsNearAGateSurviveWhatTheCadHasBecome) {
  run();
  ASSERT_FALSE(session().outdated());
  const std::int32_t before = face_at(40);
  write({40, 30, 3}, true);
  reload();
  EXPECT_NEAR(thickness(), 3, 1e-4) << "it is the plate of today";
  const std::int32_t now = face_at(40);
  ASSERT_NE(before, now) << "this test is for numbers that changed";
  expect_corrections(now);
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_TRUE(session().outdated()) << "the mesh is one of the old plate";
  EXPECT_NE(session().shown_state(), nullptr) << "and it is not thrown away";
  EXPECT_TRUE(session().modified());
  run();
  EXPECT_FALSE(session().outdated());

  action(Act::undo)->trigger();
  EXPECT_NEAR(thickness(), 2, 1e-4);
  expect_corrections(before);
  action(Act::redo)->trigger();
  EXPECT_NEAR(thickness(), 3, 1e-4);
  expect_corrections(now);
}

TEST_F(ReloadTest, AStudyOfACadThatChangedIsOpenedWithItsCorrections) {
  const std::int32_t before = face_at(40);
  session().save(folder_ / "s.lamella");
  ASSERT_TRUE(wait_idle());
  write({40, 30, 3}, true);
  window_.open_files({QString::fromStdString((folder_ / "s.lamella").string())});
  ASSERT_TRUE(wait_idle());
  EXPECT_NEAR(thickness(), 3, 1e-4);
  const std::int32_t now = face_at(40);
  ASSERT_NE(before, now) << "this test is for numbers that changed";
  expect_corrections(now);
  EXPECT_TRUE(window_.banner().hint().contains("has changed"));
  EXPECT_TRUE(window_.banner().hint().contains("in their place now"));
}

TEST_F(ReloadTest, WhatHasNotChangedIsNoStepToUndo) {
  const int steps = session().undo_stack()->count();
  reload();
  EXPECT_EQ(session().undo_stack()->count(), steps);
  EXPECT_TRUE(window_.banner().isVisible()) << "it says so";
}

TEST_F(ReloadTest, AFileThatIsGoneChangesNothing) {
  std::filesystem::remove(file_);
  const std::string asked = study_to_json(study());
  reload();
  EXPECT_EQ(study_to_json(study()), asked);
  EXPECT_EQ(session().parts().size(), 1u);
  EXPECT_TRUE(window_.banner().message().contains("plate.stl"));
}

}  // namespace
}  // namespace lamella::ui
