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

/// x with V the preconditioner: conjugate gradients, until the residual has fallen by 1e-3.
std::vector<Vec<1>> solve(Multigrid& v, const std::vector<Vec<1>>& b, const Progress& progress) {
  const std::size_t n = b.size();
  const auto dot = [&](const std::vector<Vec<1>>& a, const std::vector<Vec<1>>& c) {
    return block_sum(n, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += a[i][0] * c[i][0];
      return sum;
    });
  };
  std::vector<Vec<1>> x(n, Vec<1>::Zero()), r = b, z(n), p(n, Vec<1>::Zero()), q(n);
  double before = 0, first = 0;
  for (int it = 0; it < 30 && !progress.cancelled(); ++it) {
    v.apply<1>(r, z);
    const double now = dot(r, z);
    if (it == 0) first = now;
    if (!(now > 1e-6 * first)) break;
    const double beta = it == 0 ? 0 : now / before;
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
    multiply<1>(v.matrix(), p, q);
    const double step = now / dot(p, q);
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += step * p[i];
      r[i] -= step * q[i];
    }
    before = now;
  }
  return x;
}

/// phi + the bubble's own weight, in each element.
template <int D>
std::vector<double> permeability(const SimplexMesh<D>& mesh, const StokesSystem<D>& s,
                                 Multigrid& cycle, const Progress& progress) {
  std::vector<Vec<1>> load(s.rows(), Vec<1>::Zero());
  std::vector<double> weight(s.elements.size());
  for (std::size_t e = 0; e < s.elements.size(); ++e) {
    std::array<Vec<D>, D + 1> p;
    for (int k = 0; k <= D; ++k) p[k] = mesh.points[s.node[s.elements[e][k]]];
    const ElementShape<D> shape = element_shape<D>(p);
    weight[e] = bubble_weight<D>(shape.gradient);
    for (const std::int32_t r : s.elements[e])
      if (!s.wall[r]) load[r][0] += shape.measure / (D + 1);
  }
  const std::vector<Vec<1>> phi = solve(cycle, load, progress);
  for (std::size_t e = 0; e < s.elements.size(); ++e)
    for (const std::int32_t r : s.elements[e]) weight[e] += std::max(0.0, phi[r][0]) / (D + 1);
  return weight;
}

}  // namespace

template <int D>
std::optional<StokesPreconditioner<D>> StokesPreconditioner<D>::build(
    const SimplexMesh<D>& mesh, const StokesSystem<D>& s, const Progress& progress) {
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
    sets.push_back(std::move(fixed));
  }
  const auto walls = std::find(sets.begin(), sets.end(), s.wall);
  std::vector<double> weight;
  if (walls != sets.end()) {
    weight = permeability<D>(mesh, s, out.velocity_[walls - sets.begin()].cycle, progress);
  } else {
    auto cycle = Multigrid::build(velocity_matrix<D>(s, s.wall), progress.portion(0.6, 0.7));
    if (!cycle) return std::nullopt;
    weight = permeability<D>(mesh, s, *cycle, progress);
  }
  out.mass_ = Multigrid::build(mass_matrix<D>(mesh, s), progress.portion(0.7, 0.8), 1);
  if (!out.mass_) return std::nullopt;
  out.diffusion_ =
      Multigrid::build(pressure_diffusion<D>(mesh, s, weight), progress.portion(0.8, 1));
  if (!out.diffusion_) return std::nullopt;
  out.right_.resize(s.rows());
  out.found_.resize(s.rows());
  return out;
}

template <int D>
template <int K>
void StokesPreconditioner<D>::apply_components(const StokesSystem<D>& s, Components& c,
                                               const State<D>& r, State<D>& z) {
  std::vector<Vec<K>> right(s.rows()), found(s.rows());
  Eigen::Matrix<double, D, K> axes;
  for (int k = 0; k < K; ++k) axes.col(k) = s.frame.col(c.axes[k]);
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      right[i] = axes.transpose() * r[i].template head<D>();
  });
  c.cycle.template apply<K>(right, found);
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) z[i].template head<D>() += axes * found[i];
  });
}

template <int D>
void StokesPreconditioner<D>::apply(const StokesSystem<D>& s, const State<D>& r, State<D>& z) {
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      z[i].setZero();
      right_[i][0] = r[i][D];
    }
  });
  mass_->template apply<1>(right_, found_);
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      z[i][D] = found_[i][0];
      if (s.open[i]) right_[i][0] = 0;
    }
  });
  diffusion_->template apply<1>(right_, found_);
  for_blocks(s.rows(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!s.open[i]) z[i][D] += found_[i][0];
  });
  for (Components& c : velocity_) {
    if (c.axes.size() == 1) apply_components<1>(s, c, r, z);
    if (c.axes.size() == 2) apply_components<2>(s, c, r, z);
    if constexpr (D == 3)
      if (c.axes.size() == 3) apply_components<3>(s, c, r, z);
  }
  constrain<D>(s, z);
}

template class StokesPreconditioner<2>;
template class StokesPreconditioner<3>;

}  // namespace lamella::flow
