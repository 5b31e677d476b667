#include "ui/views/model_view.h"

#include <vtkCamera.h>
#include <vtkRenderer.h>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QMouseEvent>
#include <QSlider>
#include <QTimer>
#include <QToolButton>
#include <cmath>

#include "ui/actions/actions.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/views/overlay.h"
#include "ui/views/vtk_view.h"

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
  line->setFixedSize(1, 20);
  line->setStyleSheet("background: #dde2e8; border: none;");
  return line;
}

/// Smallest and largest distance of the box's corners along the normal.
std::pair<double, double> range_along(const std::array<double, 6>& box, const Vec<3>& normal) {
  double low = 0;
  double high = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = normal[axis] * box[2 * axis];
    const double b = normal[axis] * box[2 * axis + 1];
    low += std::min(a, b);
    high += std::max(a, b);
  }
  return {low, high};
}

}  // namespace

ModelView::ModelView(Session& session, Actions& actions, QWidget* parent)
    : QWidget(parent), session_(session), actions_(actions) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(make_bar());
  auto* frame = new QFrame;
  frame->setObjectName("view_frame");
  auto* inner = new QVBoxLayout(frame);
  inner->setContentsMargins(1, 1, 1, 1);
  layout->addWidget(frame, 1);
  if (VtkView::supported()) {
    view_ = new VtkView;
    scene_ = std::make_unique<Scene>(*view_->renderer());
    tool_ = std::make_unique<SectionTool>(*view_, [this](const Section& moved) {
      section_ = moved;
      apply_section();
    });
    overlay_ = new Overlay(*view_, *tool_);
    view_->set_mouse_filter([this](QMouseEvent* event) { return mouse(event); });
    connect(view_, &VtkView::rendered, this, [this] {
      if (scene_->set_pixel_size(view_->pixel_size())) view_->update();
    });
    inner->addWidget(view_);
  } else {
    auto* label =
        new QLabel(tr("No OpenGL 3.2 here: the model cannot be shown.\n"
                      "Meshing, report and export work as usual."));
    label->setAlignment(Qt::AlignCenter);
    label->setObjectName("faint");
    inner->addWidget(label);
  }
  connect_session();
  connect_actions();
  follow_parts();
}

ModelView::~ModelView() {
  // The scene's actors hold OpenGL objects of the view's context.
  if (view_) view_->set_mouse_filter({});
}

QWidget* ModelView::make_bar() {
  auto* bar = new QFrame;
  bar->setObjectName("view_bar");
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(10, 5, 10, 5);
  row->setSpacing(6);
  auto* by = new QLabel(tr("Color by"));
  by->setObjectName("soft");
  row->addWidget(by);
  colors_ = new QComboBox;
  colors_->setObjectName("color_by");
  colors_->addItem(tr("Body"), int(ColorBy::body));
  colors_->addItem(tr("Quality c(T)"), int(ColorBy::quality));
  colors_->addItem(tr("Wall thickness"), int(ColorBy::thickness));
  colors_->addItem(tr("Layers measured"), int(ColorBy::layers));
  colors_->setMinimumWidth(140);
  row->addWidget(colors_);
  row->addWidget(button(actions_[Act::edges]));
  row->addWidget(button(actions_[Act::features]));
  row->addWidget(separator());
  auto* section = button(actions_[Act::section]);
  section->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  row->addWidget(section);

  section_bar_ = new QWidget;
  auto* tools = new QHBoxLayout(section_bar_);
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
  slider_->setRange(0, slider_steps);
  slider_->setMinimumWidth(90);
  slider_->setMaximumWidth(180);
  tools->addSpacing(4);
  tools->addWidget(slider_, 1);
  tools->addSpacing(4);
  position_ = new QDoubleSpinBox;
  position_->setDecimals(2);
  position_->setSuffix(tr(" mm"));
  position_->setRange(-1e6, 1e6);
  position_->setKeyboardTracking(false);
  position_->setMinimumWidth(100);
  tools->addWidget(position_);
  tools->addWidget(button(actions_[Act::flip]));
  tools->addWidget(button(actions_[Act::crinkle]));
  row->addWidget(section_bar_, 1);
  section_bar_->hide();
  row->addStretch(1);

  auto* views = new QToolButton;
  views->setIcon(actions_[Act::view_iso]->icon());
  views->setIconSize(QSize(20, 20));
  views->setAutoRaise(true);
  views->setToolTip(tr("Standard views (keys 0 to 6)"));
  views->setPopupMode(QToolButton::InstantPopup);
  auto* menu = new QMenu(views);
  for (int a = int(Act::view_iso); a <= int(Act::view_bottom); ++a)
    menu->addAction(actions_[Act(a)]);
  views->setMenu(menu);
  row->addWidget(views);
  row->addWidget(button(actions_[Act::fit]));
  row->addWidget(button(actions_[Act::perspective]));
  row->addWidget(button(actions_[Act::save_picture]));

  connect(colors_, &QComboBox::currentIndexChanged, this, [this] {
    if (!scene_) return;
    follow_study();
    refresh();
  });
  connect(slider_, &QSlider::valueChanged, this, [this](int value) {
    if (!section_ || !scene_) return;
    const auto [low, high] = range_along(scene_->bounds(), section_->normal);
    const double want = low + (high - low) * value / slider_steps;
    section_->origin += section_->normal * (want - section_->origin.dot(section_->normal));
    apply_section();
  });
  connect(position_, &QDoubleSpinBox::valueChanged, this, [this](double value) {
    if (!section_) return;
    section_->origin += section_->normal * (value - section_->origin.dot(section_->normal));
    apply_section();
  });
  return bar;
}

