// SPDX-License-Identifier: BSD-3-Clause
// run.json: complete, exact, and valid whatever the record holds.
#include <csom/report/RunRecord.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "SampleMaps.h"

namespace csom {
namespace {

using nlohmann::json;

json parsed(const RunRecord& record, const MapDocument& document = test::mapOf({})) {
  return json::parse(toJson(record, computeFigures(document)));
}

TEST(RunRecordTest, EveryOptionIsAParameterOfItsOwnType) {
  Options options;
  options.resolution = 0.1;
  options.see_csom.rvfm = false;
  options.method = Method::SBki;
  RunRecord record;
  record.parameters = toParameters(options);

  std::set<std::string> names;
  visitOptions(options, [&](const OptionInfo& option, const auto&) { names.insert(option.key); });
  const json parameters = parsed(record)["parameters"];
  EXPECT_EQ(parameters.size(), names.size());
  for (const std::string& name : names) EXPECT_TRUE(parameters.contains(name)) << name;
  EXPECT_EQ(parameters["resolution"], 0.1);
  EXPECT_TRUE(parameters["rvfm"].is_boolean());
  EXPECT_EQ(parameters["rvfm"], false);
  EXPECT_TRUE(parameters["block_depth"].is_number_integer());
  EXPECT_EQ(parameters["method"], "s-bki");
}

TEST(RunRecordTest, ParametersReadLikeAnIniFile) {
  EXPECT_EQ(toText({"a", 0.2, "m", ""}), "0.2");
  EXPECT_EQ(toText({"a", true, "", ""}), "on");
  EXPECT_EQ(toText({"a", std::int64_t{-3}, "", ""}), "-3");
  EXPECT_EQ(toText({"a", std::string("text"), "", ""}), "text");
}

TEST(RunRecordTest, ScansCarryTimestampPointsAndTimes) {
  const json scans = parsed(test::sampleRecord())["scans"];
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0]["timestamp"], 1700000000.125);
  EXPECT_EQ(scans[0]["sensor_label"], "velodyne");
  EXPECT_EQ(scans[0]["observation_class"], "CObservationVelodyneScan");
  EXPECT_EQ(scans[0]["origin"], json({1, 2, 3}));
  EXPECT_EQ(scans[0]["points"], 1000);
  EXPECT_EQ(scans[0]["rejected"], 25);
  EXPECT_EQ(scans[0]["insert_ms"], 10);
  EXPECT_EQ(scans[1]["insert_ms"], 30);
  EXPECT_EQ(scans[1]["prepare_ms"], 2);
  EXPECT_EQ(scans[1]["infer_ms"], 5);
  EXPECT_EQ(scans[1]["commit_ms"], 1);
}

TEST(RunRecordTest, TotalsAddUp) {
  const json run = parsed(test::sampleRecord());
  EXPECT_EQ(run["totals"]["observations_read"], 7);
  EXPECT_EQ(run["totals"]["observations_inserted"], 2);
  EXPECT_EQ(run["totals"]["points"], 2000);
  EXPECT_EQ(run["totals"]["rejected"], 50);
  EXPECT_EQ(run["totals"]["rejects"][toString(RejectReason::TooFar)], 50);
  EXPECT_EQ(run["totals"]["rejects"].size(), kRejectReasons + 4);  // and four about labels
  EXPECT_EQ(run["refused"],
            json::parse(R"([{"observation_class": "CObservationGPS", "reason": "no range data",
                             "count": 5}])"));
  EXPECT_EQ(run["warnings"].size(), 1u);
}

TEST(RunRecordTest, PointsDroppedBeforeTheMapSawThemAreRejectsToo) {
  RunRecord record = test::sampleRecord();
  record.labels = {5, 6, 7, 1, 20, 300, 4000};
  record.unused.points = 7;
  record.unused.rejected[0] = 7;
  const json totals = parsed(record)["totals"];
  EXPECT_EQ(totals["points"], 2000 + 4321 + 7);
  EXPECT_EQ(totals["rejected"], 50 + 4321 + 7);
  EXPECT_EQ(totals["rejects"]["no-label"], 1);
  EXPECT_EQ(totals["rejects"]["unknown-label"], 20);
  EXPECT_EQ(totals["rejects"]["ignored-label"], 300);
  EXPECT_EQ(totals["rejects"]["several-labels"], 4000);
  std::size_t sum = 0;
  for (const auto& [reason, count] : totals["rejects"].items()) sum += count.get<std::size_t>();
  EXPECT_EQ(totals["rejected"], sum);
}

