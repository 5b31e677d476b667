#include "core/optimize/generate_bridge.h"

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>

#include "core/base/disjoint_sets.h"

namespace lamella {
namespace {

template <int D>
using Facet = std::array<NodeId, D>;

template <int D>
bool disjoint(const Facet<D>& a, const Facet<D>& b) {
  return std::none_of(a.begin(), a.end(),
                      [&](NodeId n) { return std::find(b.begin(), b.end(), n) != b.end(); });
}

template <std::size_t N>
bool even_permutation(std::array<NodeId, N> a, std::array<NodeId, N> b) {
  bool even = true;
  for (auto* x : {&a, &b})
    for (std::size_t i = 1; i < N; ++i)
      for (std::size_t j = i; j > 0 && (*x)[j] < (*x)[j - 1]; --j) {
        std::swap((*x)[j], (*x)[j - 1]);
        even = !even;
      }
  return even;
}

}  // namespace

template <int D>
int number_shells(const std::vector<Facet<D>>& facets, std::vector<int>& shell) {
  DisjointSets shells(facets.size());
  std::vector<std::pair<std::array<NodeId, D - 1>, int>> edges;
  edges.reserve(facets.size() * D);
  for (int f = 0; f < static_cast<int>(facets.size()); ++f)
    for (int k = 0; k < D; ++k) {
      std::array<NodeId, D - 1> e;
      for (int i = 0, j = 0; i < D; ++i)
        if (i != k) e[j++] = facets[f][i];
      std::sort(e.begin(), e.end());
      edges.emplace_back(e, f);
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].first == edges[i - 1].first) shells.join(edges[i].second, edges[i - 1].second);
  shell.assign(facets.size(), 0);
  std::map<int, int> number;
  for (int f = 0; f < static_cast<int>(facets.size()); ++f)
    shell[f] = number.try_emplace(shells.root(f), static_cast<int>(number.size())).first->second;
  return static_cast<int>(number.size());
}

template <int D>
Bridged<D> bridge_shells(const ReferenceSurface<D>& surface) {
  Bridged<D> out;
  std::vector<Facet<D>> facets;
  facets.reserve(surface.facets.size());
  for (const auto& f : surface.facets) {
    Facet<D> g;
    for (int k = 0; k < D; ++k) g[k] = f[k] + 1;
    facets.push_back(g);
  }
  std::vector<int> shell;
  out.shells = number_shells<D>(facets, shell);
  if (out.shells < 2) {
    out.facets = std::move(facets);
    return out;
  }

  const auto at = [&](NodeId n) -> const Vec<D>& { return surface.points[n - 1]; };
  std::vector<Vec<D>> middle;
  for (const auto& f : facets) {
    Vec<D> m = Vec<D>::Zero();
    for (const NodeId n : f) m += at(n) / D;
    middle.push_back(m);
  }
  // Prim's tree over the shells: nearest[f] is the closest facet of the part already tied.
  std::vector<char> used(facets.size(), 0), tied(out.shells, 0);
  std::vector<int> nearest(facets.size(), -1);
  std::vector<double> distance(facets.size(), std::numeric_limits<double>::infinity());
  std::vector<Facet<D>> sides;
  const auto tie = [&](int s) {
    tied[s] = 1;
    for (int g = 0; g < static_cast<int>(facets.size()); ++g)
      if (shell[g] == s && !used[g])
        for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
          if (tied[shell[f]]) continue;
          const double d = (middle[f] - middle[g]).squaredNorm();
          if (d < distance[f] && disjoint<D>(facets[f], facets[g])) distance[f] = d, nearest[f] = g;
        }
  };
  tie(shell[0]);
  for (int count = 1; count < out.shells; ++count) {
    int best = -1;
    for (int f = 0; f < static_cast<int>(facets.size()); ++f)
      if (!tied[shell[f]] && nearest[f] >= 0 && !used[nearest[f]] &&
          (best < 0 || distance[f] < distance[best]))
        best = f;
    if (best < 0) break;  // every near facet is taken: the pieces stay apart and the run will stall
    const int mate = nearest[best];
    used[best] = used[mate] = 1;
    const Facet<D> a = facets[mate];
    Facet<D> p = facets[best], turned = p;
    // The two ends of a prism are wound against each other; among those pairings, the shortest.
    double least = std::numeric_limits<double>::infinity();
    std::sort(p.begin(), p.end());
    do {
      if (even_permutation(p, facets[best])) continue;
      double sum = 0;
      for (int k = 0; k < D; ++k) sum += (at(p[k]) - at(a[k])).squaredNorm();
      if (sum < least) least = sum, turned = p;
    } while (std::next_permutation(p.begin(), p.end()));

    std::vector<Facet<D>> seen;
    bool turn = false;
    for (int i = D - 1; i >= 0; --i) {
      std::array<NodeId, D + 1> e;
      for (int k = 0; k <= i; ++k) e[k] = a[k];
      for (int k = i; k < D; ++k) e[k + 1] = turned[k];
      if (i == D - 1) turn = !even_permutation(opposite_facet<D>(e, D), a);
      if (turn) std::swap(e[0], e[1]);
      turn = !turn;  // the next one differs in one place: the other orientation
      out.elements.push_back(e);
      for (int k = 0; k <= D; ++k) seen.push_back(opposite_facet<D>(e, k));
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const auto same = [&](const Facet<D>& f) {
        return std::is_permutation(f.begin(), f.end(), seen[i].begin());
      };
      if (std::count_if(seen.begin(), seen.end(), same) > 1 || same(a) || same(turned)) continue;
      std::swap(seen[i][0], seen[i][1]);
      sides.push_back(seen[i]);
      std::swap(seen[i][0], seen[i][1]);
    }
    tie(shell[best]);
  }
  for (std::size_t f = 0; f < facets.size(); ++f)
    if (!used[f]) out.facets.push_back(facets[f]);
  out.facets.insert(out.facets.end(), sides.begin(), sides.end());
  return out;
}

