#include "ui/panels/length_box.h"

#include <cmath>

namespace lamella::ui {
namespace {

constexpr double step_factor = 1.25;

double three_digits(double value) { return QString::number(value, 'g', 3).toDouble(); }

}  // namespace

LengthBox::LengthBox(QWidget* parent) : QDoubleSpinBox(parent) {
  setDecimals(6);
  setRange(0, 1e6);
  setSuffix(tr(" mm"));
  setKeyboardTracking(false);
  setSpecialValueText(tr("automatic"));
}

std::optional<double> LengthBox::length() const {
  return value() > 0 ? std::optional(value()) : std::nullopt;
}

void LengthBox::set_length(std::optional<double> mm) { setValue(mm.value_or(0)); }

void LengthBox::set_automatic(const QString& text, double start) {
  setSpecialValueText(text);
  start_ = start;
}

void LengthBox::stepBy(int steps) {
  const double from = value() > 0 ? value() : start_;
  setValue(three_digits(from * std::pow(step_factor, steps)));
}

QString LengthBox::textFromValue(double value) const { return locale().toString(value, 'g', 4); }

double LengthBox::valueFromText(const QString& text) const {
  QString number = text;
  if (number.endsWith(suffix())) number.chop(suffix().size());
  bool good = false;
  const double value = locale().toDouble(number.trimmed(), &good);
  return good ? value : 0;
}

QValidator::State LengthBox::validate(QString& text, int&) const {
  QString number = text;
  if (number.endsWith(suffix())) number.chop(suffix().size());
  number = number.trimmed();
  if (number.isEmpty() || text == specialValueText()) return QValidator::Acceptable;
  bool good = false;
  const double value = locale().toDouble(number, &good);
  if (good)
    return value >= minimum() && value <= maximum() ? QValidator::Acceptable : QValidator::Invalid;
  // Something on its way to a number: "1e", "-" excluded.
  for (const QChar c : number)
    if (!c.isDigit() && !QString(".,eE-+m ").contains(c)) return QValidator::Invalid;
  return QValidator::Intermediate;
}

QAbstractSpinBox::StepEnabled LengthBox::stepEnabled() const {
  return StepUpEnabled | StepDownEnabled;
}

}  // namespace lamella::ui
