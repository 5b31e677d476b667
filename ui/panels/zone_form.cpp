#include "ui/panels/zone_form.h"

#include <QLineEdit>
#include <algorithm>

#include "ui/commands/study_edits.h"
#include "ui/panels/form.h"
#include "ui/session/session.h"
#include "ui/units.h"

namespace lamella::ui {

ZoneForm::ZoneForm(Session& session, QWidget* parent)
    : QWidget(parent), session_(session), rows_(new Form) {
  setLayout(rows_);
  rows_->setContentsMargins(0, 0, 0, 0);
  name_ = new QLineEdit;
  name_->setObjectName("zone_name");
  rows_->add(tr("Name"), name_);
  center_ = new PointBox("zone_center", tr("Drag its knob in the view"));
  rows_->add(tr("Center"), center_);
  low_ = new PointBox("zone_low", tr("Lower corner of a box, middle of one end of a cylinder"));
  rows_->add(tr("From"), low_);
  high_ = new PointBox("zone_high", tr("Upper corner of a box, middle of the other end"));
  rows_->add(tr("To"), high_);
  normal_ =
      new PointBox("zone_normal", tr("Across the plane: the body is on the other side"), true);
  rows_->add(tr("Away from"), normal_);
  offset_ = new CoordinateBox;
  offset_->setObjectName("zone_offset");
  offset_->setSuffix(" " + units::name());
  offset_->setToolTip(tr("Where the plane is along that direction"));
  rows_->add(tr("Plane at"), offset_);
  radius_ = length_box("zone_radius", tr("Drag the outer knob in the view"));
  radius_->setMinimum(1e-6);
  rows_->add(tr("Radius"), radius_);
  connect(name_, &QLineEdit::editingFinished, this, &ZoneForm::rename);
  for (PointBox* box : {center_, low_, high_, normal_})
    connect(box, &PointBox::edited, this, &ZoneForm::edit_shape);
  for (QDoubleSpinBox* box : {offset_, static_cast<QDoubleSpinBox*>(radius_)})
    connect(box, &QDoubleSpinBox::valueChanged, this, &ZoneForm::edit_shape);
}

void ZoneForm::rename() {
  const auto& zones = session_.study().zones;
  const std::string name = name_->text().trimmed().toStdString();
  if (zone_ < 0 || zone_ >= static_cast<int>(zones.size())) return;
  const std::string old = zones[static_cast<std::size_t>(zone_)].name;
  if (name == old) return;
  if (!rename_zone(session_, zone_, name)) name_->setText(QString::fromStdString(old));
}

void ZoneForm::edit_shape() {
  edit_zone(session_, zone_, tr("Shape of %1"), [this](StudyZone& zone) {
    if (auto* ball = std::get_if<ZoneBall>(&zone.shape)) {
      *ball = {center_->point(), radius_->value()};
    } else if (auto* box = std::get_if<ZoneBox>(&zone.shape)) {
      const Vec<3> a = low_->point(), b = high_->point();
      // A box without an inside is none.
      if ((a - b).cwiseAbs().minCoeff() > 0) *box = {a.cwiseMin(b), a.cwiseMax(b)};
    } else if (auto* cylinder = std::get_if<ZoneCylinder>(&zone.shape)) {
      if (low_->point() != high_->point())
        *cylinder = {low_->point(), high_->point(), radius_->value()};
    } else if (auto* half = std::get_if<ZoneHalfSpace>(&zone.shape)) {
      const Vec<3> normal = normal_->point();
      if (normal.norm() > 0) *half = {normal, offset_->value() * normal.norm()};
    } else if (auto* cell = std::get_if<ZoneCell>(&zone.shape)) {
      cell->seed = center_->point();
    }
  });
}

void ZoneForm::show_zone(int zone) {
  zone_ = zone;
  setVisible(zone >= 0);
  if (zone < 0) return;
  const StudyZone& shown = session_.study().zones[static_cast<std::size_t>(zone)];
  const QSignalBlocker block[] = {QSignalBlocker(offset_), QSignalBlocker(radius_)};
  const auto* ball = std::get_if<ZoneBall>(&shown.shape);
  const auto* box = std::get_if<ZoneBox>(&shown.shape);
  const auto* cylinder = std::get_if<ZoneCylinder>(&shown.shape);
  const auto* half = std::get_if<ZoneHalfSpace>(&shown.shape);
  const auto* cell = std::get_if<ZoneCell>(&shown.shape);
  rows_->setRowVisible(center_, ball || cell);
  rows_->setRowVisible(low_, box || cylinder);
  rows_->setRowVisible(high_, box || cylinder);
  rows_->setRowVisible(radius_, ball || cylinder);
  rows_->setRowVisible(normal_, half);
  rows_->setRowVisible(offset_, half);
  name_->setText(QString::fromStdString(shown.name));
  if (ball) center_->set_point(ball->center);
  if (cell) center_->set_point(cell->seed);
  if (ball) radius_->set_length(ball->radius);
  if (cylinder) radius_->set_length(cylinder->radius);
  if (box || cylinder) {
    low_->set_point(box ? box->low : cylinder->from);
    high_->set_point(box ? box->high : cylinder->to);
  }
  if (!half) return;
  normal_->set_point(half->normal);
  offset_->setValue(half->offset / half->normal.norm());
}

}  // namespace lamella::ui
