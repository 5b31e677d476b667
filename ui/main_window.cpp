#include "ui/main_window.h"

#include <QAbstractButton>
#include <QLabel>
#include <QMenuBar>
#include <QProgressBar>
#include <QScrollArea>
#include <QSplitter>
#include <QStackedWidget>
#include <QStatusBar>
#include <QTabBar>
#include <QTabWidget>
#include <QToolBar>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "ui/actions/actions.h"
#include "ui/box_of.h"
#include "ui/commands/study_edits.h"
#include "ui/panels/banner.h"
#include "ui/panels/convergence_panel.h"
#include "ui/panels/flow_panel.h"
#include "ui/panels/log_panel.h"
#include "ui/panels/overlap_panel.h"
#include "ui/panels/properties_panel.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/report_panel.h"
#include "ui/panels/study_panel.h"
#include "ui/panels/welcome.h"
#include "ui/session/forecaster.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/units.h"
#include "ui/views/model_view.h"
#include "ui/views/vtk_view.h"
#include "ui/window_tools.h"

namespace lamella::ui {
namespace {

QString duration(double seconds) {
  const int s = static_cast<int>(std::lround(seconds));
  return QString("%1:%2").arg(s / 60).arg(s % 60, 2, 10, QChar('0'));
}

/// The page, which the window may be too small for.
QScrollArea* scrolled(QWidget* page, const QString& name) {
  auto* area = new QScrollArea;
  area->setWidget(page);
  page->setAutoFillBackground(false);  // as setWidget made it
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setAccessibleName(name);
  return area;
}

}  // namespace

MainWindow::MainWindow(Services services, QWidget* parent)
    : QMainWindow(parent),
      session_(new Session(std::move(services), this)),
      forecaster_(new Forecaster(*session_)),
      actions_(new Actions(this)) {
  setAcceptDrops(true);
  resize(1440, 920);
  make_body();
  tools_ = new WindowTools(*this);
  make_menus();
  make_tool_bar();
  make_status_bar();
  connect_session();
  connect_actions();
  // Buttons that are icons say what they do to those who do not see them.
  for (auto* button : findChildren<QAbstractButton*>())
    if (button->text().isEmpty() && button->accessibleName().isEmpty())
      button->setAccessibleName(button->toolTip());
  update_actions();
  update_title();
  update_status();
}

MainWindow::~MainWindow() {
  // Its worker may still report while the widgets below it are taken apart.
  session_->disconnect();
}

void MainWindow::make_body() {
  // From the top down: what moves to another parent has its style worked out anew, with all below.
  auto* central = new QWidget(this);
  setCentralWidget(central);
  auto* layout = new QVBoxLayout(central);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(8);
  banner_ = new Banner;
  layout->addWidget(banner_);

  // The study and its properties need the height, the plots the width that is left.
  columns_ = new QSplitter(Qt::Horizontal, central);
  layout->addWidget(columns_, 1);
  study_ = new StudyPanel(*session_, *actions_, columns_);
  study_->setMinimumWidth(264);
  rows_ = new QSplitter(Qt::Vertical, columns_);
  properties_ = new PropertiesPanel(*session_, *forecaster_, *actions_, columns_);
  properties_->setMinimumWidth(316);
  stack_ = new QStackedWidget(rows_);
  welcome_ = new Welcome(*actions_);
  view_ = new ModelView(*session_, *actions_);
  stack_->addWidget(scrolled(welcome_, tr("Start")));
  stack_->addWidget(view_);

  auto* panel = new QFrame(rows_);
  panel->setObjectName("panel");
  auto* inner = new QVBoxLayout(panel);
  inner->setContentsMargins(1, 1, 1, 1);
  results_ = new QTabWidget(panel);
  inner->addWidget(results_);
  results_->setAccessibleName(tr("Results"));
  results_->setDocumentMode(true);
  results_->tabBar()->setDrawBase(false);
  results_->addTab(new ConvergencePanel(*session_), tr("Convergence"));
  auto* quality = new QualityPanel(*session_);
  results_->addTab(quality, tr("Quality"));
  connect(quality, &QualityPanel::range_changed, this,
          [this, quality] { view_->set_quality_range(quality->range()); });
  auto* report = new ReportPanel(*session_);
  connect(report, &ReportPanel::save_asked, this, &MainWindow::ask_report);
  results_->addTab(report, tr("Report"));
  flow_ = new FlowPanel(*session_, *actions_);
  results_->addTab(scrolled(flow_, tr("Flow")), tr("Flow"));
  connect(flow_, &FlowPanel::result_asked, this, &MainWindow::ask_result);
  overlaps_ = new OverlapPanel(*session_);
  results_->addTab(overlaps_, tr("Overlaps and gaps"));
  auto* log = new LogPanel;
  results_->addTab(log, tr("Log"));
  rows_->setStretchFactor(0, 1);
  rows_->setSizes({570, 230});
  columns_->setStretchFactor(1, 1);
  columns_->setSizes({272, 832, 316});  // what a small screen leaves to the middle
  for (QSplitter* splitter : {rows_, columns_}) {
    splitter->setHandleWidth(8);
    splitter->setChildrenCollapsible(false);
  }
  connect(session_, &Session::logged, log, &LogPanel::add);
  connect(welcome_, &Welcome::file_chosen, this,
          [this](const QString& file) { open_files({file}); });
  connect(welcome_, &Welcome::sample_chosen, this, [this](const QString& name) {
    banner_->hide();
    session_->open_sample(name.toStdString());
  });
}

void MainWindow::make_menus() {
  const auto fill = [this](const QString& title, std::initializer_list<Act> acts) {
    QMenu* menu = menuBar()->addMenu(title);
    for (const Act act : acts) {
      if (act == Act::count) {
        menu->addSeparator();
      } else {
        menu->addAction((*actions_)[act]);
      }
    }
  };
  constexpr Act line = Act::count;
  fill(tr("&File"),
       {Act::open, Act::add, Act::reload, line, Act::save, Act::save_as, line, Act::export_mesh,
        Act::save_report, Act::save_picture, Act::copy_command, line, Act::preferences, Act::quit});
  menuBar()->actions().front()->menu()->insertMenu((*actions_)[Act::add], tools_->recent_menu());
  fill(tr("&Edit"), {Act::undo, Act::redo, line, Act::remove});
  fill(tr("&Study"),
       {Act::zone_ball, Act::zone_box, Act::zone_cylinder, Act::zone_half_space, line,
        Act::add_group, Act::pick_faces, Act::pick_flood, line, Act::correct_near,
        Act::correct_face, Act::add_sphere, Act::add_box, Act::add_cylinder, line, Act::add_cut});
  fill(tr("&Mesh"), {Act::run, Act::pause, Act::cancel, Act::forecast, line, Act::overlaps});
  fill(tr("&Results"),
       {Act::solve_flow, Act::flow_arrows, Act::flow_lines, Act::flow_levels, line, Act::measure,
        Act::ellipsoid, Act::compare, line, Act::export_mesh, Act::save_report, Act::save_picture});
  fill(tr("&View"), {Act::section,
                     Act::section_x,
                     Act::section_y,
                     Act::section_z,
                     Act::flip,
                     Act::crinkle,
                     line,
                     Act::edges,
                     Act::features,
                     Act::perspective,
                     line,
                     Act::fit,
                     Act::box_zoom,
                     Act::view_iso,
                     Act::view_front,
                     Act::view_back,
                     Act::view_left,
                     Act::view_right,
                     Act::view_top,
                     Act::view_bottom,
                     line,
                     Act::show_study,
                     Act::show_properties,
                     Act::show_results});
  fill(tr("&Help"), {Act::search, Act::shortcuts, line, Act::journal, Act::about});
}

void MainWindow::make_tool_bar() {
  auto* bar = addToolBar(tr("Main"));
  bar->setMovable(false);
  bar->setContextMenuPolicy(Qt::PreventContextMenu);
  bar->setIconSize(QSize(20, 20));
  bar->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  const auto add = [&](Act act, const QString& text, const char* name = nullptr) {
    QAction* action = (*actions_)[act];
    action->setIconText(text);
    bar->addAction(action);
    if (name) bar->widgetForAction(action)->setObjectName(name);
  };
  add(Act::open, tr("Open"));
  add(Act::save, tr("Save"));
  bar->addSeparator();
  add(Act::run, tr("Run"), "run");
  add(Act::pause, tr("Pause"));
  add(Act::cancel, tr("Cancel"));
  bar->addSeparator();
  add(Act::add_group, tr("Group"));
  add(Act::correct_near, tr("Correct near"));
  bar->addSeparator();
  add(Act::section, tr("Section"));
  add(Act::export_mesh, tr("Export"));
  add(Act::save_picture, tr("Picture"));
  auto* space = new QWidget;
  space->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  bar->addWidget(space);
  for (const Act act : {Act::search, Act::undo, Act::redo}) {
    bar->addAction((*actions_)[act]);
    if (auto* button = qobject_cast<QToolButton*>(bar->widgetForAction((*actions_)[act])))
      button->setToolButtonStyle(Qt::ToolButtonIconOnly);
  }
}

void MainWindow::make_status_bar() {
  counts_ = new QLabel;
  counts_->setObjectName("counts");
  state_ = new QLabel;
  state_->setObjectName("state");
  state_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  progress_ = new QProgressBar;
  progress_->setRange(0, 1000);
  progress_->setTextVisible(false);
  progress_->setFixedWidth(240);
  progress_->hide();
  counts_->setContentsMargins(12, 5, 0, 5);
  state_->setContentsMargins(0, 5, 12, 5);
  statusBar()->addWidget(counts_, 1);
  auto* unit = new QLabel(units::name());
  unit->setObjectName("unit");
  unit->setContentsMargins(12, 5, 12, 5);
  unit->setToolTip(tr("The unit of all lengths; Preferences change it"));
  connect(&Units::get(), &Units::changed, unit, [unit] { unit->setText(units::name()); });
  statusBar()->addPermanentWidget(unit);
  statusBar()->addPermanentWidget(state_);
  statusBar()->addPermanentWidget(progress_);
  statusBar()->setContentsMargins(0, 0, 10, 0);
  statusBar()->setSizeGripEnabled(false);
}

void MainWindow::connect_session() {
  const auto refresh = [this] {
    update_actions();
    update_title();
    update_status();
  };
  connect(session_, &Session::parts_changed, this, refresh);
  connect(session_, &Session::study_changed, this, refresh);
  connect(session_, &Session::activity_changed, this, refresh);
  connect(session_, &Session::iterations_changed, this, refresh);
  connect(session_, &Session::shown_changed, this, refresh);
  connect(session_, &Session::selection_changed, this, refresh);
  connect(session_, &Session::progressed, this, &MainWindow::show_progress);
  connect(session_, &Session::run_finished, this, refresh);
  connect(session_, &Session::run_finished, this, &MainWindow::report_run);
  connect(session_, &Session::failed, this, [this](const QString& message, const QString& hint) {
    banner_->show_message(Banner::Kind::error, message, hint);
  });
  connect(session_, &Session::noticed, this, [this](const QString& what, const QString& notes) {
    banner_->show_message(Banner::Kind::info, what, notes);
  });
  connect(session_, &Session::saved, this, [this](const QString& file) {
    statusBar()->showMessage(tr("Saved %1").arg(file), 4000);
  });
  connect(session_, &Session::report_saved, this, [this](const QString& file) {
    banner_->show_message(Banner::Kind::done, tr("Report written"), file);
  });
  connect(&Units::get(), &Units::changed, session_, &Session::study_changed);
  connect(forecaster_, &Forecaster::changed, this, &MainWindow::update_status);
  connect(session_, &Session::exported, this, [this](const QString& file, const QString& notes) {
    if (notes.isEmpty())
      banner_->show_message(Banner::Kind::done, tr("Mesh written"), file);
    else
      banner_->show_message(Banner::Kind::info, tr("Mesh written: %1").arg(file), notes);
  });
  connect(session_, &Session::unit_guessed, this, &MainWindow::confirm_unit);
}

void MainWindow::confirm_unit(const QString& file, const QString& size, double guess) {
  const std::pair<double, QString> units[] = {
      {1, tr("Millimeters")}, {10, tr("Centimeters")}, {1000, tr("Meters")}, {25.4, tr("Inches")}};
  std::vector<Banner::Button> buttons;
  QString guessed;
  for (const auto& [unit, name] : units) {
    if (unit == guess) {
      guessed = name.toLower();
      buttons.insert(buttons.begin(), {tr("That is right"), [] {}});
    } else {
      buttons.push_back({name, [this, file, again = unit] {
                           if (may_drop()) session_->open({file.toStdString()}, false, again);
                         }});
    }
  }
  banner_->show_message(
      Banner::Kind::info,
      tr("An STL has no unit: by its size it is in %1, that is %2.").arg(guessed, size),
      tr("If that is not its size, read it again in its own unit."), buttons);
}

void MainWindow::connect_actions() {
  const Actions& act = *actions_;
  connect(act[Act::open], &QAction::triggered, this, [this] { ask_open(false); });
  connect(act[Act::add], &QAction::triggered, this, [this] { ask_open(true); });
  connect(act[Act::reload], &QAction::triggered, this, [this] {
    banner_->hide();
    session_->reload();
  });
  connect(act[Act::remove], &QAction::triggered, this,
          [this] { session_->remove_item(session_->item()); });
  connect(act[Act::save], &QAction::triggered, this, [this] { save(false); });
  connect(act[Act::save_as], &QAction::triggered, this, [this] { save(true); });
  connect(act[Act::forecast], &QAction::triggered, forecaster_, &Forecaster::ask);
  connect(act[Act::overlaps], &QAction::triggered, this, [this] {
    (*actions_)[Act::show_results]->setChecked(true);
    results_->setCurrentWidget(overlaps_);
    overlaps_->look();
  });
  connect(act[Act::solve_flow], &QAction::triggered, this, [this] {
    (*actions_)[Act::show_results]->setChecked(true);
    for (int k = 0; k < results_->count(); ++k)
      if (results_->widget(k)->isAncestorOf(flow_)) results_->setCurrentIndex(k);
    banner_->hide();
    session_->solve_flow();
  });
  connect(act[Act::add_group], &QAction::triggered, this, [this] {
    const bool one = session_->parts().size() == 1;
    add_group(*session_, GroupKind::gate, one ? session_->body(0).name : std::string(), {});
    (*actions_)[Act::pick_faces]->setChecked(true);
  });
  for (const Act kind : {Act::add_sphere, Act::add_box, Act::add_cylinder})
    connect(act[kind], &QAction::triggered, this, [this, kind] { add_size(kind); });
  for (int a = int(Act::zone_ball); a <= int(Act::zone_half_space); ++a)
    connect(act[Act(a)], &QAction::triggered, this, [this, a] { add_body(Act(a)); });
  connect(act[Act::export_mesh], &QAction::triggered, this, &MainWindow::ask_export);
  connect(act[Act::save_report], &QAction::triggered, this, &MainWindow::ask_report);
  connect(act[Act::save_picture], &QAction::triggered, this, &MainWindow::ask_picture);
  connect(act[Act::quit], &QAction::triggered, this, &QWidget::close);
  connect(act[Act::run], &QAction::triggered, this, [this] { start_run(); });
  connect(act[Act::pause], &QAction::triggered, session_, &Session::pause);
  connect(act[Act::cancel], &QAction::triggered, session_, &Session::cancel);
  QUndoStack* undo = session_->undo_stack();
  connect(act[Act::undo], &QAction::triggered, undo, &QUndoStack::undo);
  connect(act[Act::redo], &QAction::triggered, undo, &QUndoStack::redo);
  connect(undo, &QUndoStack::indexChanged, this, &MainWindow::update_actions);
  connect(act[Act::show_study], &QAction::toggled, study_, &QWidget::setVisible);
  connect(act[Act::show_properties], &QAction::toggled, properties_, &QWidget::setVisible);
  connect(act[Act::show_results], &QAction::toggled, results_->parentWidget(),
          &QWidget::setVisible);
  connect(act[Act::about], &QAction::triggered, this, [this] {
    banner_->show_message(
        Banner::Kind::info, tr("Lamella %1").arg(LAMELLA_VERSION),
        tr("Anisotropic tetrahedral meshes for injection molding. Apache License 2.0.\n"
           "Made with %1.")
            .arg(LAMELLA_LIBRARIES));
  });
}

void MainWindow::update_actions() {
  const Actions& act = *actions_;
  const bool idle = session_->activity() == Activity::idle;
  const bool shown = !session_->empty();
  act[Act::open]->setEnabled(idle);
  act[Act::add]->setEnabled(idle);
  act[Act::reload]->setEnabled(idle && !session_->parts().empty());
  const bool parts = session_->has_bodies();
  // What is around the bodies goes with the domain.
  const Item item = session_->item();
  const bool own =
      item.kind != ItemKind::body || session_->is_part(item.index) || session_->is_zone(item.index);
  act[Act::remove]->setEnabled(idle && item.index >= 0 && own);
  for (const Act a : {Act::save, Act::save_as}) act[a]->setEnabled(idle && parts);
  act[Act::copy_command]->setEnabled(parts);
  act[Act::forecast]->setEnabled(session_->can_run() && session_->services().forecast &&
                                 !session_->study().domain);
  act[Act::overlaps]->setEnabled(idle &&
                                 session_->parts().size() + session_->study().zones.size() > 1);
  act[Act::solve_flow]->setEnabled(session_->can_flow());
  const auto flow = session_->shown_state();
  for (const Act a : {Act::flow_arrows, Act::flow_lines, Act::flow_levels})
    act[a]->setEnabled(flow && flow->flow &&
                       (a == Act::flow_levels || flow->flow->components != 1));
  const bool of_solver = session_->study().flow && session_->study().flow->field;
  act[Act::solve_flow]->setText(of_solver ? tr("&Show the field") : tr("&Solve the flow"));
  act[Act::solve_flow]->setIconText(of_solver ? tr("Show") : tr("Solve"));
  act[Act::solve_flow]->setToolTip(
      of_solver ? tr("Lay the field of the other solver on the mesh that is shown")
                : tr("Solve the flow between gates and vents through the mesh that is shown"));
  for (int a = int(Act::add_group); a <= int(Act::correct_face); ++a)
    act[Act(a)]->setEnabled(parts);
  // They need no part to begin with.
  for (int a = int(Act::zone_ball); a <= int(Act::zone_half_space); ++a)
    act[Act(a)]->setEnabled(idle && (parts || !shown));
  for (int a = int(Act::measure); a <= int(Act::box_zoom); ++a) act[Act(a)]->setEnabled(shown);
  act[Act::add_cut]->setEnabled(shown);
  act[Act::run]->setEnabled(session_->can_run());
  act[Act::cancel]->setEnabled(!idle && !session_->cancelling());
  const bool running = session_->activity() == Activity::running && !session_->cancelling();
  act[Act::pause]->setEnabled(running);
  act[Act::pause]->setChecked(running && session_->paused());
  act[Act::export_mesh]->setEnabled(idle && session_->shown_state() != nullptr);
  act[Act::save_report]->setEnabled(idle && session_->has_report());
  act[Act::undo]->setEnabled(session_->undo_stack()->canUndo());
  act[Act::redo]->setEnabled(session_->undo_stack()->canRedo());
  const QString undo = session_->undo_stack()->undoText();
  const QString redo = session_->undo_stack()->redoText();
  act[Act::undo]->setToolTip(undo.isEmpty() ? tr("Undo") : tr("Undo: %1").arg(undo));
  act[Act::redo]->setToolTip(redo.isEmpty() ? tr("Redo") : tr("Redo: %1").arg(redo));
  for (int a = int(Act::section); a <= int(Act::section_z); ++a) act[Act(a)]->setEnabled(shown);
  for (int a = int(Act::fit); a <= int(Act::view_bottom); ++a) act[Act(a)]->setEnabled(shown);
  act[Act::compare]->setEnabled(session_->iterations().size() > 1);
  if (session_->iterations().size() < 2) act[Act::compare]->setChecked(false);
  act[Act::save_picture]->setEnabled(shown);
  stack_->setCurrentIndex(shown ? 1 : 0);
}

void MainWindow::update_title() {
  const QString name = session_->file().empty()
                           ? QString::fromStdString(session_->study().name)
                           : QString::fromStdString(session_->file().stem().string());
  setWindowTitle(session_->empty() ? tr("Lamella") : tr("%1[*] – Lamella").arg(name));
  setWindowModified(session_->modified() || session_->mesh_unsaved());
}

void MainWindow::update_status() {
  const Activity activity = session_->activity();
  if (const int shown = session_->shown(); shown >= 0) {
    const IterationRecord& record = session_->iterations()[shown].record;
    QString text = tr("%L1 nodes     %L2 elements").arg(record.nodes).arg(record.elements);
    if (record.layers.places > 0)
      text += tr("     layers %1 (5 %: %2)")
                  .arg(written(record.layers.mean, 'f', 1))
                  .arg(written(record.layers.p5, 'f', 1));
    if (record.mixed > 0) text += tr("     %L1 mixed").arg(record.mixed);
    counts_->setText(text);
  } else if (session_->has_bodies()) {
    std::size_t triangles = 0;
    for (const Part& part : session_->shapes()) triangles += part.surface.facets.size();
    const std::size_t bodies = session_->parts().size() + session_->study().zones.size();
    counts_->setText((bodies == 1 ? tr("1 body") : tr("%1 bodies").arg(bodies)) +
                     tr("     %L1 surface triangles").arg(triangles));
  } else {
    counts_->clear();
  }
  if (forecaster_->bodies() && session_->shown() < 0)
    counts_->setText(counts_->text() + tr("     forecast: %L1 nodes, %L2 MB")
                                           .arg(forecaster_->total().nodes, 0, 'f', 0)
                                           .arg(forecaster_->total().memory, 0, 'f', 0));
  progress_->setVisible(activity != Activity::idle);
  if (activity != Activity::idle) {
    if (!session_->paused()) progress_->setValue(0);
    state_->setText(session_->cancelling()            ? tr("Cancelling…")
                    : session_->paused()              ? tr("Paused")
                    : activity == Activity::loading   ? tr("Opening…")
                    : activity == Activity::saving    ? tr("Saving…")
                    : activity == Activity::exporting ? tr("Exporting…")
                    : activity == Activity::checking  ? tr("Looking…")
                    : activity == Activity::flowing
                        ? session_->study().flow && session_->study().flow->field
                              ? tr("Laying the field on the mesh…")
                              : tr("Solving the flow…")
                        : tr("Running…"));
    return;
  }
  if (session_->empty()) {
    state_->setText(tr("Ready"));
  } else if (forecaster_->busy()) {
    state_->setText(tr("Counting the mesh to expect…"));
  } else if (session_->outdated()) {
    state_->setText(tr("Settings changed since this mesh: run again"));
  } else if (const auto& outcome = session_->outcome()) {
    state_->setText(outcome->cancelled ? tr("Cancelled, best mesh kept")
                    : outcome->converged
                        ? tr("Converged in %1 s").arg(written(outcome->seconds, 'f', 1))
                        : tr("Stopped at the iteration limit"));
  } else {
    state_->setText(!session_->has_bodies() ? tr("Mesh opened") : tr("Ready to run"));
  }
}

void MainWindow::show_progress(double fraction, const QString& phase, double seconds_left) {
  if (session_->activity() == Activity::idle) return;
  progress_->setValue(static_cast<int>(fraction * 1000));
  if (session_->cancelling() || session_->paused()) return;
  QString text = phase.isEmpty() ? state_->text() : phase;
  if (session_->activity() == Activity::running) {
    // The first mesh is iteration 0: as many are there as the one under way has before it.
    if (const auto done = session_->iterations().size();
        done > 0 && !phase.startsWith(QString::fromStdString(kFlowPhase))) {
      const int most = session_->run_study().options.iterations;
      text = tr("Iteration %1 of at most %2%3")
                 .arg(std::min<int>(static_cast<int>(done), most))
                 .arg(most)
                 .arg(phase.isEmpty() || phase.startsWith("iteration") ? QString() : ":  " + phase);
    } else if (!text.isEmpty()) {
      text[0] = text[0].toUpper();
    }
    text += tr("   %1 %").arg(static_cast<int>(fraction * 100));
    if (seconds_left >= 0) text += tr("   %1 left").arg(duration(seconds_left));
  }
  state_->setText(text);
}

void MainWindow::report_run() {
  const auto& outcome = session_->outcome();
  update_status();
  if (!outcome) return;
  if (!outcome->cancelled && !outcome->converged)
    banner_->show_message(Banner::Kind::info,
                          tr("The mesh is valid but had not settled at iteration %1.")
                              .arg(session_->study().options.iterations),
                          tr("The report tells where layers are missing. More iterations, or a "
                             "smaller smallest size at blades, help."));
}

void MainWindow::add_size(Act kind) {
  const int part = std::max(0, session_->selected());
  const Part& body = session_->shapes()[static_cast<std::size_t>(part)];
  const auto& points = body.surface.points.empty() ? session_->hull().points : body.surface.points;
  if (points.empty()) return;
  const auto [low, high] = box_of(points);
  const Vec<3> middle = 0.5 * (low + high);
  const double reach = 0.15 * (high - low).norm();
  if (kind == Act::add_sphere)
    add_sizing(*session_, body.name, tr("sphere"), SphereShape{middle, reach});
  else if (kind == Act::add_box)
    add_sizing(*session_, body.name, tr("box"), BoxShape{middle, Vec<3>(0.3 * (high - low))});
  else
    add_sizing(*session_, body.name, tr("cylinder"),
               CylinderShape{middle - reach * Vec<3>::UnitZ(), middle + reach * Vec<3>::UnitZ(),
                             0.5 * reach});
}

void MainWindow::add_body(Act kind) {
  Vec<3> low = Vec<3>::Constant(-5), high = Vec<3>::Constant(5);
  const auto& b = view_->bounds();
  if (b[0] < b[1]) {
    low = {b[0], b[2], b[4]};
    high = {b[1], b[3], b[5]};
  }
  // Numbers that are good to read and to change.
  const double reach = QString::number(0.2 * (high - low).norm(), 'g', 2).toDouble();
  const Vec<3> middle = 0.5 * (low + high);
  if (kind == Act::zone_ball)
    add_zone(*session_, tr("ball"), ZoneBall{middle, reach});
  else if (kind == Act::zone_box)
    add_zone(*session_, tr("box"),
             ZoneBox{middle - Vec<3>::Constant(reach), middle + Vec<3>::Constant(reach)});
  else if (kind == Act::zone_cylinder)
    add_zone(*session_, tr("cylinder"),
             ZoneCylinder{middle - reach * Vec<3>::UnitZ(), middle + reach * Vec<3>::UnitZ(),
                          0.5 * reach});
  else
    add_zone(*session_, tr("half-space"), ZoneHalfSpace{Vec<3>::UnitZ(), middle[2]});
}

void MainWindow::start_run() {
  const std::optional<double>& budget = session_->study().options.memory;
  if (budget && forecaster_->total().memory > *budget) {
    const auto without_budget = [this] {
      Study study = session_->study();
      study.options.memory.reset();
      session_->edit(tr("Drop the memory budget"), std::move(study));
      start_run();
    };
    banner_->show_message(Banner::Kind::info,
                          tr("This mesh takes about %L1 MB, more than the budget of %L2 MB.")
                              .arg(forecaster_->total().memory, 0, 'f', 0)
                              .arg(*budget, 0, 'f', 0),
                          tr("Ask for fewer layers, or raise the budget under Advanced."),
                          {{tr("Run without a budget"), without_budget}});
    return;
  }
  banner_->hide();
  results_->setCurrentIndex(0);
  session_->run();
}

}  // namespace lamella::ui
