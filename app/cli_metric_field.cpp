#include "app/cli_metric_field.h"

#include <algorithm>
#include <cmath>

#include "core/metric/average.h"

namespace lamella::cli {

namespace {

/// What to give, with the fields there are.
std::string hint_for(const MeshContent& content) {
  std::string list;
  const auto add = [&](const std::string& name) {
    list += (list.empty() ? "\"" : ", \"") + name + "\"";
  };
  for (const TensorField& field : content.tensors) add(field.name);
  for (const NodeField& field : content.of_nodes)
    if (field.components == 1) add(field.name);
  for (const ElementField& field : content.of_elements) add(field.name);
  return list.empty() ? "Give --sol or --metric: it has no fields."
                      : "Give --sol, --metric, or --field with one of its fields: " + list + ".";
}

/// Isotropic metrics of sizes; what is no size becomes a matrix that is none.
std::vector<Metric<3>> of_sizes(const std::vector<double>& sizes) {
  std::vector<Metric<3>> metrics;
  for (const double h : sizes)
    metrics.push_back((h > 0 ? 1 / (h * h) : std::nan("")) * Metric<3>::Identity());
  return metrics;
}

MetricField<3> at_nodes(const SimplexMesh<3>& mesh, const std::vector<Metric<3>>& of_elements) {
  std::vector<std::vector<std::size_t>> around(mesh.points.size());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const NodeId v : mesh.elements[e]) around[v].push_back(e);
  MetricField<3> metric(mesh.points.size(), Metric<3>::Identity());
  for (std::size_t v = 1; v < around.size(); ++v) {
    if (around[v].empty()) continue;
    std::vector<Metric<3>> metrics;
    std::vector<double> volumes;
    for (const std::size_t e : around[v]) {
      metrics.push_back(of_elements[e]);
      volumes.push_back(std::abs(signed_measure<3>(mesh.corners(mesh.elements[e]))));
    }
    metric[v] = average<3>(metrics, mean_exponent::size, volumes);
  }
  return metric;
}

}  // namespace

Result<MetricField<3>> metric_in_file(const MeshContent& content, const std::string& name) {
  const SimplexMesh<3>& mesh = content.mesh;
  std::vector<Metric<3>> values;
  bool of_nodes = true, sizes = false;
  std::string called = name;
  if (name.empty() || name == "metric") values = content.metric;
  if (values.empty()) {
    const bool only = name.empty() && content.tensors.size() == 1;
    for (const TensorField& field : content.tensors)
      if (only || field.name == name) {
        values = field.values;
        of_nodes = field.of_nodes;
        called = field.name;
      }
  }
  for (const NodeField& field : content.of_nodes)
    if (values.empty() && field.name == name && field.components == 1) {
      values = of_sizes(field.values);
      sizes = true;
    }
  for (const ElementField& field : content.of_elements)
    if (values.empty() && field.name == name) {
      values = of_sizes(field.values);
      of_nodes = false;
      sizes = true;
    }
  if (values.empty())
    return Error{Code::bad_input,
                 name.empty() ? "The mesh has no metric to be adapted to."
                              : "The mesh has no field \"" + name + "\" of sizes or of tensors.",
                 hint_for(content)};
  for (std::size_t i = of_nodes ? 1 : 0; i < values.size(); ++i)
    if (!is_spd<3>(values[i]))
      return Error{Code::bad_input,
                   "Field \"" + (called.empty() ? "metric" : called) + "\": the " +
                       (sizes ? "size" : "matrix") + " of " + (of_nodes ? "node " : "element ") +
                       std::to_string(of_nodes ? i : i + 1) + " is not positive" +
                       (sizes ? "." : " definite."),
                   sizes ? "A size is a length in mm, above 0 everywhere."
                         : "A metric has three positive eigenvalues, 1/h^2 each."};
  if (of_nodes) return values;
  return at_nodes(mesh, values);
}

}  // namespace lamella::cli
