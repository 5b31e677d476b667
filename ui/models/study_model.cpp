#include "ui/models/study_model.h"

#include <QApplication>
#include <QFont>
#include <QIcon>
#include <QPainter>
#include <QPixmap>
#include <QSpinBox>
#include <algorithm>

#include "ui/commands/study_edits.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/units.h"

namespace lamella::ui {
namespace {

constexpr int sections = 5;

QString text(const std::string& s) { return QString::fromStdString(s); }

QIcon swatch(const QColor& color, bool round) {
  const double ratio = qApp->devicePixelRatio();
  QPixmap pixmap(QSize(14, 14) * ratio);
  pixmap.setDevicePixelRatio(ratio);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(color.darker(130), 1));
  painter.setBrush(color);
  const double radius = round ? 6 : 3;
  painter.drawRoundedRect(QRectF(1.5, 1.5, 11, 11), radius, radius);
  // The same when selected: a style would tint it.
  QIcon icon(pixmap);
  icon.addPixmap(pixmap, QIcon::Selected);
  return icon;
}

}  // namespace

StudyModel::StudyModel(Session& session, QObject* parent)
    : QAbstractItemModel(parent), session_(session) {
  connect(&session, &Session::parts_changed, this, [this] {
    beginResetModel();
    for (int k = 0; k < sections; ++k) counts_[std::size_t(k)] = entries(ItemKind(k));
    endResetModel();
  });
  connect(&session, &Session::study_changed, this, &StudyModel::follow_study);
  connect(&session, &Session::run_finished, this, &StudyModel::follow_study);
  connect(&session, &Session::iterations_changed, this, &StudyModel::follow_study);
}

int StudyModel::entries(ItemKind kind) const {
  const Study& study = session_.study();
  switch (kind) {
    case ItemKind::body:
      return static_cast<int>(study.bodies.size());
    case ItemKind::group:
      return static_cast<int>(study.groups.size());
    case ItemKind::sizing:
      return static_cast<int>(study.sizing.size());
    case ItemKind::cut:
      return static_cast<int>(study.cuts.size());
    case ItemKind::domain:
      return study.domain ? 1 : 0;
  }
  return 0;
}

void StudyModel::follow_study() {
  for (int k = 0; k < sections; ++k) {
    const QModelIndex parent = section(ItemKind(k));
    int& known = counts_[std::size_t(k)];
    const int now = entries(ItemKind(k));
    if (now > known) {
      beginInsertRows(parent, known, now - 1);
      known = now;
      endInsertRows();
    } else if (now < known) {
      beginRemoveRows(parent, now, known - 1);
      known = now;
      endRemoveRows();
    }
    if (known > 0)
      Q_EMIT dataChanged(index(0, 0, parent), index(known - 1, column_count - 1, parent));
    Q_EMIT dataChanged(parent, parent.siblingAtColumn(column_count - 1));
  }
}

QModelIndex StudyModel::section(ItemKind kind) const {
  return createIndex(static_cast<int>(kind), 0, quintptr(0));
}

QModelIndex StudyModel::index_of(const Item& item, int column) const {
  if (item.index < 0) return {};
  return index(item.index, column, section(item.kind));
}

Item StudyModel::item_at(const QModelIndex& index) {
  if (index.internalId() == 0) return {ItemKind(index.row()), -1};
  return {ItemKind(index.internalId() - 1), index.row()};
}

QModelIndex StudyModel::index(int row, int column, const QModelIndex& parent) const {
  if (row < 0 || column < 0 || column >= column_count || row >= rowCount(parent)) return {};
  return createIndex(row, column, parent.isValid() ? quintptr(parent.row() + 1) : quintptr(0));
}

QModelIndex StudyModel::parent(const QModelIndex& index) const {
  if (!index.isValid() || index.internalId() == 0) return {};
  return section(ItemKind(index.internalId() - 1));
}

int StudyModel::rowCount(const QModelIndex& parent) const {
  if (!parent.isValid()) return sections;
  if (parent.internalId() != 0 || parent.column() != 0) return 0;
  return counts_[std::size_t(parent.row())];
}

int StudyModel::columnCount(const QModelIndex&) const { return column_count; }

const BodyOutcome* StudyModel::outcome(int row) const {
  if (!session_.outcome()) return nullptr;
  for (const BodyOutcome& body : session_.outcome()->bodies)
    if (body.name == session_.body(row).name) return &body;
  return nullptr;
}

QVariant StudyModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const Item item = item_at(index);
  if (role == Qt::TextAlignmentRole && index.column() != name)
    return static_cast<int>(Qt::AlignRight | Qt::AlignVCenter);
  if (item.index < 0) return section_data(item.kind, index.column(), role);
  if (item.index >= entries(item.kind)) return {};
  switch (item.kind) {
    case ItemKind::body:
      return body_data(item.index, index.column(), role);
    case ItemKind::group:
      return group_data(item.index, index.column(), role);
    case ItemKind::sizing:
      return sizing_data(item.index, index.column(), role);
    case ItemKind::cut:
      return cut_data(item.index, index.column(), role);
    case ItemKind::domain:
      return domain_data(index.column(), role);
  }
  return {};
}

