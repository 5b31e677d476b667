#include "core/multidomain/hold.h"

#include <algorithm>
#include <cmath>

namespace lamella {

void Hold::add_plane(const Vec<3>& normal) {
  const Vec<3> n = normal.normalized();
  if (std::none_of(planes.begin(), planes.end(),
                   [&](const Vec<3>& p) { return p.cross(n).squaredNorm() < 1e-12; }))
    planes.push_back(n);
}

void Hold::add_zone(int zone) {
  if (std::find(zones.begin(), zones.end(), zone) == zones.end()) zones.push_back(zone);
}

bool Hold::allows(const Partition<3>& partition, const Vec<3>& x, double tolerance) const {
  for (const Vec<3>& n : planes)
    if (std::abs(n.dot(x - origin)) > tolerance) return false;
  for (int z : zones)
    if (std::abs(partition.zone(z).distance(x)) > tolerance) return false;
  return true;
}

std::optional<Vec<3>> Hold::settle(const Partition<3>& partition, Vec<3> x,
                                   double tolerance) const {
  const auto rows = static_cast<Eigen::Index>(planes.size() + zones.size());
  if (planes.size() > 2 || rows > 3) return std::nullopt;
  Eigen::MatrixXd a(rows, 3);
  Eigen::VectorXd r(rows);
  constexpr int steps = 20;
  for (int i = 0; i < steps; ++i) {
    Eigen::Index row = 0;
    for (const Vec<3>& n : planes) {
      a.row(row) = n.transpose();
      r[row++] = n.dot(x - origin);
    }
    for (int z : zones) {
      const ZoneDistance<3> d = partition.zone(z).at(x);
      a.row(row) = d.normal.transpose();
      r[row++] = d.distance;
    }
    const double off = r.cwiseAbs().maxCoeff();
    if (off <= 1e-6 * tolerance || (i + 1 == steps && off <= tolerance)) return x;
    // The shortest step; directions that hardly matter would throw it far.
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(0.05);
    const Vec<3> step = svd.solve(r);
    if (!step.allFinite()) return std::nullopt;
    x -= step;
  }
  return std::nullopt;
}

Vec<3> onto_borders(const Partition<3>& partition, int zones, Vec<3> x, double reach) {
  for (int k = 0; k < zones; ++k) {
    const ZoneDistance<3> d = partition.zone(k).within(x, reach);
    if (std::abs(d.distance) <= reach) x -= d.distance * d.normal;
  }
  return x;
}

Vec<3> onto_wall(const Locator<3>& wall, const Partition<3>& partition, const Vec<3>& x,
                 double reach, double on) {
  constexpr double same = 0.95;  // cosine of borders that do not fix a line
  constexpr int facets = 4;      // that are tried: the point may be beyond the nearest one
  const auto near = wall.nearest(x, reach);
  if (!near || near->distance2 == 0) return x;
  Nearest<3> foot = *near;
  std::vector<int> zones;
  std::vector<Vec<3>> normals;
  for (int k = 0; k < partition.background() && normals.size() < 2; ++k) {
    const ZoneDistance<3> d = partition.zone(k).within(x, 2 * on);
    if (std::abs(d.distance) > on || d.normal.isZero() ||
        std::any_of(normals.begin(), normals.end(),
                    [&](const Vec<3>& n) { return std::abs(n.dot(d.normal)) > same; }))
      continue;
    normals.push_back(d.normal);
    zones.push_back(k);
  }
  for (int i = 0; i < facets; ++i) {
    Hold hold;
    hold.origin = foot.point;
    hold.add_plane(wall.normal(foot.facet));
    for (const int k : zones) hold.add_zone(k);
    const auto y = hold.settle(partition, foot.point, on);
    if (!y || (*y - x).norm() > 4 * reach) break;
    foot = wall.nearest(*y).value_or(foot);
    if (foot.distance2 <= 1e-12 * on * on) return *y;
  }
  return foot.point;
}

}  // namespace lamella
