#include "ui/panels/domain_page.h"

#include <QLabel>
#include <QVBoxLayout>

#include "core/study/domain.h"
#include "ui/commands/study_edits.h"
#include "ui/panels/form.h"
#include "ui/session/session.h"
#include "ui/units.h"

namespace lamella::ui {

DomainPage::DomainPage(Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(8);
  layout->addWidget(styled_label(tr("Domain"), "panel_title"));
  details_ = styled_label({}, "soft");
  details_->setObjectName("domain_details");
  details_->setWordWrap(true);
  layout->addWidget(details_);
  layout->addStretch(1);
}

void DomainPage::refresh() {
  const Study& study = session_.study();
  if (!study.domain) return;
  QStringList lines{domain_title(*study.domain)};
  const Result<StudyZone> hull = domain_hull(study, session_.parts());
  if (!hull) {
    lines << QString::fromStdString(hull.error().message);
  } else if (!std::holds_alternative<DomainBodies>(study.domain->shape)) {
    const Box<3> box = make_zone(*hull, {*hull})->box();
    const Vec<3> size = box.hi - box.lo;
    lines << units::size(size);
  }
  lines << tr(
      "One mesh fills it and carries all bodies. Where bodies overlap, the one that comes "
      "first in the study keeps what they share.");
  details_->setText(lines.join("\n"));
}

}  // namespace lamella::ui
