#pragma once

#include <QOpenGLWidget>
#include <QPointF>
#include <QPointer>
#include <QRectF>
#include <QTimer>
#include <array>
#include <functional>
#include <memory>

#include "core/geometry/simplex.h"

class QOpenGLContext;
class vtkRenderer;

namespace lamella::ui {

/// A Qt widget that shows one VTK renderer, with the camera under the mouse: left turns, middle or
/// Shift+left shifts, the wheel and right zoom towards the cursor. Arrow keys turn, with Shift they
/// shift, + and - zoom.
///
/// VTK draws into its own framebuffer, which is copied into the widget's; the widget and VTK never
/// share OpenGL state. All positions are in logical pixels from the top left.
class VtkView : public QOpenGLWidget {
  Q_OBJECT

 public:
  explicit VtkView(QWidget* parent = nullptr);
  ~VtkView() override;

  /// False where no OpenGL context can be made; then no VtkView may be shown.
  static bool supported();
  /// The format every window of the application needs; set it before QApplication is made.
  static QSurfaceFormat format();

  vtkRenderer* renderer() const;

  /// Where a point of space (mm) is seen.
  QPointF project(const Vec<3>& point) const;
  /// The point seen at `position` as deep as `like`.
  Vec<3> unproject(const QPointF& position, const Vec<3>& like) const;
  /// mm a pixel, at the depth of the focal point.
  double pixel_size() const;

  /// Looks along `direction` with `up` upward and fits `bounds` (x0 x1 y0 y1 z0 z1).
  void look(const Vec<3>& direction, const Vec<3>& up, const std::array<double, 6>& bounds);
  void fit(const std::array<double, 6>& bounds);
  /// Brings what is in a rectangle of the picture close.
  void zoom_to(const QRectF& box);
  void set_perspective(bool on);
  bool perspective() const;
  /// Background in the colors of the theme.
  void refresh_theme();

  /// Draws what comes within the next moment fast rather than well, and once more at rest: for
  /// whatever follows the mouse.
  void hurry();
  /// The same for a mesh that is about to come: the picture is then drawn as if the camera moved.
  void arrive();
  /// Ends that at once.
  void settle();
  /// Nothing is to hold the event loop: where the processor draws, a picture at rest comes in one
  /// turn of the loop and its smooth edges in the next.
  void draw_in_steps(bool on);
  /// Triangles that are drawn several times a second.
  int fast_triangles() const { return software_ ? 60'000 : 3'000'000; }
  /// The camera moves, or did so a moment ago.
  bool moving() const { return moving_; }
  /// Takes the camera of another view, as if it had been moved here.
  void follow(const VtkView& other);

  /// Sees mouse events before the camera does; returns true to keep one for itself.
  using MouseFilter = std::function<bool(QMouseEvent*)>;
  void set_mouse_filter(MouseFilter filter) { filter_ = std::move(filter); }

 Q_SIGNALS:
  /// The picture is up to date.
  void rendered();
  void moving_changed(bool on);

 protected:
  void initializeGL() override;
  void resizeGL(int width, int height) override;
  void paintGL() override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void release_gl();
  void rest();
  /// Takes what is to be drawn to where it is drawn from, which is half of the first picture.
  void upload();
  void render();
  void camera_moved();
  void zoom(double factor, const QPointF& at);
  void rotate(const QPointF& by);
  void pan(const QPointF& by);

  struct Vtk;
  std::unique_ptr<Vtk> vtk_;
  QPointer<QOpenGLContext> context_;
  std::array<double, 6> pending_fit_{};
  bool fit_pending_ = false;
  // Half of what was in sight when the camera was moved last, mm; the scale that a resize gave.
  double seen_width_ = 0, seen_height_ = 0, kept_scale_ = 0;
  bool sized_ = false;
  bool drawing_ = false;
  bool software_ = false;
  bool hurried_ = false;
  bool arrived_ = false;
  bool in_steps_ = false;
  bool moving_ = false;
  QTimer rest_;
  MouseFilter filter_;
  QPointF last_;
  Qt::MouseButton drag_ = Qt::NoButton;
};

}  // namespace lamella::ui
