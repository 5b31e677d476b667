#include "core/flow/multigrid.h"

#include <numeric>

namespace lamella::flow {
namespace {

/// A coupling is strong when -a_ij exceeds this times sqrt(a_ii a_jj).
constexpr double kStrong = 0.02;
/// The last level is solved directly.
constexpr std::int32_t kCoarsest = 400;
constexpr std::size_t kBlock = 2048;

std::vector<double> diagonal(const Csr& a) {
  std::vector<double> d(static_cast<std::size_t>(a.rows()), 0);
  for (std::int32_t i = 0; i < a.rows(); ++i)
    for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e)
      if (a.column[e] == i) d[i] = a.value[e];
  return d;
}

/// The strong couplings alone, what is left out lumped into the diagonal: row sums stay.
Csr filtered(const Csr& a, double strong) {
  const std::vector<double> d = diagonal(a);
  Csr out;
  out.columns = a.columns;
  out.start.reserve(a.start.size());
  for (std::int32_t i = 0; i < a.rows(); ++i) {
    double lumped = 0;
    std::int32_t own = -1;
    for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
      const std::int32_t j = a.column[e];
      if (j == i) own = static_cast<std::int32_t>(out.column.size());
      if (j != i && -a.value[e] <= strong * std::sqrt(d[i] * d[j])) {
        lumped += a.value[e];
        continue;
      }
      out.column.push_back(j);
      out.value.push_back(a.value[e]);
    }
    if (own >= 0 && out.value[own] + lumped > 0.1 * d[i]) out.value[own] += lumped;
    out.start.push_back(static_cast<std::int32_t>(out.column.size()));
  }
  return out;
}

/// The aggregate of each row, -1 for rows without a strong coupling.
std::vector<std::int32_t> aggregate(const Csr& strong, std::int32_t& count) {
  const std::int32_t n = strong.rows();
  std::vector<std::int32_t> of(static_cast<std::size_t>(n), -1);
  count = 0;
  const auto alone = [&](std::int32_t i) { return strong.start[i + 1] - strong.start[i] <= 1; };
  for (std::int32_t i = 0; i < n; ++i) {
    if (of[i] >= 0 || alone(i)) continue;
    bool free = true;
    for (std::int32_t e = strong.start[i]; e < strong.start[i + 1] && free; ++e)
      free = of[strong.column[e]] < 0;
    if (!free) continue;
    for (std::int32_t e = strong.start[i]; e < strong.start[i + 1]; ++e)
      of[strong.column[e]] = count;
    ++count;
  }
  // The others join the aggregate they are coupled to most, as it was after the first pass.
  const std::vector<std::int32_t> first = of;
  for (std::int32_t i = 0; i < n; ++i) {
    if (of[i] >= 0 || alone(i)) continue;
    double most = 0;
    for (std::int32_t e = strong.start[i]; e < strong.start[i + 1]; ++e)
      if (first[strong.column[e]] >= 0 && -strong.value[e] > most) {
        most = -strong.value[e];
        of[i] = first[strong.column[e]];
      }
  }
  for (std::int32_t i = 0; i < n; ++i) {
    if (of[i] >= 0 || alone(i)) continue;
    for (std::int32_t e = strong.start[i]; e < strong.start[i + 1]; ++e)
      if (of[strong.column[e]] < 0) of[strong.column[e]] = count;
    of[i] = count++;
  }
  return of;
}

/// The largest eigenvalue of D^-1 A, by power iteration from a fixed start.
double largest_eigenvalue(const Csr& a, const std::vector<double>& d) {
  const std::size_t n = d.size();
  std::vector<Vec<1>> x(n), y(n);
  std::uint32_t state = 1;
  for (Vec<1>& v : x) {
    state = state * 1664525u + 1013904223u;
    v[0] = static_cast<double>(state >> 8) / (1u << 24) - 0.5;
  }
  double value = 1;
  for (int k = 0; k < 12; ++k) {
    multiply<1>(a, x, y);
    for_blocks(n, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) y[i] /= d[i];
    });
    const auto square = [&](const std::vector<Vec<1>>& v) {
      return block_sum(n, [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += v[i][0] * v[i][0] * d[i];
        return sum;
      });
    };
    const double before = square(x), after = square(y);
    if (!(after > 0)) break;
    value = std::sqrt(after / before);
    const double scale = 1 / std::sqrt(after);
    for_blocks(n, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) x[i] = y[i] * scale;
    });
  }
  return value;
}

