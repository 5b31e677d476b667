#pragma once

#include <QObject>

namespace lamella::ui {

/// For programs whose pictures the processor draws: it takes memory for the corners of all
/// triangles for each picture anew, and when that comes from the system page by page it takes
/// longer than the drawing. From now on what was once taken is kept, and the first 64 MB are taken
/// now, beside the window's thread; `owner` belongs to that thread, which calls this. Does nothing
/// the second time, or where the C library is another one than glibc.
void keep_memory(QObject& owner);

}  // namespace lamella::ui
