#pragma once

#include <QMainWindow>

#include "ui/actions/actions.h"
#include "ui/services.h"

class QLabel;
class QProgressBar;
class QSplitter;
class QStackedWidget;
class QTabWidget;

namespace lamella::ui {

class Banner;
class FlowPanel;
class Forecaster;
class ModelView;
class OverlapPanel;
class PropertiesPanel;
class Session;
class StudyPanel;
class Welcome;
class WindowTools;

/// The window: the study on the left, the model in the middle with results below it, and the
/// properties of what is selected on the right.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  explicit MainWindow(Services services, QWidget* parent = nullptr);
  ~MainWindow() override;

  Session& session() { return *session_; }
  Actions& actions() { return *actions_; }
  ModelView& view() { return *view_; }
  Banner& banner() { return *banner_; }
  Forecaster& forecaster() { return *forecaster_; }
  WindowTools& tools() { return *tools_; }

  /// Opens a study, parts (STEP, STL) or one mesh, by extension; as the menu, a drop and the
  /// command line do.
  void open_files(const QStringList& files, bool add = false);

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dragLeaveEvent(QDragLeaveEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void closeEvent(QCloseEvent* event) override;

 private:
  void make_menus();
  void make_tool_bar();
  void make_body();
  void make_status_bar();
  void connect_session();
  void connect_actions();
  void update_actions();
  void update_title();
  void update_status();
  void show_progress(double fraction, const QString& phase, double seconds_left);
  void ask_open(bool add);
  /// True when the study was saved, or there was nothing to save; asks for a name if it has none.
  bool save(bool ask_name);
  /// False when the user would rather keep what is unsaved.
  bool may_drop();
  /// A body by formula, in the middle of what is there.
  void add_body(Act kind);
  void add_size(Act kind);
  void start_run();
  void ask_export();
  void ask_picture();
  void ask_report();
  /// Result of another solver, to correct the mesh by.
  void ask_result();
  /// Tells in what unit an STL was read, which is to be confirmed.
  void confirm_unit(const QString& file, const QString& size, double guess);
  /// True when a dropped file was taken for such a result, or for nothing.
  bool drop_result(const QStringList& files);
  void report_run();

  Session* session_;
  Forecaster* forecaster_;
  Actions* actions_;
  WindowTools* tools_ = nullptr;
  ModelView* view_ = nullptr;
  Banner* banner_ = nullptr;
  Welcome* welcome_ = nullptr;
  StudyPanel* study_ = nullptr;
  PropertiesPanel* properties_ = nullptr;
  QStackedWidget* stack_ = nullptr;
  QTabWidget* results_ = nullptr;
  FlowPanel* flow_ = nullptr;
  OverlapPanel* overlaps_ = nullptr;
  QSplitter* columns_ = nullptr;
  QSplitter* rows_ = nullptr;
  QLabel* counts_ = nullptr;
  QLabel* state_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QString folder_;
};

}  // namespace lamella::ui
