#include <tbb/global_control.h>

#include <filesystem>

#include "app/cli_commands.h"
#include "app/cli_common.h"
#include "app/cli_job.h"
#include "app/cli_set.h"
#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/project/project_file.h"
#include "core/study/domain.h"
#include "core/study/study_file.h"

namespace lamella::cli {

namespace {

namespace fs = std::filesystem;

/// A line of the table: what became of one combination.
struct Row {
  std::string nodes, elements, layers_mean, layers_p5, quality_min, seconds;
  int status = 0;
};

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

/// OUT-3.vtu of OUT.vtu.
std::string numbered(const fs::path& file, std::size_t k) {
  const std::string name =
      file.stem().string() + "-" + std::to_string(k) + file.extension().string();
  return (file.parent_path() / name).string();
}

/// The row of a report as it was written; nothing when it is of another study, version or a run
/// that was cancelled.
std::optional<Row> row_of(const std::string& report, const Study& study,
                          const std::optional<double>& min_quality) {
  const Json json = Json::parse(report, nullptr, false);
  try {
    if (!json.is_object() || json.at("program").get<std::string>() != "Lamella " + version())
      return {};
    const Result<Study> made = study_from_json(json.at("study").dump(), "report");
    if (!made || mesh_key(*made) != mesh_key(study) || json.at("cancelled").get<bool>()) return {};
    const double worst = json.at("quality").at("min").get<double>();
    Row row{json.at("mesh").at("nodes").dump(),  json.at("mesh").at("elements").dump(),
            json.at("layers").at("mean").dump(), json.at("layers").at("p5").dump(),
            json.at("quality").at("min").dump(), json.at("seconds").dump()};
    row.status = min_quality && worst < *min_quality ? exit_code(Code::poor_quality)
                 : json.at("converged").get<bool>()  ? 0
                                                     : exit_code(Code::not_converged);
    return row;
  } catch (const Json::exception&) {
    return {};
  }
}

/// The run of a study, or of each combination of a sweep.
class StudyRun {
 public:
  StudyRun(const RunCommand& command, std::string line, Console& console)
      : c_(command), line_(std::move(line)), console_(console), progress_(console.progress()) {}

  int run() {
    if (Result<void> good = prepare(); !good) return console_.fail(good.error());
    const std::size_t first = c_.only ? *c_.only - 1 : 0;
    const std::size_t last = c_.only ? *c_.only : combinations_.size();
    int status = 0;
    std::vector<Row> rows;
    for (std::size_t k = first; k < last && status != exit_code(Code::cancelled); ++k) {
      const auto share = [&](std::size_t at) {
        return 0.05 + 0.95 * static_cast<double>(at - first) / static_cast<double>(last - first);
      };
      rows.push_back(run_one(k, progress_.portion(share(k), share(k + 1))));
      if (status == 0 || rows.back().status == exit_code(Code::cancelled))
        status = rows.back().status;
    }
    if (!table_.empty())
      if (Result<void> written = write_table(first, rows); !written)
        return console_.fail(written.error());
    return status;
  }

