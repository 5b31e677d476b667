#include "ui/views/scene_actors.h"

#include <vtkLight.h>
#include <vtkPolyDataNormals.h>
#include <vtkRenderer.h>

#include <array>

#include "ui/views/mesh_data.h"

namespace lamella::ui {

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
  mapper->SetInputData(normals->GetOutput());
  actors.surface = vtkSmartPointer<vtkActor>::New();
  actors.surface->SetMapper(mapper);
  vtkProperty* property = actors.surface->GetProperty();
  property->SetAmbient(0.40);
  property->SetDiffuse(0.70);
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
