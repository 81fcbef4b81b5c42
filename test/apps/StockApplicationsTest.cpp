// SPDX-License-Identifier: BSD-3-Clause
// MRPT's own programs, started as processes with the plug-in, leave the maps that they should.
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/ObservationAdapter.h>
#include <csom/maps/PoseRounding.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>
#include <mrpt/serialization/CArchive.h>

#include <nlohmann/json.hpp>

#include "apps/RunMrpt.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using mrpt::maps::CSimpleMap;
using testing::HasSubstr;

const std::string kConfigs = CSOM_SOURCE_DIR "/config/";
const std::string kCampusLog = CSOM_SOURCE_DIR "/rawlogs/campus.rawlog";
const std::string kDataSets = "/usr/share/mrpt/datasets/";  // of the package mrpt-common
const std::string kMapSuffix = "_csom__CSemanticContinuousMap_00.csom";

enum class Plugin { Preloaded, Absent };

ProgramResult runStock(const std::string& folder, const std::vector<std::string>& command,
                       Plugin plugin = Plugin::Preloaded) {
  return runMrpt(folder, command, 120,
                 plugin == Plugin::Preloaded ? preloadingPlugin() : acceptingPlugin());
}

CSimpleMap loadSimpleMap(const std::string& file) {
  CSimpleMap frames;
  if (!frames.loadFromFile(file)) throw std::runtime_error(file + " cannot be read");
  return frames;
}

/// Calls visit(pose, observation) for every observation, in order.
template <class Visitor>
void forEachObservation(const CSimpleMap& frames, Visitor&& visit) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    mrpt::poses::CPose3DPDF::ConstPtr pose;
    mrpt::obs::CSensoryFrame::ConstPtr frame;
    frames.get(i, pose, frame);
    for (const auto& observation : *frame) visit(pose->getMeanVal(), *observation);
  }
}

std::size_t countOf(const CSimpleMap& frames,
                    const mrpt::rtti::TRuntimeClassId* observation_class) {
  std::size_t count = 0;
  forEachObservation(frames, [&](const auto&, const mrpt::obs::CObservation& observation) {
    if (observation.GetRuntimeClass()->derivedFrom(observation_class)) ++count;
  });
  return count;
}

/// The map of the same observations by a plain loop over the core.
std::string digestOfDirectLoop(const CSimpleMap& frames, const std::string& config) {
  const auto definition = CSemanticContinuousMap::definitionFromIni(config);
  const auto& insertion = definition.insertionOpts;
  const LabelRules rules(definition.labels, insertion.point_labels, insertion.unlabelled_class,
                         insertion.scan_2d_class);
  SemanticMap map(definition.options);
  SelfLabelledAdapter adapter(beamsOf(definition.options));
  forEachObservation(frames, [&](const auto& pose, const mrpt::obs::CObservation& observation) {
    const auto scans = adapter.adapt(observation, roundedPose(pose), rules);
    if (!scans) return;
    for (const AdaptedScan& adapted : *scans) map.insert(adapted.scan);
  });
  return mapDigest(map);
}

nlohmann::json infoOf(const std::string& map_file) {
  const TempFolder folder;
  const ProgramResult info = runCsom(folder.path(), {"info", map_file, "--json"});
  EXPECT_EQ(info.exit_code, 0) << info.errors;
  return nlohmann::json::parse(info.output);
}

TEST(Observations2map, MapsADataSetOfMrpt) {
  const TempFolder folder;
  const std::string frames_file = kDataSets + "localization_demo.simplemap.gz";
  const std::string config = kConfigs + "mrpt/observations2map.ini";
  const ProgramResult run =
      runStock(folder.path(), {"observations2map", config, frames_file, "out_"});
  ASSERT_EQ(run.exit_code, 0) << run.output << run.errors;
  EXPECT_EQ(run.errors, "");

  const CSimpleMap frames = loadSimpleMap(frames_file);
  const MapDocument document = loadMap(folder / ("out_" + kMapSuffix));
  EXPECT_EQ(document.scans.size(), countOf(frames, CLASS_ID(mrpt::obs::CObservation2DRangeScan)));
  EXPECT_EQ(document.map.options().free_space.mode, FreeSpace::Projective) << "options of the ini";
  EXPECT_EQ(mapDigest(document.map), digestOfDirectLoop(frames, config));
  EXPECT_EQ(infoOf(folder / ("out_" + kMapSuffix)).at("digest"), mapDigest(document.map));
}

