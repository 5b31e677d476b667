#include "ui/views/scene_actors.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkPointData.h>
#include <vtkPolyDataNormals.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>

#include "ui/theme.h"
#include "ui/views/mesh_data.h"

namespace lamella::ui {
namespace {

/// Shading gives a body its shape, but the colors of values must be those of the legend.
void shade(vtkActor& actor, bool values) {
  actor.GetProperty()->SetAmbient(values ? 0.74 : 0.40);
  actor.GetProperty()->SetDiffuse(values ? 0.28 : 0.70);
}

}  // namespace

void set_color(vtkProperty& property, const QColor& color) {
  property.SetColor(color.redF(), color.greenF(), color.blueF());
}

void style_lines(vtkActor& actor, vtkPolyDataMapper& mapper) {
  mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-1, -8);
  actor.SetMapper(&mapper);
  actor.GetProperty()->SetColor(0.10, 0.15, 0.21);
  actor.GetProperty()->SetLineWidth(1.6F);
  actor.GetProperty()->LightingOff();
}

void style_mesh(vtkActor& actor, vtkPolyDataMapper& mapper) {
  actor.SetMapper(&mapper);
  vtkProperty* property = actor.GetProperty();
  property->SetInterpolationToFlat();
  property->SetAmbient(0.42);
  property->SetDiffuse(0.68);
  property->SetEdgeColor(0.22, 0.28, 0.35);
  property->SetLineWidth(1);
  actor.VisibilityOff();
}

QColor inside_color(const QColor& c, int strength) {
  const auto pale = [&](int own, int paper) {
    return (strength * own + 2 * paper) / (strength + 2);
  };
  return {pale(c.red(), 255), pale(c.green(), 250), pale(c.blue(), 238)};
}

void add_lights(vtkRenderer& renderer) {
  renderer.AutomaticLightCreationOff();
  for (const auto& [x, y, z, intensity] :
       {std::array{-0.30, 0.60, 1.0, 0.95}, std::array{0.7, -0.2, 1.0, 0.35}}) {
    vtkNew<vtkLight> light;
    light->SetLightTypeToCameraLight();
    light->SetPosition(x, y, z);
    light->SetFocalPoint(0, 0, 0);
    light->SetIntensity(intensity);
    renderer.AddLight(light);
  }
}

vtkSmartPointer<vtkPolyData> speck(const Vec<3>& at) {
  constexpr vtkIdType corners[] = {0, 1, 2};
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(3, corners);
  vtkNew<vtkUnsignedCharArray> rgb;
  rgb->SetNumberOfComponents(3);
  for (int k = 0; k < 3; ++k) rgb->InsertNextValue(255);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(make_points({at, at, at}));
  data->SetPolys(cells);
  data->GetCellData()->SetScalars(rgb);
  return data;
}

PartActors part_actors(const Part& part, const QColor& color) {
  PartActors actors;
  actors.name = part.name;
  actors.facet_face = part.surface.facet_face;
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(surface_data(part.surface));
  normals->ConsistencyOff();
  normals->SplittingOn();
  normals->SetFeatureAngle(32);
  normals->Update();
  vtkNew<vtkPolyDataMapper> mapper;
  actors.plain = normals->GetOutput();
  mapper->SetInputData(actors.plain);
  actors.surface = vtkSmartPointer<vtkActor>::New();
  actors.surface->SetMapper(mapper);
  shade(*actors.surface, false);
  vtkProperty* property = actors.surface->GetProperty();
  property->SetSpecular(0.08);
  property->SetSpecularPower(20);
  property->SetEdgeColor(0.3, 0.36, 0.42);
  vtkNew<vtkProperty> back;
  back->SetAmbient(0.6);
  back->SetDiffuse(0.4);
  actors.surface->SetBackfaceProperty(back);
  set_part_color(actors, color);

  vtkNew<vtkPolyDataMapper> lines;
  lines->SetInputData(feature_data(part.surface));
  actors.features = vtkSmartPointer<vtkActor>::New();
  style_lines(*actors.features, *lines);
  return actors;
}

