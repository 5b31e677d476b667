#pragma once

#include <QWidget>

#include "core/study/group.h"

class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QLabel;
class QLineEdit;
class QListWidget;
class QPushButton;
class QToolButton;

namespace lamella {
struct Part;
}

namespace lamella::ui {

class Actions;
class Session;

/// Properties of the selected boundary group: name, kind, and the faces it is made of.
class GroupPage : public QWidget {
  Q_OBJECT

 public:
  GroupPage(Session& session, Actions& actions, QWidget* parent = nullptr);
  void refresh();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  const BoundaryGroup* group() const;
  void remove_chosen();
  /// The names that faces of the part have, to choose from.
  void show_names(const Part* part);

  Session& session_;
  QToolButton* by_name_;
  QPushButton* correct_;
  std::string part_;  // of the names
  QLineEdit* name_;
  QComboBox* kind_;
  QComboBox* given_;
  QDoubleSpinBox* value_;
  QFormLayout* rows_;
  QLabel* body_;
  QLabel* area_;
  QDoubleSpinBox* angle_;
  QListWidget* faces_;
};

}  // namespace lamella::ui
