// SPDX-License-Identifier: BSD-3-Clause
// Logs become maps: the same map by every way, and nothing silently left out.
#include <csom/maps/ObservationAdapter.h>
#include <csom/maps/PoseRounding.h>
#include <csom/rawlog/MappingRun.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationImage.h>

#include <limits>

#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

MappingResult mapped(const TempFolder& folder, const std::vector<std::string>& logs,
                     const std::string& keys = "", const std::optional<PoseChoice>& poses = {}) {
  MappingRequest request;
  request.logs = logs;
  request.config_file = writeConfig(folder, keys);
  request.poses = poses;
  request.keep_key_frames = true;
  return mapLogs(request);
}

std::string computeDigest(const MappingResult& result) {
  return mapDigest(result.map->map());
}

std::string failureOf(const TempFolder& folder, const std::string& log) {
  try {
    mapped(folder, {log});
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

TEST(MappingRun, EqualsADirectLoopOverTheCore) {
  const TempFolder folder;
  const auto log = writeLog(folder / "a.rawlog", driveEntries(6));
  const auto result = mapped(folder, {log}, "free_space = sampled");
  ASSERT_EQ(result.map->scans().size(), 6u);
  EXPECT_EQ(result.insert_ms.size(), 6u);

  const auto definition = CSemanticContinuousMap::definitionFromIni(folder / "map.ini");
  SemanticMap map(definition.options);
  const LabelRules rules(definition.labels, PointLabels::ByIntensity, "", "");
  SelfLabelledAdapter adapter;
  const Entries entries = driveEntries(6);
  for (std::size_t i = 0; i < entries.size(); i += 2) {
    const auto& pose = dynamic_cast<const mrpt::obs::CObservationRobotPose&>(*entries[i]).pose.mean;
    const auto& cloud = dynamic_cast<const mrpt::obs::CObservation&>(*entries[i + 1]);
    const auto scans = adapter.adapt(cloud, roundedPose(pose), rules);
    ASSERT_TRUE(scans);
    for (const AdaptedScan& scan : *scans) map.insert(scan.scan);
  }
  EXPECT_GT(map.knownVoxelCount(), 100u);
  EXPECT_EQ(computeDigest(result), mapDigest(map));
}

TEST(MappingRun, TheSimplemapThatItWritesGivesTheSameMap) {
  const TempFolder folder;
  Entries entries{movement(0.3, 0.1, 0.2), frameOf({wallCloud(1), wallCloud(2)}),
                  movement(0.5, -0.1, 0.3), frameOf({wallCloud(3)})};
  const auto result = mapped(folder, {writeLog(folder / "a.rawlog", entries)});
  EXPECT_EQ(result.key_frames.size(), 2u) << "a key frame keeps the observations of one pose";
  ASSERT_TRUE(result.key_frames.saveToFile(folder / "a.simplemap"));
  const auto again = mapped(folder, {folder / "a.simplemap"});
  EXPECT_EQ(again.logs.at(0).poses.toString(), "key-frames");
  EXPECT_EQ(computeDigest(again), computeDigest(result));
}

TEST(MappingRun, LogsOneAfterAnotherEqualOneLog) {
  const TempFolder folder;
  const Entries entries = driveEntries(6);
  const auto whole = writeLog(folder / "whole.rawlog", entries);
  const auto first = writeLog(folder / "1.rawlog", {entries.begin(), entries.begin() + 4});
  const auto second = writeLog(folder / "2.rawlog", {entries.begin() + 4, entries.end()});
  const auto parts = mapped(folder, {second, first});
  EXPECT_EQ(parts.logs.size(), 2u);
  EXPECT_EQ(computeDigest(parts), computeDigest(mapped(folder, {whole})));
}

TEST(MappingRun, RefusesAndCountsWhatItCannotUse) {
  const TempFolder folder;
  Entries entries = driveEntries(2);
  entries.push_back(wallCloud(500));  // no pose there
  auto gps = mrpt::obs::CObservationGPS::Create();
  gps->timestamp = mrpt::Clock::fromDouble(100.5);
  entries.push_back(gps);
  auto empty = mrpt::obs::CObservationPointCloud::Create();
  empty->timestamp = gps->timestamp;
  entries.push_back(empty);
  const auto result = mapped(folder, {writeLog(folder / "a.rawlog", entries)});
  EXPECT_EQ(result.observations_read, 5u);
  EXPECT_EQ(result.map->scans().size(), 2u);
  std::size_t refused = 0;
  for (const auto& [what, count] : result.refused) refused += count;
  EXPECT_EQ(refused, 3u);
  EXPECT_EQ(result.refused.at({"CObservationPointCloud", "no pose at its time"}), 1u);
  EXPECT_EQ(result.refused.at({"CObservationGPS", "of a kind that this map does not take"}), 1u);
  EXPECT_EQ(result.refused.at({"CObservationPointCloud", "damaged: it has no point cloud"}), 1u);
  EXPECT_THAT(result.warnings,
              testing::Contains(HasSubstr("refused 1 CObservationPointCloud: no pose")));
}

TEST(MappingRun, EveryDamagedObservationHasItsOwnReason) {
  const TempFolder folder;
  Entries entries = driveEntries(2);
  auto empty = mrpt::obs::CObservationPointCloud::Create();
  empty->timestamp = mrpt::Clock::fromDouble(100.5);
  entries.push_back(empty);
  entries.push_back(robotPose(200, mrpt::poses::CPose3D(1e14, 0, 0, 0, 0, 0)));
  entries.push_back(wallCloud(200));
  const auto result = mapped(folder, {writeLog(folder / "a.rawlog", entries)});
  ASSERT_EQ(result.refused.size(), 2u) << "not both with the reason of the first";
  for (const auto& [what, count] : result.refused) {
    EXPECT_THAT(what.second, testing::StartsWith("damaged: "));
    EXPECT_EQ(count, 1u) << what.second;
  }
}

TEST(MappingRun, SwitchedOffInsertionIsSaid) {
  const TempFolder folder;
  const auto log = writeLog(folder / "a.rawlog", driveEntries(2));
  MappingRequest request;
  request.logs = {log};
  request.config_file = writeConfig(folder);
  std::string config = readBytes(request.config_file);
  config.insert(config.find("label_set"), "enableObservationInsertion = false\n");
  writeBytes(request.config_file, config);
  try {
    mapLogs(request);
    ADD_FAILURE() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("2 CObservationPointCloud: the map's "
                                        "enableObservationInsertion is false"));
  }
}

TEST(MappingRun, CountsPointsThatItCannotUse) {
  const TempFolder folder;
  auto cloud = wallCloud(100);
  auto& points = dynamic_cast<mrpt::maps::CPointsMapXYZI&>(*cloud->pointcloud);
  points.setPointFast(0, std::nanf(""), 0, 0);
  points.setPointFast(1, 0, std::numeric_limits<float>::infinity(), 0);
  points.setPointIntensity(2, 77.0f);
  points.setPointIntensity(3, 1.5f);
  const auto result = mapped(folder, {writeLog(folder / "a.rawlog", {robotPose(100, {}), cloud})});
  EXPECT_THAT(
      result.warnings,
      testing::ElementsAre(
          "rejected 2 points: non-finite",
          "left out 2 points whose label is not in the label set 'walls', or means free; if "
          "their intensities are no labels, set point_labels = none"));
}

TEST(MappingRun, MapsWhatACutOffLogHolds) {
  const TempFolder folder;
  const auto bytes = readBytes(writePlainLog(folder / "whole.rawlog", driveEntries(4)));
  writeBytes(folder / "cut.rawlog", bytes.substr(0, bytes.size() - 100));
  const auto result = mapped(folder, {folder / "cut.rawlog"});
  EXPECT_EQ(result.map->scans().size(), 3u);
  EXPECT_FALSE(result.logs.at(0).end.complete);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_THAT(result.warnings[0],
              testing::AllOf(HasSubstr("cut.rawlog: cut off in the middle of entry 7 "
                                       "(CObservationPointCloud)"),
                             HasSubstr("7 entries in ")));
}

TEST(MappingRun, SaysWhyNothingCouldBeUsed) {
  const TempFolder folder;
  EXPECT_THAT(failureOf(folder, writeLog(folder / "a.rawlog", {robotPose(1, {}), wallCloud(9)})),
              testing::AllOf(HasSubstr("no observation could be used"),
                             HasSubstr("1 CObservationPointCloud: no pose at its time")));
  EXPECT_THAT(failureOf(folder, writeLog(folder / "b.rawlog", {robotPose(1, {})})),
              HasSubstr("it holds none"));
  auto unknown = wallCloud(1);
  auto& points = dynamic_cast<mrpt::maps::CPointsMapXYZI&>(*unknown->pointcloud);
  for (std::size_t i = 0; i < points.size(); ++i) points.setPointIntensity(i, 99);
  EXPECT_THAT(failureOf(folder, writeLog(folder / "c.rawlog", {robotPose(1, {}), unknown})),
              HasSubstr("points whose label is not in the label set 'walls'"));
}

TEST(MappingRun, FindsMissingFilesBeforeItMaps) {
  const TempFolder folder;
  Entries entries = driveEntries(2);
  auto image = mrpt::obs::CObservationImage::Create();
  image->sensorLabel = "front";
  image->image.setExternalStorage("front_1.png");
  entries.push_back(image);
  const auto log = writeLog(folder / "a.rawlog", entries);
  EXPECT_THAT(failureOf(folder, log), testing::AllOf(HasSubstr("a.rawlog: entry 4 ('front')"),
                                                     HasSubstr("front_1.png is missing")));
  std::filesystem::create_directory(folder / "a_Images");
  writeBytes(folder / "a_Images/front_1.png", "anything");
  EXPECT_EQ(failureOf(folder, log), "no error");
}

TEST(MappingRun, RefusesUnknownKeysAndWrongValues) {
  const TempFolder folder;
  const auto log = writeLog(folder / "a.rawlog", driveEntries(1));
  const auto configError = [&](const std::string& keys) -> std::string {
    try {
      mapped(folder, {log}, keys);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  using testing::AllOf;
  EXPECT_THAT(configError("kernel_lenght = 1"),
              AllOf(HasSubstr("map.ini"), HasSubstr("insertOpts]"), HasSubstr("kernel_lenght")));
  EXPECT_THAT(configError("max_range = far"),
              AllOf(HasSubstr("map.ini"), HasSubstr("max_range"), HasSubstr("far")));
  EXPECT_THAT(configError("min_range = -1"), HasSubstr("min_range"));
  EXPECT_THAT(configError("method = magic"), HasSubstr("see-csom"));
}

TEST(MappingRun, ReportsProgressOfAllLogs) {
  const TempFolder folder;
  const auto log = writeLog(folder / "a.rawlog", driveEntries(3));
  MappingRequest request;
  request.logs = {log, writeLog(folder / "b.rawlog", driveEntries(4))};
  request.config_file = writeConfig(folder);
  std::vector<std::size_t> done;
  mapLogs(request, [&](const MappingProgress& now) {
    done.push_back(now.entries_done);
    EXPECT_EQ(now.entries, 14u);
  });
  ASSERT_EQ(done.size(), 14u);
  EXPECT_EQ(done.back(), 14u);
}

TEST(MappingRun, ProgressTellsWhatIsInTheMapAndWhatWasLeftOut) {
  const TempFolder folder;
  Entries entries = driveEntries(2);
  const auto cloudWith = [](double time, float label) {
    auto cloud = wallCloud(time);
    auto& points = dynamic_cast<mrpt::maps::CPointsMapXYZI&>(*cloud->pointcloud);
    points.setPointFast(0, std::nanf(""), 0, 0);
    points.setPointIntensity(1, label);
    return cloud;
  };
  entries.push_back(robotPose(102, {}));
  entries.push_back(cloudWith(102, 77));
  auto all_gone = wallCloud(102);
  auto& points = dynamic_cast<mrpt::maps::CPointsMapXYZI&>(*all_gone->pointcloud);
  for (std::size_t i = 0; i < points.size(); ++i) points.setPointFast(i, std::nanf(""), 0, 0);
  const std::size_t gone = points.size();
  entries.push_back(all_gone);
  entries.push_back(wallCloud(500));                // no pose there
  auto gps = mrpt::obs::CObservationGPS::Create();  // nobody wants it
  gps->timestamp = all_gone->timestamp;
  entries.push_back(gps);
  MappingRequest request;
  request.logs = {writeLog(folder / "a.rawlog", entries)};
  request.config_file = writeConfig(folder);
  struct Seen {
    std::size_t scans, rejected, refused, voxels;
  };
  std::vector<Seen> seen;
  const MappingResult result = mapLogs(request, [&](const MappingProgress& now) {
    seen.push_back(
        {now.scans, now.points_rejected, now.observations_refused, now.map.knownVoxelCount()});
  });
  ASSERT_EQ(seen.size(), entries.size());
  EXPECT_EQ(seen[1].scans, 1u);
  EXPECT_EQ(seen[3].rejected, 0u);
  EXPECT_GT(seen[3].voxels, seen[1].voxels);
  EXPECT_EQ(seen[5].rejected, 2u) << "one NaN, one unknown label";
  EXPECT_EQ(seen[5].refused, 0u);
  EXPECT_EQ(seen[6].rejected, 2u + gone);
  EXPECT_EQ(seen[6].refused, 1u);
  EXPECT_EQ(seen[7].refused, 2u);
  EXPECT_EQ(seen.back().refused, 2u);
  EXPECT_EQ(seen.back().scans, 3u);
  EXPECT_EQ(seen.back().voxels, result.map->map().knownVoxelCount());
}

}  // namespace
}  // namespace csom::test
