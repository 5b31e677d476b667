#include "ui/views/mesh_data.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkPointData.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/metric/metric.h"
#include "ui/views/mesh_skin.h"

namespace lamella::ui {

vtkSmartPointer<vtkPoints> make_points(const std::vector<Vec<3>>& from) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(from.size()));
  for (std::size_t k = 0; k < from.size(); ++k)
    points->SetPoint(static_cast<vtkIdType>(k), from[k].data());
  return points;
}

vtkSmartPointer<vtkPolyData> surface_data(const ReferenceSurface<3>& surface) {
  std::vector<std::pair<std::int32_t, std::int32_t>> uses;  // CAD face, vertex
  uses.reserve(3 * surface.facets.size());
  for (std::size_t f = 0; f < surface.facets.size(); ++f)
    for (const std::int32_t v : surface.facets[f]) uses.emplace_back(surface.facet_face[f], v);
  std::sort(uses.begin(), uses.end());
  uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
  std::vector<Vec<3>> points;
  points.reserve(uses.size());
  for (const auto& [face, vertex] : uses)
    points.push_back(surface.points[static_cast<std::size_t>(vertex)]);
  vtkNew<vtkCellArray> cells;
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    vtkIdType ids[3];
    for (int k = 0; k < 3; ++k)
      ids[k] = std::lower_bound(uses.begin(), uses.end(),
                                std::pair(surface.facet_face[f], surface.facets[f][k])) -
               uses.begin();
    cells->InsertNextCell(3, ids);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(make_points(points));
  data->SetPolys(cells);
  return data;
}

FieldArray array_of(ColorBy field) {
  switch (field) {
    case ColorBy::body:
    case ColorBy::filling:
      break;
    case ColorBy::size:
      return {"size", false};
    case ColorBy::quality:
      return {"quality", true};
    case ColorBy::thickness:
      return {"thickness", false};
    case ColorBy::layers:
      return {"layers", false};
    case ColorBy::speed:
      return {"speed", false};
    case ColorBy::pressure:
      return {"pressure", false};
    case ColorBy::shear:
      return {"shear rate", true};
    case ColorBy::indicator:
      return {"indicator", true};
    case ColorBy::field:
      return {"field", false};
  }
  return {};
}

bool has_field(const MeshState& state, ColorBy field) {
  const std::size_t nodes = state.mesh.points.size(), elements = state.mesh.elements.size();
  switch (field) {
    case ColorBy::body:
      return true;
    case ColorBy::quality:
      return state.quality.size() == elements;
    case ColorBy::thickness:
      return state.thickness.size() == nodes;
    case ColorBy::layers:
      return state.layers.size() == nodes;
    case ColorBy::size:
      return state.metric.size() == nodes;
    case ColorBy::filling:
      return state.filling && state.filling->first.size() == elements + 1;
    case ColorBy::speed:
    case ColorBy::pressure:
    case ColorBy::shear:
    case ColorBy::indicator:
    case ColorBy::field:
      break;
  }
  if (!state.flow || state.flow->velocity.size() != nodes || state.flow->shear.size() != elements)
    return false;
  // The vector of another solver is drawn like a velocity.
  const int components = state.flow->components;
  return field == ColorBy::indicator || (field == ColorBy::field && components > 0) ||
         (field == ColorBy::speed && components != 1) ||
         ((field == ColorBy::pressure || field == ColorBy::shear) && components == 0);
}

bool has_levels(const MeshState& state) {
  return has_field(state, ColorBy::speed) || has_field(state, ColorBy::field);
}

std::vector<double> field_values(const MeshState& state, ColorBy field) {
  const auto of_nodes = [](const std::vector<double>& values) {
    return std::vector<double>(values.begin() + 1, values.end());
  };
  if (!has_field(state, field)) return {};
  if (field == ColorBy::quality) return state.quality;
  if (field == ColorBy::thickness) return of_nodes(state.thickness);
  if (field == ColorBy::layers) return of_nodes(state.layers);
  if (field == ColorBy::pressure) return of_nodes(state.flow->pressure);
  if (field == ColorBy::shear) return state.flow->shear;
  if (field == ColorBy::indicator) return state.flow->indicator;
  if (field == ColorBy::size) {
    std::vector<double> asked;
    for (std::size_t n = 1; n < state.metric.size(); ++n)
      asked.push_back(sizes<3>(state.metric[n])[0]);
    return asked;
  }
  if (field == ColorBy::field && state.flow->components == 1) return of_nodes(state.flow->number);
  std::vector<double> speed;
  if (field == ColorBy::speed || field == ColorBy::field)
    for (std::size_t n = 1; n < state.flow->velocity.size(); ++n)
      speed.push_back(state.flow->velocity[n].norm());
  return speed;
}

void add_fields(const MeshState& state, const std::vector<std::int32_t>& element,
                const std::vector<std::int32_t>& node, vtkDataSetAttributes& cells,
                vtkDataSetAttributes& points) {
  for (const ColorBy field :
       {ColorBy::quality, ColorBy::thickness, ColorBy::layers, ColorBy::speed, ColorBy::pressure,
        ColorBy::shear, ColorBy::indicator, ColorBy::field}) {
    const std::vector<double> values = field_values(state, field);
    if (values.empty()) continue;
    const auto [name, of_elements] = array_of(field);
    const std::vector<std::int32_t>& of = of_elements ? element : node;
    vtkNew<vtkFloatArray> array;
    array->SetName(name);
    array->SetNumberOfTuples(static_cast<vtkIdType>(of.size()));
    float* out = array->GetPointer(0);
    for (std::size_t k = 0; k < of.size(); ++k) {
      // The virtual node has no value.
      const std::int32_t i = of_elements ? of[k] : of[k] - 1;
      out[k] = i < 0 ? 0 : static_cast<float>(values[static_cast<std::size_t>(i)]);
    }
    (of_elements ? cells : points).AddArray(array);
  }
}

