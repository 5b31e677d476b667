#include "core/natural/neighborhood.h"

#include <tbb/enumerable_thread_specific.h>

#include <limits>

#include "core/base/parallel.h"
#include "core/mesh/adjacency.h"

namespace lamella {
namespace {

/// For each item a run of others.
class Lists {
 public:
  Lists() = default;
  /// `pairs` of item and other, items in [0, items).
  Lists(const std::vector<std::array<std::int32_t, 2>>& pairs, std::size_t items)
      : start_(items + 1, 0), others_(pairs.size()) {
    for (const auto& p : pairs) ++start_[static_cast<std::size_t>(p[0]) + 1];
    for (std::size_t i = 0; i < items; ++i) start_[i + 1] += start_[i];
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (const auto& p : pairs) others_[next[p[0]]++] = p[1];
  }
  std::span<const std::int32_t> operator[](std::int32_t item) const {
    return std::span(others_).subspan(start_[item], start_[item + 1] - start_[item]);
  }

 private:
  std::vector<std::size_t> start_;
  std::vector<std::int32_t> others_;
};

/// Preliminary works on the mesh: who neighbors whom.
template <int D>
struct Graph {
  static constexpr std::int32_t kBoundary = -1;

  const SimplexMesh<D>& mesh;
  Lists nodes;           ///< [node] its neighbors
  Lists elements;        ///< [node] its elements
  Lists boundary_nodes;  ///< [node] its neighbors along boundary edges
  std::vector<std::array<std::int32_t, D + 1>> across;  ///< [element][vertex opposite]
  std::vector<char> on_boundary;                        ///< [node]

  explicit Graph(const SimplexMesh<D>& m) : mesh(m) {
    const std::size_t slots = mesh.points.size();
    std::vector<std::array<std::int32_t, 2>> pairs;
    const auto both_ways = [&] {
      const std::size_t count = pairs.size();
      for (std::size_t i = 0; i < count; ++i) pairs.push_back({pairs[i][1], pairs[i][0]});
      return Lists(pairs, slots);
    };
    pairs = unique_edges<D>(mesh.elements, slots);
    nodes = both_ways();
    pairs.clear();
    for (std::size_t e = 0; e < mesh.elements.size(); ++e)
      for (const NodeId n : mesh.elements[e]) pairs.push_back({n, static_cast<std::int32_t>(e)});
    elements = Lists(pairs, slots);

    std::array<std::int32_t, D + 1> closed;
    closed.fill(kBoundary);
    across.assign(mesh.elements.size(), closed);
    on_boundary.assign(slots, 0);
    pairs.clear();
    const auto uses = face_uses<D>(mesh.elements, slots);
    for_each_face<D>(uses, [&](std::size_t first, std::size_t last) {
      const FaceUse<D>& a = uses[first];
      if (last - first == 2) {
        const FaceUse<D>& b = uses[first + 1];
        across[a.element][a.local] = b.element;
        across[b.element][b.local] = a.element;
        return;
      }
      for (int i = 0; i < D; ++i) {
        on_boundary[a.nodes[i]] = 1;
        for (int j = i + 1; j < D; ++j) pairs.push_back({a.nodes[i], a.nodes[j]});
      }
    });
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    boundary_nodes = both_ways();
  }

