#include "ui/views/view_bar.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QSlider>
#include <QToolButton>
#include <algorithm>
#include <cmath>

#include "ui/actions/actions.h"
#include "ui/panels/length_box.h"
#include "ui/theme.h"
#include "ui/units.h"

namespace lamella::ui {
namespace {

constexpr int slider_steps = 1000;

QToolButton* button(QAction* action) {
  auto* b = new QToolButton;
  b->setDefaultAction(action);
  b->setIconSize(QSize(20, 20));
  b->setAutoRaise(true);
  return b;
}

QFrame* separator() {
  auto* line = new QFrame;
  line->setObjectName("separator");
  line->setFixedSize(1, 20);
  return line;
}

/// Smallest and largest distance of the box's corners along the normal.
std::pair<double, double> range_along(const std::array<double, 6>& box, const Vec<3>& normal) {
  double low = 0;
  double high = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = normal[axis] * box[static_cast<std::size_t>(2 * axis)];
    const double b = normal[axis] * box[static_cast<std::size_t>(2 * axis + 1)];
    low += std::min(a, b);
    high += std::max(a, b);
  }
  return {low, high};
}

}  // namespace

ViewBar::ViewBar(Actions& actions, QWidget* parent) : QFrame(parent), actions_(actions) {
  setObjectName("view_bar");
  auto* rows = new QVBoxLayout(this);
  rows->setContentsMargins(8, 5, 8, 5);
  rows->setSpacing(4);
  auto* row = new QHBoxLayout;
  row->setSpacing(4);
  rows->addLayout(row);
  by_ = new QLabel(tr("Color by"));
  by_->setObjectName("soft");
  row->addWidget(by_);
  colors_ = new QComboBox;
  colors_->setObjectName("color_by");
  colors_->setAccessibleName(tr("Color by"));
  colors_->setToolTip(tr("Color by"));
  colors_->addItem(tr("Body"), int(ColorBy::body));
  colors_->addItem(tr("Quality c(T)"), int(ColorBy::quality));
  colors_->addItem(tr("Wall thickness"), int(ColorBy::thickness));
  colors_->addItem(tr("Size asked"), int(ColorBy::size));
  colors_->addItem(tr("Layers measured"), int(ColorBy::layers));
  colors_->addItem(tr("Filling ratio"), int(ColorBy::filling));
  colors_->insertSeparator(colors_->count());
  colors_->addItem(tr("Velocity"), int(ColorBy::speed));
  colors_->addItem(tr("Pressure"), int(ColorBy::pressure));
  colors_->addItem(tr("Shear rate"), int(ColorBy::shear));
  colors_->addItem(tr("Flow indicator"), int(ColorBy::indicator));
  colors_->addItem(tr("Solver's field"), int(ColorBy::field));
  colors_->setMinimumWidth(130);
  row->addWidget(colors_);
  bodies_ = new QComboBox;
  bodies_->setObjectName("filling_body");
  bodies_->setAccessibleName(tr("Body whose filling is shown"));
  bodies_->setToolTip(tr("Body whose filling is shown: the selected one"));
  bodies_->setMinimumWidth(100);
  bodies_->hide();
  row->addWidget(bodies_);
  row->addWidget(button(actions_[Act::edges]));
  row->addWidget(button(actions_[Act::features]));
  row->addWidget(separator());
  row->addWidget(button(actions_[Act::section]));  // its name stands in the tool bar
  row->addStretch(1);
  row->addWidget(button(actions_[Act::measure]));
  row->addWidget(button(actions_[Act::ellipsoid]));
  row->addWidget(separator());
  row->addWidget(button(actions_[Act::box_zoom]));
  auto* views = button(actions_[Act::view_iso]);
  views->setToolTip(tr("Standard views (keys 0 to 6)"));
  views->setPopupMode(QToolButton::MenuButtonPopup);
  auto* menu = new QMenu(views);
  for (int a = int(Act::view_iso); a <= int(Act::view_bottom); ++a)
    menu->addAction(actions_[Act(a)]);
  views->setMenu(menu);
  row->addWidget(views);
  row->addWidget(button(actions_[Act::fit]));
  row->addWidget(button(actions_[Act::perspective]));
  row->addWidget(button(actions_[Act::compare]));
  section_bar_ = make_section_bar();
  rows->addWidget(section_bar_);
  section_bar_->hide();
  connect(colors_, &QComboBox::currentIndexChanged, this, &ViewBar::color_changed);
  connect(bodies_, &QComboBox::currentIndexChanged, this, &ViewBar::body_chosen);
}

