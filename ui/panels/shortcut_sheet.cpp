#include "ui/panels/shortcut_sheet.h"

#include <QGridLayout>
#include <QLabel>

#include "ui/panels/form.h"

namespace lamella::ui {

ShortcutSheet::ShortcutSheet(const std::vector<QAction*>& actions, QWidget* parent)
    : QDialog(parent) {
  setWindowTitle(tr("Keyboard shortcuts"));
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(20, 16, 20, 20);
  grid->setHorizontalSpacing(10);
  grid->setVerticalSpacing(5);
  std::vector<std::pair<QString, QString>> rows;
  for (const QAction* action : actions)
    if (!action->shortcut().isEmpty())
      rows.emplace_back(action->shortcut().toString(QKeySequence::NativeText),
                        action->text().remove('&').remove(QString::fromUtf8("…")));
  const std::pair<QString, QString> mouse[] = {
      {tr("left drag"), tr("turn the view")},
      {tr("middle drag"), tr("shift it (or Shift and left)")},
      {tr("wheel"), tr("zoom towards the pointer")},
      {tr("click"), tr("select a body; Ctrl adds")},
      {tr("right click"), tr("what can be done there")},
      {tr("Esc"), tr("end picking, forget what was measured")},
      {tr("arrows, +, -"), tr("turn the view and zoom; with Shift shift it")},
      {tr("F2"), tr("rename in the study")}};
  rows.insert(rows.end(), std::begin(mouse), std::end(mouse));
  // In as many columns as leave it lower than a small screen.
  constexpr int columns = 3;
  const int high = (static_cast<int>(rows.size()) + columns - 1) / columns;
  for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
    auto* keys = styled_label(rows[static_cast<std::size_t>(k)].first, "keys");
    keys->setAlignment(Qt::AlignCenter);
    const int column = 3 * (k / high);
    grid->addWidget(keys, k % high, column);
    grid->addWidget(styled_label(rows[static_cast<std::size_t>(k)].second, "soft"), k % high,
                    column + 1);
  }
  for (int k = 1; k < columns; ++k) grid->setColumnMinimumWidth(3 * k - 1, 16);
}

}  // namespace lamella::ui
