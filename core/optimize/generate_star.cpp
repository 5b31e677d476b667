#include "core/optimize/generate_star.h"

#include <limits>

namespace lamella {
namespace {

template <std::size_t N>
std::array<NodeId, N> sorted(std::array<NodeId, N> a) {
  for (std::size_t i = 1; i < N; ++i)
    for (std::size_t j = i; j > 0 && a[j] < a[j - 1]; --j) std::swap(a[j], a[j - 1]);
  return a;
}

template <std::size_t N>
bool has(const std::array<NodeId, N>& a, NodeId n) {
  for (const NodeId m : a)
    if (m == n) return true;
  return false;
}

template <std::size_t N>
std::size_t hash(const std::array<NodeId, N>& a) {
  std::uint64_t h = 0;
  for (const NodeId n : a) {
    h = (h ^ static_cast<std::uint64_t>(n)) * 0x9E3779B97F4A7C15ull;
    h ^= h >> 29;
  }
  return h;
}

/// Finds the slot of `key` in a table of a power of two size, or claims an empty one.
template <class Slot, class Key>
Slot& slot_of(std::vector<Slot>& table, const Key& key, unsigned stamp, bool& added) {
  const std::size_t mask = table.size() - 1;
  std::size_t i = hash(key) & mask;
  while (table[i].stamp == stamp && table[i].key != key) i = (i + 1) & mask;
  added = table[i].stamp != stamp;
  if (added) {
    table[i] = {};
    table[i].key = key;
    table[i].stamp = stamp;
  }
  return table[i];
}

template <class Slot>
void reserve_table(std::vector<Slot>& table, std::size_t entries) {
  std::size_t size = 256;
  while (size < 2 * entries) size *= 2;
  if (table.size() < size) table.assign(size, Slot{});
}

}  // namespace

template <int D>
typename StarOperator<D>::Face StarOperator<D>::make_face(
    const std::array<NodeId, D>& nodes) const {
  std::array<Vec<D>, D> p;
  for (int k = 0; k < D; ++k) p[k] = t_.point(nodes[k]);
  Face f{nodes, facet_normal<D>(p), p[0], 1, 0};
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < i; ++j) {
      const double l2 = (p[i] - p[j]).squaredNorm();
      f.edges += l2;
      if (j == 0) f.scale *= std::sqrt(l2);
    }
  return f;
}

template <int D>
double StarOperator<D>::shape(const Face& f, double v, const Vec<D>& apex) const {
  double l2 = f.edges;
  for (const NodeId n : f.nodes) l2 += (t_.point(n) - apex).squaredNorm();
  if constexpr (D == 2) return v / l2;
  if constexpr (D == 3) return v / (l2 * std::sqrt(l2));
  return v / (l2 * l2);
}

template <int D>
void StarOperator<D>::start(const Bridged<D>& boundary, NodeId apex) {
  cavity_.clear();
  faces_.clear();
  rim_.clear();
  for (const auto& e : boundary.elements) {
    bool flat;
    const double v = volume(make_face(opposite_facet<D>(e, 0)), t_.point(e[0]), flat);
    t_.add_element(e, v <= 0 || flat);
  }
  for (const auto& nodes : boundary.facets) {
    faces_.push_back(make_face(nodes));
    rim_.insert(rim_.end(), nodes.begin(), nodes.end());
  }
  if (!apex) {
    Vec<D> center = Vec<D>::Zero();
    for (const NodeId n : rim_) center += t_.point(n) / static_cast<double>(rim_.size());
    apex = t_.add_node(kernel_point(center));
  }
  apply(apex);
}

template <int D>
const std::vector<NodeId>& StarOperator<D>::neighbors(NodeId n) {
  neighbors_.clear();
  clear_nodes();
  mark_node(n);
  for (const int e : t_.around(n))
    for (const NodeId m : t_.element(e))
      if (mark_node(m)) neighbors_.push_back(m);
  return neighbors_;
}

