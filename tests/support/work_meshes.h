#pragma once

#include "core/metric/metric.h"
#include "core/optimize/boundary_model.h"
#include "core/optimize/topology.h"
#include "core/optimize/work_mesh.h"

namespace lamella::test {

/// The mesh as the optimizer works on it, all of it to be looked at.
template <int D>
WorkMesh<D> work_mesh(const SimplexMesh<D>& mesh, const MetricFunction<D>& metric,
                      const BoundaryModel<D>& model) {
  WorkMesh<D> work;
  work.points = mesh.points;
  for (std::size_t n = 1; n < mesh.points.size(); ++n)
    work.metric.push_back(Packed<D>::from(metric(mesh.points[n])));
  work.asked.clear();
  work.fixed = model.fixed();
  work.dirty.assign(mesh.points.size(), 1);
  work.elements = mesh.elements;
  work.label = mesh.element_body;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    work.elements.push_back(Topology<D>::virtual_element(mesh.facets[f]));
    work.label.push_back(model.tag_of_facet(f));
  }
  return work;
}

/// Its real elements and, as facets, its virtual ones.
template <int D>
SimplexMesh<D> simplex_mesh(const WorkMesh<D>& work, const BoundaryModel<D>& model) {
  SimplexMesh<D> mesh;
  mesh.points = work.points;
  for (std::size_t e = 0; e < work.elements.size(); ++e) {
    if (work.elements[e][0] != 0) {
      mesh.elements.push_back(work.elements[e]);
      mesh.element_body.push_back(work.label[e]);
    } else {
      mesh.facets.push_back(Topology<D>::facet_of(work.elements[e]));
      mesh.facet_group.push_back(model.tag(work.label[e]).group);
      mesh.facet_face.push_back(model.tag(work.label[e]).face);
    }
  }
  return mesh;
}

}  // namespace lamella::test
