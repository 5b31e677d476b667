#include "ui/views/scene.h"

#include <vtkActor.h>
#include <vtkCellData.h>
#include <vtkCellPicker.h>
#include <vtkCutter.h>
#include <vtkIntArray.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ui/theme.h"
#include "ui/views/coarse_skin.h"
#include "ui/views/flow_actors.h"
#include "ui/views/legends.h"
#include "ui/views/mesh_data.h"
#include "ui/views/mesh_skin.h"
#include "ui/views/scene_actors.h"

namespace lamella::ui {

struct Scene::Impl {
  vtkRenderer& renderer;
  std::vector<PartActors> parts;
  std::vector<bool> visible;
  std::vector<int> selected;
  double mesh_edge = 0;  // typical of what is drawn, mm; 0: unknown
  double pixel = 0;      // mm
  std::shared_ptr<const MeshState> state;
  std::vector<std::vector<int>> facet_group;  // [part][facet of its surface]
  std::vector<std::vector<int>> face_group;   // [part][CAD face], -1: not all of it
  std::vector<QColor> group_colors;
  std::optional<std::pair<double, double>> quality_range;
  std::vector<int> part_of_body;
  MeshSkin skins;
  vtkSmartPointer<vtkPolyData> skin;  // without cuts, made when first needed
  vtkNew<vtkActor> mesh_actor;
  vtkNew<vtkPolyDataMapper> mesh_mapper;
  vtkSmartPointer<vtkPolyData> coarse;  // of what the mesh actor shows, made when first needed
  vtkNew<vtkActor> coarse_actor;
  vtkNew<vtkPolyDataMapper> coarse_mapper;
  vtkNew<vtkActor> mesh_lines;  // features, where there is no part to take them from
  vtkNew<vtkPolyDataMapper> mesh_lines_mapper;
  vtkNew<vtkActor> hull_lines;
  vtkNew<vtkPolyDataMapper> hull_mapper;
  FlowActors flow;
  FlowLook flow_look;
  std::vector<Section> sections;
  std::vector<Cut> cuts;
  ColorBy color_by = ColorBy::body;
  int layers_asked = 4;
  std::string filled_by;
  bool edges = true;
  bool crinkle = true;
  bool features = true;
  vtkIdType most_triangles = 0;      // while the camera moves; 0: it does not
  std::size_t shown = 0, whole = 0;  // elements drawn, and of `skin`
  Legend legend;
  std::vector<double> wall_values;  // on all parts
  std::array<double, 6> bounds{1, -1, 1, -1, 1, -1};

  explicit Impl(vtkRenderer& r) : renderer(r), flow(r) {
    vtkMapper::SetResolveCoincidentTopologyToPolygonOffset();
    style_mesh(*mesh_actor, *mesh_mapper);
    renderer.AddActor(mesh_actor);
    coarse_actor->SetMapper(coarse_mapper);
    coarse_actor->SetProperty(mesh_actor->GetProperty());
    coarse_actor->VisibilityOff();
    renderer.AddActor(coarse_actor);
    style_lines(*mesh_lines, *mesh_lines_mapper);
    renderer.AddActor(mesh_lines);
    style_lines(*hull_lines, *hull_mapper);
    hull_lines->GetProperty()->SetColor(0.45, 0.52, 0.60);
    hull_lines->PickableOff();
    hull_lines->VisibilityOff();
    renderer.AddActor(hull_lines);
    add_lights(renderer);
  }

  bool part_visible(int part) const {
    return part < 0 || part >= static_cast<int>(visible.size()) || visible[part];
  }

  bool has(ColorBy field) const {
    if (field == ColorBy::body) return true;
    if (!state)
      return of_walls(field) &&
             std::any_of(parts.begin(), parts.end(), [](auto& p) { return p.wall_map != nullptr; });
    return has_field(*state, field) && (field != ColorBy::filling || filled_region() >= 0);
  }

  /// Of the body whose filling is shown; -1: it is not in this mesh.
  int filled_region() const {
    const auto& bodies = state->mesh.bodies;
    const auto it = std::find(bodies.begin(), bodies.end(), filled_by);
    return it == bodies.end() ? -1 : static_cast<int>(it - bodies.begin());
  }

