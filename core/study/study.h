#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/natural/detector.h"
#include "core/sizing/sizing_object.h"
#include "core/study/flow_entry.h"
#include "core/study/group.h"
#include "core/study/study_input.h"
#include "core/study/zone_entry.h"

namespace lamella {

/// What a body is in the tool.
enum class BodyRole {
  none,     ///< not said
  cavity,   ///< what the polymer fills: the molded part
  channel,  ///< runner or cooling channel
  insert,   ///< is molded in
  mold      ///< holds all of them
};
/// "none", "cavity", "channel", "insert", "mold".
std::string_view role_name(BodyRole role);
/// n of a body that is given the role: metal is meshed coarser than what flows.
int role_layers(BodyRole role);
/// Of bodies that overlap the one with the lower rank keeps what they share: the cavity is what the
/// mold leaves free, and an insert takes its place in the cavity.
int role_rank(BodyRole role);

/// What the user asked for one body. Lengths in mm.
struct BodySettings {
  std::string name;
  int layers = 4;                 ///< n, elements through the thickness, >= 1
  double alpha = 1;               ///< alpha_h of (4.68): sizes up to (1 + alpha) h1 are divided
  std::optional<double> h_min{};  ///< unset: 1e-3 of the body's box diagonal
  std::optional<double> h_max{};  ///< unset: no bound
  bool visible = true;
  std::optional<int> layers2{};  ///< n2 (4.4.3) of sizes up to (1 + alpha + alpha2) h1
  double alpha2 = 0;             ///< see n2: both or none
  std::optional<int> layers3{};  ///< n3 of all sizes beyond; unset: not divided
  std::optional<std::array<double, 3>> color{};  ///< RGB in [0, 1]; unset: the file's or our own
  /// Size across the body's borders in one mesh of all bodies, of two bodies the smaller counts;
  /// unset: a quarter of the layer there.
  std::optional<double> interface_size{};
  bool flow = true;  ///< the study's flow may correct the mesh of this body
  BodyRole role = BodyRole::none;

  bool operator==(const BodySettings&) const = default;
};

/// How the borders between bodies lie in one mesh of all bodies.
enum class Interfaces {
  fuzzy,  ///< within thin elements that are filled in part (6.1.2)
  exact   ///< on faces of the mesh: each element belongs to one body (6.1.1)
};
/// "fuzzy", "exact".
constexpr std::string_view interfaces_name(Interfaces i) {
  return i == Interfaces::fuzzy ? "fuzzy" : "exact";
}

/// What draws the mesh together at fuzzy interfaces.
enum class Capture {
  distance,  ///< the distance to the border, with its curvature
  gradient   ///< the gradient of the filling ratio (6.22)
};
/// "distance", "gradient".
constexpr std::string_view capture_name(Capture c) {
  return c == Capture::distance ? "distance" : "gradient";
}

/// How the mesh is made. Lengths in mm.
struct StudyOptions {
  std::optional<double> chord_tolerance{};  ///< unset: 1e-3 of the box diagonal of each body
  std::optional<double>
      max_anisotropy{};           ///< longest over shortest size of a wall; unset: no bound
  double angle_tolerance = 0.35;  ///< radians between neighbors of the tessellation
  int iterations = 6;             ///< adaptions at most
  int threads = 0;                ///< 0: all cores; the mesh does not depend on it
  std::uint64_t seed = 1;
  Detector detector = Detector::geometric;  ///< who finds the wall thickness
  bool progressive = false;   ///< asks 2, 3, .. n layers (4.4.2): less memory at the first peak
  bool until_settled = true;  ///< end when nodes and layers settle; false: all iterations
  std::optional<double> memory{};             ///< MB an adaption may take; unset: no limit
  Interfaces interfaces = Interfaces::exact;  ///< where the study has a domain
  Capture capture = Capture::distance;        ///< of fuzzy interfaces
};

/// A plane through which the window cuts the model open: what its normal points to is hidden.
struct CutPlane {
  std::string name;
  Vec<3> origin = Vec<3>::Zero();   ///< mm
  Vec<3> normal = Vec<3>::UnitX();  ///< unit
  bool on = true;
};

/// One immutable value: what the user asked. The files are named, never held.
struct Study {
  std::string name = "untitled";
  std::vector<StudyInput> inputs;
  std::vector<std::string> left_out;  ///< parts of the inputs, by name, that are not meshed
  std::vector<BodySettings> bodies;   ///< by part name; a part without an entry gets the defaults
  std::vector<StudyZone> zones;       ///< further bodies, by formula; names differ
  std::optional<StudyDomain> domain;  ///< what one mesh of all bodies fills; unset: one mesh a body
  /// Bodies, or the background, without which an exact mesh of all bodies is handed out.
  std::vector<std::string> dropped;
  StudyOptions options;
  std::vector<SizingObject> sizing;   ///< on top of the natural metric, in this order
  std::vector<BoundaryGroup> groups;  ///< named parts of the boundary
  std::optional<StudyFlow> flow;      ///< unset: nothing is corrected by a flow
  std::vector<CutPlane> cuts;         ///< for the eye only
  bool embed_inputs = false;          ///< a project file holds copies of the inputs
};

/// The files that the study reads: its inputs, and the result of another solver behind them.
std::vector<StudyInput*> sources_of(Study& study);
std::vector<const StudyInput*> sources_of(const Study& study);
/// The settings of the part called `name`: its entry, or the defaults of BodySettings.
BodySettings settings_of(const Study& study, const std::string& name);
/// The sizing objects that apply to the part called `name`.
std::vector<SizingObject> sizing_of(const Study& study, const std::string& name);
/// The groups on the part called `name`: those that name it, and those that name none.
std::vector<BoundaryGroup> groups_of(const Study& study, const std::string& name);

/// Gives the parts from number `first` on names that neither those before nor `taken` have: a name
/// that is there gets a number.
void number_names(std::vector<Part>& parts, std::size_t first = 0,
                  std::set<std::string> taken = {});

/// The parts of all inputs, in order, as a study calls them: names that were taken get a number,
/// and the parts that are left out go.
std::vector<Part> study_parts(std::vector<Part> parts, const std::vector<std::string>& left_out);

}  // namespace lamella
