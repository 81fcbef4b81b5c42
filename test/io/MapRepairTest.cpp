// SPDX-License-Identifier: BSD-3-Clause
// Damaged map files: every changed byte is found, and what is intact is saved.
#include <csom/io/MapRepair.h>

#include <random>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::size_t kPage = 4096;

class MapRepairTest : public testing::Test {
 protected:
  MapRepairTest() {
    saveMap(sampleDocument(), file_);
    bytes_ = readBytes(file_);
  }

  /// Overwrites the file with a byte of it changed; returns what stands there now.
  void damage(std::size_t at, unsigned char by) const {
    std::string damaged = bytes_;
    damaged[at] = static_cast<char>(static_cast<unsigned char>(damaged[at]) ^ by);
    writeBytes(file_, damaged);
  }

  /// Byte at which `text` begins.
  std::size_t placeOf(const std::string& text) const {
    const std::size_t at = bytes_.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    return at;
  }

  /// Every chunk of `map` is one of the sample, bit for bit.
  static void expectPartOfSample(const SemanticMap& map) {
    const SemanticMap sample = sampleMap();
    map.chunks().forEach([&](const ChunkIndex& index, const Chunk& chunk) {
      const Chunk* const original = sample.chunks().find(index);
      ASSERT_NE(original, nullptr);
      ASSERT_EQ(chunk.recordSize(), original->recordSize());
      EXPECT_EQ(std::memcmp(chunk.record(), original->record(), chunk.recordSize()), 0);
    });
  }

  const TempFolder folder_;
  const std::string file_ = folder_ / "map.csom";
  std::string bytes_;
};

TEST_F(MapRepairTest, AnIntactFileHasNoFaultsAndNothingIsLost) {
  const MapVerification found = verifyMap(file_);
  EXPECT_THAT(found.faults, IsEmpty());
  EXPECT_TRUE(found.finished);
  EXPECT_EQ(found.scans, 3U);
  EXPECT_EQ(found.chunks, sampleMap().chunks().chunkCount());
  EXPECT_EQ(found.digest, mapDigest(sampleMap()));

  const MapRepair repair = recoverMap(file_);
  EXPECT_THAT(repair.losses, IsEmpty());
  EXPECT_FALSE(repair.lost_chunks);
  saveMap(repair.document, folder_ / "again.csom");
  EXPECT_EQ(readBytes(folder_ / "again.csom"), bytes_);
}

// 10,000 single bytes: the whole of what a disk or a cable can do at once.
TEST_F(MapRepairTest, EveryChangedByteIsFoundAndNoneMakesAWrongVoxel) {
  const std::string digest = mapDigest(sampleMap());
  const std::size_t all_chunks = sampleMap().chunks().chunkCount();
  std::mt19937 random(7);
  int refused = 0, repaired = 0;
  std::size_t chunks_lost = 0;
  for (int i = 0; i < 10000; ++i) {
    const std::size_t at = random() % bytes_.size();
    damage(at, static_cast<unsigned char>(1 + random() % 255));
    try {
      ASSERT_EQ(mapDigest(loadMap(file_).map), digest) << "byte " << at;
    } catch (const FileError&) {
      ++refused;
    }
    try {
      ASSERT_THAT(verifyMap(file_).faults, Not(IsEmpty())) << "byte " << at;
    } catch (const FileError&) {
      // Of a later version, it seems: found as well.
    }
    if (i % 10 != 0) continue;
    const MapRepair repair = recoverMap(file_);
    ++repaired;
    expectPartOfSample(repair.document.map);
    const std::size_t chunks = repair.document.map.chunks().chunkCount();
    // A page holds a few chunks at most, and a byte is in one page.
    ASSERT_GE(chunks + 8, all_chunks) << "byte " << at;
    chunks_lost += all_chunks - chunks;
    ASSERT_EQ(repair.lost_chunks, chunks < all_chunks) << "byte " << at;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_EQ(repaired, 1000);
  EXPECT_GT(chunks_lost, 10U);
}

TEST_F(MapRepairTest, SavesEveryChunkWhereTheDatabaseCannotBeOpened) {
  damage(3, 0xff);  // "SQLite format 3"
  EXPECT_THROW(loadMap(file_), FileError);
  const MapRepair repair = recoverMap(file_);
  EXPECT_EQ(mapDigest(repair.document.map), mapDigest(sampleMap()));
  EXPECT_EQ(repair.document.scans.size(), 3U);
  EXPECT_EQ(repair.document.labels, sampleLabels());
  EXPECT_THAT(repair.losses, Contains(HasSubstr("all of it is there from the copy")));
}

TEST_F(MapRepairTest, SavesEveryOtherPageOfAHalfDestroyedFile) {
  std::string damaged = bytes_;
  std::mt19937 random(11);
  for (std::size_t page = 0; page < damaged.size() / kPage; page += 2)
    for (std::size_t i = 0; i < kPage; ++i) damaged[page * kPage + i] = static_cast<char>(random());
  writeBytes(file_, damaged);
  try {
    const MapRepair repair = recoverMap(file_);
    expectPartOfSample(repair.document.map);
    EXPECT_THAT(repair.losses, Not(IsEmpty()));
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("holds no options"));
  }
}

