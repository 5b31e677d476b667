#pragma once

#include <QAction>
#include <QFrame>
#include <vector>

class QLineEdit;
class QListWidget;

namespace lamella::ui {

/// A list of actions that narrows as one types; Enter runs the chosen one.
class Palette : public QFrame {
  Q_OBJECT

 public:
  explicit Palette(QWidget* parent);
  /// Opens above the middle of its parent, with the actions that can be run now.
  void open(const std::vector<QAction*>& actions);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void narrow();
  void run();

  std::vector<QAction*> actions_;
  QLineEdit* text_;
  QListWidget* list_;
};

}  // namespace lamella::ui
