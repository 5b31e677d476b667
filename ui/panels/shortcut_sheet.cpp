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
  grid->setHorizontalSpacing(14);
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
  const int half = static_cast<int>(rows.size() + 1) / 2;
  for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
    auto* keys = styled_label(rows[static_cast<std::size_t>(k)].first, "keys");
    keys->setAlignment(Qt::AlignCenter);
    const int column = k < half ? 0 : 3;
    grid->addWidget(keys, k % half, column);
    grid->addWidget(styled_label(rows[static_cast<std::size_t>(k)].second, "soft"), k % half,
                    column + 1);
  }
  grid->setColumnMinimumWidth(2, 24);
}

}  // namespace lamella::ui