TEST(RunRecordTest, TellsHowTheRunCameAbout) {
  const json run = parsed(test::sampleRecord());
  EXPECT_EQ(run["program_version"], "1.2.3");
  EXPECT_EQ(run["command"], "csom map 'my drive.rawlog' -o out");
  EXPECT_EQ(run["inputs"], json({"data/my drive.rawlog"}));
  EXPECT_EQ(run["config_file"], "config/drive.ini");
  EXPECT_EQ(run["pose_source"], "robot-pose:GT");
  EXPECT_EQ(run["label_set"], "sample");
  EXPECT_EQ(run["up"], json({0.0, 0.0, 1.0}));
  EXPECT_EQ(run["wall_seconds"], 12.34);
}

TEST(RunRecordTest, TimingHasOrderStatisticsOfEveryStage) {
  RunRecord record = test::sampleRecord();
  record.scans.resize(1);
  for (int i = 1; i <= 100; ++i) {
    record.scans.push_back(record.scans.front());
    record.scans.back().insert_ms = i;
  }
  record.scans.erase(record.scans.begin());
  const json insert = parsed(record)["timing_ms"]["insert"];
  EXPECT_EQ(insert["min"], 1);
  EXPECT_EQ(insert["median"], 50);
  EXPECT_EQ(insert["p95"], 95);
  EXPECT_EQ(insert["max"], 100);
  EXPECT_EQ(insert["total"], 5050);
  EXPECT_EQ(parsed(record)["timing_ms"].size(), 4u);
}

TEST(RunRecordTest, DescribesTheMap) {
  const MapDocument document = test::mapOf({{{0, 0, 0}, 1}, {{1, 0, 0}, 0}}, 0.5);
  const json map = parsed(test::sampleRecord(), document)["map"];
  EXPECT_EQ(map["resolution"], 0.5);
  EXPECT_EQ(map["known_voxels"], 2);
  EXPECT_EQ(map["occupied_voxels"], 1);
  EXPECT_EQ(map["free_voxels"], 1);
  EXPECT_EQ(map["bounds"]["min"], json({0, 0, 0}));
  EXPECT_EQ(map["bounds"]["max"], json({1, 0.5, 0.5}));
  EXPECT_EQ(map["digest"], mapDigest(document.map));
  EXPECT_EQ(map["classes"][1]["name"], "ground");
  EXPECT_EQ(map["classes"][1]["voxels"], 1);
  EXPECT_EQ(map["classes"][1]["volume_m3"], 0.125);
  EXPECT_EQ(map["classes"][1]["color"], json({200, 0, 0}));
}

TEST(RunRecordTest, AnEmptyRunIsValidJson) {
  const json run = parsed(RunRecord{});
  EXPECT_EQ(run["scans"], json::array());
  EXPECT_TRUE(run["map"]["bounds"].is_null());
  EXPECT_TRUE(run["timing_ms"].empty());
}

TEST(RunRecordTest, NumbersThatAreNotFiniteBecomeNull) {
  RunRecord record = test::sampleRecord();
  record.wall_seconds = std::numeric_limits<double>::quiet_NaN();
  record.scans[0].record.timestamp = std::numeric_limits<double>::infinity();
  const json run = parsed(record);
  EXPECT_TRUE(run["wall_seconds"].is_null());
  EXPECT_TRUE(run["scans"][0]["timestamp"].is_null());
}

TEST(RunRecordTest, NumbersAreTheShortestThatReadBack) {
  RunRecord record;
  record.wall_seconds = 0.1;
  EXPECT_NE(toJson(record, {}).find("\"wall_seconds\": 0.1,"), std::string::npos);
  record.wall_seconds = 1.0 / 3.0;
  EXPECT_EQ(parsed(record)["wall_seconds"].get<double>(), 1.0 / 3.0);
}

TEST(RunRecordTest, BytesThatAreNotUtf8AreReplaced) {
  RunRecord record;
  record.inputs = {"caf\xe9.rawlog"};
  EXPECT_EQ(parsed(record)["inputs"][0], "caf\xEF\xBF\xBD.rawlog");
}

TEST(RunRecordTest, WithoutCamerasThereIsNothingAboutThem) {
  const json run = parsed(test::sampleRecord());
  EXPECT_FALSE(run.contains("camera_labels"));
  EXPECT_FALSE(run.contains("deskew"));
  EXPECT_FALSE(run.contains("registration"));
  EXPECT_EQ(addedShare(test::sampleRecord()), std::nullopt);
}

