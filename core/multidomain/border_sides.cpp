#include "core/multidomain/border_sides.h"

#include <algorithm>
#include <limits>

namespace lamella {
namespace {

using Element = CutTopology::Element;

/// Price of an element on the wrong side, of its surface: folds are dearer, the ridges between
/// facets of a curved border are not.
constexpr double wrong_share = 0.1;
constexpr int rounds = 12;

/// The minimal cut between two terminals, by shortest augmenting paths in layers.
class Flow {
 public:
  explicit Flow(std::size_t nodes) : first_(nodes, -1), layer_(nodes), next_(nodes) {}

  /// `there` and `back`: capacities.
  void connect(std::size_t a, std::size_t b, double there, double back) {
    add(a, b, there);
    add(b, a, back);
    largest_ = std::max({largest_, there, back});
  }

  /// [node] whether it is on the side of the source.
  std::vector<char> cut(std::size_t source, std::size_t sink) {
    while (find_layers(source, sink)) {
      next_ = first_;
      while (augment(source, sink)) {
      }
    }
    std::vector<char> reached(first_.size());
    for (std::size_t n = 0; n < reached.size(); ++n) reached[n] = layer_[n] >= 0;
    return reached;
  }

 private:
  struct Arc {
    std::size_t to;
    double left;
    std::int32_t next;
  };
  void add(std::size_t a, std::size_t b, double capacity) {
    arcs_.push_back({b, capacity, first_[a]});
    first_[a] = static_cast<std::int32_t>(arcs_.size()) - 1;
  }
  bool open(const Arc& arc) const { return arc.left > 1e-12 * largest_; }

  bool find_layers(std::size_t source, std::size_t sink) {
    std::fill(layer_.begin(), layer_.end(), -1);
    std::vector<std::size_t> queue{source};
    layer_[source] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i)
      for (std::int32_t a = first_[queue[i]]; a >= 0; a = arcs_[a].next)
        if (open(arcs_[a]) && layer_[arcs_[a].to] < 0) {
          layer_[arcs_[a].to] = layer_[queue[i]] + 1;
          queue.push_back(arcs_[a].to);
        }
    return layer_[sink] >= 0;
  }

  /// One path along the layers, and what fits through it.
  bool augment(std::size_t source, std::size_t sink) {
    std::vector<std::int32_t> path;
    std::size_t at = source;
    while (at != sink) {
      std::int32_t& a = next_[at];
      while (a >= 0 && !(open(arcs_[a]) && layer_[arcs_[a].to] == layer_[at] + 1))
        a = arcs_[a].next;
      if (a >= 0) {
        path.push_back(a);
        at = arcs_[a].to;
      } else {
        if (at == source) return false;
        layer_[at] = -2;  // leads nowhere
        at = arcs_[path.back() ^ 1].to;
        path.pop_back();
      }
    }
    double fits = std::numeric_limits<double>::infinity();
    for (std::int32_t a : path) fits = std::min(fits, arcs_[a].left);
    for (std::int32_t a : path) {
      arcs_[a].left -= fits;
      arcs_[a ^ 1].left += fits;
    }
    return true;
  }

  std::vector<std::int32_t> first_;
  std::vector<Arc> arcs_;
  std::vector<int> layer_;
  std::vector<std::int32_t> next_;
  double largest_ = 0;
};

}  // namespace

BorderSides::BorderSides(const CutTopology& mesh, std::vector<char>& inside)
    : mesh_(mesh), inside_(inside), true_side_(inside) {}

std::int32_t BorderSides::across(std::int32_t e, int k) const {
  const auto face = opposite_facet<3>(mesh_.topo.elements[e], k);
  for (auto other : mesh_.topo.around.of(face[0]))
    if (other != e && mesh_.active(other) && std::all_of(face.begin(), face.end(), [&](NodeId n) {
          return Topology<3>::has(mesh_.topo.elements[other], n);
        }))
      return other;
  return -1;
}

double BorderSides::face_area(std::int32_t e, int k) const {
  const auto f = opposite_facet<3>(mesh_.topo.elements[e], k);
  return 0.5 * facet_normal<3>({mesh_.at(f[0]), mesh_.at(f[1]), mesh_.at(f[2])}).norm();
}

double BorderSides::surface(std::int32_t e) const {
  double area = 0;
  for (int k = 0; k < 4; ++k) area += face_area(e, k);
  return area;
}

