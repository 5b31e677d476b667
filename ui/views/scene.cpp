#include "ui/views/scene.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellPicker.h>
#include <vtkCutter.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkExtractGeometry.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkLight.h>
#include <vtkLookupTable.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <QCoreApplication>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ui/theme.h"
#include "ui/views/mesh_data.h"

namespace lamella::ui {
namespace {

constexpr const char* element_array = "element";
constexpr const char* node_array = "node";
constexpr const char* thickness_array = "thickness";
constexpr const char* layers_array = "layers";
constexpr const char* quality_array = "quality";

void set_color(vtkProperty& property, const QColor& color) {
  property.SetColor(color.redF(), color.greenF(), color.blueF());
}

void style_lines(vtkActor& actor, vtkPolyDataMapper& mapper) {
  mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-1, -8);
  actor.SetMapper(&mapper);
  actor.GetProperty()->SetColor(0.10, 0.15, 0.21);
  actor.GetProperty()->SetLineWidth(1.6F);
  actor.GetProperty()->LightingOff();
}

/// Paler and warmer: the inside of a cut body.
QColor inside_color(const QColor& c) {
  return {(c.red() + 2 * 255) / 3, (c.green() + 2 * 250) / 3, (c.blue() + 2 * 238) / 3};
}

struct PartActors {
  std::string name;
  QColor color;
  vtkSmartPointer<vtkActor> surface;
  vtkSmartPointer<vtkActor> features;
};

}  // namespace

struct Scene::Impl {
  vtkRenderer& renderer;
  std::vector<PartActors> parts;
  std::vector<bool> visible;
  std::vector<int> selected;
  double mesh_edge = 0;  // typical of what is drawn, mm; 0: unknown
  double cut_edge = 0;
  double pixel = 0;  // mm
  std::shared_ptr<const MeshState> state;
  std::vector<std::array<NodeId, 3>> outer;  // sorted boundary faces of the mesh, each sorted
  std::vector<int> part_of_body;
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  vtkSmartPointer<vtkPolyData> skin;  // of the whole grid, made when first needed
  vtkNew<vtkActor> mesh_actor;
  vtkNew<vtkPolyDataMapper> mesh_mapper;
  vtkNew<vtkActor> cut_actor;  // where the section goes through elements
  vtkNew<vtkPolyDataMapper> cut_mapper;
  vtkNew<vtkActor> mesh_lines;  // features, where there is no part to take them from
  vtkNew<vtkPolyDataMapper> mesh_lines_mapper;
  vtkNew<vtkPlane> cut_plane;   // for the elements: keeps the negative side
  vtkNew<vtkPlane> clip_plane;  // for mappers: they keep the positive side
  std::optional<Section> section;
  ColorBy color_by = ColorBy::body;
  int layers_asked = 4;
  bool edges = true;
  bool crinkle = true;
  bool features = true;
  std::size_t shown = 0;
  Legend legend;
  std::array<double, 6> bounds{1, -1, 1, -1, 1, -1};

  explicit Impl(vtkRenderer& r) : renderer(r) {
    vtkMapper::SetResolveCoincidentTopologyToPolygonOffset();
    for (const auto& [actor, mapper] : {std::pair{mesh_actor.Get(), mesh_mapper.Get()},
                                        std::pair{cut_actor.Get(), cut_mapper.Get()}}) {
      actor->SetMapper(mapper);
      vtkProperty* property = actor->GetProperty();
      property->SetInterpolationToFlat();
      property->SetAmbient(0.42);
      property->SetDiffuse(0.68);
      property->SetEdgeColor(0.22, 0.28, 0.35);
      property->SetLineWidth(1);
      actor->VisibilityOff();
      renderer.AddActor(actor);
    }
    style_lines(*mesh_lines, *mesh_lines_mapper);
    renderer.AddActor(mesh_lines);
    // A key light over the left shoulder gives faces of different slope different shades; the
    // second one keeps what it leaves in the dark readable.
    renderer.AutomaticLightCreationOff();
    for (const auto& [x, y, z, intensity] :
         {std::array{-0.30, 0.60, 1.0, 0.95}, std::array{0.7, -0.2, 1.0, 0.35}}) {
      vtkNew<vtkLight> light;
      light->SetLightTypeToCameraLight();
      light->SetPosition(x, y, z);
      light->SetFocalPoint(0, 0, 0);
      light->SetIntensity(intensity);
      renderer.AddLight(light);
    }
  }

