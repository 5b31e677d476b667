#include "app/cli_groups.h"

#include "app/cli_text.h"

namespace lamella::cli {

namespace {

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace

Result<BoundaryGroup> read_group(const std::string& text) {
  const Error misread{
      Code::usage, "--group " + text + " is not understood.",
      "Write it as NAME=BODY:FACE,FACE or NAME=BODY:X,Y,Z~ANGLE, lengths in mm and the angle in "
      "radians. BODY: may be left out where there is one body."};
  const std::size_t equals = text.find('=');
  if (equals == text.npos || equals == 0 || equals + 1 == text.size()) return misread;
  BoundaryGroup group;
  group.name = text.substr(0, equals);
  group.kind = group_kind_of(group.name);
  // Names of bodies may have a colon too.
  const std::size_t colon = text.rfind(':');
  const bool body = colon != text.npos && colon > equals;
  if (body) group.body = text.substr(equals + 1, colon - equals - 1);
  const std::string what = text.substr((body ? colon : equals) + 1);
  if (const std::size_t tilde = what.rfind('~'); tilde != what.npos) {
    const std::vector<std::string> coordinates = parts_of(what.substr(0, tilde));
    const auto angle = read_number<double>(std::string_view(what).substr(tilde + 1));
    if (coordinates.size() != 3 || !angle) return misread;
    Flood flood;
    flood.angle = *angle;
    for (int k = 0; k < 3; ++k) {
      const auto x = read_number<double>(coordinates[static_cast<std::size_t>(k)]);
      if (!x) return misread;
      flood.point[k] = *x;
    }
    group.floods.push_back(flood);
    return group;
  }
  for (const std::string& face : parts_of(what)) {
    if (face.empty()) return misread;
    if (const auto id = read_number<std::int32_t>(face))
      group.faces.push_back(*id);
    else
      group.face_names.push_back(face);
  }
  return group;
}

Result<std::pair<std::string, double>> group_and_number(const std::string& text,
                                                        std::optional<double> otherwise) {
  const std::size_t equal = text.rfind('=');
  if (equal == text.npos && otherwise) return std::pair(text, *otherwise);
  const auto number =
      equal == text.npos ? std::optional<double>{} : read_number<double>(text.substr(equal + 1));
  if (!number)
    return Error{Code::usage, "\"" + text + "\" is not GROUP=NUMBER.",
                 "As --gate inlet=20 or --gate-rate inlet=1500."};
  return std::pair(text.substr(0, equal), *number);
}

namespace {

/// METHOD, or METHOD:NAME of the field NAME in the file of --flow-field or of the study.
Result<void> take_method(const MeshCommand& c, StudyFlow& flow) {
  const std::size_t colon = c.flow->find(':');
  const std::string name = c.flow->substr(0, colon);
  const auto called = [&](const auto& methods) -> std::optional<FlowMethod> {
    for (const FlowMethod method : methods)
      if (name == flow_method_name(method)) return method;
    return {};
  };
  const auto method = colon == name.npos ? called(kFlowMethods) : called(kFieldMethods);
  if (!method) {
    std::string known, of_field;
    for (const FlowMethod m : kFlowMethods) known += std::string(flow_method_name(m)) + ", ";
    for (const FlowMethod m : kFieldMethods)
      of_field += (of_field.empty() ? "" : ", ") + std::string(flow_method_name(m)) + ":NAME";
    return Error{Code::usage, "--flow knows no method \"" + *c.flow + "\".",
                 "Use none, " + known + "or of a solver's field " + of_field + "."};
  }
  flow.method = *method;
  if (colon == name.npos) {
    flow.field.reset();
    return {};
  }
  if (c.flow_field.empty() && !flow.field)
    return Error{Code::usage, "\"" + *c.flow + "\" needs the file of the field.",
                 "Add --flow-field FILE."};
  if (!flow.field) flow.field.emplace();
  flow.field->name = c.flow->substr(colon + 1);
  if (!c.flow_field.empty()) flow.field->source = {c.flow_field, unit_factor(c.flow_field_unit)};
  return {};
}

}  // namespace

Result<void> add_flow(const MeshCommand& c, Study& study) {
  bool named = false;
  const auto give = [&](const std::string& name, GroupKind kind, std::optional<double> pressure,
                        std::optional<double> rate) -> Result<void> {
    named = true;
    bool found = false;
    for (BoundaryGroup& group : study.groups) {
      if (group.name != name) continue;
      group.kind = kind;
      group.pressure = pressure;
      group.rate = rate;
      found = true;
    }
    if (found) return {};
    return Error{Code::usage, "There is no group \"" + name + "\" for the flow.",
                 "Make it by --group NAME=BODY:FACE,.."};
  };
  for (const std::string& text : c.gates) {
    auto gate = group_and_number(text, 1);
    if (!gate) return gate.error();
    if (auto done = give(gate->first, GroupKind::gate, gate->second, {}); !done) return done;
  }
  for (const std::string& text : c.rates) {
    auto gate = group_and_number(text, {});
    if (!gate) return gate.error();
    if (auto done = give(gate->first, GroupKind::gate, {}, gate->second); !done) return done;
  }
  for (const std::string& name : c.vents)
    if (auto done = give(name, GroupKind::vent, {}, {}); !done) return done;
  for (const std::string& name : c.symmetries)
    if (auto done = give(name, GroupKind::symmetry, {}, {}); !done) return done;
  if (c.flow && *c.flow == "none") study.flow.reset();
  if (c.flow && *c.flow != "none") {
    if (!study.flow) study.flow.emplace();
    if (Result<void> good = take_method(c, *study.flow); !good) return good;
  }
  if (!c.flow_field.empty() && (!c.flow || c.flow->find(':') == std::string::npos))
    return Error{Code::usage, "--flow-field needs the name of a field.", "Add --flow field:NAME."};
  named = named || c.flow_strength || c.flow_beta || c.flow_growth || c.flow_rounds ||
          c.flow_h_min || !c.flow_bodies.empty();
  if (!study.flow && named && !c.flow)
    return Error{Code::usage, "Gates and vents are for a flow.", "Add --flow METHOD."};
  if (!study.flow) return {};
  if (c.flow_strength) study.flow->strength = *c.flow_strength;
  if (c.flow_beta) study.flow->beta = *c.flow_beta;
  if (c.flow_growth) study.flow->growth = *c.flow_growth;
  if (c.flow_rounds) study.flow->rounds = *c.flow_rounds;
  if (c.flow_h_min) study.flow->h_min = c.flow_h_min;
  return {};
}

}  // namespace lamella::cli
