#include "core/optimize/star_optimizer.h"

#include <algorithm>
#include <limits>

namespace lamella {
namespace {

constexpr double fourth_power(double x) { return x * x * x * x; }

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Squared metric distance within which a moved node keeps the metric carried to it instead of
/// asking the function again.
constexpr double still_near = 0.0025;
/// Squared metric length of a move that makes the edges around worth another look.
constexpr double far_move2 = 0.01;
/// Of the longest edge around: an edge that is shorter waits for that one to be split.
constexpr double nearly_longest = 0.8;
/// Quality below which no element may fall for the sake of the average.
constexpr double floor_quality = 0.3;
/// Gain of energy that is worth an operation, and a move where nothing but moves is left.
constexpr double least_gain = 1e-3, least_gain_of_places = 1e-6;
/// Clock of birth, for a moment, of an element whose place in the cavity is taken.
constexpr std::uint32_t replaced = std::numeric_limits<std::uint32_t>::max();

}  // namespace

template <int D>
StarOptimizer<D>::StarOptimizer(Block<D> block, const BoundaryModel<D>& model,
                                const AdaptParams& params, const MetricFunction<D>& metric_at,
                                double scale)
    : model_(model),
      carrier_(params.mean),
      averager_(params.element_mean),
      seed_(params.seed),
      metric_function_(metric_at),
      flat_(1e-12 * scale),
      plain_(params.element_mean == MetricMean::m),
      shared_(std::move(block.shared)) {
  WorkMesh<D>& mesh = block.mesh;
  topo_ =
      Topology<D>::from(std::move(mesh.points), std::move(mesh.elements), std::move(mesh.label));
  metric_ = std::move(mesh.metric);
  asked_ = std::move(mesh.asked);
  fixed_ = std::move(mesh.fixed);
  dirty_ = std::move(mesh.dirty);
  topo_.clock = 2;
  done_.resize(topo_.points.size());
  for (std::size_t n = 0; n < done_.size(); ++n) done_[n] = dirty_[n] ? 0 : 1;
  carried_.resize(topo_.points.size());
  carried_known_.resize(topo_.points.size(), 0);
  mark_.resize(topo_.points.size(), 0);
  place_.resize(topo_.points.size());
  if (!plain_) {
    own_averaged_.resize(topo_.points.size());
    for (std::size_t n = 1; n < metric_.size(); ++n) own_averaged_[n] = averager_.carry(metric_[n]);
  }
  kernel_.element_mean = params.element_mean;
  kernel_.size_average = params.size_average;
  kernel_.points = &topo_.points;
  rating_.resize(topo_.elements.size());
  kernel_.relaxation = 0;
}

template <int D>
void StarOptimizer<D>::set_weights(double relaxation, double size_weight, bool strict) {
  if (size_weight == 0) size_weight = usual_size_weight<D>;
  if (kernel_.relaxation == relaxation && kernel_.size_weight == size_weight &&
      strict == (kernel_.metrics != nullptr))
    return;
  kernel_.metrics = strict ? &metric_ : nullptr;
  kernel_.relaxation = relaxation;
  kernel_.size_weight = size_weight;
  faces_.rate_elements(nodes(), 0, topo_.elements.size(), kernel_, rating_);
}

template <int D>
std::size_t StarOptimizer<D>::sweep(const SweepParams& params, const Progress& progress) {
  sweep_ = params;
  set_weights(params.relaxation, params.size_weight, params.strict);
  std::size_t operations = 0;
  // The seed says at which node the sweep begins; nodes born in it wait for the next.
  const auto count = static_cast<std::uint64_t>(topo_.points.size()) - 1;
  const std::uint64_t first = (seed_ - 1) * 0x9E3779B97F4A7C15u % count;
  for (std::uint64_t turn = 0; turn < count; ++turn) {
    const auto s = static_cast<NodeId>(1 + (first + turn) % count);
    if ((turn & 15) == 0 && progress.cancelled()) return operations;
    if (topo_.around.empty(s)) continue;
    bool stale = true;
    for (auto e : topo_.around.of(s)) stale = stale && topo_.touch[e] <= done_[s];
    if (stale) continue;
    const std::uint32_t before = done_[s];
    done_[s] = topo_.clock++;
    if (params.attention < 1) {
      double worst = infinity;
      for (auto e : topo_.around.of(s)) worst = std::min(worst, rating_[e].quality);
      if (worst > params.attention) continue;
    }
    if (topo_.elements.size() - topo_.free_elements.size() > params.most_elements) {
      overfull_ = true;
      return operations;
    }
    const bool linked = movable(s);
    if (linked && process_node(s)) ++operations;
    if (params.moves_only || topo_.around.empty(s)) continue;
    if (!linked || edges_matter(s)) operations += improve_edges(s, before);
  }
  return operations;
}

/// Whether an element of the star of s is poor, or an edge to a node of link_, the link of s, long.
template <int D>
bool StarOptimizer<D>::edges_matter(NodeId s) const {
  for (auto e : topo_.around.of(s))
    if (rating_[e].quality <= sweep_.good_enough) return true;
  const double split4 = fourth_power(sweep_.split_above);
  for (NodeId n : link_)
    if (n > s && length4(s, n) > split4) return true;
  return false;
}

/// Edges are owned by their lower node; an edge whose cavity is older than the owner's last turn
/// has nothing new to offer.
template <int D>
std::size_t StarOptimizer<D>::improve_edges(NodeId s, std::uint32_t before) {
  list_edges(s, before);
  std::size_t operations = 0;
  const double split4 = fourth_power(sweep_.split_above);
  for (OwnedEdge edge : owned_) {
    const NodeId n = edge.node;
    // Once something has changed the list says no more than which edges there were.
    const bool listed = operations == 0;
    const double l4 = length4(s, n);
    if (listed && (!edge.fresh || (l4 <= split4 && edge.worst > sweep_.good_enough))) continue;
    if (!listed) edge = {n, infinity, false};
    star_.clear();
    for (auto e : topo_.around.of(s))
      if (Topology<D>::has(topo_.elements[e], n)) {
        star_.push_back(e);
        if (!listed) edge.see(rating_[e].quality, topo_.birth[e] > before);
      }
    if (!edge.fresh) continue;
    const bool is_long = l4 > split4 && longest(s, n, l4 / fourth_power(nearly_longest));
    if (!is_long && edge.worst > sweep_.good_enough) continue;
    if (!process_edge(s, n, is_long)) continue;
    ++operations;
    if (topo_.around.empty(s)) break;
  }
  return operations;
}

/// The edges that s owns, with the quality of their worst element and whether one of their elements
/// is younger than `before`.
template <int D>
void StarOptimizer<D>::list_edges(NodeId s, std::uint32_t before) {
  owned_.clear();
  ++mark_value_;
  const bool held = locked(s);
  for (auto e : topo_.around.of(s)) {
    const bool fresh = topo_.birth[e] > before;
    const double quality = rating_[e].quality;
    for (NodeId n : topo_.elements[e]) {
      if (n <= s) continue;
      if (mark_[n] != mark_value_) {
        if (held && locked(n)) continue;
        mark_[n] = mark_value_;
        place_[n] = static_cast<std::int32_t>(owned_.size());
        owned_.push_back({n, infinity, false});
      }
      owned_[place_[n]].see(quality, fresh);
    }
  }
}

/// Whether no edge from either end to a node around the edge has a length above limit4^(1/4): the
/// longest edges are split first.
template <int D>
bool StarOptimizer<D>::longest(NodeId s, NodeId n, double limit4) const {
  for (auto e : star_)
    for (NodeId v : topo_.elements[e])
      if (v != 0 && v != s && v != n && (length4(s, v) > limit4 || length4(n, v) > limit4))
        return false;
  return true;
}

template <int D>
void StarOptimizer<D>::open_cavity(std::span<const std::int32_t> elements, NodeId a, NodeId b) {
  cavity_.assign(elements.begin(), elements.end());
  faces_.open(nodes());
  virtual_faces_.clear();
  link_.clear();
  ++mark_value_;
  for (auto e : cavity_) {
    const Element& element = topo_.elements[e];
    const bool is_virtual = element[0] == 0;
    for (int k = 0; k <= D; ++k) {
      const NodeId n = element[k];
      if (n == a || n == b) {
        if (is_virtual) {
          CavityFace<D> f;
          f.nodes = opposite_facet<D>(element, k);
          f.element = e;
          f.place = k;
          virtual_faces_.push_back(f);
        } else {
          faces_.add(e, k);
        }
      } else if (n != 0 && mark_[n] != mark_value_) {
        mark_[n] = mark_value_;
        link_.push_back(n);
      }
    }
  }
}

template <int D>
void StarOptimizer<D>::start_from_current() {
  best_.clear();
  best_worst_ = infinity;
  best_cost_ = 0;
  for (auto e : cavity_)
    if (!topo_.is_virtual(e)) {
      best_.add(rating_[e].quality);
      best_worst_ = std::min(best_worst_, rating_[e].quality);
      best_cost_ += rating_[e].energy - typical_energy<D>;
    }
  cavity_worst_ = best_worst_;
  found_ = false;
  if (sweep_.temperature > 0) {
    dice_ = dice_ * 6364136223846793005u + 1442695040888963407u;
    const double u = (static_cast<double>(dice_ >> 11) + 1) * 0x1p-53;
    best_cost_ -= sweep_.temperature * std::log(u);
  }
}

/// Whether the star of an apex goes before the best known; its figures are in trial_ then.
template <int D>
bool StarOptimizer<D>::beats(NodeId node, const Vec<D>& point, const Packed<D>& averaged) {
  trial_.clear();
  trial_worst_ = infinity;
  typename FaceBatch<D>::Rates rates;
  const bool by_energy = sweep_.criterion == Criterion::energy;
  const double floor =
      by_energy ? std::min(cavity_worst_, floor_quality) : std::max(best_worst_, 0.0);
  const double most = best_cost_ - (sweep_.moves_only ? least_gain_of_places : least_gain);
  // What is still to come costs at least 1 - typical each.
  const double limit = most + (typical_energy<D> - 1) * static_cast<double>(faces_.size());
  double sum = 0;
  int count = 0;
  for (int g = 0; g < faces_.groups(); ++g) {
    faces_.rate(g, kernel_, node, point, averaged, rates);
    if (rates.worst < floor) return false;
    trial_worst_ = std::min(trial_worst_, rates.worst);
    if (by_energy) {
      sum += rates.sum;
      count += rates.count;
      if (sum > limit) return false;
    } else {
      trial_.add(rates.quality);
    }
  }
  if (by_energy) {
    trial_cost_ = sum + (1 - typical_energy<D>)*count;
    return trial_cost_ < most;
  }
  if (trial_worst_ != best_worst_) return true;
  return goes_before(trial_, best_);
}

/// Whether the metric of the node was asked for so near the apex that it need not be again.
template <int D>
bool StarOptimizer<D>::still_known(NodeId n, const Apex& apex) const {
  return n != 0 && apex.metric.quad(apex.point - asked_[n]) < still_near;
}

/// Makes the apex that beat the best known the best, unless the boundary forbids, or the metric
/// there where single elements count.
template <int D>
void StarOptimizer<D>::take_if_allowed(Apex apex, const BoundarySite& site) {
  if (site.boundary && (!topology_allows(apex, site) || !boundary_allows(apex, site))) return;
  if (apex.node == 0 && metric_function_ && sweep_.attention < 1 && !still_known(moving_, apex)) {
    apex = new_point(apex.point, Packed<D>::from(metric_function_(apex.point)));
    apex.asked = true;
    if (!beats(0, apex.point, apex.averaged)) return;
  }
  if (site.boundary) best_retag_ = retag_;
  std::swap(best_, trial_);
  best_worst_ = trial_worst_;
  best_cost_ = trial_cost_;
  best_apex_ = apex;
  found_ = true;
}

template <int D>
const Packed<D>& StarOptimizer<D>::carried(NodeId n) const {
  if (!carried_known_[n]) {
    carried_[n] = carrier_.carry(metric_[n]);
    carried_known_[n] = 1;
  }
  return carried_[n];
}

/// Metric at a point of the star of s, interpolated in the element that holds it.
template <int D>
Packed<D> StarOptimizer<D>::metric_in_star(NodeId s, const Vec<D>& x) {
  double best = -infinity;
  const CavityFace<D>* in = nullptr;
  Vec<D> best_weights = Vec<D>::Zero();
  const Vec<D> shift = x - topo_.points[s];
  for (const auto& f : faces_) {
    // x = s + sum w_k (p_k - s): solve for the weights of the face's nodes.
    Mat<D> a;
    for (int k = 0; k < D; ++k) a.col(k) = topo_.points[f.nodes[k]] - topo_.points[s];
    const Vec<D> w = a.inverse() * shift;
    const double least = std::min(w.minCoeff(), 1 - w.sum());
    if (least > best) {
      best = least;
      in = &f;
      best_weights = w;
    }
    if (best >= 0) break;
  }
  if (!in) return metric_[s];
  bool uniform = true;
  for (NodeId n : in->nodes) uniform = uniform && metric_[n].c == metric_[s].c;
  if (uniform) return metric_[s];
  Vec<D> w = best_weights.cwiseMax(0.0);
  double ws = std::max(0.0, 1 - best_weights.sum());
  const double total = w.sum() + ws;
  Packed<D> c = Packed<D>::zero();
  c.add(ws / total, carried(s));
  for (int k = 0; k < D; ++k) c.add(w[k] / total, carried(in->nodes[k]));
  return carrier_.metric(c);
}

template <int D>
typename StarOptimizer<D>::Apex StarOptimizer<D>::new_point(const Vec<D>& x,
                                                            const Packed<D>& metric) const {
  return {0, x, metric, plain_ ? metric : averager_.carry(metric), false};
}

template <int D>
bool StarOptimizer<D>::process_node(NodeId s) {
  open_cavity(topo_.around.of(s), s, s);
  BoundarySite site;
  if (!node_site(s, site)) return false;
  moving_ = s;
  start_from_current();

  const double near4 = fourth_power(sweep_.collapse_below);
  const bool any = cavity_worst_ < poor_quality;
  const auto join = [&](NodeId v) {
    if (sweep_.moves_only) return;
    if (any || length4(s, v) < near4) offer(v, site);
  };
  if (!site.boundary) {
    for (NodeId v : link_) join(v);
  } else if (site.on_feature) {
    join(site.ends[0]);
    join(site.ends[1]);
  } else {
    for (const auto& r : ring_)
      if (!site.stray || takes_stray(r.node, site)) join(r.node);
  }
  if (!site.stray && (!found_ || sweep_.criterion == Criterion::order)) offer_moves(s, site);
  if (!found_) return false;
  replace_cavity(best_apex_, best_apex_.node == 0 ? s : 0);
  release_if_unused(s);
  ++(best_apex_.node == 0 ? counts_.moves : counts_.collapses);
  return true;
}

template <int D>
bool StarOptimizer<D>::process_edge(NodeId s, NodeId n, bool is_long) {
  open_cavity(star_, s, n);
  BoundarySite site;
  if (!edge_site(s, n, site)) return false;
  moving_ = 0;
  start_from_current();
  if (!site.boundary) {
    for (NodeId v : link_) offer(v, site);
  } else if (!site.on_feature) {
    for (NodeId v : link_) {
      bool on_boundary = false;
      for (const auto& f : virtual_faces_) on_boundary = on_boundary || f.contains(v);
      if (on_boundary) offer(v, site);
    }
  }
  // Where the worst elements are at stake a node in between may free them.
  if (is_long || sweep_.attention < 1) {
    const Vec<D> e = topo_.points[n] - topo_.points[s];
    const double ls = std::sqrt(metric_[s].quad(e)), ln = std::sqrt(metric_[n].quad(e));
    // The metric length of a linear size field is halved here.
    // An edge that will end in an odd number of pieces is cut at one of their ends.
    const double pieces = std::round(std::sqrt(ls * ln));
    const double half = pieces > 2 && pieces < 8 ? std::floor(0.5 * pieces) / pieces : 0.5;
    const double ratio = std::sqrt(ls / ln) * (1 - half) / half;
    const double t = std::clamp(1 / (1 + ratio), 0.2, 0.8);
    Vec<D> x = topo_.points[s] + t * e;
    if (site.boundary) {
      const auto on = point_on_boundary(x, site.on_feature, 2 * model_.tolerance());
      if (on) x = *on;
      site.second = nullptr;
      site.ends[0] = site.on_feature ? s : 0;
      site.ends[1] = site.on_feature ? n : 0;
    }
    Packed<D> metric = metric_[s];
    if (metric.c != metric_[n].c) {
      Packed<D> c = Packed<D>::zero();
      c.add(1 - t, carried(s));
      c.add(t, carried(n));
      metric = carrier_.metric(c);
    }
    offer(new_point(x, metric), site);
  }
  if (!found_) return false;
  replace_cavity(best_apex_, 0);
  release_if_unused(s);
  release_if_unused(n);
  ++(best_apex_.node == 0 ? counts_.splits : counts_.swaps);
  return true;
}

template <int D>
void StarOptimizer<D>::grow_nodes() {
  const std::size_t size = topo_.points.size();
  if (metric_.size() >= size) return;
  metric_.resize(size);
  carried_.resize(size);
  carried_known_.resize(size, 0);
  if (!plain_) own_averaged_.resize(size);
  if (metric_function_) asked_.resize(size);
  fixed_.resize(size, 0);
  dirty_.resize(size, 0);
  shared_.resize(size, 0);
  done_.resize(size, 0);
  mark_.resize(size, 0);
  place_.resize(size);
}

/// Ratings of the elements {face, apex} of all faces into rates_.
template <int D>
void StarOptimizer<D>::rate_all(const Apex& apex) {
  rates_.clear();
  typename FaceBatch<D>::Rates rates;
  for (int g = 0; g < faces_.groups(); ++g) {
    faces_.rate(g, kernel_, 0, apex.point, apex.averaged, rates);
    for (int l = 0; l < FaceBatch<D>::width; ++l)
      rates_.push_back({rates.quality[l], rates.energy[l]});
  }
}

/// Puts the star of the apex in place of the cavity. `moved`: the node that takes the apex' point,
/// 0 to make a new node where the apex is none.
template <int D>
void StarOptimizer<D>::replace_cavity(const Apex& offered, NodeId moved) {
  Apex apex = offered;
  NodeId v = apex.node;
  bool far = false;
  if (v == 0) {
    v = moved;
    if (v == 0) {
      v = topo_.add_node(apex.point);
      grow_nodes();
      fixed_[v] = 0;
      shared_[v] = 0;
      done_[v] = 0;
    }
    if (metric_function_ && (apex.asked || !still_known(moved, apex))) {
      if (!apex.asked) apex = new_point(apex.point, Packed<D>::from(metric_function_(apex.point)));
      asked_[v] = apex.point;
    }
    far = apex.metric.quad(apex.point - topo_.points[v]) > far_move2;
    topo_.points[v] = apex.point;
    if (moved == 0 || apex.metric.c != metric_[v].c) carried_known_[v] = 0;
    metric_[v] = apex.metric;
    if (!plain_) own_averaged_[v] = apex.averaged;
  }
  if (moved != 0) {
    for (auto e : cavity_) topo_.touch[e] = topo_.clock;
    if (far)
      for (auto e : cavity_) topo_.birth[e] = topo_.clock;
    rate_all(apex);
    for (int i = 0; i < faces_.size(); ++i) rating_[faces_[i].element] = rates_[i];
    for (std::size_t i = 0; i < virtual_faces_.size(); ++i)
      topo_.label[virtual_faces_[i].element] = best_retag_[i];
    return;
  }
  births_.clear();
  rate_all(apex);
  const auto bear = [&](const CavityFace<D>& f, std::int32_t label, const Rating& rating) {
    if (f.contains(v)) return;
    Element nodes = topo_.elements[f.element];
    nodes[f.place] = v;
    births_.push_back({nodes, label, rating, f.element, f.place});
  };
  for (int i = 0; i < faces_.size(); ++i)
    bear(faces_[i], topo_.label[faces_[i].element], rates_[i]);
  for (std::size_t i = 0; i < virtual_faces_.size(); ++i)
    bear(virtual_faces_[i], best_retag_[i], {infinity, 0});
  // The first child of an element takes its place: but one all lists of elements stay as they are.
  std::size_t others = 0;
  for (const Birth& b : births_) {
    if (topo_.birth[b.element] == replaced) {
      births_[others++] = b;
      continue;
    }
    topo_.birth[b.element] = replaced;
    topo_.replace_node(b.element, b.place, v);
    topo_.label[b.element] = b.label;
    rating_[b.element] = b.rating;
  }
  births_.resize(others);
  for (auto e : cavity_) {
    if (topo_.birth[e] != replaced) {
      topo_.remove(e);
      continue;
    }
    topo_.birth[e] = topo_.touch[e] = topo_.clock;
  }
  for (const Birth& b : births_) {
    const std::int32_t e = topo_.add(b.nodes, b.label);
    if (static_cast<std::size_t>(e) >= rating_.size()) rating_.resize(e + 1);
    rating_[e] = b.rating;
  }
}

template <int D>
void StarOptimizer<D>::release_if_unused(NodeId n) {
  if (topo_.around.empty(n)) topo_.free_nodes.push_back(n);
}

template <int D>
Block<D> StarOptimizer<D>::take() {
  Block<D> out;
  WorkMesh<D>& mesh = out.mesh;
  out.shared.push_back(0);
  std::vector<NodeId> id(topo_.points.size(), 0);
  if (!asked_.empty()) mesh.asked = {Vec<D>::Zero()};
  for (std::size_t i = 1; i < topo_.points.size(); ++i) {
    const auto n = static_cast<NodeId>(i);
    if (topo_.around.empty(n)) continue;
    id[i] = static_cast<NodeId>(mesh.points.size());
    mesh.points.push_back(topo_.points[i]);
    mesh.metric.push_back(metric_[i]);
    if (!asked_.empty()) mesh.asked.push_back(asked_[i]);
    mesh.fixed.push_back(fixed_[i]);
    const std::uint32_t seen = locked(n) ? (dirty_[i] ? 0 : 1) : done_[i];
    bool dirty = false;
    for (auto e : topo_.around.of(n)) dirty = dirty || topo_.touch[e] > seen;
    mesh.dirty.push_back(dirty);
    out.shared.push_back(shared_[i]);
  }
  for (std::size_t e = 0; e < topo_.elements.size(); ++e) {
    if (!topo_.alive(static_cast<std::int32_t>(e))) continue;
    Element nodes = topo_.elements[e];
    for (NodeId& n : nodes) n = id[n];
    mesh.elements.push_back(nodes);
    mesh.label.push_back(topo_.label[e]);
  }
  return out;
}

template class StarOptimizer<2>;
template class StarOptimizer<3>;
template class StarOptimizer<4>;

}  // namespace lamella
