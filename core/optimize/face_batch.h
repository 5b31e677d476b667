#pragma once

#include <optional>
#include <span>

#include "core/optimize/cavity.h"

namespace lamella {

/// The real faces of a cavity, four to a group in the order of vector registers: the star is rated
/// group by group, so that a bad candidate is left at the first group that tells.
template <int D>
class FaceBatch {
 public:
  static constexpr int width = 4;
  static constexpr int packed = Packed<D>::size;
  using Lanes = double[width];

  /// What a rating needs of four faces; RealFace with the faces innermost. The lanes behind the
  /// last face repeat it, with -1 for their first node.
  struct alignas(32) Group {
    Lanes metric[packed];
    Lanes normal[D], center[D], normal2, edges[packed];
    alignas(16) std::int32_t nodes[D][width];
  };
  /// What elements are made of.
  struct Nodes {
    const std::vector<std::array<NodeId, D + 1>>& elements;
    const std::vector<Vec<D>>& points;
    const std::vector<Packed<D>>& carried;  ///< what elements average of the metric
  };
  /// Of the elements of a group. Lanes without an element have infinite quality, and count neither
  /// for the worst of them nor for the sum.
  struct alignas(32) Rates {
    Lanes quality, energy;
    int count;     ///< of elements
    double worst;  ///< quality
    double sum;    ///< of energy - 1
  };
  /// Sums over faces, of Newton's method: gradient and Hessian of the energy, and the part of the
  /// Hessian that is positive definite for sure.
  struct Derivatives {
    Vec<D> gradient = Vec<D>::Zero();
    Packed<D> hessian = Packed<D>::zero(), convex = Packed<D>::zero();
    bool sound = true;  ///< no face was flat or ill oriented
  };

  /// Forgets all faces; those to come are of these nodes, which are read when a face is first
  /// rated.
  void open(const Nodes& nodes) {
    source_.emplace(nodes);
    faces_.clear();
    derived_ = 0;
  }
  void add(std::int32_t element, int place) {
    faces_.push_back({opposite_facet<D>(source_->elements[element], place), element, place});
  }
  int size() const { return static_cast<int>(faces_.size()); }
  int groups() const { return (size() + width - 1) / width; }
  const CavityFace<D>& operator[](int i) const { return faces_[i]; }
  auto begin() const { return faces_.begin(); }
  auto end() const { return faces_.end(); }

  /// Ratings of the elements {face, apex} of a group. `node` is the apex, 0 for a new point: a face
  /// that has it makes no element.
  void rate(int group, const RatingKernel<D>& kernel, NodeId node, const Vec<D>& apex,
            const Packed<D>& apex_carried, Rates& rates);
  Rating rate_one(int i, const RatingKernel<D>& kernel, const Vec<D>& apex,
                  const Packed<D>& apex_carried);
  /// Ratings of the elements [first, last) into `ratings`, of the same length; virtual ones have
  /// infinite quality and no energy, dead ones are passed over. Opens the batch anew.
  void rate_elements(const Nodes& nodes, std::size_t first, std::size_t last,
                     const RatingKernel<D>& kernel, std::span<Rating> ratings);
  /// Of the energy in the position of an apex whose metric is held.
  Derivatives derivatives(const RatingKernel<D>& kernel, const Vec<D>& apex,
                          const Packed<D>& apex_carried);
  /// One face, taken out.
  RealFace<D> real(int i);

 private:
  void derive(int group);

  std::optional<Nodes> source_;
  std::vector<CavityFace<D>> faces_;
  std::vector<Group> groups_;
  int derived_ = 0;  ///< groups whose nodes were read
};

}  // namespace lamella
