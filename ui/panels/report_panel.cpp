#include "ui/panels/report_panel.h"

#include "ui/session/session.h"

namespace lamella::ui {
namespace {

QString cell(const QString& text) {
  return "<td align='right' style='padding: 4px 12px 4px 0'>" + text + "</td>";
}

}  // namespace

ReportPanel::ReportPanel(Session& session, QWidget* parent)
    : QTextBrowser(parent), session_(session) {
  setFrameShape(QFrame::NoFrame);
  document()->setDocumentMargin(14);
  connect(&session, &Session::run_finished, this, &ReportPanel::refresh);
  connect(&session, &Session::iterations_changed, this, &ReportPanel::refresh);
  refresh();
}

void ReportPanel::refresh() {
  const auto& outcome = session_.outcome();
  if (!outcome) {
    setHtml(tr("<span style='color:#8a97a5'>The report of a finished run appears here.</span>"));
    return;
  }
  const QString state = outcome->cancelled   ? tr("Cancelled: the best mesh so far")
                        : outcome->converged ? tr("Converged")
                                             : tr("Stopped at the limit of iterations");
  QString html = QString("<p><b>%1</b> <span style='color:#52606d'>%2</span></p>")
                     .arg(state, tr("in %1 s").arg(outcome->seconds, 0, 'f', 1));
  html += "<table cellspacing='0'><tr style='color:#6b7885'>";
  const QStringList titles{tr("Body"),         tr("Layers asked"),  tr("mean"),
                           tr("5 %"),          tr("median"),        tr("places reached"),
                           tr("Volume, mm³"),  tr("off the CAD's"), tr("Distance to surface"),
                           tr("First mesh by")};
  for (int k = 0; k < titles.size(); ++k)
    html += QString("<td align='%1' style='padding: 4px 12px 4px 0'>%2</td>")
                .arg(k == 0 ? "left" : "right", titles[k]);
  html += "</tr>";
  for (const BodyOutcome& body : outcome->bodies) {
    const double off =
        body.cad_volume > 0 ? (body.mesh_volume - body.cad_volume) / body.cad_volume * 100 : 0;
    html += "<tr><td style='padding: 4px 12px 4px 0'><b>" +
            QString::fromStdString(body.name).toHtmlEscaped() + "</b></td>";
    html += cell(QString::number(body.layers_asked));
    html += cell(QString::number(body.layers.mean, 'f', 2));
    html += cell(QString::number(body.layers.p5, 'f', 2));
    html += cell(QString::number(body.layers.p50, 'f', 2));
    html += cell(tr("%1 %").arg(body.layers.share_reached * 100, 0, 'f', 1));
    html += cell(QString("%L1").arg(body.mesh_volume, 0, 'f', 1));
    html += cell(tr("%1 %").arg(off, 0, 'f', 3));
    html += cell(tr("%1 of %2 mm")
                     .arg(body.boundary_distance.largest(), 0, 'g', 3)
                     .arg(body.chord_tolerance, 0, 'g', 3));
    html += cell(QString::fromStdString(body.first_mesh_by).toHtmlEscaped()) + "</tr>";
  }
  html += "</table>";
  for (const BodyOutcome& body : outcome->bodies)
    for (const std::string& note : body.notes)
      html += "<p style='color:#52606d'>" +
              QString::fromStdString(body.name + ": " + note).toHtmlEscaped() + "</p>";
  setHtml(html);
}

}  // namespace lamella::ui