  void match_bodies() {
    part_of_body.clear();
    if (!state) return;
    for (const std::string& body : state->mesh.bodies) {
      const auto part = std::find_if(parts.begin(), parts.end(),
                                     [&](const PartActors& p) { return p.name == body; });
      part_of_body.push_back(part == parts.end() ? -1 : static_cast<int>(part - parts.begin()));
    }
  }

  QColor color_of_body(int body) const {
    const int part = part_of_body[static_cast<std::size_t>(body)];
    if (part >= 0) return parts[static_cast<std::size_t>(part)].color;
    // A mesh file without its study: its bodies must differ still.
    const std::vector<std::string>& names = state->mesh.bodies;
    if (names.size() > 1)
      return names[static_cast<std::size_t>(body)] == "background" ? theme::surroundings
                                                                   : body_color(body);
    static const QColor plain(0x7f, 0xa8, 0xd1);
    return plain;
  }

  void update_bounds() {
    Vec<3> low = Vec<3>::Constant(std::numeric_limits<double>::max());
    Vec<3> high = -low;
    const auto take = [&](vtkMapper& mapper) {
      double b[6];
      mapper.GetBounds(b);
      if (b[0] > b[1]) return;  // nothing is drawn
      low = low.cwiseMin(Vec<3>(b[0], b[2], b[4]));
      high = high.cwiseMax(Vec<3>(b[1], b[3], b[5]));
    };
    for (const PartActors& part : parts) take(*part.surface->GetMapper());
    if (hull_lines->GetVisibility()) take(*hull_mapper);
    if (parts.empty() && state) {
      for (std::size_t k = 1; k < state->mesh.points.size(); ++k) {
        low = low.cwiseMin(state->mesh.points[k]);
        high = high.cwiseMax(state->mesh.points[k]);
      }
    }
    bounds = {low[0], high[0], low[1], high[1], low[2], high[2]};
  }

  void update_visibility() {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const bool on = part_visible(static_cast<int>(k));
      parts[k].surface->SetVisibility(on && !state);
      const bool outlined = parts.size() > 1 && std::find(selected.begin(), selected.end(),
                                                          static_cast<int>(k)) != selected.end();
      parts[k].features->SetVisibility(on && (features || outlined));
      vtkProperty* line = parts[k].features->GetProperty();
      if (outlined) {
        set_color(*line, theme::accent);
      } else {
        line->SetColor(0.10, 0.15, 0.21);
        if (theme::dark) line->SetColor(0, 0, 0);
      }
      // Against the dark of the view thin lines are lost.
      line->SetLineWidth(outlined ? 3.2F : theme::dark ? 2.4F : 1.6F);
      parts[k].surface->GetProperty()->SetEdgeVisibility(false);
    }
    show_mesh();
    mesh_lines->SetVisibility(state != nullptr && parts.empty() && features);
    mesh_lines->GetProperty()->SetLineWidth(theme::dark ? 2.4F : 1.6F);
    for (const Cut& cut : cuts) {
      cut.actor->SetVisibility(state != nullptr && !crinkle);
      cut.actor->GetProperty()->SetEdgeVisibility(edges);
    }
  }

  /// What is drawn of a mesh: the elements of visible bodies, cut by whole elements or not.
  SkinChoice choice() const {
    SkinChoice choice;
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (!part_visible(static_cast<int>(k))) choice.hidden.push_back(parts[k].name);
    choice.quality = quality_range;
    if (crinkle)
      for (const Cut& cut : cuts)
        choice.planes.emplace_back(Vec<3>(cut.keep->GetOrigin()), Vec<3>(cut.keep->GetNormal()));
    choice.grid = flow_look.any() || (!crinkle && !cuts.empty());
    return choice;
  }

  void choose_elements() {
    skin = nullptr;
    if (state) skins.choose(choice());
  }

