#pragma once

#include <QFrame>
#include <array>
#include <memory>

#include "ui/views/scene.h"

class QComboBox;

namespace lamella::ui {

class Overlay;
class Session;
class VtkView;

/// Another iteration beside the one that is shown: with the same camera, and with the same cuts
/// and colors as whoever owns it says.
class CompareView : public QFrame {
  Q_OBJECT

 public:
  CompareView(Session& session, VtkView& main, QWidget* parent = nullptr);
  ~CompareView() override;

  Scene& scene() { return *scene_; }
  VtkView* vtk_view() const { return view_; }
  /// Index of the iteration that is compared; -1: there is none.
  int iteration() const;
  /// Draws anew, with the legend of its own mesh.
  void refresh();
  void refresh_theme();

 private:
  void follow_iterations();
  void follow_mesh();
  void link(VtkView& drawn, VtkView& other);

  Session& session_;
  VtkView& main_;
  QComboBox* which_;
  VtkView* view_;
  Overlay* overlay_;
  std::unique_ptr<Scene> scene_;
  std::shared_ptr<const MeshState> shown_;
  std::array<double, 11> agreed_{};  // the camera of both, until one of them is drawn with another
};

}  // namespace lamella::ui
