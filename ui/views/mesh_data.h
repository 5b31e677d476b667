#pragma once

#include <vtkDataSetAttributes.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <utility>
#include <vector>

#include "core/geometry/surface.h"
#include "core/study/run.h"
#include "ui/views/color_map.h"

namespace lamella::ui {

/// Points as VTK has them, in the same order. mm.
vtkSmartPointer<vtkPoints> make_points(const std::vector<Vec<3>>& from);

/// Triangles of a part. Every CAD face has points of its own: shading is smooth within a face, not
/// across its border.
vtkSmartPointer<vtkPolyData> surface_data(const ReferenceSurface<3>& surface);

/// Array that a field of a mesh is in, and whether its values are of elements.
struct FieldArray {
  const char* name = "";
  bool of_elements = false;
};
FieldArray array_of(ColorBy field);
constexpr const char* velocity_array = "velocity";
/// Whether the mesh carries the field; of the filling ratio, of any body.
bool has_field(const MeshState& state, ColorBy field);
/// Whether there is a field of a flow, or of another solver, whose level sets can be drawn.
bool has_levels(const MeshState& state);
/// Values of a field, without the virtual node; empty where there is none, and of the filling
/// ratio.
std::vector<double> field_values(const MeshState& state, ColorBy field);
/// Gives cells that are `element` of the mesh, and points that are `node`, every field of it.
void add_fields(const MeshState& state, const std::vector<std::int32_t>& element,
                const std::vector<std::int32_t>& node, vtkDataSetAttributes& cells,
                vtkDataSetAttributes& points);
/// Gives points that are all nodes, the virtual one too, the velocity of the flow if there is one.
void add_velocity(const MeshState& state, vtkDataSetAttributes& points);

/// Gives points that are `node_array` of the mesh the smallest size asked there: not among the
/// fields above, since it takes a while.
void add_sizes(const MeshState& state, vtkDataSetAttributes& points);

/// Lines between CAD faces, sharp or smooth, and the sharp ones within.
vtkSmartPointer<vtkPolyData> feature_data(const ReferenceSurface<3>& surface);

/// Edges between boundary facets of different CAD faces: the features of a mesh without its part.
vtkSmartPointer<vtkPolyData> feature_data(const SimplexMesh<3>& mesh);

/// [face] the band of its element in `filling_map`, in [0, 1]. `element`: [face].
vtkSmartPointer<vtkFloatArray> filling_bands(const Filling& filling, std::int32_t region,
                                             vtkIntArray& element);

/// Values at quantiles, so that a few wild ones do not spoil the scale.
std::pair<double, double> robust_range(std::vector<double> values);

/// Length that a quarter of the polygons' sides do not reach, mm; 0 without polygons.
double typical_edge(vtkPolyData& data);

}  // namespace lamella::ui
