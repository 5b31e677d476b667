#include "core/study/request.h"

#include <algorithm>

#include "core/geometry/triangles.h"
#include "core/sizing/sizing_field.h"
#include "core/study/flow_round.h"

namespace lamella {

namespace {

constexpr double kChordGrowth = 1;  // walls are fine across anyway
/// Nodes in a throat, not at its ends alone, give it its layers.
constexpr double kBetweenReentrant = 0.5;

Result<void> check_method_of_field(const Study& study, const std::vector<std::string>& names) {
  const StudyFlow& f = *study.flow;
  if (f.field->name.empty())
    return Error{Code::usage, "No field of \"" + f.field->source.file + "\" is chosen.",
                 "Choose the one to correct by."};
  if (!suits_field(f.method, 1) && !suits_field(f.method, 3))
    return Error{Code::usage,
                 "\"" + std::string(flow_method_name(f.method)) +
                     "\" needs a flow that is solved here, no field of a file.",
                 "Use field, indicator, or of a velocity acceleration, strain, combined or "
                 "direction."};
  if (std::none_of(names.begin(), names.end(),
                   [&](const std::string& name) { return has_flow(study, name); }))
    return Error{Code::usage, "No body may be corrected by the field of the solver.",
                 "Let one of them be corrected."};
  return {};
}

Result<void> check_flow(const Study& study, const std::vector<std::string>& names) {
  if (!study.flow) return {};
  const auto usage = [](const std::string& message, const std::string& hint) {
    return Error{Code::usage, message, hint};
  };
  const StudyFlow& f = *study.flow;
  if (!(f.strength > 0 && f.beta > 0 && f.viscosity > 0))
    return usage("The strength, beta and the viscosity of the flow must be positive.",
                 "Leave them out for 1.");
  if (!(f.growth > 1))
    return usage("The growth that the flow may cause must be above 1.", "1.5 is the default.");
  if (f.rounds < 0) return usage("Rounds of the flow cannot be negative.", "1 is the default.");
  if (f.h_min && !(*f.h_min > 0))
    return usage("The smallest size of the flow must be positive.", "Leave it out for none.");
  if (f.field) return check_method_of_field(study, names);
  if (f.method == FlowMethod::field || f.method == FlowMethod::indicator)
    return usage("\"" + std::string(flow_method_name(f.method)) +
                     "\" corrects by the field of another solver, and none is named.",
                 "Name its file and the field, or choose another method.");
  bool any = false;
  for (const std::string& name : names) {
    if (!has_flow(study, name)) continue;
    any = true;
    const FlowCase<3> flow = flow_case_of(study, name);
    for (const BoundaryGroup& group : study.groups)
      if (group.pressure && group.rate)
        return usage("Gate \"" + group.name + "\" has a pressure and a rate.", "Give one of them.");
    const auto held = std::count_if(flow.gates.begin(), flow.gates.end(),
                                    [](const FlowGate& gate) { return gate.pressure.has_value(); });
    if (flow.vents.empty() && (flow.gates.size() < 2 || held == 0))
      return usage("Body \"" + name + "\": the flow has a gate and no way out.",
                   "Make a group of its faces a vent.");
  }
  if (!any)
    return usage("The flow needs a gate on a body that it may correct.",
                 "Make a group of its faces a gate.");
  return {};
}

}  // namespace

Result<void> check_request(const Study& study, const std::vector<Part>& parts) {
  const auto usage = [](const std::string& message, const std::string& hint) {
    return Error{Code::usage, message, hint};
  };
  if (parts.empty() && study.zones.empty())
    return usage("There is no body to mesh.", "Open a STEP or STL file.");
  if (study.options.iterations < 1)
    return usage("At least one iteration is needed.", "Ask for 1 or more; 6 is the default.");
  if (study.options.chord_tolerance && !(*study.options.chord_tolerance > 0))
    return usage("The chord tolerance must be positive.", "Leave it out for the default.");
  if (study.options.max_anisotropy && !(*study.options.max_anisotropy >= 1))
    return usage("The largest anisotropy must be 1 or more.",
                 "It is the longest over the shortest size of an element.");
  std::vector<std::string> names;
  for (const Part& part : parts) names.push_back(part.name);
  for (const StudyZone& zone : study.zones) names.push_back(zone.name);
  if (study.domain) names.emplace_back(kBackground);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::count(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) > 0)
      return usage("Two bodies are called \"" + names[i] + "\".", "Rename the zone.");
  for (const std::string& name : names) {
    const BodySettings body = settings_of(study, name);
    const std::string who = "Body \"" + name + "\": ";
    if (body.interface_size && !(*body.interface_size > 0))
      return usage(who + "the interface size must be positive.", "Leave it out for the default.");
    if (body.layers < 1) return usage(who + "at least one layer is needed.", "Ask for n >= 1.");
    if (body.layers2.value_or(1) < 1 || body.layers3.value_or(1) < 1)
      return usage(who + "n2 and n3 must be at least 1.", "Leave them out for long directions.");
    if (!(body.alpha >= 0)) return usage(who + "alpha must not be negative.", "1 is the default.");
    if (!(body.alpha2 >= 0)) return usage(who + "alpha2 must not be negative.", "Leave it out.");
    if (body.layers2.has_value() != (body.alpha2 > 0))
      return usage(who + "n2 and alpha2 go together.",
                   "n2 divides the sizes up to 1 + alpha + alpha2 times the smallest.");
    if (body.h_min && !(*body.h_min > 0))
      return usage(who + "h_min must be positive.", "Leave it out for the default.");
    if (body.h_max && !(*body.h_max >= body.h_min.value_or(0) && *body.h_max > 0))
      return usage(who + "h_max must be positive and not below h_min.", "Leave it out for none.");
  }
  const auto known_body = [&](const std::string& name) {
    return std::count(names.begin(), names.end(), name) > 0;
  };
  const auto body_list = [&] {
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "\"" : ", \"") + name + "\"";
    return "The bodies are " + known + ".";
  };
  for (const SizingObject& object : study.sizing) {
    if (object.body.empty() && parts.size() > 1 && std::holds_alternative<FacesShape>(object.shape))
      return usage("Sizing object \"" + object.name + "\": it picks faces, but of no body.",
                   "Name the body: faces are numbered in each.");
    if (!object.body.empty() && !known_body(object.body))
      return usage(
          "Sizing object \"" + object.name + "\": there is no body \"" + object.body + "\".",
          body_list());
  }
  for (const BoundaryGroup& group : study.groups) {
    if (group.body.empty() && parts.size() > 1)
      return usage("Group \"" + group.name + "\": it picks faces, but of no body.",
                   "Name the body: faces are numbered in each.");
    if (!group.body.empty() && !known_body(group.body))
      return usage("Group \"" + group.name + "\": there is no body \"" + group.body + "\".",
                   body_list());
  }
  if (Result<void> good = check_flow(study, names); !good) return good.error();
  for (const Part& part : parts) {
    const std::vector<BoundaryGroup> groups = groups_of(study, part.name);
    if (groups.empty()) continue;
    if (Result<GroupedSurface> grouped = group_faces(groups, part.surface); !grouped)
      return grouped.error();
  }
  for (const Part& part : parts)
    if (Result<SizingField> field = SizingField::make(sizing_of(study, part.name), part.surface);
        !field)
      return field.error();
  return {};
}

NaturalParams natural_params(const Study& study, const Part& part) {
  const BodySettings settings = settings_of(study, part.name);
  NaturalParams params;
  params.layers = settings.layers;
  params.alpha = settings.alpha;
  params.layers2 = settings.layers2;
  params.alpha2 = settings.alpha2;
  params.layers3 = settings.layers3;
  params.h_min = settings.h_min.value_or(1e-3 * diagonal_of(part.surface.points));
  params.h_max = settings.h_max.value_or(0);
  params.max_anisotropy = study.options.max_anisotropy.value_or(0);
  params.threads = study.options.threads;
  return params;
}

double chord_tolerance_of(const Study& study, const Part& part) {
  return study.options.chord_tolerance.value_or(1e-3 * diagonal_of(part.surface.points));
}

std::unique_ptr<const ChordField> chords_of(const Study& study, const Part& part,
                                            const Progress& progress) {
  ChordParams params;
  params.tolerance = chord_tolerance_of(study, part);
  params.growth = kChordGrowth;
  params.between_reentrant = kBetweenReentrant;
  params.smallest = natural_params(study, part).h_min;
  params.threads = study.options.threads;
  return std::make_unique<const ChordField>(ChordField::of_body(part.surface, params, progress));
}

}  // namespace lamella
