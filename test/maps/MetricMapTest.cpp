// SPDX-License-Identifier: BSD-3-Clause
// The map behaves as MRPT expects of a metric map.
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/ObservationAdapter.h>
#include <csom/maps/PoseRounding.h>
#include <gmock/gmock.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/system/CObserver.h>

#include <filesystem>
#include <limits>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::maps::CMultiMetricMap;
using mrpt::poses::CPose3D;
using sample::laserScan;
using sample::pointCloud;
using sample::roomCloud;
using sample::roomMap;
using sample::sampleMap;

static_assert(std::is_copy_constructible_v<CSemanticContinuousMap>);
static_assert(std::is_copy_assignable_v<CSemanticContinuousMap>);

TEST(MetricMap, IsCreatedByItsNames) {
  for (const char* name :
       {"csom::CSemanticContinuousMap", "CSemanticContinuousMap", "semanticContinuousMap"}) {
    const std::unique_ptr<mrpt::maps::TMetricMapInitializer> definition(
        mrpt::maps::TMetricMapInitializer::factory(name));
    EXPECT_NE(dynamic_cast<CSemanticContinuousMap::TMapDefinition*>(definition.get()), nullptr)
        << name;
  }
  const mrpt::rtti::CObject::Ptr object = mrpt::rtti::classFactory("csom::CSemanticContinuousMap");
  EXPECT_NE(dynamic_cast<CSemanticContinuousMap*>(object.get()), nullptr);
}

TEST(MetricMap, StartsEmpty) {
  const CSemanticContinuousMap map;
  EXPECT_TRUE(map.isEmpty());
  EXPECT_TRUE(map.scans().empty());
  EXPECT_EQ(map.labels().numberOfClasses(), 2);
  EXPECT_TRUE(map.getAsSimplePointsMap()->empty());
}

TEST(MetricMap, InsertsWhereThePointsAre) {
  CSemanticContinuousMap map = sampleMap();
  auto observation = pointCloud({{1.5f, 0, 0}}, {40});
  ASSERT_TRUE(map.insertObservation(*observation, CPose3D(10, 0, 0, M_PI / 2, 0, 0)));
  const DirichletVoxel voxel = map.map().at({10.05, 1.55, 0.05});
  EXPECT_EQ(voxel.state(), VoxelState::Occupied);
  EXPECT_EQ(voxel.mostLikelyClass(), 1);
  EXPECT_EQ(map.map().at({12, 1.5, 0}).state(), VoxelState::Unknown);
}

TEST(MetricMap, RecordsEveryInsertedObservation) {
  CSemanticContinuousMap map = sampleMap();
  map.insertObservation(*pointCloud({{1, 0, 0}, {2, 0, 0}}, {40, 77}), CPose3D(1, 2, 3, 0, 0, 0));
  ASSERT_EQ(map.scans().size(), 1u);
  const ScanRecord& record = map.scans()[0];
  EXPECT_DOUBLE_EQ(record.timestamp, 1500000000.25);
  EXPECT_EQ(record.sensor_label, "cloud");
  EXPECT_EQ(record.observation_class, "CObservationPointCloud");
  EXPECT_THAT(record.origin, testing::ElementsAre(1, 2, 3));
  EXPECT_EQ(record.report.points, 2u) << "what cannot be labelled is an obstacle all the same";
  EXPECT_EQ(map.statistics().labels.kept_unknown, 1u);
  EXPECT_EQ(map.document().meta.at("points_with_unknown_label_kept_unlabelled"), "1");
}

TEST(MetricMap, WhatHasNoUsableLabelIsRejectedByNameIfItIsNotKept) {
  CSemanticContinuousMap map = sampleMap();
  map.insertionOptions.unlabelled_class = "drop";
  auto observation = pointCloud({{1, 0, 0}, {2, 0, 0}, {0, 0, 0}}, {40, 77, 40});
  map.insertObservation(*observation);
  EXPECT_EQ(map.scans().at(0).report.points, 1u);
  EXPECT_EQ(map.statistics().labels.unknown, 1u);
  EXPECT_EQ(map.document().meta.at("points_with_unknown_label_dropped"), "1");
  EXPECT_EQ(map.document().meta.at("beams_without_return"), "1");
}