TEST_F(MapRepairTest, SaysWhichChunksAreLost) {
  const std::size_t chunks = sampleMap().chunks().chunkCount();
  // A zstd frame begins with these bytes; each is the record of a chunk.
  damage(placeOf("\x28\xb5\x2f\xfd") + 20, 1);
  const MapRepair repair = recoverMap(file_);
  EXPECT_TRUE(repair.lost_chunks);
  EXPECT_EQ(repair.document.map.chunks().chunkCount(), chunks - 1);
  EXPECT_THAT(repair.losses, Contains(HasSubstr("1 of " + std::to_string(chunks) +
                                                " chunks are lost: cubes of 2 m that begin at (")));
  EXPECT_EQ(repair.document.scans.size(), 3U);
}

TEST_F(MapRepairTest, SaysHowManyScansAreLost) {
  damage(placeOf("LIDAR'1"), 1);
  const MapRepair repair = recoverMap(file_);
  EXPECT_FALSE(repair.lost_chunks);
  EXPECT_EQ(repair.document.scans.size(), 2U);
  EXPECT_THAT(repair.losses, Contains(HasSubstr("the records of 1 of 3 scans are lost")));
}

TEST_F(MapRepairTest, TakesTheOptionsFromTheTablesIfTheirCopyIsDamaged) {
  // The description has texts with their lengths before them; the tables have none.
  const std::string length("\x0a\0\0\0\0\0\0\0", 8);
  damage(placeOf(length + "resolution"), 0x10);
  const MapRepair repair = recoverMap(file_);
  EXPECT_EQ(mapDigest(repair.document.map), mapDigest(sampleMap()));
  EXPECT_THAT(repair.losses, Contains(HasSubstr("the copy of options")));
}

TEST_F(MapRepairTest, VerifyListsWhatIsWrongWithItsPlace) {
  damage(placeOf("\x28\xb5\x2f\xfd") + 20, 1);
  const MapVerification found = verifyMap(file_);
  EXPECT_THAT(found.faults, Contains(HasSubstr("table chunks, row ")));
  EXPECT_THAT(found.faults, Contains(HasSubstr(" is not as it was written")));
  EXPECT_THAT(found.faults, Contains(HasSubstr("table meta says '" + mapDigest(sampleMap()))));
  EXPECT_EQ(found.chunks, sampleMap().chunks().chunkCount() - 1);
}

TEST_F(MapRepairTest, WhatIsNoMapCannotBeRepaired) {
  writeBytes(file_, std::string(20000, 'x'));
  EXPECT_THAT(fileErrorOf([&] { recoverMap(file_); }),
              HasSubstr(file_ + ": holds no options of a map"));
  EXPECT_THAT(verifyMap(file_).faults, Not(IsEmpty()));
  EXPECT_THAT(fileErrorOf([&] { recoverMap(folder_ / "none"); }), HasSubstr("no such file"));
}

// Once every pointer of a page was followed along chains that end nowhere: hours for a file of 8
// MB.
TEST_F(MapRepairTest, ChainsInCirclesEnd) {
  constexpr std::size_t kPages = 2000;
  constexpr std::size_t kCell = 3500;
  constexpr std::size_t kOwnBytes = 500;  // of the row, in the page of the cell
  constexpr std::size_t kRow = kOwnBytes + 244 * (kPage - 8 - 4);
  std::string bytes;
  for (std::size_t number = 1; number <= kPages; ++number) {
    std::string page(kPage, '\0');
    const auto put = [&](std::size_t at, std::size_t value, int size) {
      for (int i = 0; i < size; ++i)
        page[at + static_cast<std::size_t>(i)] = static_cast<char>(value >> (8 * (size - 1 - i)));
    };
    put(0, number, 4);  // as a continuation, it names itself
    for (std::size_t at = 8; at < kCell - 500; at += 2) put(at, kCell, 2);
    page[kCell] = static_cast<char>(0x80U | kRow >> 14U);
    page[kCell + 1] = static_cast<char>(0x80U | (kRow >> 7U & 0x7fU));
    page[kCell + 2] = static_cast<char>(kRow & 0x7fU);
    page[kCell + 3] = 1;  // number of the row
    put(kCell + 4 + kOwnBytes, number, 4);
    bytes += page;
  }
  writeBytes(file_, bytes);
  EXPECT_THAT(fileErrorOf([&] { recoverMap(file_); }), HasSubstr("holds no options of a map"));
}

}  // namespace
}  // namespace csom::test
