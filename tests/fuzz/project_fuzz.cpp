// Projects, packed or as text: an error, or a study that is the same when written and read again.

#include "core/project/project_file.h"
#include "core/study/study_file.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lamella;
  // The part that the seeds name lies beside them.
  static const bool there = write_file(test::fuzz_folder() / "a.stl", "solid a").ok();
  test::require(there, "the part can be written");
  const Result<Project> project = open_project(test::input_file(data, size, "m.lamella"));
  if (!test::answered(project)) return 0;
  const std::string text = study_to_json(project->study);
  const Result<Study> again = study_from_json(text, "the study");
  test::require(again.ok(), "a study that was read can be written and read");
  test::require(study_to_json(*again) == text, "a study survives its file");
  return 0;
}
