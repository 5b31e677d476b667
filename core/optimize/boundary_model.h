#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "core/geometry/locator.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// The facets of a mesh as its own reference: features are the (D-2)-faces where facets meet at
/// more than `feature_angle` radians; faces, [facet of the mesh], are the patches between them of
/// one group and face, D < 4.
template <int D>
ReferenceSurface<D> own_surface(const SimplexMesh<D>& mesh, double feature_angle);

/// What the optimizer must know of the boundary: which borders between facet tags are hard, which
/// nodes never move, and where the original surface lies.
///
/// A tag is a (group, CAD face, patch) triple. A border between two tags is hard where the groups
/// differ or a feature edge of the reference surface runs between the faces; soft borders (tangent
/// CAD faces) may drift with the mesh, their facets are tagged again from the nearest face. Where
/// the groups differ without a feature edge nearby, the border of the mesh given is one.
template <int D>
class BoundaryModel {
 public:
  /// `surface` null: the boundary of `mesh` itself is the reference, with features where facets
  /// meet at more than `feature_angle` radians. `tolerance` is the chord tolerance in mm.
  /// Facets of the frozen groups (ids) and elements of the frozen bodies keep their nodes. The
  /// facets of `mesh` from number `outer` on are interfaces between bodies; the reference of those
  /// from number `given` on is always the mesh given.
  BoundaryModel(const SimplexMesh<D>& mesh, const ReferenceSurface<D>* surface, double tolerance,
                double feature_angle, const std::vector<std::int32_t>& frozen_groups = {},
                const std::vector<std::int32_t>& frozen_bodies = {},
                std::size_t outer = std::numeric_limits<std::size_t>::max(),
                std::size_t given = std::numeric_limits<std::size_t>::max());
  ~BoundaryModel();

  struct Tag {
    std::int32_t group = 0;
    std::int32_t face = 0;   ///< CAD face
    std::int32_t patch = 0;  ///< the CAD face, or without one the part of it between features
    bool interface = false;  ///< between two bodies
    double side = 1;         ///< -1: facets are listed against the surface's normals
  };

  const Tag& tag(std::int32_t t) const { return tags_[t]; }
  std::int32_t tag_of_facet(std::size_t f) const { return facet_tag_[f]; }
  bool hard(std::int32_t a, std::int32_t b) const;
  /// [node of the mesh given] must stay where it is.
  const std::vector<char>& fixed() const { return fixed_; }
  double tolerance() const { return tolerance_; }
  /// The limit of `deviation`: what lies between the points of its lattice takes the rest.
  double lattice_tolerance() const { return 0.85 * tolerance_; }
  /// Whether facets of the tag, or elements of the body, stay as they are.
  bool frozen_tag(std::int32_t t) const { return frozen_tag_[t]; }
  bool frozen_body(std::int32_t b) const {
    return static_cast<std::size_t>(b) < frozen_body_.size() && frozen_body_[b];
  }

  /// Nearest point of the surface that facets of tag `t` stand for: the outer one or that of the
  /// interfaces; nothing when there is none within `within` mm.
  std::optional<Nearest<D>> nearest(const Vec<D>& x, double within, std::int32_t t) const;
  /// Unit outward normal of a facet of the reference surface.
  const Vec<D>& normal(std::int32_t facet) const { return normals_[facet]; }
  /// Nearest point of the feature edges within `within` mm.
  std::optional<Vec<D>> nearest_feature(const Vec<D>& x, double within) const;
  /// Largest distance from the surface of a lattice of points on a facet of tag `t`, up to `limit`;
  /// infinite when it is more. The side opposite to node `apex` is left out.
  double deviation(const std::array<Vec<D>, D>& p, int apex, std::int32_t t, double limit) const;
  /// The largest `deviation` of the mesh given, or distance of its feature edges.
  double first_deviation() const { return first_deviation_; }
  /// The vertices of the surface in the box [low, high], without those inside of planar faces.
  void vertices_in(const Vec<D>& low, const Vec<D>& high, std::vector<Vec<D>>& found) const;
  /// The vertices of feature edges in the box.
  void feature_vertices_in(const Vec<D>& low, const Vec<D>& high, std::vector<Vec<D>>& found) const;
  /// Tag of the same group as `t` on the CAD face of reference facet `facet`; `t` when there is
  /// none.
  std::int32_t tag_on(std::int32_t t, std::int32_t facet) const;
  /// Whether the face of the tag is a plane and x lies in it: a flat change of facets in the plane
  /// needs no look at the surface.
  bool in_plane(std::int32_t t, const Vec<D>& x) const {
    if (planes_.empty()) return true;
    const Plane& p = planes_[tags_[t].patch];
    return p.planar && std::abs(p.normal.dot(x - p.origin)) <= plane_tolerance_;
  }
  /// Whether curved boundaries can be followed; without a surface only flat changes are allowed.
  bool has_surface() const { return locator_ != nullptr; }

 private:
  void find_planes(const ReferenceSurface<D>& reference);
  void find_features(const SimplexMesh<D>& mesh, const ReferenceSurface<D>& reference,
                     double feature_angle);
  void find_sides(const SimplexMesh<D>& mesh);
  void measure_first(const SimplexMesh<D>& mesh);

  struct Features;
  struct Vertices;
  using Search = Locator<D == 4 ? 3 : D>;  // never made for D = 4
  double tolerance_;
  std::vector<Tag> tags_;
  std::vector<std::int32_t> facet_tag_;
  std::vector<char> fixed_;
  std::vector<char> frozen_tag_, frozen_body_;
  std::vector<std::uint64_t> hard_pairs_;  // sorted (face, face)
  std::vector<Vec<D>> normals_;
  std::vector<std::int32_t> facet_face_;
  struct Plane {
    Vec<D> normal = Vec<D>::Zero(), origin = Vec<D>::Zero();
    bool planar = false;
  };
  std::vector<Plane> planes_;  // [patch]
  double plane_tolerance_ = 0;
  double first_deviation_ = 0;
  std::unique_ptr<Search> locator_, interfaces_;
  std::int32_t first_interface_ = 0;  // facet of the surface; those before are the outer ones
  std::unique_ptr<Features> features_;
  std::unique_ptr<Vertices> curved_, on_features_;
};

}  // namespace lamella
