// SPDX-License-Identifier: BSD-3-Clause
// Small maps, voxel by voxel, and parts of a run record for the tests of csom::report.
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
  record.parameters = toParameters(Options{});
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

/// Two cameras, points of every fate.
inline CameraStatistics sampleCameraLabels() {
  CameraStatistics labels;
  labels.cameras = {{"left", "network", {20, 15, 12, 3, 1}, {}},
                    {"right", "label_image", {10, 9, 0, 0, 0}, {}}};
  labels.scans = {18, 4, 1};
  labels.points.labelled = 6000;
  labels.points.outside_view = 10'000;
  labels.points.hidden = 1000;
  labels.points.at_edge = 500;
  labels.points.low_confidence = 250;
  labels.points.ignored = 200;
  labels.points.unknown = 50;
  labels.seconds = {10, 0.5, 1.5};
  return labels;
}

inline CameraPicture samplePicture(CameraPicture::Moment moment, const std::string& camera) {
  CameraPicture picture;
  picture.moment = moment;
  picture.sensor_label = camera;
  picture.timestamp = 1700000000.25;
  picture.frame = 7;
  picture.segmentation = {'s', 'e', 'g'};
  picture.points = {'d', 'o', 't', 's'};
  picture.classes = {1, 3};
  return picture;
}

}  // namespace csom::test
