// SPDX-License-Identifier: BSD-3-Clause
// csom info, query, merge and export as separate processes.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/RunCsom.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class MapCommandsTest : public testing::Test {
 protected:
  void SetUp() override { saveMap(document_, map_); }

  ProgramResult run(const std::vector<std::string>& arguments) const {
    return runCsom(folder_.path(), arguments);
  }
  /// Output of a run that must succeed.
  std::string outputOf(const std::vector<std::string>& arguments) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.output;
  }
  json jsonOf(std::vector<std::string> arguments) const {
    arguments.emplace_back("--json");
    return json::parse(outputOf(arguments));
  }
  /// Messages of a run that must end with `exit_code`.
  std::string errorsOf(int exit_code, const std::vector<std::string>& arguments) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.output << result.errors;
    EXPECT_EQ(result.output, "");
    return result.errors;
  }

  /// An occupied voxel of the sample.
  VoxelIndex occupiedVoxel() const {
    VoxelIndex found;
    document_.map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& v) {
      if (v.state() == VoxelState::Occupied) found = index;
    });
    return found;
  }
  static std::string pointArgument(const Eigen::Vector3d& p) {
    return std::to_string(p.x()) + "," + std::to_string(p.y()) + "," + std::to_string(p.z());
  }

  const MapDocument document_ = sampleDocument();
  TempFolder folder_;
  std::string map_ = folder_ / "map.csom";
};

// ---- info ---------------------------------------------------------------------------------------

TEST_F(MapCommandsTest, InfoSaysWhatTheMapHolds) {
  const json info = jsonOf({"info", map_});
  EXPECT_EQ(info["digest"], mapDigest(document_.map));
  EXPECT_EQ(info["resolution_m"], 0.25);
  EXPECT_EQ(info["label_set"], "sample");
  EXPECT_EQ(info["known_voxels"], document_.map.knownVoxelCount());
  EXPECT_EQ(info["scans"]["count"], 3);
  EXPECT_EQ(info["scans"]["by_observation_class"]["CObservationPointCloud"], 3);
  EXPECT_EQ(info["scans"]["points"], 120);
  EXPECT_EQ(info["scans"]["rejected"]["too-near"], 21);
  EXPECT_EQ(info["options"]["method"], "see-csom");
  EXPECT_EQ(info["options"]["number_of_classes"], 3);
  EXPECT_EQ(info["meta"]["created_by"], "a test");
  ASSERT_EQ(info["classes"].size(), 3U);
  std::size_t voxels = 0;
  for (const json& c : info["classes"]) {
    voxels += c["voxels"].get<std::size_t>();
    EXPECT_NEAR(c["volume_m3"].get<double>(), c["voxels"].get<double>() * 0.015625, 1e-9);
  }
  EXPECT_EQ(voxels, document_.map.knownVoxelCount());
  const auto box = document_.map.boundingBox();
  EXPECT_EQ(info["bounding_box_m"]["min"][1].get<double>(), box->min.y * 0.25);
  EXPECT_EQ(info["bounding_box_m"]["max"][1].get<double>(), (box->max.y + 1) * 0.25);
}

TEST_F(MapCommandsTest, InfoForPeople) {
  const std::string text = outputOf({"info", map_});
  EXPECT_THAT(text, AllOf(HasSubstr(mapDigest(document_.map)), HasSubstr("0.25 m"),
                          HasSubstr("wall, brick"), HasSubstr("CObservationPointCloud"),
                          HasSubstr("too-near"), HasSubstr("kernel_length_max")));
}

TEST_F(MapCommandsTest, InfoOfAnEmptyMap) {
  saveMap(MapDocument{}, folder_ / "empty.csom");
  EXPECT_THAT(outputOf({"info", folder_ / "empty.csom"}), HasSubstr("the map is empty"));
  EXPECT_TRUE(jsonOf({"info", folder_ / "empty.csom"})["bounding_box_m"].is_null());
}