QVariant StudyModel::section_data(ItemKind kind, int column, int role) const {
  if (role == Qt::ForegroundRole) return theme::soft_text;
  if (role == Qt::FontRole) {
    QFont font;
    font.setWeight(QFont::DemiBold);
    return font;
  }
  if (column != name) return {};
  if (role == Qt::DisplayRole) {
    const QString titles[] = {tr("Bodies"), tr("Groups"), tr("Sizes"), tr("Cuts"), tr("Domain")};
    return titles[int(kind)];
  }
  if (role == Qt::ToolTipRole) {
    const QString tips[] = {tr("What is meshed, each body with its own settings"),
                            tr("Named parts of the boundary (gate, vent, symmetry): they go with\n"
                               "the mesh into the solver"),
                            tr("Places with a size of their own, such as the region of a gate"),
                            tr("Planes that cut the model open to look inside"),
                            tr("What one mesh of all bodies fills")};
    return tips[int(kind)];
  }
  return {};
}

QVariant StudyModel::body_data(int row, int column, int role) const {
  const BodySettings& body = session_.body(row);
  if (column == name) {
    if (role == Qt::DisplayRole)
      return body.role == BodyRole::none ? text(body.name)
                                         : text(body.name) + " · " + role_title(body.role);
    if (role == Qt::CheckStateRole) return body.visible ? Qt::Checked : Qt::Unchecked;
    if (role == Qt::DecorationRole) return swatch(session_.color_of(row), false);
    if (role == Qt::FontRole && !session_.is_part(row)) {
      QFont font;
      font.setItalic(true);
      return font;
    }
    if (role == Qt::ToolTipRole)
      return session_.is_part(row)
                 ? tr("%1\nThe eye shows or hides the body; hidden bodies are meshed too.")
                       .arg(text(body.name))
             : session_.is_zone(row)
                 ? tr("%1, a body without a file: its shape is a formula.\n"
                      "It is meshed in one mesh of all bodies.")
                       .arg(text(body.name))
                 : tr("What is around the bodies in the domain: it is meshed with them.\n"
                      "The eye shows it.");
  } else if (column == value) {
    if (role == Qt::DisplayRole) return tr("n %1").arg(body.layers);
    if (role == Qt::EditRole) return body.layers;
    if (role == Qt::ToolTipRole) return tr("Element layers through the wall thickness");
  } else {
    const BodyOutcome* made = outcome(row);
    const bool any = made && made->layers.places > 0;
    if (role == Qt::DisplayRole) return any ? written(made->layers.mean, 'f', 1) : "–";
    if (role == Qt::ForegroundRole)
      return !any                                     ? theme::faint_text
             : made->layers.mean < made->layers_asked ? theme::warning
                                                      : theme::good;
    if (role == Qt::ToolTipRole)
      return any ? tr("Layers measured in the mesh: %1 on average, 5 % of the walls below %2")
                       .arg(written(made->layers.mean, 'f', 2))
                       .arg(written(made->layers.p5, 'f', 2))
                 : tr("Layers measured in the mesh, once there is one");
  }
  return {};
}

QVariant StudyModel::group_data(int row, int column, int role) const {
  const BoundaryGroup& group = session_.study().groups[std::size_t(row)];
  if (column == name) {
    if (role == Qt::DisplayRole || role == Qt::EditRole) return text(group.name);
    if (role == Qt::DecorationRole) return swatch(group_color(row), true);
    if (role == Qt::ToolTipRole)
      return group.body.empty() ? text(group.name)
                                : tr("%1 on %2").arg(text(group.name), text(group.body));
  } else if (column == value && role == Qt::DisplayRole) {
    const auto count = group.faces.size() + group.face_names.size() + group.floods.size();
    return count == 1 ? tr("1 face") : tr("%1 faces").arg(count);
  }
  return {};
}

QVariant StudyModel::sizing_data(int row, int column, int role) const {
  const SizingObject& object = session_.study().sizing[std::size_t(row)];
  if (column == name) {
    if (role == Qt::DisplayRole || role == Qt::EditRole) return text(object.name);
    if (role == Qt::DecorationRole) return swatch(theme::accent, true);
    if (role == Qt::ToolTipRole)
      return object.body.empty() ? tr("%1\nfor all bodies").arg(text(object.name))
                                 : tr("%1\nfor %2").arg(text(object.name), text(object.body));
  } else if (column == value && (role == Qt::DisplayRole || role == Qt::ToolTipRole)) {
    if (const auto* zone = std::get_if<AnalyticZone>(&object.asks))
      return units::length(zone->sizes.minCoeff(), 3);
    if (const auto* layer = std::get_if<BoundaryLayer>(&object.asks))
      return QString("%1 × %2").arg(layer->layers).arg(units::length(layer->thickness, 3));
    const auto& asked = std::get<SizeCorrection>(object.asks);
    return asked.size ? units::length(*asked.size, 3)
                      : tr("× %1").arg(written(asked.factor.value_or(1), 'g', 3));
  }
  return {};
}

