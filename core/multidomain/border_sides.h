#pragma once

#include <span>
#include <vector>

#include "core/multidomain/cut_topology.h"

namespace lamella {

/// Which elements of the background lie inside of a zone, as char a element. An element between
/// nodes on the border, no deeper than the tolerance allows, could be counted to either side; where
/// the true one makes the border fold back onto itself, the other is better.
class BorderSides {
 public:
  BorderSides(const CutTopology& mesh, std::vector<char>& inside);

  /// The element of the background behind a face of an element; -1: none.
  std::int32_t across(std::int32_t e, int k) const;

  /// Sets the sides of the doubtful elements so that the area of the border, with a price for each
  /// element on the wrong side, is least (a minimal cut); then those at edges with more than two
  /// facets of the border. Feature edges and locked nodes of the border stay on it.
  void settle(std::span<const std::int32_t> doubtful);

 private:
  double face_area(std::int32_t e, int k) const;
  double surface(std::int32_t e) const;
  std::vector<char> least_cut(std::span<const std::int32_t> free) const;
  int border_facets(NodeId a, NodeId b) const;
  bool on_border(NodeId n) const;
  bool keeps_features(std::int32_t e) const;
  double gain(std::int32_t e);

  const CutTopology& mesh_;
  std::vector<char>& inside_;
  std::vector<char> true_side_;
};

}  // namespace lamella
