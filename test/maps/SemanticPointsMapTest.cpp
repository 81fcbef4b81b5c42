// SPDX-License-Identifier: BSD-3-Clause
// The semantic map in the guise of a points map.
#include <csom/maps/CSemanticPointsMap.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/serialization/CArchive.h>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::maps::CMultiMetricMap;
using mrpt::poses::CPose3D;
using sample::roomCloud;
using sample::roomMap;
using sample::sampleMap;

std::string computeDigest(const CSemanticPointsMap& map) {
  return mapDigest(map.semanticMap().map());
}

/// A program's set of maps as an ini defines it.
CMultiMetricMap mapsOf(const std::string& ini) {
  const mrpt::config::CConfigFileMemory source(ini);
  mrpt::maps::TSetOfMetricMapInitializers definitions;
  definitions.loadFromConfigFile(source, "Maps");
  CMultiMetricMap maps;
  maps.setListOfMaps(definitions);
  return maps;
}

TEST(SemanticPointsMap, IsAPointsMapOfTheOccupiedVoxels) {
  CSemanticPointsMap map(sampleMap());
  EXPECT_TRUE(map.isEmpty());
  ASSERT_TRUE(map.insertObservation(*roomCloud()));
  EXPECT_TRUE(map.GetRuntimeClass()->derivedFrom(CLASS_ID(mrpt::maps::CPointsMap)));
  EXPECT_EQ(computeDigest(map), mapDigest(roomMap().map()));
  EXPECT_EQ(map.size(), roomMap().getAsSimplePointsMap()->size());
  EXPECT_GT(map.size(), 1000u);
  EXPECT_EQ(map.getAsSimplePointsMap(), &map);
  EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservationImage()));
  map.clear();
  EXPECT_TRUE(map.isEmpty());
  EXPECT_TRUE(map.semanticMap().isEmpty());
}

TEST(SemanticPointsMap, AnswersAsTheSemanticMap) {
  const CSemanticContinuousMap semantic = roomMap();
  const CSemanticPointsMap map(semantic);
  const CPose3D beside(0.3, 0.2, 0, 0.05, 0, 0);
  EXPECT_EQ(map.computeObservationLikelihood(*roomCloud(), beside),
            semantic.computeObservationLikelihood(*roomCloud(), beside));
  EXPECT_TRUE(map.canComputeObservationLikelihood(*roomCloud()));
  EXPECT_FALSE(map.canComputeObservationLikelihood(mrpt::obs::CObservationImage()));
  EXPECT_EQ(map.compute3DMatchingRatio(&semantic, CPose3D(), {}),
            semantic.compute3DMatchingRatio(&semantic, CPose3D(), {}));
  EXPECT_EQ(map.squareDistanceToClosestCorrespondence(1, 1),
            semantic.squareDistanceToClosestCorrespondence(1, 1));
  EXPECT_EQ(map.asString(), semantic.asString());
}

TEST(SemanticPointsMap, IsMadeFromAnIni) {
  CMultiMetricMap maps = mapsOf(
      "[Maps]\nsemanticPointsMap_count = 1\n"
      "[Maps_semanticPointsMap_00_creationOpts]\nresolution = 0.3\n"
      "enableObservationLikelihood = false\n"
      "[Maps_semanticPointsMap_00_insertOpts]\nmethod = see-csom\nmax_range = 7\n");
  ASSERT_EQ(maps.maps.size(), 1u);
  const auto map = maps.mapByClass<CSemanticPointsMap>();
  ASSERT_TRUE(map);
  EXPECT_EQ(map->semanticMap().map().options().resolution, 0.3);
  EXPECT_EQ(map->semanticMap().map().options().scan.max_range, 7);
  EXPECT_FALSE(map->canComputeObservationLikelihood(*roomCloud()));
  // As icp-slam looks for what it aligns scans to.
  EXPECT_TRUE(maps.mapByClass<mrpt::maps::CPointsMap>());
  EXPECT_TRUE(maps.insertObservation(*roomCloud()));
  EXPECT_GT(map->size(), 100u);

  const CMultiMetricMap copy(maps);  // by a stream
  const auto copied = copy.mapByClass<CSemanticPointsMap>();
  ASSERT_TRUE(copied);
  EXPECT_NE(copied, map);
  EXPECT_EQ(computeDigest(*copied), computeDigest(*map));
  EXPECT_EQ(copied->size(), map->size());
  EXPECT_FALSE(copied->genericMapParams.enableObservationLikelihood);
}

TEST(SemanticPointsMap, CopiesAreOfTheirOwn) {
  const CSemanticPointsMap original(roomMap());
  CSemanticPointsMap copy(original);
  CSemanticPointsMap assigned;
  assigned = original;
  EXPECT_EQ(computeDigest(copy), computeDigest(original));
  EXPECT_EQ(assigned.size(), original.size());
  copy.insertObservation(*roomCloud(), CPose3D(10, 0, 0, 0, 0, 0));
  EXPECT_GT(copy.size(), original.size());
  EXPECT_NE(computeDigest(copy), computeDigest(original));
  EXPECT_EQ(computeDigest(assigned), computeDigest(original));
}

}  // namespace
}  // namespace csom
