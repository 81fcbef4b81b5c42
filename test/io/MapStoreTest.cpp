// SPDX-License-Identifier: BSD-3-Clause
// The file of a map in work: what was committed is in it, whatever happens.
#include <csom/io/MapRepair.h>
#include <csom/io/MapStore.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>

#include "io/FaultyDisk.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A scan of its own place and classes.
Scan scanNumber(int number) {
  std::mt19937 random(static_cast<unsigned>(number));
  std::uniform_real_distribution<float> offset(-1.4F, 1.4F);
  Scan scan;
  scan.origin = {0.7 * number, 0, 0};
  for (int i = 0; i < 60; ++i) {
    scan.points.emplace_back(offset(random), offset(random), offset(random));
    scan.labels.push_back(static_cast<ClassId>(1 + random() % 2));
  }
  return scan;
}

MapDocument emptyDocument() {
  MapDocument document = sampleDocument();
  document.map.clear();
  document.scans.clear();
  return document;
}

/// A map of `scans` scans that was never anywhere else than in memory.
SemanticMap mapOf(int scans) {
  SemanticMap map = emptyDocument().map;
  for (int i = 0; i < scans; ++i) map.insert(scanNumber(i));
  return map;
}

class MapStoreTest : public testing::Test {
 protected:
  /// Adds a scan to the store as a run with little memory does: its counts alone.
  void addScan(MapStore& store, int number) {
    SemanticMap increments = emptyDocument().map;
    const ScanReport report = increments.insert(scanNumber(number));
    records_.resize(store.scanCount());
    records_.push_back({100.0 + number, "lidar", "CObservationPointCloud", {0, 0, 0}, report});
    store.commit(increments.chunks().sorted(), MapStore::Voxels::Add, records_,
                 {{"done", std::to_string(number + 1)}});
  }

  std::vector<ScanRecord> records_;
  const TempFolder folder_;
  const std::string file_ = folder_ / "unfinished.csom";
};

TEST_F(MapStoreTest, PartsThatAreAddedAreTheMapOfAllScans) {
  auto store = MapStore::create(file_, emptyDocument(), {{"done", "0"}});
  for (int i = 0; i < 6; ++i) addScan(*store, i);
  EXPECT_EQ(store->digest(), mapDigest(mapOf(6)));
  EXPECT_EQ(store->scanCount(), 6U);
  EXPECT_EQ(mapDigest(store->loadVoxels()), mapDigest(mapOf(6)));

  std::size_t parts = 0;
  SemanticMap sum = emptyDocument().map;
  store->forEachPart(3000, [&](const SemanticMap& part) {
    ++parts;
    sum.merge(part);
  });
  EXPECT_GT(parts, 2U);
  EXPECT_EQ(mapDigest(sum), mapDigest(mapOf(6)));
}

TEST_F(MapStoreTest, ReplacedChunksAreTheNewOnes) {
  auto store = MapStore::create(file_, emptyDocument(), {});
  store->commit(mapOf(2).chunks().sorted(), MapStore::Voxels::Replace, {}, {});
  store->commit(mapOf(5).chunks().sorted(), MapStore::Voxels::Replace, {}, {});
  EXPECT_EQ(store->digest(), mapDigest(mapOf(5)));
  EXPECT_EQ(store->chunkCount(), mapOf(5).chunks().chunkCount());
}

TEST_F(MapStoreTest, SaturatedCountsStaySaturated) {
  // 2³² / 4096 of evidence is where counts end.
  MapDocument start = emptyDocument();
  SemanticMap map = start.map;
  Scan scan;
  scan.points.emplace_back(1.F, 0.F, 0.F);
  scan.labels.push_back(1);
  map.insert(scan);
  for (int doubling = 0; doubling < 24; ++doubling) map.merge(SemanticMap(map));
  auto store = MapStore::create(file_, start, {});
  store->commit(map.chunks().sorted(), MapStore::Voxels::Add, {}, {});
  store->commit(map.chunks().sorted(), MapStore::Voxels::Add, {}, {});
  map.merge(SemanticMap(map));
  EXPECT_EQ(store->digest(), mapDigest(map));
}

TEST_F(MapStoreTest, IsAMapThatSaysThatItIsUnfinished) {
  auto store = MapStore::create(file_, emptyDocument(), {{"key", std::string("\0\xff", 2)}});
  addScan(*store, 0);
  const MapDocument seen = loadMap(file_);
  EXPECT_EQ(seen.meta.at("state"), "unfinished");
  EXPECT_EQ(seen.meta.at("rawlog"), "dir/ä b.rawlog");
  EXPECT_EQ(mapDigest(seen.map), mapDigest(mapOf(1)));
  EXPECT_EQ(seen.scans.size(), 1U);
  const MapVerification verified = verifyMap(file_);
  EXPECT_FALSE(verified.finished);
  EXPECT_THAT(verified.faults, IsEmpty());
  EXPECT_EQ(readState(file_).at("done"), "1");
}

