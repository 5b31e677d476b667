// Where walls meet: layers on the arms against the distance from the junction, sizes in its core.

#include <cstdio>
#include <functional>

#include "core/base/atomic_file.h"
#include "core/mesh/slice.h"
#include "core/natural/layers.h"
#include "core/natural/natural_metric.h"
#include "core/study/request.h"
#include "core/study/svg_plot.h"
#include "tests/support/sample_surfaces.h"
#include "tests/validation/layer_cases.h"
#include "tests/validation/mesh_picture.h"
#include "tests/validation/planar.h"

namespace lamella {
namespace {

/// Bands of distance from the junction, in thicknesses of the arm.
constexpr double kBands[] = {0, 0.5, 1, 2, 4, 8};
constexpr std::size_t kBandCount = std::size(kBands) - 1;

/// One wall that leaves the junction; walls that mirror each other are one.
struct Arm {
  std::string name;
  double thickness;
  /// Distance from the junction, mm, of a place on the wall with that outward normal; negative
  /// where it is none of this arm's.
  std::function<double(const Vec<3>&, const Vec<3>&)> distance;
};

struct Junction {
  std::string name, file;
  ReferenceSurface<3> body;
  std::vector<Arm> arms;
  Vec<3> low, high;   ///< the core
  bool along = true;  ///< the core is long in z, where sizes are not compared
};

Mat<3> turned_space() { return testing::turn(0.4, {1, 1, 2}); }

bool faces(const Vec<3>& normal, int axis) { return std::abs(normal[axis]) > 0.9; }

/// A wall along x of thickness t that fills [low, low + t] in y, on both sides from |x| = half on.
Arm wall_x(const std::string& name, double low, double t, double half) {
  return {name, t, [=](const Vec<3>& c, const Vec<3>& n) {
            return faces(n, 1) && c[1] > low - 0.01 * t && c[1] < low + 1.01 * t
                       ? std::abs(c[0]) - half
                       : -1;
          }};
}

/// A wall along y around x = 0, from y = start on; on both sides of it when mirrored.
Arm wall_y(const std::string& name, double t, double start, bool mirrored) {
  return {name, t, [=](const Vec<3>& c, const Vec<3>& n) {
            return faces(n, 0) && std::abs(c[0]) < 0.51 * t
                       ? (mirrored ? std::abs(c[1]) : c[1]) - start
                       : -1;
          }};
}

Junction tee(const std::string& file, double plate, double rib) {
  const std::vector<double> x{-20, -rib / 2, rib / 2, 20}, y{0, plate, 22}, z{-10, 10};
  return {"T, " + short_number(plate) + " and " + short_number(rib) + " mm",
          file,
          testing::cell_surface({x, y, z}, [](int i, int j, int) { return i == 1 || j == 0; }),
          {wall_x("plate", 0, plate, rib / 2), wall_y("rib", rib, plate, false)},
          {-rib / 2, plate - std::min(plate, rib), -6},
          {rib / 2, plate, 6}};
}

Junction ell() {
  const std::vector<double> x{0, 2, 22}, z{-10, 10};
  const auto arm = [](const std::string& name, int along) {
    return Arm{name, 2, [=](const Vec<3>& c, const Vec<3>& n) {
                 return faces(n, 1 - along) && c[1 - along] < 2.02 ? c[along] - 2 : -1;
               }};
  };
  return {"L, 2 mm",
          "l",
          testing::cell_surface({x, x, z}, [](int i, int j, int) { return i == 0 || j == 0; }),
          {arm("along x", 0), arm("along y", 1)},
          {0, 0, -6},
          {2, 2, 6}};
}

Junction cross(const std::string& file, double a, double b) {
  const std::vector<double> x{-20, -b / 2, b / 2, 20}, y{-20, -a / 2, a / 2, 20}, z{-10, 10};
  return {"cross, " + short_number(a) + " and " + short_number(b) + " mm",
          file,
          testing::cell_surface({x, y, z}, [](int i, int j, int) { return i == 1 || j == 1; }),
          {wall_x("along x", -a / 2, a, b / 2), wall_y("along y", b, a / 2, true)},
          {-b / 2, -a / 2, -6},
          {b / 2, a / 2, 6}};
}

Junction three_plates() {
  const std::vector<double> x{-12, -1, 1, 12};
  return {"three plates, 2 mm",
          "three",
          testing::cell_surface({x, x, x},
                                [](int i, int j, int k) { return i == 1 || j == 1 || k == 1; }),
          {{"all", 2,
            [](const Vec<3>& c, const Vec<3>& n) {
              for (int k = 0; k < 3; ++k)
                if (faces(n, k) && std::abs(c[k]) < 1.02)
                  return std::min(std::abs(c[(k + 1) % 3]), std::abs(c[(k + 2) % 3])) - 1;
              return -1.0;
            }}},
          {-1, -1, -1},
          {1, 1, 1},
          false};
}

/// Largest over smallest size of a metric, in the plane of the section or in space.
double size_ratio(const Metric<3>& m, bool in_plane) {
  if (in_plane) {
    const Vec<2> h = sizes<2>(m.topLeftCorner<2, 2>());
    return h[1] / h[0];
  }
  const Vec<3> h = sizes<3>(m);
  return h[2] / h[0];
}

struct Band {
  double least = std::numeric_limits<double>::infinity();
  double sum = 0, area = 0, unmeasured = 0;
};

std::string number(double v) { return short_number(v, 3); }

}  // namespace

Result<JunctionTables> junctions(const std::filesystem::path& pictures) {
  JunctionTables tables;
  tables.arms = "| junction | arm | ";
  for (std::size_t b = 0; b < kBandCount; ++b)
    tables.arms += number(kBands[b]) + " to " + number(kBands[b + 1]) + " t | ";
  tables.arms += "within 1 t not measured, % |\n|---|---|---|---|---|---|---|---|\n";
  tables.cores =
      "| junction | nodes | sizes asked in the core, largest / smallest: median | most | of its "
      "elements | layers of all walls, 5 / 50 / 95 % |\n|---|---|---|---|---|---|\n";
  std::vector<std::pair<SimplexMesh<2>, std::string>> cuts;
  for (const Junction& junction :
       {tee("t", 2, 2), tee("t-thin", 2, 1), tee("t-thinner", 2, 0.5), ell(), cross("cross", 2, 2),
        cross("cross-thin", 2, 1), three_plates()}) {
    Part part = part_of(junction.name, junction.body);
    const ReferenceSurface<3> straight = part.surface;
    for (Vec<3>& x : part.surface.points) x = turned_space() * x;
    const Result<Outcome> outcome = run_case({part}, 8, true);
    if (!outcome) return outcome.error();
    SimplexMesh<3> mesh = outcome->state->mesh;
    for (Vec<3>& x : mesh.points) x = turned_space().transpose() * x;

    const Result<Layers> layers = measure_layers(mesh, straight, kCaseLayers);
    if (!layers) return layers.error();
    for (const Arm& arm : junction.arms) {
      std::array<Band, kBandCount> bands;
      for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        const auto p = mesh.corners(mesh.facets[f]);
        const Vec<3> normal = facet_normal<3>(p);
        const double d =
            arm.distance((p[0] + p[1] + p[2]) / 3, normal.normalized()) / arm.thickness;
        for (std::size_t b = 0; b < kBandCount; ++b) {
          if (d < kBands[b] || d >= kBands[b + 1]) continue;
          const double area = normal.norm() / 2;
          if (std::isnan(layers->at_facet[f])) {
            bands[b].unmeasured += area;
            continue;
          }
          bands[b].least = std::min(bands[b].least, layers->at_facet[f]);
          bands[b].sum += layers->at_facet[f] * area;
          bands[b].area += area;
        }
      }
      std::string line = "| " + junction.name + " | " + arm.name + " | ";
      for (const Band& b : bands)
        line += b.area > 0 ? number(b.least) + " / " + number(b.sum / b.area) + " | " : "- | ";
      const double unmeasured = bands[0].unmeasured + bands[1].unmeasured;
      line += number(100 * unmeasured / (unmeasured + bands[0].area + bands[1].area)) + " |\n";
      std::fprintf(stderr, "%s", line.c_str());
      tables.arms += line;
    }

    const NaturalDetector detector(straight);
    Study study;
    study.bodies.push_back({junction.name});
    const NaturalParams params = natural_params(study, part);
    std::vector<double> ratios;
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j)
        for (int k = 0; k < 5; ++k) {
          const Vec<3> share((i + 0.5) / 5, (j + 0.5) / 5, (k + 0.5) / 5);
          const Vec<3> x = junction.low + share.cwiseProduct(junction.high - junction.low);
          ratios.push_back(size_ratio(detector.at(x, params).metric, junction.along));
        }
    std::sort(ratios.begin(), ratios.end());
    const Metric<3> own = own_metric<3>(mesh, [&](const Vec<3>& x) {
      return (x.array() > junction.low.array()).all() && (x.array() < junction.high.array()).all();
    });
    const std::string extents = own.trace() > 0 ? number(size_ratio(own, junction.along)) : "none";
    const LayerStats& all = layers->stats;
    const std::string line = "| " + junction.name + " | " + grouped(mesh.node_count()) + " | " +
                             number(ratios[ratios.size() / 2]) + " | " + number(ratios.back()) +
                             " | " + extents + " | " + number(all.p5) + " / " + number(all.p50) +
                             " / " + number(all.p95) + " |\n";
    std::fprintf(stderr, "%s", line.c_str());
    tables.cores += line;

    Result<Slice<2>> cut = slice<3>(mesh, 0.0123);
    if (!cut) return cut.error();
    if (junction.file == "t" || junction.file == "t-thin" || junction.file == "cross-thin" ||
        junction.file == "l")
      cuts.emplace_back(std::move(cut->mesh), junction.name);
  }
  std::vector<MeshPanel> panels;
  for (const auto& [mesh, name] : cuts) {
    const bool crossing = name.starts_with("cross");
    const Vec<2> low = crossing         ? Vec<2>(-4, -4)
                       : name[0] == 'L' ? Vec<2>(-0.5, -0.5)
                                        : Vec<2>(-4, -0.5);
    panels.push_back({&mesh, low, low + Vec<2>(8, 8), name + ", section"});
  }
  const auto written =
      write_file(pictures / "junctions.svg", mesh_picture(panels, "Junctions of walls"));
  if (!written) return written.error();
  return tables;
}

}  // namespace lamella
