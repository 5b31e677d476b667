#include "ui/panels/overlap_panel.h"

#include <QLabel>
#include <QPushButton>
#include <QTextBrowser>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "ui/panels/form.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/units.h"

namespace lamella::ui {
namespace {

QString cell(const QString& text, bool number = true) {
  return QString("<td align='%1' style='padding: 4px 16px 4px 0'>%2</td>")
      .arg(number ? "right" : "left", text);
}

QString length(double mm) { return units::length(mm, 3); }

/// A volume of about three digits, with its error.
QString volume(double mm3, double error) {
  const double unit = std::pow(units::per_unit(), 3);
  return QString("%L1 ± %L2 ").arg(mm3 / unit, 0, 'g', 3).arg(error / unit, 0, 'g', 3) +
         units::name() + "³";
}

QString link(const char* what, const char* kind, std::size_t index, const QString& text) {
  return QString("<a style='color:%1' href='%2:%3:%4'>%5</a>")
      .arg(theme::accent.name(), what, kind)
      .arg(index)
      .arg(text);
}

QString links(const char* kind, std::size_t index) {
  return cell(link("place", kind, index, OverlapPanel::tr("Show")) + "&nbsp; " +
                  link("cut", kind, index, OverlapPanel::tr("Cut open")),
              false);
}

QString title(const QString& text) { return "<p><b>" + text + "</b></p>"; }

QString row(const QStringList& titles) {
  QString html =
      QString("<table cellspacing='0'><tr style='color:%1'>").arg(theme::soft_text.name());
  for (int k = 0; k < titles.size(); ++k) html += cell(titles[k], k > 1);
  return html + "</tr>";
}

}  // namespace

OverlapPanel::OverlapPanel(Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 8, 0, 0);
  layout->setSpacing(0);
  auto* bar = new QHBoxLayout;
  bar->setContentsMargins(14, 0, 14, 0);
  bar->setSpacing(8);
  button_ = new QPushButton(tr("Look"));
  button_->setObjectName("look_for_overlaps");
  button_->setToolTip(tr("Find where bodies overlap, and where they leave gaps"));
  bar->addWidget(button_);
  bar->addWidget(styled_label(tr("for overlaps, and for gaps narrower than"), "soft"));
  width_ = length_box("gap_width", tr("Gaps between bodies that are narrower are listed too.\n"
                                      "Empty: overlaps only"));
  width_->set_automatic(tr("overlaps only"), 0.1);
  width_->setFixedWidth(130);
  width_->setAccessibleName(tr("for overlaps, and for gaps narrower than"));
  bar->addWidget(width_);
  bar->addStretch(1);
  layout->addLayout(bar);
  text_ = new QTextBrowser;
  text_->setObjectName("overlaps");
  text_->setAccessibleName(tr("Overlaps and gaps"));
  text_->setFrameShape(QFrame::NoFrame);
  text_->document()->setDocumentMargin(14);
  text_->setOpenLinks(false);
  layout->addWidget(text_, 1);
  connect(&Units::get(), &Units::changed, this, &OverlapPanel::refresh);
  connect(button_, &QPushButton::clicked, this, &OverlapPanel::look);
  connect(text_, &QTextBrowser::anchorClicked, this, &OverlapPanel::jump);
  for (const auto signal : {&Session::overlaps_changed, &Session::activity_changed,
                            &Session::parts_changed, &Session::study_changed})
    connect(&session, signal, this, &OverlapPanel::refresh);
  refresh();
}

void OverlapPanel::look() { session_.look_for_overlaps(width_->length().value_or(0)); }

void OverlapPanel::refresh() {
  const std::size_t bodies = session_.parts().size() + session_.study().zones.size();
  button_->setEnabled(session_.activity() == Activity::idle && bodies > 1);
  const auto faint = [](const QString& text) {
    return QString("<span style='color:%1'>%2</span>").arg(theme::faint_text.name(), text);
  };
  const QString html =
      session_.overlaps()                         ? found_html()
      : session_.activity() == Activity::checking ? faint(tr("Looking… Shift+F5 cancels."))
      : bodies < 2 ? faint(tr("With two bodies or more, overlaps and gaps between them are listed "
                              "here."))
                   : faint(tr("Overlaps of bodies and gaps between them are listed here. In one "
                              "mesh of all bodies the first body keeps what two share."));
  if (html == text_->property("html").toString()) return;
  text_->setProperty("html", html);
  text_->setHtml(html);
}

