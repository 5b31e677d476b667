#pragma once

#include <QFrame>

#include "ui/session/item.h"

class QMenu;
class QTreeView;

namespace lamella::ui {

class Actions;
class Session;
class StudyModel;

/// The study as a tree, with what can be added to it and done to its entries.
class StudyPanel : public QFrame {
  Q_OBJECT

 public:
  StudyPanel(Session& session, Actions& actions, QWidget* parent = nullptr);

 private:
  void make_tree();
  void select_in_session();
  void follow_selection();
  void context_menu(const QPoint& at);
  void fill_body_menu(QMenu& menu);
  void show_bodies(bool only_selected);

  Session& session_;
  Actions& actions_;
  StudyModel* model_;
  QTreeView* tree_ = nullptr;
  bool following_ = false;
};

}  // namespace lamella::ui