QWidget* ViewBar::make_section_bar() {
  auto* bar = new QWidget;
  auto* tools = new QHBoxLayout(bar);
  tools->setContentsMargins(0, 0, 0, 0);
  tools->setSpacing(3);
  const std::pair<Act, const char*> axes[] = {
      {Act::section_x, "X"}, {Act::section_y, "Y"}, {Act::section_z, "Z"}};
  for (const auto& [act, letter] : axes) {
    auto* b = button(actions_[act]);
    b->setToolButtonStyle(Qt::ToolButtonTextOnly);
    actions_[act]->setIconText(letter);
    b->setMinimumWidth(26);
    tools->addWidget(b);
  }
  slider_ = new QSlider(Qt::Horizontal);
  slider_->setObjectName("section_position");
  slider_->setAccessibleName(tr("Position of the cut"));
  slider_->setRange(0, slider_steps);
  slider_->setMinimumWidth(90);
  tools->addSpacing(4);
  tools->addWidget(slider_, 1);
  tools->addSpacing(4);
  position_ = new CoordinateBox;
  position_->setAccessibleName(tr("Position of the cut"));
  position_->setSuffix(" " + units::name());
  position_->setMinimumWidth(100);
  tools->addWidget(position_);
  for (const Act act : {Act::flip, Act::add_cut, Act::crinkle})
    tools->addWidget(button(actions_[act]));
  connect(slider_, &QSlider::sliderPressed, this, &ViewBar::slide_started);
  connect(slider_, &QSlider::valueChanged, this, [this](int value) {
    Q_EMIT slid(range_.first + (range_.second - range_.first) * value / slider_steps);
  });
  connect(position_, &QDoubleSpinBox::valueChanged, this, &ViewBar::moved);
  return bar;
}

ColorBy ViewBar::color_by() const { return ColorBy(colors_->currentData().toInt()); }

void ViewBar::set_color_by(ColorBy color_by) {
  colors_->setCurrentIndex(colors_->findData(int(color_by)));
}

int ViewBar::body() const { return bodies_->currentIndex(); }

void ViewBar::show_bodies(const QStringList& names, int current) {
  const QSignalBlocker block(bodies_);
  bodies_->clear();
  bodies_->addItems(names);
  bodies_->setCurrentIndex(current);
  const bool filling = color_by() == ColorBy::filling && !names.isEmpty();
  // There is no room for both in a narrow window, which would grow while they are both there.
  if (filling) by_->hide();
  bodies_->setVisible(filling);
  by_->setVisible(!filling);
}

void ViewBar::show_section(const std::optional<Section>& section,
                           const std::array<double, 6>& bounds) {
  section_bar_->setVisible(section.has_value());
  {
    const QSignalBlocker block(actions_[Act::section]);
    actions_[Act::section]->setChecked(section.has_value());
  }
  // What shows the action must follow, although nothing was toggled.
  Q_EMIT actions_[Act::section]->changed();
  actions_[Act::flip]->setEnabled(section.has_value());
  for (int axis = 0; axis < 3; ++axis)
    actions_[Act(int(Act::section_x) + axis)]->setChecked(section &&
                                                          std::abs(section->normal[axis]) > 0.9999);
  if (!section) return;
  const QSignalBlocker block_slider(slider_);
  const QSignalBlocker block_position(position_);
  range_ = range_along(bounds, section->normal);
  const auto [low, high] = range_;
  const double at = section->origin.dot(section->normal);
  position_->setSingleStep(std::max(0.01, (high - low) / 100));
  position_->setValue(at);
  if (high > low)
    slider_->setValue(static_cast<int>(std::lround((at - low) / (high - low) * slider_steps)));
}

}  // namespace lamella::ui
