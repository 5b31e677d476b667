#include "core/multidomain/overlap.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"

namespace lamella {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// More cells than this are not looked at in a level: what touches all over is told as finely as
/// that, with its error.
constexpr std::size_t kMostCells = 300000;

/// What is less than zero where the condition holds, about a point; 1-Lipschitz.
struct Condition {
  double value;
  Vec<3> gradient;
};

/// The share of a tetrahedron in which all linear conditions from number k on, given by their
/// values at its vertices, are negative.
template <std::size_t N>
double share_below(const std::array<std::array<double, N>, 4>& v, std::size_t k,
                   std::size_t count) {
  for (; k < count; ++k) {
    std::array<int, 4> order{0, 1, 2, 3};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return v[i][k] < v[j][k]; });
    const auto below =
        std::count_if(order.begin(), order.end(), [&](int i) { return v[i][k] < 0; });
    if (below == 0) return 0;
    if (below == 4) continue;
    const auto cut = [&](int i, int j) {
      const auto &p = v[order[i]], &q = v[order[j]];
      const double t = p[k] / (p[k] - q[k]);
      std::array<double, N> at;
      for (std::size_t c = 0; c < count; ++c) at[c] = p[c] + t * (q[c] - p[c]);
      return std::pair(at, t);
    };
    const auto& a = v[order[0]];
    const auto& b = v[order[1]];
    const auto& c = v[order[2]];
    if (below == 1) {
      const auto [p, s] = cut(0, 1);
      const auto [q, t] = cut(0, 2);
      const auto [r, u] = cut(0, 3);
      return s * t * u * share_below<N>({a, p, q, r}, k + 1, count);
    }
    if (below == 3) {
      // The prism a b c, p q r, with p on a d and so on.
      const auto [p, s] = cut(0, 3);
      const auto [q, t] = cut(1, 3);
      const auto [r, u] = cut(2, 3);
      return u * share_below<N>({a, b, c, r}, k + 1, count) +
             t * (1 - u) * share_below<N>({a, b, q, r}, k + 1, count) +
             s * (1 - t) * (1 - u) * share_below<N>({a, p, q, r}, k + 1, count);
    }
    // The prism of the edge a b and the quadrilateral across it.
    const auto [p, s] = cut(0, 2);
    const auto [q, t] = cut(0, 3);
    const auto [r, u] = cut(1, 2);
    const auto [w, z] = cut(1, 3);
    return s * t * share_below<N>({a, p, q, b}, k + 1, count) +
           t * u * (1 - s) * share_below<N>({p, q, b, r}, k + 1, count) +
           (1 - t) * u * z * share_below<N>({q, b, r, w}, k + 1, count);
  }
  return 1;
}

/// The share of a box of half sides `half` in which all conditions hold, each taken as linear.
template <std::size_t N>
double share_of_box(const std::array<Condition, N>& conditions, std::size_t count,
                    const Vec<3>& half) {
  std::array<std::array<double, N>, 8> corner;
  for (int c = 0; c < 8; ++c) {
    const Vec<3> to(c & 1 ? half[0] : -half[0], c & 2 ? half[1] : -half[1],
                    c & 4 ? half[2] : -half[2]);
    for (std::size_t k = 0; k < count; ++k)
      corner[c][k] = conditions[k].value + conditions[k].gradient.dot(to);
  }
  double share = 0;
  for (const auto& [i, j] : {std::pair(1, 3), {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}})
    share += share_below<N>({corner[0], corner[i], corner[j], corner[7]}, 0, count) / 6;
  return share;
}

/// One volume to be found.
struct Job {
  enum class Kind { overlap, outside, gap } kind = Kind::overlap;
  int first = 0, second = 0;  // outside: what of the second is not in the first
  Box<3> box;
  std::vector<int> others{};  // third bodies about a gap

  Vec<3> half = Vec<3>::Zero();  // half sides of the cells of this level
  double volume = 0, before = 0, error = 0, width = 0, inside = 0, inside_width = 0;
  double score = -kInfinity;
  Vec<3> place = Vec<3>::Zero();
  bool done = false;
};

struct Cell {
  std::int32_t job;
  Vec<3> center;
};

struct Finding {
  bool open = false;   // to be cut again
  bool whole = false;  // wholly inside
  double share = 0, width = 0;
  double score = -kInfinity;
  Vec<3> place = Vec<3>::Zero();
};

