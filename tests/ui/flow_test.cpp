#include <gtest/gtest.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QSlider>

#include "tests/ui/window_fixture.h"
#include "ui/commands/study_edits.h"
#include "ui/panels/banner.h"
#include "ui/panels/flow_panel.h"
#include "ui/session/command_line.h"

namespace lamella::ui {
namespace {

/// A plate with a made-up mesh and a gate and a vent on two of its faces.
class FlowTest : public WindowFixture {
 protected:
  FlowTest() {
    open_part("plate");
    add_group(session(), GroupKind::gate, session().body(0).name, {0});
    add_group(session(), GroupKind::vent, session().body(0).name, {1});
    Study study = session().study();
    study.options.iterations = 1;
    session().edit("fewer", study);
  }

  void solve() {
    run();
    action(Act::solve_flow)->trigger();
    ASSERT_EQ(session().activity(), Activity::flowing);
    ASSERT_TRUE(wait_idle());
    ASSERT_TRUE(session().shown_state()->flow);
  }
};

TEST_F(FlowTest, TheFlowIsSolvedAndSeen) {
  EXPECT_FALSE(action(Act::flow_arrows)->isEnabled());
  EXPECT_FALSE(action(Act::solve_flow)->isEnabled()) << "there is no mesh";
  solve();
  const FlowFields& flow = *session().shown_state()->flow;
  ASSERT_EQ(flow.openings.size(), 2u);
  EXPECT_LT(flow.imbalance, 1e-6);
  EXPECT_GT(flow.rate(), 0);
  EXPECT_TRUE(window_.findChild<QLabel*>("flow_found")->text().contains("in by gate"));
  for (const ColorBy field : {ColorBy::speed, ColorBy::pressure, ColorBy::shear}) {
    window_.view().set_color_by(field);
    EXPECT_TRUE(window_.view().scene()->has(field));
    EXPECT_TRUE(window_.view().scene()->legend().missing.isEmpty());
  }
  window_.view().set_color_by(ColorBy::pressure);
  EXPECT_LT(window_.view().scene()->legend().low, 0.2);
  EXPECT_GT(window_.view().scene()->legend().high, 0.8);
  window_.view().set_color_by(ColorBy::body);
  action(Act::section)->setChecked(true);
  for (const Act act : {Act::flow_arrows, Act::flow_lines, Act::flow_levels}) {
    const QImage before = window_.view().picture();
    action(act)->setChecked(true);
    QTest::qWait(30);
    EXPECT_NE(before, window_.view().picture());
    action(act)->setChecked(false);
    QTest::qWait(30);
    EXPECT_EQ(before, window_.view().picture());
  }
}

TEST_F(FlowTest, AGateHasAPressureOrARate) {
  session().select_item({ItemKind::group, 0});
  auto* given = window_.findChild<QComboBox*>("gate_given");
  auto* value = window_.findChild<QDoubleSpinBox*>("gate_value");
  EXPECT_FALSE(given->isHidden());
  value->setValue(20);
  EXPECT_EQ(session().study().groups[0].pressure, 20);
  given->setCurrentIndex(1);
  Q_EMIT given->activated(1);
  EXPECT_FALSE(session().study().groups[0].pressure.has_value());
  EXPECT_EQ(session().study().groups[0].rate, 20);
  action(Act::undo)->trigger();
  EXPECT_EQ(session().study().groups[0].pressure, 20);
  solve();
  EXPECT_DOUBLE_EQ(session().shown_state()->flow->highest_pressure(), 20);
  session().select_item({ItemKind::group, 1});
  EXPECT_FALSE(given->isVisible());
}

TEST_F(FlowTest, TheStrengthIsUndoneAndSaysWhatItComesTo) {
  solve();
  auto* panel = window_.findChild<FlowPanel*>();
  auto* slider = window_.findChild<QSlider*>("flow_weight");
  EXPECT_FALSE(slider->isEnabled());
  window_.findChild<QCheckBox*>("flow_correct")->click();
  ASSERT_TRUE(session().study().flow.has_value());
  EXPECT_TRUE(slider->isEnabled());
  window_.findChild<QDoubleSpinBox*>("flow_growth")->setValue(10);
  const auto counted = [&] {
    EXPECT_TRUE(QTest::qWaitFor([&] { return panel->preview().has_value(); }, patience));
    EXPECT_TRUE(window_.findChild<QLabel*>("flow_expected")->text().startsWith("About"));
    return panel->preview()->nodes_after;
  };
  const double usual = counted();
  EXPECT_GT(usual, static_cast<double>(session().shown_state()->mesh.node_count()));
  slider->setValue(slider->minimum());
  EXPECT_NEAR(session().study().flow->strength, 0.1, 1e-9);
  EXPECT_LT(counted(), usual);
  const Result<std::string> line = command_line(session().study());
  ASSERT_TRUE(line.ok());
  EXPECT_NE(line->find("--flow combined"), std::string::npos);
  EXPECT_NE(line->find("--gate gate=1"), std::string::npos);
  action(Act::undo)->trigger();
  EXPECT_EQ(session().study().flow->strength, 1);
  action(Act::undo)->trigger();
  action(Act::undo)->trigger();
  EXPECT_FALSE(session().study().flow.has_value());
}

TEST_F(FlowTest, WithoutAGateTheBannerSaysWhatToDo) {
  session().remove_item({ItemKind::group, 0});
  action(Act::run)->trigger();
  ASSERT_TRUE(wait_idle());
  EXPECT_FALSE(window_.banner().isVisible());
  action(Act::solve_flow)->trigger();
  ASSERT_TRUE(wait_idle());
  EXPECT_FALSE(session().shown_state()->flow);
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_TRUE(window_.banner().message().contains("gate"))
      << window_.banner().message().toStdString();
  EXPECT_FALSE(window_.banner().hint().isEmpty());
}

}  // namespace
}  // namespace lamella::ui
