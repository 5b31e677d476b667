#include "ui/panels/cut_page.h"

#include <QLineEdit>
#include <QVBoxLayout>

#include "ui/commands/study_edits.h"
#include "ui/panels/form.h"
#include "ui/session/session.h"

namespace lamella::ui {

CutPage::CutPage(Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(8);
  layout->addWidget(styled_label(tr("Cut"), "panel_title"));
  auto* form = new Form;
  name_ = new QLineEdit;
  form->add(tr("Name"), name_);
  origin_ = new PointBox("cut_origin", tr("A point of the plane"));
  form->add(tr("Through"), origin_);
  normal_ = new PointBox("cut_normal", tr("Across the plane: what it points to is cut away"), true);
  form->add(tr("Towards"), normal_);
  layout->addLayout(form);
  auto* hint = styled_label(
      tr("In the view the blue knob moves the plane, the orange tip turns it."), "soft");
  hint->setWordWrap(true);
  layout->addWidget(hint);
  layout->addStretch(1);
  connect(name_, &QLineEdit::editingFinished, this, [this] {
    const Item item = session_.item();
    const std::string name = name_->text().trimmed().toStdString();
    if (item.kind != ItemKind::cut || name.empty()) return refresh();
    if (session_.study().cuts[static_cast<std::size_t>(item.index)].name == name) return;
    edit_cut(session_, item.index, tr("Rename %1"), [&](CutPlane& c) { c.name = name; });
  });
  const auto move = [this] {
    const Vec<3> normal = normal_->point();
    if (session_.item().kind != ItemKind::cut || !(normal.norm() > 0)) return;
    edit_cut(session_, session_.item().index, tr("Move %1"), [&](CutPlane& c) {
      c.origin = origin_->point();
      c.normal = normal.normalized();
    });
  };
  connect(origin_, &PointBox::edited, this, move);
  connect(normal_, &PointBox::edited, this, move);
}

void CutPage::refresh() {
  const Item item = session_.item();
  if (item.kind != ItemKind::cut) return;
  const CutPlane& cut = session_.study().cuts[static_cast<std::size_t>(item.index)];
  name_->setText(QString::fromStdString(cut.name));
  origin_->set_point(cut.origin);
  normal_->set_point(cut.normal);
}

}  // namespace lamella::ui
