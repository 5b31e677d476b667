#include "ui/session/session.h"

#include <algorithm>
#include <set>

#include "core/study/measure.h"
#include "core/study/study_file.h"
#include "ui/commands/edit_study.h"

namespace lamella::ui {
namespace {

QString text(const std::string& s) { return QString::fromStdString(s); }

QString file_name(const std::filesystem::path& file) { return text(file.filename().string()); }

QString bodies_text(std::size_t count) {
  return count == 1 ? Session::tr("1 body") : Session::tr("%1 bodies").arg(count);
}

bool is_stl(const std::filesystem::path& file) {
  return text(file.extension().string()).compare(".stl", Qt::CaseInsensitive) == 0;
}

QString box_size(const ReferenceSurface<3>& surface) {
  if (surface.points.empty()) return {};
  Vec<3> low = surface.points.front();
  Vec<3> high = low;
  for (const Vec<3>& p : surface.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec<3> size = high - low;
  return QString("%1 × %2 × %3 mm")
      .arg(size[0], 0, 'g', 4)
      .arg(size[1], 0, 'g', 4)
      .arg(size[2], 0, 'g', 4);
}

/// Settings are found by name, so names must differ.
void make_names_unique(std::vector<Part>& parts) {
  std::set<std::string> taken;
  for (Part& part : parts) {
    const std::string base = part.name;
    for (int k = 2; !taken.insert(part.name).second; ++k)
      part.name = base + " (" + std::to_string(k) + ")";
  }
}

/// What the mesh depends on, as text.
std::string asked(Study study) {
  study.name.clear();
  study.inputs.clear();
  study.options.threads = 0;
  for (BodySettings& body : study.bodies) body.visible = true;
  return study_to_json(study);
}

}  // namespace

Session::Session(Services services, QObject* parent)
    : QObject(parent), services_(std::move(services)) {
  connect(&worker_, &Worker::progressed, this, [this](double fraction, const QString& phase) {
    const double elapsed = static_cast<double>(clock_.elapsed()) / 1000;
    const bool known = fraction > 0.02 && elapsed > 1;
    Q_EMIT progressed(fraction, phase, known ? elapsed * (1 - fraction) / fraction : -1);
  });
}

bool Session::outdated() const {
  if (!run_study_ || iterations_.empty()) return false;
  return asked(*run_study_) != asked(*study_);
}

std::shared_ptr<const MeshState> Session::shown_state() const {
  return shown_ < 0 ? nullptr : iterations_[shown_].state;
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
  std::erase_if(parts, [&](int p) { return p < 0 || p >= static_cast<int>(parts_->size()); });
  if (std::find(parts.begin(), parts.end(), current) == parts.end())
    current = parts.empty() ? -1 : parts.back();
  if (parts == selection_ && current == selected_) return;
  selection_ = std::move(parts);
  selected_ = current;
  Q_EMIT selection_changed();
}

double Session::automatic_size(int part) const {
  return 1e-3 * box_diagonal((*parts_)[static_cast<std::size_t>(part)].surface.points);
}

void Session::set_study(std::shared_ptr<const Study> study) {
  study_ = std::move(study);
  Q_EMIT study_changed();
}

void Session::set_activity(Activity activity) {
  if (activity_ == activity) return;
  activity_ = activity;
  Q_EMIT activity_changed();
}

void Session::begin(Activity activity, Worker::Job job) {
  clock_.restart();
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
  params.unit = unit;
  begin(Activity::loading, [this, files, add, params](const Progress& progress) -> Worker::Done {
    std::vector<Part> parts;
    std::vector<std::string> inputs;
    std::vector<PartSource> sources;
    std::optional<Error> error;
    QString no_unit;
    for (std::size_t k = 0; k < files.size() && !error; ++k) {
      const double share = 1.0 / static_cast<double>(files.size());
      auto loaded = services_.load_parts(
          files[k], params,
          progress.portion(share * static_cast<double>(k), share * static_cast<double>(k + 1)));
      if (!loaded) {
        error = loaded.error();
        break;
      }
      if (is_stl(files[k])) no_unit = text(files[k].string());
      for (std::size_t p = 0; p < loaded->size(); ++p) {
        parts.push_back(std::move((*loaded)[p]));
        sources.push_back({files[k], p, params.unit});
      }
      inputs.push_back(files[k].string());
    }
    return
        [this, parts = std::move(parts), sources, inputs, error, add, no_unit, params]() mutable {
          set_activity(Activity::idle);
          if (error) return report(*error);
          const QString size = parts.empty() ? QString() : box_size(parts.back().surface);
          if (!add) read_with_ = params;
          take_parts(std::move(parts), std::move(sources), inputs, add);
          if (!no_unit.isEmpty() && params.unit == 1) Q_EMIT unit_assumed(no_unit, size);
        };
  });
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
    return [this, read = std::move(read), file]() mutable {
      set_activity(Activity::idle);
      if (!read) return report(read.error());
      take_parts({}, {}, {}, false);
      Study study;
      study.name = file.stem().string();
      set_study(std::make_shared<Study>(study));
      auto state = std::make_shared<MeshState>(std::move(*read));
      Iteration iteration;
      iteration.record.nodes = state->mesh.node_count();
      iteration.record.elements = state->mesh.element_count();
      iteration.state = state;
      add_iteration(std::move(iteration));
    };
  });
}

