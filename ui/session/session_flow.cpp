#include <QElapsedTimer>

#include "core/geometry/triangles.h"
#include "core/study/flow_of_mesh.h"
#include "ui/session/session.h"
#include "ui/units.h"

// The flow through the shown mesh, or the field that another solver has found on it.
namespace lamella::ui {

double Session::extent() const {
  if (const double parts = extent_of(*parts_); parts > 0) return parts;
  const auto state = shown_state();
  return state ? diagonal_of_nodes(state->mesh) : extent_of(*shapes_);
}

std::shared_ptr<const SolverResult> Session::result() const {
  if (!result_ || !study_->flow || !study_->flow->field) return nullptr;
  const StudyInput& source = study_->flow->field->source;
  const bool same = result_->source.file == source.file ||
                    (!source.sha256.empty() && result_->source.sha256 == source.sha256);
  return same ? result_ : nullptr;
}

void Session::take_result(std::shared_ptr<const SolverResult> result) {
  if (!result || result == result_) return;
  result_ = std::move(result);
  Q_EMIT result_read();
}

void Session::open_result(const std::filesystem::path& file) {
  if (activity_ != Activity::idle || empty()) return;
  const QString name = QString::fromStdString(file.filename().string());
  Q_EMIT logged(tr("Reading the result %1").arg(name));
  begin(Activity::loading,
        [this, name, file = std::filesystem::absolute(file),
         size = extent()](const Progress& progress) -> Worker::Done {
          auto read = read_solver_result(services_, file, 0, size, progress);
          return [this, name, size, read = std::move(read)] {
            set_activity(Activity::idle);
            if (!read) return report(read.error());
            take_result(*read);
            Study study = *study_;
            const StudyInput& source = (*read)->source;
            StudyFlow flow = study.flow.value_or(StudyFlow{});
            flow.method = FlowMethod::field;
            flow.field = StudyField{source, (*read)->content.of_nodes.front().name};
            study.flow = std::move(flow);
            edit(tr("Correct by the result %1").arg(name), std::move(study));
            for (const FileUnit& unit : kFileUnits)
              if (unit.mm == source.unit && unit.mm != 1)
                Q_EMIT noticed(
                    tr("Lengths in %1 are taken for %2.")
                        .arg(name, QString::fromUtf8(unit.name.data(),
                                                     static_cast<int>(unit.name.size()))),
                    tr("The result is then %1 across, and the bodies are %2. If that is wrong, "
                       "choose its unit in the flow panel.")
                        .arg(units::length((*read)->across * unit.mm), units::length(size)));
            solve_flow();
          };
        });
}

void Session::solve_flow() {
  const auto state = shown_state();
  if (activity_ != Activity::idle || !state) return;
  const bool of_solver = study_->flow && study_->flow->field;
  Q_EMIT logged((of_solver ? tr("Laying the solver's field on %L1 nodes")
                           : tr("Solving the flow through %L1 nodes"))
                    .arg(state->mesh.node_count()));
  begin(Activity::flowing,
        [this, state, study = study_, parts = parts_, copies = project_.copies,
         known = result_](const Progress& progress) mutable -> Worker::Done {
          QElapsedTimer clock;
          clock.start();
          const auto field =
              solver_field_of(services_, *study, copies, known, progress.portion(0, 0.5));
          Result<FlowFields> flow =
              field ? flow_of_mesh(*state, *study, *parts, progress.portion(*field ? 0.5 : 0, 1),
                                   field->get())
                    : Result<FlowFields>(field.error());
          std::shared_ptr<const MeshState> flowing;
          std::shared_ptr<const PreparedMesh> prepared;
          if (flow) {
            auto made = std::make_shared<MeshState>(*state);
            made->flow = std::make_shared<const FlowFields>(std::move(*flow));
            flowing = std::move(made);
            prepared = prepare(flowing);
          }
          const double seconds = static_cast<double>(clock.elapsed()) / 1000;
          return [this, state, flowing, prepared, seconds, known, flow = std::move(flow)] {
            set_activity(Activity::idle);
            take_result(known);
            if (!flowing) return report(flow.error());
            const FlowFields& fields = *flowing->flow;
            if (fields.components == 0)
              Q_EMIT logged(tr("Flow: %1 iterations, %2 mm³/s, %3 s")
                                .arg(fields.residuals.size() - 1)
                                .arg(written(fields.rate(), 'g', 5))
                                .arg(written(seconds, 'f', 1)));
            // It is the same mesh for the report as well.
            if (outcome_ && outcome_->state == state) outcome_->state = flowing;
            if (opened_mesh_ == state) opened_mesh_ = flowing;
            mesh_unsaved_ = has_bodies();
            for (std::size_t k = 0; k < iterations_.size(); ++k) {
              if (iterations_[k].state != state) continue;
              iterations_[k].state = flowing;
              iterations_[k].prepared = prepared;
              iterations_[k].record.flow_rate = fields.rate();
              iterations_[k].record.flow_pressure = fields.highest_pressure();
              if (static_cast<int>(k) == shown_) Q_EMIT shown_changed();
            }
          };
        });
}

}  // namespace lamella::ui
