#include "core/sizing/sizing_field.h"

#include <algorithm>
#include <limits>

#include "core/base/overloaded.h"
#include "core/geometry/locator.h"
#include "core/metric/analytic.h"
#include "core/metric/intersect.h"

namespace lamella {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A zone that ends on a wall holds on the wall: relative to the extents of the shape.
constexpr double kRounding = 1e-9;

/// The best elements have a little less than a layer each: asked for by this much finer, n of them
/// are within a tenth as thick as asked, and the poor places of a boundary layer have .9 n.
constexpr double kFinerLayers = 1.04;

double distance_to_box(const Box<3>& box, const Vec<3>& x) {
  return (box.lo - x).cwiseMax(x - box.hi).cwiseMax(0.0).norm();
}

/// A shape ready to be asked: the distance (mm) of x to it, 0 inside; where that is above `within`,
/// it may be infinite.
struct Anywhere {
  double distance(const Vec<3>&, double) const { return 0; }
};
struct Ball {
  Vec<3> center;
  double radius;
  double distance(const Vec<3>& x, double) const { return (x - center).norm() - radius; }
};
struct Brick {
  Vec<3> center, half;
  Mat<3> axes;
  double distance(const Vec<3>& x, double) const {
    return ((axes.transpose() * (x - center)).cwiseAbs() - half).cwiseMax(0.0).norm();
  }
};
struct Rod {
  Vec<3> center, axis;
  double half, radius;
  double distance(const Vec<3>& x, double) const {
    const Vec<3> d = x - center;
    const double along = axis.dot(d), out = (d - along * axis).norm() - radius;
    return std::hypot(std::max(0.0, std::abs(along) - half), std::max(0.0, out));
  }
};
struct Skin {
  std::shared_ptr<const Locator<3>> facets;
  double depth;
  double distance(const Vec<3>& x, double within) const {
    const auto near = facets->nearest(x, std::min(1e150, within + depth));
    return near ? std::sqrt(near->distance2) - depth : kInfinity;
  }
};

struct Placed {
  std::variant<Anywhere, Ball, Brick, Rod, Skin> shape;
  Box<3> box;                 ///< around it
  double extent = kInfinity;  ///< its smallest
  double rounding = 0;        ///< mm

  bool holds(const Vec<3>& x) const {
    return distance_to_box(box, x) <= rounding && distance(x, rounding) == 0;
  }
  double distance(const Vec<3>& x, double within) const {
    const double d =
        std::visit([&](const auto& s) { return s.distance(x, within + rounding); }, shape);
    return d <= rounding ? 0 : d;
  }
};

struct Correction {
  double size = 0, factor = 0;  ///< one of them is 0
  double slope = 0;             ///< ln(gradation)
  bool keep_directions = false;

  bool coarsens() const { return keep_directions && factor > 1; }
  double at_shape(double smallest) const { return size > 0 ? size : factor * smallest; }
};

struct Zone {
  enum class Kind { cartesian, cylindrical, spherical } kind = Kind::cartesian;
  Vec<3> origin = Vec<3>::Zero(), axis = Vec<3>::UnitZ();
  Metric<3> constant;  ///< of the Cartesian frame
  Vec<3> sizes, last_sizes;
  double from = 0, to = 0;  ///< equal: sizes do not change
  bool geometric = false;
  bool replace = false;

  Metric<3> at(const Vec<3>& x) const {
    if (kind == Kind::cartesian) return constant;
    const Vec<3> d = x - origin;
    return kind == Kind::cylindrical
               ? cylindrical_metric_at(d, axis, sizes_at((d - axis * axis.dot(d)).norm()))
               : spherical_metric_at(d, axis, sizes_at(d.norm()));
  }
  Vec<3> sizes_at(double r) const {
    if (!(to > from)) return sizes;
    const double t = std::clamp((r - from) / (to - from), 0.0, 1.0);
    if (!geometric) return (1 - t) * sizes + t * last_sizes;
    return sizes.array() * (last_sizes.array() / sizes.array()).pow(t);
  }
};

/// Sizes across the walls.
struct Layer {
  std::shared_ptr<const Locator<3>> walls;
  double thickness = 0, size = 0, slope = 0;
};

struct Placement {
  Placed place;
  std::variant<Correction, Zone, Layer> asks;

