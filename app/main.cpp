// lamella: the window. It is handed readers, meshers and writers here and knows none of them.

#include <QApplication>
#include <QEventLoop>
#include <QPainter>
#include <QSettings>
#include <QStandardPaths>
#include <QSurfaceFormat>
#include <QTabWidget>
#include <QTimer>
#include <QWindow>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>
#include <vector>

#include "app/window_options.h"
#include "app/window_services.h"
#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/study/report_pictures.h"
#include "ui/actions/actions.h"
#include "ui/language.h"
#include "ui/main_window.h"
#include "ui/panels/flow_panel.h"
#include "ui/report_pdf.h"
#include "ui/session/forecaster.h"
#include "ui/session/session.h"
#include "ui/session/wall_map.h"
#include "ui/theme.h"
#include "ui/views/model_view.h"
#include "ui/views/vtk_view.h"
#include "ui/window_tools.h"

namespace lamella {
namespace {

/// What to do without a user: make pictures and leave.
struct Script {
  bool run = false;
  int iteration = -1;  ///< picture as soon as this one is there; -1: of the finished run
  bool cut = false;    ///< with the model cut open
  bool flat = false;   ///< the cut goes through elements
  QString near;        ///< "x,y,z,r": brings what is within r mm of a point close
  QString color;       ///< as option --color
  QStringList flow;    ///< as option --flow
  QString select;      ///< group, sizing, cut or domain: the first one is selected
  int tab = 0;         ///< of the results
  QString dialog;      ///< as option --dialog
  QString screenshot;  ///< picture of the window
  QString section;     ///< picture of the 3D view, cut open
  bool any() const { return run || !screenshot.isEmpty() || !section.isEmpty(); }
};

/// Lets the window work until `done` holds, then a moment longer to be drawn.
template <class Done>
void wait_until(Done done) {
  QEventLoop loop;
  QTimer timer;
  QObject::connect(&timer, &QTimer::timeout, &loop, [&] {
    if (done()) loop.quit();
  });
  timer.start(20);
  loop.exec();
  QTimer::singleShot(300, &loop, &QEventLoop::quit);
  loop.exec();
}

bool save(const QImage& picture, const QString& file) {
  if (!picture.isNull() && picture.save(file)) return true;
  std::fprintf(stderr, "lamella: cannot write the picture %s\n", qPrintable(file));
  return false;
}

/// The cut as a whole, and beside it a wall from so near that its layers can be counted.
QImage picture_of_section(ui::MainWindow& window) {
  ui::ModelView& model = window.view();
  QImage whole = model.picture();
  const auto state = window.session().shown_state();
  const auto section = model.section();
  if (whole.isNull() || !state || !section) return whole;
  const std::optional<WallPlace> place = typical_wall(*state, section->origin, section->normal);
  if (!place) return whole;

  const Vec<3> up = std::abs(section->normal[2]) > 0.9 ? Vec<3>::UnitY() : Vec<3>::UnitZ();
  const Vec<3> lower = place->center.array() - 1.4 * place->thickness;
  const Vec<3> upper = place->center.array() + 1.4 * place->thickness;
  const QPointF mark = model.vtk_view()->project(place->center);
  const QPointF across = model.vtk_view()->project(place->center + place->thickness * up) - mark;
  model.vtk_view()->look(-section->normal, up,
                         {lower[0], upper[0], lower[1], upper[1], lower[2], upper[2]});
  wait_until([] { return true; });
  const QImage near = model.picture();
  const int side = near.height();
  QImage both(whole.width() + side, side, QImage::Format_RGB32);
  QPainter painter(&both);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.drawImage(0, 0, whole);
  painter.drawImage(whole.width(), 0, near, (near.width() - side) / 2, 0, side, side);
  painter.setPen(QPen(QColor(0xd0, 0x60, 0x10), 3));
  const double radius = 1.6 * std::hypot(across.x(), across.y());
  painter.scale(whole.devicePixelRatio(), whole.devicePixelRatio());
  painter.drawEllipse(mark, radius, radius);
  painter.resetTransform();
  painter.drawRect(whole.width() + 1, 1, side - 3, side - 3);
  return both;
}

/// What an action opens beside the window, even where it is waited for; nothing where it opens
/// none.
QImage picture_of_dialog(ui::MainWindow& window, ui::Act act) {
  QImage image;
  bool looked = false;
  QTimer::singleShot(400, &window, [&] {
    looked = true;
    for (QWidget* top : QApplication::topLevelWidgets()) {
      if (top == &window || !top->isVisible()) continue;
      image = top->grab().toImage();
      top->close();
    }
  });
  window.actions()[act]->trigger();
  wait_until([&] { return looked; });
  return image;
}

int play(ui::MainWindow& window, const Script& script) {
  ui::Session& session = window.session();
  bool failed = false;
  QObject::connect(
      &session, &ui::Session::failed, &session, [&](const QString& message, const QString& hint) {
        std::fprintf(stderr, "lamella: %s %s\n", qPrintable(message), qPrintable(hint));
        failed = true;
      });
  const auto idle = [&] { return session.activity() == ui::Activity::idle; };
  wait_until(idle);
  if (script.run && !failed) {
    session.run();
    wait_until([&] {
      return idle() || (script.iteration >= 0 &&
                        static_cast<int>(session.iterations().size()) > script.iteration);
    });
  }
  if (failed) return exit_code(Code::bad_input);
  bool saved = true;
  const QStringList colors{"body",  "quality",  "thickness", "layers",    "filling", "size",
                           "speed", "pressure", "shear",     "indicator", "field"};
  if (const auto color = colors.indexOf(script.color); color >= 0)
    window.view().set_color_by(ui::ColorBy(color));
  for (const auto& [name, act] :
       {std::pair("arrows", ui::Act::flow_arrows), std::pair("lines", ui::Act::flow_lines),
        std::pair("levels", ui::Act::flow_levels)})
    if (script.flow.contains(name)) window.actions()[act]->setChecked(true);
  const QStringList kinds{"body", "group", "sizing", "cut", "domain"};
  if (const auto kind = kinds.indexOf(script.select); kind > 0)
    session.select_item({ui::ItemKind(kind), 0});
  if (script.cut) window.view().look_at_section();
  const auto* flow = window.findChild<ui::FlowPanel*>();
  wait_until([&] {
    return !window.view().walls().busy() && !window.forecaster().busy() && !flow->busy();
  });
  if (script.flat) window.actions()[ui::Act::crinkle]->setChecked(false);
  if (const QStringList at = script.near.split(','); at.size() == 4)
    window.view().look_near(Vec<3>(at[0].toDouble(), at[1].toDouble(), at[2].toDouble()),
                            at[3].toDouble());
  if (auto* tabs = window.findChild<QTabWidget*>()) tabs->setCurrentIndex(script.tab);
  if (!script.screenshot.isEmpty()) {
    wait_until([] { return true; });
    if (ui::VtkView* view = window.view().vtk_view()) view->settle();
    const QStringList dialogs{"export", "preferences", "shortcuts", "journal", "search"};
    constexpr ui::Act acts[] = {ui::Act::export_mesh, ui::Act::preferences, ui::Act::shortcuts,
                                ui::Act::journal, ui::Act::search};
    const auto dialog = dialogs.indexOf(script.dialog);
    saved = save(dialog < 0 ? window.grab().toImage() : picture_of_dialog(window, acts[dialog]),
                 script.screenshot);
  }
  if (!script.section.isEmpty()) {
    // All the window for the view, and a smooth cut: layers are counted on it.
    for (const ui::Act act :
         {ui::Act::show_study, ui::Act::show_properties, ui::Act::show_results, ui::Act::crinkle})
      window.actions()[act]->setChecked(false);
    wait_until([] { return true; });
    window.view().look_at_section();
    wait_until([] { return true; });
    saved = save(picture_of_section(window), script.section) && saved;
  }
  session.cancel();
  wait_until(idle);
  return saved ? 0 : exit_code(Code::io);
}

/// The report of a mesh (.html) or of a project, as PDF.
int make_pdf(const QStringList& from, const QString& to) {
  const auto write = [&]() -> Result<void> {
    if (from.size() != 1)
      return Error{Code::usage, "One report is made into a PDF at a time.",
                   "Give a .report.html or a .lamella project."};
    const std::string file = from.front().toStdString();
    Result<std::string> html = std::string();
    if (is_project(file)) {
      Result<Project> project = open_project_head(file);
      if (!project) return project.error();
      html = project->report_html;
    } else {
      html = read_file(file);
    }
    if (!html) return html.error();
    return ui::write_report_pdf(QString::fromStdString(*html), to);
  };
  const Result<void> written = write();
  if (written) return 0;
  std::fprintf(stderr, "lamella: %s %s\n", written.error().message.c_str(),
               written.error().hint.c_str());
  return exit_code(written.error().code);
}

}  // namespace
}  // namespace lamella

