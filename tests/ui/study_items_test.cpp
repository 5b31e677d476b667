#include <gtest/gtest.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileInfo>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QLocale>
#include <QSpinBox>
#include <QStandardPaths>
#include <QTreeView>
#include <cmath>

#include "core/base/atomic_file.h"
#include "core/base/sha256.h"
#include "core/project/project_file.h"
#include "core/study/study_file.h"
#include "tests/ui/window_fixture.h"
#include "ui/commands/study_edits.h"
#include "ui/models/study_model.h"
#include "ui/panels/banner.h"
#include "ui/panels/convergence_panel.h"
#include "ui/panels/journal_view.h"
#include "ui/panels/palette.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/recovery_dialog.h"
#include "ui/session/command_line.h"
#include "ui/session/recovery.h"
#include "ui/window_tools.h"

namespace lamella::ui {
namespace {

/// A window with a plate of 40 x 30 x 2 and runs that are made up.
class StudyItemsTest : public WindowFixture {
 protected:
  StudyItemsTest() { open_part("plate"); }

  void click() { QTest::mouseClick(view(), Qt::LeftButton, {}, view()->rect().center()); }
};

TEST_F(StudyItemsTest, WhatIsRarelySetReachesTheStudyAndIsUndone) {
  auto* layers2 = window_.findChild<QSpinBox*>("layers2");
  auto* alpha2 = window_.findChild<QDoubleSpinBox*>("alpha2");
  EXPECT_FALSE(alpha2->isEnabled());
  layers2->setValue(6);
  EXPECT_EQ(session().body(0).layers2, 6);
  EXPECT_GT(session().body(0).alpha2, 0);  // the two go together
  alpha2->setValue(8);
  EXPECT_EQ(session().body(0).alpha2, 8);
  window_.findChild<QSpinBox*>("layers3")->setValue(3);
  EXPECT_EQ(session().body(0).layers3, 3);
  layers2->setValue(0);
  EXPECT_FALSE(session().body(0).layers2.has_value());
  EXPECT_EQ(session().body(0).alpha2, 0);
  window_.findChild<QCheckBox*>("progressive")->setChecked(true);
  EXPECT_TRUE(study().options.progressive);
  window_.findChild<QComboBox*>("detector")->setCurrentIndex(1);
  EXPECT_EQ(study().options.detector, Detector::neighborhood);
  for (int k = 0; k < 6; ++k) action(Act::undo)->trigger();
  EXPECT_FALSE(study().options.progressive);
  EXPECT_FALSE(session().body(0).layers2.has_value());
  EXPECT_FALSE(session().modified());
}

TEST_F(StudyItemsTest, FacesOfAGroupArePickedInTheView) {
  action(Act::add_group)->trigger();
  ASSERT_EQ(study().groups.size(), 1u);
  EXPECT_EQ(session().item(), (Item{ItemKind::group, 0}));
  EXPECT_TRUE(action(Act::pick_faces)->isChecked());
  const QImage before = window_.view().picture();
  click();
  ASSERT_EQ(study().groups[0].faces.size(), 1u);
  EXPECT_EQ(study().groups[0].body, session().body(0).name);
  QTest::qWait(50);
  EXPECT_NE(before, window_.view().picture());
  // The same face again goes out, and undo brings it back.
  click();
  EXPECT_TRUE(study().groups[0].faces.empty());
  action(Act::undo)->trigger();
  EXPECT_EQ(study().groups[0].faces.size(), 1u);
  QTest::keyClick(view(), Qt::Key_Escape);
  EXPECT_FALSE(action(Act::pick_faces)->isChecked());
  click();
  EXPECT_EQ(session().item().kind, ItemKind::body);

  // Name and kind are set among the properties; the name in the tree follows.
  session().select_item({ItemKind::group, 0});
  auto* name = window_.findChild<QLineEdit*>("group_name");
  name->setText("inlet");
  Q_EMIT name->editingFinished();
  EXPECT_EQ(study().groups[0].name, "inlet");
  auto* model = qobject_cast<StudyModel*>(window_.findChild<QTreeView*>("study")->model());
  EXPECT_EQ(model->index_of({ItemKind::group, 0}).data().toString(), "inlet");
  // Faces are picked on the mesh as on the part.
  run();
  QTest::qWait(50);
  action(Act::pick_flood)->setChecked(true);
  click();
  EXPECT_EQ(study().groups[0].floods.size(), 1u);
  EXPECT_TRUE(session().outdated());
  session().remove_item({ItemKind::group, 0});
  EXPECT_TRUE(study().groups.empty());
  action(Act::undo)->trigger();
  EXPECT_EQ(study().groups.size(), 1u);
}

TEST_F(StudyItemsTest, ASizeIsPutWhereOneClicksAndItsKnobsAreDragged) {
  action(Act::correct_near)->setChecked(true);
  click();
  ASSERT_EQ(study().sizing.size(), 1u);
  EXPECT_EQ(window_.actions().mode(), Act::count);
  const auto sphere = [&] { return std::get<SphereShape>(study().sizing[0].shape); };
  const SphereShape first = sphere();
  QTest::qWait(50);
  // It is where the click hit the part.
  const QPointF center = view()->project(first.center);
  EXPECT_LT(std::hypot(center.x() - view()->width() / 2.0, center.y() - view()->height() / 2.0), 3);

  const int steps = session().undo_stack()->index();
  const QPointF knob = center + QPointF(first.radius / view()->pixel_size(), 0);
  QTest::mousePress(view(), Qt::LeftButton, {}, knob.toPoint());
  QTest::mouseMove(view(), (knob + QPointF(10, 0)).toPoint());
  QTest::mouseMove(view(), (knob + QPointF(20, 0)).toPoint());
  QTest::mouseRelease(view(), Qt::LeftButton, {}, (knob + QPointF(20, 0)).toPoint());
  EXPECT_NEAR(sphere().radius, first.radius + 20 * view()->pixel_size(), 2 * view()->pixel_size());
  EXPECT_EQ(session().undo_stack()->index(), steps + 1) << "one drag is one step";
  action(Act::undo)->trigger();
  EXPECT_EQ(sphere().radius, first.radius);

  // What it asks is set among the properties.
  window_.findChild<QDoubleSpinBox*>("asked_value")->setValue(0.25);
  EXPECT_EQ(std::get<SizeCorrection>(study().sizing[0].asks).factor, 0.25);
  window_.findChild<QCheckBox*>("keep_directions")->setChecked(true);
  EXPECT_TRUE(std::get<SizeCorrection>(study().sizing[0].asks).keep_directions);
  for (const Act act : {Act::add_sphere, Act::add_box, Act::add_cylinder}) action(act)->trigger();
  ASSERT_EQ(study().sizing.size(), 4u);
  action(Act::correct_face)->setChecked(true);
  click();
  ASSERT_EQ(study().sizing.size(), 5u);
  EXPECT_EQ(std::get<FacesShape>(study().sizing[4].shape).ids.size(), 1u);
}

TEST_F(StudyItemsTest, SeveralCutsAreEntriesOfTheStudy) {
  run();
  const std::size_t whole = window_.view().scene()->shown_elements();
  action(Act::section)->setChecked(true);
  QTest::qWait(50);
  const std::size_t half = window_.view().scene()->shown_elements();
  action(Act::add_cut)->trigger();
  QTest::qWait(50);
  ASSERT_EQ(study().cuts.size(), 2u);
  const std::size_t quarter = window_.view().scene()->shown_elements();
  EXPECT_LT(half, whole);
  EXPECT_LT(quarter, half);
  EXPECT_GT(quarter, 0u);
  // The eye in the tree turns one off; cutting through elements works with both.
  auto* model = qobject_cast<StudyModel*>(window_.findChild<QTreeView*>("study")->model());
  model->setData(model->index_of({ItemKind::cut, 1}), Qt::Unchecked, Qt::CheckStateRole);
  QTest::qWait(50);
  EXPECT_EQ(window_.view().scene()->shown_elements(), half);
  EXPECT_FALSE(session().outdated()) << "cuts are for the eye only";
  action(Act::section)->setChecked(false);
  QTest::qWait(50);
  EXPECT_EQ(window_.view().scene()->shown_elements(), whole);
}

TEST_F(StudyItemsTest, SavedStudyIsOpenedAsItWas) {
  add_group(session(), GroupKind::vent, session().body(0).name, {2});
  add_sizing(session(), session().body(0).name, "gate", SphereShape{{1, 2, 3}, 4});
  add_cut(session(), Vec<3>(1, 2, 0), Vec<3>::UnitY());
  session().select(0);
  window_.findChild<QSpinBox*>("layers")->setValue(7);
  EXPECT_TRUE(session().modified());
  EXPECT_TRUE(window_.isWindowModified());
  session().save(folder_ / "s.lamella");
  ASSERT_TRUE(wait_idle());
  EXPECT_FALSE(session().modified());
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"plate.step", "s.lamella"}));
  const std::string asked = study_to_json(study());

  session().open({folder_ / "plate.step"});
  ASSERT_TRUE(wait_idle());
  ASSERT_TRUE(study().groups.empty());
  window_.open_files({QString::fromStdString((folder_ / "s.lamella").string())});
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(study_to_json(study()), asked);
  EXPECT_FALSE(session().modified());
  EXPECT_TRUE(window_.view().section().has_value());
  EXPECT_FALSE(window_.banner().isVisible());
  session().save(folder_ / "nowhere" / "s.lamella");
  ASSERT_TRUE(wait_idle());
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_TRUE(window_.banner().message().contains("nowhere"));
  EXPECT_EQ(session().file(), folder_ / "s.lamella");
}

