#pragma once

#include <QColor>
#include <QElapsedTimer>
#include <QObject>
#include <QUndoStack>
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/project/project_file.h"
#include "core/study/domain.h"
#include "core/study/report.h"
#include "ui/services.h"
#include "ui/session/item.h"
#include "ui/session/read_parts.h"
#include "ui/session/solver_result.h"
#include "ui/session/worker.h"

namespace lamella::ui {

/// What the window is busy with.
enum class Activity { idle, loading, saving, running, exporting, checking, flowing };

struct PreparedMesh;
struct SkinChoice;

/// One finished iteration: its record and the mesh it left.
struct Iteration {
  IterationRecord record;
  std::shared_ptr<const MeshState> state;
  std::shared_ptr<const PreparedMesh> prepared{};  ///< to be drawn; may be null
};

/// Overlaps and gaps between the bodies, as they were looked for.
struct OverlapCheck {
  StudyOverlaps found;
  double gap_width = 0;  ///< mm; 0: gaps were not looked for
  double seconds = 0;
};

/// The open study and everything that happens to it; the panels and views only follow it.
///
/// Lives in the window's thread. Long work runs on its worker; results arrive by queued calls, so
/// every member may be read without a lock.
class Session : public QObject {
  Q_OBJECT

 public:
  explicit Session(Services services, QObject* parent = nullptr);

  const Services& services() const { return services_; }
  const Study& study() const { return *study_; }
  std::shared_ptr<const Study> study_value() const { return study_; }
  /// That of the run whose iterations there are; the present one before any.
  const Study& run_study() const { return run_study_ ? *run_study_ : *study_; }
  const std::vector<Part>& parts() const { return *parts_; }
  std::shared_ptr<const std::vector<Part>> parts_value() const { return parts_; }
  /// What every body of the study looks like: the parts, the zones as soon as their surfaces are
  /// known, and the background, which has none of its own.
  const std::vector<Part>& shapes() const { return *shapes_; }
  std::shared_ptr<const std::vector<Part>> shapes_value() const { return shapes_; }
  /// Surface of the domain; empty where there is none or bodies are it.
  const ReferenceSurface<3>& hull() const { return hull_; }
  /// Settings of body `index`: parts, zones and the background, in this order.
  const BodySettings& body(int index) const { return study_->bodies[index]; }
  /// In the view: what the user chose, else the file's color, else one of ours.
  QColor color_of(int index) const;
  const std::vector<Iteration>& iterations() const { return iterations_; }
  const std::optional<Outcome>& outcome() const { return outcome_; }
  Activity activity() const { return activity_; }
  bool paused() const { return worker_.paused(); }
  bool cancelling() const { return worker_.cancelling(); }
  /// Nothing to show: neither parts nor a mesh.
  bool empty() const { return !has_bodies() && iterations_.empty(); }
  bool has_bodies() const { return !study_->bodies.empty(); }
  /// Zones are meshed in one mesh of all bodies only.
  bool can_run() const {
    return activity_ == Activity::idle && has_bodies() && (study_->domain || !parts_->empty());
  }
  /// A body from a file; the others are zones and the background.
  bool is_part(int index) const { return index >= 0 && index < static_cast<int>(parts_->size()); }
  bool is_zone(int index) const {
    const int zone = index - static_cast<int>(parts_->size());
    return zone >= 0 && zone < static_cast<int>(study_->zones.size());
  }
  /// True when the settings differ from those the shown meshes were made with.
  bool outdated() const;
  QUndoStack* undo_stack() { return &undo_; }

  /// Index into `iterations` of the one being looked at; -1: none, the parts are shown.
  int shown() const { return shown_; }
  std::shared_ptr<const MeshState> shown_state() const;
  std::shared_ptr<const PreparedMesh> shown_prepared() const {
    return shown_ < 0 ? nullptr : iterations_[static_cast<std::size_t>(shown_)].prepared;
  }
  /// What the view draws of a mesh: those that come are prepared for it.
  void draw_as(SkinChoice choice);
  void show_iteration(int index);

  /// Body selected everywhere; -1: none. Of several it is the one chosen last.
  int selected() const { return selected_; }
  /// Every selected body, in rising order; edits of settings go to all of them.
  const std::vector<int>& selection() const { return selection_; }
  void select(int part);
  /// Selects several; `current` is one of them, or -1 with none.
  void select(std::vector<int> parts, int current);
  /// What was selected last: the body `selected`, or an entry of another list of the study.
  Item item() const;
  void select_item(const Item& item);

  /// Chord tolerance a body gets when the study has none, mm; its smallest size likewise.
  double automatic_size(int body) const;

