#pragma once

#include <QFrame>
#include <array>
#include <optional>
#include <utility>

#include "ui/views/scene.h"

class QComboBox;
class QLabel;
class QDoubleSpinBox;
class QSlider;

namespace lamella::ui {

class Actions;

/// The bar above the view: what to color by, tools, and where the cut is.
class ViewBar : public QFrame {
  Q_OBJECT

 public:
  explicit ViewBar(Actions& actions, QWidget* parent = nullptr);

  ColorBy color_by() const;
  void set_color_by(ColorBy color_by);
  /// The one of `show_bodies` that is chosen.
  int body() const;
  /// The bodies whose filling can be shown, and the one that is.
  void show_bodies(const QStringList& names, int current);
  /// Shows where the plane is in the box of the model; nothing hides what is for cuts.
  void show_section(const std::optional<Section>& section, const std::array<double, 6>& bounds);

 Q_SIGNALS:
  void color_changed();
  /// Another body whose filling is to be shown.
  void body_chosen(int body);
  void slide_started();
  /// Places along the normal, mm: by the slider, by a number.
  void slid(double position);
  void moved(double position);

 private:
  QWidget* make_section_bar();

  Actions& actions_;
  QLabel* by_;
  QComboBox* colors_;
  QComboBox* bodies_;
  QWidget* section_bar_;
  QSlider* slider_ = nullptr;
  QDoubleSpinBox* position_ = nullptr;
  std::pair<double, double> range_{0, 1};
};

}  // namespace lamella::ui
