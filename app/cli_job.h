#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/cli_console.h"
#include "app/services.h"
#include "core/study/report.h"

namespace lamella::cli {

/// One mesh of one study: what `mesh` and `run` share.
struct Job {
  Study study;
  MesherChoice mesher = MesherChoice::automatic;
  std::vector<std::string> outputs;  ///< meshes, and projects by their ending .lamella
  std::string report;                ///< stem of the report; empty: in the projects alone
  std::string command;               ///< how to reproduce it
  std::vector<InputFile> inputs;     ///< as `inputs_of` tells them
  std::map<std::string, std::filesystem::path> copies;  ///< of inputs, for projects
  std::shared_ptr<const SolverField> field;             ///< that the study names; null: none
};

struct Made {
  Outcome outcome;
  Report report;
};

/// Whether a mesh can be written there. Error: usage.
Result<void> check_output(const std::string& output);
/// Where the report of a mesh file is, without its ending.
std::string report_stem(const std::string& output);

void tell_notes(const std::vector<std::string>& notes, Console& console);
void tell_parts(const std::vector<Part>& parts, const Study& study, Console& console);

/// Reads the field of another solver that the study of the job names, if it names one.
/// Errors: bad_input, usage.
Result<void> read_field(Job& job, const Progress& progress);

/// Runs the study, writes the mesh and its report, and tells of all of it. After a cancel the best
/// mesh is written all the same. Errors: those of run, export_mesh and save_project.
Result<Made> make_mesh(const Job& job, const std::vector<Part>& parts, const Progress& progress,
                       Console& console);

/// What keeps it from being a full success: cancelled, poor quality, not converged.
std::optional<Error> verdict_on(const Made& made, const std::optional<double>& min_quality);

}  // namespace lamella::cli
