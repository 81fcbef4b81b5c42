// SPDX-License-Identifier: BSD-3-Clause
// Small maps, voxel by voxel, and a run record for the tests of csom::report.
#pragma once

#include <csom/report/RunRecord.h>

#include <string>
#include <utility>
#include <vector>

namespace csom::test {

struct LabelledVoxel {
  VoxelIndex voxel;
  ClassId class_id;
};

/// Five classes: free, red ground, green tree, blue wall, white ceiling.
inline LabelSet sampleLabels() {
  return LabelSet::fromYaml(R"(
name: sample
classes:
  - {id: 0, name: free, color: [255, 255, 255]}
  - {id: 1, name: ground, color: [200, 0, 0]}
  - {id: 2, name: tree, color: [0, 200, 0]}
  - {id: 3, name: wall, color: [0, 0, 200]}
  - {id: 4, name: ceiling, color: [200, 200, 0]}
)",
                            "sample labels");
}

/// Exactly these voxels, each hit once; class 0 makes a voxel free.
inline MapDocument mapOf(const std::vector<LabelledVoxel>& voxels, double resolution = 1.0,
                         LabelSet labels = sampleLabels()) {
  Options options;
  options.method = Method::SCsm;
  options.resolution = resolution;
  options.number_of_classes = labels.numberOfClasses();
  MapDocument document{SemanticMap(options), std::move(labels), {}, {}};
  for (const LabelledVoxel& v : voxels) {
    Scan scan;
    scan.origin = document.map.grid().center(v.voxel);
    scan.points = {Eigen::Vector3f::Zero()};
    scan.labels = {v.class_id};
    document.map.insert(scan);
  }
  return document;
}

/// Two scans with rejects, refused observations and warnings.
inline RunRecord sampleRecord() {
  RunRecord record;
  record.program_version = "1.2.3";
  record.command = "csom map 'my drive.rawlog' -o out";
  record.inputs = {"data/my drive.rawlog"};
  record.config_file = "config/drive.ini";
  record.parameters = parametersOf(Options{});
  record.pose_source = "robot-pose:GT";
  record.label_set = "sample";
  record.observations_read = 7;
  record.wall_seconds = 12.34;
  record.refused = {{"CObservationGPS", "no range data", 5}};
  record.warnings = {"config/drive.ini: [map]: unknown key 'resolutoin'"};
  for (const double insert_ms : {10.0, 30.0}) {
    RunScan scan;
    scan.record.timestamp = 1700000000.125;
    scan.record.sensor_label = "velodyne";
    scan.record.observation_class = "CObservationVelodyneScan";
    scan.record.origin = {1, 2, 3};
    scan.record.report.points = 1000;
    scan.record.report.rejected[static_cast<std::size_t>(RejectReason::TooFar)] = 25;
    scan.record.report.prepare_ms = 2;
    scan.record.report.infer_ms = 5;
    scan.record.report.commit_ms = 1;
    scan.insert_ms = insert_ms;
    record.scans.push_back(scan);
  }
  return record;
}

}  // namespace csom::test
