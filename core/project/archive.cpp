#include "core/project/archive.h"

#include <sys/stat.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>

#include "core/base/atomic_file.h"

namespace lamella {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPiece = 1 << 18;
/// 1980-01-01, where zip's calendar begins: the same content gives the same bytes.
constexpr zip_uint16_t kDosDate = 1 << 5 | 1;

Error refuse(const fs::path& file, const std::string& finding, const std::string& hint) {
  return {Code::bad_input, "\"" + file.string() + "\": " + finding + ".", hint};
}
const char* const kCopyAgain = "Copy it again, or open the .bak beside it.";
const char* const kDistrust =
    "It may be made to do harm: do not use it unless you know its origin.";

struct ErrorText {
  zip_error_t error{};
  explicit ErrorText(int code) { zip_error_init_with_code(&error, code); }
  ~ErrorText() { zip_error_fini(&error); }
  std::string text() { return zip_error_strerror(&error); }
};

/// What the end of the file says of the number of entries, before anything is made of it; nothing
/// where there is no such end.
bool tells_too_many(std::ifstream& stream, std::uint64_t most) {
  constexpr std::uint64_t kRecord = 22, kComment = 65535;
  stream.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(stream.tellg());
  const std::uint64_t length = std::min(size, kRecord + kComment);
  std::string tail(length, '\0');
  stream.seekg(static_cast<std::streamoff>(size - length));
  stream.read(tail.data(), static_cast<std::streamsize>(length));
  const std::size_t at = tail.rfind("PK\x05\x06");
  if (at == tail.npos || at + kRecord > tail.size()) return false;
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(tail[at + k]); };
  return static_cast<std::uint64_t>(byte(10) | byte(11) << 8) > most;
}

/// Why the name must not be followed; empty when it may.
std::string fault_of(const std::string& name) {
  if (name.empty()) return "has no name";
  if (name.find('\\') != name.npos) return "has a backslash in its name";
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == 127; }))
    return "has a control character in its name";
  if (name.front() == '/' || (name.size() > 1 && name[1] == ':')) return "has an absolute name";
  for (const fs::path& step : fs::path(name))
    if (step == ".." || step == ".") return "leaves the folder";
  return "";
}

std::string printable(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  if (name.size() > 80) name = name.substr(0, 77) + "...";
  return name;
}

}  // namespace

struct Archive::Handle {
  zip_t* zip = nullptr;
  std::mutex one_at_a_time;
  ~Handle() {
    if (zip) zip_discard(zip);
  }
};

