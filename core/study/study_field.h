#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "core/base/progress.h"
#include "core/flow/solver_field.h"
#include "core/study/study.h"

namespace lamella {

/// Reads what another solver has written, as `read_vtk_result` does: this room knows no format.
using ResultReader =
    std::function<Result<MeshContent>(const std::filesystem::path&, const Progress&)>;

/// Where the result of another solver can be read: where it is named, or else from the copy by its
/// hash. Errors: bad_input (it is nowhere).
Result<std::filesystem::path> find_result(
    const StudyField& field, const std::map<std::string, std::filesystem::path>& copies);

/// The field of another solver that the study names, whose hash becomes that of today; null where
/// it names none. Errors: bad_input (missing), those of the reader and of `solver_field`.
Result<std::shared_ptr<const SolverField>> load_field(
    Study& study, const std::map<std::string, std::filesystem::path>& copies,
    const ResultReader& read, const Progress& progress = {});

}  // namespace lamella
