#include "app/cli_run_options.h"

#include <CLI/CLI.hpp>

namespace lamella::cli {

void add_run(CLI::App* app, RunCommand& run) {
  const auto option = [app](const char* name, auto& value, const char* text, const char* what) {
    return app->add_option(name, value, what)->option_text(text);
  };
  option("STUDY", run.study, " ", "Project (.lamella) or study as text (.json)")->required();
  option("-o,--output", run.outputs, "FILE",
         "Mesh to write, as for mesh, or a .lamella project; may be repeated [STUDY.lamella]")
      ->allow_extra_args(false);
  option("--set", run.set, "PATH=V,..",
         "Change a setting, as options.iterations=3 or bodies.lid.layers=6; body.MEMBER is that of "
         "every body, body.n its layers. Several values sweep: every combination of all --set is "
         "meshed, as FILE-1, FILE-2, ..")
      ->allow_extra_args(false);
  option("--only", run.only, "K", "Mesh the combination K of a sweep alone")
      ->check(CLI::PositiveNumber);
  app->add_flag("--resume", run.resume,
                "Leave out what a run of the same study and settings has finished");
  option("--table", run.table, "FILE",
         "CSV with a line for each combination [of a sweep: FILE.csv]");
  option("--threads", run.threads, "N", "Threads; the mesh does not depend on it [the study's]")
      ->check(CLI::Range(0, 4096));
  option("--memory", run.memory, "MB",
         "Memory an adaption may take, MB; status 6 when more is needed [the study's]")
      ->check(CLI::PositiveNumber);
  option("--seed", run.seed, "N", "Another seed gives another, equally good mesh [the study's]");
  option("--min-quality", run.min_quality, "X", "End with status 5 when an element is worse")
      ->check(CLI::Range(0.0, 1.0));
  app->add_flag("--json", run.json, "One JSON object a line on standard output");
}

}  // namespace lamella::cli
