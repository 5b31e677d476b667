#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "core/base/atomic_file.h"
#include "core/cad/load_parts.h"
#include "tests/support/box_mesh.h"
#include "ui/services.h"

namespace lamella::test {

/// A state of box elements that fills the bounding box of `part`, finer with each iteration, with
/// smooth made-up fields.
inline std::shared_ptr<const MeshState> box_state(const Part& part, int iteration) {
  Vec<3> low = part.surface.points.front();
  Vec<3> high = low;
  for (const Vec<3>& p : part.surface.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const std::array<int, 3> n{6 + 3 * iteration, 5 + 2 * iteration, 2 + iteration};
  auto state = std::make_shared<MeshState>();
  state->mesh = box_mesh(n[0], n[1], n[2]);
  state->mesh.bodies = {part.name};
  const Vec<3> scale = (high - low).cwiseQuotient(Vec<3>(n[0], n[1], n[2]));
  for (std::size_t k = 1; k < state->mesh.points.size(); ++k)
    state->mesh.points[k] = low + state->mesh.points[k].cwiseProduct(scale);
  const std::size_t nodes = state->mesh.points.size();
  state->metric.assign(nodes, Metric<3>::Identity());
  state->thickness.resize(nodes);
  state->layers.resize(nodes);
  for (std::size_t k = 1; k < nodes; ++k) {
    const Vec<3> u = (state->mesh.points[k] - low).cwiseQuotient(high - low);
    state->thickness[k] = (high - low).minCoeff() * (0.6 + 0.4 * std::sin(5 * u[0]));
    state->layers[k] = u[0] > 0.9 ? std::numeric_limits<double>::quiet_NaN() : 2 + 4 * u[1];
  }
  for (std::size_t e = 0; e < state->mesh.elements.size(); ++e)
    state->quality.push_back(0.2 + 0.7 * std::abs(std::sin(0.1 * static_cast<double>(e))));
  return state;
}

/// The window's services with real parts and a made-up run of `iterations` steps of `step` each.
struct FakeServices {
  std::chrono::milliseconds step{10};
  std::atomic<int> until = 1000;  // iterations that a run makes before it waits for more
  std::atomic<int> exports = 0;
  ExportOptions export_options{};  // of the last one
  std::atomic<bool> mesh_is_damaged = false;
  MeshContent result{};  // of another solver, in every file

  ui::Services make() {
    ui::Services services;
    services.load_parts = [](const std::filesystem::path& file, const LoadParams& params,
                             const Progress& progress) {
      return load_parts(file, params, progress);
    };
    services.meshers = [](std::uint64_t) {
      return std::vector<std::shared_ptr<const VolumeMesher>>{};
    };
    services.run = [this](const Study& study, const std::vector<Part>& parts, const auto&,
                          const Progress& progress, const IterationSink& sink,
                          const auto&) -> Result<Outcome> {
      Outcome outcome;
      const int last = study.options.iterations;
      for (int k = 0; k <= last; ++k) {
        while (k >= until && !progress.cancelled())
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        for (int s = 0; s < 10; ++s) {
          if (progress.cancelled()) break;
          std::this_thread::sleep_for(step / 10);
          progress.portion(double(k) / (last + 1), double(k + 1) / (last + 1), "Adapting")
              .report((s + 1) / 10.0);
        }
        if (progress.cancelled()) {
          outcome.cancelled = true;
          break;
        }
        outcome.state = box_state(parts.front(), k);
        IterationRecord record;
        record.iteration = k;
        record.nodes = outcome.state->mesh.node_count();
        record.elements = outcome.state->mesh.element_count();
        record.conformity = 2.0 / (k + 1);
        record.layers = {2.0 + 0.4 * k, 1.4 + 0.4 * k, 2.0 + 0.4 * k, 0.9, 100};
        record.seconds = 0.1;
        outcome.records.push_back(record);
        sink(record, outcome.state);
      }
      if (!outcome.state) return cancelled_error();
      outcome.converged = !outcome.cancelled;
      BodyOutcome body;
      body.name = parts.front().name;
      body.layers_asked = settings_of(study, body.name).layers;
      body.first_mesh_by = "boxes";
      body.cad_volume = body.mesh_volume = parts.front().cad_volume;
      body.layers = outcome.records.back().layers;
      outcome.bodies.push_back(body);
      return outcome;
    };
    services.read_result = [this](const std::filesystem::path& file,
                                  const Progress&) -> Result<MeshContent> {
      if (!std::filesystem::exists(file)) return Error{Code::io, "There is no such file.", ""};
      return result;
    };
    services.formats.add(own_formats());
    services.export_mesh = [this](const std::filesystem::path& file, const MeshState&, const Study&,
                                  const ExportOptions& options,
                                  const Progress&) -> Result<ExportCertificate> {
      if (!std::filesystem::is_directory(file.parent_path()))
        return Error{Code::io, "Cannot write " + file.string() + ".", "Choose another folder."};
      if (Result<void> written = write_file(file, "a mesh"); !written) return written.error();
      ++exports;
      export_options = options;
      ExportCertificate proof;
      proof.file = file.filename().string();
      proof.format = "made up";
      proof.agrees = true;
      proof.notes = {"a note of the export"};
      return proof;
    };
    services.sample_part = [](const std::string& name) -> Result<std::filesystem::path> {
      return Error{Code::usage, "No sample part is called " + name + ".", ""};
    };
    services.thickness_map = [](const ReferenceSurface<3>& surface, const Progress& progress) {
      return thickness_map(surface, 0, progress);
    };
    services.read_mesh = [this](const std::filesystem::path&) -> Result<MeshState> {
      if (mesh_is_damaged) return Error{Code::bad_input, "The mesh is damaged.", ""};
      MeshState state;
      state.mesh = box_mesh(4, 3, 2, true);
      return state;
    };
    return services;
  }
};

}  // namespace lamella::test
