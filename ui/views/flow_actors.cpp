#include "ui/views/flow_actors.h"

#include <vtkActor.h>
#include <vtkArrowSource.h>
#include <vtkCellData.h>
#include <vtkContourFilter.h>
#include <vtkCutter.h>
#include <vtkFloatArray.h>
#include <vtkGlyph3D.h>
#include <vtkLookupTable.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkStreamTracer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/geometry/triangles.h"
#include "ui/theme.h"
#include "ui/views/mesh_data.h"
#include "ui/views/scene_actors.h"

namespace lamella::ui {
namespace {

constexpr double kArrowsAcross = 45;  // places for arrows along the diagonal on a section
constexpr double kArrowsWithin = 22;  // the same in the whole mesh
constexpr int kLines = 150;           // streamlines, about
constexpr int kLevels = 14;
constexpr double kInflow = 0.05;  // of the fastest: what enters through a facet is a gate's

using Cell = std::array<long, 3>;
Cell cell_of(const Vec<3>& x, double spacing) {
  return {std::lround(x[0] / spacing), std::lround(x[1] / spacing), std::lround(x[2] / spacing)};
}

}  // namespace

struct FlowActors::Impl {
  vtkNew<vtkActor> arrows, lines, levels;
  vtkNew<vtkPolyDataMapper> arrow_mapper, line_mapper, level_mapper;

  explicit Impl(vtkRenderer& renderer) {
    for (const auto& [actor, mapper] :
         {std::pair(arrows.Get(), arrow_mapper.Get()), std::pair(lines.Get(), line_mapper.Get()),
          std::pair(levels.Get(), level_mapper.Get())}) {
      actor->SetMapper(mapper);
      actor->PickableOff();
      actor->VisibilityOff();
      actor->GetProperty()->SetLighting(actor == arrows.Get());
      actor->GetProperty()->SetLineWidth(actor == lines.Get() ? 1.8F : 1.4F);
      renderer.AddActor(actor);
    }
  }

  static void color(vtkActor& actor, vtkPolyDataMapper& mapper, const MeshState& state, bool dark) {
    mapper.SetScalarVisibility(!dark);
    if (dark) {
      set_color(*actor.GetProperty(), QColor(0x16, 0x1c, 0x24));
      return;
    }
    const auto [low, high] = robust_range(field_values(state, ColorBy::speed));
    mapper.SetLookupTable(lookup_table({{}, low, high, sequential_map()}));
    mapper.UseLookupTableScalarRangeOn();
    mapper.SetScalarModeToUsePointFieldData();
    mapper.SelectColorArray(array_of(ColorBy::speed).name);
  }

