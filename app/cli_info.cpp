#include <algorithm>

#include "app/cli_commands.h"
#include "app/cli_common.h"
#include "app/services.h"
#include "core/cad/load_parts.h"
#include "core/geometry/soup.h"

namespace lamella::cli {

namespace {

/// One line a face: what --size-face and sizing objects pick it by.
void say_faces(const Part& part, Console& console) {
  const ReferenceSurface<3>& s = part.surface;
  struct Found {
    double area = 0, largest = -1;
    Vec<3> point = Vec<3>::Zero();
    std::size_t triangles = 0;
  };
  std::vector<Found> faces(s.faces.size());
  for (std::size_t f = 0; f < s.facets.size(); ++f) {
    const std::array<Vec<3>, 3> p = {s.points[s.facets[f][0]], s.points[s.facets[f][1]],
                                     s.points[s.facets[f][2]]};
    const double area = facet_area(s, f);
    Found& face = faces[s.facet_face[f]];
    face.area += area;
    ++face.triangles;
    if (area <= face.largest) continue;
    face.largest = area;
    face.point = (p[0] + p[1] + p[2]) / 3;
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Found& face = faces[f];
    const std::string& name = s.faces[f].name;
    console.say("  face " + std::to_string(f) + (name.empty() ? "" : " \"" + name + "\"") + ": " +
                short_number(face.area, 6) + " mm2, through (" + short_number(face.point[0], 5) +
                ", " + short_number(face.point[1], 5) + ", " + short_number(face.point[2], 5) +
                ")");
    console.emit(dump({{"phase", "face"},
                       {"body", part.name},
                       {"id", f},
                       {"name", name},
                       {"area", face.area},
                       {"triangles", face.triangles},
                       {"point", {face.point[0], face.point[1], face.point[2]}}}));
  }
}

Json vector_json(const Vec<3>& x) { return {x[0], x[1], x[2]}; }

Json finding_json(const Finding& finding) {
  Json places = Json::array();
  for (const Vec<3>& x : finding.places) places.push_back(vector_json(x));
  return {{"count", finding.count}, {"places", std::move(places)}};
}

/// What the findings are called, in text and JSON.
struct Kind {
  const Finding Diagnosis::*finding;
  const char* key;
  const char* text;
};
constexpr Kind kKinds[] = {
    {&Diagnosis::open_edges, "open_edges", "open edge"},
    {&Diagnosis::non_manifold_edges, "non_manifold_edges", "non-manifold edge"},
    {&Diagnosis::wrong_windings, "wrong_windings", "wrongly wound edge"},
    {&Diagnosis::duplicate_facets, "duplicate_facets", "duplicate facet"},
    {&Diagnosis::degenerate_facets, "degenerate_facets", "degenerate facet"},
    {&Diagnosis::self_intersections, "self_intersections", "pair of facets that cross"},
    {&Diagnosis::thin_walls, "thin_walls", "facet on a thin wall"}};

std::string sentence(const Finding& finding, const std::string& what) {
  std::string plural = what;
  if (finding.count != 1) {
    const std::size_t of = plural.find(" of "), on = plural.find(" on ");
    plural.insert(std::min({of, on, plural.size()}), "s");
  }
  return grouped(finding.count) + " " + plural + ", the first at " +
         place_text(finding.places.front());
}

/// The file as it is, before any repair.
void say_diagnosis(const FileDiagnosis& file, Console& console) {
  if (file.bodies.empty() && file.free_shells + file.free_faces == 0) return;  // not even read
  Json bodies = Json::array();
  for (std::size_t b = 0; b < file.bodies.size(); ++b) {
    const Diagnosis& d = file.bodies[b];
    const std::string who = d.name.empty() ? "body " + std::to_string(b + 1) : d.name;
    const auto voids = std::count_if(d.shells.begin(), d.shells.end(),
                                     [](const ShellFinding& s) { return s.depth % 2 == 1; });
    constexpr std::size_t kMostTold = 20;
    if (b == kMostTold)
      console.say("as read     .. and " + std::to_string(file.bodies.size() - kMostTold) +
                  " further bodies");
    const auto say = [&](const std::string& text) {
      if (b < kMostTold) console.say(text);
    };
    say("as read     " + who + ": " + grouped(d.facets) + " triangles, " +
        counted(d.shells.size(), "shell") +
        (voids > 0 ? ", " + counted(static_cast<std::size_t>(voids), "void") : "") +
        (d.sound() ? ", sound" : "") +
        (d.thinnest > 0 ? ", thinnest wall " + short_number(d.thinnest, 3) + " mm" : ""));
    Json json = {{"name", who},
                 {"triangles", d.facets},
                 {"vertices", d.vertices},
                 {"area", d.area},
                 {"volume", d.volume},
                 {"low", vector_json(d.low)},
                 {"high", vector_json(d.high)},
                 {"sound", d.sound()},
                 {"exact_shape_valid", d.exact_shape_valid},
                 {"thin_limit", d.thin_limit},
                 {"thinnest", d.thinnest}};
    if (!d.exact_shape_valid) say("            the CAD kernel's own check calls the solid invalid");
    for (const Kind& kind : kKinds) {
      const Finding& finding = d.*kind.finding;
      json[kind.key] = finding_json(finding);
      if (finding.count > 0) say("            " + sentence(finding, kind.text));
    }
    Json shells = Json::array();
    for (const ShellFinding& s : d.shells)
      shells.push_back({{"triangles", s.facets},
                        {"closed", s.closed},
                        {"volume", s.volume},
                        {"depth", s.depth},
                        {"around", s.around},
                        {"low", vector_json(s.low)},
                        {"high", vector_json(s.high)}});
    json["shells"] = std::move(shells);
    bodies.push_back(std::move(json));
  }
  if (file.free_shells + file.free_faces > 0)
    console.say("as read     " + counted(file.free_shells, "free shell") + " and " +
                counted(file.free_faces, "free face") + " outside any solid");
  console.emit(dump({{"phase", "diagnosis"},
                     {"unit_guess", file.unit_guess},
                     {"free_shells", file.free_shells},
                     {"free_faces", file.free_faces},
                     {"bodies", std::move(bodies)}}));
}

/// The notes tell it to people, where it was done.
void emit_wrap(const WrapReport& wrap, Console& console) {
  const auto deviation = [](const Deviation& d) {
    return Json{{"distance", d.distance}, {"place", vector_json(d.place)}};
  };
  console.emit(dump({{"phase", "wrap"},
                     {"bodies", wrap.bodies},
                     {"spacing", wrap.spacing},
                     {"to_file", deviation(wrap.to_file)},
                     {"from_file", deviation(wrap.from_file)},
                     {"bridged", wrap.bridged},
                     {"specks", wrap.specks}}));
}

}  // namespace

int run_info(const InfoCommand& c, Console& console) {
  LoadParams load = load_params(c.repair, c.wrap_spacing, c.cad);
  load.chord_tolerance = c.chord_tolerance;
  load.unit = unit_factor(c.unit);
  const Inspection inspection =
      names_mesh(c.part) ? Inspection{{}, {}, load_bodies(c.part, load, console.progress())}
                         : inspect_parts(c.part, load, console.progress());
  say_diagnosis(inspection.diagnosis, console);
  const Result<std::vector<Part>>& parts = inspection.parts;
  if (!parts) return console.fail(of_input(parts.error()));
  for (const WrapReport& wrap : inspection.wraps) emit_wrap(wrap, console);
  console.say(c.part + ": " + std::to_string(parts->size()) +
              (parts->size() == 1 ? " body" : " bodies"));
  for (const Part& part : *parts) {
    Vec<3> low = Vec<3>::Constant(1e300), high = -low;
    for (const Vec<3>& x : part.surface.points) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    const Vec<3> size = high - low;
    double area = 0;
    for (std::size_t f = 0; f < part.surface.facets.size(); ++f)
      area += facet_area(part.surface, f);
    // Twice the volume over the area is the thickness of a thin sheet.
    const double wall = area > 0 ? 2 * part.cad_volume / area : 0;
    console.say("body \"" + part.name + "\"");
    console.say("  size        " + short_number(size[0], 6) + " x " + short_number(size[1], 6) +
                " x " + short_number(size[2], 6) + " mm");
    console.say("  volume      " + short_number(part.cad_volume, 8) + " mm3, area " +
                short_number(area, 8) + " mm2, mean wall about " + short_number(wall, 3) + " mm");
    console.say("  surface     " + grouped(part.surface.facets.size()) + " triangles on " +
                grouped(part.surface.faces.size()) + " faces, " +
                grouped(part.surface.feature_edges.size()) + " feature edges, within " +
                short_number(part.chord_error, 3) + " mm");
    for (const std::string& note : part.notes) console.say("  note        " + note);
    console.emit(dump({{"phase", "body"},
                       {"name", part.name},
                       {"size", {size[0], size[1], size[2]}},
                       {"volume", part.cad_volume},
                       {"area", area},
                       {"mean_wall", wall},
                       {"triangles", part.surface.facets.size()},
                       {"faces", part.surface.faces.size()},
                       {"feature_edges", part.surface.feature_edges.size()},
                       {"chord_error", part.chord_error},
                       {"notes", part.notes}}));
    if (c.faces) say_faces(part, console);
  }
  return 0;
}

}  // namespace lamella::cli
