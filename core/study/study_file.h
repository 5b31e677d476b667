#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "core/study/study.h"

namespace lamella {

/// Of what is written. Schema 1, whose inputs had no hash, is read too.
inline constexpr int kStudySchema = 2;

/// A study as plain JSON (resources/docs/project.schema.json): its unit ("mm") and the members of
/// Study by their names, inputs relative to the study's folder. What is unset is left out.
std::string study_to_json(const Study& study);

/// What the mesh depends on, as text: studies of one key give the same mesh. Where a file lies and
/// what is for the eye does not count; an STL names its body, which settings may name.
std::string mesh_key(Study study);

/// Reads what `study_to_json` writes; members left out keep their defaults. `where` names the
/// source in messages; `schema` (may be null) gets the version found. Errors: bad_input (not JSON,
/// an unknown member, a value of the wrong type or out of range, a newer schema), naming the
/// member.
Result<Study> study_from_json(const std::string& text, const std::string& where,
                              int* schema = nullptr);

/// Errors: io, bad_input.
Result<Study> read_study(const std::filesystem::path& file);
/// Errors: io; nothing is left behind.
Result<void> write_study(const Study& study, const std::filesystem::path& file);

/// The same, and what the file held before stays beside it as FILE.bak; the new one is read again
/// and compared before it takes its place. Errors: io.
Result<void> save_study(const Study& study, const std::filesystem::path& file);

/// Takes down what the input's file holds now: its size and hash. Errors: io.
Result<void> identify(StudyInput& input, const std::filesystem::path& file);

}  // namespace lamella
