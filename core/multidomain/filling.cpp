#include "core/multidomain/filling.h"

#include <algorithm>
#include <limits>
#include <span>

#include "core/base/parallel.h"

namespace lamella {

namespace {

constexpr std::size_t kChunk = 2048;  // elements or nodes whose lists are made together

/// Signed distances that may matter in the elements of one node.
struct Near {
  std::int32_t zone = 0;
  bool covers = false;  ///< every element of the node lies inside
  double distance = 0;
};

/// Lists of many items one behind the other.
template <class Item>
struct Lists {
  std::vector<std::uint32_t> first{0};
  std::vector<Item> items;

  std::span<const Item> of(std::size_t i) const {
    return std::span(items).subspan(first[i], first[i + 1] - first[i]);
  }
};

/// Lists for i in [0, count), each made by append(i, list) alone, in parallel by chunks.
template <class Item, class Append>
bool make_lists(std::size_t count, int threads, const Progress& progress, Lists<Item>& lists,
                Append append) {
  const std::size_t chunks = (count + kChunk - 1) / kChunk;
  std::vector<std::vector<Item>> parts(chunks);
  lists.first.assign(count + 1, 0);
  const bool whole = parallel_each(
      chunks, threads, progress,
      [&](std::size_t c) {
        for (std::size_t i = c * kChunk; i < std::min(count, (c + 1) * kChunk); ++i) {
          const std::size_t before = parts[c].size();
          append(i, parts[c]);
          lists.first[i + 1] = static_cast<std::uint32_t>(parts[c].size() - before);
        }
      },
      1);
  if (!whole) return false;
  for (std::size_t i = 0; i < count; ++i) lists.first[i + 1] += lists.first[i];
  lists.items.reserve(lists.first.back());
  for (std::vector<Item>& part : parts) {
    lists.items.insert(lists.items.end(), part.begin(), part.end());
    std::vector<Item>().swap(part);
  }
  return true;
}

/// [node] longest edge of its elements, mm.
template <int D>
std::vector<double> reach_of_nodes(const SimplexMesh<D>& mesh) {
  std::vector<double> reach(mesh.points.size(), 0);
  for (const auto& e : mesh.elements)
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j) {
        const double length = (mesh.points[e[i]] - mesh.points[e[j]]).norm();
        reach[e[i]] = std::max(reach[e[i]], length);
        reach[e[j]] = std::max(reach[e[j]], length);
      }
  return reach;
}

/// Shares of the few zones that may cross one element. Keeps its memory from element to element.
template <int D>
class Divider {
 public:
  /// `near[v]` is the list of the corner v. Appends the shares.
  void divide(const Partition<D>& partition, int depth, const std::array<Vec<D>, D + 1>& corners,
              const std::array<std::span<const Near>, D + 1>& near, std::vector<Share>& shares) {
    // What covers the elements of one corner covers this one and hides all that come behind.
    std::int32_t cover = partition.background();
    for (const auto& list : near)
      if (!list.empty() && list.back().covers) cover = std::min(cover, list.back().zone);
    partition_ = &partition;
    zones_.clear();
    levels_.resize(static_cast<std::size_t>(depth) + 1);
    levels_[0].clear();
    for (const Near& item : near[0]) {
      if (item.zone >= cover) break;
      Values d;
      if (!everywhere(item.zone, near, d)) continue;
      zones_.push_back(item.zone);
      levels_[0].push_back(d);
    }
    if (zones_.empty()) {
      shares.push_back({cover, 1});
      return;
    }
    taken_.assign(zones_.size(), 0);
    cut(corners, 0, 1);
    double before = 0;
    const auto add = [&](std::int32_t zone, double until) {
      if (until - before < kNothing) return;
      shares.push_back({zone, static_cast<float>(until - before)});
      before = until;
    };
    for (std::size_t z = 0; z < zones_.size(); ++z) add(zones_[z], taken_[z]);
    add(cover, 1);
    if (before == 0) shares.push_back({cover, 1});
  }

 private:
  using Values = std::array<double, D + 1>;
  static constexpr double kNothing = 1e-7;  // shares below are rounding

