#include "core/study/zone_surface.h"

#include <algorithm>
#include <numbers>

#include "core/geometry/soup.h"
#include "core/geometry/triangles.h"

namespace lamella {

namespace {

/// Where normal . x <= offset.
struct Plane {
  Vec<3> normal;
  double offset;
};

/// Chords of a circle that stay within the tolerance.
int chords(double radius, double tolerance) {
  const double half = std::acos(std::clamp(1 - tolerance / radius, 0.5, 1 - 1e-8));
  return std::clamp(static_cast<int>(std::ceil(std::numbers::pi / half)), 12, 720);
}

void add_fan(const std::vector<Vec<3>>& polygon, TriangleSoup& soup) {
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    soup.push_back({polygon[0], polygon[i], polygon[i + 1]});
}

/// The convex body between the planes as triangles; empty where they leave nothing of the box.
TriangleSoup convex_body(const std::vector<Plane>& planes) {
  const double far = [&] {
    double reach = 0;
    for (const Plane& p : planes) reach = std::max(reach, std::abs(p.offset));
    return 10 * (reach + 1);
  }();
  TriangleSoup soup;
  for (std::size_t face = 0; face < planes.size(); ++face) {
    // A large square in the plane, counterclockwise seen from outside, cut by all others.
    const Vec<3>& n = planes[face].normal;
    const Vec<3> u = n.unitOrthogonal(), v = n.cross(u), o = planes[face].offset * n;
    std::vector<Vec<3>> polygon{o - far * u - far * v, o + far * u - far * v, o + far * u + far * v,
                                o - far * u + far * v};
    for (std::size_t by = 0; by < planes.size() && !polygon.empty(); ++by) {
      if (by == face) continue;
      std::vector<Vec<3>> kept;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec<3>&a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = planes[by].normal.dot(a) - planes[by].offset;
        const double db = planes[by].normal.dot(b) - planes[by].offset;
        if (da <= 0) kept.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) kept.push_back(a + da / (da - db) * (b - a));
      }
      polygon = std::move(kept);
    }
    if (polygon.size() >= 3) add_fan(polygon, soup);
  }
  return soup;
}

std::vector<Plane> planes_of(const ZoneBox& box) {
  std::vector<Plane> planes;
  for (int k = 0; k < 3; ++k) {
    planes.push_back({Vec<3>::Unit(k), box.high[k]});
    planes.push_back({-Vec<3>::Unit(k), -box.low[k]});
  }
  return planes;
}

/// A prism whose edges lie on the cylinder.
std::vector<Plane> planes_of(const ZoneCylinder& c, int sides) {
  const Vec<3> axis = (c.to - c.from).normalized();
  const Vec<3> u = axis.unitOrthogonal(), v = axis.cross(u);
  std::vector<Plane> planes{{axis, axis.dot(c.to)}, {-axis, -axis.dot(c.from)}};
  const double turn = 2 * std::numbers::pi / sides;
  for (int i = 0; i < sides; ++i) {
    const Vec<3> n = std::cos(i * turn) * u + std::sin(i * turn) * v;
    planes.push_back({n, n.dot(c.from) + c.radius * std::cos(turn / 2)});
  }
  return planes;
}

TriangleSoup cylinder(const ZoneCylinder& c, double tolerance) {
  const int sides = chords(c.radius, tolerance);
  const Vec<3> axis = (c.to - c.from).normalized();
  const Vec<3> u = axis.unitOrthogonal(), v = axis.cross(u);
  std::vector<Vec<3>> low, high;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    const Vec<3> out = c.radius * (std::cos(angle) * u + std::sin(angle) * v);
    low.push_back(c.from + out);
    high.push_back(c.to + out);
  }
  TriangleSoup soup;
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t j = (i + 1) % low.size();
    soup.push_back({low[i], low[j], high[j]});
    soup.push_back({low[i], high[j], high[i]});
    soup.push_back({c.from, low[j], low[i]});
    soup.push_back({c.to, high[i], high[j]});
  }
  return soup;
}

