#include "ui/views/pick_tools.h"

#include <vtkCellArray.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include <QCoreApplication>
#include <QFontMetricsF>
#include <QMouseEvent>
#include <QPainter>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/triangles.h"
#include "ui/actions/actions.h"
#include "ui/commands/study_edits.h"
#include "ui/session/session.h"
#include "ui/theme.h"
#include "ui/units.h"
#include "ui/views/mesh_data.h"
#include "ui/views/vtk_view.h"

namespace lamella::ui {
namespace {

/// Radius of a new sphere, as a share of the body's diagonal.
constexpr double gate_share = 0.05;

struct Texts {
  Q_DECLARE_TR_FUNCTIONS(lamella::ui::PickTools)
};

void paint_tag(QPainter& painter, const QPointF& at, const QString& text) {
  QFont bold = painter.font();
  bold.setWeight(QFont::DemiBold);
  painter.setFont(bold);
  const QRectF box = QFontMetricsF(bold).boundingRect(QRectF(0, 0, 400, 100), 0, text);
  const QRectF tag(at.x() + 12, at.y() - box.height() / 2 - 4, box.width() + 16, box.height() + 8);
  painter.setPen(QPen(theme::border, 1));
  painter.setBrush(QColor(theme::panel.red(), theme::panel.green(), theme::panel.blue(), 235));
  painter.drawRoundedRect(tag, 5, 5);
  painter.setPen(theme::text);
  painter.drawText(tag, Qt::AlignCenter, text);
}

void paint_dot(QPainter& painter, const QPointF& at, const QColor& color) {
  painter.setPen(QPen(Qt::white, 1.5));
  painter.setBrush(color);
  painter.drawEllipse(at, 4.5, 4.5);
}

/// The ellipsoid of the metric around `at`, as triangles.
vtkSmartPointer<vtkPolyData> ellipsoid_data(const Metric<3>& metric, const Vec<3>& at) {
  constexpr int count = 40;
  constexpr int rings = 21;
  std::vector<Vec<3>> points = unit_ball(metric, count, rings);
  for (Vec<3>& p : points) p += at;
  vtkNew<vtkCellArray> cells;
  for (int j = 0; j + 1 < rings; ++j)
    for (int i = 0; i < count; ++i) {
      const vtkIdType a = j * count + i, b = j * count + (i + 1) % count;
      const vtkIdType quad[4] = {a, b, b + count, a + count};
      cells->InsertNextCell(4, quad);
    }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(make_points(points));
  data->SetPolys(cells);
  return data;
}

}  // namespace

PickTools::PickTools(Session& session, Actions& actions, VtkView& view, Scene& scene)
    : session_(session), actions_(actions), view_(view), scene_(scene) {
  ellipsoid_ = vtkSmartPointer<vtkActor>::New();
  ellipsoid_->VisibilityOff();
  ellipsoid_->GetProperty()->SetColor(0.90, 0.60, 0.15);
  ellipsoid_->GetProperty()->SetOpacity(0.75);
  ellipsoid_->GetProperty()->SetAmbient(0.35);
  view_.renderer()->AddActor(ellipsoid_);
}

PickTools::~PickTools() { view_.renderer()->RemoveActor(ellipsoid_); }

bool PickTools::mouse(QMouseEvent* event) {
  if (actions_.mode() != Act::box_zoom) {
    corner_.reset();
    return false;
  }
  if (event->type() == QEvent::MouseButtonPress && event->button() == Qt::LeftButton) {
    corner_ = opposite_ = event->position();
    return true;
  }
  if (!corner_) return false;
  opposite_ = event->position();
  if (event->type() == QEvent::MouseButtonRelease) {
    const QRectF box = QRectF(*corner_, opposite_).normalized();
    corner_.reset();
    if (box.width() > 8 && box.height() > 8) view_.zoom_to(box);
    actions_.leave_mode();
  }
  return true;
}

bool PickTools::click(const std::optional<Picked>& picked) {
  const Act mode = actions_.mode();
  if (mode == Act::count || mode == Act::box_zoom) return false;
  if (!picked) return true;  // beside the model: the mode goes on
  const std::string body = picked->part < 0 ? std::string() : session_.body(picked->part).name;
  switch (mode) {
    case Act::pick_faces:
      pick_face(*picked);
      break;
    case Act::pick_flood:
      flood_from(*picked);
      break;
    case Act::correct_near:
      if (picked->part < 0) break;
      add_sizing(session_, body, Texts::tr("near gate"),
                 SphereShape{picked->point, gate_share * diagonal_of(picked->part)});
      actions_.leave_mode();
      break;
    case Act::correct_face: {
      if (!session_.is_part(picked->part) || !picked->face) break;
      FacesShape shape;
      shape.ids = {*picked->face};
      add_sizing(session_, body, Texts::tr("face size"), shape);
      actions_.leave_mode();
      break;
    }
    case Act::measure:
      if (measured_.size() == 3) measured_.clear();
      measured_.push_back(picked->point);
      break;
    case Act::ellipsoid:
      show_metric(*picked);
      break;
    default:
      break;
  }
  return true;
}

double PickTools::diagonal_of(int part) const { return 1e3 * session_.automatic_size(part); }

void PickTools::pick_face(const Picked& picked) {
  // Groups are of parts: faces of a zone have no numbers that last.
  if (!session_.is_part(picked.part) || !picked.face) return;
  const std::string& body = session_.body(picked.part).name;
  if (session_.item().kind == ItemKind::group)
    toggle_face(session_, session_.item().index, body, *picked.face);
  else
    add_group(session_, GroupKind::gate, body, {*picked.face});
}

void PickTools::flood_from(const Picked& picked) {
  if (!session_.is_part(picked.part)) return;
  const std::string body = session_.body(picked.part).name;
  if (session_.item().kind != ItemKind::group) add_group(session_, GroupKind::gate, body, {});
  const double angle = actions_[Act::pick_flood]->data().toDouble();
  edit_group(session_, session_.item().index, Texts::tr("Flood %1 from a point"),
             [&](BoundaryGroup& group) {
               const bool fresh =
                   group.faces.empty() && group.face_names.empty() && group.floods.empty();
               if (fresh) group.body = body;
               if (group.body == body || group.body.empty())
                 group.floods.push_back({picked.point, angle > 0 ? angle : Flood{}.angle});
             });
  actions_.leave_mode();
}

void PickTools::show_metric(const Picked& picked) {
  const auto state = session_.shown_state();
  if (!state || picked.element < 0 || state->metric.size() != state->mesh.points.size()) {
    metric_text_ = Texts::tr("This mesh has no metric");
    metric_at_ = picked.point;
    ellipsoid_->VisibilityOff();
    return;
  }
  NodeId node = 0;
  double nearest = std::numeric_limits<double>::max();
  for (const NodeId n : state->mesh.elements[static_cast<std::size_t>(picked.element)]) {
    const double d = (state->mesh.points[static_cast<std::size_t>(n)] - picked.point).norm();
    if (d >= nearest) continue;
    nearest = d;
    node = n;
  }
  const auto n = static_cast<std::size_t>(node);
  metric_at_ = state->mesh.points[n];
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(ellipsoid_data(state->metric[n], metric_at_));
  normals->Update();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(normals->GetOutput());
  ellipsoid_->SetMapper(mapper);
  ellipsoid_->VisibilityOn();
  const Vec<3> h = sizes<3>(state->metric[n]);
  metric_text_ = Texts::tr("asked: %1").arg(units::size(h, 3));
  if (n < state->thickness.size() && state->thickness[n] > 0)
    metric_text_ += "\n" + Texts::tr("wall: %1").arg(units::length(state->thickness[n], 3));
}

void PickTools::mark(const Vec<3>& at, const QString& text) {
  place_ = at;
  place_text_ = text;
}

void PickTools::forget() {
  measured_.clear();
  place_.reset();
  metric_text_.clear();
  ellipsoid_->VisibilityOff();
  view_.update();
}

void PickTools::paint(QPainter& painter) const {
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  std::vector<QPointF> at;
  for (const Vec<3>& p : measured_) at.push_back(view_.project(p));
  for (std::size_t k = 1; k < at.size(); ++k) {
    painter.setPen(QPen(Qt::white, 4));
    painter.drawLine(at[k - 1], at[k]);
    painter.setPen(QPen(theme::warning, 2));
    painter.drawLine(at[k - 1], at[k]);
  }
  for (const QPointF& p : at) paint_dot(painter, p, theme::warning);
  for (std::size_t k = 1; k < at.size(); ++k) {
    const Vec<3> d = measured_[k] - measured_[k - 1];
    paint_tag(painter, (at[k - 1] + at[k]) / 2, units::length(d.norm(), 5));
  }
  if (at.size() == 3) {
    const Vec<3> a = measured_[0] - measured_[1];
    const Vec<3> b = measured_[2] - measured_[1];
    paint_tag(
        painter, at[1],
        written(std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi, 'f', 1) + "°");
  }
  if (!metric_text_.isEmpty()) paint_tag(painter, view_.project(metric_at_), metric_text_);
  if (place_) {
    const QPointF p = view_.project(*place_);
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(Qt::white, 5));
    painter.drawEllipse(p, 13, 13);
    painter.setPen(QPen(theme::danger, 2.5));
    painter.drawEllipse(p, 13, 13);
    paint_tag(painter, p + QPointF(8, 0), place_text_);
  }
  if (corner_) {
    QColor fill = theme::accent;
    fill.setAlpha(30);
    painter.setBrush(fill);
    painter.setPen(QPen(theme::accent, 1.2, Qt::DashLine));
    painter.drawRect(QRectF(*corner_, opposite_).normalized());
  }
  painter.restore();
}

