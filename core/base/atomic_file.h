#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace lamella {

/// A file that appears complete or not at all: it is written beside its target under a hidden name,
/// flushed to the disk and renamed by `commit`. Without `commit` nothing is left behind and an
/// older target stays as it was. A target that is no regular file (a pipe, /dev/stdout) is written
/// directly.
class AtomicFile {
 public:
  /// Errors: io (no such folder, no permission, target is a folder).
  static Result<AtomicFile> create(const std::filesystem::path& target);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  /// Where to write, for libraries that open files themselves.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Stream to the temporary file, binary, open since `create`.
  std::ostream& stream() { return stream_; }
  /// Where something more may be put for the time of writing: a name beside `temporary`, with this
  /// ending, that goes with it.
  std::filesystem::path beside(const std::string& ending) const;
  /// Errors: io (disk full, renaming failed); the temporary file is gone then. With `keep_backup`
  /// an older target becomes TARGET.bak; at no moment is there no target.
  Result<void> commit(bool keep_backup = false);

 private:
  AtomicFile() = default;
  std::filesystem::path target_, temporary_;
  mutable std::vector<std::filesystem::path> beside_;
  std::ofstream stream_;
};

/// Removes what programs that were killed while they wrote the target have left beside it: their
/// process is gone, and nobody wrote to it for ten minutes.
void remove_leftovers(const std::filesystem::path& target);

/// Writes the bytes in one step. Errors: as AtomicFile.
Result<void> write_file(const std::filesystem::path& target, std::string_view bytes);

/// A file to be read, binary, at its beginning. Errors: io (missing, a folder, unreadable), naming
/// the file.
Result<std::ifstream> open_to_read(const std::filesystem::path& file);

/// Whole content of a file. Errors: io (missing, a folder, unreadable), naming the file.
Result<std::string> read_file(const std::filesystem::path& file);

}  // namespace lamella
