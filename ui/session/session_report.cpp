#include <algorithm>

#include "core/base/atomic_file.h"
#include "ui/report_pdf.h"
#include "ui/session/command_line.h"
#include "ui/session/session.h"

// Files that leave the window, and what their report says.
namespace lamella::ui {
namespace {

QString text(const std::string& s) { return QString::fromStdString(s); }

}  // namespace

void Session::export_mesh(const std::filesystem::path& file, const ExportOptions& options) {
  const auto state = shown_state();
  if (activity_ != Activity::idle || !state) return;
  Q_EMIT logged(tr("Exporting %1").arg(text(file.string())));
  begin(Activity::exporting,
        [this, state, file, options, study = study_](const Progress& progress) -> Worker::Done {
          Result<ExportCertificate> written =
              services_.export_mesh(file, *state, *study, options, progress);
          return [this, state, written = std::move(written), file] {
            set_activity(Activity::idle);
            if (!written) return report(written.error());
            // Written once more it takes the place of the one before.
            std::erase_if(exports_, [&](const auto& one) {
              return one.first == state && one.second.file == written->file;
            });
            exports_.emplace_back(state, *written);
            Q_EMIT logged(tr("Wrote %1").arg(text(file.string())));
            QStringList notes;
            for (const std::string& note : written->notes) notes << text(note);
            for (const QString& note : notes) Q_EMIT logged(note);
            Q_EMIT exported(text(file.string()), notes.join('\n'));
          };
        });
}

ReportContext Session::report_context(const std::filesystem::path& file) const {
  const Study& study = run_study_ ? *run_study_ : *study_;
  ReportContext context;
  context.inputs = inputs_of(study);
  // What options cannot say a saved study can.
  if (const Result<std::string> line = command_line(study); line)
    context.command = *line;
  else if (!file.empty())
    context.command = command_line_for(file.string());
  for (const auto& [state, certificate] : exports_)
    if (outcome_ && state == outcome_->state) context.exports.push_back(certificate);
  return context;
}

void Session::take_report(Iteration& iteration) {
  Result<Outcome> outcome = outcome_from_json(project_.report_json);
  if (!outcome) return;
  outcome->state = iteration.state;
  const auto of_mesh = std::find_if(
      outcome->records.rbegin(), outcome->records.rend(), [&](const IterationRecord& r) {
        return r.nodes == iteration.record.nodes && r.elements == iteration.record.elements;
      });
  if (of_mesh != outcome->records.rend()) iteration.record = *of_mesh;
  outcome_ = std::move(*outcome);
}

void Session::save_report(const std::filesystem::path& file) {
  if (activity_ != Activity::idle || !has_report()) return;
  const bool opened = outcome_->state == opened_mesh_;
  begin(Activity::saving,
        [this, file, outcome = *outcome_, study = run_study_ ? run_study_ : study_,
         html = opened ? project_.report_html : std::string(),
         context = report_context(file_)](const Progress& progress) mutable -> Worker::Done {
          const auto write = [&]() -> Result<void> {
            if (html.empty()) {
              Result<Report> made = build_report(*study, outcome, context, progress);
              if (!made) return made.error();
              html = report_html(*made);
            }
            if (file.extension() == ".pdf")
              return write_report_pdf(text(html), text(file.string()));
            return write_file(file, html);
          };
          return [this, file, written = write()] {
            set_activity(Activity::idle);
            if (!written) return report(written.error());
            Q_EMIT logged(tr("Wrote %1").arg(text(file.string())));
            Q_EMIT report_saved(text(file.string()));
          };
        });
}

}  // namespace lamella::ui
