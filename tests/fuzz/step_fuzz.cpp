// STEP files, which the CAD library reads in a process of its own: an error, or closed bodies.

#include "core/cad/load_parts.h"
#include "core/geometry/soup.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lamella;
  LoadParams params;
  params.cad_seconds = 60;
  params.repair = Repair::none;  // a wrap of what is open takes too long to be tried by thousands
  const auto parts = load_parts(test::input_file(data, size, "m.step"), params);
  if (!test::answered(parts)) return 0;
  test::require(!parts->empty(), "there is a part");
  for (const Part& part : *parts) {
    test::require(check_closed(part.surface).ok(), "a part is closed");
    test::require(enclosed_measure(part.surface) > 0, "a part has a volume");
  }
  return 0;
}
