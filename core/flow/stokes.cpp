#include "core/flow/stokes.h"

#include "core/base/parallel.h"
#include "core/flow/stokes_precondition.h"

namespace lamella {
namespace {

using flow::State;

/// Without a fall of the residual by half over so many iterations it stagnates.
constexpr std::size_t kPatience = 300;

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
        mesh_, system_, progress.portion(0.15, 0.3, "preparing the flow solver"));
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
    State<D> x(system_.rows(), Vec<D + 1>::Zero());
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
  /// Of pressures (over the viscosity) at the openings, and the body force if asked.
  State<D> right_side(const std::vector<double>& pressure, bool with_force) const {
    State<D> b = with_force && !system_.force.empty()
                     ? system_.force
                     : State<D>(system_.rows(), Vec<D + 1>::Zero());
    for (std::size_t o = 0; o < pressure.size(); ++o)
      for (std::size_t k = 0; k < system_.openings[o].rows.size(); ++k)
        b[system_.openings[o].rows[k]].template head<D>() -=
            pressure[o] / flow_.viscosity * system_.openings[o].load[k];
    flow::constrain<D>(system_, b);
    return b;
  }

  double rate(std::size_t opening, const State<D>& x) const {
    const auto& o = system_.openings[opening];
    double sum = 0;
    for (std::size_t k = 0; k < o.rows.size(); ++k)
      sum += o.load[k].dot(x[o.rows[k]].template head<D>());
    return sum;
  }

  /// Adds the flows of the gates with a rate, whose pressures follow.
  Result<void> add_rates(const std::vector<std::size_t>& rated, std::vector<double>& pressure,
                         State<D>& x, std::vector<double>& residuals, const Progress& solving) {
    const auto n = static_cast<Eigen::Index>(rated.size());
    const double parts = static_cast<double>(n) + 1;
    std::vector<State<D>> unit;
    Eigen::MatrixXd rates(n, n);
    Eigen::VectorXd missing(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      std::vector<double> one(system_.openings.size(), 0);
      one[rated[k]] = flow_.viscosity;
      unit.emplace_back(system_.rows(), Vec<D + 1>::Zero());
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
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += found[k] * unit[k][i];
    }
    return {};
  }

  double dot(const State<D>& a, const State<D>& b) const {
    return flow::block_sum(a.size(), [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += a[i].dot(b[i]);
      return sum;
    });
  }

  /// y = K x within the admissible states.
  void multiply(const State<D>& x, State<D>& y) const {
    flow::multiply<D>(system_, x, y);
    flow::constrain<D>(system_, y);
  }

  /// Preconditioned minimal residuals (Paige and Saunders 1975). What rounding leaves between the
  /// residual of the recurrence and the true one is solved for again.
  Result<void> solve(const State<D>& b, State<D>& x, std::vector<double>& history,
                     const Progress& progress) {
    const std::size_t n = b.size();
    State<D> r = b, z(n), next(n), before(n), w0(n), w1(n), kz(n);
    double first = 0;
    history.clear();
    for (int pass = 0; pass < 4; ++pass) {
      preconditioner_->apply(system_, r, z);
      double gamma = std::sqrt(std::max(0.0, dot(r, z)));
      if (pass == 0) first = gamma;
      if (history.empty()) history.push_back(1);
      if (!(gamma > settings_.tolerance * first)) return {};
      for (State<D>* v : {&before, &w0, &w1}) std::fill(v->begin(), v->end(), Vec<D + 1>::Zero());
      double gamma_before = 1, eta = gamma, s0 = 0, s1 = 0, c0 = 1, c1 = 1;
      while (std::abs(eta) > 0.5 * settings_.tolerance * first) {
        if (progress.cancelled()) return cancelled_error();
        if (const Result<void> fine = judge(history); !fine) return fine.error();
        for_rows(n, [&](std::size_t i) { z[i] /= gamma; });
        multiply(z, kz);
        const double delta = dot(kz, z);
        const double p = delta / gamma, q = gamma / gamma_before;
        for_rows(n, [&](std::size_t i) { next[i] = kz[i] - p * r[i] - q * before[i]; });
        std::swap(before, r);
        std::swap(r, next);
        std::swap(z, kz);  // kz is the direction now, z is free
        preconditioner_->apply(system_, r, z);
        const double gamma_next = std::sqrt(std::max(0.0, dot(r, z)));
        const double a0 = c1 * delta - c0 * s1 * gamma, a1 = std::hypot(a0, gamma_next);
        const double a2 = s1 * delta + c0 * c1 * gamma, a3 = s0 * gamma;
        c0 = c1;
        s0 = s1;
        c1 = a0 / a1;
        s1 = gamma_next / a1;
        const double step = c1 * eta;
        for_rows(n, [&](std::size_t i) {
          const Vec<D + 1> w = (kz[i] - a3 * w0[i] - a2 * w1[i]) / a1;
          w0[i] = w1[i];
          w1[i] = w;
          x[i] += step * w;
        });
        eta = -s1 * eta;
        gamma_before = gamma;
        gamma = gamma_next;
        history.push_back(std::abs(eta) / first);
        progress.report(std::log(history.back()) / std::log(settings_.tolerance));
        if (gamma == 0) break;
      }
      multiply(x, r);
      for_rows(n, [&](std::size_t i) { r[i] = b[i] - r[i]; });
    }
    preconditioner_->apply(system_, r, z);
    if (std::sqrt(std::max(0.0, dot(r, z))) <= 10 * settings_.tolerance * first) return {};
    return stuck("Rounding keeps the residual of the flow from falling further", history);
  }

  template <class Work>
  static void for_rows(std::size_t n, Work&& work) {
    flow::for_blocks(n, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) work(i);
    });
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

  void report(const State<D>& x, const std::vector<double>& pressure, Flow<D>& out) const {
    out.velocity.assign(mesh_.points.size(), Vec<D>::Zero());
    out.pressure.assign(mesh_.points.size(), 0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      out.velocity[system_.node[i]] = x[i].template head<D>();
      out.pressure[system_.node[i]] = x[i][D] * flow_.viscosity;
    }
    double sum = 0, enters = 0;
    for (std::size_t o = 0; o < system_.openings.size(); ++o) {
      OpeningFlow opening;
      opening.group = o < flow_.gates.size() ? flow_.gates[o].group
                                             : flow_.vents[o - flow_.gates.size()];
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
