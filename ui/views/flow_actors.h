#pragma once

#include <memory>
#include <vector>

#include "core/study/run.h"
#include "ui/views/color_map.h"
#include "ui/views/section.h"

class vtkRenderer;
class vtkUnstructuredGrid;

namespace lamella::ui {

/// The flow through a mesh as arrows, streamlines and level sets.
class FlowActors {
 public:
  explicit FlowActors(vtkRenderer& renderer);
  ~FlowActors();

  /// `grid` has the fields of `state` (`add_fields`); null: nothing is drawn. Where the mesh is
  /// colored by a field of the flow, level sets are of that and everything is dark; else arrows and
  /// lines have the colors of the velocity.
  void draw(vtkUnstructuredGrid* grid, const MeshState* state, const std::vector<Section>& sections,
            const FlowLook& look, ColorBy color_by);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lamella::ui
