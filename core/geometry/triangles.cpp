#include "core/geometry/triangles.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

namespace lamella {
namespace {

using Facet = std::array<std::int32_t, 3>;

bool has_repeated_vertex(const Facet& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; }

}  // namespace

Triangles merge_exact(const TriangleSoup& soup) {
  const std::size_t n = 3 * soup.size();
  const auto point = [&](std::size_t i) -> const Vec<3>& { return soup[i / 3][i % 3]; };
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Vec<3>& p = point(i);
    const Vec<3>& q = point(j);
    for (int k = 0; k < 3; ++k) {
      if (p[k] < q[k]) return true;
      if (p[k] > q[k]) return false;
      // Damaged files hold what is no number: an order of its own keeps the sort sound.
      if (std::isnan(p[k]) != std::isnan(q[k])) return std::isnan(q[k]);
    }
    return i < j;
  });
  std::vector<std::uint32_t> first(n);
  for (std::size_t k = 0; k < n; ++k) {
    const bool same = k > 0 && point(order[k]) == point(order[k - 1]);
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  Triangles t;
  t.facets.resize(soup.size());
  std::vector<std::int32_t> id(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (first[i] == i) {
      id[i] = static_cast<std::int32_t>(t.points.size());
      t.points.push_back(point(i));
    }
    t.facets[i / 3][i % 3] = id[first[i]];
  }
  return t;
}

std::size_t drop_degenerate(Triangles& t) { return std::erase_if(t.facets, has_repeated_vertex); }

std::size_t drop_duplicates(Triangles& t) {
  struct Key {
    Facet sorted;
    int sign;
    std::size_t facet;
  };
  std::vector<Key> keys;
  keys.reserve(t.facets.size());
  for (std::size_t f = 0; f < t.facets.size(); ++f) {
    Facet s = t.facets[f];
    std::sort(s.begin(), s.end());
    const int at = static_cast<int>(std::find(t.facets[f].begin(), t.facets[f].end(), s[0]) -
                                    t.facets[f].begin());
    keys.push_back({s, t.facets[f][(at + 1) % 3] == s[1] ? 1 : -1, f});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& x, const Key& y) {
    return x.sorted != y.sorted ? x.sorted < y.sorted : x.facet < y.facet;
  });
  // Edges that as many facets run along as against bound closed bodies: copies there belong to
  // several of them.
  std::vector<char> balanced(t.facets.size(), 1);
  for_each_edge(edge_uses(t.facets), [&](std::span<const EdgeUse> edge) {
    std::ptrdiff_t sum = 0;
    for (const EdgeUse& use : edge) sum += use.forward ? 1 : -1;
    if (sum != 0)
      for (const EdgeUse& use : edge) balanced[use.facet] = 0;
  });
  std::vector<char> keep(t.facets.size(), 1);
  for (std::size_t i = 0; i < keys.size();) {
    std::size_t j = i;
    int net = 0;
    for (; j < keys.size() && keys[j].sorted == keys[i].sorted; ++j) net += keys[j].sign;
    int most = balanced[keys[i].facet] ? std::abs(net) : 1;
    for (std::size_t k = i; k < j; ++k) {
      const bool chosen = most > 0 && net * keys[k].sign > 0;
      most -= chosen ? 1 : 0;
      keep[keys[k].facet] = chosen ? 1 : 0;
    }
    i = j;
  }
  std::size_t f = 0;
  return std::erase_if(t.facets, [&](const Facet&) { return !keep[f++]; });
}

Triangles subset(const Triangles& t, const std::vector<std::int32_t>& facets) {
  Triangles part;
  std::vector<std::int32_t> id(t.points.size(), -1);
  for (const std::int32_t f : facets) {
    Facet mine = t.facets[f];
    for (std::int32_t& v : mine) {
      if (id[v] < 0) {
        id[v] = static_cast<std::int32_t>(part.points.size());
        part.points.push_back(t.points[v]);
      }
      v = id[v];
    }
    part.facets.push_back(mine);
  }
  return part;
}

ReferenceSurface<3> plain_surface(const Triangles& t) {
  ReferenceSurface<3> s;
  s.points = t.points;
  s.facets = t.facets;
  s.facet_face.assign(t.facets.size(), 0);
  s.faces.resize(1);
  return s;
}

bool lies_inside(const Triangles& t, const std::vector<std::int32_t>& in,
                 const std::vector<std::int32_t>& out) {
  const std::size_t step = std::max<std::size_t>(1, in.size() / 8);
  double winding = 0;
  for (std::size_t k = 0; k < in.size(); k += step) {
    const auto p = t.corners(in[k]);
    const Vec<3> x = (p[0] + p[1] + p[2]) / 3;
    winding = 0;
    for (const std::int32_t f : out) winding += solid_angle(t.corners(f), x);
    winding = std::abs(winding) / (4 * std::numbers::pi);
    if (std::abs(winding - 0.5) > 0.25) break;
  }
  return winding > 0.5;
}

EdgeDefects find_edge_defects(const Triangles& t) {
  EdgeDefects d;
  for_each_edge(edge_uses(t.facets), [&](std::span<const EdgeUse> uses) {
    if (uses.size() == 2) return;
    const Vec<3> middle = 0.5 * (t.points[uses[0].a] + t.points[uses[0].b]);
    if (uses.size() == 1) {
      if (d.open++ == 0) d.open_at = middle;
    } else if (d.non_manifold++ == 0) {
      d.non_manifold_at = middle;
    }
  });
  return d;
}

double solid_angle(const std::array<Vec<3>, 3>& facet, const Vec<3>& x) {
  const Vec<3> a = facet[0] - x, b = facet[1] - x, c = facet[2] - x;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)),
                        la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

double diagonal_of(const std::vector<Vec<3>>& points) {
  Vec<3> low = Vec<3>::Constant(1e300), high = -low;
  for (const Vec<3>& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return points.empty() ? 0 : (high - low).norm();
}

std::string place_text(const Vec<3>& p) {
  const double none = 1e-6 * p.cwiseAbs().maxCoeff();
  const auto seen = [&](double x) { return std::abs(x) < none ? 0 : x; };
  char text[96];
  std::snprintf(text, sizeof(text), "(%.6g, %.6g, %.6g)", seen(p[0]), seen(p[1]), seen(p[2]));
  return text;
}

std::string counted(std::size_t n, const std::string& what) {
  if (n != 1 && what.ends_with("body")) return std::to_string(n) + " bodies";
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

std::string length_text(double x) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", x);
  return text;
}

}  // namespace lamella
