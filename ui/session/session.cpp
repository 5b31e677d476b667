#include "ui/session/session.h"

#include <QSettings>
#include <algorithm>
#include <limits>

#include "core/geometry/triangles.h"
#include "core/study/measure.h"
#include "core/study/mesh_parts.h"
#include "core/study/report.h"
#include "core/study/study_file.h"
#include "ui/box_of.h"
#include "ui/commands/edit_study.h"
#include "ui/commands/study_edits.h"
#include "ui/theme.h"
#include "ui/units.h"
#include "ui/views/mesh_skin.h"

namespace lamella::ui {
namespace {

QString text(const std::string& s) { return QString::fromStdString(s); }

QString file_name(const std::filesystem::path& file) { return text(file.filename().string()); }

QString bodies_text(std::size_t count) {
  return count == 1 ? Session::tr("1 body") : Session::tr("%1 bodies").arg(count);
}

QString box_size(const ReferenceSurface<3>& surface) {
  if (surface.points.empty()) return {};
  const Box<3> box = box_of(surface.points);
  return units::size(box.hi - box.lo);
}

/// A mesh of which no more than itself is known. What counts in its metric is measured where it has
/// one, else not a number: any other metric would give other values.
IterationRecord measured(MeshState& state) {
  if (!state.metric.empty())
    if (Result<IterationRecord> record = measure(state)) return *record;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  IterationRecord record;
  record.nodes = state.mesh.node_count();
  record.elements = state.mesh.element_count();
  record.quality_min = record.quality_mean = record.conformity = record.unit_edges = unknown;
  if (!state.quality.empty())
    record.quality_min = *std::min_element(state.quality.begin(), state.quality.end());
  return record;
}

}  // namespace

Session::Session(Services services, QObject* parent)
    : QObject(parent), services_(std::move(services)) {
  Study study;
  study.options.threads = QSettings().value("threads", 0).toInt();
  if (const double memory = QSettings().value("memory_budget", 0).toDouble(); memory > 0)
    study.options.memory = memory;
  study_ = std::make_shared<const Study>(std::move(study));
  connect(&worker_, &Worker::progressed, this, [this](double fraction, const QString& phase) {
    const double elapsed = static_cast<double>(clock_.elapsed() - held_) / 1000;
    const bool known = fraction > 0.02 && elapsed > 1;
    Q_EMIT progressed(fraction, phase, known ? elapsed * (1 - fraction) / fraction : -1);
  });
  // Bodies that changed meanwhile.
  connect(&shaper_, &Worker::finished, this, &Session::take_zone_shapes);
}

QColor Session::color_of(int index) const {
  const auto k = static_cast<std::size_t>(index);
  if (const auto& own = study_->bodies[k].color)
    return QColor::fromRgbF(static_cast<float>((*own)[0]), static_cast<float>((*own)[1]),
                            static_cast<float>((*own)[2]));
  switch (study_->bodies[k].role) {
    case BodyRole::mold:
      return theme::steel;
    case BodyRole::insert:
      return theme::brass;
    case BodyRole::channel:
      return theme::coolant;
    default:
      break;
  }
  if (has_background(*study_) && k + 1 == study_->bodies.size()) return theme::surroundings;
  return body_color(index,
                    k < parts_->size() ? (*parts_)[k].color : std::array<double, 3>{-1, -1, -1});
}

bool Session::outdated() const {
  if (!run_study_ || iterations_.empty()) return false;
  return mesh_key(*run_study_) != mesh_key(*study_);
}

std::shared_ptr<const MeshState> Session::shown_state() const {
  return shown_ < 0 ? nullptr : iterations_[shown_].state;
}

void Session::draw_as(SkinChoice choice) {
  const auto now = drawn_as_.load();
  if (!now || !(*now == choice)) drawn_as_ = std::make_shared<const SkinChoice>(std::move(choice));
}

std::shared_ptr<const PreparedMesh> Session::prepare(std::shared_ptr<const MeshState> state) const {
  const auto as = drawn_as_.load();
  return prepare_mesh(std::move(state), as ? *as : SkinChoice());
}

void Session::show_iteration(int index) {
  index = std::clamp(index, -1, static_cast<int>(iterations_.size()) - 1);
  if (index == shown_) return;
  shown_ = index;
  Q_EMIT shown_changed();
}

void Session::select(int part) {
  select(part < 0 ? std::vector<int>{} : std::vector<int>{part}, part);
}

void Session::select(std::vector<int> parts, int current) {
  std::sort(parts.begin(), parts.end());
  std::erase_if(parts,
                [&](int p) { return p < 0 || p >= static_cast<int>(study_->bodies.size()); });
  if (std::find(parts.begin(), parts.end(), current) == parts.end())
    current = parts.empty() ? -1 : parts.back();
  if (parts == selection_ && current == selected_ && !item_) return;
  item_.reset();
  selection_ = std::move(parts);
  selected_ = current;
  Q_EMIT selection_changed();
}

Item Session::item() const {
  const Item item = item_.value_or(Item{ItemKind::body, selected_});
  const auto within = [&](std::size_t count) {
    return item.index >= 0 && item.index < static_cast<int>(count);
  };
  // An edit undone may have taken the entry away.
  const bool there = item.kind == ItemKind::body     ? true
                     : item.kind == ItemKind::group  ? within(study_->groups.size())
                     : item.kind == ItemKind::sizing ? within(study_->sizing.size())
                     : item.kind == ItemKind::cut    ? within(study_->cuts.size())
                                                     : within(study_->domain ? 1 : 0);
  return there ? item : Item{ItemKind::body, selected_};
}

void Session::select_item(const Item& item) {
  if (item.kind == ItemKind::body) return select(item.index);
  if (item_ == item) return;
  item_ = item;
  Q_EMIT selection_changed();
}

double Session::automatic_size(int body) const {
  const auto& points = (*shapes_)[static_cast<std::size_t>(body)].surface.points;
  return 1e-3 * diagonal_of(points.empty() ? hull_.points : points);
}

void Session::set_study(std::shared_ptr<const Study> study) {
  study_ = std::move(study);
  const std::vector<int> before = selection_;
  // What draws the bodies must have them before it hears of their settings.
  if (follow_bodies()) Q_EMIT surfaces_changed();
  Q_EMIT study_changed();
  if (before != selection_) Q_EMIT selection_changed();
}

void Session::set_activity(Activity activity) {
  if (activity_ == activity) return;
  activity_ = activity;
  Q_EMIT activity_changed();
}

void Session::begin(Activity activity, Worker::Job job) {
  clock_.restart();
  held_ = 0;
  worker_.start(std::move(job));
  set_activity(activity);
}

void Session::report(const Error& error) {
  if (error.code == Code::cancelled) {
    Q_EMIT logged(tr("Cancelled."));
    return;
  }
  const QString message = text(error.message);
  const QString hint = text(error.hint);
  Q_EMIT logged(hint.isEmpty() ? message : message + " " + hint);
  Q_EMIT failed(message, hint);
}

void Session::open(const std::vector<std::filesystem::path>& files, bool add, double unit) {
  if (activity_ != Activity::idle || files.empty()) return;
  Q_EMIT logged(tr("Opening %1").arg(file_name(files.front())));
  LoadParams params;
  params.chord_tolerance = study_->options.chord_tolerance;
  params.angle_tolerance = study_->options.angle_tolerance;
  if (add && !parts_->empty()) params = read_with_;
  // What is added is in the unit of the STL that is there.
  if (add && unit == 0 && !parts_->empty()) {
    unit = 1;
    for (const PartSource& source : sources_)
      if (names_stl(source.file)) unit = source.unit;
  }
  begin(Activity::loading,
        [this, files, add, params, unit](const Progress& progress) -> Worker::Done {
          std::vector<StudyInput> inputs;
          std::vector<double> units;
          QString no_unit;
          for (const auto& file : files) {
            const bool guess = names_stl(file) && unit == 0;
            if (guess) no_unit = text(file.string());
            units.push_back(guess ? 0 : names_stl(file) ? unit : 1);
          }
          Result<ReadParts> read = read_parts(services_, files, units, params, progress);
          for (std::size_t k = 0; k < files.size(); ++k)
            inputs.push_back({files[k].string(), units[k]});
          for (std::size_t k = 0; read && k < files.size(); ++k)
            if (const Result<void> known = identify(inputs[k], files[k]); !known)
              read = known.error();
          return [this, read = std::move(read), inputs, add, no_unit, params]() mutable {
            set_activity(Activity::idle);
            if (!read) return report(read.error());
            const QString size =
                read->parts.empty() ? QString() : box_size(read->parts.back().surface);
            if (!add) read_with_ = params;
            take_parts(std::move(*read), inputs, add);
            // Read again it takes the place of the study: only where it is all there is.
            if (!no_unit.isEmpty() && !add && inputs.size() == 1)
              Q_EMIT unit_guessed(no_unit, size, inputs.front().unit);
          };
        });
}

void Session::open_study(const std::filesystem::path& file,
                         const std::optional<std::filesystem::path>& recovered_for) {
  if (activity_ != Activity::idle) return;
  Q_EMIT logged(tr("Opening the study %1").arg(file_name(file)));
  begin(Activity::loading, [this, file, recovered_for](const Progress& progress) -> Worker::Done {
    struct Opened {
      Project project;
      ReadParts read;
      LoadParams params;
      std::shared_ptr<MeshState> mesh;
      IterationRecord record;
      std::shared_ptr<const PreparedMesh> prepared;
      std::optional<Error> unread;  // why there is none
    };
    const auto open_all = [&]() -> Result<Opened> {
      Result<Project> project = open_project(file, progress.portion(0, 0.3),
                                             recovered_for.value_or(std::filesystem::path()));
      if (!project) return project.error();
      Opened opened;
      opened.project = std::move(*project);
      const Study& study = opened.project.study;
      std::vector<double> units;
      for (const StudyInput& input : study.inputs) units.push_back(input.unit);
      opened.params.chord_tolerance = study.options.chord_tolerance;
      opened.params.angle_tolerance = study.options.angle_tolerance;
      Result<ReadParts> read = read_parts(services_, opened.project.files, units, opened.params,
                                          progress.portion(0.3, 0.9));
      if (!read) return read.error();
      opened.read = std::move(*read);
      name_parts(opened.read, 0, study.left_out, true);
      if (!opened.project.mesh.empty()) {
        if (Result<MeshState> state = services_.read_mesh(opened.project.mesh))
          opened.mesh = std::make_shared<MeshState>(std::move(*state));
        else
          opened.unread = state.error();
        if (opened.mesh) {
          opened.record = measured(*opened.mesh);
          opened.prepared = prepare(opened.mesh);
        }
      }
      return opened;
    };
    Result<Opened> opened = open_all();
    return [this, opened = std::move(opened), file, recovered_for]() mutable {
      set_activity(Activity::idle);
      if (!opened) return report(opened.error());
      project_ = std::move(opened->project);
      std::vector<std::string> notes = project_.notes;
      for (std::string& note : fit_to_parts(project_.study, file, opened->read.parts))
        notes.push_back(std::move(note));
      read_with_ = opened->params;
      replace_all(project_.study, std::move(opened->read), 0);
      file_ = recovered_for.value_or(file);
      if (recovered_for) {
        saved_.clear();
        compared_.reset();
      }
      opened_mesh_ = opened->mesh;
      if (opened->mesh) {
        Study made_of = *project_.mesh_study;
        arrange_bodies(made_of, *parts_);
        run_study_ = std::make_shared<const Study>(std::move(made_of));
        Iteration iteration{opened->record, opened->mesh, opened->prepared};
        take_report(iteration);
        add_iteration(std::move(iteration));
      }
      Q_EMIT study_changed();
      if (opened->unread) report(*opened->unread);
      tell(tr("The study is open, but not all is as it was saved."), notes);
      Q_EMIT study_opened(text(file.string()));
    };
  });
}

void Session::save(const std::filesystem::path& file) {
  if (activity_ != Activity::idle || !has_bodies()) return;
  const auto state = shown_state();
  begin(Activity::saving,
        [this, file, state, study = study_, parts = parts_, made_of = run_study_,
         outcome = outcome_, opened = project_, opened_mesh = opened_mesh_,
         context = report_context(file)](const Progress& progress) -> Worker::Done {
          ProjectContent content;
          content.study = *study;
          content.copies = opened.copies;
          content.faces = known_faces(*study, *parts);
          if (state) {
            if (made_of) content.mesh_study = *made_of;
            content.write_mesh = [&](const std::filesystem::path& vtu) -> Result<void> {
              // The names are those it was made with.
              Result<ExportCertificate> written =
                  services_.export_mesh(vtu, *state, made_of ? *made_of : *study, {}, {});
              if (!written) return written.error();
              return {};
            };
            if (state == opened_mesh) {
              content.report_json = opened.report_json;
              content.report_html = opened.report_html;
            } else if (outcome && outcome->state == state) {
              if (Result<Report> made =
                      build_report(made_of ? *made_of : *study, *outcome, context)) {
                content.report_json = report_json(*made);
                content.report_html = report_html(*made);
              }
            }
          }
          Result<std::vector<std::string>> written = save_project(content, file, progress);
          const bool with_mesh = state && is_project(file);
          return [this, written = std::move(written), study, file, with_mesh] {
            set_activity(Activity::idle);
            if (!written) return report(written.error());
            if (with_mesh) mesh_unsaved_ = false;
            file_ = file;
            saved_ = study_to_json(*study);
            compared_.reset();
            Q_EMIT logged(tr("Saved %1").arg(text(file.string())));
            Q_EMIT study_changed();
            Q_EMIT saved(text(file.string()));
            tell(tr("Saved, but not all of it."), *written);
          };
        });
}

void Session::tell(const QString& what, const std::vector<std::string>& notes) {
  QStringList lines;
  for (const std::string& note : notes) lines << text(note);
  for (const QString& line : lines) Q_EMIT logged(line);
  if (!lines.isEmpty()) Q_EMIT noticed(what, lines.join('\n'));
}

bool Session::modified() const {
  if (!has_bodies()) return false;
  if (compared_ != study_) {
    compared_ = study_;
    differs_ = study_to_json(*study_) != saved_;
  }
  return differs_;
}

void Session::open_sample(const std::string& name) {
  if (activity_ != Activity::idle) return;
  Q_EMIT logged(tr("Making the sample part “%1”").arg(text(name)));
  begin(Activity::loading, [this, name](const Progress&) -> Worker::Done {
    Result<std::filesystem::path> made = services_.sample_part(name);
    return [this, made = std::move(made)] {
      set_activity(Activity::idle);
      if (!made) return report(made.error());
      open({*made});
    };
  });
}

void Session::open_mesh(const std::filesystem::path& file) {
  if (activity_ != Activity::idle) return;
  Q_EMIT logged(tr("Opening the mesh %1").arg(file_name(file)));
  begin(Activity::loading, [this, file](const Progress&) -> Worker::Done {
    Result<MeshState> read = services_.read_mesh(file);
    Iteration opened;
    if (read) {
      opened.record = measured(*read);
      opened.state = std::make_shared<const MeshState>(std::move(*read));
      opened.prepared = prepare(opened.state);
    }
    return [this, read = std::move(read), opened = std::move(opened), file] {
      set_activity(Activity::idle);
      if (!read) return report(read.error());
      Study study;
      study.name = file.stem().string();
      project_ = {};
      replace_all(std::move(study), {}, 0);
      add_iteration(opened);
    };
  });
}

void Session::take_parts(ReadParts read, const std::vector<StudyInput>& inputs, bool add) {
  ReadParts all;
  Study study;
  if (add) {
    all.parts = *parts_;
    all.sources = sources_;
    study = *study_;
  } else {
    project_ = {};
    study.options = study_->options;
    study.name = !inputs.empty() ? std::filesystem::path(inputs.front().file).stem().string()
                                 : (read.parts.empty() ? "untitled" : read.parts.front().name);
  }
  const std::size_t first_new = all.parts.size();
  for (Part& part : read.parts) all.parts.push_back(std::move(part));
  all.sources.insert(all.sources.end(), read.sources.begin(), read.sources.end());
  std::vector<std::string> taken = study.left_out;
  for (const StudyZone& zone : study.zones) taken.push_back(zone.name);
  name_parts(all, first_new, taken, false);
  for (std::size_t k = first_new; k < all.parts.size(); ++k)
    add_groups_of_file(all.parts[k], study);
  study.inputs.insert(study.inputs.end(), inputs.begin(), inputs.end());
  const std::filesystem::path file = add ? file_ : std::filesystem::path();
  const std::string saved = saved_;
  replace_all(std::move(study), std::move(all), first_new);
  file_ = file;
  if (add) {
    saved_ = saved;
    compared_.reset();
  }
}

void Session::replace_all(Study study, ReadParts read, std::size_t first_new) {
  arrange_bodies(study, read.parts);
  for (std::size_t k = first_new; k < read.parts.size(); ++k) {
    const Part& part = read.parts[k];
    Q_EMIT logged(tr("%1: %2, %L3 triangles on %4 faces, volume %5")
                      .arg(text(part.name), box_size(part.surface))
                      .arg(part.surface.facets.size())
                      .arg(part.surface.faces.size())
                      .arg(units::volume(part.cad_volume)));
    for (const std::string& note : part.notes) Q_EMIT logged(text(part.name + ": " + note));
  }
  parts_ = std::make_shared<const std::vector<Part>>(std::move(read.parts));
  sources_ = std::move(read.sources);
  if (first_new == 0) surfaces_differ_ = false;
  selected_ = -1;
  selection_.clear();
  item_.reset();
  file_.clear();
  opened_mesh_.reset();
  undo_.clear();
  saved_ = study_to_json(study);
  compared_.reset();
  study_ = std::make_shared<const Study>(std::move(study));
  follow_bodies();
  clear_iterations();
  mesh_unsaved_ = false;
  // What shows the parts has to have them before it hears of their settings.
  Q_EMIT parts_changed();
  Q_EMIT study_changed();
  select(has_bodies() ? static_cast<int>(first_new) : -1);
}

void Session::wrote(const QString& file, const Result<void>& written) {
  if (!written) return report(written.error());
  Q_EMIT logged(tr("Wrote %1").arg(file));
}

void Session::remove_item(const Item& item) {
  if (item.kind == ItemKind::body)
    return is_part(item.index) ? remove_part(item.index) : remove_zone(item.index);
  if (item.kind == ItemKind::domain) return edit_domain(*this, tr("Drop the domain"), {});
  Study study = *study_;
  const auto take = [&](auto& list, const QString& what) {
    if (item.index < 0 || item.index >= static_cast<int>(list.size())) return;
    const QString name = text(list[static_cast<std::size_t>(item.index)].name);
    list.erase(list.begin() + item.index);
    edit(what.arg(name), std::move(study));
  };
  if (item.kind == ItemKind::group) take(study.groups, tr("Remove group %1"));
  if (item.kind == ItemKind::sizing) take(study.sizing, tr("Remove size %1"));
  if (item.kind == ItemKind::cut) take(study.cuts, tr("Remove %1"));
}

void Session::show_place(const Vec<3>& at, double radius, const QString& words) {
  Q_EMIT place_shown(at, radius, words);
}

void Session::cut_at(const Vec<3>& at, double radius, const QString& words) {
  Q_EMIT cut_asked(at);
  show_place(at, radius, words);
}

void Session::clear_iterations() {
  outcome_.reset();
  run_study_.reset();
  exports_.clear();
  iterations_.clear();
  shown_ = -1;
  Q_EMIT iterations_changed();
  Q_EMIT shown_changed();
}

void Session::add_iteration(Iteration iteration) {
  // Someone looking back at an older iteration is not torn away from it.
  const bool follow = shown_ + 1 == static_cast<int>(iterations_.size());
  // The loop tells a mesh again once it knows the flow through it.
  const auto same = [&](const IterationRecord& a, const IterationRecord& b) {
    return a.iteration == b.iteration && a.nodes == b.nodes && a.elements == b.elements;
  };
  if (!iterations_.empty() && iteration.state->flow &&
      same(iterations_.back().record, iteration.record)) {
    iterations_.back() = std::move(iteration);
    Q_EMIT iterations_changed();
    if (follow) Q_EMIT shown_changed();
    return;
  }
  iterations_.push_back(std::move(iteration));
  Q_EMIT iterations_changed();
  if (follow) show_iteration(static_cast<int>(iterations_.size()) - 1);
}

void Session::run() {
  if (!can_run()) return;
  clear_iterations();
  run_study_ = study_;
  Q_EMIT logged(tr("Run: %1, at most %2 iterations")
                    .arg(bodies_text(parts_->size() + (study_->domain ? study_->zones.size() : 0)))
                    .arg(study_->options.iterations));
  // The surfaces spend a share of the chord tolerance: another one needs other surfaces.
  LoadParams params = read_with_;
  params.chord_tolerance = study_->options.chord_tolerance;
  const bool again = surfaces_differ_ || params.chord_tolerance != read_with_.chord_tolerance;
  begin(
      Activity::running,
      [this, study = study_, parts = parts_, sources = sources_, params, again,
       copies = project_.copies, known = result_](const Progress& whole) mutable -> Worker::Done {
        // What is missing is told before the work.
        const auto field = solver_field_of(services_, *study, copies, known, whole.portion(0, 0));
        if (!field)
          return [this, error = field.error()]() mutable { finish_run(std::move(error)); };
        worker_.post([this, known] { take_result(known); });
        if (again) {
          auto read =
              read_again(services_, *parts, sources, params, whole.portion(0, 0.05, "reading"));
          if (!read)
            return [this, error = read.error()]() mutable { finish_run(std::move(error)); };
          auto before =
              std::exchange(parts, std::make_shared<const std::vector<Part>>(std::move(*read)));
          worker_.post([this, before = std::move(before), parts, params] {
            if (parts_ != before) return;  // a part was removed, or came back
            parts_ = parts;
            surfaces_differ_ = false;
            read_with_ = params;
            follow_bodies();
            Q_EMIT surfaces_changed();
          });
        }
        const Progress progress = whole.portion(again ? 0.05 : 0, 1);
        const auto meshers = services_.meshers ? services_.meshers(study->options.seed)
                                               : std::vector<std::shared_ptr<const VolumeMesher>>{};
        std::pair<std::shared_ptr<const MeshState>, std::shared_ptr<const PreparedMesh>> last;
        Result<Outcome> result = services_.run(
            *study, *parts, meshers, progress,
            [&, this](const IterationRecord& record, std::shared_ptr<const MeshState> state) {
              last = {state, prepare(state)};
              worker_.post([this, record, state = std::move(state), prepared = last.second] {
                Q_EMIT logged(tr("Iteration %1: %L2 nodes, %L3 elements, layers %4 (5 %: %5), %6 s")
                                  .arg(record.iteration)
                                  .arg(record.nodes)
                                  .arg(record.elements)
                                  .arg(written(record.layers.mean, 'f', 1))
                                  .arg(written(record.layers.p5, 'f', 1))
                                  .arg(written(record.seconds, 'f', 1)));
                if (record.mixed > 0)
                  Q_EMIT logged(tr("%L1 mixed elements, interface error %2")
                                    .arg(record.mixed)
                                    .arg(written(record.interface_error, 'f', 4)));
                add_iteration({record, state, prepared});
              });
            },
            *field);
        if (result && result->state && result->state != last.first)
          last.second = prepare(result->state);
        return [this, result = std::move(result), prepared = last.second]() mutable {
          finish_run(std::move(result), prepared);
        };
      });
}

void Session::finish_run(Result<Outcome> result, std::shared_ptr<const PreparedMesh> prepared) {
  set_activity(Activity::idle);
  if (!result) {
    report(result.error());
    Q_EMIT run_finished();
    return;
  }
  outcome_ = std::move(*result);
  if (outcome_->state) {
    mesh_unsaved_ = true;
    keep_best(outcome_->state, prepared);
  }
  for (const BodyOutcome& body : outcome_->bodies) {
    Q_EMIT logged(tr("%1: first mesh by %2, layers %3 asked, %4 on average (5 %: %5)")
                      .arg(text(body.name), text(body.first_mesh_by))
                      .arg(body.layers_asked)
                      .arg(written(body.layers.mean, 'f', 2))
                      .arg(written(body.layers.p5, 'f', 2)));
    for (const std::string& note : body.notes) Q_EMIT logged(text(body.name + ": " + note));
  }
  Q_EMIT logged(outcome_->cancelled ? tr("Cancelled after %1 s; the best mesh so far is kept.")
                                          .arg(written(outcome_->seconds, 'f', 1))
                : outcome_->converged
                    ? tr("Converged in %1 s.").arg(written(outcome_->seconds, 'f', 1))
                    : tr("Stopped after %1 s at the limit of iterations.")
                          .arg(written(outcome_->seconds, 'f', 1)));
  Q_EMIT run_finished();
}

void Session::keep_best(const std::shared_ptr<const MeshState>& state,
                        const std::shared_ptr<const PreparedMesh>& prepared) {
  // The loop keeps its best mesh, which need not be the last one it told about.
  const bool follow = shown_ + 1 == static_cast<int>(iterations_.size());
  const auto best =
      std::find_if(iterations_.rbegin(), iterations_.rend(), [&](const Iteration& it) {
        return it.record.nodes == state->mesh.node_count() &&
               it.record.elements == state->mesh.element_count();
      });
  if (best != iterations_.rend()) {
    best->state = state;
    best->prepared = prepared;
    if (follow) show_iteration(static_cast<int>(iterations_.rend() - best) - 1);
    return;
  }
  // Bodies whose best meshes are of different iterations.
  Iteration mixed;
  if (!outcome_->records.empty()) mixed.record = outcome_->records.back();
  mixed.record.nodes = state->mesh.node_count();
  mixed.record.elements = state->mesh.element_count();
  mixed.state = state;
  mixed.prepared = prepared;
  add_iteration(std::move(mixed));
}

void Session::pause(bool on) {
  if (activity_ != Activity::running || on == worker_.paused() || worker_.cancelling()) return;
  worker_.pause(on);
  if (on)
    held_at_ = clock_.elapsed();
  else
    held_ += clock_.elapsed() - held_at_;
  Q_EMIT logged(on ? tr("Paused.") : tr("Goes on."));
  Q_EMIT activity_changed();
}

void Session::cancel() {
  if (activity_ == Activity::idle || worker_.cancelling()) return;
  worker_.cancel();
  Q_EMIT activity_changed();
}

void Session::edit(const QString& what, Study after, int merge) {
  undo_.push(new EditStudy(*this, what, std::make_shared<Study>(std::move(after)), merge));
}

void Session::edit_selection(const QString& what,
                             const std::function<void(BodySettings&)>& change) {
  Study study = *study_;
  bool changed = false;
  for (const int k : selection_) {
    const BodySettings before = study.bodies[k];
    change(study.bodies[k]);
    changed = changed || before != study.bodies[k];
  }
  if (!changed) return;
  const QString title =
      selection_.size() == 1
          ? tr("%1 of %2").arg(what, text(study.bodies[std::size_t(selected_)].name))
          : tr("%1 of %2 bodies").arg(what).arg(selection_.size());
  edit(title, std::move(study));
}

void Session::edit_body(int index, const QString& what, const BodySettings& after) {
  Study study = *study_;
  study.bodies[index] = after;
  edit(what, std::move(study));
}

}  // namespace lamella::ui
