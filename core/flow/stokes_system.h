#pragma once

#include "core/base/progress.h"
#include "core/flow/sparse.h"
#include "core/flow/stokes.h"

namespace lamella::flow {

/// Velocity and pressure of each row, (v, p).
template <int D>
using State = std::vector<Vec<D + 1>>;

/// System (5.3) for eta = 1, one row a used node, its rows along a space-filling curve so that
/// blocks of them are compact. Nothing is eliminated: `constrain` keeps states admissible.
template <int D>
struct StokesSystem {
  /// Couplings of row i with column j.
  struct Entry {
    double a = 0;  ///< A: int grad l_i . grad l_j
    double c = 0;  ///< C: what the bubbles leave
    Vec<D> b = Vec<D>::Zero();   ///< -int l_i grad l_j, the divergence
    Vec<D> bt = Vec<D>::Zero();  ///< -int l_j grad l_i, its transpose
  };
  struct Opening {
    std::vector<std::int32_t> rows;
    std::vector<Vec<D>> load;  ///< int l_i n, [as rows]
    double area = 0;
  };

  std::vector<NodeId> node;       ///< [row] of the mesh
  std::vector<std::int32_t> row;  ///< [mesh node], -1 where unused
  std::vector<std::array<std::int32_t, D + 1>> elements;  ///< rows
  std::vector<std::int32_t> around_start, around;         ///< elements around a row

  std::vector<std::int32_t> start, column;  ///< as in Csr
  std::vector<Entry> entry;

  std::vector<char> wall;         ///< [row] velocity is zero
  std::vector<char> open;         ///< [row] on a gate or vent
  std::vector<std::int32_t> slides;   ///< rows on symmetries only
  std::vector<Mat<D>> slide_project;  ///< [as slides] onto the velocities they may have
  Mat<D> frame = Mat<D>::Identity();  ///< columns: axes, the normals of symmetries among them
  std::vector<Opening> openings;      ///< gates, then vents
  State<D> force;                     ///< right-hand side of the body force; empty without one

  std::size_t rows() const { return node.size(); }
};

/// Errors: those of `solve_stokes` that do not come of solving.
template <int D>
Result<StokesSystem<D>> assemble(const SimplexMesh<D>& mesh, const FlowCase<D>& flow,
                                 const Progress& progress);

/// y = K x.
template <int D>
void multiply(const StokesSystem<D>& s, const State<D>& x, State<D>& y);
/// Sets what may not be to zero.
template <int D>
void constrain(const StokesSystem<D>& s, State<D>& x);

/// A, with rows and columns of fixed rows replaced by those of the identity.
template <int D>
Csr velocity_matrix(const StokesSystem<D>& s, const std::vector<char>& fixed);
/// The pressure mass and C.
template <int D>
Csr mass_matrix(const SimplexMesh<D>& mesh, const StokesSystem<D>& s);
/// int w grad p . grad q with a weight w for each element, fixed at the openings.
template <int D>
Csr pressure_diffusion(const SimplexMesh<D>& mesh, const StokesSystem<D>& s,
                       const std::vector<double>& weight);
/// (int b)^2 / (|T| int |grad b|^2) of the bubble b = l_0 .. l_D, mm^2.
template <int D>
double bubble_weight(const std::array<Vec<D>, D + 1>& gradient);

}  // namespace lamella::flow
