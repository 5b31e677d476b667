#pragma once

#include <vtkIdList.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace lamella::ui {

/// A surface with fewer triangles than the one it was made of.
struct CoarseSkin {
  vtkSmartPointer<vtkPolyData> surface;
  vtkSmartPointer<vtkIdList> cells;   ///< [triangle] the one it was
  vtkSmartPointer<vtkIdList> points;  ///< [point] one of those that it took the place of
};

/// `skin` in about `triangles`, for pictures that must come fast: points that are near each other
/// become one, put where the planes around them meet.
CoarseSkin coarse_skin(vtkPolyData& skin, int triangles);
/// Its surface, with the scalars that are active on `skin`, which it was made of or a copy of that.
vtkSmartPointer<vtkPolyData> with_scalars(const CoarseSkin& coarse, vtkPolyData& skin);

}  // namespace lamella::ui
