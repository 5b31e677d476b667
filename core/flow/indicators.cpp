#include "core/flow/indicators.h"

#include "core/base/parallel.h"
#include "core/flow/element.h"
#include "core/mesh/adjacency.h"

namespace lamella {
namespace {

constexpr std::size_t kGrain = 1024;

template <int D>
Mat<D> symmetric(const Mat<D>& g) {
  return 0.5 * (g + g.transpose());
}

/// Symmetric N of m unknown directions with e^T N e = |e|^4 for the edges of a simplex.
template <int M>
Mat<M> solve_sizes(const std::array<Vec<M>, M + 1>& p) {
  constexpr int kUnknowns = M * (M + 1) / 2;
  Eigen::Matrix<double, kUnknowns, kUnknowns> a;
  Vec<kUnknowns> b;
  double scale = 0;
  for (int k = 1; k <= M; ++k) scale = std::max(scale, (p[k] - p[0]).norm());
  int row = 0;
  for (int i = 0; i <= M; ++i)
    for (int j = i + 1; j <= M; ++j, ++row) {
      const Vec<M> e = (p[j] - p[i]) / scale;
      int column = 0;
      for (int r = 0; r < M; ++r)
        for (int c = r; c < M; ++c) a(row, column++) = (r == c ? 1 : 2) * e[r] * e[c];
      b[row] = e.squaredNorm() * e.squaredNorm();
    }
  const Vec<kUnknowns> found = a.partialPivLu().solve(b) * (scale * scale);
  Mat<M> n;
  int column = 0;
  for (int r = 0; r < M; ++r)
    for (int c = r; c < M; ++c) n(r, c) = n(c, r) = found[column++];
  return n;
}

template <int D, std::size_t N>
double diameter(const std::array<Vec<D>, N>& p) {
  double longest = 0;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = i + 1; j < N; ++j) longest = std::max(longest, (p[i] - p[j]).norm());
  return longest;
}

/// What the sizes along a direction need of an element.
template <int D>
struct ElementSizes {
  Vec<D> direction = Vec<D>::Zero();  ///< zero: diameters
  double height = 0;                  ///< the smallest
};

template <int D>
Result<std::vector<double>> residual(const SimplexMesh<D>& mesh,
                                     const std::vector<Vec<D>>& velocity,
                                     const std::vector<double>& pressure, double viscosity,
                                     const std::vector<Vec<D>>* direction, int threads,
                                     const Progress& progress) {
  const auto gradients = element_gradients<D>(mesh, velocity, threads);
  const auto slopes = element_gradients<D>(mesh, pressure, threads);
  std::vector<ElementSizes<D>> sizes(direction ? mesh.elements.size() : 0);
  std::vector<double> squared(mesh.elements.size());
  if (!parallel_each(
          mesh.elements.size(), threads, progress.portion(0, 0.3),
          [&](std::size_t e) {
            const auto p = mesh.corners(mesh.elements[e]);
            double size = diameter<D>(p);
            const double measure = std::abs(signed_measure<D>(p));
            if (direction) {
              const flow::ElementShape<D> shape = flow::element_shape<D>(p);
              double steepest = 0;
              for (const Vec<D>& g : shape.gradient) steepest = std::max(steepest, g.norm());
              sizes[e] = {(*direction)[e], 1 / steepest};
              const Vec<D>& d = sizes[e].direction;
              if (d.squaredNorm() > 0) {
                const double along = std::sqrt(std::max(0.0, d.dot(size_tensor<D>(p) * d)));
                size = std::clamp(along, sizes[e].height, size);
              }
            }
            squared[e] = slopes[e].squaredNorm() * measure * size * size;
          },
          kGrain))
    return cancelled_error();

  const auto uses = face_uses<D>(mesh.elements, mesh.points.size());
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.7);
  for_each_face<D>(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2) return;  // lambda is zero on the boundary
    std::array<Vec<D>, D> p;
    for (int k = 0; k < D; ++k) p[k] = mesh.points[uses[first].nodes[k]];
    const Vec<D> normal = facet_normal<D>(p);
    const double area = normal.norm() / factorial(D - 1);
    const auto a = static_cast<std::size_t>(uses[first].element),
               b = static_cast<std::size_t>(uses[first + 1].element);
    const Vec<D> jump =
        2 * viscosity * symmetric<D>(Mat<D>(gradients[a] - gradients[b])) * normal.normalized();
    const double around = diameter<D>(p);
    const Mat<D> n = direction ? facet_size_tensor<D>(p) : Mat<D>::Zero();
    for (const std::size_t e : {a, b}) {
      double size = around;
      if (direction && sizes[e].direction.squaredNorm() > 0) {
        const Vec<D>& d = sizes[e].direction;
        size = std::clamp(std::sqrt(std::max(0.0, d.dot(n * d))), std::min(sizes[e].height, around),
                          around);
      }
      squared[e] += 0.5 * jump.squaredNorm() * area * size;
    }
  });
  if (progress.cancelled()) return cancelled_error();
  for (double& s : squared) s = std::sqrt(s);
  progress.report(1);
  return squared;
}

}  // namespace

