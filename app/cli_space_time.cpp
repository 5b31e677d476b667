#include <algorithm>
#include <cstdio>

#include "app/cli_commands.h"
#include "app/cli_common.h"
#include "core/base/atomic_file.h"
#include "core/io/medit.h"
#include "core/io/words.h"
#include "core/mesh/quality.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/slice.h"
#include "core/mesh/validate.h"
#include "core/metric/analytic.h"

namespace lamella::cli {

namespace {

namespace fs = std::filesystem;
constexpr double kMostElements = 1e6;  ///< of a box: made at one go, in about a second

/// One value for all axes, or one for each.
template <int D, class T>
Result<std::array<T, D>> per_axis(const std::vector<T>& values, const char* option) {
  std::array<T, D> all;
  if (values.size() != 1 && values.size() != D)
    return Error{Code::usage,
                 std::string(option) + " has " + std::to_string(values.size()) + " values.",
                 "Give one, or one for each of the " + std::to_string(D) + " axes."};
  for (int k = 0; k < D; ++k) all[k] = values[values.size() == 1 ? 0 : k];
  return all;
}

template <int D>
int make_box(const BoxCommand& c, Console& console) {
  if (Result<void> known = check_output_name(c.output, D); !known)
    return console.fail(known.error());
  const auto cells = per_axis<D>(c.cells, "--cells");
  const auto low = per_axis<D>(c.low, "--low"), high = per_axis<D>(c.high, "--high");
  if (!cells) return console.fail(cells.error());
  if (!low) return console.fail(low.error());
  if (!high) return console.fail(high.error());
  double elements = factorial(D);
  for (int k = 0; k < D; ++k) {
    elements *= (*cells)[k];
    const double size = (*high)[k] - (*low)[k];
    if (!(size > 0) || !std::isfinite(size))
      return console.fail({Code::usage,
                           "The box has no extent along axis " + std::to_string(k + 1) + ".",
                           "--high must lie above --low."});
  }
  if (elements > kMostElements)
    return console.fail({Code::usage,
                         "The box would have " + short_number(elements, 3) + " elements; at most " +
                             short_number(kMostElements, 3) + " are made.",
                         "Start with fewer cells and adapt it."});
  const Progress progress = console.progress();
  SimplexMesh<D> mesh = box_mesh<D>(*cells, Eigen::Map<const Vec<D>>(low->data()),
                                    Eigen::Map<const Vec<D>>(high->data()));
  // Each side is a group, in the order of box_mesh.
  mesh.groups.clear();
  for (int k = 0; k < D; ++k)
    for (const char* end : {" low", " high"})
      mesh.groups.push_back((D == 4 && k == 3 ? "t" : std::string(1, "xyz"[k])) + end);
  mesh.facet_group = mesh.facet_face;
  const std::size_t nodes = mesh.node_count(), count = mesh.element_count();
  if (auto done = write_any<D>(c.output, std::move(mesh), {}, progress); !done)
    return console.fail(done.error());
  console.say("wrote " + c.output + ": " + std::to_string(D) + "D box, " + grouped(nodes) +
              " nodes, " + grouped(count) + " elements");
  console.emit(dump({{"phase", "written"},
                     {"file", c.output},
                     {"dimension", D},
                     {"nodes", nodes},
                     {"elements", count}}));
  return 0;
}

/// OUT_0003.vtu of OUT.vtu.
fs::path numbered(const fs::path& output, std::size_t i) {
  char number[32];
  std::snprintf(number, sizeof number, "_%04zu", i);
  fs::path file = output;
  return file.replace_filename(output.stem().string() + number + output.extension().string());
}

/// The series as ParaView opens it, with the times.
std::string collection(const std::vector<fs::path>& files, const std::vector<double>& times) {
  TextBuilder text;
  text
      << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (std::size_t i = 0; i < files.size(); ++i) {
    text << "    <DataSet timestep=\"" << times[i] << "\" part=\"0\" file=\"";
    for (const char letter : files[i].filename().string()) {
      if (letter == '&')
        text << "&amp;";
      else if (letter == '<')
        text << "&lt;";
      else if (letter == '"')
        text << "&quot;";
      else
        text << letter;
    }
    text << "\"/>\n";
  }
  text << "  </Collection>\n</VTKFile>\n";
  return text.text();
}

/// What a run wrote before it failed goes away.
int undo(const std::vector<fs::path>& files, const Error& error, Console& console) {
  for (const fs::path& file : files) {
    std::error_code ignored;
    fs::remove(file, ignored);
    for (const char* beside : {".sol", ".json"}) fs::remove(file.string() + beside, ignored);
    if (names_medit(file)) fs::remove(fs::path(file).replace_extension(".sol"), ignored);
  }
  return console.fail(error);
}

template <int D>
int make_slices(const SimplexMesh<D>& mesh, const SliceCommand& c, Console& console) {
  if (Result<void> known = check_output_name(c.output, D - 1); !known)
    return console.fail(known.error());
  const fs::path output = c.output;
  if (output.extension() == ".stl" || output.extension() == ".foam")
    return console.fail({Code::usage, "Slices are neither STL files nor OpenFOAM cases.",
                         "Use .vtu, .msh or .mesh."});
  const Progress progress = console.progress();
  const Result<MetricField<D>> metric = metric_of<D>(mesh, c.sol, c.metric, nullptr);
  if (!metric) return console.fail(metric.error());
  const Result<MeshReport> whole = inspect<D>(mesh, progress.portion(0, 0.2));
  if (!whole) return console.fail(whole.error());
  if (!whole->conforming())
    return console.fail({Code::bad_input, "\"" + c.mesh + "\": " + whole->first_finding, ""});

  std::vector<fs::path> written;
  for (std::size_t i = 0; i < c.times.size(); ++i) {
    const auto count = static_cast<double>(c.times.size()), at = static_cast<double>(i);
    const Progress part = progress.portion(0.2 + 0.8 * at / count, 0.2 + 0.8 * (at + 1) / count);
    const double time = c.times[i];
    auto cut = slice<D>(mesh, time, *metric, part.portion(0, 0.4));
    if (!cut) return undo(written, cut.error(), console);
    const Result<MeshReport> report = inspect<D - 1>(cut->mesh, part.portion(0.4, 0.6));
    if (!report) return undo(written, report.error(), console);
    if (!report->valid())
      return undo(
          written,
          {Code::failed,
           "The slice at " + short_number(time, 10) + " is not valid: " + report->first_finding,
           "Choose a value nearby."},
          console);
    written.push_back(numbered(output, i));
    const std::string file = written.back().string();
    if (auto done = write_any<D - 1>(file, std::move(cut->mesh), std::move(cut->metric),
                                     part.portion(0.6, 1));
        !done)
      return undo(written, done.error(), console);
    console.say(file + ": at " + short_number(time, 10) + ", " + grouped(report->nodes) +
                " nodes, " + grouped(report->elements) + " elements, volume " +
                short_number(report->volume, 10) + ", boundary " +
                short_number(report->boundary_area, 8));
    console.emit(dump({{"phase", "slice"},
                       {"file", file},
                       {"time", time},
                       {"nodes", report->nodes},
                       {"elements", report->elements},
                       {"volume", report->volume},
                       {"boundary_area", report->boundary_area}}));
  }
  if (output.extension() != ".vtu") return 0;
  const fs::path series = fs::path(output).replace_extension(".pvd");
  if (auto done = write_file(series, collection(written, c.times)); !done)
    return undo(written, done.error(), console);
  console.say("wrote " + series.string());
  console.emit(dump({{"phase", "written"}, {"file", series.string()}}));
  return 0;
}

}  // namespace

int run_box(const BoxCommand& c, Console& console) {
  if (c.dimension == 2) return make_box<2>(c, console);
  if (c.dimension == 3) return make_box<3>(c, console);
  return make_box<4>(c, console);
}

int run_slice(const SliceCommand& c, Console& console) {
  const Result<AnyMesh> mesh = read_medit(c.mesh, console.progress().portion(0, 0));
  if (!mesh) return console.fail(of_input(mesh.error()));
  if (const auto* m = std::get_if<SimplexMesh<4>>(&*mesh)) return make_slices<4>(*m, c, console);
  if (const auto* m = std::get_if<SimplexMesh<3>>(&*mesh)) return make_slices<3>(*m, c, console);
  return console.fail(
      {Code::usage, "\"" + c.mesh + "\" is a 2D mesh.", "Meshes in 4D, and in 3D, are sliced."});
}

}  // namespace lamella::cli
