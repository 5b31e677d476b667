#include "ui/panels/group_page.h"

#include <QComboBox>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <numbers>
#include <set>

#include "core/geometry/soup.h"
#include "ui/actions/actions.h"
#include "ui/commands/study_edits.h"
#include "ui/panels/form.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/units.h"

namespace lamella::ui {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Which list of the group an entry shows, and its place there.
enum Role { list_role = Qt::UserRole, place_role };
enum List { face_list, name_list, flood_list };

QToolButton* wide_button(QAction* action) {
  auto* button = new QToolButton;
  button->setDefaultAction(action);
  button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  button->setObjectName("wide");
  button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  return button;
}

double area_of(const ReferenceSurface<3>& s, const std::vector<std::int32_t>& facets) {
  double area = 0;
  for (const std::int32_t f : facets) area += facet_area(s, static_cast<std::size_t>(f));
  return area;
}

}  // namespace

GroupPage::GroupPage(Session& session, Actions& actions, QWidget* parent)
    : QWidget(parent), session_(session) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(8);
  layout->addWidget(styled_label(tr("Boundary group"), "panel_title"));
  auto* form = new Form;
  name_ = new QLineEdit;
  name_->setObjectName("group_name");
  name_->setToolTip(tr("The name in the files that are written"));
  form->add(tr("Name"), name_);
  kind_ = new QComboBox;
  kind_->setObjectName("group_kind");
  for (const GroupKind kind :
       {GroupKind::gate, GroupKind::vent, GroupKind::symmetry, GroupKind::walls, GroupKind::other})
    kind_->addItem(kind_title(kind), int(kind));
  kind_->setToolTip(tr("What the simulation is to take it for"));
  form->add(tr("Kind"), kind_);
  given_ = new QComboBox;
  given_->setObjectName("gate_given");
  given_->addItems({tr("by its pressure"), tr("by its rate")});
  given_->setToolTip(tr("What is known of the flow that enters; the other one follows"));
  form->add(tr("Flow"), given_);
  value_ = number_box(1e-3, 1e9, 1, "gate_value", tr("Of the flow through the gate"));
  value_->setDecimals(3);
  form->add({}, value_);
  value_->setAccessibleName(tr("Flow"));
  rows_ = form;
  body_ = styled_label({}, "soft");
  form->add(tr("Body"), body_);
  area_ = styled_label({}, "soft");
  area_->setObjectName("group_area");
  area_->setWordWrap(true);
  form->add(tr("Area"), area_);
  layout->addLayout(form);
  layout->addWidget(styled_label(tr("Faces"), "section_title"));
  layout->addWidget(wide_button(actions[Act::pick_faces]));
  auto* flood = new QHBoxLayout;
  flood->addWidget(wide_button(actions[Act::pick_flood]), 1);
  angle_ = number_box(1, 180, 5, "flood_angle",
                      tr("A flood crosses edges where the surface turns by no more than this"));
  angle_->setAccessibleName(angle_->toolTip());
  angle_->setDecimals(0);
  angle_->setSuffix("°");
  angle_->setValue(20);
  flood->addWidget(angle_);
  layout->addLayout(flood);
  by_name_ = new QToolButton;
  by_name_->setObjectName("wide");
  by_name_->setText(tr("Faces by name"));
  by_name_->setToolTip(tr("All faces that have this name in the CAD file"));
  by_name_->setPopupMode(QToolButton::InstantPopup);
  by_name_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  auto* names = new QMenu(by_name_);
  names->setObjectName("face_names");
  by_name_->setMenu(names);
  layout->addWidget(by_name_);
  faces_ = new QListWidget;
  faces_->setObjectName("group_faces");
  faces_->setAccessibleName(tr("Faces"));
  faces_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  faces_->setFrameShape(QFrame::NoFrame);
  faces_->setToolTip(tr("Del takes the selected ones out"));
  layout->addWidget(faces_, 1);
  auto* take = new QPushButton(tr("Take out"));
  layout->addWidget(take, 0, Qt::AlignLeft);
  correct_ = new QPushButton(icon("sphere"), tr("Correct near it"));
  correct_->setObjectName("correct_near_group");
  correct_->setToolTip(tr("Puts a sphere with a size of its own around the group"));
  layout->addWidget(correct_, 0, Qt::AlignLeft);

  const auto set_angle = [this, &actions] {
    actions[Act::pick_flood]->setData(angle_->value() * degree);
  };
  set_angle();
  connect(angle_, &QDoubleSpinBox::valueChanged, this, set_angle);
  connect(name_, &QLineEdit::editingFinished, this, [this] {
    const std::string name = name_->text().trimmed().toStdString();
    if (!group() || group()->name == name) return;
    if (name.empty()) return refresh();
    edit_group(session_, session_.item().index, tr("Rename group %1"),
               [&](BoundaryGroup& g) { g.name = name; });
  });
  connect(kind_, &QComboBox::activated, this, [this] {
    const auto kind = GroupKind(kind_->currentData().toInt());
    edit_group(session_, session_.item().index, tr("Kind of group %1"), [kind](BoundaryGroup& g) {
      g.kind = kind;
      if (kind == GroupKind::gate) return;
      g.pressure.reset();
      g.rate.reset();
    });
  });
  const auto set_gate = [this] {
    const double value = value_->value();
    const bool rate = given_->currentIndex() == 1;
    edit_group(session_, session_.item().index, tr("Flow through %1"),
               [rate, value](BoundaryGroup& g) {
                 g.rate = rate ? std::optional(value) : std::nullopt;
                 g.pressure = rate ? std::nullopt : std::optional(value);
               });
  };
  connect(given_, &QComboBox::activated, this, set_gate);
  connect(value_, &QDoubleSpinBox::valueChanged, this, set_gate);
  connect(take, &QPushButton::clicked, this, &GroupPage::remove_chosen);
  connect(correct_, &QPushButton::clicked, this, [this] {
    if (group()) correct_near_group(session_, session_.item().index);
  });
  connect(names, &QMenu::triggered, this, [this](QAction* chosen) {
    const std::string name = chosen->data().toString().toStdString();
    edit_group(session_, session_.item().index, tr("Faces by name of %1"), [&](BoundaryGroup& g) {
      g.body = part_;
      if (std::find(g.face_names.begin(), g.face_names.end(), name) == g.face_names.end())
        g.face_names.push_back(name);
    });
  });
  faces_->installEventFilter(this);
}