  bool part_visible(int part) const {
    return part < 0 || part >= static_cast<int>(visible.size()) || visible[part];
  }

  bool has(ColorBy field) const {
    if (field == ColorBy::body) return true;
    if (!state) return false;
    const SimplexMesh<3>& mesh = state->mesh;
    switch (field) {
      case ColorBy::quality:
        return state->quality.size() == mesh.elements.size();
      case ColorBy::thickness:
        return state->thickness.size() == mesh.points.size();
      case ColorBy::layers:
        return state->layers.size() == mesh.points.size();
      case ColorBy::body:
        break;
    }
    return true;
  }

  QColor color_of_body(int body) const {
    const int part = part_of_body[static_cast<std::size_t>(body)];
    if (part >= 0) return parts[static_cast<std::size_t>(part)].color;
    static const QColor plain(0x7f, 0xa8, 0xd1);
    return plain;
  }

  void update_bounds() {
    Vec<3> low = Vec<3>::Constant(std::numeric_limits<double>::max());
    Vec<3> high = -low;
    for (const PartActors& part : parts) {
      double b[6];
      part.surface->GetMapper()->GetBounds(b);
      low = low.cwiseMin(Vec<3>(b[0], b[2], b[4]));
      high = high.cwiseMax(Vec<3>(b[1], b[3], b[5]));
    }
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
      }
      line->SetLineWidth(outlined ? 3.2F : 1.6F);
      parts[k].surface->GetProperty()->SetEdgeVisibility(false);
    }
    mesh_actor->SetVisibility(state != nullptr);
    mesh_lines->SetVisibility(state != nullptr && parts.empty() && features);
    cut_actor->SetVisibility(state != nullptr && section && !crinkle);
    mesh_actor->GetProperty()->SetEdgeVisibility(edges);
    cut_actor->GetProperty()->SetEdgeVisibility(edges);
  }

  /// The elements of visible bodies as a grid that remembers their numbers.
  void build_grid() {
    grid = nullptr;
    if (!state) return;
    const SimplexMesh<3>& mesh = state->mesh;
    vtkNew<vtkTypeInt64Array> corners;
    vtkNew<vtkIntArray> element;
    element->SetName(element_array);
    std::vector<char> body_visible(mesh.bodies.size());
    for (std::size_t b = 0; b < mesh.bodies.size(); ++b)
      body_visible[b] = part_visible(part_of_body[b]);
    corners->Allocate(static_cast<vtkIdType>(4 * mesh.elements.size()));
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
      if (!mesh.element_body.empty() &&
          !body_visible[static_cast<std::size_t>(mesh.element_body[e])])
        continue;
      for (const NodeId node : mesh.elements[e]) corners->InsertNextValue(node);
      element->InsertNextValue(static_cast<int>(e));
    }
    vtkNew<vtkCellArray> cells;
    cells->SetData(4, corners);
    vtkNew<vtkIntArray> node;
    node->SetName(node_array);
    node->SetNumberOfTuples(static_cast<vtkIdType>(mesh.points.size()));
    for (vtkIdType k = 0; k < node->GetNumberOfTuples(); ++k)
      node->SetValue(k, static_cast<int>(k));
    grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    grid->SetPoints(make_points(mesh.points));
    grid->SetCells(VTK_TETRA, cells);
    grid->GetCellData()->AddArray(element);
    grid->GetPointData()->AddArray(node);
    const auto add = [&](ColorBy field, const std::vector<double>& values, const char* name) {
      if (!has(field)) return;
      vtkNew<vtkFloatArray> array;
      array->SetName(name);
      array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
      for (std::size_t k = 0; k < values.size(); ++k)
        array->SetValue(static_cast<vtkIdType>(k), static_cast<float>(values[k]));
      grid->GetPointData()->AddArray(array);
    };
    add(ColorBy::thickness, state->thickness, thickness_array);
    add(ColorBy::layers, state->layers, layers_array);
    if (has(ColorBy::quality)) {
      vtkNew<vtkFloatArray> quality;
      quality->SetName(quality_array);
      quality->SetNumberOfTuples(element->GetNumberOfTuples());
      for (vtkIdType k = 0; k < element->GetNumberOfTuples(); ++k)
        quality->SetValue(k, static_cast<float>(state->quality[std::size_t(element->GetValue(k))]));
      grid->GetCellData()->AddArray(quality);
    }
    skin = nullptr;
  }

  static vtkSmartPointer<vtkPolyData> skin_of(vtkUnstructuredGrid* of) {
    vtkNew<vtkDataSetSurfaceFilter> filter;
    filter->SetInputData(of);
    filter->Update();
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->ShallowCopy(filter->GetOutput());
    return data;
  }

  void update_mesh() {
    shown = 0;
    mesh_mapper->RemoveAllClippingPlanes();
    cut_mapper->RemoveAllInputs();
    update_visibility();
    if (!grid) {
      mesh_mapper->RemoveAllInputs();
      recolor();
      return;
    }
    if (section && crinkle) {
      vtkNew<vtkExtractGeometry> cut;
      cut->SetInputData(grid);
      cut->SetImplicitFunction(cut_plane);
      cut->ExtractInsideOn();
      cut->ExtractBoundaryCellsOn();
      cut->Update();
      shown = static_cast<std::size_t>(cut->GetOutput()->GetNumberOfCells());
      mesh_mapper->SetInputData(skin_of(cut->GetOutput()));
    } else {
      if (!skin) skin = skin_of(grid);
      mesh_mapper->SetInputData(skin);
      shown = static_cast<std::size_t>(grid->GetNumberOfCells());
      if (section) {
        mesh_mapper->AddClippingPlane(clip_plane);
        vtkNew<vtkCutter> cut;
        cut->SetInputData(grid);
        cut->SetCutFunction(cut_plane);
        cut->GenerateTrianglesOff();
        cut->Update();
        auto data = vtkSmartPointer<vtkPolyData>::New();
        data->ShallowCopy(cut->GetOutput());
        cut_mapper->SetInputData(data);
        shown = static_cast<std::size_t>(data->GetNumberOfCells());
      }
    }
    mesh_edge = typical_edge(*mesh_mapper->GetInput());
    cut_edge =
        cut_mapper->GetNumberOfInputConnections(0) > 0 ? typical_edge(*cut_mapper->GetInput()) : 0;
    shade_edges();
    recolor();
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
    shade_one(*cut_actor, cut_edge);
  }

  void recolor() {
    legend = {};
    const auto tr = [](const char* text) { return QCoreApplication::translate("Scene", text); };
    if (color_by != ColorBy::body && !has(color_by) && (state || !parts.empty())) {
      legend.title = color_by == ColorBy::quality     ? tr("Quality c(T)")
                     : color_by == ColorBy::thickness ? tr("Wall thickness")
                                                      : tr("Layers through the wall");
      legend.missing = state ? tr("not in this mesh") : tr("known once the part is meshed");
    }
    if (!grid) return;
    // Shading gives a body its shape, but the colors of values must be those of the legend.
    const bool values = color_by != ColorBy::body && has(color_by);
    mesh_actor->GetProperty()->SetAmbient(values ? 0.74 : 0.42);
    mesh_actor->GetProperty()->SetDiffuse(values ? 0.28 : 0.68);
    cut_actor->GetProperty()->SetAmbient(1);
    cut_actor->GetProperty()->SetDiffuse(0);
    if (color_by != ColorBy::body && has(color_by)) fill_legend();
    color(*mesh_mapper, false);
    if (cut_mapper->GetNumberOfInputConnections(0) > 0) color(*cut_mapper, true);
  }

  bool is_outer(std::array<NodeId, 3> face) const {
    std::sort(face.begin(), face.end());
    return std::binary_search(outer.begin(), outer.end(), face);
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
    vtkNew<vtkLookupTable> table;
    constexpr int entries = 256;
    table->SetNumberOfTableValues(entries);
    for (int k = 0; k < entries; ++k) {
      const QColor c = legend.map.at((k + 0.5) / entries);
      table->SetTableValue(k, c.redF(), c.greenF(), c.blueF(), 1);
    }
    table->SetNanColor(theme::missing.redF(), theme::missing.greenF(), theme::missing.blueF(), 1);
    table->SetRange(legend.low, legend.high);
    mapper.SetLookupTable(table);
    mapper.UseLookupTableScalarRangeOn();
    mapper.SetColorModeToMapScalars();
    if (color_by == ColorBy::quality) {
      data.GetCellData()->SetActiveScalars(quality_array);
      mapper.SetScalarModeToUseCellData();
      mapper.InterpolateScalarsBeforeMappingOff();
    } else {
      data.GetPointData()->SetActiveScalars(color_by == ColorBy::layers ? layers_array
                                                                        : thickness_array);
      mapper.SetScalarModeToUsePointData();
      mapper.InterpolateScalarsBeforeMappingOn();
    }
    data.Modified();
  }

  void color_by_body(vtkPolyData& data, bool inside) {
    auto* element = vtkIntArray::SafeDownCast(data.GetCellData()->GetArray(element_array));
    auto* node = vtkIntArray::SafeDownCast(data.GetPointData()->GetArray(node_array));
    const vtkIdType faces = data.GetNumberOfCells();
    vtkNew<vtkUnsignedCharArray> rgb;
    rgb->SetName("body color");
    rgb->SetNumberOfComponents(3);
    rgb->SetNumberOfTuples(faces);
    vtkNew<vtkIdList> corner;
    for (vtkIdType f = 0; f < faces; ++f) {
      const int e = element->GetValue(f);
      QColor c = color_of_body(
          state->mesh.element_body.empty() ? 0 : state->mesh.element_body[std::size_t(e)]);
      bool made_by_section = inside;
      if (section && crinkle && !inside) {
        data.GetCellPoints(f, corner);
        made_by_section =
            !is_outer({node->GetValue(corner->GetId(0)), node->GetValue(corner->GetId(1)),
                       node->GetValue(corner->GetId(2))});
      }
      if (made_by_section) c = inside_color(c);
      const unsigned char bytes[3] = {static_cast<unsigned char>(c.red()),
                                      static_cast<unsigned char>(c.green()),
                                      static_cast<unsigned char>(c.blue())};
      rgb->SetTypedTuple(f, bytes);
    }
    data.GetCellData()->SetScalars(rgb);
  }

  void fill_legend() {
    const auto tr = [](const char* text) { return QCoreApplication::translate("Scene", text); };
    switch (color_by) {
      case ColorBy::body:
        break;
      case ColorBy::quality:
        legend = {tr("Quality c(T)"), 0, 1, rating_map()};
        break;
      case ColorBy::thickness: {
        const auto& t = state->thickness;
        const auto [low, high] = robust_range({t.begin() + 1, t.end()});
        legend = {tr("Wall thickness, mm"), low, high, sequential_map()};
        break;
      }
      case ColorBy::layers: {
        // One band a layer, the one of n layers being the first good one.
        const int n = layers_asked;
        legend = {tr("Layers through the wall, %1 asked").arg(n), 0, 2.0 * n, rating_map()};
        legend.map.bands = std::min(2 * n, 24);
        legend.missing = tr("no wall to count in");
        break;
      }
    }
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
    PartActors actors;
    actors.name = parts[k].name;
    actors.color = colors[k];
    vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(surface_data(parts[k].surface));
    normals->ConsistencyOff();
    normals->SplittingOn();
    normals->SetFeatureAngle(32);
    normals->Update();
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(normals->GetOutput());
    actors.surface = vtkSmartPointer<vtkActor>::New();
    actors.surface->SetMapper(mapper);
    vtkProperty* property = actors.surface->GetProperty();
    set_color(*property, colors[k]);
    property->SetAmbient(0.40);
    property->SetDiffuse(0.70);
    property->SetSpecular(0.08);
    property->SetSpecularPower(20);
    property->SetEdgeColor(0.3, 0.36, 0.42);
    vtkNew<vtkProperty> back;
    set_color(*back, inside_color(colors[k]));
    back->SetAmbient(0.6);
    back->SetDiffuse(0.4);
    actors.surface->SetBackfaceProperty(back);

    vtkNew<vtkPolyDataMapper> lines;
    lines->SetInputData(feature_data(parts[k].surface));
    actors.features = vtkSmartPointer<vtkActor>::New();
    style_lines(*actors.features, *lines);
    impl_->renderer.AddActor(actors.surface);
    impl_->renderer.AddActor(actors.features);
    impl_->parts.push_back(std::move(actors));
  }
  impl_->update_bounds();
  set_section(impl_->section);
  impl_->update_visibility();
}

