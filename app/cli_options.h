#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/services.h"

namespace lamella::cli {

/// Limits of reading a STEP file.
struct CadOptions {
  std::optional<double> seconds, memory;  ///< s, MB
};

/// What the command line asks for, one struct a subcommand; unset options keep the study's value.
struct MeshCommand {
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
  std::optional<int> layers, layers2, layers3;
  std::optional<double> alpha, alpha2, h_min, h_max, chord_tolerance, angle_tolerance,
      max_anisotropy;
  std::optional<int> iterations, threads;
  std::optional<std::uint64_t> seed;
  std::optional<double> min_quality;
  std::vector<std::string> size_spheres, size_boxes, size_cylinders, size_faces;
  std::optional<double> size_gradation;
  bool size_keep_directions = false;
  std::vector<std::string> groups;
  bool forecast = false;  ///< tell it, mesh nothing
  bool progressive = false;
  std::optional<double> memory;
  std::optional<std::string> unit;
  std::string repair = "auto";
  std::optional<double> wrap_spacing;
  CadOptions cad;
  std::string mesher = "auto";
  std::optional<std::string> detector;
  std::optional<std::string> domain, interfaces, capture;
  std::optional<double> interface_size;
  std::vector<std::string> drop, boundary_layers;
  std::vector<std::string> gates, rates, vents, symmetries, flow_bodies;
  std::optional<std::string> flow;
  std::string flow_field, flow_field_unit = "mm";
  std::optional<double> flow_strength, flow_beta, flow_growth, flow_h_min;
  std::optional<int> flow_rounds;
  std::string report;
  bool json = false;
};

/// A whole study as the window runs it, or a sweep of its settings.
struct RunCommand {
  std::string study;
  std::vector<std::string> outputs;  ///< none: the project itself
  std::vector<std::string> set;      ///< PATH=VALUE,..
  std::optional<std::size_t> only;   ///< combination, from 1
  bool resume = false;
  std::string table;
  std::optional<int> threads;
  std::optional<double> memory;
  std::optional<std::uint64_t> seed;
  std::optional<double> min_quality;
  bool json = false;
};

struct AdaptCommand {
  std::string mesh, output, sol, metric, field;
  bool background = true;
  std::string mean = "size", element_mean = "m", size_average = "l2";
  std::optional<double> h_min, h_max, max_anisotropy, gradation, elements;
  std::string gradation_kind = "intersection";
  std::vector<std::string> freeze_groups, freeze_bodies;
  bool split_blocking = false;
  int iterations = 3;
  std::optional<int> sweeps, threads;
  std::optional<double> memory;  ///< MB
  std::optional<double> chord_tolerance;
  std::uint64_t seed = 1;
  bool json = false;
};

struct GenerateCommand {
  std::string surface, output;
  std::string unit = "mm";
  std::string repair = "auto";
  std::optional<double> wrap_spacing;
  CadOptions cad;
  std::string mesher = "auto";
  std::optional<double> chord_tolerance;
  std::optional<int> threads;
  std::optional<double> memory;  ///< MB
  std::uint64_t seed = 1;
  bool json = false;
};

struct ExportCommand {
  std::string mesh, output, format;
  std::string unit = "mm";
  bool json = false;
};

struct CheckCommand {
  std::string mesh, sol, metric;
  std::optional<int> layers, threads;
  std::optional<double> min_quality;
  bool json = false;
};

struct InfoCommand {
  std::string part;
  std::string unit = "mm";
  std::string repair = "auto";
  std::optional<double> wrap_spacing;
  CadOptions cad;
  std::optional<double> chord_tolerance;
  bool faces = false;
  std::optional<int> threads;
  bool json = false;
};

struct SampleCommand {
  std::string name, output;
};

/// A study made of zones. Unset options are those of the case, and belong to some of them only.
struct CaseCommand {
  std::string name, output;
  int layers = 4;
  std::uint64_t seed = 1;
  std::optional<int> grains, relaxations, count;
  std::optional<double> fraction, gap, length, angle;
  std::vector<double> radius, orientation, size;
};

/// A box cut into simplices. Cells and corners: one value for all axes, or one for each.
struct BoxCommand {
  int dimension = 3;
  std::vector<int> cells;
  std::vector<double> low{0}, high{1};
  std::string output;
  bool json = false;
};

struct SliceCommand {
  std::string mesh, output, sol, metric;
  std::vector<double> times;
  bool json = false;
};

/// A Stokes flow on a mesh, and the metric corrected by it.
struct FlowCommand {
  std::string mesh, output, sol, body;
  std::vector<std::string> gates;  ///< GROUP or GROUP=PRESSURE
  std::vector<std::string> rates;  ///< GROUP=RATE
  std::vector<std::string> vents, symmetries;
  double viscosity = 1, tolerance = 1e-8;
  std::string correct;  ///< empty: nothing is corrected
  std::string correct_out;
  std::string field_file;  ///< where the field NAME of METHOD:NAME is; empty: the mesh itself
  std::string field_unit = "mm";
  double strength = 1, beta = 1;
  std::optional<double> h_min, elements;
  std::optional<double> memory;  ///< MB
  int threads = 0;
  bool json = false;
};

using Command = std::variant<MeshCommand, RunCommand, AdaptCommand, GenerateCommand, ExportCommand,
                             CheckCommand, InfoCommand, SampleCommand, CaseCommand, BoxCommand,
                             SliceCommand, FlowCommand>;

/// Parses the command line. Help, version and errors of usage are printed here: the exit status is
/// in `status` then, and nothing is returned.
std::optional<Command> parse(int argc, char** argv, int& status);

/// mm per unit of --unit.
double unit_factor(const std::string& unit);
/// The load parameters of these options.
LoadParams load_params(const std::string& repair, const std::optional<double>& wrap_spacing,
                       const CadOptions& cad);
MesherChoice mesher_choice(const std::string& name);

}  // namespace lamella::cli
