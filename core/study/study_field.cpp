#include "core/study/study_field.h"

#include "core/study/study_file.h"

namespace lamella {

Result<std::filesystem::path> find_result(
    const StudyField& field, const std::map<std::string, std::filesystem::path>& copies) {
  std::error_code ec;
  if (std::filesystem::is_regular_file(field.source.file, ec))
    return std::filesystem::path(field.source.file);
  if (const auto copy = copies.find(field.source.sha256); copy != copies.end()) return copy->second;
  return Error{Code::bad_input, "The solver's result \"" + field.source.file + "\" is missing.",
               "Put it back, name another, or run without the correction."};
}

Result<std::shared_ptr<const SolverField>> load_field(
    Study& study, const std::map<std::string, std::filesystem::path>& copies,
    const ResultReader& read, const Progress& progress) {
  if (!study.flow || !study.flow->field) return std::shared_ptr<const SolverField>();
  StudyField& asked = *study.flow->field;
  const Result<std::filesystem::path> file = find_result(asked, copies);
  if (!file) return file.error();
  if (Result<void> known = identify(asked.source, *file); !known) return known.error();
  Result<MeshContent> content = read(*file, progress);
  if (!content) return content.error();
  Result<SolverField> field =
      solver_field(std::move(*content), asked.name, asked.source.unit, asked.source.file);
  if (!field) return field.error();
  return std::make_shared<const SolverField>(std::move(*field));
}

}  // namespace lamella
