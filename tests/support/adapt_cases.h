#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>

#include "core/mesh/sample_meshes.h"
#include "core/mesh/validate.h"
#include "core/metric/analytic.h"
#include "core/optimize/adapt.h"
#include "tests/support/random_metric.h"

/// Meshes, metrics and promises that the tests of the adaption share.
namespace lamella::test {

template <int D>
struct NamedMesh {
  std::string name;
  SimplexMesh<D> mesh;
};

template <int D>
Vec<D> center_of(const SimplexMesh<D>& mesh, const typename SimplexMesh<D>::Facet& facet) {
  Vec<D> c = Vec<D>::Zero();
  for (NodeId n : facet) c += mesh.points[n] / D;
  return c;
}

/// Makes a second group of the facets that `in` tells by their center.
template <int D, class In>
SimplexMesh<D> with_gate(SimplexMesh<D> mesh, const In& in) {
  mesh.groups = {"walls", "gate"};
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    mesh.facet_group[f] = in(center_of<D>(mesh, mesh.facets[f])) ? 1 : 0;
  return mesh;
}

/// Domains of flat sides.
template <int D>
std::vector<NamedMesh<D>> flat_meshes(int cells) {
  return {{"box", unit_box<D>(cells)},
          {"box whose one side is a gate",
           with_gate<D>(unit_box<D>(cells), [](const Vec<D>& x) { return x[0] == 0; })},
          {"L", l_shape<D>(cells / 2)},
          {"box of two bodies", two_body_box<D>(cells)},
          {"simplex", equilateral_simplex<D>(1)}};
}

template <int D>
struct NamedMetric {
  std::string name;
  MetricFunction<D> at;
};

/// Metrics with sizes of about h and larger, their axes turned by the generator.
template <int D>
std::vector<NamedMetric<D>> metrics(double h, std::mt19937& rng) {
  std::vector<NamedMetric<D>> all;
  all.push_back({"uniform", [h](const Vec<D>&) { return isotropic_metric<D>(h); }});
  Vec<D> sizes = Vec<D>::Constant(2 * h);
  sizes[0] = 0.5 * h;
  const Metric<D> turned = metric_from_sizes<D>(random_rotation<D>(rng), sizes);
  all.push_back({"constant, anisotropic", [turned](const Vec<D>&) { return turned; }});
  all.push_back({"boundary layer", [h](const Vec<D>& x) {
                   Vec<D> s = Vec<D>::Constant(2 * h);
                   s[0] = std::min(2 * h, 0.2 * h + std::abs(x[0]));
                   return metric_from_sizes<D>(Mat<D>::Identity(), s);
                 }});
  all.push_back({"rotating", [h](const Vec<D>& x) {
                   Mat<D> axes = Mat<D>::Identity();
                   const double c = std::cos(2 * x[1]), s = std::sin(2 * x[1]);
                   axes.template topLeftCorner<2, 2>() << c, -s, s, c;
                   Vec<D> across = Vec<D>::Constant(2 * h);
                   across[0] = 0.6 * h;
                   return metric_from_sizes<D>(axes, across);
                 }});
  // exp of a sum of waves of symmetric matrices: smooth and positive definite.
  std::vector<std::pair<Vec<D>, Mat<D>>> waves;
  for (int i = 0; i < 4; ++i) {
    Mat<D> a;
    for (int k = 0; k < D; ++k) a.col(k) = random_vector<D>(rng);
    waves.emplace_back(3 * random_vector<D>(rng), 0.4 * (a + a.transpose()));
  }
  all.push_back({"random, smooth", [h, waves](const Vec<D>& x) {
                   Mat<D> log = Mat<D>::Zero();
                   for (const auto& [k, a] : waves) log += std::sin(k.dot(x)) * a;
                   return Metric<D>(metric_exp<D>(log) / (1.5 * h * 1.5 * h));
                 }});
  return all;
}

/// Measure of the facets of each (group, CAD face).
template <int D>
std::map<std::pair<int, int>, double> areas(const SimplexMesh<D>& mesh) {
  std::map<std::pair<int, int>, double> sum;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    sum[{mesh.facet_group[f], mesh.facet_face[f]}] +=
        facet_normal<D>(mesh.corners(mesh.facets[f])).norm() / factorial(D - 1);
  return sum;
}

/// Measure of each body.
template <int D>
std::vector<double> volumes(const SimplexMesh<D>& mesh) {
  std::vector<double> sum(mesh.bodies.size(), 0);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    sum[mesh.element_body[e]] += signed_measure<D>(mesh.corners(mesh.elements[e]));
  return sum;
}

/// Nodes of each simplex in growing order, the simplices sorted.
template <std::size_t N>
std::vector<std::array<NodeId, N>> as_sets(std::vector<std::array<NodeId, N>> simplices) {
  for (auto& s : simplices) std::sort(s.begin(), s.end());
  std::sort(simplices.begin(), simplices.end());
  return simplices;
}

/// Definition 1.4; no element twice; and every facet of the boundary has one neighbor across each
/// of its sides: with the virtual elements every face is shared by two.
template <int D>
void expect_valid(const SimplexMesh<D>& mesh) {
  const Result<void> good = validate(mesh);
  ASSERT_TRUE(good.ok()) << good.error().message;
  const auto sets = as_sets(mesh.elements);
  EXPECT_EQ(std::adjacent_find(sets.begin(), sets.end()), sets.end()) << "an element twice";
  std::map<std::array<NodeId, D - 1>, int> ridges;
  for (const auto& f : mesh.facets)
    for (int k = 0; k < D; ++k) {
      std::array<NodeId, D - 1> r;
      for (int i = 0, j = 0; i < D; ++i)
        if (i != k) r[j++] = f[i];
      std::sort(r.begin(), r.end());
      ++ridges[r];
    }
  for (const auto& [nodes, count] : ridges)
    ASSERT_EQ(count, 2) << "the boundary is pinched at node " << nodes[0];
}

/// The domain, its bodies and each flat side of the boundary are what they were.
template <int D>
void expect_same_shape(const SimplexMesh<D>& before, const SimplexMesh<D>& after) {
  const auto v = volumes(before), w = volumes(after);
  ASSERT_EQ(v.size(), w.size());
  for (std::size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(w[i], v[i], 1e-12 * v[i]) << "body " << i;
  const auto a = areas(before), b = areas(after);
  EXPECT_EQ(a.size(), b.size());
  for (const auto& [side, area] : a) {
    ASSERT_TRUE(b.contains(side)) << "group " << side.first << ", face " << side.second;
    EXPECT_NEAR(b.at(side), area, 1e-12 * area)
        << "group " << side.first << ", face " << side.second;
  }
}

template <int D>
bool has_point(const SimplexMesh<D>& mesh, const Vec<D>& x) {
  return std::find(mesh.points.begin() + 1, mesh.points.end(), x) != mesh.points.end();
}

/// The boundary of a mesh as a surface of one face per CAD face, without features.
template <int D>
ReferenceSurface<D> boundary_surface(const SimplexMesh<D>& mesh) {
  ReferenceSurface<D> s;
  s.points.assign(mesh.points.begin() + 1, mesh.points.end());
  std::int32_t faces = 0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    auto nodes = mesh.facets[f];
    for (NodeId& n : nodes) --n;
    s.facets.push_back(nodes);
    s.facet_face.push_back(mesh.facet_face[f]);
    faces = std::max(faces, mesh.facet_face[f] + 1);
  }
  s.faces.resize(static_cast<std::size_t>(faces));
  return s;
}

/// Adapts once, the metric given at the nodes; a failure fails the test.
template <int D>
Adapted<D> adapted(const SimplexMesh<D>& mesh, const MetricFunction<D>& metric,
                   const AdaptParams& params = {}, const ReferenceSurface<D>* surface = nullptr) {
  auto r = adapt<D>(mesh, sample_metric<D>(metric, mesh.points), surface, params);
  if (!r.ok()) {
    ADD_FAILURE() << r.error().message;
    return {mesh, {}, {}};
  }
  return std::move(*r);
}

}  // namespace lamella::test
