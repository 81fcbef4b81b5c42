// SPDX-License-Identifier: BSD-3-Clause
// Bad input ends with one clear line on stderr, exit code 1 or 2, and no files.
#include <mrpt/obs/CObservationImage.h>

#include <limits>

#include "apps/RunCsom.h"
#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class BadInput : public testing::Test {
 protected:
  BadInput()
      : config(writeConfig(folder)), log(writeLog(folder / "drive.rawlog", driveEntries(3))) {}

  ProgramResult map(const std::string& rawlog, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command{"map", rawlog, "-c", config, "-o", out};
    command.insert(command.end(), more.begin(), more.end());
    return runCsom(folder.path(), command);
  }

  template <class Matcher>
  void expectRefused(const ProgramResult& run, int exit_code, const Matcher& line) const {
    EXPECT_EQ(run.exit_code, exit_code);
    EXPECT_EQ(run.output, "");
    EXPECT_THAT(run.errorLines(), testing::ElementsAre(AllOf(testing::StartsWith("csom: "), line)));
    EXPECT_FALSE(std::filesystem::exists(out));
  }

  const TempFolder folder;
  const std::string config, log;
  const std::string out = folder / "out";
};

TEST_F(BadInput, MissingEmptyAndForeignLogs) {
  writeBytes(folder / "empty.rawlog", "");
  writeBytes(folder / "text.rawlog", "not a rawlog, but a text that someone renamed\n");
  expectRefused(map(folder / "none.rawlog"), 1, HasSubstr("none.rawlog: no such file"));
  expectRefused(map(folder / "empty.rawlog"), 1, HasSubstr("empty.rawlog: is empty"));
  expectRefused(map(folder / "text.rawlog"), 1, HasSubstr("text.rawlog: is neither a rawlog nor"));
  expectRefused(map(folder.path()), 1, HasSubstr("is a folder"));
  expectRefused(map(config), 1, HasSubstr("map.ini: is neither a rawlog nor"));
}

TEST_F(BadInput, ALogWithoutScans) {
  writeLog(folder / "bare.rawlog", {robotPose(1, {})});
  expectRefused(
      map(folder / "bare.rawlog"), 1,
      AllOf(HasSubstr("bare.rawlog: no observation could be used"), HasSubstr("holds none")));
}

TEST_F(BadInput, ACutOffLogIsMappedAsFarAsItGoes) {
  const auto bytes = readBytes(writePlainLog(folder / "plain.rawlog", driveEntries(3)));
  writeBytes(folder / "cut.rawlog", bytes.substr(0, bytes.size() - 10));
  const auto run = map(folder / "cut.rawlog");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.errorLines(), testing::ElementsAre(AllOf(HasSubstr("warning: "),
                                                           HasSubstr("cut.rawlog: cut off in the "
                                                                     "middle of entry 5"),
                                                           HasSubstr("5 entries in "))));
  EXPECT_EQ(loadMap(out + "/map.csom").scans.size(), 2u);
  EXPECT_THAT(readBytes(out + "/run.json"), HasSubstr("cut off in the middle of entry 5"));
}

