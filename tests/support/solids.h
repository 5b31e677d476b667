#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <numbers>
#include <string>

#include "core/geometry/foot.h"
#include "core/geometry/locator.h"
#include "core/mesh/boundary.h"
#include "core/mesh/sample_meshes.h"

/// Bodies whose exact shape is known, meshed from grids, and what a mesh of them must keep.
namespace lamella::test {

struct Solid {
  std::string name;
  SimplexMesh<3> mesh;          ///< boundary nodes on the exact shape
  ReferenceSurface<3> surface;  ///< its boundary: the tessellation
  double volume = 0;            ///< of the exact shape
  double lost = 0;              ///< volume that the tessellation misses: sum of the faces' amounts
  std::function<double(const Vec<3>&)> distance;  ///< to the exact shape
  std::vector<Vec<3>> samples;                    ///< points of the exact shape, dense
};

/// Cells of a grid that `keep` tells, each cut into six tetrahedra; axis 0 closes on itself when
/// `ring`. `face` numbers a boundary facet by its corners.
inline SimplexMesh<3> grid_mesh(const std::array<int, 3>& n, bool ring,
                                const std::function<bool(int, int, int)>& keep,
                                const std::function<Vec<3>(int, int, int)>& position,
                                const std::function<int(const std::array<Vec<3>, 3>&)>& face) {
  SimplexMesh<3> mesh;
  const std::array<int, 3> nodes{ring ? n[0] : n[0] + 1, n[1] + 1, n[2] + 1};
  const auto id = [&](std::array<int, 3> i) {
    return 1 + i[0] % nodes[0] + nodes[0] * (i[1] + nodes[1] * i[2]);
  };
  for (int k = 0; k < nodes[2]; ++k)
    for (int j = 0; j < nodes[1]; ++j)
      for (int i = 0; i < nodes[0]; ++i) mesh.points.push_back(position(i, j, k));
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        if (!keep(i, j, k)) continue;
        std::array<int, 3> axes{0, 1, 2};
        do {
          std::array<int, 3> at{i, j, k};
          SimplexMesh<3>::Element e{id(at)};
          for (int step = 0; step < 3; ++step) {
            ++at[axes[step]];
            e[step + 1] = id(at);
          }
          if (signed_measure<3>(mesh.corners(e)) < 0) std::swap(e[2], e[3]);
          mesh.elements.push_back(e);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  mesh.element_body.assign(mesh.elements.size(), 0);
  rebuild_facets(mesh);
  compact_nodes(mesh);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    mesh.facet_face[f] = face(mesh.corners(mesh.facets[f]));
  return mesh;
}

/// Edges between boundary facets of different faces, as pairs of nodes, each with its two faces.
inline std::map<std::array<NodeId, 2>, std::array<int, 2>> face_borders(
    const SimplexMesh<3>& mesh) {
  std::map<std::array<NodeId, 2>, std::array<int, 2>> borders;
  std::map<std::array<NodeId, 2>, int> seen;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      std::array<NodeId, 2> e{mesh.facets[f][k], mesh.facets[f][(k + 1) % 3]};
      std::sort(e.begin(), e.end());
      const auto [it, added] = seen.emplace(e, mesh.facet_face[f]);
      if (!added && it->second != mesh.facet_face[f]) {
        const auto [low, high] = std::minmax(it->second, mesh.facet_face[f]);
        borders[e] = {low, high};
      }
    }
  return borders;
}

/// The boundary of a mesh, with features where faces meet.
inline ReferenceSurface<3> featured_surface(const SimplexMesh<3>& mesh,
                                            const std::vector<Vec<3>>& corners) {
  ReferenceSurface<3> s;
  std::vector<std::int32_t> vertex(mesh.points.size(), -1);
  int faces = 0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    std::array<std::int32_t, 3> facet{};
    for (int k = 0; k < 3; ++k) {
      auto& v = vertex[mesh.facets[f][k]];
      if (v < 0) {
        v = static_cast<std::int32_t>(s.points.size());
        s.points.push_back(mesh.points[mesh.facets[f][k]]);
      }
      facet[k] = v;
    }
    s.facets.push_back(facet);
    s.facet_face.push_back(mesh.facet_face[f]);
    faces = std::max(faces, mesh.facet_face[f] + 1);
  }
  s.faces.resize(static_cast<std::size_t>(faces));
  for (const auto& [e, pair] : face_borders(mesh))
    s.feature_edges.push_back({vertex[e[0]], vertex[e[1]]});
  for (const Vec<3>& c : corners)
    for (std::size_t v = 0; v < s.points.size(); ++v)
      if ((s.points[v] - c).norm() < 1e-12) s.corners.push_back(static_cast<std::int32_t>(v));
  return s;
}

inline double volume_of(const SimplexMesh<3>& mesh) {
  double v = 0;
  for (const auto& e : mesh.elements) v += signed_measure<3>(mesh.corners(e));
  return v;
}

