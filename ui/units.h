#pragma once

#include <QObject>
#include <QString>

#include "core/geometry/simplex.h"

namespace lamella::ui {

/// In what lengths are shown and entered. Everything is held in mm; only what people see changes.
class Units : public QObject {
  Q_OBJECT

 public:
  static Units& get();
  bool inches() const { return inches_; }
  /// Remembered for the next start.
  void set_inches(bool on);

 Q_SIGNALS:
  void changed();

 private:
  Units();
  bool inches_ = false;
};

/// A number as the language writes it, without groups of digits; `format` and `digits` as in
/// QString::number.
QString written(double value, char format = 'g', int digits = 4);

namespace units {

/// mm that one unit has: 1 or 25.4.
double per_unit();
/// "mm" or "in".
QString name();
/// A length in the unit, without its name, and with it: `digits` significant ones.
QString number(double mm, int digits = 4);
QString length(double mm, int digits = 4);
/// "(x, y, z)" without the unit, with semicolons where numbers have commas; what is nothing beside
/// the largest of them is 0.
QString point(const Vec<3>& mm, int digits = 4);
/// "40 × 30 × 2 mm"
QString size(const Vec<3>& mm, int digits = 4);
/// From mm² and mm³, to `decimals` places (of mm; two more of inches), with the unit.
QString area(double mm2, int decimals = 2);
QString volume(double mm3, int decimals = 1);

}  // namespace units
}  // namespace lamella::ui
