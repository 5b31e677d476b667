#pragma once

#include <QString>

#include "core/base/result.h"

class QWidget;

namespace lamella::ui {

/// Asks where figures are to go, as a table (.csv) or as a picture (.png); empty: nowhere.
QString ask_figures_file(QWidget* parent, const QString& name);
/// By the ending of the file writes `csv`, or `plots` as seen, at twice the resolution of a screen.
/// Errors: io; usage (another ending).
Result<void> save_figures(const QString& file, const QString& csv, QWidget& plots);

}  // namespace lamella::ui
