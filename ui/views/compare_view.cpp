#include "ui/views/compare_view.h"

#include <vtkCamera.h>
#include <vtkRenderer.h>

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <algorithm>

#include "ui/panels/form.h"
#include "ui/session/session.h"
#include "ui/views/overlay.h"
#include "ui/views/vtk_view.h"

namespace lamella::ui {
namespace {

/// Choice that follows the iteration shown.
constexpr int one_before = -1;

std::array<double, 11> seen_by(vtkCamera& camera) {
  std::array<double, 11> seen{};
  camera.GetPosition(seen.data());
  camera.GetFocalPoint(seen.data() + 3);
  camera.GetViewUp(seen.data() + 6);
  seen[9] = camera.GetParallelScale();
  seen[10] = camera.GetParallelProjection() ? 0 : camera.GetViewAngle();
  return seen;
}

}  // namespace

CompareView::CompareView(Session& session, VtkView& main, QWidget* parent)
    : QFrame(parent), session_(session), main_(main) {
  setObjectName("view_frame");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(1, 1, 1, 1);
  layout->setSpacing(0);
  auto* row = new QHBoxLayout;
  row->setContentsMargins(10, 5, 10, 5);
  row->addWidget(styled_label(tr("Compared with"), "soft"));
  which_ = new QComboBox;
  which_->setObjectName("compared");
  which_->setAccessibleName(tr("Iteration on the left"));
  which_->setToolTip(tr("The iteration on the left; the one on the right is that of the slider"));
  row->addWidget(which_, 1);
  row->setSpacing(8);
  layout->addLayout(row);
  view_ = new VtkView;
  view_->renderer()->GetActiveCamera()->DeepCopy(main.renderer()->GetActiveCamera());
  scene_ = std::make_unique<Scene>(*view_->renderer());
  overlay_ = new Overlay(*view_);
  overlay_->set_scale_visible(true);
  layout->addWidget(view_, 1);
  agreed_ = seen_by(*main.renderer()->GetActiveCamera());
  connect(view_, &VtkView::moving_changed, this,
          [this](bool on) { scene_->set_moving(on, view_->fast_triangles()); });
  link(*view_, main_);
  link(main_, *view_);
  const auto follow_activity = [this] {
    view_->draw_in_steps(session_.activity() == Activity::running);
  };
  connect(&session, &Session::activity_changed, this, follow_activity);
  follow_activity();
  connect(which_, &QComboBox::currentIndexChanged, this, &CompareView::follow_mesh);
  connect(&session, &Session::iterations_changed, this, &CompareView::follow_iterations);
  connect(&session, &Session::shown_changed, this, &CompareView::follow_mesh);
  follow_iterations();
}

CompareView::~CompareView() = default;

void CompareView::link(VtkView& drawn, VtkView& other) {
  connect(&drawn, &VtkView::rendered, this, [this, &drawn, &other] {
    // Each has a camera of its own: what one does to the depth range must not call for the other.
    vtkCamera* from = drawn.renderer()->GetActiveCamera();
    if (const auto now = seen_by(*from); now != agreed_) {
      agreed_ = now;
      other.follow(drawn);
    }
    if (&drawn == view_ && scene_->set_pixel_size(view_->pixel_size())) view_->update();
  });
}

int CompareView::iteration() const {
  const int last = static_cast<int>(session_.iterations().size()) - 1;
  const int chosen = which_->currentData().toInt();
  return std::min(last, chosen == one_before ? std::max(0, session_.shown() - 1) : chosen);
}

void CompareView::follow_iterations() {
  const QSignalBlocker block(which_);
  const int chosen = which_->count() > 0 ? which_->currentData().toInt() : one_before;
  which_->clear();
  which_->addItem(tr("the iteration before"), one_before);
  for (std::size_t k = 0; k < session_.iterations().size(); ++k) {
    const int number = session_.iterations()[k].record.iteration;
    which_->addItem(number == 0 ? tr("0: first mesh") : tr("iteration %1").arg(number),
                    static_cast<int>(k));
  }
  which_->setCurrentIndex(std::max(0, which_->findData(chosen)));
  follow_mesh();
}

void CompareView::follow_mesh() {
  const int k = iteration();
  const Iteration none;
  const Iteration& compared = k < 0 ? none : session_.iterations()[static_cast<std::size_t>(k)];
  if (compared.state == shown_) return;
  shown_ = compared.state;
  if (session_.activity() == Activity::running) view_->arrive();
  scene_->set_mesh(shown_, compared.prepared);
  refresh();
}

void CompareView::refresh() {
  overlay_->set_legend(scene_->legend());
  view_->update();
}

void CompareView::refresh_theme() {
  view_->refresh_theme();
  refresh();
}

}  // namespace lamella::ui
