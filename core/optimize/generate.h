#pragma once

#include <memory>
#include <string>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// Fills a closed surface with tetrahedra. The boundary facets of the result are exactly the facets
/// of the surface (points 1..n are the surface's points in order; further nodes lie inside), with
/// facet_face copied from it.
class VolumeMesher {
 public:
  virtual ~VolumeMesher() = default;
  /// Short name for log and report, as "algorithm 2.1" or "Netgen 6.2".
  virtual std::string name() const = 0;
  virtual Result<SimplexMesh<3>> generate(const ReferenceSurface<3>& surface,
                                          const Progress& progress) const = 0;
};

struct GenerateParams {
  std::uint64_t seed = 1;
  /// Processor seconds after which it gives up, Code::failed; with voids, which are set in one by
  /// one before that, half of it and a 60th a void more.
  double time_limit = 120;
};

/// Algorithm 2.1: the mesh of the domain bounded by `surface`, by topological optimization towards
/// the minimal volume (2.20), which is also the certificate of the result. Boundary facets as for
/// VolumeMesher. Works for D = 2, 3 (4 with a closed boundary of tetrahedra).
/// Errors: bad_input (surface not closed or wrongly wound), failed (the surface touches or, in 3D,
/// crosses itself; or stalled: the message tells the excess volume and where), cancelled.
template <int D>
Result<SimplexMesh<D>> generate(const ReferenceSurface<D>& surface,
                                const GenerateParams& params = {}, const Progress& progress = {});

/// Algorithm 2.1 as a VolumeMesher.
std::unique_ptr<VolumeMesher> topological_mesher(const GenerateParams& params = {});

}  // namespace lamella