template <int D>
bool StarOperator<D>::improve_node(NodeId s) {
  if (t_.degree(s) == 0 || t_.degree(s) > kLargestCavity) return false;
  neighbors(s);
  neighbors_.push_back(s);
  return cut_vertex_set(neighbors_) && improve(0);
}

template <int D>
bool StarOperator<D>::improve_edge(NodeId a, NodeId b) {
  if (t_.degree(a) > t_.degree(b)) std::swap(a, b);
  if (t_.degree(a) == 0) return false;
  // Common neighbors: nodes that share an element with a, and one with b. The enriched set needs
  // both lists; b's may be the whole mesh, so its neighborhood is asked node by node.
  neighbors(a);
  inner_.clear();
  bool linked = false;
  for (const NodeId n : neighbors_) {
    if (n == b) {
      linked = true;
      continue;
    }
    const auto& list = t_.degree(n) < t_.degree(b) ? t_.around(n) : t_.around(b);
    const NodeId other = t_.degree(n) < t_.degree(b) ? b : n;
    for (const int e : list) {
      const auto& v = t_.element(e);
      if (has(v, other)) {
        inner_.push_back(n);
        break;
      }
    }
  }
  if (!linked) return false;
  inner_.push_back(a);
  inner_.push_back(b);
  clear_nodes();
  for (const NodeId n : inner_) mark_node(n);
  return cut_vertex_set(inner_) && improve(0);
}

/// The elements with all vertices among the marked nodes, which are `seeds`; false if too many.
template <int D>
bool StarOperator<D>::cut_vertex_set(const std::vector<NodeId>& seeds) {
  cavity_.clear();
  clear_elements();
  // An element has at least two seeds, so the longest list need not be read.
  const NodeId longest = *std::max_element(
      seeds.begin(), seeds.end(), [&](NodeId a, NodeId b) { return t_.degree(a) < t_.degree(b); });
  for (const NodeId n : seeds) {
    if (n == longest) continue;
    for (const int e : t_.around(n)) {
      if (in_cavity(e)) continue;
      const auto& v = t_.element(e);
      if (std::all_of(v.begin(), v.end(), [&](NodeId m) { return node_marked(m); })) {
        element_mark_[e] = element_stamp_;
        cavity_.push_back(e);
      }
    }
  }
  return static_cast<int>(cavity_.size()) <= kLargestCavity;
}

template <int D>
int StarOperator<D>::across(int e, const std::array<NodeId, D>& face) const {
  NodeId least = face[0];
  for (const NodeId n : face)
    if (t_.degree(n) < t_.degree(least)) least = n;
  for (const int other : t_.around(least)) {
    if (other == e) continue;
    const auto& v = t_.element(other);
    if (std::all_of(face.begin(), face.end(), [&](NodeId n) { return has(v, n); })) return other;
  }
  return -1;
}

template <int D>
bool StarOperator<D>::improve_seen_from(int seed, NodeId apex, int limit, bool strict) {
  cavity_.assign(1, seed);
  clear_elements();
  element_mark_[seed] = element_stamp_;
  const Vec<D> x = t_.point(apex);
  for (std::size_t i = 0; i < cavity_.size(); ++i) {
    const auto v = t_.element(cavity_[i]);
    for (int k = 0; k <= D; ++k) {
      const auto nodes = opposite_facet<D>(v, k);
      if (has(nodes, apex)) continue;
      bool flat;
      const double vol = volume(make_face(nodes), x, flat);
      if (vol > 0 && !flat) continue;
      const int next = across(cavity_[i], nodes);
      if (next < 0 && strict) return false;
      if (next < 0 || in_cavity(next)) continue;
      if (static_cast<int>(cavity_.size()) >= limit) return false;
      element_mark_[next] = element_stamp_;
      cavity_.push_back(next);
    }
  }
  return improve(apex);
}

