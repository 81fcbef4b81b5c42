// SPDX-License-Identifier: BSD-3-Clause
// The voxels that the page carries: all occupied ones, in their places, with their class vectors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "SampleMaps.h"
#include "ViewerModel.h"

namespace csom {
namespace {

using nlohmann::json;
using Place = std::tuple<int, int, int>;

struct UnpackedCube {
  double variance = 0;
  double evidence = 0;
  std::vector<std::pair<int, double>> vector;  ///< class, probability
};

/// Reads the model as the header describes it, one field after another.
std::map<Place, UnpackedCube> unpacked(const ViewerModel& model) {
  const json header = json::parse(model.header);
  const std::size_t tiles = header["tiles"], cubes = header["voxels"],
                    entries = header["vectorEntries"];
  std::vector<std::uint8_t> bytes(tiles * (12 + 4096) + 3 * cubes + 2 * entries);
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(bytes.data(), &size, model.data.data(), model.data.size()), Z_OK);
  EXPECT_EQ(size, bytes.size());

  const auto word = [&](std::size_t at) {
    std::int32_t value;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  const auto fromLogarithmic = [&](const char* range, std::uint8_t byte) {
    const double min = header[range]["min"], max = header[range]["max"];
    return min * std::pow(max / min, byte / 255.0);
  };
  const std::uint8_t* const sizes = bytes.data() + tiles * (12 + 4096);
  const std::uint8_t* const classes = sizes + 3 * cubes;
  std::map<Place, UnpackedCube> result;
  std::size_t cube = 0, entry = 0;
  for (std::size_t t = 0; t < tiles; ++t) {
    for (int i = 0; i < 32 * 32 * 32; ++i) {
      const std::size_t row = static_cast<std::size_t>(i / 32);
      const auto bits = static_cast<std::uint32_t>(word(12 * tiles + 4096 * t + 4 * row));
      if ((bits >> (i % 32) & 1) == 0) continue;
      UnpackedCube unpacked;
      unpacked.variance = fromLogarithmic("variance", sizes[cubes + cube]);
      unpacked.evidence = fromLogarithmic("evidence", sizes[2 * cubes + cube]);
      for (int k = 0; k < sizes[cube]; ++k, ++entry)
        unpacked.vector.emplace_back(classes[entry], classes[entries + entry] / 255.0);
      ++cube;
      result[{word(12 * t) * 32 + i % 32, word(12 * t + 4) * 32 + i / 32 % 32,
              word(12 * t + 8) * 32 + i / 1024}] = unpacked;
    }
  }
  EXPECT_EQ(cube, cubes);
  EXPECT_EQ(entry, entries);
  return result;
}

TEST(ViewerModelTest, HoldsEveryOccupiedVoxelWithItsClassVector) {
  MapDocument document = test::mapOf({{{0, 0, 0}, 1},
                                      {{31, 5, 0}, 2},
                                      {{32, 5, 0}, 2},
                                      {{-1, -33, 7}, 3},
                                      {{-1, -33, 7}, 3},
                                      {{-1, -33, 7}, 2},
                                      {{4, 4, 4}, 0}});
  const auto cubes = unpacked(viewerModel(document, test::sampleRecord()));
  document.map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    if (voxel.state() != VoxelState::Occupied) return;
    const auto found = cubes.find({v.x, v.y, v.z});
    ASSERT_NE(found, cubes.end());
    const ClassId best = voxel.mostLikelyClass();
    EXPECT_EQ(found->second.vector.front().first, best);
    for (const auto& [k, probability] : found->second.vector)
      EXPECT_NEAR(probability, voxel.probability(static_cast<ClassId>(k)), 0.5 / 255);
    EXPECT_NEAR(found->second.variance / voxel.variance(best), 1, 0.03);
    EXPECT_NEAR(found->second.evidence / voxel.evidence(), 1, 0.03);
  });
  EXPECT_EQ(cubes.size(), 4u);
  EXPECT_EQ(cubes.at({-1, -33, 7}).vector.size(), 2u);
}