TEST_F(StudyItemsTest, AMeshOfOtherSettingsIsKeptAsOne) {
  run();
  const auto study = folder_ / "s.lamella";
  window_.findChild<QSpinBox*>("layers")->setValue(9);
  ASSERT_TRUE(session().outdated());
  session().save(study);
  ASSERT_TRUE(wait_idle());
  const Result<Project> kept = open_project(study);
  ASSERT_TRUE(kept);
  EXPECT_FALSE(kept->mesh.empty());
  EXPECT_NE(kept->report_html.find("<html"), std::string::npos);
  session().open_study(study);
  ASSERT_TRUE(wait_idle());
  EXPECT_NE(session().shown_state(), nullptr);
  EXPECT_TRUE(session().outdated()) << "it is not taken for one of these settings";
  EXPECT_EQ(session().body(0).layers, 9);
  // Saved once more, the report of the mesh that was opened stays with it.
  session().save(study);
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(open_project(study)->report_html, kept->report_html);
}

TEST_F(StudyItemsTest, AStudyAsTextIsOpenedAndSavedToo) {
  const auto text = folder_ / "s.json";
  window_.findChild<QSpinBox*>("layers")->setValue(6);
  session().save(text);
  ASSERT_TRUE(wait_idle());
  EXPECT_FALSE(session().modified());
  EXPECT_EQ(read_study(text)->inputs.at(0).file, "plate.step");
  session().open({folder_ / "plate.step"});
  ASSERT_TRUE(wait_idle());
  window_.open_files({QString::fromStdString(text.string())});
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(session().body(0).layers, 6);
}

