#include "core/flow/stokes.h"

#include "core/base/parallel.h"
#include "core/flow/stokes_precondition.h"

namespace lamella {
namespace {

using flow::Pressures;
using flow::Velocities;

/// Without a fall of the residual by half over so many iterations it stagnates.
constexpr std::size_t kPatience = 300;
constexpr int kPasses = 15;
/// Share of the flow that may be lost.
constexpr double kBalance = 3e-7;

template <int D>
class Solver {
 public:
  Solver(const SimplexMesh<D>& mesh, const FlowCase<D>& flow, const FlowSettings& settings)
      : mesh_(mesh), flow_(flow), settings_(settings) {}

  Result<Flow<D>> run(const Progress& progress) {
    Result<flow::StokesSystem<D>> system =
        flow::assemble<D>(mesh_, flow_, progress.portion(0, 0.15, "assembling the flow"));
    if (!system) return system.error();
    system_ = std::move(*system);
    auto preconditioner = flow::StokesPreconditioner<D>::build(
        mesh_, system_, settings_.smooth_pressure,
        progress.portion(0.15, 0.3, "preparing the flow solver"));
    if (!preconditioner) return cancelled_error();
    preconditioner_ = std::move(preconditioner);

    // One solution for the pressures and forces that are given, one for each rate.
    std::vector<std::size_t> rated;
    for (std::size_t g = 0; g < flow_.gates.size(); ++g)
      if (flow_.gates[g].rate) rated.push_back(g);
    const Progress solving = progress.portion(0.3, 1, "solving the flow");
    const double parts = static_cast<double>(rated.size()) + 1;
    std::vector<double> pressure(system_.openings.size(), 0);
    bool driven = !system_.force.empty();
    for (std::size_t g = 0; g < flow_.gates.size(); ++g) {
      pressure[g] = flow_.gates[g].pressure.value_or(0);
      driven = driven || pressure[g] != 0;
    }
    State x = zero();
    Flow<D> out;
    if (driven)
      if (Result<void> done =
              solve(right_side(pressure, true), x, out.residuals, solving.portion(0, 1 / parts));
          !done)
        return done.error();
    if (!rated.empty())
      if (Result<void> done = add_rates(rated, pressure, x, out.residuals, solving); !done)
        return done.error();
    report(x, pressure, out);
    return out;
  }

 private:
  struct State {
    Velocities<D> v;
    Pressures p;
  };
  State zero() const {
    return {Velocities<D>(system_.rows(), Vec<D>::Zero()),
            Pressures(system_.rows(), Vec<1>::Zero())};
  }

  /// Of pressures (over the viscosity) at the openings, and the body force if asked.
  State right_side(const std::vector<double>& pressure, bool with_force) const {
    State b = zero();
    if (with_force && !system_.force.empty()) b = {system_.force, system_.bubble_force};
    for (std::size_t o = 0; o < pressure.size(); ++o)
      for (std::size_t k = 0; k < system_.openings[o].rows.size(); ++k)
        b.v[system_.openings[o].rows[k]] -=
            pressure[o] / flow_.viscosity * system_.openings[o].load[k];
    flow::constrain<D>(system_, b.v);
    return b;
  }

  double rate(std::size_t opening, const State& x) const {
    const auto& o = system_.openings[opening];
    double sum = 0;
    for (std::size_t k = 0; k < o.rows.size(); ++k) sum += o.load[k].dot(x.v[o.rows[k]]);
    return sum;
  }

