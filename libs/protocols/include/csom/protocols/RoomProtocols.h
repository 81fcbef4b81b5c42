// SPDX-License-Identifier: BSD-3-Clause
// P1, P2 and P6: a room of which there are labelled clouds, without places to have seen it from.
#pragma once

#include <csom/protocols/Trial.h>

#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// The clouds of a room, one an object or a scan.
struct Room {
  LabelSet labels = LabelSet::occupancy();
  std::vector<LabelledCloud> clouds;
  std::vector<std::string> warnings;  ///< what was left out, one line each
};

/// True for a folder with *.pcd files.
bool isRoom(const std::string& folder);

/// Reads all *.pcd files of a folder, in natural order. Rows that are no points are left out;
/// labels that the label set does not know are not used. Both are warned of. Throws FileError.
Room readRoom(const std::string& folder, const LabelSet& labels);

/// The points of all clouds.
LabelledCloud labelledPoints(const Room& room);

/// P1: all clouds as one scan, at each of these densities [m].
std::vector<Trial> roomDensityTrials(const Room& room, const std::vector<double>& densities,
                                     double resolution);

/// P2: the same, a scan a cloud.
std::vector<Trial> roomObjectTrials(const Room& room, const std::vector<double>& densities,
                                    double resolution);

struct RepetitionOptions {
  std::size_t scans = 50;
  double share = 0.1;   ///< of the points that a scan holds, chosen at random
  double sigma = 0.01;  ///< of each coordinate [m]
  std::uint64_t seed = 1;
  std::vector<std::size_t> checkpoints{1, 5, 10, 25, 50};
};

/// P6: the same room again and again, never the same points.
std::vector<Trial> roomRepetitionTrials(const Room& room, double density, double resolution,
                                        const RepetitionOptions& options = {});

}  // namespace csom
