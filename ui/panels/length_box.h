#pragma once

#include <QDoubleSpinBox>
#include <optional>

namespace lamella::ui {

/// A length in mm, or nothing: then the program chooses, and the box says what. Shown and typed in
/// the unit that was chosen, or with "mm" or "in" behind it in either.
///
/// An empty text or 0 means nothing; the arrows change the length by a share of itself.
class LengthBox : public QDoubleSpinBox {
  Q_OBJECT

 public:
  explicit LengthBox(QWidget* parent = nullptr);

  std::optional<double> length() const;
  void set_length(std::optional<double> mm);
  /// `text` is shown when there is no length; `start` (mm) is where the arrows begin then.
  void set_automatic(const QString& text, double start);

  void stepBy(int steps) override;
  QString textFromValue(double value) const override;
  double valueFromText(const QString& text) const override;
  QValidator::State validate(QString& text, int& position) const override;

 protected:
  StepEnabled stepEnabled() const override;

 private:
  double start_ = 1;
};

/// A coordinate in mm, shown and typed in the unit that was chosen, without zeros at its end; or a
/// part of a direction, which has none.
class CoordinateBox : public QDoubleSpinBox {
  Q_OBJECT

 public:
  explicit CoordinateBox(bool direction = false, QWidget* parent = nullptr);
  QString textFromValue(double value) const override;
  double valueFromText(const QString& text) const override;

 private:
  double unit() const;

  bool direction_;
};

}  // namespace lamella::ui
