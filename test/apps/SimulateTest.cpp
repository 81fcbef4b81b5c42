// SPDX-License-Identifier: BSD-3-Clause
#include <csom/io/MapFile.h>
#include <csom/io/TrajectoryFile.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/RunCsom.h"
#include "io/IoFixtures.h"

namespace csom {
namespace {

namespace fs = std::filesystem;
using test::ProgramResult;
using test::runCsom;
using testing::HasSubstr;

const std::string kRoom = CSOM_SOURCE_DIR "/config/worlds/room.yaml";

class SimulateTest : public testing::Test {
 protected:
  ProgramResult simulate(const std::string& world, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"simulate", world, "-o", rawlog()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runCsom(folder_.path(), arguments);
  }
  std::string rawlog() const { return folder_ / "x.rawlog"; }

  /// Fails with this exit code and one line, and leaves no file.
  void expectFailure(const ProgramResult& result, int exit_code, const std::string& reason) {
    EXPECT_EQ(result.exit_code, exit_code);
    ASSERT_EQ(result.errorLines().size(), 1U) << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(reason));
    EXPECT_FALSE(fs::exists(rawlog()));
  }

  test::TempFolder folder_;
};

TEST_F(SimulateTest, WritesRawlogTruthAndTrajectory) {
  const std::string truth = folder_ / "truth.csom";
  const std::string trajectory = folder_ / "x.tum";
  const ProgramResult result =
      simulate(kRoom, {"--truth", truth, "--trajectory", trajectory, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(fs::exists(rawlog()));
  EXPECT_EQ(readTumTrajectory(trajectory).size(), 12U);

  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["frames"], 12);
  EXPECT_EQ(json["labelled_returns"], 12 * 3500);
  const MapDocument document = loadMap(truth);
  EXPECT_EQ(document.labels.name(), "simulator");
  EXPECT_EQ(document.map.options().resolution, 0.1);
  std::size_t occupied = 0;
  std::size_t free = 0;
  document.map.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel& voxel) {
    ++(voxel.state() == VoxelState::Free ? free : occupied);
  });
  EXPECT_EQ(json["truth"]["occupied_voxels"], occupied);
  EXPECT_EQ(json["truth"]["free_voxels"], free);
  EXPECT_GT(occupied, 20000U);
  EXPECT_GT(free, 100000U);
  EXPECT_EQ(document.map.at({1.0, 0.55, -0.05}).mostLikelyClass(),
            document.labels.classByName("floor"));
  EXPECT_EQ(document.map.at({1.5, -2, 1}).state(), VoxelState::Free);
}

TEST_F(SimulateTest, TruthResolutionAndSeedOverrideTheWorldFile) {
  const std::string truth = folder_ / "truth.csom";
  const ProgramResult result =
      simulate(kRoom, {"--truth", truth, "--truth-resolution", "0.25", "--seed", "9", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(nlohmann::json::parse(result.output)["seed"], 9);
  EXPECT_EQ(loadMap(truth).map.options().resolution, 0.25);
}

TEST_F(SimulateTest, FaultyWorldFileIsAnErrorOfConfiguration) {
  const std::string world = folder_ / "bad.yaml";
  std::ofstream(world) << "label_set: simulator\nsolids:\n  - {shape: box}\n";
  expectFailure(simulate(world), 2, world + ":3: solid has no 'center'");
}

TEST_F(SimulateTest, TruthTooFineToHoldIsAnErrorOfConfiguration) {
  expectFailure(simulate(kRoom, {"--truth", folder_ / "t.csom", "--truth-resolution", "0.001"}), 2,
                kRoom + ": truth: region has ");
  EXPECT_FALSE(fs::exists(folder_ / "t.csom"));
}

TEST_F(SimulateTest, FilesThatCannotBeReadOrWrittenFail) {
  expectFailure(simulate(folder_ / "none.yaml"), 2, "none.yaml: cannot be read");
  const ProgramResult result =
      runCsom(folder_.path(), {"simulate", kRoom, "-o", folder_ / "no/folder/x.rawlog"});
  expectFailure(result, 1, "no/folder/x.rawlog: ");
}

TEST_F(SimulateTest, HelpHasExamples) {
  const ProgramResult result = runCsom(folder_.path(), {"simulate", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("csom simulate config/worlds/room.yaml -o room.rawlog"));
  EXPECT_EQ(simulate(kRoom, {"--format", "bag"}).exit_code, 2);
}

}  // namespace
}  // namespace csom