  void draw_arrows(vtkPolyData* cut, const MeshState& state, double diagonal, double fastest) {
    const double spacing = diagonal / (cut ? kArrowsAcross : kArrowsWithin);
    std::map<Cell, std::pair<Vec<3>, Vec<3>>> fastest_of;  // place and velocity in a cell of a grid
    vtkNew<vtkPoints> places;
    vtkNew<vtkFloatArray> direction, speed, length;
    direction->SetName("direction");
    direction->SetNumberOfComponents(3);
    speed->SetName(array_of(ColorBy::speed).name);
    length->SetName("length");
    const auto take = [&](const Vec<3>& x, const Vec<3>& v) {
      if (!(v.norm() > 1e-3 * fastest)) return;
      const auto [it, first] = fastest_of.try_emplace(cell_of(x, spacing), x, v);
      if (!first && v.norm() > it->second.second.norm()) it->second = {x, v};
    };
    const auto add = [&](const Vec<3>& x, const Vec<3>& v) {
      places->InsertNextPoint(x.data());
      direction->InsertNextTuple3(v[0], v[1], v[2]);
      speed->InsertNextValue(static_cast<float>(v.norm()));
      // Slow places are seen too.
      length->InsertNextValue(static_cast<float>(1.8 * spacing * std::sqrt(v.norm() / fastest)));
    };
    if (cut) {
      vtkDataArray* velocity = cut->GetPointData()->GetArray(velocity_array);
      for (vtkIdType k = 0; velocity && k < cut->GetNumberOfPoints(); ++k) {
        Vec<3> x, v;
        cut->GetPoint(k, x.data());
        velocity->GetTuple(k, v.data());
        take(x, v);
      }
    } else {
      for (std::size_t n = 1; n < state.mesh.points.size(); ++n)
        take(state.mesh.points[n], state.flow->velocity[n]);
    }
    for (const auto& [cell, at] : fastest_of) add(at.first, at.second);
    vtkNew<vtkPolyData> data;
    data->SetPoints(places);
    data->GetPointData()->AddArray(direction);
    data->GetPointData()->AddArray(speed);
    data->GetPointData()->AddArray(length);
    vtkNew<vtkArrowSource> arrow;
    arrow->SetTipRadius(0.16);
    arrow->SetTipLength(0.4);
    arrow->SetShaftRadius(0.055);
    arrow->SetTipResolution(10);
    vtkNew<vtkGlyph3D> glyph;
    glyph->SetInputData(data);
    glyph->SetSourceConnection(arrow->GetOutputPort());
    glyph->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "length");
    glyph->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "direction");
    glyph->SetVectorModeToUseVector();
    glyph->SetScaleModeToScaleByScalar();
    glyph->SetScaleFactor(1);
    glyph->Update();
    arrow_mapper->SetInputData(glyph->GetOutput());
  }

  void draw_lines(vtkUnstructuredGrid* grid, const MeshState& state, double diagonal,
                  double fastest) {
    const SimplexMesh<3>& mesh = state.mesh;
    std::vector<std::array<Vec<3>, 3>> gates;
    double area = 0;
    for (const auto& f : mesh.facets) {
      const std::array<Vec<3>, 3> p = mesh.corners(f);
      const Vec<3> normal = facet_normal<3>(p);
      Vec<3> v = Vec<3>::Zero();
      for (const NodeId n : f) v += state.flow->velocity[n] / 3;
      if (!(-v.dot(normal.normalized()) > kInflow * fastest)) continue;
      gates.push_back(p);
      area += normal.norm();
    }
    vtkNew<vtkPoints> seeds;
    const int each = static_cast<int>(kLines / std::max<std::size_t>(1, gates.size())) + 1;
    const double spacing = std::sqrt(0.5 * area / kLines);
    std::set<Cell> taken;
    for (const auto& p : gates)
      for (int i = 0; i < each; ++i) {
        // Points that fill a triangle evenly, by the golden ratio and its like.
        double a = std::fmod(0.5 + 0.7548776662 * i, 1), b = std::fmod(0.5 + 0.5698402910 * i, 1);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const Vec<3> inward = -facet_normal<3>(p).normalized();
        const Vec<3> x = p[0] + a * (p[1] - p[0]) + b * (p[2] - p[0]) + 1e-4 * diagonal * inward;
        if (each > 1 || taken.insert(cell_of(x, spacing)).second) seeds->InsertNextPoint(x.data());
      }
    vtkNew<vtkPolyData> from;
    from->SetPoints(seeds);
    grid->GetPointData()->SetActiveVectors(velocity_array);
    vtkNew<vtkStreamTracer> tracer;
    tracer->SetInputData(grid);
    tracer->SetSourceData(from);
    tracer->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                                   velocity_array);
    tracer->SetIntegratorTypeToRungeKutta45();
    tracer->SetIntegrationDirectionToForward();
    // Steps of the size of stretched elements would leave thin walls where the flow turns.
    tracer->SetIntegrationStepUnit(vtkStreamTracer::LENGTH_UNIT);
    tracer->SetInitialIntegrationStep(1e-3 * diagonal);
    tracer->SetMinimumIntegrationStep(1e-5 * diagonal);
    tracer->SetMaximumIntegrationStep(4e-3 * diagonal);
    tracer->SetMaximumPropagation(20 * diagonal);
    tracer->SetMaximumNumberOfSteps(20000);
    tracer->SetTerminalSpeed(1e-5 * fastest);
    tracer->SetComputeVorticity(false);
    tracer->Update();
    line_mapper->SetInputData(tracer->GetOutput());
  }

  void draw_levels(vtkPolyData* cut, const MeshState& state, ColorBy field) {
    const char* name = array_of(field).name;
    const auto [low, high] = robust_range(field_values(state, field));
    vtkNew<vtkContourFilter> contour;
    contour->SetInputData(cut);
    contour->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
    contour->SetNumberOfContours(kLevels);
    for (int k = 0; k < kLevels; ++k)
      contour->SetValue(k, low + (high - low) * (k + 0.5) / kLevels);
    contour->Update();
    level_mapper->SetInputData(contour->GetOutput());
  }
};

FlowActors::FlowActors(vtkRenderer& renderer) : impl_(std::make_unique<Impl>(renderer)) {}
FlowActors::~FlowActors() = default;

void FlowActors::draw(vtkUnstructuredGrid* grid, const MeshState* state,
                      const std::vector<Section>& sections, const FlowLook& look,
                      ColorBy color_by) {
  double fastest = 0;
  for (std::size_t n = 1; state && n < state->flow->velocity.size(); ++n)
    fastest = std::max(fastest, state->flow->velocity[n].norm());
  const bool moves = fastest > 0, any = grid && look.any() && (moves || has_levels(*state));
  vtkSmartPointer<vtkPolyData> cut;
  if (any && !sections.empty()) {
    vtkNew<vtkPlane> plane;
    plane->SetOrigin(sections.front().origin.data());
    plane->SetNormal(sections.front().normal.data());
    vtkNew<vtkCutter> cutter;
    cutter->SetCutFunction(plane);
    cutter->SetInputData(grid);
    cutter->Update();
    cut = cutter->GetOutput();
  }
  impl_->arrows->SetVisibility(moves && any && look.arrows);
  impl_->lines->SetVisibility(moves && any && look.lines);
  impl_->levels->SetVisibility(any && look.levels && cut);
  if (!any) return;
  const double diagonal = diagonal_of({state->mesh.points.begin() + 1, state->mesh.points.end()});
  const bool dark = of_flow(color_by);
  if (look.arrows && moves) {
    impl_->draw_arrows(cut, *state, diagonal, fastest);
    Impl::color(*impl_->arrows, *impl_->arrow_mapper, *state, dark);
  }
  if (look.lines && moves) {
    impl_->draw_lines(grid, *state, diagonal, fastest);
    Impl::color(*impl_->lines, *impl_->line_mapper, *state, dark);
  }
  if (look.levels && cut) {
    const ColorBy of = has_field(*state, ColorBy::field) ? ColorBy::field
                       : color_by == ColorBy::pressure   ? ColorBy::pressure
                                                         : ColorBy::speed;
    impl_->draw_levels(cut, *state, of);
    Impl::color(*impl_->levels, *impl_->level_mapper, *state, true);
  }
}

}  // namespace lamella::ui