TEST_F(BadInput, ALogCutOffInItsFirstEntry) {
  const auto bytes = readBytes(writePlainLog(folder / "plain.rawlog", {wallCloud(1)}));
  for (const std::size_t size : {std::size_t{30}, bytes.size() / 2, bytes.size() - 1}) {
    writeBytes(folder / "cut.rawlog", bytes.substr(0, size));
    const auto run = map(folder / "cut.rawlog", {"--poses", "odometry"});
    EXPECT_NE(run.exit_code, 0);
    EXPECT_EQ(run.errorLines().size(), 1u) << run.errors;
    EXPECT_THAT(run.errors, HasSubstr("cut.rawlog"));
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

// Byte by byte through the headers of the first scan, and some of its points.
TEST_F(BadInput, ADamagedLogNeitherCrashesNorHangs) {
  const auto bytes = readBytes(writePlainLog(folder / "plain.rawlog", driveEntries(2)));
  for (std::size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 60) {
    auto damaged = bytes;
    damaged.replace(at, std::min<std::size_t>(4, bytes.size() - at), "\xff\xff\xff\x7f", 0, 4);
    writeBytes(folder / "damaged.rawlog", damaged);
    const auto run = map(folder / "damaged.rawlog");
    EXPECT_LE(run.exit_code, 2) << "byte " << at << ": " << run.errors;
    for (const std::string& line : run.errorLines())
      EXPECT_THAT(line, testing::StartsWith("csom: ")) << "byte " << at;
    std::filesystem::remove_all(out);
  }
}

TEST_F(BadInput, AMissingExternalisedImage) {
  Entries entries = driveEntries(1);
  auto image = mrpt::obs::CObservationImage::Create();
  image->sensorLabel = "front";
  image->image.setExternalStorage("front_7.png");
  entries.push_back(image);
  expectRefused(
      map(writeLog(folder / "images.rawlog", entries)), 1,
      AllOf(HasSubstr("images.rawlog: entry 2 ('front')"), HasSubstr("front_7.png is missing")));
}

TEST_F(BadInput, PointsThatAreNotFiniteAreCounted) {
  auto cloud = wallCloud(100);
  auto& points = dynamic_cast<mrpt::maps::CPointsMapXYZI&>(*cloud->pointcloud);
  points.setPointFast(0, std::nanf(""), 0, 0);
  points.setPointFast(1, 0, 0, -std::numeric_limits<float>::infinity());
  const auto run = map(writeLog(folder / "nan.rawlog", {robotPose(100, {}), cloud}));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.errorLines(),
              testing::ElementsAre("csom: warning: rejected 2 points: non-finite"));
  for (std::size_t i = 0; i < points.size(); ++i) points.setPointFast(i, std::nanf(""), 0, 0);
  std::filesystem::remove_all(out);
  expectRefused(map(writeLog(folder / "nan.rawlog", {robotPose(100, {}), cloud})), 1,
                HasSubstr("rejected 132 points: non-finite"));
}

TEST_F(BadInput, ClassIdsOutOfRangeAreCounted) {
  auto cloud = wallCloud(100);
  auto& points = dynamic_cast<mrpt::maps::CPointsMapXYZI&>(*cloud->pointcloud);
  points.setPointIntensity(0, 3);
  const auto run = map(writeLog(folder / "ids.rawlog", {robotPose(100, {}), cloud}));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.errorLines(), testing::ElementsAre(HasSubstr("1 points whose label is not in the "
                                                               "label set 'walls'")));
  for (std::size_t i = 0; i < points.size(); ++i) points.setPointIntensity(i, 1000);
  std::filesystem::remove_all(out);
  expectRefused(map(writeLog(folder / "ids.rawlog", {robotPose(100, {}), cloud})), 1,
                HasSubstr("132 points whose label is not in the label set 'walls'"));
}

TEST_F(BadInput, AConfigurationThatIsWrong) {
  const auto withKeys = [&](const std::string& keys) {
    writeConfig(folder, keys);
    return map(log);
  };
  expectRefused(withKeys("resolutoin = 0.1"), 2,
                AllOf(HasSubstr("map.ini"), HasSubstr("insertOpts]"), HasSubstr("resolutoin")));
  expectRefused(withKeys("block_depth = deep"), 2,
                AllOf(HasSubstr("map.ini"), HasSubstr("block_depth"), HasSubstr("deep")));
  expectRefused(withKeys("ds_resolution = -0.5"), 2,
                AllOf(HasSubstr("map.ini"), HasSubstr("ds_resolution"), HasSubstr("-0.5")));
  expectRefused(withKeys("unlabelled_class = lamp"), 2,
                AllOf(HasSubstr("map.ini"), HasSubstr("lamp")));
  writeBytes(config, "[MappingApplication]\n");
  expectRefused(map(log), 2, AllOf(HasSubstr("map.ini"), HasSubstr("semanticContinuousMap_count")));
  writeBytes(config, readBytes(log) + "${" + readBytes(log));
  expectRefused(map(log), 2, HasSubstr("map.ini"));
  std::filesystem::remove(config);
  expectRefused(map(log), 2, HasSubstr("map.ini"));
  std::filesystem::create_directory(config);
  expectRefused(map(log), 2, HasSubstr("map.ini"));
}