TEST(Observations2map, MakesTheMapOfCsomMap) {
  const TempFolder folder;
  const std::string config = kConfigs + "campus.ini";
  const ProgramResult mapping =
      runCsom(folder.path(), {"map", kCampusLog, "-c", config, "-o", folder / "out", "--no-html",
                              "--write-simplemap", folder / "campus.simplemap"});
  ASSERT_EQ(mapping.exit_code, 0) << mapping.errors;
  const ProgramResult run =
      runStock(folder.path(), {"observations2map", config, folder / "campus.simplemap", "stock_"});
  ASSERT_EQ(run.exit_code, 0) << run.output << run.errors;

  const MapDocument ours = loadMap(folder / "out/map.csom");
  const MapDocument stock = loadMap(folder / ("stock_" + kMapSuffix));
  EXPECT_EQ(stock.scans.size(), ours.scans.size());
  EXPECT_GT(stock.scans.size(), 10u);
  EXPECT_EQ(mapDigest(stock.map), mapDigest(ours.map));
  EXPECT_EQ(digestOfDirectLoop(loadSimpleMap(folder / "campus.simplemap"), config),
            mapDigest(ours.map));
}

/// Maps a log by csom, and what csom writes as a simplemap by observations2map.
void expectTheMapOfCsomMap(const std::string& log, const std::string& config) {
  const TempFolder folder;
  const ProgramResult mapping =
      runCsom(folder.path(), {"map", log, "-c", config, "-o", folder / "out", "--no-html",
                              "--write-simplemap", folder / "drive.simplemap"});
  ASSERT_EQ(mapping.exit_code, 0) << mapping.errors;
  const ProgramResult run =
      runStock(folder.path(), {"observations2map", config, folder / "drive.simplemap", "stock_"});
  ASSERT_EQ(run.exit_code, 0) << run.output << run.errors;
  const MapDocument ours = loadMap(folder / "out/map.csom");
  const MapDocument stock = loadMap(folder / ("stock_" + kMapSuffix));
  EXPECT_EQ(stock.scans.size(), ours.scans.size());
  EXPECT_GT(stock.scans.size(), 10u);
  EXPECT_GT(stock.map.knownVoxelCount(), 1000u);
  EXPECT_EQ(mapDigest(stock.map), mapDigest(ours.map));
}

TEST(Observations2map, MakesTheMapOfCsomMapWithANetworkInTheLoop) {
  expectTheMapOfCsomMap(kCampusLog, kConfigs + "campus-camera.ini");
}

/// A camera that works at other times than the LiDAR: scans wait for images, the last one in vain.
TEST(Observations2map, MakesTheMapOfCsomMapWhereImagesAndScansAreApart) {
  const TempFolder folder;
  std::string world = readBytes(CSOM_SOURCE_DIR "/config/worlds/campus.yaml");
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = world.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    world.replace(at, from.size(), to);
  };
  replace("waypoints: [[0, -1.6], [53.4, -1.6], [53.4, 38]]", "waypoints: [[0, -1.6], [20, -1.6]]");
  replace("pose: [0.3, 0, 1.5, 0, 4, 0]\n    rate: 1.5",
          "pose: [0.3, 0, 1.5, 0, 4, 0]\n    rate: 3.7");
  writeBytes(folder / "world.yaml", world);
  const ProgramResult simulation =
      runCsom(folder.path(), {"simulate", folder / "world.yaml", "-o", folder / "drive.rawlog",
                              "--format", "observations"});
  ASSERT_EQ(simulation.exit_code, 0) << simulation.errors;

  std::string config = readBytes(kConfigs + "campus-camera.ini");
  config.replace(config.find("networks/campus.yaml"), 20, kConfigs + "networks/campus.yaml");
  config += "\n[MappingApplication_semanticContinuousMap_00_labelOpts]\nmax_time_offset = 0.2\n";
  writeBytes(folder / "map.ini", config);
  expectTheMapOfCsomMap(folder / "drive.rawlog", folder / "map.ini");
}

TEST(Observations2map, WarnsOfUnknownKeys) {
  const TempFolder folder;
  std::ofstream(folder / "map.ini")
      << "[MappingApplication]\nsemanticContinuousMap_count = 1\n"
         "[MappingApplication_semanticContinuousMap_00_creationOpts]\nresolutoin = 0.3\n";
  const ProgramResult run = runStock(
      folder.path(),
      {"observations2map", "map.ini", kDataSets + "localization_demo.simplemap.gz", "out_"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("map.ini [MappingApplication_semanticContinuousMap_00_"
                                    "creationOpts] resolutoin: unknown key"));
}

TEST(Observations2map, StopsAtWrongValues) {
  const TempFolder folder;
  std::ofstream(folder / "map.ini")
      << "[MappingApplication]\nsemanticContinuousMap_count = 1\n"
         "[MappingApplication_semanticContinuousMap_00_creationOpts]\nresolution = fine\n";
  const ProgramResult run = runStock(
      folder.path(),
      {"observations2map", "map.ini", kDataSets + "localization_demo.simplemap.gz", "out_"});
  EXPECT_NE(run.exit_code, 0);
  EXPECT_THAT(run.output + run.errors, HasSubstr("resolution"));
  EXPECT_FALSE(std::filesystem::exists(folder / ("out_" + kMapSuffix)));
}

// docs/mrpt.md tells users so.
TEST(Observations2map, WithoutThePluginNoMapAndNoError) {
  const TempFolder folder;
  const ProgramResult run = runStock(folder.path(),
                                     {"observations2map", kConfigs + "mrpt/observations2map.ini",
                                      kDataSets + "localization_demo.simplemap.gz", "out_"},
                                     Plugin::Absent);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / ("out_" + kMapSuffix)));
}