TEST_F(StudyItemsTest, InputsThatChangedOrWentAreTold) {
  Study study = session().study();
  study.embed_inputs = true;
  session().edit("copies", study);
  add_group(session(), GroupKind::vent, session().body(0).name, {2, 77});
  window_.findChild<QSpinBox*>("layers")->setValue(6);
  const auto file = folder_ / "s.lamella", part = folder_ / "plate.step";
  session().save(file);
  ASSERT_TRUE(wait_idle());
  std::string step = read_file(part).value();
  ASSERT_TRUE(write_file(part, step + "\n"));
  QSignalSpy noticed(&session(), &Session::noticed);
  session().open_study(file);
  ASSERT_TRUE(wait_idle());
  ASSERT_EQ(noticed.count(), 1);
  const QString changed = noticed.takeFirst().at(1).toString();
  EXPECT_TRUE(changed.contains("plate.step\" has changed")) << changed.toStdString();
  EXPECT_TRUE(changed.contains("no face like number 77")) << changed.toStdString();
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_EQ(session().body(0).layers, 6);
  EXPECT_EQ(study_to_json(session().study()).find(sha256(step)), std::string::npos);

  std::filesystem::remove(part);
  session().open_study(file);
  ASSERT_TRUE(wait_idle());
  ASSERT_EQ(noticed.count(), 1);
  EXPECT_TRUE(noticed.at(0).at(1).toString().contains("the copy in the project was read"));
  EXPECT_EQ(session().parts().size(), 1u);
  // The copy goes along when it is saved elsewhere.
  session().save(folder_ / "t.lamella");
  ASSERT_TRUE(wait_idle());
  std::filesystem::remove(file);
  session().open_study(folder_ / "t.lamella");
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(session().parts().size(), 1u);
  EXPECT_EQ(session().body(0).layers, 6);
}

