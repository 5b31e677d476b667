#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/study/run.h"
#include "ui/session/mesh_faces.h"

namespace lamella::ui {

/// Names of what goes along with the pixels: of cells the element, its face of the mesh (-1:
/// inside) and whether a cut laid the face open; of points the node. Fields are named by
/// `array_of`.
inline constexpr const char* element_array = "element";
inline constexpr const char* facet_array = "facet";
inline constexpr const char* opened_array = "opened";
inline constexpr const char* node_array = "node";

/// The elements of a mesh that are drawn: those of bodies in sight, in a range of qualities.
class MeshSkin {
 public:
  /// Null: nothing. Without `faces` they are made here.
  void set(std::shared_ptr<const MeshState> state, std::shared_ptr<const MeshFaces> faces);
  /// [body of the mesh] and the range; empty: all.
  void choose(const std::vector<bool>& body_visible,
              const std::optional<std::pair<double, double>>& quality);
  explicit operator bool() const { return state_ != nullptr; }

  /// The outside of the chosen elements that have a node where all planes (origin, normal) are
  /// negative; without planes, of all of them.
  vtkSmartPointer<vtkPolyData> skin(const std::vector<std::pair<Vec<3>, Vec<3>>>& planes);
  /// Elements of the last skin.
  std::size_t elements() const { return elements_; }
  /// The chosen elements as a grid to be cut through, made when first asked for.
  vtkUnstructuredGrid* grid();

 private:
  std::shared_ptr<const MeshState> state_;
  std::shared_ptr<const MeshFaces> faces_;
  std::vector<char> in_sight_;  // [element] its body is
  std::vector<char> chosen_;    // [element] and its quality is in the range
  std::size_t elements_ = 0;
  vtkSmartPointer<vtkUnstructuredGrid> grid_;
};

}  // namespace lamella::ui
