#include <gtest/gtest.h>

#include <QComboBox>
#include <QDropEvent>
#include <QLabel>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QTabWidget>
#include <QTimer>
#include <QUndoStack>
#include <cmath>

#include "core/mesh/sample_meshes.h"
#include "tests/ui/window_fixture.h"
#include "ui/panels/banner.h"
#include "ui/panels/body_page.h"
#include "ui/panels/flow_panel.h"
#include "ui/panels/length_box.h"
#include "ui/session/command_line.h"

namespace lamella::ui {
namespace {

/// A plate with a made-up mesh, and what another solver has found on it, in meters: a front.
class SolverFieldTest : public WindowFixture {
 protected:
  SolverFieldTest() {
    open_part("plate");
    Study study = session().study();
    study.options.iterations = 1;
    session().edit("fewer", study);
    EXPECT_TRUE(write_file(file_, "a result"));
    MeshContent& made = fake_.result;
    made.mesh = box_mesh<3>({40, 8, 2}, Vec<3>(-0.03, -0.02, 0), Vec<3>(0.03, 0.02, 0.002));
    NodeField number{"T", 1, {}}, vector{"U", 3, {}};
    for (const Vec<3>& x : made.mesh.points) {
      number.values.push_back(200 + 100 * std::tanh(300 * x[0]));
      vector.values.insert(vector.values.end(), {1 - x[1] * x[1] / 4e-4, 0.0, 0.0});
    }
    made.of_nodes = {number, vector};
  }

  void open() {
    session().open_result(file_);
    ASSERT_TRUE(wait_idle());
    QTest::qWait(30);
  }
  void choose(const char* box, const QString& text) {
    auto* combo = window_.findChild<QComboBox*>(box);
    const int index = combo->findText(text);
    ASSERT_GE(index, 0) << text.toStdString();
    combo->setCurrentIndex(index);
    Q_EMIT combo->activated(index);
    ASSERT_TRUE(wait_idle());
  }
  QString found() { return window_.findChild<QLabel*>("flow_found")->text(); }
  const FlowFields* on_mesh() { return session().shown_state()->flow.get(); }

