#pragma once

#include <string>

#include "core/base/result.h"
#include "core/study/zone_entry.h"

namespace lamella::cli {

/// The domain that --domain asks for: "bodies", "margin", "margin=SHARE", "body=NAME",
/// "box=X,Y,Z,X,Y,Z" or "cylinder=X,Y,Z,X,Y,Z,R". Errors: usage.
Result<StudyDomain> domain_of(const std::string& text);

}  // namespace lamella::cli
