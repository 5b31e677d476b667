#pragma once

#include <filesystem>
#include <optional>

#include "core/geometry/soup.h"
#include "core/netgen/netgen_mesher.h"
#include "core/study/run.h"

/// What is promised of layers, case by case; each function makes a table of validation.md.
namespace lamella {

inline constexpr int kCaseLayers = 4;  // n of all cases

/// The main loop with its defaults and n = 4: until it settles, at most `iterations`, or all of
/// them.
inline Result<Outcome> run_case(const std::vector<Part>& parts, int iterations, bool until_settled,
                                const IterationSink& sink = {}) {
  Study study;
  for (const Part& part : parts) {
    study.bodies.push_back({part.name});
    study.bodies.back().layers = kCaseLayers;
  }
  study.options.iterations = iterations;
  study.options.until_settled = until_settled;
  return run(study, parts,
             {std::shared_ptr<const VolumeMesher>(topological_mesher()),
              std::shared_ptr<const VolumeMesher>(netgen_mesher())},
             {}, sink);
}

/// All sizes of the natural metric times `factor`.
inline Study refined(Study study, double factor) {
  SizingObject all;
  all.name = "all";
  SizeCorrection scaled;
  scaled.factor = factor;
  scaled.keep_directions = true;
  all.asks = scaled;
  study.sizing.push_back(all);
  return study;
}

/// A part of flat or finely tessellated faces, all at their exact place.
inline Part part_of(const std::string& name, ReferenceSurface<3> surface) {
  Part part;
  part.name = name;
  part.surface = std::move(surface);
  find_features(part.surface, 0.5);
  return part;
}

/// Figure 4.25: the table, and the pictures into the folder.
Result<std::string> figure_4_25(const std::filesystem::path& pictures);
/// Where walls meet: layers along the arms, and sizes in the core.
struct JunctionTables {
  std::string arms, cores;
};
Result<JunctionTables> junctions(const std::filesystem::path& pictures);
/// Nodes against those of an isotropic mesh with as many layers.
Result<std::string> against_isotropic();
/// What changes from iteration 5 to 8. Real parts when their folder is given.
Result<std::string> iterations_5_to_8(const std::optional<std::filesystem::path>& cad);

}  // namespace lamella
