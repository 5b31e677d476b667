#pragma once

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/geometry/surface.h"
#include "core/multidomain/overlap.h"
#include "core/study/study.h"

namespace lamella {

/// Adds the surface behind what is in `all`.
void append(const ReferenceSurface<3>& surface, ReferenceSurface<3>& all);
/// Adds the surface seen from its other side behind what is in `all`, but for facets that lie on
/// the boundary of `taken_from` and look the same way: there is nothing behind them.
void append_reversed(const ReferenceSurface<3>& surface, const Zone<3>& taken_from,
                     ReferenceSurface<3>& all);

/// Whether one mesh of all bodies has something around them that is no body itself.
bool has_background(const Study& study);

/// Layers through what is around the bodies, unless the study has settings for it.
inline constexpr int kBackgroundLayers = 2;
bool names_background(const Study& study);

/// Gives every part and zone its settings, in this order, and the background last, where there is
/// one: with two layers and out of sight, unless the study says more. Others go.
void arrange_bodies(Study& study, const std::vector<Part>& parts);

/// The domain as a zone: a part as the box around it, the union of the bodies as the box with a
/// margin in which they are meshed. Errors: usage (no domain, no body of that name, no box).
Result<StudyZone> domain_hull(const Study& study, const std::vector<Part>& parts);

/// A part or a zone; the other one is null.
struct RankedBody {
  const Part* part = nullptr;
  const StudyZone* zone = nullptr;
};
/// All bodies but what is around them, those first that keep what they share with others: by the
/// rank of their roles, among equals parts before zones, each in the order given.
std::vector<RankedBody> by_rank(const Study& study, const std::vector<Part>& parts);

struct StudyOverlaps {
  std::vector<std::string> names;  ///< [region of the report]
  OverlapReport report;
};

/// Overlaps and gaps between the parts and zones but the domain, within it where there is one.
/// Errors: as `find_overlaps`.
Result<StudyOverlaps> study_overlaps(const Study& study, const std::vector<Part>& parts,
                                     OverlapOptions options = {}, const Progress& progress = {});

}  // namespace lamella
