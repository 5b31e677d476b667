#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"
#include "core/multidomain/partition.h"

namespace lamella {

struct BalanceParams {
  double most = 0;       ///< mm, > 0: how far a node may move, of the wall how far beyond it
  double tolerance = 0;  ///< mm: facets go no farther from their border, or than they were
  const Zone<3>* domain = nullptr;         ///< what the mesh fills; null: its wall stays as it is
  int threads = 0;                         ///< 0: all cores; the result does not depend on it
  const MetricField<3>* metric = nullptr;  ///< [node] of qualities; null: only volumes count
  /// [CAD face] mm: how deep the zone's own border lies below the shape it stands for, see
  /// chord_depth.h; beyond its end not at all
  std::vector<double> depth{};
};

/// Moves nodes of smooth borders, and of the domain's wall, across them, so that as much of what
/// lies between border and mesh is on one side as on the other: chords of a curved border with all
/// nodes on it take volume from the body inside, and are farther from it than they need be. Where
/// borders or the smooth parts of one meet nodes move as each of them needs, along edges whose
/// sides lack nothing, and stay where that cannot be. The facets of zone z have CAD faces from
/// number `first_face[z]` on, those below are of the wall. What would make an element poor stays.
/// Returns how many nodes were moved; where it was cancelled the mesh is as valid as before.
std::size_t balance_borders(SimplexMesh<3>& mesh, const Partition<3>& partition,
                            std::span<const std::int32_t> first_face, const BalanceParams& params,
                            const Progress& progress = {});

/// Moves the nodes of elements within `reach` mm of the places to where they were (`points`);
/// whether any was elsewhere.
bool put_back(SimplexMesh<3>& mesh, const std::vector<Vec<3>>& points,
              const std::vector<Vec<3>>& places, double reach);

}  // namespace lamella