  /// Reads a part file and replaces the study, or adds to it. `unit`: mm per unit of an STL;
  /// 0: guessed by its size.
  void open(const std::vector<std::filesystem::path>& files, bool add = false, double unit = 0);
  /// Reads the files of the parts again, as one undoable step: what the study asks stays, and what
  /// it asks of faces goes to where they are now.
  void reload();
  /// Opens a sample part made by code.
  void open_sample(const std::string& name);
  /// Reads a volume mesh just to look at it.
  void open_mesh(const std::filesystem::path& file);
  /// Removes one part from the study, with its groups and sizes, as one undoable step. The mesh
  /// shown stays, as one of other settings.
  void remove_part(int index);

  /// The file of the study; empty while it has none.
  const std::filesystem::path& file() const { return file_; }
  /// Whether the study differs from what was opened or saved last.
  bool modified() const;
  /// Whether a run, or a flow, has left a mesh that no project holds.
  bool mesh_unsaved() const { return mesh_unsaved_; }
  /// Opens a study and its parts. One that was `recovered` keeps the file it was made for, which
  /// may be none, and counts as modified.
  void open_study(const std::filesystem::path& file,
                  const std::optional<std::filesystem::path>& recovered_for = {});
  /// Saves the project: the study with the mesh shown and its report, or, as .json, the study
  /// alone.
  void save(const std::filesystem::path& file);

  void run();
  /// Looks for overlaps of the bodies, and for gaps between them narrower than `gap_width` mm.
  void look_for_overlaps(double gap_width);
  /// Tells what became of a file that a panel wrote.
  void wrote(const QString& file, const Result<void>& written);
  /// Solves the flow through the shown mesh, which carries it from then on.
  void solve_flow();
  bool can_flow() const { return activity_ == Activity::idle && shown_state() != nullptr; }
  /// Reads the result of another solver, by whose first field the study then corrects the mesh, in
  /// one undoable step; on the shown mesh it is seen at once.
  void open_result(const std::filesystem::path& file);
  /// What was read last of the file that the study names; else null.
  std::shared_ptr<const SolverResult> result() const;
  /// Diagonal of the bodies, or of the mesh where there are none, mm.
  double extent() const;
  /// What was found last; nothing once the bodies have changed.
  const std::optional<OverlapCheck>& overlaps() const { return overlaps_; }
  /// Holds the run, or lets it go on.
  void pause(bool on);
  /// Cancels what is under way.
  void cancel();
  /// Writes the shown mesh.
  void export_mesh(const std::filesystem::path& file, const ExportOptions& options = {});
  /// Writes the report of the run, or of the project as it was opened: PDF by the ending .pdf, else
  /// HTML.
  void save_report(const std::filesystem::path& file);
  bool has_report() const { return outcome_ && outcome_->state; }

  /// Changes the study as one undoable step called `what`. Steps one after another with the same
  /// `merge` (not 0) become one.
  void edit(const QString& what, Study after, int merge = 0);
  /// A number for `edit` that no step has had yet.
  int new_merge() { return ++merges_; }
  /// Takes an entry out of the study; a body as `remove_part` does.
  void remove_item(const Item& item);
  /// Asks the view to bring a place close and mark it.
  void show_place(const Vec<3>& at, double radius, const QString& text);
  /// The same, with the model cut open through it.
  void cut_at(const Vec<3>& at, double radius, const QString& text);
  void edit_body(int index, const QString& what, const BodySettings& after);
  /// Changes the settings of every selected body in one undoable step.
  void edit_selection(const QString& what, const std::function<void(BodySettings&)>& change);

 Q_SIGNALS:
  void parts_changed();
  /// Surfaces are finer or coarser, or of other zones.
  void surfaces_changed();
  void study_changed();
  void selection_changed();
  /// An iteration was added, or all were cleared.
  void iterations_changed();
  void shown_changed();
  void activity_changed();
  /// Fraction in [0, 1]; seconds left, negative while unknown.
  void progressed(double fraction, const QString& phase, double seconds_left);
  void run_finished();
  void overlaps_changed();
  /// The result of another solver was read.
  void result_read();
  /// `notes` are what a solver will complain about, one a line; mostly empty.
  void exported(const QString& file, const QString& notes);
  void saved(const QString& file);
  void report_saved(const QString& file);
  /// A study file is open, with all its parts.
  void study_opened(const QString& file);
  void place_shown(const lamella::Vec<3>& at, double radius, const QString& text);
  void cut_asked(const lamella::Vec<3>& at);
  void failed(const QString& message, const QString& hint);
  /// Something worth knowing, no failure; `notes` one a line.
  void noticed(const QString& what, const QString& notes);
  /// The unit of an STL, in mm, was guessed by its size; it may be another one.
  void unit_guessed(const QString& file, const QString& size, double unit);
  void logged(const QString& line);

