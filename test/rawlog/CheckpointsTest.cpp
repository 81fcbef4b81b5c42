// SPDX-License-Identifier: BSD-3-Clause
// A run that is ended at any place goes on from its file to the same map.
#include <csom/io/MapRepair.h>
#include <csom/rawlog/MappingRun.h>
#include <sys/resource.h>

#include "io/FaultyDisk.h"
#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

std::string shipped(const std::string& path) {
  return std::string(CSOM_SOURCE_DIR) + "/" + path;
}

class CheckpointsTest : public testing::Test {
 protected:
  CheckpointsTest() {
    request.logs = {writeLog(folder / "a.rawlog", driveEntries(4)),
                    writeLog(folder / "b.rawlog", driveEntries(3))};
    request.config_file = writeConfig(folder);
  }

  /// The campus, its labels from `source`, the lines of the ini that say so.
  void useCampus(const std::string& source) {
    request.logs = {shipped("rawlogs/campus.rawlog")};
    request.config_file = folder / "camera.ini";
    const std::string section = "[MappingApplication_semanticContinuousMap_00_";
    writeBytes(request.config_file,
               "[MappingApplication]\nsemanticContinuousMap_count = 1\n" + section +
                   "creationOpts]\nlabel_set = simulator\nresolution = 0.5\n" + section +
                   "insertOpts]\nmethod = s-csm\nds_resolution = 0.5\n" + section +
                   "labelSource_00]\nsensor_label = camera\n" + source);
  }

  /// Images, label images and scans wait for each other.
  void useCampusWithCamera() { useCampus("source = label_image\nlabel_image = camera_labels\n"); }

  /// The files of the network lie in the folder of the test.
  void useCampusWithNetwork() {
    for (const char* name : {"campus.yaml", "campus.onnx"})
      std::filesystem::copy_file(shipped("config/networks/") + name, folder / name);
    useCampus("source = network\nnetwork = campus.yaml\n");
  }

  CheckpointRequest everyEntry(bool resume = false) const {
    CheckpointRequest checkpoints;
    checkpoints.file = file;
    checkpoints.resume = resume;
    checkpoints.seconds = 0;
    return checkpoints;
  }

  std::string undisturbed() const { return mapDigest(mapLogs(request).map->map()); }

  /// The map of a run that stops after every `entries` entries and is gone on with.
  std::string stoppedAfter(int entries, std::optional<std::size_t> max_memory = {}) const {
    for (;;) {
      int left = entries;
      CheckpointRequest checkpoints = everyEntry(std::filesystem::exists(file));
      checkpoints.seconds = 1e6;
      checkpoints.max_memory = max_memory;
      checkpoints.stop = [&left] { return --left == 0; };
      try {
        MappingResult result = mapLogs(request, {}, checkpoints);
        return finish(std::move(result));
      } catch (const Interrupted&) {
        EXPECT_THAT(verifyMap(file).faults, IsEmpty());
      }
    }
  }

  /// The digest of the finished file, after which nothing is left of the unfinished one.
  std::string finish(MappingResult result) const {
    result.store->writeFinished(folder / "map.csom", {});
    MapStore::remove(std::move(result.store));
    const MapDocument document = loadMap(folder / "map.csom");
    EXPECT_EQ(document.scans.size(), result.map->scans().size());
    EXPECT_EQ(result.insert_ms.size(), document.scans.size());
    EXPECT_FALSE(std::filesystem::exists(file));
    return mapDigest(document.map);
  }

  const TempFolder folder;
  const std::string file = folder / "unfinished.csom";
  MappingRequest request;
};

TEST_F(CheckpointsTest, EveryEntryIsAPlaceToStop) {
  const std::string expected = undisturbed();
  // The first entry is a pose: a run that stops there has nothing to go on with.
  for (const int entries : {2, 3, 5}) EXPECT_EQ(stoppedAfter(entries), expected) << entries;
}