TEST_F(StudyItemsTest, AStudyOpensWithoutAMeshThatCannotBeRead) {
  const auto study = folder_ / "s.lamella";
  run();
  session().save(study);
  ASSERT_TRUE(wait_idle());
  fake_.mesh_is_damaged = true;
  QSignalSpy opened(&session(), &Session::study_opened), failed(&session(), &Session::failed);
  session().open_study(study);
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(opened.count(), 1);
  EXPECT_EQ(failed.count(), 1) << "the user is told";
  EXPECT_EQ(session().parts().size(), 1u);
  EXPECT_EQ(session().shown_state(), nullptr);
  // What cannot be opened at all is not opened: whatever waits for it keeps what it has.
  session().open_study(folder_ / "none.lamella");
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(opened.count(), 1);
}

TEST_F(StudyItemsTest, WhatIsUnsavedSurvivesACrash) {
  const auto folder = folder_.path() / "recovery";
  Recovery recovery(session(), folder);
  window_.findChild<QSpinBox*>("layers")->setValue(9);
  const auto kept = [&] {
    std::error_code ec;
    return !std::filesystem::is_empty(folder, ec) && !ec;
  };
  ASSERT_TRUE(QTest::qWaitFor(kept, patience));
  // This program still runs: nothing is left behind. One that is gone has left what it had.
  EXPECT_TRUE(recovery.left_behind().empty());
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    std::filesystem::copy_file(entry.path(),
                               folder / ("999999999" + entry.path().extension().string()));
  const auto left = recovery.left_behind();
  ASSERT_EQ(left.size(), 1u);
  session().open({folder_ / "plate.step"});
  ASSERT_TRUE(wait_idle());
  ASSERT_EQ(session().body(0).layers, 4);
  session().open_study(left[0].file, left[0].made_for);
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(session().body(0).layers, 9);
  EXPECT_TRUE(session().modified());
  EXPECT_TRUE(session().file().empty());
  Recovery::discard(left[0]);
  session().save(folder_ / "s.lamella");
  ASSERT_TRUE(wait_idle());
  EXPECT_FALSE(kept());
}

/// A home for the program's data that no other run of these tests looks into.
class OwnHome {
 protected:
  OwnHome() { qputenv("HOME", QByteArray::fromStdString(home_.path().string())); }
  ~OwnHome() { qputenv("HOME", before_); }

 private:
  QByteArray before_ = qgetenv("HOME");
  test::TemporaryFolder home_;
};

/// Beside the program's data: studies that programs which are gone have left.
class RecoveryTest : OwnHome, public StudyItemsTest {
 protected:
  void leave(const char* pid, int layers, const std::string& target) {
    Study study = session().study();
    study.name = "of " + std::string(pid);
    study.bodies[0].layers = layers;
    ASSERT_TRUE(write_study(study, kept_ / (std::string(pid) + ".lamella")));
    ASSERT_TRUE(write_file(kept_ / (std::string(pid) + ".target"), target));
    ASSERT_TRUE(write_file(kept_ / (std::string(pid) + ".journal"), "12:00  Edit: Layers\n"));
  }
  bool left(const char* pid) const {
    return std::filesystem::exists(kept_ / (std::string(pid) + ".lamella"));
  }
  /// The dialog, after what it does.
  RecoveryDialog* offered(const QStringList& files = {}) {
    window_.tools().offer_recovery(files);
    QTest::qWait(30);
    auto* dialog = window_.findChild<RecoveryDialog*>();
    // Its shortcuts are deaf until then.
    EXPECT_TRUE(dialog == nullptr || QTest::qWaitForWindowActive(dialog, patience));
    return dialog;
  }
  void expect_closed() {
    EXPECT_TRUE(
        QTest::qWaitFor([this] { return !window_.findChild<RecoveryDialog*>(); }, patience));
  }

  std::filesystem::path kept_ =
      QStandardPaths::writableLocation(QStandardPaths::AppDataLocation).toStdString() + "/recovery";
};

