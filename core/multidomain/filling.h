#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/mesh/simplex_mesh.h"
#include "core/multidomain/partition.h"

namespace lamella {

/// How much of an element a region fills.
struct Share {
  std::int32_t region = 0;
  float ratio = 0;  ///< in (0, 1]
};

/// Filling ratios g_k(T) = |T cut with omega_k| / |T| (6.10) of all regions of a partition: the
/// discontinuous P0 interpolation of their characteristic functions. Only what is not zero is kept.
struct Filling {
  std::vector<std::uint32_t> first{0};  ///< [element] of its shares in `shares`, and the end
  std::vector<Share> shares;            ///< by ascending region; those of an element sum up to 1
  int regions = 0;

  double ratio(std::size_t element, std::int32_t region) const;
  bool mixed(std::size_t element) const { return first[element + 1] - first[element] > 1; }
  std::size_t mixed_count() const;
  /// The region with the largest share, the first of equals.
  std::int32_t main_region(std::size_t element) const;
};

struct FillingParams {
  /// Bisections of an element that a border crosses before the border is taken as flat in the
  /// piece: 3 is enough for a metric, 6 to 9 for figures that are reported.
  int depth = 3;
  int threads = 0;  ///< 0: all cores; the result does not depend on it
};

/// A region that no border can reach is full or empty by distance alone: time and memory grow with
/// the elements at borders. Errors: cancelled.
template <int D>
Result<Filling> filling_ratios(const SimplexMesh<D>& mesh, const Partition<D>& partition,
                               const FillingParams& params = {}, const Progress& progress = {});

/// The share of the simplex where a linear function with the given values at the corners is
/// negative, exactly.
template <int D>
double negative_share(std::array<double, D + 1> values);

/// The thesis' estimate (6.21) of the zone's share, with the points (B.3)-(B.5) no farther apart
/// than thickness / sqrt 2.
template <int D>
double sampled_share(const std::array<Vec<D>, D + 1>& corners, const Zone<D>& zone,
                     double thickness);

/// What a filling is worth for one region.
struct FillingError {
  double volume = 0;       ///< mm^D, sum of g_k(T) |T|
  double l2 = 0;           ///< ||g_k - 1_k|| in L2 (6.12), mm^(D/2)
  double relative_l2 = 0;  ///< l2 / ||1_k||: 0 when every element is full or empty
};
/// [region]
template <int D>
std::vector<FillingError> filling_errors(const SimplexMesh<D>& mesh, const Filling& filling);

}  // namespace lamella
