#include "ui/views/mesh_skin.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

#include "ui/views/mesh_data.h"

namespace lamella::ui {
namespace {

template <class Array>
vtkSmartPointer<Array> named(const char* name, std::size_t size) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfTuples(static_cast<vtkIdType>(size));
  return array;
}

void add_numbers(vtkDataSetAttributes& to, const char* name, const std::vector<std::int32_t>& of) {
  auto array = named<vtkIntArray>(name, of.size());
  std::copy(of.begin(), of.end(), array->GetPointer(0));
  to.AddArray(array);
}

}  // namespace

std::shared_ptr<const PreparedMesh> prepare_mesh(std::shared_ptr<const MeshState> state,
                                                 const SkinChoice& choice) {
  auto made = std::make_shared<PreparedMesh>();
  made->faces = mesh_faces(state->mesh);
  MeshSkin skin;
  skin.set(std::move(state), made);
  skin.choose(choice);
  made->skin = skin.skin(choice.planes);
  made->elements = skin.elements();
  if (choice.fast > 0 && made->skin->GetNumberOfCells() > choice.fast)
    made->coarse = coarse_skin(*made->skin, choice.fast / 2);
  if (choice.grid) made->grid = skin.grid();
  made->choice = choice;
  return made;
}

void MeshSkin::set(std::shared_ptr<const MeshState> state,
                   std::shared_ptr<const PreparedMesh> prepared) {
  state_ = std::move(state);
  prepared_ = std::move(prepared);
  if (state_ && !prepared_) {
    auto faces = std::make_shared<PreparedMesh>();
    faces->faces = mesh_faces(state_->mesh);
    prepared_ = faces;
  }
  elements_ = 0;
  choose({});
}

void MeshSkin::choose(const SkinChoice& choice) {
  choice_.hidden = choice.hidden;
  choice_.quality = choice.quality;
  grid_ = nullptr;
  in_sight_.clear();
  chosen_.clear();
}

void MeshSkin::mark() {
  const SimplexMesh<3>& mesh = state_->mesh;
  const std::size_t count = mesh.elements.size();
  if (in_sight_.size() == count) return;
  std::vector<char> body_in_sight;
  for (const std::string& body : mesh.bodies)
    body_in_sight.push_back(std::find(choice_.hidden.begin(), choice_.hidden.end(), body) ==
                            choice_.hidden.end());
  in_sight_.assign(count, body_in_sight.empty() ? 1 : body_in_sight[0]);
  for (std::size_t e = 0; e < mesh.element_body.size() && !body_in_sight.empty(); ++e)
    in_sight_[e] = body_in_sight[static_cast<std::size_t>(mesh.element_body[e])];
  chosen_ = in_sight_;
  const auto& range = choice_.quality;
  if (!range || state_->quality.size() != count) return;
  for (std::size_t e = 0; e < count; ++e)
    chosen_[e] =
        chosen_[e] && state_->quality[e] >= range->first && state_->quality[e] <= range->second;
}

bool MeshSkin::prepared() const {
  return prepared_->skin && prepared_->choice.hidden == choice_.hidden &&
         prepared_->choice.quality == choice_.quality;
}

