// SPDX-License-Identifier: BSD-3-Clause
// csom report as a process: the same page and pictures from run.json and map.csom alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "apps/RunCsom.h"

namespace csom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::set<std::string> kPagesAndPictures{"report.html", "top.png", "front.png", "side.png",
                                              "isometric.png"};

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::set<std::string> filesOf(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

/// `mapped`: what csom map left of the room; `bare`: its map and run.json alone.
class ReportCommand : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directories(bare);
    const std::string source = CSOM_SOURCE_DIR;
    const auto run = runCsom(folder, {"map", source + "/rawlogs/room.rawlog", "-c",
                                      source + "/config/room.ini", "-o", mapped});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    for (const char* name : {"map.csom", "run.json"}) fs::copy(mapped / name, bare / name);
  }
  void TearDown() override { fs::remove_all(folder); }

  const fs::path folder =
      fs::path(testing::TempDir()) / ("csom-report-command-" + std::to_string(getpid()));
  const fs::path mapped = folder / "mapped", bare = folder / "bare";
};

TEST_F(ReportCommand, MakesTheSameFilesOfRunAndMapAlone) {
  const auto run = runCsom(folder, {"report", bare});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("bare/report.html"));
  EXPECT_EQ(filesOf(bare), filesOf(mapped));
  for (const std::string& name : filesOf(mapped))
    EXPECT_EQ(bytesOf(bare / name), bytesOf(mapped / name)) << name;
}

TEST_F(ReportCommand, WritesElsewhereAndInOtherColours) {
  const auto run = runCsom(folder, {"report", bare, "-o", folder / "else", "--color-blind"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(filesOf(folder / "else"), kPagesAndPictures);
  EXPECT_EQ(filesOf(bare), (std::set<std::string>{"map.csom", "run.json"}));
  EXPECT_NE(bytesOf(folder / "else/top.png"), bytesOf(mapped / "top.png"));
}

TEST_F(ReportCommand, LeavesOutThePageAndLeavesAnOldOneAlone) {
  std::ofstream(bare / "report.html") << "old";
  const auto run = runCsom(folder, {"report", bare, "--no-html"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(bytesOf(bare / "report.html"), "old");
  EXPECT_EQ(bytesOf(bare / "side.png"), bytesOf(mapped / "side.png"));
}

TEST_F(ReportCommand, SaysInOneLineWhatIsMissing) {
  const auto refused = [&](const fs::path& where) {
    const auto run = runCsom(folder, {"report", where});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.errorLines().size(), 1u) << run.errors;
    return run.errors;
  };
  EXPECT_THAT(refused(folder / "nowhere"), HasSubstr("nowhere/map.csom"));
  EXPECT_FALSE(fs::exists(folder / "nowhere"));
  fs::remove(bare / "run.json");
  EXPECT_THAT(refused(bare), HasSubstr("bare/run.json: no such file"));
  std::ofstream(bare / "run.json") << "{}";
  EXPECT_THAT(refused(bare), HasSubstr("map is missing"));
  EXPECT_EQ(filesOf(bare), (std::set<std::string>{"map.csom", "run.json"}));
}

}  // namespace
}  // namespace csom::test