  /// It acts on the natural metric instead of being intersected with it.
  bool rules() const {
    if (const auto* zone = std::get_if<Zone>(&asks)) return zone->replace;
    if (const auto* correction = std::get_if<Correction>(&asks)) return correction->coarsens();
    return false;
  }
};

/// Smallest and largest size asked by a metric.
struct Range {
  explicit Range(const Metric<3>& m) {
    const Vec<3> h = sizes<3>(m);
    smallest = h[0];
    largest = h[2];
  }
  double smallest, largest;
};

/// A zone that replaces, or a correction that coarsens.
void rule(const Placement& p, const Vec<3>& x, Metric<3>& metric) {
  if (const auto* zone = std::get_if<Zone>(&p.asks)) {
    if (p.place.holds(x)) metric = zone->at(x);
    return;
  }
  const auto& c = std::get<Correction>(p.asks);
  const double h1 = Range(metric).smallest;
  const double reach = (c.factor - 1) * h1 / c.slope;
  if (distance_to_box(p.place.box, x) >= reach) return;
  const double d = p.place.distance(x, reach);
  if (d < reach) metric *= eigenvalue_from_size(c.factor - d * c.slope / h1);
}

/// Intersects `metric` with the layer's size across the nearest wall.
void refine(const Layer& layer, const Box<3>& box, const Vec<3>& x, const Range& range,
            Metric<3>& metric) {
  const double reach = layer.thickness + (range.largest - layer.size) / layer.slope;
  if (!(reach > 0) || distance_to_box(box, x) >= reach) return;
  const auto near = layer.walls->nearest(x, reach);
  if (!near) return;
  const double d = std::sqrt(near->distance2);
  const Vec<3> wall = layer.walls->normal(near->facet);
  const Vec<3> across = d > 1e-9 * layer.thickness ? Vec<3>((x - near->point) / d) : wall;
  // What lies beside the faces, not before them, is none of the layer's.
  if (std::abs(across.dot(wall)) < 0.7) return;
  const double h = layer.size + layer.slope * std::max(0.0, d - layer.thickness);
  const double ratio = across.dot(metric.llt().solve(across)) / (h * h);
  if (ratio > 1) metric += (1 - 1 / ratio) / (h * h) * across * across.transpose();
}

/// Intersects `metric` with what one object makes of `base`.
void refine(const Placement& p, const Vec<3>& x, const Metric<3>& base, const Range& range,
            Metric<3>& metric) {
  if (const auto* zone = std::get_if<Zone>(&p.asks)) {
    if (p.place.holds(x)) metric = intersect<3>(metric, zone->at(x));
    return;
  }
  if (const auto* layer = std::get_if<Layer>(&p.asks))
    return refine(*layer, p.place.box, x, range, metric);
  const auto& c = std::get<Correction>(p.asks);
  const double h0 = c.at_shape(range.smallest);
  const double ends = c.keep_directions ? range.smallest : range.largest;
  const double reach = (ends - h0) / c.slope;
  if (!(reach > 0) || distance_to_box(p.place.box, x) >= reach) return;
  const double d = p.place.distance(x, reach);
  if (!(d < reach)) return;
  const double h = h0 + c.slope * d;
  metric = intersect<3>(metric, c.keep_directions
                                    ? Metric<3>(base * eigenvalue_from_size(h / range.smallest))
                                    : isotropic_metric<3>(h));
}

/// Reads objects into placements; complains in the name of the object.
class Reader {
 public:
  explicit Reader(const ReferenceSurface<3>& surface) : surface_(surface) {}

