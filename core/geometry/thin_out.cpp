#include "core/geometry/thin_out.h"

#include <algorithm>

#include "core/geometry/foot.h"
#include "core/geometry/self_intersection.h"

namespace lamella {
namespace {

using Facet = std::array<std::int32_t, 3>;

/// Shortest height over longest edge.
double slimness(const std::array<Vec<3>, 3>& p) {
  const double longest = std::max(
      {(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
  return longest > 0 ? facet_normal<3>(p).norm() / longest : 0;
}

class Thinner {
 public:
  Thinner(Triangles& t, const ThinOutParams& params, const std::vector<char>& locked)
      : t_(t),
        params_(params),
        locked_(locked),
        error_(t.points.size(), 0),
        around_(t.points.size()),
        alive_(t.facets.size(), 1) {
    for (std::size_t f = 0; f < t.facets.size(); ++f)
      for (const std::int32_t v : t.facets[f]) around_[v].push_back(static_cast<std::int32_t>(f));
  }

  void run(const Progress& progress) {
    for (int pass = 0; pass < 12; ++pass) {
      std::size_t gone = 0;
      for (std::size_t v = 0; v < around_.size(); ++v) {
        if (v % 1024 == 0 && progress.cancelled()) return finish();
        gone += remove(static_cast<std::int32_t>(v)) ? 1 : 0;
      }
      progress.report((pass + 1) / 12.0);
      if (gone * 100 < around_.size()) break;
    }
    finish();
  }

 private:
  void finish() {
    std::size_t f = 0;
    std::erase_if(t_.facets, [&](const Facet&) { return !alive_[f++]; });
  }

  void neighbors_of(std::int32_t v, std::vector<std::int32_t>& out) const {
    out.clear();
    for (const std::int32_t f : around_[v])
      for (const std::int32_t w : t_.facets[f])
        if (w != v) out.push_back(w);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
  }

  bool remove(std::int32_t v) {
    if (locked_[v] || around_[v].size() < 3) return false;
    neighbors_of(v, ring_);
    if (ring_.size() != around_[v].size()) return false;
    std::int32_t best = -1;
    double best_worst = 0, best_error = 0, worst_before = 1;
    for (const std::int32_t f : around_[v])
      worst_before = std::min(worst_before, slimness(t_.corners(f)));
    for (const std::int32_t to : ring_) {
      double worst = 0, error = 0;
      if (!allowed(v, to, worst, error)) continue;
      if (worst < std::min(1.0 / 12, worst_before)) continue;
      if (worst > best_worst) {
        best = to;
        best_worst = worst;
        best_error = error;
      }
    }
    if (best < 0) return false;
    for (const std::int32_t f : around_[v]) {
      Facet& facet = t_.facets[f];
      if (std::find(facet.begin(), facet.end(), best) != facet.end()) {
        alive_[f] = 0;
        for (const std::int32_t w : facet)
          if (w != v) std::erase(around_[w], f);
      } else {
        std::replace(facet.begin(), facet.end(), v, best);
        around_[best].push_back(f);
      }
    }
    error_[best] = std::max(error_[best], best_error);
    for (const std::int32_t w : ring_) error_[w] = std::max(error_[w], best_error);
    around_[v].clear();
    return true;
  }

  bool allowed(std::int32_t v, std::int32_t to, double& worst, double& error) {
    neighbors_of(to, other_);
    int common = 0;
    for (const std::int32_t w : ring_)
      common += std::binary_search(other_.begin(), other_.end(), w) ? 1 : 0;
    if (common != 2) return false;
    // Two vertices of three facets each that share them: a tetrahedron would fold flat.
    if (ring_.size() + other_.size() <= 7) return false;
    worst = 1;
    double off = 1e300;
    const Vec<3>& x = t_.points[v];
    for (const std::int32_t f : around_[v]) {
      const Facet& facet = t_.facets[f];
      if (std::find(facet.begin(), facet.end(), to) != facet.end()) continue;
      const auto before = t_.corners(f);
      auto after = before;
      for (int k = 0; k < 3; ++k)
        if (facet[k] == v) after[k] = t_.points[to];
      const Vec<3> n = facet_normal<3>(before), m = facet_normal<3>(after);
      if (n.dot(m) <= 0.5 * n.norm() * m.norm()) return false;
      worst = std::min(worst, slimness(after));
      off = std::min(off, (foot_on_facet(after, x).point - x).norm());
      // The middle of each old facet must stay near too: an edge beside v must not be cut off.
      const Vec<3> middle = (before[0] + before[1] + before[2]) / 3;
      const double tilt = std::abs(m.stableNormalized().dot(middle - after[0]));
      if (tilt > params_.tolerance) return false;
    }
    if (params_.longest > 0)
      for (const std::int32_t w : ring_)
        if ((t_.points[w] - t_.points[to]).squaredNorm() > params_.longest * params_.longest)
          return false;
    error = error_[v] + off;
    return error <= params_.tolerance;
  }

  Triangles& t_;
  const ThinOutParams& params_;
  const std::vector<char>& locked_;
  std::vector<double> error_;  // mm that the surface around a vertex may already be off
  std::vector<std::vector<std::int32_t>> around_;
  std::vector<char> alive_;
  std::vector<std::int32_t> ring_, other_;
};

}  // namespace

void thin_out(Triangles& surface, const ThinOutParams& params, const Progress& progress) {
  std::vector<char> locked(surface.points.size(), 0);
  constexpr int kTries = 4;
  for (int k = 0; k < kTries; ++k) {
    Triangles trial = surface;
    Thinner(trial, params, locked).run(progress);
    if (progress.cancelled()) return;
    const auto pairs = self_intersecting_pairs(trial.points, trial.facets, progress);
    if (progress.cancelled()) return;
    if (pairs.empty()) {
      surface = std::move(trial);
      return;
    }
    // Around what crosses now everything stays as it was.
    for (const auto& pair : pairs)
      for (const std::int32_t f : pair)
        for (const std::int32_t v : trial.facets[f]) locked[v] = 1;
    for (int ring = 0; ring < 3; ++ring) {
      std::vector<char> wider = locked;
      for (const Facet& f : surface.facets)
        if (locked[f[0]] || locked[f[1]] || locked[f[2]])
          for (const std::int32_t v : f) wider[v] = 1;
      locked = std::move(wider);
    }
  }
}

}  // namespace lamella
