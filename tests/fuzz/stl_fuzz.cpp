// The STL reader and what makes a surface of its triangles: an error, or closed surfaces with a
// volume.

#include "core/geometry/soup.h"
#include "core/io/stl.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lamella;
  const auto soup = read_stl(test::input_file(data, size, "m.stl"));
  if (!test::answered(soup)) return 0;
  --test::accepted;  // not yet
  SoupParams as_it_is;
  as_it_is.repair = false;
  bool sound = false;
  for (const SoupParams& params : {as_it_is, SoupParams{}}) {
    const auto bodies = surfaces_from_soup(*soup, params);
    if (!bodies) {
      test::require(!bodies.error().message.empty(), "an error has a message");
      continue;
    }
    sound = true;
    test::require(!bodies->empty(), "there is a body");
    for (const auto& body : *bodies) {
      test::require(check_closed(body).ok(), "a body is closed");
      test::require(enclosed_measure(body) > 0, "a body has a volume");
    }
  }
  test::accepted += sound ? 1 : 0;
  return 0;
}
