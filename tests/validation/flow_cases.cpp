// The mesh corrected by the flow: the crossing of figure 5.3 and the notch and the detail of figure
// 4.25. Tables and pictures of resources/docs/validation.md, which holds the reading.

#include <cmath>
#include <cstdio>

#include "core/base/atomic_file.h"
#include "core/flow/correction.h"
#include "core/flow/indicators.h"
#include "core/mesh/element_locator.h"
#include "core/mesh/slice.h"
#include "core/optimize/adapt.h"
#include "core/study/flow_of_mesh.h"
#include "tests/support/sample_surfaces.h"
#include "tests/validation/layer_cases.h"
#include "tests/validation/mesh_picture.h"
#include "tests/validation/page.h"

namespace lamella {
namespace {

constexpr double kWall = 2;        // mm
constexpr double kLong = 20;       // mm, half length of the plates
constexpr double kAside = 0.0123;  // mm, of the section: off the planes of symmetry
constexpr double kGrowth = 1.5;    // of the elements

std::string number(double v, int digits = 3) { return short_number(v, digits); }

struct FlowProblem {
  std::string name;  ///< of its table, too
  Part part;
  Vec<3> gate, vent;  ///< points of their faces
};

FlowProblem crossing() {
  const std::vector<double> x{-kLong, -kWall / 2, kWall / 2, kLong};
  return {"crossing",
          part_of("crossing",
                  testing::cell_surface({x, x, std::vector{-10.0, 10.0}},
                                        [](int i, int j, int) { return i == 1 || j == 1; })),
          {-kLong, 0.1, 0.2},
          {0.1, kLong, 0.2}};
}

FlowProblem notch(double wide) {
  constexpr double kThroat = 0.4;
  const std::vector<double> x{-kLong, -wide / 2, wide / 2, kLong}, y{0, kThroat, kWall};
  const std::string name = "notch-" + number(wide);
  return {name,
          part_of(name, testing::cell_surface({x, y, std::vector{-10.0, 10.0}},
                                              [](int i, int j, int) { return i != 1 || j == 0; })),
          {-kLong, 0.7, 0.2},
          {kLong, 0.7, 0.2}};
}

/// The fluid leaves by the top of the little cube.
FlowProblem detail() {
  constexpr double kSize = 0.6;
  const std::vector<double> x{-kLong, -kSize / 2, kSize / 2, kLong}, y{0, kWall, kWall + kSize};
  return {"detail",
          part_of("detail", testing::cell_surface(
                                {x, y, std::vector{-10.0, -kSize / 2, kSize / 2, 10.0}},
                                [](int i, int j, int k) { return j == 0 || (i == 1 && k == 1); })),
          {-kLong, 0.7, 0.2},
          {0.07, kWall + kSize, 0.03}};
}

Study study_of(const FlowProblem& problem) {
  Study study;
  study.bodies.push_back({problem.part.name});
  study.bodies.back().layers = kCaseLayers;
  study.groups = {{"gate", GroupKind::gate}, {"vent", GroupKind::vent}};
  study.groups[0].floods = {{problem.gate, 0.3}};
  study.groups[1].floods = {{problem.vent, 0.3}};
  study.flow.emplace();
  study.flow->rounds = 0;
  return study;
}

Result<Outcome> made(const FlowProblem& problem, const Study& study) {
  return run(study, {problem.part},
             {std::shared_ptr<const VolumeMesher>(topological_mesher()),
              std::shared_ptr<const VolumeMesher>(netgen_mesher())});
}

Study corrected_by(const FlowProblem& problem, FlowMethod method) {
  Study study = study_of(problem);
  study.flow->rounds = 1;
  study.flow->method = method;
  study.flow->beta = 0.5;
  study.flow->growth = kGrowth;
  return study;
}

struct Point {
  double nodes = 0, rate = 0;
};
Point point_of(const Outcome& outcome) {
  return {static_cast<double>(outcome.state->mesh.node_count()), outcome.state->flow->rate()};
}

/// Of the mesh that uniform refinement would make with so many nodes: linear between its meshes in
/// logarithms.
double error_at(const std::vector<Point>& uniform, double exact, double nodes) {
  std::size_t k = 1;
  while (k + 1 < uniform.size() && uniform[k].nodes < nodes) ++k;
  const auto error = [&](std::size_t i) { return std::abs(uniform[i].rate / exact - 1); };
  const double t =
      std::log(nodes / uniform[k - 1].nodes) / std::log(uniform[k].nodes / uniform[k - 1].nodes);
  return error(k - 1) * std::pow(error(k) / error(k - 1), t);
}

// ---- Pictures

/// The section of a mesh with values at its nodes as colors and vectors as strokes.
struct FieldPanel {
  SimplexMesh<2> mesh;
  std::vector<double> value;    ///< [node]
  std::vector<Vec<2>> vectors;  ///< [node], may be empty
  std::string caption;
};

std::string color_of(double t) {
  // Violet over teal to yellow.
  const double stops[5][3] = {
      {68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
  const double s = 4 * std::clamp(t, 0.0, 1.0);
  const int k = std::min(3, static_cast<int>(s));
  char text[16];
  const auto mix = [&](int c) {
    return static_cast<int>(stops[k][c] + (s - k) * (stops[k + 1][c] - stops[k][c]));
  };
  std::snprintf(text, sizeof text, "#%02x%02x%02x", mix(0), mix(1), mix(2));
  return text;
}

std::string field_picture(const std::vector<FieldPanel>& panels, const std::string& title,
                          double window) {
  constexpr double kWidth = 380, kGap = 16, kCaption = 26;
  constexpr int kBands = 24;
  const double scale = kWidth / (2 * window);
  const double width = (kWidth + kGap) * static_cast<double>(panels.size()) + kGap;
  const double height = kWidth + kGap + kCaption;
  char text[200];
  std::string svg;
  std::snprintf(
      text, sizeof text,
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" "
      "height=\"%.0f\">\n<title>",
      width, height, width, height);
  svg += text + escaped(title) +
         "</title>\n<style>text{font:12px sans-serif;fill:#1c2733}path{stroke-width:.6}"
         ".v{fill:none;stroke:#101418;stroke-width:.8}</style>\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  double left = kGap;
  for (const FieldPanel& panel : panels) {
    const auto at = [&](const Vec<2>& p) {
      std::snprintf(text, sizeof text, "%.1f %.1f", scale * (p[0] + window),
                    scale * (window - p[1]));
      return std::string(text);
    };
    const auto inside = [&](const Vec<2>& p) { return p.cwiseAbs().maxCoeff() <= window; };
    const auto [low, high] = std::minmax_element(panel.value.begin() + 1, panel.value.end());
    std::vector<std::string> bands(kBands);
    for (const auto& e : panel.mesh.elements) {
      // Four pieces each, so that bands show the field and not the elements.
      std::array<Vec<2>, 6> p;
      std::array<double, 6> v;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = panel.mesh.points[e[k]];
        v[k] = panel.value[e[k]];
      }
      for (std::size_t k = 0; k < 3; ++k) {
        p[3 + k] = 0.5 * (p[k] + p[(k + 1) % 3]);
        v[3 + k] = 0.5 * (v[k] + v[(k + 1) % 3]);
      }
      const auto outside = [&](int axis, double side) {
        return side * p[0][axis] > window && side * p[1][axis] > window &&
               side * p[2][axis] > window;
      };
      if (outside(0, 1) || outside(0, -1) || outside(1, 1) || outside(1, -1)) continue;
      for (const auto& t : {std::array{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}) {
        const double mean = (v[t[0]] + v[t[1]] + v[t[2]]) / 3;
        const int band =
            std::clamp(static_cast<int>(kBands * (mean - *low) / std::max(*high - *low, 1e-300)), 0,
                       kBands - 1);
        bands[static_cast<std::size_t>(band)] +=
            "M" + at(p[t[0]]) + "L" + at(p[t[1]]) + "L" + at(p[t[2]]) + "Z";
      }
    }
    std::snprintf(text, sizeof text, "<svg x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\">\n",
                  left, kGap / 2, kWidth, kWidth);
    svg += text;
    for (int k = 0; k < kBands; ++k) {
      const std::string color = color_of((k + 0.5) / kBands);
      if (!bands[static_cast<std::size_t>(k)].empty())
        svg += "<path fill=\"" + color + "\" stroke=\"" + color + "\" d=\"" +
               bands[static_cast<std::size_t>(k)] + "\"/>\n";
    }
    if (!panel.vectors.empty()) {
      double longest = 0;
      for (const Vec<2>& v : panel.vectors) longest = std::max(longest, v.norm());
      svg += "<path class=\"v\" d=\"";
      for (std::size_t n = 1; n < panel.vectors.size(); ++n) {
        const Vec<2>& x = panel.mesh.points[n];
        const Vec<2> tip = x + 1.2 / longest * panel.vectors[n];
        if (inside(x) && inside(tip) && panel.vectors[n].norm() > 0.01 * longest)
          svg += "M" + at(x) + "L" + at(tip);
      }
      svg += "\"/>\n";
    }
    svg += "</svg>\n";
    std::snprintf(text, sizeof text, "<text text-anchor=\"middle\" x=\"%.1f\" y=\"%.1f\">",
                  left + kWidth / 2, height - 10);
    svg += text + escaped(panel.caption) + "</text>\n";
    left += kWidth + kGap;
  }
  return svg + "</svg>\n";
}

Result<std::vector<FieldPanel>> fields_of(const MeshState& state) {
  const auto cut = slice<3>(state.mesh, kAside);
  if (!cut) return cut.error();
  const ElementLocator<3> locator(state.mesh);
  const std::vector<Vec<3>>& v = state.flow->velocity;
  const std::vector<double> acceleration = acceleration_norm<3>(state.mesh, v);
  const std::vector<double> shear = nodal_means<3, double>(state.mesh, state.flow->shear);
  FieldPanel flow{cut->mesh, {0}, {Vec<2>::Zero()}, "5.2: velocity, and pressure as color"};
  FieldPanel gamma{cut->mesh, {0}, {}, "5.4: norm of the acceleration"};
  FieldPanel rate{cut->mesh, {0}, {}, "5.5: shear rate"};
  for (std::size_t n = 1; n < cut->mesh.points.size(); ++n) {
    const Vec<2>& x = cut->mesh.points[n];
    const Located<3> place = locator.locate({x[0], x[1], kAside});
    const auto& e = state.mesh.elements[static_cast<std::size_t>(place.element)];
    Vec<3> velocity = Vec<3>::Zero();
    double p = 0, a = 0, s = 0;
    for (int k = 0; k < 4; ++k) {
      velocity += place.weights[k] * v[e[k]];
      p += place.weights[k] * state.flow->pressure[e[k]];
      a += place.weights[k] * acceleration[e[k]];
      s += place.weights[k] * shear[e[k]];
    }
    flow.value.push_back(p);
    flow.vectors.push_back(velocity.head<2>());
    gamma.value.push_back(a);
    rate.value.push_back(s);
  }
  return std::vector{flow, gamma, rate};
}

/// Figure 5.6: the gradient of the acceleration alone, without the natural metric, down to as many
/// elements as that asks for; no size above kLong / 2, where it says nothing.
Result<SimplexMesh<3>> by_acceleration_alone(const FlowProblem& problem, const Outcome& natural) {
  const MeshState& state = *natural.state;
  const double h_min = natural.bodies.front().h_min;
  const Metric<3> largest = isotropic_metric<3>(kLong / 2);
  const MetricField<3> bare(state.mesh.points.size(), largest);
  std::vector<Mat<3>> tensors =
      gradient_tensors<3>(state.mesh, acceleration_norm<3>(state.mesh, state.flow->velocity));
  AddParams params;
  params.strength = 1000;  // beyond the budget, which then sets the weight
  params.h_min = h_min;
  params.elements = forecast_elements<3>(state.mesh, state.metric);
  const auto added = add_tensors<3>(state.mesh, bare, tensors, params);
  if (!added) return added.error();
  for (Mat<3>& t : tensors) t *= added->weight;
  const Result<CorrectionField> field = CorrectionField::adding(state.mesh, tensors);
  if (!field) return field.error();
  const MetricFunction<3> asked = [&](const Vec<3>& x) { return field->apply(x, largest, h_min); };
  SimplexMesh<3> mesh = state.mesh;
  for (int k = 0; k < 4; ++k) {
    MetricField<3> metric(mesh.points.size(), largest);
    for (std::size_t n = 1; n < metric.size(); ++n) metric[n] = asked(mesh.points[n]);
    Result<Adapted<3>> next = adapt<3>(mesh, metric, &problem.part.surface, {}, {}, asked);
    if (!next) return next.error();
    mesh = std::move(next->mesh);
  }
  return mesh;
}

/// The crossing with its natural mesh, corrected by the acceleration and by the velocity, and the
/// flow on a finer one.
Result<void> draw_crossing(const std::filesystem::path& pictures) {
  const FlowProblem problem = crossing();
  const Result<Outcome> natural = made(problem, study_of(problem));
  if (!natural) return natural.error();
  const Result<SimplexMesh<3>> alone = by_acceleration_alone(problem, *natural);
  if (!alone) return alone.error();
  const Result<Outcome> corrected = made(problem, corrected_by(problem, FlowMethod::acceleration));
  if (!corrected) return corrected.error();
  const Result<Outcome> by_default = made(problem, corrected_by(problem, StudyFlow{}.method));
  if (!by_default) return by_default.error();
  const Result<Outcome> fine = made(problem, refined(study_of(problem), 0.63));
  if (!fine) return fine.error();
  const Vec<2> low(-6, -6), high(6, 6);
  std::vector<SimplexMesh<2>> sections;
  std::vector<std::string> captions;
  for (const auto& [mesh, what] : std::vector<std::pair<const SimplexMesh<3>*, std::string>>{
           {&natural->state->mesh, "5.3: natural, "},
           {&*alone, "5.6: acceleration alone, "},
           {&corrected->state->mesh, "5.7: corrected by acceleration, "},
           {&by_default->state->mesh,
            "corrected by " + std::string(flow_method_name(StudyFlow{}.method)) + ", "}}) {
    auto cut = slice<3>(*mesh, kAside);
    if (!cut) return cut.error();
    sections.push_back(std::move(cut->mesh));
    captions.push_back(what + grouped(mesh->node_count()) + " nodes");
  }
  std::vector<MeshPanel> panels;
  for (std::size_t k = 0; k < sections.size(); ++k)
    panels.push_back({&sections[k], low, high, captions[k]});
  const std::string meshes =
      mesh_picture(panels, "Figures 5.3, 5.6 and 5.7, section of the crossing");
  if (auto written = write_file(pictures / "figure-5.3.svg", meshes); !written) return written;
  const auto fields = fields_of(*fine->state);
  if (!fields) return fields.error();
  return write_file(pictures / "figure-5.2.svg",
                    field_picture(*fields, "Figures 5.2, 5.4 and 5.5, section of the crossing", 6));
}

// ---- Tables

Result<void> put(const std::filesystem::path& page_file, const std::string& name,
                 const std::string& table) {
  Result<std::string> page = read_file(page_file);
  if (!page) return page.error();
  if (const Result<void> set = set_table(*page, name, table); !set) return set;
  return write_file(page_file, *page);
}

Result<std::string> table_of(const FlowProblem& problem) {
  std::string table =
      "| mesh | nodes | of natural | rate, mm3/s | error, % | uniform refinement at as many nodes, "
      "% "
      "|\n|---|---|---|---|---|---|\n";
  std::vector<Point> uniform;
  std::vector<std::string> titles;
  for (const double factor : {1.0, 0.8, 0.63, 0.5, 0.35, 0.25}) {
    const Result<Outcome> mesh =
        made(problem, factor == 1 ? study_of(problem) : refined(study_of(problem), factor));
    if (!mesh) return mesh.error();
    uniform.push_back(point_of(*mesh));
    std::fprintf(stderr, "%s %g: %.0f nodes, rate %.6g, %zu iterations\n", problem.name.c_str(),
                 factor, uniform.back().nodes, uniform.back().rate,
                 mesh->state->flow->residuals.size() - 1);
    titles.push_back(factor == 1 ? "natural" : "sizes x " + number(factor));
  }
  // Errors fall with the square of the sizes: the limit of the last two.
  const Point &a = uniform[uniform.size() - 2], &b = uniform.back();
  const double ratio = std::pow(b.nodes / a.nodes, 2.0 / 3);
  const double exact = b.rate + (b.rate - a.rate) / (ratio - 1);
  // Rates that still differ so much have no limit to be told.
  const bool settled = std::abs(b.rate - a.rate) < 0.1 * b.rate;
  const auto row = [&](const std::string& title, const Point& p, bool beside) {
    const double error = std::abs(p.rate / exact - 1);
    const std::string line =
        "| " + title + " | " + grouped(static_cast<std::size_t>(p.nodes)) + " | " +
        number(p.nodes / uniform.front().nodes) + " | " + number(p.rate, 5) + " | " +
        (settled ? number(100 * error) : "") + " | " +
        (settled && beside ? number(100 * error_at(uniform, exact, p.nodes)) : "") + " |\n";
    std::fprintf(stderr, "%s", line.c_str());
    table += line;
  };
  for (std::size_t k = 0; k < uniform.size(); ++k) row(titles[k], uniform[k], false);
  for (const FlowMethod method : kFlowMethods) {
    const Result<Outcome> mesh = made(problem, corrected_by(problem, method));
    if (!mesh) return mesh.error();
    row("by " + std::string(flow_method_name(method)), point_of(*mesh), true);
  }
  return table;
}

/// The pictures and all tables, or one of them.
Result<void> regenerate(const std::filesystem::path& docs,
                        const std::optional<std::filesystem::path>& only) {
  const std::filesystem::path page = docs / "validation.md",
                              pictures = docs / "pictures/validation";
  if (!only || *only == "pictures")
    if (auto drawn = draw_crossing(pictures); !drawn) return drawn;
  for (const FlowProblem& problem : {crossing(), notch(1.2), notch(0.4), detail()}) {
    if (only && *only != problem.name) continue;
    const Result<std::string> table = table_of(problem);
    if (!table) return table.error();
    if (auto done = put(page, "flow-" + problem.name, *table); !done) return done;
  }
  return {};
}

}  // namespace
}  // namespace lamella

int main(int argc, char** argv) {
  return lamella::write_tables(argc, argv, "lamella_flow_cases", lamella::regenerate,
                               "[CASE], the folder that holds validation.md, and crossing, "
                               "notch-1.2, notch-0.4, detail or pictures for one of them");
}
