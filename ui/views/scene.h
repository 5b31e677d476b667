#pragma once

#include <QColor>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/surface.h"
#include "core/natural/thickness_map.h"
#include "core/study/run.h"
#include "ui/views/color_map.h"
#include "ui/views/section.h"

class vtkRenderer;

namespace lamella::ui {

struct PreparedMesh;
struct SkinChoice;

/// What lies under a pixel.
struct Picked {
  int part = -1;                     ///< -1: a mesh without its part
  Vec<3> point = Vec<3>::Zero();     ///< mm
  std::optional<std::int32_t> face;  ///< CAD face, unless it was cut open
  int element = -1;                  ///< of the mesh; -1: none is shown
};

/// Parts and meshes as pixels of one renderer. Shows the surfaces of the parts, or a mesh once it
/// is given one. Every number it colors by comes with the MeshState.
class Scene {
 public:
  explicit Scene(vtkRenderer& renderer);
  ~Scene();

  /// `colors` has one entry a part.
  void set_parts(const std::vector<Part>& parts, const std::vector<QColor>& colors);
  /// Null shows the parts. Bodies are matched to parts by name. What is not prepared, or otherwise
  /// than `skin_choice` says, is made here, which takes a while.
  void set_mesh(std::shared_ptr<const MeshState> state,
                std::shared_ptr<const PreparedMesh> prepared = nullptr);
  /// What of the next mesh will be drawn.
  SkinChoice skin_choice() const;
  /// Wall thickness on the surfaces of the parts, or the size asked there, one a part or null: for
  /// the fields `of_walls` while no mesh is shown.
  void set_walls(const std::vector<std::shared_ptr<const ThicknessMap>>& maps);
  void set_visible(const std::vector<bool>& visible);
  /// Parts outlined in the accent color.
  void set_selected(const std::vector<int>& parts);
  /// What is seen at `x`, `y` (device pixels from the bottom left).
  std::optional<Picked> pick(double x, double y) const;
  /// Other colors, one a part.
  void set_colors(const std::vector<QColor>& colors);
  /// Boundary groups: [part][facet of its surface] number of the group or -1, and their colors.
  void set_groups(std::vector<std::vector<int>> facet_group, std::vector<QColor> colors);
  /// Only elements with a quality in [low, high] are drawn; nothing: all.
  void set_quality_range(const std::optional<std::pair<double, double>>& range);
  /// mm a pixel of the picture has: edges of elements a few pixels wide are drawn fainter, or the
  /// picture would be all edges.
  /// True when that asks for another picture.
  bool set_pixel_size(double size);
  /// `layers_asked` centers the scale of ColorBy::layers; `body`: whose filling is shown.
  void set_color_by(ColorBy color_by, int layers_asked, const std::string& body);
  /// Outline of what one mesh of all bodies fills; empty: none.
  void set_hull(const ReferenceSurface<3>& hull);
  /// Cuts the mesh as `set_crinkle` says, and the parts smoothly; what is on the far side of any of
  /// the planes goes.
  void set_sections(const std::vector<Section>& sections);
  /// True (the default): the section leaves whole elements; false: it cuts through them.
  void set_crinkle(bool on);
  /// Arrows, lines and level sets of the mesh's flow.
  void set_flow(const FlowLook& look);
  void set_edges(bool on);
  void set_features(bool on);
  /// While the camera moves: a mesh of more triangles than that is drawn coarser, without edges.
  void set_moving(bool on, int most_triangles);

  /// False where the mesh carries no such field.
  bool has(ColorBy color_by) const;
  Legend legend() const;
  /// x0 x1 y0 y1 z0 z1 of everything shown or hidden; x0 > x1 when there is nothing.
  std::array<double, 6> bounds() const;
  /// Elements in the picture; of a section that cuts through elements, those cut. 0 while parts
  /// are shown.
  std::size_t shown_elements() const;

 private:
  void clip_parts();

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lamella::ui