vtkSmartPointer<vtkPolyData> MeshSkin::skin(const std::vector<std::pair<Vec<3>, Vec<3>>>& planes) {
  if (prepared() && prepared_->choice.planes == planes) {
    elements_ = prepared_->elements;
    auto copy = vtkSmartPointer<vtkPolyData>::New();  // each view has colors of its own
    copy->ShallowCopy(prepared_->skin);
    return copy;
  }
  mark();
  const SimplexMesh<3>& mesh = state_->mesh;
  const std::vector<char>* drawn = &chosen_;
  std::vector<char> left;
  if (!planes.empty()) {
    std::vector<char> inside(mesh.points.size(), 1);
    for (const auto& [origin, normal] : planes)
      for (std::size_t n = 1; n < inside.size(); ++n)
        if ((mesh.points[n] - origin).dot(normal) >= 0) inside[n] = 0;
    left.resize(mesh.elements.size());
    for (std::size_t e = 0; e < left.size(); ++e) {
      const auto& c = mesh.elements[e];
      left[e] = chosen_[e] && (inside[std::size_t(c[0])] || inside[std::size_t(c[1])] ||
                               inside[std::size_t(c[2])] || inside[std::size_t(c[3])]);
    }
    drawn = &left;
  }
  std::vector<std::int32_t> element, facet, node;
  std::vector<char> opened;
  std::vector<std::int32_t> corners;
  std::vector<std::int32_t> point_of(mesh.points.size(), -1);
  elements_ = 0;
  for (std::size_t e = 0; e < drawn->size(); ++e) {
    if (!(*drawn)[e]) continue;
    ++elements_;
    for (int k = 0; k < 4; ++k) {
      const std::int32_t beyond = prepared_->faces.neighbor[e][std::size_t(k)];
      if (beyond >= 0 && (*drawn)[static_cast<std::size_t>(beyond)]) continue;
      const std::int32_t number = prepared_->faces.facet(e, k);
      element.push_back(static_cast<std::int32_t>(e));
      facet.push_back(number);
      // Where a body ends at one that is hidden, no cut has opened it.
      opened.push_back(number < 0 && beyond >= 0 && in_sight_[static_cast<std::size_t>(beyond)]);
      for (const NodeId n : opposite_facet<3>(mesh.elements[e], k)) {
        std::int32_t& point = point_of[static_cast<std::size_t>(n)];
        if (point < 0) {
          point = static_cast<std::int32_t>(node.size());
          node.push_back(n);
        }
        corners.push_back(point);
      }
    }
  }
  std::vector<Vec<3>> points;
  points.reserve(node.size());
  for (const std::int32_t n : node) points.push_back(mesh.points[static_cast<std::size_t>(n)]);
  auto ids = vtkSmartPointer<vtkTypeInt32Array>::New();
  ids->SetNumberOfValues(static_cast<vtkIdType>(corners.size()));
  std::copy(corners.begin(), corners.end(), ids->GetPointer(0));
  vtkNew<vtkCellArray> cells;
  cells->SetData(3, ids);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(make_points(points));
  data->SetPolys(cells);
  add_numbers(*data->GetCellData(), element_array, element);
  add_numbers(*data->GetCellData(), facet_array, facet);
  auto by_cut = named<vtkUnsignedCharArray>(opened_array, opened.size());
  std::copy(opened.begin(), opened.end(), by_cut->GetPointer(0));
  data->GetCellData()->AddArray(by_cut);
  add_numbers(*data->GetPointData(), node_array, node);
  add_fields(*state_, element, node, *data->GetCellData(), *data->GetPointData());
  return data;
}

const CoarseSkin* MeshSkin::coarse(vtkPolyData& of) const {
  // Copies share their points.
  const bool known =
      prepared_ && prepared_->coarse && of.GetPoints() == prepared_->skin->GetPoints();
  return known ? &*prepared_->coarse : nullptr;
}

vtkUnstructuredGrid* MeshSkin::grid() {
  if (grid_ || !state_) return grid_;
  if (prepared() && prepared_->grid) {
    grid_ = vtkSmartPointer<vtkUnstructuredGrid>::New();
    grid_->ShallowCopy(prepared_->grid);
    return grid_;
  }
  mark();
  const SimplexMesh<3>& mesh = state_->mesh;
  std::vector<std::int32_t> element;
  for (std::size_t e = 0; e < chosen_.size(); ++e)
    if (chosen_[e]) element.push_back(static_cast<std::int32_t>(e));
  vtkNew<vtkTypeInt64Array> corners;
  corners->SetNumberOfValues(static_cast<vtkIdType>(4 * element.size()));
  auto* out = corners->GetPointer(0);
  for (const std::int32_t e : element)
    for (const NodeId n : mesh.elements[static_cast<std::size_t>(e)]) *out++ = n;
  vtkNew<vtkCellArray> cells;
  cells->SetData(4, corners);
  std::vector<std::int32_t> node(mesh.points.size());
  for (std::size_t n = 0; n < node.size(); ++n) node[n] = static_cast<std::int32_t>(n);
  grid_ = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid_->SetPoints(make_points(mesh.points));
  grid_->SetCells(VTK_TETRA, cells);
  add_numbers(*grid_->GetCellData(), element_array, element);
  add_numbers(*grid_->GetPointData(), node_array, node);
  add_fields(*state_, element, node, *grid_->GetCellData(), *grid_->GetPointData());
  add_velocity(*state_, *grid_->GetPointData());
  return grid_;
}

}  // namespace lamella::ui
