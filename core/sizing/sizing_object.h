#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry/simplex.h"

namespace lamella {

/// Where a sizing object holds. Lengths in mm.
struct WholeBody {};
struct SphereShape {
  Vec<3> center = Vec<3>::Zero();
  double radius = 0;  ///< > 0
};
/// A box along `x_axis`, the part of `y_axis` across it, and their cross product.
struct BoxShape {
  Vec<3> center = Vec<3>::Zero();
  Vec<3> size = Vec<3>::Zero();     ///< edge lengths along the axes, > 0
  Vec<3> x_axis = Vec<3>::UnitX();  ///< any length
  Vec<3> y_axis = Vec<3>::UnitY();  ///< any length, not parallel to x_axis
};
/// A full cylinder between the centers of its ends.
struct CylinderShape {
  Vec<3> from = Vec<3>::Zero(), to = Vec<3>::Zero();
  double radius = 0;  ///< > 0
};
/// Faces of the body's reference surface, and what is within `depth` of them.
struct FacesShape {
  std::vector<std::int32_t> ids{};   ///< CAD face ids
  std::vector<std::string> names{};  ///< all faces that have one of these names
  double depth = 0;                  ///< >= 0
  bool others = false;               ///< all faces but these
};
using SizingShape = std::variant<WholeBody, SphereShape, BoxShape, CylinderShape, FacesShape>;

/// Correction by hand (figure 4.23). Inside the shape the size is h0 = `size`, or `factor` times
/// the smallest size asked there without the correction; at the distance d outside it is
/// h(d) = h0 + d ln(gradation), until that asks for no more than what rules there. This is the
/// growth of GradationKind: sizes change by the factor `gradation` at most per unit length.
///
/// Isotropic: h(d) in every direction, intersected with what rules (A.1.3.2): finer, never coarser.
/// With `keep_directions` the metric is scaled by one factor such that its smallest size becomes
/// min(h(d), h1), where h1 is the smallest size that rules: directions and ratios stay, and it is
/// never coarser either; unless `factor` is above 1, for which the smallest size becomes
/// max(h0 - d ln(gradation), h1).
struct SizeCorrection {
  std::optional<double> size{};    ///< mm, > 0; exactly one of both
  std::optional<double> factor{};  ///< > 0
  double gradation = 1.3;          ///< > 1
  bool keep_directions = false;
};

/// Frames of the analytic metrics (A.1.4). Axes have any length.
struct CartesianFrame {
  Vec<3> x_axis = Vec<3>::UnitX();
  Vec<3> y_axis = Vec<3>::UnitY();  ///< its part across x_axis
};
struct CylindricalFrame {
  Vec<3> origin = Vec<3>::Zero();
  Vec<3> axis = Vec<3>::UnitZ();
};
struct SphericalFrame {
  Vec<3> origin = Vec<3>::Zero();
  Vec<3> axis = Vec<3>::UnitZ();  ///< of the poles
};

/// Sizes that change with the radius r of the frame, (A.16) and (A.20) with h(r): those of the zone
/// up to `from`, `sizes` from `to` on, linear or geometric in r between.
struct RadialProgression {
  enum class Kind { none, linear, geometric } kind = Kind::none;
  double from = 0, to = 0;  ///< mm, 0 <= from < to
  Vec<3> sizes = Vec<3>::Zero();
};

/// Analytic zone (A.1.4): sizes (mm) along x, y, z; along r, theta, z; or along r, theta, phi of
/// the frame. It ends where its shape ends.
struct AnalyticZone {
  std::variant<CartesianFrame, CylindricalFrame, SphericalFrame> frame;
  Vec<3> sizes = Vec<3>::Zero();    ///< > 0
  RadialProgression progression{};  ///< none for a Cartesian frame
  bool replace = false;             ///< instead of the natural metric; else intersected with it
};

/// Boundary layer (7.3.2) on the faces of the object, or on all walls of the body: `layers`
/// elements across within `thickness` of them, beyond it growing as a correction does. Along the
/// wall sizes stay as they are.
struct BoundaryLayer {
  double thickness = 0;    ///< mm, > 0
  int layers = 3;          ///< >= 1
  double gradation = 1.5;  ///< > 1
};

/// What the user asks of the mesh size somewhere, on top of the natural metric.
struct SizingObject {
  std::string name;
  std::string body{};  ///< the part it applies to; empty: all of them
  SizingShape shape;
  std::variant<SizeCorrection, AnalyticZone, BoundaryLayer> asks;
};

}  // namespace lamella
