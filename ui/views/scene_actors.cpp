#include "ui/views/scene_actors.h"

#include <vtkPolyDataNormals.h>

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

QColor inside_color(const QColor& c) {
  return {(c.red() + 2 * 255) / 3, (c.green() + 2 * 250) / 3, (c.blue() + 2 * 238) / 3};
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