  const std::filesystem::path file_ = folder_ / "solved.vtu";
};

TEST_F(SolverFieldTest, AResultIsReadItsUnitGuessedAndItsFieldSeen) {
  run();
  open();
  ASSERT_TRUE(study().flow && study().flow->field);
  EXPECT_EQ(study().flow->field->name, "T");
  EXPECT_EQ(study().flow->field->source.unit, 1000);
  EXPECT_EQ(study().flow->method, FlowMethod::field);
  EXPECT_EQ(study().flow->field->source.sha256.size(), 64u);
  EXPECT_TRUE(window_.banner().isVisible()) << "a guess is told";
  EXPECT_TRUE(window_.banner().message().contains(" m."))
      << window_.banner().message().toStdString();

  auto* from = find<QComboBox>("flow_from");
  auto* field = find<QComboBox>("flow_field");
  EXPECT_EQ(from->currentIndex(), 1);
  EXPECT_EQ(field->count(), 2);
  EXPECT_EQ(find<QComboBox>("flow_unit")->currentText(), "m");
  EXPECT_EQ(find<QPushButton>("flow_file")->text(), "solved.vtu");
  EXPECT_TRUE(found().contains("72.1")) << found().toStdString();

  ASSERT_TRUE(on_mesh());
  EXPECT_EQ(on_mesh()->field, "T");
  window_.view().set_color_by(ColorBy::field);
  EXPECT_TRUE(window_.view().scene()->has(ColorBy::field));
  EXPECT_EQ(window_.view().scene()->legend().title, "T");
  EXPECT_NEAR(window_.view().scene()->legend().low, 100, 15);
  EXPECT_NEAR(window_.view().scene()->legend().high, 300, 15);
  EXPECT_FALSE(window_.view().scene()->has(ColorBy::pressure));
  EXPECT_FALSE(window_.view().scene()->has(ColorBy::speed));
  EXPECT_TRUE(window_.view().scene()->has(ColorBy::indicator));
  EXPECT_FALSE(action(Act::flow_arrows)->isEnabled()) << "a number has no direction";
  action(Act::section)->setChecked(true);
  action(Act::section_y)->trigger();
  action(Act::crinkle)->setChecked(false);  // whole elements hide what is on the plane
  QTest::qWait(100);
  const QImage before = window_.view().picture();
  action(Act::flow_levels)->setChecked(true);
  QTest::qWait(30);
  EXPECT_NE(before, window_.view().picture()) << "level sets of the number";
  auto* panel = window_.findChild<FlowPanel*>();
  EXPECT_TRUE(QTest::qWaitFor([&] { return panel->preview().has_value(); }, 20000));
  EXPECT_GT(panel->preview()->nodes_after, panel->preview()->nodes_before);
  if (auto* tabs = window_.findChild<QTabWidget*>()) tabs->setCurrentIndex(3);
  picture("solver_field");
}

TEST_F(SolverFieldTest, WhatIsChosenCanBeUndone) {
  run();
  open();
  choose("flow_field", "U");
  EXPECT_EQ(study().flow->field->name, "U");
  EXPECT_EQ(on_mesh()->field, "U");
  EXPECT_TRUE(action(Act::flow_arrows)->isEnabled());
  auto* method = find<QComboBox>("flow_method");
  EXPECT_LT(method->findData(int(FlowMethod::indicator)), 0) << "of numbers alone";
  EXPECT_LT(method->findData(int(FlowMethod::residual)), 0) << "of a flow alone";
  choose("flow_method", method->itemText(method->findData(int(FlowMethod::strain))));
  EXPECT_EQ(study().flow->method, FlowMethod::strain);
  // A number cannot be strained.
  choose("flow_field", "T");
  EXPECT_EQ(study().flow->method, FlowMethod::field);
  find<LengthBox>("flow_h_min")->setValue(0.5);
  EXPECT_EQ(study().flow->h_min, 0.5);
  for (int k = 0; k < 5; ++k) action(Act::undo)->trigger();
  EXPECT_FALSE(study().flow.has_value());
  action(Act::redo)->trigger();
  ASSERT_TRUE(study().flow.has_value());
  EXPECT_EQ(study().flow->field->name, "T");
}

TEST_F(SolverFieldTest, AWrongUnitIsToldWithTheOneThatWouldFit) {
  run();
  open();
  window_.banner().hide();
  choose("flow_unit", "mm");
  EXPECT_EQ(study().flow->field->source.unit, 1);
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_TRUE(window_.banner().hint().contains("1000")) << window_.banner().hint().toStdString();
}

TEST_F(SolverFieldTest, TheCommandLineAndTheBodiesKnowIt) {
  open();  // without a mesh
  ASSERT_TRUE(study().flow && study().flow->field);
  const Result<std::string> line = command_line(study());
  ASSERT_TRUE(line.ok()) << line.error().message;
  EXPECT_NE(line->find("--flow field:T --flow-field " + file_.string() + " --flow-field-unit m"),
            std::string::npos)
      << *line;
  Study odd = study();
  odd.flow->field->source.unit = 17;
  EXPECT_FALSE(command_line(odd).ok());
  session().select(0);
  EXPECT_FALSE(window_.findChild<QCheckBox*>("body_flow")->isHidden());
  choose("flow_from", "Flow, solved here");
  EXPECT_FALSE(study().flow->field.has_value());
  EXPECT_EQ(study().flow->method, FlowMethod::combined);
}

TEST_F(SolverFieldTest, AFileThatIsGoneIsToldBeforeTheRun) {
  open();
  std::filesystem::remove(file_);
  action(Act::run)->trigger();
  ASSERT_TRUE(wait_idle());
  EXPECT_TRUE(session().iterations().empty());
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_TRUE(window_.banner().message().contains("solved.vtu"));
  EXPECT_FALSE(window_.banner().hint().isEmpty());
}

TEST_F(SolverFieldTest, AResultWithoutFieldsChangesNothing) {
  fake_.result.of_nodes.clear();
  open();
  EXPECT_FALSE(study().flow.has_value());
  EXPECT_TRUE(window_.banner().message().contains("no field"));
}

TEST_F(SolverFieldTest, ADroppedResultIsOfferedForCorrection) {
  QMimeData data;
  data.setUrls({QUrl::fromLocalFile(QString::fromStdString(file_.string()))});
  const auto drop = [&](const QString& answer) {
    bool asked = false;
    QTimer::singleShot(200, &window_, [&] {
      for (QWidget* top : QApplication::topLevelWidgets()) {
        auto* box = qobject_cast<QMessageBox*>(top);
        if (!box) continue;
        asked = true;
        for (QAbstractButton* button : box->buttons())
          if (button->text() == answer) return button->click();
        box->reject();
      }
    });
    // Qt hands a drop only to a widget that has let the drag in.
    QDragEnterEvent enter(QPoint(100, 100), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&window_, &enter);
    QDropEvent event(QPointF(100, 100), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&window_, &event);
    EXPECT_TRUE(wait_idle());
    return asked;
  };
  EXPECT_TRUE(drop("none of them"));
  EXPECT_FALSE(study().flow.has_value());
  EXPECT_TRUE(session().has_bodies()) << "nothing was opened either";
  EXPECT_TRUE(drop("Correct by its fields"));
  ASSERT_TRUE(study().flow && study().flow->field);
  EXPECT_EQ(study().flow->field->source.file, file_.string());
}

}  // namespace
}  // namespace lamella::ui
