#include <QAccessible>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QSettings>
#include <QSpinBox>
#include <QTabWidget>
#include <QTranslator>
#include <QTreeView>
#include <fstream>

#include "core/study/study_file.h"
#include "tests/ui/window_fixture.h"
#include "ui/commands/study_edits.h"
#include "ui/language.h"
#include "ui/models/study_model.h"
#include "ui/panels/banner.h"
#include "ui/panels/convergence_panel.h"
#include "ui/panels/form.h"
#include "ui/panels/preferences.h"
#include "ui/panels/quality_panel.h"
#include "ui/session/command_line.h"
#include "ui/session/journal.h"
#include "ui/units.h"
#include "ui/window_tools.h"

namespace lamella::ui {
namespace {

class HabitsTest : public WindowFixture {
 protected:
  ~HabitsTest() override { Units::get().set_inches(false); }

  QString text_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    return QString::fromStdString({std::istreambuf_iterator<char>(in), {}});
  }
};

TEST_F(HabitsTest, APausedRunStandsStillGoesOnAndCanBeCancelled) {
  open_part("plate");
  fake_.until = 1;
  EXPECT_FALSE(action(Act::pause)->isEnabled());
  double done = 0;
  QObject::connect(&session(), &Session::progressed, &window_, [&](double f) { done = f; });
  action(Act::run)->trigger();
  ASSERT_TRUE(wait_iterations(1));
  action(Act::pause)->trigger();
  EXPECT_TRUE(session().paused());
  EXPECT_TRUE(action(Act::pause)->isChecked());
  fake_.until = 3;
  QTest::qWait(100);  // until it reports its progress, which holds it
  const double done_before = done;
  picture("paused");
  QTest::qWait(100);  // several steps, if it went on
  EXPECT_EQ(session().iterations().size(), 1u);
  EXPECT_EQ(done, done_before);
  EXPECT_EQ(session().activity(), Activity::running);
  action(Act::pause)->trigger();
  EXPECT_FALSE(session().paused());
  ASSERT_TRUE(wait_iterations(3));
  action(Act::pause)->trigger();
  ASSERT_TRUE(session().paused());
  action(Act::cancel)->trigger();
  ASSERT_TRUE(wait_idle());
  EXPECT_TRUE(session().outcome()->cancelled);
  EXPECT_LT(session().iterations().size(), 7u);
  EXPECT_FALSE(action(Act::pause)->isChecked());
  // The next run is not held.
  fake_.until = 1000;
  run();
  EXPECT_EQ(session().iterations().size(), 7u);
}

TEST_F(HabitsTest, PlotsAreSavedAsTablesAndPictures) {
  open_part("plate");
  run();
  auto* convergence = window_.findChild<ConvergencePanel*>();
  auto* quality = window_.findChild<QualityPanel*>();
  const auto file = [&](const char* name) {
    return QString::fromStdString((folder_ / name).string());
  };
  convergence->save(file("run.csv"));
  EXPECT_EQ(text_of(folder_ / "run.csv").count('\n'), 8);
  convergence->save(file("run.png"));
  const QImage plots(file("run.png"));
  EXPECT_GT(plots.width(), 1000);
  EXPECT_NE(plots.pixel(5, 5), 0u);
  quality->save(file("quality.csv"));
  const QStringList lines = text_of(folder_ / "quality.csv").split('\n', Qt::SkipEmptyParts);
  ASSERT_EQ(lines.size(), 41);
  qulonglong all = 0;
  for (const QString& line : lines.mid(1)) all += line.split(',').last().toULongLong();
  EXPECT_EQ(all, session().shown_state()->mesh.element_count());
  quality->save(file("quality.png"));
  EXPECT_FALSE(QImage(file("quality.png")).isNull());
  // What cannot be written is told like any failure.
  QSignalSpy failed(&session(), &Session::failed);
  quality->save(file("nowhere/quality.png"));
  quality->save(file("quality.txt"));
  ASSERT_EQ(failed.count(), 2);
  EXPECT_TRUE(failed[0][0].toString().contains("nowhere"));
  EXPECT_TRUE(failed[1][0].toString().contains("quality.txt"));
}

TEST_F(HabitsTest, TheJournalTellsEditsActionsAndTheirUndoing) {
  open_part("plate");
  const Journal& journal = window_.tools().journal();
  find<QSpinBox>("layers")->setValue(6);
  EXPECT_TRUE(journal.text().contains("Edit: " + session().undo_stack()->undoText()));
  action(Act::undo)->trigger();
  EXPECT_TRUE(journal.text().contains("Undone: "));
  action(Act::redo)->trigger();
  EXPECT_TRUE(journal.text().contains("Done again: "));
  EXPECT_TRUE(journal.text().contains("Action: Undo"));
  action(Act::journal)->trigger();
  auto* dialog = window_.findChild<QDialog*>();
  ASSERT_NE(dialog, nullptr);
  // The last one is that of this start.
  EXPECT_TRUE(
      dialog->findChildren<QPlainTextEdit*>().last()->toPlainText().contains("Action: Undo"));
  if (const QString folder = qEnvironmentVariable("LAMELLA_PICTURES"); !folder.isEmpty())
    dialog->grab().save(folder + "/journal.png");
  dialog->close();
}

TEST_F(HabitsTest, AJournalOfAProgramThatIsGoneCanBeReadUntilItIsDiscarded) {
  // No program has this number.
  const auto folder = folder_ / "recovery";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "999999999.journal") << "12:00  Edit: Layers of plate\n";
  Journal journal(session(), folder);
  EXPECT_TRUE(journal.left_behind().contains("Layers of plate"));
  journal.add("something");
  EXPECT_TRUE(journal.text().contains("something"));
  EXPECT_FALSE(journal.left_behind().contains("something"));
  journal.discard_left();
  EXPECT_TRUE(journal.left_behind().isEmpty());
  EXPECT_TRUE(journal.text().contains("something"));
}