TEST_F(MapStoreTest, GoesOnWhereItWasLeft) {
  const MapStore::State state{{"bytes", std::string("\0\x01\xff", 3)}, {"done", "2"}};
  {
    auto store = MapStore::create(file_, emptyDocument(), {});
    addScan(*store, 0);
    addScan(*store, 1);
    store->commit({}, MapStore::Voxels::Add, records_, state);
  }
  auto store = MapStore::open(file_);
  EXPECT_EQ(store->state(), state);
  EXPECT_EQ(store->loadScans().size(), 2U);
  addScan(*store, 2);
  EXPECT_EQ(store->digest(), mapDigest(mapOf(3)));
  EXPECT_EQ(store->loadScans().size(), 3U);
}

TEST_F(MapStoreTest, TheFinishedFileIsOnePlainMap) {
  auto store = MapStore::create(file_, emptyDocument(), {{"done", "0"}});
  for (int i = 0; i < 4; ++i) addScan(*store, i);
  store->writeFinished(folder_ / "map.csom", {{"created_by", "a test"}});
  MapStore::remove(std::move(store));
  EXPECT_THAT(folder_.fileNames(), ElementsAre("map.csom"));
  EXPECT_THAT(verifyMap(folder_ / "map.csom").faults, IsEmpty());
  const MapDocument map = loadMap(folder_ / "map.csom");
  EXPECT_EQ(mapDigest(map.map), mapDigest(mapOf(4)));
  EXPECT_EQ(map.scans.size(), 4U);
  EXPECT_THAT(map.meta, ElementsAre(testing::Pair("created_by", "a test")));
  EXPECT_THAT(fileErrorOf([&] { readState(folder_ / "map.csom"); }),
              HasSubstr("is a finished map"));
}

TEST_F(MapStoreTest, HasOneWriter) {
  auto store = MapStore::create(file_, emptyDocument(), {});
  EXPECT_THAT(fileErrorOf([&] { MapStore::open(file_); }),
              HasSubstr(file_ + ": is being written by another process"));
  EXPECT_THAT(fileErrorOf([&] { MapStore::create(file_, emptyDocument(), {}); }),
              HasSubstr("is there already"));
  store.reset();
  EXPECT_NO_THROW(MapStore::open(file_));
  EXPECT_THAT(folder_.fileNames(), ElementsAre("unfinished.csom"));
}

// Readers in other processes see one commit or the next, never a part of one.
TEST_F(MapStoreTest, ManyReadWhileOneWrites) {
  constexpr int kScans = 25, kReaders = 3;
  std::vector<std::string> digests;
  for (int i = 0; i <= kScans; ++i) digests.push_back(mapDigest(mapOf(i)));
  std::vector<pid_t> readers;
  for (int r = 0; r < kReaders; ++r) {
    const pid_t pid = ::fork();
    ASSERT_GE(pid, 0);
    if (pid > 0) {
      readers.push_back(pid);
      continue;
    }
    // Until all scans are there; what is read must be what was committed, and never older than
    // what was read before.
    std::size_t last = 0;
    while (!std::filesystem::exists(file_)) ::usleep(100);
    while (last < kScans) {
      try {
        const MapDocument seen = loadMap(file_);
        if (seen.scans.size() < last || mapDigest(seen.map) != digests.at(seen.scans.size()))
          ::_exit(1);
        last = seen.scans.size();
      } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        ::_exit(2);
      }
    }
    ::_exit(0);
  }
  // Only now: a connection must not be carried over into another process.
  auto store = MapStore::create(file_, emptyDocument(), {});
  for (int i = 0; i < kScans; ++i) addScan(*store, i);
  for (const pid_t reader : readers) {
    int status = -1;
    ASSERT_EQ(::waitpid(reader, &status, 0), reader);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
  }
}

/// Every write or flush of a run fails once, and with it all that come later.
class FailingDisk : public MapStoreTest, public testing::WithParamInterface<int> {};

TEST_P(FailingDisk, LosesNothingThatWasCommitted) {
  constexpr int kScans = 3;
  FaultyDisk disk;
  int failures = 0;
  for (long operations = 0;; ++operations) {
    for (const char* ending : {"", "-wal", "-shm"}) std::filesystem::remove(file_ + ending);
    disk.repair();
    auto store = MapStore::create(file_, emptyDocument(), {{"done", "0"}});
    disk.failAfter(operations, GetParam());
    int committed = 0;
    std::string error;
    try {
      for (; committed < kScans; ++committed) addScan(*store, committed);
    } catch (const FileError& failure) {
      error = failure.what();
    }
    store.reset();
    disk.repair();
    if (!error.empty()) {
      ++failures;
      EXPECT_THAT(error, HasSubstr(file_ + ": cannot be "));
    }
    store = MapStore::open(file_);
    // What failed may be in the file all the same if only the flush failed.
    const int done = std::stoi(store->state().at("done"));
    ASSERT_GE(done, committed) << "after " << operations << " operations";
    ASSERT_EQ(store->scanCount(), static_cast<std::size_t>(done));
    for (int i = done; i < kScans; ++i) addScan(*store, i);
    ASSERT_EQ(store->digest(), mapDigest(mapOf(kScans))) << "after " << operations;
    ASSERT_THAT(verifyMap(file_).faults, IsEmpty());
    if (error.empty()) break;
  }
  EXPECT_GT(failures, 20);
}

INSTANTIATE_TEST_SUITE_P(Errors, FailingDisk, testing::ValuesIn(kDiskErrors), diskErrorName);

}  // namespace
}  // namespace csom::test
