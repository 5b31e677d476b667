#include "ui/units.h"

#include <QLocale>
#include <QSettings>
#include <cmath>

namespace lamella::ui {

Units& Units::get() {
  static Units units;
  return units;
}

Units::Units() : inches_(QSettings().value("inches", false).toBool()) {}

void Units::set_inches(bool on) {
  if (on == inches_) return;
  inches_ = on;
  QSettings().setValue("inches", on);
  Q_EMIT changed();
}

QString written(double value, char format, int digits) {
  QLocale locale;
  locale.setNumberOptions(locale.numberOptions() | QLocale::OmitGroupSeparator);
  return locale.toString(value, format, digits).toLower();  // it writes 1E-07
}

namespace units {

double per_unit() { return Units::get().inches() ? 25.4 : 1; }

QString name() { return Units::get().inches() ? QStringLiteral("in") : QStringLiteral("mm"); }

QString number(double mm, int digits) { return written(mm / per_unit(), 'g', digits); }

QString point(const Vec<3>& mm, int digits) {
  const double none = 1e-6 * mm.cwiseAbs().maxCoeff();
  const auto text = [&](double x) { return number(std::abs(x) < none ? 0 : x, digits); };
  const QString next = QLocale().decimalPoint() == "," ? "; " : ", ";
  return "(" + text(mm[0]) + next + text(mm[1]) + next + text(mm[2]) + ")";
}

QString length(double mm, int digits) { return number(mm, digits) + " " + name(); }

QString size(const Vec<3>& mm, int digits) {
  return QString("%1 × %2 × %3 %4")
      .arg(number(mm[0], digits), number(mm[1], digits), number(mm[2], digits), name());
}

QString area(double mm2, int decimals) {
  const double unit = per_unit() * per_unit();
  return QString("%L1 ").arg(mm2 / unit, 0, 'f', decimals + (unit > 1 ? 2 : 0)) + name() + "²";
}

QString volume(double mm3, int decimals) {
  const double unit = per_unit() * per_unit() * per_unit();
  return QString("%L1 ").arg(mm3 / unit, 0, 'f', decimals + (unit > 1 ? 2 : 0)) + name() + "³";
}

}  // namespace units
}  // namespace lamella::ui
