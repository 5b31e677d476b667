#pragma once

#include <QFrame>

class QLabel;
class QStackedWidget;

namespace lamella::ui {

class Actions;
class BodyPage;
class CutPage;
class DomainPage;
class Forecaster;
class GroupPage;
class MeshPage;
class Session;
class SizingPage;

/// What can be set of the selected entry of the study, and how the whole is meshed.
class PropertiesPanel : public QFrame {
  Q_OBJECT

 public:
  PropertiesPanel(Session& session, Forecaster& forecaster, Actions& actions,
                  QWidget* parent = nullptr);

 private:
  void refresh();

  Session& session_;
  QWidget* content_;
  QWidget* scroll_;
  QLabel* empty_;
  QStackedWidget* pages_;
  BodyPage* body_;
  GroupPage* group_;
  SizingPage* sizing_;
  CutPage* cut_;
  DomainPage* domain_;
  MeshPage* mesh_;
};

}  // namespace lamella::ui
