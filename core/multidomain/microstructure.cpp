#include "core/multidomain/microstructure.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdio>
#include <numbers>
#include <random>

#include "core/base/parallel.h"

namespace lamella {

namespace {

constexpr int kTries = 20000;  // places tried for one seed or inclusion
constexpr int kShakes = 50;    // moves of all balls to make room for one

/// Chance that is the same everywhere: what the distributions of <random> make of the generator is
/// left to each library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double number(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
  }
  Vec<3> in(const Box<3>& box) {
    Vec<3> x;
    for (int k = 0; k < 3; ++k) x[k] = number(box.lo[k], box.hi[k]);
    return x;
  }
  Vec<3> direction() {
    for (;;) {
      const Vec<3> x = in({Vec<3>::Constant(-1), Vec<3>::Ones()});
      if (const double d = x.norm(); d <= 1 && d > 0.01) return x / d;
    }
  }

 private:
  std::mt19937_64 random_;
};

/// Numbered points of a box, to be found by their place.
class Buckets {
 public:
  Buckets(const Box<3>& box, double side) : low_(box.lo) {
    const Vec<3> extent = (box.hi - box.lo).cwiseMax(1e-300);
    side_ = std::max(side, std::cbrt(extent.prod() / 1e6));
    for (int k = 0; k < 3; ++k)
      count_[k] = std::max(1, static_cast<int>(std::min(1e3, std::ceil(extent[k] / side_))));
    buckets_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
  }
  void add(const Vec<3>& x, std::int32_t id) {
    const auto c = cell(x);
    bucket(c[0], c[1], c[2]).push_back(id);
  }
  void remove(const Vec<3>& x, std::int32_t id) {
    const auto c = cell(x);
    std::erase(bucket(c[0], c[1], c[2]), id);
  }
  /// Calls visit(id) for all points nearer than r and maybe others, until one returns true.
  template <class Visit>
  bool any(const Vec<3>& x, double r, Visit visit) const {
    const auto from = cell(x.array() - r), to = cell(x.array() + r);
    for (int k = from[2]; k <= to[2]; ++k)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i)
          for (const std::int32_t id : bucket(i, j, k))
            if (visit(id)) return true;
    return false;
  }

 private:
  std::array<int, 3> cell(const Vec<3>& x) const {
    std::array<int, 3> c;
    for (int k = 0; k < 3; ++k)
      c[k] =
          static_cast<int>(std::clamp(std::floor((x[k] - low_[k]) / side_), 0.0, count_[k] - 1.0));
    return c;
  }
  const std::vector<std::int32_t>& bucket(int i, int j, int k) const {
    return buckets_[i + count_[0] * (j + static_cast<std::size_t>(count_[1]) * k)];
  }
  std::vector<std::int32_t>& bucket(int i, int j, int k) {
    return buckets_[i + count_[0] * (j + static_cast<std::size_t>(count_[1]) * k)];
  }
  Vec<3> low_;
  double side_;
  std::array<int, 3> count_;
  std::vector<std::vector<std::int32_t>> buckets_;
};

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
  return text;
}

/// A point of the specimen; nothing when chance finds none.
std::optional<Vec<3>> point_in(const Specimen& specimen, const Box<3>& box, Dice& dice) {
  for (int t = 0; t < kTries; ++t)
    if (const Vec<3> x = dice.in(box); specimen.zone->distance(x) < 0) return x;
  return std::nullopt;
}

/// Lloyd's step, the centroids found from points of the specimen.
bool relax(const Specimen& specimen, int threads, std::vector<Vec<3>>& seeds, Dice& dice,
           const Progress& progress) {
  const Box<3> box = specimen.zone->box();
  const double side = std::cbrt(specimen.volume / static_cast<double>(seeds.size()));
  Buckets buckets(box, side);
  for (std::size_t s = 0; s < seeds.size(); ++s)
    buckets.add(seeds[s], static_cast<std::int32_t>(s));
  std::vector<Vec<3>> points;
  while (points.size() < 256 * seeds.size()) {
    const std::optional<Vec<3>> x = point_in(specimen, box, dice);
    if (!x || (points.size() % 4096 == 0 && progress.cancelled())) return false;
    points.push_back(*x);
  }
  std::vector<std::int32_t> owner(points.size());
  const auto find = [&](std::size_t p) {
    for (double r = side;; r *= 2) {
      double best = r;
      std::int32_t nearest = -1;
      buckets.any(points[p], r, [&](std::int32_t s) {
        const double d = (seeds[s] - points[p]).norm();
        if (d < best || (d == best && s < nearest)) best = d, nearest = s;
        return false;
      });
      if (nearest >= 0) {
        owner[p] = nearest;
        return;
      }
    }
  };
  if (!parallel_each(points.size(), threads, progress, find)) return false;
  std::vector<Vec<3>> sum(seeds.size(), Vec<3>::Zero());
  std::vector<int> count(seeds.size(), 0);
  for (std::size_t p = 0; p < points.size(); ++p) {
    sum[owner[p]] += points[p];
    ++count[owner[p]];
  }
  for (std::size_t s = 0; s < seeds.size(); ++s)
    if (count[s]) seeds[s] = sum[s] / count[s];
  return true;
}

