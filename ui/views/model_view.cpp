#include "ui/views/model_view.h"

#include <vtkCamera.h>
#include <vtkRenderer.h>

#include <QKeyEvent>
#include <QLabel>
#include <QMenu>
#include <QMouseEvent>
#include <QSplitter>
#include <QTimer>
#include <cmath>

#include "core/study/study_file.h"
#include "ui/actions/actions.h"
#include "ui/commands/study_edits.h"
#include "ui/session/asked_sizes.h"
#include "ui/session/session.h"
#include "ui/session/wall_map.h"
#include "ui/theme.h"
#include "ui/units.h"
#include "ui/views/compare_view.h"
#include "ui/views/first_direction.h"
#include "ui/views/mesh_skin.h"
#include "ui/views/overlay.h"
#include "ui/views/pick_tools.h"
#include "ui/views/size_shapes.h"
#include "ui/views/size_tool.h"
#include "ui/views/view_bar.h"
#include "ui/views/vtk_view.h"

namespace lamella::ui {

ModelView::ModelView(Session& session, Actions& actions, QWidget* parent)
    : QWidget(parent), session_(session), actions_(actions) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  walls_ = std::make_unique<WallMap>(session);
  connect(walls_.get(), &WallMap::changed, this, &ModelView::follow_walls);
  bar_ = new ViewBar(actions);
  layout->addWidget(bar_);
  connect(bar_, &ViewBar::color_changed, this, &ModelView::follow_study);
  connect(bar_, &ViewBar::body_chosen, this, [this](int body) {
    if (session_.has_bodies())
      session_.select(body);
    else
      follow_study();
  });
  connect(bar_, &ViewBar::slide_started, this, [this] { drag_merge_ = session_.new_merge(); });
  connect(bar_, &ViewBar::slid, this, [this](double at) { slide_to(at, drag_merge_); });
  connect(bar_, &ViewBar::moved, this, [this](double at) { slide_to(at, 0); });
  auto* frame = new QFrame;
  frame->setObjectName("view_frame");
  auto* inner = new QVBoxLayout(frame);
  inner->setContentsMargins(1, 1, 1, 1);
  sides_ = new QSplitter(Qt::Horizontal);
  sides_->setHandleWidth(6);
  sides_->setChildrenCollapsible(false);
  sides_->addWidget(frame);
  layout->addWidget(sides_, 1);
  if (VtkView::supported()) {
    view_ = new VtkView;
    scene_ = std::make_unique<Scene>(*view_->renderer());
    shapes_ = std::make_unique<SizeShapes>(*view_->renderer());
    picks_ = std::make_unique<PickTools>(session_, actions_, *view_, *scene_);
    tool_ = std::make_unique<SectionTool>(*view_, [this](const Section& moved) {
      const auto now = section();
      if (now && moved.origin == now->origin && moved.normal == now->normal)
        overlay_->update();  // only another look of the handle
      else
        set_section(moved, drag_merge_);
    });
    size_tool_ = std::make_unique<SizeTool>(*view_, [this](const SizingShape& shape, int drag) {
      if (size_merge_.first != drag) size_merge_ = {drag, session_.new_merge()};
      if (const int zone = selected_zone(); zone >= 0)
        return edit_zone(
            session_, zone, tr("Shape of %1"), [&](StudyZone& z) { set_shape(z, shape); },
            size_merge_.second);
      edit_sizing(
          session_, session_.item().index, tr("Move %1"),
          [&](SizingObject& object) { object.shape = shape; }, size_merge_.second);
    });
    overlay_ = new Overlay(*view_);
    overlay_->add([this](QPainter& p) { tool_->paint(p); }, true);
    overlay_->add([this](QPainter& p) { size_tool_->paint(p); }, true);
    overlay_->add([this](QPainter& p) { picks_->paint(p); }, false);
    view_->set_mouse_filter([this](QMouseEvent* event) { return mouse(event); });
    connect(view_, &VtkView::moving_changed, this,
            [this](bool on) { scene_->set_moving(on, view_->fast_triangles()); });
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

void ModelView::connect_session() {
  connect(&Units::get(), &Units::changed, this, [this] {
    if (scene_) refresh();
  });
  connect(&session_, &Session::parts_changed, this, &ModelView::follow_parts);
  connect(&session_, &Session::study_changed, this, &ModelView::follow_study);
  connect(&session_, &Session::surfaces_changed, this, &ModelView::follow_surfaces);
  connect(&session_, &Session::selection_changed, this, &ModelView::follow_selection);
  connect(&session_, &Session::shown_changed, this, &ModelView::follow_mesh);
  connect(&session_, &Session::activity_changed, this, [this] {
    if (view_) view_->draw_in_steps(session_.activity() == Activity::running);
  });
  connect(&session_, &Session::place_shown, this,
          [this](const Vec<3>& at, double radius, const QString& text) {
            if (!scene_) return;
            look_near(at, radius);
            picks_->mark(at, text);
            overlay_->update();
          });
  connect(&session_, &Session::overlaps_changed, this, [this] {
    if (picks_) picks_->forget();  // the overlap marked is not there anymore
  });
  connect(&session_, &Session::cut_asked, this, [this](const Vec<3>& at) {
    if (!scene_) return;
    Section cut = section().value_or(section_across({true, true, true}));
    cut.origin = at;
    set_section(cut);
  });
}

void ModelView::connect_actions() {
  for (const auto& [act, set] :
       {std::pair(Act::crinkle, &Scene::set_crinkle), std::pair(Act::edges, &Scene::set_edges),
        std::pair(Act::features, &Scene::set_features)})
    connect(actions_[act], &QAction::toggled, this, [this, set = set](bool on) {
      if (!scene_) return;
      each_scene([&](Scene& s) { (s.*set)(on); });
      refresh();
    });
  for (const Act act : {Act::flow_arrows, Act::flow_lines, Act::flow_levels})
    connect(actions_[act], &QAction::toggled, this, [this] {
      if (!scene_) return;
      each_scene([look = flow_look()](Scene& s) { s.set_flow(look); });
      refresh();
    });
  connect(actions_[Act::compare], &QAction::toggled, this, &ModelView::compare);
  connect(actions_[Act::section], &QAction::toggled, this, [this](bool on) {
    if (on == section().has_value()) return;
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
    if (std::optional<Section> now = section()) {
      now->normal = -now->normal;
      set_section(now);
    }
  });
  connect(actions_[Act::add_cut], &QAction::triggered, this, &ModelView::add_section);
  for (int a = int(Act::pick_faces); a <= int(Act::box_zoom); ++a)
    connect(actions_[Act(a)], &QAction::toggled, this, &ModelView::follow_mode);
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
  const bool had = scene_->bounds()[0] <= scene_->bounds()[1];
  each_scene([this](Scene& s) { set_parts(s); });
  tool_->set_bounds(scene_->bounds());
  groups_shown_.clear();
  follow_study();
  if (!had) look_isometric();
}

void ModelView::set_parts(Scene& scene) {
  std::vector<QColor> colors;
  for (std::size_t k = 0; k < session_.shapes().size(); ++k)
    colors.push_back(session_.color_of(static_cast<int>(k)));
  scene.set_parts(session_.shapes(), colors);
  scene.set_walls(walls_->maps());
  scene.set_hull(session_.hull());
}

void ModelView::each_scene(const std::function<void(Scene&)>& change) {
  if (scene_) change(*scene_);
  if (compare_) change(compare_->scene());
}

FlowLook ModelView::flow_look() const {
  return {actions_[Act::flow_arrows]->isChecked(), actions_[Act::flow_lines]->isChecked(),
          actions_[Act::flow_levels]->isChecked()};
}

void ModelView::compare(bool on) {
  if (!scene_ || on == (compare_ != nullptr)) return;
  if (!on) {
    delete compare_;
    compare_ = nullptr;
    return;
  }
  compare_ = new CompareView(session_, *view_);
  Scene& other = compare_->scene();
  set_parts(other);
  other.set_edges(actions_[Act::edges]->isChecked());
  other.set_features(actions_[Act::features]->isChecked());
  other.set_crinkle(actions_[Act::crinkle]->isChecked());
  other.set_quality_range(quality_range_);
  groups_shown_.clear();
  follow_study();
  other.set_sections(sections_);
  other.set_flow(flow_look());
  sides_->insertWidget(0, compare_);
  sides_->setSizes({sides_->width() / 2, sides_->width() / 2});
  refresh();
}

void ModelView::follow_parts() {
  if (!scene_) return;
  picks_->forget();
  actions_.leave_mode();
  current_cut_ = -1;
  follow_surfaces();
  tool_->set_bounds(scene_->bounds());
  look_isometric();
}

void ModelView::follow_selection() {
  if (!scene_) return;
  const Item item = session_.item();
  scene_->set_selected(item.kind == ItemKind::body ? session_.selection() : std::vector<int>{});
  if (item.kind == ItemKind::cut) current_cut_ = item.index;
  // Picking faces goes on only with a group to pick them for.
  if (item.kind != ItemKind::group && item.kind != ItemKind::body &&
      (actions_.mode() == Act::pick_faces || actions_.mode() == Act::pick_flood))
    actions_.leave_mode();
  follow_study();
}

std::optional<Picked> ModelView::pick(const QPointF& at) const {
  view_->settle();
  const double ratio = view_->devicePixelRatioF();
  return scene_->pick(at.x() * ratio, (view_->height() - 1 - at.y()) * ratio);
}

bool ModelView::mouse(QMouseEvent* event) {
  if (event->type() == QEvent::MouseButtonPress) drag_merge_ = session_.new_merge();
  // A mode has the clicks to itself, also where a handle is.
  const bool free = actions_.mode() == Act::count;
  const bool taken =
      picks_->mouse(event) || (free && (size_tool_->mouse(event) || tool_->mouse(event)));
  if (taken || event->type() == QEvent::MouseMove) overlay_->update();
  const bool clicks = event->button() == Qt::LeftButton || event->button() == Qt::RightButton;
  if (event->type() == QEvent::MouseButtonPress) {
    pressed_.reset();
    if (!taken && clicks) pressed_ = event->position();
  } else if (event->type() == QEvent::MouseButtonRelease && pressed_) {
    const QPointF moved = event->position() - *pressed_;
    pressed_.reset();
    if (std::hypot(moved.x(), moved.y()) >= 4) return taken;
    if (event->button() == Qt::RightButton) {
      context_menu(event->position().toPoint());
      return taken;
    }
    const std::optional<Picked> picked = pick(event->position());
    if (picks_->click(picked)) {
      follow_mode();
      view_->update();
      return taken;
    }
    const int part = picked ? picked->part : -1;
    std::vector<int> parts = session_.selection();
    if (part >= 0 && event->modifiers() & Qt::ControlModifier) {
      if (std::erase(parts, part) == 0) parts.push_back(part);
      session_.select(std::move(parts), part);
    } else if (part >= 0) {
      session_.select(part);
    }
  }
  return taken;
}

void ModelView::context_menu(const QPoint& at) {
  const std::optional<Picked> picked = pick(at);
  QMenu menu(this);
  if (picked && picked->part >= 0) {
    const int part = picked->part;
    session_.select(part);
    menu.addAction(
        tr("Hide %1").arg(QString::fromStdString(session_.body(part).name)), this, [this, part] {
          BodySettings body = session_.body(part);
          body.visible = false;
          session_.edit_body(part, tr("Hide %1").arg(QString::fromStdString(body.name)), body);
        });
    if (picked->face && session_.is_part(part)) {
      menu.addAction(actions_[Act::add_group]->icon(), tr("New boundary group of this face"), this,
                     [this, part, face = *picked->face] {
                       add_group(session_, GroupKind::gate, session_.body(part).name, {face});
                     });
      menu.addAction(tr("Give this face a size"), this, [this, part, face = *picked->face] {
        FacesShape shape;
        shape.ids = {face};
        add_sizing(session_, session_.body(part).name, tr("face size"), shape);
      });
    }
    menu.addAction(actions_[Act::correct_near]->icon(), tr("Correct near this point"), this,
                   [this, at] {
                     actions_[Act::correct_near]->setChecked(true);
                     picks_->click(pick(at));
                     follow_mode();
                   });
    menu.addSeparator();
  }
  menu.addAction(tr("Show all bodies"), this, [this] { show_all_bodies(session_); });
  for (const Act act : {Act::section, Act::fit, Act::view_iso, Act::measure, Act::save_picture})
    menu.addAction(actions_[act]);
  menu.exec(view_->mapToGlobal(at));
}

void ModelView::keyPressEvent(QKeyEvent* event) {
  if (event->key() != Qt::Key_Escape) return QWidget::keyPressEvent(event);
  actions_.leave_mode();
  picks_->forget();
  walls_->stop();
  follow_mode();
  view_->update();
}

void ModelView::follow_mode() {
  if (!scene_) return;
  if (actions_.mode() == Act::pick_faces || actions_.mode() == Act::correct_near ||
      actions_.mode() == Act::measure)
    view_->setFocus();
  view_->setCursor(actions_.mode() == Act::count ? Qt::ArrowCursor : Qt::CrossCursor);
  overlay_->set_hint(picks_->hint());
  overlay_->update();
}

void ModelView::follow_study() {
  if (!scene_) return;
  std::vector<bool> visible;
  std::vector<QColor> colors;
  int layers = 4;
  const int count = static_cast<int>(session_.study().bodies.size());
  for (int k = 0; k < count; ++k) {
    visible.push_back(session_.body(k).visible);
    colors.push_back(session_.color_of(k));
  }
  if (count > 0) layers = session_.body(std::clamp(session_.selected(), 0, count - 1)).layers;
  const std::string filled_by = choose_filled();
  each_scene([&](Scene& s) {
    s.set_visible(visible);
    s.set_colors(colors);
    s.set_color_by(color_by(), layers, filled_by);
  });
  walls_->want(of_walls(color_by()) && !session_.shown_state());
  if (of_walls(color_by()) && !session_.shown_state()) follow_walls();
  follow_cuts();
  follow_groups();
  follow_sizes();
  overlay_->set_hint(picks_->hint());
  refresh();
}

std::string ModelView::choose_filled() {
  std::vector<std::string> names;
  for (const BodySettings& body : session_.study().bodies) names.push_back(body.name);
  const auto state = session_.shown_state();
  const bool alone = names.empty();  // a mesh that was opened without a study
  if (alone && state) names = state->mesh.bodies;
  const int last = static_cast<int>(names.size()) - 1;
  const int current = std::clamp(alone ? bar_->body() : session_.selected(), 0, std::max(0, last));
  QStringList shown;
  for (const std::string& name : names) shown << QString::fromStdString(name);
  bar_->show_bodies(shown, current);
  return last < 0 ? std::string() : names[static_cast<std::size_t>(current)];
}

void ModelView::follow_groups() {
  const Study& study = session_.study();
  Study only;
  only.groups = study.groups;
  std::string key = study_to_json(only);
  if (key == groups_shown_) return;
  groups_shown_ = std::move(key);
  std::vector<QColor> colors;
  std::vector<std::vector<int>> facet_group;
  for (const Part& part : session_.shapes())
    facet_group.emplace_back(part.surface.facets.size(), -1);
  for (std::size_t g = 0; g < study.groups.size(); ++g) {
    colors.push_back(group_color(static_cast<int>(g)));
    for (std::size_t p = 0; p < session_.parts().size(); ++p) {
      const Part& part = session_.parts()[p];
      const bool here = study.groups[g].body == part.name ||
                        (study.groups[g].body.empty() && session_.parts().size() == 1);
      if (!here) continue;
      // A group without faces yet is no mistake here.
      const auto facets = facets_of(study.groups[g], part.surface);
      if (!facets) continue;
      for (const std::int32_t f : *facets) {
        int& group = facet_group[p][static_cast<std::size_t>(f)];
        if (group < 0) group = static_cast<int>(g);
      }
    }
  }
  each_scene([&](Scene& s) { s.set_groups(facet_group, colors); });
}

int ModelView::selected_zone() const {
  const Item item = session_.item();
  const bool one = item.kind == ItemKind::body && session_.selection().size() == 1;
  return one && session_.is_zone(item.index)
             ? item.index - static_cast<int>(session_.parts().size())
             : -1;
}

void ModelView::follow_sizes() {
  const Item item = session_.item();
  const bool chosen = item.kind == ItemKind::sizing;
  shapes_->set(session_.study().sizing, session_.shapes(), chosen ? item.index : -1);
  const int zone = selected_zone();
  if (zone >= 0)
    return size_tool_->set(knobs_of(session_.study().zones[static_cast<std::size_t>(zone)]));
  size_tool_->set(
      chosen ? std::optional(session_.study().sizing[static_cast<std::size_t>(item.index)].shape)
             : std::nullopt);
}

void ModelView::follow_walls() {
  if (!scene_) return;
  const WallMap::Maps maps =
      color_by() == ColorBy::size ? asked_sizes(session_, walls_->maps()) : walls_->maps();
  each_scene([&](Scene& s) { s.set_walls(maps); });
  refresh();
}

void ModelView::follow_mesh() {
  if (!scene_) return;
  const bool had = scene_->bounds()[0] <= scene_->bounds()[1];
  picks_->forget();
  if (session_.activity() == Activity::running) view_->arrive();
  scene_->set_mesh(session_.shown_state(), session_.shown_prepared());
  walls_->want(of_walls(color_by()) && !session_.shown_state());
  if (!session_.has_bodies()) follow_study();
  tool_->set_bounds(scene_->bounds());
  if (!had) look_isometric();
  refresh();
}

void ModelView::refresh() {
  Legend legend = scene_->legend();
  if (!session_.shown_state() && of_walls(color_by()) && !walls_->status().isEmpty())
    legend.missing = walls_->status();
  overlay_->set_legend(legend);
  overlay_->set_scale_visible(!session_.empty());
  SkinChoice drawn = scene_->skin_choice();
  drawn.fast = view_->fast_triangles();
  session_.draw_as(std::move(drawn));
  view_->update();
  if (compare_) compare_->refresh();
}

void ModelView::set_color_by(ColorBy color_by) { bar_->set_color_by(color_by); }

ColorBy ModelView::color_by() const { return bar_->color_by(); }

Section ModelView::section_across(const std::array<bool, 3>& axes) const {
  Vec<3> direction;
  view_->renderer()->GetActiveCamera()->GetDirectionOfProjection(direction.data());
  return first_section(scene_->bounds(), direction, axes);
}

void ModelView::start_section(int axis) {
  if (!scene_ || session_.empty()) {
    actions_[Act::section]->setChecked(false);
    return;
  }
  const int cuts = static_cast<int>(session_.study().cuts.size());
  if (axis < 0 && cuts > 0) {
    current_cut_ = std::clamp(current_cut_, 0, cuts - 1);
    edit_cut(session_, current_cut_, tr("Turn %1 on"), [](CutPlane& c) { c.on = true; });
  } else {
    set_section(
        section_across({axis < 0 || axis == 0, axis < 0 || axis == 1, axis < 0 || axis == 2}));
  }
}

void ModelView::add_section() {
  if (!scene_ || session_.empty()) return;
  // Across an axis that no cut is across yet.
  std::array<bool, 3> axes{true, true, true};
  for (std::size_t k = 0; k < 3; ++k)
    axes[k] = std::none_of(sections_.begin(), sections_.end(), [&](const Section& s) {
      return std::abs(s.normal[static_cast<Eigen::Index>(k)]) > 0.9;
    });
  const bool none = axes == std::array<bool, 3>{};
  const Section section = section_across(none ? std::array{true, true, true} : axes);
  add_cut(session_, section.origin, section.normal);
}

std::optional<Section> ModelView::section() const {
  const auto& cuts = session_.study().cuts;
  const auto k = static_cast<std::size_t>(current_cut_);
  if (current_cut_ < 0 || k >= cuts.size() || !cuts[k].on) return {};
  return Section{cuts[k].origin, cuts[k].normal};
}

void ModelView::set_section(const std::optional<Section>& section, int merge) {
  const auto& cuts = session_.study().cuts;
  if (section && current_cut_ >= 0 && current_cut_ < static_cast<int>(cuts.size())) {
    edit_cut(
        session_, current_cut_, tr("Move %1"),
        [&](CutPlane& cut) {
          cut.origin = section->origin;
          cut.normal = section->normal;
          cut.on = true;
        },
        merge);
  } else if (section) {
    // The handle is on the new cut, but what was selected stays so.
    const Item item = session_.item();
    const std::vector<int> parts = session_.selection();
    current_cut_ = static_cast<int>(cuts.size());
    add_cut(session_, section->origin, section->normal);
    if (item.kind == ItemKind::body)
      session_.select(parts, item.index);
    else
      session_.select_item(item);
  } else if (std::any_of(cuts.begin(), cuts.end(), [](const CutPlane& c) { return c.on; })) {
    Study study = session_.study();
    for (CutPlane& cut : study.cuts) cut.on = false;
    session_.edit(tr("Turn the cuts off"), std::move(study));
  }
}

void ModelView::slide_to(double position, int merge) {
  std::optional<Section> now = section();
  if (!now) return;
  now->origin += now->normal * (position - now->origin.dot(now->normal));
  set_section(now, merge);
}

void ModelView::follow_cuts() {
  const auto& cuts = session_.study().cuts;
  if (!section()) {
    current_cut_ = -1;
    for (std::size_t k = 0; k < cuts.size(); ++k)
      if (cuts[k].on) current_cut_ = static_cast<int>(k);
    if (current_cut_ < 0) current_cut_ = static_cast<int>(cuts.size()) - 1;
  }
  std::vector<Section> on;
  for (const CutPlane& cut : cuts)
    if (cut.on) on.push_back({cut.origin, cut.normal});
  const auto handle = section();
  tool_->set(handle);
  bar_->show_section(handle, scene_->bounds());
  if (on.size() == sections_.size() &&
      std::equal(on.begin(), on.end(), sections_.begin(), [](const Section& a, const Section& b) {
        return a.origin == b.origin && a.normal == b.normal;
      }))
    return;
  sections_ = std::move(on);
  apply_sections();
}

void ModelView::apply_sections() {
  overlay_->update();
  if (section_pending_) return;
  // Many moves of the mouse in one turn of the event loop make one cut.
  section_pending_ = true;
  view_->hurry();
  QTimer::singleShot(0, this, [this] {
    if (!section_pending_) return;
    section_pending_ = false;
    each_scene([this](Scene& s) { s.set_sections(sections_); });
    refresh();
  });
}

void ModelView::refresh_theme() {
  if (!view_) return;
  view_->refresh_theme();
  each_scene([this](Scene& s) { s.set_features(actions_[Act::features]->isChecked()); });
  if (compare_) compare_->refresh_theme();
  refresh();
}

void ModelView::set_quality_range(const std::optional<std::pair<double, double>>& range) {
  if (!scene_) return;
  quality_range_ = range;
  each_scene([&](Scene& s) { s.set_quality_range(range); });
  refresh();
}

QImage ModelView::picture(const QSize& pixels) {
  if (!view_) return {};
  const QSize before = view_->size();
  view_->resize(pixels / view_->devicePixelRatioF());
  picture();  // so that what lies over the picture follows the new size
  const QImage image = picture();
  view_->resize(before);
  return image;
}

std::array<double, 6> ModelView::bounds() const {
  return scene_ ? scene_->bounds() : std::array<double, 6>{1, -1, 1, -1, 1, -1};
}

void ModelView::fit() {
  if (view_ && scene_->bounds()[0] <= scene_->bounds()[1]) view_->fit(scene_->bounds());
}

void ModelView::look(const Vec<3>& direction, const Vec<3>& up) {
  if (view_ && scene_->bounds()[0] <= scene_->bounds()[1])
    view_->look(direction, up, scene_->bounds());
}

void ModelView::look_isometric() {
  if (scene_) look(first_direction(scene_->bounds(), session_.shapes()), Vec<3>::UnitZ());
}

void ModelView::look_near(const Vec<3>& center, double radius) {
  if (!view_) return;
  view_->fit({center[0] - radius, center[0] + radius, center[1] - radius, center[1] + radius,
              center[2] - radius, center[2] + radius});
}

void ModelView::look_at_section() {
  if (!view_ || session_.empty()) return;
  if (!section()) start_section(-1);
  const Section cut = *section();
  auto bounds = scene_->bounds();
  // Of the box, what is left behind the plane and near it.
  for (int axis = 0; axis < 3; ++axis) {
    const double n = cut.normal[axis];
    if (std::abs(n) < 0.9) continue;
    const double at = cut.origin[axis];
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
  const Vec<3> n = cut.normal;
  const Vec<3> up = std::abs(n[2]) > 0.9 ? Vec<3>::UnitY() : Vec<3>::UnitZ();
  const Vec<3> from = (n + 0.45 * up + 0.4 * n.cross(up)).normalized();
  view_->look(-from, up, bounds);
}

QImage ModelView::picture() {
  if (!view_) return {};
  if (section_pending_) {
    section_pending_ = false;
    each_scene([this](Scene& s) { s.set_sections(sections_); });
    refresh();
  }
  view_->settle();
  overlay_->set_handle_visible(false);
  const QImage image = view_->grab().toImage();
  overlay_->set_handle_visible(true);
  return image;
}

}  // namespace lamella::ui
