#include "ui/panels/study_panel.h"

#include <QHeaderView>
#include <QMenu>
#include <QToolButton>
#include <QTreeView>
#include <QVBoxLayout>
#include <algorithm>

#include "ui/actions/actions.h"
#include "ui/commands/study_edits.h"
#include "ui/models/study_model.h"
#include "ui/panels/form.h"
#include "ui/session/session.h"
#include "ui/theme.h"

namespace lamella::ui {

StudyPanel::StudyPanel(Session& session, Actions& actions, QWidget* parent)
    : QFrame(parent), session_(session), actions_(actions) {
  setObjectName("panel");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(1, 8, 1, 8);
  layout->setSpacing(4);
  auto* header = new QHBoxLayout;
  header->setContentsMargins(14, 0, 8, 0);
  header->addWidget(styled_label(tr("Study"), "panel_title"), 1);
  auto* add = new QToolButton;
  add->setObjectName("add_entry");
  add->setIcon(icon("add"));
  add->setIconSize(QSize(18, 18));
  add->setAutoRaise(true);
  add->setToolTip(tr("Add a body, a boundary group, a size or a cut"));
  add->setAccessibleName(tr("Add"));
  add->setPopupMode(QToolButton::InstantPopup);
  auto* menu = new QMenu(add);
  for (const Act act :
       {Act::add, Act::zone_ball, Act::zone_box, Act::zone_cylinder, Act::zone_half_space,
        Act::count, Act::add_group, Act::count, Act::correct_near, Act::correct_face,
        Act::add_sphere, Act::add_box, Act::add_cylinder, Act::count, Act::add_cut})
    if (act == Act::count)
      menu->addSeparator();
    else
      menu->addAction(actions[act]);
  add->setMenu(menu);
  header->addWidget(add);
  auto* remove = new QToolButton;
  remove->setDefaultAction(actions[Act::remove]);
  remove->setIconSize(QSize(18, 18));
  remove->setAutoRaise(true);
  header->addWidget(remove);
  layout->addLayout(header);
  model_ = new StudyModel(session, this);
  make_tree();
  layout->addWidget(tree_, 1);

  connect(&session, &Session::parts_changed, this, &StudyPanel::follow_selection);
  connect(&session, &Session::selection_changed, this, &StudyPanel::follow_selection);
  connect(&session, &Session::study_changed, this, &StudyPanel::follow_selection);
  connect(tree_->selectionModel(), &QItemSelectionModel::selectionChanged, this,
          &StudyPanel::select_in_session);
  connect(tree_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &StudyPanel::select_in_session);
  follow_selection();
}

void StudyPanel::make_tree() {
  tree_ = new QTreeView;
  tree_->setObjectName("study");
  tree_->setAccessibleName(tr("Study"));
  tree_->setModel(model_);
  tree_->setItemDelegate(new StudyDelegate(tree_));
  tree_->setIndentation(12);
  tree_->setRootIsDecorated(false);
  tree_->setItemsExpandable(false);
  tree_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  tree_->setAllColumnsShowFocus(true);
  tree_->setTextElideMode(Qt::ElideMiddle);  // names of an assembly often begin alike
  tree_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed);
  tree_->setContextMenuPolicy(Qt::CustomContextMenu);
  tree_->header()->setStretchLastSection(false);
  tree_->header()->setMinimumSectionSize(40);
  tree_->header()->setSectionResizeMode(StudyModel::name, QHeaderView::Stretch);
  const int title =
      tree_->header()->fontMetrics().horizontalAdvance(
          model_->headerData(StudyModel::measured, Qt::Horizontal, Qt::DisplayRole).toString()) +
      14;  // padding of the style
  tree_->header()->setSectionResizeMode(StudyModel::value, QHeaderView::ResizeToContents);
  tree_->header()->setSectionResizeMode(StudyModel::measured, QHeaderView::Fixed);
  tree_->setColumnWidth(StudyModel::measured, std::max(46, title));
  // Most studies have no domain: its row comes with it.
  const auto expand = [this] {
    tree_->expandAll();
    const QModelIndex domain = model_->section(ItemKind::domain);
    tree_->setRowHidden(domain.row(), {}, model_->rowCount(domain) == 0);
  };
  tree_->ensurePolished();  // or rows are laid out without the height that the style gives them
  expand();
  connect(model_, &QAbstractItemModel::modelReset, this, expand);
  connect(model_, &QAbstractItemModel::rowsInserted, this, expand);
  connect(model_, &QAbstractItemModel::rowsRemoved, this, expand);
  connect(tree_, &QWidget::customContextMenuRequested, this, &StudyPanel::context_menu);
}

