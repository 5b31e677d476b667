#include "ui/panels/sizing_page.h"

#include <QComboBox>
#include <QLineEdit>
#include <QVBoxLayout>

#include "ui/commands/study_edits.h"
#include "ui/panels/form.h"
#include "ui/session/forecaster.h"
#include "ui/session/session.h"
#include "ui/units.h"

namespace lamella::ui {

SizingPage::SizingPage(Session& session, Forecaster& forecaster, QWidget* parent)
    : QWidget(parent), session_(session), forecaster_(forecaster) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(8);
  layout->addWidget(styled_label(tr("Size at a place"), "panel_title"));
  auto* form = new Form;
  rows_ = form;
  name_ = new QLineEdit;
  name_->setObjectName("sizing_name");
  form->add(tr("Name"), name_);
  body_ = new QComboBox;
  body_->setObjectName("sizing_body");
  body_->setToolTip(tr("The body whose elements get this size"));
  form->add(tr("Body"), body_);
  make_shape(form);
  make_asked(form);
  layout->addLayout(form);
  zone_ = styled_label(tr("An analytic zone: its sizes are set in the study file."), "soft");
  zone_->setWordWrap(true);
  layout->addWidget(zone_);
  layout->addSpacing(6);
  layout->addWidget(styled_label(tr("Mesh to expect"), "section_title"));
  forecast_ = styled_label({}, "soft");
  forecast_->setObjectName("sizing_forecast");
  forecast_->setWordWrap(true);
  layout->addWidget(forecast_);
  layout->addStretch(1);

  connect(name_, &QLineEdit::editingFinished, this, [this] {
    const std::string name = name_->text().trimmed().toStdString();
    if (name.empty()) return refresh();
    edit(tr("Rename %1"), [&](SizingObject& o) { o.name = name; });
  });
  connect(body_, &QComboBox::activated, this, [this] {
    const std::string body = body_->currentData().toString().toStdString();
    edit(tr("Body of %1"), [&](SizingObject& o) { o.body = body; });
  });
  connect(&forecaster, &Forecaster::changed, this, &SizingPage::show_forecast);
}

void SizingPage::make_shape(Form* form) {
  center_ = new PointBox("center", tr("Center; drag its knob in the view"));
  form->add(tr("Center"), center_);
  end_ = new PointBox("end", tr("Center of the other end"));
  form->add(tr("Other end"), end_);
  size_ = new PointBox("box_size", tr("Lengths of the edges"));
  size_->set_minimum(0.001);
  form->add(tr("Edges"), size_);
  radius_ = length_box("radius", tr("Radius; drag the outer knob in the view"));
  radius_->setMinimum(1e-6);
  form->add(tr("Radius"), radius_);
  faces_ = styled_label({}, "soft");
  form->add(tr("Faces"), faces_);
  depth_ = length_box("depth", tr("How far below the faces the size holds"));
  form->add(tr("Depth"), depth_);
  for (PointBox* box : {center_, end_, size_})
    connect(box, &PointBox::edited, this, &SizingPage::edit_shape);
  for (LengthBox* box : {radius_, depth_})
    connect(box, &QDoubleSpinBox::valueChanged, this, &SizingPage::edit_shape);
}

void SizingPage::make_asked(Form* form) {
  asks_ = new QComboBox;
  asks_->setObjectName("asks");
  asks_->addItem(tr("size"));
  asks_->addItem(tr("× natural size"));
  asks_->setToolTip(tr("A size, or a factor of the size that the walls ask for there"));
  form->add(tr("Asks for"), asks_);
  value_ = number_box(1e-6, 1e6, 0.05, "asked_value",
                      tr("The smaller, the more elements. A factor above 1 is coarser, and needs\n"
                         "the directions kept"));
  value_->setDecimals(4);
  form->add(tr("Value"), value_);
  gradation_ =
      number_box(1.01, 10, 0.1, "gradation", tr("How fast sizes grow outside, per unit length"));
  form->add(tr("Growth outside"), gradation_);
  directions_ = new QCheckBox(tr("keep directions"));
  directions_->setObjectName("keep_directions");
  directions_->setToolTip(
      tr("Scales the stretched elements of the walls instead of making them\n"
         "equal in all directions: fewer elements"));
  form->add(tr("Stretching"), directions_);
  connect(asks_, &QComboBox::activated, this, [this] {
    edit(tr("What %1 asks"), [this](SizingObject& o) {
      auto& c = std::get<SizeCorrection>(o.asks);
      const bool size = asks_->currentIndex() == 0;
      // The smallest size of the body is a start that is fine, and is seen.
      const double start = session_.has_bodies() ? 20 * session_.automatic_size(0) : 1;
      c.size = size ? std::optional(start) : std::nullopt;
      c.factor = size ? std::nullopt : std::optional(0.5);
    });
  });
  connect(value_, &QDoubleSpinBox::valueChanged, this, &SizingPage::edit_asked);
  connect(gradation_, &QDoubleSpinBox::valueChanged, this, &SizingPage::edit_asked);
  connect(directions_, &QCheckBox::toggled, this, &SizingPage::edit_asked);
}

