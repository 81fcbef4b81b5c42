// SPDX-License-Identifier: BSD-3-Clause
// What the tests of csom::io share: a small map and its document.
#pragma once

#include <csom/core/Error.h>
#include <csom/io/MapFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "TestFiles.h"

namespace csom::test {

/// The bytes of a number, little-endian as the machine's.
template <class Number>
std::string bytesOf(Number number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

inline LabelSet sampleLabels() {
  return LabelSet::fromYaml(
      "name: sample\n"
      "classes:\n"
      "  - {id: 0, name: free, color: [255, 255, 255]}\n"
      "  - {id: 1, name: road, color: [10, 20, 30]}\n"
      "  - {id: 2, name: \"wall, brick\", color: [200, 0, 7]}\n",
      "sample");
}

/// A map with occupied voxels of two classes, free ones, and negative indices.
inline SemanticMap sampleMap() {
  Options options;
  options.number_of_classes = 3;
  options.method = Method::SeeCsom;
  options.resolution = 0.25;
  options.free_space.mode = FreeSpace::Sampled;
  SemanticMap map(options);
  Scan scan;
  scan.origin = {0.1, -0.2, 1.0};
  for (int i = -20; i < 20; ++i) {
    scan.points.emplace_back(3.0F, 0.3F * static_cast<float>(i), -0.9F);
    scan.labels.push_back(i % 3 == 0 ? 2 : 1);
  }
  map.insert(scan);
  return map;
}

inline MapDocument sampleDocument() {
  MapDocument document;
  document.map = sampleMap();
  document.labels = sampleLabels();
  document.meta = {{"created_by", "a test"}, {"rawlog", "dir/ä b.rawlog"}};
  for (int i = 0; i < 3; ++i) {
    ScanRecord scan;
    scan.timestamp = 1e9 + 0.1 * i;
    scan.sensor_label = "LIDAR'" + std::to_string(i);
    scan.observation_class = "CObservationPointCloud";
    scan.origin = {1.5, -2.25, 0.1 * i};
    scan.report.points = 40;
    scan.report.rejected[1] = 7;
    scan.report.training_points = 33;
    scan.report.free_points = 5;
    scan.report.free_voxels = 6;
    scan.report.blocks_observed = 8;
    scan.report.blocks_filled = 9;
    scan.report.voxels_updated = 10;
    scan.report.prepare_ms = 0.125;
    scan.report.infer_ms = 1.0 / 3;
    scan.report.commit_ms = 2;
    document.scans.push_back(scan);
  }
  return document;
}

}  // namespace csom::test
