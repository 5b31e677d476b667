#include "core/optimize/metric_conditioning.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/quality.h"
#include "core/metric/intersect.h"

namespace lamella {
namespace {

using Kind = ConditionStep::Kind;

/// A spread metric may exceed the node's by this much before it is intersected: fixed points that
/// are reached only in the limit end.
constexpr double kSlack = 1e-3;
/// The forecast is within this of the elements asked.
constexpr double kElementsTolerance = 2e-3;

/// Sums over the nodes a step has changed; logarithms of factors.
struct Change {
  std::size_t nodes = 0;
  double largest = 0, sum = 0, lost = 0, anisotropy_sum = 0;

  /// Eigenvalues of one node, ascending.
  template <int D>
  void add(const Vec<D>& before, const Vec<D>& after) {
    const double size = 0.5 * (after.array() / before.array()).log().abs().maxCoeff();
    const double ratio =
        0.5 * std::log(after[D - 1] / after[0] * (before[0] / before[D - 1]));  // after / before
    ++nodes;
    largest = std::max(largest, size);
    sum += size;
    lost = std::max(lost, -ratio);
    anisotropy_sum += ratio;
  }
  void add(const Change& o) {
    nodes += o.nodes;
    largest = std::max(largest, o.largest);
    sum += o.sum;
    lost = std::max(lost, o.lost);
    anisotropy_sum += o.anisotropy_sum;
  }
  ConditionStep step(Kind kind) const {
    ConditionStep s;
    s.kind = kind;
    s.nodes = nodes;
    if (nodes == 0) return s;
    s.size_largest = std::exp(largest);
    s.size_mean = std::exp(sum / static_cast<double>(nodes));
    s.anisotropy_lost = std::exp(lost);
    s.anisotropy_mean = std::exp(anisotropy_sum / static_cast<double>(nodes));
    return s;
  }
};

/// Sums over fixed blocks of indices, added in their order: the same for any thread count.
template <class Sum, class Work>
bool summed(std::size_t count, int threads, const Progress& progress, Sum& total, Work work) {
  constexpr std::size_t kBlock = 2048;
  std::vector<Sum> sums((count + kBlock - 1) / kBlock, total);
  const bool done = parallel_each(
      sums.size(), threads, progress,
      [&](std::size_t b) {
        const std::size_t end = std::min(count, (b + 1) * kBlock);
        for (std::size_t i = b * kBlock; i < end; ++i) work(i, sums[b]);
      },
      1);
  for (const Sum& s : sums) total.add(s);
  return done;
}

/// The eigenvalues after one step; `kind` is one of those that act on a node alone.
template <int D>
Vec<D> stepped(const Vec<D>& values, Kind kind, const ConditionParams& params, double scale) {
  switch (kind) {
    case Kind::scale:
      return scale == 1 ? values : values * eigenvalue_from_size(scale);
    case Kind::h_min:
      if (params.h_min) return values.cwiseMin(eigenvalue_from_size(*params.h_min));
      break;
    case Kind::h_max:
      if (params.h_max) return values.cwiseMax(eigenvalue_from_size(*params.h_max));
      break;
    case Kind::anisotropy:
      if (params.max_anisotropy)
        return values.cwiseMax(values[D - 1] * eigenvalue_from_size(*params.max_anisotropy));
      break;
    case Kind::gradation:
      break;
  }
  return values;
}
constexpr std::array kNodeSteps = {Kind::scale, Kind::h_min, Kind::h_max, Kind::anisotropy};

/// More than the rounding of the eigenvalues, which is relative to the largest one.
template <int D>
bool differ(const Vec<D>& a, const Vec<D>& b) {
  const double rounding = 1e-14 * std::max(a[D - 1], b[D - 1]);
  return ((a - b).array().abs() > 1e-9 * b.array().abs() + rounding).any();
}

template <int D>
Metric<D> assembled(const Mat<D>& axes, const Vec<D>& values) {
  const Mat<D> m = axes * values.asDiagonal() * axes.transpose();
  return 0.5 * (m + m.transpose());
}

/// Neighbors of each node, in ascending order: of node n at [start[n], start[n + 1]).
struct Neighbors {
  std::vector<std::size_t> start;
  std::vector<NodeId> node;
};

template <int D>
Neighbors neighbors_of(const SimplexMesh<D>& mesh) {
  const auto edges = unique_edges<D>(mesh.elements, mesh.points.size());
  Neighbors out;
  out.start.assign(mesh.points.size() + 1, 0);
  for (const auto& e : edges)
    for (const NodeId n : e) ++out.start[n + 1];
  for (std::size_t n = 0; n + 1 < out.start.size(); ++n) out.start[n + 1] += out.start[n];
  out.node.resize(out.start.back());
  std::vector<std::size_t> next(out.start.begin(), out.start.end() - 1);
  for (const auto& [a, b] : edges) {
    out.node[next[a]++] = b;
    out.node[next[b]++] = a;
  }
  return out;
}

template <int D>
class Conditioner {
 public:
  Conditioner(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
              const ConditionParams& params)
      : mesh_(mesh), input_(metric), params_(params) {}

