#include "core/project/archive.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <random>

#include "core/base/atomic_file.h"
#include "tests/support/raw_zip.h"
#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

using namespace std::string_literals;

using test::raw_zip;
using test::RawEntry;

struct ArchiveTest : testing::Test {
  test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.lamella";

  Result<Archive> open(const std::string& bytes, const ArchiveLimits& limits = {}) {
    std::ofstream(file, std::ios::binary) << bytes;
    return Archive::open(file, limits);
  }
  /// The sentence of the refusal; empty when it was opened.
  std::string refusal(const std::string& bytes, const ArchiveLimits& limits = {}) {
    const Result<Archive> archive = open(bytes, limits);
    if (archive) return "";
    EXPECT_NE(archive.error().message.find("a.lamella"), std::string::npos);
    EXPECT_FALSE(archive.error().hint.empty());
    EXPECT_EQ(archive.error().code, Code::bad_input);
    return archive.error().message;
  }
  std::string packed(const std::vector<NewEntry>& entries) {
    EXPECT_TRUE(write_archive(file, entries));
    return read_file(file).value();
  }
};

TEST_F(ArchiveTest, GivesBackWhatWasPutInAndIsTheSameBytesAgain) {
  ASSERT_TRUE(write_file(folder / "mesh", std::string(300000, 'm')));
  const std::vector<NewEntry> entries = {
      {"project.json", "{}"s}, {"mesh.vtu", folder / "mesh", false}, {"inputs/1-ä b.stl", ""s}};
  const std::string bytes = packed(entries);
  const Result<Archive> archive = Archive::open(file);
  ASSERT_TRUE(archive) << archive.error().message;
  ASSERT_EQ(archive->entries().size(), 3u);
  EXPECT_TRUE(archive->check());
  EXPECT_EQ(archive->read(*archive->find("project.json"), 100).value(), "{}");
  EXPECT_EQ(archive->read(*archive->find("inputs/1-ä b.stl"), 100).value(), "");
  ASSERT_TRUE(archive->unpack(*archive->find("mesh.vtu"), folder / "back"));
  EXPECT_EQ(read_file(folder / "back").value(), std::string(300000, 'm'));
  EXPECT_EQ(archive->find("mesh"), nullptr);
  EXPECT_FALSE(archive->read(*archive->find("mesh.vtu"), 299999));
  EXPECT_EQ(packed(entries), bytes);
  EXPECT_LT(packed({{"a", std::string(300000, 'm')}}).size(), 10000u);
}

TEST_F(ArchiveTest, AnotherProgramsZipIsRead) {
  const Result<Archive> archive =
      open(raw_zip({{"inputs/", "", 040755}, {"project.json", "{}"}, {"inputs/1-a.stl", "solid"}}));
  ASSERT_TRUE(archive) << archive.error().message;
  EXPECT_EQ(archive->entries().size(), 2u) << "folders are no entries";
  EXPECT_TRUE(archive->check());
}

TEST_F(ArchiveTest, HostileEntriesAreNamedAndRefused) {
  const std::vector<std::pair<RawEntry, std::string>> cases = {
      {{"../evil"}, "leaves the folder"},
      {{"inputs/../../evil"}, "leaves the folder"},
      {{"./evil"}, "leaves the folder"},
      {{"/etc/evil"}, "absolute"},
      {{"C:/evil"}, "absolute"},
      {{"..\\evil"}, "backslash"},
      {{"a\nb"}, "control character"},
      {{""}, "no name"},
      {{"link", "/etc/passwd", 0120777}, "is a link"},
      {{"pipe", "", 0010644}, "is no file"},
      {{"secret", "x", 0100644, 1}, "encrypted"},
      {{"strange", "x", 0100644, 0, 12}, "unknown way"}};
  for (const auto& [entry, finding] : cases) {
    const std::string told = refusal(raw_zip({{"project.json", "{}"}, entry}));
    EXPECT_NE(told.find(finding), std::string::npos) << entry.name << ": " << told;
  }
  EXPECT_NE(refusal(raw_zip({{"a", "1"}, {"a", "2"}})).find("there twice"), std::string::npos);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.lamella"}) << "nothing is written";
}

TEST_F(ArchiveTest, AbsurdCountsAreRefused) {
  EXPECT_NE(refusal(raw_zip(std::vector<RawEntry>(1001, {"a"}))).find("more than 1000"),
            std::string::npos);
  // A count that the list does not bear out.
  std::string lie = raw_zip({{"project.json", "{}"}});
  for (const std::size_t at : {lie.size() - 14, lie.size() - 12}) lie[at] = lie[at + 1] = '\xff';
  EXPECT_NE(refusal(lie).find("more than 1000"), std::string::npos);
  for (const std::size_t at : {lie.size() - 14, lie.size() - 12}) lie[at] = 9, lie[at + 1] = 0;
  EXPECT_NE(refusal(lie), "");
}

