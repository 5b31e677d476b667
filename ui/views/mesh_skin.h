#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/study/run.h"
#include "ui/session/mesh_faces.h"
#include "ui/views/coarse_skin.h"

namespace lamella::ui {

/// Names of what goes along with the pixels: of cells the element, its face of the mesh (-1:
/// inside) and whether a cut laid the face open; of points the node. Fields are named by
/// `array_of`.
inline constexpr const char* element_array = "element";
inline constexpr const char* facet_array = "facet";
inline constexpr const char* opened_array = "opened";
inline constexpr const char* node_array = "node";

/// What of a mesh is drawn.
struct SkinChoice {
  std::vector<std::string> hidden;  ///< bodies out of sight
  std::optional<std::pair<double, double>> quality;
  /// Origin and normal of each: elements without a node where all are negative go.
  std::vector<std::pair<Vec<3>, Vec<3>>> planes;
  bool grid = false;  ///< the elements themselves are needed too, to be cut through
  int fast = 0;       ///< triangles drawn while the camera moves; 0: not known yet

  bool operator==(const SkinChoice&) const = default;
};

/// What drawing a mesh takes longest for. Made off the window's thread, then belongs to that.
struct PreparedMesh {
  MeshFaces faces;
  SkinChoice choice;  ///< that the rest is of
  vtkSmartPointer<vtkPolyData> skin;
  std::optional<CoarseSkin> coarse;  ///< of a skin that has more triangles than `fast`
  std::size_t elements = 0;
  vtkSmartPointer<vtkUnstructuredGrid> grid;  ///< null: not asked for
};
std::shared_ptr<const PreparedMesh> prepare_mesh(std::shared_ptr<const MeshState> state,
                                                 const SkinChoice& choice);

/// The elements of a mesh that are drawn: those of bodies in sight, in a range of qualities.
class MeshSkin {
 public:
  /// Null: nothing. What is not prepared is made here.
  void set(std::shared_ptr<const MeshState> state, std::shared_ptr<const PreparedMesh> prepared);
  /// Takes its bodies and its range.
  void choose(const SkinChoice& choice);
  explicit operator bool() const { return state_ != nullptr; }

  /// The outside of the chosen elements that have a node where all planes (origin, normal) are
  /// negative; without planes, of all of them.
  vtkSmartPointer<vtkPolyData> skin(const std::vector<std::pair<Vec<3>, Vec<3>>>& planes);
  /// Elements of the last skin.
  std::size_t elements() const { return elements_; }
  /// What `of`, one of the skins, looks like with fewer triangles; null: that is not prepared.
  const CoarseSkin* coarse(vtkPolyData& of) const;
  /// The chosen elements as a grid to be cut through, made when first asked for.
  vtkUnstructuredGrid* grid();

 private:
  /// Fills the marks of elements, unless they are up to date.
  void mark();
  bool prepared() const;

  std::shared_ptr<const MeshState> state_;
  std::shared_ptr<const PreparedMesh> prepared_;
  SkinChoice choice_;           // without planes
  std::vector<char> in_sight_;  // [element] its body is; empty: not marked yet
  std::vector<char> chosen_;    // [element] and its quality is in the range
  std::size_t elements_ = 0;
  vtkSmartPointer<vtkUnstructuredGrid> grid_;
};

}  // namespace lamella::ui
