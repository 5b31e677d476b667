#include "core/base/atomic_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace lamella {
namespace {

using Names = std::vector<std::string>;

TEST(AtomicFile, WritesExactlyTheBytesAndNothingElse) {
  const test::TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  ASSERT_TRUE(write_file(folder / "x.bin", bytes).ok());
  EXPECT_EQ(read_file(folder / "x.bin").value(), bytes);
  EXPECT_EQ(folder.names(), Names{"x.bin"});
}

TEST(AtomicFile, WithoutCommitTheOldContentStaysAndNothingIsLeftBehind) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_file(folder / "x", "old").ok());
  {
    Result<AtomicFile> file = AtomicFile::create(folder / "x");
    ASSERT_TRUE(file.ok());
    file->stream() << "half of the new";
  }
  EXPECT_EQ(read_file(folder / "x").value(), "old");
  EXPECT_EQ(folder.names(), Names{"x"});
}

TEST(AtomicFile, FollowsSymbolicLinks) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_file(folder / "target", "old").ok());
  std::filesystem::create_symlink("target", folder / "link");
  ASSERT_TRUE(write_file(folder / "link", "new").ok());
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(read_file(folder / "target").value(), "new");
}

TEST(AtomicFile, RefusesFoldersAndMissingFolders) {
  const test::TemporaryFolder folder;
  for (const auto& target : {folder.path(), folder / "no" / "x"}) {
    const Result<void> result = write_file(target, "x");
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, Code::io);
    EXPECT_NE(result.error().message.find(target.string()), std::string::npos);
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(AtomicFile, AFullDiskIsAnErrorAndNotASilentLoss) {
  const Result<void> result = write_file("/dev/full", std::string(1 << 20, 'x'));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, Code::io);
}

TEST(ReadFile, NamesTheFileThatIsMissing) {
  const Result<std::string> missing = read_file("/no/such/file.step");
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().message.find("/no/such/file.step"), std::string::npos);
}

}  // namespace
}  // namespace lamella
