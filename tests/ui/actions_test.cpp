#include <vtkCamera.h>
#include <vtkRenderer.h>

#include <QClipboard>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QSpinBox>
#include <QTabWidget>
#include <QTimer>
#include <QTreeView>

#include "core/base/version.h"
#include "tests/ui/window_fixture.h"
#include "ui/panels/banner.h"
#include "ui/panels/shortcut_sheet.h"

namespace lamella::ui {
namespace {

/// What the other tests reach past the actions, driven by them.
class ActionsTest : public WindowFixture {
 protected:
  ActionsTest() { QCoreApplication::setAttribute(Qt::AA_DontUseNativeDialogs); }

  QString path(const char* name) { return QString::fromStdString((folder_ / name).string()); }

  /// Triggers what asks for a file and answers with that one.
  void trigger(Act act, const QString& file) {
    bool answered = false;
    QTimer poll;
    QObject::connect(&poll, &QTimer::timeout, &window_, [&] {
      auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
      if (!dialog || answered) return;
      auto* name = dialog->findChild<QLineEdit*>(
          qobject_cast<QFileDialog*>(dialog) ? "fileNameEdit" : "export_file");
      if (!name) return;
      answered = true;
      name->setText(file);
      QMetaObject::invokeMethod(dialog, "accept");
    });
    poll.start(10);
    action(act)->trigger();
    EXPECT_TRUE(answered) << "nothing was asked";
    EXPECT_TRUE(wait_idle());
  }

  bool in_sight(const char* name) { return window_.findChild<QWidget*>(name)->isVisible(); }
};

TEST_F(ActionsTest, FilesAreOpenedAddedAndWritten) {
  for (const char* name : {"plate", "wedge"})
    ASSERT_TRUE(write_sample(name, folder_ / (std::string(name) + ".step")));
  trigger(Act::open, path("plate.step"));
  ASSERT_EQ(session().parts().size(), 1u);
  trigger(Act::add, path("wedge.step"));
  ASSERT_EQ(session().parts().size(), 2u);
  run();
  for (const auto& [act, file] :
       {std::pair(Act::save, "s.lamella"), std::pair(Act::save_as, "t.lamella"),
        std::pair(Act::export_mesh, "m.msh"), std::pair(Act::save_report, "r.html"),
        std::pair(Act::save_picture, "p.png")}) {
    trigger(act, path(file));
    EXPECT_TRUE(QFile::exists(path(file))) << file;
  }
  EXPECT_EQ(session().file(), folder_ / "t.lamella");
  EXPECT_FALSE(QImage(path("p.png")).isNull());
  action(Act::quit)->trigger();
  EXPECT_FALSE(window_.isVisible()) << "nothing is unsaved, so nothing is asked";
}

TEST_F(ActionsTest, TheViewIsTurnedCutAndFitted) {
  open_part("plate");
  const auto looks = [this] {
    Vec<3> along;
    view()->renderer()->GetActiveCamera()->GetDirectionOfProjection(along.data());
    return along;
  };
  const Vec<3> x = Vec<3>::UnitX(), y = Vec<3>::UnitY(), z = Vec<3>::UnitZ();
  for (const auto& [act, along] :
       {std::pair(Act::view_front, y), std::pair(Act::view_back, Vec<3>(-y)),
        std::pair(Act::view_left, x), std::pair(Act::view_right, Vec<3>(-x)),
        std::pair(Act::view_top, Vec<3>(-z)), std::pair(Act::view_bottom, z)}) {
    action(act)->trigger();
    EXPECT_LT((looks() - along).norm(), 1e-9) << action(act)->text().toStdString();
  }
  const double whole = view()->pixel_size();
  for (int k = 0; k < 5; ++k) QTest::keyClick(view(), Qt::Key_Plus);
  ASSERT_LT(view()->pixel_size(), 0.6 * whole);
  action(Act::fit)->trigger();
  EXPECT_NEAR(view()->pixel_size(), whole, 1e-9 * whole);
  for (const bool on : {true, false}) {
    action(Act::perspective)->setChecked(on);
    EXPECT_EQ(view()->perspective(), on);
  }
  action(Act::view_iso)->trigger();
  const QImage with_lines = window_.view().picture();
  action(Act::features)->setChecked(false);
  EXPECT_GT(difference(with_lines, window_.view().picture()), 1e-3);
  // A new section can be seen from where one looks.
  for (const Act look : {Act::view_front, Act::view_left, Act::view_top, Act::view_iso}) {
    action(look)->trigger();
    action(Act::section)->setChecked(true);
    ASSERT_TRUE(window_.view().section());
    EXPECT_LT(window_.view().section()->normal.dot(looks()), -0.25)
        << action(look)->text().toStdString();
    session().remove_item({ItemKind::cut, 0});
  }
  for (const auto& [act, axis] : {std::pair(Act::section_y, 1), std::pair(Act::section_z, 2)}) {
    action(act)->trigger();
    EXPECT_EQ(std::abs(window_.view().section()->normal[axis]), 1);
  }
}

TEST_F(ActionsTest, PanelsGoAndComeBackAndHelpIsGiven) {
  open_part("plate");
  for (const auto& [act, inside] :
       {std::pair(Act::show_study, "study"), std::pair(Act::show_properties, "layers"),
        std::pair(Act::show_results, "iteration_slider")})
    for (const bool on : {false, true}) {
      action(act)->setChecked(on);
      EXPECT_EQ(in_sight(inside), on) << inside;
    }
  action(Act::copy_command)->trigger();
  EXPECT_TRUE(QApplication::clipboard()->text().startsWith("lamella-cli mesh"));
  action(Act::about)->trigger();
  EXPECT_TRUE(window_.banner().message().contains(QString::fromStdString(version())));
  for (const char* library : {qVersion(), "LGPL", "Open CASCADE 7", "VTK 9", "Apache License"})
    EXPECT_TRUE(window_.banner().hint().contains(library)) << library;
  action(Act::shortcuts)->trigger();
  auto* sheet = window_.findChild<ShortcutSheet*>();
  ASSERT_NE(sheet, nullptr);
  EXPECT_TRUE(sheet->isVisible());
  QStringList told;
  for (const auto* label : sheet->findChildren<QLabel*>()) told << label->text();
  for (int a = 0; a < int(Act::count); ++a)
    if (const QKeySequence keys = action(Act(a))->shortcut(); !keys.isEmpty()) {
      EXPECT_TRUE(told.contains(keys.toString(QKeySequence::NativeText)));
    }
  sheet->close();
}

}  // namespace
}  // namespace lamella::ui