 private:
  /// All that can fail before the first mesh.
  Result<void> prepare() {
    if (!names_study(c_.study))
      return Error{Code::usage, "\"" + c_.study + "\" is no study.",
                   "Give a .lamella project or a .json study; parts are for `mesh`."};
    for (const std::string& text : c_.set) {
      Result<Setting> setting = read_setting(text);
      if (!setting) return setting.error();
      settings_.push_back(std::move(*setting));
    }
    Result<std::vector<Combination>> all = combinations_of(settings_);
    if (!all) return all.error();
    combinations_ = std::move(*all);
    const bool sweep = combinations_.size() > 1;
    if (c_.only && *c_.only > combinations_.size())
      return Error{Code::usage,
                   "There are " + std::to_string(combinations_.size()) + " combinations, no " +
                       std::to_string(*c_.only) + ".",
                   "--only counts from 1."};
    const fs::path project = fs::path(c_.study).replace_extension(".lamella");
    outputs_ = c_.outputs.empty() ? std::vector<std::string>{project.string()} : c_.outputs;
    table_ = c_.table;
    if (table_.empty() && sweep && !c_.only)
      table_ = fs::path(outputs_.front()).replace_extension(".csv").string();
    for (const std::string& output : outputs_)
      if (Result<void> good = check_output(output); !good) return good;

    Result<Project> opened = open_project(c_.study, progress_.portion(0, 0.02));
    if (!opened) return of_input(opened.error());
    project_ = std::move(*opened);
    tell_notes(project_.notes, console_);
    StudyOptions& o = project_.study.options;
    if (c_.threads) o.threads = *c_.threads;
    if (c_.memory) o.memory = c_.memory;
    if (c_.seed) o.seed = *c_.seed;
    if (project_.files.empty() && project_.study.zones.empty())
      return Error{Code::bad_input, "\"" + c_.study + "\": the study names no inputs.",
                   "Add the parts to \"inputs\"."};
    if (Result<void> loaded = load(project_.study, progress_.portion(0.02, 0.05)); !loaded)
      return loaded;
    tell_notes(fit_to_parts(project_.study, c_.study, parts_), console_);
    // Every body has an entry from here on, as in the window.
    arrange_bodies(project_.study, parts_);
    // A path that is wrong is told before the first mesh, not by it.
    for (const Combination& combination : combinations_)
      if (Result<Study> study = with_settings(project_.study, settings_, combination); !study)
        return study.error();
    return {};
  }

  /// The parts, unless those that are there are of these tolerances, with the same ones left out.
  Result<void> load(const Study& study, const Progress& progress) {
    LoadParams params;
    params.chord_tolerance = study.options.chord_tolerance;
    params.angle_tolerance = study.options.angle_tolerance;
    if (loaded_ && loaded_->chord_tolerance == params.chord_tolerance &&
        loaded_->angle_tolerance == params.angle_tolerance && left_out_ == study.left_out)
      return {};
    Result<std::vector<Part>> parts = load_all(project_.files, study, params, progress);
    if (!parts) return parts.error();
    parts_ = std::move(*parts);
    loaded_ = params;
    left_out_ = study.left_out;
    return {};
  }

  Row run_one(std::size_t k, const Progress& progress) {
    Job job;
    job.study = with_settings(project_.study, settings_, combinations_[k]).value();
    // A --set may have named another file.
    if (job.study.flow && job.study.flow->field)
      if (StudyInput& source = job.study.flow->field->source; fs::exists(source.file))
        (void)identify(source, source.file);  // what cannot be read is told by who reads it
    job.command = line_;
    job.inputs = inputs_of(job.study);
    job.copies = project_.copies;
    const bool sweep = combinations_.size() > 1;
    bool in_project = false;
    for (const std::string& output : outputs_) {
      job.outputs.push_back(sweep ? numbered(output, k + 1) : output);
      in_project = in_project || is_project(output);
    }
    if (!in_project) job.report = report_stem(job.outputs.front());
    tell_combination(k, job);
    if (c_.resume) {
      if (const std::optional<Row> row = finished(job)) {
        console_.say("finished before: " + job.outputs.front());
        tell_row(k, *row);
        return *row;
      }
    }
    std::optional<tbb::global_control> limit;
    if (const int threads = job.study.options.threads; threads > 0)
      limit.emplace(tbb::global_control::max_allowed_parallelism,
                    static_cast<std::size_t>(threads));
    Row row;
    Result<void> loaded = load(job.study, progress.portion(0, 0.04));
    if (loaded) loaded = read_field(job, progress.portion(0.04, 0.05));
    if (loaded) tell_parts(parts_, job.study, console_);
    Result<Made> made = loaded ? make_mesh(job, parts_, progress.portion(0.05, 1), console_)
                               : Result<Made>(loaded.error());
    if (!made) {
      row.status = console_.fail(made.error());
      tell_row(k, row);
      return row;
    }
    const IterationRecord& r = made->report.final_record;
    row = {dump(r.nodes),     dump(r.elements),    dump(r.layers.mean),
           dump(r.layers.p5), dump(r.quality_min), dump(made->outcome.seconds)};
    if (const std::optional<Error> verdict = verdict_on(*made, c_.min_quality))
      row.status = console_.fail(*verdict);
    tell_row(k, row);
    return row;
  }