template <int D>
std::vector<Vec<D>> element_gradients(const SimplexMesh<D>& mesh, const std::vector<double>& field,
                                      int threads) {
  std::vector<Vec<D>> out(mesh.elements.size());
  parallel_each(
      out.size(), threads, {},
      [&](std::size_t e) {
        const flow::ElementShape<D> shape = flow::element_shape<D>(mesh.corners(mesh.elements[e]));
        out[e].setZero();
        for (int k = 0; k <= D; ++k) out[e] += field[mesh.elements[e][k]] * shape.gradient[k];
      },
      kGrain);
  return out;
}

template <int D>
std::vector<Mat<D>> element_gradients(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& field,
                                      int threads) {
  std::vector<Mat<D>> out(mesh.elements.size());
  parallel_each(
      out.size(), threads, {},
      [&](std::size_t e) {
        const flow::ElementShape<D> shape = flow::element_shape<D>(mesh.corners(mesh.elements[e]));
        out[e].setZero();
        for (int k = 0; k <= D; ++k)
          out[e] += field[mesh.elements[e][k]] * shape.gradient[k].transpose();
      },
      kGrain);
  return out;
}

template <int D, class T>
std::vector<T> nodal_means(const SimplexMesh<D>& mesh, const std::vector<T>& of_elements,
                           int threads) {
  std::vector<std::int32_t> start(mesh.points.size() + 1, 0);
  for (const auto& e : mesh.elements)
    for (const NodeId n : e) ++start[n + 1];
  for (std::size_t n = 0; n < mesh.points.size(); ++n) start[n + 1] += start[n];
  std::vector<std::int32_t> around(static_cast<std::size_t>(start.back()));
  std::vector<std::int32_t> next(start.begin(), start.end() - 1);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const NodeId n : mesh.elements[e]) around[next[n]++] = static_cast<std::int32_t>(e);

  T zero;
  if constexpr (std::is_same_v<T, double>)
    zero = 0;
  else
    zero.setZero();
  std::vector<T> out(mesh.points.size(), zero);
  parallel_each(
      out.size(), threads, {},
      [&](std::size_t n) {
        double total = 0;
        for (std::int32_t a = start[n]; a < start[n + 1]; ++a) {
          const auto e = static_cast<std::size_t>(around[a]);
          const double measure = std::abs(signed_measure<D>(mesh.corners(mesh.elements[e])));
          out[n] += measure * of_elements[e];
          total += measure;
        }
        if (total > 0) out[n] /= total;
      },
      kGrain);
  return out;
}

template <int D>
std::vector<double> acceleration_norm(const SimplexMesh<D>& mesh,
                                      const std::vector<Vec<D>>& velocity, int threads) {
  const auto gradients =
      nodal_means<D, Mat<D>>(mesh, element_gradients<D>(mesh, velocity, threads), threads);
  std::vector<double> out(velocity.size());
  for (std::size_t n = 0; n < out.size(); ++n) out[n] = (gradients[n] * velocity[n]).norm();
  return out;
}

template <int D>
std::vector<double> shear_rate(const SimplexMesh<D>& mesh, const std::vector<Vec<D>>& velocity,
                               int threads) {
  const auto gradients = element_gradients<D>(mesh, velocity, threads);
  std::vector<double> out(gradients.size());
  for (std::size_t e = 0; e < out.size(); ++e) out[e] = symmetric<D>(gradients[e]).norm();
  return out;
}

template <int D>
std::vector<double> direction_change(const SimplexMesh<D>& mesh,
                                     const std::vector<Vec<D>>& velocity, int threads) {
  double largest = 0;
  for (const Vec<D>& v : velocity) largest = std::max(largest, v.norm());
  const auto gradients = element_gradients<D>(mesh, velocity, threads);
  std::vector<double> out(gradients.size(), 0);
  if (largest == 0) return out;
  for (std::size_t e = 0; e < out.size(); ++e) {
    Vec<D> v = Vec<D>::Zero();
    for (const NodeId n : mesh.elements[e]) v += velocity[n] / (D + 1);
    if (v.squaredNorm() == 0) continue;
    const Vec<D> u = v.normalized();
    const Mat<D> across = Mat<D>::Identity() - u * u.transpose();
    out[e] = (across * gradients[e]).norm() / std::max(v.norm(), 1e-3 * largest);
  }
  return out;
}

