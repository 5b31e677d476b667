#pragma once

#include "core/base/progress.h"
#include "core/flow/sparse.h"
#include "core/flow/stokes.h"

namespace lamella::flow {

/// [row].
template <int D>
using Velocities = std::vector<Vec<D>>;
using Pressures = std::vector<Vec<1>>;

/// System (5.3) for eta = 1, one row a used node, its rows along a space-filling curve so that
/// blocks of them are compact. Nothing is eliminated: `constrain` keeps velocities admissible.
template <int D>
struct StokesSystem {
  /// Couplings of the velocity of column j, on row i.
  struct OfVelocity {
    double a = 0;               ///< A: int grad l_i . grad l_j
    Vec<D> b = Vec<D>::Zero();  ///< -int l_i grad l_j, the divergence
  };
  /// Couplings of the pressure of column j.
  struct OfPressure {
    double c = 0;                ///< C: what the bubbles leave, and the first part of `smoothing`
    Vec<D> bt = Vec<D>::Zero();  ///< -int l_j grad l_i, the transposed divergence
  };
  struct Opening {
    std::vector<std::int32_t> rows;
    std::vector<Vec<D>> load;  ///< int l_i n, [as rows]
    double area = 0;
  };

  std::vector<NodeId> node;                               ///< [row] of the mesh
  std::vector<std::int32_t> row;                          ///< [mesh node], -1 where unused
  std::vector<std::array<std::int32_t, D + 1>> elements;  ///< rows
  std::vector<std::int32_t> around_start, around;         ///< elements around a row

  std::vector<std::int32_t> start, column;  ///< as in Csr
  std::vector<OfVelocity> of_velocity;      ///< [entry]
  std::vector<OfPressure> of_pressure;      ///< [entry]
  /// [row] W_i / m_i of `smooth_pressure`; empty without.
  std::vector<Mat<D>> smoothing;

  std::vector<char> wall;             ///< [row] velocity is zero
  std::vector<char> open;             ///< [row] on a gate or vent
  std::vector<std::int32_t> slides;   ///< rows on symmetries only
  std::vector<Mat<D>> slide_project;  ///< [as slides] onto the velocities they may have
  Mat<D> frame = Mat<D>::Identity();  ///< columns: axes, the normals of symmetries among them
  std::vector<Opening> openings;      ///< gates, then vents
  Velocities<D> force;                ///< right-hand sides of the body force; empty without one
  Pressures bubble_force;

  std::size_t rows() const { return node.size(); }
};

/// Errors: those of `solve_stokes` that do not come of solving.
template <int D>
Result<StokesSystem<D>> assemble(const SimplexMesh<D>& mesh, const FlowCase<D>& flow,
                                 const Progress& progress);

/// Adds sum_i sum_T |T| / (D + 1) (grad p - g_i)^T W_i (grad q - h_i), T around i, to C; g_i and
/// h_i are the means of the gradients around i. W_i is a hundredth of the squared sizes of the
/// elements around i, at most phi_i: see `FlowSettings::smooth_pressure`.
template <int D>
void smooth_pressure(const SimplexMesh<D>& mesh, StokesSystem<D>& s, const Pressures& phi,
                     const Progress& progress);

/// f = A v, g = B v.
template <int D>
void multiply_velocity(const StokesSystem<D>& s, const Velocities<D>& v, Velocities<D>& f,
                       Pressures& g);
/// f += B^T p, g -= C p.
template <int D>
void add_pressure(const StokesSystem<D>& s, const Pressures& p, Velocities<D>& f, Pressures& g);
/// Sets what may not be to zero.
template <int D>
void constrain(const StokesSystem<D>& s, Velocities<D>& v);

/// A, with rows and columns of fixed rows replaced by those of the identity.
template <int D>
Csr velocity_matrix(const StokesSystem<D>& s, const std::vector<char>& fixed);
/// These are not complete when cancelled: the pressure mass and the C of the bubbles alone, before
/// `smooth_pressure`.
template <int D>
Csr mass_matrix(const SimplexMesh<D>& mesh, const StokesSystem<D>& s, const Progress& progress);
/// int w grad p . grad q with a weight w (mm^2) for each element. At an opening the pressure
/// outside is known: w p q / max(height of the element, sqrt w) there.
template <int D>
Csr pressure_diffusion(const SimplexMesh<D>& mesh, const StokesSystem<D>& s,
                       const std::vector<double>& weight, const Progress& progress);
/// (int b)^2 / (|T| int |grad b|^2) of the bubble b = l_0 .. l_D, mm^2.
template <int D>
double bubble_weight(const std::array<Vec<D>, D + 1>& gradient);

}  // namespace lamella::flow