void add_velocity(const MeshState& state, vtkDataSetAttributes& points) {
  if (!has_field(state, ColorBy::speed)) return;
  vtkNew<vtkFloatArray> velocity;
  velocity->SetName(velocity_array);
  velocity->SetNumberOfComponents(3);
  velocity->SetNumberOfTuples(static_cast<vtkIdType>(state.flow->velocity.size()));
  for (std::size_t n = 0; n < state.flow->velocity.size(); ++n) {
    const Vec<3>& v = state.flow->velocity[n];
    velocity->SetTuple3(static_cast<vtkIdType>(n), v[0], v[1], v[2]);
  }
  points.AddArray(velocity);
}

vtkSmartPointer<vtkPolyData> feature_data(const ReferenceSurface<3>& surface) {
  std::vector<std::array<std::int32_t, 3>> sides;  // two vertices, CAD face
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = surface.facets[f][k];
      const std::int32_t b = surface.facets[f][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), surface.facet_face[f]});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<std::array<std::int32_t, 2>> edges;
  for (const auto& edge : surface.feature_edges)
    edges.push_back({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])});
  for (std::size_t k = 1; k < sides.size(); ++k) {
    const auto& a = sides[k - 1];
    const auto& b = sides[k];
    if (a[0] == b[0] && a[1] == b[1] && a[2] != b[2]) edges.push_back({a[0], a[1]});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  vtkNew<vtkCellArray> cells;
  for (const auto& edge : edges) {
    const vtkIdType ids[2] = {edge[0], edge[1]};
    cells->InsertNextCell(2, ids);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(make_points(surface.points));
  data->SetLines(cells);
  return data;
}

vtkSmartPointer<vtkPolyData> feature_data(const SimplexMesh<3>& mesh) {
  std::vector<std::array<std::int32_t, 3>> sides;  // two nodes, CAD face
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const NodeId a = mesh.facets[f][k];
      const NodeId b = mesh.facets[f][(k + 1) % 3];
      sides.push_back(
          {std::min(a, b), std::max(a, b), f < mesh.facet_face.size() ? mesh.facet_face[f] : 0});
    }
  }
  std::sort(sides.begin(), sides.end());
  vtkNew<vtkCellArray> cells;
  for (std::size_t k = 1; k < sides.size(); ++k) {
    const auto& a = sides[k - 1];
    const auto& b = sides[k];
    if (a[0] != b[0] || a[1] != b[1] || a[2] == b[2]) continue;
    const vtkIdType ids[2] = {a[0], a[1]};
    cells->InsertNextCell(2, ids);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(make_points(mesh.points));
  data->SetLines(cells);
  return data;
}

vtkSmartPointer<vtkFloatArray> filling_bands(const Filling& filling, std::int32_t region,
                                             vtkIntArray& element) {
  auto bands = vtkSmartPointer<vtkFloatArray>::New();
  bands->SetName("filling");
  bands->SetNumberOfTuples(element.GetNumberOfTuples());
  for (vtkIdType f = 0; f < element.GetNumberOfTuples(); ++f) {
    const auto e = static_cast<std::size_t>(element.GetValue(f));
    const double ratio = filling.ratio(e, region);
    // An element that is filled by one body alone is full or empty, whatever the numbers say.
    const bool half = ratio >= 0.5, mixed = filling.mixed(e) && ratio > 0;
    bands->SetValue(f, !half ? (mixed ? 0.375F : 0.125F) : (mixed ? 0.625F : 0.875F));
  }
  return bands;
}

void add_sizes(const MeshState& state, vtkDataSetAttributes& points) {
  const char* name = array_of(ColorBy::size).name;
  auto* node = vtkIntArray::SafeDownCast(points.GetArray(node_array));
  if (!node || points.GetArray(name)) return;
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfTuples(node->GetNumberOfTuples());
  for (vtkIdType k = 0; k < node->GetNumberOfTuples(); ++k) {
    const auto n = static_cast<std::size_t>(node->GetValue(k));
    array->SetValue(k, n == 0 ? 0 : static_cast<float>(sizes<3>(state.metric[n])[0]));
  }
  points.AddArray(array);
}

std::pair<double, double> robust_range(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return {0, 1};
  const auto at = [&](double q) {
    const auto k = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + k, values.end());
    return values[static_cast<std::size_t>(k)];
  };
  const double low = at(0.01);
  const double high = at(0.99);
  if (high - low > 1e-9 * std::abs(high)) return {low, high};
  return {low - 0.05 * std::abs(low), high + 0.05 * std::abs(high)};
}

double typical_edge(vtkPolyData& data) {
  // Some thousand polygons tell as much as all of them.
  constexpr vtkIdType enough = 5000;
  const vtkIdType stride = std::max<vtkIdType>(1, data.GetNumberOfCells() / enough);
  std::vector<double> lengths;
  vtkNew<vtkIdList> corners;
  Vec<3> a;
  Vec<3> b;
  for (vtkIdType c = 0; c < data.GetNumberOfCells(); c += stride) {
    data.GetCellPoints(c, corners);
    for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k) {
      data.GetPoint(corners->GetId(k), a.data());
      data.GetPoint(corners->GetId((k + 1) % corners->GetNumberOfIds()), b.data());
      lengths.push_back((a - b).norm());
    }
  }
  if (lengths.empty()) return 0;
  const auto quarter = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 4);
  std::nth_element(lengths.begin(), quarter, lengths.end());
  return *quarter;
}

}  // namespace lamella::ui
