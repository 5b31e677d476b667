#include "ui/views/coarse_skin.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/geometry/simplex.h"
#include "ui/views/mesh_data.h"

namespace lamella::ui {
namespace {

/// What lies in a cell of the grid.
struct Cluster {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();  // sum of area n n^T of the planes
  Vec<3> offsets = Vec<3>::Zero();                    // of area (n . p) n, from `middle` on
  Vec<3> sum = Vec<3>::Zero();
  int points = 0;
  vtkIdType first = 0;  // one of its points
};

/// Where the planes meet best; along directions that none of them fixes, the middle.
Vec<3> meeting_point(const Cluster& c, double reach) {
  const Vec<3> middle = c.sum / c.points;
  const double weight = c.normals.trace();
  if (!(weight > 0)) return middle;
  const Eigen::Matrix3d held = c.normals + 1e-3 * weight * Eigen::Matrix3d::Identity();
  const Vec<3> shift = held.ldlt().solve(Vec<3>(c.offsets - c.normals * middle));
  // Planes that are nearly one meet far away.
  return shift.norm() < reach ? Vec<3>(middle + shift) : middle;
}

/// Those of `from` at `ids`, as the active scalars of `to`.
void take_scalars(vtkDataSetAttributes& from, vtkIdList& ids, vtkDataSetAttributes& to) {
  vtkDataArray* scalars = from.GetScalars();
  if (!scalars) return;
  auto taken = vtkSmartPointer<vtkDataArray>::Take(scalars->NewInstance());
  taken->SetName(scalars->GetName());
  taken->SetNumberOfComponents(scalars->GetNumberOfComponents());
  taken->SetNumberOfTuples(ids.GetNumberOfIds());
  scalars->GetTuples(&ids, taken);
  to.SetScalars(taken);
}

}  // namespace

vtkSmartPointer<vtkPolyData> with_scalars(const CoarseSkin& coarse, vtkPolyData& skin) {
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->ShallowCopy(coarse.surface);
  take_scalars(*skin.GetCellData(), *coarse.cells, *surface->GetCellData());
  take_scalars(*skin.GetPointData(), *coarse.points, *surface->GetPointData());
  return surface;
}

CoarseSkin coarse_skin(vtkPolyData& skin, int triangles) {
  const vtkIdType points = skin.GetNumberOfPoints(), cells = skin.GetNumberOfCells();
  std::vector<Vec<3>> at(static_cast<std::size_t>(points));
  for (vtkIdType p = 0; p < points; ++p) skin.GetPoint(p, at[static_cast<std::size_t>(p)].data());
  std::vector<std::array<vtkIdType, 3>> corners(static_cast<std::size_t>(cells));
  double area = 0;
  for (vtkIdType c = 0; c < cells; ++c) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    skin.GetPolys()->GetCellAtId(c, count, ids);
    auto& corner = corners[static_cast<std::size_t>(c)];
    std::copy_n(ids, 3, corner.begin());
    const Vec<3>& a = at[static_cast<std::size_t>(corner[0])];
    area += 0.5 * (at[static_cast<std::size_t>(corner[1])] - a)
                      .cross(at[static_cast<std::size_t>(corner[2])] - a)
                      .norm();
  }
  // A square of the grid makes two triangles.
  const double size = std::sqrt(2 * area / triangles);
  CoarseSkin coarse{vtkSmartPointer<vtkPolyData>::New(), vtkSmartPointer<vtkIdList>::New(),
                    vtkSmartPointer<vtkIdList>::New()};
  if (!(size > 0)) return coarse;

  // Points by their cell of the grid, as numbers in the order in which cells are met.
  double box[6];
  skin.GetBounds(box);
  const auto side = [&](int axis) {
    return static_cast<std::int64_t>((box[2 * axis + 1] - box[2 * axis]) / size) + 1;
  };
  const std::int64_t nx = side(0), ny = side(1);
  std::vector<std::pair<std::int64_t, vtkIdType>> order(at.size());
  for (std::size_t p = 0; p < at.size(); ++p) {
    const auto k = [&](int axis) {
      return static_cast<std::int64_t>((at[p][axis] - box[2 * axis]) / size);
    };
    order[p] = {(k(2) * ny + k(1)) * nx + k(0), static_cast<vtkIdType>(p)};
  }
  std::sort(order.begin(), order.end());
  std::vector<Cluster> clusters;
  std::vector<vtkIdType> cluster_of(at.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || order[k].first != order[k - 1].first) {
      clusters.emplace_back();
      clusters.back().first = order[k].second;
    }
    const auto p = static_cast<std::size_t>(order[k].second);
    cluster_of[p] = static_cast<vtkIdType>(clusters.size()) - 1;
    clusters.back().sum += at[p];
    ++clusters.back().points;
  }

  vtkNew<vtkCellArray> polys;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    std::array<vtkIdType, 3> to;
    std::array<Vec<3>, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      to[k] = cluster_of[static_cast<std::size_t>(corners[c][k])];
      p[k] = at[static_cast<std::size_t>(corners[c][k])];
    }
    const Vec<3> normal = (p[1] - p[0]).cross(p[2] - p[0]);
    const double length = normal.norm();
    if (length > 0)
      for (const vtkIdType to_one : to) {
        Cluster& cluster = clusters[static_cast<std::size_t>(to_one)];
        cluster.normals += normal * normal.transpose() / length;
        cluster.offsets += normal * (normal.dot(p[0]) / length);
      }
    if (to[0] == to[1] || to[1] == to[2] || to[2] == to[0]) continue;
    polys->InsertNextCell(3, to.data());
    coarse.cells->InsertNextId(static_cast<vtkIdType>(c));
  }
  std::vector<Vec<3>> moved;
  moved.reserve(clusters.size());
  for (const Cluster& cluster : clusters) {
    moved.push_back(meeting_point(cluster, size));
    coarse.points->InsertNextId(cluster.first);
  }
  coarse.surface->SetPoints(make_points(moved));
  coarse.surface->SetPolys(polys);
  return coarse;
}

}  // namespace lamella::ui
