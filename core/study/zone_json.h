#pragma once

#include "core/study/json_members.h"
#include "core/study/zone_entry.h"

namespace lamella {

/// The part of a study file that is about zones: {"name": .., "shape": "ball", ..}, and the domain,
/// {"shape": "box", ..}. The first complaint, if any, is left in `complaint`.
Json json_of(const StudyZone& zone);
Json json_of(const StudyDomain& domain);
StudyZone read_study_zone(const Json& json, std::size_t index, std::string& complaint);
StudyDomain read_domain(const Json& json, std::string& complaint);

/// What zone number `index` has in common with one before that it must not; empty if nothing.
std::string conflict(const std::vector<StudyZone>& zones, std::size_t index);

}  // namespace lamella
