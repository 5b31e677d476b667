#include "ui/panels/palette.h"

#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QPainter>
#include <QStyledItemDelegate>
#include <QVBoxLayout>

#include "ui/theme.h"

namespace lamella::ui {
namespace {

enum Role { action_role = Qt::UserRole, keys_role };

QString title_of(const QAction& action) {
  return action.text().remove('&').remove(QString::fromUtf8("…"));
}

/// Whether every word of `words` is in `text`.
bool has_all(const QString& text, const QStringList& words) {
  for (const QString& word : words)
    if (!text.contains(word, Qt::CaseInsensitive)) return false;
  return true;
}

/// The entry with its keys at the right edge.
class KeysBeside : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;
  void paint(QPainter* painter, const QStyleOptionViewItem& option,
             const QModelIndex& index) const override {
    QStyledItemDelegate::paint(painter, option, index);
    painter->setPen(theme::soft_text);
    painter->drawText(option.rect.adjusted(0, 0, -10, 0), Qt::AlignRight | Qt::AlignVCenter,
                      index.data(keys_role).toString());
  }
};

}  // namespace

Palette::Palette(QWidget* parent) : QFrame(parent, Qt::Popup) {
  setObjectName("palette");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 8, 8, 8);
  layout->setSpacing(6);
  text_ = new QLineEdit;
  text_->setObjectName("palette_text");
  text_->setPlaceholderText(tr("What do you want to do?"));
  text_->setAccessibleName(tr("Search actions"));
  list_ = new QListWidget;
  list_->setObjectName("palette_list");
  list_->setFocusPolicy(Qt::NoFocus);
  list_->setIconSize(QSize(20, 20));
  list_->setItemDelegate(new KeysBeside(list_));
  layout->addWidget(text_);
  layout->addWidget(list_);
  text_->installEventFilter(this);
  connect(text_, &QLineEdit::textChanged, this, &Palette::narrow);
  connect(text_, &QLineEdit::returnPressed, this, &Palette::run);
  connect(list_, &QListWidget::itemClicked, this, &Palette::run);
}

void Palette::open(const std::vector<QAction*>& actions) {
  actions_ = actions;
  text_->clear();
  narrow();
  resize(460, 360);
  const QWidget* window = parentWidget();
  move(window->mapToGlobal(QPoint((window->width() - width()) / 2, 90)));
  show();
  text_->setFocus();
}

void Palette::narrow() {
  list_->clear();
  QPixmap blank(list_->iconSize());  // titles stand in one column
  blank.fill(Qt::transparent);
  const QStringList words = text_->text().split(' ', Qt::SkipEmptyParts);
  for (std::size_t k = 0; k < actions_.size(); ++k) {
    const QAction& action = *actions_[k];
    if (!action.isEnabled()) continue;
    // The tip often has the word that the title lacks.
    if (!has_all(title_of(action) + ' ' + action.toolTip(), words)) continue;
    auto* item = new QListWidgetItem(action.icon().isNull() ? QIcon(blank) : action.icon(),
                                     title_of(action));
    item->setData(keys_role, action.shortcut().toString(QKeySequence::NativeText));
    item->setToolTip(action.toolTip());
    item->setData(action_role, static_cast<int>(k));
    // What says it in its title comes before what only explains it so.
    if (has_all(title_of(action), words) || list_->count() == 0)
      list_->addItem(item);
    else
      list_->insertItem(list_->count(), item);
  }
  list_->setCurrentRow(0);
}

void Palette::run() {
  const QListWidgetItem* item = list_->currentItem();
  if (!item) return;
  QAction* action = actions_[static_cast<std::size_t>(item->data(action_role).toInt())];
  hide();
  action->trigger();
}

bool Palette::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::KeyPress) {
    const int key = static_cast<QKeyEvent*>(event)->key();
    const int step = key == Qt::Key_Down ? 1 : key == Qt::Key_Up ? -1 : 0;
    if (step != 0 && list_->count() > 0) {
      list_->setCurrentRow((list_->currentRow() + step + list_->count()) % list_->count());
      return true;
    }
  }
  return QFrame::eventFilter(watched, event);
}

}  // namespace lamella::ui