  void update_mesh() {
    shown = 0;
    mesh_mapper->RemoveAllClippingPlanes();
    for (const Cut& cut : cuts) cut.mapper->RemoveAllInputs();
    update_visibility();
    if (!skins) {
      rehearse();
      draw_flow();
      recolor();
      return;
    }
    if (!cuts.empty() && crinkle) {
      mesh_mapper->SetInputData(skins.skin(choice().planes));
      shown = skins.elements();
    } else {
      if (!skin) {
        skin = skins.skin({});
        whole = skins.elements();
      }
      mesh_mapper->SetInputData(skin);
      shown = whole;
      if (!cuts.empty()) cut_through();
    }
    mesh_edge = typical_edge(*mesh_mapper->GetInput());
    shade_edges();
    draw_flow();
    recolor();
  }

  /// Draws a speck as a mesh is drawn. Programs for the graphics are translated where they are
  /// first used, which is not to hold the window when a run brings its first mesh.
  void rehearse() {
    const Vec<3> middle(bounds[0] + bounds[1], bounds[2] + bounds[3], bounds[4] + bounds[5]);
    mesh_mapper->SetInputData(speck(middle / 2));
    mesh_mapper->ScalarVisibilityOn();
    mesh_mapper->SetScalarModeToUseCellData();
    mesh_mapper->SetColorModeToDirectScalars();
  }

  /// The mesh, or something coarser while there is no time for all of it.
  void show_mesh() {
    const bool on = state != nullptr;
    const vtkIdType all = on && mesh_mapper->GetNumberOfInputConnections(0) > 0
                              ? mesh_mapper->GetInput()->GetNumberOfCells()
                              : 0;
    const bool fast = most_triangles > 0 && all > most_triangles;
    if (fast && !coarse) {
      vtkPolyData& drawn = *mesh_mapper->GetInput();
      const CoarseSkin* made = skins.coarse(drawn);
      coarse = with_scalars(made ? *made : coarse_skin(drawn, static_cast<int>(most_triangles / 2)),
                            drawn);
    }
    if (fast) {
      // How it colors and what clips it; the shaders are each mapper's own.
      coarse_mapper->vtkMapper::ShallowCopy(mesh_mapper);
      coarse_mapper->SetInputData(coarse);
    }
    coarse_actor->SetVisibility(fast);
    mesh_actor->SetVisibility(on ? !fast : !parts.empty());
    mesh_actor->GetProperty()->SetEdgeVisibility(edges && !sees_lines() && !fast);
  }

  /// Arrows and lines within the mesh, which lets them be seen.
  void draw_flow() {
    const bool on = skins && flow_look.any() && state && has_levels(*state);
    flow.draw(on ? skins.grid() : nullptr, on ? state.get() : nullptr, sections, flow_look,
              color_by);
    mesh_actor->GetProperty()->SetOpacity(sees_lines() ? 0.3 : 1);
    // What is drawn is closed: only through it can its far side be seen.
    mesh_actor->GetProperty()->SetBackfaceCulling(!sees_lines());
    show_mesh();
  }
  bool sees_lines() const { return flow_look.lines && has(ColorBy::speed); }

  /// Faces where the planes go through elements, each cut off by the other planes.
  void cut_through() {
    shown = 0;
    if (color_by == ColorBy::size && has(color_by))
      add_sizes(*state, *skins.grid()->GetPointData());
    for (Cut& cut : cuts) {
      mesh_mapper->AddClippingPlane(cut.clip);
      vtkNew<vtkCutter> cutter;
      cutter->SetInputData(skins.grid());
      cutter->SetCutFunction(cut.keep);
      cutter->GenerateTrianglesOff();
      cutter->Update();
      auto data = vtkSmartPointer<vtkPolyData>::New();
      data->ShallowCopy(cutter->GetOutput());
      cut.mapper->SetInputData(data);
      cut.mapper->RemoveAllClippingPlanes();
      for (const Cut& other : cuts)
        if (&other != &cut) cut.mapper->AddClippingPlane(other.clip);
      cut.edge = typical_edge(*data);
      shown += static_cast<std::size_t>(data->GetNumberOfCells());
    }
  }