  /// Adds the flows of the gates with a rate, whose pressures follow.
  Result<void> add_rates(const std::vector<std::size_t>& rated, std::vector<double>& pressure,
                         State& x, std::vector<double>& residuals, const Progress& solving) {
    const auto n = static_cast<Eigen::Index>(rated.size());
    const double parts = static_cast<double>(n) + 1;
    std::vector<State> unit;
    Eigen::MatrixXd rates(n, n);
    Eigen::VectorXd missing(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      std::vector<double> one(system_.openings.size(), 0);
      one[rated[k]] = flow_.viscosity;
      unit.push_back(zero());
      const Progress here = solving.portion((k + 1) / parts, (k + 2) / parts);
      if (Result<void> done = solve(right_side(one, false), unit.back(), residuals, here); !done)
        return done.error();
      for (Eigen::Index g = 0; g < n; ++g) rates(g, k) = rate(rated[g], unit.back());
      missing[k] = -*flow_.gates[rated[k]].rate - rate(rated[k], x);
    }
    const Eigen::VectorXd found = rates.fullPivLu().solve(missing);
    if (!((rates * found - missing).norm() <= 1e-6 * missing.norm()))
      return Error{Code::usage, "The rates asked at the gates cannot all be met.",
                   "Name a vent, or give one gate a pressure."};
    for (Eigen::Index k = 0; k < n; ++k) {
      pressure[rated[k]] = found[k] * flow_.viscosity;
      for_rows([&](std::size_t i) {
        x.v[i] += found[k] * unit[k].v[i];
        x.p[i] += found[k] * unit[k].p[i];
      });
    }
    return {};
  }

  template <class Work>
  void for_rows(Work&& work) const {
    flow::for_blocks(system_.rows(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) work(i);
    });
  }
  template <class Rows>
  double dot(const Rows& a, const Rows& b) const {
    return flow::block_sum(a.size(), [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += a[i].dot(b[i]);
      return sum;
    });
  }

  /// What enters also leaves: the residuals of the pressure add up to the sum of all rates.
  bool balanced(const State& r, const State& x) const {
    double enters = 0, sum = 0;
    for (std::size_t o = 0; o < system_.openings.size(); ++o) enters += std::max(0.0, -rate(o, x));
    for (const Vec<1>& p : r.p) sum += p[0];
    return std::abs(sum) <= kBalance * enters;
  }

  /// Conjugate gradients of Bramble and Pasciak (1988). With the approximate inverses a of A and s
  /// of the Schur complement, the rows of (5.3) are replaced by those of (a, s B a, -s), which
  /// makes it positive definite for the product (A - 1/a, 1/s) as long as 1/a is below A; the
  /// products are found without 1/a and 1/s. What rounding leaves between the residual carried
  /// along and the true one is solved for again.
  Result<void> solve(const State& b, State& x, std::vector<double>& history,
                     const Progress& progress) {
    State r = b, z = zero(), az = zero(), d = zero(), kd = zero();
    Velocities<D> w(system_.rows());
    Pressures g(system_.rows());
    double first = 0;
    int grown = 0;
    history.clear();
    for (int pass = 0; pass < kPasses; ++pass) {
      preconditioner_->velocity(system_, r.v, z.v);
      double before = 0;
      for (bool restart = true; true; restart = false) {
        if (progress.cancelled()) return cancelled_error();
        flow::multiply_velocity<D>(system_, z.v, az.v, az.p);
        for_rows([&](std::size_t i) { g[i] = az.p[i] - r.p[i]; });
        preconditioner_->pressure(g, z.p);
        const double now = dot(az.v, z.v) - dot(r.v, z.v) + dot(g, z.p);
        if (history.empty()) {
          first = now;
          history.push_back(1);
          if (now == 0) return {};
        }
        const double share = std::sqrt(std::abs(now / first));
        if (!restart) history.push_back(share);
        if (const Result<void> fine = judge(history); !fine) return fine.error();
        progress.report(std::log(share) / std::log(settings_.tolerance));
        const bool small = share <= (restart ? 1 : 0.5) * settings_.tolerance;
        if (small && (balanced(r, x) || share <= 1e-4 * settings_.tolerance)) {
          if (restart) return {};
          break;
        }
        flow::add_pressure<D>(system_, z.p, az.v, az.p);
        const double beta = restart ? 0 : now / before;
        for_rows([&](std::size_t i) {
          d.v[i] = z.v[i] + beta * d.v[i];
          d.p[i] = z.p[i] + beta * d.p[i];
          kd.v[i] = az.v[i] + beta * kd.v[i];
          kd.p[i] = az.p[i] + beta * kd.p[i];
        });
        preconditioner_->velocity(system_, kd.v, w);
        const double curvature = dot(w, kd.v) - dot(kd.v, d.v) - dot(kd.p, d.p);
        if (!(now > 0 && curvature > 0)) {
          // 1/a was not below A.
          if (++grown > 10) return stuck("The flow solver broke down", history);
          preconditioner_->shrink_velocity();
          break;
        }
        const double step = now / curvature;
        for_rows([&](std::size_t i) {
          x.v[i] += step * d.v[i];
          x.p[i] += step * d.p[i];
          r.v[i] -= step * kd.v[i];
          r.p[i] -= step * kd.p[i];
          z.v[i] -= step * w[i];
        });
        before = now;
      }
      flow::multiply_velocity<D>(system_, x.v, r.v, r.p);
      flow::add_pressure<D>(system_, x.p, r.v, r.p);
      for_rows([&](std::size_t i) {
        r.v[i] = b.v[i] - r.v[i];
        r.p[i] = b.p[i] - r.p[i];
      });
    }
    return stuck("Rounding keeps the residual of the flow from falling further", history);
  }

