#include "app/cli_options.h"

#include <CLI/CLI.hpp>
#include <map>

#include "app/cli_completion.h"
#include "app/cli_manual.h"
#include "app/cli_run_options.h"
#include "core/base/version.h"
#include "core/cad/sample_parts.h"
#include "core/metric/analytic.h"

namespace lamella::cli {

namespace {

const std::map<std::string, double> kUnits = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"inch", 25.4}};

/// Endings of the formats, with their names.
std::string format_endings() {
  std::string text;
  for (const MeshFormat& format : mesh_formats().all())
    text += (text.empty() ? "" : ", ") + format.endings.front() + " (" + format.title + ")";
  return text;
}

const char* const kFooter = R"(
Lengths are in mm, angles in radians. Exit status: 0 done, 1 error, 2 usage, 3 bad input,
4 not converged (the mesh is written), 5 quality below the limit asked, 6 memory limit,
130 cancelled (Ctrl-C; `mesh`, `run` and `adapt` write what they have).

Examples:
  lamella-cli sample t_junction -o t.step
  lamella-cli mesh t.step -n 4 -o t.msh -o t.vtu
  lamella-cli run t.study.json --set body.n=2,4,8 -o t.lamella
  lamella-cli mesh t.step --size-sphere 0,0,0,2,0.3 --forecast
  lamella-cli check t.msh --layers 4
  lamella-cli export t.msh t.inp
  lamella-cli adapt cube.mesh --metric polar-2 --iterations 5 -o adapted.mesh
  lamella-cli box --dimension 4 --cells 4,4,4,8 --high 1,1,1,2 -o spacetime.mesh
  lamella-cli slice spacetime.mesh --times 0.5,1,1.5 -o at.vtu
  lamella-cli flow t.msh --gate in=20 --vent out -o flow.vtu
)";

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

template <class Text>
void add_unit(CLI::App* app, Text& unit) {
  app->add_option("--unit", unit,
                  "Length unit of STL files, which name none: mm, cm, m or inch [mm]")
      ->option_text("UNIT")
      ->check(CLI::IsMember({"mm", "cm", "m", "inch"}));
}

void add_repair(CLI::App* app, std::string& repair, std::optional<double>& spacing) {
  app->add_option("--repair", repair,
                  "Broken surfaces: none is changed (none), small named repairs and a wrap where "
                  "they do not do (auto), or a wrap of every body (wrap) [auto]")
      ->option_text("NAME")
      ->check(CLI::IsMember({"none", "auto", "wrap"}));
  app->add_option("--wrap-spacing", spacing,
                  "Grid of a wrap, mm [1/160 of the diagonal, finer where walls would be lost]")
      ->option_text("X")
      ->check(CLI::PositiveNumber);
}

void add_cad(CLI::App* app, CadOptions& cad) {
  app->add_option("--cad-timeout", cad.seconds, "Time that reading a CAD file may take, s [600]")
      ->option_text("S")
      ->check(CLI::PositiveNumber);
  app->add_option("--cad-memory", cad.memory,
                  "Memory that reading a CAD file may take, MB [3/4 of the machine's]")
      ->option_text("MB")
      ->check(CLI::PositiveNumber);
}

void add_mesher(CLI::App* app, std::string& mesher) {
  app->add_option(
         "--mesher", mesher,
         "First mesh by algorithm 2.1 (topological), Netgen, or the first that succeeds [auto]")
      ->option_text("NAME")
      ->check(CLI::IsMember({"auto", "topological", "netgen"}));
}

template <class Value>
void add_chord(CLI::App* app, Value& value) {
  app->add_option("--chord-tolerance", value,
                  "Largest distance of the boundary to the part, mm [1/1000 of the diagonal]")
      ->option_text("X")
      ->check(CLI::PositiveNumber);
}

template <class Value>
void add_threads(CLI::App* app, Value& threads) {
  app->add_option("--threads", threads, "Threads; the result does not depend on it [all cores]")
      ->option_text("N")
      ->check(CLI::Range(0, 4096));
}

void add_memory(CLI::App* app, std::optional<double>& memory, const char* what) {
  app->add_option("--memory", memory, what)->option_text("MB")->check(CLI::PositiveNumber);
}

