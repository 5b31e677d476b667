#pragma once

#include <QWidget>

class QLabel;

namespace lamella::ui {

class Session;

/// What the domain of one mesh of all bodies is.
class DomainPage : public QWidget {
  Q_OBJECT

 public:
  explicit DomainPage(Session& session, QWidget* parent = nullptr);
  void refresh();

 private:
  Session& session_;
  QLabel* details_;
};

}  // namespace lamella::ui