  Result<void> judge(const std::vector<double>& history) const {
    if (!std::isfinite(history.back()))
      return Error{Code::failed, "The flow solver diverged.",
                   "Check the mesh for elements that are nearly flat."};
    if (history.size() > static_cast<std::size_t>(settings_.most_iterations))
      return stuck("The flow has not converged", history);
    if (history.size() > kPatience && history.back() > 0.5 * history[history.size() - kPatience])
      return stuck("The residual of the flow no longer falls", history);
    return {};
  }

  Error stuck(const std::string& what, const std::vector<double>& history) const {
    char text[100];
    std::snprintf(text, sizeof text, ": after %zu iterations it is %.1e of the first.",
                  history.size() - 1, history.back());
    return {Code::not_converged, what + text,
            "Ask for a larger tolerance, or adapt the mesh, which mends the worst elements."};
  }

  void report(const State& x, const std::vector<double>& pressure, Flow<D>& out) const {
    out.velocity.assign(mesh_.points.size(), Vec<D>::Zero());
    out.pressure.assign(mesh_.points.size(), 0);
    for (std::size_t i = 0; i < system_.rows(); ++i) {
      out.velocity[system_.node[i]] = x.v[i];
      out.pressure[system_.node[i]] = x.p[i][0] * flow_.viscosity;
    }
    double sum = 0, enters = 0;
    for (std::size_t o = 0; o < system_.openings.size(); ++o) {
      OpeningFlow opening;
      opening.group =
          o < flow_.gates.size() ? flow_.gates[o].group : flow_.vents[o - flow_.gates.size()];
      opening.pressure = pressure[o];
      opening.rate = rate(o, x);
      opening.area = system_.openings[o].area;
      sum += opening.rate;
      enters += std::max(0.0, -opening.rate);
      out.openings.push_back(std::move(opening));
    }
    out.imbalance = enters > 0 ? std::abs(sum) / enters : std::abs(sum);
  }

  const SimplexMesh<D>& mesh_;
  const FlowCase<D>& flow_;
  const FlowSettings& settings_;
  flow::StokesSystem<D> system_;
  std::optional<flow::StokesPreconditioner<D>> preconditioner_;
};

}  // namespace

template <int D>
Result<Flow<D>> solve_stokes(const SimplexMesh<D>& mesh, const FlowCase<D>& flow,
                             const FlowSettings& settings, const Progress& progress) {
  if (!(settings.tolerance > 0 && settings.tolerance < 1))
    return Error{Code::usage, "The tolerance of the flow is not between 0 and 1.", ""};
  std::optional<Result<Flow<D>>> out;
  thread_arena(settings.threads).execute([&] {
    out.emplace(Solver<D>(mesh, flow, settings).run(progress));
  });
  return std::move(*out);
}
template Result<Flow<2>> solve_stokes(const SimplexMesh<2>&, const FlowCase<2>&,
                                      const FlowSettings&, const Progress&);
template Result<Flow<3>> solve_stokes(const SimplexMesh<3>&, const FlowCase<3>&,
                                      const FlowSettings&, const Progress&);

}  // namespace lamella
