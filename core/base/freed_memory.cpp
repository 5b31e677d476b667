#include "core/base/freed_memory.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace lamella {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int mb = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * mb);  // the most that glibc allows
  mallopt(M_TRIM_THRESHOLD, 512 * mb);
  mallopt(M_TOP_PAD, 32 * mb);
#endif
}

void give_back_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace lamella
