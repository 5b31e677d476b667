#include "core/natural/spread_metric.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/parallel.h"
#include "core/geometry/bvh.h"
#include "core/metric/intersect.h"

namespace lamella {
namespace {

constexpr double kCell = 0.5;   // of the least size of a level: one sample in each
constexpr double kReach = 0.7;  // of the largest size: as far there is another node

struct Sample {
  Vec<3> at;
  Vec<3> size;  // ascending
  Mat<3> axis;

  static Sample of(const Vec<3>& at, const Metric<3>& metric) {
    const Spectrum<3> s = spectrum<3>(metric);
    Sample out{at, {}, {}};
    for (int k = 0; k < 3; ++k) {
      out.size[k] = 1 / std::sqrt(s.values[2 - k]);
      out.axis.col(k) = s.vectors.col(2 - k);
    }
    return out;
  }
};

enum Rank { middle = 1, largest = 2 };

/// The samples whose sizes of one rank are alike.
struct Level {
  double least = 0;  // mm, that those sizes are not below
  Rank rank = middle;
  std::vector<Sample> samples;
  Bvh<3> tree;
  Bvh<3>::Ref root = Bvh<3>::kNothing;

  double reach(const Sample& s) const { return rank == middle ? kReach * s.size[largest] : 0; }

  /// One sample in each cell, then the tree.
  void close(const Progress& progress) {
    std::set<std::array<std::int64_t, 3>> cells;
    std::erase_if(samples, [&](const Sample& s) {
      std::array<std::int64_t, 3> cell;
      for (int k = 0; k < 3; ++k) cell[k] = std::llround(s.at[k] / (kCell * least));
      return !cells.insert(cell).second;
    });
    std::vector<Box<3>> boxes(samples.size());
    std::vector<std::int32_t> items(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Sample& s = samples[i];
      const Vec<3> half = reach(s) * s.axis.col(largest).cwiseAbs();
      boxes[i] = {s.at - half, s.at + half};
      items[i] = static_cast<std::int32_t>(i);
    }
    tree = Bvh<3>(samples.front().at);
    root = tree.build(boxes, items, progress);
  }

  double distance2(const Sample& s, const Vec<3>& x) const {
    Vec<3> off = s.axis.transpose() * (x - s.at);
    const double along = std::abs(off[largest]), within = std::min(along, reach(s));
    off[largest] = within * s.size[middle] / s.size[largest] + along - within;
    return off.squaredNorm();
  }

  /// The nearest sample below `bound2`, which becomes its distance.
  const Sample* nearest(const Vec<3>& x, double& bound2) const {
    const Sample* best = nullptr;
    tree.near(root, x, bound2, [&](std::int32_t block) {
      for (int k = 0; k < Bvh<3>::kWide; ++k) {
        const auto i = tree.order()[static_cast<std::size_t>(Bvh<3>::kWide * block + k)];
        const Sample& s = samples[static_cast<std::size_t>(i)];
        const double d2 = distance2(s, x);
        if (!(d2 < bound2)) continue;
        bound2 = d2;
        best = &s;
      }
    });
    return best;
  }
};

}  // namespace

struct SpreadMetric::Levels {
  std::vector<Level> list;  // by growing size
  double growth;
};

SpreadMetric SpreadMetric::from(const std::vector<Vec<3>>& points, const MetricField<3>& metrics,
                                const SpreadParams& params, const Progress& progress) {
  std::vector<Sample> samples(points.size());
  SpreadMetric out;
  if (points.size() < 2) return out;
  if (!parallel_each(
          points.size() - 1, params.threads, progress.portion(0, 0.3),
          [&](std::size_t i) { samples[i + 1] = Sample::of(points[i + 1], metrics[i + 1]); }, 64))
    return out;
  std::map<std::array<int, 2>, Level> by_size;
  for (std::size_t i = 1; i < samples.size(); ++i)
    for (const Rank rank : {middle, largest}) {
      const int power = std::ilogb(samples[i].size[rank]);
      Level& level = by_size[{power, rank}];
      level.rank = rank;
      level.least = std::ldexp(1, power);
      level.samples.push_back(samples[i]);
    }
  auto levels = std::make_shared<Levels>(Levels{{}, params.growth});
  for (auto& [key, level] : by_size) levels->list.push_back(std::move(level));
  parallel_each(levels->list.size(), params.threads, progress.portion(0.3, 1),
                [&](std::size_t i) { levels->list[i].close(progress); });
  out.levels_ = std::move(levels);
  return out;
}

Metric<3> SpreadMetric::at(const Metric<3>& metric, const Vec<3>& x) const {
  if (!levels_) return metric;
  const double growth = levels_->growth;
  const double most = 1 / std::sqrt(spectrum<3>(metric).values[0]);
  Metric<3> out = metric;
  for (const Level& level : levels_->list) {
    // Farther away sizes have grown to what there is.
    const double far = (most - level.least) / growth;
    if (!(far > 0)) break;
    double distance2 = far * far;
    const Sample* s = level.nearest(x, distance2);
    if (!s) continue;
    const Vec<3> grown = s->size.array() + growth * std::sqrt(distance2);
    bool asks = false;
    for (int k = 0; k < 3; ++k)
      asks = asks || metric_length<3>(Vec<3>(s->axis.col(k)), out) * grown[k] < 1;
    if (asks) out = intersect<3>(out, metric_from_sizes<3>(s->axis, grown));
  }
  return out;
}

}  // namespace lamella
