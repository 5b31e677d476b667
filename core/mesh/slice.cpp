#include "core/mesh/slice.h"

#include <algorithm>
#include <sstream>

#include "core/mesh/boundary.h"

namespace lamella {
namespace {

constexpr std::size_t kPollEvery = 1 << 14;
constexpr double kOnPlane = 1e-9;  ///< of the extent along the last axis

/// A node of the slice: on the edge from a node below to one above, or a node on the hyperplane,
/// twice.
using Key = std::array<NodeId, 2>;

/// Ascending node ids of one simplex, by side of the hyperplane.
struct Sides {
  std::array<NodeId, 5> below{}, on{}, above{};
  int below_count = 0, on_count = 0, above_count = 0;
};

template <std::size_t N>
Sides sides_of(std::array<NodeId, N> nodes, const std::vector<signed char>& side) {
  std::sort(nodes.begin(), nodes.end());
  Sides s;
  for (const NodeId v : nodes) {
    if (side[v] < 0) s.below[s.below_count++] = v;
    if (side[v] == 0) s.on[s.on_count++] = v;
    if (side[v] > 0) s.above[s.above_count++] = v;
  }
  return s;
}

/// Calls visit(keys) for each simplex of N - 1 nodes that the hyperplane cuts out of one with nodes
/// on both sides: the nodes on it joined with each monotone path from the pair of the first node
/// below and the first above to the pair of the last ones.
template <int N, class Visit>
void cut(const Sides& s, Visit visit) {
  std::array<Key, N - 1> keys;
  for (int i = 0; i < s.on_count; ++i) keys[i] = {s.on[i], s.on[i]};
  const int steps = s.below_count + s.above_count - 2;
  // A path is the set of its steps along the nodes above.
  for (unsigned path = 0; path < 1u << steps; ++path) {
    int i = 0, j = 0, count = s.on_count;
    keys[count++] = {s.below[0], s.above[0]};
    for (int step = 0; step < steps && i < s.below_count && j < s.above_count; ++step) {
      ++(path >> step & 1u ? j : i);
      if (i < s.below_count && j < s.above_count) keys[count++] = {s.below[i], s.above[j]};
    }
    if (i == s.below_count - 1 && j == s.above_count - 1) visit(keys);
  }
}

/// A piece of the slice before its nodes are numbered.
template <int N>
struct Piece {
  std::array<Key, N> keys;
  std::int32_t from = 0;  ///< the element or facet it is cut out of
};

/// The piece that lies in the hyperplane as a whole; only where `s` has one node off it.
template <int N>
Piece<N> lying(const Sides& s, std::int32_t from) {
  Piece<N> piece;
  for (int k = 0; k < N; ++k) piece.keys[k] = {s.on[k], s.on[k]};
  piece.from = from;
  return piece;
}

/// Facets of elements in the hyperplane: each once, of the element below where there is one.
template <int N>
void append_lying(std::vector<Piece<N>> below, const std::vector<Piece<N>>& above,
                  std::vector<Piece<N>>& out) {
  below.insert(below.end(), above.begin(), above.end());
  std::stable_sort(below.begin(), below.end(),
                   [](const auto& a, const auto& b) { return a.keys < b.keys; });
  below.erase(std::unique(below.begin(), below.end(),
                          [](const auto& a, const auto& b) { return a.keys == b.keys; }),
              below.end());
  out.insert(out.end(), below.begin(), below.end());
}

template <int D>
class Slicer {
 public:
  Slicer(const SimplexMesh<D>& mesh, double value, const MetricField<D>& metric,
         const Progress& progress)
      : mesh_(mesh), value_(value), metric_(metric), progress_(progress) {}

  Result<Slice<D - 1>> run() {
    if (!metric_.empty() && metric_.size() != mesh_.points.size())
      return Error{Code::bad_input,
                   "The metric has " + std::to_string(metric_.size()) + " entries, the mesh " +
                       std::to_string(mesh_.points.size()) + " nodes with the virtual one.",
                   "Give the metric of this mesh."};
    if (!find_sides()) return outside();
    if (!cut_elements() || !cut_facets()) return cancelled_error();
    if (elements_.empty()) return outside();
    number_nodes();
    Slice<D - 1> slice;
    place_nodes(slice);
    if (!connect(slice.mesh)) return cancelled_error();
    progress_.report(1);
    return slice;
  }

 private:
  bool find_sides() {
    Eigen::AlignedBox<double, D> box;
    for (std::size_t v = 1; v < mesh_.points.size(); ++v) box.extend(mesh_.points[v]);
    if (box.isEmpty()) return false;
    low_ = box.min()[D - 1];
    high_ = box.max()[D - 1];
    const double tolerance = kOnPlane * (high_ - low_);
    side_.assign(mesh_.points.size(), 0);
    for (std::size_t v = 1; v < side_.size(); ++v) {
      const double d = mesh_.points[v][D - 1] - value_;
      if (std::abs(d) > tolerance) side_[v] = d < 0 ? -1 : 1;
    }
    return true;
  }

