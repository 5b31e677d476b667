#pragma once

#include <vtkActor.h>
#include <vtkPlane.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSmartPointer.h>

#include <QColor>
#include <string>
#include <vector>

#include "core/geometry/surface.h"

class vtkRenderer;

namespace lamella::ui {

/// A part as it is drawn: its surface and the lines between its faces.
struct PartActors {
  std::string name;
  QColor color;
  std::vector<std::int32_t> facet_face;
  vtkSmartPointer<vtkActor> surface;
  vtkSmartPointer<vtkActor> features;
};
PartActors part_actors(const Part& part, const QColor& color);
void set_part_color(PartActors& part, const QColor& color);

/// One plane of the section.
struct Cut {
  vtkSmartPointer<vtkPlane> keep = vtkSmartPointer<vtkPlane>::New();   // its negative side
  vtkSmartPointer<vtkPlane> clip = vtkSmartPointer<vtkPlane>::New();   // mappers keep the positive
  vtkSmartPointer<vtkActor> actor = vtkSmartPointer<vtkActor>::New();  // through elements
  vtkSmartPointer<vtkPolyDataMapper> mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
  double edge = 0;  // typical of what is drawn, mm; 0: unknown
};
Cut make_cut(const Vec<3>& origin, const Vec<3>& normal);

/// Elements of a mesh: flat faces with edges; lines; the paler inside of a cut body, of which
/// several side by side need more `strength` to differ.
void style_mesh(vtkActor& actor, vtkPolyDataMapper& mapper);
void style_lines(vtkActor& actor, vtkPolyDataMapper& mapper);
QColor inside_color(const QColor& color, int strength = 1);
/// A key light over the left shoulder gives faces of different slope different shades; the second
/// one keeps what it leaves in the dark readable.
void add_lights(vtkRenderer& renderer);
void set_color(vtkProperty& property, const QColor& color);

}  // namespace lamella::ui
