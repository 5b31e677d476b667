#pragma once

#include <QColor>
#include <QIcon>
#include <array>

class QApplication;

namespace lamella::ui {

/// Colors used by name all over the window, as the theme has them.
namespace theme {
inline bool dark = false;
inline QColor text{0x1f, 0x29, 0x33};
inline QColor soft_text{0x52, 0x60, 0x6d};
inline QColor faint_text{0x8a, 0x97, 0xa5};
inline QColor window{0xf4, 0xf6, 0xf8};
inline QColor panel{0xff, 0xff, 0xff};
inline QColor border{0xdd, 0xe2, 0xe8};
inline QColor accent{0x1d, 0x6f, 0xc4};
inline QColor good{0x2f, 0x85, 0x5a};
inline QColor warning{0xc0, 0x7a, 0x0b};
inline QColor danger{0xc5, 0x3a, 0x30};
inline QColor surroundings{0xd9, 0xdd, 0xe2};  ///< of what is around the bodies
inline QColor steel{0x93, 0x9e, 0xab};         ///< of a mold
inline QColor brass{0xc9, 0xa2, 0x4b};         ///< of an insert
inline QColor coolant{0x3b, 0xa9, 0x9c};       ///< of a channel
inline QColor missing{0xc4, 0xc9, 0xcf};       ///< where a field has no value
}  // namespace theme

/// Style, palette, font and style sheet of the application; the dark theme is the light one with
/// its lightness turned over.
void apply_theme(QApplication& application, bool dark = false);

/// Icon `name` of resources/icons, with a paler disabled state.
QIcon icon(const QString& name);

/// Color of body `index`: the one of its file, else the next of a calm palette. `rgb` in [0, 1],
/// negative for none.
QColor body_color(int index, const std::array<double, 3>& rgb = {-1, -1, -1});

/// Color of boundary group `index`.
QColor group_color(int index);

}  // namespace lamella::ui
