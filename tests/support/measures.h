#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "core/geometry/simplex.h"
#include "core/io/export_certificate.h"
#include "tests/support/three_bodies.h"

namespace lamella::test {

/// Areas of groups and volumes of bodies by name, as some program finds them in a file.
struct Measures {
  std::map<std::string, double> areas, volumes;

  void add_triangle(const std::string& name, const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
    areas[name] += (b - a).cross(c - a).norm() / 2;
  }
  void add_tetrahedron(const std::string& name, const Vec<3>& a, const Vec<3>& b, const Vec<3>& c,
                       const Vec<3>& d) {
    volumes[name] += (b - a).cross(c - a).dot(d - a) / 6;
  }
};

/// What a mesh has, its lengths in units of `length` mm; `bar` is what a format makes of "|".
inline Measures measures_of(const SimplexMesh<3>& mesh, double length = 1, char bar = '|') {
  Measures measures;
  const auto named = [bar](std::string name) {
    for (char& c : name)
      if (c == '|') c = bar;
    return name;
  };
  const MeshSummary summary = summarize(mesh);
  for (const NamedMeasure& body : summary.bodies)
    measures.volumes[named(body.name)] = body.measure / (length * length * length);
  for (const NamedMeasure& group : summary.groups)
    measures.areas[named(group.name)] = group.measure / (length * length);
  return measures;
}

/// The same names, areas and volumes to these relative tolerances.
inline void expect_measures(const Measures& seen, const Measures& made, double area = 1e-9,
                            double volume = 1e-9) {
  const auto compare = [](const std::map<std::string, double>& a,
                          const std::map<std::string, double>& b, double tolerance) {
    for (const auto& [name, value] : a) {
      const auto at = b.find(name);
      if (at == b.end())
        ADD_FAILURE() << "there should be no " << name;
      else
        EXPECT_NEAR(value / at->second, 1, tolerance) << name;
    }
    for (const auto& [name, value] : b) EXPECT_TRUE(a.contains(name)) << name << " is missing";
  };
  compare(seen.areas, made.areas, area);
  compare(seen.volumes, made.volumes, volume);
}

/// The three bodies with different volumes, and coordinates that need all their digits.
inline ThreeBodies three_different_bodies() {
  ThreeBodies made;
  for (Vec<3>& x : made.mesh.points)
    x = Vec<3>(x[0] * (1 + x[0] / 30), x[1] * (1 + x[1] / 17), 0.93 * x[2]);
  return made;
}

}  // namespace lamella::test
