#pragma once

#include <QString>

#include "core/base/result.h"

namespace lamella::ui {

/// Writes the HTML of a report (core/study/report.h) as a PDF of A4 pages. Needs no display.
/// Errors: io; bad_input (no report).
Result<void> write_report_pdf(const QString& html, const QString& file);

}  // namespace lamella::ui