/// (I - w D^-1 F) T with the aggregates' own indicator functions T.
Csr prolongator(const Csr& f, const std::vector<std::int32_t>& aggregates, std::int32_t count) {
  Csr t;
  t.columns = count;
  for (const std::int32_t of : aggregates) {
    if (of >= 0) {
      t.column.push_back(of);
      t.value.push_back(1);
    }
    t.start.push_back(static_cast<std::int32_t>(t.column.size()));
  }
  const std::vector<double> d = diagonal(f);
  const double w = 4.0 / 3 / (1.05 * largest_eigenvalue(f, d));
  Csr smooth = f;
  for (std::int32_t i = 0; i < f.rows(); ++i)
    for (std::int32_t e = f.start[i]; e < f.start[i + 1]; ++e)
      smooth.value[e] = (f.column[e] == i ? 1 : 0) - w * f.value[e] / d[i];
  return product(smooth, t);
}

}  // namespace

void Multigrid::finish(Level& level) {
  const auto n = static_cast<std::size_t>(level.a.rows());
  level.block = n <= 4 * kBlock ? std::max<std::size_t>(n, 1) : kBlock;
  level.inverse.resize(n);
  for_blocks(
      n,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          double d = 0, out = 0;
          for (std::int32_t e = level.a.start[i]; e < level.a.start[i + 1]; ++e) {
            const auto j = static_cast<std::size_t>(level.a.column[e]);
            if (j == i) d = level.a.value[e];
            if (j < begin || j >= end) out += std::abs(level.a.value[e]);
          }
          level.inverse[i] = 1 / (d + out);
        }
      },
      level.block);
}

std::optional<Multigrid> Multigrid::build(Csr matrix, const Progress& progress,
                                          std::size_t most_levels) {
  Multigrid out;
  out.levels_.reserve(most_levels);
  out.levels_.emplace_back().a = std::move(matrix);
  while (true) {
    if (progress.cancelled()) return std::nullopt;
    Level& fine = out.levels_.back();
    out.finish(fine);
    const std::int32_t n = fine.a.rows();
    if (n <= kCoarsest || out.levels_.size() == most_levels) break;
    const Csr strong = filtered(fine.a, kStrong);
    std::int32_t count = 0;
    const std::vector<std::int32_t> aggregates = aggregate(strong, count);
    if (count == 0 || count > 0.9 * n) break;
    fine.prolong = prolongator(strong, aggregates, count);
    if (progress.cancelled()) return std::nullopt;
    fine.restrict_to = transpose(fine.prolong);
    Csr coarse = product(fine.restrict_to, product(fine.a, fine.prolong));
    progress.report(1 - static_cast<double>(count) / out.levels_.front().a.rows());
    out.levels_.emplace_back().a = std::move(coarse);
  }
  const Csr& last = out.levels_.back().a;
  if (last.rows() <= 4 * kCoarsest) {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(last.rows(), last.rows());
    for (std::int32_t i = 0; i < last.rows(); ++i)
      for (std::int32_t e = last.start[i]; e < last.start[i + 1]; ++e)
        dense(i, last.column[e]) = last.value[e];
    out.coarsest_.compute(dense);
    out.direct_ = out.coarsest_.info() == Eigen::Success && out.coarsest_.isPositive();
  }
  return out;
}

double Multigrid::complexity() const {
  double sum = 0;
  for (const Level& level : levels_) sum += static_cast<double>(level.a.value.size());
  return sum / static_cast<double>(levels_.front().a.value.size());
}

