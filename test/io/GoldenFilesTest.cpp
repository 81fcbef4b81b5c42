// SPDX-License-Identifier: BSD-3-Clause
// Maps that earlier versions wrote are read as they were meant: test/golden/README.md.
#include <csom/io/MapRepair.h>
#include <csom/io/TextParser.h>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::IsEmpty;

std::string golden(const std::string& name) {
  return std::string(CSOM_SOURCE_DIR) + "/test/golden/" + name;
}

class GoldenFiles : public testing::TestWithParam<const char*> {};

/// Every voxel as `csom export --to csv --all` wrote it at the time.
TEST_P(GoldenFiles, HoldTheVoxelsThatTheyHeld) {
  const MapDocument document = loadMap(golden(std::string(GetParam()) + ".csom"));
  const std::string csv = readBytes(golden("voxels.csv"));
  detail::LineReader lines(csv);
  std::string_view line;
  ASSERT_TRUE(lines.next(line));
  std::size_t voxels = 0;
  while (lines.next(line)) {
    double x = 0, y = 0, z = 0, evidence = 0, probability = 0;
    int id = 0;
    char name[32] = "";
    ASSERT_EQ(std::sscanf(std::string(line).c_str(), "%lf,%lf,%lf,%d,%31[^,],%lf,%*f,%lf", &x, &y,
                          &z, &id, name, &probability, &evidence),
              7)
        << line;
    const DirichletVoxel voxel = document.map.at({x, y, z});
    EXPECT_EQ(voxel.mostLikelyClass(), id) << line;
    EXPECT_EQ(document.labels.at(voxel.mostLikelyClass()).name, name);
    EXPECT_NEAR(voxel.probability(voxel.mostLikelyClass()), probability, 1e-12) << line;
    EXPECT_NEAR(voxel.evidence(), evidence, 1e-12) << line;
    ++voxels;
  }
  EXPECT_EQ(voxels, 551U);
  EXPECT_EQ(document.map.knownVoxelCount(), voxels);
}

TEST_P(GoldenFiles, HoldScansOptionsAndMeta) {
  const MapDocument document = loadMap(golden(std::string(GetParam()) + ".csom"));
  ASSERT_EQ(document.scans.size(), 12U);
  EXPECT_EQ(document.scans[3].sensor_label, "scanner");
  EXPECT_EQ(document.scans[3].observation_class, "CObservationPointCloud");
  EXPECT_EQ(document.scans[3].report.points, 3500U);
  const Options& options = document.map.options();
  EXPECT_EQ(options.resolution, 0.8);
  EXPECT_EQ(options.method, Method::SCsm);
  EXPECT_EQ(options.free_space.mode, FreeSpace::Sampled);
  EXPECT_EQ(document.labels.name(), "simulator");
  EXPECT_EQ(document.meta.at("rawlog"), "room.rawlog");
  EXPECT_EQ(document.meta.count("digest"), 0U);
}

TEST_P(GoldenFiles, AreIntact) {
  const MapVerification found = verifyMap(golden(std::string(GetParam()) + ".csom"));
  EXPECT_THAT(found.faults, IsEmpty());
  EXPECT_TRUE(found.finished);
  EXPECT_EQ(found.scans, 12U);
  EXPECT_EQ(found.chunks, 8U);
  EXPECT_EQ(found.digest, "ffc38398e778723e") << "equal maps have equal digests";
}

INSTANTIATE_TEST_SUITE_P(Versions, GoldenFiles, testing::Values("version-1", "version-2"),
                         [](const auto& test) {
                           std::string name(test.param);
                           name.erase(name.find('-'), 1);
                           return name;
                         });

}  // namespace
}  // namespace csom::test
