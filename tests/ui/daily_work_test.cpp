#include <sys/resource.h>

#include <QFileDialog>
#include <QInputDialog>
#include <QLineEdit>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QPushButton>
#include <QSpinBox>
#include <QTimer>
#include <csignal>

#include "core/base/atomic_file.h"
#include "tests/ui/window_fixture.h"
#include "ui/panels/banner.h"
#include "ui/views/plot.h"

namespace lamella::ui {
namespace {

/// A plate, one of whose CAD faces has a name.
class DailyWorkTest : public WindowFixture {
 protected:
  DailyWorkTest() : WindowFixture(&name_a_face) {
    QCoreApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
    open_part("plate");
  }

  static Services name_a_face(Services made) {
    made.load_parts = [load = made.load_parts](const auto& file, const auto& params,
                                               const Progress& progress) {
      auto parts = load(file, params, progress);
      if (parts) parts->front().surface.faces.at(2).name = "sprue & runner";
      return parts;
    };
    return made;
  }

  QString path(const char* name) { return QString::fromStdString((folder_ / name).string()); }

  /// Whether the window asks about unsaved changes when it is closed, and is gone after the answer.
  struct Closed {
    bool asked = false;
    bool gone = false;
  };
  Closed close_and_answer(QMessageBox::StandardButton answer) {
    Closed closed;
    QTimer poll;
    QObject::connect(&poll, &QTimer::timeout, &window_, [&] {
      auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
      if (!box || closed.asked) return;
      closed.asked = true;
      box->button(answer)->click();
    });
    poll.start(10);
    closed.gone = window_.close();
    return closed;
  }
};

TEST_F(DailyWorkTest, EveryActionIsInAMenu) {
  QStringList menus;
  QList<QAction*> listed;
  for (const QAction* title : window_.menuBar()->actions()) {
    menus << title->text().remove('&');
    listed += title->menu()->actions();
  }
  for (const char* menu : {"File", "Edit", "View", "Mesh", "Results", "Help"})
    EXPECT_TRUE(menus.contains(menu)) << menu;
  for (int a = 0; a < int(Act::count); ++a)
    EXPECT_TRUE(listed.contains(action(Act(a)))) << action(Act(a))->text().toStdString();
}

TEST_F(DailyWorkTest, TheWorstQualityOfEveryIterationIsPlotted) {
  run();
  const auto* plot = find<Plot>("quality_plot");
  EXPECT_TRUE(plot->isVisible());
  EXPECT_EQ(plot->count(), static_cast<int>(session().iterations().size()));
}

TEST_F(DailyWorkTest, AGroupTakesFacesByTheirNameAndIsCorrectedNear) {
  action(Act::add_group)->trigger();
  auto* names = window_.findChild<QMenu*>("face_names");
  ASSERT_EQ(names->actions().size(), 1);
  names->actions().front()->trigger();
  ASSERT_EQ(study().groups.at(0).face_names, std::vector<std::string>{"sprue & runner"});
  const auto facets = facets_of(study().groups[0], session().parts()[0].surface);
  ASSERT_TRUE(facets && !facets->empty());

  find<QPushButton>("correct_near_group")->click();
  ASSERT_EQ(study().sizing.size(), 1u);
  EXPECT_EQ(study().sizing[0].body, session().parts()[0].name);
  const auto& ball = std::get<SphereShape>(study().sizing[0].shape);
  const ReferenceSurface<3>& surface = session().parts()[0].surface;
  for (const std::int32_t f : *facets)
    for (const auto node : surface.facets[std::size_t(f)])
      EXPECT_LT((surface.points[std::size_t(node)] - ball.center).norm(), ball.radius);
  action(Act::undo)->trigger();
  action(Act::undo)->trigger();
  EXPECT_TRUE(study().sizing.empty() && study().groups[0].face_names.empty());
}

TEST_F(DailyWorkTest, UnsavedChangesAreAskedAboutBeforeTheWindowGoes) {
  find<QSpinBox>("layers")->setValue(6);
  session().save(folder_ / "s.lamella");
  ASSERT_TRUE(wait_idle());
  find<QSpinBox>("layers")->setValue(7);
  Closed closed = close_and_answer(QMessageBox::Cancel);
  EXPECT_TRUE(closed.asked);
  EXPECT_FALSE(closed.gone);
  EXPECT_EQ(session().body(0).layers, 7);

  closed = close_and_answer(QMessageBox::Save);
  EXPECT_TRUE(closed.asked && closed.gone);
  EXPECT_FALSE(session().modified());
  window_.show();
  session().open_study(folder_ / "s.lamella");
  ASSERT_TRUE(wait_idle());
  EXPECT_EQ(session().body(0).layers, 7);
  closed = close_and_answer(QMessageBox::Discard);
  EXPECT_TRUE(closed.gone);
  EXPECT_FALSE(closed.asked) << "nothing is unsaved";
}

TEST_F(DailyWorkTest, WhatCannotBeWrittenIsToldAndWhatWasSavedStays) {
  const auto file = folder_ / "s.lamella";
  session().save(file);
  ASSERT_TRUE(wait_idle());
  const std::string before = read_file(file).value();
  find<QSpinBox>("layers")->setValue(6);
  {
    // As on a full disk: no file grows beyond a few bytes.
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit old{};
    getrlimit(RLIMIT_FSIZE, &old);
    rlimit full = old;
    full.rlim_cur = 64;
    setrlimit(RLIMIT_FSIZE, &full);
    session().save(file);
    const bool done = wait_idle();
    setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, handler);
    ASSERT_TRUE(done);
  }
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_TRUE(session().modified());
  EXPECT_EQ(read_file(file).value(), before);
  // A place where nothing can be written.
  window_.banner().hide();
  session().save("/proc/s.lamella");
  ASSERT_TRUE(wait_idle());
  EXPECT_TRUE(window_.banner().isVisible());
  EXPECT_FALSE(window_.banner().hint().isEmpty());
  EXPECT_TRUE(session().modified());
  session().save(file);
  ASSERT_TRUE(wait_idle());
  EXPECT_FALSE(session().modified());
  EXPECT_NE(read_file(file).value(), before);
}

TEST_F(DailyWorkTest, APictureHasAnyWidthThatIsAskedFor) {
  const double shape = double(view()->width()) / view()->height();
  QTimer poll;
  int asked = 0;
  QObject::connect(&poll, &QTimer::timeout, &window_, [&] {
    QWidget* top = QApplication::activeModalWidget();
    if (auto* dialog = qobject_cast<QFileDialog*>(top); dialog && asked == 0) {
      ++asked;
      dialog->selectNameFilter(dialog->nameFilters().last());
      dialog->findChild<QLineEdit*>("fileNameEdit")->setText(path("p.png"));
      QMetaObject::invokeMethod(dialog, "accept");
    } else if (auto* width = qobject_cast<QInputDialog*>(top); width && asked == 1) {
      ++asked;
      width->setIntValue(777);
      width->accept();
    }
  });
  poll.start(10);
  action(Act::save_picture)->trigger();
  EXPECT_EQ(asked, 2);
  const QImage picture(path("p.png"));
  EXPECT_NEAR(picture.width(), 777, 1);
  EXPECT_NEAR(double(picture.width()) / picture.height(), shape, 0.01);
}

}  // namespace
}  // namespace lamella::ui
