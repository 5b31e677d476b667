#pragma once

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <tuple>

#include "core/geometry/surface.h"

/// Small named surfaces for tests, all closed and wound outward.
namespace lamella::test {

inline void number_facets(ReferenceSurface<3>& s) {
  s.facet_face.resize(s.facets.size());
  for (std::size_t i = 0; i < s.facets.size(); ++i)
    s.facet_face[i] = static_cast<std::int32_t>(i % 7);
  s.faces.resize(7);
}

/// Union of the unit cells for which `inside(i, j, k)` is true, times `scale`; each cell side is
/// cut in two triangles.
template <class Inside>
ReferenceSurface<3> cells(int nx, int ny, int nz, const Vec<3>& scale, Inside inside) {
  ReferenceSurface<3> s;
  std::map<std::array<int, 3>, std::int32_t> ids;
  const auto id = [&](const std::array<int, 3>& c) {
    const auto [it, added] = ids.try_emplace(c, static_cast<std::int32_t>(s.points.size()));
    if (added) s.points.push_back(Vec<3>(c[0], c[1], c[2]).cwiseProduct(scale));
    return it->second;
  };
  const int n[3] = {nx, ny, nz};
  const auto full = [&](const std::array<int, 3>& c) {
    for (int a = 0; a < 3; ++a)
      if (c[a] < 0 || c[a] >= n[a]) return false;
    return static_cast<bool>(inside(c[0], c[1], c[2]));
  };
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        const std::array<int, 3> c{i, j, k};
        if (!full(c)) continue;
        for (int a = 0; a < 3; ++a)
          for (int side = 0; side < 2; ++side) {
            std::array<int, 3> next = c;
            next[a] += side ? 1 : -1;
            if (full(next)) continue;
            const int b = (a + 1) % 3, d = (a + 2) % 3;
            std::array<int, 3> q[4] = {c, c, c, c};
            for (auto& corner : q) corner[a] += side;
            q[1][b] += 1, q[2][b] += 1, q[2][d] += 1, q[3][d] += 1;
            if (!side) std::swap(q[1], q[3]);
            const std::int32_t v[4] = {id(q[0]), id(q[1]), id(q[2]), id(q[3])};
            s.facets.push_back({v[0], v[1], v[2]});
            s.facets.push_back({v[0], v[2], v[3]});
          }
      }
  number_facets(s);
  return s;
}

inline ReferenceSurface<3> box(int nx, int ny, int nz, const Vec<3>& scale = Vec<3>::Ones()) {
  return cells(nx, ny, nz, scale, [](int, int, int) { return true; });
}

inline ReferenceSurface<3> ell(int n) {
  return cells(2 * n, n, 2 * n, Vec<3>::Ones(), [n](int i, int, int k) { return i < n || k < n; });
}

inline ReferenceSurface<3> tee(int n) {
  return cells(3 * n, n, 3 * n, Vec<3>::Ones(),
               [n](int i, int, int k) { return k >= 2 * n || (i >= n && i < 2 * n); });
}

/// Octahedron whose edges are cut in `n`, pushed onto the sphere of radius r; `inward` turns it
/// inside out, for cavities.
inline ReferenceSurface<3> sphere(int n, double r, bool inward = false) {
  ReferenceSurface<3> s;
  std::map<std::array<int, 3>, std::int32_t> ids;
  const auto id = [&](int x, int y, int z) {
    const auto [it, added] = ids.try_emplace({x, y, z}, static_cast<std::int32_t>(s.points.size()));
    if (added) s.points.push_back(r * Vec<3>(x, y, z).normalized());
    return it->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const int sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
    const auto add = [&](std::array<int, 2> a, std::array<int, 2> b, std::array<int, 2> c) {
      const auto at = [&](const std::array<int, 2>& p) {
        return id(sx * p[0], sy * p[1], sz * (n - p[0] - p[1]));
      };
      std::array<std::int32_t, 3> f{at(a), at(b), at(c)};
      if ((sx * sy * sz < 0) != inward) std::swap(f[1], f[2]);
      s.facets.push_back(f);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        add({i, j}, {i + 1, j}, {i, j + 1});
        if (i + j + 2 <= n) add({i + 1, j}, {i + 1, j + 1}, {i, j + 1});
      }
  }
  number_facets(s);
  return s;
}

/// Both surfaces as one, as a body with a cavity.
inline ReferenceSurface<3> joined(ReferenceSurface<3> a, const ReferenceSurface<3>& b) {
  const auto shift = static_cast<std::int32_t>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (auto f : b.facets) a.facets.push_back({f[0] + shift, f[1] + shift, f[2] + shift});
  number_facets(a);
  return a;
}

/// A clean ASCII STL; empty when the file is missing.
inline ReferenceSurface<3> ascii_stl(const std::string& path) {
  ReferenceSurface<3> s;
  std::ifstream in(path);
  std::map<std::tuple<double, double, double>, std::int32_t> ids;
  std::vector<std::int32_t> corners;
  for (std::string word; in >> word;) {
    if (word != "vertex") continue;
    Vec<3> x;
    in >> x[0] >> x[1] >> x[2];
    const auto [it, added] =
        ids.try_emplace({x[0], x[1], x[2]}, static_cast<std::int32_t>(s.points.size()));
    if (added) s.points.push_back(x);
    corners.push_back(it->second);
  }
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    s.facets.push_back({corners[i], corners[i + 1], corners[i + 2]});
  number_facets(s);
  return s;
}

}  // namespace lamella::test
