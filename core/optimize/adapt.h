#pragma once

#include <optional>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

/// A quantity that stands for the metric where metrics are averaged (section 3.2.2).
enum class MetricMean {
  m,     ///< M, (3.10) and (3.11)
  root,  ///< M^(1/2), (3.12) to (3.15)
  size,  ///< M^(-1/2), (3.16) to (3.19): cheapest first iterations
  log,   ///< log M, log-Euclidean
  h      ///< the smallest size, isotropic, (3.20) to (3.23)
};

/// How the size of an element follows from its edges: the root of the mean square (3.4), or the
/// plain mean of their lengths.
enum class SizeAverage { l2, l1 };

struct AdaptParams {
  MetricMean mean = MetricMean::size;       ///< carries the metric to new nodes; a metric function
                                            ///< given to `adapt` goes before it
  MetricMean element_mean = MetricMean::m;  ///< metric of an element from its nodes'
  SizeAverage size_average = SizeAverage::l2;
  std::optional<double> chord_tolerance{};  ///< mm; unset: 1e-3 of the box diagonal
  double feature_angle = 0.7;  ///< radians between facets that makes an edge a feature, where no
                               ///< reference surface tells
  int sweeps = 24;             ///< upper bound of the sweeps for the average quality
  double relaxation = 3;       ///< weight of the shape in the first sweeps, >= 1; 1: none
  int relaxed_sweeps = 8;      ///< upper bound of the relaxed sweeps
  int threads = 0;             ///< 0: all cores; the mesh does not depend on it
  std::optional<double> memory_limit{};  ///< MB the adaption may take; unset: no limit
  bool treat_blocking = false;  ///< split inner edges and elements that join wall to wall (C.1.1)
  std::vector<std::int32_t> frozen_groups{};  ///< boundary groups whose facets stay as they are
  std::vector<std::int32_t> frozen_bodies{};  ///< bodies whose elements stay as they are
  std::uint64_t seed = 1;                     ///< the order of the work; any seed is as good
};

/// What `adapt` did.
struct AdaptReport {
  std::size_t splits = 0;     ///< nodes added
  std::size_t collapses = 0;  ///< nodes removed
  std::size_t swaps = 0;      ///< cavities reconnected without adding or removing a node
  std::size_t moves = 0;      ///< nodes moved
  int sweeps = 0;
  bool settled = false;              ///< ended by itself, not by `sweeps`
  bool cancelled = false;            ///< stopped early: the mesh is valid, and as far as it got
  double forecast_nodes = 0;         ///< (1.34) before the start
  double forecast_memory = 0;        ///< MB, of the adaption itself
  std::size_t blocking = 0;          ///< blocking faces found at the end when asked to treat them
  std::size_t blocking_treated = 0;  ///< of them, opened by a node inside
};

template <int D>
struct Adapted {
  SimplexMesh<D> mesh;
  MetricField<D> metric;  ///< [node] of the new mesh, transported or evaluated
  AdaptReport report;
};

/// Algorithm 3.1: the mesh whose elements are unit and equilateral under `metric`; the input is
/// left untouched. With `metric_at`, which is asked wherever a node goes, `metric` is its values at
/// the nodes of the mesh, or empty. Boundary facets keep their group and CAD face; nodes of the
/// boundary stay on `surface` within the chord tolerance (without a surface: on the boundary of the
/// input). Faces between bodies that the input lists as facets are held in the same way, on the
/// facets of `surface` that have their CAD faces; those that it does not list, to what they are in
/// the input. A cancel returns the valid mesh reached so far, with `cancelled` set in its report.
/// Errors: bad_input (metric size or mesh invalid), memory (the limit would be exceeded).
template <int D>
Result<Adapted<D>> adapt(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                         const ReferenceSurface<D>* surface = nullptr,
                         const AdaptParams& params = {}, const Progress& progress = {},
                         const MetricFunction<D>& metric_at = {});

}  // namespace lamella
