// SPDX-License-Identifier: BSD-3-Clause
// From the images of the simulated drive through its network to labelled scans.
#include <csom/core/Error.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/PoseRounding.h>
#include <gmock/gmock.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CRawlog.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "CameraLabelledAdapter.h"

namespace csom {
namespace {

using testing::HasSubstr;
using Definition = CSemanticContinuousMap::TMapDefinition;

Definition campusDefinition() {
  return CSemanticContinuousMap::definitionFromIni(CSOM_SOURCE_DIR "/config/campus-camera.ini");
}

/// The first three frames of the drive.
std::vector<mrpt::obs::CObservation::Ptr> campusObservations() {
  mrpt::obs::CRawlog log;
  const std::string file = CSOM_SOURCE_DIR "/rawlogs/campus.rawlog";
  if (!log.loadFromRawLogFile(file)) throw std::runtime_error(file + " cannot be read");
  std::vector<mrpt::obs::CObservation::Ptr> observations;
  std::size_t frames = 0;
  for (std::size_t i = 0; i < log.size() && frames < 3; ++i) {
    if (log.getType(i) != mrpt::obs::CRawlog::etSensoryFrame) continue;
    const auto frame = log.getAsObservations(i);
    observations.insert(observations.end(), frame->begin(), frame->end());
    ++frames;
  }
  return observations;
}

struct Labelled {
  std::vector<AdaptedScan> scans;
  CameraStatistics statistics;
};

Labelled label(const Definition& definition) {
  CameraLabelledAdapter adapter(definition.labelOpts, definition.labels);
  const LabelRules rules(definition.labels, PointLabels::None, "drop", "drop");
  Labelled labelled;
  for (const auto& observation : campusObservations()) {
    const auto scans = adapter.adapt(*observation, roundedPose({}), rules);
    if (scans) labelled.scans.insert(labelled.scans.end(), scans->begin(), scans->end());
  }
  for (AdaptedScan& scan : adapter.flush()) labelled.scans.push_back(std::move(scan));
  labelled.statistics = *adapter.cameraStatistics();
  return labelled;
}

TEST(CameraNetwork, LabelsPointsInView) {
  const Labelled labelled = label(campusDefinition());
  ASSERT_EQ(labelled.scans.size(), 3U);
  EXPECT_EQ(labelled.statistics.cameras.at(0).images.network_runs, 3U);
  EXPECT_GT(labelled.statistics.seconds.network, 0);
  for (const AdaptedScan& scan : labelled.scans) {
    EXPECT_GT(scan.scan.points.size(), 1000U);
    const std::set<ClassId> classes(scan.scan.labels.begin(), scan.scan.labels.end());
    EXPECT_GT(classes.size(), 3U);
    EXPECT_EQ(classes.count(kFreeClass), 0U) << "the sky is no class of a point";
  }
}

TEST(CameraNetwork, SoftLabelsAreDistributionsWhoseBestClassIsTheHardLabel) {
  Definition definition = campusDefinition();
  const Labelled hard = label(definition);
  definition.labelOpts.points.label_mode = PointLabellingOptions::LabelMode::Soft;
  definition.labelOpts.points.temperature = 2;
  const Labelled soft = label(definition);
  ASSERT_EQ(soft.scans.size(), hard.scans.size());
  const auto classes = static_cast<std::ptrdiff_t>(definition.labels.numberOfClasses());
  for (std::size_t i = 0; i < soft.scans.size(); ++i) {
    const Scan& scan = soft.scans[i].scan;
    ASSERT_EQ(scan.points.size(), hard.scans[i].scan.points.size());
    ASSERT_EQ(scan.scores.size(), scan.points.size() * static_cast<std::size_t>(classes));
    EXPECT_TRUE(scan.labels.empty());
    std::size_t unsure = 0;
    for (std::size_t p = 0; p < scan.points.size(); ++p) {
      const auto row = scan.scores.begin() + static_cast<std::ptrdiff_t>(p) * classes;
      float sum = 0;
      for (auto score = row; score != row + classes; ++score) sum += *score;
      ASSERT_NEAR(sum, 1, 1e-4);
      const auto best = std::max_element(row, row + classes);
      ASSERT_EQ(best - row, hard.scans[i].scan.labels[p]);
      unsure += *best < 0.9F ? 1 : 0;
    }
    EXPECT_GT(unsure, 0U);
    EXPECT_LT(unsure, scan.points.size());
  }
}

TEST(CameraNetwork, UnsurePointsAreDroppedOrKeptAsDistributions) {
  Definition definition = campusDefinition();
  definition.labelOpts.points.min_confidence = 0.9;
  const Labelled dropped = label(definition);
  const auto low = dropped.statistics.points.low_confidence;
  EXPECT_GT(low, 0U);
  definition.labelOpts.points.low_confidence = PointLabellingOptions::LowConfidence::Soft;
  const Labelled kept = label(definition);
  std::size_t points_dropped = 0;
  std::size_t points_kept = 0;
  for (const AdaptedScan& scan : dropped.scans) points_dropped += scan.scan.points.size();
  for (const AdaptedScan& scan : kept.scans) points_kept += scan.scan.points.size();
  EXPECT_EQ(points_kept, points_dropped + low);
}

TEST(CameraNetwork, ACachedRunNeedsNoNetworkAndGivesTheSameScans) {
  const std::filesystem::path cache =
      std::filesystem::path(testing::TempDir()) / "csom_camera_network_cache";
  std::filesystem::remove_all(cache);
  Definition definition = campusDefinition();
  const Labelled plain = label(definition);
  definition.labelOpts.label_cache = cache.string();
  const Labelled first = label(definition);
  const Labelled second = label(definition);
  EXPECT_EQ(first.statistics.cameras[0].images.network_runs, 3U);
  EXPECT_EQ(second.statistics.cameras[0].images.network_runs, 0U);
  EXPECT_EQ(second.statistics.cameras[0].images.from_cache, 3U);
  for (std::size_t i = 0; i < plain.scans.size(); ++i) {
    EXPECT_EQ(first.scans[i].scan.labels, plain.scans[i].scan.labels);
    EXPECT_EQ(second.scans[i].scan.labels, plain.scans[i].scan.labels);
    EXPECT_EQ(second.scans[i].scan.points, plain.scans[i].scan.points);
  }
}

TEST(CameraNetwork, WhatIsWrongWithItIsSaidBeforeTheFirstImage) {
  Definition definition = campusDefinition();
  definition.labelOpts.sources[0].model = "/nowhere/model.onnx";
  CSemanticContinuousMap map(definition);
  try {
    map.openLabelSources();
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/model.onnx"));
  }

  // The classes of the network are not those of another label set.
  Definition other = campusDefinition();
  EXPECT_THROW(CameraLabelledAdapter(other.labelOpts, LabelSet::occupancy()), ConfigError);
}

}  // namespace
}  // namespace csom