  void shade_edges() {
    const auto shade_one = [this](vtkActor& actor, double length) {
      if (!(pixel > 0) || !(length > 0)) return;
      // Full strength from 14 pixels an edge, the faintest at 3.
      const double shade =
          std::clamp((std::log(14.0) - std::log(length / pixel)) / std::log(14.0 / 3), 0.0, 1.0);
      const auto mix = [&](double dark, double faint) { return dark + shade * (faint - dark); };
      actor.GetProperty()->SetEdgeColor(mix(0.24, 0.56), mix(0.29, 0.59), mix(0.35, 0.63));
    };
    shade_one(*mesh_actor, mesh_edge);
    for (const Cut& cut : cuts) shade_one(*cut.actor, cut.edge);
  }

  void recolor() {
    legend = {};
    if (color_by != ColorBy::body && !has(color_by) && (state || !parts.empty()))
      legend = missing_legend(color_by, state != nullptr);
    if (!state && of_walls(color_by) && has(color_by))
      legend = color_by == ColorBy::size ? size_legend(wall_values) : thickness_legend(wall_values);
    color_parts();
    if (!skins) return;
    // Shading gives a body its shape, but the colors of values must be those of the legend.
    const bool values = color_by != ColorBy::body && has(color_by);
    mesh_actor->GetProperty()->SetAmbient(values ? 0.74 : 0.42);
    mesh_actor->GetProperty()->SetDiffuse(values ? 0.28 : 0.68);
    if (color_by != ColorBy::body && has(color_by))
      legend = field_legend(color_by, *state, layers_asked, filled_by);
    else if (color_by == ColorBy::body && flow_look.any() && has(ColorBy::speed))
      legend = field_legend(ColorBy::speed, *state, layers_asked, filled_by);
    color(*mesh_mapper, false);
    coarse = nullptr;
    show_mesh();
    for (const Cut& cut : cuts) {
      cut.actor->GetProperty()->SetAmbient(1);
      cut.actor->GetProperty()->SetDiffuse(0);
      if (cut.mapper->GetNumberOfInputConnections(0) > 0) color(*cut.mapper, true);
    }
  }

  /// Group of a facet of the mesh: that of its CAD face, if all of it is in one; -1: none.
  int group_of(int part, std::size_t facet) const {
    const SimplexMesh<3>& mesh = state->mesh;
    const auto p = static_cast<std::size_t>(part);
    if (part < 0 || p >= face_group.size() || facet >= mesh.facet_face.size()) return -1;
    const auto face = static_cast<std::size_t>(mesh.facet_face[facet]);
    if (face >= face_group[p].size()) return -1;
    return face_group[p][face];
  }