class Finder {
 public:
  Finder(const Partition<3>& partition, double gap_width)
      : partition_(partition), gap_width_(gap_width) {}

  Finding look(const Job& job, const Cell& cell) const {
    const At at = look_at(job, cell.center);
    const double radius = job.half.norm();
    Finding found;
    const double worst = at.worst();
    if (worst >= radius) return found;
    found.whole = worst <= -radius;
    found.open = !found.whole;
    found.share = found.whole ? 1 : share_of_box(at.conditions, at.count, job.half);
    if (!at.facing) found.share = 0;
    found.width = at.width;
    if (found.share == 0) return found;
    found.score = at.score(job);
    found.place = cell.center;
    // Between two planes the best point is midway.
    const Condition &p = at.conditions[0], &q = at.conditions[1];
    const Vec<3> across = q.gradient - p.gradient;
    const Vec<3> step = (p.value - q.value) / std::max(across.squaredNorm(), 1e-12) * across;
    const bool within = (step.cwiseAbs() - job.half).maxCoeff() <= 0;
    if (within && at.promise(job) > std::max(found.score, job.score)) {
      const double there = look_at(job, cell.center + step).score(job);
      if (there > found.score) found.score = there, found.place = cell.center + step;
    }
    return found;
  }

  /// Walks from the best point found to the best one near it.
  void climb(Job& job) const {
    const double end = 1e-6 * (job.box.hi - job.box.lo).norm();
    for (double step = job.half.maxCoeff(); step > end;) {
      const Vec<3> from = job.place;
      for (int k = 0; k < 6; ++k) {
        const Vec<3> x = from + (k % 2 ? step : -step) * Vec<3>::Unit(k / 2);
        if ((x - job.box.lo).minCoeff() < 0 || (job.box.hi - x).minCoeff() < 0) continue;
        const double score = look_at(job, x).score(job);
        if (score > job.score) job.score = score, job.place = x;
      }
      if (job.place == from) step /= 2;
    }
  }

 private:
  struct At {
    std::array<Condition, 4> conditions;
    std::size_t count = 2;
    bool facing = true;
    double width = 0;

    double worst() const {
      double most = -kInfinity;
      for (std::size_t k = 0; k < count; ++k) most = std::max(most, conditions[k].value);
      return most;
    }
    /// Of an overlap its depth, of a gap how narrow it is; nothing for a point that is in none.
    double score(const Job& job) const {
      if (!(worst() < 0) || !facing) return -kInfinity;
      return job.kind == Job::Kind::gap ? -width : -worst();
    }
    /// The score to expect between the planes seen from here.
    double promise(const Job& job) const {
      return job.kind == Job::Kind::gap ? -width : -(conditions[0].value + conditions[1].value) / 2;
    }
  };

  At look_at(const Job& job, const Vec<3>& x) const {
    const ZoneDistance<3> a = partition_.zone(job.first).at(x);
    const ZoneDistance<3> b = partition_.zone(job.second).at(x);
    At at;
    if (job.kind != Job::Kind::gap) {
      const double sign = job.kind == Job::Kind::outside ? -1 : 1;
      at.conditions[0] = {sign * a.distance, sign * a.normal};
      at.conditions[1] = {b.distance, b.normal};
      return at;
    }
    at.conditions[0] = {-a.distance, -a.normal};
    at.conditions[1] = {-b.distance, -b.normal};
    at.width = a.distance + b.distance;
    at.conditions[2] = {(at.width - gap_width_) / 2, (a.normal + b.normal) / 2};
    at.count = 3;
    at.facing = a.normal.dot(b.normal) < 0;
    ZoneDistance<3> third;
    for (const int other : job.others)
      if (const ZoneDistance<3> next = partition_.zone(other).at(x); next.distance < third.distance)
        third = next;
    if (third.distance < kInfinity) {
      const ZoneDistance<3>& far = a.distance > b.distance ? a : b;
      at.conditions[3] = {(far.distance - third.distance) / 2, (far.normal - third.normal) / 2};
      at.count = 4;
    }
    return at;
  }

  const Partition<3>& partition_;
  double gap_width_;
};