  /// A zone that is missing at one corner does not reach the element.
  static bool everywhere(std::int32_t zone, const std::array<std::span<const Near>, D + 1>& near,
                         Values& distances) {
    for (int v = 0; v <= D; ++v) {
      const auto at = std::find_if(near[v].begin(), near[v].end(),
                                   [&](const Near& other) { return other.zone == zone; });
      if (at == near[v].end()) return false;
      distances[v] = at->distance;
    }
    return true;
  }

  /// Adds to taken_[z] what zones 0..z cover of the piece, whose share of the element is `share`
  /// and whose distances are those of the level.
  void cut(const std::array<Vec<D>, D + 1>& p, std::size_t level, double share) {
    int a = 0, b = 1;
    double longest = 0;
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j)
        if (const double l = (p[i] - p[j]).squaredNorm(); l > longest) {
          longest = l;
          a = i;
          b = j;
        }
    longest = std::sqrt(longest);
    const std::size_t m = zones_.size();
    if (level + 1 < levels_.size() && crossed(levels_[level], longest)) {
      const Vec<D> middle = (p[a] + p[b]) / 2;
      std::vector<Values>& half = levels_[level + 1];
      half.resize(m);
      for (std::size_t z = 0; z < m; ++z) {
        half[z] = levels_[level][z];
        half[z][a] = partition_->zone(zones_[z]).distance(middle);
      }
      std::array<Vec<D>, D + 1> q = p;
      q[a] = middle;
      cut(q, level + 1, share / 2);
      for (std::size_t z = 0; z < m; ++z) {
        // The half below has not touched the value at the middle.
        const double there = half[z][a];
        half[z] = levels_[level][z];
        half[z][b] = there;
      }
      q = p;
      q[b] = middle;
      cut(q, level + 1, share / 2);
      return;
    }
    Values over;
    over.fill(std::numeric_limits<double>::infinity());
    for (std::size_t z = 0; z < m; ++z) {
      for (int v = 0; v <= D; ++v) over[v] = std::min(over[v], levels_[level][z][v]);
      taken_[z] += share * negative_share<D>(over);
    }
  }

  /// Whether the border of a zone that is not hidden may cross a piece with this longest edge.
  static bool crossed(const std::vector<Values>& values, double longest) {
    for (const Values& d : values) {
      const auto decides = [&](double x) { return std::abs(x) >= longest; };
      if (std::none_of(d.begin(), d.end(), decides)) return true;
      if (d[0] < 0) return false;
    }
    return false;
  }

  const Partition<D>* partition_ = nullptr;
  std::vector<std::int32_t> zones_;
  std::vector<std::vector<Values>> levels_;  // [level][zone]
  std::vector<double> taken_;                // [zone] by it and those before
};

}  // namespace

double Filling::ratio(std::size_t element, std::int32_t region) const {
  for (std::uint32_t s = first[element]; s < first[element + 1]; ++s)
    if (shares[s].region == region) return shares[s].ratio;
  return 0;
}

std::size_t Filling::mixed_count() const {
  std::size_t count = 0;
  for (std::size_t e = 0; e + 1 < first.size(); ++e) count += mixed(e);
  return count;
}

std::int32_t Filling::main_region(std::size_t element) const {
  std::uint32_t best = first[element];
  for (std::uint32_t s = best; s < first[element + 1]; ++s)
    if (shares[s].ratio > shares[best].ratio) best = s;
  return shares[best].region;
}

template <int D>
double negative_share(std::array<double, D + 1> s) {
  std::sort(s.begin(), s.end());
  int negative = 0;
  while (negative <= D && s[negative] < 0) ++negative;
  if (negative == 0) return 0;
  if (negative == D + 1) return 1;
  // Of the edge from corner i (negative) to corner j the part t_ij = s_i / (s_i - s_j) is negative.
  const auto t = [&](int i, int j) { return s[i] / (s[i] - s[j]); };
  if (negative == 1) {
    double share = 1;
    for (int j = 1; j <= D; ++j) share *= t(0, j);
    return share;
  }
  if (negative == D) {
    double share = 1;
    for (int j = 0; j < D; ++j) share *= 1 - t(j, D);
    return 1 - share;
  }
  return t(0, 2) * t(0, 3) + t(0, 2) * t(1, 3) * (1 - t(0, 3)) + (1 - t(0, 2)) * t(1, 2) * t(1, 3);
}