TEST_F(RecoveryTest, ADialogTellsWhatIsRecoveredAndEnterRecoversIt) {
  EXPECT_EQ(offered(), nullptr) << "nothing was left";
  const std::string target = (folder_ / "mine.lamella").string();
  leave("999999999", 9, target);
  RecoveryDialog* dialog = offered();
  ASSERT_NE(dialog, nullptr);
  const QString details = dialog->findChild<QLabel*>("recovery_details")->text();
  const QString written = QLocale().toString(
      QFileInfo(QString::fromStdString((kept_ / "999999999.lamella").string())).lastModified(),
      QLocale::ShortFormat);
  for (const QString& told : {QString::fromStdString(target), written, QString("of 999999999"),
                              QString("1 body (plate)")})
    EXPECT_TRUE(details.contains(told)) << told.toStdString();
  if (const QString to = qEnvironmentVariable("LAMELLA_PICTURES"); !to.isEmpty())
    dialog->grab().save(to + "/recovery.png");
  QTest::keyClick(dialog, Qt::Key_Return);
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(session().body(0).layers, 9);
  EXPECT_EQ(session().file().string(), target);
  EXPECT_TRUE(session().modified());
  EXPECT_FALSE(left("999999999")) << "it is kept anew, as that of this window";
  EXPECT_FALSE(std::filesystem::exists(kept_ / "999999999.journal"));
  expect_closed();
}

TEST_F(RecoveryTest, EscapeLeavesItToTheNextStartAndOpensWhatWasAskedFor) {
  leave("999999999", 9, "");
  ASSERT_TRUE(write_sample("wedge", folder_ / "wedge.step"));
  RecoveryDialog* dialog = offered({QString::fromStdString((folder_ / "wedge.step").string())});
  ASSERT_NE(dialog, nullptr);
  EXPECT_EQ(session().body(0).name, "plate") << "not before it is decided";
  QTest::keyClick(dialog, Qt::Key_Escape);
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(session().body(0).name, "wedge");
  EXPECT_TRUE(left("999999999"));
  expect_closed();
}

TEST_F(RecoveryTest, OfSeveralOneIsChosenAndOthersAreDiscardedByKeys) {
  leave("999999998", 8, "");
  QTest::qWait(20);
  leave("999999999", 9, "");
  RecoveryDialog* dialog = offered();
  ASSERT_NE(dialog, nullptr);
  auto* list = dialog->findChild<QListWidget*>("recovery_list");
  ASSERT_EQ(list->count(), 2);
  EXPECT_TRUE(dialog->findChild<QLabel*>("recovery_details")->text().contains("of 999999999"))
      << "the latest is chosen";
  QTest::keyClick(dialog, Qt::Key_W, Qt::AltModifier);
  ASSERT_TRUE(
      QTest::qWaitFor([&] { return dialog->findChild<JournalView*>() != nullptr; }, patience));
  dialog->findChild<JournalView*>()->close();
  dialog->activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(dialog, patience));
  QTest::keyClick(dialog, Qt::Key_D, Qt::AltModifier);
  // A button that a key presses stays down for a moment.
  EXPECT_TRUE(QTest::qWaitFor([&] { return !left("999999999"); }, patience));
  EXPECT_TRUE(left("999999998"));
  EXPECT_TRUE(std::filesystem::exists(kept_ / "999999998.journal"));
  ASSERT_TRUE(dialog->isVisible());
  QTest::keyClick(dialog, Qt::Key_D, Qt::AltModifier);
  EXPECT_TRUE(QTest::qWaitFor([&] { return !left("999999998"); }, patience));
  EXPECT_FALSE(std::filesystem::exists(kept_ / "999999998.journal"));
  expect_closed();
}

TEST_F(StudyItemsTest, ActionsAreFoundByTheirWords) {
  action(Act::search)->trigger();
  auto* text = window_.findChild<QLineEdit*>("palette_text");
  ASSERT_NE(text, nullptr);
  auto* list = window_.findChild<QListWidget*>("palette_list");
  const int all = list->count();
  text->setText("mesh edges");
  EXPECT_LT(list->count(), all);
  ASSERT_GE(list->count(), 1);
  ASSERT_TRUE(action(Act::edges)->isChecked());
  QTest::keyClick(text, Qt::Key_Return);
  EXPECT_FALSE(action(Act::edges)->isChecked());
}

