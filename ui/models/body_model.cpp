#include "ui/models/body_model.h"

#include <QDoubleSpinBox>
#include <QIcon>
#include <QPainter>
#include <QPixmap>

#include "ui/session/session.h"
#include "ui/theme.h"

namespace lamella::ui {
namespace {

QIcon swatch(const QColor& color) {
  QPixmap pixmap(14, 14);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(color.darker(130), 1));
  painter.setBrush(color);
  painter.drawRoundedRect(QRectF(1.5, 1.5, 11, 11), 3, 3);
  // The same when selected: a style would tint it.
  QIcon icon(pixmap);
  icon.addPixmap(pixmap, QIcon::Selected);
  return icon;
}

}  // namespace

BodyModel::BodyModel(Session& session, QObject* parent)
    : QAbstractTableModel(parent), session_(session) {
  connect(&session, &Session::parts_changed, this, [this] {
    beginResetModel();
    endResetModel();
  });
  const auto refresh = [this] {
    if (rowCount() > 0) Q_EMIT dataChanged(index(0, 0), index(rowCount() - 1, column_count - 1));
  };
  connect(&session, &Session::study_changed, this, refresh);
  connect(&session, &Session::run_finished, this, refresh);
  connect(&session, &Session::iterations_changed, this, refresh);
}

const BodyOutcome* BodyModel::outcome(int row) const {
  if (!session_.outcome()) return nullptr;
  for (const BodyOutcome& body : session_.outcome()->bodies)
    if (body.name == session_.body(row).name) return &body;
  return nullptr;
}

int BodyModel::rowCount(const QModelIndex& parent) const {
  // Between a new study and the reset the two lists may differ for a moment.
  return parent.isValid()
             ? 0
             : static_cast<int>(std::min(session_.parts().size(), session_.study().bodies.size()));
}

int BodyModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : column_count;
}

QVariant BodyModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const BodySettings& body = session_.body(index.row());
  const Part& part = session_.parts()[index.row()];
  if (role == Qt::TextAlignmentRole && index.column() != name)
    return static_cast<int>(Qt::AlignRight | Qt::AlignVCenter);
  switch (index.column()) {
    case name:
      if (role == Qt::DisplayRole) return QString::fromStdString(body.name);
      if (role == Qt::CheckStateRole) return body.visible ? Qt::Checked : Qt::Unchecked;
      if (role == Qt::DecorationRole) return swatch(body_color(index.row(), part.color));
      if (role == Qt::ToolTipRole)
        return tr("%1\nThe eye shows or hides the body; hidden bodies are meshed too.")
            .arg(QString::fromStdString(body.name));
      break;
    case layers:
      if (role == Qt::DisplayRole || role == Qt::EditRole) return body.layers;
      if (role == Qt::ToolTipRole) return tr("Element layers through the wall thickness");
      break;
    case alpha:
      if (role == Qt::DisplayRole) return QString::number(body.alpha, 'g', 3);
      if (role == Qt::EditRole) return body.alpha;
      if (role == Qt::ToolTipRole)
        return tr("Directions up to (1 + α) times the wall thickness are divided too");
      break;
    case h_min:
      if (role == Qt::DisplayRole)
        return body.h_min ? QString::number(*body.h_min, 'g', 3) : tr("auto");
      if (role == Qt::EditRole) return body.h_min.value_or(0.0);
      if (role == Qt::ForegroundRole && !body.h_min) return theme::faint_text;
      if (role == Qt::ToolTipRole)
        return tr("Smallest element size in mm; auto: 1/1000 of the body's diagonal");
      break;
    case measured: {
      const BodyOutcome* made = outcome(index.row());
      const bool any = made && made->layers.places > 0;
      if (role == Qt::DisplayRole) return any ? QString::number(made->layers.mean, 'f', 1) : "–";
      if (role == Qt::ForegroundRole)
        return !any                                     ? theme::faint_text
               : made->layers.mean < made->layers_asked ? theme::warning
                                                        : theme::good;
      if (role == Qt::ToolTipRole)
        return any ? tr("Layers measured in the mesh: %1 on average, 5 % of the walls below %2")
                         .arg(made->layers.mean, 0, 'f', 2)
                         .arg(made->layers.p5, 0, 'f', 2)
                   : tr("Layers measured in the mesh, once there is one");
      break;
    }
    default:
      break;
  }
  return {};
}