  /// Parts in their colors, facets of groups in those of the groups, or by wall thickness.
  void color_parts() {
    const bool by_wall = !state && of_walls(color_by) && has(color_by);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (by_wall)
        show_walls(parts[p], legend);
      else
        show_groups(parts[p], p < facet_group.size() ? facet_group[p] : std::vector<int>{},
                    group_colors);
    }
  }

  /// `inside`: every face was made by the section.
  void color(vtkPolyDataMapper& mapper, bool inside) {
    vtkPolyData& data = *mapper.GetInput();
    if (data.GetNumberOfCells() == 0) return;
    mapper.ScalarVisibilityOn();
    // The choice is kept for the next mesh that has the field.
    if (color_by == ColorBy::body || !has(color_by)) {
      color_by_body(data, inside);
      mapper.SetScalarModeToUseCellData();
      mapper.SetColorModeToDirectScalars();
      data.Modified();
      return;
    }
    mapper.SetLookupTable(lookup_table(legend));
    mapper.UseLookupTableScalarRangeOn();
    mapper.SetColorModeToMapScalars();
    if (color_by == ColorBy::filling) {
      auto* element = vtkIntArray::SafeDownCast(data.GetCellData()->GetArray(element_array));
      show_values(data, *filling_bands(*state->filling, filled_region(), *element));
      mapper.SetScalarModeToUseCellData();
      mapper.InterpolateScalarsBeforeMappingOff();
    } else if (const auto [name, of_elements] = array_of(color_by); of_elements) {
      data.GetCellData()->SetActiveScalars(name);
      mapper.SetScalarModeToUseCellData();
      mapper.InterpolateScalarsBeforeMappingOff();
    } else {
      if (color_by == ColorBy::size && !inside) add_sizes(*state, *data.GetPointData());
      data.GetPointData()->SetActiveScalars(name);
      mapper.SetScalarModeToUsePointData();
      mapper.InterpolateScalarsBeforeMappingOn();
    }
    data.Modified();
  }

  void color_by_body(vtkPolyData& data, bool inside) {
    auto* element = vtkIntArray::SafeDownCast(data.GetCellData()->GetArray(element_array));
    auto* facet = vtkIntArray::SafeDownCast(data.GetCellData()->GetArray(facet_array));
    auto* opened = vtkUnsignedCharArray::SafeDownCast(data.GetCellData()->GetArray(opened_array));
    // A few colors for many faces: each as it is, and where a cut laid it open. Bodies side by side
    // in a cut must differ.
    using Bytes = std::array<unsigned char, 3>;
    const auto both = [&](const QColor& c) {
      const auto bytes = [](const QColor& of) {
        return Bytes{static_cast<unsigned char>(of.red()), static_cast<unsigned char>(of.green()),
                     static_cast<unsigned char>(of.blue())};
      };
      return std::array{bytes(c), bytes(inside_color(c, state->mesh.bodies.size() > 1 ? 2 : 1))};
    };
    std::vector<std::array<Bytes, 2>> of_body, of_group;
    for (std::size_t b = 0; b < state->mesh.bodies.size(); ++b)
      of_body.push_back(both(color_of_body(static_cast<int>(b))));
    for (const QColor& c : group_colors) of_group.push_back(both(c));
    const auto& element_body = state->mesh.element_body;
    const vtkIdType faces = data.GetNumberOfCells();
    vtkNew<vtkUnsignedCharArray> rgb;
    rgb->SetName("body color");
    rgb->SetNumberOfComponents(3);
    rgb->SetNumberOfTuples(faces);
    unsigned char* out = rgb->GetPointer(0);
    for (vtkIdType f = 0; f < faces; ++f, out += 3) {
      const auto e = static_cast<std::size_t>(element->GetValue(f));
      const auto body = element_body.empty() ? 0 : static_cast<std::size_t>(element_body[e]);
      const int number = inside ? -1 : facet->GetValue(f);
      const int group =
          number < 0 ? -1 : group_of(part_of_body[body], static_cast<std::size_t>(number));
      const auto& color = group < 0 ? of_body[body] : of_group[static_cast<std::size_t>(group)];
      const Bytes& bytes = color[inside || opened->GetValue(f) != 0 ? 1 : 0];
      std::copy(bytes.begin(), bytes.end(), out);
    }
    show_values(data, *rgb);
  }

  /// Colors cells by these values. The active ones stay for the next time: SetScalars would throw
  /// them away.
  static void show_values(vtkPolyData& data, vtkDataArray& values) {
    data.GetCellData()->AddArray(&values);
    data.GetCellData()->SetActiveScalars(values.GetName());
  }
};

Scene::Scene(vtkRenderer& renderer) : impl_(std::make_unique<Impl>(renderer)) {}
Scene::~Scene() = default;

void Scene::set_parts(const std::vector<Part>& parts, const std::vector<QColor>& colors) {
  for (const PartActors& old : impl_->parts) {
    impl_->renderer.RemoveActor(old.surface);
    impl_->renderer.RemoveActor(old.features);
  }
  impl_->parts.clear();
  impl_->visible.assign(parts.size(), true);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    PartActors actors = part_actors(parts[k], colors[k]);
    impl_->renderer.AddActor(actors.surface);
    impl_->renderer.AddActor(actors.features);
    impl_->parts.push_back(std::move(actors));
  }
  impl_->facet_group.clear();
  impl_->face_group.clear();
  impl_->match_bodies();
  impl_->choose_elements();
  impl_->update_bounds();
  clip_parts();
  impl_->update_mesh();
}