Box<3> common(const Box<3>& a, const Box<3>& b) {
  return {a.lo.cwiseMax(b.lo), a.hi.cwiseMin(b.hi)};
}
Box<3> grown(const Box<3>& box, double by) { return {box.lo.array() - by, box.hi.array() + by}; }
bool has_volume(const Box<3>& box) { return ((box.hi - box.lo).array() > 0).all(); }
bool holds(const Box<3>& outer, const Box<3>& inner) {
  const double slack = 1e-9 * (inner.hi - inner.lo).norm();
  return (inner.lo - outer.lo).minCoeff() >= -slack && (outer.hi - inner.hi).minCoeff() >= -slack;
}

/// Pairs of boxes that meet, by a sweep along x; sorted.
std::vector<std::array<int, 2>> meeting(const std::vector<Box<3>>& boxes) {
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::pair(boxes[a].lo[0], a) < std::pair(boxes[b].lo[0], b);
  });
  std::vector<int> active;
  std::vector<std::array<int, 2>> pairs;
  for (const int next : order) {
    std::erase_if(active, [&](int k) { return boxes[k].hi[0] <= boxes[next].lo[0]; });
    for (const int k : active)
      if (has_volume(common(boxes[k], boxes[next])))
        pairs.push_back({std::min(k, next), std::max(k, next)});
    active.push_back(next);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Halves the sides of a job's cells that are among the long ones; how often along each axis.
std::array<int, 3> halve(Job& job) {
  std::array<int, 3> cuts{1, 1, 1};
  const double longest = job.half.maxCoeff();
  for (int k = 0; k < 3; ++k)
    if (job.half[k] > 0.7 * longest) {
      cuts[k] = 2;
      job.half[k] /= 2;
    }
  return cuts;
}

/// Tells whether the job is settled, after a level.
void settle(Job& job, const OverlapOptions& options) {
  const Vec<3> sides = job.box.hi - job.box.lo;
  const double longest = sides.maxCoeff(), side = 2 * job.half.maxCoeff();
  double coarsest = longest / 32, finest = longest / 1024, small = 1e-2 * sides.prod();
  if (job.kind == Job::Kind::gap) {
    coarsest = std::min(coarsest, options.gap_width);
    finest = std::max(finest, options.gap_width / 4);
    small = 0.1 * options.gap_width * sides.prod() / sides.minCoeff();
  }
  job.error = std::abs(job.volume - job.before);
  const bool close = job.error <= options.tolerance * std::max(job.volume, small);
  // Planes seen from where three bodies meet seem to overlap: no point of it is ever found.
  const bool seeming = job.score == -kInfinity && side <= coarsest / 2;
  job.done = (side <= coarsest && close) || seeming || side <= finest;
}

/// Measures all jobs at once, level by level. False when cancelled.
bool measure(std::vector<Job>& jobs, const Finder& finder, const OverlapOptions& options,
             const Progress& progress) {
  std::vector<Cell> cells;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    jobs[j].half = (jobs[j].box.hi - jobs[j].box.lo) / 2;
    cells.push_back({static_cast<std::int32_t>(j), (jobs[j].box.lo + jobs[j].box.hi) / 2});
  }
  std::vector<Finding> found;
  for (double begin = 0; !cells.empty(); begin += (1 - begin) / 3) {
    found.assign(cells.size(), {});
    if (!parallel_each(
            cells.size(), options.threads, progress.portion(begin, begin + (1 - begin) / 3),
            [&](std::size_t c) { found[c] = finder.look(jobs[cells[c].job], cells[c]); }))
      return false;
    for (Job& job : jobs)
      if (!job.done) {
        job.before = job.volume;
        job.volume = job.inside;
        job.width = job.inside_width;
      }
    for (std::size_t c = 0; c < cells.size(); ++c) {
      Job& job = jobs[cells[c].job];
      const double volume = found[c].share * 8 * job.half.prod();
      job.volume += volume;
      job.width += volume * found[c].width;
      if (found[c].whole) {
        job.inside += volume;
        job.inside_width += volume * found[c].width;
      }
      if (found[c].score > job.score) job.score = found[c].score, job.place = found[c].place;
    }
    for (Job& job : jobs)
      if (!job.done) settle(job, options);
    std::vector<std::array<int, 3>> cuts(jobs.size());
    for (std::size_t j = 0; j < jobs.size(); ++j)
      if (!jobs[j].done) cuts[j] = halve(jobs[j]);
    std::vector<Cell> next;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const Job& job = jobs[cells[c].job];
      if (!found[c].open || job.done) continue;
      const auto& n = cuts[cells[c].job];
      for (int i = 0; i < n[0] * n[1] * n[2]; ++i) {
        const std::array<int, 3> at{i % n[0], i / n[0] % n[1], i / n[0] / n[1]};
        Cell child = cells[c];
        for (int k = 0; k < 3; ++k)
          child.center[k] += n[k] == 1 ? 0 : (at[k] ? job.half[k] : -job.half[k]);
        next.push_back(child);
      }
    }
    if (next.size() > kMostCells) break;
    cells = std::move(next);
  }
  return true;
}

}  // namespace