  Result<Placement> read(const SizingObject& object) {
    complaint_.reset();
    Placement p;
    const auto* layer = std::get_if<BoundaryLayer>(&object.asks);
    if (layer) {
      place_layer(object.shape, p.place);
      if (!complaint_) p.asks = prepared(*layer, p.place);
    } else {
      std::visit([&](const auto& shape) { place(shape, p.place); }, object.shape);
      std::visit(Overloaded{[&](const BoundaryLayer&) {},
                            [&](const auto& asks) { p.asks = prepared(asks); }},
                 object.asks);
    }
    if (!complaint_) return p;
    complaint_->message = "Sizing object \"" + object.name + "\": " + complaint_->message;
    return *complaint_;
  }

 private:
  void complain(const std::string& message, const std::string& hint) {
    if (!complaint_) complaint_ = Error{Code::usage, message, hint};
  }
  void want(bool good, const std::string& message, const std::string& hint) {
    if (!good) complain(message, hint);
  }
  static bool positive(double v) { return v > 0 && std::isfinite(v); }
  static bool positive(const Vec<3>& v) { return v.minCoeff() > 0 && v.allFinite(); }

  Vec<3> direction(const Vec<3>& axis) {
    const bool good = axis.allFinite() && axis.norm() > 0;
    want(good, "an axis has no direction.", "Give three numbers that are not all 0.");
    return good ? axis.normalized() : Vec<3>::UnitZ();
  }
  /// Right-handed columns from an axis and one that is not parallel to it.
  Mat<3> axes(const Vec<3>& x_axis, const Vec<3>& y_axis) {
    const Vec<3> x = direction(x_axis), y = direction(y_axis);
    const Vec<3> across = y - x * x.dot(y);
    want(across.norm() > 1e-6, "its x and y axes are parallel.",
         "Give two directions at an angle.");
    Mat<3> m;
    m << x, across.normalized(), x.cross(across.normalized());
    return m;
  }

