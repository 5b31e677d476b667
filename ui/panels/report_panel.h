#pragma once

#include <QTextBrowser>

namespace lamella::ui {

class Session;

/// What became of each body of the last run, as a table.
class ReportPanel : public QTextBrowser {
  Q_OBJECT

 public:
  explicit ReportPanel(Session& session, QWidget* parent = nullptr);

 Q_SIGNALS:
  void save_asked();

 private:
  void refresh();
  /// Of fuzzy interfaces: mixed elements and what the borders are worth.
  QString interfaces_html() const;
  QString places_html() const;
  /// Follows a link to a place with too few layers.
  void jump(const QUrl& link);

  Session& session_;
};

}  // namespace lamella::ui