TEST(MetricMap, B9_aScanThatCannotBeInsertedIsRefusedAndNotThrown) {
  Options options;
  options.resolution = 0.064;
  options.free_space.mode = FreeSpace::Sampled;
  options.free_space.resolution = 0.001;  // 2^27 free samples are soon reached
  CSemanticContinuousMap map(options, sample::sampleLabels());
  map.insertionOptions.point_labels = PointLabels::ByIntensity;
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20000; ++i) points.emplace_back(7.9f, 0.0001f * static_cast<float>(i), 0.0f);
  map.warn_of_damaged = false;
  EXPECT_FALSE(
      map.insertObservation(*pointCloud(points, std::vector<float>(points.size(), 40.0f))));
  EXPECT_EQ(map.lastInsertion().outcome, LastInsertion::Outcome::Damaged);
  EXPECT_THAT(map.lastInsertion().reason, testing::HasSubstr("free samples"));
  EXPECT_EQ(map.statistics().damaged.at("CObservationPointCloud"), 1u);
  EXPECT_TRUE(map.insertObservation(*pointCloud({{1, 0, 0}}, {40}))) << "the next one is";
}

TEST(MetricMap, RefusesWhatItCannotUseWithoutThrowing) {
  CSemanticContinuousMap map = sampleMap();
  EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservationOdometry()));
  EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservationPointCloud()));
  EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservationPointCloud()));
  EXPECT_FALSE(map.insertObservation(*laserScan(0)));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(map.insertObservation(*pointCloud({{nan, 0, 0}}, {40})));
  CPose3D nowhere;
  nowhere.x(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(map.insertObservation(*roomCloud(), nowhere));

  EXPECT_TRUE(map.isEmpty());
  EXPECT_TRUE(map.scans().empty());
  const InsertionStatistics& statistics = map.statistics();
  EXPECT_EQ(statistics.not_taken.at("CObservationOdometry"), 1u);
  EXPECT_EQ(statistics.damaged.at("CObservationPointCloud"), 3u);
  EXPECT_EQ(statistics.why_damaged.at("CObservationPointCloud"), "it has no point cloud");
  EXPECT_EQ(statistics.without_points, 2u);
}

TEST(MetricMap, TellsWhatBecameOfTheLastObservation) {
  using Outcome = LastInsertion::Outcome;
  CSemanticContinuousMap map = sampleMap();
  map.warn_of_damaged = false;
  map.insertObservation(*roomCloud());
  EXPECT_EQ(map.lastInsertion().outcome, Outcome::Inserted);
  map.insertObservation(mrpt::obs::CObservationOdometry());
  EXPECT_EQ(map.lastInsertion().outcome, Outcome::NotTaken);
  map.insertObservation(*laserScan(0));
  EXPECT_EQ(map.lastInsertion().outcome, Outcome::NoPoints);
  map.insertObservation(mrpt::obs::CObservationPointCloud());
  EXPECT_EQ(map.lastInsertion().outcome, Outcome::Damaged);
  EXPECT_EQ(map.lastInsertion().reason, "it has no point cloud");

  CPose3D nowhere;
  nowhere.x(std::numeric_limits<double>::infinity());
  map.insertObservation(*roomCloud(), nowhere);
  EXPECT_EQ(map.lastInsertion().outcome, Outcome::Damaged);
  EXPECT_NE(map.lastInsertion().reason, "it has no point cloud") << "that was another one";

  map.genericMapParams.enableObservationInsertion = false;
  map.insertObservation(*roomCloud());
  EXPECT_EQ(map.lastInsertion().outcome, Outcome::Disabled);
}

TEST(MetricMap, EqualsADirectLoopOverTheCore) {
  CSemanticContinuousMap map = sampleMap();
  SemanticMap direct(map.map().options());
  const LabelSet labels = sample::sampleLabels();
  const LabelRules rules(labels, PointLabels::ByIntensity, "", "");
  SelfLabelledAdapter adapter;
  for (int i = 0; i < 5; ++i) {
    const CPose3D pose(0.3 * i, -0.1 * i, 0.01 * i, 0.4 * i, 0.02 * i, -0.03 * i);
    map.insertObservation(*roomCloud(), pose);
    direct.insert(adapter.adapt(*roomCloud(), roundedPose(pose), rules)->front().scan);
  }
  EXPECT_EQ(mapDigest(map.map()), mapDigest(direct));
}

TEST(MetricMap, SimpleMapGivesTheSameMap) {
  CSemanticContinuousMap direct = sampleMap();
  mrpt::maps::CSimpleMap keyframes;
  for (int i = 0; i < 5; ++i) {
    const CPose3D pose(0.3 * i, -0.1 * i, 0.01 * i, 0.4 * i, 0.02 * i, -0.03 * i);
    direct.insertObservation(*roomCloud(), pose);
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(roomCloud());
    keyframes.insert(mrpt::poses::CPose3DPDFGaussian::Create(pose), frame);
  }
  const std::string file = testing::TempDir() + "csom_metric_map_test.simplemap";
  ASSERT_TRUE(keyframes.saveToFile(file));
  mrpt::maps::CSimpleMap loaded;
  ASSERT_TRUE(loaded.loadFromFile(file));

  CSemanticContinuousMap map = sampleMap();
  map.insertObservation(*laserScan());  // erased by loading
  map.loadFromSimpleMap(loaded);
  EXPECT_EQ(map.scans().size(), 5u);
  EXPECT_EQ(mapDigest(map.map()), mapDigest(direct.map()));
}

