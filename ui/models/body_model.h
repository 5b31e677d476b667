#pragma once

#include <QAbstractTableModel>
#include <QStyledItemDelegate>

#include "core/study/run.h"

namespace lamella::ui {

class Session;

/// The bodies of the study as rows: visible (check mark) and name, n, alpha, h_min, and the layers
/// measured in the mesh of the last run.
/// Edits go to the session as undoable steps.
class BodyModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { name, layers, alpha, h_min, measured, column_count };

  explicit BodyModel(Session& session, QObject* parent = nullptr);

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  /// For h_min an empty text or "auto" means: derived from the size of the body.
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;

 private:
  const BodyOutcome* outcome(int row) const;

  Session& session_;
};

/// Spin boxes with the range and step of each column.
class BodyDelegate : public QStyledItemDelegate {
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