  Result<Conditioned<D>> run(const Progress& progress) {
    if (!prepare(progress.portion(0, 0.1))) return cancelled_error();
    ConditionReport report;
    const Progress rest = progress.portion(0.1, 1, "conditioning the metric");
    const std::optional<double> before = complexity(input_, rest);
    if (!before) return cancelled_error();
    report.elements_before = *before;
    if (params_.elements) {
      if (!solve(report, rest)) return cancelled_error();
    } else if (!apply(1, &report, rest)) {
      return cancelled_error();
    }
    progress.report(1);
    return Conditioned<D>{std::move(metric_), std::move(report)};
  }

 private:
  bool prepare(const Progress& progress) {
    const std::size_t nodes = input_.size() - 1;
    spectra_.resize(input_.size());
    if (!parallel_each(nodes, params_.threads, progress,
                       [&](std::size_t i) { spectra_[i + 1] = spectrum<D>(input_[i + 1]); }))
      return false;
    weight_.resize(mesh_.elements.size());
    for (std::size_t e = 0; e < weight_.size(); ++e)
      weight_[e] =
          std::abs(signed_measure<D>(mesh_.corners(mesh_.elements[e]))) / unit_simplex_measure(D);
    if (params_.gradation) neighbors_ = neighbors_of<D>(mesh_);
    return !progress.cancelled();
  }

  /// Forecast (1.34) of elements; nullopt when cancelled.
  std::optional<double> complexity(const MetricField<D>& metric, const Progress& progress) const {
    struct Sum {
      double value = 0;
      void add(const Sum& o) { value += o.value; }
    } total;
    if (!summed(weight_.size(), params_.threads, progress.portion(0, 0), total,
                [&](std::size_t e, Sum& sum) {
                  const double det = mean_metric<D>(metric, mesh_.elements[e]).determinant();
                  sum.value += weight_[e] * std::sqrt(std::max(0.0, det));
                }))
      return {};
    return total.value;
  }

  /// All steps with the scale given, into `metric_`. Returns the forecast, or nullopt when
  /// cancelled; `report` gets the steps.
  std::optional<double> apply(double scale, ConditionReport* report, const Progress& progress) {
    // The forecast after each step on its own costs a field a step: only for the report.
    double elements = report ? report->elements_before : 0;
    metric_ = input_;
    if (report) {
      report->scale = scale;
      for (std::size_t s = 0; s < kNodeSteps.size(); ++s) {
        if (!asked(kNodeSteps[s])) continue;
        const auto change = node_steps(scale, s, s + 1, progress);
        const auto after = change ? complexity(metric_, progress) : std::nullopt;
        if (!after) return {};
        report->steps.push_back(change->step(kNodeSteps[s]));
        report->steps.back().elements_before = elements;
        report->steps.back().elements_after = elements = *after;
      }
    } else if (!node_steps(scale, 0, kNodeSteps.size(), progress)) {
      return {};
    }
    if (params_.gradation) {
      const MetricField<D> ungraded = report ? metric_ : MetricField<D>{};
      ConditionStep step;
      if (!grade(step.sweeps, step.settled, progress)) return {};
      if (report) {
        const auto change = difference(ungraded, progress);
        const auto after = change ? complexity(metric_, progress) : std::nullopt;
        if (!after) return {};
        const ConditionStep counted = change->step(Kind::gradation);
        report->steps.push_back(counted);
        report->steps.back().sweeps = step.sweeps;
        report->steps.back().settled = step.settled;
        report->steps.back().elements_before = elements;
        report->steps.back().elements_after = elements = *after;
      }
    }
    if (!report) return complexity(metric_, progress);
    report->elements_after = elements;
    return elements;
  }

