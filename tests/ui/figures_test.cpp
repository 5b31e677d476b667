// The window with a million elements, as figures. Not for ctest: they depend on the machine.
//   lamella_ui_tests --gtest_also_run_disabled_tests --gtest_filter='*Figures*'
#include <gtest/gtest.h>

#include <QElapsedTimer>
#include <QTest>
#include <QTimer>
#include <algorithm>
#include <cstdio>

#include "app/window_services.h"
#include "core/cad/sample_parts.h"
#include "core/mesh/sample_meshes.h"
#include "tests/support/fake_services.h"
#include "tests/support/temporary_folder.h"
#include "ui/actions/actions.h"
#include "ui/main_window.h"
#include "ui/session/session.h"
#include "ui/views/model_view.h"
#include "ui/views/vtk_view.h"

namespace lamella::ui {
namespace {

/// A box of a million tetrahedra with every field a result has.
std::shared_ptr<const MeshState> million() {
  auto state = std::make_shared<MeshState>();
  state->mesh = box_mesh<3>({84, 63, 32}, Vec<3>::Zero(), Vec<3>(84, 63, 32));
  const std::size_t nodes = state->mesh.points.size();
  state->metric.assign(nodes, Metric<3>::Identity());
  state->thickness.assign(nodes, 2);
  state->layers.assign(nodes, 4);
  for (std::size_t n = 1; n < nodes; ++n) {
    state->thickness[n] += std::sin(state->mesh.points[n][0]);
    state->layers[n] += std::cos(state->mesh.points[n][1]);
  }
  for (std::size_t e = 0; e < state->mesh.elements.size(); ++e)
    state->quality.push_back(0.2 + 0.7 * std::abs(std::sin(0.1 * static_cast<double>(e))));
  return state;
}

/// The longest time that nothing came through the event loop.
class Heartbeat {
 public:
  Heartbeat() {
    clock_.start();
    QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] { beat(); });
    timer_.start(5);
  }
  qint64 longest() {
    beat();
    return longest_;
  }

 private:
  void beat() { longest_ = std::max(longest_, clock_.restart()); }

  QTimer timer_;
  QElapsedTimer clock_;
  qint64 longest_ = 0;
};

class DISABLED_Figures : public testing::Test {
 protected:
  DISABLED_Figures() : services_(window_services(folder_.path())) {}

  static bool wait_idle(MainWindow& window) {
    return QTest::qWaitFor([&] { return window.session().activity() == Activity::idle; }, 600000);
  }
  /// Seconds until the view has drawn what `change` asks for.
  static double drawn(VtkView& view, const std::function<void()>& change) {
    bool done = false;
    const auto link = QObject::connect(&view, &VtkView::rendered, &view, [&] { done = true; });
    QElapsedTimer clock;
    clock.start();
    change();
    EXPECT_TRUE(QTest::qWaitFor([&] { return done; }, 60000));
    QObject::disconnect(link);
    return static_cast<double>(clock.nsecsElapsed()) * 1e-9;
  }

  test::TemporaryFolder folder_;
  Services services_;
};

TEST_F(DISABLED_Figures, AMillionElements) {
  const auto state = million();
  const auto file = folder_ / "million.vtu";
  ASSERT_TRUE(services_.export_mesh(file, *state, Study{}));
  MainWindow window(services_);
  window.resize(1700, 1300);
  window.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&window));
  VtkView& view = *window.view().vtk_view();
  QElapsedTimer clock;
  clock.start();
  window.open_files({QString::fromStdString(file.string())});
  ASSERT_TRUE(wait_idle(window));
  const double opened =
      drawn(view, [&] { view.update(); }) + static_cast<double>(clock.nsecsElapsed()) * 1e-9;
  std::printf("%zu elements\nopening: %.2f s\n", state->mesh.elements.size(), opened);

  view.setFixedSize(1280, 800);
  window.actions()[Act::edges]->setChecked(false);
  drawn(view, [&] { view.update(); });
  constexpr int frames = 30;
  clock.restart();
  for (int k = 0; k < frames; ++k)
    drawn(view, [&] {
      const double angle = 0.1 * k;
      window.view().look(Vec<3>(std::cos(angle), std::sin(angle), -0.5), Vec<3>::UnitZ());
    });
  std::printf("turning at %d x %d: %.1f frames/s\n", view.width(), view.height(),
              frames / (static_cast<double>(clock.nsecsElapsed()) * 1e-9));

  const auto at = [&](double t) {
    const Vec<3> normal = Vec<3>(1, 0.3, 0.2).normalized();
    return Section{Vec<3>(84 * t, 31, 16), normal};
  };
  drawn(view, [&] { window.view().set_section(at(0.5)); });
  std::vector<double> cuts;
  for (int k = 0; k < 10; ++k)
    cuts.push_back(drawn(view, [&] { window.view().set_section(at(0.3 + 0.04 * k), 1); }));
  std::sort(cuts.begin(), cuts.end());
  std::printf("crinkle cut dragged: %.3f s, at worst %.3f s\n", cuts[5], cuts.back());

  std::vector<double> picks;
  for (int k = 0; k < 10; ++k) {
    clock.restart();
    window.view().scene()->pick(400 + 50 * k, 400);
    picks.push_back(static_cast<double>(clock.nsecsElapsed()) * 1e-6);
  }
  std::sort(picks.begin(), picks.end());
  std::printf("pick: %.1f ms, at worst %.1f ms\n", picks[5], picks.back());
}

/// A run that hands over three meshes of a million elements, edges on.
TEST_F(DISABLED_Figures, EventLoopWhileMeshesOfAMillionElementsArrive) {
  std::vector<std::shared_ptr<const MeshState>> states;
  for (int k = 0; k < 3; ++k) states.push_back(million());
  services_.run = [&](const Study&, const std::vector<Part>&, const auto&, const Progress& progress,
                      const IterationSink& sink) -> Result<Outcome> {
    Outcome outcome;
    for (int k = 0; k < 3; ++k) {
      IterationRecord record;
      record.iteration = k;
      record.nodes = states[std::size_t(k)]->mesh.node_count();
      record.elements = states[std::size_t(k)]->mesh.element_count();
      outcome.records.push_back(record);
      outcome.state = states[std::size_t(k)];
      sink(record, outcome.state);
      for (int s = 0; s < 200; ++s) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        progress.report((200 * k + s) / 600.0);
      }
    }
    outcome.converged = true;
    return outcome;
  };
  const auto part = folder_ / "plate.step";
  ASSERT_TRUE(write_sample("plate", part));
  MainWindow window(services_);
  window.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&window));
  window.open_files({QString::fromStdString(part.string())});
  ASSERT_TRUE(wait_idle(window));
  QTest::qWait(300);
  Heartbeat heart;
  window.session().run();
  ASSERT_TRUE(wait_idle(window));
  QTest::qWait(300);
  std::printf("event loop held at most %lld ms while meshes of a million elements arrive\n",
              static_cast<long long>(heart.longest()));
}

TEST_F(DISABLED_Figures, EventLoopDuringARun) {
  const auto part = folder_ / "tray.step";
  ASSERT_TRUE(write_sample("t_junction", part));
  MainWindow window(services_);
  window.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&window));
  window.open_files({QString::fromStdString(part.string())});
  ASSERT_TRUE(wait_idle(window));
  QTest::qWait(300);
  Heartbeat heart;
  window.session().run();
  ASSERT_TRUE(wait_idle(window));
  QTest::qWait(300);
  std::printf("event loop held at most %lld ms during a run\n",
              static_cast<long long>(heart.longest()));
}

}  // namespace
}  // namespace lamella::ui