void ModelView::connect_session() {
  connect(&session_, &Session::parts_changed, this, &ModelView::follow_parts);
  connect(&session_, &Session::study_changed, this, &ModelView::follow_study);
  connect(&session_, &Session::surfaces_changed, this, &ModelView::follow_surfaces);
  connect(&session_, &Session::selection_changed, this, &ModelView::follow_selection);
  connect(&session_, &Session::shown_changed, this, &ModelView::follow_mesh);
}

void ModelView::connect_actions() {
  connect(actions_[Act::crinkle], &QAction::toggled, this, [this](bool on) {
    if (!scene_) return;
    scene_->set_crinkle(on);
    refresh();
  });
  connect(actions_[Act::edges], &QAction::toggled, this, [this](bool on) {
    if (!scene_) return;
    scene_->set_edges(on);
    refresh();
  });
  connect(actions_[Act::features], &QAction::toggled, this, [this](bool on) {
    if (!scene_) return;
    scene_->set_features(on);
    refresh();
  });
  connect(actions_[Act::section], &QAction::toggled, this, [this](bool on) {
    if (on == section_.has_value()) return;
    if (on) {
      start_section(-1);
    } else {
      set_section(std::nullopt);
    }
  });
  for (int axis = 0; axis < 3; ++axis) {
    connect(actions_[Act(int(Act::section_x) + axis)], &QAction::triggered, this,
            [this, axis] { start_section(axis); });
  }
  connect(actions_[Act::flip], &QAction::triggered, this, [this] {
    if (!section_) return;
    section_->normal = -section_->normal;
    apply_section();
  });
  connect(actions_[Act::fit], &QAction::triggered, this, &ModelView::fit);
  connect(actions_[Act::perspective], &QAction::toggled, this, [this](bool on) {
    if (view_) view_->set_perspective(on);
  });
  connect(actions_[Act::view_iso], &QAction::triggered, this, &ModelView::look_isometric);
  const Vec<3> z = Vec<3>::UnitZ();
  const std::tuple<Act, Vec<3>, Vec<3>> views[] = {
      {Act::view_front, Vec<3>::UnitY(), z}, {Act::view_back, -Vec<3>::UnitY(), z},
      {Act::view_left, Vec<3>::UnitX(), z},  {Act::view_right, -Vec<3>::UnitX(), z},
      {Act::view_top, -z, Vec<3>::UnitY()},  {Act::view_bottom, z, Vec<3>::UnitY()}};
  for (const auto& [act, direction, up] : views) {
    connect(actions_[act], &QAction::triggered, this,
            [this, direction = direction, up = up] { look(direction, up); });
  }
}

void ModelView::follow_surfaces() {
  if (!scene_) return;
  std::vector<QColor> colors;
  for (std::size_t k = 0; k < session_.parts().size(); ++k)
    colors.push_back(body_color(static_cast<int>(k), session_.parts()[k].color));
  scene_->set_parts(session_.parts(), colors);
  follow_study();
}

void ModelView::follow_parts() {
  if (!scene_) return;
  follow_surfaces();
  set_section(std::nullopt);
  tool_->set_bounds(scene_->bounds());
  look_isometric();
}