template <int D>
Mat<D> size_tensor(const std::array<Vec<D>, D + 1>& p) {
  return solve_sizes<D>(p);
}

template <int D>
Mat<D> facet_size_tensor(const std::array<Vec<D>, D>& p) {
  Eigen::Matrix<double, D, D - 1> edges;
  for (int k = 1; k < D; ++k) edges.col(k - 1) = p[k] - p[0];
  const Eigen::Matrix<double, D, D - 1> axes =
      edges.householderQr().householderQ() * Eigen::Matrix<double, D, D - 1>::Identity();
  std::array<Vec<D - 1>, D> within;
  for (int k = 0; k < D; ++k) within[k] = axes.transpose() * (p[k] - p[0]);
  return axes * solve_sizes<D - 1>(within) * axes.transpose();
}

template <int D>
Result<std::vector<double>> residual_indicator(const SimplexMesh<D>& mesh,
                                               const std::vector<Vec<D>>& velocity,
                                               const std::vector<double>& pressure,
                                               double viscosity, int threads,
                                               const Progress& progress) {
  return residual<D>(mesh, velocity, pressure, viscosity, nullptr, threads, progress);
}

template <int D>
Result<std::vector<double>> directional_indicator(const SimplexMesh<D>& mesh,
                                                  const std::vector<Vec<D>>& velocity,
                                                  const std::vector<double>& pressure,
                                                  double viscosity,
                                                  const std::vector<Vec<D>>& direction, int threads,
                                                  const Progress& progress) {
  if (!direction.empty())
    return residual<D>(mesh, velocity, pressure, viscosity, &direction, threads, progress);
  std::vector<double> speed(velocity.size());
  for (std::size_t n = 0; n < speed.size(); ++n) speed[n] = velocity[n].norm();
  auto along = element_gradients<D>(mesh, speed, threads);
  double steepest = 0;
  for (const Vec<D>& d : along) steepest = std::max(steepest, d.norm());
  for (Vec<D>& d : along) {
    // The gradient of a field that is constant but for rounding has no direction.
    const double norm = d.norm();
    if (norm > 1e-12 * steepest)
      d /= norm;
    else
      d.setZero();
  }
  return residual<D>(mesh, velocity, pressure, viscosity, &along, threads, progress);
}

#define LAMELLA_FLOW_INSTANCES(D)                                                                  \
  template std::vector<Vec<D>> element_gradients(const SimplexMesh<D>&,                            \
                                                 const std::vector<double>&, int);                 \
  template std::vector<Mat<D>> element_gradients(const SimplexMesh<D>&,                            \
                                                 const std::vector<Vec<D>>&, int);                 \
  template std::vector<double> nodal_means<D, double>(const SimplexMesh<D>&,                       \
                                                      const std::vector<double>&, int);            \
  template std::vector<Vec<D>> nodal_means<D, Vec<D>>(const SimplexMesh<D>&,                       \
                                                      const std::vector<Vec<D>>&, int);            \
  template std::vector<Mat<D>> nodal_means<D, Mat<D>>(const SimplexMesh<D>&,                       \
                                                      const std::vector<Mat<D>>&, int);            \
  template std::vector<double> acceleration_norm(const SimplexMesh<D>&,                            \
                                                 const std::vector<Vec<D>>&, int);                 \
  template std::vector<double> shear_rate(const SimplexMesh<D>&, const std::vector<Vec<D>>&, int); \
  template std::vector<double> direction_change(const SimplexMesh<D>&, const std::vector<Vec<D>>&, \
                                                int);                                              \
  template Mat<D> size_tensor<D>(const std::array<Vec<D>, D + 1>&);                                \
  template Mat<D> facet_size_tensor<D>(const std::array<Vec<D>, D>&);                              \
  template Result<std::vector<double>> residual_indicator(                                         \
      const SimplexMesh<D>&, const std::vector<Vec<D>>&, const std::vector<double>&, double, int,  \
      const Progress&);                                                                            \
  template Result<std::vector<double>> directional_indicator(                                      \
      const SimplexMesh<D>&, const std::vector<Vec<D>>&, const std::vector<double>&, double,       \
      const std::vector<Vec<D>>&, int, const Progress&);
LAMELLA_FLOW_INSTANCES(2)
LAMELLA_FLOW_INSTANCES(3)
#undef LAMELLA_FLOW_INSTANCES

}  // namespace lamella
