// Regenerates the curves of section 3.2.2 and table A.4 of the thesis: pictures, one table of all
// figures, and the tables inside resources/docs/validation.md, which holds the reading.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>

#include "core/base/atomic_file.h"
#include "core/base/parallel.h"
#include "core/mesh/check.h"
#include "core/mesh/sample_meshes.h"
#include "core/metric/analytic.h"
#include "core/optimize/adapt.h"
#include "core/study/svg_plot.h"
#include "tests/validation/page.h"

namespace lamella {
namespace {

namespace fs = std::filesystem;

/// A mesh under the analytic metric at its nodes, whatever the engine averaged on its way there.
struct Row {
  std::size_t nodes = 0, elements = 0;
  double conformity = 0;          ///< (1.33)
  double invariant = 0;           ///< mean of sqrt(trace(R R))
  double unit_edges = 0;          ///< share, 0..1
  double quality = 0, worst = 0;  ///< c(T), (3.7): mean and smallest
};

/// One configuration of the engine on one case; row 0 is the start mesh.
struct Curve {
  std::string name;
  AdaptParams params;
  std::vector<Row> rows;
  std::vector<double> seeds;  ///< (1.33) at the end with the seeds 1, 2, ...
  std::optional<Error> error;
};

/// One case of section 3.2.2.
struct Case {
  std::string name;      ///< of its metric
  std::string figure;    ///< of the thesis
  std::string enlarged;  ///< the picture that shows its lower end
  std::vector<Curve> curves;
};

/// A row of table A.4.
struct Hypercube {
  int divisions;  ///< h = 1 / divisions
  Row thesis;
  Curve ours;
};

Row measured(const CheckReport& r, std::size_t nodes, std::size_t elements) {
  return {.nodes = nodes,
          .elements = elements,
          .conformity = r.conformity.mean,
          .invariant = r.conformity_invariant.mean,
          .unit_edges = r.unit_edges,
          .quality = r.quality.mean,
          .worst = r.quality.min};
}

/// Adapts `iterations` times. The nodes get the analytic metric before each adaption; within one it
/// is carried to new nodes by the average that the curve is about.
template <int D>
void run(Curve& curve, SimplexMesh<D> mesh, const MetricFunction<D>& function, int iterations) {
  for (int i = 0;; ++i) {
    const MetricField<D> metric = sample_metric<D>(function, mesh.points);
    const Result<CheckReport> report = check<D>(mesh, metric);
    if (!report) {
      curve.error = report.error();
      return;
    }
    curve.rows.push_back(measured(*report, mesh.node_count(), mesh.element_count()));
    if (i == iterations) return;
    Result<Adapted<D>> adapted = adapt<D>(mesh, metric, nullptr, curve.params);
    if (!adapted) {
      curve.error = adapted.error();
      return;
    }
    mesh = std::move(adapted->mesh);
  }
}

template <int D>
void run_named(Curve& curve, SimplexMesh<D> start, const std::string& metric, int iterations) {
  const Result<MetricFunction<D>> function = named_metric<D>(metric);
  if (function) {
    run<D>(curve, std::move(start), *function, iterations);
  } else {
    curve.error = function.error();
  }
}

/// The same quantity carries the metric to new nodes and into elements, as in the thesis.
Curve averaging(const std::string& name, MetricMean mean, SizeAverage size = SizeAverage::l2) {
  Curve curve;
  curve.name = name;
  curve.params.mean = curve.params.element_mean = mean;
  curve.params.size_average = size;
  return curve;
}

/// h comes last: without it the others keep their colors.
std::vector<Curve> averages() {
  std::vector<Curve> curves = {averaging("M", MetricMean::m),
                               averaging("M^(1/2)", MetricMean::root),
                               averaging("M^(-1/2)", MetricMean::size),
                               averaging("log M", MetricMean::log), averaging("h", MetricMean::h)};
  // Not of the thesis: logarithms carry the metric to new nodes, elements take the mean of M.
  curves[3].params.element_mean = MetricMean::m;
  return curves;
}

constexpr int kIterations = 10;
/// The isotropic h asks the thin box for so many elements that it stops sooner.
constexpr int kDenseIterations = 5;
/// Seeds in 2D, where they cost little: what they spread over tells no averages apart.
constexpr std::uint64_t kSeeds = 5;

void run_case(const std::string& metric, Curve& curve) {
  if (metric == "thinbox") {
    run_named<3>(curve, box_mesh<3>({2, 10, 10}, Vec<3>::Zero(), Vec<3>(0.1, 1, 1)), metric,
                 curve.params.mean == MetricMean::h ? kDenseIterations : kIterations);
    return;
  }
  const SimplexMesh<2> start = box_mesh<2>({7, 9}, Vec<2>::Zero(), Vec<2>(7, 9));
  run_named<2>(curve, start, metric, kIterations);
  if (!curve.error) curve.seeds = {curve.rows.back().conformity};
  for (std::uint64_t seed = 2; seed <= kSeeds && !curve.error; ++seed) {
    Curve other;
    other.params = curve.params;
    other.params.seed = seed;
    run_named<2>(other, start, metric, kIterations);
    if (other.error) {
      curve.error = other.error;
    } else {
      curve.seeds.push_back(other.rows.back().conformity);
    }
  }
}

std::string number(double v, int digits = 3) { return short_number(v, digits); }

/// Two plots side by side: the coefficient of the thesis and its affine-invariant form.
std::string picture(const Case& c, const std::string& figure, std::size_t first) {
  std::vector<Series> thesis, invariant;
  for (const Curve& curve : c.curves) {
    // The thesis enlarges the curves that converge.
    if (first > 0 && curve.name == "h" && c.name != "gb2d-iso") continue;
    thesis.push_back({curve.name, {}});
    invariant.push_back({curve.name, {}});
    for (const Row& row : curve.rows) {
      thesis.back().values.push_back(row.conformity);
      invariant.back().values.push_back(row.invariant);
    }
  }
  return svg_document(
      {svg_log_convergence(thesis, "non conformity (1.33), log scale", first),
       svg_log_convergence(invariant, "mean of sqrt(trace(R R)), log scale", first)},
      "Figure " + figure + ": " + c.name);
}

/// First iteration from which on (1.33) stays within 10 % of its last value.
std::size_t settled(const Curve& curve) {
  const double last = curve.rows.back().conformity;
  std::size_t i = curve.rows.size() - 1;
  while (i > 0 && std::abs(curve.rows[i - 1].conformity - last) <= 0.1 * last) --i;
  return i;
}

std::string summary(const Case& c) {
  std::string table =
      "| average | nodes at the end | most elements on the way | (1.33) at the end | over the "
      "seeds | "
      "reached at iteration | invariant at the end | unit edges % | c(T) mean / min |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const Curve& curve : c.curves) {
    std::size_t most = 0;
    for (const Row& row : curve.rows) most = std::max(most, row.elements);
    const auto [low, high] = std::minmax_element(curve.seeds.begin(), curve.seeds.end());
    const std::string spread =
        curve.seeds.empty() ? "not run" : number(*low) + " to " + number(*high);
    const Row& end = curve.rows.back();
    table += "| " + curve.name + " | " + grouped(end.nodes) + " | " + grouped(most) + " | " +
             number(end.conformity) + " | " + spread + " | " + std::to_string(settled(curve)) +
             " | " + number(end.invariant) + " | " + number(100 * end.unit_edges) + " | " +
             number(end.quality) + " / " + number(end.worst) + " |\n";
  }
  return table;
}

std::string hypercube_summary(const std::vector<Hypercube>& cubes) {
  std::string table =
      "| h | nodes, thesis | nodes | elements, thesis | elements | c(T) mean, thesis | c(T) mean | "
      "c(T) min, thesis | c(T) min |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const Hypercube& cube : cubes) {
    const Row& end = cube.ours.rows.back();
    const double more =
        100.0 * (static_cast<double>(end.nodes) / static_cast<double>(cube.thesis.nodes) - 1);
    char percent[32];
    std::snprintf(percent, sizeof percent, " (%+.1f %%)", more);
    table += "| 1/" + std::to_string(cube.divisions) + " | " + grouped(cube.thesis.nodes) + " | " +
             grouped(end.nodes) + percent + " | " + grouped(cube.thesis.elements) + " | " +
             grouped(end.elements) + " | " + number(cube.thesis.quality) + " | " +
             number(end.quality) + " | " + number(cube.thesis.worst) + " | " + number(end.worst) +
             " |\n";
  }
  return table;
}