void set_walls(PartActors& part, std::shared_ptr<const ThicknessMap> map) {
  if (map == part.wall_map) return;
  // Sizes that are dragged change on the same triangles.
  const bool same = map && part.wall_map && part.walls && map->points == part.wall_map->points &&
                    map->facets == part.wall_map->facets &&
                    part.walls->GetNumberOfPoints() == vtkIdType(map->points.size());
  part.wall_map = std::move(map);
  if (same) {
    vtkNew<vtkFloatArray> values;
    values->SetName("wall thickness");
    for (const double t : part.wall_map->thickness) values->InsertNextValue(static_cast<float>(t));
    part.walls->GetPointData()->SetScalars(values);
    return;
  }
  part.walls = nullptr;
  if (!part.wall_map) return;
  vtkNew<vtkPolyData> data;
  data->SetPoints(make_points(part.wall_map->points));
  vtkNew<vtkCellArray> cells;
  for (const auto& facet : part.wall_map->facets) {
    const vtkIdType ids[3] = {facet[0], facet[1], facet[2]};
    cells->InsertNextCell(3, ids);
  }
  data->SetPolys(cells);
  vtkNew<vtkFloatArray> values;
  values->SetName("wall thickness");
  for (const double t : part.wall_map->thickness) values->InsertNextValue(static_cast<float>(t));
  data->GetPointData()->SetScalars(values);
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(data);
  normals->ConsistencyOff();
  normals->SplittingOff();
  normals->Update();
  part.walls = normals->GetOutput();
}

void show_walls(PartActors& part, const Legend& legend) {
  if (!part.walls) return show_groups(part, {}, {});
  auto* mapper = vtkPolyDataMapper::SafeDownCast(part.surface->GetMapper());
  mapper->SetInputData(part.walls);
  mapper->ScalarVisibilityOn();
  mapper->SetLookupTable(lookup_table(legend));
  mapper->UseLookupTableScalarRangeOn();
  mapper->SetColorModeToMapScalars();
  mapper->SetScalarModeToUsePointData();
  mapper->InterpolateScalarsBeforeMappingOn();
  shade(*part.surface, true);
}

void show_groups(PartActors& part, const std::vector<int>& facet_group,
                 const std::vector<QColor>& group_colors) {
  auto* mapper = vtkPolyDataMapper::SafeDownCast(part.surface->GetMapper());
  mapper->SetInputData(part.plain);
  mapper->InterpolateScalarsBeforeMappingOff();
  shade(*part.surface, false);
  const bool grouped =
      std::any_of(facet_group.begin(), facet_group.end(), [](int g) { return g >= 0; });
  mapper->SetScalarVisibility(grouped);
  if (!grouped) return;
  vtkNew<vtkUnsignedCharArray> rgb;
  rgb->SetName("group color");
  rgb->SetNumberOfComponents(3);
  rgb->SetNumberOfTuples(part.plain->GetNumberOfCells());
  for (vtkIdType f = 0; f < part.plain->GetNumberOfCells(); ++f) {
    const int g = facet_group[static_cast<std::size_t>(f)];
    const QColor& c = g < 0 ? part.color : group_colors[static_cast<std::size_t>(g)];
    const unsigned char bytes[3] = {static_cast<unsigned char>(c.red()),
                                    static_cast<unsigned char>(c.green()),
                                    static_cast<unsigned char>(c.blue())};
    rgb->SetTypedTuple(f, bytes);
  }
  part.plain->GetCellData()->SetScalars(rgb);
  mapper->SetScalarModeToUseCellData();
  mapper->SetColorModeToDirectScalars();
  part.plain->Modified();
}

std::size_t facet_of(const PartActors& part, vtkIdType cell) {
  const auto k = static_cast<std::size_t>(cell);
  const bool by_wall =
      part.walls &&
      vtkPolyDataMapper::SafeDownCast(part.surface->GetMapper())->GetInput() == part.walls.Get();
  return by_wall ? static_cast<std::size_t>(part.wall_map->facet_of[k]) : k;
}

vtkSmartPointer<vtkLookupTable> lookup_table(const Legend& legend) {
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  constexpr int entries = 256;
  table->SetNumberOfTableValues(entries);
  for (int k = 0; k < entries; ++k) {
    const QColor c = legend.map.at((k + 0.5) / entries);
    table->SetTableValue(k, c.redF(), c.greenF(), c.blueF(), 1);
  }
  table->SetNanColor(theme::missing.redF(), theme::missing.greenF(), theme::missing.blueF(), 1);
  table->SetRange(legend.low, legend.high);
  return table;
}

void set_part_color(PartActors& part, const QColor& color) {
  part.color = color;
  set_color(*part.surface->GetProperty(), color);
  set_color(*part.surface->GetBackfaceProperty(), inside_color(color));
}

Cut make_cut(const Vec<3>& origin, const Vec<3>& normal) {
  Cut cut;
  cut.keep->SetOrigin(origin[0], origin[1], origin[2]);
  cut.keep->SetNormal(normal[0], normal[1], normal[2]);
  cut.clip->SetOrigin(origin[0], origin[1], origin[2]);
  cut.clip->SetNormal(-normal[0], -normal[1], -normal[2]);
  style_mesh(*cut.actor, *cut.mapper);
  return cut;
}

}  // namespace lamella::ui