template <int D>
double sampled_share(const std::array<Vec<D>, D + 1>& corners, const Zone<D>& zone,
                     double thickness) {
  const double step = thickness / std::sqrt(2.0);
  std::size_t in = 0, all = 0;
  const auto along = [&](auto& self, int j, const Vec<D>& x, double left) -> void {
    if (j > D) {
      ++all;
      in += zone.distance(x) < 0;
      return;
    }
    const Vec<D> edge = corners[j] - corners[0];
    const int count = static_cast<int>(std::floor(left * edge.norm() / step)) + 1;
    for (int i = 0; i <= count; ++i) {
      const double part = static_cast<double>(i) / count;
      self(self, j + 1, x + part * left * edge, left * (1 - part));
    }
  };
  along(along, 1, corners[0], 1.0);
  return static_cast<double>(in) / static_cast<double>(all);
}

template <int D>
Result<Filling> filling_ratios(const SimplexMesh<D>& mesh, const Partition<D>& partition,
                               const FillingParams& params, const Progress& progress) {
  const std::vector<double> reach = reach_of_nodes(mesh);
  Lists<Near> near;
  const auto look_around = [&](std::size_t n, std::vector<Near>& list) {
    if (n == 0) return;
    const Vec<D>& x = mesh.points[n];
    for (int z = 0; z < partition.background(); ++z) {
      const double d = partition.zone_at(z, x, reach[n]).distance;
      if (d >= reach[n]) continue;
      list.push_back({z, d <= -reach[n], d});
      if (d <= -reach[n]) break;
    }
  };
  if (!make_lists(mesh.points.size(), params.threads, progress.portion(0, 0.4, "filling ratios"),
                  near, look_around))
    return cancelled_error();
  Lists<Share> shares;
  const auto divide = [&](std::size_t e, std::vector<Share>& list) {
    thread_local Divider<D> divider;
    std::array<std::span<const Near>, D + 1> of_corner;
    for (int v = 0; v <= D; ++v) of_corner[v] = near.of(mesh.elements[e][v]);
    divider.divide(partition, params.depth, mesh.corners(mesh.elements[e]), of_corner, list);
  };
  if (!make_lists(mesh.elements.size(), params.threads, progress.portion(0.4, 1, "filling ratios"),
                  shares, divide))
    return cancelled_error();
  Filling filling;
  filling.first = std::move(shares.first);
  filling.shares = std::move(shares.items);
  filling.regions = partition.count();
  return filling;
}

template <int D>
std::vector<FillingError> filling_errors(const SimplexMesh<D>& mesh, const Filling& filling) {
  std::vector<FillingError> errors(static_cast<std::size_t>(filling.regions));
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const double measure = signed_measure<D>(mesh.corners(mesh.elements[e]));
    for (std::uint32_t s = filling.first[e]; s < filling.first[e + 1]; ++s) {
      const double g = filling.shares[s].ratio;
      FillingError& error = errors[filling.shares[s].region];
      error.volume += g * measure;
      error.l2 += g * (1 - g) * measure;
    }
  }
  for (FillingError& error : errors) {
    error.relative_l2 = error.volume > 0 ? std::sqrt(error.l2 / error.volume) : 0;
    error.l2 = std::sqrt(error.l2);
  }
  return errors;
}

#define LAMELLA_INSTANTIATE(D)                                                                \
  template double negative_share<D>(std::array<double, D + 1>);                               \
  template double sampled_share<D>(const std::array<Vec<D>, D + 1>&, const Zone<D>&, double); \
  template Result<Filling> filling_ratios<D>(const SimplexMesh<D>&, const Partition<D>&,      \
                                             const FillingParams&, const Progress&);          \
  template std::vector<FillingError> filling_errors<D>(const SimplexMesh<D>&, const Filling&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