TEST_F(MapCommandsTest, WhatIsNoMapEndsWithOneLine) {
  writeBytes(folder_ / "no.csom", "nothing");
  const std::vector<std::vector<std::string>> commands{
      {"info"}, {"query", "--point", "0,0,0"}, {"export", "--to", "csv", "-o", folder_ / "x"}};
  for (std::vector<std::string> command : commands) {
    command.insert(command.begin() + 1, folder_ / "no.csom");
    const std::string errors = errorsOf(1, command);
    EXPECT_THAT(errors, HasSubstr("no.csom: is no csom map"));
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  }
  EXPECT_THAT(errorsOf(1, {"info", folder_ / "missing.csom"}), HasSubstr("no such file"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x"));
}

// ---- query --------------------------------------------------------------------------------------

TEST_F(MapCommandsTest, QueryPointIsTheVoxelOfTheMap) {
  const VoxelIndex index = occupiedVoxel();
  const Eigen::Vector3d center = document_.map.grid().center(index);
  const DirichletVoxel voxel = document_.map.voxel(index);
  const json answer = jsonOf({"query", map_, "--point", pointArgument(center)});
  EXPECT_EQ(answer["voxel"], (json{index.x, index.y, index.z}));
  EXPECT_EQ(answer["state"], "occupied");
  EXPECT_EQ(answer["class_id"], voxel.mostLikelyClass());
  EXPECT_EQ(answer["class_name"], document_.labels.at(voxel.mostLikelyClass()).name);
  EXPECT_EQ(answer["probability"], voxel.probability(voxel.mostLikelyClass()));
  EXPECT_EQ(answer["evidence"], voxel.evidence());
  EXPECT_EQ(answer["entropy"], voxel.entropy());
  EXPECT_EQ(answer["probabilities"], json(voxel.probabilities()));
  EXPECT_THAT(outputOf({"query", map_, "--point", pointArgument(center)}),
              HasSubstr("state        occupied"));
}

TEST_F(MapCommandsTest, QueryPointInTheUnknown) {
  const json answer = jsonOf({"query", map_, "--point", "-1000,.5,1e2"});
  EXPECT_EQ(answer["state"], "unknown");
  EXPECT_TRUE(answer["class_id"].is_null());
  EXPECT_EQ(answer["voxel"], (json{-4000, 2, 400}));
}

TEST_F(MapCommandsTest, QueryRayHitsWhatTheMapHits) {
  const auto hit = document_.map.castRay({0.1, -0.2, 1.0}, {3, 0, -1}, 100);
  ASSERT_TRUE(hit);
  const json answer = jsonOf({"query", map_, "--ray", "0.1,-0.2,1.0,3,0,-1"});
  EXPECT_EQ(answer["hit"], true);
  EXPECT_NEAR(answer["distance"].get<double>(), hit->distance, 1e-12);
  EXPECT_EQ(answer["voxel"], (json{hit->voxel.x, hit->voxel.y, hit->voxel.z}));
  EXPECT_EQ(answer["class_id"], hit->class_id);
  EXPECT_EQ(jsonOf({"query", map_, "--ray", "0.1,-0.2,1.0,3,0,-1", "--max-range", "0.5"})["hit"],
            false);
  EXPECT_THAT(outputOf({"query", map_, "--ray", "0,0,50,0,0,1"}), HasSubstr("no hit"));
}

TEST_F(MapCommandsTest, QueryBoxCountsVoxelsByClass) {
  const json all = jsonOf({"query", map_, "--box", "-100,-100,-100,100,100,100"});
  EXPECT_EQ(all["known_voxels"], document_.map.knownVoxelCount());
  EXPECT_EQ(all["voxels"].size(), document_.map.knownVoxelCount());
  EXPECT_EQ(all["known_voxels"].get<int>(),
            all["occupied_voxels"].get<int>() + all["free_voxels"].get<int>());

  // One voxel exactly, by its own faces.
  const Eigen::Vector3d center = document_.map.grid().center(occupiedVoxel());
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.125);
  const json one = jsonOf(
      {"query", map_, "--box", pointArgument(center - half) + "," + pointArgument(center + half)});
  EXPECT_EQ(one["known_voxels"], 1);
  EXPECT_EQ(one["voxels"][0]["center"], (json{center.x(), center.y(), center.z()}));

  EXPECT_EQ(jsonOf({"query", map_, "--box", "0,0,0,0.01,0.01,0.01"})["known_voxels"], 0);
  EXPECT_EQ(
      jsonOf({"query", map_, "--box", "-1e300,-1e300,-1e300,1e300,1e300,1e300"})["known_voxels"],
      document_.map.knownVoxelCount());
}

TEST_F(MapCommandsTest, WrongQueriesEndWithUsage) {
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"--point"},
      {"--point", "1,2"},
      {"--point", "1,2,3,4"},
      {"--point", "1,2,"},
      {"--point", "1,2,x"},
      {"--point", "1, 2,3"},
      {"--point", "nan,0,0"},
      {"--point", "inf,0,0"},
      {"--point", "1e999,0,0"},
      {"--point", "1e30,0,0"},
      {"--point", ""},
      {"--ray", "0,0,0,1,0"},
      {"--ray", "0,0,0,0,0,0"},
      {"--ray", "1e30,0,0,1,0,0"},
      {"--box", "0,0,0,1,1"},
      {"--box", "0,0,0,1,-0.1,1"},
      {"--box", "1,0,0,0,1,1"},
      {"--point", "0,0,0", "--ray", "0,0,0,1,0,0"},
      {"--point", "0,0,0", "--max-range", "3"},
      {"--ray", "0,0,0,1,0,0", "--max-range", "0"},
      {"--ray", "0,0,0,1,0,0", "--max-range", "-1"},
      {"--ray", "0,0,0,1,0,0", "--max-range", "nan"},
      {"--point", "0,0,0", "--points"},
  };
  for (std::vector<std::string> arguments : wrong) {
    arguments.insert(arguments.begin(), {"query", map_});
    EXPECT_NE(errorsOf(2, arguments), "") << testing::PrintToString(arguments);
  }
  EXPECT_THAT(errorsOf(2, {"query", map_, "--point", "1,2,x"}),
              HasSubstr("--point: '1,2,x' must be 3 finite numbers separated by commas"));
}

