// SPDX-License-Identifier: BSD-3-Clause
// What the command line accepts, and what it says where it does not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "apps/RunCsom.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string kRoomWorld = CSOM_SOURCE_DIR "/config/worlds/room.yaml";
const std::string kRoomLog = CSOM_SOURCE_DIR "/rawlogs/room.rawlog";
const std::string kRoomIni = CSOM_SOURCE_DIR "/config/room.ini";

class CommandLine : public testing::Test {
 protected:
  void expectUsageError(const std::vector<std::string>& arguments, const std::string& message) {
    const ProgramResult run = runCsom(folder_.path(), arguments);
    EXPECT_EQ(run.exit_code, 2) << run.errors;
    EXPECT_THAT(run.errors, HasSubstr(message));
  }
  TempFolder folder_;
};

TEST_F(CommandLine, NamesWordsThatAreNoCommand) {
  expectUsageError({"evaluate"}, "no command 'evaluate'; there are map, info");
  expectUsageError({"evaluate", "--help"}, "no command 'evaluate'");
  expectUsageError({"import", "kitti"},
                   "no command 'kitti'; there are semantickitti, kitti-raw, pcd");
  EXPECT_EQ(runCsom(folder_.path(), {"import", "pcd", "--help"}).exit_code, 0);
}

TEST_F(CommandLine, LoadsNoLibraryThatFewCommandsNeed) {
  // So the dynamic linker lists what it loads, and does not run the program.
  const auto libraries =
      runProgram(folder_.path(), CSOM_PROGRAM, {}, {"LD_TRACE_LOADED_OBJECTS=1"}).output;
  EXPECT_THAT(libraries, HasSubstr("libmrpt-maps.so"));
  for (const std::string seldom : {"libopenvdb.so", "libmrpt-slam.so", "libmrpt-vision.so",
                                   "libopencv_videoio.so", "libopencv_highgui.so"})
    EXPECT_THAT(libraries, Not(HasSubstr(seldom)));
}

TEST_F(CommandLine, ListsTheWordsOfAChoice) {
  expectUsageError({"export", "m.csom", "--to", "obj", "-o", "m.obj"},
                   "no format 'obj'; there are ply, ");
  expectUsageError({"export", "m.csom", "--to", "2", "-o", "m.csv"}, "no format '2'; there are");
  const auto upper_case = runCsom(
      folder_.path(), {"export", folder_ / "none.csom", "--to", "CSV", "-o", folder_ / "a"});
  EXPECT_EQ(upper_case.exit_code, 1);
  EXPECT_THAT(upper_case.errors, HasSubstr("none.csom"));
}

TEST_F(CommandLine, RefusesNumbersThatCannotBe) {
  expectUsageError({"import", "pcd", "a.pcd", "-o", "a.rawlog", "--every", "-1"}, "--every");
  expectUsageError({"simulate", kRoomWorld, "-o", folder_ / "a.rawlog", "--seed", "-1"}, "--seed");
  expectUsageError({"simulate", kRoomWorld, "-o", folder_ / "a.rawlog", "--truth-resolution", "1"},
                   "--truth");
}

TEST_F(CommandLine, NeverWritesOverItsInput) {
  const std::string world = folder_ / "world.yaml";
  const std::string ini = folder_ / "room.ini";
  const std::string log = folder_ / "room.rawlog";
  std::filesystem::copy_file(kRoomWorld, world);
  std::filesystem::copy_file(kRoomIni, ini);
  std::filesystem::copy_file(kRoomLog, log);
  const std::string world_text = readBytes(world);
  const std::string log_bytes = readBytes(log);

  expectUsageError({"simulate", world, "-o", world}, "is an input of this command");
  expectUsageError({"simulate", world, "-o", folder_ / "x", "--truth", folder_ / "./x"},
                   "is named for two outputs");
  expectUsageError({"map", log, "-c", ini, "-o", folder_ / "out", "--write-simplemap", log},
                   "is an input of this command");
  expectUsageError(
      {"map", log, "-c", ini, "-o", folder_ / "out", "--write-simplemap", folder_ / "out/map.csom"},
      "is named for two outputs");
  expectUsageError({"map", log, "-c", ini, "-o", ""}, "--output is empty");
  std::filesystem::create_symlink(log, folder_ / "link.csom");
  expectUsageError({"export", log, "--to", "csv", "-o", folder_ / "link.csom"},
                   "is an input of this command");
  EXPECT_EQ(readBytes(world), world_text);
  EXPECT_EQ(readBytes(log), log_bytes);
}

TEST_F(CommandLine, AFullStandardOutputIsAFailure) {
  ASSERT_EQ(
      runCsom(folder_.path(), {"map", kRoomLog, "-c", kRoomIni, "-o", folder_ / "out"}).exit_code,
      0);
  const std::string command = std::string(CSOM_PROGRAM) + " info " + folder_ / "out/map.csom" +
                              " >/dev/full 2>" + folder_ / "errors.txt";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(readBytes(folder_ / "errors.txt"), HasSubstr("standard output: cannot be written"));
}

}  // namespace
}  // namespace csom::test