int main(int argc, char** argv) {
  using namespace lamella;
  // What these make needs no display.
  constexpr std::string_view texts[] = {"-h", "--help",    "--help-all",
                                        "-v", "--version", "--manual"};
  if (std::any_of(argv + 1, argv + argc, [&](const std::string_view word) {
        return word.starts_with("--report-pdf") ||
               std::find(std::begin(texts), std::end(texts), word) != std::end(texts);
      }))
    qputenv("QT_QPA_PLATFORM", "offscreen");
  QSurfaceFormat::setDefaultFormat(ui::VtkView::format());
  QApplication application(argc, argv);
  QApplication::setApplicationName("lamella");
  QApplication::setOrganizationName("lamella");
  QApplication::setApplicationVersion(QString::fromStdString(std::string(version())));
  QApplication::setDesktopFileName("org.lamella.Lamella");

  WindowOptions options;
  options.process(application);
  if (options.isSet("manual")) {
    std::fputs(options.manual_page().c_str(), stdout);
    return 0;
  }
  if (options.isSet("report-pdf")) return make_pdf(options.files(), options.value("report-pdf"));

  Script script;
  script.run = options.isSet("run");
  if (options.isSet("iteration")) script.iteration = options.value("iteration").toInt();
  script.cut = options.isSet("cut");
  script.flat = options.isSet("flat");
  script.near = options.value("near");
  script.color = options.value("color");
  script.flow = options.value("flow").split(',');
  script.select = options.value("select");
  script.tab = options.value("tab").toInt();
  script.dialog = options.value("dialog");
  script.screenshot = options.value("screenshot");
  script.section = options.value("section");

  ui::speak(application, QSettings().value("language").toString());
  ui::apply_theme(application, QSettings().value("dark", false).toBool() || options.isSet("dark"));
  ui::MainWindow window(window_services(
      QStandardPaths::writableLocation(QStandardPaths::CacheLocation).toStdString() + "/samples"));
  if (const QStringList size = options.value("size").split('x'); size.size() == 2)
    window.resize(size[0].toInt(), size[1].toInt());
  window.show();
  if (options.isSet("leave")) {
    while (!window.windowHandle()->isExposed())
      QApplication::processEvents(QEventLoop::WaitForMoreEvents);
    QApplication::processEvents();
    return 0;
  }
  if (script.any())
    window.open_files(options.files());
  else
    window.tools().offer_recovery(options.files());
  return script.any() ? play(window, script) : QApplication::exec();
}
