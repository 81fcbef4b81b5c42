// SPDX-License-Identifier: BSD-3-Clause
#include <csom/io/OutputFile.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

class OutputFileTest : public testing::Test {
 protected:
  TempFolder folder_;
};

TEST_F(OutputFileTest, AppearsOnCommitOnly) {
  {
    OutputFile out(folder_ / "a.txt");
    out.write("hello ");
    out.write("world");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.txt"));
    out.commit();
  }
  EXPECT_EQ(readBytes(folder_ / "a.txt"), "hello world");
  EXPECT_THAT(folder_.fileNames(), ElementsAre("a.txt"));
}

TEST_F(OutputFileTest, NothingIsLeftWithoutCommit) {
  writeBytes(folder_ / "a.txt", "old");
  {
    OutputFile out(folder_ / "a.txt");
    out.write("new");
  }
  EXPECT_EQ(readBytes(folder_ / "a.txt"), "old");
  EXPECT_THAT(folder_.fileNames(), ElementsAre("a.txt"));
}

TEST_F(OutputFileTest, EmptyFileCanBeCommitted) {
  OutputFile out(folder_ / "empty");
  out.commit();
  EXPECT_EQ(readBytes(folder_ / "empty"), "");
}

TEST_F(OutputFileTest, FollowsLinks) {
  writeBytes(folder_ / "real", "old");
  std::filesystem::create_symlink(folder_ / "real", folder_ / "link");
  OutputFile out(folder_ / "link");
  out.write("new");
  out.commit();
  EXPECT_EQ(readBytes(folder_ / "real"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
}

TEST_F(OutputFileTest, HonoursUmask) {
  const mode_t old = ::umask(027);
  OutputFile(folder_ / "a").commit();
  ::umask(old);
  struct stat info {};
  ASSERT_EQ(::stat((folder_ / "a").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0640U);
}

TEST_F(OutputFileTest, TwoWritersOfOneTargetDoNotMix) {
  OutputFile first(folder_ / "a");
  OutputFile second(folder_ / "a");
  first.write("first");
  second.write("second");
  first.commit();
  EXPECT_EQ(readBytes(folder_ / "a"), "first");
  second.commit();
  EXPECT_EQ(readBytes(folder_ / "a"), "second");
}

TEST_F(OutputFileTest, ImpossibleTargetsAreNamed) {
  EXPECT_THAT(fileErrorOf([] { OutputFile out("/nowhere/a"); }),
              HasSubstr("/nowhere/a: cannot be written: No such file"));
  EXPECT_THAT(fileErrorOf([&] { OutputFile out(folder_.path()); }), HasSubstr("is a folder"));
}

TEST_F(OutputFileTest, FullDeviceIsAnErrorAndStaysADevice) {
  EXPECT_THAT(fileErrorOf([] {
                OutputFile out("/dev/full");
                out.write(std::string(1 << 20, 'x'));
                out.commit();
              }),
              HasSubstr("/dev/full: cannot be written: No space left on device"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(OutputFileTest, DiskFullLeavesTheOldFile) {
  writeBytes(folder_ / "a", "old");
  // A limit on the size of files stands in for a full disk: write() then fails with EFBIG.
  struct rlimit limit {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const struct rlimit small { 4096, limit.rlim_max };
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message = fileErrorOf([&] {
    OutputFile out(folder_ / "a");
    out.write(std::string(1 << 20, 'x'));
    out.commit();
  });
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr("/a: cannot be written: File too large"));
  EXPECT_EQ(readBytes(folder_ / "a"), "old");
  EXPECT_THAT(folder_.fileNames(), ElementsAre("a"));
}

}  // namespace
}  // namespace csom::test