// ---- merge --------------------------------------------------------------------------------------

TEST_F(MapCommandsTest, MergeIsTheSumInAnyOrder) {
  MapDocument other = sampleDocument();
  Scan scan;
  scan.origin = {20, 0, 0};
  scan.points = {{1, 0, 0}, {-17, 0.3F, 0.2F}};
  scan.labels = {1, 2};
  other.map.insert(scan);
  saveMap(other, folder_ / "b.csom");
  outputOf({"merge", map_, folder_ / "b.csom", "-o", folder_ / "ab.csom"});
  outputOf({"merge", folder_ / "b.csom", map_, "-o", folder_ / "ba.csom"});
  SemanticMap sum = document_.map;
  sum.merge(other.map);
  const MapDocument merged = loadMap(folder_ / "ab.csom");
  EXPECT_EQ(mapDigest(merged.map), mapDigest(sum));
  EXPECT_EQ(mapDigest(loadMap(folder_ / "ba.csom").map), mapDigest(sum));
  EXPECT_EQ(merged.scans.size(), 6U);
  EXPECT_EQ(merged.meta.at("merged_from"), map_ + ", " + folder_ / "b.csom");
}

/// Of the same frame and label set, but other content than the sample.
MapDocument otherDocument() {
  MapDocument other = sampleDocument();
  other.map.merge(sampleMap());
  return other;
}

TEST_F(MapCommandsTest, MergeOverItsOwnInput) {
  const MapDocument other = otherDocument();
  saveMap(other, folder_ / "other.csom");
  outputOf({"merge", map_, folder_ / "other.csom", "-o", map_});
  SemanticMap sum = document_.map;
  sum.merge(other.map);
  EXPECT_EQ(mapDigest(loadMap(map_).map), mapDigest(sum));
}

TEST_F(MapCommandsTest, MergeRefusesWhatDoesNotFit) {
  const std::string out = folder_ / "out.csom";
  saveMap(MapDocument{}, folder_ / "occupancy.csom");
  EXPECT_THAT(errorsOf(1, {"merge", map_, folder_ / "occupancy.csom", "-o", out}),
              AllOf(HasSubstr("occupancy.csom: its label set 'occupancy' is not that of"),
                    HasSubstr("map.csom, 'sample'")));
  MapDocument finer = sampleDocument();
  Options options = finer.map.options();
  options.resolution = 0.1;
  finer.map = SemanticMap(options);
  saveMap(finer, folder_ / "finer.csom");
  EXPECT_THAT(errorsOf(1, {"merge", map_, folder_ / "finer.csom", "-o", out}),
              AllOf(HasSubstr("finer.csom: "), HasSubstr("resolution 0.25"), HasSubstr("0.1")));
  EXPECT_THAT(errorsOf(1, {"merge", map_, folder_ / "missing.csom", "-o", out}),
              HasSubstr("missing.csom: no such file"));
  saveMap(otherDocument(), folder_ / "other.csom");
  EXPECT_THAT(errorsOf(1, {"merge", map_, folder_ / "other.csom", "-o", "/nowhere/out.csom"}),
              HasSubstr("/nowhere/out.csom: cannot be written"));
  EXPECT_NE(errorsOf(2, {"merge", map_, "-o", out}), "");
  EXPECT_NE(errorsOf(2, {"merge", map_, map_}), "");
  EXPECT_FALSE(std::filesystem::exists(out));
}