/// Amounts that make no sense; nothing when they do.
template <class Options>
std::optional<Error> refuse(const Options& options) {
  const auto bad = [](const char* message) { return Error{Code::bad_input, message, ""}; };
  if (options.count.has_value() == options.fraction.has_value())
    return bad("Either a number of inclusions or their fraction is needed.");
  if (options.count && *options.count < 1) return bad("At least one inclusion is needed.");
  if (options.fraction && !(*options.fraction > 0 && *options.fraction < 1))
    return bad("The fraction of inclusions must be between 0 and 1.");
  if (!(options.gap >= 0)) return bad("The gap between inclusions must not be negative.");
  return std::nullopt;
}

Error no_room(const char* what, std::size_t placed, std::size_t asked, double filled,
              const Specimen& specimen, double wanted) {
  return {Code::bad_input,
          "Only " + std::to_string(placed) + " of " + std::to_string(asked) + " " + what +
              " found room, " + percent(filled / specimen.volume) + " of the volume where " +
              percent(wanted / specimen.volume) + " are asked.",
          placed == 0 ? "Ask for smaller ones, or for a larger specimen."
                      : "Ask for fewer, for a smaller gap or size, or try another seed."};
}

/// Distance of two segments.
double segment_distance(const Vec<3>& p0, const Vec<3>& p1, const Vec<3>& q0, const Vec<3>& q1) {
  const Vec<3> u = p1 - p0, v = q1 - q0, w = p0 - q0;
  const double a = u.squaredNorm(), b = u.dot(v), c = v.squaredNorm(), d = u.dot(w), e = v.dot(w);
  const double det = a * c - b * b;
  double s = det > 1e-12 * a * c ? std::clamp((b * e - c * d) / det, 0.0, 1.0) : 0;
  const double t = std::clamp((b * s + e) / c, 0.0, 1.0);
  s = std::clamp((b * t - d) / a, 0.0, 1.0);
  double best = (w + s * u - t * v).norm();
  // The ends, for the steps above end on a side that parallel segments need not have.
  for (const auto& [x, y, z] : {std::array{p0, q0, q1}, {p1, q0, q1}, {q0, p0, p1}, {q1, p0, p1}}) {
    const double f = std::clamp((x - y).dot(z - y) / (z - y).squaredNorm(), 0.0, 1.0);
    best = std::min(best, (x - y - f * (z - y)).norm());
  }
  return best;
}

/// Mean of p_i^2 of the angular central Gaussian law of the variances b, by the trapezoidal rule
/// in ln t of b_i / 2 int dt / ((1 + b_i t) prod (1 + b_k t)^(1/2)).
Vec<3> mean_squares(const Vec<3>& b) {
  Vec<3> mean = Vec<3>::Zero();
  for (double s = -40; s < 90; s += 0.125) {
    const double t = std::exp(s);
    const Vec<3> f = Vec<3>::Ones() + t * b;
    mean += 0.125 * t / (2 * std::sqrt(f.prod())) * b.cwiseQuotient(f);
  }
  return mean / mean.sum();
}