/// Fills faces_ and rim_ from cavity_: the faces seen once.
template <int D>
bool StarOperator<D>::take_boundary() {
  reserve_table(face_table_, cavity_.size() * (D + 1));
  ++table_stamp_;
  for (const int e : cavity_)
    for (int k = 0; k <= D; ++k) {
      bool added;
      auto& slot =
          slot_of(face_table_, sorted(opposite_facet<D>(t_.element(e), k)), table_stamp_, added);
      slot.face = added ? e * (D + 1) + k : -1;
    }
  faces_.clear();
  rim_.clear();
  clear_nodes();
  for (const int e : cavity_)
    for (int k = 0; k <= D; ++k) {
      const auto nodes = opposite_facet<D>(t_.element(e), k);
      bool added;
      const auto& slot = slot_of(face_table_, sorted(nodes), table_stamp_, added);
      if (slot.face != e * (D + 1) + k) continue;
      faces_.push_back(make_face(nodes));
      for (const NodeId n : nodes)
        if (mark_node(n)) rim_.push_back(n);
    }
  std::sort(rim_.begin(), rim_.end());
  return !faces_.empty();
}

template <int D>
void StarOperator<D>::weigh_present() {
  present_.inverted = 0;
  present_.shapes.clear();
  double sum = 0;
  for (const int e : cavity_) {
    const auto& v = t_.element(e);
    const Face f = make_face(opposite_facet<D>(v, 0));
    bool flat;
    const double vol = volume(f, t_.point(v[0]), flat);
    sum += std::abs(vol);
    if (vol < 0 && !flat) present_.inverted -= vol;
    present_.shapes.push_back(flat ? 0 : shape(f, vol, t_.point(v[0])));
  }
  std::sort(present_.shapes.begin(), present_.shapes.end());
  tolerance_ = 1e-12 * sum;
}

/// False as soon as the star from `apex` exceeds the inverted volume allowed.
template <int D>
bool StarOperator<D>::weigh(const Vec<D>& apex, NodeId id, double inverted_limit,
                            Worth& out) const {
  out.inverted = 0;
  out.shapes.clear();
  for (const Face& f : faces_) {
    if (has(f.nodes, id)) continue;
    bool flat;
    const double v = volume(f, apex, flat);
    if (v < 0 && !flat) {
      out.inverted -= v;
      if (out.inverted > inverted_limit) return false;
    }
    out.shapes.push_back(flat ? 0 : v);
  }
  return true;
}

template <int D>
bool StarOperator<D>::better(const Worth& a, const Worth& b) const {
  if (std::abs(a.inverted - b.inverted) > tolerance_) return a.inverted < b.inverted;
  const std::size_t n = std::min(a.shapes.size(), b.shapes.size());
  for (std::size_t i = 0; i < n; ++i)
    if (std::abs(a.shapes[i] - b.shapes[i]) > 1e-9 * std::abs(b.shapes[i]))
      return a.shapes[i] > b.shapes[i];
  return a.shapes.size() < b.shapes.size();
}

/// Proposition 2.3: the boundary of the cavity has no boundary itself, and no face of the star but
/// those of the cavity's boundary belongs to an element outside.
template <int D>
bool StarOperator<D>::legal(NodeId apex) {
  reserve_table(edge_table_, faces_.size() * D);
  ++table_stamp_;
  for (const Face& f : faces_)
    for (int k = 0; k < D; ++k) {
      const bool has_apex = has(f.nodes, apex);
      if (has_apex && f.nodes[k] != apex) continue;
      std::array<NodeId, D - 1> edge;
      for (int i = 0, j = 0; i < D; ++i)
        if (i != k) edge[j++] = f.nodes[i];
      bool added;
      auto& slot = slot_of(edge_table_, sorted(edge), table_stamp_, added);
      ++(has_apex ? slot.held : slot.free);
      if (slot.free + slot.held > 2) return false;
    }
  for (const Face& f : faces_)
    for (int k = 0; k < D; ++k) {
      if (has(f.nodes, apex)) break;
      std::array<NodeId, D - 1> edge;
      for (int i = 0, j = 0; i < D; ++i)
        if (i != k) edge[j++] = f.nodes[i];
      bool added;
      auto& slot = slot_of(edge_table_, sorted(edge), table_stamp_, added);
      if (slot.free + slot.held != 2) return false;
      if (apex && slot.free == 2 && !slot.checked) {
        if (exists_outside(apex, edge)) return false;
        slot.checked = true;
      }
    }
  return true;
}

