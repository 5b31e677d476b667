#pragma once

#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QSpinBox>
#include <QToolButton>
#include <array>

#include "core/geometry/simplex.h"
#include "ui/panels/length_box.h"

namespace lamella::ui {

/// A label whose looks the style sheet has under `kind`: panel_title, section_title, soft, faint.
QLabel* styled_label(const QString& text, const char* kind);
QSpinBox* integer_box(int low, int high, const char* name, const QString& tip);
QDoubleSpinBox* number_box(double low, double high, double step, const char* name,
                           const QString& tip);
LengthBox* length_box(const char* name, const QString& tip);

/// A tip with a small picture, resources/icons/NAME.svg, above its text.
QString pictured_tip(const char* name, const QString& text);

/// Rows whose labels have the same width in every group, so that the boxes line up.
class Form : public QFormLayout {
 public:
  Form();
  void add(const QString& text, QWidget* field);
};

/// A title that unfolds what is below it; folded at first.
class Folded : public QWidget {
  Q_OBJECT

 public:
  explicit Folded(const QString& title, QWidget* parent = nullptr);
  Form* form() { return form_; }
  void set_open(bool open) { button_->setChecked(open); }

 private:
  QToolButton* button_;
  QWidget* content_;
  Form* form_;
};

/// Three coordinates, mm, or with `direction` three parts of one.
class PointBox : public QWidget {
  Q_OBJECT

 public:
  PointBox(const char* name, const QString& tip, bool direction = false, QWidget* parent = nullptr);
  Vec<3> point() const;
  /// Does not tell `edited`.
  void set_point(const Vec<3>& point);
  void set_minimum(double least);

 Q_SIGNALS:
  void edited();

 private:
  std::array<QDoubleSpinBox*, 3> boxes_;
};

}  // namespace lamella::ui
