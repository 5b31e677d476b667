#include "ui/main_window.h"

#include <QDropEvent>
#include <QLabel>
#include <QMimeData>
#include <QPushButton>
#include <QSlider>
#include <QSpinBox>
#include <QTreeView>
#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/study/study_file.h"
#include "tests/ui/window_fixture.h"
#include "ui/commands/study_edits.h"
#include "ui/models/study_model.h"
#include "ui/panels/banner.h"
#include "ui/panels/length_box.h"

namespace lamella::ui {
namespace {

/// A closed box as an ASCII STL.
void write_box_stl(const std::filesystem::path& file, const Vec<3>& size) {
  const std::array<std::array<int, 3>, 12> triangles{{{0, 2, 1},
                                                      {1, 2, 3},
                                                      {4, 5, 6},
                                                      {5, 7, 6},
                                                      {0, 1, 4},
                                                      {1, 5, 4},
                                                      {2, 6, 3},
                                                      {3, 6, 7},
                                                      {0, 4, 2},
                                                      {2, 4, 6},
                                                      {1, 3, 5},
                                                      {3, 7, 5}}};
  std::ofstream out(file);
  out << "solid box\n";
  for (const auto& t : triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const int v : t)
      out << "vertex " << (v & 1 ? size[0] : 0) << ' ' << (v & 2 ? size[1] : 0) << ' '
          << (v & 4 ? size[2] : 0) << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid box\n";
}

class MainWindowTest : public WindowFixture {
 protected:
  MainWindowTest() { write_box_stl(folder_ / "box.stl", {30, 20, 4}); }

