#include "core/study/study_file.h"

#include <algorithm>

#include "core/base/atomic_file.h"
#include "core/base/sha256.h"
#include "core/base/version.h"
#include "core/study/json_members.h"
#include "core/study/zone_json.h"

namespace lamella {

namespace {

using lamella::json_of;

/// Names of the alternatives, in the order of their variants.
const std::vector<std::string> kShapes = {"body", "sphere", "box", "cylinder", "faces"};
const std::vector<std::string> kFrames = {"cartesian", "cylindrical", "spherical"};
const std::vector<std::string> kProgressions = {"linear", "geometric"};

/// The value of the member by its name, `unset` where there is none.
template <class Values, class Value>
Value one_of(Members& m, const std::string& member, const Values& values, Value unset,
             std::string_view (*name)(Value)) {
  if (!m.has(member)) return unset;
  std::vector<std::string> names;
  for (const Value v : values) names.emplace_back(name(v));
  return *(std::begin(values) + m.choice(member, names));
}
template <class Value>
Value one_of(Members& m, const std::string& member, std::initializer_list<Value> values,
             Value unset, std::string_view (*name)(Value)) {
  return one_of<std::initializer_list<Value>, Value>(m, member, values, unset, name);
}

BodySettings read_body(const Json& json, std::size_t index, std::string& complaint) {
  BodySettings body;
  Members m(json, "bodies[" + std::to_string(index) + "]", complaint);
  m.text("name", body.name);
  if (body.name.empty()) m.complain("name", "is needed");
  m.integer("layers", body.layers, 1);
  m.number("alpha", body.alpha, true);
  m.integer("layers2", body.layers2, 1);
  m.number("alpha2", body.alpha2, true);
  m.integer("layers3", body.layers3, 1);
  m.number("h_min", body.h_min);
  m.number("h_max", body.h_max);
  m.number("interface_size", body.interface_size);
  m.flag("flow", body.flow);
  m.flag("visible", body.visible);
  body.role = one_of(
      m, "role",
      {BodyRole::none, BodyRole::cavity, BodyRole::channel, BodyRole::insert, BodyRole::mold},
      BodyRole::none, role_name);
  if (m.has("color")) {
    Vec<3> color = Vec<3>::Zero();
    m.vector("color", color);
    if (!(color.minCoeff() >= 0 && color.maxCoeff() <= 1))
      m.complain("color", "must be three numbers from 0 to 1");
    body.color = {color[0], color[1], color[2]};
  }
  m.finish();
  return body;
}

StudyOptions read_options(const Json& json, std::string& complaint) {
  StudyOptions options;
  Members m(json, "options", complaint);
  m.number("chord_tolerance", options.chord_tolerance);
  m.number("angle_tolerance", options.angle_tolerance, false);
  m.number("max_anisotropy", options.max_anisotropy);
  m.integer("iterations", options.iterations, 1);
  m.integer("threads", options.threads, 0);
  m.integer("seed", options.seed, 0);
  std::string detector(detector_name(options.detector));
  m.text("detector", detector);
  if (const auto known = detector_from_name(detector))
    options.detector = *known;
  else
    m.complain("detector", "must be \"geometric\" or \"neighborhood\"");
  m.flag("progressive", options.progressive);
  m.number("memory", options.memory);
  m.flag("until_settled", options.until_settled);
  options.interfaces = one_of(m, "interfaces", {Interfaces::fuzzy, Interfaces::exact},
                              options.interfaces, interfaces_name);
  options.capture =
      one_of(m, "capture", {Capture::distance, Capture::gradient}, options.capture, capture_name);
  m.finish();
  return options;
}

SizingShape read_shape(const Json& json, const std::string& path, std::string& complaint) {
  Members m(json, path, complaint);
  SizingShape shape;
  switch (m.choice("kind", kShapes)) {
    case 0:
      break;
    case 1: {
      SphereShape s;
      m.vector("center", s.center, true);
      m.needed("radius", s.radius);
      shape = s;
      break;
    }
    case 2: {
      BoxShape s;
      m.vector("center", s.center, true);
      m.lengths("size", s.size);
      m.vector("x_axis", s.x_axis);
      m.vector("y_axis", s.y_axis);
      shape = s;
      break;
    }
    case 3: {
      CylinderShape s;
      m.vector("from", s.from, true);
      m.vector("to", s.to, true);
      m.needed("radius", s.radius);
      shape = s;
      break;
    }
    default: {
      FacesShape s;
      m.list("ids", s.ids);
      m.list("names", s.names);
      m.number("depth", s.depth, true);
      m.flag("others", s.others);
      if (s.ids.empty() && s.names.empty() && !s.others)
        m.complain("", "needs \"ids\" or \"names\"");
      shape = s;
    }
  }
  m.finish();
  return shape;
}

AnalyticZone read_zone(const Json& json, const std::string& path, std::string& complaint) {
  Members m(json, path, complaint);
  AnalyticZone zone;
  const auto round = [&](auto frame) {
    m.vector("origin", frame.origin, true);
    m.vector("axis", frame.axis);
    zone.frame = frame;
  };
  switch (m.choice("frame", kFrames)) {
    case 0: {
      CartesianFrame frame;
      m.vector("x_axis", frame.x_axis);
      m.vector("y_axis", frame.y_axis);
      zone.frame = frame;
      break;
    }
    case 1:
      round(CylindricalFrame{});
      break;
    default:
      round(SphericalFrame{});
  }
  m.lengths("sizes", zone.sizes);
  if (m.has("progression")) {
    RadialProgression& p = zone.progression;
    Members g(m.at("progression"), path + ".progression", complaint);
    p.kind = g.choice("kind", kProgressions) == 1 ? RadialProgression::Kind::geometric
                                                  : RadialProgression::Kind::linear;
    g.number("from", p.from, true);
    if (!g.has("to")) g.complain("to", "is needed");
    g.number("to", p.to, false);
    g.lengths("sizes", p.sizes);
    g.finish();
  }
  m.flag("replace", zone.replace);
  m.finish();
  return zone;
}

SizingObject read_sizing(const Json& json, std::size_t index, std::string& complaint) {
  const std::string path = "sizing[" + std::to_string(index) + "]";
  SizingObject object;
  object.name = "sizing " + std::to_string(index + 1);
  Members m(json, path, complaint);
  m.text("name", object.name);
  m.text("body", object.body);
  if (m.has("shape"))
    object.shape = read_shape(m.at("shape"), path + ".shape", complaint);
  else
    m.complain("shape", "is needed");
  if (m.has("zone")) {
    object.asks = read_zone(m.at("zone"), path + ".zone", complaint);
  } else if (m.has("boundary_layer")) {
    BoundaryLayer layer;
    Members l(m.at("boundary_layer"), path + ".boundary_layer", complaint);
    l.number("thickness", layer.thickness, false);
    if (!(layer.thickness > 0)) l.complain("thickness", "is needed");
    l.integer("layers", layer.layers, 1);
    l.number("gradation", layer.gradation, false);
    if (!(layer.gradation > 1)) l.complain("gradation", "must be above 1");
    l.finish();
    object.asks = layer;
  } else {
    SizeCorrection c;
    m.number("size", c.size);
    m.number("factor", c.factor);
    if (c.size.has_value() == c.factor.has_value())
      m.complain("", "needs one of \"size\", \"factor\", \"zone\" and \"boundary_layer\"");
    m.number("gradation", c.gradation, false);
    if (!(c.gradation > 1)) m.complain("gradation", "must be above 1");
    m.flag("keep_directions", c.keep_directions);
    object.asks = c;
  }
  m.finish();
  return object;
}

void read_source(Members& m, StudyInput& input) {
  m.text("file", input.file);
  if (input.file.empty()) m.complain("file", "is needed");
  m.number("unit", input.unit, false);
  m.text("sha256", input.sha256);
  const auto hexadecimal = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (!input.sha256.empty() &&
      (input.sha256.size() != 64 ||
       !std::all_of(input.sha256.begin(), input.sha256.end(), hexadecimal)))
    m.complain("sha256", "must be 64 hexadecimal digits");
  m.integer("bytes", input.bytes, 0);
  m.text("entry", input.entry);
}

StudyInput read_input(const Json& json, std::size_t index, std::string& complaint) {
  StudyInput input;
  if (json.is_string()) {
    input.file = json.get<std::string>();
    return input;
  }
  Members m(json, "inputs[" + std::to_string(index) + "]", complaint);
  read_source(m, input);
  m.finish();
  return input;
}

BoundaryGroup read_group(const Json& json, std::size_t index, std::string& complaint) {
  const std::string path = "groups[" + std::to_string(index) + "]";
  BoundaryGroup group;
  Members m(json, path, complaint);
  m.text("name", group.name);
  if (group.name.empty()) m.complain("name", "is needed");
  if (m.has("kind"))
    group.kind =
        static_cast<GroupKind>(m.choice("kind", {"other", "gate", "vent", "symmetry", "walls"}));
  m.text("body", group.body);
  m.number("pressure", group.pressure);
  m.number("rate", group.rate);
  if (group.pressure && group.rate) m.complain("rate", "and a pressure exclude each other");
  m.list("faces", group.faces);
  m.list("face_names", group.face_names);
  if (m.has("floods")) {
    if (!m.at("floods").is_array()) {
      m.complain("floods", "must be a list");
    } else {
      for (const Json& item : m.at("floods")) {
        Flood flood;
        Members f(item, path + ".floods[" + std::to_string(group.floods.size()) + "]", complaint);
        f.vector("point", flood.point, true);
        f.number("angle", flood.angle, false);
        f.finish();
        group.floods.push_back(flood);
      }
    }
  }
  m.finish();
  return group;
}

StudyFlow read_flow(const Json& json, std::string& complaint) {
  StudyFlow flow;
  Members m(json, "flow", complaint);
  if (m.has("field")) {
    StudyField field;
    Members f(m.at("field"), "flow.field", complaint);
    f.text("name", field.name);
    if (field.name.empty()) f.complain("name", "is needed");
    read_source(f, field.source);
    f.finish();
    flow.field = std::move(field);
    flow.method = one_of(m, "method", kFieldMethods, FlowMethod::field, flow_method_name);
  } else {
    flow.method = one_of(m, "method", kFlowMethods, flow.method, flow_method_name);
  }
  m.number("strength", flow.strength, false);
  m.number("beta", flow.beta, false);
  m.number("growth", flow.growth, false);
  if (!(flow.growth > 1)) m.complain("growth", "must be above 1");
  m.integer("rounds", flow.rounds, 0);
  m.number("viscosity", flow.viscosity, false);
  m.number("h_min", flow.h_min);
  m.finish();
  return flow;
}

CutPlane read_cut(const Json& json, std::size_t index, std::string& complaint) {
  CutPlane cut;
  cut.name = "cut " + std::to_string(index + 1);
  Members m(json, "cuts[" + std::to_string(index) + "]", complaint);
  m.text("name", cut.name);
  m.vector("origin", cut.origin, true);
  m.vector("normal", cut.normal, true);
  if (!(cut.normal.norm() > 0)) m.complain("normal", "must not be zero");
  cut.normal.normalize();
  m.flag("on", cut.on);
  m.finish();
  return cut;
}

Json json_of(const SizingShape& shape) {
  Json json;
  json["kind"] = kShapes.at(shape.index());
  if (const auto* s = std::get_if<SphereShape>(&shape)) {
    json["center"] = json_of(s->center);
    json["radius"] = s->radius;
  } else if (const auto* b = std::get_if<BoxShape>(&shape)) {
    json["center"] = json_of(b->center);
    json["size"] = json_of(b->size);
    json["x_axis"] = json_of(b->x_axis);
    json["y_axis"] = json_of(b->y_axis);
  } else if (const auto* c = std::get_if<CylinderShape>(&shape)) {
    json["from"] = json_of(c->from);
    json["to"] = json_of(c->to);
    json["radius"] = c->radius;
  } else if (const auto* f = std::get_if<FacesShape>(&shape)) {
    if (!f->ids.empty()) json["ids"] = f->ids;
    if (!f->names.empty()) json["names"] = f->names;
    json["depth"] = f->depth;
    if (f->others) json["others"] = true;
  }
  return json;
}

Json json_of(const AnalyticZone& zone) {
  Json json;
  json["frame"] = kFrames.at(zone.frame.index());
  if (const auto* f = std::get_if<CartesianFrame>(&zone.frame)) {
    json["x_axis"] = json_of(f->x_axis);
    json["y_axis"] = json_of(f->y_axis);
  } else {
    const auto round = [&](const auto& frame) {
      json["origin"] = json_of(frame.origin);
      json["axis"] = json_of(frame.axis);
    };
    if (const auto* c = std::get_if<CylindricalFrame>(&zone.frame)) round(*c);
    if (const auto* s = std::get_if<SphericalFrame>(&zone.frame)) round(*s);
  }
  json["sizes"] = json_of(zone.sizes);
  const RadialProgression& p = zone.progression;
  if (p.kind != RadialProgression::Kind::none)
    json["progression"] = {
        {"kind", kProgressions.at(p.kind == RadialProgression::Kind::geometric ? 1 : 0)},
        {"from", p.from},
        {"to", p.to},
        {"sizes", json_of(p.sizes)}};
  json["replace"] = zone.replace;
  return json;
}

Json json_of(const SizingObject& object) {
  Json json;
  json["name"] = object.name;
  if (!object.body.empty()) json["body"] = object.body;
  json["shape"] = json_of(object.shape);
  if (const auto* zone = std::get_if<AnalyticZone>(&object.asks)) {
    json["zone"] = json_of(*zone);
    return json;
  }
  if (const auto* layer = std::get_if<BoundaryLayer>(&object.asks)) {
    json["boundary_layer"] = {{"thickness", layer->thickness},
                              {"layers", layer->layers},
                              {"gradation", layer->gradation}};
    return json;
  }
  const auto& c = std::get<SizeCorrection>(object.asks);
  if (c.size) json["size"] = *c.size;
  if (c.factor) json["factor"] = *c.factor;
  json["gradation"] = c.gradation;
  json["keep_directions"] = c.keep_directions;
  return json;
}

Json json_of(const BoundaryGroup& group) {
  Json json;
  json["name"] = group.name;
  json["kind"] = group_kind_name(group.kind);
  if (!group.body.empty()) json["body"] = group.body;
  if (group.pressure) json["pressure"] = *group.pressure;
  if (group.rate) json["rate"] = *group.rate;
  if (!group.faces.empty()) json["faces"] = group.faces;
  if (!group.face_names.empty()) json["face_names"] = group.face_names;
  for (const Flood& flood : group.floods)
    json["floods"].push_back({{"point", json_of(flood.point)}, {"angle", flood.angle}});
  return json;
}

Json json_of(const StudyInput& input) {
  Json json;
  json["file"] = input.file;
  if (input.unit != 1) json["unit"] = input.unit;
  if (!input.sha256.empty()) {
    json["sha256"] = input.sha256;
    json["bytes"] = input.bytes;
  }
  if (!input.entry.empty()) json["entry"] = input.entry;
  return json;
}

Json json_of(const StudyFlow& flow) {
  Json json = {{"method", flow_method_name(flow.method)},
               {"strength", flow.strength},
               {"beta", flow.beta},
               {"growth", flow.growth},
               {"rounds", flow.rounds},
               {"viscosity", flow.viscosity}};
  if (flow.h_min) json["h_min"] = *flow.h_min;
  if (flow.field) {
    json["field"] = json_of(flow.field->source);
    json["field"]["name"] = flow.field->name;
  }
  return json;
}

}  // namespace

std::string study_to_json(const Study& study) {
  Json json;
  json["schema"] = kStudySchema;
  json["program"] = "Lamella " + version();
  json["name"] = study.name;
  json["unit"] = "mm";
  json["inputs"] = Json::array();
  for (const StudyInput& input : study.inputs) {
    Json in = json_of(input);
    json["inputs"].push_back(in.size() == 1 ? Json(input.file) : std::move(in));
  }
  if (study.embed_inputs) json["embed_inputs"] = true;
  if (!study.left_out.empty()) json["left_out"] = study.left_out;
  json["bodies"] = Json::array();
  for (const BodySettings& body : study.bodies) {
    Json b;
    b["name"] = body.name;
    b["layers"] = body.layers;
    b["alpha"] = body.alpha;
    if (body.layers2) b["layers2"] = *body.layers2;
    if (body.layers2) b["alpha2"] = body.alpha2;
    if (body.layers3) b["layers3"] = *body.layers3;
    if (body.h_min) b["h_min"] = *body.h_min;
    if (body.h_max) b["h_max"] = *body.h_max;
    if (body.interface_size) b["interface_size"] = *body.interface_size;
    if (!body.flow) b["flow"] = false;
    b["visible"] = body.visible;
    if (body.role != BodyRole::none) b["role"] = role_name(body.role);
    if (body.color) b["color"] = *body.color;
    json["bodies"].push_back(std::move(b));
  }
  for (const StudyZone& zone : study.zones) json["zones"].push_back(json_of(zone));
  if (study.domain) json["domain"] = json_of(*study.domain);
  if (!study.dropped.empty()) json["dropped"] = study.dropped;
  const StudyOptions& o = study.options;
  Json& options = json["options"];
  if (o.chord_tolerance) options["chord_tolerance"] = *o.chord_tolerance;
  options["angle_tolerance"] = o.angle_tolerance;
  if (o.max_anisotropy) options["max_anisotropy"] = *o.max_anisotropy;
  options["iterations"] = o.iterations;
  options["threads"] = o.threads;
  options["seed"] = o.seed;
  options["detector"] = detector_name(o.detector);
  options["progressive"] = o.progressive;
  if (o.memory) options["memory"] = *o.memory;
  options["until_settled"] = o.until_settled;
  if (study.domain) {
    options["interfaces"] = interfaces_name(o.interfaces);
    options["capture"] = capture_name(o.capture);
  }
  for (const SizingObject& object : study.sizing) json["sizing"].push_back(json_of(object));
  for (const BoundaryGroup& group : study.groups) json["groups"].push_back(json_of(group));
  if (study.flow) json["flow"] = json_of(*study.flow);
  for (const CutPlane& cut : study.cuts)
    json["cuts"].push_back({{"name", cut.name},
                            {"origin", json_of(cut.origin)},
                            {"normal", json_of(cut.normal)},
                            {"on", cut.on}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string mesh_key(Study study) {
  study.name.clear();
  study.embed_inputs = false;
  study.options.threads = 0;
  study.options.memory.reset();
  study.cuts.clear();
  // A file is what it holds, not where it lies.
  for (StudyInput* input : sources_of(study)) *input = {"", input->unit, input->sha256, 0, ""};
  for (BodySettings& body : study.bodies) {
    body.visible = true;
    body.color.reset();
    // Who keeps what bodies share is asked in one mesh of all only.
    if (!study.domain) body.role = BodyRole::none;
  }
  return study_to_json(study);
}

Result<void> identify(StudyInput& input, const std::filesystem::path& file) {
  Result<std::string> bytes = read_file(file);
  if (!bytes) return bytes.error();
  input.sha256 = sha256(*bytes);
  input.bytes = bytes->size();
  return {};
}

Result<Study> study_from_json(const std::string& text, const std::string& where, int* schema) {
  const auto refuse = [&](const std::string& finding, const std::string& hint) {
    return Error{Code::bad_input, "\"" + where + "\": " + finding + ".", hint};
  };
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded())
    return refuse("not a study, it is no valid JSON", "Give a study, a STEP or an STL file.");
  if (!json.is_object() || !json.contains("schema") || !json["schema"].is_number_integer())
    return refuse("not a study, the member \"schema\" is missing", "Give a study of Lamella.");
  const Json& version = json["schema"];
  if (version.is_number_unsigned() && version.get<std::uint64_t>() > kStudySchema)
    return refuse("written by a newer version (schema " + version.dump() +
                      "; this one reads up to " + std::to_string(kStudySchema) + ")",
                  "Update Lamella.");
  if (version.get<std::int64_t>() < 1)
    return refuse("there is no schema " + version.dump(), "Give a study of Lamella.");
  if (schema) *schema = version.get<int>();
  std::string complaint;
  Study study;
  Members m(json, "", complaint);
  m.has("schema");
  m.has("program");
  std::string unit = "mm";
  m.text("unit", unit);
  if (unit != "mm") m.complain("unit", "must be \"mm\"");
  m.text("name", study.name);
  const auto each = [&](const char* name, auto& values, auto read) {
    if (!m.has(name)) return;
    if (!m.at(name).is_array()) return m.complain(name, "must be a list");
    for (const Json& item : m.at(name)) values.push_back(read(item, values.size(), complaint));
  };
  each("inputs", study.inputs, read_input);
  m.flag("embed_inputs", study.embed_inputs);
  m.list("left_out", study.left_out);
  each("bodies", study.bodies, read_body);
  each("zones", study.zones, read_study_zone);
  m.list("dropped", study.dropped);
  for (std::size_t z = 0; z < study.zones.size(); ++z)
    if (const std::string finding = conflict(study.zones, z); !finding.empty())
      m.complain("zones[" + std::to_string(z) + "]", finding);
  if (m.has("domain")) study.domain = read_domain(m.at("domain"), complaint);
  if (m.has("options")) study.options = read_options(m.at("options"), complaint);
  each("sizing", study.sizing, read_sizing);
  each("groups", study.groups, read_group);
  if (m.has("flow")) study.flow = read_flow(m.at("flow"), complaint);
  each("cuts", study.cuts, read_cut);
  m.finish();
  if (!complaint.empty()) return refuse(complaint, "Correct or remove it.");
  return study;
}

Result<Study> read_study(const std::filesystem::path& file) {
  Result<std::string> text = read_file(file);
  if (!text) return text.error();
  return study_from_json(*text, file.string());
}

Result<void> write_study(const Study& study, const std::filesystem::path& file) {
  return write_file(file, study_to_json(study));
}

Result<void> save_study(const Study& study, const std::filesystem::path& file) {
  const std::string text = study_to_json(study);
  const Result<std::string> before = read_file(file);
  Result<AtomicFile> target = AtomicFile::create(file);
  if (!target) return target.error();
  target->stream() << text << std::flush;
  Result<Study> back = read_study(target->temporary());
  if (!target->stream() || !back || study_to_json(*back) != text)
    return Error{Code::io, "\"" + file.string() + "\" does not read back as written.",
                 "Check the space on the disk, or save it elsewhere."};
  return target->commit(before && *before != text);
}

}  // namespace lamella
