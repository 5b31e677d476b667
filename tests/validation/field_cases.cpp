// A mesh corrected by what another solver has found: the front of a melt in a plate, whose walls
// know nothing of it. Table and picture of resources/docs/validation_field.md, which holds the
// reading.

#include <cmath>
#include <cstdio>

#include "core/base/atomic_file.h"
#include "core/mesh/sample_meshes.h"
#include "core/mesh/slice.h"
#include "core/study/run.h"
#include "tests/support/sample_surfaces.h"
#include "tests/validation/layer_cases.h"
#include "tests/validation/mesh_picture.h"
#include "tests/validation/page.h"

namespace lamella {
namespace {

const Vec<3> kSize(40, 20, 2);  // mm
constexpr int kLayers = 2;
constexpr double kCell = 0.25;      // mm, of the other solver
constexpr double kHeight = 1.0123;  // mm, of the section

/// Temperature, C: the melt has come 15 mm from its gate in the corner.
double temperature(const Vec<3>& x) {
  return 120 - 100 * std::tanh((x.head<2>().norm() - 15) / 0.8);
}

std::shared_ptr<const SolverField> solved() {
  auto found = std::make_shared<SolverField>();
  std::array<int, 3> cells;
  for (int k = 0; k < 3; ++k) cells[k] = static_cast<int>(std::lround(kSize[k] / kCell));
  found->mesh = box_mesh<3>(cells, Vec<3>::Zero(), kSize);
  found->field = {"T", 1, {}};
  for (const Vec<3>& x : found->mesh.points) found->field.values.push_back(temperature(x));
  return found;
}

/// Root of the mean square of what linear elements miss of the temperature, C.
double error_of(const SimplexMesh<3>& mesh) {
  constexpr int kParts = 6;  // of each edge
  double sum = 0, volume = 0;
  for (const auto& e : mesh.elements) {
    double square = 0;
    int places = 0;
    for (int a = 0; a <= kParts; ++a)
      for (int b = 0; a + b <= kParts; ++b)
        for (int c = 0; a + b + c <= kParts; ++c, ++places) {
          // Within the element: its corners are exact.
          const double w[4] = {a + 0.25, b + 0.25, c + 0.25, kParts - a - b - c + 0.25};
          Vec<3> x = Vec<3>::Zero();
          double linear = 0;
          for (std::size_t k = 0; k < 4; ++k) {
            x += w[k] / (kParts + 1) * mesh.points[e[k]];
            linear += w[k] / (kParts + 1) * temperature(mesh.points[e[k]]);
          }
          square += std::pow(linear - temperature(x), 2);
        }
    const double v = signed_measure<3>(mesh.corners(e));
    sum += v * square / places;
    volume += v;
  }
  return std::sqrt(sum / volume);
}

Study study_of() {
  Study study;
  study.bodies = {{"plate", kLayers}};
  return study;
}

Study corrected(FlowMethod method, double growth, int rounds) {
  Study study = study_of();
  study.flow.emplace();
  study.flow->method = method;
  study.flow->growth = growth;
  study.flow->rounds = rounds;
  study.flow->strength = 4;  // the budget sets the weight
  study.flow->field = StudyField{{"solved.vtu"}, "T"};
  return study;
}

struct Made {
  SimplexMesh<3> mesh;
  double elements = 0, error = 0;
};

Result<Made> made(const Study& study) {
  static const std::shared_ptr<const SolverField> field = solved();
  const Part plate = part_of("plate", testing::box_surface(kSize));
  Result<Outcome> outcome = run(study, {plate},
                                {std::shared_ptr<const VolumeMesher>(topological_mesher()),
                                 std::shared_ptr<const VolumeMesher>(netgen_mesher())},
                                {}, {}, field);
  if (!outcome) return outcome.error();
  Made out{outcome->state->mesh, static_cast<double>(outcome->state->mesh.element_count()), 0};
  out.error = error_of(out.mesh);
  return out;
}

/// Of uniform refinement at so many elements: linear between its meshes in logarithms.
double error_at(const std::vector<Made>& uniform, double elements) {
  std::size_t k = 1;
  while (k + 1 < uniform.size() && uniform[k].elements < elements) ++k;
  const Made &a = uniform[k - 1], &b = uniform[k];
  const double t = std::log(elements / a.elements) / std::log(b.elements / a.elements);
  return a.error * std::pow(b.error / a.error, t);
}

Result<void> regenerate(const std::filesystem::path& docs,
                        const std::optional<std::filesystem::path>&) {
  std::string table =
      "| mesh | nodes | elements | error, C | without the field at as many elements, C | share "
      "|\n|---|---|---|---|---|---|\n";
  std::vector<Made> uniform;
  const auto row = [&](const std::string& title, const Made& m, bool beside) {
    const double other = beside ? error_at(uniform, m.elements) : 0;
    const std::string line = "| " + title + " | " + grouped(m.mesh.node_count()) + " | " +
                             grouped(m.mesh.element_count()) + " | " + short_number(m.error, 3) +
                             " | " + (beside ? short_number(other, 3) : "") + " | " +
                             (beside ? short_number(m.error / other, 2) : "") + " |\n";
    std::fprintf(stderr, "%s", line.c_str());
    table += line;
  };
  for (const double factor : {1.0, 0.8, 0.63, 0.5, 0.35}) {
    Result<Made> mesh = made(factor == 1 ? study_of() : refined(study_of(), factor));
    if (!mesh) return mesh.error();
    row(factor == 1 ? "natural" : "sizes x " + short_number(factor, 2), *mesh, false);
    uniform.push_back(std::move(*mesh));
  }
  std::optional<Made> drawn;
  for (const auto& [growth, rounds] :
       std::vector<std::pair<double, int>>{{1.5, 1}, {2, 1}, {4, 1}, {4, 2}}) {
    Result<Made> mesh = made(corrected(FlowMethod::field, growth, rounds));
    if (!mesh) return mesh.error();
    row("by its gradient, growth " + short_number(growth, 2) + ", rounds " + std::to_string(rounds),
        *mesh, true);
    if (growth == 4) drawn = std::move(*mesh);
  }
  // As many elements without the field, for the eye.
  double factor = 1;
  for (std::size_t k = 0; k + 1 < uniform.size(); ++k)
    if (uniform[k].elements < drawn->elements) factor = k == 0 ? 0.9 : k == 1 ? 0.72 : 0.56;
  const Result<Made> even = made(refined(study_of(), factor));
  if (!even) return even.error();
  std::vector<SimplexMesh<2>> sections;
  std::vector<std::string> captions;
  for (const auto& [mesh, what] :
       std::vector<std::pair<const Made*, std::string>>{{&uniform.front(), "natural"},
                                                        {&*even, "finer everywhere"},
                                                        {&*drawn, "corrected by the field"}}) {
    auto cut = slice<3>(mesh->mesh, kHeight);
    if (!cut) return cut.error();
    sections.push_back(std::move(cut->mesh));
    captions.push_back(what + ": " + grouped(mesh->mesh.element_count()) + " elements, " +
                       short_number(mesh->error, 3) + " C");
  }
  std::vector<MeshPanel> panels;
  for (std::size_t k = 0; k < sections.size(); ++k)
    panels.push_back({&sections[k], {0, 0}, {40, 20}, captions[k]});
  const auto picture = docs / "pictures/validation/field-front.svg";
  if (auto done = write_file(picture, mesh_picture(panels, "A front that walls know nothing of"));
      !done)
    return done;
  const std::filesystem::path page_file = docs / "validation_field.md";
  Result<std::string> page = read_file(page_file);
  if (!page) return page.error();
  if (const Result<void> set = set_table(*page, "field-front", table); !set) return set;
  return write_file(page_file, *page);
}

}  // namespace
}  // namespace lamella

int main(int argc, char** argv) {
  return lamella::write_tables(argc, argv, "lamella_field_cases", lamella::regenerate,
                               ", the folder that holds validation_field.md");
}