  std::vector<int> layers() const {
    // Descending: breadth first from the boundary.
    std::vector<int> depth(mesh.points.size(), 0);
    std::vector<NodeId> order;
    for (std::size_t n = 1; n < depth.size(); ++n)
      if (on_boundary[n]) {
        depth[n] = 1;
        order.push_back(static_cast<NodeId>(n));
      }
    for (std::size_t i = 0; i < order.size(); ++i)
      for (const NodeId n : nodes[order[i]])
        if (depth[n] == 0) {
          depth[n] = depth[order[i]] + 1;
          order.push_back(n);
        }
    // Ascending: deeper nodes are settled first. The loop over l of the algorithm lets the smallest
    // l take the node.
    std::vector<int> layer = depth;
    for (auto it = order.rbegin(); it != order.rend(); ++it) {
      int smallest = 0;
      for (const NodeId n : nodes[*it])
        if (depth[n] > depth[*it] && (smallest == 0 || layer[n] < smallest)) smallest = layer[n];
      if (smallest > 0) layer[*it] = smallest;
    }
    return layer;
  }
};

/// What one node ends with.
template <int D>
struct Found {
  std::optional<EllipticFit<D>> fit;
  int order = 0, least_order = 0;
  bool failed = false, bounded = false;
};

/// Grows the neighborhoods of one node after another; everything it needs is kept between nodes.
template <int D>
class Grower {
 public:
  Grower(const Graph<D>& graph, const NeighborhoodParams& growth, double h_max)
      : graph_(graph),
        growth_(growth),
        interpolation_({growth.weights, growth.edge_middles, h_max}),
        reached_(graph.mesh.points.size(), 0),
        inside_(graph.mesh.elements.size(), 0),
        seen_(graph.mesh.points.size(), 0),
        slot_(graph.mesh.points.size(), 0) {}

  /// `layer` is k(S).
  Found<D> at(NodeId center, int layer) {
    start(center);
    Found<D> found;
    const int most = 2 * layer - 1;
    bool obstructs = false;  // order k_0 is reached
    for (int k = 1;; ++k) {
      const bool grown = grow();
      if (!grown && found.fit) break;
      collect_hull();
      if (k < most && !obstructs) obstructs = hull_parts_boundary();
      const bool relevant = k >= most || (k >= layer && obstructs);
      found.bounded = elements_.size() > (relevant ? 1 : 10) * growth_.largest;
      const bool last = !grown || found.bounded;
      if (!last && !relevant) continue;
      bool failed = false;
      const std::optional<EllipticFit<D>> fit = interpolate(failed);
      const bool first = found.least_order == 0;
      if (first) found.least_order = k;
      const bool good = fit && fit->error <= growth_.threshold;
      if (good || first) {
        found.fit = fit;
        found.order = k;
        found.failed = failed;
      }
      if (!good || last) break;
    }
    return found;
  }

 private:
  struct OpenFace {
    std::int32_t element;
    std::int32_t local;
  };

  void start(NodeId center) {
    ++node_stamp_;
    ring_.assign(1, center);
    reached_[center] = node_stamp_;
    elements_.clear();
    open_.clear();
  }

  /// The next neighborhood (4.4) and the elements that lie in it altogether. False when there are
  /// no more nodes.
  bool grow() {
    next_.clear();
    for (const NodeId n : ring_)
      for (const NodeId m : graph_.nodes[n])
        if (reached_[m] != node_stamp_) {
          reached_[m] = node_stamp_;
          next_.push_back(m);
        }
    ring_.swap(next_);
    if (ring_.empty()) return false;
    const std::size_t before = elements_.size();
    for (const NodeId n : ring_)
      for (const std::int32_t e : graph_.elements[n]) {
        if (inside_[e] == node_stamp_) continue;
        bool all = true;
        for (const NodeId v : graph_.mesh.elements[e]) all = all && reached_[v] == node_stamp_;
        if (!all) continue;
        inside_[e] = node_stamp_;
        elements_.push_back(e);
      }
    std::erase_if(open_, [&](const OpenFace& f) { return !is_open(f); });
    for (std::size_t i = before; i < elements_.size(); ++i)
      for (std::int32_t k = 0; k <= D; ++k)
        if (const OpenFace f{elements_[i], k}; is_open(f)) open_.push_back(f);
    return true;
  }
  bool is_open(const OpenFace& f) const {
    const std::int32_t next = graph_.across[f.element][f.local];
    return next == Graph<D>::kBoundary || inside_[next] != node_stamp_;
  }