void Session::take_parts(std::vector<Part> parts, std::vector<PartSource> sources,
                         std::vector<StudyInput> inputs, bool add) {
  std::vector<Part> all;
  Study study;
  if (add) {
    all = *parts_;
    study = *study_;
  } else {
    study.options = study_->options;
    study.name = !inputs.empty() ? std::filesystem::path(inputs.front()).stem().string()
                                 : (parts.empty() ? "untitled" : parts.front().name);
  }
  const std::size_t first_new = all.size();
  if (!add) sources_.clear();
  sources_.insert(sources_.end(), sources.begin(), sources.end());
  for (Part& part : parts) all.push_back(std::move(part));
  make_names_unique(all);
  study.inputs.insert(study.inputs.end(), inputs.begin(), inputs.end());
  std::vector<BodySettings> bodies;
  for (const Part& part : all) {
    bodies.push_back(settings_of(study, part.name));
    bodies.back().name = part.name;
  }
  study.bodies = std::move(bodies);
  for (std::size_t k = first_new; k < all.size(); ++k) {
    const Part& part = all[k];
    Q_EMIT logged(tr("%1: %2, %3 triangles on %4 faces, volume %L5 mm³")
                      .arg(text(part.name), box_size(part.surface))
                      .arg(part.surface.facets.size())
                      .arg(part.surface.faces.size())
                      .arg(part.cad_volume, 0, 'f', 1));
    for (const std::string& note : part.notes) Q_EMIT logged(text(part.name + ": " + note));
  }
  const bool any = !all.empty();
  parts_ = std::make_shared<const std::vector<Part>>(std::move(all));
  selected_ = -1;
  selection_.clear();
  undo_.clear();
  clear_iterations();
  set_study(std::make_shared<Study>(std::move(study)));
  Q_EMIT parts_changed();
  select(any ? static_cast<int>(first_new) : -1);
}

void Session::remove_part(int index) {
  if (activity_ != Activity::idle || index < 0 || index >= static_cast<int>(parts_->size())) return;
  auto parts = *parts_;
  auto study = *study_;
  Q_EMIT logged(tr("Removed %1").arg(text(parts[index].name)));
  parts.erase(parts.begin() + index);
  study.bodies.erase(study.bodies.begin() + index);
  if (parts.empty()) study = Study{};
  sources_.erase(sources_.begin() + index);
  parts_ = std::make_shared<const std::vector<Part>>(std::move(parts));
  selected_ = -1;
  selection_.clear();
  undo_.clear();
  clear_iterations();
  set_study(std::make_shared<Study>(std::move(study)));
  Q_EMIT parts_changed();
  select(std::min(index, static_cast<int>(parts_->size()) - 1));
}

void Session::clear_iterations() {
  outcome_.reset();
  run_study_.reset();
  iterations_.clear();
  shown_ = -1;
  Q_EMIT iterations_changed();
  Q_EMIT shown_changed();
}

void Session::add_iteration(Iteration iteration) {
  // Someone looking back at an older iteration is not torn away from it.
  const bool follow = shown_ + 1 == static_cast<int>(iterations_.size());
  iterations_.push_back(std::move(iteration));
  Q_EMIT iterations_changed();
  if (follow) show_iteration(static_cast<int>(iterations_.size()) - 1);
}

void Session::run() {
  if (!can_run()) return;
  clear_iterations();
  run_study_ = study_;
  Q_EMIT logged(tr("Run: %1, at most %2 iterations")
                    .arg(bodies_text(parts_->size()))
                    .arg(study_->options.iterations));
  // The surfaces spend a share of the chord tolerance: another one needs other surfaces.
  LoadParams params = read_with_;
  params.chord_tolerance = study_->options.chord_tolerance;
  const bool again = params.chord_tolerance != read_with_.chord_tolerance;
  begin(
      Activity::running,
      [this, study = study_, parts = parts_, sources = sources_, params,
       again](const Progress& whole) mutable -> Worker::Done {
        if (again) {
          auto read = read_again(*parts, sources, params, whole.portion(0, 0.05, "reading"));
          if (!read)
            return [this, error = read.error()]() mutable { finish_run(std::move(error)); };
          parts = *read;
          worker_.post([this, parts, params] {
            parts_ = parts;
            read_with_ = params;
            Q_EMIT surfaces_changed();
          });
        }
        const Progress progress = whole.portion(again ? 0.05 : 0, 1);
        const auto meshers = services_.meshers ? services_.meshers(study->options.seed)
                                               : std::vector<std::shared_ptr<const VolumeMesher>>{};
        Result<Outcome> result = services_.run(
            *study, *parts, meshers, progress,
            [this](const IterationRecord& record, std::shared_ptr<const MeshState> state) {
              worker_.post([this, record, state = std::move(state)] {
                Q_EMIT logged(tr("Iteration %1: %L2 nodes, %L3 elements, layers %4 (5 %: %5), %6 s")
                                  .arg(record.iteration)
                                  .arg(record.nodes)
                                  .arg(record.elements)
                                  .arg(record.layers.mean, 0, 'f', 1)
                                  .arg(record.layers.p5, 0, 'f', 1)
                                  .arg(record.seconds, 0, 'f', 1));
                add_iteration({record, state});
              });
            });
        return [this, result = std::move(result)]() mutable { finish_run(std::move(result)); };
      });
}

