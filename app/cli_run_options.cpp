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

void add_case(CLI::App* e, CaseCommand& made) {
  const std::vector<std::string> names = {"polycrystal", "inclusions", "fibers", "two-balls",
                                          "tilted-plate"};
  e->add_option("NAME", made.name, "polycrystal, inclusions, fibers, two-balls or tilted-plate")
      ->option_text(" ")
      ->required()
      ->check(CLI::IsMember(names));
  e->add_option("-o,--output", made.output, "Study to write, or its folder [NAME.json]")
      ->option_text("FILE");
  e->add_option("-n,--layers", made.layers, "Elements through the thickness of each zone [4]")
      ->option_text("N")
      ->check(CLI::Range(1, 1000));
  e->add_option("--seed", made.seed, "Another seed gives another microstructure [1]")
      ->option_text("N");
  const auto number = [e](const char* name, auto& value, const char* text, const char* what) {
    return e->add_option(name, value, what)->option_text(text);
  };
  number("--grains", made.grains, "N", "Polycrystal: grains [50]")->check(CLI::Range(1, 100000));
  number("--relaxations", made.relaxations, "N",
         "Polycrystal: steps towards grains of equal size (Lloyd) [0]")
      ->check(CLI::Range(0, 1000));
  number("--count", made.count, "N", "Inclusions, fibers: their number, instead of a fraction")
      ->check(CLI::Range(1, 1000000));
  number("--fraction", made.fraction, "X",
         "Inclusions, fibers: their share of the volume [0.1, fibers 0.03]")
      ->check(CLI::Range(0.0, 1.0))
      ->excludes("--count");
  number("--radius", made.radius, "X,..",
         "Inclusions: radius, or the least and the largest, mm [1]; fibers: radius [0.2]")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  number("--gap", made.gap, "X",
         "Inclusions, fibers: least distance to each other and to the walls, mm [0.1]")
      ->check(CLI::NonNegativeNumber);
  number("--length", made.length, "X", "Fibers: length, mm [3]")->check(CLI::PositiveNumber);
  number("--orientation", made.orientation, "A,B,C",
         "Fibers: diagonal of the orientation tensor, sum 1 [alike in all directions]")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 1.0));
  number("--size", made.size, "X,Y,Z",
         "Inclusions, fibers: edges of the domain, mm [10,10,10]; polycrystal: a box instead of a "
         "cylinder of radius 5 and length 10")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  number("--angle", made.angle, "X", "Tilted plate: angle of its normal to the x axis [0.61]");
}

}  // namespace lamella::cli
