#include "ui/panels/properties_panel.h"

#include <QLabel>
#include <QScrollArea>
#include <QVBoxLayout>

#include "ui/panels/body_page.h"
#include "ui/panels/cut_page.h"
#include "ui/panels/domain_page.h"
#include "ui/panels/group_page.h"
#include "ui/panels/mesh_page.h"
#include "ui/panels/sizing_page.h"
#include "ui/session/session.h"

namespace lamella::ui {

PropertiesPanel::PropertiesPanel(Session& session, Forecaster& forecaster, Actions& actions,
                                 QWidget* parent)
    : QFrame(parent), session_(session) {
  setObjectName("panel");
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(1, 1, 1, 1);
  auto* scroll = new QScrollArea(this);
  scroll_ = scroll;
  scroll->setAccessibleName(tr("Settings"));
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  outer->addWidget(scroll);
  content_ = new QWidget;
  content_->setObjectName("properties");
  scroll->setWidget(content_);
  auto* layout = new QVBoxLayout(content_);
  layout->setContentsMargins(14, 10, 14, 12);
  layout->setSpacing(10);
  body_ = new BodyPage(session, content_);
  group_ = new GroupPage(session, actions, content_);
  sizing_ = new SizingPage(session, forecaster, content_);
  cut_ = new CutPage(session, content_);
  domain_ = new DomainPage(session, content_);
  // Not a stack: that would be as high as the highest page and scroll where there is room.
  for (QWidget* page : pages()) {
    page->hide();
    layout->addWidget(page, 1);
  }
  mesh_ = new MeshPage(session, content_);
  empty_ = new QLabel(tr("The settings of what is selected appear here."));
  empty_->setObjectName("faint");
  empty_->setAlignment(Qt::AlignCenter);
  empty_->setWordWrap(true);
  outer->addWidget(empty_);
  layout->addWidget(mesh_);

  connect(&session, &Session::parts_changed, this, &PropertiesPanel::refresh);
  connect(&session, &Session::surfaces_changed, this, &PropertiesPanel::refresh);
  connect(&session, &Session::selection_changed, this, &PropertiesPanel::refresh);
  connect(&session, &Session::study_changed, this, &PropertiesPanel::refresh);
  refresh();
}

std::array<QWidget*, 5> PropertiesPanel::pages() const {
  return {body_, group_, sizing_, cut_, domain_};
}

void PropertiesPanel::refresh() {
  scroll_->setVisible(session_.has_bodies());
  empty_->setVisible(!session_.has_bodies());
  QWidget* current = pages()[static_cast<std::size_t>(session_.item().kind)];
  for (QWidget* page : pages())
    if (page != current) page->hide();
  current->show();
  body_->refresh();
  group_->refresh();
  sizing_->refresh();
  cut_->refresh();
  domain_->refresh();
  mesh_->refresh();
}

}  // namespace lamella::ui