void add_json(CLI::App* app, bool& json) {
  app->add_flag("--json", json, "One JSON object a line on standard output");
}

void add_conditioning(CLI::App* a, AdaptCommand& adapt) {
  a->add_option("--h-min", adapt.h_min, "Smallest size, mm [no bound]")
      ->option_text("X")
      ->check(CLI::PositiveNumber);
  a->add_option("--h-max", adapt.h_max, "Largest size, mm [no bound]")
      ->option_text("X")
      ->check(CLI::PositiveNumber);
  a->add_option("--max-anisotropy", adapt.max_anisotropy,
                "Largest over smallest size at a node; large sizes shrink [no bound]")
      ->option_text("X")
      ->check(CLI::Range(1.0, 1e300));
  auto* gradation = a->add_option("--gradation", adapt.gradation,
                                  "Growth of sizes per unit length, above 1 [no bound]")
                        ->option_text("X")
                        ->check(CLI::PositiveNumber);
  a->add_option("--gradation-kind", adapt.gradation_kind,
                "The metric of a neighbor, grown, is intersected (intersection), or the metric is "
                "scaled (isotropic) [intersection]")
      ->option_text("NAME")
      ->check(CLI::IsMember({"isotropic", "intersection"}))
      ->needs(gradation);
  a->add_option("--elements", adapt.elements,
                "Scale the metric until it asks for so many elements, after all bounds")
      ->option_text("N")
      ->check(CLI::PositiveNumber);
}

void add_adapt(CLI::App* a, AdaptCommand& adapt) {
  a->add_option("MESH", adapt.mesh, "Medit .mesh (2D, 3D or 4D), or a mesh that export reads")
      ->option_text(" ")
      ->required();
  a->add_option("-o,--output", adapt.output, "File to write; a .mesh gets its metric as .sol")
      ->option_text("FILE")
      ->required();
  auto* sol = a->add_option("--sol", adapt.sol, "Metric or size at the nodes (Medit .sol)")
                  ->option_text("FILE");
  auto* metric =
      a->add_option("--metric", adapt.metric,
                    "Analytic metric NAME or NAME:key=value,..: " + joined(metric_names()))
          ->option_text("NAME");
  sol->excludes(metric);
  a->add_option("--field", adapt.field,
                "Field of MESH (.vtu, .msh) to adapt to: tensors are a metric, numbers a size in "
                "mm, at nodes or in elements [its metric, or its only tensors]")
      ->option_text("NAME")
      ->excludes(metric)
      ->excludes(sol);
  a->add_flag("--background,!--no-background", adapt.background,
              "Keep the metric of a file on the first mesh and look it up there, or carry it from "
              "node to node, which blurs it [--background]")
      ->excludes(metric);
  const auto means = CLI::IsMember({"m", "root", "size", "log", "h"});
  a->add_option(
       "--mean", adapt.mean,
       "What is averaged where a metric is carried to a new place: M (m), its root (root), "
       "M^(-1/2) (size), log M (log) or the smallest size (h) [size]")
      ->option_text("NAME")
      ->check(means);
  a->add_option("--element-mean", adapt.element_mean, "The same for the metric of an element [m]")
      ->option_text("NAME")
      ->check(means);
  a->add_option("--size-average", adapt.size_average,
                "Size of an element from its edges: root of the mean square (l2) or mean (l1) [l2]")
      ->option_text("NAME")
      ->check(CLI::IsMember({"l2", "l1"}));
  add_conditioning(a, adapt);
  a->add_option("--freeze-group", adapt.freeze_groups,
                "Leave the faces of this boundary group as they are; may be repeated")
      ->option_text("NAME")
      ->allow_extra_args(false);
  a->add_option("--freeze-body", adapt.freeze_bodies,
                "Leave the elements of this body as they are; may be repeated")
      ->option_text("NAME")
      ->allow_extra_args(false);
  a->add_flag("--split-blocking", adapt.split_blocking,
              "Open faces and edges inside whose nodes are all on the boundary");
  a->add_option("--iterations", adapt.iterations, "Adaptions [3]")
      ->option_text("N")
      ->check(CLI::Range(1, 1000));
  a->add_option("--sweeps", adapt.sweeps, "Sweeps of one adaption at most [24]")
      ->option_text("N")
      ->check(CLI::Range(1, 1000));
  add_chord(a, adapt.chord_tolerance);
  add_threads(a, adapt.threads);
  add_memory(a, adapt.memory,
             "Memory the adaption may take, MB; status 6 when more is needed [no limit]");
  a->add_option("--seed", adapt.seed, "Another seed gives another, equally good mesh [1]")
      ->option_text("N");
  add_json(a, adapt.json);
}

