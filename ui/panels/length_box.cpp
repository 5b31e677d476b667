#include "ui/panels/length_box.h"

#include <cmath>
#include <utility>

#include "ui/units.h"

namespace lamella::ui {
namespace {

constexpr double step_factor = 1.25;

double three_digits(double value) { return QString::number(value, 'g', 3).toDouble(); }

/// What is typed without the name of its unit, and mm that the unit has.
std::pair<QString, double> without_unit(const QString& text) {
  QString number = text.trimmed();
  double unit = units::per_unit();
  // Behind a unit that was typed the box writes its own: the first one counts.
  for (bool found = true; found;) {
    found = false;
    for (const auto& [name, mm] : {std::pair("mm", 1.0), std::pair("in", 25.4)}) {
      if (!number.endsWith(name)) continue;
      number = number.chopped(2).trimmed();
      unit = mm;
      found = true;
    }
  }
  return {number, unit};
}

}  // namespace

LengthBox::LengthBox(QWidget* parent) : QDoubleSpinBox(parent) {
  setDecimals(6);
  setRange(0, 1e6);
  setSuffix(" " + units::name());
  connect(&Units::get(), &Units::changed, this, [this] { setSuffix(" " + units::name()); });
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

QString LengthBox::textFromValue(double value) const {
  return locale().toString(value / units::per_unit(), 'g', 4);
}

double LengthBox::valueFromText(const QString& text) const {
  const auto [number, unit] = without_unit(text);
  bool good = false;
  const double value = locale().toDouble(number, &good);
  return good ? value * unit : 0;
}

QValidator::State LengthBox::validate(QString& text, int&) const {
  const auto [number, unit] = without_unit(text);
  if (number.isEmpty() || text == specialValueText()) return QValidator::Acceptable;
  bool good = false;
  const double value = locale().toDouble(number, &good);
  if (good)
    return value * unit >= minimum() && value * unit <= maximum() ? QValidator::Acceptable
                                                                  : QValidator::Invalid;
  // Something on its way to a number: "1e", "-" excluded.
  for (const QChar c : number)
    if (!c.isDigit() && !QString(".,eE-+min ").contains(c)) return QValidator::Invalid;
  return QValidator::Intermediate;
}

QAbstractSpinBox::StepEnabled LengthBox::stepEnabled() const {
  return StepUpEnabled | StepDownEnabled;
}

CoordinateBox::CoordinateBox(bool direction, QWidget* parent)
    : QDoubleSpinBox(parent), direction_(direction) {
  constexpr int decimals = 8;
  setDecimals(decimals);
  setRange(-1e6, 1e6);
  setKeyboardTracking(false);
  // Setting them shows the value anew.
  connect(&Units::get(), &Units::changed, this, [this] {
    setDecimals(decimals);
    if (!suffix().isEmpty()) setSuffix(" " + units::name());
  });
}

double CoordinateBox::unit() const { return direction_ ? 1 : units::per_unit(); }

QString CoordinateBox::textFromValue(double value) const {
  return locale().toString(value / unit(), 'g', 6);
}

double CoordinateBox::valueFromText(const QString& text) const {
  QString number = text;
  if (number.endsWith(suffix())) number.chop(suffix().size());
  return locale().toDouble(number.trimmed()) * unit();
}

}  // namespace lamella::ui