QVariant StudyModel::cut_data(int row, int column, int role) const {
  const CutPlane& cut = session_.study().cuts[std::size_t(row)];
  if (column != name) return {};
  if (role == Qt::DisplayRole || role == Qt::EditRole) return text(cut.name);
  if (role == Qt::CheckStateRole) return cut.on ? Qt::Checked : Qt::Unchecked;
  if (role == Qt::ToolTipRole) return tr("The eye turns the cut on and off");
  return {};
}

QVariant StudyModel::domain_data(int column, int role) const {
  const Study& study = session_.study();
  if (role == Qt::ToolTipRole)
    return tr(
        "One mesh fills it and carries all bodies.\nThe mesh's properties have its settings.");
  if (role != Qt::DisplayRole) return {};
  if (column == name) return domain_title(*study.domain);
  if (column == value)
    return study.options.interfaces == Interfaces::fuzzy ? tr("fuzzy") : tr("exact");
  return {};
}

QVariant StudyModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal) return {};
  if (role == Qt::TextAlignmentRole)
    return static_cast<int>((section == name ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter);
  if (role != Qt::DisplayRole) return {};
  const QString titles[] = {tr("Name"), tr("asked"), tr("is")};
  return titles[section];
}

Qt::ItemFlags StudyModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags flags = QAbstractItemModel::flags(index);
  const Item item = item_at(index);
  if (item.index < 0) return Qt::ItemIsEnabled;
  const bool checkable = item.kind == ItemKind::body || item.kind == ItemKind::cut;
  if (index.column() == name && checkable) flags |= Qt::ItemIsUserCheckable;
  const int edited = item.kind == ItemKind::body ? value : name;
  if (index.column() == edited && item.kind != ItemKind::domain) flags |= Qt::ItemIsEditable;
  return flags;
}

bool StudyModel::setData(const QModelIndex& index, const QVariant& to, int role) {
  if (!index.isValid()) return false;
  const Item item = item_at(index);
  if (item.index < 0 || item.index >= entries(item.kind)) return false;
  if (item.kind == ItemKind::body) {
    BodySettings body = session_.body(item.index);
    QString what;
    if (index.column() == name && role == Qt::CheckStateRole) {
      body.visible = to.toInt() == Qt::Checked;
      what = body.visible ? tr("Show %1") : tr("Hide %1");
    } else if (index.column() == value && role == Qt::EditRole) {
      const int n = to.toInt();
      if (n < 1 || n == body.layers) return false;
      body.layers = n;
      what = tr("Layers of %1");
    } else {
      return false;
    }
    session_.edit_body(item.index, what.arg(text(body.name)), body);
    return true;
  }
  if (index.column() != name || item.kind == ItemKind::domain) return false;
  Study study = session_.study();
  if (item.kind == ItemKind::cut && role == Qt::CheckStateRole) {
    CutPlane& cut = study.cuts[std::size_t(item.index)];
    cut.on = to.toInt() == Qt::Checked;
    session_.edit((cut.on ? tr("Turn %1 on") : tr("Turn %1 off")).arg(text(cut.name)), study);
    return true;
  }
  const std::string given = to.toString().trimmed().toStdString();
  if (role != Qt::EditRole || given.empty()) return false;
  std::string& old = item.kind == ItemKind::group    ? study.groups[std::size_t(item.index)].name
                     : item.kind == ItemKind::sizing ? study.sizing[std::size_t(item.index)].name
                                                     : study.cuts[std::size_t(item.index)].name;
  if (old == given) return false;
  const QString what = tr("Rename %1").arg(text(old));
  old = given;
  session_.edit(what, study);
  return true;
}

QWidget* StudyDelegate::createEditor(QWidget* parent, const QStyleOptionViewItem& option,
                                     const QModelIndex& index) const {
  if (index.column() == StudyModel::name)
    return QStyledItemDelegate::createEditor(parent, option, index);
  auto* spin = new QSpinBox(parent);
  spin->setRange(1, 64);
  spin->setFrame(false);
  return spin;
}

void StudyDelegate::setEditorData(QWidget* editor, const QModelIndex& index) const {
  if (auto* integer = qobject_cast<QSpinBox*>(editor))
    integer->setValue(index.data(Qt::EditRole).toInt());
  else
    QStyledItemDelegate::setEditorData(editor, index);
}

void StudyDelegate::setModelData(QWidget* editor, QAbstractItemModel* model,
                                 const QModelIndex& index) const {
  if (auto* integer = qobject_cast<QSpinBox*>(editor)) {
    integer->interpretText();
    model->setData(index, integer->value(), Qt::EditRole);
  } else {
    QStyledItemDelegate::setModelData(editor, model, index);
  }
}

}  // namespace lamella::ui