Result<std::shared_ptr<const std::vector<Part>>> Session::read_again(
    const std::vector<Part>& parts, const std::vector<PartSource>& sources,
    const LoadParams& params, const Progress& progress) {
  std::vector<Part> all = parts;
  std::vector<Part> file;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k == 0 || sources[k].file != sources[k - 1].file ||
        sources[k].unit != sources[k - 1].unit) {
      LoadParams own = params;
      own.unit = sources[k].unit;
      const auto count = static_cast<double>(all.size());
      auto loaded = services_.load_parts(
          sources[k].file, own,
          progress.portion(static_cast<double>(k) / count, static_cast<double>(k + 1) / count));
      if (!loaded) return loaded.error();
      file = std::move(*loaded);
    }
    if (sources[k].index >= file.size())
      return Error{Code::bad_input,
                   "\"" + sources[k].file.string() + "\" has changed since it was opened.",
                   "Open it again."};
    Part part = file[sources[k].index];
    part.name = all[k].name;
    all[k] = std::move(part);
  }
  return std::make_shared<const std::vector<Part>>(std::move(all));
}

void Session::finish_run(Result<Outcome> result) {
  set_activity(Activity::idle);
  if (!result) {
    report(result.error());
    Q_EMIT run_finished();
    return;
  }
  outcome_ = std::move(*result);
  if (outcome_->state) keep_best(outcome_->state);
  for (const BodyOutcome& body : outcome_->bodies) {
    Q_EMIT logged(tr("%1: first mesh by %2, layers %3 asked, %4 on average (5 %: %5)")
                      .arg(text(body.name), text(body.first_mesh_by))
                      .arg(body.layers_asked)
                      .arg(body.layers.mean, 0, 'f', 2)
                      .arg(body.layers.p5, 0, 'f', 2));
    for (const std::string& note : body.notes) Q_EMIT logged(text(body.name + ": " + note));
  }
  Q_EMIT logged(
      outcome_->cancelled ? tr("Cancelled after %1 s; the best mesh so far is kept.")
                                .arg(outcome_->seconds, 0, 'f', 1)
      : outcome_->converged
          ? tr("Converged in %1 s.").arg(outcome_->seconds, 0, 'f', 1)
          : tr("Stopped after %1 s at the limit of iterations.").arg(outcome_->seconds, 0, 'f', 1));
  Q_EMIT run_finished();
}

void Session::keep_best(const std::shared_ptr<const MeshState>& state) {
  // The loop keeps its best mesh, which need not be the last one it told about.
  const bool follow = shown_ + 1 == static_cast<int>(iterations_.size());
  const auto best =
      std::find_if(iterations_.rbegin(), iterations_.rend(), [&](const Iteration& it) {
        return it.record.nodes == state->mesh.node_count() &&
               it.record.elements == state->mesh.element_count();
      });
  if (best != iterations_.rend()) {
    best->state = state;
    if (follow) show_iteration(static_cast<int>(iterations_.rend() - best) - 1);
    return;
  }
  // Bodies whose best meshes are of different iterations.
  Iteration mixed;
  if (!outcome_->records.empty()) mixed.record = outcome_->records.back();
  mixed.record.nodes = state->mesh.node_count();
  mixed.record.elements = state->mesh.element_count();
  mixed.state = state;
  add_iteration(std::move(mixed));
}

void Session::cancel() {
  if (activity_ == Activity::idle || worker_.cancelling()) return;
  worker_.cancel();
  Q_EMIT activity_changed();
}

void Session::export_mesh(const std::filesystem::path& file) {
  const auto state = shown_state();
  if (activity_ != Activity::idle || !state) return;
  Q_EMIT logged(tr("Exporting %1").arg(text(file.string())));
  begin(Activity::exporting, [this, state, file, study = study_](const Progress&) -> Worker::Done {
    Result<void> written = services_.export_mesh(file, *state, *study);
    return [this, written = std::move(written), file] {
      set_activity(Activity::idle);
      if (!written) return report(written.error());
      Q_EMIT logged(tr("Wrote %1").arg(text(file.string())));
      Q_EMIT exported(text(file.string()));
    };
  });
}

void Session::edit(const QString& what, Study after) {
  undo_.push(new EditStudy(*this, what, std::make_shared<Study>(std::move(after))));
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
