#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"

namespace lamella {

/// What a zip from elsewhere may ask of us. Sizes in bytes.
struct ArchiveLimits {
  std::uint64_t entries = 1000;
  std::uint64_t unpacked = std::uint64_t{64} << 30;  ///< of all entries together
  /// Unpacked over packed size of an entry above `small`; text packs by 10, a bomb by 1000.
  double ratio = 200;
  std::uint64_t small = 1 << 20;
};

struct ArchiveEntry {
  std::string name;  ///< relative, with '/', within the folder
  std::uint64_t index = 0;
  std::uint64_t size = 0;  ///< unpacked, bytes
  std::uint32_t crc = 0;

  bool operator==(const ArchiveEntry&) const = default;
};

/// A zip that is read. Its names, kinds, counts and sizes are checked before anything is unpacked:
/// a file made to harm is refused with its reason.
class Archive {
 public:
  /// Errors: io (missing, unreadable); bad_input (no zip, truncated, inconsistent; entries twice,
  /// outside of the folder, links, encrypted, too many or too large), naming file and entry.
  static Result<Archive> open(const std::filesystem::path& file, const ArchiveLimits& limits = {});

  /// Folders are left out.
  const std::vector<ArchiveEntry>& entries() const { return entries_; }
  /// Null when there is none.
  const ArchiveEntry* find(const std::string& name) const;

  /// Content of an entry of at most `most` bytes. Errors: bad_input (larger, damaged).
  Result<std::string> read(const ArchiveEntry& entry, std::uint64_t most) const;
  /// Writes the content to a new file, piece by piece. Errors: bad_input (damaged), io, cancelled;
  /// nothing is left behind.
  Result<void> unpack(const ArchiveEntry& entry, const std::filesystem::path& to,
                      const Progress& progress = {}) const;
  /// Reads all entries and compares their checksums. Errors: bad_input, cancelled.
  Result<void> check(const Progress& progress = {}) const;

 private:
  struct Handle;
  Archive() = default;
  template <class Sink>
  Result<void> each_piece(const ArchiveEntry& entry, const Progress& progress, Sink sink) const;

  std::filesystem::path file_;
  std::shared_ptr<Handle> handle_;
  std::vector<ArchiveEntry> entries_;
};

/// An entry to be written: bytes, or the content of a file.
struct NewEntry {
  std::string name;
  std::variant<std::string, std::filesystem::path> content;
  bool packed = true;  ///< false: stored as it is, for content that is packed already
};

/// Writes a zip in the place of `file`; the same entries give the same bytes. The caller sees to it
/// that nothing is lost on failure. Errors: io, cancelled.
Result<void> write_archive(const std::filesystem::path& file, const std::vector<NewEntry>& entries,
                           const Progress& progress = {});

}  // namespace lamella
