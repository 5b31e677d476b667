#include "core/study/flow_round.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/flow/correction.h"
#include "core/flow/indicators.h"

namespace lamella {

namespace {

std::vector<Mat<3>> tensors_of(const SimplexMesh<3>& mesh, const std::vector<Vec<3>>& velocity,
                               FlowMethod method, int threads) {
  if (method == FlowMethod::velocity) return gradient_tensors<3>(mesh, velocity, threads);
  if (method == FlowMethod::strain) return strain_tensors<3>(mesh, velocity, threads);
  if (method == FlowMethod::combined) return combined_tensors<3>(mesh, velocity, threads);
  return gradient_tensors<3>(mesh, acceleration_norm<3>(mesh, velocity, threads), threads);
}

}  // namespace

void FlowFields::resize(std::size_t nodes, std::size_t elements) {
  velocity.resize(nodes, Vec<3>::Zero());
  pressure.resize(nodes, 0);
  shear.resize(elements, 0);
  indicator.resize(elements, 0);
}

void FlowFields::append(const FlowFields& other) {
  std::vector<NodeId> node(other.pressure.size(), 0);
  for (std::size_t n = 1; n < node.size(); ++n)
    node[n] = static_cast<NodeId>(pressure.size() + n - 1);
  std::vector<std::size_t> element(other.shear.size());
  for (std::size_t e = 0; e < element.size(); ++e) element[e] = shear.size() + e;
  resize(pressure.size() + node.size() - 1, shear.size() + element.size());
  put(other, node, element);
}

void FlowFields::put(const FlowFields& part, const std::vector<NodeId>& node,
                     const std::vector<std::size_t>& element) {
  for (std::size_t n = 1; n < node.size(); ++n) {
    velocity[node[n]] = part.velocity[n];
    pressure[node[n]] = part.pressure[n];
  }
  for (std::size_t e = 0; e < element.size(); ++e) {
    shear[element[e]] = part.shear[e];
    indicator[element[e]] = part.indicator[e];
  }
  openings.insert(openings.end(), part.openings.begin(), part.openings.end());
  imbalance = std::max(imbalance, part.imbalance);
  if (part.residuals.size() > residuals.size()) residuals = part.residuals;
}

double FlowFields::rate() const {
  double sum = 0;
  for (const OpeningFlow& o : openings) sum -= std::min(0.0, o.rate);
  return sum;
}

double FlowFields::highest_pressure() const {
  double highest = 0;
  for (const OpeningFlow& o : openings) highest = std::max(highest, o.pressure);
  return highest;
}

bool has_flow(const Study& study, const std::string& body) {
  return study.flow && settings_of(study, body).flow && !flow_case_of(study, body).gates.empty();
}

FlowCase<3> flow_case_of(const Study& study, const std::string& body) {
  FlowCase<3> out;
  if (study.flow) out.viscosity = study.flow->viscosity;
  std::vector<std::string> known;  // groups of one name are one group
  for (const BoundaryGroup& group : groups_of(study, body)) {
    if (std::count(known.begin(), known.end(), group.name) > 0) continue;
    known.push_back(group.name);
    if (group.kind == GroupKind::gate) {
      FlowGate gate{group.name, group.pressure, group.rate};
      if (!gate.pressure && !gate.rate) gate.pressure = 1;
      out.gates.push_back(std::move(gate));
    }
    if (group.kind == GroupKind::vent) out.vents.push_back(group.name);
    if (group.kind == GroupKind::symmetry) out.symmetries.push_back(group.name);
  }
  return out;
}

Result<FlowFields> flow_through(const SimplexMesh<3>& mesh, const FlowCase<3>& flow,
                                FlowMethod method, int threads, const Progress& progress) {
  FlowSettings settings;
  settings.threads = threads;
  Result<Flow<3>> solved = solve_stokes<3>(mesh, flow, settings, progress.portion(0, 0.9));
  if (!solved) return solved.error();
  FlowFields out;
  out.velocity = std::move(solved->velocity);
  out.pressure = std::move(solved->pressure);
  out.openings = std::move(solved->openings);
  out.imbalance = solved->imbalance;
  out.residuals = std::move(solved->residuals);
  out.shear = shear_rate<3>(mesh, out.velocity, threads);
  const Progress rest = progress.portion(0.9, 1);
  if (adds_gradient(method)) {
    const std::vector<Mat<3>> tensors = tensors_of(mesh, out.velocity, method, threads);
    out.indicator.assign(mesh.elements.size(), 0);
    const auto largest = [&](std::size_t e) {
      const auto& t = mesh.elements[e];
      Mat<3> mean = Mat<3>::Zero();
      for (const NodeId n : t) mean += 0.25 * tensors[n];
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < a; ++b) {
          const Vec<3> edge = mesh.points[t[a]] - mesh.points[t[b]];
          out.indicator[e] = std::max(out.indicator[e], edge.dot(mean * edge));
        }
      out.indicator[e] = std::sqrt(out.indicator[e]);
    };
    if (!parallel_each(mesh.elements.size(), threads, rest, largest)) return cancelled_error();
    return out;
  }
  if (method == FlowMethod::direction) {
    out.indicator = direction_change<3>(mesh, out.velocity, threads);
    return out;
  }
  auto found =
      method == FlowMethod::residual
          ? residual_indicator<3>(mesh, out.velocity, out.pressure, flow.viscosity, threads, rest)
          : directional_indicator<3>(mesh, out.velocity, out.pressure, flow.viscosity, {}, threads,
                                     rest);
  if (!found) return found.error();
  out.indicator = std::move(*found);
  return out;
}

Result<FlowCorrection> flow_correction(const SimplexMesh<3>& mesh, const MetricField<3>& natural,
                                       const FlowFields& flow, const StudyFlow& asked,
                                       const CorrectionField& before, double h_min, int threads,
                                       const Progress& progress) {
  FlowCorrection out;
  out.elements_before = forecast_elements<3>(mesh, natural);
  const double budget = asked.growth * out.elements_before;
  if (adds_gradient(asked.method)) {
    std::vector<Mat<3>> tensors = tensors_of(mesh, flow.velocity, asked.method, threads);
    AddParams params;
    params.strength = asked.strength;
    params.h_min = h_min;
    params.elements = budget;
    params.threads = threads;
    const auto made = add_tensors<3>(mesh, natural, tensors, params, progress.portion(0, 0.8));
    if (!made) return made.error();
    for (Mat<3>& t : tensors) t *= made->weight;
    out.elements_after = made->elements_after;
    Result<CorrectionField> field =
        CorrectionField::adding(mesh, tensors, progress.portion(0.8, 1));
    if (!field) return field.error();
    out.field = std::move(*field);
    return out;
  }
  std::vector<double> factors(mesh.points.size(), 1);
  if (!before.empty() &&
      !parallel_each(mesh.node_count(), threads, progress.portion(0, 0.1),
                     [&](std::size_t i) { factors[i + 1] = before.factor(mesh.points[i + 1]); }))
    return cancelled_error();
  UniformizeParams params;
  params.beta = asked.beta;
  params.h_min = h_min;
  params.elements = budget;
  params.threads = threads;
  const auto made = refine_evenly<3>(mesh, natural, flow.indicator, std::move(factors), params,
                                     progress.portion(0.1, 0.8));
  if (!made) return made.error();
  out.elements_after = made->elements_after;
  Result<CorrectionField> field =
      CorrectionField::scaling(mesh, made->factors, progress.portion(0.8, 1));
  if (!field) return field.error();
  out.field = std::move(*field);
  return out;
}

}  // namespace lamella
