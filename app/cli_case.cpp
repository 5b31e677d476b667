#include <algorithm>
#include <filesystem>

#include "app/cli_commands.h"
#include "core/multidomain/microstructure.h"
#include "core/study/study_file.h"

namespace lamella::cli {

namespace {

namespace fs = std::filesystem;

/// Options that some cases have, and which.
struct Belongs {
  const char* option;
  bool given;
  std::vector<std::string> cases;
};

std::optional<Error> misplaced(const CaseCommand& c) {
  for (const Belongs& b :
       std::vector<Belongs>{{"--grains", c.grains.has_value(), {"polycrystal"}},
                            {"--relaxations", c.relaxations.has_value(), {"polycrystal"}},
                            {"--count", c.count.has_value(), {"inclusions", "fibers"}},
                            {"--fraction", c.fraction.has_value(), {"inclusions", "fibers"}},
                            {"--radius", !c.radius.empty(), {"inclusions", "fibers"}},
                            {"--gap", c.gap.has_value(), {"inclusions", "fibers"}},
                            {"--length", c.length.has_value(), {"fibers"}},
                            {"--orientation", !c.orientation.empty(), {"fibers"}},
                            {"--size", !c.size.empty(), {"polycrystal", "inclusions", "fibers"}},
                            {"--angle", c.angle.has_value(), {"tilted-plate"}}})
    if (b.given && std::find(b.cases.begin(), b.cases.end(), c.name) == b.cases.end())
      return Error{Code::usage,
                   std::string(b.option) + " means nothing to the case " + c.name + ".",
                   "Leave it out, or choose the case " + b.cases.front() + "."};
  if (!c.size.empty() && c.size.size() != 3)
    return Error{Code::usage, "--size needs three lengths.", "Write it as --size X,Y,Z."};
  if (c.radius.size() > (c.name == "fibers" ? 1u : 2u))
    return Error{Code::usage, "--radius has too many values.",
                 "Inclusions have one or two, the least and the largest; fibers have one."};
  if (!c.orientation.empty() && c.orientation.size() != 3)
    return Error{Code::usage, "--orientation needs three values.",
                 "Write it as --orientation A,B,C, with the sum 1."};
  return std::nullopt;
}

ZoneBox box_of(const CaseCommand& c) {
  const Vec<3> high =
      c.size.empty() ? Vec<3>::Constant(10) : Vec<3>(c.size[0], c.size[1], c.size[2]);
  return {Vec<3>::Zero(), high};
}

void add(Study& study, const char* kind, decltype(StudyZone::shape) shape) {
  study.zones.push_back({kind + (" " + std::to_string(study.zones.size() + 1)), std::move(shape)});
}

std::optional<Error> polycrystal(const CaseCommand& c, const Progress& progress, Study& study) {
  const ZoneCylinder round{Vec<3>::Zero(), {0, 0, 10}, 5};
  const ZoneBox box = box_of(c);
  PolycrystalOptions options;
  options.grains = c.grains.value_or(50);
  options.relaxations = c.relaxations.value_or(0);
  options.seed = c.seed;
  const auto seeds =
      polycrystal_seeds(c.size.empty() ? cylinder_specimen(round.from, round.to, round.radius)
                                       : box_specimen(box.low, box.high),
                        options, progress);
  if (!seeds) return seeds.error();
  if (c.size.empty())
    study.domain = {round};
  else
    study.domain = {box};
  for (const Vec<3>& seed : *seeds) add(study, "grain", ZoneCell{seed, ""});
  return std::nullopt;
}

std::optional<Error> inclusions(const CaseCommand& c, const Progress& progress, Study& study) {
  const ZoneBox box = box_of(c);
  InclusionOptions options;
  options.count = c.count;
  options.fraction =
      c.count && !c.fraction ? std::nullopt : std::optional(c.fraction.value_or(0.1));
  if (!c.radius.empty()) {
    options.radius_min = c.radius.front();
    options.radius_max = c.radius.back();
  }
  options.gap = c.gap.value_or(0.1);
  options.seed = c.seed;
  const auto balls = pack_balls(box_specimen(box.low, box.high), options, progress);
  if (!balls) return balls.error();
  study.domain = {box};
  for (const BallInclusion& ball : *balls)
    add(study, "inclusion", ZoneBall{ball.center, ball.radius});
  return std::nullopt;
}

std::optional<Error> fibers(const CaseCommand& c, const Progress& progress, Study& study) {
  const ZoneBox box = box_of(c);
  FiberOptions options;
  options.count = c.count;
  options.fraction =
      c.count && !c.fraction ? std::nullopt : std::optional(c.fraction.value_or(0.03));
  options.length = c.length.value_or(3);
  options.radius = c.radius.empty() ? 0.2 : c.radius.front();
  options.gap = c.gap.value_or(0.1);
  if (!c.orientation.empty())
    options.orientation = Vec<3>(c.orientation[0], c.orientation[1], c.orientation[2]).asDiagonal();
  options.seed = c.seed;
  const auto packed = pack_fibers(box_specimen(box.low, box.high), options, progress);
  if (!packed) return packed.error();
  study.domain = {box};
  for (const FiberInclusion& fiber : *packed)
    add(study, "fiber", ZoneCylinder{fiber.from, fiber.to, fiber.radius});
  return std::nullopt;
}

/// Figure 6.5: the intersection is a third body, with triple lines around it.
void two_balls(Study& study) {
  study.domain = {ZoneBox{{-3, -2, -2}, {3, 2, 2}}};
  add(study, "ball", ZoneBall{{-0.6, 0, 0}, 1});
  add(study, "ball", ZoneBall{{0.6, 0, 0}, 1});
}

/// A plate of 1 mm between two parallel planes: what is below it covers the rest of its half space.
void tilted_plate(const CaseCommand& c, Study& study) {
  const double angle = c.angle.value_or(0.61);
  const Vec<3> normal(std::cos(angle), std::sin(angle), 0);
  study.domain = {ZoneBox{Vec<3>::Constant(-5), Vec<3>::Constant(5)}};
  study.zones = {{"below", ZoneHalfSpace{normal, -0.5}}, {"plate", ZoneHalfSpace{normal, 0.5}}};
}

}  // namespace

int run_case(const CaseCommand& c, Console& console) {
  if (const auto error = misplaced(c)) return console.fail(*error);
  Study study;
  study.name = c.name;
  std::optional<Error> error;
  if (c.name == "polycrystal")
    error = polycrystal(c, console.progress(), study);
  else if (c.name == "inclusions")
    error = inclusions(c, console.progress(), study);
  else if (c.name == "fibers")
    error = fibers(c, console.progress(), study);
  else if (c.name == "two-balls")
    two_balls(study);
  else
    tilted_plate(c, study);
  if (error) return console.fail(*error);
  study.options.seed = c.seed;
  for (const StudyZone& zone : study.zones) {
    BodySettings body;
    body.name = zone.name;
    body.layers = c.layers;
    study.bodies.push_back(body);
  }
  fs::path file = c.output.empty() ? c.name + ".json" : c.output;
  if (std::error_code ec; fs::is_directory(file, ec)) file /= c.name + ".json";
  if (Result<void> done = write_study(study, file); !done) return console.fail(done.error());
  console.say("wrote " + file.string() + ": " + std::to_string(study.zones.size()) + " zones");
  return 0;
}

}  // namespace lamella::cli