namespace {

/// Gauss-Seidel within each block, forward from x = 0.
template <int K>
void sweep_forward(const Csr& a, const std::vector<double>& inverse, std::size_t block,
                   const std::vector<Vec<K>>& b, std::vector<Vec<K>>& x) {
  for_blocks(
      b.size(),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          Vec<K> sum = b[i];
          for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
            const auto j = static_cast<std::size_t>(a.column[e]);
            if (j >= i) break;
            if (j >= begin) sum -= a.value[e] * x[j];
          }
          x[i] = inverse[i] * sum;
        }
      },
      block);
}

/// The transposed sweep, backward; other blocks are seen as they were before it.
template <int K>
void sweep_backward(const Csr& a, const std::vector<double>& inverse, std::size_t block,
                    const std::vector<Vec<K>>& b, const std::vector<Vec<K>>& before,
                    std::vector<Vec<K>>& x) {
  for_blocks(
      b.size(),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = end; i-- > begin;) {
          Vec<K> sum = b[i];
          for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
            const auto j = static_cast<std::size_t>(a.column[e]);
            sum -= a.value[e] * (j < begin || j >= end ? before[j] : x[j]);
          }
          x[i] += inverse[i] * sum;
        }
      },
      block);
}

}  // namespace

template <int K>
void Multigrid::solve_coarsest(const std::vector<Vec<K>>& b, std::vector<Vec<K>>& x) {
  Level& level = levels_.back();
  const auto n = static_cast<Eigen::Index>(b.size());
  if (direct_) {
    Eigen::MatrixXd right(n, K);
    for (Eigen::Index i = 0; i < n; ++i) right.row(i) = b[i].transpose();
    const Eigen::MatrixXd found = coarsest_.solve(right);
    for (Eigen::Index i = 0; i < n; ++i) x[i] = found.row(i).transpose();
    return;
  }
  sweep_forward<K>(level.a, level.inverse, level.block, b, x);
  const std::vector<Vec<K>> before = x;
  sweep_backward<K>(level.a, level.inverse, level.block, b, before, x);
}

template <int K>
void Multigrid::cycle(std::size_t at, const std::vector<Vec<K>>& b, std::vector<Vec<K>>& x) {
  if (at + 1 == levels_.size()) return solve_coarsest<K>(b, x);
  Level& level = levels_[at];
  Level& next = levels_[at + 1];
  Work<K>& work = level.template work<K>();
  Work<K>& coarse = next.template work<K>();
  work.r.resize(b.size());
  coarse.b.resize(static_cast<std::size_t>(next.a.rows()));
  coarse.x.resize(coarse.b.size());

  sweep_forward<K>(level.a, level.inverse, level.block, b, x);
  for_blocks(b.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec<K> sum = b[i];
      for (std::int32_t e = level.a.start[i]; e < level.a.start[i + 1]; ++e)
        sum -= level.a.value[e] * x[level.a.column[e]];
      work.r[i] = sum;
    }
  });
  multiply<K>(level.restrict_to, work.r, coarse.b);
  cycle<K>(at + 1, coarse.b, coarse.x);
  for_blocks(b.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec<K> sum = x[i];
      for (std::int32_t e = level.prolong.start[i]; e < level.prolong.start[i + 1]; ++e)
        sum += level.prolong.value[e] * coarse.x[level.prolong.column[e]];
      x[i] = work.r[i] = sum;
    }
  });
  sweep_backward<K>(level.a, level.inverse, level.block, b, work.r, x);
}

template <int K>
void Multigrid::apply(const std::vector<Vec<K>>& b, std::vector<Vec<K>>& x) {
  cycle<K>(0, b, x);
}
template void Multigrid::apply(const std::vector<Vec<1>>&, std::vector<Vec<1>>&);
template void Multigrid::apply(const std::vector<Vec<2>>&, std::vector<Vec<2>>&);
template void Multigrid::apply(const std::vector<Vec<3>>&, std::vector<Vec<3>>&);

}  // namespace lamella::flow
