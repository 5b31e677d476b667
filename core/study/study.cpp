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

std::vector<SizingObject> sizing_of(const Study& study, const std::string& name) {
  std::vector<SizingObject> objects;
  for (const SizingObject& object : study.sizing)
    if (object.body.empty() || object.body == name) objects.push_back(object);
  return objects;
}

}  // namespace lamella
