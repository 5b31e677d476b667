#include "core/flow/stokes_precondition.h"

#include "core/flow/element.h"

namespace lamella::flow {
namespace {

/// Rows where the component of the velocity along an axis of the frame is fixed.
template <int D>
std::vector<char> fixed_rows(const StokesSystem<D>& s, int axis) {
  std::vector<char> fixed = s.wall;
  for (std::size_t k = 0; k < s.slides.size(); ++k)
    if ((s.slide_project[k] * s.frame.col(axis)).norm() < 1e-3) fixed[s.slides[k]] = 1;
  return fixed;
}

struct Solved {
  Pressures x;
  double smallest = 1;  ///< eigenvalue of V A, by the Lanczos process behind the iterations
};

/// A x = b with a cycle V before it: conjugate gradients, `steps` of them or until the residual has
/// fallen by 1e-8.
Solved solve(Multigrid& v, const Pressures& b, int steps, const Progress& progress) {
  const std::size_t n = b.size();
  const auto dot = [&](const Pressures& a, const Pressures& c) {
    return block_sum(n, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += a[i][0] * c[i][0];
      return sum;
    });
  };
  Solved out;
  out.x.assign(n, Vec<1>::Zero());
  Pressures r = b, z(n), p(n, Vec<1>::Zero()), q(n);
  std::vector<double> step, beta;
  double before = 0, first = 0;
  for (int it = 0; it < steps && !progress.cancelled(); ++it) {
    v.apply<1>(r, z);
    const double now = dot(r, z);
    if (it == 0) first = now;
    if (!(now > 1e-16 * first)) break;
    beta.push_back(it == 0 ? 0 : now / before);
    for_blocks(n, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) p[i] = z[i] + beta.back() * p[i];
    });
    multiply<1>(v.matrix(), p, q);
    step.push_back(now / dot(p, q));
    for_blocks(n, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        out.x[i] += step.back() * p[i];
        r[i] -= step.back() * q[i];
      }
    });
    before = now;
  }
  const auto m = static_cast<Eigen::Index>(step.size());
  if (m == 0) return out;
  Eigen::MatrixXd t = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index k = 0; k < m; ++k) {
    t(k, k) = 1 / step[k] + (k > 0 ? beta[k] / step[k - 1] : 0);
    if (k > 0) t(k, k - 1) = t(k - 1, k) = std::sqrt(beta[k]) / step[k - 1];
  }
  const double found = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(t).eigenvalues()[0];
  if (found > 0) out.smallest = std::min(1.0, found);
  return out;
}

/// The smallest eigenvalue of V A, from above.
double smallest_eigenvalue(Multigrid& v, const Progress& progress) {
  Pressures b(static_cast<std::size_t>(v.matrix().rows()));
  std::uint32_t state = 1;
  for (Vec<1>& x : b) {
    state = state * 1664525u + 1013904223u;
    x[0] = static_cast<double>(state >> 8) / (1u << 24) - 0.5;
  }
  return solve(v, b, 20, progress).smallest;
}

/// phi of the preconditioner.
template <int D>
Pressures torsion(const SimplexMesh<D>& mesh, const StokesSystem<D>& s, Multigrid& cycle,
                  const Progress& progress) {
  Pressures load(s.rows(), Vec<1>::Zero());
  for (const auto& e : s.elements) {
    std::array<Vec<D>, D + 1> p;
    for (int k = 0; k <= D; ++k) p[k] = mesh.points[s.node[e[k]]];
    const double part = std::abs(signed_measure<D>(p)) / (D + 1);
    for (const std::int32_t r : e)
      if (!s.wall[r]) load[r][0] += part;
  }
  return solve(cycle, load, 10, progress).x;
}

}  // namespace