inline Solid sphere_solid(int n) {
  Solid s;
  s.name = "sphere";
  s.mesh = ball_mesh<3>(n, 1);
  s.volume = 4 * std::numbers::pi / 3;
  s.lost = s.volume - volume_of(s.mesh);
  s.surface = featured_surface(s.mesh, {});
  s.distance = [](const Vec<3>& x) { return std::abs(x.norm() - 1); };
  constexpr int count = 40000;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * i + 1) / count, phi = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    s.samples.push_back({r * std::cos(phi), r * std::sin(phi), z});
  }
  return s;
}

/// Radii 1 and 0.4; n cells across the tube, `around` along it.
inline Solid torus_solid(int n, int around) {
  static constexpr double big = 1, small = 0.4, pi = std::numbers::pi;
  const auto at = [=](double along, double x, double y) {
    return Vec<3>((big + x) * std::cos(along), (big + x) * std::sin(along), y);
  };
  Solid s;
  s.name = "torus";
  s.mesh = grid_mesh(
      {around, n, n}, true, [](int, int, int) { return true; },
      [&](int i, int j, int k) {
        Vec<2> p(2.0 * j / n - 1, 2.0 * k / n - 1);
        const double most = p.lpNorm<Eigen::Infinity>();
        if (most > 0) p *= most / p.norm();
        return at(2 * pi * i / around, small * p[0], small * p[1]);
      },
      [](const auto&) { return 0; });
  s.surface = featured_surface(s.mesh, {});
  s.volume = 2 * pi * pi * big * small * small;
  s.lost = s.volume - volume_of(s.mesh);
  s.distance = [](const Vec<3>& x) {
    return std::abs(std::hypot(x.head<2>().norm() - big, x[2]) - small);
  };
  for (int i = 0; i < 300; ++i)
    for (int j = 0; j < 150; ++j)
      s.samples.push_back(at(2 * pi * i / 300, small * std::cos(2 * pi * j / 150),
                             small * std::sin(2 * pi * j / 150)));
  return s;
}

/// Box [-1, 1]^2 x [0, 0.6] with a boss of radius 0.6 up to z = 1 and a hole of radius 0.3 through
/// both; 8 n sides around.
inline Solid drilled_boss_solid(int n) {
  static constexpr double hole = 0.3, boss = 0.6, top = 0.6, high = 1, pi = std::numbers::pi;
  const int around = 8 * n, inner = n, outer = n, low = 2 * n, upper = n;
  Solid s;
  s.name = "box with hole and boss";
  s.mesh = grid_mesh(
      {around, inner + outer, low + upper}, true,
      [&](int, int j, int k) { return k < low || j < inner; },
      [&](int i, int j, int k) {
        const double phi = 2 * pi * i / around;
        const Vec<2> u(std::cos(phi), std::sin(phi));
        Vec<2> p;
        if (j <= inner) {
          p = (hole + (boss - hole) * j / inner) * u;
        } else {
          // Equal steps along the sides of the square, its corners at odd eighths of a turn.
          const int side = (i + n) / (2 * n) % 4;
          const double t = (i + n) % (2 * n) / static_cast<double>(n) - 1;
          const std::array<Vec<2>, 4> square{Vec<2>(1, t), {-t, 1}, {-1, -t}, {t, -1}};
          const double a = (j - inner) / static_cast<double>(outer);
          p = (1 - a) * boss * u + a * square[side];
        }
        return Vec<3>(p[0], p[1],
                      k <= low ? top * k / low : top + (high - top) * (k - low) / upper);
      },
      [](const std::array<Vec<3>, 3>& p) {
        const auto all = [&](const auto& on) { return std::all_of(p.begin(), p.end(), on); };
        for (int a = 0; a < 2; ++a)
          for (const double side : {-1.0, 1.0})
            if (all([&](const Vec<3>& x) { return x[a] == side; })) return 2 * a + (side > 0);
        if (all([](const Vec<3>& x) { return x[2] == 0; })) return 4;
        if (all([](const Vec<3>& x) { return x[2] == top; })) return 5;
        if (all([](const Vec<3>& x) { return x[2] == high; })) return 6;
        return p[0].head<2>().norm() < 0.5 * (hole + boss) ? 7 : 8;
      });
  std::vector<Vec<3>> corners;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {0.0, top}) corners.push_back({x, y, z});
  s.surface = featured_surface(s.mesh, corners);
  s.volume = 4 * top - pi * hole * hole * high + pi * boss * boss * (high - top);
  // The polygon makes the hole smaller and the boss too: the two would cancel in part.
  const double missing = pi - 0.5 * around * std::sin(2 * pi / around);
  s.lost = missing * (hole * hole * high + boss * boss * (high - top));
  s.distance = [](const Vec<3>& x) {
    const Vec<2> m(x.head<2>().norm(), x[2]);  // in the half plane of the meridian
    const auto line = [&](double r0, double z0, double r1, double z1) {
      return (foot_on_segment<2>({r0, z0}, {r1, z1}, m).point - m).norm();
    };
    double d = std::min(
        {line(hole, 0, hole, high), line(boss, top, boss, high), line(hole, high, boss, high)});
    const auto plane = [&](double r, double z) {
      const Vec<2> in = x.head<2>().cwiseMax(-1).cwiseMin(1);
      const double off = in.norm() < r ? r - m[0] : (x.head<2>() - in).norm();
      return std::hypot(off, x[2] - z);
    };
    d = std::min({d, plane(hole, 0), plane(boss, top)});
    for (int a = 0; a < 2; ++a)
      for (const double side : {-1.0, 1.0}) {
        const double b = x[1 - a] - std::clamp(x[1 - a], -1.0, 1.0);
        const double c = x[2] - std::clamp(x[2], 0.0, top);
        d = std::min(d, Vec<3>(x[a] - side, b, c).norm());
      }
    return d;
  };
  for (int i = 0; i < 400; ++i) {
    const Vec<2> u(std::cos(2 * pi * i / 400), std::sin(2 * pi * i / 400));
    const auto ring = [&](double r, double z) { s.samples.push_back({r * u[0], r * u[1], z}); };
    for (int j = 0; j <= 40; ++j) {
      const double t = j / 40.0;
      ring(hole, high * t);
      ring(boss, top + (high - top) * t);
      ring(hole + (boss - hole) * t, high);
    }
  }
  for (int i = 0; i <= 100; ++i)
    for (int j = 0; j <= 100; ++j) {
      const double a = 0.02 * i - 1, b = 0.02 * j - 1;
      if (std::hypot(a, b) >= hole) s.samples.push_back({a, b, 0});
      if (std::hypot(a, b) >= boss) s.samples.push_back({a, b, top});
      for (const double side : {-1.0, 1.0}) {
        s.samples.push_back({side, a, 0.5 * top * (b + 1)});
        s.samples.push_back({a, side, 0.5 * top * (b + 1)});
      }
    }
  return s;
}