TEST_F(HabitsTest, InchesAreShownAndTypedAndMillimetersKept) {
  open_part("plate");
  auto* h_max = find<LengthBox>("h_max");
  h_max->setValue(12.7);
  EXPECT_EQ(h_max->text(), "12.7 mm");
  Preferences preferences(&window_);
  preferences.findChild<QComboBox*>("unit")->setCurrentIndex(1);
  EXPECT_EQ(h_max->text(), "0.5 in");
  EXPECT_EQ(find<QLabel>("unit")->text(), "in") << "the status bar says it";
  EXPECT_EQ(session().body(0).h_max, 12.7);
  EXPECT_TRUE(find<LengthBox>("h_min")->text().endsWith(" in"));
  h_max->findChild<QLineEdit*>()->setText("0.25 in");
  h_max->interpretText();
  EXPECT_NEAR(*session().body(0).h_max, 6.35, 1e-12);
  // Either unit may be typed.
  h_max->findChild<QLineEdit*>()->setText("2 mm");
  h_max->interpretText();
  EXPECT_NEAR(*session().body(0).h_max, 2, 1e-12);
  EXPECT_EQ(units::length(25.4), "1 in");
  EXPECT_EQ(units::volume(25.4 * 25.4 * 25.4), "1.000 in³");

  action(Act::section)->setChecked(true);
  const Vec<3> origin = study().cuts[0].origin;
  session().select_item({ItemKind::cut, 0});
  QTest::qWait(50);
  auto* at = find<PointBox>("cut_origin");
  EXPECT_LT((at->point() - origin).norm(), 1e-6);
  auto* x = at->findChildren<QDoubleSpinBox*>()[0];
  x->findChild<QLineEdit*>()->setText("0.1");
  x->interpretText();
  EXPECT_NEAR(study().cuts[0].origin[0], 2.54, 1e-9);
  // A direction has no unit.
  EXPECT_LT((find<PointBox>("cut_normal")->point() - study().cuts[0].normal).norm(), 1e-6);
  picture("inches");
  preferences.findChild<QComboBox*>("unit")->setCurrentIndex(0);
  EXPECT_EQ(h_max->text(), "2 mm");
}

/// What a screen reader calls the widgets that take the keyboard; those without a name.
QStringList nameless(const QWidget& window) {
  QStringList found;
  for (QWidget* widget : window.findChildren<QWidget*>()) {
    // What is inside of a spin box or a combo box speaks for it.
    const bool part = qobject_cast<QAbstractSpinBox*>(widget->parentWidget()) ||
                      qobject_cast<QComboBox*>(widget->parentWidget());
    if (part || !widget->isVisible() || !(widget->focusPolicy() & Qt::TabFocus)) continue;
    QAccessibleInterface* accessible = QAccessible::queryAccessibleInterface(widget);
    if (!accessible || !accessible->text(QAccessible::Name).isEmpty()) continue;
    found << QString("%1 \"%2\" in %3")
                 .arg(widget->metaObject()->className(), widget->objectName(),
                      widget->parentWidget()->metaObject()->className());
  }
  return found;
}

TEST_F(HabitsTest, EverythingThatTakesTheKeyboardHasAName) {
  EXPECT_EQ(nameless(window_).join("\n").toStdString(), "");
  open_part("plate");
  run();
  action(Act::section)->setChecked(true);
  action(Act::add_group)->trigger();
  QTest::qWait(30);
  EXPECT_EQ(nameless(window_).join("\n").toStdString(), "");
  action(Act::add_sphere)->trigger();
  QTest::qWait(30);
  EXPECT_EQ(nameless(window_).join("\n").toStdString(), "");
  action(Act::zone_box)->trigger();
  action(Act::compare)->setChecked(true);
  for (auto* tabs : window_.findChildren<QTabWidget*>())
    for (int k = 0; k < tabs->count(); ++k) {
      tabs->setCurrentIndex(k);
      EXPECT_EQ(nameless(window_).join("\n").toStdString(), "");
    }
  session().select_item({ItemKind::cut, 0});
  QTest::qWait(30);
  EXPECT_EQ(nameless(window_).join("\n").toStdString(), "");
  action(Act::preferences)->trigger();
  action(Act::journal)->trigger();
  for (auto* dialog : window_.findChildren<QDialog*>()) {
    EXPECT_EQ(nameless(*dialog).join("\n").toStdString(), "");
    dialog->close();
  }
}