void Scene::set_mesh(std::shared_ptr<const MeshState> state) {
  impl_->state = std::move(state);
  impl_->outer.clear();
  impl_->part_of_body.clear();
  if (impl_->state) {
    const SimplexMesh<3>& mesh = impl_->state->mesh;
    for (const std::string& body : mesh.bodies) {
      const auto part = std::find_if(impl_->parts.begin(), impl_->parts.end(),
                                     [&](const PartActors& p) { return p.name == body; });
      impl_->part_of_body.push_back(
          part == impl_->parts.end() ? -1 : static_cast<int>(part - impl_->parts.begin()));
    }
    impl_->outer = mesh.facets;
    for (auto& facet : impl_->outer) std::sort(facet.begin(), facet.end());
    std::sort(impl_->outer.begin(), impl_->outer.end());
    if (impl_->parts.empty()) impl_->mesh_lines_mapper->SetInputData(feature_data(mesh));
  }
  impl_->build_grid();
  impl_->update_bounds();
  impl_->update_mesh();
  impl_->update_visibility();
}

void Scene::set_visible(const std::vector<bool>& visible) {
  if (visible == impl_->visible) return;
  impl_->visible = visible;
  impl_->build_grid();
  impl_->update_mesh();
  impl_->update_visibility();
}

void Scene::set_selected(const std::vector<int>& parts) {
  if (parts == impl_->selected) return;
  impl_->selected = parts;
  impl_->update_visibility();
}