  /// What a run before has left of this job, if that is all of it.
  std::optional<Row> finished(const Job& job) const {
    std::error_code ec;
    std::string report;
    for (const std::string& output : job.outputs) {
      if (!fs::exists(output, ec)) return {};
      if (!is_project(output)) continue;
      const Result<Project> project = open_project_head(output);
      if (!project || !project->mesh_study) return {};
      if (mesh_key(*project->mesh_study) != mesh_key(job.study)) return {};
      report = project->report_json;
    }
    if (!job.report.empty()) {
      const Result<std::string> beside = read_file(job.report + ".json");
      if (!beside) return {};
      report = *beside;
    }
    return row_of(report, job.study, c_.min_quality);
  }

  void tell_combination(std::size_t k, const Job& job) const {
    if (settings_.empty()) return;
    std::string text;
    Json values = Json::object();
    for (std::size_t s = 0; s < settings_.size(); ++s) {
      const std::string& value = combinations_[k][s];
      text += (s == 0 ? "" : ", ") + settings_[s].path + " = " + value;
      values[settings_[s].path] = value;
    }
    console_.say("[" + std::to_string(k + 1) + "/" + std::to_string(combinations_.size()) + "] " +
                 text);
    console_.emit(dump({{"phase", "combination"},
                        {"combination", k + 1},
                        {"of", combinations_.size()},
                        {"settings", values},
                        {"outputs", job.outputs}}));
  }

  void tell_row(std::size_t k, const Row& row) const {
    Json json = {{"phase", "row"}, {"combination", k + 1}, {"status", row.status}};
    const auto number = [&](const char* name, const std::string& text) {
      if (!text.empty()) json[name] = Json::parse(text);
    };
    number("nodes", row.nodes);
    number("elements", row.elements);
    number("layers_mean", row.layers_mean);
    number("layers_p5", row.layers_p5);
    number("quality_min", row.quality_min);
    number("seconds", row.seconds);
    console_.emit(dump(json));
  }

  Result<void> write_table(std::size_t first, const std::vector<Row>& rows) const {
    std::string text = "combination";
    for (const Setting& setting : settings_) text += "," + quoted(setting.path);
    text += ",nodes,elements,layers_mean,layers_p5,quality_min,seconds,status,file\n";
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Row& row = rows[r];
      const std::size_t k = first + r;
      text += std::to_string(k + 1);
      for (const std::string& value : combinations_[k]) text += "," + quoted(value);
      for (const std::string& value :
           {row.nodes, row.elements, row.layers_mean, row.layers_p5, row.quality_min, row.seconds,
            std::to_string(row.status),
            combinations_.size() > 1 ? numbered(outputs_.front(), k + 1) : outputs_.front()})
        text += "," + quoted(value);
      text += "\n";
    }
    if (Result<void> written = write_file(table_, text); !written) return written;
    console_.say("table " + table_);
    console_.emit(dump({{"phase", "written"}, {"file", table_}, {"format", "table"}}));
    return {};
  }

  const RunCommand& c_;
  const std::string line_;
  Console& console_;
  const Progress progress_;
  Project project_;
  std::vector<Setting> settings_;
  std::vector<Combination> combinations_;
  std::vector<std::string> outputs_;
  std::string table_;
  std::vector<Part> parts_;
  std::optional<LoadParams> loaded_;
  std::vector<std::string> left_out_;  // of the parts
};

}  // namespace

int run_study(const RunCommand& c, const std::string& line, Console& console) {
  return StudyRun(c, line, console).run();
}

}  // namespace lamella::cli
