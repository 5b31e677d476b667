#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/study/canvas.h"
#include "core/study/run.h"

namespace lamella {

/// A drawing of the mesh.
struct ReportPicture {
  std::string caption;
  std::string png;  ///< bytes of the file
  int width = 0, height = 0;
};

/// Colors of the layers map and what they stand for, from few layers to many.
std::vector<std::pair<Rgb, std::string>> layers_legend();

/// The layers measured back over those asked, on the bodies seen from two sides. Nothing where no
/// layers were measured. Errors: cancelled.
Result<std::optional<ReportPicture>> layers_map(const Study& study, const MeshState& state,
                                                const Progress& progress = {});

/// Two sections of the mesh, each with a wall from near: those of the study, or across the two
/// longest sides of the bodies where they meet most. Errors: cancelled.
Result<std::vector<ReportPicture>> sections(const Study& study, const MeshState& state,
                                            const Progress& progress = {});

/// A place of a section in a wall as thick as most.
struct WallPlace {
  Vec<3> center = Vec<3>::Zero();  ///< mm
  double thickness = 0;            ///< mm
};
/// The one nearest to the middle of all such places; nothing where the mesh tells no thickness.
/// `counts` (one a node, or none at all) says which nodes count.
std::optional<WallPlace> typical_wall(const MeshState& state, const Vec<3>& origin,
                                      const Vec<3>& normal, const std::vector<char>& counts = {});

}  // namespace lamella
