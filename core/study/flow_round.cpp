#include "core/study/flow_round.h"

#include <algorithm>
#include <cstdio>

#include "core/base/parallel.h"
#include "core/flow/correction.h"
#include "core/flow/field_transfer.h"
#include "core/flow/indicators.h"
#include "core/geometry/bvh.h"
#include "core/geometry/triangles.h"

namespace lamella {

namespace {

std::vector<Mat<3>> tensors_of(const SimplexMesh<3>& mesh, const FlowFields& flow,
                               FlowMethod method, int threads) {
  const std::vector<Vec<3>>& velocity = flow.velocity;
  if (flow.components == 1) return gradient_tensors<3>(mesh, flow.number, threads);
  if (method == FlowMethod::velocity || method == FlowMethod::field)
    return gradient_tensors<3>(mesh, velocity, threads);
  if (method == FlowMethod::strain) return strain_tensors<3>(mesh, velocity, threads);
  if (method == FlowMethod::combined) return combined_tensors<3>(mesh, velocity, threads);
  return gradient_tensors<3>(mesh, acceleration_norm<3>(mesh, velocity, threads), threads);
}

/// [element] the largest difference along an edge of the field whose gradient is added.
Result<std::vector<double>> differences(const SimplexMesh<3>& mesh, const FlowFields& flow,
                                        FlowMethod method, int threads, const Progress& progress) {
  const std::vector<Mat<3>> tensors = tensors_of(mesh, flow, method, threads);
  std::vector<double> out(mesh.elements.size(), 0);
  const auto largest = [&](std::size_t e) {
    const auto& t = mesh.elements[e];
    Mat<3> mean = Mat<3>::Zero();
    for (const NodeId n : t) mean += 0.25 * tensors[n];
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) {
        const Vec<3> edge = mesh.points[t[a]] - mesh.points[t[b]];
        out[e] = std::max(out[e], edge.dot(mean * edge));
      }
    out[e] = std::sqrt(out[e]);
  };
  if (!parallel_each(mesh.elements.size(), threads, progress, largest)) return cancelled_error();
  return out;
}

}  // namespace

void FlowFields::resize(std::size_t nodes, std::size_t elements) {
  if (components == 1) number.resize(nodes, 0);
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
  if (part.components > 0) {
    field = part.field;
    components = part.components;
    resize(pressure.size(), shear.size());
  }
  for (std::size_t n = 1; n < node.size(); ++n) {
    if (!part.number.empty()) number[node[n]] = part.number[n];
    velocity[node[n]] = part.velocity[n];
    pressure[node[n]] = part.pressure[n];
  }
  for (std::size_t e = 0; e < element.size(); ++e) {
    shear[element[e]] = part.shear[e];
    indicator[element[e]] = part.indicator[e];
  }
  outside += part.outside;
  farthest = std::max(farthest, part.farthest);
  openings.insert(openings.end(), part.openings.begin(), part.openings.end());
  imbalance = std::max(imbalance, part.imbalance);
  if (part.residuals.size() > residuals.size()) residuals = part.residuals;
}

FlowFields FlowFields::of(const std::vector<NodeId>& node,
                          const std::vector<std::size_t>& element) const {
  FlowFields part;
  part.field = field;
  part.components = components;
  for (const NodeId n : node) {
    if (!number.empty()) part.number.push_back(number[n]);
    part.velocity.push_back(velocity[n]);
    part.pressure.push_back(pressure[n]);
  }
  for (const std::size_t e : element) {
    part.shear.push_back(shear[e]);
    part.indicator.push_back(indicator[e]);
  }
  return part;
}

