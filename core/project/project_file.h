#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/study/moved_faces.h"
#include "core/study/study.h"

namespace lamella {

/// Writes the mesh of a project as VTU: the room knows no mesh format.
using MeshWriter = std::function<Result<void>(const std::filesystem::path& vtu)>;

/// What is to be saved. The inputs are named from anywhere but relative to the working folder.
struct ProjectContent {
  Study study;
  /// Copies of inputs by their hash, for those that are not where the study says.
  std::map<std::string, std::filesystem::path> copies{};
  MeshWriter write_mesh{};            ///< empty: there is no mesh
  std::optional<Study> mesh_study{};  ///< the study the mesh was made of; unset: `study`
  std::string report_json{};          ///< of the run that made it; empty: none
  std::string report_html{};
  /// Where the faces are that the study asks for by number, should the CAD change; see known_faces.
  std::vector<KnownFaces> faces{};
};

/// A project or study that was opened. Holds the folder of what was unpacked, which goes with the
/// last copy of it.
struct Project {
  Study study;                               ///< its inputs absolute; hashes are those of today
  std::vector<std::filesystem::path> files;  ///< [input] where to read it
  std::map<std::string, std::filesystem::path> copies;  ///< unpacked, by hash
  std::filesystem::path mesh;                           ///< VTU; empty: none
  std::optional<Study> mesh_study;                      ///< what it was made of, where there is one
  std::string report_json, report_html;
  std::vector<std::string> notes;  ///< for the user: inputs that changed or were missing
  std::shared_ptr<const void> folder;
};

/// Whether the file is a project by its ending, .lamella.
bool is_project(const std::filesystem::path& file);
/// Whether the file is a project or a study as text (.json).
bool names_study(const std::filesystem::path& file);

/// Reads a project, or a bare study as text (with its mesh beside it, FILE.vtu, as schema 1 had
/// it). Inputs are looked for where they are linked; one that is missing is taken from the project,
/// or from `also` (a project of the same study; may be empty). What does not hold is refused before
/// anything is unpacked. Errors: io; bad_input (damaged or hostile file, see Archive; a newer
/// schema; an input that is nowhere); cancelled.
Result<Project> open_project(const std::filesystem::path& file, const Progress& progress = {},
                             const std::filesystem::path& also = {});

/// What a project says of itself and of its mesh, which stays packed: neither inputs nor mesh are
/// looked at, and `mesh_study` is set where there is a mesh. Errors: io, bad_input.
Result<Project> open_project_head(const std::filesystem::path& file);

/// Saves a project, or with the ending .json the study alone. It is written beside the target and
/// read again in full; only then it takes the target's place, and what was there before becomes
/// FILE.bak. Returns notes for the user. Errors: io, cancelled, those of the mesh's writer; the
/// target is then as it was.
Result<std::vector<std::string>> save_project(const ProjectContent& content,
                                              const std::filesystem::path& file,
                                              const Progress& progress = {});

/// The study with its inputs as they are found from `folder`: relative where they lie in it, else
/// absolute.
Study seen_from(Study study, const std::filesystem::path& folder);

/// Makes the study of a project that was opened from `file` fit the parts of its inputs: where an
/// input is not what it was when the project was saved, what asks for faces by number goes to the
/// faces that are in their place now. Returns notes for the user, those of `unmatched` among them.
std::vector<std::string> fit_to_parts(Study& study, const std::filesystem::path& file,
                                      const std::vector<Part>& parts);

/// What the settings name that the parts do not have, bodies and faces, for the user; nothing where
/// all is found.
std::vector<std::string> unmatched(const Study& study, const std::vector<Part>& parts);

}  // namespace lamella
