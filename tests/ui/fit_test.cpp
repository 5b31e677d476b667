#include <QAbstractButton>
#include <QAbstractScrollArea>
#include <QComboBox>
#include <QLabel>
#include <QScrollBar>
#include <QTabWidget>
#include <QToolButton>
#include <QTranslator>

#include "core/study/study_file.h"
#include "tests/ui/window_fixture.h"
#include "ui/commands/study_edits.h"
#include "ui/language.h"
#include "ui/panels/recovery_dialog.h"
#include "ui/units.h"

namespace lamella::ui {
namespace {

/// What of the texts in sight there is no room for, and what must be scrolled sideways.
QStringList unfitting(const QWidget& window) {
  QStringList found;
  for (QWidget* widget : window.findChildren<QWidget*>()) {
    if (!widget->isVisible()) continue;
    const auto* label = qobject_cast<QLabel*>(widget);
    const auto* button = qobject_cast<QAbstractButton*>(widget);
    QString text = label ? label->text() : button ? button->text() : QString();
    const auto* tool = qobject_cast<QToolButton*>(widget);
    if (tool && tool->toolButtonStyle() == Qt::ToolButtonIconOnly && !tool->icon().isNull())
      text.clear();
    const bool wraps = label && (label->wordWrap() || Qt::mightBeRichText(text));
    if (!text.isEmpty() && !wraps && widget->width() < widget->fontMetrics().size(0, text).width())
      found << text;
    if (const auto* combo = qobject_cast<QComboBox*>(widget))
      if (combo->width() - 36 < combo->fontMetrics().horizontalAdvance(combo->currentText()))
        found << combo->currentText();
    const auto* area = qobject_cast<QAbstractScrollArea*>(widget);
    if (area && area->horizontalScrollBar()->maximum() > 0)
      found << QString("%1 %2 scrolls sideways by %3")
                   .arg(area->metaObject()->className(), area->accessibleName())
                   .arg(area->horizontalScrollBar()->maximum());
  }
  return found;
}

/// In each language at each size: as the window starts, and on the smallest screen it is for.
class FitTest : public WindowFixture,
                public testing::WithParamInterface<std::tuple<const char*, QSize>> {
 protected:
  FitTest()
      : WindowFixture([](Services made) {
          speak(*qApp, std::get<0>(GetParam()));
          return made;
        }) {
    window_.resize(std::get<1>(GetParam()));
  }
  ~FitTest() override {
    qDeleteAll(qApp->findChildren<QTranslator*>());
    speak(*qApp, "en");
  }
  void expect_fit(const char* state) {
    QTest::qWait(30);
    EXPECT_EQ(window_.size(), std::get<1>(GetParam())) << state << ": it needs more";
    EXPECT_EQ(unfitting(window_).join("\n").toStdString(), "") << state;
  }
};

TEST_P(FitTest, EveryTextHasItsRoom) {
  expect_fit("start");
  open_part("t_junction");
  expect_fit("body");
  action(Act::add_group)->trigger();
  expect_fit("group");
  action(Act::add_sphere)->trigger();
  expect_fit("size");
  action(Act::zone_ball)->trigger();
  expect_fit("body by formula, and the domain");
  action(Act::undo)->trigger();
  run();
  action(Act::section)->setChecked(true);
  session().select_item({ItemKind::cut, 0});
  for (int color = 0; color <= int(ColorBy::field); ++color) {
    window_.view().set_color_by(ColorBy(color));
    expect_fit(qPrintable(QString("color %1").arg(color)));
  }
  add_group(session(), GroupKind::gate, session().body(0).name, {0});
  add_group(session(), GroupKind::vent, session().body(0).name, {1});
  action(Act::solve_flow)->trigger();
  ASSERT_TRUE(wait_idle());
  auto* results = window_.findChild<QTabWidget*>();
  for (int tab = 0; tab < results->count(); ++tab) {
    results->setCurrentIndex(tab);
    expect_fit(qPrintable("results: " + results->tabText(tab)));
  }
  // One mesh of all bodies has one plot more, and a body to choose whose filling is shown.
  action(Act::zone_ball)->trigger();
  window_.view().set_color_by(ColorBy::filling);
  results->setCurrentIndex(0);
  expect_fit("domain");
  for (const Act act : {Act::shortcuts, Act::preferences, Act::journal}) action(act)->trigger();
  ASSERT_TRUE(write_study(study(), folder_ / "left.json"));
  const Recovery::Left left{folder_ / "left.json", folder_ / "battery case, second try.lamella",
                            QDateTime::currentDateTime()};
  RecoveryDialog recovery({left, left}, &window_);
  recovery.show();
  QTest::qWait(30);
  if (const QString to = qEnvironmentVariable("LAMELLA_PICTURES"); !to.isEmpty())
    recovery.grab().save(to + "/recovery-" + std::get<0>(GetParam()) + ".png");
  for (QWidget* top : QApplication::topLevelWidgets()) {
    if (!qobject_cast<QDialog*>(top) || !top->isVisible()) continue;
    EXPECT_EQ(unfitting(*top).join("\n").toStdString(), "") << qPrintable(top->windowTitle());
    EXPECT_LE(top->width(), 1280) << qPrintable(top->windowTitle());
    EXPECT_LE(top->height(), 740) << qPrintable(top->windowTitle());
    top->close();
  }
}

INSTANTIATE_TEST_SUITE_P(Languages, FitTest,
                         testing::Combine(testing::Values("en", "fr"),
                                          testing::Values(QSize(1440, 920), QSize(1280, 800))));

TEST(Units, APlaceHasNoSpeckOfANumber) {
  EXPECT_EQ(units::point({-11.21, -21.13, -2.872e-16}), "(-11.21, -21.13, 0)");
  EXPECT_EQ(units::point({3e-7, 2e-7, 0}), "(3e-07, 2e-07, 0)") << "small is not nothing";
  EXPECT_EQ(units::point({0, 0, 0}), "(0, 0, 0)");
}

}  // namespace
}  // namespace lamella::ui