Result<OverlapReport> find_overlaps(const Partition<3>& partition, const OverlapOptions& options,
                                    const Progress& progress) {
  const int bodies = partition.background();
  std::vector<Box<3>> boxes, near;
  for (int k = 0; k < bodies; ++k) {
    boxes.push_back(partition.box(k));
    if (options.within) boxes.back() = common(boxes.back(), *options.within);
    if (has_volume(boxes.back()) && !(boxes.back().hi - boxes.back().lo).allFinite())
      return Error{Code::bad_input, "The zone \"" + partition.names()[k] + "\" has no end.",
                   "Give a domain in which overlaps are looked for."};
    near.push_back(has_volume(boxes.back()) ? grown(boxes.back(), options.gap_width)
                                            : boxes.back());
    if (options.within) near.back() = common(near.back(), *options.within);
  }
  std::vector<Job> jobs;
  for (const auto& [a, b] : meeting(boxes))
    jobs.push_back({Job::Kind::overlap, a, b, common(boxes[a], boxes[b])});
  if (options.gap_width > 0) {
    const std::vector<std::array<int, 2>> close = meeting(near);
    std::vector<std::vector<int>> neighbors(static_cast<std::size_t>(bodies));
    for (const auto& [a, b] : close) {
      neighbors[a].push_back(b);
      neighbors[b].push_back(a);
    }
    for (const auto& [a, b] : close) {
      Job job{Job::Kind::gap, a, b, common(near[a], near[b])};
      for (const int other : neighbors[a])
        if (other != b && has_volume(common(near[other], job.box))) job.others.push_back(other);
      jobs.push_back(std::move(job));
    }
  }
  const Finder finder(partition, options.gap_width);
  if (!measure(jobs, finder, options, progress.portion(0, 0.7))) return cancelled_error();
  if (!parallel_each(
          jobs.size(), options.threads, progress.portion(0.7, 0.75),
          [&](std::size_t j) {
            if (jobs[j].score > -kInfinity) finder.climb(jobs[j]);
          },
          1))
    return cancelled_error();

  OverlapReport report;
  std::vector<Job> rest;
  std::vector<std::size_t> pair;  // of each of them
  for (const Job& job : jobs) {
    const double size = (job.box.hi - job.box.lo).norm();
    if (!(job.score > -kInfinity && job.volume > 0)) continue;
    if (job.kind == Job::Kind::gap) {
      if (-job.score > 1e-9 * size)
        report.gaps.push_back({job.first, job.second, job.volume, job.error, job.width / job.volume,
                               -job.score, job.place});
      continue;
    }
    if (!(job.score > std::max(options.contact, 1e-9 * size))) continue;
    for (const auto& [outer, inner] : {std::pair(job.first, job.second), {job.second, job.first}})
      if (holds(boxes[outer], boxes[inner])) {
        rest.push_back({Job::Kind::outside, outer, inner, boxes[inner]});
        pair.push_back(report.overlaps.size());
      }
    report.overlaps.push_back(
        {job.first, job.second, job.volume, job.error, job.place, job.score, {}});
  }
  if (!measure(rest, finder, options, progress.portion(0.75, 1))) return cancelled_error();
  for (std::size_t j = 0; j < rest.size(); ++j) {
    Overlap& overlap = report.overlaps[pair[j]];
    const bool sticks_out =
        rest[j].score > options.contact && rest[j].volume > options.tolerance * overlap.volume;
    if (!sticks_out && !overlap.inner) overlap.inner = rest[j].second;
  }
  return report;
}

}  // namespace lamella
