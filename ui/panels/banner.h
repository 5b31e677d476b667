#pragma once

#include <QFrame>
#include <functional>
#include <utility>
#include <vector>

class QHBoxLayout;
class QLabel;

namespace lamella::ui {

/// A message above the view that interrupts nobody: a sentence, a hint and perhaps a few buttons.
class Banner : public QFrame {
  Q_OBJECT

 public:
  enum class Kind { error, info, done };
  using Button = std::pair<QString, std::function<void()>>;

  explicit Banner(QWidget* parent = nullptr);

  void show_message(Kind kind, const QString& message, const QString& hint,
                    const std::vector<Button>& buttons = {});
  QString message() const;
  QString hint() const;

 private:
  QLabel* icon_;
  QLabel* message_;
  QLabel* hint_;
  QHBoxLayout* buttons_;
};

}  // namespace lamella::ui
