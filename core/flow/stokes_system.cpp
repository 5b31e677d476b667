#include "core/flow/stokes_system.h"

#include <numeric>

#include "core/base/disjoint_sets.h"
#include "core/flow/element.h"
#include "core/mesh/boundary.h"
#include "core/metric/metric.h"

namespace lamella::flow {
namespace {

/// Eigenvalues of the mean of n n^T above this count: planes that meet at more than 4 degrees are
/// two, a plane whose facets scatter by less is one.
constexpr double kPlane = 1e-3;

/// Share of the squared sizes in the weight of `smooth_pressure`. Above it changes little.
constexpr double kSmoothing = 0.01;

enum class Role : char { wall, symmetry, opening };

template <int D>
std::array<Vec<D>, D + 1> corners_of(const SimplexMesh<D>& mesh, const StokesSystem<D>& s,
                                     std::size_t e) {
  std::array<Vec<D>, D + 1> p;
  for (int k = 0; k <= D; ++k) p[k] = mesh.points[s.node[s.elements[e][k]]];
  return p;
}

/// Position along a Z-order curve of cells of equal edges.
template <int D>
std::uint64_t curve_key(const Vec<D>& x, const Vec<D>& low, double scale) {
  constexpr int kBits = D == 2 ? 31 : 21;
  std::array<std::uint64_t, D> cell;
  for (int k = 0; k < D; ++k)
    cell[k] = static_cast<std::uint64_t>((x[k] - low[k]) * scale * ((1u << kBits) - 1.0));
  std::uint64_t key = 0;
  for (int bit = kBits - 1; bit >= 0; --bit)
    for (int k = 0; k < D; ++k) key = key << 1 | (cell[k] >> bit & 1);
  return key;
}

template <int D>
void number_rows(const SimplexMesh<D>& mesh, StokesSystem<D>& s) {
  s.row.assign(mesh.points.size(), -1);
  Vec<D> low = Vec<D>::Constant(1e300), high = -low;
  for (const auto& e : mesh.elements)
    for (const NodeId n : e) {
      s.row[n] = 0;
      low = low.cwiseMin(mesh.points[n]);
      high = high.cwiseMax(mesh.points[n]);
    }
  const double scale = 1 / std::max((high - low).maxCoeff(), 1e-300);
  std::vector<std::pair<std::uint64_t, NodeId>> order;
  for (std::size_t n = 1; n < mesh.points.size(); ++n)
    if (s.row[n] == 0)
      order.emplace_back(curve_key<D>(mesh.points[n], low, scale), static_cast<NodeId>(n));
  std::sort(order.begin(), order.end());
  s.node.reserve(order.size());
  for (const auto& [key, n] : order) {
    s.row[n] = static_cast<std::int32_t>(s.node.size());
    s.node.push_back(n);
  }

  // Elements in the order of their least row: what is near in space is near in memory.
  const std::size_t n = s.rows();
  std::vector<std::int32_t> first(n + 1, 0);
  const auto least = [&](const auto& e) {
    std::int32_t r = s.row[e[0]];
    for (const NodeId v : e) r = std::min(r, s.row[v]);
    return r;
  };
  for (const auto& e : mesh.elements) ++first[least(e) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  s.elements.resize(mesh.elements.size());
  for (const auto& e : mesh.elements) {
    auto& to = s.elements[first[least(e)]++];
    for (int k = 0; k <= D; ++k) to[k] = s.row[e[k]];
  }

  s.around_start.assign(n + 1, 0);
  for (const auto& e : s.elements)
    for (const std::int32_t r : e) ++s.around_start[r + 1];
  std::partial_sum(s.around_start.begin(), s.around_start.end(), s.around_start.begin());
  s.around.resize(static_cast<std::size_t>(s.around_start.back()));
  std::vector<std::int32_t> next(s.around_start.begin(), s.around_start.end() - 1);
  for (std::size_t e = 0; e < s.elements.size(); ++e)
    for (const std::int32_t r : s.elements[e]) s.around[next[r]++] = static_cast<std::int32_t>(e);
}

/// Columns of each row, ascending.
template <int D>
void fill_pattern(StokesSystem<D>& s) {
  const std::size_t n = s.rows();
  std::vector<std::int32_t> length(n);
  const auto neighbors = [&](std::size_t i, std::vector<std::int32_t>& found) {
    found.clear();
    for (std::int32_t a = s.around_start[i]; a < s.around_start[i + 1]; ++a)
      for (const std::int32_t r : s.elements[s.around[a]]) found.push_back(r);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  };
  for_blocks(n, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> found;
    for (std::size_t i = begin; i < end; ++i) {
      neighbors(i, found);
      length[i] = static_cast<std::int32_t>(found.size());
    }
  });
  s.start.assign(n + 1, 0);
  std::partial_sum(length.begin(), length.end(), s.start.begin() + 1);
  s.column.resize(static_cast<std::size_t>(s.start.back()));
  for_blocks(n, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> found;
    for (std::size_t i = begin; i < end; ++i) {
      neighbors(i, found);
      std::copy(found.begin(), found.end(), s.column.begin() + s.start[i]);
    }
  });
}

/// Calls add(entry number, element, its shape, local row, local column) for the couplings of every
/// row, rows in parallel.
template <int D, class Add>
void for_each_coupling(const SimplexMesh<D>& mesh, const StokesSystem<D>& s,
                       const Progress& progress, Add add) {
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    if (progress.cancelled()) return;
    for (std::size_t i = begin; i < end; ++i)
      for (std::int32_t a = s.around_start[i]; a < s.around_start[i + 1]; ++a) {
        const std::int32_t e = s.around[a];
        const auto& rows = s.elements[e];
        const ElementShape<D> shape = element_shape<D>(corners_of<D>(mesh, s, e));
        int own = 0;
        while (rows[own] != static_cast<std::int32_t>(i)) ++own;
        for (int k = 0; k <= D; ++k) {
          const auto first = s.column.begin() + s.start[i],
                     last = s.column.begin() + s.start[i + 1];
          const auto at = std::lower_bound(first, last, rows[k]) - s.column.begin();
          add(static_cast<std::size_t>(at), static_cast<std::size_t>(e), shape, own, k);
        }
      }
  });
}

