#include "ui/panels/welcome.h"

#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include "ui/actions/actions.h"
#include "ui/session/recent_files.h"
#include "ui/theme.h"

namespace lamella::ui {

Welcome::Welcome(Actions& actions, QWidget* parent) : QFrame(parent) {
  setObjectName("welcome");
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(8, 12, 8, 12);
  outer->addStretch(2);

  drop_zone_ = new QFrame;
  drop_zone_->setObjectName("drop_zone");
  drop_zone_->setFixedWidth(546);
  drop_zone_->setMinimumHeight(190);
  auto* zone = new QVBoxLayout(drop_zone_);
  zone->setSpacing(8);
  zone->addStretch(1);
  auto* picture = new QLabel;
  picture->setPixmap(QIcon(":/icons/drop.svg").pixmap(72, 72));
  picture->setAlignment(Qt::AlignCenter);
  zone->addWidget(picture);
  auto* title = new QLabel(tr("Drop a CAD or STL file here"));
  QFont large = title->font();
  large.setPointSizeF(large.pointSizeF() + 6);
  large.setWeight(QFont::DemiBold);
  title->setFont(large);
  title->setAlignment(Qt::AlignCenter);
  zone->addWidget(title);
  auto* text = new QLabel(tr("Lamella fills it with tetrahedra, n layers through every wall."));
  text->setObjectName("soft");
  text->setAlignment(Qt::AlignCenter);
  zone->addWidget(text);
  zone->addSpacing(8);
  auto* open = new QPushButton(tr("Open a file…"));
  open->setObjectName("primary");
  connect(open, &QPushButton::clicked, actions[Act::open], &QAction::trigger);
  zone->addWidget(open, 0, Qt::AlignCenter);
  zone->addStretch(1);
  outer->addWidget(drop_zone_, 0, Qt::AlignCenter);
  outer->addSpacing(18);

  auto* or_label = new QLabel(tr("or start with a sample part"));
  or_label->setObjectName("soft");
  or_label->setAlignment(Qt::AlignCenter);
  outer->addWidget(or_label);
  outer->addSpacing(10);
  auto* samples = new QHBoxLayout;
  samples->setSpacing(4);
  samples->addStretch(1);
  const std::tuple<const char*, QString, QString> parts[] = {
      {"ribbed_tray", tr("Ribbed tray"), tr("Ribs, bosses and fillets")},
      {"plate", tr("Plate"), tr("One thin wall")},
      {"curved_shell", tr("Curved shell"), tr("A wall that bends")},
      {"t_junction", tr("T-junction"), tr("Where walls meet")},
      {"twisted_tube", tr("Twisted tube"), tr("A tube in a cube")}};
  for (const auto& [name, label, tip] : parts) {
    auto* card = new QToolButton;
    card->setObjectName("sample");
    card->setText(label);
    card->setToolTip(tip);
    card->setIcon(QIcon(QString(":/icons/sample-%1.svg").arg(name)));
    card->setIconSize(QSize(84, 56));
    card->setToolButtonStyle(Qt::ToolButtonTextUnderIcon);
    card->setFixedSize(106, 98);
    card->setCursor(Qt::PointingHandCursor);
    connect(card, &QToolButton::clicked, this,
            [this, name = QString(name)] { Q_EMIT sample_chosen(name); });
    samples->addWidget(card);
  }
  samples->addStretch(1);
  outer->addLayout(samples);
  outer->addSpacing(14);
  recent_ = new QVBoxLayout;
  recent_->setSpacing(2);
  outer->addLayout(recent_);
  outer->addStretch(3);
  refresh();
}

void Welcome::refresh() {
  while (QLayoutItem* item = recent_->takeAt(0)) {
    delete item->widget();
    delete item;
  }
  const QStringList files = recent_files().mid(0, 4);
  if (files.isEmpty()) return;
  auto* title = new QLabel(tr("opened last"));
  title->setObjectName("faint");
  title->setAlignment(Qt::AlignCenter);
  recent_->addWidget(title);
  for (const QString& file : files) {
    auto* link = new QToolButton;
    link->setObjectName("link");
    link->setText(QFileInfo(file).fileName());
    link->setToolTip(file);
    link->setCursor(Qt::PointingHandCursor);
    connect(
        link, &QToolButton::clicked, this, [this, file] { Q_EMIT file_chosen(file); },
        Qt::QueuedConnection);
    recent_->addWidget(link, 0, Qt::AlignCenter);
  }
}

void Welcome::set_dragging(bool on) {
  drop_zone_->setProperty("active", on);
  style()->unpolish(drop_zone_);
  style()->polish(drop_zone_);
}

}  // namespace lamella::ui
