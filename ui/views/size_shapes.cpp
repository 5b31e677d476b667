#include "ui/views/size_shapes.h"

#include <vtkCellArray.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ui/theme.h"
#include "ui/views/mesh_data.h"

namespace lamella::ui {
namespace {

constexpr int around = 48;

using Polygons = std::vector<std::vector<vtkIdType>>;

vtkSmartPointer<vtkPolyData> poly_data(const std::vector<Vec<3>>& points, const Polygons& faces) {
  vtkNew<vtkCellArray> cells;
  for (const auto& face : faces)
    cells->InsertNextCell(static_cast<vtkIdType>(face.size()), face.data());
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(make_points(points));
  data->SetPolys(cells);
  return data;
}

vtkSmartPointer<vtkPolyData> sphere(const SphereShape& s) {
  constexpr int rings = 25;
  std::vector<Vec<3>> points;
  Polygons faces;
  for (int j = 0; j < rings; ++j) {
    const double latitude = std::numbers::pi * (static_cast<double>(j) / (rings - 1) - 0.5);
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around;
      points.push_back(s.center + s.radius * Vec<3>(std::cos(latitude) * std::cos(a),
                                                    std::cos(latitude) * std::sin(a),
                                                    std::sin(latitude)));
      if (j == 0) continue;
      const vtkIdType p = (j - 1) * around + i, q = (j - 1) * around + (i + 1) % around;
      faces.push_back({p, q, q + around, p + around});
    }
  }
  return poly_data(points, faces);
}

vtkSmartPointer<vtkPolyData> box(const BoxShape& b) {
  const Vec<3> x = b.x_axis.normalized();
  const Vec<3> y = (b.y_axis - b.y_axis.dot(x) * x).normalized();
  const Vec<3> z = x.cross(y);
  std::vector<Vec<3>> points;
  for (int k = 0; k < 8; ++k)
    points.push_back(b.center + ((k & 1) - 0.5) * b.size[0] * x +
                     (((k >> 1) & 1) - 0.5) * b.size[1] * y +
                     (((k >> 2) & 1) - 0.5) * b.size[2] * z);
  return poly_data(
      points, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

vtkSmartPointer<vtkPolyData> cylinder(const CylinderShape& c) {
  const Vec<3> axis = (c.to - c.from).normalized();
  const Vec<3> u = axis.unitOrthogonal();
  const Vec<3> v = axis.cross(u);
  std::vector<Vec<3>> points;
  Polygons faces(2);
  for (int i = 0; i < around; ++i) {
    const double a = 2 * std::numbers::pi * i / around;
    const Vec<3> out = c.radius * (std::cos(a) * u + std::sin(a) * v);
    points.push_back(c.from + out);
    points.push_back(c.to + out);
    const vtkIdType p = 2 * i, q = 2 * ((i + 1) % around);
    faces.push_back({p, q, q + 1, p + 1});
    faces[0].insert(faces[0].begin(), p);
    faces[1].push_back(p + 1);
  }
  return poly_data(points, faces);
}

vtkSmartPointer<vtkPolyData> faces_of(const FacesShape& shape, const ReferenceSurface<3>& surface) {
  vtkNew<vtkCellArray> cells;
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const std::int32_t face = surface.facet_face[f];
    const auto& name = surface.faces[static_cast<std::size_t>(face)].name;
    if (std::find(shape.ids.begin(), shape.ids.end(), face) == shape.ids.end() &&
        std::find(shape.names.begin(), shape.names.end(), name) == shape.names.end())
      continue;
    const vtkIdType ids[3] = {surface.facets[f][0], surface.facets[f][1], surface.facets[f][2]};
    cells->InsertNextCell(3, ids);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(make_points(surface.points));
  data->SetPolys(cells);
  return data;
}

vtkSmartPointer<vtkPolyData> shape_data(const SizingObject& object,
                                        const std::vector<Part>& parts) {
  if (const auto* s = std::get_if<SphereShape>(&object.shape)) return sphere(*s);
  if (const auto* b = std::get_if<BoxShape>(&object.shape)) return box(*b);
  if (const auto* c = std::get_if<CylinderShape>(&object.shape)) return cylinder(*c);
  if (const auto* f = std::get_if<FacesShape>(&object.shape))
    for (const Part& part : parts)
      if (part.name == object.body || (object.body.empty() && parts.size() == 1))
        return faces_of(*f, part.surface);
  return nullptr;  // the whole body has no shape of its own
}

}  // namespace

SizeShapes::SizeShapes(vtkRenderer& renderer) : renderer_(renderer) {}

SizeShapes::~SizeShapes() {
  for (const auto& actor : actors_) renderer_.RemoveActor(actor);
}

void SizeShapes::set(const std::vector<SizingObject>& objects, const std::vector<Part>& parts,
                     int selected) {
  for (const auto& actor : actors_) renderer_.RemoveActor(actor);
  actors_.clear();
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const auto data = shape_data(objects[k], parts);
    if (!data || data->GetNumberOfCells() == 0) continue;
    vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(data);
    normals->SetFeatureAngle(40);
    normals->Update();
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(normals->GetOutput());
    mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(-1, -4);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    const bool chosen = static_cast<int>(k) == selected;
    const QColor color = chosen ? theme::warning : theme::accent;
    vtkProperty* property = actor->GetProperty();
    property->SetColor(color.redF(), color.greenF(), color.blueF());
    property->SetOpacity(chosen ? 0.42 : 0.26);
    property->SetAmbient(0.5);
    property->SetDiffuse(0.5);
    actor->PickableOff();
    renderer_.AddActor(actor);
    actors_.push_back(std::move(actor));
  }
}

}  // namespace lamella::ui
