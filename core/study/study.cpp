#include "core/study/study.h"

#include <algorithm>

namespace lamella {

std::string_view role_name(BodyRole role) {
  switch (role) {
    case BodyRole::none:
      break;
    case BodyRole::cavity:
      return "cavity";
    case BodyRole::channel:
      return "channel";
    case BodyRole::insert:
      return "insert";
    case BodyRole::mold:
      return "mold";
  }
  return "none";
}

int role_layers(BodyRole role) {
  return role == BodyRole::insert || role == BodyRole::mold ? 2 : BodySettings{}.layers;
}

int role_rank(BodyRole role) {
  return role == BodyRole::insert ? 0 : role == BodyRole::mold ? 2 : 1;
}

std::vector<StudyInput*> sources_of(Study& study) {
  std::vector<StudyInput*> sources;
  for (StudyInput& input : study.inputs) sources.push_back(&input);
  if (study.flow && study.flow->field) sources.push_back(&study.flow->field->source);
  return sources;
}

std::vector<const StudyInput*> sources_of(const Study& study) {
  std::vector<const StudyInput*> sources;
  for (const StudyInput& input : study.inputs) sources.push_back(&input);
  if (study.flow && study.flow->field) sources.push_back(&study.flow->field->source);
  return sources;
}

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

std::vector<BoundaryGroup> groups_of(const Study& study, const std::string& name) {
  std::vector<BoundaryGroup> groups;
  for (const BoundaryGroup& group : study.groups)
    if (group.body.empty() || group.body == name) groups.push_back(group);
  return groups;
}

void number_names(std::vector<Part>& parts, std::size_t first, std::set<std::string> taken) {
  for (std::size_t k = 0; k < first; ++k) taken.insert(parts[k].name);
  for (std::size_t k = first; k < parts.size(); ++k) {
    const std::string base = parts[k].name;
    for (int n = 2; !taken.insert(parts[k].name).second; ++n)
      parts[k].name = base + " (" + std::to_string(n) + ")";
  }
}

std::vector<Part> study_parts(std::vector<Part> parts, const std::vector<std::string>& left_out) {
  number_names(parts);
  std::erase_if(parts, [&](const Part& part) {
    return std::find(left_out.begin(), left_out.end(), part.name) != left_out.end();
  });
  return parts;
}

}  // namespace lamella