QVariant BodyModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal) return {};
  if (role == Qt::TextAlignmentRole)
    return static_cast<int>((section == name ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter);
  if (role != Qt::DisplayRole) return {};
  switch (section) {
    case name:
      return tr("Body");
    case layers:
      return tr("n");
    case alpha:
      return tr("α");
    case h_min:
      return tr("h min");
    case measured:
      return tr("measured");
    default:
      return {};
  }
}

Qt::ItemFlags BodyModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  if (index.column() == measured) return flags;
  return flags | (index.column() == name ? Qt::ItemIsUserCheckable : Qt::ItemIsEditable);
}

bool BodyModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (!index.isValid() || index.row() >= rowCount()) return false;
  BodySettings body = session_.body(index.row());
  QString what;
  if (index.column() == name && role == Qt::CheckStateRole) {
    body.visible = value.toInt() == Qt::Checked;
    what = body.visible ? tr("Show %1") : tr("Hide %1");
  } else if (role != Qt::EditRole) {
    return false;
  } else if (index.column() == layers) {
    const int n = value.toInt();
    if (n < 1 || n == body.layers) return false;
    body.layers = n;
    what = tr("Layers of %1");
  } else if (index.column() == alpha) {
    const double a = value.toDouble();
    if (a <= 0 || a == body.alpha) return false;
    body.alpha = a;
    what = tr("α of %1");
  } else if (index.column() == h_min) {
    const double h = value.toDouble();
    const std::optional<double> next = h > 0 ? std::optional(h) : std::nullopt;
    if (next == body.h_min) return false;
    body.h_min = next;
    what = tr("Smallest size of %1");
  } else {
    return false;
  }
  session_.edit_body(index.row(), what.arg(QString::fromStdString(body.name)), body);
  return true;
}

QWidget* BodyDelegate::createEditor(QWidget* parent, const QStyleOptionViewItem&,
                                    const QModelIndex& index) const {
  if (index.column() == BodyModel::layers) {
    auto* spin = new QSpinBox(parent);
    spin->setRange(1, 64);
    spin->setFrame(false);
    return spin;
  }
  auto* spin = new QDoubleSpinBox(parent);
  spin->setFrame(false);
  if (index.column() == BodyModel::alpha) {
    spin->setRange(0.1, 20);
    spin->setSingleStep(0.25);
    spin->setDecimals(2);
  } else {
    spin->setRange(0, 1000);
    spin->setDecimals(4);
    spin->setSingleStep(0.01);
    spin->setSpecialValueText(tr("auto"));
  }
  return spin;
}

void BodyDelegate::setEditorData(QWidget* editor, const QModelIndex& index) const {
  if (auto* integer = qobject_cast<QSpinBox*>(editor))
    integer->setValue(index.data(Qt::EditRole).toInt());
  else if (auto* real = qobject_cast<QDoubleSpinBox*>(editor))
    real->setValue(index.data(Qt::EditRole).toDouble());
}

void BodyDelegate::setModelData(QWidget* editor, QAbstractItemModel* model,
                                const QModelIndex& index) const {
  if (auto* integer = qobject_cast<QSpinBox*>(editor)) {
    integer->interpretText();
    model->setData(index, integer->value(), Qt::EditRole);
  } else if (auto* real = qobject_cast<QDoubleSpinBox*>(editor)) {
    real->interpretText();
    model->setData(index, real->value(), Qt::EditRole);
  }
}

}  // namespace lamella::ui