int Scene::part_at(double x, double y) const {
  vtkNew<vtkCellPicker> picker;
  picker->SetTolerance(0);
  picker->PickFromListOn();
  for (const PartActors& part : impl_->parts)
    if (part.surface->GetVisibility()) picker->AddPickList(part.surface);
  for (vtkActor* actor : {impl_->mesh_actor.Get(), impl_->cut_actor.Get()})
    if (actor->GetVisibility()) picker->AddPickList(actor);
  if (!picker->Pick(x, y, 0, &impl_->renderer)) return -1;
  for (std::size_t k = 0; k < impl_->parts.size(); ++k)
    if (picker->GetActor() == impl_->parts[k].surface) return static_cast<int>(k);
  auto* element = vtkIntArray::SafeDownCast(
      picker->GetDataSet() ? picker->GetDataSet()->GetCellData()->GetArray(element_array)
                           : nullptr);
  if (!element || picker->GetCellId() < 0 || !impl_->state) return -1;
  const auto e = static_cast<std::size_t>(element->GetValue(picker->GetCellId()));
  const SimplexMesh<3>& mesh = impl_->state->mesh;
  return impl_
      ->part_of_body[mesh.element_body.empty() ? 0
                                               : static_cast<std::size_t>(mesh.element_body[e])];
}

