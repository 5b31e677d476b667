#pragma once

#include <QAbstractItemModel>
#include <QStyledItemDelegate>

#include "core/study/run.h"
#include "ui/session/item.h"

namespace lamella::ui {

class Session;

/// The study as a tree of two floors: bodies, groups, sizes, cuts and the domain, each with its
/// entries.
/// Visibility, layers and names can be edited.
class StudyModel : public QAbstractItemModel {
  Q_OBJECT

 public:
  enum Column { name, value, measured, column_count };

  explicit StudyModel(Session& session, QObject* parent = nullptr);

  /// The row of a list of the study.
  QModelIndex section(ItemKind kind) const;
  QModelIndex index_of(const Item& item, int column = name) const;
  /// The entry of an index; index -1 for the row of a list itself.
  static Item item_at(const QModelIndex& index);

  QModelIndex index(int row, int column, const QModelIndex& parent = {}) const override;
  QModelIndex parent(const QModelIndex& index) const override;
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role = Qt::EditRole) override;

 private:
  void follow_study();
  int entries(ItemKind kind) const;
  QVariant section_data(ItemKind kind, int column, int role) const;
  QVariant body_data(int row, int column, int role) const;
  QVariant group_data(int row, int column, int role) const;
  QVariant sizing_data(int row, int column, int role) const;
  QVariant cut_data(int row, int column, int role) const;
  QVariant domain_data(int column, int role) const;
  const BodyOutcome* outcome(int row) const;

  Session& session_;
  std::array<int, 5> counts_{};  // as the views know them
};

/// Editors of StudyModel's cells.
class StudyDelegate : public QStyledItemDelegate {
  Q_OBJECT

 public:
  using QStyledItemDelegate::QStyledItemDelegate;
  QWidget* createEditor(QWidget* parent, const QStyleOptionViewItem& option,
                        const QModelIndex& index) const override;
  void setEditorData(QWidget* editor, const QModelIndex& index) const override;
  void setModelData(QWidget* editor, QAbstractItemModel* model,
                    const QModelIndex& index) const override;
};

}  // namespace lamella::ui