  bool asked(Kind kind) const {
    switch (kind) {
      case Kind::scale:
        return params_.elements.has_value();
      case Kind::h_min:
        return params_.h_min.has_value();
      case Kind::h_max:
        return params_.h_max.has_value();
      case Kind::anisotropy:
        return params_.max_anisotropy.has_value();
      case Kind::gradation:
        return params_.gradation.has_value();
    }
    return false;
  }

  /// The metric after the steps before `end`; counts what those from `begin` on changed.
  std::optional<Change> node_steps(double scale, std::size_t begin, std::size_t end,
                                   const Progress& progress) {
    Change total;
    const bool done = summed(input_.size() - 1, params_.threads, progress.portion(0, 0), total,
                             [&](std::size_t i, Change& sum) {
                               const Spectrum<D>& own = spectra_[i + 1];
                               Vec<D> values = own.values, before = values;
                               for (std::size_t s = 0; s < end; ++s) {
                                 if (s == begin) before = values;
                                 values = stepped<D>(values, kNodeSteps[s], params_, scale);
                               }
                               if (differ<D>(values, before)) sum.add<D>(before, values);
                               metric_[i + 1] = differ<D>(values, own.values)
                                                    ? assembled<D>(own.vectors, values)
                                                    : input_[i + 1];
                             });
    if (!done) return {};
    return total;
  }

  std::optional<Change> difference(const MetricField<D>& before, const Progress& progress) const {
    Change total;
    const bool done = summed(before.size() - 1, params_.threads, progress.portion(0, 0), total,
                             [&](std::size_t i, Change& sum) {
                               if (before[i + 1] == metric_[i + 1]) return;
                               const Vec<D> a = spectrum<D>(before[i + 1]).values,
                                            b = spectrum<D>(metric_[i + 1]).values;
                               if (differ<D>(b, a)) sum.add<D>(a, b);
                             });
    if (!done) return {};
    return total;
  }

  /// The scale whose forecast is the elements asked: a bracket, then the secant in logarithms with
  /// the retained end weighted down (Illinois).
  bool solve(ConditionReport& report, const Progress& progress) {
    const double goal = std::log(*params_.elements);
    int evaluations = 0;
    bool cancelled = false;
    const auto gap = [&](double log_scale) {
      const double share = evaluations / (evaluations + 3.0);
      ++evaluations;
      const auto n = apply(std::exp(log_scale), nullptr,
                           progress.portion(share, evaluations / (evaluations + 3.0)));
      cancelled = cancelled || !n;
      return n ? std::log(std::max(*n, 1e-300)) - goal : 0;
    };
    double a = 0, fa = gap(a), b = a, fb = fa, step = 0;
    // Without bounds N(s) = s^-D N(1). Bounds flatten it; where they hold everywhere the step grows
    // until the far side of the plateau, or past every size that means something.
    constexpr double kFar = 60;
    while (!cancelled && std::abs(b) < kFar && std::abs(fb) > kElementsTolerance) {
      const bool flat = step != 0 && std::abs(fb - fa) < 1e-9;
      step = flat ? 2 * step : 1.05 * fb / D + (fb > 0 ? 0.05 : -0.05);
      a = b;
      fa = fb;
      b += step;
      fb = gap(b);
      if ((fb > 0) != (fa > 0)) break;
    }
    double best = b, best_gap = fb;
    if ((fb > 0) != (fa > 0)) {
      double wa = fa, wb = fb;
      int side = 0;
      for (int i = 0; i < 60 && !cancelled && std::abs(best_gap) > kElementsTolerance; ++i) {
        const double c = i % 8 == 7 ? 0.5 * (a + b) : (a * wb - b * wa) / (wb - wa);
        const double fc = gap(c);
        best = c;
        best_gap = fc;
        if ((fc > 0) == (fb > 0)) {
          b = c;
          wb = fb = fc;
          if (side == 1) wa *= 0.5;
          side = 1;
        } else {
          a = c;
          wa = fa = fc;
          if (side == -1) wb *= 0.5;
          side = -1;
        }
      }
    }
    if (cancelled) return false;
    report.elements_reached = std::abs(best_gap) < 0.01;
    return apply(std::exp(best), &report, progress.portion(0.95, 1)).has_value();
  }