void SizingPage::edit(const QString& what, const std::function<void(SizingObject&)>& change) {
  if (session_.item().kind == ItemKind::sizing)
    edit_sizing(session_, session_.item().index, what, change);
}

void SizingPage::edit_shape() {
  edit(tr("Shape of %1"), [this](SizingObject& o) {
    if (auto* s = std::get_if<SphereShape>(&o.shape)) {
      *s = {center_->point(), radius_->value()};
    } else if (auto* b = std::get_if<BoxShape>(&o.shape)) {
      b->center = center_->point();
      b->size = size_->point();
    } else if (auto* c = std::get_if<CylinderShape>(&o.shape)) {
      *c = {center_->point(), end_->point(), radius_->value()};
    } else if (auto* f = std::get_if<FacesShape>(&o.shape)) {
      f->depth = depth_->value();
    }
  });
}

void SizingPage::edit_asked() {
  edit(tr("What %1 asks"), [this](SizingObject& o) {
    auto* c = std::get_if<SizeCorrection>(&o.asks);
    if (!c) return;
    // The box shows a size rounded: what was not changed there stays as it is.
    if (sender() == value_ && c->size) c->size = value_->value() * units::per_unit();
    if (sender() == value_ && c->factor) c->factor = value_->value();
    c->gradation = gradation_->value();
    c->keep_directions = directions_->isChecked();
  });
}

void SizingPage::refresh() {
  const Item item = session_.item();
  if (item.kind != ItemKind::sizing) return;
  const SizingObject& object = session_.study().sizing[static_cast<std::size_t>(item.index)];
  const QSignalBlocker block[] = {QSignalBlocker(radius_), QSignalBlocker(depth_),
                                  QSignalBlocker(value_), QSignalBlocker(gradation_),
                                  QSignalBlocker(directions_)};
  depth_->setSpecialValueText(units::length(0));
  name_->setText(QString::fromStdString(object.name));
  body_->clear();
  if (!std::holds_alternative<FacesShape>(object.shape) || session_.shapes().size() == 1)
    body_->addItem(tr("all bodies"), QString());
  for (const Part& part : session_.shapes())
    body_->addItem(QString::fromStdString(part.name), QString::fromStdString(part.name));
  body_->setCurrentIndex(body_->findData(QString::fromStdString(object.body)));
  show_shape(object.shape);
  show_asked(object);
  show_forecast();
}

void SizingPage::show_shape(const SizingShape& shape) {
  const auto row = [this](QWidget* field, bool on) {
    field->setVisible(on);
    if (QWidget* label = rows_->labelForField(field)) label->setVisible(on);
  };
  const auto* sphere = std::get_if<SphereShape>(&shape);
  const auto* box = std::get_if<BoxShape>(&shape);
  const auto* cylinder = std::get_if<CylinderShape>(&shape);
  const auto* faces = std::get_if<FacesShape>(&shape);
  row(center_, sphere || box || cylinder);
  row(end_, cylinder);
  row(size_, box);
  row(radius_, sphere || cylinder);
  row(faces_, faces);
  row(depth_, faces);
  if (sphere) {
    center_->set_point(sphere->center);
    radius_->set_length(sphere->radius);
  } else if (box) {
    center_->set_point(box->center);
    size_->set_point(box->size);
  } else if (cylinder) {
    center_->set_point(cylinder->from);
    end_->set_point(cylinder->to);
    radius_->set_length(cylinder->radius);
  } else if (faces) {
    QStringList names;
    for (const std::int32_t id : faces->ids) names << QString::number(id);
    for (const std::string& name : faces->names) names << QString::fromStdString(name);
    faces_->setText(names.join(", "));
    depth_->set_length(faces->depth);
  }
}

void SizingPage::show_asked(const SizingObject& object) {
  const auto* c = std::get_if<SizeCorrection>(&object.asks);
  for (QWidget* field : std::initializer_list<QWidget*>{asks_, value_, gradation_, directions_}) {
    field->setVisible(c);
    if (QWidget* label = rows_->labelForField(field)) label->setVisible(c);
  }
  zone_->setVisible(!c);
  if (!c) return;
  asks_->setCurrentIndex(c->size ? 0 : 1);
  value_->setSuffix(c->size ? " " + units::name() : QString());
  value_->setPrefix(c->size ? QString() : "× ");
  value_->setValue(c->size ? *c->size / units::per_unit() : c->factor.value_or(1));
  gradation_->setValue(c->gradation);
  directions_->setChecked(c->keep_directions);
}

void SizingPage::show_forecast() { forecast_->setText(forecaster_.description()); }

}  // namespace lamella::ui
