#include "core/sizing/forecast.h"

#include <algorithm>
#include <atomic>

#include "core/base/parallel.h"
#include "core/optimize/memory_need.h"

namespace lamella {
namespace {

/// In meshes as `adapt` makes them, measured on boxes: elements in the volume of a unit equilateral
/// one (1.03 to 1.12), nodes an element inside, and further nodes in the area of a unit equilateral
/// facet of the boundary.
constexpr double kElements = 1.06;
constexpr double kNodesAnElement = 1 / 5.7;
constexpr double kNodesAFacet = 0.205;

/// A part worth less than this share of the whole is not looked at closer.
constexpr double kShare = 1.0 / 2000;
/// Divisions in a row that change nothing until a part is believed: each goes across another edge.
constexpr int kCalm = 3;

/// Measure in the natural metric, and with the sizing objects.
using Pair = Eigen::Array2d;

/// A simplex of the volume (K = 4) or of the boundary (K = 3).
template <int K>
struct Cell {
  std::array<Vec<3>, K> corners;
  Pair value = Pair::Zero();
  int calm = 0;
};

template <int K>
class Integral {
 public:
  Integral(const MetricFunction<3>& natural, const SizingField& sizing,
           const ForecastParams& params, std::vector<Cell<K>> cells)
      : natural_(natural), sizing_(sizing), params_(params), cells_(std::move(cells)) {}

  /// False when cancelled.
  bool run(const Progress& progress) {
    const std::size_t most = cells_.size() + params_.samples;
    if (!sample(progress.portion(0, 0.4))) return false;
    Pair done = Pair::Zero();
    for (int round = 0; !cells_.empty(); ++round) {
      Pair whole = done;
      for (const Cell<K>& c : cells_) whole += c.value;
      std::vector<Cell<K>> halves;
      const bool enough = samples_ >= most;
      for (const Cell<K>& c : cells_) {
        if (enough || !open(c, whole))
          done += c.value;
        else
          divide(c, halves);
      }
      cells_ = std::move(halves);
      const double left = std::pow(0.8, round);
      if (!sample(progress.portion(1 - 0.6 * left, 1 - 0.48 * left))) return false;
      compare();
    }
    total_ = done;
    return true;
  }

  Pair total() const { return total_; }
  std::size_t samples() const { return samples_; }
  bool bad() const { return bad_; }

 private:
  bool sample(const Progress& progress) {
    samples_ += cells_.size();
    return parallel_each(
        cells_.size(), params_.threads, progress,
        [&](std::size_t i) {
          Cell<K>& c = cells_[i];
          Vec<3> x = Vec<3>::Zero();
          for (const Vec<3>& p : c.corners) x += p / K;
          Eigen::Matrix<double, 3, K - 1> e;
          for (int k = 1; k < K; ++k) e.col(k - 1) = c.corners[k] - c.corners[0];
          const Metric<3> natural = natural_(x), corrected = sizing_.apply(x, natural);
          const auto measure = [&](const Metric<3>& m) {
            const double det = (e.transpose() * m * e).determinant();
            return std::sqrt(std::max(0.0, det)) / factorial(K - 1);
          };
          if (!is_spd<3>(natural)) bad_ = true;
          c.value = {measure(natural), measure(corrected)};
        },
        16);
  }

  bool open(const Cell<K>& c, const Pair& whole) const {
    Box<3> box;
    double longest2 = 0;
    for (int i = 0; i < K; ++i) {
      box.add(c.corners[i]);
      for (int j = 0; j < i; ++j)
        longest2 = std::max(longest2, (c.corners[i] - c.corners[j]).squaredNorm());
    }
    const double detail = 0.5 * sizing_.detail(box);
    return longest2 > detail * detail || (c.calm < kCalm && (c.value > kShare * whole).any());
  }

  /// Halves keep the value of the whole until they are sampled, for `compare`.
  void divide(const Cell<K>& c, std::vector<Cell<K>>& halves) {
    int a = 0, b = 1;
    for (int i = 0; i < K; ++i)
      for (int j = i + 1; j < K; ++j)
        if ((c.corners[i] - c.corners[j]).squaredNorm() >
            (c.corners[a] - c.corners[b]).squaredNorm()) {
          a = i;
          b = j;
        }
    const Vec<3> middle = 0.5 * (c.corners[a] + c.corners[b]);
    for (const int moved : {a, b}) {
      halves.push_back(c);
      halves.back().corners[moved] = middle;
    }
    before_.push_back(c.value);
  }

  void compare() {
    for (std::size_t i = 0; i < before_.size(); ++i) {
      Cell<K>&one = cells_[2 * i], &other = cells_[2 * i + 1];
      const Pair change = (one.value + other.value - before_[i]).abs();
      const int calm = (change <= params_.tolerance * before_[i]).all() ? one.calm + 1 : 0;
      one.calm = other.calm = calm;
    }
    before_.clear();
  }

  const MetricFunction<3>& natural_;
  const SizingField& sizing_;
  const ForecastParams& params_;
  std::vector<Cell<K>> cells_;
  std::vector<Pair> before_;  ///< [pair of halves]
  Pair total_ = Pair::Zero();
  std::size_t samples_ = 0;
  std::atomic<bool> bad_ = false;
};

/// From the measures in the metric.
MeshForecast forecast_of(double volume, double area) {
  MeshForecast f;
  f.elements = kElements * volume / unit_simplex_measure(3);
  f.nodes = kNodesAnElement * f.elements + kNodesAFacet * area / unit_simplex_measure(2);
  f.memory = 1e-6 * bytes_an_element<3> * f.elements;
  return f;
}

template <int K, class List>
std::vector<Cell<K>> cells_of(const SimplexMesh<3>& mesh, const List& list) {
  std::vector<Cell<K>> cells(list.size());
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i].corners = mesh.corners(list[i]);
  return cells;
}

}  // namespace

Result<SizingForecast> forecast_mesh(const SimplexMesh<3>& mesh, const MetricFunction<3>& natural,
                                     const SizingField& sizing, const ForecastParams& params,
                                     const Progress& progress) {
  if (mesh.elements.empty())
    return Error{Code::bad_input, "The mesh to forecast from has no elements.", ""};
  Integral<4> volume(natural, sizing, params, cells_of<4>(mesh, mesh.elements));
  if (!volume.run(progress.portion(0, 0.6, "forecast"))) return cancelled_error();
  Integral<3> area(natural, sizing, params, cells_of<3>(mesh, mesh.facets));
  if (!area.run(progress.portion(0.6, 1, "forecast"))) return cancelled_error();
  if (volume.bad() || area.bad())
    return Error{Code::bad_input, "The metric to forecast from is not positive definite.",
                 "Sizes must be positive and finite in every direction."};
  SizingForecast out;
  out.natural = forecast_of(volume.total()[0], area.total()[0]);
  out.corrected = forecast_of(volume.total()[1], area.total()[1]);
  out.samples = volume.samples() + area.samples();
  progress.report(1);
  return out;
}

}  // namespace lamella