/// The square root of the law's covariance, for which the mean of p p^T is the tensor.
Mat<3> gaussian_root(const Mat<3>& tensor) {
  const Eigen::SelfAdjointEigenSolver<Mat<3>> eigen(tensor);
  const Vec<3> asked = eigen.eigenvalues().cwiseMax(0.0) / eigen.eigenvalues().cwiseMax(0.0).sum();
  Vec<3> b = asked;
  for (int i = 0; i < 500; ++i) {
    const Vec<3> mean = mean_squares(b);
    for (int k = 0; k < 3; ++k)
      if (mean[k] > 0) b[k] *= asked[k] / mean[k];
    b /= b.maxCoeff();
    if ((mean - asked).cwiseAbs().maxCoeff() < 1e-9) break;
  }
  return eigen.eigenvectors() * b.cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

Specimen box_specimen(const Vec<3>& low, const Vec<3>& high) {
  return {box_zone<3>(low, high), (high - low).prod()};
}
Specimen cylinder_specimen(const Vec<3>& from, const Vec<3>& to, double radius) {
  return {cylinder_zone(from, to, radius), std::numbers::pi * radius * radius * (to - from).norm()};
}

Result<std::vector<Vec<3>>> polycrystal_seeds(const Specimen& specimen,
                                              const PolycrystalOptions& options,
                                              const Progress& progress) {
  if (options.grains < 1 || !(options.spacing >= 0) || options.relaxations < 0)
    return Error{Code::bad_input, "A polycrystal needs at least one grain and no negative spacing.",
                 ""};
  const Box<3> box = specimen.zone->box();
  const double least = options.spacing * std::cbrt(specimen.volume / options.grains);
  Dice dice(options.seed);
  std::vector<Vec<3>> seeds;
  Buckets buckets(box, std::cbrt(specimen.volume / options.grains));
  const Progress placing = progress.portion(0, 1.0 / (1 + options.relaxations));
  while (seeds.size() < static_cast<std::size_t>(options.grains)) {
    if (progress.cancelled()) return cancelled_error();
    bool placed = false;
    for (int t = 0; t < kTries && !placed; ++t) {
      const Vec<3> x = dice.in(box);
      if (!(specimen.zone->distance(x) < 0) ||
          buckets.any(x, least, [&](std::int32_t s) { return (seeds[s] - x).norm() < least; }))
        continue;
      buckets.add(x, static_cast<std::int32_t>(seeds.size()));
      seeds.push_back(x);
      placed = true;
    }
    if (!placed)
      return Error{Code::bad_input,
                   "Only " + std::to_string(seeds.size()) + " of " +
                       std::to_string(options.grains) + " grains found room at that spacing.",
                   "Ask for a smaller spacing, 0.7 or less, and for relaxations instead."};
    placing.report(static_cast<double>(seeds.size()) / options.grains);
  }
  for (int i = 0; i < options.relaxations; ++i)
    if (!relax(specimen, options.threads, seeds, dice,
               progress.portion((1.0 + i) / (1 + options.relaxations),
                                (2.0 + i) / (1 + options.relaxations))))
      return cancelled_error();
  return seeds;
}

Result<std::vector<BallInclusion>> pack_balls(const Specimen& specimen,
                                              const InclusionOptions& options,
                                              const Progress& progress) {
  if (const auto error = refuse(options)) return *error;
  if (!(options.radius_min > 0) || !(options.radius_max >= options.radius_min))
    return Error{Code::bad_input, "The radius of inclusions must be positive, the least first.",
                 ""};
  Dice dice(options.seed);
  const auto volume_of = [](double r) { return 4 * std::numbers::pi / 3 * r * r * r; };
  std::vector<double> radii;
  double wanted = 0;
  for (;;) {
    const double r = dice.number(options.radius_min, options.radius_max);
    if (options.count
            ? static_cast<int>(radii.size()) == *options.count
            : !radii.empty() && wanted + volume_of(r) / 2 > *options.fraction * specimen.volume)
      break;
    if (radii.size() % 4096 == 0 && progress.cancelled()) return cancelled_error();
    radii.push_back(r);
    wanted += volume_of(r);
  }
  std::sort(radii.begin(), radii.end(), std::greater<>());

  const Box<3> box = specimen.zone->box();
  std::vector<BallInclusion> balls;
  Buckets buckets(box, 2 * radii.front() + options.gap);
  const auto fits = [&](const Vec<3>& x, double r, std::int32_t but) {
    return specimen.zone->distance(x) <= -r - options.gap &&
           !buckets.any(x, r + radii.front() + options.gap, [&](std::int32_t b) {
             return b != but && (balls[b].center - x).norm() < balls[b].radius + r + options.gap;
           });
  };
  const auto shake = [&] {
    for (std::size_t b = 0; b < balls.size(); ++b) {
      const auto id = static_cast<std::int32_t>(b);
      Vec<3>& center = balls[b].center;
      const Vec<3> x = center + dice.number(0, balls[b].radius) * dice.direction();
      if (!fits(x, balls[b].radius, id)) continue;
      buckets.remove(center, id);
      buckets.add(x, id);
      center = x;
    }
  };
  double filled = 0;
  for (const double r : radii) {
    bool placed = false;
    for (int round = 0; round <= kShakes && !placed; ++round) {
      if (progress.cancelled()) return cancelled_error();
      if (round > 0) shake();
      for (int t = 0; t < kTries && !placed; ++t) {
        const Vec<3> x = dice.in(box);
        if (!fits(x, r, -1)) continue;
        buckets.add(x, static_cast<std::int32_t>(balls.size()));
        balls.push_back({x, r});
        placed = true;
      }
    }
    if (!placed) return no_room("balls", balls.size(), radii.size(), filled, specimen, wanted);
    filled += volume_of(r);
    progress.report(filled / wanted);
  }
  return balls;
}

Result<std::vector<FiberInclusion>> pack_fibers(const Specimen& specimen,
                                                const FiberOptions& options,
                                                const Progress& progress) {
  if (const auto error = refuse(options)) return *error;
  if (!(options.radius > 0) || !(options.length > 0))
    return Error{Code::bad_input, "The radius and the length of fibers must be positive.", ""};
  const Mat<3>& a = options.orientation;
  const bool tensor = (a - a.transpose()).norm() < 1e-6 && std::abs(a.trace() - 1) < 1e-6 &&
                      Eigen::SelfAdjointEigenSolver<Mat<3>>(a).eigenvalues()[0] > -1e-6;
  if (!tensor)
    return Error{Code::bad_input,
                 "The orientation tensor must be symmetric, of trace 1 and without negative "
                 "eigenvalues.",
                 "All directions alike: 1/3, 1/3, 1/3 on its diagonal; aligned with x: 1, 0, 0."};
  const double volume = std::numbers::pi * options.radius * options.radius * options.length;
  const std::size_t count =
      options.count ? static_cast<std::size_t>(*options.count)
                    : static_cast<std::size_t>(
                          std::max(1.0, std::round(*options.fraction * specimen.volume / volume)));
  const Mat<3> root = gaussian_root(a);
  const Box<3> box = specimen.zone->box();
  const double apart = 2 * options.radius + options.gap;
  Dice dice(options.seed);
  Buckets buckets(box, options.length / 2 + apart);
  std::vector<FiberInclusion> fibers;
  while (fibers.size() < count) {
    if (progress.cancelled()) return cancelled_error();
    const auto placed = static_cast<double>(fibers.size());
    // Another place is tried, not another direction: those that fit easily would be preferred.
    Vec<3> along;
    do along = root * dice.direction();
    while (!(along.norm() > 1e-9));
    const Vec<3> half = options.length / 2 * along.normalized();
    bool found = false;
    for (int t = 0; t < kTries && !found; ++t) {
      const Vec<3> x = dice.in(box), from = x - half, to = x + half;
      const double wall = -options.radius - options.gap;
      if (specimen.zone->distance(from) > wall || specimen.zone->distance(to) > wall ||
          buckets.any(x, options.length + apart, [&](std::int32_t f) {
            return segment_distance(from, to, fibers[f].from, fibers[f].to) < apart;
          }))
        continue;
      buckets.add(x, static_cast<std::int32_t>(fibers.size()));
      fibers.push_back({from, to, options.radius});
      found = true;
    }
    if (!found)
      return no_room("fibers", fibers.size(), count, placed * volume, specimen,
                     static_cast<double>(count) * volume);
    progress.report((placed + 1) / static_cast<double>(count));
  }
  return fibers;
}

std::vector<Region<3>> regions_of(const std::vector<Vec<3>>& grain_seeds) {
  std::vector<Region<3>> regions;
  for (std::size_t s = 0; s < grain_seeds.size(); ++s)
    regions.push_back({"grain " + std::to_string(s + 1), voronoi_zone<3>(grain_seeds, s)});
  return regions;
}

std::vector<Region<3>> regions_of(const std::vector<BallInclusion>& balls) {
  std::vector<Region<3>> regions;
  for (const BallInclusion& ball : balls)
    regions.push_back({"inclusion " + std::to_string(regions.size() + 1),
                       ball_zone<3>(ball.center, ball.radius)});
  return regions;
}

std::vector<Region<3>> regions_of(const std::vector<FiberInclusion>& fibers) {
  std::vector<Region<3>> regions;
  for (const FiberInclusion& fiber : fibers)
    regions.push_back({"fiber " + std::to_string(regions.size() + 1),
                       cylinder_zone(fiber.from, fiber.to, fiber.radius)});
  return regions;
}

}  // namespace lamella