  bool grade(int& sweeps, bool& settled, const Progress& progress) {
    const bool done = params_.gradation_kind == GradationKind::isotropic
                          ? grade_by_factors(sweeps, settled, progress)
                          : grade_by_intersection(sweeps, settled, progress);
    if (!done || !params_.h_min) return done;
    return parallel_each(metric_.size() - 1, params_.threads, progress.portion(1, 1),
                         [&](std::size_t i) {
                           if (!changed_[i + 1]) return;
                           ConditionParams floor;
                           floor.h_min = params_.h_min;
                           metric_[i + 1] = bounded_metric<D>(metric_[i + 1], floor);
                         });
  }

  /// Repeats update(n, moved), which says whether node n changed and writes its new value aside,
  /// until no node changes; `accept(n)` makes the value of a changed node the one that others see.
  /// Only neighbors with moved[p], those of the sweep before, can ask for more than they have
  /// asked: metrics only get finer.
  template <class Update, class Accept>
  bool sweep(int& sweeps, bool& settled, const Progress& progress, Update update, Accept accept) {
    std::vector<char> moved(metric_.size(), 1), now(metric_.size(), 0), next;
    changed_.assign(metric_.size(), 0);
    std::vector<NodeId> work(metric_.size() - 1);
    for (std::size_t i = 0; i < work.size(); ++i) work[i] = static_cast<NodeId>(i + 1);
    settled = false;
    for (sweeps = 0; sweeps < params_.gradation_sweeps && !settled; ++sweeps) {
      const Progress here =
          progress.portion(sweeps / (sweeps + 10.0), (sweeps + 1) / (sweeps + 11.0));
      if (!parallel_each(work.size(), params_.threads, here,
                         [&](std::size_t i) { now[work[i]] = update(work[i], moved); }))
        return false;
      moved.assign(metric_.size(), 0);
      next.assign(metric_.size(), 0);
      settled = true;
      for (const NodeId n : work) {
        if (!now[n]) continue;
        settled = false;
        changed_[n] = moved[n] = 1;
        accept(n);
        for (std::size_t k = neighbors_.start[n]; k < neighbors_.start[n + 1]; ++k)
          next[neighbors_.node[k]] = 1;
      }
      work.clear();
      for (std::size_t n = 1; n < next.size(); ++n)
        if (next[n]) work.push_back(static_cast<NodeId>(n));
    }
    return true;
  }

  bool grade_by_factors(int& sweeps, bool& settled, const Progress& progress) {
    const double slope = std::log(*params_.gradation);
    std::vector<double> factor(metric_.size(), 1), next = factor;
    const auto update = [&](NodeId q, const std::vector<char>& moved) {
      double s = factor[q];
      for (std::size_t k = neighbors_.start[q]; k < neighbors_.start[q + 1]; ++k) {
        const NodeId p = neighbors_.node[k];
        if (!moved[p]) continue;
        const Vec<D> e = mesh_.points[q] - mesh_.points[p];
        // |e| / h(e) is the metric length, of which the factor is divided.
        s = std::min(s, metric_length<D>(e, metric_[q]) *
                            (factor[p] / metric_length<D>(e, metric_[p]) + slope));
      }
      next[q] = s;
      return s < factor[q] * (1 - 1e-12);
    };
    if (!sweep(sweeps, settled, progress, update, [&](NodeId n) { factor[n] = next[n]; }))
      return false;
    for (std::size_t n = 1; n < metric_.size(); ++n)
      if (changed_[n]) metric_[n] *= eigenvalue_from_size(factor[n]);
    return true;
  }

  bool grade_by_intersection(int& sweeps, bool& settled, const Progress& progress) {
    const double slope = std::log(*params_.gradation);
    MetricField<D> next = metric_;
    ConditionParams cap;
    cap.max_anisotropy = params_.max_anisotropy;
    const auto update = [&](NodeId q, const std::vector<char>& moved) {
      struct Violation {
        double size;  // sum of the quotients of both forms along the axes that reduce them
        Metric<D> metric;
      };
      std::vector<Violation> found;
      const Metric<D>& own = metric_[q];
      for (std::size_t k = neighbors_.start[q]; k < neighbors_.start[q + 1]; ++k) {
        const NodeId p = neighbors_.node[k];
        if (!moved[p]) continue;
        const Vec<D> e = mesh_.points[q] - mesh_.points[p];
        const double growth = 1 + slope * metric_length<D>(e, metric_[p]);
        const Metric<D> spread = metric_[p] / (growth * growth);
        if (covers(own, spread)) continue;
        found.push_back({own.llt().solve(spread).trace(), spread});
      }
      if (found.empty()) return false;
      std::stable_sort(found.begin(), found.end(),
                       [](const Violation& a, const Violation& b) { return a.size > b.size; });
      Metric<D> m = own;
      for (const Violation& v : found)
        if (!covers(m, v.metric)) m = intersect<D>(m, v.metric);
      if (cap.max_anisotropy) m = bounded_metric<D>(m, cap);
      next[q] = m;
      return true;
    };
    return sweep(sweeps, settled, progress, update, [&](NodeId n) { metric_[n] = next[n]; });
  }

