#pragma once

#include <QFrame>

class QVBoxLayout;

namespace lamella::ui {

class Actions;

/// The empty state: a place to drop files, and sample parts to try.
class Welcome : public QFrame {
  Q_OBJECT

 public:
  explicit Welcome(Actions& actions, QWidget* parent = nullptr);
  /// Lights up while files are dragged over the window.
  void set_dragging(bool on);
  /// Shows the files opened last.
  void refresh();

 Q_SIGNALS:
  void sample_chosen(const QString& name);
  void file_chosen(const QString& file);

 private:
  QFrame* drop_zone_;
  QVBoxLayout* recent_;
};

}  // namespace lamella::ui