std::string tab_separated(const std::string& name, const Curve& curve) {
  std::string lines;
  for (std::size_t i = 0; i < curve.rows.size(); ++i) {
    const Row& r = curve.rows[i];
    lines += name + "\t" + curve.name + "\t" + std::to_string(i) + "\t" + std::to_string(r.nodes) +
             "\t" + std::to_string(r.elements) + "\t" + number(r.conformity, 6) + "\t" +
             number(r.invariant, 6) + "\t" + number(r.unit_edges, 6) + "\t" + number(r.quality, 6) +
             "\t" + number(r.worst, 6) + "\n";
  }
  return lines;
}

Result<void> write_all(const fs::path& docs, const std::vector<Case>& cases,
                       const std::vector<Hypercube>& cubes) {
  const fs::path pictures = docs / "pictures" / "validation";
  std::error_code failed;
  fs::create_directories(pictures, failed);
  if (failed)
    return Error{Code::io, "The folder " + pictures.string() + " cannot be made.",
                 failed.message() + "."};
  Result<std::string> page = read_file(docs / "validation.md");
  if (!page) return page.error();
  std::string table =
      "case\taverage\titeration\tnodes\telements\tconformity_1_33\tconformity_invariant\t"
      "unit_edges\tquality_mean\tquality_min\n";
  for (const Case& c : cases) {
    for (const Curve& curve : c.curves) table += tab_separated(c.name, curve);
    for (const bool enlarged : {false, true}) {
      const std::string& figure = enlarged ? c.enlarged : c.figure;
      const Result<void> written = write_file(pictures / ("figure-" + figure + ".svg"),
                                              picture(c, figure, enlarged ? 3 : 0));
      if (!written) return written;
    }
    if (const Result<void> set = set_table(*page, c.figure, summary(c)); !set) return set;
  }
  for (const Hypercube& cube : cubes) table += tab_separated("hypercube", cube.ours);
  if (const Result<void> set = set_table(*page, "A.4", hypercube_summary(cubes)); !set) return set;
  if (const Result<void> written = write_file(pictures / "figures.tsv", table); !written)
    return written;
  return write_file(docs / "validation.md", *page);
}