  void open(const std::string& name) {
    window_.open_files({QString::fromStdString((folder_ / name).string())});
    ASSERT_TRUE(wait_idle());
  }
};

TEST_F(MainWindowTest, EmptyWindowOffersToOpenAndNothingElse) {
  EXPECT_TRUE(session().empty());
  EXPECT_TRUE(action(Act::open)->isEnabled());
  for (const Act act : {Act::run, Act::cancel, Act::export_mesh, Act::section, Act::save_picture})
    EXPECT_FALSE(action(act)->isEnabled());
  EXPECT_FALSE(window_.view().isVisible());
}

TEST_F(MainWindowTest, OpenedPartIsShownAndListed) {
  open("box.stl");
  ASSERT_EQ(session().parts().size(), 1u);
  EXPECT_TRUE(window_.view().isVisible());
  EXPECT_TRUE(action(Act::run)->isEnabled());
  EXPECT_EQ(session().selected(), 0);
  EXPECT_TRUE(window_.windowTitle().startsWith("box"));
  QTest::qWait(50);
  const QImage picture = window_.view().picture();
  ASSERT_FALSE(picture.isNull());
  // The part stands in the middle of the picture, the background in its corner.
  EXPECT_NE(picture.pixel(picture.width() / 2, picture.height() / 2), picture.pixel(3, 3));
}

TEST_F(MainWindowTest, UnitOfAnStlIsToldAndCanBeChanged) {
  open("box.stl");
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_TRUE(window_.banner().message().contains("30 × 20 × 4 mm"));
  const auto buttons = window_.banner().findChildren<QPushButton*>();
  const auto inches = std::find_if(buttons.begin(), buttons.end(),
                                   [](const QPushButton* b) { return b->text() == "Inches"; });
  ASSERT_NE(inches, buttons.end());
  (*inches)->click();
  ASSERT_TRUE(wait_idle());
  EXPECT_NEAR(session().parts()[0].cad_volume, 30 * 20 * 4 * std::pow(25.4, 3), 1);
  EXPECT_FALSE(window_.banner().isVisible()) << "it was told";
}

TEST_F(MainWindowTest, UnitOfAnStlIsGuessedByItsSizeAndConfirmed) {
  for (const auto& [scale, unit] : {std::pair(1 / 25.4, 25.4), std::pair(1e-3, 1000.0)}) {
    write_box_stl(folder_ / "small.stl", scale * Vec<3>(30, 20, 4));
    open("small.stl");
    EXPECT_NEAR(session().parts()[0].cad_volume, 30 * 20 * 4, 0.1);
    EXPECT_EQ(session().study().inputs.at(0).unit, unit);
    EXPECT_TRUE(window_.banner().message().contains(unit == 1000 ? "meters" : "inches"));
    const auto buttons = window_.banner().findChildren<QPushButton*>();
    const auto right = std::find_if(buttons.begin(), buttons.end(), [](const QPushButton* b) {
      return b->text() == "That is right";
    });
    ASSERT_NE(right, buttons.end());
    (*right)->click();
    EXPECT_FALSE(window_.banner().isVisible());
    EXPECT_EQ(session().study().inputs.at(0).unit, unit);
  }
}

TEST_F(MainWindowTest, BadFileGivesABannerWithAHintAndKeepsTheStudy) {
  open("box.stl");
  std::ofstream(folder_ / "bad.step") << "this is no STEP file\n";
  open("bad.step");
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_TRUE(window_.banner().message().contains("bad.step"));
  EXPECT_FALSE(window_.banner().hint().isEmpty());
  EXPECT_EQ(session().parts().size(), 1u);
  EXPECT_TRUE(action(Act::open)->isEnabled());
}

TEST_F(MainWindowTest, MissingFileGivesABanner) {
  open("nowhere.stl");
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_TRUE(window_.banner().message().contains("nowhere.stl"));
  EXPECT_TRUE(session().empty());
}

TEST_F(MainWindowTest, RunFillsTheConvergenceAndShowsTheLastMesh) {
  open("box.stl");
  run();
  EXPECT_EQ(session().iterations().size(), 7u);
  EXPECT_EQ(session().shown(), 6);
  EXPECT_TRUE(session().outcome()->converged);
  EXPECT_TRUE(action(Act::export_mesh)->isEnabled());
  const auto& record = session().iterations().back().record;
  EXPECT_TRUE(window_.findChild<QLabel*>("counts")->text().contains(
      QLocale().toString(qulonglong(record.nodes))));
}

TEST_F(MainWindowTest, CancelKeepsTheBestMeshAndARunCanFollow) {
  open("box.stl");
  fake_.until = 1;
  action(Act::run)->trigger();
  ASSERT_TRUE(wait_iterations(1));
  EXPECT_EQ(session().activity(), Activity::running);
  EXPECT_FALSE(action(Act::run)->isEnabled());
  action(Act::cancel)->trigger();
  ASSERT_TRUE(wait_idle());
  EXPECT_LT(session().iterations().size(), 7u);  // it did not go on to the end
  EXPECT_TRUE(session().outcome()->cancelled);
  EXPECT_NE(session().shown_state(), nullptr);
  fake_.until = 1000;
  run();
  EXPECT_EQ(session().iterations().size(), 7u);
  EXPECT_FALSE(session().outcome()->cancelled);
}

TEST_F(MainWindowTest, LookingBackIsNotInterruptedByNewIterations) {
  open("box.stl");
  fake_.until = 3;
  action(Act::run)->trigger();
  ASSERT_TRUE(wait_iterations(3));
  window_.findChild<QSlider*>("iteration_slider")->setValue(0);
  fake_.until = 5;
  ASSERT_TRUE(wait_iterations(5));
  EXPECT_EQ(session().activity(), Activity::running);
  EXPECT_EQ(session().shown(), 0);
  EXPECT_EQ(session().shown_state(), session().iterations().front().state);
  fake_.until = 1000;
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(session().shown(), 0);
}

TEST_F(MainWindowTest, SectionCutsTheMeshByWholeElements) {
  open("box.stl");
  run();
  const std::size_t whole = window_.view().scene()->shown_elements();
  EXPECT_EQ(whole, session().shown_state()->mesh.element_count());
  action(Act::section)->setChecked(true);
  QTest::qWait(50);
  const std::size_t half = window_.view().scene()->shown_elements();
  EXPECT_LT(half, whole);
  EXPECT_GT(half, whole / 3);
  // Both sides together have everything, and the cut elements twice.
  action(Act::flip)->trigger();
  QTest::qWait(50);
  EXPECT_GE(half + window_.view().scene()->shown_elements(), whole);
  window_.findChild<QSlider*>("section_position")->setValue(100);
  QTest::qWait(50);
  EXPECT_NE(window_.view().scene()->shown_elements(), half);
  action(Act::section)->setChecked(false);
  QTest::qWait(50);
  EXPECT_EQ(window_.view().scene()->shown_elements(), whole);
}

TEST_F(MainWindowTest, SectionCutsThroughElementsWhenAsked) {
  open("box.stl");
  run();
  // Between two planes of nodes: the plane cuts one slice of 17 x 8 cells, and each of the six
  // tetrahedra of a cell spans the whole cell in x.
  window_.view().set_section(Section{{7.9, 0, 0}, Vec<3>::UnitX()});
  QTest::qWait(50);
  const std::size_t crinkled = window_.view().scene()->shown_elements();
  action(Act::crinkle)->setChecked(false);
  QTest::qWait(50);
  EXPECT_EQ(window_.view().scene()->shown_elements(), 17u * 8 * 6);
  EXPECT_LT(window_.view().scene()->shown_elements(), crinkled);
}

TEST_F(MainWindowTest, SectionPlaneIsDraggedByItsKnob) {
  open("box.stl");
  action(Act::section_x)->trigger();
  QTest::qWait(50);
  VtkView* view = window_.view().vtk_view();
  const Section start = *window_.view().section();
  const QPointF knob = view->project(start.origin);
  const QPointF tip = view->project(start.origin + start.normal * (74 * view->pixel_size()));
  const QPointF by = (tip - knob) / 2;
  QTest::mousePress(view, Qt::LeftButton, {}, knob.toPoint());
  QTest::mouseMove(view, (knob + by).toPoint());
  QTest::mouseRelease(view, Qt::LeftButton, {}, (knob + by).toPoint());
  const Section moved = *window_.view().section();
  // Half the shaft on the screen is half the shaft in space, along the normal only.
  EXPECT_NEAR((moved.origin - start.origin).dot(start.normal), 37 * view->pixel_size(),
              2 * view->pixel_size());
  EXPECT_LT((moved.normal - start.normal).norm(), 1e-12);
}

TEST_F(MainWindowTest, ColoringChangesThePictureAndBringsALegend) {
  open("box.stl");
  run();
  QTest::qWait(50);
  const QImage plain = window_.view().picture();
  EXPECT_TRUE(window_.view().scene()->legend().title.isEmpty());
  for (const ColorBy by : {ColorBy::quality, ColorBy::thickness, ColorBy::layers}) {
    window_.view().set_color_by(by);
    QTest::qWait(50);
    EXPECT_FALSE(window_.view().scene()->legend().title.isEmpty());
    EXPECT_GT(difference(plain, window_.view().picture()), 0.05);
  }
  // There and back again the colors are the same.
  window_.view().set_color_by(ColorBy::quality);
  const QImage quality = window_.view().picture();
  window_.view().set_color_by(ColorBy::body);
  EXPECT_LT(difference(plain, window_.view().picture()), 0.001);
  window_.view().set_color_by(ColorBy::quality);
  EXPECT_LT(difference(quality, window_.view().picture()), 0.001);
}

TEST_F(MainWindowTest, BodySettingsAreEditedAndUndone) {
  open("box.stl");
  auto* model = qobject_cast<StudyModel*>(window_.findChild<QTreeView*>("study")->model());
  const QModelIndex layers = model->index_of({ItemKind::body, 0}, StudyModel::value);
  EXPECT_TRUE(model->setData(layers, 8));
  EXPECT_EQ(session().body(0).layers, 8);
  EXPECT_EQ(window_.findChild<QSpinBox*>("layers")->value(), 8);
  auto* h_min = window_.findChild<LengthBox*>("h_min");
  h_min->setValue(0.25);
  EXPECT_EQ(session().body(0).h_min, 0.25);
  h_min->setValue(0);
  EXPECT_FALSE(session().body(0).h_min.has_value());
  EXPECT_FALSE(model->setData(layers, 0));
  action(Act::undo)->trigger();
  EXPECT_EQ(session().body(0).h_min, 0.25);
  action(Act::undo)->trigger();
  action(Act::undo)->trigger();
  EXPECT_EQ(session().body(0).layers, 4);
  action(Act::redo)->trigger();
  EXPECT_EQ(session().body(0).layers, 8);
}

TEST_F(MainWindowTest, SettingsOfSeveralBodiesAreEditedAtOnce) {
  open("box.stl");
  for (int k = 0; k < 2; ++k) {
    window_.open_files({QString::fromStdString((folder_ / "box.stl").string())}, true);
    ASSERT_TRUE(wait_idle());
  }
  ASSERT_EQ(session().parts().size(), 3u);
  auto* layers = window_.findChild<QSpinBox*>("layers");
  session().select({0, 2}, 2);
  auto* tree = window_.findChild<QTreeView*>("study");
  EXPECT_EQ(tree->selectionModel()->selectedRows().size(), 2);
  layers->setValue(6);
  EXPECT_EQ(session().body(0).layers, 6);
  EXPECT_EQ(session().body(1).layers, 4);
  EXPECT_EQ(session().body(2).layers, 6);
  // What differs is not shown as if it were the same, and stays until it is changed.
  session().select({1, 2}, 1);
  EXPECT_EQ(layers->text(), "different");
  auto* h_min = window_.findChild<LengthBox*>("h_min");
  h_min->setValue(0.5);
  EXPECT_EQ(session().body(1).layers, 4);
  EXPECT_EQ(session().body(2).layers, 6);
  EXPECT_EQ(session().body(2).h_min, 0.5);
  action(Act::undo)->trigger();
  EXPECT_FALSE(session().body(1).h_min.has_value());
  EXPECT_FALSE(session().body(2).h_min.has_value());
  // Rows chosen in the tree are chosen everywhere.
  tree->selectAll();
  EXPECT_EQ(session().selection(), (std::vector<int>{0, 1, 2}));
}

TEST_F(MainWindowTest, MeshSettingsReachTheStudyAndSayWhatAutomaticIs) {
  open("box.stl");
  auto* chord = window_.findChild<LengthBox*>("chord_tolerance");
  // The box is 30 x 20 x 4: 1/1000 of its diagonal is 0.0363.
  EXPECT_EQ(chord->text(), "auto: 0.0363 mm");
  EXPECT_EQ(window_.findChild<LengthBox*>("h_min")->text(), "auto: 0.0363 mm");
  EXPECT_EQ(window_.findChild<LengthBox*>("h_max")->text(), "no bound");
  chord->setValue(0.1);
  window_.findChild<LengthBox*>("h_max")->setValue(3);
  window_.findChild<QSpinBox*>("seed")->setValue(7);
  window_.findChild<QSpinBox*>("iterations")->setValue(3);
  EXPECT_EQ(session().study().options.chord_tolerance, 0.1);
  EXPECT_EQ(session().body(0).h_max, 3);
  EXPECT_EQ(session().study().options.seed, 7u);
  EXPECT_EQ(session().study().options.iterations, 3);
  // A smallest size above the largest one would be refused by the run: it moves the other.
  window_.findChild<LengthBox*>("h_min")->setValue(5);
  EXPECT_EQ(session().body(0).h_max, 5);
  chord->setValue(0);
  EXPECT_FALSE(session().study().options.chord_tolerance.has_value());
}

TEST_F(MainWindowTest, AnotherChordToleranceMeansOtherSurfacesWithTheNextRun) {
  ASSERT_TRUE(write_sample("curved_shell", folder_ / "shell.step"));
  open("shell.step");
  const std::size_t before = session().parts()[0].surface.facets.size();
  const double error = session().parts()[0].chord_error;
  window_.findChild<LengthBox*>("chord_tolerance")->setValue(session().automatic_size(0) / 3);
  run();
  EXPECT_GT(session().parts()[0].surface.facets.size(), before);
  EXPECT_LT(session().parts()[0].chord_error, error);
  EXPECT_FALSE(session().outdated());
  EXPECT_EQ(session().selected(), 0);
}

TEST_F(MainWindowTest, ClickSelectsTheBodyAndTheSelectedOneIsOutlined) {
  ASSERT_TRUE(write_sample("twisted_tube", folder_ / "tube.step"));
  open("tube.step");
  ASSERT_EQ(session().parts().size(), 2u);
  VtkView* view = window_.view().vtk_view();
  QTest::qWait(50);
  session().select(0);
  QTest::qWait(50);
  const QImage first = window_.view().picture();
  session().select(1);
  QTest::qWait(50);
  EXPECT_GT(difference(first, window_.view().picture()), 0.001);
  // The block encloses the tube: it is what a click in the middle hits, in the part and the mesh.
  const auto volume = [this](int k) { return session().parts()[std::size_t(k)].cad_volume; };
  const int block = volume(0) > volume(1) ? 0 : 1;
  session().select(1 - block);
  QTest::mouseClick(view, Qt::LeftButton, {}, view->rect().center());
  EXPECT_EQ(session().selected(), block);
  // Nothing is hit in the corner: the selection stays.
  QTest::mouseClick(view, Qt::LeftButton, {}, QPoint(3, 3));
  EXPECT_EQ(session().selected(), block);
  // Ctrl adds; a hidden body cannot be hit.
  BodySettings hidden = session().body(block);
  hidden.visible = false;
  session().edit_body(block, "hide", hidden);
  const Vec<3> inside = session().parts()[std::size_t(1 - block)].surface.points.front();
  QTest::qWait(50);
  QTest::mouseClick(view, Qt::LeftButton, Qt::ControlModifier, view->rect().center());
  if (session().selection().size() == 1) {
    // The tube winds around the middle: aim at one of its own points.
    QTest::mouseClick(view, Qt::LeftButton, Qt::ControlModifier, view->project(inside).toPoint());
  }
  EXPECT_EQ(session().selection().size(), 2u);
}

TEST_F(MainWindowTest, LayersAreJudgedByWhatTheSelectedBodyAsks) {
  open("box.stl");
  window_.open_files({QString::fromStdString((folder_ / "box.stl").string())}, true);
  ASSERT_TRUE(wait_idle());
  run();
  window_.view().set_color_by(ColorBy::layers);
  session().select(1);
  window_.findChild<QSpinBox*>("layers")->setValue(7);
  EXPECT_EQ(window_.view().scene()->legend().high, 14);
  session().select(0);
  EXPECT_EQ(window_.view().scene()->legend().high, 8);
}

TEST_F(MainWindowTest, SettingsChangedAfterARunAreTold) {
  open("box.stl");
  run();
  EXPECT_FALSE(session().outdated());
  window_.findChild<QSpinBox*>("layers")->setValue(6);
  EXPECT_TRUE(session().outdated());
  action(Act::undo)->trigger();
  EXPECT_FALSE(session().outdated());
}

TEST_F(MainWindowTest, HiddenBodyLeavesThePicture) {
  open("box.stl");
  QTest::qWait(50);
  const QImage with = window_.view().picture();
  auto* model = qobject_cast<StudyModel*>(window_.findChild<QTreeView*>("study")->model());
  model->setData(model->index_of({ItemKind::body, 0}), Qt::Unchecked, Qt::CheckStateRole);
  QTest::qWait(50);
  EXPECT_GT(difference(with, window_.view().picture()), 0.05);
}

TEST_F(MainWindowTest, BodiesOfASecondFileAreAddedUnderANameOfTheirOwn) {
  open("box.stl");
  window_.open_files({QString::fromStdString((folder_ / "box.stl").string())}, true);
  ASSERT_TRUE(wait_idle());
  ASSERT_EQ(session().parts().size(), 2u);
  EXPECT_NE(session().body(0).name, session().body(1).name);
}

TEST_F(MainWindowTest, ARemovedPartComesBackWithItsGroupsAndSizes) {
  write_box_stl(folder_ / "bar.stl", {60, 4, 8});
  open("box.stl");
  window_.open_files({QString::fromStdString((folder_ / "bar.stl").string())}, true);
  ASSERT_TRUE(wait_idle());
  add_group(session(), GroupKind::gate, "bar", {0});
  add_sizing(session(), "bar", "near", SphereShape{{1, 2, 3}, 2});
  session().select(1);
  window_.findChild<QSpinBox*>("layers")->setValue(7);
  const std::string asked = study_to_json(session().study());
  const auto& tree = *window_.findChild<QTreeView*>("study")->model();
  const auto rows = [&] { return tree.rowCount(tree.index(int(ItemKind::body), 0)); };
  QTest::qWait(50);
  const QImage both = window_.view().picture();

  action(Act::remove)->trigger();
  ASSERT_EQ(session().parts().size(), 1u);
  EXPECT_TRUE(session().study().groups.empty() && session().study().sizing.empty());
  EXPECT_EQ(session().selected(), 0);
  EXPECT_EQ(rows(), 1);
  EXPECT_EQ(session().undo_stack()->undoText(), "Remove bar");
  EXPECT_GT(difference(both, window_.view().picture()), 0.01);
  action(Act::undo)->trigger();
  ASSERT_EQ(session().parts().size(), 2u);
  EXPECT_EQ(study_to_json(session().study()), asked);
  EXPECT_EQ(session().selected(), 1);
  EXPECT_EQ(rows(), 2);
  QTest::qWait(50);
  EXPECT_LT(difference(both, window_.view().picture()), 0.001);
  action(Act::undo)->trigger();
  EXPECT_EQ(session().body(1).layers, 4) << "what came before is undone as ever";

  // What was meshed stays in sight, as a mesh of other settings, until the part is back.
  run();
  action(Act::remove)->trigger();
  EXPECT_NE(session().shown_state(), nullptr);
  EXPECT_TRUE(session().outdated());
  action(Act::undo)->trigger();
  EXPECT_FALSE(session().outdated());
  // So does the last one.
  for (int k = 0; k < 2; ++k) action(Act::remove)->trigger();
  EXPECT_FALSE(session().has_bodies());
  for (int k = 0; k < 2; ++k) action(Act::undo)->trigger();
  EXPECT_EQ(session().parts().size(), 2u);
  EXPECT_TRUE(action(Act::run)->isEnabled());
}

TEST_F(MainWindowTest, APartThatComesBackIsAsFineAsTheOthers) {
  ASSERT_TRUE(write_sample("curved_shell", folder_ / "shell.step"));
  open("shell.step");
  window_.open_files({QString::fromStdString((folder_ / "box.stl").string())}, true);
  ASSERT_TRUE(wait_idle());
  const auto triangles = [this] { return session().parts()[0].surface.facets.size(); };
  const std::size_t coarse = triangles();
  auto* chord = window_.findChild<LengthBox*>("chord_tolerance");
  const double fine = session().automatic_size(0) / 3;
  session().remove_item({ItemKind::body, 0});
  chord->setValue(fine);
  run();
  for (int k = 0; k < 2; ++k) action(Act::undo)->trigger();
  ASSERT_EQ(triangles(), coarse);
  chord->setValue(fine);
  run();
  EXPECT_GT(triangles(), coarse) << "the box was as fine already, the shell was not";
}

TEST_F(MainWindowTest, ExportTellsSuccessAndFailure) {
  open("box.stl");
  run();
  QSignalSpy exported(&session(), &Session::exported);
  session().export_mesh(folder_ / "box.msh");
  ASSERT_TRUE(wait_idle());
  ASSERT_EQ(exported.count(), 1);
  EXPECT_EQ(fake_.exports, 1);
  EXPECT_EQ(exported.at(0).at(1).toString(), "a note of the export");
  EXPECT_TRUE(window_.banner().message().contains("box.msh"));
  session().export_mesh(folder_.path() / "no_such_folder" / "box.msh");
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(exported.count(), 1);
  EXPECT_TRUE(window_.banner().message().contains("no_such_folder"));
}

TEST_F(MainWindowTest, DroppedFileIsOpened) {
  QMimeData data;
  data.setUrls({QUrl::fromLocalFile(QString::fromStdString((folder_ / "box.stl").string()))});
  // Qt hands a drop only to a widget that has let the drag in.
  QDragEnterEvent enter(QPoint(100, 100), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&window_, &enter);
  ASSERT_TRUE(enter.isAccepted());
  QDropEvent drop(QPointF(100, 100), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&window_, &drop);
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(session().parts().size(), 1u);
}

TEST_F(MainWindowTest, MeshFileIsShownWithoutParts) {
  window_.open_files({QString::fromStdString((folder_ / "any.msh").string())});
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(window_.view().scene()->shown_elements(), 4u * 3 * 2 * 6);
  // Without its metric nothing is known of what counts in it, least of all that it is 0.
  EXPECT_TRUE(std::isnan(session().iterations()[0].record.quality_min));
  EXPECT_TRUE(std::isnan(session().iterations()[0].record.conformity));
  EXPECT_FALSE(action(Act::run)->isEnabled());
  EXPECT_TRUE(action(Act::export_mesh)->isEnabled());
}

TEST_F(MainWindowTest, ClosingDuringARunStopsIt) {
  open("box.stl");
  fake_.until = 1;  // it would never end
  action(Act::run)->trigger();
  ASSERT_TRUE(wait_iterations(1));
  window_.close();
  EXPECT_TRUE(wait_idle());
}

/// Pictures of the main states for a person to judge: LAMELLA_PICTURES names the folder.
TEST_F(MainWindowTest, StatesCanBePictured) {
  const QString to = qEnvironmentVariable("LAMELLA_PICTURES");
  const QString part = qEnvironmentVariable("LAMELLA_PICTURED_PART",
                                            QString::fromStdString((folder_ / "box.stl").string()));
  const auto keep = [&](const char* name) {
    if (!to.isEmpty()) QTest::qWait(200);
    const QPixmap picture = window_.grab();
    EXPECT_EQ(picture.size(), window_.size() * window_.devicePixelRatio());
    if (to.isEmpty()) return;
    EXPECT_TRUE(picture.save(to + "/" + name + ".png"));
  };
  keep("empty");
  window_.open_files({part});
  ASSERT_TRUE(wait_idle());
  keep("part");
  fake_.until = 4;
  action(Act::run)->trigger();
  ASSERT_TRUE(wait_iterations(4));
  keep("running");
  fake_.until = 1000;
  ASSERT_TRUE(wait_idle());
  action(Act::section)->setChecked(true);
  keep("section");
  window_.view().set_color_by(ColorBy::thickness);
  keep("thickness");
}

}  // namespace
}  // namespace lamella::ui
