#pragma once

#include <cstdint>
#include <filesystem>

#include "core/io/export_certificate.h"
#include "core/mesh/fitness.h"
#include "core/mesh/validate.h"
#include "core/study/report_pictures.h"
#include "core/study/run.h"
#include "core/study/svg_plot.h"

namespace lamella {

/// A file that went in, named by its content.
struct InputFile {
  std::string path;
  std::uintmax_t bytes = 0;
  std::string sha256;
};

/// Errors: io.
Result<InputFile> describe_input(const std::filesystem::path& file);

/// The inputs of a study whose hashes are known, as reports and meshes name them.
std::vector<InputFile> inputs_of(const Study& study);

/// What a report tells besides the outcome itself.
struct ReportContext {
  std::vector<InputFile> inputs;
  std::vector<ExportCertificate> exports;
  std::string command;  ///< how to reproduce the mesh
};

/// Everything a report says, measured on the mesh of the outcome.
struct Report {
  Study study;
  Outcome outcome;
  ReportContext context;
  MeshReport validity;
  IterationRecord final_record;  ///< of the mesh that was kept
  Fitness fitness;
  Histogram quality{0, 1, 25};
  Histogram layers{0, 1, 1};  ///< of the nodes where layers were measured
  std::optional<ReportPicture> layers_map;
  std::vector<ReportPicture> sections;
};

/// What solvers ask of the mesh, judged.
std::vector<FitnessLine> fitness_lines(const Report& report);

/// Errors: cancelled.
Result<Report> build_report(const Study& study, const Outcome& outcome,
                            const ReportContext& context, const Progress& progress = {});

/// The report for programs.
std::string report_json(const Report& report);
/// What `report_json` tells of the run, without its mesh. Error: bad_input.
Result<Outcome> outcome_from_json(const std::string& report);
/// The report for people: one page of HTML that needs no other file.
std::string report_html(const Report& report);

/// Writes STEM.json and STEM.html. Errors: io.
Result<void> write_report(const Report& report, const std::filesystem::path& stem);

/// Where a mesh comes from, as one JSON object for the files it is written to: version, what was
/// asked of each body, kinds of the groups, hashes of the inputs.
std::string provenance_json(const Study& study, const SimplexMesh<3>& mesh,
                            const std::vector<InputFile>& inputs);

/// One line of JSON, without line end.
std::string record_json(const IterationRecord& record);

}  // namespace lamella
