// Many bodies in one mesh (chapters 6 and 7): what fuzzy and exact interfaces reach, case by case.
// Tables of resources/docs/multidomain.md, which holds the reading, and a mesh a case into a
// folder.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "core/base/atomic_file.h"
#include "core/cad/load_parts.h"
#include "core/cad/sample_parts.h"
#include "core/io/mesh_file.h"
#include "core/multidomain/microstructure.h"
#include "core/study/assembly_members.h"
#include "core/study/request.h"
#include "core/study/svg_plot.h"
#include "tests/support/sample_surfaces.h"
#include "tests/support/temporary_folder.h"
#include "tests/validation/layer_cases.h"

namespace lamella {
namespace {

namespace fs = std::filesystem;

constexpr int kFirst = 8, kLast = 12;  // iterations that are compared
constexpr double kPoor = 0.2;          // quality
constexpr int kRealLayers = 2;         // n of real parts

struct Scene {
  std::string name;
  Study study;
  std::vector<Part> parts{};
};

std::string number(double v, int digits = 3) { return short_number(v, digits); }

StudyZone ball(const std::string& name, const Vec<3>& center, double radius) {
  return {name, ZoneBall{center, radius}};
}

Study study_of(std::vector<StudyZone> zones, StudyDomain domain) {
  Study study;
  study.zones = std::move(zones);
  study.domain = std::move(domain);
  return study;
}

const ZoneBox kBox{Vec<3>::Constant(-5), Vec<3>::Constant(5)};

/// A plate 1 mm thick right through the box, its normal 30 degrees off the z axis.
Scene tilted_plate(double azimuth) {
  const double tilt = std::numbers::pi / 6, turn = azimuth * std::numbers::pi / 180;
  const Vec<3> n(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
  return {"tilted plate, azimuth " + number(azimuth),
          study_of({{"below", ZoneHalfSpace{n, -0.5}}, {"plate", ZoneHalfSpace{n, 0.5}}}, {kBox})};
}

/// A plate of 24 x 16 x 2 mm with two holes of 4 x 4 mm, figure 6.6, in a box.
Scene pierced_plate() {
  const std::vector<double> x{0, 4, 8, 16, 20, 24}, y{0, 6, 10, 16}, z{0, 2};
  Scene scene{"pierced plate", {}, {}};
  scene.parts.push_back(part_of("plate", testing::cell_surface({x, y, z}, [](int i, int j, int) {
                                  return j != 1 || (i != 1 && i != 3);
                                })));
  scene.parts.back().cad_volume = enclosed_measure(scene.parts.back().surface);
  scene.study.domain = StudyDomain{DomainMargin{0.15}};
  return scene;
}

Result<Scene> polycrystal(int grains) {
  const Vec<3> from = Vec<3>::Zero(), to = 10 * Vec<3>::UnitZ();
  PolycrystalOptions options;
  options.grains = grains;
  Result<std::vector<Vec<3>>> seeds = polycrystal_seeds(cylinder_specimen(from, to, 5), options);
  if (!seeds) return seeds.error();
  std::vector<StudyZone> zones;
  for (const Vec<3>& seed : *seeds)
    zones.push_back({"grain " + std::to_string(zones.size() + 1), ZoneCell{seed, "grains"}});
  return Scene{"polycrystal of " + std::to_string(grains) + " grains",
               study_of(std::move(zones), {ZoneCylinder{from, to, 5}})};
}

/// The tube in its block, figures 6.2 and 7.2, with the bore of the tube as what is around both.
Result<Scene> twisted_tube() {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "twisted_tube.step";
  if (const Result<void> written = write_sample("twisted_tube", file); !written)
    return written.error();
  Result<std::vector<Part>> parts = load_parts(file);
  if (!parts) return parts.error();
  Scene scene{"twisted tube in a block", {}, std::move(*parts)};
  scene.study.domain = StudyDomain{ZoneBox{{-30, -30, 0}, {30, 30, 60}}};
  return scene;
}

Result<Scene> files(const std::string& name, const fs::path& folder,
                    const std::vector<std::string>& names) {
  Scene scene{name, {}, {}};
  for (const std::string& file : names) {
    Result<std::vector<Part>> parts = load_parts(folder / file);
    if (!parts) return parts.error();
    scene.parts.insert(scene.parts.end(), parts->begin(), parts->end());
  }
  number_names(scene.parts);
  for (const Part& part : scene.parts) scene.study.bodies.push_back({part.name, kRealLayers});
  scene.study.domain = StudyDomain{DomainMargin{}};
  return scene;
}

Result<Outcome> made(const Scene& scene, Interfaces interfaces, int iterations,
                     bool until_settled) {
  Study study = scene.study;
  study.options.interfaces = interfaces;
  study.options.iterations = iterations;
  study.options.until_settled = until_settled;
  return run(study, scene.parts, {std::shared_ptr<const VolumeMesher>(topological_mesher())});
}

/// The angle to the border's normal that the direction of the smallest size keeps below in 95 % of
/// the mixed elements, degrees: that of their metric, and that of their own shape.
std::array<double, 2> turns_of_elements(const MeshState& state, const Partition<3>& partition) {
  std::array<std::vector<double>, 2> turns;
  for (std::size_t e = 0; e < state.mesh.elements.size(); ++e) {
    if (!state.filling->mixed(e)) continue;
    const auto p = state.mesh.corners(state.mesh.elements[e]);
    const Vec<3> normal = partition.border((p[0] + p[1] + p[2] + p[3]) / 4).normal;
    Metric<3> asked = Metric<3>::Zero();
    for (NodeId n : state.mesh.elements[e]) asked += state.metric[n] / 4;
    const std::array<Metric<3>, 2> metrics{asked, simplex_metric<3>(p)};
    for (int k = 0; k < 2; ++k) {
      const double cosine = std::abs(normal.dot(spectrum<3>(metrics[k]).vectors.col(2)));
      turns[k].push_back(std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi);
    }
  }
  std::array<double, 2> most{};
  for (int k = 0; k < 2 && !turns[k].empty(); ++k) {
    const auto at = turns[k].begin() + static_cast<std::ptrdiff_t>(0.95 * (turns[k].size() - 1));
    std::nth_element(turns[k].begin(), at, turns[k].end());
    most[k] = *at;
  }
  return most;
}

/// Puts a row of a table between the comments "table NAME" and "end" of a page in place of the one
/// with the same first cell, or at the end.
Result<void> set_row(std::string& page, const std::string& table, const std::string& row) {
  const std::string begin = "<!-- table " + table + " -->\n";
  const std::size_t from = page.find(begin);
  const std::size_t to = from == std::string::npos ? from : page.find("<!-- end -->", from);
  if (to == std::string::npos)
    return Error{Code::bad_input, "The page has no table \"" + table + "\".",
                 "It stands between the lines " + begin + " and <!-- end -->."};
  const std::string cell = row.substr(0, row.find('|', 1) + 1);
  std::size_t line = page.find("\n" + cell, from);
  if (line == std::string::npos || line > to) {
    page.insert(to, row);
  } else {
    ++line;
    page.replace(line, page.find('\n', line) + 1 - line, row);
  }
  return {};
}

/// The first number of a row of a table; NaN where it has none.
double number_in_row(const std::string& page, const std::string& table, const std::string& name) {
  const std::size_t from = page.find("<!-- table " + table + " -->\n");
  const std::string cell = "\n| " + name + " | ";
  const std::size_t line = from == std::string::npos ? from : page.find(cell, from);
  if (line == std::string::npos || line > page.find("<!-- end -->", from)) return std::nan("");
  const char* text = page.c_str() + line + cell.size();
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  return end == text ? std::nan("") : value;
}

/// The largest error of a volume, %, of the bodies whose volume is known and not that of a sliver.
double volume_error(const std::vector<BodyOutcome>& bodies) {
  double total = 0, worst = 0;
  for (const BodyOutcome& b : bodies) total += b.mesh_volume;
  for (const BodyOutcome& b : bodies)
    if (b.cad_volume > 1e-6 * total)
      worst = std::max(worst, 100 * std::abs(b.mesh_volume / b.cad_volume - 1));
  return worst;
}

Result<std::string> fuzzy_row(const Scene& scene, double exact_nodes) {
  Result<Outcome> outcome = made(scene, Interfaces::fuzzy, kLast, false);
  if (!outcome) return outcome.error();
  const auto& records = outcome->records;
  const auto at = [&](std::size_t i) { return records[std::min(i, records.size() - 1)]; };
  const double before = static_cast<double>(at(kFirst).nodes);
  const auto nodes = static_cast<double>(at(kLast).nodes);
  std::size_t settled = records.size() - 1;  // the error is within 3 % of its end from there on
  while (settled > 0 &&
         std::abs(records[settled - 1].interface_error / records.back().interface_error - 1) < 0.03)
    --settled;
  Result<Assembly> laid = lay_out(scene.study, scene.parts,
                                  {std::shared_ptr<const VolumeMesher>(topological_mesher())}, {});
  if (!laid) return laid.error();
  const auto turns = turns_of_elements(*outcome->state, *laid->partition);
  return "| " + scene.name + " | " + number(nodes, 6) + " | " + number(nodes / exact_nodes, 2) +
         " | " + number(100 * (nodes / before - 1), 2) + " % | " + number(at(1).interface_error) +
         " / " + number(at(kLast).interface_error) + " | " + std::to_string(settled) + " | " +
         number(volume_error(outcome->bodies), 2) + " % | " + number(turns[0], 2) + " / " +
         number(turns[1], 2) + " | " + number(records.back().quality_mean) + " / " +
         number(records.back().quality_min, 2) + " |\n";
}

Result<std::string> exact_row(const Scene& scene, const fs::path& meshes) {
  Result<Outcome> outcome = made(scene, Interfaces::exact, kFirst, true);
  if (!outcome) return outcome.error();
  const MeshState& state = *outcome->state;
  const std::size_t poor = static_cast<std::size_t>(std::count_if(
      state.quality.begin(), state.quality.end(), [](double q) { return q < kPoor; }));
  double off = 0;  // what is around bodies has their surfaces and the domain's
  for (const BodyOutcome& b : outcome->bodies)
    if (b.name != kBackground)
      off = std::max(off, b.boundary_distance.largest() / b.chord_tolerance);
  const IterationRecord& last = outcome->records.back();
  std::string file = scene.name;
  std::replace_if(
      file.begin(), file.end(), [](char c) { return !std::isalnum(c); }, '-');
  MeshFields fields;
  fields.metric = &state.metric;
  const Result<ExportCertificate> written =
      write_mesh_file(own_formats().front(), state.mesh, fields, meshes / (file + ".msh"));
  if (!written) return written.error();
  return "| " + scene.name + " | " + number(static_cast<double>(last.nodes), 6) + " | " +
         std::to_string(last.iteration) + " | " + number(outcome->seconds, 2) + " | " +
         number(last.layers.mean) + " / " + number(last.layers.p5) + " | " +
         number(volume_error(outcome->bodies), 2) + " % | " + number(off, 2) + " | " +
         number(last.quality_mean) + " / " + number(last.quality_min, 2) + " | " +
         std::to_string(poor) + " of " + std::to_string(state.mesh.elements.size()) + " |\n";
}

Result<std::vector<Scene>> scenes(const std::optional<fs::path>& cad) {
  std::vector<Scene> all;
  all.push_back({"ball", study_of({ball("ball", {0, 0, 0}, 3)}, {kBox})});
  all.push_back(tilted_plate(35));
  all.push_back(tilted_plate(125));
  all.push_back(pierced_plate());
  all.push_back(
      {"two balls that overlap",
       study_of({ball("ball 1", {-1, 0, 0}, 2.2), ball("ball 2", {1.2, 0, 0}, 2)}, {kBox})});
  for (const int grains : {10, 50}) {
    Result<Scene> scene = polycrystal(grains);
    if (!scene) return scene.error();
    all.push_back(std::move(*scene));
  }
  Result<Scene> tube = twisted_tube();
  if (!tube) return tube.error();
  all.push_back(std::move(*tube));
  if (!cad) {
    std::fprintf(stderr, "Without the folder of the CAD files: no real parts.\n");
    return all;
  }
  const std::vector<std::pair<std::string, std::vector<std::string>>> real{
      {"molded tail, part and mold",
       {"moulded_tail_part.stl", "moulded_tail_core.stl", "moulded_tail_mould_a.stl",
        "moulded_tail_mould_b.stl"}},
      {"battery case", {"lego_3xaa_battery_case.step"}},
      {"card with inserts", {"expansion_card_with_inserts.stp"}}};
  for (const auto& [name, names] : real) {
    Result<Scene> scene = files(name, *cad, names);
    if (!scene) return scene.error();
    all.push_back(std::move(*scene));
  }
  return all;
}

/// What is asked for on the command line.
struct Wanted {
  fs::path folder;                 ///< of multidomain.md
  std::optional<fs::path> cad;     ///< of the CAD files
  std::vector<std::string> names;  ///< beginnings of the cases' names; none: all
  bool exact = true, fuzzy = true;
};

Wanted wanted(const std::vector<std::string>& arguments) {
  Wanted all;
  all.folder = arguments.front();
  bool one_kind = false;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string& a = arguments[i];
    if (a == "exact" || a == "fuzzy") {
      if (!std::exchange(one_kind, true)) all.exact = all.fuzzy = false;
      (a == "exact" ? all.exact : all.fuzzy) = true;
    } else if (i == 1 && fs::is_directory(a)) {
      all.cad = a;
    } else {
      all.names.push_back(a);
    }
  }
  return all;
}

Result<void> regenerate(const Wanted& of) {
  const fs::path page_file = of.folder / "multidomain.md";
  Result<std::vector<Scene>> all = scenes(of.cad);
  if (!all) return all.error();
  const fs::path meshes = fs::temp_directory_path() / "lamella_multidomain";
  fs::create_directories(meshes);
  const auto wants = [&](const Scene& scene) {
    return of.names.empty() ||
           std::any_of(of.names.begin(), of.names.end(),
                       [&](const std::string& name) { return scene.name.rfind(name, 0) == 0; });
  };
  // The page keeps each row as soon as it is there: all of them take hours.
  const auto keep = [&](const Scene& scene, const std::string& table,
                        const Result<std::string>& row) -> Result<void> {
    if (!row) std::fprintf(stderr, "%s: %s\n", scene.name.c_str(), row.error().message.c_str());
    const std::string text = row ? *row : "| " + scene.name + " | " + row.error().message + " |\n";
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
    Result<std::string> page = read_file(page_file);
    if (!page) return page.error();
    if (Result<void> set = set_row(*page, table, text); !set) return set.error();
    return write_file(page_file, *page);
  };
  // Exact meshes first: they take a small part of the time.
  for (const Scene& scene : *all)
    if (of.exact && wants(scene))
      if (Result<void> kept = keep(scene, "exact interfaces", exact_row(scene, meshes)); !kept)
        return kept.error();
  for (const Scene& scene : *all)
    if (of.fuzzy && wants(scene)) {
      const Result<std::string> page = read_file(page_file);
      if (!page) return page.error();
      const double exact_nodes = number_in_row(*page, "exact interfaces", scene.name);
      if (Result<void> kept = keep(scene, "fuzzy interfaces", fuzzy_row(scene, exact_nodes)); !kept)
        return kept.error();
    }
  std::printf("meshes are in %s\n", meshes.string().c_str());
  return {};
}

}  // namespace
}  // namespace lamella

int main(int argc, char** argv) {
  using namespace lamella;
  if (argc < 2) {
    std::fprintf(stderr,
                 "usage: lamella_multidomain_cases FOLDER [PARTS] [exact|fuzzy] [NAME]..., the "
                 "folder that holds multidomain.md, that of the CAD files, one of the tables, and "
                 "beginnings of the names of rows\n");
    return exit_code(Code::usage);
  }
  const Result<void> done = regenerate(wanted({argv + 1, argv + argc}));
  if (done) return 0;
  std::fprintf(stderr, "%s %s\n", done.error().message.c_str(), done.error().hint.c_str());
  return exit_code(done.error().code);
}
