#include "ui/panels/report_panel.h"

#include <algorithm>
#include <cmath>

#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/units.h"

namespace lamella::ui {
namespace {

constexpr std::size_t most_places = 40;

/// Numbers stay whole; titles of columns may take two lines.
QString cell(const QString& text) {
  return "<td align='right' style='padding: 4px 10px 4px 0; white-space: nowrap'>" + text + "</td>";
}

}  // namespace

ReportPanel::ReportPanel(Session& session, QWidget* parent)
    : QTextBrowser(parent), session_(session) {
  setAccessibleName(tr("Report"));
  setFrameShape(QFrame::NoFrame);
  document()->setDocumentMargin(14);
  setWordWrapMode(QTextOption::WordWrap);
  setOpenLinks(false);
  connect(this, &QTextBrowser::anchorClicked, this, &ReportPanel::jump);
  connect(&Units::get(), &Units::changed, this, &ReportPanel::refresh);
  connect(&session, &Session::run_finished, this, &ReportPanel::refresh);
  connect(&session, &Session::iterations_changed, this, &ReportPanel::refresh);
  refresh();
}

void ReportPanel::refresh() {
  const auto& outcome = session_.outcome();
  if (!outcome) {
    setHtml(QString("<span style='color:%1'>%2</span>")
                .arg(theme::faint_text.name(), tr("The report of a finished run appears here.")));
    return;
  }
  const QString state = outcome->cancelled   ? tr("Cancelled: the best mesh so far")
                        : outcome->converged ? tr("Converged")
                                             : tr("Stopped at the limit of iterations");
  QString html =
      QString(
          "<p><b>%1</b> <span style='color:%3'>%2</span> &nbsp; <a style='color:%5' "
          "href='save'>%4</a></p>")
          .arg(state, tr("in %1 s").arg(written(outcome->seconds, 'f', 1)), theme::soft_text.name(),
               tr("Save as PDF or HTML…"), theme::accent.name());
  html += "<table cellspacing='0'><tr style='color:" + theme::soft_text.name() + "'>";
  const QStringList titles{tr("Body"),
                           tr("Layers asked"),
                           tr("mean"),
                           tr("5 %"),
                           tr("median"),
                           tr("places reached"),
                           tr("Volume off the CAD's"),
                           tr("Distance to surface")};
  for (int k = 0; k < titles.size(); ++k)
    html += QString("<td align='%1' valign='bottom' style='padding: 4px 10px 0 0'>%2</td>")
                .arg(k == 0 ? "left" : "right", titles[k]);
  html += "</tr>";
  // Fuzzy borders have no faces that could be off.
  const bool fuzzy = !outcome->records.empty() && outcome->records.back().mixed > 0;
  for (const BodyOutcome& body : outcome->bodies) {
    const double off =
        body.cad_volume > 0 ? (body.mesh_volume - body.cad_volume) / body.cad_volume * 100 : 0;
    // The whole name stands in the study.
    const QString name =
        fontMetrics().elidedText(QString::fromStdString(body.name), Qt::ElideMiddle, 130);
    html += "<tr><td style='padding: 4px 10px 4px 0; white-space: nowrap'><b>" +
            name.toHtmlEscaped() + "</b></td>";
    html += cell(QString::number(body.layers_asked));
    html += cell(written(body.layers.mean, 'f', 2));
    html += cell(written(body.layers.p5, 'f', 2));
    html += cell(written(body.layers.p50, 'f', 2));
    html += cell(tr("%1 %").arg(written(body.layers.share_reached * 100, 'f', 1)));
    html += cell(tr("%1 %").arg(written(off, 'f', 3)));
    html += cell(fuzzy ? tr("–")
                       : tr("%1 of %2")
                             .arg(units::number(body.boundary_distance.largest(), 3),
                                  units::length(body.chord_tolerance, 3))) +
            "</tr>";
  }
  html += "</table>";
  html += interfaces_html();
  const auto add_note = [&](const BodyOutcome& body, const QString& note) {
    html += "<p style='color:" + theme::soft_text.name() + "; margin: 4px 0'>" +
            (QString::fromStdString(body.name) + ": " + note).toHtmlEscaped() + "</p>";
  };
  for (const BodyOutcome& body : outcome->bodies) {
    add_note(body,
             tr("volume %1, first mesh by %2")
                 .arg(units::volume(body.mesh_volume), QString::fromStdString(body.first_mesh_by)));
    for (const std::string& note : body.notes) add_note(body, QString::fromStdString(note));
  }
  html += places_html();
  setHtml(html);
}

QString ReportPanel::interfaces_html() const {
  const Outcome& outcome = *session_.outcome();
  if (outcome.records.empty() || outcome.records.back().mixed == 0) return {};
  const IterationRecord& last = outcome.records.back();
  QString html = "<p><b>" +
                 tr("%L1 of %L2 elements are mixed: filled in part by several bodies")
                     .arg(last.mixed)
                     .arg(last.elements) +
                 "</b></p><table cellspacing='0'>";
  for (const BodyOutcome& body : outcome.bodies)
    html += "<tr><td style='padding: 4px 12px 4px 0'>" +
            QString::fromStdString(body.name).toHtmlEscaped() + "</td>" +
            cell(tr("interface error %1 %").arg(written(100 * body.interface_error, 'f', 2))) +
            cell(tr("%1 across its borders").arg(units::length(body.interface_size, 3))) + "</tr>";
  return html + "</table>";
}

QString ReportPanel::places_html() const {
  QString html;
  const auto& bodies = session_.outcome()->bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& below = bodies[b].below;
    if (below.empty()) continue;
    html += "<p><b>" +
            tr("%1: places with fewer than %2 layers, the largest first")
                .arg(QString::fromStdString(bodies[b].name).toHtmlEscaped())
                .arg(bodies[b].layers_asked) +
            "</b></p><table cellspacing='0'>";
    for (std::size_t k = 0; k < below.size() && k < most_places; ++k)
      html += "<tr>" +
              cell(QString("<a style='color:%4' href='place:%1:%2'>%3</a>")
                       .arg(b)
                       .arg(k)
                       .arg(tr("Show"), theme::accent.name())) +
              cell(tr("%1 layers").arg(written(below[k].layers, 'f', 1))) +
              cell(tr("on %1").arg(units::area(below[k].area))) +
              cell(tr("near %1").arg(units::point(below[k].at))) + "</tr>";
    html += "</table>";
    if (below.size() > most_places)
      html += "<p>" + tr("and %1 smaller ones").arg(below.size() - most_places) + "</p>";
  }
  return html;
}

void ReportPanel::jump(const QUrl& link) {
  if (link.toString() == "save") Q_EMIT save_asked();
  const QStringList words = link.toString().split(':');
  const auto& outcome = session_.outcome();
  if (words.size() != 3 || !outcome) return;
  const auto b = static_cast<std::size_t>(words[1].toInt());
  const auto k = static_cast<std::size_t>(words[2].toInt());
  if (b >= outcome->bodies.size() || k >= outcome->bodies[b].below.size()) return;
  const PlaceBelow& place = outcome->bodies[b].below[k];
  // So much around it that its surroundings are recognized.
  session_.show_place(place.at, 3 * std::sqrt(std::max(place.area, 1e-6)),
                      tr("%1 of %2 layers")
                          .arg(written(place.layers, 'f', 1))
                          .arg(outcome->bodies[b].layers_asked));
}

}  // namespace lamella::ui