  /// Entry i of `count`, in the part of the work from `begin` on.
  bool cancelled(std::size_t i, double begin, std::size_t count) const {
    if (i % kPollEvery != 0) return false;
    progress_.report(begin + 0.3 * static_cast<double>(i) / static_cast<double>(count));
    return progress_.cancelled();
  }

  bool cut_elements() {
    std::vector<Piece<D>> lying_below, lying_above;
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
      if (cancelled(e, 0, mesh_.elements.size())) return false;
      const Sides s = sides_of(mesh_.elements[e], side_);
      const auto from = static_cast<std::int32_t>(e);
      if (s.below_count > 0 && s.above_count > 0)
        cut<D + 1>(s, [&](const auto& keys) { elements_.push_back({keys, from}); });
      else if (s.on_count == D)
        (s.below_count > 0 ? lying_below : lying_above).push_back(lying<D>(s, from));
    }
    append_lying(std::move(lying_below), lying_above, elements_);
    return true;
  }

  bool cut_facets() {
    for (std::size_t f = 0; f < mesh_.facets.size(); ++f) {
      if (cancelled(f, 0.3, mesh_.facets.size())) return false;
      const Sides s = sides_of(mesh_.facets[f], side_);
      const auto from = static_cast<std::int32_t>(f);
      if (s.below_count > 0 && s.above_count > 0)
        cut<D>(s, [&](const auto& keys) { facets_.push_back({keys, from}); });
      else if (s.on_count == D - 1)
        facets_.push_back(lying<D - 1>(s, from));
    }
    return true;
  }

  void number_nodes() {
    for (const auto& piece : elements_)
      keys_.insert(keys_.end(), piece.keys.begin(), piece.keys.end());
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  }
  /// 0 for a key that no element has.
  NodeId node_of(const Key& key) const {
    const auto it = std::lower_bound(keys_.begin(), keys_.end(), key);
    return it == keys_.end() || *it != key ? 0 : static_cast<NodeId>(it - keys_.begin()) + 1;
  }

  void place_nodes(Slice<D - 1>& slice) const {
    slice.mesh.points.reserve(keys_.size() + 1);
    if (!metric_.empty()) slice.metric.assign(1, Metric<D - 1>::Identity());
    for (const auto& [low, high] : keys_) {
      const Vec<D>&a = mesh_.points[low], &b = mesh_.points[high];
      const double s = low == high ? 0 : (value_ - a[D - 1]) / (b[D - 1] - a[D - 1]);
      slice.mesh.points.push_back((a + s * (b - a)).template head<D - 1>());
      if (metric_.empty()) continue;
      const Metric<D> m = (1 - s) * metric_[low] + s * metric_[high];
      slice.metric.push_back(m.template topLeftCorner<D - 1, D - 1>());
    }
  }

  bool connect(SimplexMesh<D - 1>& out) const {
    out.bodies = mesh_.bodies;
    out.groups = mesh_.groups;
    for (const auto& piece : elements_) {
      if (cancelled(out.elements.size(), 0.6, elements_.size())) return false;
      auto& e = out.elements.emplace_back();
      for (int k = 0; k < D; ++k) e[k] = node_of(piece.keys[k]);
      if (signed_measure<D - 1>(out.corners(e)) < 0) std::swap(e[0], e[1]);
      out.element_body.push_back(mesh_.element_body[piece.from]);
    }
    for (const auto& piece : facets_) {
      typename SimplexMesh<D - 1>::Facet f;
      for (int k = 0; k < D - 1; ++k) f[k] = node_of(piece.keys[k]);
      if (std::find(f.begin(), f.end(), 0) != f.end()) continue;
      out.facets.push_back(f);
      out.facet_group.push_back(mesh_.facet_group[piece.from]);
      out.facet_face.push_back(mesh_.facet_face[piece.from]);
    }
    rebuild_facets(out);  // turns them outward
    return true;
  }

  Error outside() const {
    std::ostringstream text;
    text << "The mesh has no cross-section at " << value_ << ": its coordinate " << D
         << " goes from " << low_ << " to " << high_ << ".";
    return {Code::usage, text.str(), "Choose a value between them."};
  }

  const SimplexMesh<D>& mesh_;
  const double value_;
  const MetricField<D>& metric_;
  const Progress& progress_;
  double low_ = 0, high_ = 0;
  std::vector<signed char> side_;  ///< [node] below -1, on the hyperplane 0, above 1
  std::vector<Piece<D>> elements_;
  std::vector<Piece<D - 1>> facets_;
  std::vector<Key> keys_;  ///< [node - 1] of the slice, ascending
};

}  // namespace

template <int D>
Result<Slice<D - 1>> slice(const SimplexMesh<D>& mesh, double value, const MetricField<D>& metric,
                           const Progress& progress) {
  return Slicer<D>(mesh, value, metric, progress).run();
}

template Result<Slice<2>> slice<3>(const SimplexMesh<3>&, double, const MetricField<3>&,
                                   const Progress&);
template Result<Slice<3>> slice<4>(const SimplexMesh<4>&, double, const MetricField<4>&,
                                   const Progress&);

}  // namespace lamella