/// Octahedron with its triangles cut in four until none lies deeper than the tolerance: those in
/// the middle of its faces are larger than those along its edges.
TriangleSoup ball(const ZoneBall& b, double tolerance) {
  TriangleSoup soup;
  for (const double z : {1.0, -1.0})
    for (int k = 0; k < 4; ++k) {
      const double a = k * std::numbers::pi / 2, c = a + std::numbers::pi / 2;
      const Vec<3> p(std::cos(a), std::sin(a), 0), q(std::cos(c), std::sin(c), 0), r(0, 0, z);
      if (z > 0)
        soup.push_back({p, q, r});
      else
        soup.push_back({q, p, r});
    }
  const auto deep = [&](const std::array<Vec<3>, 3>& facet) {
    return b.radius * (1 - facet[0].dot(facet_normal<3>(facet).normalized())) > tolerance;
  };
  constexpr std::size_t most = 1'000'000;
  while (soup.size() < 128 || (soup.size() < most && std::any_of(soup.begin(), soup.end(), deep))) {
    TriangleSoup finer;
    for (const auto& [p, q, r] : soup) {
      const Vec<3> pq = (p + q).normalized(), qr = (q + r).normalized(), rp = (r + p).normalized();
      finer.push_back({p, pq, rp});
      finer.push_back({pq, q, qr});
      finer.push_back({rp, qr, r});
      finer.push_back({pq, qr, rp});
    }
    soup = std::move(finer);
  }
  for (auto& facet : soup)
    for (Vec<3>& p : facet) p = b.center + b.radius * p;
  return soup;
}

/// Volume between the facets that are chords of the cylinder's side and the side, mm^3.
double beyond_chords(const ReferenceSurface<3>& surface, const ZoneCylinder& c) {
  const Vec<3> axis = (c.to - c.from).normalized();
  const auto outward = [&](const Vec<3>& x) -> Vec<3> {
    const Vec<3> from = x - c.from;
    return from - from.dot(axis) * axis;
  };
  double volume = 0;
  for (const auto& f : surface.facets) {
    const std::array<Vec<3>, 3> p{surface.points[f[0]], surface.points[f[1]], surface.points[f[2]]};
    const Vec<3> normal = (p[1] - p[0]).cross(p[2] - p[0]);
    const double area = normal.norm() / 2, apart = normal.dot(p[0] - c.from) / (2 * area);
    // Its planes are those of at least 12 chords (planes_of).
    if (std::abs(normal.dot(axis)) > 1e-9 * area || apart < 0.96 * c.radius) continue;
    for (int k = 0; k < 3; ++k)
      volume += area / 3 * (c.radius - outward((p[k] + p[(k + 1) % 3]) / 2).norm());
  }
  return volume;
}

}  // namespace

Result<ReferenceSurface<3>> zone_surface(const StudyZone& zone, const std::vector<StudyZone>& all,
                                         const StudyZone& domain, double tolerance) {
  std::vector<Plane> planes;
  if (const auto* b = std::get_if<ZoneBox>(&domain.shape)) planes = planes_of(*b);
  if (const auto* c = std::get_if<ZoneCylinder>(&domain.shape))
    planes = planes_of(*c, chords(c->radius, tolerance));
  TriangleSoup soup;
  if (const auto* b = std::get_if<ZoneBall>(&zone.shape)) {
    soup = ball(*b, tolerance);
  } else if (const auto* box = std::get_if<ZoneBox>(&zone.shape)) {
    soup = convex_body(planes_of(*box));
  } else if (const auto* c = std::get_if<ZoneCylinder>(&zone.shape)) {
    soup = cylinder(*c, tolerance);
  } else if (const auto* h = std::get_if<ZoneHalfSpace>(&zone.shape)) {
    const double length = h->normal.norm();
    planes.push_back({h->normal / length, h->offset / length});
    soup = convex_body(planes);
  } else if (const auto* cell = std::get_if<ZoneCell>(&zone.shape)) {
    for (const StudyZone& other : all) {
      const auto* rival = std::get_if<ZoneCell>(&other.shape);
      if (!rival || rival->set != cell->set || rival->seed == cell->seed) continue;
      const Vec<3> n = (rival->seed - cell->seed).normalized();
      planes.push_back({n, n.dot((rival->seed + cell->seed) / 2)});
    }
    soup = convex_body(planes);
  }
  const auto nothing = [&] {
    return Error{Code::bad_input, "Zone \"" + zone.name + "\": nothing of it lies in the domain.",
                 "Move it, or make the domain larger."};
  };
  if (soup.size() < 4) return nothing();
  Result<ReferenceSurface<3>> surface = surface_from_soup(soup);
  if (!surface) return nothing();
  return surface;
}

double zone_volume(const StudyZone& zone, const ReferenceSurface<3>& surface,
                   const StudyZone& domain) {
  constexpr double pi = std::numbers::pi;
  if (const auto* b = std::get_if<ZoneBall>(&zone.shape))
    return 4 * pi / 3 * b->radius * b->radius * b->radius;
  if (const auto* c = std::get_if<ZoneCylinder>(&zone.shape))
    return pi * c->radius * c->radius * (c->to - c->from).norm();
  const bool ends = std::holds_alternative<ZoneHalfSpace>(zone.shape) ||
                    std::holds_alternative<ZoneCell>(zone.shape);
  const auto* hull = std::get_if<ZoneCylinder>(&domain.shape);
  return enclosed_measure(surface) + (ends && hull ? beyond_chords(surface, *hull) : 0);
}

}  // namespace lamella