void ModelView::follow_selection() {
  if (!scene_) return;
  scene_->set_selected(session_.selection());
  follow_study();
}

bool ModelView::mouse(QMouseEvent* event) {
  const bool taken = tool_->mouse(event);
  if (event->type() == QEvent::MouseButtonPress) {
    pressed_.reset();
    if (!taken && event->button() == Qt::LeftButton) pressed_ = event->position();
  } else if (event->type() == QEvent::MouseButtonRelease && pressed_) {
    const QPointF moved = event->position() - *pressed_;
    pressed_.reset();
    if (std::hypot(moved.x(), moved.y()) < 4) {
      const double ratio = view_->devicePixelRatioF();
      const int part = scene_->part_at(event->position().x() * ratio,
                                       (view_->height() - 1 - event->position().y()) * ratio);
      std::vector<int> parts = session_.selection();
      if (part >= 0 && event->modifiers() & Qt::ControlModifier) {
        if (std::erase(parts, part) == 0) parts.push_back(part);
        session_.select(std::move(parts), part);
      } else if (part >= 0) {
        session_.select(part);
      }
    }
  }
  return taken;
}

void ModelView::follow_study() {
  if (!scene_) return;
  std::vector<bool> visible;
  int layers = 4;
  for (const BodySettings& body : session_.study().bodies) visible.push_back(body.visible);
  const int count = static_cast<int>(session_.study().bodies.size());
  if (count > 0) layers = session_.body(std::clamp(session_.selected(), 0, count - 1)).layers;
  scene_->set_visible(visible);
  scene_->set_color_by(color_by(), layers);
  refresh();
}

void ModelView::follow_mesh() {
  if (!scene_) return;
  const bool had = scene_->bounds()[0] <= scene_->bounds()[1];
  scene_->set_mesh(session_.shown_state());
  tool_->set_bounds(scene_->bounds());
  if (!had) look_isometric();
  refresh();
}

void ModelView::refresh() {
  overlay_->set_legend(scene_->legend());
  overlay_->set_scale_visible(!session_.empty());
  view_->update();
}

void ModelView::set_color_by(ColorBy color_by) {
  colors_->setCurrentIndex(colors_->findData(int(color_by)));
}

ColorBy ModelView::color_by() const { return ColorBy(colors_->currentData().toInt()); }

void ModelView::start_section(int axis) {
  if (!scene_ || session_.empty()) {
    actions_[Act::section]->setChecked(false);
    return;
  }
  const auto b = scene_->bounds();
  if (axis < 0) {
    // Across the longest side: the section that shows most walls.
    const Vec<3> size(b[1] - b[0], b[3] - b[2], b[5] - b[4]);
    size.maxCoeff(&axis);
  }
  Section section;
  section.normal = Vec<3>::Unit(axis);
  // The side towards the viewer goes, so that the cut is seen.
  double direction[3];
  view_->renderer()->GetActiveCamera()->GetDirectionOfProjection(direction);
  if (direction[axis] > 0) section.normal = -section.normal;
  section.origin = Vec<3>((b[0] + b[1]) / 2, (b[2] + b[3]) / 2, (b[4] + b[5]) / 2);
  set_section(section);
}

void ModelView::set_section(const std::optional<Section>& section) {
  section_ = section;
  actions_[Act::section]->setChecked(section.has_value());
  actions_[Act::flip]->setEnabled(section.has_value());
  if (!section)
    for (const Act act : {Act::section_x, Act::section_y, Act::section_z})
      actions_[act]->setChecked(false);
  section_bar_->setVisible(section.has_value());
  if (!scene_) return;
  apply_section();
}

void ModelView::apply_section() {
  tool_->set(section_);
  update_section_controls();
  overlay_->update();
  if (section_pending_) return;
  // Many moves of the mouse in one turn of the event loop make one cut.
  section_pending_ = true;
  QTimer::singleShot(0, this, [this] {
    section_pending_ = false;
    scene_->set_section(section_);
    refresh();
  });
}

void ModelView::update_section_controls() {
  if (!section_) return;
  for (int axis = 0; axis < 3; ++axis)
    actions_[Act(int(Act::section_x) + axis)]->setChecked(std::abs(section_->normal[axis]) >
                                                          0.9999);
  const QSignalBlocker block_slider(slider_);
  const QSignalBlocker block_position(position_);
  const auto [low, high] = range_along(scene_->bounds(), section_->normal);
  const double at = section_->origin.dot(section_->normal);
  position_->setSingleStep(std::max(0.01, (high - low) / 100));
  position_->setValue(at);
  if (high > low)
    slider_->setValue(static_cast<int>(std::lround((at - low) / (high - low) * slider_steps)));
}

