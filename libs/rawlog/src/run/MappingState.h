// SPDX-License-Identifier: BSD-3-Clause
// Where a mapping run stands, as texts and bytes in the file of the map.
#pragma once

#include <csom/io/MapStore.h>
#include <csom/rawlog/MappingRun.h>

#include <Eigen/Core>
#include <cstddef>
#include <string>

namespace csom::detail {

/// What a run has counted, beside what the map object itself knows.
struct MappingState {
  std::size_t log = 0;      ///< number of the log at hand, from 0
  std::size_t entries = 0;  ///< of it that are done
  std::size_t observations_read = 0;
  std::size_t observations_refused = 0;
  std::size_t points_rejected = 0;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  Eigen::Vector3d farthest = Eigen::Vector3d::Zero();  ///< the robot's largest coordinate [m]
  std::optional<DeskewStatistics> deskew;
  std::vector<double> insert_ms;
  std::map<std::pair<std::string, std::string>, std::size_t> refused;
};

void write(const MappingState& state, MapStore::State& out);
/// Throws FileError, about `file`.
MappingState readMappingState(const MapStore::State& in, const std::string& file);

/// The map without its voxels and scans: options, statistics, and what waits for images.
std::string bytesOf(const CSemanticContinuousMap& map);
CSemanticContinuousMap::Ptr mapFromBytes(const std::string& bytes, const std::string& file);

void write(const MappingRequest& request, MapStore::State& out);

/// `input.N.kind` of the logs, whose scans are in the map.
constexpr char kLogInput[] = "log";

/// Files that a run reads, those of its networks included, with their sizes and hashes:
/// `input.N.file` … Throws FileError.
void writeInputs(const MappingRequest& request, const LabelOptions& labels, MapStore::State& out);
/// Throws FileError if one of them is not as it was.
void requireSameInputs(const MapStore::State& in, const MapStore::State& now,
                       const std::string& file);

}  // namespace csom::detail
