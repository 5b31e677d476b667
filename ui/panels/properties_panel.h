#pragma once

#include <QFrame>
#include <array>

class QLabel;

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
  std::array<QWidget*, 5> pages() const;  // in the order of ItemKind

  Session& session_;
  QWidget* content_;
  QWidget* scroll_;
  QLabel* empty_;
  BodyPage* body_;
  GroupPage* group_;
  SizingPage* sizing_;
  CutPage* cut_;
  DomainPage* domain_;
  MeshPage* mesh_;
};

}  // namespace lamella::ui