/// Runs rbpf-slam and holds its final map against the key frames that it stored beside it.
void expectMapOfKeyFrames(const std::string& config, const std::string& rawlog,
                          const mrpt::rtti::TRuntimeClassId* observation_class) {
  const TempFolder folder;
  const ProgramResult run = runStock(folder.path(), {"rbpf-slam", config, rawlog});
  ASSERT_EQ(run.exit_code, 0) << run.output.substr(0, 2000) << run.errors;

  const std::string map_file = folder / ("rbpf-slam-out/finalMap" + kMapSuffix);
  const MapDocument document = loadMap(map_file);
  const CSimpleMap frames = loadSimpleMap(folder / "rbpf-slam-out/_finalmap_.simplemap");
  EXPECT_GT(document.scans.size(), 5u);
  EXPECT_EQ(document.scans.size(), countOf(frames, observation_class));
  EXPECT_GT(document.map.knownVoxelCount(), 1000u);
  EXPECT_EQ(infoOf(map_file).at("digest"), mapDigest(document.map));
}

TEST(RbpfSlam, MapsADataSetOfMrpt) {
  expectMapOfKeyFrames(kConfigs + "mrpt/rbpf-slam.ini",
                       kDataSets + "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog",
                       CLASS_ID(mrpt::obs::CObservation2DRangeScan));
}

TEST(RbpfSlam, MapsTheCampusDrive) {
  expectMapOfKeyFrames(kConfigs + "mrpt/rbpf-slam-campus.ini", kCampusLog,
                       CLASS_ID(mrpt::obs::CObservationVelodyneScan));
}

/// Every particle labels its scans by the network, whose words it finds in the cache.
TEST(RbpfSlam, MapsTheCampusDriveWithLabelsFromTheCamera) {
  const TempFolder folder;
  std::string config = readBytes(kConfigs + "mrpt/rbpf-slam-campus.ini");
  const std::string by_intensity = "point_labels = intensity";
  config.replace(config.find(by_intensity), by_intensity.size(), "point_labels = none");
  config +=
      "\n[MappingApplication_semanticContinuousMap_00_labelSource_00]\n"
      "sensor_label = camera\nsource = network\nnetwork = " +
      kConfigs +
      "networks/campus.yaml\n"
      "[MappingApplication_semanticContinuousMap_00_labelOpts]\nlabel_cache = " +
      (folder / "cache") + "\n";
  writeBytes(folder / "rbpf.ini", config);
  expectMapOfKeyFrames(folder / "rbpf.ini", kCampusLog,
                       CLASS_ID(mrpt::obs::CObservationVelodyneScan));
}

/// A log with one laser scan and the map of it.
void writeLogWithMap(const std::string& file) {
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->sensorLabel = "LASER";
  scan->timestamp = mrpt::Clock::fromDouble(1.5e9);
  scan->resizeScanAndAssign(181, 5.0f, true);
  CSemanticContinuousMap map;
  map.insertObservation(*scan);
  mrpt::io::CFileGZOutputStream stream(file);
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << *scan << map;
}

TEST(RawlogEdit, ReadsLogsWithMapsInThem) {
  const TempFolder folder;
  writeLogWithMap(folder / "map.rawlog");
  const ProgramResult run =
      runStock(folder.path(), {"rawlog-edit", "-p", CSOM_PLUGIN, "-i", "map.rawlog", "--info"},
               Plugin::Absent);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.output, HasSubstr("LASER"));
  EXPECT_THAT(run.output + run.errors, testing::Not(HasSubstr("not registered")));
  EXPECT_THAT(run.output + run.errors, testing::Not(HasSubstr("exception")));

  const ProgramResult without =
      runStock(folder.path(), {"rawlog-edit", "-i", "map.rawlog", "--info"}, Plugin::Absent);
  EXPECT_THAT(without.output + without.errors, HasSubstr("not registered"));
}

}  // namespace
}  // namespace csom::test