template <int D>
Result<void> check_boundary(const ReferenceSurface<D>& surface) {
  const std::string hint = "Close the surface, or have it repaired, before it is meshed.";
  if (surface.facets.empty()) return Error{Code::bad_input, "The surface has no facet.", hint};
  struct Use {
    std::array<std::int32_t, D - 1> edge;
    bool odd;
  };
  std::vector<Use> uses;
  uses.reserve(surface.facets.size() * D);
  for (const auto& f : surface.facets)
    for (int k = 0; k < D; ++k) {
      if (f[k] < 0 || f[k] >= static_cast<std::int32_t>(surface.points.size()))
        return Error{Code::bad_input, "A facet of the surface names a point that is not there.",
                     ""};
      Use u{{}, (D - 1 - k) % 2 != 0};
      for (int i = 0, j = 0; i < D; ++i)
        if (i != k) u.edge[j++] = f[i];
      for (int i = 1; i < D - 1; ++i)
        for (int j = i; j > 0 && u.edge[j] < u.edge[j - 1]; --j) {
          std::swap(u.edge[j], u.edge[j - 1]);
          u.odd = !u.odd;
        }
      uses.push_back(u);
    }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.edge < b.edge; });
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i + 1;
    while (j < uses.size() && uses[j].edge == uses[i].edge) ++j;
    std::ostringstream where;
    where << "near (" << surface.points[uses[i].edge[0]].transpose() << ").";
    if ((j - i) % 2 == 1)
      return Error{Code::bad_input, "The surface is not closed " + where.str(), hint};
    if (j - i > 2)
      return Error{Code::failed, "The surface touches itself " + where.str(),
                   "Parts of a body that meet in a line only must be joined or set apart."};
    if (uses[i].odd == uses[i + 1].odd)
      return Error{Code::bad_input, "The winding of the surface changes " + where.str(), hint};
    i = j;
  }
  return {};
}

template Result<void> check_boundary<2>(const ReferenceSurface<2>&);
template Result<void> check_boundary<3>(const ReferenceSurface<3>&);
template Result<void> check_boundary<4>(const ReferenceSurface<4>&);
template int number_shells<2>(const std::vector<Facet<2>>&, std::vector<int>&);
template int number_shells<3>(const std::vector<Facet<3>>&, std::vector<int>&);
template int number_shells<4>(const std::vector<Facet<4>>&, std::vector<int>&);
template Bridged<2> bridge_shells<2>(const ReferenceSurface<2>&);
template Bridged<3> bridge_shells<3>(const ReferenceSurface<3>&);
template Bridged<4> bridge_shells<4>(const ReferenceSurface<4>&);

}  // namespace lamella