  void place(const WholeBody&, Placed& out) {
    out.shape = Anywhere{};
    out.box = {Vec<3>::Constant(-kInfinity), Vec<3>::Constant(kInfinity)};
  }
  void place(const SphereShape& s, Placed& out) {
    want(s.center.allFinite() && positive(s.radius), "the radius of the sphere is not positive.",
         "Lengths are in mm.");
    out.shape = Ball{s.center, s.radius};
    out.box = {s.center.array() - s.radius, s.center.array() + s.radius};
    measure(2 * s.radius, out);
  }
  void place(const BoxShape& s, Placed& out) {
    want(s.center.allFinite() && positive(s.size), "the box is empty.",
         "Its size is the length of its edges in mm, each above 0.");
    const Brick brick{s.center, 0.5 * s.size, axes(s.x_axis, s.y_axis)};
    const Vec<3> reach = brick.axes.cwiseAbs() * brick.half;
    out.shape = brick;
    out.box = {s.center - reach, s.center + reach};
    measure(s.size.minCoeff(), out);
  }
  void place(const CylinderShape& s, Placed& out) {
    const double length = (s.to - s.from).norm();
    want(positive(length) && positive(s.radius), "the cylinder is empty.",
         "Its ends must be apart and its radius positive, in mm.");
    const Vec<3> axis = positive(length) ? Vec<3>((s.to - s.from) / length) : Vec<3>::UnitZ();
    const Rod rod{0.5 * (s.from + s.to), axis, 0.5 * length, s.radius};
    const Vec<3> reach = rod.half * axis.cwiseAbs() +
                         s.radius * (1 - axis.array().square()).max(0.0).sqrt().matrix();
    out.shape = rod;
    out.box = {rod.center - reach, rod.center + reach};
    measure(std::min(length, 2 * s.radius), out);
  }
  void place(const FacesShape& s, Placed& out) {
    want(s.depth >= 0 && std::isfinite(s.depth), "the depth under the faces is negative.",
         "0 is the faces alone.");
    want(s.others || !s.ids.empty() || !s.names.empty(), "it picks no face.", known_faces());
    std::vector<char> picked(surface_.faces.size(), 0);
    for (const std::int32_t id : s.ids) {
      const bool known = id >= 0 && static_cast<std::size_t>(id) < picked.size();
      want(known, "the body has no face " + std::to_string(id) + ".", known_faces());
      if (known) picked[id] = 1;
    }
    for (const std::string& name : s.names) {
      bool found = false;
      for (std::size_t f = 0; f < picked.size(); ++f)
        if (surface_.faces[f].name == name) picked[f] = found = true;
      want(found, "the body has no face called \"" + name + "\".", known_faces());
    }
    if (s.others)
      for (char& p : picked) p = !p;
    ReferenceSurface<3> part;
    double area = 0;
    std::vector<std::int32_t> fresh(surface_.points.size(), -1);
    for (std::size_t f = 0; f < surface_.facets.size(); ++f) {
      if (!picked[surface_.facet_face[f]]) continue;
      auto facet = surface_.facets[f];
      for (std::int32_t& v : facet) {
        if (fresh[v] < 0) {
          fresh[v] = static_cast<std::int32_t>(part.points.size());
          part.points.push_back(surface_.points[v]);
          out.box.add(surface_.points[v]);
        }
        v = fresh[v];
      }
      part.facets.push_back(facet);
      area += 0.5 *
              facet_normal<3>({part.points[facet[0]], part.points[facet[1]], part.points[facet[2]]})
                  .norm();
    }
    want(!part.facets.empty(), "its faces have no triangle.", known_faces());
    if (complaint_) return;
    part.facet_face.assign(part.facets.size(), 0);
    part.faces.resize(1);
    out.box.lo.array() -= s.depth;
    out.box.hi.array() += s.depth;
    out.shape = Skin{std::make_shared<const Locator<3>>(part), s.depth};
    measure(std::max(s.depth, 0.5 * std::sqrt(area)), out);
  }
  /// Faces, or all of them where the object is for the whole body.
  void place_layer(const SizingShape& shape, Placed& out) {
    FacesShape walls;
    walls.others = true;
    if (const auto* faces = std::get_if<FacesShape>(&shape)) walls = *faces;
    want(std::holds_alternative<FacesShape>(shape) || std::holds_alternative<WholeBody>(shape),
         "a boundary layer lies on faces.", "Pick faces, or take the whole body.");
    place(walls, out);
  }
  static void measure(double extent, Placed& out) {
    out.extent = extent;
    out.rounding = kRounding * (out.box.hi - out.box.lo).norm();
  }
  std::string known_faces() const {
    std::string names;
    int count = 0;
    for (const SurfaceFace& face : surface_.faces)
      if (!face.name.empty() && ++count <= 8)
        names += (names.empty() ? "" : ", ") + ("\"" + face.name + "\"");
    return "Faces are numbered from 0; the body has " + std::to_string(surface_.faces.size()) +
           (names.empty() ? "" : "; names are " + names + (count > 8 ? ", .." : "")) + ".";
  }

