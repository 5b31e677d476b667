#pragma once

#include <vtkActor.h>
#include <vtkLookupTable.h>
#include <vtkPlane.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSmartPointer.h>

#include <QColor>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/surface.h"
#include "core/natural/thickness_map.h"
#include "ui/views/color_map.h"

class vtkRenderer;

namespace lamella::ui {

/// A part as it is drawn: its surface and the lines between its faces.
struct PartActors {
  std::string name;
  QColor color;
  std::vector<std::int32_t> facet_face;
  vtkSmartPointer<vtkActor> surface;
  vtkSmartPointer<vtkPolyData> plain;  // what the surface shows, a cell a facet,
  vtkSmartPointer<vtkPolyData> walls;  // or this, with its wall thickness; may be null
  std::shared_ptr<const ThicknessMap> wall_map;
  vtkSmartPointer<vtkActor> features;
};
/// A triangle without area, with a color of its own.
vtkSmartPointer<vtkPolyData> speck(const Vec<3>& at);
PartActors part_actors(const Part& part, const QColor& color);
/// The wall thickness of the part; null takes it away.
void set_walls(PartActors& part, std::shared_ptr<const ThicknessMap> map);
/// Colors the surface by that thickness.
void show_walls(PartActors& part, const Legend& legend);
/// Colors it plainly, facets in a group (`facet_group`, -1: none) in the color of the group.
void show_groups(PartActors& part, const std::vector<int>& facet_group,
                 const std::vector<QColor>& group_colors);
/// Triangle of the part that a picked cell of its surface is in.
std::size_t facet_of(const PartActors& part, vtkIdType cell);
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
/// Colors over the range of the legend.
vtkSmartPointer<vtkLookupTable> lookup_table(const Legend& legend);
void set_color(vtkProperty& property, const QColor& color);

}  // namespace lamella::ui
