#include "core/study/study.h"

#include <algorithm>

namespace lamella {

BodySettings settings_of(const Study& study, const std::string& name) {
  const auto it = std::find_if(study.bodies.begin(), study.bodies.end(),
                               [&](const BodySettings& body) { return body.name == name; });
  if (it != study.bodies.end()) return *it;
  BodySettings defaults;
  defaults.name = name;
  return defaults;
}

}  // namespace lamella
