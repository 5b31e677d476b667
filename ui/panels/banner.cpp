#include "ui/panels/banner.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include "ui/theme.h"

namespace lamella::ui {

Banner::Banner(QWidget* parent) : QFrame(parent) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(14, 9, 8, 9);
  row->setSpacing(12);
  icon_ = new QLabel;
  row->addWidget(icon_);
  auto* texts = new QVBoxLayout;
  texts->setSpacing(2);
  message_ = new QLabel;
  message_->setObjectName("banner_title");
  hint_ = new QLabel;
  hint_->setObjectName("soft");
  for (QLabel* label : {message_, hint_}) {
    label->setWordWrap(true);
    label->setTextFormat(Qt::PlainText);
    label->setTextInteractionFlags(Qt::TextSelectableByMouse);
    texts->addWidget(label);
  }
  row->addLayout(texts, 1);
  buttons_ = new QHBoxLayout;
  buttons_->setSpacing(6);
  row->addLayout(buttons_);
  auto* close = new QToolButton;
  close->setIcon(lamella::ui::icon("close"));
  close->setToolTip(tr("Dismiss"));
  connect(close, &QToolButton::clicked, this, &QWidget::hide);
  row->addWidget(close, 0, Qt::AlignTop);
  hide();
}

void Banner::show_message(Kind kind, const QString& message, const QString& hint,
                          const std::vector<Button>& buttons) {
  const char* names[] = {"error", "info", "done"};
  const QString name = names[static_cast<int>(kind)];
  setObjectName("banner_" + name);
  // A style sheet looks at object names only when the style is polished again.
  style()->unpolish(this);
  style()->polish(this);
  icon_->setPixmap(lamella::ui::icon(name).pixmap(24, 24));
  message_->setText(message);
  hint_->setText(hint);
  hint_->setVisible(!hint.isEmpty());
  while (QLayoutItem* item = buttons_->takeAt(0)) {
    if (item->widget()) item->widget()->deleteLater();
    delete item;
  }
  for (const auto& [text, action] : buttons) {
    auto* button = new QPushButton(text);
    connect(button, &QPushButton::clicked, this, [this, action = action] {
      hide();
      action();
    });
    buttons_->addWidget(button);
  }
  show();
}

QString Banner::message() const { return message_->text(); }
QString Banner::hint() const { return hint_->text(); }

}  // namespace lamella::ui