void StudyPanel::select_in_session() {
  if (following_) return;
  const Item current = StudyModel::item_at(tree_->currentIndex());
  if (!tree_->currentIndex().isValid()) return;
  std::vector<int> bodies;
  for (const QModelIndex& index : tree_->selectionModel()->selectedRows())
    if (const Item item = StudyModel::item_at(index);
        item.kind == ItemKind::body && item.index >= 0)
      bodies.push_back(item.index);
  if (current.kind != ItemKind::body && current.index >= 0) {
    session_.select_item(current);
  } else if (!bodies.empty()) {
    session_.select(std::move(bodies), current.kind == ItemKind::body ? current.index : -1);
  }
}

void StudyPanel::follow_selection() {
  following_ = true;
  const Item item = session_.item();
  QItemSelection rows;
  const auto choose = [&](const Item& i) {
    const QModelIndex first = model_->index_of(i);
    if (first.isValid()) rows.select(first, first.siblingAtColumn(StudyModel::column_count - 1));
  };
  if (item.kind == ItemKind::body) {
    for (const int row : session_.selection()) choose({ItemKind::body, row});
  } else {
    choose(item);
  }
  tree_->selectionModel()->select(rows, QItemSelectionModel::ClearAndSelect);
  if (const QModelIndex current = model_->index_of(item); current.isValid())
    tree_->selectionModel()->setCurrentIndex(current, QItemSelectionModel::NoUpdate);
  following_ = false;
}

void StudyPanel::show_bodies(bool only_selected) {
  if (!only_selected) return show_all_bodies(session_);
  Study study = session_.study();
  const auto& chosen = session_.selection();
  for (std::size_t k = 0; k < study.bodies.size(); ++k)
    study.bodies[k].visible = std::find(chosen.begin(), chosen.end(), int(k)) != chosen.end();
  session_.edit(tr("Show only the selection"), std::move(study));
}

void StudyPanel::fill_body_menu(QMenu& menu) {
  menu.addAction(tr("Show only this"), this, [this] { show_bodies(true); });
  menu.addAction(tr("Show all bodies"), this, [this] { show_bodies(false); });
  menu.addSeparator();
  menu.addAction(actions_[Act::add]);
  menu.addAction(actions_[Act::remove]);
}

void StudyPanel::context_menu(const QPoint& at) {
  const QModelIndex index = tree_->indexAt(at);
  if (!index.isValid()) return;
  const Item item = StudyModel::item_at(index);
  QMenu menu(this);
  const auto rename = [&] {
    menu.addAction(tr("Rename"), this,
                   [this, item] { tree_->edit(model_->index_of(item, StudyModel::name)); });
  };
  switch (item.kind) {
    case ItemKind::body:
      if (item.index >= 0)
        fill_body_menu(menu);
      else
        for (const Act act :
             {Act::add, Act::zone_ball, Act::zone_box, Act::zone_cylinder, Act::zone_half_space})
          menu.addAction(actions_[act]);
      break;
    case ItemKind::group:
      menu.addAction(actions_[Act::add_group]);
      if (item.index < 0) break;
      menu.addAction(actions_[Act::pick_faces]);
      menu.addAction(actions_[Act::pick_flood]);
      rename();
      menu.addAction(actions_[Act::remove]);
      break;
    case ItemKind::sizing:
      for (const Act act :
           {Act::correct_near, Act::correct_face, Act::add_sphere, Act::add_box, Act::add_cylinder})
        menu.addAction(actions_[act]);
      if (item.index < 0) break;
      menu.addSeparator();
      rename();
      menu.addAction(actions_[Act::remove]);
      break;
    case ItemKind::cut:
      menu.addAction(actions_[Act::add_cut]);
      if (item.index < 0) break;
      menu.addAction(actions_[Act::flip]);
      rename();
      menu.addAction(actions_[Act::remove]);
      break;
    case ItemKind::domain:
      menu.addAction(actions_[Act::overlaps]);
      menu.addAction(actions_[Act::remove]);
      break;
  }
  menu.exec(tree_->viewport()->mapToGlobal(at));
}

}  // namespace lamella::ui