  /// The hull (4.5) and its nodes (4.6).
  void collect_hull() {
    ++hull_stamp_;
    hull_.clear();
    points_.clear();
    faces_.clear();
    for (const OpenFace& f : open_) {
      std::array<std::int32_t, D> face;
      const auto& e = graph_.mesh.elements[f.element];
      for (int k = 0, j = 0; k <= D; ++k) {
        if (k == f.local) continue;
        const NodeId n = e[k];
        if (seen_[n] != hull_stamp_) {
          seen_[n] = hull_stamp_;
          slot_[n] = static_cast<std::int32_t>(hull_.size());
          hull_.push_back(n);
          points_.push_back(graph_.mesh.points[n]);
        }
        face[j++] = slot_[n];
      }
      faces_.push_back(face);
    }
  }

  /// Whether the nodes that the hull shares with the boundary fall apart into several parts when
  /// only boundary edges join them (section B.1.1).
  bool hull_parts_boundary() {
    std::size_t shared = 0;
    NodeId first = 0;
    for (const NodeId n : hull_)
      if (graph_.on_boundary[n]) {
        if (shared++ == 0) first = n;
      }
    if (shared < 2) return false;
    next_.assign(1, first);
    slot_[first] = -1;  // visited
    for (std::size_t i = 0; i < next_.size(); ++i)
      for (const NodeId m : graph_.boundary_nodes[next_[i]])
        if (seen_[m] == hull_stamp_ && slot_[m] >= 0) {
          slot_[m] = -1;
          next_.push_back(m);
        }
    return next_.size() < shared;
  }

  std::optional<EllipticFit<D>> interpolate(bool& failed) {
    interpolation_.set(points_, faces_);
    if (growth_.interpolation) {
      const auto fit = interpolation_.fit(*growth_.interpolation);
      failed = !fit || fit->projected;
      if (fit) return fit;
    }
    const auto fit = interpolation_.fit();
    failed = failed || !fit;
    return fit;
  }

  const Graph<D>& graph_;
  const NeighborhoodParams& growth_;
  EllipticInterpolation<D> interpolation_;
  std::uint32_t node_stamp_ = 0, hull_stamp_ = 0;
  std::vector<std::uint32_t> reached_, inside_;  ///< [node], [element]: node_stamp_ when in
  std::vector<std::uint32_t> seen_;              ///< [node]: hull_stamp_ when on the hull
  std::vector<std::int32_t> slot_;               ///< [node] index on the hull
  std::vector<NodeId> ring_, next_, hull_;
  std::vector<std::int32_t> elements_;
  std::vector<OpenFace> open_;
  std::vector<Vec<D>> points_;
  std::vector<std::array<std::int32_t, D>> faces_;
};

/// (4.68): the sizes up to (1 + alpha) h_1 over n, the others as they are or, if so asked, by n2
/// and n3 (4.4.3), all within the bounds.
template <int D>
Metric<D> divided(const Spectrum<D>& s, const NaturalParams& params, double h_max) {
  Vec<D> h = s.values.unaryExpr(&size_from_eigenvalue);
  const double h1 = h[D - 1];
  for (int k = 0; k < D; ++k) {
    if (h[k] <= (1 + params.alpha) * h1)
      h[k] /= params.layers;
    else if (params.layers2 && h[k] <= (1 + params.alpha + params.alpha2) * h1)
      h[k] /= *params.layers2;
    else
      h[k] /= params.layers3.value_or(1);
    h[k] = std::clamp(h[k], params.h_min, h_max);
  }
  if (params.max_anisotropy > 0) h = h.cwiseMin(params.max_anisotropy * h.minCoeff());
  return metric_from_sizes<D>(s.vectors, h);
}

template <int D>
double diagonal(const SimplexMesh<D>& mesh) {
  Vec<D> low = mesh.points[1], high = low;
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    low = low.cwiseMin(mesh.points[n]);
    high = high.cwiseMax(mesh.points[n]);
  }
  return (high - low).norm();
}

}  // namespace

