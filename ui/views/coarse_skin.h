#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace lamella::ui {

/// The triangles of `skin` with about `triangles` of them, for pictures that must come fast: points
/// that are near each other become one, put where the planes around them meet. Carries the scalars
/// that are active.
vtkSmartPointer<vtkPolyData> coarse_skin(vtkPolyData& skin, int triangles);

}  // namespace lamella::ui
