#include <gtest/gtest.h>

#include <QApplication>
#include <QLocale>
#include <QStandardPaths>
#include <QSurfaceFormat>

#include "ui/theme.h"
#include "ui/views/vtk_view.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  QStandardPaths::setTestModeEnabled(true);
  QLocale::setDefault(QLocale(QLocale::English));
  QSurfaceFormat::setDefaultFormat(lamella::ui::VtkView::format());
  QApplication application(argc, argv);
  lamella::ui::apply_theme(application);
  return RUN_ALL_TESTS();
}
