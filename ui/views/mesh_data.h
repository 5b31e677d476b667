#pragma once

#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <utility>
#include <vector>

#include "core/geometry/surface.h"
#include "core/mesh/simplex_mesh.h"
#include "core/multidomain/filling.h"

namespace lamella::ui {

/// Points as VTK has them, in the same order. mm.
vtkSmartPointer<vtkPoints> make_points(const std::vector<Vec<3>>& from);

/// Triangles of a part. Every CAD face has points of its own: shading is smooth within a face, not
/// across its border.
vtkSmartPointer<vtkPolyData> surface_data(const ReferenceSurface<3>& surface);

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