void add_flow(CLI::App* f, FlowCommand& flow) {
  const auto several = [f](const char* name, std::vector<std::string>& texts, const char* form,
                           const char* what) {
    f->add_option(name, texts, what)->option_text(form)->allow_extra_args(false);
  };
  const auto number = [f](const char* name, auto& value, const char* text, const char* what) {
    return f->add_option(name, value, what)->option_text(text)->check(CLI::PositiveNumber);
  };
  f->add_option("MESH", flow.mesh, "Medit .mesh (2D or 3D), .msh or .vtu")
      ->option_text(" ")
      ->required();
  several(
      "--gate", flow.gates, "GROUP[=P]",
      "Boundary group where the fluid enters, at a pressure in MPa [1]; may be repeated, as the "
      "next three");
  several("--gate-rate", flow.rates, "GROUP=Q",
          "The same with the rate that enters, mm3/s (in 2D mm2/s), in place of the pressure");
  several("--vent", flow.vents, "GROUP", "Group where it leaves, at the pressure 0");
  several("--symmetry", flow.symmetries, "GROUP",
          "Planes of symmetry; all other groups are walls that the fluid sticks to");
  number("--viscosity", flow.viscosity, "ETA", "MPa s [1]");
  f->add_option("--body", flow.body, "Solve in this body alone [all of the mesh]")
      ->option_text("NAME");
  f->add_option("--tolerance", flow.tolerance, "Residual to reach, relative to the first [1e-8]")
      ->option_text("X")
      ->check(CLI::Range(1e-14, 0.5));
  f->add_option("-o,--output", flow.output, "VTU file to write, with all fields")
      ->option_text("FILE");
  auto* correct =
      f->add_option(
           "--correct", flow.correct,
           "Correct the metric of the mesh: by the gradient of the acceleration or of the velocity "
           "(acceleration, velocity), by the strain rate (strain), by the velocity and its "
           "curvature (combined), or by the change of direction or the residual smoothed over the "
           "elements (direction, residual, directional). Of a solver's result, without a gate: by "
           "the gradient of any field (field:NAME), by an indicator to smooth (indicator:NAME), or "
           "by a velocity (acceleration:NAME, strain:NAME, combined:NAME, direction:NAME)")
          ->option_text("METHOD");
  auto* field =
      f->add_option("--field", flow.field_file,
                    "Result of a solver that has it, on any mesh: .vtu, .vtk, .msh, .. [the "
                    "mesh itself]")
          ->option_text("FILE")
          ->needs(correct);
  f->add_option("--field-unit", flow.field_unit, "Its unit of length: mm, cm, m or inch [mm]")
      ->option_text("UNIT")
      ->check(CLI::IsMember({"mm", "cm", "m", "inch"}))
      ->needs(field);
  number("--strength", flow.strength, "MU",
         "Of the gradient term: times the mu that lets it dominate the metric [1]")
      ->needs(correct);
  number("--beta", flow.beta, "B",
         "Of a smoothed indicator: factor of the mean error; below 1 refines [1]")
      ->needs(correct);
  number(
      "--elements", flow.elements, "N",
      "Elements that the corrected metric may ask for; of a smoothed indicator, that it asks for")
      ->needs(correct);
  number("--h-min", flow.h_min, "X", "Smallest size of the correction, mm [no bound]")
      ->needs(correct);
  f->add_option("--sol", flow.sol,
                "Metric to correct (Medit .sol) [that of the file, or what the elements are]")
      ->option_text("FILE")
      ->needs(correct);
  auto* out = f->add_option("--correct-out", flow.correct_out, "Medit .sol to write it to")
                  ->option_text("FILE")
                  ->needs(correct);
  correct->needs(out);
  add_threads(f, flow.threads);
  add_memory(f, flow.memory,
             "Memory that it may take, MB; status 6 when more is needed [no limit]");
  add_json(f, flow.json);
}