TEST(RunRecordTest, CountsWhatBecameOfImagesScansAndPoints) {
  RunRecord record = test::sampleRecord();
  record.camera_labels = test::sampleCameraLabels();
  record.wall_seconds = 12.5;
  record.camera_labels->clock_restarts = 2;
  record.camera_labels->points.kept_unlabelled = 9;
  EXPECT_EQ(parsed(record)["camera_labels"], json::parse(R"({
    "images": {"read": 30, "used": 24, "network_runs": 12, "from_cache": 3, "unused": 5,
               "refused": 1},
    "scans": {"labelled": 18, "without_image": 4, "late": 1},
    "clock_restarts": 2,
    "points": {"labelled": 6000, "outside_view": 10000, "hidden": 1000, "at_edge": 500,
               "low_confidence": 250, "ignored": 200, "unknown": 50, "kept_unlabelled": 9},
    "seconds": {"network": 10.0, "image_decoding": 0.5, "labelling": 1.5},
    "added_share": 0.25,
    "cameras": [
      {"sensor_label": "left", "source": "network",
       "images": {"read": 20, "used": 15, "network_runs": 12, "from_cache": 3, "unused": 4,
                  "refused": 1}},
      {"sensor_label": "right", "source": "label_image",
       "images": {"read": 10, "used": 9, "network_runs": 0, "from_cache": 0, "unused": 1,
                  "refused": 0}}]
  })"));
}

TEST(RunRecordTest, WithoutANetworkTheAddedShareIsNull) {
  RunRecord record = test::sampleRecord();
  record.camera_labels = test::sampleCameraLabels();
  record.camera_labels->seconds.network = 0;
  EXPECT_TRUE(parsed(record)["camera_labels"]["added_share"].is_null());
}

TEST(RunRecordTest, PointsThatCamerasDropAreRejectsByReason) {
  RunRecord record = test::sampleRecord();
  record.labels = {5, 6, 7, 1, 20, 300, 4000};
  record.camera_labels = test::sampleCameraLabels();
  const auto check = [&](std::size_t unseen) {
    const json totals = parsed(record)["totals"];
    EXPECT_EQ(totals["rejects"]["unknown-label"], 20 + 50);
    EXPECT_EQ(totals["rejects"]["ignored-label"], 300 + 200);
    EXPECT_EQ(totals["rejects"]["not-seen-by-camera"], unseen) << "hidden or at an edge";
    EXPECT_EQ(totals["rejects"]["low-confidence"], 250);
    std::size_t sum = 0;
    for (const auto& [reason, count] : totals["rejects"].items()) sum += count.get<std::size_t>();
    EXPECT_EQ(totals["rejected"], sum);
    EXPECT_EQ(totals["points"], 2000 + 4321 + 10'000 + unseen + 250 + 200 + 50);
    EXPECT_EQ(totals["outside_view"], 10'000) << "left out, but not rejected";
  };
  check(1500);
}

TEST(RunRecordTest, PointsThatAreKeptAsUnlabelledAreNoRejects) {
  RunRecord record = test::sampleRecord();
  record.labels = {5, 6, 7, 1, 20, 300, 4000};
  record.camera_labels = test::sampleCameraLabels();
  record.camera_labels->points.kept_unlabelled = 11'750;  // these the scans count
  record.no_returns = 18;
  const json totals = parsed(record)["totals"];
  EXPECT_EQ(totals["rejects"]["unknown-label"], 20);
  EXPECT_EQ(totals["rejects"]["ignored-label"], 300);
  EXPECT_EQ(totals["rejects"]["not-seen-by-camera"], 0);
  EXPECT_EQ(totals["rejects"]["low-confidence"], 250);
  EXPECT_EQ(totals["outside_view"], 0);
  EXPECT_EQ(totals["points"], 2000 + 4321 + 250);
  EXPECT_EQ(totals["kept_unlabelled"], 6 + 7);
  EXPECT_EQ(totals["no_returns"], 18);
}

TEST(RunRecordTest, TellsWhereRangeImagesComeFrom) {
  RunRecord record = test::sampleRecord();
  EXPECT_EQ(describeImages(record.images), "") << "the method does not look at them";
  record.images = {1200, 1, 3};
  EXPECT_EQ(describeImages(record.images),
            "1,200 scans with the range image of the sensor, 1 scan with rows found in the points, "
            "3 scans without rows: neighbours in space");
  EXPECT_EQ(parsed(record)["scan_images"],
            json::parse(R"({"of_sensor": 1200, "found": 1, "none": 3})"));
}

TEST(RunRecordTest, TellsAboutDeskewingAndRegistration) {
  RunRecord record = test::sampleRecord();
  record.deskew = DeskewStatistics{5, 6, 7};
  record.registration = RegistrationStatistics{100, 3, 12.5};
  const json run = parsed(record);
  EXPECT_EQ(run["deskew"], json::parse(R"({"deskewed": 5, "not_needed": 6, "not_possible": 7})"));
  EXPECT_EQ(run["registration"], json::parse(R"({"scans": 100, "doubtful": 3, "seconds": 12.5})"));
}

}  // namespace
}  // namespace csom