Result<Archive> Archive::open(const fs::path& file, const ArchiveLimits& limits) {
  std::error_code ec;
  const fs::file_status status = fs::status(file, ec);
  const auto unreadable = [&](const std::string& finding, const std::string& hint) {
    return Error{Code::io, "\"" + file.string() + "\": " + finding + ".", hint};
  };
  if (!fs::exists(status))
    return unreadable("there is no such file", "Check the name and the folder.");
  if (!fs::is_regular_file(status)) return unreadable("this is no file", "Give a file.");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    return unreadable(std::string("cannot be read (") + std::strerror(errno) + ")",
                      "Check the permissions.");
  std::array<char, 4> head{};
  stream.read(head.data(), head.size());
  const bool begins = stream.gcount() == 4 && std::memcmp(head.data(), "PK\x03\x04", 4) == 0;
  stream.clear();
  const auto entry_count = "more than " + std::to_string(limits.entries) + " entries";
  if (tells_too_many(stream, limits.entries))
    return refuse(file, "it has " + entry_count, kDistrust);
  stream.close();

  Archive archive;
  archive.file_ = file;
  archive.handle_ = std::make_shared<Handle>();
  int code = 0;
  archive.handle_->zip = zip_open(file.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &code);
  zip_t* zip = archive.handle_->zip;
  if (!zip) {
    if (code == ZIP_ER_NOZIP && !begins)
      return refuse(file, "it is no project: neither a zip nor a study as text",
                    "Give a .lamella project or a study.");
    if (code == ZIP_ER_EXISTS) return refuse(file, "one of its entries is there twice", kDistrust);
    if (code == ZIP_ER_NOZIP)
      return refuse(file, "the file ends too early", std::string("It is truncated. ") + kCopyAgain);
    return refuse(file, "the file is damaged (" + ErrorText(code).text() + ")", kCopyAgain);
  }
  const auto count =
      static_cast<std::uint64_t>(std::max<zip_int64_t>(0, zip_get_num_entries(zip, 0)));
  if (count > limits.entries) return refuse(file, "it has " + entry_count, kDistrust);

  const std::uint64_t file_size = fs::file_size(file, ec);
  std::uint64_t unpacked = 0, packed = 0;
  std::set<std::string> names;
  for (std::uint64_t i = 0; i < count; ++i) {
    zip_stat_t stat;
    zip_stat_init(&stat);
    if (zip_stat_index(zip, i, ZIP_FL_ENC_RAW, &stat) != 0)
      return refuse(file, "the file is damaged (entry " + std::to_string(i) + ")", kCopyAgain);
    const std::string name = stat.name ? stat.name : "";
    const std::string who = "its entry \"" + printable(name) + "\" ";
    if (const std::string fault = fault_of(name); !fault.empty())
      return refuse(file, who + fault, kDistrust);
    if (!names.insert(name).second) return refuse(file, who + "is there twice", kDistrust);
    zip_uint8_t system = 0;
    zip_uint32_t attributes = 0;
    zip_file_get_external_attributes(zip, i, 0, &system, &attributes);
    const zip_uint32_t kind = (attributes >> 16) & S_IFMT;
    if (system == ZIP_OPSYS_UNIX && kind != 0 && kind != S_IFREG && kind != S_IFDIR)
      return refuse(file, who + (kind == S_IFLNK ? "is a link" : "is no file"), kDistrust);
    if (stat.encryption_method != ZIP_EM_NONE)
      return refuse(file, who + "is encrypted", "Give a project that is not.");
    if (stat.comp_method != ZIP_CM_STORE && stat.comp_method != ZIP_CM_DEFLATE)
      return refuse(file, who + "is packed in an unknown way", "Pack it by deflate.");
    // Each is below the file's size or refused, so that the sums below cannot overflow.
    if (stat.comp_size > file_size || stat.size > limits.unpacked)
      return refuse(file, who + "is larger than can be", kDistrust);
    if (stat.size > limits.small &&
        static_cast<double>(stat.size) > limits.ratio * static_cast<double>(stat.comp_size))
      return refuse(file,
                    who + "unpacks to " + std::to_string(stat.size) + " bytes from " +
                        std::to_string(stat.comp_size),
                    kDistrust);
    unpacked += stat.size;
    packed += stat.comp_size;
    if (packed > file_size) return refuse(file, "its entries overlap", kDistrust);
    if (unpacked > limits.unpacked)
      return refuse(file, "it unpacks to more than " + std::to_string(limits.unpacked) + " bytes",
                    kDistrust);
    if (name.back() != '/') archive.entries_.push_back({name, i, stat.size, stat.crc});
  }
  return archive;
}

const ArchiveEntry* Archive::find(const std::string& name) const {
  const auto at = std::find_if(entries_.begin(), entries_.end(),
                               [&](const ArchiveEntry& entry) { return entry.name == name; });
  return at == entries_.end() ? nullptr : &*at;
}

template <class Sink>
Result<void> Archive::each_piece(const ArchiveEntry& entry, const Progress& progress,
                                 Sink sink) const {
  const std::lock_guard lock(handle_->one_at_a_time);
  const std::string who = "its entry \"" + entry.name + "\" ";
  zip_file_t* stream = zip_fopen_index(handle_->zip, entry.index, 0);
  if (!stream) return refuse(file_, who + "cannot be read", kCopyAgain);
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> closes(stream, zip_fclose);
  std::vector<char> piece(kPiece);
  std::uint64_t done = 0;
  for (;;) {
    const zip_int64_t got = zip_fread(stream, piece.data(), piece.size());
    if (got < 0) return refuse(file_, who + "is damaged", kCopyAgain);
    if (got == 0) break;
    done += static_cast<std::uint64_t>(got);
    // What the list of entries promised is what was judged.
    if (done > entry.size) return refuse(file_, who + "is larger than it says", kDistrust);
    if (Result<void> taken = sink(piece.data(), static_cast<std::size_t>(got)); !taken)
      return taken;
    if (progress.cancelled()) return cancelled_error();
    progress.report(static_cast<double>(done) / static_cast<double>(entry.size));
  }
  if (done != entry.size) return refuse(file_, who + "is shorter than it says", kCopyAgain);
  return {};
}