void add_sizing(CLI::App* m, MeshCommand& mesh) {
  const auto add = [m](const char* name, std::vector<std::string>& texts, const char* form,
                       const char* what) {
    m->add_option(name, texts, what)->option_text(form)->allow_extra_args(false);
  };
  add("--size-sphere", mesh.size_spheres, "X,Y,Z,R,SIZE",
      "Size in a sphere: center, radius, and the size in mm or, as 0.3x, times the natural one; "
      "may be repeated, as the next three");
  add("--size-box", mesh.size_boxes, "X,Y,Z,X,Y,Z,SIZE", "Size in a box between two corners");
  add("--size-cylinder", mesh.size_cylinders, "X,Y,Z,X,Y,Z,R,SIZE",
      "Size in a cylinder: centers of its ends, radius");
  add("--size-face", mesh.size_faces, "BODY:FACE,SIZE",
      "Size on a face, by number or name (info --faces lists them)");
  m->add_option("--size-gradation", mesh.size_gradation,
                "Growth of sizes per unit length around them, above 1 [1.3]")
      ->option_text("X")
      ->check(CLI::PositiveNumber);
  m->add_flag("--size-keep-directions", mesh.size_keep_directions,
              "Scale the natural metric there, its smallest size to SIZE, instead of making it "
              "isotropic");
}

void add_export(CLI::App* x, ExportCommand& exported) {
  std::string names;
  for (const MeshFormat& format : mesh_formats().all())
    names += (names.empty() ? "" : ", ") + format.name;
  x->add_option("IN", exported.mesh, "A mesh of tetrahedra in any of the formats but STL")
      ->option_text(" ")
      ->required();
  x->add_option("OUT", exported.output, "File to write: " + format_endings())
      ->option_text(" ")
      ->required();
  x->add_option("--format", exported.format, names + " [by the ending of OUT]")
      ->option_text("NAME");
  x->add_option("--unit", exported.unit,
                "Unit of the lengths in OUT: mm or m; OpenFOAM is always in m [mm]")
      ->option_text("UNIT")
      ->check(CLI::IsMember({"mm", "m"}));
  add_json(x, exported.json);
}

void add_boundary_layers(CLI::App* m, MeshCommand& mesh) {
  m->add_option("--boundary-layer", mesh.boundary_layers,
                "Boundary layer of a thickness, mm, with N elements across: THICKNESS,N for all "
                "walls, THICKNESS,N,BODY:FACE,.. for faces by number or name, and "
                "THICKNESS,N,BODY:-FACE,.. for all but these; may be repeated")
      ->option_text("TEXT")
      ->allow_extra_args(false);
}

void add_groups(CLI::App* m, MeshCommand& mesh) {
  m->add_option("--group", mesh.groups,
                "Boundary group of faces: NAME=BODY:FACE,.. by number or name (info --faces lists "
                "them), or NAME=BODY:X,Y,Z~ANGLE for what can be reached from a point without "
                "turning by more than ANGLE at an edge; may be repeated")
      ->option_text("TEXT")
      ->allow_extra_args(false);
}