void ModelView::fit() {
  if (view_ && scene_->bounds()[0] <= scene_->bounds()[1]) view_->fit(scene_->bounds());
}

void ModelView::look(const Vec<3>& direction, const Vec<3>& up) {
  if (view_ && scene_->bounds()[0] <= scene_->bounds()[1])
    view_->look(direction, up, scene_->bounds());
}

Vec<3> ModelView::first_direction() const {
  // Flat parts are seen on their flat side, and from where they have more to show.
  const auto b = scene_->bounds();
  int thin = 0;
  int wide = 0;
  const Vec<3> size(b[1] - b[0], b[3] - b[2], b[5] - b[4]);
  size.minCoeff(&thin);
  size.maxCoeff(&wide);
  Vec<3> direction(-0.55, 0.72, -0.58);
  if (size[thin] < 0.35 * size[3 - thin - wide]) {
    direction = Vec<3>(-0.42, 0.48, -0.46);
    direction[thin] = direction[thin] < 0 ? -0.85 : 0.85;
    double shown = 0;  // CAD faces that look our way, less those that look away
    double all = 0;
    for (const Part& part : session_.parts()) {
      std::vector<double> along(part.surface.faces.size());
      all += static_cast<double>(along.size());
      for (std::size_t k = 0; k < part.surface.facets.size(); ++k) {
        const auto& f = part.surface.facets[k];
        const Vec<3>& a = part.surface.points[static_cast<std::size_t>(f[0])];
        const Vec<3> n = (part.surface.points[static_cast<std::size_t>(f[1])] - a)
                             .cross(part.surface.points[static_cast<std::size_t>(f[2])] - a);
        if (std::abs(n[thin]) > 0.5 * n.norm())
          along[static_cast<std::size_t>(part.surface.facet_face[k])] += n[thin];
      }
      for (const double n : along)
        if (n != 0) shown += n * direction[thin] < 0 ? 1 : -1;
    }
    // From below only if there is much more to see there.
    const double much = thin == 2 ? 0.5 : 0.0;
    if (shown < -much * all) direction[thin] = -direction[thin];
  }
  return direction.normalized();
}

void ModelView::look_isometric() {
  if (scene_) look(first_direction(), Vec<3>::UnitZ());
}

void ModelView::look_near(const Vec<3>& center, double radius) {
  if (!view_) return;
  view_->fit({center[0] - radius, center[0] + radius, center[1] - radius, center[1] + radius,
              center[2] - radius, center[2] + radius});
}

void ModelView::look_at_section() {
  if (!view_ || session_.empty()) return;
  if (!section_) start_section(-1);
  auto bounds = scene_->bounds();
  // Of the box, what is left behind the plane and near it.
  for (int axis = 0; axis < 3; ++axis) {
    const double n = section_->normal[axis];
    if (std::abs(n) < 0.9) continue;
    const double at = section_->origin[axis];
    double depth = 0;
    for (int other = 0; other < 3; ++other)
      if (other != axis) depth = std::max(depth, bounds[2 * other + 1] - bounds[2 * other]);
    if (n > 0) {
      bounds[2 * axis + 1] = at;
      bounds[2 * axis] = std::max(bounds[2 * axis], at - depth * 0.8);
    } else {
      bounds[2 * axis] = at;
      bounds[2 * axis + 1] = std::min(bounds[2 * axis + 1], at + depth * 0.8);
    }
  }
  const Vec<3> n = section_->normal;
  const Vec<3> up = std::abs(n[2]) > 0.9 ? Vec<3>::UnitY() : Vec<3>::UnitZ();
  const Vec<3> from = (n + 0.45 * up + 0.4 * n.cross(up)).normalized();
  view_->look(-from, up, bounds);
}

QImage ModelView::picture() {
  if (!view_) return {};
  if (section_pending_) {
    section_pending_ = false;
    scene_->set_section(section_);
    refresh();
  }
  overlay_->set_handle_visible(false);
  const QImage image = view_->grab().toImage();
  overlay_->set_handle_visible(true);
  return image;
}

}  // namespace lamella::ui
