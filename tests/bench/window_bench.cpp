// The window with a million elements: seconds, frames, and how long the event loop is held.
#include <QApplication>
#include <QElapsedTimer>
#include <QEventLoop>
#include <QLocale>
#include <QMouseEvent>
#include <QStandardPaths>
#include <QTest>
#include <QTimer>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
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

/// A million tetrahedra with every field a result has: a box, or a plate with four layers, most of
/// which is outside.
std::shared_ptr<const MeshState> million(bool plate) {
  auto state = std::make_shared<MeshState>();
  state->mesh = plate ? box_mesh<3>({256, 166, 4}, Vec<3>::Zero(), Vec<3>(84, 63, 4))
                      : box_mesh<3>({84, 63, 32}, Vec<3>::Zero(), Vec<3>(84, 63, 32));
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

/// Seconds of processor time that all threads have used, or this one.
double processor(clockid_t of = CLOCK_PROCESS_CPUTIME_ID) {
  timespec t{};
  clock_gettime(of, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The longest times that nothing came through the event loop: by the clock, by the work of the
/// window's thread, and by that of all threads. The last two do not count what other programs take.
class Heartbeat {
 public:
  Heartbeat() {
    clock_.start();
    beat();
    longest_ = {};
    QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] { beat(); });
    timer_.start(5);
  }
  void print(const char* when) {
    beat();
    std::printf("event loop held %s: at most %.0f ms, %.0f of its own work, %.0f of all threads\n",
                when, longest_[0], longest_[1], longest_[2]);
  }

 private:
  void beat() {
    const std::array<double, 3> now{1e-6 * static_cast<double>(clock_.nsecsElapsed()),
                                    1e3 * processor(CLOCK_THREAD_CPUTIME_ID), 1e3 * processor()};
    for (std::size_t k = 0; k < 3; ++k) longest_[k] = std::max(longest_[k], now[k] - last_[k]);
    last_ = now;
  }

  QTimer timer_;
  QElapsedTimer clock_;
  std::array<double, 3> last_{}, longest_{};
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

/// Turns the view under the mouse, a frame as soon as the last one is drawn.
void turn(VtkView& view) {
  const auto mouse = [&](QEvent::Type type, const QPointF& at) {
    QMouseEvent event(type, at, view.mapToGlobal(at), Qt::LeftButton,
                      type == QEvent::MouseButtonRelease ? Qt::NoButton : Qt::LeftButton,
                      Qt::NoModifier);
    QApplication::sendEvent(&view, &event);
  };
  constexpr int frames = 40;
  int drawn = 0;
  QEventLoop loop;
  QPointF at(400, 400);
  mouse(QEvent::MouseButtonPress, at);
  const auto link = QObject::connect(&view, &VtkView::rendered, &view, [&] {
    if (++drawn == frames) return loop.quit();
    at += QPointF(7, drawn % 20 < 10 ? 3 : -3);
    QTimer::singleShot(0, &view, [&] { mouse(QEvent::MouseMove, at); });
  });
  QElapsedTimer clock;
  clock.start();
  const double used = processor();
  view.update();
  loop.exec();
  const double seconds = static_cast<double>(clock.nsecsElapsed()) * 1e-9;
  QObject::disconnect(link);
  mouse(QEvent::MouseButtonRelease, at);
  std::printf("turning at %d x %d: %.1f frames/s, %.0f ms of the processors a frame\n",
              view.width(), view.height(), frames / seconds, 1e3 * (processor() - used) / frames);
}

/// Measures how long the event loop is held while a sample part is meshed.
void held_by_a_run(const char* when, const Services& services,
                   const std::filesystem::path& folder) {
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
  heart.print(when);
}

void million_elements(const Services& services, const std::filesystem::path& folder, bool plate) {
  const auto state = million(plate);
  const auto file = folder / "million.vtu";
  require(services.export_mesh(file, *state, Study{}, {}, {}).ok(), "writing the mesh");
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
  std::printf("%s of %zu elements\nopening: %.2f s\n", plate ? "plate" : "box",
              state->mesh.elements.size(), opened);

  view.setFixedSize(1280, 800);
  window.actions()[Act::edges]->setChecked(false);
  drawn(view, [&] { view.update(); });
  turn(view);

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

  QTest::qWait(400);  // the view is at rest
  std::vector<double> picks;
  int met = 0;
  for (int k = 0; k < 10; ++k) {
    clock.restart();
    met += window.view().scene()->pick(400 + 50 * k, 400).has_value();
    picks.push_back(static_cast<double>(clock.nsecsElapsed()) * 1e-6);
  }
  std::sort(picks.begin(), picks.end());
  std::printf("pick: %.1f ms, at worst %.1f ms, %d of 10 met the mesh\n", picks[5], picks.back(),
              met);
}

/// A run that hands over three plates of a million elements, edges on.
Services with_million_meshes(Services services) {
  std::vector<std::shared_ptr<const MeshState>> states;
  for (int k = 0; k < 3; ++k) states.push_back(million(true));
  services.run = [states](const Study&, const std::vector<Part>&, const auto&,
                          const Progress& progress, const IterationSink& sink,
                          const auto&) -> Result<Outcome> {
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
  const std::string only = argc > 1 ? argv[1] : "";
  const auto wanted = [&](const char* what) { return only.empty() || only == what; };
  if (wanted("box")) million_elements(services, folder.path(), false);
  if (wanted("plate")) million_elements(services, folder.path(), true);
  if (wanted("arrive"))
    held_by_a_run("while meshes of a million elements arrive", with_million_meshes(services),
                  folder.path());
  if (wanted("run")) held_by_a_run("during a run", services, folder.path());
}
