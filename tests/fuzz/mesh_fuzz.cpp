// One reader of the table of mesh formats, which format_name.cpp names: an error, or a mesh whose
// arrays, indices and points are sound.

#include "core/io/mesh_file.h"
#include "core/mesh/validate.h"
#include "tests/fuzz/target.h"

extern const char* const lamella_fuzz_format;

namespace {

const lamella::MeshFormat& format() {
  static const lamella::MeshFormats formats = [] {
    lamella::MeshFormats all;
    all.add(lamella::own_formats());
    return all;
  }();
  static const auto found = formats.called(lamella_fuzz_format);
  lamella::test::require(found.ok(), "the format is known");
  return **found;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lamella;
  const auto file = test::input_file(data, size, "m" + format().endings.front());
  const Result<MeshContent> content = read_mesh_file(format(), file);
  if (!test::answered(content)) return 0;
  const Result<MeshReport> found = inspect<3>(content->mesh);
  test::require(found.ok(), "a mesh can be inspected");
  test::require(found->bad_arrays + found->bad_indices + found->bad_points == 0,
                found->first_finding.c_str());
  return 0;
}