TEST_F(StudyItemsTest, ARangeOfQualityShowsItsElementsAlone) {
  run();
  auto* quality = window_.findChild<QualityPanel*>();
  const auto state = session().shown_state();
  quality->set_range(std::pair(0.0, 0.5));
  QTest::qWait(50);
  std::size_t poor = 0;
  for (const double q : state->quality) poor += q <= 0.5;
  EXPECT_EQ(window_.view().scene()->shown_elements(), poor);
  quality->set_range(std::nullopt);
  EXPECT_EQ(window_.view().scene()->shown_elements(), state->mesh.element_count());
}

TEST_F(StudyItemsTest, FiguresOfEveryIterationAreALineEach) {
  run();
  const QStringList lines =
      window_.findChild<ConvergencePanel*>()->csv().split('\n', Qt::SkipEmptyParts);
  ASSERT_EQ(lines.size(), static_cast<qsizetype>(session().iterations().size()) + 1);
  const QStringList titles = lines[0].split(','), last = lines.back().split(',');
  ASSERT_EQ(titles.size(), last.size());
  EXPECT_EQ(last[titles.indexOf("nodes")].toULongLong(),
            session().iterations().back().record.nodes);
}

TEST_F(StudyItemsTest, APlaceIsBroughtToTheMiddleOfTheView) {
  const Vec<3> corner = session().parts()[0].surface.points.front();
  session().show_place(corner, 2, "2.1 of 4 layers");
  QTest::qWait(50);
  const QPointF seen = view()->project(corner);
  EXPECT_NEAR(seen.x(), view()->width() / 2.0, 2);
  EXPECT_NEAR(seen.y(), view()->height() / 2.0, 2);
}

TEST_F(StudyItemsTest, DistancesAreMeasuredAndTheMetricShownWhileCut) {
  run();
  action(Act::section)->setChecked(true);
  QTest::qWait(50);
  const QImage before = window_.view().picture();
  action(Act::measure)->setChecked(true);
  const QPoint middle = view()->rect().center();
  QTest::mouseClick(view(), Qt::LeftButton, {}, middle);
  QTest::mouseClick(view(), Qt::LeftButton, {}, middle + QPoint(60, 10));
  EXPECT_NE(before, window_.view().picture());
  action(Act::ellipsoid)->setChecked(true);
  EXPECT_FALSE(action(Act::measure)->isChecked());
  click();
  QTest::keyClick(view(), Qt::Key_Escape);
  QTest::qWait(50);
  EXPECT_EQ(before, window_.view().picture()) << "Escape clears what was measured";
}

TEST_F(StudyItemsTest, PicturesHaveTheResolutionAsked) {
  const QSize before = view()->size();
  const QImage large = window_.view().picture(QSize(1920, 1080));
  EXPECT_EQ(large.size(), QSize(1920, 1080));
  EXPECT_EQ(view()->size(), before);
}

TEST_F(StudyItemsTest, ABoxIsZoomedTo) {
  const double before = view()->pixel_size();
  action(Act::box_zoom)->setChecked(true);
  const QPoint middle = view()->rect().center();
  QTest::mousePress(view(), Qt::LeftButton, {}, middle - QPoint(40, 40));
  QTest::mouseMove(view(), middle);
  QTest::mouseRelease(view(), Qt::LeftButton, {}, middle + QPoint(40, 40));
  EXPECT_LT(view()->pixel_size(), before / 2);
  EXPECT_FALSE(action(Act::box_zoom)->isChecked());
}

TEST(CommandLine, SaysWhatTheStudyAsks) {
  Study study;
  study.name = "my part";
  study.inputs = {{"a b.stl", 25.4}};
  study.bodies = {{"a b", 6}};
  study.bodies[0].h_min = 0.05;
  study.options.iterations = 3;
  study.groups = {{"gate", GroupKind::gate, "a b", {3, 4}}};
  SizeCorrection half;
  half.factor = 0.5;
  study.sizing = {{"s", "", SphereShape{{1, 2, 3}, 4}, half}};
  const Result<std::string> line = command_line(study);
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(*line,
            "lamella-cli mesh 'a b.stl' --unit inch -n 6 --h-min 0.05 --iterations 3 "
            "--size-sphere 1,2,3,4,0.5x --group 'gate=a b:3,4' -o 'my part.msh'");
  // What options cannot say is not passed over.
  study.bodies.push_back({"pin", 2});
  EXPECT_FALSE(command_line(study));
}

}  // namespace
}  // namespace lamella::ui