TEST(MetricMap, ClearEmptiesIt) {
  CSemanticContinuousMap map = roomMap();
  ASSERT_FALSE(map.isEmpty());
  map.clear();
  EXPECT_TRUE(map.isEmpty());
  EXPECT_TRUE(map.scans().empty());
  EXPECT_TRUE(map.getAsSimplePointsMap()->empty());
  EXPECT_TRUE(map.insertObservation(*roomCloud()));
}

TEST(MetricMap, CopiesAreIndependent) {
  CSemanticContinuousMap map = roomMap();
  const std::string before = mapDigest(map.map());
  const CSemanticContinuousMap copy = map;
  map.insertObservation(*roomCloud(), CPose3D(1, 0, 0, 0, 0, 0));
  EXPECT_EQ(mapDigest(copy.map()), before);
  EXPECT_EQ(copy.scans().size(), 1u);
  EXPECT_NE(mapDigest(map.map()), before);
  map = copy;
  EXPECT_EQ(mapDigest(map.map()), before);
  EXPECT_EQ(map.getAsSimplePointsMap()->size(), copy.getAsSimplePointsMap()->size());
}

TEST(MetricMap, DocumentRoundTrip) {
  const CSemanticContinuousMap map = roomMap();
  CSemanticContinuousMap other;
  other.setDocument(map.document());
  EXPECT_EQ(mapDigest(other.map()), mapDigest(map.map()));
  EXPECT_EQ(other.labels().name(), "sample");
  EXPECT_EQ(other.scans().size(), 1u);
  EXPECT_EQ(other.statistics().inserted, 1u);

  // Counts go on from those of the document.
  const auto insert_faults = [](CSemanticContinuousMap& into) {
    into.warn_of_damaged = false;
    into.insertObservation(*pointCloud({{1, 0, 0}, {2, 0, 0}}, {40, 77}));
    into.insertObservation(mrpt::obs::CObservationOdometry());
    into.insertObservation(mrpt::obs::CObservationPointCloud());
  };
  CSemanticContinuousMap faulty = roomMap();
  insert_faults(faulty);
  other = sampleMap();
  other.setDocument(faulty.document());
  EXPECT_EQ(other.document().meta, faulty.document().meta);
  insert_faults(other);
  const auto meta = other.document().meta;
  EXPECT_EQ(meta.at("points_with_unknown_label_kept_unlabelled"), "2");
  EXPECT_EQ(meta.at("observations_not_taken"), "CObservationOdometry 2");
  EXPECT_EQ(meta.at("observations_damaged"), "CObservationPointCloud 2");

  MapDocument inconsistent = map.document();
  inconsistent.labels = LabelSet::occupancy();
  EXPECT_THROW(other.setDocument(inconsistent), std::invalid_argument);
}

TEST(MetricMap, SavesAMapFile) {
  const CSemanticContinuousMap map = roomMap();
  const std::string prefix = testing::TempDir() + "csom_metric_map_test_saved";
  map.saveMetricMapRepresentationToFile(prefix);
  const MapDocument loaded = loadMap(prefix + ".csom");
  EXPECT_EQ(mapDigest(loaded.map), mapDigest(map.map()));
  EXPECT_EQ(loaded.scans.size(), 1u);
  EXPECT_EQ(loaded.labels.name(), "sample");
}

CMultiMetricMap multiMap() {
  mrpt::maps::TSetOfMetricMapInitializers definitions;
  CSemanticContinuousMap::TMapDefinition definition;
  definition.labels = sample::sampleLabels();
  definition.insertionOpts.point_labels = PointLabels::ByIntensity;
  definitions.push_back(definition);
  CMultiMetricMap maps;
  maps.setListOfMaps(definitions);
  return maps;
}