TEST_F(BadInput, OptionsThatAreWrong) {
  expectRefused(map(log, {"--poses", "gps"}), 2,
                AllOf(HasSubstr("source of poses 'gps': expected"), HasSubstr("(--poses)")));
  expectRefused(map(log, {"--poses", "odometry"}), 2, HasSubstr("drive.rawlog: holds no odometry"));
  expectRefused(map(log, {"--poses", "tum:" + (folder / "none")}), 1, HasSubstr("none"));
  expectRefused(map(log, {"--threads", "-1"}), 2, HasSubstr("threads"));
  EXPECT_EQ(map(log, {"--threads", "two"}).exit_code, 2);
  EXPECT_EQ(runCsom(folder.path(), {"map", log}).exit_code, 2);
  EXPECT_EQ(runCsom(folder.path(), {"map", log, "-c", config, "-o", out, "--frobnicate"}).exit_code,
            2);
  EXPECT_FALSE(std::filesystem::exists(out));
}

// Below a regular file nobody can write, not even the administrator.
TEST_F(BadInput, AnUnwritableOutput) {
  writeBytes(folder / "file", "");
  const auto refused = [&](const std::string& where, const std::vector<std::string>& more = {}) {
    std::vector<std::string> command{"map", log, "-c", config, "-o", where};
    command.insert(command.end(), more.begin(), more.end());
    const auto run = runCsom(folder.path(), command);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(run.errorLines().size(), 1u) << run.errors;
    return run.errors;
  };
  EXPECT_THAT(refused(folder / "file"), HasSubstr("file"));
  EXPECT_THAT(refused(folder / "file/out"), HasSubstr("file is a file"));
  EXPECT_THAT(refused(out, {"--write-simplemap", folder / "file/x.simplemap"}),
              HasSubstr("x.simplemap"));
  EXPECT_FALSE(std::filesystem::exists(out));
  std::filesystem::create_directories(folder / "taken/report.html");
  EXPECT_THAT(refused(folder / "taken"), HasSubstr("report.html: is a folder"));
  EXPECT_FALSE(std::filesystem::exists(folder / "taken/map.csom"));
}

TEST_F(BadInput, ADiskThatFillsUpWhileResultsAreWritten) {
  const auto run = runProgram(
      folder.path(), "/bin/sh",
      {"-c", "trap '' XFSZ; ulimit -f 8; exec \"$0\" map \"$1\" -c \"$2\" -o \"$3\"", CSOM_PROGRAM,
       CSOM_SOURCE_DIR "/rawlogs/room.rawlog", CSOM_SOURCE_DIR "/config/room.ini", out});
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_EQ(run.errorLines().size(), 1u) << run.errors;
  EXPECT_FALSE(std::filesystem::exists(out)) << "nothing may be left of a run that failed";
}

TEST_F(BadInput, AMapFileThatIsNoMap) {
  writeBytes(folder / "fake.csom", "SQLite format 3, or so it says");
  for (const std::string& name : {folder / "fake.csom", folder / "none.csom", folder.path(), log}) {
    const auto run = runCsom(folder.path(), {"info", name});
    EXPECT_EQ(run.exit_code, 1) << name;
    EXPECT_THAT(run.errorLines(), testing::ElementsAre(HasSubstr(name)));
  }
}

}  // namespace
}  // namespace csom::test