template <int D>
Result<std::vector<Role>> roles_of_groups(const SimplexMesh<D>& mesh, const FlowCase<D>& flow,
                                          std::vector<std::int32_t>& opening_of) {
  std::vector<Role> roles(mesh.groups.size(), Role::wall);
  std::vector<char> named(mesh.groups.size(), 0);
  opening_of.assign(mesh.groups.size(), -1);
  std::int32_t openings = 0;
  const auto name = [&](const std::string& group, Role role) -> Result<void> {
    const auto at = std::find(mesh.groups.begin(), mesh.groups.end(), group);
    if (at == mesh.groups.end()) {
      std::string known;
      for (const std::string& g : mesh.groups) known += (known.empty() ? "" : ", ") + g;
      return Error{Code::usage, "The mesh has no boundary group \"" + group + "\".",
                   "Its groups are: " + known + "."};
    }
    const auto g = static_cast<std::size_t>(at - mesh.groups.begin());
    if (named[g])
      return Error{Code::usage, "The boundary group \"" + group + "\" is named twice.",
                   "A group is a gate, a vent or a symmetry."};
    named[g] = 1;
    roles[g] = role;
    if (role == Role::opening) opening_of[g] = openings++;
    return {};
  };
  for (const FlowGate& gate : flow.gates) {
    if (Result<void> done = name(gate.group, Role::opening); !done) return done.error();
    if (gate.pressure.has_value() == gate.rate.has_value())
      return Error{Code::usage,
                   "The gate \"" + gate.group + "\" needs either a pressure or a rate.", ""};
    if (!std::isfinite(gate.pressure.value_or(0)) || !std::isfinite(gate.rate.value_or(0)))
      return Error{Code::usage, "The gate \"" + gate.group + "\" has no finite value.", ""};
  }
  for (const std::string& vent : flow.vents)
    if (Result<void> done = name(vent, Role::opening); !done) return done.error();
  for (const std::string& plane : flow.symmetries)
    if (Result<void> done = name(plane, Role::symmetry); !done) return done.error();
  return roles;
}

