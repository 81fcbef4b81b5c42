// SPDX-License-Identifier: BSD-3-Clause
// P3 and P7: a street, mapped from what a network says of some of its scans.
#pragma once

#include <csom/protocols/Trial.h>

#include <cstddef>
#include <string>
#include <vector>

namespace csom {

/// A scan in the map frame, with the true labels and with those of a network.
struct StreetScan {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the sensor
  std::vector<Eigen::Vector3d> points;
  std::vector<ClassId> labels;       ///< kFreeClass: unlabelled
  std::vector<ClassId> predictions;  ///< kFreeClass: unlabelled; empty: not read
  RangeImage image;                  ///< of all points; empty: not found, or no predictions read
};

struct Street {
  LabelSet labels = LabelSet::occupancy();
  std::vector<StreetScan> scans;
  std::vector<std::string> warnings;  ///< what was left out, one line each
};

/// True for a folder with a folder velodyne/.
bool isStreet(const std::string& folder);

/// Reads a sequence in the layout of SemanticKITTI: velodyne/*.bin, labels/*.label, if asked for
/// predictions/*.label, poses.txt and calib.txt; the map frame is that of poses.txt. Labels that
/// the label set does not know are not used and warned of. Throws FileError.
Street readStreet(const std::string& folder, const LabelSet& labels, bool predictions = true);

/// The points of all scans with their true labels.
LabelledCloud labelledPoints(const Street& street);

/// Maps the scans 0, `every`, 2·`every` … with the network's labels, down-sampled to `density` [m];
/// the truth are the labels of all scans.
std::vector<Trial> streetTrials(const Street& street, std::size_t every, double density,
                                double resolution);

/// The range up to which P7 judges what beams tell [m].
constexpr double kJudgedRange = 50;

/// P7: maps the first and the last scan with the network's labels, and judges the voxels of which
/// all scans together know what they are: see computeStreetTruth().
std::vector<Trial> knownStreetTrials(const Street& street, double density, double resolution);

/// What the points within kJudgedRange of their sensor tell. A voxel that holds labelled ones is
/// occupied by their majority class; one without any point, in which at least two samples of beams
/// lie, is free; all others are left out. Beams are sampled every 0.8 voxels from 1.5 m up to one
/// voxel before their point. Throws std::invalid_argument if there is no labelled point.
VoxelTruth computeStreetTruth(const Street& street, double resolution);

/// The network's own labels against the truth, of all scans: what a map must beat.
PointScore scoreOfPredictions(const Street& street);

}  // namespace csom
