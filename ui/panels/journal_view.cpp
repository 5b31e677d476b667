#include "ui/panels/journal_view.h"

#include <QDialogButtonBox>
#include <QPlainTextEdit>
#include <QVBoxLayout>

#include "ui/panels/form.h"

namespace lamella::ui {

JournalView::JournalView(const QString& left, const QString& now, QWidget* parent)
    : QDialog(parent) {
  setWindowTitle(tr("Journal"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(20, 16, 20, 16);
  const auto add = [&](const QString& title, const QString& lines) {
    layout->addWidget(styled_label(title, "section_title"));
    auto* text = new QPlainTextEdit(lines.isEmpty() ? tr("Nothing yet") : lines);
    text->setAccessibleName(title);
    text->setReadOnly(true);
    layout->addWidget(text);
    text->moveCursor(QTextCursor::End);
  };
  if (!left.isEmpty()) add(tr("Until the last crash"), left);
  add(tr("Since this start"), now);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  layout->addWidget(buttons);
  resize(760, 520);
}

}  // namespace lamella::ui
