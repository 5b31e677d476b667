#pragma once

#include <string>

#include "core/base/progress.h"
#include "core/geometry/triangles.h"

namespace lamella {

struct DiagnoseParams {
  double thin_wall = 0;           ///< mm: walls below it are listed; 0: 1e-3 of the box diagonal
  std::size_t most_places = 100;  ///< places listed of each kind
};

/// How often something was found, and where.
struct Finding {
  std::size_t count = 0;
  std::vector<Vec<3>> places;  ///< mm; the first ones
};

/// A set of facets that hang together by edges.
struct ShellFinding {
  std::size_t facets = 0;
  double volume = 0;  ///< mm^3, signed; of a closed shell
  bool closed = false;
  int depth = 0;             ///< closed shells around it: odd, a void
  std::int32_t around = -1;  ///< index of the shell directly around it
  Vec<3> low, high;          ///< box, mm
};

/// What is wrong with triangles, as they are: nothing is changed.
struct Diagnosis {
  std::string name;
  std::size_t facets = 0, vertices = 0;
  double area = 0, volume = 0;  ///< mm^2, mm^3
  Vec<3> low = Vec<3>::Zero(), high = Vec<3>::Zero();
  Finding open_edges;          ///< of one facet
  Finding non_manifold_edges;  ///< of more than two
  Finding wrong_windings;      ///< edges that two facets run through in the same direction
  Finding duplicate_facets;    ///< on the vertices of another
  Finding degenerate_facets;   ///< without area
  Finding self_intersections;  ///< pairs of facets that cross
  Finding thin_walls;          ///< facets whose wall is below `thin_limit`
  double thin_limit = 0;       ///< mm
  double thinnest = 0;         ///< mm, where a wall was measured; 0: nowhere
  std::vector<ShellFinding> shells;
  /// STEP only: whether the exact solid passes the kernel's own check.
  bool exact_shape_valid = true;

  bool sound() const {
    return open_edges.count + non_manifold_edges.count + wrong_windings.count +
               duplicate_facets.count + degenerate_facets.count + self_intersections.count ==
           0;
  }
};

/// Diagnosis of all triangles together. Walls are measured by a ray from the middle of each facet,
/// only where the surface is closed and wound alike. Cancel leaves it incomplete.
Diagnosis diagnose(const Triangles& triangles, const DiagnoseParams& params = {},
                   const Progress& progress = {});

/// One diagnosis a body: an outer shell with the voids directly inside it, or an open shell.
/// Largest first.
std::vector<Diagnosis> diagnose_bodies(const Triangles& triangles,
                                       const DiagnoseParams& params = {},
                                       const Progress& progress = {});

/// A file and its bodies as they are.
struct FileDiagnosis {
  std::vector<Diagnosis> bodies;
  std::size_t free_shells = 0;  ///< STEP: shells that belong to no solid
  std::size_t free_faces = 0;   ///< STEP: faces that belong to no shell
  std::string
      unit_guess;  ///< of a file without unit, from its size: "mm", "inch" or "m"; else empty
};

/// The unit that a part of this size, in file units, is likely in: parts are between 15 mm and 15
/// m.
std::string guess_unit(double diagonal);

}  // namespace lamella