std::vector<char> BorderSides::least_cut(std::span<const std::int32_t> free) const {
  std::vector<std::int32_t> place(inside_.size(), -1);
  for (std::size_t i = 0; i < free.size(); ++i) place[free[i]] = static_cast<std::int32_t>(i);
  const std::size_t in = free.size(), out = in + 1;
  Flow flow(free.size() + 2);
  for (std::size_t i = 0; i < free.size(); ++i) {
    const std::int32_t e = free[i];
    double to_in = 0, to_out = 0;
    (true_side_[e] ? to_in : to_out) += wrong_share * surface(e);
    for (int k = 0; k < 4; ++k) {
      const std::int32_t n = across(e, k);
      if (n < 0) continue;
      const double area = face_area(e, k);
      if (place[n] < 0) {
        (inside_[n] ? to_in : to_out) += area;
      } else if (n > e) {
        flow.connect(i, static_cast<std::size_t>(place[n]), area, area);
      }
    }
    flow.connect(in, i, to_in, 0);
    flow.connect(i, out, to_out, 0);
  }
  return flow.cut(in, out);
}

int BorderSides::border_facets(NodeId a, NodeId b) const {
  int twice = 0;
  for (auto e : mesh_.topo.around.of(a)) {
    if (!mesh_.active(e) || !Topology<3>::has(mesh_.topo.elements[e], b)) continue;
    for (int k = 0; k < 4; ++k) {
      const NodeId apex = mesh_.topo.elements[e][k];
      if (apex == a || apex == b) continue;
      const std::int32_t next = across(e, k);
      twice += next >= 0 && inside_[next] != inside_[e];
    }
  }
  return twice / 2;
}

bool BorderSides::on_border(NodeId n) const {
  std::array<bool, 2> sides{};
  for (auto e : mesh_.topo.around.of(n))
    if (mesh_.active(e)) sides[inside_[e]] = true;
  return sides[0] && sides[1];
}

/// Whether the features of an element that were on the border by the true sides still are.
bool BorderSides::keeps_features(std::int32_t e) const {
  const Element& nodes = mesh_.topo.elements[e];
  const auto differ = [&](NodeId a, NodeId b, const std::vector<char>& side) {
    std::array<bool, 2> sides{};
    for (auto o : mesh_.topo.around.of(a))
      if (mesh_.active(o) && Topology<3>::has(mesh_.topo.elements[o], b)) sides[side[o]] = true;
    return sides[0] && sides[1];
  };
  for (int i = 0; i < 4; ++i) {
    if (mesh_.locked[nodes[i]] && differ(nodes[i], nodes[i], true_side_) && !on_border(nodes[i]))
      return false;
    for (int j = 0; j < i; ++j)
      if (mesh_.features.contains(mesh_.key(nodes[i], nodes[j])) &&
          differ(nodes[i], nodes[j], true_side_) && !differ(nodes[i], nodes[j], inside_))
        return false;
  }
  return true;
}

/// What is won, mm^2, if an element goes to the other side: area, and the square on edges of more
/// than two facets.
double BorderSides::gain(std::int32_t e) {
  const Element& nodes = mesh_.topo.elements[e];
  const auto price = [&] {
    double sum = inside_[e] == true_side_[e] ? 0 : wrong_share * surface(e);
    for (int k = 0; k < 4; ++k) {
      const std::int32_t n = across(e, k);
      if (n >= 0 && inside_[n] != inside_[e]) sum += face_area(e, k);
    }
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j)
        sum += std::max(0, border_facets(nodes[i], nodes[j]) - 2) *
               (mesh_.at(nodes[i]) - mesh_.at(nodes[j])).squaredNorm();
    return sum;
  };
  const double before = price();
  inside_[e] = !inside_[e];
  const double won = keeps_features(e) ? before - price() : -before;
  inside_[e] = !inside_[e];
  return won - 1e-9 * before;
}

void BorderSides::settle(std::span<const std::int32_t> doubtful) {
  std::vector<std::int32_t> free(doubtful.begin(), doubtful.end());
  for (int round = 0; round < rounds && !free.empty(); ++round) {
    const auto cut = least_cut(free);
    for (std::size_t i = 0; i < free.size(); ++i) inside_[free[i]] = cut[i];
    const auto kept = std::partition(free.begin(), free.end(), [&](std::int32_t e) {
      return inside_[e] == true_side_[e] || keeps_features(e);
    });
    if (kept == free.end()) break;
    // These stay where they are, and the others are cut again.
    free.erase(kept, free.end());
    for (auto e : doubtful) inside_[e] = true_side_[e];
    std::sort(free.begin(), free.end());
  }
  for (int round = 0; round < rounds; ++round) {
    bool any = false;
    for (auto e : doubtful)
      if (gain(e) > 0) {
        inside_[e] = !inside_[e];
        any = true;
      }
    if (!any) break;
  }
}

}  // namespace lamella