TEST_F(CheckpointsTest, LittleMemoryMakesTheSameMap) {
  const std::string expected = undisturbed();
  CheckpointRequest checkpoints = everyEntry();
  checkpoints.seconds = 1e6;
  checkpoints.max_memory = 4000;
  MappingResult result = mapLogs(request, {}, checkpoints);
  EXPECT_FALSE(result.voxels_in_memory);
  EXPECT_LT(result.map->map().memoryBytes(), 4000U);
  EXPECT_EQ(result.store->digest(), expected);
  EXPECT_EQ(finish(std::move(result)), expected);
  EXPECT_EQ(stoppedAfter(2, 4000), expected);

  checkpoints.max_memory = 100'000'000;
  result = mapLogs(request, {}, checkpoints);
  EXPECT_TRUE(result.voxels_in_memory);
  EXPECT_EQ(finish(std::move(result)), expected);
}

TEST_F(CheckpointsTest, ImagesAndScansThatWaitAreKept) {
  useCampusWithCamera();
  const std::string expected = undisturbed();
  EXPECT_EQ(stoppedAfter(17), expected);
  EXPECT_EQ(stoppedAfter(44, 100'000), expected);
}

TEST_F(CheckpointsTest, B9_AResumedRunLoadsItsNetworksOnceAndBeforeItBegins) {
  useCampusWithNetwork();
  const MappingResult once = mapLogs(request);
  // The first entry after the stop may be an image or not.
  for (const int entries : {16, 17, 18, 19, 20}) {
    CheckpointRequest checkpoints = everyEntry();
    checkpoints.seconds = 1e6;
    int left = entries;
    checkpoints.stop = [&left] { return --left == 0; };
    EXPECT_THROW(mapLogs(request, {}, checkpoints), Interrupted);
    // Whatever becomes of the model after that is too late: it is in memory.
    checkpoints.resume = true;
    checkpoints.stop = [this] {
      std::filesystem::remove(folder / "campus.onnx");
      return false;
    };
    MappingResult result = mapLogs(request, {}, checkpoints);
    EXPECT_EQ(result.refused, once.refused) << entries;
    EXPECT_EQ(finish(std::move(result)), mapDigest(once.map->map())) << entries;
    std::filesystem::copy_file(shipped("config/networks/campus.onnx"), folder / "campus.onnx");
  }
}

TEST_F(CheckpointsTest, B9_TimesThatAreNoWholeNumberOfThemAreRefused) {
  int left = 3;
  CheckpointRequest checkpoints = everyEntry();
  checkpoints.stop = [&left] { return --left == 0; };
  EXPECT_THROW(mapLogs(request, {}, checkpoints), Interrupted);
  {
    const auto store = MapStore::open(file);
    MapStore::State state = store->state();
    state.at("insert_ms").pop_back();
    store->commit({}, MapStore::Voxels::Add, store->loadScans(), state);
  }
  const std::string error = fileErrorOf([&] { mapLogs(request, {}, everyEntry(true)); });
  EXPECT_THAT(error, AllOf(HasSubstr(file), HasSubstr("insert_ms"), HasSubstr("bytes")));
}

TEST_F(CheckpointsTest, WhatIsCountedIsThatOfTheWholeRun) {
  Entries entries = driveEntries(3);
  entries.push_back(wallCloud(900));  // no pose there
  entries.push_back(robotPose(103, {}));
  request.logs = {writeLog(folder / "c.rawlog", entries)};
  request.keep_key_frames = true;
  const MappingResult once = mapLogs(request);
  for (bool resume = false;; resume = true) {
    int left = 2;
    CheckpointRequest checkpoints = everyEntry(resume);
    checkpoints.stop = [&left] { return --left == 0; };
    try {
      MappingResult result = mapLogs(request, {}, checkpoints);
      EXPECT_EQ(result.observations_read, once.observations_read);
      EXPECT_EQ(result.refused, once.refused);
      EXPECT_EQ(result.key_frames.size(), once.key_frames.size());
      EXPECT_EQ(result.warnings, once.warnings);
      EXPECT_TRUE(result.up.isApprox(once.up, 1e-12));
      finish(std::move(result));
      return;
    } catch (const Interrupted&) {
    }
  }
}

TEST_F(CheckpointsTest, TheRequestIsInTheFile) {
  request.poses = PoseChoice::parse("robot-pose:truth");
  request.threads = 1;
  request.deskew = false;
  CheckpointRequest checkpoints = everyEntry();
  checkpoints.meta = {{"command", "a test"}};
  checkpoints.notes = {{"mood", "good"}};
  int left = 3;
  checkpoints.stop = [&left] { return --left == 0; };
  EXPECT_THROW(mapLogs(request, {}, checkpoints), Interrupted);
  const MapStore::State state = readState(file);
  EXPECT_EQ(state.at("note.mood"), "good");
  const MappingRequest read = readRequest(state, file);
  EXPECT_EQ(read.logs, request.logs);
  EXPECT_EQ(read.config_file, request.config_file);
  EXPECT_EQ(read.poses->toString(), "robot-pose:truth");
  EXPECT_EQ(read.threads, 1);
  EXPECT_FALSE(read.deskew);
  const auto meta = loadMap(file).meta;
  EXPECT_EQ(meta.at("command"), "a test");
  EXPECT_EQ(meta.at("input.1.bytes"), std::to_string(std::filesystem::file_size(request.logs[0])));
  EXPECT_EQ(meta.at("input.2.xxh3").size(), 16U);
  EXPECT_EQ(meta.at("config.text"), readBytes(request.config_file));
  EXPECT_EQ(meta.count("library.mrpt"), 1U);
}

TEST_F(CheckpointsTest, ARunThatHasDoneNothingLeavesNothing) {
  CheckpointRequest checkpoints = everyEntry();
  checkpoints.stop = [] { return true; };
  request.logs = {writeLog(folder / "bare.rawlog", {robotPose(1, {}), robotPose(2, {})})};
  EXPECT_THROW(mapLogs(request, {}, checkpoints), Interrupted);
  checkpoints.stop = {};
  EXPECT_THROW(mapLogs(request, {}, checkpoints), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(CheckpointsTest, MemoryThatRunsShortEndsTheRunWithAllSaved) {
  // It is asked ten times a second at most: a short run would come to its end before.
  request.logs = {writeLog(folder / "long.rawlog", driveEntries(1600))};
  std::size_t scans = 0;
  CheckpointRequest checkpoints = everyEntry();
  checkpoints.seconds = 1e6;
  checkpoints.memory_shortage = [&scans]() -> std::optional<std::string> {
    if (scans == 0) return std::nullopt;
    return "3 MB are left of a test";
  };
  std::string message;
  try {
    mapLogs(
        request, [&scans](const MappingProgress& now) { scans = now.scans; }, checkpoints);
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  EXPECT_THAT(message, HasSubstr("memory is short: 3 MB are left of a test; "));
  EXPECT_THAT(message, HasSubstr("the rest can be mapped with less"));
  const MapDocument saved = loadMap(file);
  EXPECT_THAT(message, HasSubstr(std::to_string(saved.scans.size()) + " scan"));
}

TEST(MemoryShortage, SeesTheLimitOfTheProcess) {
  EXPECT_EQ(memoryShortage(0), std::nullopt);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  rlimit limited = before;
  limited.rlim_cur = std::size_t{1} << 46U;
  ASSERT_EQ(setrlimit(RLIMIT_AS, &limited), 0);
  const auto shortage = memoryShortage(std::size_t{1} << 47U);
  setrlimit(RLIMIT_AS, &before);
  ASSERT_TRUE(shortage.has_value());
  EXPECT_THAT(*shortage, HasSubstr(" MB are left of "));
}

/// Every write or flush fails once, and with it all that come later.
class RunOnAFailingDisk : public CheckpointsTest, public testing::WithParamInterface<int> {};

TEST_P(RunOnAFailingDisk, GoesOnToTheSameMap) {
  const std::string expected = undisturbed();
  FaultyDisk disk;
  int failures = 0, resumed = 0;
  for (long operations = 0;; operations += 3) {
    disk.failAfter(operations, GetParam());
    bool failed = false;
    try {
      EXPECT_EQ(finish(mapLogs(request, {}, everyEntry())), expected);
    } catch (const std::runtime_error&) {
      failed = true;
    }
    disk.repair();
    if (!failed) break;
    ++failures;
    const bool go_on = std::filesystem::exists(file);
    resumed += go_on ? 1 : 0;
    ASSERT_EQ(finish(mapLogs(request, {}, everyEntry(go_on))), expected) << operations;
  }
  EXPECT_GT(failures, 20);
  EXPECT_GT(resumed, 10);
}

INSTANTIATE_TEST_SUITE_P(Errors, RunOnAFailingDisk, testing::ValuesIn(kDiskErrors), diskErrorName);

}  // namespace
}  // namespace csom::test