/// Axes of which one is normal to each symmetry, as far as they are orthogonal.
template <int D>
Mat<D> frame_of(std::vector<std::pair<double, Vec<D>>> planes) {
  std::stable_sort(planes.begin(), planes.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Mat<D> frame = Mat<D>::Identity();
  int found = 0;
  const auto take = [&](Vec<D> n, double least) {
    for (int k = 0; k < found; ++k) n -= n.dot(frame.col(k)) * frame.col(k);
    if (found == D || n.norm() < least) return;
    frame.col(found++) = n.normalized();
  };
  for (const auto& [area, n] : planes) take(n, 1 - 1e-6);
  for (int k = 0; k < D; ++k) take(Vec<D>::Unit(k), 0.5);
  for (int k = 0; k < D; ++k) take(Vec<D>::Unit(k), 1e-3);
  return frame;
}

template <int D>
Result<void> mark_boundary(const SimplexMesh<D>& mesh, const FlowCase<D>& flow,
                           StokesSystem<D>& s) {
  std::vector<std::int32_t> opening_of;
  const Result<std::vector<Role>> roles = roles_of_groups<D>(mesh, flow, opening_of);
  if (!roles) return roles.error();
  s.openings.resize(flow.gates.size() + flow.vents.size());
  const std::size_t n = s.rows();
  s.wall.assign(n, 0);
  s.open.assign(n, 0);

  std::vector<std::pair<typename SimplexMesh<D>::Facet, std::int32_t>> listed;
  listed.reserve(mesh.facets.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    listed.emplace_back(mesh.facets[f], mesh.facet_group[f]);
    std::sort(listed.back().first.begin(), listed.back().first.end());
  }
  std::sort(listed.begin(), listed.end());

  std::vector<std::int32_t> slide_at(n, -1);
  std::vector<Mat<D>> normals;
  std::vector<std::pair<double, Vec<D>>> planes;
  std::vector<std::vector<std::pair<std::int32_t, Vec<D>>>> loads(s.openings.size());
  for (const BoundaryFace<D>& face : boundary_faces<D>(mesh.elements, mesh.points.size())) {
    auto sorted = face.facet;
    std::sort(sorted.begin(), sorted.end());
    const auto at = std::lower_bound(listed.begin(), listed.end(), std::pair(sorted, -1));
    const bool known = at != listed.end() && at->first == sorted;
    const Role role = known ? (*roles)[at->second] : Role::wall;
    const Vec<D> area = facet_normal<D>(mesh.corners(face.facet)) / factorial(D - 1);
    if (role == Role::opening) {
      const auto o = static_cast<std::size_t>(opening_of[at->second]);
      s.openings[o].area += area.norm();
      for (const NodeId v : face.facet) {
        loads[o].emplace_back(s.row[v], area / D);
        s.open[s.row[v]] = 1;
      }
    } else if (role == Role::wall) {
      for (const NodeId v : face.facet) s.wall[s.row[v]] = 1;
    } else {
      const Vec<D> unit = area.normalized();
      for (const NodeId v : face.facet) {
        std::int32_t& slide = slide_at[s.row[v]];
        if (slide < 0) {
          slide = static_cast<std::int32_t>(normals.size());
          normals.push_back(Mat<D>::Zero());
        }
        normals[slide] += area.norm() * unit * unit.transpose();
      }
      auto plane = planes.begin();
      while (plane != planes.end() && std::abs(plane->second.dot(unit)) < 1 - kPlane) ++plane;
      if (plane != planes.end())
        plane->first += area.norm();
      else if (planes.size() < 100)
        planes.emplace_back(area.norm(), unit);
    }
  }
  for (std::size_t o = 0; o < loads.size(); ++o) {
    std::sort(loads[o].begin(), loads[o].end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [r, load] : loads[o]) {
      if (s.openings[o].rows.empty() || s.openings[o].rows.back() != r) {
        s.openings[o].rows.push_back(r);
        s.openings[o].load.push_back(Vec<D>::Zero());
      }
      s.openings[o].load.back() += load;
    }
    if (loads[o].empty())
      return Error{
          Code::bad_input,
          "No boundary face of the mesh belongs to the group \"" +
              (o < flow.gates.size() ? flow.gates[o].group : flow.vents[o - flow.gates.size()]) +
              "\".",
          "Give the group faces when the part is meshed."};
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (slide_at[i] < 0 || s.wall[i]) continue;
    const Mat<D>& sum = normals[slide_at[i]];
    const Spectrum<D> found = spectrum<D>(Mat<D>(sum / sum.trace()));
    Mat<D> project = Mat<D>::Identity();
    for (int k = 0; k < D; ++k)
      if (found.values[k] > kPlane)
        project -= found.vectors.col(k) * found.vectors.col(k).transpose();
    s.slides.push_back(static_cast<std::int32_t>(i));
    s.slide_project.push_back(project);
  }
  s.frame = frame_of<D>(planes);
  return {};
}

/// Every part of the mesh has an opening, or its pressure is known up to a constant only.
template <int D>
Result<void> check_parts(const SimplexMesh<D>& mesh, const StokesSystem<D>& s) {
  DisjointSets parts(s.rows());
  for (const auto& e : s.elements)
    for (const std::int32_t r : e) parts.join(e[0], r);
  std::vector<char> open(s.rows(), 0);
  for (std::size_t i = 0; i < s.rows(); ++i)
    if (s.open[i]) open[parts.root(static_cast<std::int32_t>(i))] = 1;
  for (std::size_t i = 0; i < s.rows(); ++i) {
    if (open[parts.root(static_cast<std::int32_t>(i))]) continue;
    std::string place;
    for (int k = 0; k < D; ++k)
      place += (k ? ", " : "") + std::to_string(mesh.points[s.node[i]][k]);
    return Error{Code::bad_input,
                 "The part of the mesh around (" + place + ") has neither gate nor vent.",
                 "Name one of its boundary groups, or solve on the body that has them."};
  }
  return {};
}

}  // namespace

