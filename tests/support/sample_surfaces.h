#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "core/geometry/surface.h"

namespace lamella::testing {

/// Puts every facet on face 0, unless faces are given already.
template <int D>
ReferenceSurface<D> with_faces(ReferenceSurface<D> s) {
  if (s.facet_face.empty()) s.facet_face.assign(s.facets.size(), 0);
  std::int32_t last = 0;
  for (const auto f : s.facet_face) last = std::max(last, f);
  s.faces.resize(static_cast<std::size_t>(last) + 1);
  return s;
}

/// Boundary of the union of grid cells: x, y, z are growing coordinates, cell(i, j, k) says whether
/// [x_i, x_i+1] x .. belongs to the body. Faces 0..5: the sides -x +x -y +y -z +z.
inline ReferenceSurface<3> cell_surface(const std::array<std::vector<double>, 3>& grid,
                                        const std::function<bool(int, int, int)>& cell) {
  ReferenceSurface<3> s;
  std::map<std::array<int, 3>, std::int32_t> ids;
  const auto vertex = [&](const std::array<int, 3>& i) {
    const auto [it, fresh] = ids.emplace(i, static_cast<std::int32_t>(s.points.size()));
    if (fresh) s.points.push_back({grid[0][i[0]], grid[1][i[1]], grid[2][i[2]]});
    return it->second;
  };
  std::array<int, 3> n;
  for (int a = 0; a < 3; ++a) n[a] = static_cast<int>(grid[a].size()) - 1;
  const auto full = [&](const std::array<int, 3>& c) {
    for (int a = 0; a < 3; ++a)
      if (c[a] < 0 || c[a] >= n[a]) return false;
    return cell(c[0], c[1], c[2]);
  };
  for (int i = 0; i < n[0]; ++i)
    for (int j = 0; j < n[1]; ++j)
      for (int k = 0; k < n[2]; ++k)
        for (int side = 0; side < 6 && full({i, j, k}); ++side) {
          const int a = side / 2, b = (a + 1) % 3, c = (a + 2) % 3;
          std::array<int, 3> other{i, j, k};
          other[a] += side % 2 ? 1 : -1;
          if (full(other)) continue;
          std::array<int, 3> p{i, j, k};
          p[a] += side % 2;
          std::array<std::int32_t, 4> q;
          for (int t = 0; t < 4; ++t) {
            auto at = p;
            at[b] += t == 1 || t == 2;
            at[c] += t >= 2;
            q[t] = vertex(at);
          }
          if (side % 2 == 0) std::swap(q[1], q[3]);
          s.facets.push_back({q[0], q[1], q[2]});
          s.facets.push_back({q[0], q[2], q[3]});
          s.facet_face.insert(s.facet_face.end(), 2, side);
        }
  return with_faces(s);
}

inline std::vector<double> steps(double from, double to, int n) {
  std::vector<double> x;
  for (int i = 0; i <= n; ++i) x.push_back(from + (to - from) * i / n);
  return x;
}

/// Box [0, size] with n cells an axis.
inline ReferenceSurface<3> box_surface(const Vec<3>& size, std::array<int, 3> n = {1, 1, 1}) {
  return cell_surface({steps(0, size[0], n[0]), steps(0, size[1], n[1]), steps(0, size[2], n[2])},
                      [](int, int, int) { return true; });
}

/// L profile in (x, z): two walls of thickness t, legs 1 x 1, extruded along y by 1.
inline ReferenceSurface<3> l_surface(double t) {
  return cell_surface({std::vector{0.0, t, 1.0}, {0.0, 0.5, 1.0}, {0.0, t, 1.0}},
                      [](int i, int, int k) { return i == 0 || k == 0; });
}

/// Prism over a convex or concave polygon of (x, z), counterclockwise seen from -y, along y in
/// [0, width]; `fan` is the vertex from which the two ends are cut into triangles.
inline ReferenceSurface<3> prism_surface(const std::vector<Vec<2>>& polygon, double width) {
  ReferenceSurface<3> s;
  const auto n = static_cast<std::int32_t>(polygon.size());
  for (const double y : {0.0, width})
    for (const auto& p : polygon) s.points.push_back({p[0], y, p[1]});
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t j = (i + 1) % n;
    s.facets.push_back({i, j, n + j});
    s.facets.push_back({i, n + j, n + i});
    s.facet_face.insert(s.facet_face.end(), 2, i);
  }
  for (std::int32_t i = 1; i + 1 < n; ++i) {
    s.facets.push_back({0, i + 1, i});
    s.facets.push_back({n, n + i, n + i + 1});
    s.facet_face.push_back(n);
    s.facet_face.push_back(n + 1);
  }
  for (auto& f : s.facets) std::swap(f[1], f[2]);
  return with_faces(s);
}