void Scene::set_mesh(std::shared_ptr<const MeshState> state,
                     std::shared_ptr<const PreparedMesh> prepared) {
  impl_->state = std::move(state);
  impl_->skins.set(impl_->state, std::move(prepared));
  impl_->match_bodies();
  if (impl_->state && impl_->parts.empty())
    impl_->mesh_lines_mapper->SetInputData(feature_data(impl_->state->mesh));
  impl_->choose_elements();
  impl_->update_bounds();
  impl_->update_mesh();
  impl_->update_visibility();
}

SkinChoice Scene::skin_choice() const { return impl_->choice(); }

void Scene::set_walls(const std::vector<std::shared_ptr<const ThicknessMap>>& maps) {
  std::vector<double> all;
  for (std::size_t k = 0; k < impl_->parts.size(); ++k) {
    const auto map = k < maps.size() ? maps[k] : nullptr;
    ui::set_walls(impl_->parts[k], map);
    if (map) all.insert(all.end(), map->thickness.begin(), map->thickness.end());
  }
  impl_->wall_values = std::move(all);
  impl_->recolor();
}

void Scene::set_visible(const std::vector<bool>& visible) {
  if (visible == impl_->visible) return;
  impl_->visible = visible;
  impl_->choose_elements();
  impl_->update_mesh();
  impl_->update_visibility();
}

void Scene::set_selected(const std::vector<int>& parts) {
  if (parts == impl_->selected) return;
  impl_->selected = parts;
  impl_->update_visibility();
}

std::optional<Picked> Scene::pick(double x, double y) const {
  vtkNew<vtkCellPicker> picker;
  picker->SetTolerance(0);
  picker->PickFromListOn();
  for (const PartActors& part : impl_->parts)
    if (part.surface->GetVisibility()) picker->AddPickList(part.surface);
  if (impl_->state && impl_->mesh_actor->GetVisibility()) picker->AddPickList(impl_->mesh_actor);
  for (const Cut& cut : impl_->cuts)
    if (cut.actor->GetVisibility()) picker->AddPickList(cut.actor);
  if (!picker->Pick(x, y, 0, &impl_->renderer) || picker->GetCellId() < 0) return {};
  Picked picked;
  picker->GetPickPosition(picked.point.data());
  for (std::size_t k = 0; k < impl_->parts.size(); ++k) {
    if (picker->GetActor() != impl_->parts[k].surface) continue;
    picked.part = static_cast<int>(k);
    const PartActors& part = impl_->parts[k];
    picked.face = part.facet_face[facet_of(part, picker->GetCellId())];
    return picked;
  }
  vtkDataSet* data = picker->GetDataSet();
  auto* element =
      data ? vtkIntArray::SafeDownCast(data->GetCellData()->GetArray(element_array)) : nullptr;
  if (!element || !impl_->state) return {};
  const SimplexMesh<3>& mesh = impl_->state->mesh;
  picked.element = element->GetValue(picker->GetCellId());
  const auto e = static_cast<std::size_t>(picked.element);
  picked.part = impl_->part_of_body[mesh.element_body.empty()
                                        ? 0
                                        : static_cast<std::size_t>(mesh.element_body[e])];
  if (picker->GetActor() == impl_->mesh_actor) {
    const int facet = vtkIntArray::SafeDownCast(data->GetCellData()->GetArray(facet_array))
                          ->GetValue(picker->GetCellId());
    if (facet >= 0 && static_cast<std::size_t>(facet) < mesh.facet_face.size())
      picked.face = mesh.facet_face[static_cast<std::size_t>(facet)];
  }
  return picked;
}

void Scene::set_colors(const std::vector<QColor>& colors) {
  bool changed = false;
  for (std::size_t k = 0; k < impl_->parts.size() && k < colors.size(); ++k) {
    PartActors& part = impl_->parts[k];
    if (part.color == colors[k]) continue;
    changed = true;
    set_part_color(part, colors[k]);
  }
  if (changed) impl_->recolor();
}

