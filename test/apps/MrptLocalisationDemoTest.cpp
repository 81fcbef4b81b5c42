// SPDX-License-Identifier: BSD-3-Clause
// MRPT's example of localisation, with the semantic map and with MRPT's own occupancy grid.
//
// pf-localization seeds its random numbers by the clock, so several runs are compared by their
// medians. CSOM_LOCALISATION_RUNS=20 makes as many runs with each map; seven are usual.
#include <mrpt/maps/CSimpleMap.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <regex>

#include "apps/RunMrpt.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

const std::string kConfig = CSOM_SOURCE_DIR "/config/mrpt/pf-localization-demo.ini";

/// Where the drive ends, as MRPT's own test of this example has it [m].
constexpr double kTrueX = 15.89;
constexpr double kTrueY = -10.0;

int numberOfRuns() {
  const char* const asked = std::getenv("CSOM_LOCALISATION_RUNS");
  return asked == nullptr ? 7 : std::stoi(asked);
}

/// The same ini with MRPT's occupancy grid instead, and the options that MRPT's example gives it.
std::string withStockGrid(const std::string& ini) {
  const std::size_t at = ini.find("semanticContinuousMap_count = 1");
  if (at == std::string::npos) throw std::runtime_error("no semanticContinuousMap in the ini");
  return ini.substr(0, at) +
         "occupancyGrid_count = 1\n[MetricMap_occupancyGrid_00_creationOpts]\nresolution = 0.06\n"
         "[MetricMap_occupancyGrid_00_insertOpts]\nmaxDistanceInsertion = 15\n"
         "maxOccupancyUpdateCertainty = 0.55\nconsiderInvalidRangesAsFreeSpace = 1\n"
         "[MetricMap_occupancyGrid_00_likelihoodOpts]\nlikelihoodMethod = 4\nLF_decimation = 20\n"
         "LF_stdHit = 0.20\nLF_maxCorrsDistance = 0.30\nLF_zHit = 0.95\nLF_zRandom = 0.05\n"
         "LF_maxRange = 80\nLF_alternateAverageMethod = 0\n";
}

/// Distance of the last estimate from the true end of the drive [m].
double finalError(const TempFolder& folder, const std::string& ini) {
  const ProgramResult run = runMrpt(folder.path(), {"pf-localization", ini});
  if (run.exit_code != 0) throw std::runtime_error(run.output + run.errors);
  const std::regex line(R"(PDF estimation: \(([-\d.]+),([-\d.]+),)");
  double error = 0;
  int steps = 0;
  for (std::sregex_iterator it(run.output.begin(), run.output.end(), line), end; it != end; ++it) {
    error = std::hypot(std::stod((*it)[1]) - kTrueX, std::stod((*it)[2]) - kTrueY);
    ++steps;
  }
  if (steps != 37) throw std::runtime_error("it did not go through all frames: " + run.output);
  return error;
}

/// Median of the final errors of several runs; a run that is lost counts as well.
double medianError(const TempFolder& folder, const std::string& name, const std::string& ini) {
  writeBytes(folder / "l.ini", ini);
  std::vector<double> errors;
  for (int run = 0; run < numberOfRuns(); ++run) errors.push_back(finalError(folder, "l.ini"));
  std::sort(errors.begin(), errors.end());
  const auto lost = errors.end() - std::upper_bound(errors.begin(), errors.end(), 1.0);
  const double median = errors[errors.size() / 2];
  std::cout << name << ": median error " << median << " m, " << lost << " of " << errors.size()
            << " runs lost\n";
  return median;
}

TEST(LocalisationDemo, EndsAsNearAsWithTheStockGrid) {
  const std::string ini = readBytes(kConfig);
  const TempFolder stock_folder;
  const double stock = medianError(stock_folder, "occupancyGrid", withStockGrid(ini));
  const TempFolder folder;
  const double ours = medianError(folder, "semanticContinuousMap", ini);
  // A tenth more, and what chance does to the medians of so few runs: less than half a voxel.
  EXPECT_LT(ours, 1.1 * stock + 0.025);
  EXPECT_LT(ours, 0.1);

  // It saves the map that it has made of all frames.
  mrpt::maps::CSimpleMap frames;
  ASSERT_TRUE(frames.loadFromFile("/usr/share/mrpt/datasets/localization_demo.simplemap.gz"));
  const MapDocument document =
      loadMap(folder / "LOCALIZATION_000_0040000/map_csom__CSemanticContinuousMap_00.csom");
  EXPECT_EQ(document.scans.size(), frames.size());
}

}  // namespace
}  // namespace csom::test