void add_flow_of_loop(CLI::App* m, MeshCommand& mesh) {
  const auto several = [m](const char* name, std::vector<std::string>& texts, const char* form,
                           const char* what) {
    return m->add_option(name, texts, what)->option_text(form)->allow_extra_args(false);
  };
  several("--gate", mesh.gates, "GROUP[=P]",
          "Boundary group of --group where a fluid enters, at a pressure in MPa [1]; may be "
          "repeated, as the next three");
  several("--gate-rate", mesh.rates, "GROUP=Q", "The same with the rate that enters, mm3/s");
  several("--vent", mesh.vents, "GROUP", "Group where it leaves, at the pressure 0");
  several("--symmetry", mesh.symmetries, "GROUP", "Planes of symmetry of the flow");
  m->add_option(
       "--flow", mesh.flow,
       "Solve a Stokes flow through the mesh that has settled, and correct it by the flow: "
       "where its acceleration or its velocity changes (acceleration, velocity), by the "
       "strain rate (strain), or by the change of direction or the residual made even "
       "over the elements (direction, residual, directional); with --flow-field by a field of "
       "another solver instead, as field:NAME (its gradient), indicator:NAME (made even), or of a "
       "velocity acceleration:NAME, strain:NAME, combined:NAME, direction:NAME")
      ->option_text("METHOD");
  auto* field = m->add_option("--flow-field", mesh.flow_field,
                              "Result of another solver that has the field, on any mesh of the "
                              "bodies: .vtu, .vtk, .msh, ..")
                    ->option_text("FILE");
  m->add_option("--flow-field-unit", mesh.flow_field_unit,
                "Its unit of length: mm, cm, m or inch [mm]")
      ->option_text("UNIT")
      ->check(CLI::IsMember({"mm", "cm", "m", "inch"}))
      ->needs(field);
  m->add_option("--flow-rounds", mesh.flow_rounds,
                "Rounds of flow and correction; 0 solves the flow alone [1]")
      ->option_text("N")
      ->check(CLI::Range(0, 100));
  const auto number = [m](const char* name, std::optional<double>& value, const char* text,
                          const char* what) {
    m->add_option(name, value, what)->option_text(text)->check(CLI::PositiveNumber);
  };
  number("--flow-strength", mesh.flow_strength, "MU",
         "Of acceleration, velocity, strain, combined and field: times the mu that lets them "
         "dominate the metric [1]");
  number(
      "--flow-beta", mesh.flow_beta, "B",
      "Of direction, the residuals and indicator: factor of the mean error; below 1 refines [1]");
  number("--flow-growth", mesh.flow_growth, "X",
         "Elements that the correction may ask for, over those without it, above 1 [1.5]");
  number("--flow-h-min", mesh.flow_h_min, "X", "Smallest size of the correction, mm [no bound]");
  several("--flow-body", mesh.flow_bodies, "NAME",
          "Body that the flow corrects [all with a gate]; may be repeated");
}

void add_domain(CLI::App* m, MeshCommand& mesh) {
  m->add_option("--domain", mesh.domain,
                "One mesh of all bodies, in this domain: bodies (their union), margin[=SHARE] (a "
                "box around them, grown by a share of its diagonal), body=NAME (one of them, the "
                "others lie in it), box=X,Y,Z,X,Y,Z or cylinder=X,Y,Z,X,Y,Z,R [a mesh a body]")
      ->option_text("TEXT");
  m->add_option("--interfaces", mesh.interfaces,
                "Borders between bodies in one mesh: on its faces (exact), or inside of thin "
                "elements that bodies fill in part (fuzzy) [exact]")
      ->option_text("NAME")
      ->check(CLI::IsMember({"exact", "fuzzy"}));
  m->add_option("--interface-size", mesh.interface_size,
                "Size across borders, mm [fuzzy: a quarter of the layer there; exact: the natural "
                "size]")
      ->option_text("X")
      ->check(CLI::PositiveNumber);
  m->add_option("--drop", mesh.drop,
                "Body of an exact mesh that is not handed out, or \"background\"; may be repeated")
      ->option_text("NAME")
      ->allow_extra_args(false);
  m->add_option("--capture", mesh.capture,
                "What draws the mesh together at fuzzy borders: their distance, or the gradient of "
                "the filling ratio [distance]")
      ->option_text("NAME")
      ->check(CLI::IsMember({"distance", "gradient"}));
}

}  // namespace

double unit_factor(const std::string& unit) { return kUnits.at(unit); }

LoadParams load_params(const std::string& repair, const std::optional<double>& wrap_spacing,
                       const CadOptions& cad) {
  LoadParams load;
  load.repair = repair == "none"   ? Repair::none
                : repair == "wrap" ? Repair::wrap
                                   : Repair::automatic;
  load.wrap_spacing = wrap_spacing;
  if (cad.seconds) load.cad_seconds = *cad.seconds;
  load.cad_memory = cad.memory;
  return load;
}

