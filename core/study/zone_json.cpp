#include "core/study/zone_json.h"

namespace lamella {

namespace {

/// Names of the alternatives, in the order of their variants.
const std::vector<std::string> kZones = {"ball", "box", "cylinder", "half_space", "voronoi"};
const std::vector<std::string> kDomains = {"none", "box", "cylinder", "margin", "body"};

void read(Members& m, ZoneBall& ball) {
  m.vector("center", ball.center, true);
  m.needed("radius", ball.radius);
}
void read(Members& m, ZoneBox& box) {
  m.vector("low", box.low, true);
  m.vector("high", box.high, true);
  if (!((box.high - box.low).minCoeff() > 0)) m.complain("high", "must be above \"low\"");
}
void read(Members& m, ZoneCylinder& cylinder) {
  m.vector("from", cylinder.from, true);
  m.vector("to", cylinder.to, true);
  if (cylinder.from == cylinder.to) m.complain("to", "must differ from \"from\"");
  m.needed("radius", cylinder.radius);
}
void read(Members& m, ZoneHalfSpace& half) {
  m.vector("normal", half.normal, true);
  if (!(half.normal.norm() > 0)) m.complain("normal", "must not be zero");
  if (!m.has("offset"))
    m.complain("offset", "is needed");
  else if (!m.at("offset").is_number())
    m.complain("offset", "must be a number");
  else
    half.offset = m.at("offset").get<double>();
}
void read(Members& m, ZoneCell& cell) {
  m.vector("seed", cell.seed, true);
  m.text("set", cell.set);
}
void read(Members&, DomainBodies&) {}
void read(Members& m, DomainMargin& margin) { m.number("share", margin.share, false); }
void read(Members& m, DomainBody& body) {
  m.text("body", body.name);
  if (body.name.empty()) m.complain("body", "is needed");
}

/// The alternative whose number is `choice`, read.
template <class Variant, std::size_t I = 0>
Variant read_alternative(Members& m, std::size_t choice) {
  if constexpr (I + 1 < std::variant_size_v<Variant>)
    if (choice != I) return read_alternative<Variant, I + 1>(m, choice);
  std::variant_alternative_t<I, Variant> value;
  read(m, value);
  return value;
}

void write(Json& json, const ZoneBall& ball) {
  json["center"] = json_of(ball.center);
  json["radius"] = ball.radius;
}
void write(Json& json, const ZoneBox& box) {
  json["low"] = json_of(box.low);
  json["high"] = json_of(box.high);
}
void write(Json& json, const ZoneCylinder& cylinder) {
  json["from"] = json_of(cylinder.from);
  json["to"] = json_of(cylinder.to);
  json["radius"] = cylinder.radius;
}
void write(Json& json, const ZoneHalfSpace& half) {
  json["normal"] = json_of(half.normal);
  json["offset"] = half.offset;
}
void write(Json& json, const ZoneCell& cell) {
  json["seed"] = json_of(cell.seed);
  if (!cell.set.empty()) json["set"] = cell.set;
}
void write(Json&, const DomainBodies&) {}
void write(Json& json, const DomainMargin& margin) { json["share"] = margin.share; }
void write(Json& json, const DomainBody& body) { json["body"] = body.name; }

}  // namespace

Json json_of(const StudyZone& zone) {
  Json json;
  json["name"] = zone.name;
  json["shape"] = kZones.at(zone.shape.index());
  std::visit([&](const auto& shape) { write(json, shape); }, zone.shape);
  return json;
}

Json json_of(const StudyDomain& domain) {
  Json json;
  json["shape"] = kDomains.at(domain.shape.index());
  std::visit([&](const auto& shape) { write(json, shape); }, domain.shape);
  return json;
}

StudyZone read_study_zone(const Json& json, std::size_t index, std::string& complaint) {
  StudyZone zone;
  Members m(json, "zones[" + std::to_string(index) + "]", complaint);
  m.text("name", zone.name);
  if (zone.name.empty()) m.complain("name", "is needed");
  zone.shape = read_alternative<decltype(zone.shape)>(m, m.choice("shape", kZones));
  m.finish();
  return zone;
}

StudyDomain read_domain(const Json& json, std::string& complaint) {
  StudyDomain domain;
  Members m(json, "domain", complaint);
  domain.shape = read_alternative<decltype(domain.shape)>(m, m.choice("shape", kDomains));
  m.finish();
  return domain;
}

std::string conflict(const std::vector<StudyZone>& zones, std::size_t index) {
  const StudyZone& zone = zones[index];
  const auto* cell = std::get_if<ZoneCell>(&zone.shape);
  for (std::size_t before = 0; before < index; ++before) {
    if (zones[before].name == zone.name)
      return "has the name of zones[" + std::to_string(before) + "]";
    const auto* other = std::get_if<ZoneCell>(&zones[before].shape);
    if (cell && other && *cell == *other)
      return "has the seed of zones[" + std::to_string(before) + "]";
  }
  return "";
}

}  // namespace lamella