template <int D>
std::vector<int> layer_numbers(const SimplexMesh<D>& mesh) {
  return Graph<D>(mesh).layers();
}

double average_layers(const std::vector<int>& layer_numbers) {
  double sum = 0;
  std::size_t count = 0;
  for (const int k : layer_numbers)
    if (k > 0) {
      sum += 2 * k - 1.5;
      ++count;
    }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

template <int D>
Result<NeighborhoodField<D>> neighborhood_field(const SimplexMesh<D>& mesh,
                                                const NaturalParams& params,
                                                const NeighborhoodParams& growth,
                                                const Progress& progress) {
  if (const auto ok = check_params(params); !ok) return ok.error();
  if (!(growth.threshold > 0) || growth.largest == 0)
    return Error{Code::usage, "The error threshold and the size of neighborhoods must be positive.",
                 "0.76 and 2000 are the usual values."};
  if (mesh.elements.empty())
    return Error{Code::bad_input, "The mesh has no elements to grow neighborhoods in.", ""};
  const std::size_t n = mesh.points.size();
  const double h_max = params.h_max > 0 ? params.h_max : diagonal(mesh);
  const Graph<D> graph(mesh);
  const std::vector<int> layers = graph.layers();
  if (progress.cancelled()) return cancelled_error();

  NeighborhoodField<D> field;
  field.metric.assign(n, Metric<D>::Identity());
  field.thickness.assign(n, 0.0);
  field.direction.assign(n, Vec<D>::UnitX());
  field.error.assign(n, std::numeric_limits<double>::quiet_NaN());
  field.order.assign(n, 0);
  field.least_order.assign(n, 0);
  std::vector<char> failed(n, 0), bounded(n, 0);
  tbb::enumerable_thread_specific<Grower<D>> growers(
      [&] { return Grower<D>(graph, growth, h_max); });
  const bool complete = parallel_each(
      n - 1, params.threads, progress,
      [&](std::size_t at) {
        const std::size_t i = at + 1;
        const Found<D> found =
            layers[i] > 0 ? growers.local().at(static_cast<NodeId>(i), layers[i]) : Found<D>{};
        failed[i] = found.failed || !found.fit;
        bounded[i] = found.bounded;
        field.order[i] = found.order;
        field.least_order[i] = found.least_order;
        if (!found.fit) {
          field.metric[i] = isotropic_metric<D>(h_max);
          field.thickness[i] = h_max;
          return;
        }
        const Spectrum<D> s = spectrum<D>(found.fit->metric);
        field.error[i] = found.fit->error;
        field.metric[i] = divided<D>(s, params, h_max);
        field.thickness[i] = size_from_eigenvalue(s.values[D - 1]);
        field.direction[i] = s.vectors.col(D - 1);
      },
      16);
  if (!complete) return cancelled_error();
  for (std::size_t i = 1; i < n; ++i) {
    field.failures += failed[i];
    field.bounded += bounded[i];
  }
  return field;
}

Result<NaturalField> NeighborhoodDetector::field(const SimplexMesh<3>& mesh,
                                                 const NaturalParams& params,
                                                 const Progress& progress) const {
  Result<NeighborhoodField<3>> found = neighborhood_field<3>(mesh, params, growth_, progress);
  if (!found) return found.error();
  return NaturalField{std::move(found->metric), std::move(found->thickness),
                      std::move(found->direction)};
}

#define LAMELLA_INSTANTIATE(D)                                       \
  template std::vector<int> layer_numbers<D>(const SimplexMesh<D>&); \
  template Result<NeighborhoodField<D>> neighborhood_field<D>(       \
      const SimplexMesh<D>&, const NaturalParams&, const NeighborhoodParams&, const Progress&);
LAMELLA_INSTANTIATE(2)
LAMELLA_INSTANTIATE(3)
LAMELLA_INSTANTIATE(4)
#undef LAMELLA_INSTANTIATE

}  // namespace lamella