TEST_F(HabitsTest, TheViewTurnsShiftsAndZoomsByKeys) {
  open_part("plate");
  view()->setFocus();
  for (const int key : {Qt::Key_Left, Qt::Key_Up, Qt::Key_Plus, Qt::Key_Minus}) {
    const QPointF before = view()->project(Vec<3>(3, 5, 1));
    QTest::keyClick(view(), Qt::Key(key));
    EXPECT_GT(QPointF(view()->project(Vec<3>(3, 5, 1)) - before).manhattanLength(), 0.3) << key;
  }
  const QPointF before = view()->project(Vec<3>(3, 5, 1));
  QTest::keyClick(view(), Qt::Key_Right, Qt::ShiftModifier);
  const QPointF by = view()->project(Vec<3>(3, 5, 1)) - before;
  EXPECT_GT(by.x(), 10);
  EXPECT_NEAR(by.y(), 0, 0.5);
}

/// The program in French, and in English again.
struct French {
  French() { speak(*qApp, "fr"); }
  ~French() {
    qDeleteAll(qApp->findChildren<QTranslator*>());
    speak(*qApp, "en");
  }
};

TEST_F(HabitsTest, SpeaksFrenchWhenAskedTo) {
  Preferences preferences(&window_);
  auto* language = preferences.findChild<QComboBox*>("language");
  language->setCurrentIndex(language->findText("Français"));
  const QString code = QSettings().value("language").toString();
  QSettings().remove("language");
  EXPECT_EQ(code, "fr");
  {
    const French french;
    MainWindow window(fake_.make());
    EXPECT_EQ(window.actions()[Act::run]->text(), QString::fromUtf8("&Lancer"));
    EXPECT_EQ(QString(Session::tr("%1 bodies")).arg(3), "3 corps");
    EXPECT_EQ(role_title(BodyRole::mold), "moule");
    // One comma everywhere, and coordinates that can still be told apart.
    EXPECT_EQ(QString("%L1").arg(0.5), "0,5");
    EXPECT_EQ(units::length(1.25), "1,25 mm");
    EXPECT_EQ(units::size({1.5, 2, 3}), QString::fromUtf8("1,5 × 2 × 3 mm"));
    EXPECT_EQ(units::point({1.5, 2, 3}), "(1,5; 2; 3)");
    // A few words are the same in both.
    int same = 0;
    for (int a = 0; a < int(Act::count); ++a)
      same += window.actions()[Act(a)]->text() == action(Act(a))->text();
    EXPECT_LT(same, int(Act::count) / 10);
    for (auto* tabs : window.findChildren<QTabWidget*>())
      EXPECT_NE(tabs->tabText(tabs->count() - 1), "Log") << "the panels too";
    if (const QString folder = qEnvironmentVariable("LAMELLA_PICTURES"); !folder.isEmpty()) {
      window.show();
      const auto file = folder_ / "tray.step";
      ASSERT_TRUE(write_sample("ribbed_tray", file));
      window.open_files({QString::fromStdString(file.string())});
      QTest::qWait(1500);
      window.grab().save(folder + "/french.png");
    }
  }
  EXPECT_EQ(units::point({1.5, 2, 3}), "(1.5, 2, 3)");
  MainWindow window(fake_.make());
  EXPECT_EQ(window.actions()[Act::run]->text(), action(Act::run)->text());
}

TEST_F(HabitsTest, ARoleGivesColorAndLayersAndIsKept) {
  open_part("plate");
  auto* role = find<QComboBox>("role");
  const auto choose = [&](BodyRole r) {
    role->setCurrentIndex(role->findData(int(r)));
    Q_EMIT role->activated(role->currentIndex());
  };
  const QColor plain = session().color_of(0);
  choose(BodyRole::mold);
  EXPECT_EQ(session().body(0).role, BodyRole::mold);
  EXPECT_EQ(session().body(0).layers, role_layers(BodyRole::mold));
  EXPECT_NE(session().color_of(0), plain);
  auto* tree = find<QTreeView>("study");
  const QModelIndex first = tree->model()->index(0, 0, tree->model()->index(0, 0));
  EXPECT_TRUE(first.data().toString().contains("mold"));
  picture("role");
  // Layers that were chosen by hand stay.
  find<QSpinBox>("layers")->setValue(7);
  choose(BodyRole::cavity);
  EXPECT_EQ(session().body(0).layers, 7);
  EXPECT_EQ(session().color_of(0), plain);
  const Result<Study> again = study_from_json(study_to_json(study()), "test");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->bodies[0].role, BodyRole::cavity);
  EXPECT_TRUE(command_line(study()));
  session().undo_stack()->undo();
  session().undo_stack()->undo();
  session().undo_stack()->undo();
  EXPECT_EQ(session().body(0).role, BodyRole::none);
  EXPECT_EQ(session().body(0).layers, 4);
}

}  // namespace
}  // namespace lamella::ui
