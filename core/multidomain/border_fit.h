#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/multidomain/cut_topology.h"

namespace lamella {

/// Puts nodes on the border of a zone where chords of it are too long, before and after the mesh
/// is cut there. `phi`: the signed distance of the zone at the nodes, 0 on its border; nodes behind
/// its end lie on it. It grows with the mesh.
class BorderFit {
 public:
  BorderFit(CutTopology& mesh, const Partition<3>& partition, int zone, const CutParams& params,
            std::vector<double>& phi)
      : mesh_(mesh), partition_(partition), zone_(zone), params_(params), phi_(phi) {}

  /// Whether an element around the nodes has one on the same smooth part of the border next to x
  /// already: another would only fold it.
  bool crowded(std::span<const NodeId> of, const Vec<3>& x) const;

  /// Edges between nodes of a smooth border whose middle is too far from it get a node on it before
  /// anything is cut: elements around a chord that is too long are neither inside nor outside.
  void bow();
  /// Splits the edges, then the facets, of the zone's interface that are too far from the border,
  /// until they keep the tolerance. False when cancelled.
  bool bend(const Progress& progress);

 private:
  bool bend_edges(const Progress& progress);
  bool bend_faces(const Progress& progress);
  bool same_sheet(std::span<const NodeId> of, const Vec<3>& y) const;
  std::int32_t interface() const { return mesh_.first_interface + zone_; }
  double distance(const Vec<3>& x) const { return partition_.zone(zone_).distance(x); }
  const Vec<3>& at(NodeId n) const { return mesh_.at(n); }

  CutTopology& mesh_;
  const Partition<3>& partition_;
  int zone_;
  const CutParams& params_;
  std::vector<double>& phi_;
};

}  // namespace lamella
