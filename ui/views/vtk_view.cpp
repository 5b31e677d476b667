#include "ui/views/vtk_view.h"

#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkOpenGLState.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QSurfaceFormat>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "ui/theme.h"
#include "ui/views/kept_memory.h"
#include "ui/views/scene_actors.h"

namespace lamella::ui {
namespace {

/// VTK asks for its context before any OpenGL call. QOpenGLWidget::makeCurrent would rebind Qt's
/// framebuffer behind VTK's state cache, so the context itself is made current, and only if needed.
void make_current(vtkObject*, unsigned long, void* client, void*) {
  auto* context = static_cast<QPointer<QOpenGLContext>*>(client)->data();
  if (context && QOpenGLContext::currentContext() != context)
    context->makeCurrent(context->surface());
}

void is_current(vtkObject*, unsigned long, void* client, void* call_data) {
  auto* context = static_cast<QPointer<QOpenGLContext>*>(client)->data();
  *static_cast<bool*>(call_data) = context && QOpenGLContext::currentContext() == context;
}

}  // namespace

/// ms without a move after which the picture is drawn well.
constexpr int rest_after = 180;
/// ms in which what waits meanwhile has its turn.
constexpr int between_steps = 20;
/// Pixels that the processor draws several times a second.
constexpr double fast_pixels = 350'000;

/// How well a picture was drawn.
enum class Drawn { fast, sharp, smooth };

struct VtkView::Vtk {
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderer> smoother;  // draws nothing but makes the edges of what is there smooth
  vtkMTimeType drawn = 0;
  Drawn drawn_how = Drawn::fast;
  bool rehearsed = false;
  int width = 1, height = 1;  // of the widget, device pixels

  /// The picture has that share of the widget's pixels along a side.
  void set_share(double share) {
    window->SetSize(std::max(1, static_cast<int>(std::lround(share * width))),
                    std::max(1, static_cast<int>(std::lround(share * height))));
  }

