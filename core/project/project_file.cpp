#include "core/project/project_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <fstream>

#include "core/base/atomic_file.h"
#include "core/base/sha256.h"
#include "core/project/archive.h"
#include "core/study/domain.h"
#include "core/study/request.h"
#include "core/study/study_file.h"

namespace lamella {

namespace {

namespace fs = std::filesystem;

// Entries of a project.
constexpr const char* kStudy = "project.json";
constexpr const char* kMesh = "mesh.vtu";
constexpr const char* kMeshStudy = "mesh.json";
constexpr const char* kReportJson = "report.json";
constexpr const char* kReportHtml = "report.html";
constexpr const char* kFaces = "faces.json";

/// A study of 100,000 zones has a quarter of it; read as JSON it takes sixteen times its size.
constexpr std::uint64_t kLongestText = 32 << 20;
constexpr int kDeepestText = 64;

Error refuse(const fs::path& file, const std::string& finding, const std::string& hint) {
  return {Code::bad_input, "\"" + file.string() + "\": " + finding + ".", hint};
}

std::string ending_of(const fs::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

/// JSON of any depth would be read: deep nesting is refused before.
int depth_of(const std::string& text) {
  int depth = 0, deepest = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') ++i;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '{' || c == '[') deepest = std::max(deepest, ++depth);
    if (c == '}' || c == ']') --depth;
  }
  return deepest;
}

Result<Study> parse(const std::string& text, const fs::path& file, int* schema = nullptr) {
  if (depth_of(text) > kDeepestText)
    return refuse(file, "its study is nested too deep", "Give a study of Lamella.");
  return study_from_json(text, file.string(), schema);
}

/// A folder that goes with the last who holds it.
Result<std::shared_ptr<const fs::path>> temporary_folder() {
  std::error_code ec;
  std::string pattern = (fs::temp_directory_path(ec) / "lamella-XXXXXX").string();
  if (ec || !::mkdtemp(pattern.data()))
    return Error{Code::io, "No folder for temporary files could be made.",
                 "Set TMPDIR to a folder with space."};
  return std::shared_ptr<const fs::path>(new fs::path(pattern), [](const fs::path* folder) {
    std::error_code ignored;
    fs::remove_all(*folder, ignored);
    delete folder;
  });
}

class Opening {
 public:
  Opening(const fs::path& file, const fs::path& also) : file_(file), also_(also) {}

  Result<Project> open_head() {
    Result<bool> text = is_text();
    if (!text) return text.error();
    Result<void> read = *text ? read_text() : read_zip_head();
    if (!read) return read.error();
    if (!*text && archive_->find(kMesh) && !project_.mesh_study)
      project_.mesh_study = project_.study;
    project_.mesh.clear();
    return std::move(project_);
  }

  Result<Project> open(const Progress& progress) {
    Result<bool> text = is_text();
    if (!text) return text.error();
    Result<void> read = *text ? read_text() : read_zip(progress.portion(0, 0.6));
    if (!read) return read.error();
    Project& project = project_;
    for (std::size_t k = 0; k < project.study.inputs.size(); ++k) {
      if (Result<void> found = find_input(k); !found) return found.error();
      if (progress.cancelled()) return cancelled_error();
    }
    if (project.study.flow && project.study.flow->field)
      if (Result<void> found = find_result(project.study.flow->field->source); !found)
        return found.error();
    // A mesh that names no study is of this one.
    if (!project.mesh.empty() && !project.mesh_study) project.mesh_study = project.study;
    progress.report(1);
    return std::move(project_);
  }

 private:
  Result<bool> is_text() const {
    std::error_code ec;
    // Whatever is missing or no file is told by who reads it.
    if (!fs::is_regular_file(file_, ec)) return true;
    std::ifstream stream(file_, std::ios::binary);
    char first = '\0';
    stream >> first;
    if (first != '{' && first != '[') return false;
    if (fs::file_size(file_, ec) > kLongestText)
      return refuse(file_, "too long for a study", "Give a study of Lamella.");
    return true;
  }

  Result<void> read_text() {
    Result<std::string> text = read_file(file_);
    if (!text) return text.error();
    int schema = 0;
    Result<Study> study = parse(*text, file_, &schema);
    if (!study) return study.error();
    project_.study = std::move(*study);
    for (const StudyInput* input : sources_of(project_.study))
      if (!input->entry.empty())
        return refuse(file_, "it names a copy of \"" + input->file + "\", which text cannot hold",
                      "Take \"entry\" out.");
    std::error_code ec;
    const fs::path beside = file_.string() + ".vtu";
    if (schema == 1 && fs::is_regular_file(beside, ec)) project_.mesh = beside;
    return {};
  }

  Result<void> read_zip(const Progress& progress) {
    if (Result<void> read = read_zip_head(); !read) return read;
    const ArchiveEntry* mesh = archive_->find(kMesh);
    if (!mesh) return {};
    Result<fs::path> to = unpack(*archive_, *mesh, "mesh", kMesh, progress);
    if (!to) return to.error();
    project_.mesh = std::move(*to);
    return {};
  }

  Result<void> read_zip_head() {
    Result<Archive> archive = Archive::open(file_);
    if (!archive) return archive.error();
    archive_ = std::make_unique<const Archive>(std::move(*archive));
    Result<std::string> text = read_entry(kStudy);
    if (!text) return text.error();
    if (text->empty())
      return refuse(file_, "it is no project, it has no " + std::string(kStudy),
                    "Give a .lamella project.");
    Result<Study> study = parse(*text, file_);
    if (!study) return study.error();
    project_.study = std::move(*study);
    for (const StudyInput* input : sources_of(project_.study))
      if (!input->entry.empty() && !archive_->find(input->entry))
        return refuse(file_, "the copy \"" + input->entry + "\" of an input is missing",
                      "Copy the project again, or open the .bak beside it.");
    for (const auto& [name, value] : {std::pair{kReportJson, &project_.report_json},
                                      std::pair{kReportHtml, &project_.report_html}}) {
      Result<std::string> report = read_entry(name);
      if (!report) return report.error();
      *value = std::move(*report);
    }
    if (!archive_->find(kMesh)) return {};
    Result<std::string> made_of = read_entry(kMeshStudy);
    if (!made_of) return made_of.error();
    if (!made_of->empty()) {
      Result<Study> mesh_study = parse(*made_of, file_);
      if (!mesh_study) return mesh_study.error();
      project_.mesh_study = std::move(*mesh_study);
    }
    return {};
  }

  /// Empty when there is no such entry.
  Result<std::string> read_entry(const char* name) const {
    const ArchiveEntry* entry = archive_->find(name);
    if (!entry) return std::string();
    return archive_->read(*entry, kLongestText);
  }

  /// Into a folder of ours, by a name of ours: what the entry is called does not matter.
  Result<fs::path> unpack(const Archive& archive, const ArchiveEntry& entry,
                          const std::string& folder, const std::string& name,
                          const Progress& progress) {
    if (!folder_) {
      Result<std::shared_ptr<const fs::path>> made = temporary_folder();
      if (!made) return made.error();
      folder_ = std::move(*made);
      project_.folder = folder_;
    }
    std::error_code ec;
    const fs::space_info space = fs::space(*folder_, ec);
    if (!ec && space.available < entry.size)
      return Error{Code::io,
                   "\"" + file_.string() + "\" needs " + std::to_string(entry.size >> 20) +
                       " MB for temporary files, there are " +
                       std::to_string(space.available >> 20) + ".",
                   "Make space, or set TMPDIR to a folder with more."};
    fs::create_directory(*folder_ / folder, ec);
    const fs::path to = *folder_ / folder / name;
    if (Result<void> done = archive.unpack(entry, to, progress); !done) return done.error();
    return to;
  }

  /// Where the study links the file; true where it is there, and its hash is today's then.
  Result<bool> find_linked(StudyInput& input, const std::string& kept) {
    const fs::path folder = fs::absolute(file_).parent_path();
    const fs::path linked = (folder / input.file).lexically_normal();
    const std::string before = input.sha256;
    input.file = linked.string();
    input.entry.clear();
    std::error_code ec;
    if (!fs::exists(linked, ec)) return false;
    if (Result<void> found = identify(input, linked); !found) return bad_input(found.error());
    if (!before.empty() && before != input.sha256)
      project_.notes.push_back("\"" + linked.string() +
                               "\" has changed since the study was saved: it was read anew" + kept +
                               ".");
    return true;
  }

  /// The file, or a copy of it in this project or in `also_`; nothing where it is nowhere.
  Result<std::optional<fs::path>> find_file(StudyInput& input, const std::string& folder,
                                            const std::string& kept) {
    const StudyInput saved = input;
    const Result<bool> linked = find_linked(input, kept);
    if (!linked) return linked.error();
    if (*linked) return std::optional<fs::path>(input.file);
    const auto copy = [&](const Archive& archive, const fs::path& from,
                          const StudyInput& other) -> Result<std::optional<fs::path>> {
      Result<fs::path> taken = take_copy(archive, from, other, input, folder);
      if (!taken) return taken.error();
      return std::optional(std::move(*taken));
    };
    if (archive_ && !saved.entry.empty()) return copy(*archive_, file_, saved);
    if (also_.empty() || saved.sha256.empty()) return std::optional<fs::path>();
    const Result<Archive> also = Archive::open(also_);
    const ArchiveEntry* text = also ? also->find(kStudy) : nullptr;
    const Result<std::string> json =
        text ? also->read(*text, kLongestText) : Result<std::string>(std::string());
    Result<Study> study = json ? parse(*json, also_) : Result<Study>(json.error());
    if (study)
      for (const StudyInput* other : sources_of(*study))
        if (other->sha256 == saved.sha256 && also->find(other->entry))
          return copy(*also, also_, *other);
    return std::optional<fs::path>();
  }

  Result<void> find_input(std::size_t k) {
    StudyInput& input = project_.study.inputs[k];
    Result<std::optional<fs::path>> found = find_file(
        input, std::to_string(k + 1), ", and settings, groups and sizes are kept by their names");
    if (!found) return found.error();
    if (!*found)
      return Error{Code::bad_input,
                   "\"" + file_.string() + "\": its input \"" + input.file + "\" is missing.",
                   "Put it back, or correct \"inputs\"; a project saved with copies of its inputs "
                   "does not need them."};
    project_.files.push_back(std::move(**found));
    return {};
  }

  /// Without it the parts can still be seen and edited: only a run needs it.
  Result<void> find_result(StudyInput& source) {
    const Result<std::optional<fs::path>> found = find_file(source, "result", "");
    if (!found) return found.error();
    if (!*found)
      project_.notes.push_back("The solver's result \"" + source.file +
                               "\" is missing: a run needs it to correct the mesh by its field.");
    return {};
  }

  Result<fs::path> take_copy(const Archive& archive, const fs::path& from, const StudyInput& saved,
                             StudyInput& input, const std::string& folder) {
    std::string name = fs::path(input.file).filename().string();
    if (name.empty() || name == "." || name == "..") name = "part";
    Result<fs::path> copy = unpack(archive, *archive.find(saved.entry), folder, name, {});
    if (!copy) return copy.error();
    if (Result<void> known = identify(input, *copy); !known) return known.error();
    if (!saved.sha256.empty() && saved.sha256 != input.sha256)
      return refuse(from,
                    "the copy \"" + saved.entry + "\" is not what was saved, its hash differs",
                    "Put back \"" + input.file + "\", or open the .bak beside it.");
    project_.notes.push_back("\"" + input.file +
                             "\" is missing: the copy in the project was read.");
    project_.copies[input.sha256] = *copy;
    return copy;
  }

  static Error bad_input(Error error) {
    if (error.code == Code::io) error.code = Code::bad_input;
    return error;
  }

  const fs::path& file_;
  const fs::path& also_;
  std::unique_ptr<const Archive> archive_;
  std::shared_ptr<const fs::path> folder_;
  Project project_;
};

/// The name of a copy within the project: number and name of the file, in plain letters.
std::string entry_name(std::size_t k, const std::string& file) {
  std::string name = fs::path(file).filename().string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
  return "inputs/" + std::to_string(k + 1) + "-" + name;
}

/// Adds copies of the inputs, each as it was when it was read.
void embed(const ProjectContent& content, Study& study, std::vector<NewEntry>& entries,
           std::vector<std::string>& notes) {
  Study named = content.study;  // as it was before its files became relative
  const std::vector<StudyInput*> from = sources_of(named), to = sources_of(study);
  for (std::size_t k = 0; k < to.size(); ++k) {
    StudyInput& input = *to[k];
    std::vector<fs::path> places = {from[k]->file};
    if (const auto copy = content.copies.find(input.sha256); copy != content.copies.end())
      places.push_back(copy->second);
    for (const fs::path& place : places) {
      Result<std::string> bytes = read_file(place);
      if (!bytes || (!input.sha256.empty() && sha256(*bytes) != input.sha256)) continue;
      input.sha256 = sha256(*bytes);
      input.bytes = bytes->size();
      input.entry = entry_name(k, input.file);
      entries.push_back({input.entry, std::move(*bytes)});
      break;
    }
    if (input.entry.empty())
      notes.push_back("\"" + from[k]->file +
                      "\" is no longer what was read: the project holds no copy of it.");
  }
}

/// Reads all of what was written, and the study from it.
Result<void> prove(const fs::path& written, const std::vector<NewEntry>& entries,
                   const std::string& study, const Progress& progress) {
  Result<Archive> archive = Archive::open(written);
  if (!archive) return archive.error();
  if (archive->entries().size() != entries.size())
    return refuse(written, "entries are missing", "");
  if (Result<void> good = archive->check(progress); !good) return good;
  Result<std::string> text = archive->read(*archive->find(kStudy), kLongestText);
  if (!text) return text.error();
  Result<Study> back = parse(*text, written);
  if (!back) return back.error();
  if (*text != study || study_to_json(*back) != study)
    return refuse(written, "the study reads back otherwise", "");
  return {};
}

/// What a project tells of its faces; empty: nothing.
Result<std::vector<KnownFaces>> faces_of(const fs::path& file) {
  const Result<Archive> archive = Archive::open(file);
  if (!archive) return archive.error();
  const ArchiveEntry* entry = archive->find(kFaces);
  if (!entry) return std::vector<KnownFaces>();
  const Result<std::string> text = archive->read(*entry, kLongestText);
  if (!text) return text.error();
  if (depth_of(*text) > kDeepestText) return refuse(file, "it is nested too deep", "");
  return known_faces_from(*text);
}

}  // namespace

bool is_project(const fs::path& file) { return ending_of(file) == ".lamella"; }

bool names_study(const fs::path& file) { return is_project(file) || ending_of(file) == ".json"; }

Result<Project> open_project(const fs::path& file, const Progress& progress, const fs::path& also) {
  return Opening(file, also).open(progress);
}

Result<Project> open_project_head(const fs::path& file) { return Opening(file, {}).open_head(); }

Result<std::vector<std::string>> save_project(const ProjectContent& content, const fs::path& file,
                                              const Progress& progress) {
  std::error_code ec;
  const fs::path folder = fs::absolute(file, ec).parent_path();
  Study study = seen_from(content.study, folder);
  for (StudyInput* input : sources_of(study)) input->entry.clear();
  std::vector<std::string> notes;
  if (ending_of(file) == ".json") {
    if (study.embed_inputs || content.write_mesh)
      notes.emplace_back(
          "A study as text holds neither meshes nor copies of inputs: .lamella does.");
    if (Result<void> saved = save_study(study, file); !saved) return saved.error();
    return notes;
  }
  if (fs::exists(file, ec) && !fs::is_regular_file(file, ec))
    return Error{Code::io, "\"" + file.string() + "\" cannot be written, it is no file.",
                 "Give a file name."};
  remove_leftovers(file);
  Result<AtomicFile> target = AtomicFile::create(file);
  if (!target) return target.error();

  std::vector<NewEntry> entries(1);
  if (content.write_mesh) {
    const fs::path mesh = target->beside(".vtu");
    if (Result<void> written = content.write_mesh(mesh); !written) return written.error();
    if (progress.cancelled()) return cancelled_error();
    progress.report(0.5);
    entries.push_back({kMesh, mesh, false});
    Study made_of = seen_from(content.mesh_study.value_or(content.study), folder);
    for (StudyInput* input : sources_of(made_of)) input->entry.clear();
    entries.push_back({kMeshStudy, study_to_json(made_of)});
    for (const auto& [name, report] : {std::pair{kReportJson, &content.report_json},
                                       std::pair{kReportHtml, &content.report_html}}) {
      if (report->size() > kLongestText)
        notes.push_back(std::string(name) + " is too long for a project: it was left out.");
      else if (!report->empty())
        entries.push_back({name, *report});
    }
  }
  if (study.embed_inputs) embed(content, study, entries, notes);
  if (!content.faces.empty()) entries.push_back({kFaces, known_faces_json(content.faces)});
  const std::string text = study_to_json(study);
  entries.front() = {kStudy, text};

  const fs::path& temporary = target->temporary();
  Result<void> done = write_archive(temporary, entries, progress.portion(0.5, 0.8));
  if (done) done = prove(temporary, entries, text, progress.portion(0.8, 1));
  if (!done && done.error().code == Code::cancelled) return done.error();
  if (!done)
    return Error{Code::io, "\"" + file.string() + "\" was not saved: " + done.error().message,
                 "Check the space on the disk, or save it elsewhere; what was there before is "
                 "untouched."};
  const Result<Archive> before = Archive::open(file), after = Archive::open(temporary);
  const bool same = before && after && before->entries() == after->entries();
  if (Result<void> placed = target->commit(!same); !placed) return placed.error();
  return notes;
}

Study seen_from(Study study, const fs::path& folder) {
  for (StudyInput* input : sources_of(study)) {
    const fs::path absolute = fs::absolute(input->file).lexically_normal();
    const fs::path relative = folder.empty() ? fs::path() : absolute.lexically_relative(folder);
    // A file far away is better named where it is: the study may be moved without it.
    const bool near = !relative.empty() && *relative.begin() != "..";
    input->file = near ? relative.string() : absolute.string();
  }
  return study;
}

std::vector<std::string> fit_to_parts(Study& study, const fs::path& file,
                                      const std::vector<Part>& parts) {
  std::vector<std::string> notes;
  const Result<Project> saved = open_project_head(file);
  bool changed = false;
  for (std::size_t k = 0; saved && k < saved->study.inputs.size(); ++k) {
    const std::string& before = saved->study.inputs[k].sha256;
    changed =
        changed || (k < study.inputs.size() && !before.empty() && before != study.inputs[k].sha256);
  }
  if (changed && !known_faces(study, parts).empty()) {
    const Result<std::vector<KnownFaces>> faces = faces_of(file);
    if (faces && !faces->empty()) {
      notes = move_faces(study, *faces, parts);
      notes.insert(
          notes.begin(),
          "What is asked of faces by number goes to the faces that are in their place now.");
    } else {
      notes.emplace_back(
          "It does not tell where its faces were: see whether their numbers are still the same.");
    }
  }
  for (std::string& note : unmatched(study, parts)) notes.push_back(std::move(note));
  return notes;
}

std::vector<std::string> unmatched(const Study& study, const std::vector<Part>& parts) {
  std::vector<std::string> notes;
  const auto part_called = [&](const std::string& name) -> const Part* {
    if (name.empty()) return parts.size() == 1 ? &parts.front() : nullptr;
    const auto at = std::find_if(parts.begin(), parts.end(),
                                 [&](const Part& part) { return part.name == name; });
    return at == parts.end() ? nullptr : &*at;
  };
  const auto is_body = [&](const std::string& name) {
    return part_called(name) || (has_background(study) && name == kBackground) ||
           std::any_of(study.zones.begin(), study.zones.end(),
                       [&](const StudyZone& zone) { return zone.name == name; });
  };
  for (const BodySettings& body : study.bodies)
    if (!is_body(body.name))
      notes.push_back("There is no body \"" + body.name +
                      "\" any more: its settings are left out.");
  const auto look = [&](const std::string& who, const std::string& body,
                        const std::vector<std::int32_t>& ids,
                        const std::vector<std::string>& names) {
    if (!body.empty() && !is_body(body)) {
      notes.push_back(who + " is on the body \"" + body + "\", which is no longer there.");
      return;
    }
    const Part* part = part_called(body);
    if (!part) return;
    const auto& faces = part->surface.faces;
    for (const std::int32_t id : ids)
      if (id < 0 || static_cast<std::size_t>(id) >= faces.size())
        notes.push_back(who + ": \"" + part->name + "\" has no face " + std::to_string(id) + ".");
    for (const std::string& name : names)
      if (std::none_of(faces.begin(), faces.end(),
                       [&](const SurfaceFace& face) { return face.name == name; }))
        notes.push_back(who + ": \"" + part->name + "\" has no face \"" + name + "\".");
  };
  for (const BoundaryGroup& group : study.groups)
    look("Group \"" + group.name + "\"", group.body, group.faces, group.face_names);
  for (const SizingObject& object : study.sizing) {
    const auto* faces = std::get_if<FacesShape>(&object.shape);
    look("Size \"" + object.name + "\"", object.body,
         faces ? faces->ids : std::vector<std::int32_t>{},
         faces ? faces->names : std::vector<std::string>{});
  }
  return notes;
}

}  // namespace lamella