TEST_F(ArchiveTest, BombsAreRefusedBeforeTheyAreUnpacked) {
  const std::string zeros = packed({{"mesh.vtu", std::string(64 << 20, '\0')}});
  EXPECT_NE(refusal(zeros).find("unpacks to 67108864 bytes"), std::string::npos) << refusal(zeros);
  // Many small ones, each below the bound of a ratio.
  std::vector<NewEntry> many;
  for (int k = 0; k < 100; ++k) many.push_back({std::to_string(k), std::string(1 << 20, '\0')});
  ArchiveLimits limits;
  limits.unpacked = 64 << 20;
  EXPECT_NE(refusal(packed(many), limits).find("more than 67108864"), std::string::npos);
  // One that says it is small: what it says is all that is unpacked.
  std::string lie = packed({{"mesh.vtu", std::string(2 << 20, '\0')}});
  const std::string size("\0\0\x20\0", 4), small("\0\x10\0\0", 4);
  int patched = 0;
  for (std::size_t at = 0; (at = lie.find(size, at)) != lie.npos; at += 4, ++patched)
    lie.replace(at, 4, small);
  ASSERT_EQ(patched, 2) << "header and list";
  const Result<Archive> liar = open(lie);
  ASSERT_TRUE(liar) << liar.error().message;
  ASSERT_EQ(liar->entries()[0].size, 4096u);
  EXPECT_FALSE(liar->unpack(liar->entries()[0], folder / "out"));
  EXPECT_FALSE(liar->read(liar->entries()[0], 1 << 30));
  EXPECT_FALSE(liar->check());
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.lamella"});
}

TEST_F(ArchiveTest, EntriesThatShareBytesAreRefused) {
  // The second entry of the list is the first again, by another name of the same length.
  std::string bytes = raw_zip({{"a", std::string(5000, 'x')}, {"b", std::string(5000, 'x')}});
  const std::size_t second = bytes.rfind("PK\x01\x02");
  for (std::size_t k = 42; k < 46; ++k) bytes[second + k] = 0;  // where its header is
  EXPECT_NE(refusal(bytes), "");
}

TEST_F(ArchiveTest, EveryTruncationAndEveryFlippedBitIsFoundOrHarmless) {
  const std::vector<NewEntry> entries = {{"project.json", "{\"schema\": 2}"s},
                                         {"mesh.vtu", std::string(60, 'm')}};
  const std::string good = packed(entries);
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_NE(refusal(good.substr(0, length)), "") << length;
  EXPECT_NE(refusal("this is no zip at all").find("neither a zip nor"), std::string::npos);
  EXPECT_NE(refusal(good.substr(0, good.size() / 2)).find("too early"), std::string::npos);
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::string bad = good;
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ (1 << bit % 8));
    const Result<Archive> archive = open(bad);
    if (!archive || !archive->check()) continue;
    // Bits that mean nothing to us, such as dates; what is read is what was written.
    for (const NewEntry& entry : entries)
      if (const ArchiveEntry* found = archive->find(entry.name)) {
        EXPECT_EQ(archive->read(*found, 1000).value(), std::get<std::string>(entry.content)) << bit;
      }
  }
}

TEST_F(ArchiveTest, RandomBytesNeverHarm) {
  std::mt19937 random(7);
  const std::string good = packed({{"project.json", "{}"s}, {"mesh.vtu", std::string(2000, 'm')}});
  for (int trial = 0; trial < 500; ++trial) {
    std::string bad = good;
    for (int k = 0; k < 1 + trial % 20; ++k)
      bad[random() % bad.size()] = static_cast<char>(random());
    const Result<Archive> archive = open(bad);
    if (!archive) continue;
    for (const ArchiveEntry& entry : archive->entries()) {
      const Result<std::string> bytes = archive->read(entry, 1 << 20);
      if (bytes) {
        EXPECT_EQ(bytes->size(), entry.size);
      }
    }
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.lamella"});
}

/// Largest resident memory of `work` in a process of its own, MB.
template <class Work>
double memory_of(Work work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(0);
  }
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  return static_cast<double>(used.ru_maxrss) / 1024;
}

TEST_F(ArchiveTest, UnpackingTakesTheMemoryOfOnePiece) {
  std::mt19937_64 random(1);
  {
    std::string noise(96 << 20, '\0');
    for (std::size_t at = 0; at < noise.size(); at += 8) {
      const std::uint64_t value = random();
      std::copy_n(reinterpret_cast<const char*>(&value), 8, &noise[at]);
    }
    ASSERT_TRUE(write_file(folder / "noise", noise));
  }
  ASSERT_TRUE(write_archive(file, {{"mesh.vtu", folder / "noise", false}}));
  const double idle = memory_of([] {});
  const double busy = memory_of([&] {
    const Result<Archive> archive = Archive::open(file);
    if (archive) (void)archive->unpack(archive->entries()[0], folder / "out");
  });
  EXPECT_LT(busy - idle, 20);
  EXPECT_EQ(std::filesystem::file_size(folder / "out"), 96u << 20);
}

TEST_F(ArchiveTest, CancelLeavesNothing) {
  std::stop_source stop;
  stop.request_stop();
  const Progress cancelled({}, stop.get_token());
  ASSERT_TRUE(write_file(folder / "noise", std::string(10 << 20, 'n')));
  const Result<void> written =
      write_archive(file, {{"mesh.vtu", folder / "noise", false}}, cancelled);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Code::cancelled);
  ASSERT_TRUE(write_archive(file, {{"mesh.vtu", folder / "noise", false}}));
  const Result<Archive> archive = Archive::open(file);
  ASSERT_TRUE(archive);
  EXPECT_EQ(archive->check(cancelled).error().code, Code::cancelled);
  EXPECT_EQ(archive->unpack(archive->entries()[0], folder / "out", cancelled).error().code,
            Code::cancelled);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace lamella