Result<std::string> Archive::read(const ArchiveEntry& entry, std::uint64_t most) const {
  if (entry.size > most)
    return refuse(file_,
                  "its entry \"" + entry.name + "\" has " + std::to_string(entry.size) +
                      " bytes, at most " + std::to_string(most) + " are read",
                  kDistrust);
  std::string bytes;
  bytes.reserve(entry.size);
  Result<void> done = each_piece(entry, {}, [&](const char* data, std::size_t size) {
    bytes.append(data, size);
    return Result<void>();
  });
  if (!done) return done.error();
  return bytes;
}

Result<void> Archive::unpack(const ArchiveEntry& entry, const fs::path& to,
                             const Progress& progress) const {
  Result<AtomicFile> target = AtomicFile::create(to);
  if (!target) return target.error();
  Result<void> done = each_piece(entry, progress, [&](const char* data, std::size_t size) {
    if (target->stream().write(data, static_cast<std::streamsize>(size))) return Result<void>();
    return Result<void>(Error{Code::io, "\"" + to.string() + "\": writing failed.",
                              "Check the space on the disk."});
  });
  if (!done) return done;
  return target->commit();
}

Result<void> Archive::check(const Progress& progress) const {
  std::uint64_t all = 1, before = 0;
  for (const ArchiveEntry& entry : entries_) all += entry.size;
  for (const ArchiveEntry& entry : entries_) {
    const auto share = [&](std::uint64_t bytes) {
      return static_cast<double>(bytes) / static_cast<double>(all);
    };
    Result<void> good =
        each_piece(entry, progress.portion(share(before), share(before + entry.size)),
                   [](const char*, std::size_t) { return Result<void>(); });
    if (!good) return good;
    before += entry.size;
  }
  return {};
}

Result<void> write_archive(const fs::path& file, const std::vector<NewEntry>& entries,
                           const Progress& progress) {
  const auto failed = [&](zip_error_t* error) {
    return Error{Code::io,
                 "\"" + file.string() + "\": writing failed (" + zip_error_strerror(error) + ").",
                 "Check the space on the disk."};
  };
  int code = 0;
  zip_t* zip = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (!zip) {
    ErrorText error(code);
    return failed(&error.error);
  }
  std::unique_ptr<zip_t, void (*)(zip_t*)> discards(zip, zip_discard);
  for (const NewEntry& entry : entries) {
    const auto* bytes = std::get_if<std::string>(&entry.content);
    zip_source_t* source =
        bytes ? zip_source_buffer(zip, bytes->data(), bytes->size(), 0)
              : zip_source_file(zip, std::get<fs::path>(entry.content).c_str(), 0, -1);
    if (!source) return failed(zip_get_error(zip));
    const zip_int64_t index = zip_file_add(zip, entry.name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(source);
      return failed(zip_get_error(zip));
    }
    const auto at = static_cast<zip_uint64_t>(index);
    if (zip_set_file_compression(zip, at, entry.packed ? ZIP_CM_DEFLATE : ZIP_CM_STORE,
                                 entry.packed ? 1 : 0) != 0 ||
        zip_file_set_dostime(zip, at, 0, kDosDate, 0) != 0)
      return failed(zip_get_error(zip));
  }
  auto* told = const_cast<Progress*>(&progress);
  zip_register_progress_callback_with_state(
      zip, 0.01,
      [](zip_t*, double fraction, void* data) {
        static_cast<const Progress*>(data)->report(fraction);
      },
      nullptr, told);
  zip_register_cancel_callback_with_state(
      zip,
      [](zip_t*, void* data) { return static_cast<const Progress*>(data)->cancelled() ? 1 : 0; },
      nullptr, told);
  if (zip_close(zip) != 0)
    return progress.cancelled() ? cancelled_error() : failed(zip_get_error(zip));
  discards.release();
  return {};
}

}  // namespace lamella