/// Largest distance of a dense lattice on the boundary facets to the exact shape.
inline double mesh_off(const Solid& solid, const SimplexMesh<3>& mesh) {
  constexpr int order = 12;
  double off = 0;
  for (const auto& f : mesh.facets) {
    const auto p = mesh.corners(f);
    for (int i = 0; i <= order; ++i)
      for (int j = 0; i + j <= order; ++j)
        off = std::max(off, solid.distance((i * p[0] + j * p[1] + (order - i - j) * p[2]) / order));
  }
  return off;
}

/// Largest distance of the samples of the exact shape to the boundary of the mesh.
inline double shape_off(const Solid& solid, const SimplexMesh<3>& mesh) {
  ReferenceSurface<3> s;
  s.points = mesh.points;
  s.facets.assign(mesh.facets.begin(), mesh.facets.end());
  const Locator<3> locator(s);
  double off2 = 0;
  for (const Vec<3>& x : solid.samples) off2 = std::max(off2, locator.nearest(x)->distance2);
  return std::sqrt(off2);
}

/// What became of the feature edges: lengths by pair of faces, and how far the edges of the mesh
/// and of the tessellation lie from each other, at most.
struct FeatureFindings {
  std::map<std::array<int, 2>, double> before, after;  ///< length of each border of two faces
  double off = 0;                                      ///< both directions
  std::size_t corners_lost = 0;
  /// Edges of either that leave the other by more than `tolerance`.
  std::size_t changed = 0;
};

inline FeatureFindings compare_features(const Solid& solid, const SimplexMesh<3>& mesh,
                                        double tolerance) {
  FeatureFindings found;
  struct Edges {
    std::vector<std::array<Vec<3>, 2>> all;
    std::map<std::array<int, 2>, double> length;
  };
  const auto edges_of = [](const SimplexMesh<3>& m) {
    Edges e;
    for (const auto& [nodes, faces] : face_borders(m)) {
      e.all.push_back({m.points[nodes[0]], m.points[nodes[1]]});
      e.length[faces] += (m.points[nodes[0]] - m.points[nodes[1]]).norm();
    }
    return e;
  };
  const Edges before = edges_of(solid.mesh), after = edges_of(mesh);
  const auto compare = [&](const Edges& from, const Edges& to) {
    for (const auto& [a, b] : from.all) {
      double off = 0;
      for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Vec<3> x = (1 - t) * a + t * b;
        double least = 1e300;
        for (const auto& [c, d] : to.all)
          least = std::min(least, (foot_on_segment<3>(c, d, x).point - x).norm());
        off = std::max(off, least);
      }
      found.off = std::max(found.off, off);
      found.changed += off > tolerance * (1 + 1e-9);
    }
  };
  compare(before, after);
  compare(after, before);
  found.before = before.length;
  found.after = after.length;
  for (auto c : solid.surface.corners)
    found.corners_lost += std::find(mesh.points.begin() + 1, mesh.points.end(),
                                    solid.surface.points[c]) == mesh.points.end();
  return found;
}

}  // namespace lamella::test
