#pragma once

#include <vtkActor.h>
#include <vtkSmartPointer.h>

#include <vector>

#include "core/study/study.h"

class vtkRenderer;

namespace lamella::ui {

/// The shapes of sizing objects, drawn translucent over the model.
class SizeShapes {
 public:
  explicit SizeShapes(vtkRenderer& renderer);
  ~SizeShapes();

  /// `selected` is drawn stronger; -1: none.
  void set(const std::vector<SizingObject>& objects, const std::vector<Part>& parts, int selected);

 private:
  vtkRenderer& renderer_;
  std::vector<vtkSmartPointer<vtkActor>> actors_;
};

}  // namespace lamella::ui
