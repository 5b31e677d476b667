#pragma once

#include "core/flow/multigrid.h"
#include "core/flow/stokes_system.h"

namespace lamella::flow {

/// Block diagonal and symmetric positive definite, for minimal residuals:
/// - velocity: one multigrid cycle on A for all components that are fixed at the same rows, in axes
///   normal to the symmetries;
/// - pressure: (M + C)^-1 + K^-1 with M the mass and K = int phi grad p . grad q, where
///   -lap phi = 1, phi = 0 on walls. Pressures that vary over less than the thickness of a wall see
///   the mass. Those that vary along a thin cavity drive the flow phi grad p, of mean H^2 / 12
///   between plates: without K the iterations grow with its length over its thickness.
template <int D>
class StokesPreconditioner {
 public:
  /// Nullopt when cancelled.
  static std::optional<StokesPreconditioner> build(const SimplexMesh<D>& mesh,
                                                   const StokesSystem<D>& system,
                                                   const Progress& progress);
  /// z = P r, in the arena of the caller.
  void apply(const StokesSystem<D>& system, const State<D>& r, State<D>& z);

 private:
  struct Components {
    std::vector<int> axes;
    Multigrid cycle;
  };
  template <int K>
  void apply_components(const StokesSystem<D>& system, Components& c, const State<D>& r,
                        State<D>& z);

  std::vector<Components> velocity_;
  std::optional<Multigrid> mass_, diffusion_;
  std::vector<Vec<1>> right_, found_;
};

}  // namespace lamella::flow
