// The window with a million elements: seconds, frames, and how long the event loop is held.
#include <QApplication>
#include <QElapsedTimer>
#include <QLocale>
#include <QStandardPaths>
#include <QTest>
#include <QTimer>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include "app/window_services.h"
#include "core/cad/sample_parts.h"
#include "core/mesh/sample_meshes.h"
#include "tests/support/temporary_folder.h"
#include "ui/actions/actions.h"
#include "ui/main_window.h"
#include "ui/session/session.h"
#include "ui/theme.h"
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

/// A figure that was not measured must not be printed.
void require(bool fine, const char* what) {
  if (fine) return;
  std::fprintf(stderr, "failed: %s\n", what);
  std::exit(1);
}

void wait_idle(MainWindow& window) {
  require(QTest::qWaitFor([&] { return window.session().activity() == Activity::idle; }, 600000),
          "waiting for the window to be idle");
}

void show(MainWindow& window) {
  window.show();
  require(QTest::qWaitForWindowExposed(&window), "showing the window");
}

/// Seconds until the view has drawn what `change` asks for.
double drawn(VtkView& view, const std::function<void()>& change) {
  bool done = false;
  const auto link = QObject::connect(&view, &VtkView::rendered, &view, [&] { done = true; });
  QElapsedTimer clock;
  clock.start();
  change();
  require(QTest::qWaitFor([&] { return done; }, 60000), "drawing");
  QObject::disconnect(link);
  return static_cast<double>(clock.nsecsElapsed()) * 1e-9;
}

/// Milliseconds that the event loop is held at most while a sample part is meshed.
long long held_by_a_run(const Services& services, const std::filesystem::path& folder) {
  const auto part = folder / "part.step";
  require(write_sample("t_junction", part).ok(), "writing the part");
  MainWindow window(services);
  show(window);
  window.open_files({QString::fromStdString(part.string())});
  wait_idle(window);
  QTest::qWait(300);
  Heartbeat heart;
  window.session().run();
  wait_idle(window);
  QTest::qWait(300);
  return heart.longest();
}

void million_elements(const Services& services, const std::filesystem::path& folder) {
  const auto state = million();
  const auto file = folder / "million.vtu";
  require(services.export_mesh(file, *state, Study{}).ok(), "writing the mesh");
  MainWindow window(services);
  window.resize(1700, 1300);
  show(window);
  VtkView& view = *window.view().vtk_view();
  QElapsedTimer clock;
  clock.start();
  window.open_files({QString::fromStdString(file.string())});
  wait_idle(window);
  drawn(view, [&] { view.update(); });
  const double opened = static_cast<double>(clock.nsecsElapsed()) * 1e-9;
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
Services with_million_meshes(Services services) {
  std::vector<std::shared_ptr<const MeshState>> states;
  for (int k = 0; k < 3; ++k) states.push_back(million());
  services.run = [states](const Study&, const std::vector<Part>&, const auto&,
                          const Progress& progress, const IterationSink& sink) -> Result<Outcome> {
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
  return services;
}

}  // namespace
}  // namespace lamella::ui

int main(int argc, char** argv) {
  using namespace lamella::ui;
  QStandardPaths::setTestModeEnabled(true);
  QLocale::setDefault(QLocale(QLocale::English));
  QSurfaceFormat::setDefaultFormat(VtkView::format());
  QApplication application(argc, argv);
  apply_theme(application);
  const lamella::test::TemporaryFolder folder;
  const Services services = lamella::window_services(folder.path());
  million_elements(services, folder.path());
  std::printf("event loop held at most %lld ms while meshes of a million elements arrive\n",
              held_by_a_run(with_million_meshes(services), folder.path()));
  std::printf("event loop held at most %lld ms during a run\n",
              held_by_a_run(services, folder.path()));
}