 private:
  friend class EditStudy;
  friend class RemovePart;
  friend class ReloadParts;
  void set_study(std::shared_ptr<const Study> study);
  /// A part that was removed, and the tolerances of its surface.
  struct TakenPart {
    Part part;
    PartSource source;
    LoadParams read_with;
  };
  /// The parts as they were read, and the study of them.
  struct ReadState {
    std::shared_ptr<const std::vector<Part>> parts;
    std::vector<PartSource> sources;
    std::shared_ptr<const Study> study;
  };
  /// Puts them in the place of the present ones, which are returned.
  ReadState exchange_parts(ReadState now);
  TakenPart take_part(int index, std::shared_ptr<const Study> after);
  void put_back(int index, TakenPart taken, std::shared_ptr<const Study> after);
  /// Shapes and selection for the bodies as they are now. True where other bodies came.
  bool follow_bodies();
  void take_zone_shapes();
  /// What a report tells besides the outcome; `file` is that of the study, if it has one.
  ReportContext report_context(const std::filesystem::path& file) const;
  /// What became of the run that a project was saved after, for its mesh.
  void take_report(Iteration& iteration);
  void drop_overlaps();
  void take_result(std::shared_ptr<const SolverResult> result);
  void remove_zone(int index);
  void set_activity(Activity activity);
  void begin(Activity activity, Worker::Job job);
  void report(const Error& error);
  /// Tells the notes, if there are some.
  void tell(const QString& what, const std::vector<std::string>& notes);
  void take_parts(ReadParts read, const std::vector<StudyInput>& inputs, bool add);
  /// Puts the study and its named parts in the place of what there was.
  void replace_all(Study study, ReadParts read, std::size_t first_new);
  void clear_iterations();
  void add_iteration(Iteration iteration);
  void finish_run(Result<Outcome> result, std::shared_ptr<const PreparedMesh> prepared = nullptr);
  /// As the view draws it now; for use by the running job.
  std::shared_ptr<const PreparedMesh> prepare(std::shared_ptr<const MeshState> state) const;
  /// The mesh a run ends with, among the iterations.
  void keep_best(const std::shared_ptr<const MeshState>& state,
                 const std::shared_ptr<const PreparedMesh>& prepared);

  Services services_;
  std::shared_ptr<const Study> study_ = std::make_shared<Study>();
  std::shared_ptr<const std::vector<Part>> parts_ = std::make_shared<std::vector<Part>>();
  std::shared_ptr<const std::vector<Part>> shapes_ = parts_;
  std::shared_ptr<const Study> shaped_;  // whose bodies `shapes_` has
  std::shared_ptr<const std::vector<Part>> shaped_parts_;
  int shaped_round_ = 0;  // counts other bodies
  int drawn_round_ = 0;   // whose zones have their surfaces
  ReferenceSurface<3> hull_;
  std::optional<OverlapCheck> overlaps_;
  std::vector<PartSource> sources_;  // one a part
  LoadParams read_with_;             // tolerances of the parts' surfaces
  bool surfaces_differ_ = false;     // one of them came back with another
  std::vector<Iteration> iterations_;
  std::optional<Outcome> outcome_;
  std::vector<std::pair<std::shared_ptr<const MeshState>, ExportCertificate>> exports_;
  std::shared_ptr<const Study> run_study_;
  Project project_;  // as it was opened; its copies of inputs are in use
  std::shared_ptr<const MeshState> opened_mesh_;
  std::shared_ptr<const SolverResult> result_;
  Activity activity_ = Activity::idle;
  bool mesh_unsaved_ = false;
  int shown_ = -1;
  int selected_ = -1;
  std::vector<int> selection_;
  std::optional<Item> item_;  // unless it is a body
  std::filesystem::path file_;
  std::string saved_;                              // the study as it was opened or saved
  mutable std::shared_ptr<const Study> compared_;  // by `modified`, with what it found
  mutable bool differs_ = false;
  std::atomic<std::shared_ptr<const SkinChoice>> drawn_as_;
  int merges_ = 0;
  QUndoStack undo_;
  QElapsedTimer clock_;
  qint64 held_ = 0;     // ms of the activity that it was paused
  qint64 held_at_ = 0;  // ms, where the pause under way began
  Worker shaper_;       // of zones
  Worker worker_;       // last: its destructor waits for the job that uses the rest
};

}  // namespace lamella::ui