Result<void> regenerate(const fs::path& docs) {
  std::vector<Case> cases = {
      {"thinbox", "3.10", "3.11", averages()},
      {"gb2d", "3.4", "3.5", averages()},
      {"gb2d-iso", "3.7", "3.8", averages()},
      {"gb2d",
       "3.12",
       "3.12-enlarged",
       {averaging("L2", MetricMean::m), averaging("L1", MetricMean::m, SizeAverage::l1)}}};
  const auto thesis = [](std::size_t nodes, std::size_t elements, double quality, double worst) {
    return Row{.nodes = nodes, .elements = elements, .quality = quality, .worst = worst};
  };
  std::vector<Hypercube> cubes = {{2, thesis(126, 946, 0.486350, 0.218303), {}},
                                  {3, thesis(451, 4573, 0.502368, 0.213219), {}},
                                  {4, thesis(1192, 14887, 0.516302, 0.198019), {}},
                                  {5, thesis(2588, 35894, 0.518706, 0.145331), {}}};

  std::vector<std::pair<Curve*, std::function<void()>>> jobs;
  for (auto cube = cubes.rbegin(); cube != cubes.rend(); ++cube) {
    Hypercube& h = *cube;
    h.ours.name = "1/" + std::to_string(h.divisions);
    jobs.emplace_back(&h.ours, [&h] {
      run<4>(
          h.ours, unit_box<4>(1),
          [&h](const Vec<4>&) { return isotropic_metric<4>(1.0 / h.divisions); }, 10);
    });
  }
  for (Case& c : cases)
    for (Curve& curve : c.curves)
      jobs.emplace_back(&curve, [&c, &curve] { run_case(c.name, curve); });
  std::mutex console;
  std::size_t finished = 0;
  parallel_each(
      jobs.size(), 0, {},
      [&](std::size_t i) {
        jobs[i].second();
        const std::lock_guard lock(console);
        std::fprintf(stderr, "%zu of %zu: %s\n", ++finished, jobs.size(),
                     jobs[i].first->name.c_str());
      },
      1);
  for (const auto& job : jobs)
    if (job.first->error) return *job.first->error;
  return write_all(docs, cases, cubes);
}

}  // namespace
}  // namespace lamella

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr,
                 "usage: lamella_adaption_curves FOLDER, the one that holds validation.md\n");
    return lamella::exit_code(lamella::Code::usage);
  }
  const lamella::Result<void> done = lamella::regenerate(argv[1]);
  if (done) return 0;
  std::fprintf(stderr, "%s %s\n", done.error().message.c_str(), done.error().hint.c_str());
  return lamella::exit_code(done.error().code);
}