bool Scene::set_pixel_size(double size) {
  if (!(size > 0) || std::abs(size - impl_->pixel) < 0.02 * impl_->pixel) return false;
  impl_->pixel = size;
  impl_->shade_edges();
  return true;
}

void Scene::set_color_by(ColorBy color_by, int layers_asked) {
  impl_->color_by = color_by;
  impl_->layers_asked = layers_asked;
  impl_->recolor();
}

void Scene::set_section(const std::optional<Section>& section) {
  impl_->section = section;
  if (section) {
    Vec<3> origin = section->origin;
    Vec<3> normal = section->normal;
    impl_->cut_plane->SetOrigin(origin.data());
    impl_->cut_plane->SetNormal(normal.data());
    normal = -normal;
    impl_->clip_plane->SetOrigin(origin.data());
    impl_->clip_plane->SetNormal(normal.data());
  }
  for (const PartActors& part : impl_->parts) {
    for (vtkActor* actor : {part.surface.Get(), part.features.Get()}) {
      actor->GetMapper()->RemoveAllClippingPlanes();
      if (section) actor->GetMapper()->AddClippingPlane(impl_->clip_plane);
    }
  }
  impl_->mesh_lines_mapper->RemoveAllClippingPlanes();
  if (section) impl_->mesh_lines_mapper->AddClippingPlane(impl_->clip_plane);
  impl_->update_mesh();
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

bool Scene::has(ColorBy color_by) const { return impl_->has(color_by); }

Legend Scene::legend() const { return impl_->legend; }

std::array<double, 6> Scene::bounds() const { return impl_->bounds; }

std::size_t Scene::shown_elements() const { return impl_->shown; }

}  // namespace lamella::ui
