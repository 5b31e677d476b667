#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// Fields of a flow, or of any solver's result at the nodes of a mesh. Node fields are indexed by
/// NodeId, entry 0 is the virtual node; elements must not be flat. `threads` 0: all cores; no
/// result depends on it.

/// Gradient of a P1 field in each element: of a scalar a vector, of a vector the matrix
/// dv_i / dx_j.
template <int D>
std::vector<Vec<D>> element_gradients(const SimplexMesh<D>& mesh, const std::vector<double>& field,
                                      int threads = 0);
template <int D>
std::vector<Mat<D>> element_gradients(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& field,
                                      int threads = 0);

/// The mean of the elements around each node, weighted by their measures; zero at unused nodes.
/// T: double, Vec<D> or Mat<D>.
template <int D, class T>
std::vector<T> nodal_means(const SimplexMesh<D>& mesh, const std::vector<T>& of_elements,
                           int threads = 0);

/// ||(grad v) v|| at the nodes, with the mean gradient there (section 5.1.1.2).
template <int D>
std::vector<double> acceleration_norm(const SimplexMesh<D>& mesh,
                                      const std::vector<Vec<D>>& velocity, int threads = 0);

/// ||eps(v)|| of each element, (5.4).
template <int D>
std::vector<double> shear_rate(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& velocity,
                               int threads = 0);

/// ||grad (v / ||v||)|| of each element, mm^-1, (5.22), by the derivative of the quotient at its
/// center: at a wall there is no direction to take differences of. Where ||v|| is below a
/// thousandth of the largest velocity, that is put in its place.
template <int D>
std::vector<double> direction_change(const SimplexMesh<D>& mesh,
                                     const std::vector<Vec<D>>& velocity, int threads = 0);

/// The symmetric N_T with ||e||_N = ||e||^2 for every edge e, (5.26): ||d||_N is the size of the
/// simplex along the unit vector d, (5.27). Not always positive.
template <int D>
Mat<D> size_tensor(const std::array<Vec<D>, D + 1>& p);
/// N_F, the same within the hyperplane of a facet and zero across it.
template <int D>
Mat<D> facet_size_tensor(const std::array<Vec<D>, D>& p);

/// The residual indicator of each element: the root of (5.24), so that (5.23) adds its squares.
/// Errors: cancelled.
template <int D>
Result<std::vector<double>> residual_indicator(const SimplexMesh<D>& mesh,
                                               const std::vector<Vec<D>>& velocity,
                                               const std::vector<double>& pressure,
                                               double viscosity, int threads = 0,
                                               const Progress& progress = {});

/// The directional one, the root of (5.28): h_F and h_T are the sizes along d, one unit vector for
/// each element; empty: d = grad ||v|| / ||grad ||v|||| (5.29), and where that is zero the
/// diameters again. No size is taken below the smallest height of the element: N_T says nothing
/// there, and N_F vanishes across a facet that is orthogonal to d.
template <int D>
Result<std::vector<double>> directional_indicator(const SimplexMesh<D>& mesh,
                                                  const std::vector<Vec<D>>& velocity,
                                                  const std::vector<double>& pressure,
                                                  double viscosity,
                                                  const std::vector<Vec<D>>& direction = {},
                                                  int threads = 0, const Progress& progress = {});

}  // namespace lamella