TEST(ViewerModelTest, TellsWhatThePageShowsAroundTheVoxels) {
  RunRecord record = test::sampleRecord();
  record.scans[1].record.origin = {2, 2, 3};
  const MapDocument document =
      test::mapOf({{{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {{1, 0, 3}, 4}, {{2, 0, 9}, 0}}, 0.5);
  const json header = json::parse(viewerModel(document, record).header);
  EXPECT_EQ(header["resolution"], 0.5);
  EXPECT_EQ(header["voxelsPerCube"], 1);
  EXPECT_EQ(header["layers"], json({{"low", 0}, {"high", 3}}));
  EXPECT_EQ(header["focus"], json({{"low", {0, 0, 0}}, {"high", {2, 1, 4}}}));
  EXPECT_EQ(header["classes"],
            json::parse(R"([{"id": 1, "name": "ground", "voxels": 2, "shown": true},
                            {"id": 4, "name": "ceiling", "voxels": 1, "shown": false}])"));
  EXPECT_EQ(header["classNames"][1],
            json::parse(R"({"name": "ground", "color": [200, 0, 0], "safeColor": [0, 114, 178]})"));
  EXPECT_EQ(header["classNames"].size(), 5u);
  EXPECT_EQ(header["trajectories"], json::parse("[[[2.0, 4.0, 6.0], [4.0, 4.0, 6.0]]]"));
}

TEST(ViewerModelTest, FollowsTheUpOfTheRobot) {
  RunRecord record = test::sampleRecord();
  record.up = {0, -1, 0.1};
  const json header =
      json::parse(viewerModel(test::mapOf({{{0, 0, 0}, 1}, {{0, 4, 0}, 1}}), record).header);
  EXPECT_EQ(header["up"], json({{"axis", 1}, {"sign", -1}}));
  EXPECT_EQ(header["layers"], json({{"low", -5}, {"high", -1}}));
}

TEST(ViewerModelTest, TooManyVoxelsBecomeCubesOfWhichTheBestKnownVoxelIsShown) {
  const MapDocument document = test::mapOf(
      {{{0, 0, 0}, 1}, {{1, 1, 1}, 2}, {{1, 1, 1}, 2}, {{2, 0, 0}, 3}, {{-1, 0, 0}, 3}});
  const ViewerModel model = viewerModel(document, test::sampleRecord(), 3);
  EXPECT_EQ(model.voxels_per_cube, 2);
  const auto cubes = unpacked(model);
  ASSERT_EQ(cubes.size(), 3u);
  EXPECT_EQ(cubes.at({0, 0, 0}).vector.front().first, 2);
  EXPECT_EQ(cubes.at({1, 0, 0}).vector.front().first, 3);
  EXPECT_EQ(cubes.at({-1, 0, 0}).vector.front().first, 3);
  EXPECT_EQ(json::parse(model.header)["resolution"], 2.0);
  EXPECT_EQ(viewerModel(document, test::sampleRecord(), 4).voxels_per_cube, 1);
}

TEST(ViewerModelTest, ScatteredVoxelsDoNotFillThePageWithEmptyTiles) {
  std::vector<test::LabelledVoxel> scattered;
  for (int i = 0; i < 16'000; ++i) scattered.push_back({{32 * i, 0, 0}, 1});
  const ViewerModel model = viewerModel(test::mapOf(scattered), test::sampleRecord());
  EXPECT_EQ(model.cubes, 16'000u);
  EXPECT_EQ(json::parse(model.header)["tiles"], 8'000);
}

TEST(ViewerModelTest, AMapWithoutOccupiedVoxelsHasNoModel) {
  const ViewerModel model = viewerModel(test::mapOf({{{0, 0, 0}, 0}}), test::sampleRecord());
  EXPECT_EQ(model.cubes, 0u);
  EXPECT_TRUE(model.data.empty());
}

}  // namespace
}  // namespace csom
