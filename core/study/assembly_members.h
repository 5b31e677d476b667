#pragma once

#include <memory>
#include <optional>

#include "core/flow/correction_field.h"
#include "core/multidomain/partition.h"
#include "core/natural/layer_correction.h"
#include "core/natural/medial_ball.h"
#include "core/natural/natural_metric.h"
#include "core/sizing/sizing_field.h"
#include "core/study/run.h"

namespace lamella {

/// A body or what is around all of them: a region of the partition.
struct Member {
  Part part;  ///< its surface, the whole of it whatever lies over it
  /// Where others take a share of the body or the domain cuts it: all that bounds what is left,
  /// from inside it, and more that is out of reach from there.
  std::optional<ReferenceSurface<3>> bounds;
  /// What the thickness of its walls is measured on.
  const ReferenceSurface<3>& walls() const { return bounds ? *bounds : part.surface; }
  NaturalParams natural;
  std::unique_ptr<const NaturalDetector> detector;
  SizingField sizing;
  LayerCorrection correction;
  CorrectionField of_flow;
  std::unique_ptr<const FaceGroups> groups;  ///< null: the study has none on it
  /// mm, across its borders, where its layers are thinnest; 0: exact, and not asked
  double interface_size = 0;
  std::optional<double> interface_asked;  ///< the same for all of them; unset: a share of the layer
  bool endless = false;                   ///< a formula that ends with the domain only
};

/// What one mesh of all bodies is made from, before the first iteration.
struct Assembly {
  std::vector<Member> members;  ///< [region], what is around the bodies last
  std::unique_ptr<const Partition<3>> partition;
  bool full = false;  ///< the bodies leave nothing of the domain to what is around them
  ZonePtr<3> domain;  ///< the mesh fills it
  std::vector<std::int32_t> body_of;        ///< [region] body of an exact mesh, -1: dropped
  std::optional<ReferenceSurface<3>> wall;  ///< of the domain; unset: that of the mesh, planes
  SimplexMesh<3> first;                     ///< of the whole domain, one body
  double chord_tolerance = 0;               ///< mm, of the mesh to the bodies' exact shape
  double border_share = 0;                  ///< of the layer there: the size across borders
  double mesh_tolerance = 0;                ///< what the tessellations have left of it for the mesh
  std::vector<BodyOutcome> outcomes;        ///< [region], with overlaps and gaps in the notes
  StudyOverlaps overlaps;

  /// At most the distance of x to what the region is in the mesh, mm; 0 or less within.
  double beyond(int region, const Vec<3>& x) const;
  /// Sets the distances between the bodies of an exact mesh and their surfaces in the outcomes, and
  /// tells the farthest places beyond the tolerance. Errors: cancelled.
  Result<std::vector<Vec<3>>> measure_distances(const SimplexMesh<3>& mesh, int threads,
                                                const Progress& progress);
  /// `ease_poor` on an exact mesh whose distances are set, which it sets anew; false where nothing
  /// moved, as it does where a body gets too far from its surface by it. Errors: cancelled.
  Result<bool> ease(SimplexMesh<3>& mesh, MetricField<3>& metric, int threads,
                    const Progress& progress);
  /// What holds the borders of the member in the mesh: its surface, of an endless one the part of
  /// it that is within the domain.
  ReferenceSurface<3> borders_of(const Member& member) const;
};

/// Facets on the CAD faces from number `first_face` on, which are those of a grouped surface, get
/// their groups.
void put_in_groups(const FaceGroups& of, std::int32_t first_face, SimplexMesh<3>& mesh);

/// Errors: usage (no body, a body to be dropped that is not there, what one mesh of all bodies
/// cannot do); bad_input (a zone outside of the domain); those of the meshers; cancelled.
Result<Assembly> lay_out(const Study& study, const std::vector<Part>& parts,
                         const std::vector<std::shared_ptr<const VolumeMesher>>& meshers,
                         const Progress& progress);

}  // namespace lamella
