#pragma once

#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <array>
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
/// Values of a field, without the virtual node; those that the grid gets but of the filling ratio.
std::vector<double> field_values(const MeshState& state, ColorBy field);
/// Gives the grid every field of the mesh whose nodes it has, and the elements `element` [cell].
void add_fields(const MeshState& state, vtkIntArray& element, vtkUnstructuredGrid& grid);

/// Lines between CAD faces, sharp or smooth, and the sharp ones within.
vtkSmartPointer<vtkPolyData> feature_data(const ReferenceSurface<3>& surface);

/// Edges between boundary facets of different CAD faces: the features of a mesh without its part.
vtkSmartPointer<vtkPolyData> feature_data(const SimplexMesh<3>& mesh);

/// The triangles, each as its nodes in rising order; sorted. `node`: [point] of the mesh.
std::vector<std::array<NodeId, 3>> sorted_faces(vtkPolyData& data, vtkIntArray& node);

/// [face] the band of its element in `filling_map`, in [0, 1]. `element`: [face].
vtkSmartPointer<vtkFloatArray> filling_bands(const Filling& filling, std::int32_t region,
                                             vtkIntArray& element);

/// Values at quantiles, so that a few wild ones do not spoil the scale.
std::pair<double, double> robust_range(std::vector<double> values);

/// Length that a quarter of the polygons' sides do not reach, mm; 0 without polygons.
double typical_edge(vtkPolyData& data);

}  // namespace lamella::ui
