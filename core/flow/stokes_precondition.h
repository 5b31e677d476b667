#pragma once

#include "core/flow/multigrid.h"
#include "core/flow/stokes_system.h"

namespace lamella::flow {

/// Approximate inverses of the blocks of (5.3), both symmetric positive definite:
/// - velocity: one multigrid cycle on A for all components that are fixed at the same rows, in axes
///   normal to the symmetries, scaled such that its inverse is below A;
/// - pressure: (M + C)^-1 + K^-1 with M the mass and K = int phi grad p . grad q, where
///   -lap phi = 1, phi = 0 on walls. Pressures that vary over less than the thickness of a wall see
///   the mass. Those that vary along a thin cavity drive the flow phi grad p, of mean H^2 / 12
///   between plates: without K the iterations grow with its length over its thickness.
template <int D>
class StokesPreconditioner {
 public:
  /// Also smooths the pressure of `system`, if asked. Nullopt when cancelled.
  static std::optional<StokesPreconditioner> build(const SimplexMesh<D>& mesh,
                                                   StokesSystem<D>& system, bool smooth,
                                                   const Progress& progress);
  void velocity(const StokesSystem<D>& system, const Velocities<D>& f, Velocities<D>& v);
  void pressure(const Pressures& g, Pressures& p);
  /// Makes the inverse of `velocity` smaller: it was not below A.
  void shrink_velocity();

 private:
  struct Components {
    std::vector<int> axes;
    Multigrid cycle;
    double scale = 1;
  };
  template <int K>
  void apply_components(const StokesSystem<D>& system, Components& c, const Velocities<D>& f,
                        Velocities<D>& v);

  std::vector<Components> velocity_;
  std::optional<Multigrid> mass_, diffusion_;
  Pressures more_;
};

}  // namespace lamella::flow
