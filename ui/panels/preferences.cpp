#include "ui/panels/preferences.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QSettings>
#include <QVBoxLayout>
#include <algorithm>

#include "ui/language.h"
#include "ui/panels/form.h"
#include "ui/units.h"

namespace lamella::ui {

Preferences::Preferences(QWidget* parent) : QDialog(parent) {
  setWindowTitle(tr("Preferences"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(20, 16, 20, 20);
  auto* form = new Form;
  auto* theme = new QComboBox;
  theme->setObjectName("theme");
  theme->addItem(tr("light"));
  theme->addItem(tr("dark"));
  theme->setCurrentIndex(QSettings().value("dark", false).toBool() ? 1 : 0);
  form->add(tr("Theme"), theme);
  auto* unit = new QComboBox;
  unit->setObjectName("unit");
  unit->setToolTip(tr("In what lengths are shown and entered; files keep millimeters"));
  unit->addItems({tr("millimeters"), tr("inches")});
  unit->setCurrentIndex(Units::get().inches() ? 1 : 0);
  form->add(tr("Lengths in"), unit);
  connect(unit, &QComboBox::currentIndexChanged, this,
          [](int index) { Units::get().set_inches(index == 1); });
  auto* language = new QComboBox;
  language->setObjectName("language");
  language->setToolTip(tr("From the next start on"));
  for (const auto& [code, name] : languages()) language->addItem(name, code);
  language->setCurrentIndex(
      std::max(0, language->findData(QSettings().value("language").toString())));
  form->add(tr("Language"), language);
  connect(language, &QComboBox::currentIndexChanged, this,
          [language] { QSettings().setValue("language", language->currentData().toString()); });
  auto* memory = integer_box(
      0, 10000000, "memory_budget",
      tr("Of studies begun from now on: a run that is expected to take more does not start"));
  memory->setSpecialValueText(tr("no bound"));
  memory->setSuffix(tr(" MB"));
  memory->setSingleStep(1000);
  memory->setValue(QSettings().value("memory_budget", 0).toInt());
  form->add(tr("Memory budget"), memory);
  auto* threads = integer_box(0, 256, "default_threads", tr("Of studies begun from now on"));
  threads->setSpecialValueText(tr("all cores"));
  threads->setValue(QSettings().value("threads", 0).toInt());
  form->add(tr("Threads"), threads);
  layout->addLayout(form);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  layout->addSpacing(8);
  layout->addWidget(buttons);
  setMinimumWidth(360);
  connect(theme, &QComboBox::currentIndexChanged, this, [this](int index) {
    QSettings().setValue("dark", index == 1);
    Q_EMIT theme_changed(index == 1);
  });
  connect(memory, &QSpinBox::valueChanged, this,
          [](int mb) { QSettings().setValue("memory_budget", mb); });
  connect(threads, &QSpinBox::valueChanged, this,
          [](int count) { QSettings().setValue("threads", count); });
}

}  // namespace lamella::ui