double FlowFields::mean_indicator() const {
  double sum = 0;
  std::size_t count = 0;
  for (const double i : indicator) {
    sum += i;
    count += i > 0;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
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
  if (!study.flow || !settings_of(study, body).flow) return false;
  return study.flow->field || !flow_case_of(study, body).gates.empty();
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
    auto found = differences(mesh, out, method, threads, rest);
    if (!found) return found.error();
    out.indicator = std::move(*found);
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

namespace {

/// Whether the field can be used as the method does. Errors: usage, bad_input.
Result<void> check_use(const NodeField& field, FlowMethod method) {
  if (!suits_field(method, field.components))
    return Error{Code::usage,
                 "\"" + field.name + "\" is a " + (field.components == 1 ? "number" : "vector") +
                     ", which \"" + std::string(flow_method_name(method)) + "\" cannot use.",
                 "An indicator is a number; a velocity is a vector; \"field\" takes both."};
  if (method == FlowMethod::indicator &&
      std::any_of(field.values.begin(), field.values.end(), [](double v) { return v < 0; }))
    return Error{Code::bad_input, "\"" + field.name + "\" is negative in places: no indicator.",
                 "Correct by its gradient (field), or write its absolute value."};
  return {};
}

}  // namespace

Result<FlowFields> field_on(const SimplexMesh<3>& mesh, const SolverField& field, FlowMethod method,
                            double across, int threads, const Progress& progress) {
  FlowFields out;
  out.field = field.field.name;
  out.components = field.field.components;
  if (Result<void> good = check_use(field.field, method); !good) return good.error();
  Result<TransferredField> found = transfer_field(field.mesh, field.field.values, out.components,
                                                  mesh, threads, progress.portion(0, 0.8), across);
  if (!found) return found.error();
  out.outside = found->outside;
  out.farthest = found->farthest;
  out.resize(mesh.points.size(), mesh.elements.size());
  if (out.components == 1)
    out.number = std::move(found->values);
  else
    for (std::size_t n = 1; n < mesh.points.size(); ++n)
      out.velocity[n] = Eigen::Map<const Vec<3>>(&found->values[3 * n]);
  if (method == FlowMethod::direction) {
    out.indicator = direction_change<3>(mesh, out.velocity, threads);
  } else if (method == FlowMethod::indicator) {
    for (std::size_t e = 0; e < mesh.elements.size(); ++e)
      for (const NodeId n : mesh.elements[e]) out.indicator[e] += out.number[n] / 4;
  } else {
    auto steps = differences(mesh, out, method, threads, progress.portion(0.8, 1));
    if (!steps) return steps.error();
    out.indicator = std::move(*steps);
  }
  return out;
}

double extent_of(const std::vector<Part>& parts) {
  Box<3> box;
  for (const Part& part : parts)
    for (const Vec<3>& p : part.surface.points) box.add(p);
  return parts.empty() ? 0 : (box.hi - box.lo).norm();
}

Result<void> check_field(const Study& study, const std::vector<Part>& parts,
                         const SolverField* field, const Progress& progress) {
  if (!study.flow || !study.flow->field) return {};
  if (!field) return Error{Code::usage, "The solver's field was not read.", "Name its file again."};
  if (Result<void> good = check_use(field->field, study.flow->method); !good) return good;
  std::optional<Error> why;
  for (const Part& part : parts) {
    if (!has_flow(study, part.name)) continue;
    const Result<void> there =
        check_place(field->mesh, part.surface, extent_of(parts), study.options.threads, progress);
    if (there) return {};
    if (there.error().code == Code::cancelled) return there;
    if (!why) why = there.error();
  }
  if (why) return *why;
  return {};
}

double flow_h_min(const Study& study, double natural) {
  return std::max(natural, study.flow ? study.flow->h_min.value_or(0) : 0);
}

bool is_of(const FlowFields& fields, const StudyFlow& flow) {
  return fields.field == (flow.field ? flow.field->name : std::string());
}

Result<FlowCorrection> flow_correction(const SimplexMesh<3>& mesh, const MetricField<3>& natural,
                                       const FlowFields& flow, const StudyFlow& asked,
                                       const CorrectionField& before, double h_min, int threads,
                                       const Progress& progress) {
  FlowCorrection out;
  out.elements_before = forecast_elements<3>(mesh, natural);
  const double budget = asked.growth * out.elements_before;
  if (adds_gradient(asked.method)) {
    std::vector<Mat<3>> tensors = tensors_of(mesh, flow, asked.method, threads);
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

std::string outside_note(const FlowFields& fields) {
  if (fields.outside == 0) return {};
  char text[200];
  std::snprintf(text, sizeof text,
                "%zu of %zu nodes lie outside the mesh of the field, up to %.3g mm; the nearest "
                "place counts there.",
                fields.outside, fields.velocity.size() - 1, fields.farthest);
  return text;
}

std::string field_note(const FlowFields& before, const FlowFields& after,
                       const FlowCorrection& made) {
  char text[200];
  std::snprintf(text, sizeof text,
                "\": %.4g instead of %.4g elements asked for; the mean indicator is %.4g instead "
                "of %.4g.",
                made.elements_after, made.elements_before, after.mean_indicator(),
                before.mean_indicator());
  return "Corrected by the field \"" + after.field + text;
}

}  // namespace lamella
