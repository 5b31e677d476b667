#include "ui/session/command_line.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "core/flow/solver_field.h"
#include "core/study/domain.h"
#include "core/study/request.h"

namespace lamella::ui {
namespace {

std::string quoted(const std::string& text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("._-/,:=+~").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// As short as it can be read back to the same value.
std::string number(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

std::string numbers(const Vec<3>& v) {
  return number(v[0]) + ',' + number(v[1]) + ',' + number(v[2]);
}

Error cannot(const std::string& what) {
  return {Code::usage, "The options of lamella-cli cannot say " + what + ".",
          "Save the study: the command can take it as it is."};
}

bool same(const BodySettings& a, const BodySettings& b) {
  return a.layers == b.layers && a.alpha == b.alpha && a.h_min == b.h_min && a.h_max == b.h_max &&
         a.layers2 == b.layers2 && a.alpha2 == b.alpha2 && a.layers3 == b.layers3 &&
         a.interface_size == b.interface_size;
}

Result<std::string> sizing_options(const Study& study) {
  std::string text;
  const SizeCorrection* first = nullptr;
  for (const SizingObject& object : study.sizing) {
    const auto* asked = std::get_if<SizeCorrection>(&object.asks);
    if (!asked) return cannot("\"" + object.name + "\", which is no size, factor or box of sizes");
    if (first &&
        (first->gradation != asked->gradation || first->keep_directions != asked->keep_directions))
      return cannot("sizes that grow differently");
    if (!first) first = asked;
    const std::string size = asked->size ? number(*asked->size) : number(*asked->factor) + "x";
    const auto* faces = std::get_if<FacesShape>(&object.shape);
    if (!faces && !object.body.empty() && study.bodies.size() > 1)
      return cannot("that \"" + object.name + "\" is for one body only");
    const auto* box = std::get_if<BoxShape>(&object.shape);
    if (const auto* s = std::get_if<SphereShape>(&object.shape)) {
      text += " --size-sphere " + numbers(s->center) + ',' + number(s->radius) + ',' + size;
    } else if (box && box->x_axis == Vec<3>::UnitX() && box->y_axis == Vec<3>::UnitY()) {
      text += " --size-box " + numbers(box->center - 0.5 * box->size) + ',' +
              numbers(box->center + 0.5 * box->size) + ',' + size;
    } else if (const auto* c = std::get_if<CylinderShape>(&object.shape)) {
      text += " --size-cylinder " + numbers(c->from) + ',' + numbers(c->to) + ',' +
              number(c->radius) + ',' + size;
    } else if (faces && faces->depth == 0) {
      const std::string body = object.body.empty() ? "" : object.body + ":";
      for (const std::int32_t id : faces->ids)
        text += " --size-face " + quoted(body + std::to_string(id) + ',' + size);
      for (const std::string& name : faces->names)
        text += " --size-face " + quoted(body + name + ',' + size);
    } else {
      return cannot("the shape of \"" + object.name + "\"");
    }
  }
  if (first && first->gradation != SizeCorrection{}.gradation)
    text += " --size-gradation " + number(first->gradation);
  if (first && first->keep_directions) text += " --size-keep-directions";
  return text;
}

std::string domain_options(const Study& study) {
  if (!study.domain) return {};
  std::string text = " --domain ";
  const auto& shape = study.domain->shape;
  if (const auto* box = std::get_if<ZoneBox>(&shape))
    text += "box=" + numbers(box->low) + ',' + numbers(box->high);
  else if (const auto* c = std::get_if<ZoneCylinder>(&shape))
    text += "cylinder=" + numbers(c->from) + ',' + numbers(c->to) + ',' + number(c->radius);
  else if (const auto* margin = std::get_if<DomainMargin>(&shape))
    text += "margin=" + number(margin->share);
  else if (const auto* body = std::get_if<DomainBody>(&shape))
    text += quoted("body=" + body->name);
  else
    text += "bodies";
  const StudyOptions& o = study.options;
  const StudyOptions usual;
  for (const std::string& name : study.dropped) text += " --drop " + quoted(name);
  if (o.interfaces != usual.interfaces)
    text += " --interfaces " + std::string(interfaces_name(o.interfaces));
  if (o.capture != usual.capture) text += " --capture " + std::string(capture_name(o.capture));
  return text;
}

Result<std::string> group_options(const Study& study) {
  std::string text;
  for (const BoundaryGroup& group : study.groups) {
    const bool by_flow = study.flow && group.kind != GroupKind::other &&
                         group.kind != GroupKind::walls;  // told by the options of the flow
    if (group.kind != group_kind_of(group.name) && !by_flow)
      return cannot("the kind of group \"" + group.name + "\"");
    const std::string head = group.name + '=' + (group.body.empty() ? "" : group.body + ":");
    std::string faces;
    for (const std::int32_t id : group.faces)
      faces += (faces.empty() ? "" : ",") + std::to_string(id);
    for (const std::string& name : group.face_names) faces += (faces.empty() ? "" : ",") + name;
    if (!faces.empty()) text += " --group " + quoted(head + faces);
    for (const Flood& flood : group.floods)
      text += " --group " + quoted(head + numbers(flood.point) + '~' + number(flood.angle));
  }
  return text;
}

std::string flow_options(const Study& study) {
  if (!study.flow) return {};
  const StudyFlow& flow = *study.flow;
  const StudyFlow usual;
  std::string text = " --flow ";
  const std::string method(flow_method_name(flow.method));
  text += flow.field ? quoted(method + ':' + flow.field->name) : method;
  if (flow.field) {
    text += " --flow-field " + quoted(flow.field->source.file);
    for (const FileUnit& unit : kFileUnits)
      if (unit.mm == flow.field->source.unit && unit.mm != 1)
        text += " --flow-field-unit " + std::string(unit.name);
  }
  std::string before;
  for (const BoundaryGroup& group : study.groups) {
    if (group.name == before) continue;
    before = group.name;
    if (group.kind == GroupKind::gate && group.rate)
      text += " --gate-rate " + quoted(group.name + '=' + number(*group.rate));
    else if (group.kind == GroupKind::gate)
      text += " --gate " + quoted(group.name + '=' + number(group.pressure.value_or(1)));
    if (group.kind == GroupKind::vent) text += " --vent " + quoted(group.name);
    if (group.kind == GroupKind::symmetry) text += " --symmetry " + quoted(group.name);
  }
  if (flow.strength != usual.strength) text += " --flow-strength " + number(flow.strength);
  if (flow.beta != usual.beta) text += " --flow-beta " + number(flow.beta);
  if (flow.growth != usual.growth) text += " --flow-growth " + number(flow.growth);
  if (flow.h_min) text += " --flow-h-min " + number(*flow.h_min);
  if (flow.rounds != usual.rounds) text += " --flow-rounds " + std::to_string(flow.rounds);
  bool all = true;
  for (const BodySettings& body : study.bodies) all = all && body.flow;
  for (const BodySettings& body : study.bodies)
    if (!all && body.flow) text += " --flow-body " + quoted(body.name);
  return text;
}

}  // namespace

Result<std::string> command_line(const Study& study) {
  if (!study.left_out.empty()) return cannot("which bodies are left out");
  std::string text = "lamella-cli mesh";
  for (const StudyInput& input : study.inputs) text += ' ' + quoted(input.file);
  const double unit = study.inputs.empty() ? 1 : study.inputs.front().unit;
  for (const StudyInput& input : study.inputs)
    if (input.unit != unit) return cannot("different units of several STL files");
  const std::pair<double, const char*> units[] = {{10, "cm"}, {1000, "m"}, {25.4, "inch"}};
  for (const auto& [mm, name] : units)
    if (unit == mm) text += std::string(" --unit ") + name;
  if (!study.zones.empty()) return cannot("bodies by formula");
  for (const BodySettings& body : study.bodies)
    if (study.domain && role_rank(body.role) != role_rank(BodyRole::none))
      return cannot("the roles of bodies");
  for (const BodySettings& body : study.bodies) {
    // What is around the bodies has settings of its own, which no option says.
    const bool around = has_background(study) && body.name == kBackground;
    Study plain;
    plain.domain = study.domain;
    arrange_bodies(plain, {});
    if (!same(body, around ? plain.bodies.front() : study.bodies.front()))
      return cannot(around ? "settings of the background" : "settings that differ between bodies");
  }
  const BodySettings body = study.bodies.empty() ? BodySettings{} : study.bodies.front();
  text += " -n " + std::to_string(body.layers);
  if (body.alpha != BodySettings{}.alpha) text += " --alpha " + number(body.alpha);
  if (body.layers2)
    text += " --layers2 " + std::to_string(*body.layers2) + " --alpha2 " + number(body.alpha2);
  if (body.layers3) text += " --layers3 " + std::to_string(*body.layers3);
  if (body.h_min) text += " --h-min " + number(*body.h_min);
  if (body.h_max) text += " --h-max " + number(*body.h_max);
  if (body.interface_size && study.domain)
    text += " --interface-size " + number(*body.interface_size);
  text += domain_options(study);
  const StudyOptions& o = study.options;
  const StudyOptions usual;
  if (o.chord_tolerance) text += " --chord-tolerance " + number(*o.chord_tolerance);
  if (o.max_anisotropy) text += " --max-anisotropy " + number(*o.max_anisotropy);
  if (o.angle_tolerance != usual.angle_tolerance)
    text += " --angle-tolerance " + number(o.angle_tolerance);
  if (o.iterations != usual.iterations) text += " --iterations " + std::to_string(o.iterations);
  if (o.threads != usual.threads) text += " --threads " + std::to_string(o.threads);
  if (o.seed != usual.seed) text += " --seed " + std::to_string(o.seed);
  if (!o.until_settled) return cannot("that all iterations are to be made");
  if (o.memory) text += " --memory " + number(*o.memory);
  if (o.progressive) text += " --progressive";
  if (o.detector != usual.detector) text += " --detector " + std::string(detector_name(o.detector));
  const Result<std::string> sizing = sizing_options(study);
  if (!sizing) return sizing.error();
  const Result<std::string> groups = group_options(study);
  if (!groups) return groups.error();
  if (study.flow && study.flow->viscosity != StudyFlow{}.viscosity)
    return cannot("the viscosity of the flow");
  if (study.flow && study.flow->field &&
      std::none_of(std::begin(kFileUnits), std::end(kFileUnits), [&](const FileUnit& known) {
        return known.mm == study.flow->field->source.unit;
      }))
    return cannot("the unit of the solver's result");
  return text + *sizing + *groups + flow_options(study) + " -o " + quoted(study.name + ".msh");
}

std::string command_line_for(const std::string& study_file) {
  const std::filesystem::path file(study_file);
  return "lamella-cli mesh " + quoted(study_file) + " -o " +
         quoted(std::filesystem::path(file).replace_extension(".msh").string());
}

}  // namespace lamella::ui