template <int D>
bool StarOperator<D>::exists_outside(NodeId apex, const std::array<NodeId, D - 1>& edge) const {
  NodeId least = apex;
  for (const NodeId n : edge)
    if (t_.degree(n) < t_.degree(least)) least = n;
  for (const int e : t_.around(least)) {
    if (in_cavity(e)) continue;
    const auto& v = t_.element(e);
    if (!has(v, apex)) continue;
    if (std::all_of(edge.begin(), edge.end(), [&](NodeId n) { return has(v, n); })) return true;
  }
  return false;
}

/// Maximizes the smallest distance to the planes of the cavity's faces: a point of its kernel
/// when there is one. Newton's method on a smoothed maximum, sharpened in steps.
template <int D>
Vec<D> StarOperator<D>::kernel_point(const Vec<D>& from) const {
  Vec<D> lo = t_.point(rim_[0]), hi = lo;
  for (const NodeId n : rim_) {
    lo = lo.cwiseMin(t_.point(n));
    hi = hi.cwiseMax(t_.point(n));
  }
  const double size = (hi - lo).norm();
  const auto smoothed = [&](const Vec<D>& x, double sharp, Vec<D>* g, Mat<D>* h) {
    double top = -std::numeric_limits<double>::infinity();
    for (const Face& f : faces_) {
      const double n = f.normal.norm();
      if (n > 0) top = std::max(top, f.normal.dot(x - f.base) / n);
    }
    double sum = 0;
    if (g) g->setZero(), h->setZero();
    for (const Face& f : faces_) {
      const double n = f.normal.norm();
      if (n <= 0) continue;
      const Vec<D> u = f.normal / n;
      const double w = std::exp(sharp * (u.dot(x - f.base) - top));
      sum += w;
      if (g) {
        *g += w * u;
        *h += w * u * u.transpose();
      }
    }
    if (g) {
      *g /= sum;
      *h = sharp * (*h / sum - *g * g->transpose());
    }
    return top + std::log(sum) / sharp;
  };
  Vec<D> x = from;
  for (double sharp = 8 / size; sharp < 2e4 / size; sharp *= 12) {
    for (int it = 0; it < 5; ++it) {
      Vec<D> g;
      Mat<D> h;
      const double here = smoothed(x, sharp, &g, &h);
      h.diagonal().array() += 1e-3 * sharp;
      Vec<D> step = -h.ldlt().solve(g);
      if (step.norm() > 0.3 * size) step *= 0.3 * size / step.norm();
      double t = 1;
      const double slope = g.dot(step);
      while (t > 1e-3 && smoothed(x + t * step, sharp, nullptr, nullptr) > here + 0.1 * t * slope)
        t *= 0.4;
      if (t <= 1e-3) break;
      x += t * step;
      if (t * step.norm() < 1e-6 * size) break;
    }
  }
  return x.cwiseMax(lo).cwiseMin(hi);
}

template <int D>
bool StarOperator<D>::take_best(NodeId id, const Vec<D>& apex, double limit) {
  if (!weigh(apex, id, limit, trial_) || trial_.shapes.empty()) return false;
  // Shapes need distances: only now that the volume is not worse.
  std::size_t i = 0;
  for (const Face& f : faces_) {
    if (has(f.nodes, id)) continue;
    if (trial_.shapes[i] != 0) trial_.shapes[i] = shape(f, trial_.shapes[i], apex);
    ++i;
  }
  std::sort(trial_.shapes.begin(), trial_.shapes.end());
  if (!better(trial_, best_) || !legal(id)) return false;
  std::swap(best_, trial_);
  return true;
}

