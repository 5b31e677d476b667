#pragma once

#include <array>
#include <utility>
#include <vector>

#include "core/geometry/simplex.h"

namespace lamella::test {

/// Triangles without connectivity, as an STL holds them.
using Soup = std::vector<std::array<Vec<3>, 3>>;

/// The 12 outward triangles of a box.
inline Soup box_soup(const Vec<3>& low, const Vec<3>& high) {
  const auto corner = [&](int i) {
    return Vec<3>{i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]};
  };
  constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  Soup soup;
  for (const auto& f : kFaces) {
    soup.push_back({corner(f[0]), corner(f[1]), corner(f[2])});
    soup.push_back({corner(f[0]), corner(f[2]), corner(f[3])});
  }
  return soup;
}

inline Soup unit_box() { return box_soup(Vec<3>::Zero(), Vec<3>::Ones()); }

inline Soup turned(Soup soup) {
  for (auto& facet : soup) std::swap(facet[1], facet[2]);
  return soup;
}

inline Soup both(Soup a, const Soup& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace lamella::test
