#include "ui/panels/form.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

#include "ui/theme.h"

namespace lamella::ui {
namespace {

/// Numbers without zeros at their end.
class PlainNumberBox : public QDoubleSpinBox {
 public:
  using QDoubleSpinBox::QDoubleSpinBox;
  QString textFromValue(double value) const override {
    return locale().toString(value, 'f', QLocale::FloatingPointShortest);
  }
};

}  // namespace

QLabel* styled_label(const QString& text, const char* kind) {
  auto* l = new QLabel(text);
  l->setObjectName(kind);
  return l;
}

QSpinBox* integer_box(int low, int high, const char* name, const QString& tip) {
  auto* box = new QSpinBox;
  box->setObjectName(name);
  box->setRange(low, high);
  box->setKeyboardTracking(false);
  box->setToolTip(tip);
  return box;
}

QDoubleSpinBox* number_box(double low, double high, double step, const char* name,
                           const QString& tip) {
  auto* box = new PlainNumberBox;
  box->setObjectName(name);
  box->setRange(low, high);
  box->setSingleStep(step);
  box->setKeyboardTracking(false);
  box->setToolTip(tip);
  return box;
}

LengthBox* length_box(const char* name, const QString& tip) {
  auto* box = new LengthBox;
  box->setObjectName(name);
  box->setToolTip(tip);
  return box;
}

QString pictured_tip(const char* name, const QString& text) {
  return QString("<img src=':/icons/%1.svg' width='200' height='90'/><br>%2")
      .arg(name, text.toHtmlEscaped().replace('\n', ' '));
}

Form::Form() {
  setHorizontalSpacing(8);
  setVerticalSpacing(7);
  setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
}

void Form::add(const QString& text, QWidget* field) {
  auto* l = new QLabel(text);
  l->setMinimumWidth(110);
  l->setToolTip(field->toolTip());
  l->setBuddy(field);
  field->setAccessibleName(text);
  // Boxes ask for the width of their longest text, which the panel has not.
  field->setSizePolicy(QSizePolicy::Ignored, field->sizePolicy().verticalPolicy());
  field->setMinimumWidth(80);
  addRow(l, field);
}

Folded::Folded(const QString& title, QWidget* parent) : QWidget(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  button_ = new QToolButton;
  button_->setObjectName("fold");
  button_->setText(title);
  button_->setIcon(icon("chevron-right"));
  button_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  button_->setCheckable(true);
  button_->setAutoRaise(true);
  content_ = new QWidget;
  form_ = new Form;
  content_->setLayout(form_);
  form_->setContentsMargins(0, 0, 0, 0);
  content_->hide();
  layout->addWidget(button_);
  layout->addWidget(content_);
  connect(button_, &QToolButton::toggled, this, [this](bool open) {
    content_->setVisible(open);
    button_->setIcon(icon(open ? "chevron-down" : "chevron-right"));
  });
}

PointBox::PointBox(const char* name, const QString& tip, bool direction, QWidget* parent)
    : QWidget(parent) {
  setObjectName(name);
  setToolTip(tip);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(2);
  const char* const axes[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    auto* box = new CoordinateBox(direction);
    box->setObjectName("coordinate");
    box->setSingleStep(0.5);
    box->setToolTip(tip);
    box->setButtonSymbols(QAbstractSpinBox::NoButtons);
    box->setAccessibleName(axes[k]);
    box->setMinimumWidth(30);
    box->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
    connect(box, &QDoubleSpinBox::valueChanged, this, &PointBox::edited);
    row->addWidget(box, 1);
    boxes_[k] = box;
  }
}

Vec<3> PointBox::point() const {
  return {boxes_[0]->value(), boxes_[1]->value(), boxes_[2]->value()};
}

void PointBox::set_point(const Vec<3>& point) {
  for (std::size_t k = 0; k < 3; ++k) {
    const QSignalBlocker block(boxes_[k]);
    boxes_[k]->setValue(point[static_cast<int>(k)]);
  }
}

void PointBox::set_minimum(double least) {
  for (QDoubleSpinBox* box : boxes_) box->setMinimum(least);
}

}  // namespace lamella::ui
