#pragma once

#include <QWidget>

class QPushButton;
class QTextBrowser;
class QUrl;

namespace lamella::ui {

class LengthBox;
class Session;

/// Where bodies overlap and where they leave narrow gaps between them, with a way to each place.
class OverlapPanel : public QWidget {
  Q_OBJECT

 public:
  explicit OverlapPanel(Session& session, QWidget* parent = nullptr);
  /// Starts to look, with the gap width that is set.
  void look();

 private:
  void refresh();
  QString found_html() const;
  /// Follows a link to a place.
  void jump(const QUrl& link);

  Session& session_;
  LengthBox* width_;
  QPushButton* button_;
  QTextBrowser* text_;
};

}  // namespace lamella::ui
