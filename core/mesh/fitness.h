#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/check.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// What solvers measure of a tetrahedral mesh: Euclidean, whatever metric it was made for. Angles
/// in degrees. The center of an element is the mean of its corners.
struct Fitness {
  std::size_t elements = 0;
  Stats aspect;  ///< sqrt(1.5) Lmax / hmin, `aspect_ratio` of quality.h
  std::size_t aspect_over_50 = 0;
  double dihedral_min = 0;  ///< between two faces of an element
  double dihedral_max = 0;
  std::size_t inner_faces = 0;   ///< of two elements; what follows is of these
  double non_orthogonality = 0;  ///< largest angle between a face's normal and its centers' line
  double non_orthogonality_mean = 0;  ///< arc cosine of the mean cosine, as checkMesh tells it
  std::size_t beyond_70 = 0;          ///< faces with a larger angle than 70
  /// From where the centers' line meets the face to the middle of the face, over the face's reach
  /// in that direction or a fifth of the distance of the centers, whichever is larger.
  Stats skewness;
  double boundary_skewness = 0;   ///< largest of the boundary, the line being the face's normal
  Stats smoothness;               ///< smaller over larger volume of two neighbors, 0..1
  std::size_t regions = 0;        ///< of elements that hang together by faces
  std::size_t free_edges = 0;     ///< of the boundary, with an odd number of facets
  std::size_t crossed_edges = 0;  ///< of the boundary, with more than two facets
};

/// Indices must be sound. Error: cancelled.
Result<Fitness> fitness(const SimplexMesh<3>& mesh, const Progress& progress = {});

/// One thing a solver asks of a mesh.
struct FitnessLine {
  std::string solver;
  std::string criterion;
  std::string value;
  std::string bound;  ///< empty: told, not judged
  bool holds = true;
  std::string advice;  ///< where it does not hold
};

/// The criteria of finite elements, OpenFOAM (checkMesh), Moldflow and Moldex3D, one after another.
/// `bodies` is the number of regions that are meant; `layers`: the 5 % quantile of the layers that
/// were measured, if any.
std::vector<FitnessLine> fitness_lines(const Fitness& fitness, std::size_t bodies,
                                       std::optional<double> layers);

}  // namespace lamella
