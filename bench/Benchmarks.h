// SPDX-License-Identifier: BSD-3-Clause
// What csom-bench measures, a function a file. Scans must outlive the benchmarks.
#pragma once

#include <cstddef>
#include <vector>

#include "Scans.h"

namespace csom::bench {

/// insert/…: whole scans into a map, with the stages' times.
void registerInsertions(const std::vector<Scan>& scans);
/// points/…: one scan of ever more points, at most `most_points`.
void registerGrowth(const std::vector<Scan>& scans, std::size_t most_points);
/// floor/…: what no mapper that looks at every point can do without.
void registerFloor(const std::vector<SensorScan>& sensor_scans, const std::vector<Scan>& scans);
/// octomap: OctoMap's insertPointCloud().
void registerOctoMap(const std::vector<Scan>& scans);
/// query/…: questions to a map.
void registerQueries(const std::vector<Scan>& scans);
/// copy/…: copies of a map.
void registerCopies(const std::vector<Scan>& scans);

}  // namespace csom::bench
