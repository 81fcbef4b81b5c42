// SPDX-License-Identifier: BSD-3-Clause
// MRPT's rbpf-slam finds a drive through the campus although odometry is poor.
#include <Eigen/Core>
#include <cmath>
#include <iostream>

#include "apps/RunMrpt.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

const std::string kConfig = CSOM_SOURCE_DIR "/config/mrpt/rbpf-slam-campus.ini";
const std::string kWorld = CSOM_SOURCE_DIR "/config/worlds/campus.yaml";

using Path = std::vector<Eigen::Vector2d>;

/// The campus with odometry that drifts three times as fast, and without its camera.
std::string noisyWorld() {
  std::string world = readBytes(kWorld);
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = world.find(from);
    if (at == std::string::npos) throw std::runtime_error("not found: " + from);
    world.replace(at, from.size(), to);
  };
  replace("translation_per_metre: 0.02", "translation_per_metre: 0.05");
  replace("rotation_per_metre: 0.15", "rotation_per_metre: 0.5");
  const std::size_t camera = world.find("  - type: camera");
  return world.erase(camera, world.find("\nsolids:") - camera);
}

/// Columns `x` and x + 1 of a file of numbers, comments left out, from line `first` on.
Path readPath(const std::string& file, std::size_t x, std::size_t first = 0) {
  std::ifstream lines(file);
  Path path;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '%' || line[0] == '#') continue;
    std::istringstream numbers(line);
    std::vector<double> row;
    for (double number = 0; numbers >> number;) row.push_back(number);
    if (row.size() < x + 2) throw std::runtime_error(file + ": too few columns: " + line);
    path.emplace_back(row[x], row[x + 1]);
  }
  if (path.size() <= first) throw std::runtime_error(file + " is empty");
  path.erase(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(first));
  return path;
}

/// Root mean square of the distances of places at the same time, from the first one on.
double error(const Path& path, const Path& truth) {
  EXPECT_EQ(path.size(), truth.size());
  double squares = 0;
  for (std::size_t i = 0; i < std::min(path.size(), truth.size()); ++i)
    squares += (path[i] - (truth[i] - truth[0])).squaredNorm();
  return std::sqrt(squares / static_cast<double>(path.size()));
}

TEST(RbpfSlam, TheBestParticleDrivesNearerToTheTruthThanOdometry) {
  const TempFolder folder;
  writeBytes(folder / "noisy.yaml", noisyWorld());
  const ProgramResult simulation =
      runCsom(folder.path(), {"simulate", folder / "noisy.yaml", "-o", folder / "noisy.rawlog",
                              "--trajectory", folder / "truth.tum"});
  ASSERT_EQ(simulation.exit_code, 0) << simulation.errors;
  std::string ini = readBytes(kConfig);
  ini.insert(ini.find("[MappingApplication]") + 21, "RANDOM_SEED = 1\n");
  writeBytes(folder / "rbpf.ini", ini);
  const ProgramResult run = runMrpt(folder.path(), {"rbpf-slam", "rbpf.ini", "noisy.rawlog"}, 200);
  ASSERT_EQ(run.exit_code, 0) << run.output.substr(0, 2000) << run.errors;

  const Path truth = readPath(folder / "truth.tum", 1);
  const double odometry = error(readPath(folder / "rbpf-slam-out/log_odometry_path.txt", 1), truth);
  // The path begins with the place before the first frame.
  const double best = error(readPath(folder / "rbpf-slam-out/most_likely_path.txt", 0, 1), truth);
  std::cout << "path error: odometry " << odometry << " m, best particle " << best << " m\n";
  EXPECT_GT(odometry, 1) << "it drifts";
  EXPECT_LT(best, 0.6 * odometry);
  const MapDocument document =
      loadMap(folder / "rbpf-slam-out/finalMap_csom__CSemanticContinuousMap_00.csom");
  EXPECT_GT(document.scans.size(), 20u);
  EXPECT_GT(document.map.knownVoxelCount(), 10000u);
}

}  // namespace
}  // namespace csom::test
