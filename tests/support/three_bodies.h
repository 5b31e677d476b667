#pragma once

#include "core/io/mesh_fields.h"
#include "core/mesh/interfaces.h"
#include "core/mesh/sample_meshes.h"

namespace lamella::test {

/// A box of 6 x 4 x 2 mm side by side of three bodies of 2 mm, with a gate (x = 0, area 8), a vent
/// (x = 6), a symmetry (y = 0) and walls, the two faces between bodies among the groups; a metric,
/// and ratios as if the borders were fuzzy.
struct ThreeBodies {
  SimplexMesh<3> mesh;
  MetricField<3> metric;
  MeshFields fields;

  explicit ThreeBodies(const std::vector<std::string>& bodies = {"cover", "insert", "runner"},
                       const std::vector<std::string>& groups = {"walls", "gate", "vent",
                                                                 "symmetry"}) {
    SimplexMesh<3> box = box_mesh<3>({6, 4, 3}, Vec<3>(0, 0, 0), Vec<3>(6, 4, 2));
    box.bodies = bodies;
    box.groups = groups;
    for (std::size_t e = 0; e < box.elements.size(); ++e) {
      double x = 0;
      for (const NodeId v : box.elements[e]) x += box.points[v][0] / 4;
      box.element_body[e] = static_cast<std::int32_t>(x / 2);
    }
    for (std::size_t f = 0; f < box.facets.size(); ++f)
      box.facet_group[f] = box.facet_face[f] < 3 ? box.facet_face[f] + 1 : 0;
    mesh = with_interfaces(box);
    for (const Vec<3>& x : mesh.points) {
      const Vec<3> v = x + Vec<3>(0.1, 0.2, 0.3);
      metric.push_back(v * v.transpose() + 2 * Metric<3>::Identity());
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      ElementField field{std::string(kFillingField) + bodies[b], {}};
      for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
        const auto body = static_cast<std::size_t>(mesh.element_body[e]);
        const bool mixed = e % 5 == 0;
        field.values.push_back(body == b                      ? (mixed ? 0.75 : 1)
                               : mixed && (body + 1) % 3 == b ? 0.25
                                                              : 0);
      }
      fields.of_elements.push_back(std::move(field));
    }
  }
  /// The fields with the metric, which they borrow.
  MeshFields with_metric() const {
    MeshFields all = fields;
    all.metric = &metric;
    return all;
  }
};

/// Bodies and groups whose names few formats can hold.
inline ThreeBodies three_bodies_of_odd_names() {
  const std::string longest(150, 'x');
  return ThreeBodies({"cold side / 2", "Kühlung|Kern", longest + "a"},
                     {longest + "b", "7 gate", "Gate", "gate"});
}

}  // namespace lamella::test
