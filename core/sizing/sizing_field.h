#pragma once

#include <memory>

#include "core/base/result.h"
#include "core/geometry/bvh.h"
#include "core/geometry/surface.h"
#include "core/metric/metric.h"
#include "core/sizing/sizing_object.h"

namespace lamella {

/// The CAD faces that the shape picks, rising; those that the surface does not have are left out.
std::vector<std::int32_t> picked_faces(const FacesShape& shape, const ReferenceSurface<3>& surface);

/// Sizing objects of one body, ready to be asked. Immutable and thread-safe; copies share their
/// content.
///
/// First what replaces or coarsens acts on the natural metric, in the order of the list; then every
/// other object, made from that, is intersected with it, in the order of the list.
class SizingField {
 public:
  /// Asks for nothing.
  SizingField() = default;
  /// All of `objects`, whatever body they name; `surface` is where faces are looked up.
  /// Errors: usage, naming the object (a size, radius or extent that is not positive; a gradation
  /// not above 1; parallel axes; an unknown face).
  static Result<SizingField> make(const std::vector<SizingObject>& objects,
                                  const ReferenceSurface<3>& surface);

  /// The metric asked at x, where `natural` is without the objects: the same to the bit where none
  /// of them reaches. Allocates nothing.
  Metric<3> apply(const Vec<3>& x, const Metric<3>& natural) const;

  bool empty() const { return !impl_; }
  /// Some object may ask for less than the natural metric does.
  bool may_coarsen() const;
  /// The smallest extent (mm) of the shapes that touch the box; infinite when none does. Samples
  /// farther apart may miss a shape altogether.
  double detail(const Box<3>& box) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace lamella