  /// When anything in the picture was changed last.
  vtkMTimeType changed() {
    vtkMTimeType last = std::max({renderer->GetMTime(), renderer->GetViewProps()->GetMTime(),
                                  renderer->GetActiveCamera()->GetMTime()});
    vtkActorCollection* actors = renderer->GetActors();
    actors->InitTraversal();
    while (vtkActor* actor = actors->GetNextActor())
      last = std::max(last, actor->GetVisibility() ? actor->GetRedrawMTime() : actor->GetMTime());
    return last;
  }
};

vtkRenderer* VtkView::renderer() const { return vtk_->renderer; }

QSurfaceFormat VtkView::format() {
  QSurfaceFormat format;
  format.setRenderableType(QSurfaceFormat::OpenGL);
  format.setVersion(3, 2);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  format.setStencilBufferSize(8);
  format.setSamples(0);
  return format;
}

bool VtkView::supported() {
  static const bool works = [] {
    QOpenGLContext context;
    context.setFormat(format());
    return context.create();
  }();
  return works;
}

VtkView::VtkView(QWidget* parent) : QOpenGLWidget(parent), vtk_(std::make_unique<Vtk>()) {
  setFormat(format());
  setUpdateBehavior(PartialUpdate);  // a picture that still holds stays
  setMouseTracking(true);
  setAccessibleName(tr("Model"));
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(200, 150);
  vtk_->window->SetReadyForRendering(false);
  vtk_->window->SetFrameBlitModeToNoBlit();
  vtk_->window->SetMultiSamples(0);
  vtk_->window->AddRenderer(vtk_->renderer);
  vtk_->window->SetNumberOfLayers(2);
  vtk_->smoother->SetLayer(1);
  vtk_->smoother->InteractiveOff();
  vtk_->smoother->DrawOff();
  vtk_->smoother->UseFXAAOn();
  // Without anything in it it would do nothing at all.
  vtkNew<vtkPolyDataMapper> nothing;
  nothing->SetInputData(speck(Vec<3>::Zero()));
  vtkNew<vtkActor> in_it;
  in_it->SetMapper(nothing);
  vtk_->smoother->AddActor(in_it);
  vtk_->window->AddRenderer(vtk_->smoother);
  vtk_->renderer->SetGradientBackground(true);
  refresh_theme();
  vtk_->renderer->GetActiveCamera()->ParallelProjectionOn();
  rest_.setSingleShot(true);
  rest_.setInterval(rest_after);
  connect(&rest_, &QTimer::timeout, this, &VtkView::rest);
  vtkNew<vtkCallbackCommand> make;
  make->SetCallback(make_current);
  make->SetClientData(&context_);
  vtk_->window->AddObserver(vtkCommand::WindowMakeCurrentEvent, make);
  vtkNew<vtkCallbackCommand> is;
  is->SetCallback(is_current);
  is->SetClientData(&context_);
  vtk_->window->AddObserver(vtkCommand::WindowIsCurrentEvent, is);
}

void VtkView::refresh_theme() {
  // VTK's gradient runs upward: the lighter color belongs to the top.
  if (theme::dark) {
    vtk_->renderer->SetBackground(0.24, 0.28, 0.32);
    vtk_->renderer->SetBackground2(0.40, 0.44, 0.48);
  } else {
    vtk_->renderer->SetBackground(0.86, 0.892, 0.925);
    vtk_->renderer->SetBackground2(0.985, 0.988, 0.992);
  }
}

VtkView::~VtkView() {
  // Qt would otherwise report the dying context to a half-destroyed view.
  if (context_) disconnect(context_, nullptr, this, nullptr);
  release_gl();
}

void VtkView::release_gl() {
  if (!context_) return;
  makeCurrent();
  vtk_->window->Finalize();
  vtk_->window->SetReadyForRendering(false);
  doneCurrent();
  context_ = nullptr;
}

void VtkView::initializeGL() {
  // Called again with another context when the widget is given to another window.
  if (context_) disconnect(context_, nullptr, this, nullptr);
  context_ = context();
  connect(context_, &QOpenGLContext::aboutToBeDestroyed, this, &VtkView::release_gl);
  const auto* name = reinterpret_cast<const char*>(context_->functions()->glGetString(GL_RENDERER));
  const QByteArray device(name ? name : "");
  software_ = device.contains("llvmpipe") || device.contains("softpipe");
  if (software_) keep_memory(*qApp);
  vtk_->drawn = 0;
  vtk_->rehearsed = false;
  vtk_->window->SetMultiSamples(software_ ? 0 : 8);
  vtk_->window->SetForceMaximumHardwareLineWidth(1);
  vtk_->window->SetReadyForRendering(true);
  vtk_->window->SetOwnContext(0);
  vtk_->window->SetMapped(1);
  vtk_->window->SetSupportsOpenGL(1);
  vtk_->window->SetIsDirect(1);
  vtk_->window->OpenGLInitContext();
  vtk_->window->OpenGLInit();
}

void VtkView::resizeGL(int width, int height) {
  const double ratio = devicePixelRatioF();
  vtkCamera* camera = vtk_->renderer->GetActiveCamera();
  if (sized_ && width > 0 && height > 0) {
    // What was in sight stays so, also where the view gets narrower than it was.
    if (camera->GetParallelScale() != kept_scale_) {
      seen_height_ = camera->GetParallelScale();
      seen_width_ = seen_height_ * vtk_->width / vtk_->height;
    }
    kept_scale_ = std::max(seen_height_, seen_width_ * height / width);
    camera->SetParallelScale(kept_scale_);
  }
  vtk_->width = static_cast<int>(std::lround(width * ratio));
  vtk_->height = static_cast<int>(std::lround(height * ratio));
  vtk_->set_share(1);
  sized_ = true;
  vtk_->drawn = 0;
  if (fit_pending_) fit(pending_fit_);
}

void VtkView::paintGL() {
  if (drawing_ || !context_) return;
  // What lies over the picture is painted more often than it changes.
  const bool well = !hurried_, same = vtk_->drawn == vtk_->changed();
  if (same && (!well || vtk_->drawn_how == Drawn::smooth)) return Q_EMIT rendered();
  drawing_ = true;
  const bool only_smooth = software_ && well && same && vtk_->drawn_how == Drawn::sharp;
  // Smooth edges take as long as all the rest where the processor draws.
  const bool sharp = software_ && well && in_steps_ && !only_smooth;
  vtk_->renderer->SetUseFXAA(software_ && well && !sharp);
  if (software_)
    vtk_->set_share(
        well ? 1 : std::min(1.0, std::sqrt(fast_pixels / (double(vtk_->width) * vtk_->height))));
  vtk_->renderer->SetDraw(!only_smooth);
  vtk_->smoother->SetDraw(only_smooth);
  render();
  vtk_->renderer->DrawOn();
  vtk_->smoother->DrawOff();

  QOpenGLExtraFunctions* gl = context_->extraFunctions();
  gl->glBindFramebuffer(GL_DRAW_FRAMEBUFFER, defaultFramebufferObject());
  const GLenum target = GL_COLOR_ATTACHMENT0;
  gl->glDrawBuffers(1, &target);
  gl->glDisable(GL_SCISSOR_TEST);
  const int* drawn = vtk_->window->GetSize();
  if (software_ && !vtk_->rehearsed) {
    // What enlarges a fast picture is translated at its first use, which is not to be in a run.
    vtk_->window->BlitDisplayFramebuffer(0, 0, 0, drawn[0] / 2, drawn[1] / 2, 0, 0, vtk_->width,
                                         vtk_->height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    vtk_->rehearsed = true;
  }
  vtk_->window->BlitDisplayFramebuffer(0, 0, 0, drawn[0], drawn[1], 0, 0, vtk_->width, vtk_->height,
                                       GL_COLOR_BUFFER_BIT, GL_LINEAR);
  // The window is opaque: what VTK left in alpha would let the desktop shine through.
  gl->glBindFramebuffer(GL_FRAMEBUFFER, defaultFramebufferObject());
  gl->glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
  gl->glClearColor(0, 0, 0, 1);
  gl->glClear(GL_COLOR_BUFFER_BIT);
  gl->glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  drawing_ = false;
  vtk_->drawn = vtk_->changed();
  vtk_->drawn_how = sharp ? Drawn::sharp : well || !software_ ? Drawn::smooth : Drawn::fast;
  if (hurried_) rest_.start();  // counted from when the picture is there
  if (sharp) QTimer::singleShot(between_steps, this, [this] { update(); });
  Q_EMIT rendered();
}

void VtkView::hurry() {
  hurried_ = true;
  rest_.start();
}

void VtkView::render() {
  vtkOpenGLState* state = vtk_->window->GetState();
  state->Reset();
  state->Push();
  state->vtkglDepthFunc(GL_LEQUAL);
  vtk_->window->Render();
  state->Pop();
}

void VtkView::arrive() {
  hurry();
  arrived_ = true;
  if (moving_) return;
  moving_ = true;
  Q_EMIT moving_changed(true);
}

void VtkView::rest() {
  if (!arrived_ || !software_) return settle();
  arrived_ = false;
  upload();
  QTimer::singleShot(between_steps, this, &VtkView::settle);
}

void VtkView::upload() {
  if (drawing_ || !context_ || !moving_) return;
  moving_ = false;
  Q_EMIT moving_changed(false);
  makeCurrent();
  drawing_ = true;
  vtk_->window->SetSize(1, 1);
  render();
  drawing_ = false;
  vtk_->drawn = 0;
  doneCurrent();
}

void VtkView::draw_in_steps(bool on) { in_steps_ = on; }

void VtkView::settle() {
  if (!hurried_) return;
  arrived_ = false;
  rest_.stop();
  hurried_ = false;
  vtk_->set_share(1);  // what asks for the size of the picture means all of it
  if (moving_) {
    moving_ = false;
    Q_EMIT moving_changed(false);
  }
  update();
}

void VtkView::camera_moved() {
  vtk_->renderer->ResetCameraClippingRange();
  hurry();
  if (!moving_) {
    moving_ = true;
    Q_EMIT moving_changed(true);
  }
  update();
}

void VtkView::follow(const VtkView& other) {
  vtk_->renderer->GetActiveCamera()->DeepCopy(other.vtk_->renderer->GetActiveCamera());
  if (other.moving_)
    camera_moved();
  else
    update();
}

QPointF VtkView::project(const Vec<3>& point) const {
  const double aspect = height() > 0 ? double(width()) / height() : 1;
  vtkMatrix4x4* matrix =
      vtk_->renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(aspect, -1, 1);
  const double in[4] = {point[0], point[1], point[2], 1};
  double out[4];
  matrix->MultiplyPoint(in, out);
  return {(out[0] / out[3] + 1) / 2 * width(), (1 - out[1] / out[3]) / 2 * height()};
}

Vec<3> VtkView::unproject(const QPointF& position, const Vec<3>& like) const {
  const double aspect = height() > 0 ? double(width()) / height() : 1;
  vtkMatrix4x4* matrix =
      vtk_->renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(aspect, -1, 1);
  const double in[4] = {like[0], like[1], like[2], 1};
  double clip[4];
  matrix->MultiplyPoint(in, clip);
  vtkNew<vtkMatrix4x4> inverse;
  vtkMatrix4x4::Invert(matrix, inverse);
  const double seen[4] = {(2 * position.x() / width() - 1) * clip[3],
                          (1 - 2 * position.y() / height()) * clip[3], clip[2], clip[3]};
  double out[4];
  inverse->MultiplyPoint(seen, out);
  return {out[0] / out[3], out[1] / out[3], out[2] / out[3]};
}

double VtkView::pixel_size() const {
  vtkCamera* camera = vtk_->renderer->GetActiveCamera();
  const double view_height =
      camera->GetParallelProjection()
          ? 2 * camera->GetParallelScale()
          : 2 * camera->GetDistance() * std::tan(camera->GetViewAngle() * M_PI / 360);
  return view_height / std::max(1, height());
}

void VtkView::look(const Vec<3>& direction, const Vec<3>& up, const std::array<double, 6>& bounds) {
  vtkCamera* camera = vtk_->renderer->GetActiveCamera();
  double focal[3];
  camera->GetFocalPoint(focal);
  const double distance = camera->GetDistance();
  camera->SetPosition(focal[0] - direction[0] * distance, focal[1] - direction[1] * distance,
                      focal[2] - direction[2] * distance);
  camera->SetViewUp(up[0], up[1], up[2]);
  fit(bounds);
}

void VtkView::fit(const std::array<double, 6>& bounds) {
  if (!sized_) {  // the aspect is not known yet
    pending_fit_ = bounds;
    fit_pending_ = true;
    return;
  }
  fit_pending_ = false;
  if (bounds[0] > bounds[1]) return;
  vtk_->renderer->ResetCamera(bounds.data());
  // ResetCamera fits the bounding sphere; the box seen along the axes of the screen is smaller.
  vtkCamera* camera = vtk_->renderer->GetActiveCamera();
  if (camera->GetParallelProjection()) {
    double half_width = 1e-9;
    double half_height = 1e-9;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec<3> p(bounds[corner & 1], bounds[2 + ((corner >> 1) & 1)],
                     bounds[4 + ((corner >> 2) & 1)]);
      const QPointF s = project(p);
      half_width = std::max(half_width, std::abs(s.x() - width() / 2.0));
      half_height = std::max(half_height, std::abs(s.y() - height() / 2.0));
    }
    const double fill = std::max(half_width / (width() / 2.0), half_height / (height() / 2.0));
    camera->SetParallelScale(camera->GetParallelScale() * fill * 1.18);
  }
  vtk_->renderer->ResetCameraClippingRange();
  update();
}

void VtkView::zoom_to(const QRectF& box) {
  pan(QPointF(width() / 2.0, height() / 2.0) - box.center());
  zoom(std::min(width() / box.width(), height() / box.height()),
       QPointF(width() / 2.0, height() / 2.0));
}

void VtkView::set_perspective(bool on) {
  vtk_->renderer->GetActiveCamera()->SetParallelProjection(!on);
  vtk_->renderer->ResetCameraClippingRange();
  update();
}

bool VtkView::perspective() const {
  return !vtk_->renderer->GetActiveCamera()->GetParallelProjection();
}

void VtkView::rotate(const QPointF& by) {
  vtkCamera* camera = vtk_->renderer->GetActiveCamera();
  camera->Azimuth(-by.x() * 0.4);
  camera->Elevation(by.y() * 0.4);
  camera->OrthogonalizeViewUp();
  camera_moved();
}

void VtkView::pan(const QPointF& by) {
  vtkCamera* camera = vtk_->renderer->GetActiveCamera();
  Vec<3> focal;
  Vec<3> position;
  camera->GetFocalPoint(focal.data());
  camera->GetPosition(position.data());
  const Vec<3> shift = unproject(project(focal) - by, focal) - focal;
  focal += shift;
  position += shift;
  camera->SetFocalPoint(focal.data());
  camera->SetPosition(position.data());
  camera_moved();
}

void VtkView::zoom(double factor, const QPointF& at) {
  vtkCamera* camera = vtk_->renderer->GetActiveCamera();
  Vec<3> focal;
  camera->GetFocalPoint(focal.data());
  const Vec<3> before = unproject(at, focal);
  if (camera->GetParallelProjection()) {
    camera->SetParallelScale(camera->GetParallelScale() / factor);
  } else {
    camera->Dolly(factor);
  }
  // Shift so that what is under the cursor stays there.
  const Vec<3> shift = before - unproject(at, focal);
  Vec<3> position;
  camera->GetPosition(position.data());
  focal += shift;
  position += shift;
  camera->SetFocalPoint(focal.data());
  camera->SetPosition(position.data());
  camera_moved();
}

void VtkView::mousePressEvent(QMouseEvent* event) {
  if (filter_ && filter_(event)) return;
  drag_ = event->button();
  last_ = event->position();
}

void VtkView::mouseMoveEvent(QMouseEvent* event) {
  if (filter_ && filter_(event)) return;
  if (drag_ == Qt::NoButton) return;
  const QPointF by = event->position() - last_;
  last_ = event->position();
  const bool shift = event->modifiers() & Qt::ShiftModifier;
  if (drag_ == Qt::MiddleButton || (drag_ == Qt::LeftButton && shift)) {
    pan(by);
  } else if (drag_ == Qt::LeftButton) {
    rotate(by);
  } else if (drag_ == Qt::RightButton) {
    zoom(std::exp(-by.y() * 0.01), QPointF(width() / 2.0, height() / 2.0));
  }
}

void VtkView::mouseReleaseEvent(QMouseEvent* event) {
  drag_ = Qt::NoButton;
  if (filter_) filter_(event);
}

void VtkView::keyPressEvent(QKeyEvent* event) {
  constexpr double step = 25;  // pixels of a drag
  const QPointF middle(width() / 2.0, height() / 2.0);
  const auto move = [&](double x, double y) {
    if (event->modifiers() & Qt::ShiftModifier)
      pan(step * QPointF(x, y));
    else
      rotate(step * QPointF(x, y));
  };
  switch (event->key()) {
    case Qt::Key_Left:
      return move(-1, 0);
    case Qt::Key_Right:
      return move(1, 0);
    case Qt::Key_Up:
      return move(0, -1);
    case Qt::Key_Down:
      return move(0, 1);
    case Qt::Key_Plus:
      return zoom(1.2, middle);
    case Qt::Key_Minus:
      return zoom(1 / 1.2, middle);
    default:
      QOpenGLWidget::keyPressEvent(event);
  }
}

void VtkView::wheelEvent(QWheelEvent* event) {
  zoom(std::exp(event->angleDelta().y() * 0.0012), event->position());
}

}  // namespace lamella::ui