TEST(MetricMap, WorksInsideAMultiMetricMap) {
  CMultiMetricMap maps = multiMap();
  ASSERT_TRUE(maps.insertObservation(*roomCloud()));
  const std::string digest = mapDigest(maps.mapByClass<CSemanticContinuousMap>()->map());

  CMultiMetricMap copy = maps;
  maps.insertObservation(*roomCloud(), CPose3D(1, 0, 0, 0, 0, 0));
  EXPECT_EQ(mapDigest(copy.mapByClass<CSemanticContinuousMap>()->map()), digest);
  EXPECT_NE(mapDigest(maps.mapByClass<CSemanticContinuousMap>()->map()), digest);

  const CMultiMetricMap moved = std::move(copy);
  EXPECT_EQ(mapDigest(moved.mapByClass<CSemanticContinuousMap>()->map()), digest);
  EXPECT_TRUE(maps.insertObservation(*roomCloud()));
}

TEST(MetricMap, GenericParametersGateInsertionAndLikelihood) {
  CSemanticContinuousMap map = roomMap();
  map.genericMapParams.enableObservationInsertion = false;
  EXPECT_FALSE(map.insertObservation(*roomCloud()));
  EXPECT_EQ(map.scans().size(), 1u);
  EXPECT_TRUE(map.canComputeObservationLikelihood(*roomCloud()));
  map.genericMapParams.enableObservationLikelihood = false;
  EXPECT_FALSE(map.canComputeObservationLikelihood(*roomCloud()));
}

class Listener : public mrpt::system::CObserver {
 public:
  int clears = 0;
  int insertions = 0;

 protected:
  void OnEvent(const mrpt::system::mrptEvent& event) override {
    if (event.isOfType<mrpt::maps::mrptEventMetricMapClear>()) ++clears;
    if (event.isOfType<mrpt::maps::mrptEventMetricMapInsert>()) ++insertions;
  }
};

TEST(MetricMap, PublishesEvents) {
  CSemanticContinuousMap map = sampleMap();
  Listener listener;
  listener.observeBegin(map);
  map.insertObservation(*roomCloud());
  EXPECT_EQ(listener.insertions, 1);
  map.insertObservation(mrpt::obs::CObservationOdometry());
  EXPECT_EQ(listener.insertions, 1);
  map.clear();
  EXPECT_EQ(listener.clears, 1);

  CSemanticContinuousMap copy = map;
  copy.insertObservation(*roomCloud());
  EXPECT_EQ(listener.insertions, 1) << "a copy has no observers";
}

TEST(MetricMap, RaycastingFreesWhatTheBeamsCross) {
  Options options;
  options.free_space.mode = FreeSpace::Raycast;
  CSemanticContinuousMap map(options);
  ASSERT_TRUE(map.insertObservation(*laserScan()));
  EXPECT_EQ(map.map().at({5.0, 0.05, 0.05}).state(), VoxelState::Occupied);
  EXPECT_EQ(map.map().at({2.5, 0.05, 0.05}).state(), VoxelState::Free);
  EXPECT_EQ(map.map().at({-2.5, 0.05, 0.05}).state(), VoxelState::Unknown);
}

const mrpt::opengl::COctoMapVoxels* voxelsOf(const mrpt::opengl::CSetOfObjects& scene) {
  return scene.empty() ? nullptr
                       : dynamic_cast<const mrpt::opengl::COctoMapVoxels*>(scene.begin()->get());
}

TEST(MetricMap, ShowsVoxelsInTheColoursOfTheirClasses) {
  CSemanticContinuousMap map = roomMap();
  mrpt::opengl::CSetOfObjects scene;
  map.getVisualizationInto(scene);
  const auto* voxels = voxelsOf(scene);
  ASSERT_NE(voxels, nullptr);
  EXPECT_GT(voxels->getVoxelCount(mrpt::opengl::VOXEL_SET_OCCUPIED), 100u);
  const mrpt::img::TColor color = voxels->getVoxel(mrpt::opengl::VOXEL_SET_OCCUPIED, 0).color;
  EXPECT_EQ(color, mrpt::img::TColor(0, 200, 0));

  map.genericMapParams.enableSaveAs3DObject = false;
  mrpt::opengl::CSetOfObjects hidden;
  map.getVisualizationInto(hidden);
  EXPECT_TRUE(hidden.empty());
}

TEST(MetricMap, DescribesItself) {
  const std::string text = roomMap().asString();
  EXPECT_THAT(text, testing::HasSubstr("4 classes (sample), 1 observations"));
}

TEST(MetricMap, PointsMapFollowsTheMap) {
  CSemanticContinuousMap map = sampleMap();
  map.insertObservation(*pointCloud({{1, 0, 0}}, {40}));
  const std::size_t before = map.getAsSimplePointsMap()->size();
  EXPECT_GT(before, 0u);
  map.insertObservation(*pointCloud({{5, 5, 0}}, {40}));
  EXPECT_GT(map.getAsSimplePointsMap()->size(), before);
}

}  // namespace
}  // namespace csom