  /// m >= spread as quadratic forms, up to the slack: the difference has positive pivots. A sweep
  /// spends its time here, and Eigen's LLT takes several times as long at this size.
  static bool covers(const Metric<D>& m, const Metric<D>& spread) {
    Mat<D> rest = (1 + kSlack) * m - spread;
    for (int k = 0; k < D; ++k) {
      if (!(rest(k, k) > 0)) return false;
      for (int i = k + 1; i < D; ++i) {
        const double f = rest(i, k) / rest(k, k);
        for (int j = i; j < D; ++j) rest(j, i) -= f * rest(j, k);
      }
    }
    return true;
  }

  const SimplexMesh<D>& mesh_;
  const MetricField<D>& input_;
  const ConditionParams& params_;
  std::vector<Spectrum<D>> spectra_;  ///< [node] of the input
  std::vector<double> weight_;        ///< [element] |T| / |T_eq|
  Neighbors neighbors_;
  MetricField<D> metric_;
  std::vector<char> changed_;  ///< [node] by the gradation
};

std::optional<Error> checked(const ConditionParams& p) {
  const auto refuse = [](const std::string& what, const std::string& hint) {
    return Error{Code::usage, what, hint};
  };
  const auto positive = [](const std::optional<double>& v) {
    return !v || (*v > 0 && std::isfinite(*v));
  };
  if (!positive(p.h_min) || !positive(p.h_max))
    return refuse("A bound of the mesh size is not a positive number.", "Give a size in mm.");
  if (p.h_min && p.h_max && *p.h_min > *p.h_max)
    return refuse("The smallest size asked is above the largest.", "Exchange h_min and h_max.");
  if (p.max_anisotropy && !(*p.max_anisotropy >= 1))
    return refuse("The bound of the anisotropy is below 1.",
                  "It is the largest size over the smallest: 1 is isotropic.");
  if (p.gradation && !(*p.gradation > 1 && std::isfinite(*p.gradation)))
    return refuse("The gradation is not above 1.",
                  "It is the growth of sizes per unit length: 1.3 is common.");
  if (!positive(p.elements))
    return refuse("The number of elements asked is not positive.", "Ask for 1 at least.");
  return {};
}

}  // namespace

const char* step_name(ConditionStep::Kind kind) {
  switch (kind) {
    case Kind::scale:
      return "scale";
    case Kind::h_min:
      return "h_min";
    case Kind::h_max:
      return "h_max";
    case Kind::anisotropy:
      return "anisotropy";
    case Kind::gradation:
      return "gradation";
  }
  return "";
}

template <int D>
Metric<D> bounded_metric(const Metric<D>& metric, const ConditionParams& params, double scale) {
  const Spectrum<D> own = spectrum<D>(metric);
  Vec<D> values = own.values;
  for (const Kind kind : kNodeSteps) values = stepped<D>(values, kind, params, scale);
  return differ<D>(values, own.values) ? assembled<D>(own.vectors, values) : metric;
}

template <int D>
Result<Conditioned<D>> condition_metric(const SimplexMesh<D>& mesh, const MetricField<D>& metric,
                                        const ConditionParams& params, const Progress& progress) {
  if (auto error = checked(params)) return *error;
  if (mesh.elements.empty())
    return Error{Code::bad_input, "The mesh of the metric has no elements.", ""};
  if (Result<void> good = check_metric<D>(metric, mesh.node_count()); !good) return good.error();
  return Conditioner<D>(mesh, metric, params).run(progress);
}

#define LAMELLA_INSTANTIATE(D)                                                            \
  template Metric<D> bounded_metric<D>(const Metric<D>&, const ConditionParams&, double); \
  template Result<Conditioned<D>> condition_metric<D>(                                    \
      const SimplexMesh<D>&, const MetricField<D>&, const ConditionParams&, const Progress&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
