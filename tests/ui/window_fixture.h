#pragma once

#include <gtest/gtest.h>

#include <QFile>
#include <QSignalSpy>
#include <QTest>

#include "core/cad/sample_parts.h"
#include "tests/support/fake_services.h"
#include "tests/support/temporary_folder.h"
#include "ui/actions/actions.h"
#include "ui/main_window.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/views/model_view.h"
#include "ui/views/vtk_view.h"

namespace lamella::ui {

/// ms after which what was waited for never comes, however busy the machine is.
constexpr int patience = 300'000;

/// A window with one of the sample parts, and runs that are made up.
class WindowFixture : public testing::Test {
 protected:
  explicit WindowFixture(Services (*change)(Services) = [](Services made) { return made; })
      : window_(change(fake_.make())) {
    window_.resize(1200, 800);  // the processor draws it
    window_.show();
    EXPECT_TRUE(QTest::qWaitForWindowExposed(&window_, patience));
  }

  void open_part(const std::string& name) {
    const auto file = folder_ / (name + ".step");
    ASSERT_TRUE(write_sample(name, file));
    window_.open_files({QString::fromStdString(file.string())});
    ASSERT_TRUE(wait_idle());
    QTest::qWait(50);
  }

  Session& session() { return window_.session(); }
  const Study& study() { return session().study(); }
  QAction* action(Act act) { return window_.actions()[act]; }
  VtkView* view() { return window_.view().vtk_view(); }
  template <class Widget>
  Widget* find(const char* name) {
    auto* widget = window_.findChild<Widget*>(name);
    EXPECT_NE(widget, nullptr) << name;
    return widget;
  }
  bool wait_idle() {
    return QTest::qWaitFor([this] { return session().activity() == Activity::idle; }, patience);
  }
  /// Until the run, which waits after them, has made so many iterations.
  bool wait_iterations(std::size_t count) {
    return QTest::qWaitFor([&] { return session().iterations().size() == count; }, patience);
  }
  void run() {
    action(Act::run)->trigger();
    ASSERT_TRUE(wait_idle());
    QTest::qWait(30);
  }
  void set_dark(bool dark) {
    apply_theme(*qApp, dark);
    window_.actions().refresh_icons();
    window_.view().refresh_theme();
  }
  /// Pictures to look at, where LAMELLA_PICTURES names a folder: in both themes.
  void picture(const QString& name) {
    const QString folder = qEnvironmentVariable("LAMELLA_PICTURES");
    if (folder.isEmpty()) return;
    for (const bool dark : {true, false}) {
      set_dark(dark);
      QTest::qWait(150);
      view()->settle();
      window_.grab().save(folder + "/" + name + (dark ? "-dark.png" : ".png"));
    }
  }

  test::TemporaryFolder folder_;
  test::FakeServices fake_;
  MainWindow window_;
};

/// Share of the pixels that differ.
inline double difference(const QImage& a, const QImage& b) {
  if (a.size() != b.size() || a.isNull()) return 1;
  int differing = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) differing += a.pixel(x, y) != b.pixel(x, y);
  return differing / (double(a.width()) * a.height());
}

}  // namespace lamella::ui