QString OverlapPanel::found_html() const {
  const OverlapCheck& check = *session_.overlaps();
  const auto& [overlaps, gaps] = check.found.report;
  const auto name = [&](int region) {
    return QString::fromStdString(check.found.names[static_cast<std::size_t>(region)])
        .toHtmlEscaped();
  };
  QString html;
  if (overlaps.empty()) {
    html += title(tr("No bodies overlap."));
  } else {
    html += title(overlaps.size() == 1 ? tr("1 overlap") : tr("%1 overlaps").arg(overlaps.size()));
    html += row({{}, tr("Bodies"), tr("Volume"), tr("Depth"), {}});
    for (std::size_t k = 0; k < overlaps.size(); ++k) {
      const Overlap& o = overlaps[k];
      html +=
          "<tr>" + links("overlap", k) +
          cell(tr("%1 and %2").arg(name(o.first), name(o.second)), false) +
          cell(volume(o.volume, o.error)) + cell(length(o.depth)) +
          cell(o.inner ? tr("%1 lies wholly in the other").arg(name(*o.inner)) : QString(), false) +
          "</tr>";
    }
    html += "</table>";
  }
  if (check.gap_width > 0 && gaps.empty()) {
    html += title(tr("No gaps are narrower than %1.").arg(length(check.gap_width)));
  } else if (check.gap_width > 0) {
    const QString narrower = tr("narrower than %1").arg(length(check.gap_width));
    html +=
        title((gaps.size() == 1 ? tr("1 gap") : tr("%1 gaps").arg(gaps.size())) + ' ' + narrower);
    html += row({{}, tr("Bodies"), tr("Volume"), tr("Narrowest"), tr("mean")});
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      const Gap& g = gaps[k];
      html += "<tr>" + links("gap", k) +
              cell(tr("%1 and %2").arg(name(g.first), name(g.second)), false) +
              cell(volume(g.volume, g.error)) + cell(length(g.least_width)) +
              cell(length(g.mean_width)) + "</tr>";
    }
    html += "</table>";
  }
  return html +
         QString("<p style='color:%1'>%2</p>")
             .arg(theme::soft_text.name(), tr("Found in %1 s").arg(written(check.seconds, 'f', 1)));
}

void OverlapPanel::jump(const QUrl& to) {
  const QStringList words = to.toString().split(':');
  if (words.size() != 3 || !session_.overlaps()) return;
  const auto& [names, report] = session_.overlaps()->found;
  const auto k = static_cast<std::size_t>(words[2].toInt());
  const auto show = [&](const auto& found, double size, const QString& text) {
    // The two are outlined, wherever the place is hidden behind.
    std::vector<int> bodies;
    for (std::size_t b = 0; b < session_.study().bodies.size(); ++b)
      for (const int region : {found.first, found.second})
        if (session_.study().bodies[b].name == names[static_cast<std::size_t>(region)])
          bodies.push_back(static_cast<int>(b));
    session_.select(bodies, -1);
    // So much around it that its surroundings are recognized.
    const double radius = std::max(size, std::cbrt(found.volume));
    if (words[0] == "cut")
      session_.cut_at(found.place, radius, text);
    else
      session_.show_place(found.place, radius, text);
  };
  if (words[1] == "overlap" && k < report.overlaps.size())
    show(report.overlaps[k], 4 * report.overlaps[k].depth,
         tr("overlap %1 deep").arg(length(report.overlaps[k].depth)));
  else if (words[1] == "gap" && k < report.gaps.size())
    show(report.gaps[k], 8 * report.gaps[k].least_width,
         tr("gap of %1").arg(length(report.gaps[k].least_width)));
}

}  // namespace lamella::ui