template <int D>
double bubble_weight(const std::array<Vec<D>, D + 1>& gradient) {
  double sum = 0;
  for (const Vec<D>& g : gradient) sum += g.squaredNorm();
  constexpr double kMean = static_cast<double>(factorial(D)) / factorial(2 * D + 1);
  constexpr double kEnergy = static_cast<double>(factorial(D)) * (1 << (D - 1)) / factorial(3 * D);
  return kMean * kMean / (kEnergy * sum);
}

template <int D>
Result<StokesSystem<D>> assemble(const SimplexMesh<D>& mesh, const FlowCase<D>& flow,
                                 const Progress& progress) {
  if (!(flow.viscosity > 0) || !std::isfinite(flow.viscosity))
    return Error{Code::usage, "The viscosity is not a positive number.", ""};
  if (flow.gates.empty() && !flow.body_force)
    return Error{Code::usage, "Nothing drives the flow.", "Name a gate."};
  if (flow.gates.size() + flow.vents.size() < (flow.body_force ? 1 : 2))
    return Error{Code::usage, "What enters at the gate has no way out.", "Name a vent."};
  if (mesh.elements.empty())
    return Error{Code::bad_input, "The mesh has no elements.", "Give a volume mesh."};
  StokesSystem<D> s;
  number_rows<D>(mesh, s);
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.2);
  if (Result<void> done = mark_boundary<D>(mesh, flow, s); !done) return done.error();
  if (Result<void> done = check_parts<D>(mesh, s); !done) return done.error();
  for (std::size_t e = 0; e < s.elements.size(); ++e) {
    const auto p = corners_of<D>(mesh, s, e);
    double longest = 0;
    for (int k = 1; k <= D; ++k) longest = std::max(longest, (p[k] - p[0]).norm());
    if (std::abs(signed_measure<D>(p)) > 1e-14 * std::pow(longest, D)) continue;
    std::string place;
    for (int k = 0; k < D; ++k) place += (k ? ", " : "") + std::to_string(p[0][k]);
    return Error{Code::bad_input, "An element at (" + place + ") is flat.",
                 "Check the mesh; adapt it, which removes flat elements."};
  }
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.5);
  fill_pattern<D>(s);
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.7);
  s.of_velocity.resize(s.column.size());
  s.of_pressure.resize(s.column.size());
  for_each_coupling<D>(
      mesh, s, progress,
      [&](std::size_t at, std::size_t, const ElementShape<D>& shape, int own, int k) {
        const double a = shape.measure * shape.gradient[own].dot(shape.gradient[k]);
        s.of_velocity[at].a += a;
        s.of_velocity[at].b -= shape.measure / (D + 1) * shape.gradient[k];
        s.of_pressure[at].c += bubble_weight<D>(shape.gradient) * a;
        s.of_pressure[at].bt -= shape.measure / (D + 1) * shape.gradient[own];
      });
  if (progress.cancelled()) return cancelled_error();
  if (flow.body_force) {
    s.force.assign(s.rows(), Vec<D>::Zero());
    s.bubble_force.assign(s.rows(), Vec<1>::Zero());
    for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::int32_t a = s.around_start[i]; a < s.around_start[i + 1]; ++a) {
          const auto e = static_cast<std::size_t>(s.around[a]);
          const auto p = corners_of<D>(mesh, s, e);
          const ElementShape<D> shape = element_shape<D>(p);
          int own = 0;
          while (s.elements[e][own] != static_cast<std::int32_t>(i)) ++own;
          Vec<D> center = Vec<D>::Zero();
          for (const Vec<D>& x : p) center += x / (D + 1);
          const Vec<D> f = flow.body_force(center) / flow.viscosity;
          s.force[i] += shape.measure / (D + 1) * f;
          s.bubble_force[i][0] -=
              bubble_weight<D>(shape.gradient) * shape.measure * f.dot(shape.gradient[own]);
        }
    });
    constrain<D>(s, s.force);
  }
  progress.report(1);
  return s;
}

