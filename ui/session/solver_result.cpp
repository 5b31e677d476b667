#include "ui/session/solver_result.h"

#include "core/study/study_file.h"

namespace lamella::ui {

bool SolverResult::is_current() const {
  std::error_code ec;
  return std::filesystem::last_write_time(file, ec) == time && !ec;
}

Result<std::shared_ptr<const SolverResult>> read_solver_result(const Services& services,
                                                               const std::filesystem::path& file,
                                                               double unit, double size,
                                                               const Progress& progress) {
  auto result = std::make_shared<SolverResult>();
  std::error_code ec;
  result->file = file;
  result->time = std::filesystem::last_write_time(file, ec);
  result->source.file = file.string();
  if (Result<void> known = identify(result->source, file); !known) return known.error();
  Result<MeshContent> content = services.read_result(file, progress);
  if (!content) return content.error();
  result->content = std::move(*content);
  if (result->content.of_nodes.empty())
    return Error{Code::bad_input, "\"" + file.string() + "\" has no field.",
                 "Save the result with its numbers or vectors, at its points or cells."};
  result->across = diagonal_of_nodes(result->content.mesh);
  const bool guess = !(unit > 0) && size > 0 && result->across > 0;
  result->source.unit = guess ? likely_unit(result->across, size).mm : unit > 0 ? unit : 1;
  return std::shared_ptr<const SolverResult>(std::move(result));
}

Result<std::shared_ptr<const SolverField>> solver_field_of(
    const Services& services, const Study& study,
    const std::map<std::string, std::filesystem::path>& copies,
    std::shared_ptr<const SolverResult>& known, const Progress& progress) {
  if (!study.flow || !study.flow->field) return std::shared_ptr<const SolverField>();
  const StudyField& asked = *study.flow->field;
  const Result<std::filesystem::path> file = find_result(asked, copies);
  if (!file) return file.error();
  if (!known || known->file != *file || !known->is_current()) {
    auto read = read_solver_result(services, *file, asked.source.unit, 0, progress);
    if (!read) return read.error();
    known = std::move(*read);
  }
  Result<SolverField> field =
      solver_field(known->content, asked.name, asked.source.unit, asked.source.file);
  if (!field) return field.error();
  return std::make_shared<const SolverField>(std::move(*field));
}

}  // namespace lamella::ui
