#pragma once

#include <QWidget>
#include <array>

#include "core/study/record.h"
#include "ui/views/plot.h"

class QLabel;
class QSlider;
class QToolButton;

namespace lamella::ui {

class Session;

/// Nodes, layers, conformity and errors at interfaces over the iterations, live, and the slider
/// that looks back.
class ConvergencePanel : public QWidget {
  Q_OBJECT

 public:
  explicit ConvergencePanel(Session& session, QWidget* parent = nullptr);
  /// Every iteration as a line of comma-separated values, with titles.
  QString csv() const;
  /// Writes the figures, or a picture of the plots, by the ending of the file.
  void save(const QString& file);

 private:
  std::array<Plot*, 5> all_plots() const {
    return {nodes_, layers_, conformity_, quality_, error_};
  }
  std::vector<IterationRecord> records() const;
  void follow_iterations();
  void follow_shown();
  /// The layers of the selected body where they are known apart, else of all.
  void show_layers(Series mean, Series low);

  Session& session_;
  QWidget* plots_;
  Plot* nodes_;
  Plot* layers_;
  Plot* conformity_;
  Plot* quality_;  // of the worst element
  Plot* error_;    // at the borders of one mesh of all bodies
  QSlider* slider_;
  QLabel* position_;
  QToolButton* back_;
  QToolButton* forward_;
};

}  // namespace lamella::ui
