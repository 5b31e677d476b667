#pragma once

#include "core/natural/elliptic_interpolation.h"
#include "core/natural/thickness_detector.h"

namespace lamella {

/// How hulls are grown and judged.
struct NeighborhoodParams {
  double threshold = 0.76;                       ///< of the interpolation error (4.63)
  std::optional<Interpolation> interpolation{};  ///< unset: M2, where it fails M4, else M1
  PointWeights weights = PointWeights::area;
  bool edge_middles = true;  ///< see EllipticParams
  /// Elements from which on a neighborhood grows no further than k_min; from ten times as many on,
  /// no further at all. In a wide plate nothing else ends its growth.
  std::size_t largest = 2000;
};

/// What algorithm 4.1 found at the nodes of a mesh.
template <int D>
struct NeighborhoodField {
  MetricField<D> metric;          ///< [node] divided, (4.68)
  std::vector<double> thickness;  ///< [node] h_1 of (4.67) before the division, mm
  std::vector<Vec<D>> direction;  ///< [node] unit, its eigenvector
  std::vector<double> error;      ///< [node] (4.63) of the hull taken; NaN where there is none
  std::vector<int> order;         ///< [node] K, the order of the hull taken
  std::vector<int> least_order;   ///< [node] k_min (B.1), as far as growth got
  std::size_t failures = 0;  ///< nodes where the interpolation asked gave no metric: another did
  std::size_t bounded = 0;   ///< nodes whose growth was ended by `largest`
};

/// k(S) of algorithm B.1: about half the number of layers of elements around each node, >= 1. 0 for
/// a node of no element. A node takes the smallest number of its deeper neighbors.
template <int D>
std::vector<int> layer_numbers(const SimplexMesh<D>& mesh);

/// (B.2): mean of 2 k(S) - 3/2 over the nodes of the mesh that have elements.
double average_layers(const std::vector<int>& layer_numbers);

/// The natural metric by neighborhood growing (definitions 4.3 to 4.6, algorithms 4.1 and B.1).
/// K is the last order before the error (4.63) passes the threshold, but not below k_min. The mesh
/// is taken as one body. `largest` keeps the time linear in the nodes.
/// Errors: those of `check_params`; usage (threshold or `largest` not positive), bad_input (no
/// elements), cancelled.
template <int D>
Result<NeighborhoodField<D>> neighborhood_field(const SimplexMesh<D>& mesh,
                                                const NaturalParams& params,
                                                const NeighborhoodParams& growth = {},
                                                const Progress& progress = {});

/// The detector of the thesis: the mesh tells its own thickness, no surface is asked.
class NeighborhoodDetector : public ThicknessDetector {
 public:
  explicit NeighborhoodDetector(const NeighborhoodParams& growth = {}) : growth_(growth) {}
  Result<NaturalField> field(const SimplexMesh<3>& mesh, const NaturalParams& params,
                             const Progress& progress = {}) const override;

 private:
  NeighborhoodParams growth_;
};

}  // namespace lamella