QString PickTools::hint() const {
  const bool group = session_.item().kind == ItemKind::group;
  switch (actions_.mode()) {
    case Act::pick_faces:
      return group ? Texts::tr("Click faces to add them to “%1” or to take them out. Esc ends.")
                         .arg(QString::fromStdString(
                             session_.study()
                                 .groups[static_cast<std::size_t>(session_.item().index)]
                                 .name))
                   : Texts::tr("Click the first face of a new group. Esc ends.");
    case Act::pick_flood:
      return Texts::tr("Click where the group is to begin. Esc ends.");
    case Act::correct_near:
      return Texts::tr("Click the gate, or any place that needs a size of its own. Esc ends.");
    case Act::correct_face:
      return Texts::tr("Click the face that is to have a size of its own. Esc ends.");
    case Act::measure:
      return measured_.size() == 1 ? Texts::tr("Click the second place. Esc ends.")
             : measured_.size() == 2
                 ? Texts::tr("A third place gives the angle. Esc ends.")
                 : Texts::tr("Click two places to see their distance. Esc ends.");
    case Act::ellipsoid:
      return session_.shown_state()
                 ? Texts::tr("Click the mesh to see the sizes asked there. Esc ends.")
                 : Texts::tr("Sizes are known once there is a mesh. Esc ends.");
    case Act::box_zoom:
      return Texts::tr("Draw a rectangle around what is to come close. Esc ends.");
    default:
      return {};
  }
}

}  // namespace lamella::ui
