#pragma once

#include <memory>

#include "core/base/progress.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// Where a point lies in a mesh.
template <int D>
struct Located {
  std::int32_t element = -1;
  std::array<double, D + 1> weights{};  ///< barycentric, >= 0 with the sum 1: of x itself, or of
                                        ///< the nearest point of the mesh when outside
  bool inside = false;
  double distance2 = 0;  ///< mm^2 from x to the mesh; 0 inside
};

/// Bounding volume hierarchies over the elements and over the boundary of a mesh. Keeps its own
/// copy of what it needs. Immutable and thread-safe after construction; the answer depends on the
/// mesh and the point alone, not on earlier queries.
template <int D>
class ElementLocator {
 public:
  /// The mesh must have at least one element; the list of facets is not used. A cancelled locator
  /// lacks elements: ask `progress` before it is used.
  explicit ElementLocator(const SimplexMesh<D>& mesh, const Progress& progress = {});
  ~ElementLocator();
  ElementLocator(ElementLocator&&) noexcept;

  /// The element that contains x (where several do, always the same of them), or the nearest one
  /// when x is outside. Weights below zero by rounding are raised to it.
  Located<D> locate(const Vec<D>& x) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lamella