template <int D>
void smooth_pressure(const SimplexMesh<D>& mesh, StokesSystem<D>& s, const Pressures& phi,
                     const Progress& progress) {
  std::vector<Mat<D>> w(s.rows());
  s.smoothing.resize(s.rows());
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double mass = 0;
      Mat<D> sum = Mat<D>::Zero();
      for (std::int32_t a = s.around_start[i]; a < s.around_start[i + 1]; ++a) {
        const auto p = corners_of<D>(mesh, s, static_cast<std::size_t>(s.around[a]));
        const double part = std::abs(signed_measure<D>(p)) / (D + 1);
        mass += part;
        sum += part * simplex_metric_inverse<D>(p);
      }
      const Spectrum<D> found = spectrum<D>(Mat<D>(sum * (kSmoothing / mass)));
      const Vec<D> limited = found.values.cwiseMin(std::max(0.0, phi[i][0]));
      w[i] = found.vectors * limited.asDiagonal() * found.vectors.transpose();
      s.smoothing[i] = w[i] / mass;
    }
  });
  // The variance is the mean of the squares, here, less the square of the mean, in `add_pressure`.
  for_each_coupling<D>(
      mesh, s, progress,
      [&](std::size_t at, std::size_t e, const ElementShape<D>& shape, int own, int k) {
        Mat<D> mean = Mat<D>::Zero();
        for (const std::int32_t r : s.elements[e]) mean += w[r] / (D + 1);
        s.of_pressure[at].c += shape.measure * shape.gradient[own].dot(mean * shape.gradient[k]);
      });
}

template <int D>
void multiply_velocity(const StokesSystem<D>& s, const Velocities<D>& v, Velocities<D>& f,
                       Pressures& g) {
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec<D> sum = Vec<D>::Zero();
      double divergence = 0;
      for (std::int32_t e = s.start[i]; e < s.start[i + 1]; ++e) {
        const Vec<D>& other = v[s.column[e]];
        sum += s.of_velocity[e].a * other;
        divergence += s.of_velocity[e].b.dot(other);
      }
      f[i] = sum;
      g[i][0] = divergence;
    }
  });
  constrain<D>(s, f);
}

template <int D>
void add_pressure(const StokesSystem<D>& s, const Pressures& p, Velocities<D>& f, Pressures& g) {
  std::vector<Vec<D>> mean(s.smoothing.size());
  for_blocks(mean.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec<D> sum = Vec<D>::Zero();
      for (std::int32_t e = s.start[i]; e < s.start[i + 1]; ++e)
        sum += p[s.column[e]][0] * s.of_velocity[e].b;
      mean[i] = s.smoothing[i] * sum;
    }
  });
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec<D> sum = Vec<D>::Zero();
      double leaves = 0;
      for (std::int32_t e = s.start[i]; e < s.start[i + 1]; ++e) {
        const auto& entry = s.of_pressure[e];
        const double other = p[s.column[e]][0];
        sum += other * entry.bt;
        leaves += entry.c * other;
        if (!mean.empty()) leaves -= entry.bt.dot(mean[s.column[e]]);
      }
      f[i] += sum;
      g[i][0] -= leaves;
    }
  });
  constrain<D>(s, f);
}

template <int D>
void constrain(const StokesSystem<D>& s, Velocities<D>& v) {
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (s.wall[i]) v[i].setZero();
  });
  for (std::size_t k = 0; k < s.slides.size(); ++k) {
    Vec<D>& x = v[s.slides[k]];
    x = (s.slide_project[k] * x).eval();
  }
}

