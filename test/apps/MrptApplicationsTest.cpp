// SPDX-License-Identifier: BSD-3-Clause
// Programs of MRPT that match maps with each other, started as processes with the plug-in.
#include <mrpt/maps/CSimpleMap.h>

#include <algorithm>
#include <regex>

#include "apps/RunMrpt.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kConfigs = CSOM_SOURCE_DIR "/config/mrpt/";
const std::string kDataSets = "/usr/share/mrpt/datasets/";  // of the package mrpt-common

ProgramResult runStock(const TempFolder& folder, const std::vector<std::string>& command) {
  return runMrpt(folder.path(), command, 200);
}

std::size_t framesOf(const std::string& file) {
  mrpt::maps::CSimpleMap frames;
  if (!frames.loadFromFile(file)) throw std::runtime_error(file + " cannot be read");
  return frames.size();
}

/// Every frame is in one part, and the parts are neither one nor one for each frame.
TEST(MapPartition, DividesADataSetByTheOverlapOfSemanticMaps) {
  const TempFolder folder;
  const std::string ini = "MAP-PARTITION_CONFIG.ini";
  writeBytes(folder / ini, readBytes(kConfigs + ini));
  const std::string frames = kDataSets + "localization_demo.simplemap.gz";
  const ProgramResult run = runStock(folder, {"map-partition", frames});
  EXPECT_THAT(run.output, HasSubstr("metricmap_csom::CSemanticContinuousMap"));
  EXPECT_THAT(run.output + run.errors, Not(HasSubstr("exception")));

  const std::regex part(R"(Part#\d+=((?: \d+)+))");
  std::size_t parts = 0;
  std::vector<int> members;
  for (std::sregex_iterator it(run.output.begin(), run.output.end(), part), end; it != end; ++it) {
    ++parts;
    std::istringstream numbers((*it)[1]);
    for (int number = 0; numbers >> number;) members.push_back(number);
  }
  std::sort(members.begin(), members.end());
  ASSERT_EQ(members.size(), framesOf(frames)) << run.output << run.errors;
  for (std::size_t i = 0; i < members.size(); ++i) EXPECT_EQ(members[i], static_cast<int>(i));
  EXPECT_GE(parts, 2u);
  EXPECT_LE(parts, members.size() / 3);
}

/// It aligns occupancy grids: ours may be beside them.
TEST(GridMatching, RunsWithASemanticMapBesideItsGrid) {
  const TempFolder folder;
  std::string ini = readBytes("/usr/share/mrpt/config_files/grid-matching/gridmatch_example.ini");
  const std::size_t at = ini.find("pointsMap_count=1");
  ASSERT_NE(at, std::string::npos);
  ini.insert(at, "semanticContinuousMap_count=1\n");
  // It leaves no map, and does not name it: that our map was made is told by what it complains of.
  ini += "\n[metric_maps_semanticContinuousMap_00_creationOpts]\nresolutoin=0.1\n";
  writeBytes(folder / "gm.ini", ini);
  const std::string frames = kDataSets + "localization_demo.simplemap.gz";
  const ProgramResult run =
      runStock(folder, {"grid-matching", "-m", "-c", "gm.ini", "-1", frames, "-2", frames,
                        "--out-dir", "results", "--aligner", "amModifiedRANSAC"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("resolutoin: unknown key"));
  EXPECT_THAT(run.output, HasSubstr("Overall estimation"));
  EXPECT_THAT(run.output + run.errors, Not(HasSubstr("exception")));
}

TEST(RbpfSlam, DrawsParticlesByAligningScansToTheSemanticMap) {
  const TempFolder folder;
  const ProgramResult run =
      runStock(folder, {"rbpf-slam", kConfigs + "rbpf-slam-optimal.ini",
                        kDataSets + "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"});
  ASSERT_EQ(run.exit_code, 0) << run.output.substr(0, 2000) << run.errors;
  const MapDocument document =
      loadMap(folder / "rbpf-slam-out/finalMap_csom__CSemanticPointsMap_00.csom");
  EXPECT_EQ(document.scans.size(), framesOf(folder / "rbpf-slam-out/_finalmap_.simplemap"));
  EXPECT_GT(document.scans.size(), 20u);
  EXPECT_GT(document.map.knownVoxelCount(), 1000u);
}

}  // namespace
}  // namespace csom::test