bool GroupPage::eventFilter(QObject* watched, QEvent* event) {
  const bool key = event->type() == QEvent::ShortcutOverride || event->type() == QEvent::KeyPress;
  if (watched != faces_ || !key || static_cast<QKeyEvent*>(event)->key() != Qt::Key_Delete)
    return QWidget::eventFilter(watched, event);
  // Here the key is for faces, not for the group.
  if (event->type() == QEvent::KeyPress) remove_chosen();
  event->accept();
  return true;
}

const BoundaryGroup* GroupPage::group() const {
  const Item item = session_.item();
  return item.kind == ItemKind::group
             ? &session_.study().groups[static_cast<std::size_t>(item.index)]
             : nullptr;
}

void GroupPage::remove_chosen() {
  if (!group()) return;
  std::vector<std::pair<int, int>> chosen;
  for (const QListWidgetItem* item : faces_->selectedItems())
    chosen.emplace_back(item->data(list_role).toInt(), item->data(place_role).toInt());
  if (chosen.empty()) return;
  std::sort(chosen.rbegin(), chosen.rend());
  edit_group(session_, session_.item().index, tr("Take faces out of %1"), [&](BoundaryGroup& g) {
    for (const auto& [list, place] : chosen) {
      if (list == face_list) g.faces.erase(g.faces.begin() + place);
      if (list == name_list) g.face_names.erase(g.face_names.begin() + place);
      if (list == flood_list) g.floods.erase(g.floods.begin() + place);
    }
  });
}

void GroupPage::show_names(const Part* part) {
  by_name_->menu()->clear();
  std::set<std::string> names;
  if (part)
    for (const auto& face : part->surface.faces)
      if (!face.name.empty()) names.insert(face.name);
  for (const std::string& name : names) {
    // What is written like a key of the menu is none.
    QAction* entry = by_name_->menu()->addAction(QString::fromStdString(name).replace('&', "&&"));
    entry->setData(QString::fromStdString(name));
  }
  by_name_->setVisible(!names.empty());
  part_ = part ? part->name : std::string();
}

void GroupPage::refresh() {
  const BoundaryGroup* g = group();
  if (!g) return;
  name_->setText(QString::fromStdString(g->name));
  kind_->setCurrentIndex(kind_->findData(int(g->kind)));
  for (QWidget* box : std::initializer_list<QWidget*>{given_, value_})
    rows_->setRowVisible(box, g->kind == GroupKind::gate);
  {
    const QSignalBlocker block(value_);
    given_->setCurrentIndex(g->rate ? 1 : 0);
    value_->setSuffix(g->rate ? tr(" mm³/s") : tr(" MPa"));
    value_->setValue(g->rate.value_or(g->pressure.value_or(1)));
  }
  faces_->clear();
  const Part* part = nullptr;
  for (const Part& p : session_.parts())
    if (p.name == g->body || (g->body.empty() && session_.parts().size() == 1)) part = &p;
  show_names(part);
  body_->setText(part ? QString::fromStdString(part->name) : tr("that of the first face picked"));
  const auto add = [this](const QString& text, List list, std::size_t place) {
    auto* item = new QListWidgetItem(text, faces_);
    item->setData(list_role, int(list));
    item->setData(place_role, static_cast<int>(place));
  };
  for (std::size_t k = 0; k < g->faces.size(); ++k) {
    const auto id = static_cast<std::size_t>(g->faces[k]);
    const bool named =
        part && id < part->surface.faces.size() && !part->surface.faces[id].name.empty();
    add(named ? tr("face %1, %2").arg(id).arg(QString::fromStdString(part->surface.faces[id].name))
              : tr("face %1").arg(id),
        face_list, k);
  }
  for (std::size_t k = 0; k < g->face_names.size(); ++k)
    add(tr("faces called %1").arg(QString::fromStdString(g->face_names[k])), name_list, k);
  for (std::size_t k = 0; k < g->floods.size(); ++k) {
    const Flood& flood = g->floods[k];
    add(tr("from (%1, %2, %3) up to %4°")
            .arg(units::number(flood.point[0]), units::number(flood.point[1]),
                 units::number(flood.point[2]))
            .arg(flood.angle / degree, 0, 'f', 0),
        flood_list, k);
  }
  correct_->setEnabled(part && faces_->count() > 0);
  if (!part || faces_->count() == 0) {
    area_->setText(tr("pick its faces in the view"));
    return;
  }
  const auto facets = facets_of(*g, part->surface);
  area_->setText(facets ? units::area(area_of(part->surface, *facets))
                        : QString::fromStdString(facets.error().message));
}

}  // namespace lamella::ui
