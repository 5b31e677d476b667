#pragma once

#include "app/cli_console.h"
#include "app/cli_options.h"

namespace lamella::cli {

/// Each runs one subcommand and returns the exit status. `line` is the command line, for the
/// report.
int run_mesh(const MeshCommand& command, const std::string& line, Console& console);
int run_study(const RunCommand& command, const std::string& line, Console& console);
int run_adapt(const AdaptCommand& command, Console& console);
int run_generate(const GenerateCommand& command, Console& console);
int run_export(const ExportCommand& command, Console& console);
int run_check(const CheckCommand& command, Console& console);
int run_info(const InfoCommand& command, Console& console);
int run_sample(const SampleCommand& command, Console& console);
int run_case(const CaseCommand& command, Console& console);
int run_box(const BoxCommand& command, Console& console);
int run_slice(const SliceCommand& command, Console& console);
int run_flow(const FlowCommand& command, Console& console);

}  // namespace lamella::cli
