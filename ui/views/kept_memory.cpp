#include "ui/views/kept_memory.h"

#include <QThread>
#include <array>
#include <cstddef>
#include <cstdlib>

#include "core/base/freed_memory.h"

namespace lamella::ui {

void keep_memory(QObject& owner) {
#ifdef __GLIBC__
  static bool kept = false;
  if (kept) return;
  kept = true;
  constexpr std::size_t block = std::size_t(16) << 20, page = 4096;
  keep_freed_memory();
  // Blocks of this thread's heap, which go back to it: pages that another thread has touched stay.
  std::array<char*, 4> blocks{};
  for (char*& b : blocks) b = static_cast<char*>(std::malloc(block));
  QThread* touch = QThread::create([blocks] {
    for (char* b : blocks)
      for (std::size_t k = 0; b && k < block; k += page) static_cast<volatile char*>(b)[k] = 0;
  });
  // A program that ends before it is done leaves it to the system.
  QObject::connect(touch, &QThread::finished, &owner, [blocks] {
    for (char* b : blocks) std::free(b);
  });
  QObject::connect(touch, &QThread::finished, touch, &QObject::deleteLater);
  touch->start(QThread::LowPriority);
#else
  (void)owner;
#endif
}

}  // namespace lamella::ui
