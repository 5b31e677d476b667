#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "ui/services.h"

namespace lamella::ui {

/// What was read of another solver's result, and of which state of the file.
struct SolverResult {
  std::filesystem::path file;
  std::filesystem::file_time_type time;
  StudyInput source;  ///< as a study names it, its unit guessed where the study has none yet
  double across = 0;  ///< diagonal of its mesh, in units of the file
  MeshContent content;

  /// Whether the file is the same still.
  bool is_current() const;
};

/// Reads a result. A unit of 0 is guessed for bodies `size` mm across. Errors: those of
/// Services::read_result; bad_input without a field.
Result<std::shared_ptr<const SolverResult>> read_solver_result(const Services& services,
                                                               const std::filesystem::path& file,
                                                               double unit, double size,
                                                               const Progress& progress);

/// The field that the study asks for, from `known` (may be null) where that is its file still, else
/// read anew into it; null where it asks for none. Errors: bad_input, usage.
Result<std::shared_ptr<const SolverField>> solver_field_of(
    const Services& services, const Study& study,
    const std::map<std::string, std::filesystem::path>& copies,
    std::shared_ptr<const SolverResult>& known, const Progress& progress);

}  // namespace lamella::ui
