#include "core/mesh/sample_meshes.h"

#include <algorithm>
#include <numeric>

#include "core/mesh/boundary.h"

namespace lamella {
namespace {

/// Numbers each facet by the side of the box [low, high] it lies on.
template <int D>
void name_sides(SimplexMesh<D>& mesh, const Vec<D>& low, const Vec<D>& high) {
  for (std::size_t i = 0; i < mesh.facets.size(); ++i)
    for (int k = 0; k < D; ++k)
      for (int side = 0; side < 2; ++side) {
        const double value = side == 0 ? low[k] : high[k];
        const auto on_side = [&](NodeId v) { return mesh.points[v][k] == value; };
        if (std::all_of(mesh.facets[i].begin(), mesh.facets[i].end(), on_side))
          mesh.facet_face[i] = 2 * k + side;
      }
}

template <int D>
Vec<D> element_center(const SimplexMesh<D>& mesh, std::size_t e) {
  Vec<D> c = Vec<D>::Zero();
  for (const NodeId v : mesh.elements[e]) c += mesh.points[v];
  return c / (D + 1);
}

}  // namespace

template <int D>
SimplexMesh<D> box_mesh(const std::array<int, D>& cells, const Vec<D>& low, const Vec<D>& high) {
  SimplexMesh<D> mesh;
  std::array<NodeId, D> stride{};
  NodeId slots = 1;
  for (int k = 0; k < D; ++k) {
    assert(cells[k] > 0 && low[k] < high[k]);
    stride[k] = slots;
    slots *= cells[k] + 1;
  }
  for (NodeId id = 0; id < slots; ++id) {
    Vec<D> x;
    for (int k = 0; k < D; ++k) {
      const int i = id / stride[k] % (cells[k] + 1);
      // Both ends exactly as given, so that sides are found by comparison.
      x[k] = i == cells[k] ? high[k] : low[k] + (high[k] - low[k]) * i / cells[k];
    }
    mesh.points.push_back(x);
  }
  for (NodeId id = 0; id < slots; ++id) {
    bool is_cell = true;
    for (int k = 0; k < D; ++k) is_cell = is_cell && id / stride[k] % (cells[k] + 1) < cells[k];
    if (!is_cell) continue;
    std::array<int, D> axes;
    std::iota(axes.begin(), axes.end(), 0);
    do {  // one simplex per path along the axes from the low corner to the high one
      typename SimplexMesh<D>::Element e;
      e[0] = id + 1;
      bool odd = false;
      for (int k = 0; k < D; ++k) {
        e[k + 1] = e[k] + stride[axes[k]];
        for (int j = 0; j < k; ++j) odd = odd != (axes[j] > axes[k]);
      }
      if (odd) std::swap(e[D - 1], e[D]);
      mesh.elements.push_back(e);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  mesh.element_body.assign(mesh.elements.size(), 0);
  rebuild_facets(mesh);
  name_sides(mesh, low, high);
  return mesh;
}

template <int D>
SimplexMesh<D> unit_box(int n) {
  std::array<int, D> cells;
  cells.fill(n);
  return box_mesh<D>(cells, Vec<D>::Zero(), Vec<D>::Ones());
}

template <int D>
SimplexMesh<D> equilateral_simplex(double edge) {
  SimplexMesh<D> mesh;
  // Gram matrix of the edge vectors from vertex 0: edge^2 on the diagonal, half of it elsewhere.
  const Mat<D> gram = 0.5 * edge * edge * (Mat<D>::Identity() + Mat<D>::Ones());
  const Mat<D> edges = gram.llt().matrixU();
  const Vec<D> center = edges.rowwise().sum() / (D + 1);
  mesh.points.push_back(-center);
  for (int k = 0; k < D; ++k) mesh.points.push_back(edges.col(k) - center);
  auto& element = mesh.elements.emplace_back();
  std::iota(element.begin(), element.end(), 1);
  mesh.element_body = {0};
  rebuild_facets(mesh);
  return mesh;
}

template <int D>
SimplexMesh<D> ball_mesh(int n, double radius) {
  assert(n % 2 == 0);
  std::array<int, D> cells;
  cells.fill(n);
  SimplexMesh<D> mesh = box_mesh<D>(cells, -Vec<D>::Ones(), Vec<D>::Ones());
  for (Vec<D>& x : mesh.points) {
    const double largest = x.template lpNorm<Eigen::Infinity>();
    if (largest > 0) x *= radius * largest / x.norm();
  }
  std::fill(mesh.facet_face.begin(), mesh.facet_face.end(), 0);
  return mesh;
}

template <int D>
SimplexMesh<D> l_shape(int n) {
  std::array<int, D> cells;
  cells.fill(n);
  cells[0] = cells[1] = 2 * n;
  Vec<D> high = Vec<D>::Ones();
  high[0] = high[1] = 2;
  SimplexMesh<D> mesh = box_mesh<D>(cells, Vec<D>::Zero(), high);
  std::size_t kept = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const Vec<D> c = element_center(mesh, e);
    if (c[0] < 1 || c[1] < 1) mesh.elements[kept++] = mesh.elements[e];
  }
  mesh.elements.resize(kept);
  mesh.element_body.assign(kept, 0);
  // What the cut lays bare gets its own numbers, after the sides of the box.
  const Vec<D> low = Vec<D>::Zero();
  compact_nodes(mesh);
  mesh.facets.clear();
  mesh.facet_group.clear();
  mesh.facet_face.clear();
  rebuild_facets(mesh);
  for (std::size_t i = 0; i < mesh.facets.size(); ++i)
    for (int k = 0; k < 2; ++k)
      if (std::all_of(mesh.facets[i].begin(), mesh.facets[i].end(),
                      [&](NodeId v) { return mesh.points[v][k] == 1; }))
        mesh.facet_face[i] = 2 * D + k;
  name_sides(mesh, low, high);
  return mesh;
}

template <int D>
SimplexMesh<D> two_body_box(int n) {
  assert(n % 2 == 0);
  SimplexMesh<D> mesh = unit_box<D>(n);
  mesh.bodies = {"left", "right"};
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    mesh.element_body[e] = element_center(mesh, e)[0] > 0.5 ? 1 : 0;
  return mesh;
}

template SimplexMesh<2> box_mesh<2>(const std::array<int, 2>&, const Vec<2>&, const Vec<2>&);
template SimplexMesh<3> box_mesh<3>(const std::array<int, 3>&, const Vec<3>&, const Vec<3>&);
template SimplexMesh<4> box_mesh<4>(const std::array<int, 4>&, const Vec<4>&, const Vec<4>&);
template SimplexMesh<2> unit_box<2>(int);
template SimplexMesh<3> unit_box<3>(int);
template SimplexMesh<4> unit_box<4>(int);
template SimplexMesh<2> equilateral_simplex<2>(double);
template SimplexMesh<3> equilateral_simplex<3>(double);
template SimplexMesh<4> equilateral_simplex<4>(double);
template SimplexMesh<2> ball_mesh<2>(int, double);
template SimplexMesh<3> ball_mesh<3>(int, double);
template SimplexMesh<4> ball_mesh<4>(int, double);
template SimplexMesh<2> l_shape<2>(int);
template SimplexMesh<3> l_shape<3>(int);
template SimplexMesh<4> l_shape<4>(int);
template SimplexMesh<2> two_body_box<2>(int);
template SimplexMesh<3> two_body_box<3>(int);
template SimplexMesh<4> two_body_box<4>(int);

}  // namespace lamella
