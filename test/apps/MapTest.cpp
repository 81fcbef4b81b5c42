// SPDX-License-Identifier: BSD-3-Clause
// csom map as a process: the files that it leaves, and the same map from MRPT's own program.
#include <csom/io/TrajectoryFile.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/rawlog/Simulation.h>

#include <nlohmann/json.hpp>

#include "apps/RunMrpt.h"
#include "rawlog/LogFixtures.h"
#include "rawlog/SimulatedDrive.h"

namespace csom::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Map : public testing::Test {
 protected:
  Map() : log(writeLog(folder / "drive.rawlog", driveEntries(5))), config(writeConfig(folder)) {}

  std::string digest(const std::string& map_file) const { return mapDigest(loadMap(map_file).map); }

  const TempFolder folder;
  const std::string log, config;
};

TEST_F(Map, LeavesMapRecordAndReport) {
  const auto run = runCsom(folder.path(), {"map", log, "-c", config, "-o", folder / "new/out"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errorLines(), testing::IsEmpty());
  EXPECT_THAT(run.output,
              testing::AllOf(HasSubstr("5 with 660 points"), HasSubstr("robot-pose:truth"),
                             HasSubstr("new/out/report.html")));

  const MapDocument document = loadMap(folder / "new/out/map.csom");
  EXPECT_EQ(document.scans.size(), 5u);
  EXPECT_EQ(document.labels.name(), "walls");
  EXPECT_EQ(document.map.at({2.1, 0.05, 0.65}).mostLikelyClass(), 1);
  EXPECT_THAT(document.meta.at("command"), HasSubstr("csom map "));

  const json record = json::parse(readBytes(folder / "new/out/run.json"));
  ASSERT_EQ(record.at("scans").size(), 5u);
  EXPECT_EQ(record["scans"][4].at("points"), 132);
  EXPECT_NEAR(record["scans"][4].at("timestamp").get<double>(), 104.0, 1e-6);
  EXPECT_GT(record["scans"][4].at("insert_ms").get<double>(), 0.0);
  EXPECT_THAT(readBytes(folder / "new/out/report.html"), HasSubstr("<html"));
}

TEST_F(Map, PrintsJsonAndLeavesOutThePage) {
  const auto run = runCsom(folder.path(),
                           {"map", log, "-c", config, "-o", folder / "out", "--json", "--no-html"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(json::parse(run.output).at("scans").size(), 5u);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/report.html"));
}

TEST_F(Map, DoesNotDependOnThreads) {
  ASSERT_EQ(runCsom(folder.path(), {"map", log, "-c", config, "-o", folder / "1", "--threads", "1"})
                .exit_code,
            0);
  ASSERT_EQ(runCsom(folder.path(), {"map", log, "-c", config, "-o", folder / "4", "--threads", "4"})
                .exit_code,
            0);
  EXPECT_EQ(digest(folder / "1/map.csom"), digest(folder / "4/map.csom"));
}

TEST_F(Map, TakesASimplemapInPlaceOfARawlog) {
  ASSERT_EQ(runCsom(folder.path(), {"map", log, "-c", config, "-o", folder / "1",
                                    "--write-simplemap", folder / "drive.simplemap"})
                .exit_code,
            0);
  const auto run =
      runCsom(folder.path(), {"map", folder / "drive.simplemap", "-c", config, "-o", folder / "2"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(digest(folder / "1/map.csom"), digest(folder / "2/map.csom"));
}

TEST_F(Map, ReplacesTheFilesOfAnEarlierRun) {
  ASSERT_EQ(runCsom(folder.path(), {"map", log, "-c", config, "-o", folder / "out"}).exit_code, 0);
  const auto before = digest(folder / "out/map.csom");
  const std::string more = writeLog(folder / "more.rawlog", driveEntries(4));
  ASSERT_EQ(
      runCsom(folder.path(), {"map", log, more, "-c", config, "-o", folder / "out"}).exit_code, 0);
  EXPECT_NE(digest(folder / "out/map.csom"), before);
  ASSERT_EQ(runCsom(folder.path(), {"map", folder / "missing", "-c", config, "-o", folder / "out"})
                .exit_code,
            1);
  EXPECT_EQ(loadMap(folder / "out/map.csom").scans.size(), 9u) << "a failed run changes nothing";
}

TEST_F(Map, LeavesNoPageOfAnEarlierRun) {
  const std::vector<std::string> command{"map", log, "-c", config, "-o", folder / "out"};
  ASSERT_EQ(runCsom(folder.path(), command).exit_code, 0);
  ASSERT_TRUE(std::filesystem::exists(folder / "out/report.html"));
  auto without_page = command;
  without_page.emplace_back("--no-html");
  ASSERT_EQ(runCsom(folder.path(), without_page).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/report.html"));
  EXPECT_TRUE(std::filesystem::exists(folder / "out/top.png"));
}

TEST_F(Map, HelpShowsExamples) {
  const auto run = runCsom(folder.path(), {"map", "--help"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.output, testing::AllOf(HasSubstr("Examples:"), HasSubstr("--write-simplemap")));
}

// The map of observations2map is ours bit for bit: same observations, same poses, same options.
TEST_F(Map, EqualsThatOfObservations2map) {
  ASSERT_EQ(runCsom(folder.path(), {"map", log, "-c", config, "-o", folder / "out",
                                    "--write-simplemap", folder / "drive.simplemap"})
                .exit_code,
            0);
  const auto stock = runMrpt(
      folder.path(), {"observations2map", config, folder / "drive.simplemap", folder / "stock_"});
  ASSERT_EQ(stock.exit_code, 0) << stock.output << stock.errors;
  std::string stock_map;
  for (const std::string& name : folder.fileNames()) {
    if (name.rfind("stock_", 0) == 0 && name.find(".csom") != std::string::npos) stock_map = name;
  }
  ASSERT_NE(stock_map, "") << stock.output;
  EXPECT_EQ(digest(folder / stock_map), digest(folder / "out/map.csom"));
}

TEST_F(Map, RegisteredPosesAreATrajectoryThatGivesTheSameMapAgain) {
  SimulationOptions options;
  options.format = RawlogFormat::Observations;
  const std::string drive = folder / "yard.rawlog";
  simulateRawlog(yardDrive(folder), drive, options);
  const std::string occupancy = std::string(CSOM_SOURCE_DIR) + "/config/occupancy.ini";
  const auto run = runCsom(folder.path(), {"map", drive, "-c", occupancy, "-o", folder / "out",
                                           "--poses", "icp", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto record = json::parse(run.output);
  EXPECT_EQ(record.at("registration").at("scans"), 20);
  EXPECT_EQ(record.at("registration").at("doubtful"), 0);
  EXPECT_EQ(readTumTrajectory(folder / "out/trajectory.tum").size(), 20U);

  const std::string trajectory = folder / "kept.tum";
  std::filesystem::copy_file(folder / "out/trajectory.tum", trajectory);
  const std::string digest_by_icp = digest(folder / "out/map.csom");
  ASSERT_EQ(runCsom(folder.path(), {"map", drive, "-c", occupancy, "-o", folder / "out", "--poses",
                                    "tum:" + trajectory})
                .exit_code,
            0);
  EXPECT_EQ(digest(folder / "out/map.csom"), digest_by_icp);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/trajectory.tum")) << "of an earlier run";
}

std::string shipped(const std::string& path) {
  return std::string(CSOM_SOURCE_DIR) + "/" + path;
}

TEST(ShippedConfigurations, HaveNoUnknownKeys) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(shipped("config"))) {
    if (entry.path().extension() != ".ini") continue;
    ++files;
    const auto definition = CSemanticContinuousMap::definitionFromIni(entry.path().string());
    EXPECT_THAT(definition.unknownKeys(), testing::IsEmpty()) << entry.path();
    // The one for scans without labels has free and occupied.
    const bool has_labels = entry.path().filename() != "occupancy.ini";
    EXPECT_EQ(definition.labels.numberOfClasses() > 2, has_labels) << entry.path();
  }
  EXPECT_GE(files, 4);
}

TEST(ShippedConfigurations, ServeObservations2mapAsTheyServeUs) {
  const TempFolder folder;
  const auto ours = runCsom(
      folder.path(), {"map", shipped("rawlogs/room.rawlog"), "-c", shipped("config/room.ini"), "-o",
                      folder / "out", "--write-simplemap", folder / "room.simplemap"});
  ASSERT_EQ(ours.exit_code, 0) << ours.errors;
  const auto stock = runMrpt(folder.path(), {"observations2map", shipped("config/room.ini"),
                                             folder / "room.simplemap", folder / "stock"});
  ASSERT_EQ(stock.exit_code, 0) << stock.output << stock.errors;
  int maps = 0;
  for (const std::string& name : folder.fileNames()) {
    if (name.rfind("stock", 0) != 0 || name.find(".csom") == std::string::npos) continue;
    ++maps;
    EXPECT_EQ(mapDigest(loadMap(folder / name).map),
              mapDigest(loadMap(folder / "out/map.csom").map));
  }
  EXPECT_EQ(maps, 1);
}

TEST_F(Map, AFullDiskIsAnError) {
  const auto run = runCsom(folder.path(), {"map", log, "-c", config, "-o", folder / "out",
                                           "--write-simplemap", "/dev/full"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.errors, HasSubstr("/dev/full: cannot be written: No space left"));
}

}  // namespace
}  // namespace csom::test
