// SPDX-License-Identifier: BSD-3-Clause
// What MRPT asks of all its metric maps, for both of ours.
#include <csom/maps/CSemanticPointsMap.h>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/obs/stock_observations.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/system/CObserver.h>

#include <memory>
#include <type_traits>

#include "SampleObservations.h"

namespace csom {
namespace {

using mrpt::maps::CMultiMetricMap;
using mrpt::poses::CPose3D;

const SemanticMap& voxelsOf(const CSemanticContinuousMap& map) {
  return map.map();
}
const SemanticMap& voxelsOf(const CSemanticPointsMap& map) {
  return map.semanticMap().map();
}

mrpt::obs::CObservation2DRangeScan stockScan(int which = 0) {
  mrpt::obs::CObservation2DRangeScan scan;
  mrpt::obs::stock_observations::example2DRangeScan(scan, which);
  return scan;
}

template <class Map>
class MrptConventions : public testing::Test {
 protected:
  static Map filledMap() {
    Map map;
    map.insertObservation(stockScan());
    return map;
  }
  static CMultiMetricMap filledSet() {
    mrpt::maps::TSetOfMetricMapInitializers definitions;
    definitions.push_back(typename Map::TMapDefinition());
    CMultiMetricMap maps;
    maps.setListOfMaps(definitions);
    maps.insertObservation(stockScan());
    return maps;
  }
};

using Maps = testing::Types<CSemanticContinuousMap, CSemanticPointsMap>;
TYPED_TEST_SUITE(MrptConventions, Maps);

TYPED_TEST(MrptConventions, HasTheTraitsOfAMap) {
  EXPECT_TRUE(std::is_default_constructible_v<TypeParam>);
  EXPECT_TRUE(std::is_copy_constructible_v<TypeParam>);
  EXPECT_TRUE(std::is_copy_assignable_v<TypeParam>);
  EXPECT_TRUE(std::is_move_constructible_v<TypeParam>);
  EXPECT_TRUE(std::is_move_assignable_v<TypeParam>);
  EXPECT_TRUE((std::is_base_of_v<mrpt::maps::CMetricMap, TypeParam>));
}

TYPED_TEST(MrptConventions, IsKnownByItsClassName) {
  const TypeParam map;
  const std::string name = map.GetRuntimeClass()->className;
  const mrpt::rtti::CObject::Ptr object = mrpt::rtti::classFactory(name);
  ASSERT_NE(object, nullptr) << name;
  EXPECT_NE(dynamic_cast<TypeParam*>(object.get()), nullptr);
  EXPECT_TRUE(map.GetRuntimeClass()->derivedFrom(CLASS_ID(mrpt::maps::CMetricMap)));
}

TYPED_TEST(MrptConventions, IsDuplicatedAsAnObject) {
  const TypeParam map = TestFixture::filledMap();
  const auto copy = std::dynamic_pointer_cast<TypeParam>(map.duplicateGetSmartPtr());
  ASSERT_NE(copy, nullptr);
  EXPECT_EQ(mapDigest(voxelsOf(*copy)), mapDigest(voxelsOf(map)));
}

TYPED_TEST(MrptConventions, GoesThroughAStream) {
  const TypeParam map = TestFixture::filledMap();
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << map;
  stream.Seek(0);
  TypeParam read;
  archive >> read;
  EXPECT_EQ(mapDigest(voxelsOf(read)), mapDigest(voxelsOf(map)));

  stream.Seek(0);
  mrpt::serialization::CSerializable::Ptr object;
  archive >> object;
  const auto made = std::dynamic_pointer_cast<TypeParam>(object);
  ASSERT_NE(made, nullptr);
  EXPECT_EQ(mapDigest(voxelsOf(*made)), mapDigest(voxelsOf(map)));
}

TYPED_TEST(MrptConventions, ASetOfMapsIsCopiedAndMovedWithIt) {
  CMultiMetricMap maps = TestFixture::filledSet();
  const std::string digest = mapDigest(voxelsOf(*maps.mapByClass<TypeParam>()));
  CMultiMetricMap copy(maps);
  maps.insertObservation(stockScan(1), CPose3D(5, 0, 0, 0, 0, 0));
  EXPECT_EQ(mapDigest(voxelsOf(*copy.mapByClass<TypeParam>())), digest);
  EXPECT_NE(mapDigest(voxelsOf(*maps.mapByClass<TypeParam>())), digest);

  const CMultiMetricMap moved(std::move(copy));
  EXPECT_EQ(mapDigest(voxelsOf(*moved.mapByClass<TypeParam>())), digest);
  CMultiMetricMap assigned;
  assigned = moved;
  EXPECT_EQ(mapDigest(voxelsOf(*assigned.mapByClass<TypeParam>())), digest);
  CMultiMetricMap move_assigned;
  move_assigned = std::move(assigned);
  EXPECT_EQ(mapDigest(voxelsOf(*move_assigned.mapByClass<TypeParam>())), digest);
}

TYPED_TEST(MrptConventions, GenericParametersDecideWhatIsInsertedAndAsked) {
  TypeParam map = TestFixture::filledMap();
  const std::string digest = mapDigest(voxelsOf(map));
  map.genericMapParams.enableObservationInsertion = false;
  EXPECT_FALSE(map.insertObservation(stockScan(1)));
  EXPECT_EQ(mapDigest(voxelsOf(map)), digest);
  EXPECT_TRUE(map.canComputeObservationLikelihood(stockScan()));
  EXPECT_NE(map.computeObservationLikelihood(stockScan(1), CPose3D(1, 1, 0, 0, 0, 0)), 0);
  map.genericMapParams.enableObservationLikelihood = false;
  EXPECT_FALSE(map.canComputeObservationLikelihood(stockScan()));
  EXPECT_EQ(map.computeObservationLikelihood(stockScan(1), CPose3D(1, 1, 0, 0, 0, 0)), 0);
}

TYPED_TEST(MrptConventions, TellsOfInsertionsAndOfBeingCleared) {
  struct Listener : public mrpt::system::CObserver {
    int insertions = 0;
    int clears = 0;
    void OnEvent(const mrpt::system::mrptEvent& event) override {
      if (event.isOfType<mrpt::maps::mrptEventMetricMapInsert>()) ++insertions;
      if (event.isOfType<mrpt::maps::mrptEventMetricMapClear>()) ++clears;
    }
  };
  TypeParam map;
  Listener listener;
  listener.observeBegin(map);
  map.insertObservation(stockScan());
  EXPECT_EQ(listener.insertions, 1);
  EXPECT_EQ(listener.clears, 0);
  map.clear();
  EXPECT_EQ(listener.clears, 1);
}

TYPED_TEST(MrptConventions, ASimpleMapFillsIt) {
  mrpt::maps::CSimpleMap frames;
  for (int i = 0; i < 2; ++i) {
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(std::make_shared<mrpt::obs::CObservation2DRangeScan>(stockScan(i)));
    frames.insert(mrpt::poses::CPose3DPDFGaussian::Create(CPose3D(2.0 * i, 0, 0, 0, 0, 0)), frame);
  }
  TypeParam direct;
  direct.insertObservation(stockScan(0));
  direct.insertObservation(stockScan(1), CPose3D(2, 0, 0, 0, 0, 0));
  TypeParam map = TestFixture::filledMap();  // erased
  map.loadFromSimpleMap(frames);
  EXPECT_EQ(mapDigest(voxelsOf(map)), mapDigest(voxelsOf(direct)));
}

/// As COctoMap's and COccupancyGridMap3D's own tests: a scan leaves something where it hit.
TYPED_TEST(MrptConventions, LaserScansAreWhereTheyHit) {
  TypeParam map;
  EXPECT_TRUE(map.isEmpty());
  const auto scan = stockScan();
  ASSERT_TRUE(map.insertObservation(scan));
  EXPECT_FALSE(map.isEmpty());
  mrpt::maps::CSimplePointsMap hits;
  hits.insertionOptions.minDistBetweenLaserPoints = 0;
  hits.insertObservation(scan);
  ASSERT_GT(hits.size(), 100u);
  std::size_t occupied = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    float x = 0;
    float y = 0;
    float z = 0;
    hits.getPoint(i, x, y, z);
    const auto voxel = voxelsOf(map).at(Eigen::Vector3f(x, y, z).cast<double>());
    if (voxel.state() == VoxelState::Occupied) ++occupied;
  }
  EXPECT_GE(occupied, hits.size() * 98 / 100) << "of " << hits.size();
  map.clear();
  EXPECT_TRUE(map.isEmpty());
}

}  // namespace
}  // namespace csom
