#pragma once

#include <unordered_map>

#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// The elements that a listed facet belongs to.
struct FacetSide {
  std::int32_t element = -1;  ///< the one it points out of; -1: it is a face of no element
  std::int32_t local = 0;     ///< vertex of that element which the facet is opposite to
  std::int32_t other = -1;    ///< the element on its other side; -1: boundary
};

/// [facet]; a facet of the boundary that is listed inward belongs to its element all the same.
std::vector<FacetSide> facet_sides(const SimplexMesh<3>& mesh);

/// Whether every face of the boundary is among the facets.
bool boundary_is_listed(const SimplexMesh<3>& mesh);

/// Lists the faces of the boundary that are not, outward, in a group "unnamed" of their own.
void list_boundary(SimplexMesh<3>& mesh);

/// Positions 1, 2, .. of numbers in the order of a file, which mostly are 1, 2, .. themselves.
class FileNumbers {
 public:
  void add(std::int64_t number) {
    ++count_;
    if (others_.empty() && number == count_) return;
    if (others_.empty())
      for (std::int32_t i = 1; i < count_; ++i) others_[i] = i;
    others_[number] = count_;
  }
  /// 0: there is none.
  std::int32_t of(std::int64_t number) const {
    if (others_.empty())
      return number >= 1 && number <= count_ ? static_cast<std::int32_t>(number) : 0;
    const auto at = others_.find(number);
    return at == others_.end() ? 0 : at->second;
  }
  std::int32_t count() const { return count_; }

 private:
  std::int32_t count_ = 0;
  std::unordered_map<std::int64_t, std::int32_t> others_;
};

}  // namespace lamella