template <int D>
std::optional<StokesPreconditioner<D>> StokesPreconditioner<D>::build(const SimplexMesh<D>& mesh,
                                                                      StokesSystem<D>& s,
                                                                      bool smooth,
                                                                      const Progress& progress) {
  StokesPreconditioner out;
  std::vector<std::vector<char>> sets;
  for (int axis = 0; axis < D; ++axis) {
    std::vector<char> fixed = fixed_rows<D>(s, axis);
    const auto same = std::find(sets.begin(), sets.end(), fixed);
    if (same != sets.end()) {
      out.velocity_[static_cast<std::size_t>(same - sets.begin())].axes.push_back(axis);
      continue;
    }
    auto cycle = Multigrid::build(velocity_matrix<D>(s, fixed),
                                  progress.portion(0.2 * axis, 0.2 * (axis + 1)));
    if (!cycle) return std::nullopt;
    out.velocity_.push_back({{axis}, std::move(*cycle)});
    Components& made = out.velocity_.back();
    made.scale = 1.1 / smallest_eigenvalue(made.cycle, progress);
    sets.push_back(std::move(fixed));
  }
  const auto walls = std::find(sets.begin(), sets.end(), s.wall);
  Pressures phi;
  if (walls != sets.end()) {
    phi = torsion<D>(mesh, s, out.velocity_[walls - sets.begin()].cycle, progress);
  } else {
    auto cycle = Multigrid::build(velocity_matrix<D>(s, s.wall), progress.portion(0.6, 0.7));
    if (!cycle) return std::nullopt;
    phi = torsion<D>(mesh, s, *cycle, progress);
  }
  std::vector<double> weight(s.elements.size());
  for_blocks(weight.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      std::array<Vec<D>, D + 1> p;
      for (int k = 0; k <= D; ++k) p[k] = mesh.points[s.node[s.elements[e][k]]];
      weight[e] = bubble_weight<D>(element_shape<D>(p).gradient);
      for (const std::int32_t r : s.elements[e]) weight[e] += std::max(0.0, phi[r][0]) / (D + 1);
    }
  });
  out.mass_ = Multigrid::build(mass_matrix<D>(mesh, s, progress), progress.portion(0.7, 0.8), 1);
  if (!out.mass_) return std::nullopt;
  if (smooth) smooth_pressure<D>(mesh, s, phi, progress);
  out.diffusion_ =
      Multigrid::build(pressure_diffusion<D>(mesh, s, weight, progress), progress.portion(0.8, 1));
  if (!out.diffusion_) return std::nullopt;
  out.more_.resize(s.rows());
  return out;
}

template <int D>
template <int K>
void StokesPreconditioner<D>::apply_components(const StokesSystem<D>& s, Components& c,
                                               const Velocities<D>& f, Velocities<D>& v) {
  std::vector<Vec<K>> right(s.rows()), found(s.rows());
  Eigen::Matrix<double, D, K> axes;
  for (int k = 0; k < K; ++k) axes.col(k) = s.frame.col(c.axes[k]);
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) right[i] = c.scale * (axes.transpose() * f[i]);
  });
  c.cycle.template apply<K>(right, found);
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) v[i] += axes * found[i];
  });
}

template <int D>
void StokesPreconditioner<D>::velocity(const StokesSystem<D>& s, const Velocities<D>& f,
                                       Velocities<D>& v) {
  v.assign(s.rows(), Vec<D>::Zero());
  for (Components& c : velocity_) {
    if (c.axes.size() == 1) apply_components<1>(s, c, f, v);
    if (c.axes.size() == 2) apply_components<2>(s, c, f, v);
    if constexpr (D == 3)
      if (c.axes.size() == 3) apply_components<3>(s, c, f, v);
  }
  constrain<D>(s, v);
}

template <int D>
void StokesPreconditioner<D>::pressure(const Pressures& g, Pressures& p) {
  mass_->template apply<1>(g, p);
  diffusion_->template apply<1>(g, more_);
  for_blocks(p.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) p[i] += more_[i];
  });
}

template <int D>
void StokesPreconditioner<D>::shrink_velocity() {
  for (Components& c : velocity_) c.scale *= 1.5;
}

template class StokesPreconditioner<2>;
template class StokesPreconditioner<3>;

}  // namespace lamella::flow