void Scene::set_groups(std::vector<std::vector<int>> facet_group, std::vector<QColor> colors) {
  if (facet_group == impl_->facet_group && colors == impl_->group_colors) return;
  impl_->facet_group = std::move(facet_group);
  impl_->group_colors = std::move(colors);
  // A face of the mesh is in a group where all of its CAD face is.
  impl_->face_group.assign(impl_->facet_group.size(), {});
  for (std::size_t p = 0; p < impl_->facet_group.size() && p < impl_->parts.size(); ++p) {
    const std::vector<std::int32_t>& face = impl_->parts[p].facet_face;
    constexpr int unmet = -3;
    std::vector<int>& of = impl_->face_group[p];
    for (std::size_t f = 0; f < face.size(); ++f) {
      const auto id = static_cast<std::size_t>(face[f]);
      if (of.size() <= id) of.resize(id + 1, unmet);
      const int group = impl_->facet_group[p][f];
      of[id] = of[id] == unmet || of[id] == group ? group : -1;
    }
  }
  impl_->recolor();
}

void Scene::set_quality_range(const std::optional<std::pair<double, double>>& range) {
  if (range == impl_->quality_range) return;
  impl_->quality_range = range;
  impl_->choose_elements();
  impl_->update_mesh();
}

bool Scene::set_pixel_size(double size) {
  if (!(size > 0) || std::abs(size - impl_->pixel) < 0.02 * impl_->pixel) return false;
  impl_->pixel = size;
  impl_->shade_edges();
  return true;
}

void Scene::set_hull(const ReferenceSurface<3>& hull) {
  impl_->hull_lines->SetVisibility(!hull.points.empty());
  if (!hull.points.empty()) impl_->hull_mapper->SetInputData(feature_data(hull));
  impl_->update_bounds();
}

void Scene::set_color_by(ColorBy color_by, int layers_asked, const std::string& body) {
  if (color_by == impl_->color_by && layers_asked == impl_->layers_asked &&
      body == impl_->filled_by)
    return;
  impl_->filled_by = body;
  impl_->color_by = color_by;
  impl_->layers_asked = layers_asked;
  // What cuts through elements has points between the nodes.
  if (color_by == ColorBy::size && !impl_->crinkle && !impl_->cuts.empty())
    return impl_->update_mesh();
  impl_->draw_flow();
  impl_->recolor();
}

void Scene::set_sections(const std::vector<Section>& sections) {
  for (const Cut& cut : impl_->cuts) impl_->renderer.RemoveActor(cut.actor);
  impl_->cuts.clear();
  for (const Section& section : sections) {
    Cut cut = make_cut(section.origin, section.normal);
    impl_->renderer.AddActor(cut.actor);
    impl_->cuts.push_back(std::move(cut));
  }
  impl_->sections = sections;
  clip_parts();
  impl_->update_mesh();
}

void Scene::set_flow(const FlowLook& look) {
  if (look == impl_->flow_look) return;
  impl_->flow_look = look;
  impl_->draw_flow();
  impl_->recolor();
}

void Scene::clip_parts() {
  const auto clip = [this](vtkMapper& mapper) {
    mapper.RemoveAllClippingPlanes();
    for (const Cut& cut : impl_->cuts) mapper.AddClippingPlane(cut.clip);
  };
  for (const PartActors& part : impl_->parts) {
    clip(*part.surface->GetMapper());
    clip(*part.features->GetMapper());
  }
  clip(*impl_->mesh_lines_mapper);
}

void Scene::set_crinkle(bool on) {
  impl_->crinkle = on;
  impl_->update_mesh();
}

void Scene::set_edges(bool on) {
  impl_->edges = on;
  impl_->update_visibility();
}

void Scene::set_features(bool on) {
  impl_->features = on;
  impl_->update_visibility();
}

void Scene::set_moving(bool on, int most_triangles) {
  impl_->most_triangles = on ? most_triangles : 0;
  impl_->show_mesh();
}

bool Scene::has(ColorBy color_by) const { return impl_->has(color_by); }

Legend Scene::legend() const { return impl_->legend; }

std::array<double, 6> Scene::bounds() const { return impl_->bounds; }

std::size_t Scene::shown_elements() const { return impl_->shown; }

}  // namespace lamella::ui