template <int D>
bool StarOperator<D>::improve(NodeId only) {
  if (cavity_.size() < 2 || !take_boundary()) return false;
  weigh_present();
  best_ = present_;
  NodeId winner = -1;
  const auto consider = [&](NodeId n) {
    if (take_best(n, t_.point(n), best_.inverted + tolerance_)) winner = n;
  };
  if (only) {
    consider(only);
    if (winner > 0) apply(winner);
    return winner > 0;
  }
  for (const NodeId n : rim_) consider(n);
  take_inner();
  for (const NodeId n : inner_) consider(n);

  // A new point only where nothing else gives a well oriented star, and only if it pays: a little
  // gain for one more node each time would fill the folded zones with nodes.
  Vec<D> spot = Vec<D>::Zero();
  if (best_.shapes.front() <= 0) {
    Vec<D> center = Vec<D>::Zero();
    for (const NodeId n : rim_) center += t_.point(n);
    center /= static_cast<double>(rim_.size());
    for (const Vec<D>& x : {center, kernel_point(center)}) {
      const double share = inner_.empty() ? 0.5 : 1;
      if (take_best(0, x, share * best_.inverted + tolerance_)) winner = 0, spot = x;
    }
  }
  if (winner < 0) return false;
  apply(winner ? winner : t_.add_node(spot));
  return true;
}

template <int D>
bool StarOperator<D>::restar(const std::vector<int>& elements) {
  cavity_ = elements;
  clear_elements();
  for (const int e : cavity_) element_mark_[e] = element_stamp_;
  if (cavity_.size() < 2 || !take_boundary()) return false;
  weigh_present();
  constexpr double kAny = std::numeric_limits<double>::infinity();
  best_.inverted = kAny;
  best_.shapes.clear();
  NodeId winner = 0;
  for (const NodeId n : rim_)
    if (take_best(n, t_.point(n), kAny)) winner = n;
  if (winner) apply(winner);
  return winner != 0;
}

/// Nodes of the cavity that are not on its boundary: free points already paid for.
template <int D>
void StarOperator<D>::take_inner() {
  inner_.clear();
  clear_nodes();
  for (const NodeId n : rim_) mark_node(n);
  for (const int e : cavity_)
    for (const NodeId n : t_.element(e))
      if (mark_node(n)) inner_.push_back(n);
  std::sort(inner_.begin(), inner_.end());
}

template <int D>
void StarOperator<D>::apply(NodeId apex) {
  inner_.clear();
  for (const int e : cavity_) {
    for (const NodeId n : t_.element(e))
      if (!t_.on_surface(n)) inner_.push_back(n);
    t_.remove_element(e);
  }
  for (const Face& f : faces_) {
    if (has(f.nodes, apex)) continue;
    bool flat;
    const double v = volume(f, t_.point(apex), flat);
    std::array<NodeId, D + 1> e;
    for (int k = 0; k < D; ++k) e[k] = f.nodes[k];
    e[D] = apex;
    std::swap(e[0], e[1]);
    t_.add_element(e, v <= 0 || flat);
  }
  std::sort(inner_.begin(), inner_.end());
  inner_.erase(std::unique(inner_.begin(), inner_.end()), inner_.end());
  for (const NodeId n : inner_) t_.drop_node_if_unused(n);
  rim_.push_back(apex);
}

template <int D>
double StarOperator<D>::inverted_volume(Vec<D>* where) const {
  double sum = 0, worst = 0;
  for (int e = 0; e < t_.element_end(); ++e) {
    if (!t_.alive(e) || !t_.bad(e)) continue;
    const auto& v = t_.element(e);
    bool flat;
    const double vol = volume(make_face(opposite_facet<D>(v, 0)), t_.point(v[0]), flat);
    if (vol < 0) sum -= vol;
    if (where && vol <= worst) {
      worst = vol;
      where->setZero();
      for (const NodeId n : v) *where += t_.point(n) / (D + 1);
    }
  }
  return sum / factorial(D);
}

template class StarOperator<2>;
template class StarOperator<3>;
template class StarOperator<4>;

}  // namespace lamella