template <int D>
Csr velocity_matrix(const StokesSystem<D>& s, const std::vector<char>& fixed) {
  Csr out;
  out.columns = static_cast<std::int32_t>(s.rows());
  out.start.reserve(s.rows() + 1);
  out.column.reserve(s.column.size());
  out.value.reserve(s.column.size());
  for (std::size_t i = 0; i < s.rows(); ++i) {
    for (std::int32_t e = s.start[i]; e < s.start[i + 1]; ++e) {
      const std::int32_t j = s.column[e];
      const bool own = static_cast<std::size_t>(j) == i;
      if (!own && (fixed[i] || fixed[j])) continue;
      out.column.push_back(j);
      out.value.push_back(s.of_velocity[e].a);
    }
    out.start.push_back(static_cast<std::int32_t>(out.column.size()));
  }
  return out;
}

template <int D>
Csr mass_matrix(const SimplexMesh<D>& mesh, const StokesSystem<D>& s, const Progress& progress) {
  Csr out;
  out.columns = static_cast<std::int32_t>(s.rows());
  out.start = s.start;
  out.column = s.column;
  out.value.resize(s.column.size());
  for (std::size_t e = 0; e < s.of_pressure.size(); ++e) out.value[e] = s.of_pressure[e].c;
  for_each_coupling<D>(
      mesh, s, progress,
      [&](std::size_t at, std::size_t, const ElementShape<D>& shape, int own, int k) {
        out.value[at] += shape.measure * (own == k ? 2 : 1) / ((D + 1.0) * (D + 2.0));
      });
  return out;
}

template <int D>
Csr pressure_diffusion(const SimplexMesh<D>& mesh, const StokesSystem<D>& s,
                       const std::vector<double>& weight, const Progress& progress) {
  Csr out;
  out.columns = static_cast<std::int32_t>(s.rows());
  out.start = s.start;
  out.column = s.column;
  out.value.assign(s.column.size(), 0);
  for_each_coupling<D>(
      mesh, s, progress,
      [&](std::size_t at, std::size_t e, const ElementShape<D>& shape, int own, int k) {
        out.value[at] += weight[e] * shape.measure * shape.gradient[own].dot(shape.gradient[k]);
        // Faces of the element on an opening: all nodes but one are open.
        int inside = -1, count = 0;
        for (int c = 0; c <= D; ++c)
          if (!s.open[s.elements[e][c]]) inside = c, ++count;
        if (count != 1 || own == inside || k == inside) return;
        const double height = 1 / shape.gradient[inside].norm();
        const double area = D * shape.measure / height;
        out.value[at] += weight[e] / std::max(height, std::sqrt(weight[e])) * area *
                         (own == k ? 2 : 1) / (D * (D + 1.0));
      });
  return out;
}

template double bubble_weight<2>(const std::array<Vec<2>, 3>&);
template double bubble_weight<3>(const std::array<Vec<3>, 4>&);
template Result<StokesSystem<2>> assemble(const SimplexMesh<2>&, const FlowCase<2>&,
                                          const Progress&);
template Result<StokesSystem<3>> assemble(const SimplexMesh<3>&, const FlowCase<3>&,
                                          const Progress&);
template void smooth_pressure(const SimplexMesh<2>&, StokesSystem<2>&, const Pressures&,
                              const Progress&);
template void smooth_pressure(const SimplexMesh<3>&, StokesSystem<3>&, const Pressures&,
                              const Progress&);
template void multiply_velocity(const StokesSystem<2>&, const Velocities<2>&, Velocities<2>&,
                                Pressures&);
template void multiply_velocity(const StokesSystem<3>&, const Velocities<3>&, Velocities<3>&,
                                Pressures&);
template void add_pressure(const StokesSystem<2>&, const Pressures&, Velocities<2>&, Pressures&);
template void add_pressure(const StokesSystem<3>&, const Pressures&, Velocities<3>&, Pressures&);
template void constrain(const StokesSystem<2>&, Velocities<2>&);
template void constrain(const StokesSystem<3>&, Velocities<3>&);
template Csr velocity_matrix(const StokesSystem<2>&, const std::vector<char>&);
template Csr velocity_matrix(const StokesSystem<3>&, const std::vector<char>&);
template Csr mass_matrix(const SimplexMesh<2>&, const StokesSystem<2>&, const Progress&);
template Csr mass_matrix(const SimplexMesh<3>&, const StokesSystem<3>&, const Progress&);
template Csr pressure_diffusion(const SimplexMesh<2>&, const StokesSystem<2>&,
                                const std::vector<double>&, const Progress&);
template Csr pressure_diffusion(const SimplexMesh<3>&, const StokesSystem<3>&,
                                const std::vector<double>&, const Progress&);

}  // namespace lamella::flow