  Correction prepared(const SizeCorrection& c) {
    want(c.size.has_value() != c.factor.has_value(),
         "it needs either a size or a factor of the natural size.", "Give one of them.");
    want(positive(c.size.value_or(c.factor.value_or(1))), "the size asked is not positive.",
         "Give a size in mm, or a factor of the natural size, above 0.");
    want(c.gradation > 1 && std::isfinite(c.gradation), "the gradation is not above 1.",
         "It is the growth of sizes per unit length: 1.3 is common.");
    return {c.size.value_or(0), c.factor.value_or(0), std::log(c.gradation), c.keep_directions};
  }
  Layer prepared(const BoundaryLayer& l, Placed& place) {
    want(positive(l.thickness), "the thickness of the boundary layer is not positive.",
         "Give it in mm.");
    want(l.layers >= 1, "a boundary layer has at least one element across.", "3 is common.");
    want(l.gradation > 1 && std::isfinite(l.gradation), "the gradation is not above 1.",
         "It is the growth of sizes beyond the layer per unit length: 1.5 is common.");
    place.extent = l.thickness / std::max(1, l.layers);
    return {std::get<Skin>(place.shape).facets, l.thickness,
            l.thickness / (kFinerLayers * l.layers), std::log(l.gradation)};
  }
  Zone prepared(const AnalyticZone& z) {
    Zone out;
    want(positive(z.sizes), "a size of the zone is not positive.", "Give three sizes in mm.");
    out.sizes = z.sizes;
    out.replace = z.replace;
    const RadialProgression& g = z.progression;
    const bool progresses = g.kind != RadialProgression::Kind::none;
    std::visit(Overloaded{[&](const CartesianFrame& f) {
                            out.constant = metric_from_sizes<3>(axes(f.x_axis, f.y_axis), z.sizes);
                            want(!progresses,
                                 "sizes that change with the radius need one, and a Cartesian "
                                 "frame has none.",
                                 "Use a cylindrical or a spherical frame.");
                          },
                          [&](const CylindricalFrame& f) {
                            out.kind = Zone::Kind::cylindrical;
                            out.origin = f.origin;
                            out.axis = direction(f.axis);
                          },
                          [&](const SphericalFrame& f) {
                            out.kind = Zone::Kind::spherical;
                            out.origin = f.origin;
                            out.axis = direction(f.axis);
                          }},
               z.frame);
    want(out.origin.allFinite(), "the origin of its frame is not a place.", "Give numbers in mm.");
    if (progresses) {
      want(g.from >= 0 && g.to > g.from && std::isfinite(g.to),
           "the radii between which sizes change must grow.", "0 <= from < to, in mm.");
      want(positive(g.sizes), "a size of the zone is not positive.", "Give three sizes in mm.");
      out.last_sizes = g.sizes;
      out.from = g.from;
      out.to = g.to;
      out.geometric = g.kind == RadialProgression::Kind::geometric;
    }
    return out;
  }

  const ReferenceSurface<3>& surface_;
  std::optional<Error> complaint_;
};

}  // namespace

std::vector<std::int32_t> picked_faces(const FacesShape& shape,
                                       const ReferenceSurface<3>& surface) {
  std::vector<std::int32_t> picked;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const auto id = static_cast<std::int32_t>(f);
    const bool named =
        std::count(shape.ids.begin(), shape.ids.end(), id) > 0 ||
        std::count(shape.names.begin(), shape.names.end(), surface.faces[f].name) > 0;
    if (named != shape.others) picked.push_back(id);
  }
  return picked;
}

struct SizingField::Impl {
  std::vector<Placement> ruling, refining;
};

Result<SizingField> SizingField::make(const std::vector<SizingObject>& objects,
                                      const ReferenceSurface<3>& surface) {
  SizingField field;
  if (objects.empty()) return field;
  auto impl = std::make_shared<Impl>();
  Reader reader(surface);
  for (const SizingObject& object : objects) {
    Result<Placement> placement = reader.read(object);
    if (!placement) return placement.error();
    auto& list = placement->rules() ? impl->ruling : impl->refining;
    list.push_back(std::move(*placement));
  }
  field.impl_ = std::move(impl);
  return field;
}

Metric<3> SizingField::apply(const Vec<3>& x, const Metric<3>& natural) const {
  if (!impl_) return natural;
  Metric<3> base = natural;
  for (const Placement& p : impl_->ruling) rule(p, x, base);
  if (impl_->refining.empty()) return base;
  const Range range(base);
  Metric<3> metric = base;
  for (const Placement& p : impl_->refining) refine(p, x, base, range, metric);
  return metric;
}

bool SizingField::may_coarsen() const { return impl_ && !impl_->ruling.empty(); }

double SizingField::detail(const Box<3>& box) const {
  double least = kInfinity;
  if (!impl_) return least;
  for (const auto* list : {&impl_->ruling, &impl_->refining})
    for (const Placement& p : *list) {
      const Box<3>& own = p.place.box;
      if ((own.lo.array() <= box.hi.array()).all() && (own.hi.array() >= box.lo.array()).all())
        least = std::min(least, p.place.extent);
    }
  return least;
}

}  // namespace lamella