/// Icosahedron refined `levels` times, vertices on the sphere.
inline ReferenceSurface<3> sphere_surface(double radius, int levels,
                                          const Vec<3>& center = {0, 0, 0}, bool hollow = false) {
  ReferenceSurface<3> s;
  const double g = std::numbers::phi;
  for (const auto& [a, b] : {std::pair{-1., g}, {1., g}, {-1., -g}, {1., -g}}) {
    s.points.push_back({a, b, 0});
    s.points.push_back({0, a, b});
    s.points.push_back({b, 0, a});
  }
  // Facets: all triples at the shortest mutual distance 2, turned outward.
  const auto near = [&](int a, int b) { return (s.points[a] - s.points[b]).norm() < 2.01; };
  for (int a = 0; a < 12; ++a)
    for (int b = a + 1; b < 12; ++b)
      for (int c = b + 1; c < 12; ++c)
        if (near(a, b) && near(b, c) && near(a, c)) s.facets.push_back({a, b, c});
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [it, fresh] = middles.emplace(std::minmax(a, b), s.points.size());
      if (fresh) s.points.push_back(0.5 * (s.points[a] + s.points[b]));
      return it->second;
    };
    decltype(s.facets) finer;
    for (const auto& [a, b, c] : s.facets) {
      const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    s.facets = finer;
    for (auto& p : s.points) p.normalize();
  }
  for (auto& f : s.facets) {
    const Vec<3> n = facet_normal<3>({s.points[f[0]], s.points[f[1]], s.points[f[2]]});
    if ((n.dot(s.points[f[0]]) < 0) != hollow) std::swap(f[1], f[2]);
  }
  for (auto& p : s.points) p = center + radius * p.normalized();
  return with_faces(s);
}

/// Tube along z: inner radius a, outer radius b, `around` facets around (polygons inscribed).
inline ReferenceSurface<3> tube_surface(double a, double b, double height, int around, int along) {
  ReferenceSurface<3> s;
  const auto id = [&](int ring, int i, int k) {
    return static_cast<std::int32_t>((ring * (along + 1) + k) * around + i % around);
  };
  for (const double r : {a, b})
    for (int k = 0; k <= along; ++k)
      for (int i = 0; i < around; ++i) {
        const double phi = 2 * std::numbers::pi * i / around;
        s.points.push_back({r * std::cos(phi), r * std::sin(phi), height * k / along});
      }
  const auto quad = [&](std::int32_t p, std::int32_t q, std::int32_t r, std::int32_t t, int face) {
    s.facets.push_back({p, q, r});
    s.facets.push_back({p, r, t});
    s.facet_face.insert(s.facet_face.end(), 2, face);
  };
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < along; ++k) {
      quad(id(1, i, k), id(1, i + 1, k), id(1, i + 1, k + 1), id(1, i, k + 1), 0);
      quad(id(0, i, k), id(0, i, k + 1), id(0, i + 1, k + 1), id(0, i + 1, k), 1);
    }
    quad(id(0, i, 0), id(0, i + 1, 0), id(1, i + 1, 0), id(1, i, 0), 2);
    quad(id(0, i, along), id(1, i, along), id(1, i + 1, along), id(0, i + 1, along), 3);
  }
  return with_faces(s);
}

/// Both bodies in one surface.
template <int D>
ReferenceSurface<D> together(ReferenceSurface<D> s, const ReferenceSurface<D>& other) {
  const auto points = static_cast<std::int32_t>(s.points.size());
  const auto faces = static_cast<std::int32_t>(s.faces.size());
  s.points.insert(s.points.end(), other.points.begin(), other.points.end());
  for (auto f : other.facets) {
    for (auto& v : f) v += points;
    s.facets.push_back(f);
  }
  for (const auto f : other.facet_face) s.facet_face.push_back(f + faces);
  s.faces.insert(s.faces.end(), other.faces.begin(), other.faces.end());
  return s;
}

template <int D>
ReferenceSurface<D> moved(ReferenceSurface<D> s, const Mat<D>& rotation, const Vec<D>& shift) {
  for (auto& p : s.points) p = rotation * p + shift;
  return s;
}

inline Mat<3> turn(double angle, const Vec<3>& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// Regular polygon in the plane, outward facets.
inline ReferenceSurface<2> polygon_surface(double radius, int n) {
  ReferenceSurface<2> s;
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * std::numbers::pi * i / n;
    s.points.push_back({radius * std::cos(phi), radius * std::sin(phi)});
    // facet_normal<2> of (a, b) is the left side of a -> b: outward runs clockwise.
    s.facets.push_back({(i + 1) % n, i});
    s.facet_face.push_back(i % 3);
  }
  return with_faces(s);
}

}  // namespace lamella::testing
