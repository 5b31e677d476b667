#include "core/base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>

namespace lamella {

namespace {

namespace fs = std::filesystem;

Error io_error(const fs::path& file, const std::string& finding, const std::string& hint) {
  return {Code::io, "\"" + file.string() + "\": " + finding + ".", hint};
}

bool flush_to_disk(const fs::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags);
  if (descriptor < 0) return false;
  const bool good = ::fsync(descriptor) == 0;
  ::close(descriptor);
  return good;
}

/// Makes FILE.bak of the file, by way of `between`; the file itself stays.
Result<void> back_up(const fs::path& file, const fs::path& between) {
  std::error_code ec;
  if (!fs::is_regular_file(file, ec)) return {};
  fs::create_hard_link(file, between, ec);
  // Not every file system has links.
  if (ec && fs::copy_file(file, between, fs::copy_options::overwrite_existing, ec) &&
      !flush_to_disk(between, O_RDONLY))
    ec.assign(errno, std::generic_category());
  if (ec)
    return io_error(file, "no backup could be made of it (" + ec.message() + ")",
                    "Check the space on the disk.");
  fs::rename(between, file.string() + ".bak", ec);
  if (ec) return io_error(file, "no backup could be made of it (" + ec.message() + ")", "");
  return {};
}

}  // namespace

Result<AtomicFile> AtomicFile::create(const fs::path& target) {
  static std::atomic<unsigned> counter = 0;
  std::error_code ec;
  AtomicFile file;
  // Renaming onto a symbolic link would replace the link instead of what it points to.
  file.target_ = fs::is_symlink(target, ec) ? fs::weakly_canonical(target, ec) : target;
  const fs::file_status status = fs::status(file.target_, ec);
  if (fs::is_directory(status))
    return io_error(target, "cannot be written, it is a folder", "Give a file name.");
  const fs::path folder = file.target_.has_parent_path() ? file.target_.parent_path() : ".";
  if (!fs::is_directory(folder, ec))
    return io_error(target, "the folder does not exist", "Create it first.");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    file.temporary_ = file.target_;
  } else {
    file.temporary_ =
        folder / ("." + file.target_.filename().string() + "." + std::to_string(::getpid()) + "-" +
                  std::to_string(counter++) + ".part");
  }
  errno = 0;
  file.stream_.open(file.temporary_, std::ios::binary | std::ios::trunc);
  if (!file.stream_)
    return io_error(target, std::string("cannot be written (") + std::strerror(errno) + ")",
                    "Check the permissions of the folder and the space on the disk.");
  return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      beside_(std::move(other.beside_)),
      stream_(std::move(other.stream_)) {
  other.temporary_.clear();
}

fs::path AtomicFile::beside(const std::string& ending) const {
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
  // A pipe's own name is no place for further files, its folder is.
  const std::string stem =
      temporary_ == target_ ? "." + target_.filename().string() + "." + std::to_string(::getpid())
                            : temporary_.filename().string();
  beside_.push_back(folder / (stem + ending));
  return beside_.back();
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  for (const fs::path& file : beside_) fs::remove(file, ignored);
  if (temporary_.empty() || temporary_ == target_) return;
  stream_.close();
  std::error_code ec;
  fs::remove(temporary_, ec);
}

Result<void> AtomicFile::commit(bool keep_backup) {
  const std::string hint = "Check the space on the disk.";
  errno = 0;
  stream_.close();
  if (!stream_) return io_error(target_, "writing failed", hint);
  if (temporary_ == target_) return {};
  if (!flush_to_disk(temporary_, O_RDONLY))
    return io_error(target_, std::string("writing failed (") + std::strerror(errno) + ")", hint);
  if (keep_backup)
    if (Result<void> kept = back_up(target_, beside(".bak")); !kept) return kept;
  std::error_code ec;
  fs::rename(temporary_, target_, ec);
  if (ec) return io_error(target_, "cannot be replaced (" + ec.message() + ")", "");
  temporary_.clear();
  // The name is durable only once the folder is; a file system that cannot do that is no failure.
  flush_to_disk(target_.has_parent_path() ? target_.parent_path() : ".", O_RDONLY | O_DIRECTORY);
  return {};
}

void remove_leftovers(const fs::path& target) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
  const std::string name = target.filename().string() + ".";
  std::error_code ec;
  std::vector<fs::path> gone;
  for (fs::directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
    const fs::directory_entry& entry = *at;
    const std::string file = entry.path().filename().string();
    const std::size_t dots = file.find_first_not_of('.');
    if (dots == 0 || dots == file.npos || file.compare(dots, name.size(), name) != 0) continue;
    const std::string rest = file.substr(dots + name.size());
    const long process = std::strtol(rest.c_str(), nullptr, 10);
    if (process <= 0 || rest.find(".part") == rest.npos) continue;
    if (::kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH) continue;
    // On a shared disk the process may be one of another machine.
    std::error_code unknown;
    const auto written = fs::last_write_time(entry.path(), unknown);
    if (unknown || fs::file_time_type::clock::now() - written < std::chrono::minutes(10)) continue;
    gone.push_back(entry.path());
  }
  for (const fs::path& file : gone) fs::remove(file, ec);
}

Result<void> write_file(const fs::path& target, std::string_view bytes) {
  Result<AtomicFile> file = AtomicFile::create(target);
  if (!file) return file.error();
  file->stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file->commit();
}

Result<std::ifstream> open_to_read(const fs::path& path) {
  std::error_code ec;
  const fs::file_status status = fs::status(path, ec);
  if (!fs::exists(status))
    return io_error(path, "there is no such file", "Check the name and the folder.");
  if (fs::is_directory(status)) return io_error(path, "this is a folder", "Give a file.");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    return io_error(path, std::string("cannot be read (") + std::strerror(errno) + ")",
                    "Check the permissions.");
  return stream;
}

Result<std::string> read_file(const fs::path& path) {
  Result<std::ifstream> opened = open_to_read(path);
  if (!opened) return opened.error();
  std::ifstream& stream = *opened;
  std::error_code ec;
  std::string bytes;
  const auto size = fs::file_size(path, ec);
  if (!ec) bytes.reserve(size);
  char buffer[1 << 16];
  while (stream.read(buffer, sizeof buffer) || stream.gcount() > 0)
    bytes.append(buffer, static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) return io_error(path, "reading failed", "Check the disk.");
  return bytes;
}

}  // namespace lamella