MesherChoice mesher_choice(const std::string& name) {
  if (name == "topological") return MesherChoice::topological;
  if (name == "netgen") return MesherChoice::netgen;
  return MesherChoice::automatic;
}

std::optional<Command> parse(int argc, char** argv, int& status) {
  CLI::App app(
      "Anisotropic tetrahedral meshes for injection molding: n element layers through every wall.",
      "lamella-cli");
  app.set_version_flag("--version", "Lamella " + version());
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);

  MeshCommand mesh;
  CLI::App* m = app.add_subcommand("mesh", "Mesh parts with n layers through their walls");
  m->footer(
      "Ctrl-C writes the best mesh so far and ends with status 130. Sizes of --size-* are never "
      "coarser than the natural metric; a study can ask for more.");
  m->add_option("PART", mesh.inputs,
                "STEP, IGES, BREP or STL files, meshes whose bodies are taken, or one study "
                "(.lamella or .json)")
      ->option_text("...")
      ->required();
  m->add_option("-o,--output", mesh.outputs,
                "File to write: " + format_endings() + ", .lamella (project); may be repeated")
      ->option_text("FILE")
      ->allow_extra_args(false);
  m->add_flag("--forecast", mesh.forecast,
              "Tell the nodes and the memory to expect, and mesh nothing; needs no -o");
  m->add_option("-n,--layers", mesh.layers, "Elements through the thickness of each wall [4]")
      ->option_text("N")
      ->check(CLI::Range(1, 1000));
  m->add_option("--alpha", mesh.alpha,
                "Sizes up to (1 + alpha) times the smallest are divided by n too [1]")
      ->option_text("X")
      ->check(CLI::NonNegativeNumber);
  m->add_option("--layers2", mesh.layers2,
                "Elements through the width of walls: of sizes up to (1 + alpha + alpha2) times "
                "the smallest; needs --alpha2")
      ->option_text("N")
      ->check(CLI::Range(1, 1000));
  m->add_option("--alpha2", mesh.alpha2, "See --layers2")
      ->option_text("X")
      ->check(CLI::PositiveNumber);
  m->add_option("--layers3", mesh.layers3, "Elements along all longer directions [not divided]")
      ->option_text("N")
      ->check(CLI::Range(1, 1000));
  m->add_flag("--progressive", mesh.progressive,
              "Ask for 2, 3, .. n layers in the first iterations, which lowers the peak of memory");
  add_memory(m, mesh.memory,
             "Memory an adaption may take, MB; status 6 when more is needed [no limit]");
  m->add_option("--h-min", mesh.h_min, "Smallest size, mm [1/1000 of the body's diagonal]")
      ->option_text("X")
      ->check(CLI::PositiveNumber);
  m->add_option("--h-max", mesh.h_max, "Largest size, mm [no bound]")
      ->option_text("X")
      ->check(CLI::PositiveNumber);
  m->add_option("--max-anisotropy", mesh.max_anisotropy,
                "Longest over shortest size of an element across a wall [no bound]")
      ->option_text("X")
      ->check(CLI::Range(1.0, 1e300));
  add_chord(m, mesh.chord_tolerance);
  m->add_option("--angle-tolerance", mesh.angle_tolerance,
                "Largest angle between neighbors of the tessellation [0.35]")
      ->option_text("X")
      ->check(CLI::PositiveNumber);
  m->add_option("--iterations", mesh.iterations, "Adaptions at most [6]")
      ->option_text("N")
      ->check(CLI::Range(1, 1000));
  add_threads(m, mesh.threads);
  m->add_option("--seed", mesh.seed, "Another seed gives another, equally good mesh [1]")
      ->option_text("N");
  m->add_option("--min-quality", mesh.min_quality, "End with status 5 when an element is worse")
      ->option_text("X")
      ->check(CLI::Range(0.0, 1.0));
  add_sizing(m, mesh);
  add_boundary_layers(m, mesh);
  add_groups(m, mesh);
  add_flow_of_loop(m, mesh);
  add_unit(m, mesh.unit);
  add_repair(m, mesh.repair, mesh.wrap_spacing);
  add_cad(m, mesh.cad);
  add_mesher(m, mesh.mesher);
  m->add_option("--detector", mesh.detector,
                "Who finds the thickness of walls: rays and balls inside the part (geometric), or "
                "neighborhoods grown in the mesh (neighborhood) [geometric]")
      ->option_text("NAME")
      ->check(CLI::IsMember({"geometric", "neighborhood"}));
  add_domain(m, mesh);
  m->add_option("--report", mesh.report, "Stem of the report: STEM.json and STEM.html [OUT.report]")
      ->option_text("STEM");
  add_json(m, mesh.json);

  RunCommand run;
  CLI::App* r = app.add_subcommand("run", "Run a study as the window does, or a sweep of settings");
  r->footer(
      "The mesh is the one that the window makes of it, byte for byte. Without -o the mesh and its "
      "report go into the project; a study as text gets one beside it. Of a sweep the last --set "
      "changes fastest, and a mesh that fails does not keep the others from being made.");
  add_run(r, run);

  AdaptCommand adapt;
  CLI::App* a = app.add_subcommand("adapt", "Adapt a mesh to a metric, in 2D, 3D or 4D");
  a->footer("Ctrl-C writes the mesh as far as it got and ends with status 130.");
  add_adapt(a, adapt);

  GenerateCommand generate;
  CLI::App* g = app.add_subcommand("generate", "Fill a closed surface with tetrahedra");
  g->add_option("SURFACE", generate.surface, "STEP, IGES, BREP or STL file")
      ->option_text(" ")
      ->required();
  g->add_option("-o,--output", generate.output, "File to write, as for mesh")
      ->option_text("FILE")
      ->required();
  add_chord(g, generate.chord_tolerance);
  add_unit(g, generate.unit);
  add_repair(g, generate.repair, generate.wrap_spacing);
  add_cad(g, generate.cad);
  add_mesher(g, generate.mesher);
  add_threads(g, generate.threads);
  add_memory(g, generate.memory,
             "Memory that a body may take, MB; status 6 when more is needed [no limit]");
  g->add_option("--seed", generate.seed, "Another seed gives another, equally good mesh [1]")
      ->option_text("N");
  add_json(g, generate.json);

  ExportCommand exported;
  CLI::App* x = app.add_subcommand("export", "Write a mesh in another format");
  x->footer(
      "The file is read again and compared. What the format has no place for goes into OUT.json "
      "and "
      "OUT.sol beside it, which belong to the mesh when it is read. Of openfoam, OUT is the folder "
      "of the case, or a .foam in it.");
  add_export(x, exported);

  CheckCommand check;
  CLI::App* c = app.add_subcommand("check", "Validity, quality, conformity and layers of a mesh");
  c->add_option("MESH", check.mesh, "Medit .mesh (2D, 3D or 4D), or a mesh that export reads")
      ->option_text(" ")
      ->required();
  auto* check_sol =
      c->add_option("--sol", check.sol, "Metric at the nodes (Medit .sol)")->option_text("FILE");
  auto* check_metric =
      c->add_option("--metric", check.metric, "Analytic metric, as for adapt")->option_text("NAME");
  check_sol->excludes(check_metric);
  c->add_option("-n,--layers", check.layers, "Measure the layers through the walls, n are asked")
      ->option_text("N")
      ->check(CLI::Range(1, 1000));
  c->add_option("--min-quality", check.min_quality, "End with status 5 when an element is worse")
      ->option_text("X")
      ->check(CLI::Range(0.0, 1.0));
  add_threads(c, check.threads);
  add_json(c, check.json);

  InfoCommand info;
  CLI::App* i = app.add_subcommand("info", "Bodies, size and volume of a part");
  i->footer(
      "The file is diagnosed as it is: open, non-manifold and wrongly wound edges, duplicate and "
      "degenerate facets, facets that cross, thin walls, shells and free faces, with places.");
  i->add_option("PART", info.part, "STEP, IGES, BREP or STL file, or a mesh")
      ->option_text(" ")
      ->required();
  add_chord(i, info.chord_tolerance);
  i->add_flag("--faces", info.faces, "List the faces: number, name, area and a point on them");
  add_unit(i, info.unit);
  add_repair(i, info.repair, info.wrap_spacing);
  add_cad(i, info.cad);
  add_threads(i, info.threads);
  add_json(i, info.json);

  SampleCommand sample;
  CLI::App* s = app.add_subcommand(
      "sample", "Write a part made by code, and a study of it: " + joined(sample_names()));
  s->add_option("NAME", sample.name, "Its name")->option_text(" ")->required();
  s->add_option("-o,--output", sample.output, "STEP, IGES or BREP file to write [NAME.step]")
      ->option_text("FILE");

  CaseCommand made;
  CLI::App* e = app.add_subcommand(
      "case", "Write a study of zones: a microstructure, overlapping balls, a tilted plate");
  add_case(e, made);

  BoxCommand box;
  CLI::App* b = app.add_subcommand("box", "Write a box cut into simplices, to start from");
  b->add_option("--dimension", box.dimension, "2, 3 or 4 [3]")
      ->option_text("D")
      ->check(CLI::Range(2, 4));
  b->add_option("--cells", box.cells, "Cells along every axis, or along each: N,N,..")
      ->option_text("N,..")
      ->required()
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  b->add_option("--low", box.low, "Lowest corner: one value, or one for each axis [0]")
      ->option_text("X,..")
      ->delimiter(',');
  b->add_option("--high", box.high, "Highest corner [1]")->option_text("X,..")->delimiter(',');
  b->add_option("-o,--output", box.output, "File to write: .mesh (Medit); in 3D as for mesh")
      ->option_text("FILE")
      ->required();
  add_json(b, box.json);

  SliceCommand slice;
  CLI::App* l = app.add_subcommand("slice", "Cross-sections of a 4D mesh at given times");
  l->add_option("MESH", slice.mesh, "Medit .mesh (4D; a 3D one is cut at given z)")
      ->option_text(" ")
      ->required();
  l->add_option("--times", slice.times, "Values of the last coordinate: T,T,..")
      ->option_text("T,..")
      ->required()
      ->delimiter(',');
  l->add_option("-o,--output", slice.output,
                "OUT.vtu writes OUT_0000.vtu and so on, and OUT.pvd; other formats as for mesh")
      ->option_text("OUT")
      ->required();
  auto* slice_sol =
      l->add_option("--sol", slice.sol, "Metric at the nodes, cut as well")->option_text("FILE");
  auto* slice_metric =
      l->add_option("--metric", slice.metric, "Analytic metric, as for adapt")->option_text("NAME");
  slice_sol->excludes(slice_metric);
  add_json(l, slice.json);

  FlowCommand flow;
  CLI::App* f = app.add_subcommand(
      "flow", "Stokes flow between gates and vents, and the metric corrected by it");
  add_flow(f, flow);

  std::string shell;
  CLI::App* t = app.add_subcommand("completion", "Print what completes these commands in a shell");
  t->add_option("SHELL", shell, "bash")
      ->option_text(" ")
      ->required()
      ->check(CLI::IsMember({"bash"}));
  CLI::App* u = app.add_subcommand("manual", "Print the manual page of these commands (man -l)");

  app.footer(kFooter);  // after the subcommands, which would repeat it
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    status = app.exit(error) == 0 ? 0 : exit_code(Code::usage);
    return std::nullopt;
  }
  if (m->parsed()) {
    if (mesh.forecast == !mesh.outputs.empty()) {
      std::cerr << "lamella-cli: mesh needs either --output or --forecast.\n";
      status = exit_code(Code::usage);
      return std::nullopt;
    }
    return mesh;
  }
  if (t->parsed()) {
    std::cout << bash_completion(app);
    return std::nullopt;
  }
  if (u->parsed()) {
    std::cout << manual_page(app);
    return std::nullopt;
  }
  if (r->parsed()) return run;
  if (a->parsed()) return adapt;
  if (g->parsed()) return generate;
  if (x->parsed()) return exported;
  if (c->parsed()) return check;
  if (i->parsed()) return info;
  if (e->parsed()) return made;
  if (b->parsed()) return box;
  if (l->parsed()) return slice;
  if (f->parsed()) return flow;
  return sample;
}

}  // namespace lamella::cli