// ---- export -------------------------------------------------------------------------------------

TEST_F(MapCommandsTest, ExportWritesOneLineAVoxel) {
  const auto lines = [&](const std::vector<std::string>& extra) {
    std::vector<std::string> arguments{"export", map_, "--to", "csv", "-o", folder_ / "out.csv"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    outputOf(arguments);
    const std::string text = readBytes(folder_ / "out.csv");
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  };
  const json info = jsonOf({"info", map_});
  EXPECT_EQ(lines({}), 1 + info["occupied_voxels"].get<std::size_t>());
  EXPECT_EQ(lines({"--all"}), 1 + info["known_voxels"].get<std::size_t>());
  outputOf({"export", map_, "--to", "ply", "-o", folder_ / "out.ply"});
  EXPECT_EQ(readBytes(folder_ / "out.ply").substr(0, 4), "ply\n");
  outputOf({"export", map_, "--to", "pcd", "-o", folder_ / "out.pcd"});
  EXPECT_THAT(readBytes(folder_ / "out.pcd"), HasSubstr("FIELDS x y z rgb label\n"));
}

TEST_F(MapCommandsTest, ExportToAPipe) {
  EXPECT_EQ(outputOf({"export", map_, "--to", "csv", "-o", "/dev/stdout"}).substr(0, 6), "x,y,z,");
}

TEST_F(MapCommandsTest, ExportFailuresLeaveNothing) {
  EXPECT_THAT(errorsOf(1, {"export", map_, "--to", "ply", "-o", "/dev/full"}),
              HasSubstr("/dev/full: cannot be written: No space left on device"));
  EXPECT_THAT(errorsOf(1, {"export", map_, "--to", "ply", "-o", "/nowhere/a.ply"}),
              HasSubstr("/nowhere/a.ply: cannot be written"));
  EXPECT_THAT(errorsOf(2, {"export", map_, "--to", "obj", "-o", folder_ / "a"}), HasSubstr("--to"));
  EXPECT_NE(errorsOf(2, {"export", map_, "--to", "ply"}), "");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a"));
}

TEST_F(MapCommandsTest, HelpShowsExamples) {
  for (const char* command : {"info", "query", "merge", "export"})
    EXPECT_THAT(outputOf({command, "--help"}),
                AllOf(HasSubstr("Example"), HasSubstr(std::string("csom ") + command)));
}

// ---- eval ---------------------------------------------------------------------------------------

TEST_F(MapCommandsTest, EvalNamesBothMapsThatDoNotFit) {
  MapDocument other = document_;
  Options options = document_.map.options();
  options.resolution = 0.5;
  other.map = SemanticMap(options);
  saveMap(other, folder_ / "coarse.csom");
  EXPECT_THAT(errorsOf(1, {"eval", "voxels", "--map", map_, "--truth", folder_ / "coarse.csom"}),
              AllOf(HasSubstr("map.csom"), HasSubstr("coarse.csom"), HasSubstr("0.25")));
  other = document_;
  other.labels = LabelSet::fromYaml(
      "name: other\nclasses:\n  - {id: 0, name: free, color: [255, 255, 255]}\n"
      "  - {id: 1, name: road, color: [10, 20, 30]}\n  - {id: 2, name: x, color: [1, 2, 3]}\n",
      "other");
  saveMap(other, folder_ / "other.csom");
  EXPECT_THAT(errorsOf(2, {"eval", "voxels", "--map", map_, "--truth", folder_ / "other.csom"}),
              AllOf(HasSubstr("map.csom"), HasSubstr("other.csom"), HasSubstr("'other'")));
}

// ---- hostile texts ------------------------------------------------------------------------------

TEST_F(MapCommandsTest, ControlCharactersOfAMapDoNotReachTheTerminal) {
  MapDocument hostile = document_;
  hostile.meta["evil\x1b[2J"] = "\x1b]0;title\x07";
  hostile.scans[0].observation_class = "C\x1b[31m";
  saveMap(hostile, folder_ / "hostile.csom");
  const std::string text = outputOf({"info", folder_ / "hostile.csom"});
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_THAT(text, AllOf(HasSubstr("evil?[2J"), HasSubstr("?]0;title?"), HasSubstr("C?[31m")));
}

}  // namespace
}  // namespace csom::test
