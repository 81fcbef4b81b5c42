// SPDX-License-Identifier: BSD-3-Clause
// Chunk records: against a plain std::map, and against hostile bytes.
#include <csom/core/ChunkStore.h>
#include <csom/core/DirichletVoxel.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <random>
#include <string>

namespace csom {
namespace {

constexpr int kClasses = 20;
using Reference = std::map<std::pair<int, int>, std::uint32_t>;  // (voxel, class) → count

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int upTo(int max) { return std::uniform_int_distribution<int>(0, max)(engine_); }

 private:
  std::mt19937 engine_;
};

std::vector<CountIncrement> randomIncrements(Random& random, int size) {
  Reference unique;
  for (int i = 0; i < size; ++i)
    unique[{random.upTo(511), random.upTo(kClasses - 1)}] =
        static_cast<std::uint32_t>(1 + random.upTo(9999));
  std::vector<CountIncrement> out;
  for (const auto& [key, count] : unique)
    out.push_back({static_cast<std::uint16_t>(key.first), static_cast<ClassId>(key.second), count});
  return out;
}

Reference contentOf(const Chunk& chunk) {
  Reference content;
  std::vector<int> known;
  chunk.forEachKnown([&](int voxel) { known.push_back(voxel); });
  std::vector<int> visited;
  chunk.forEachVoxel([&](int voxel, const Chunk::Entries& entries) {
    visited.push_back(voxel);
    EXPECT_EQ(entries.counts, chunk.at(voxel).counts);
    EXPECT_EQ(entries.classes, chunk.at(voxel).classes);
    EXPECT_EQ(entries.size, chunk.at(voxel).size);
    EXPECT_GT(entries.size, 0);
    for (int i = 0; i < entries.size; ++i) content[{voxel, entries.classes[i]}] = entries.counts[i];
  });
  EXPECT_EQ(visited, known);
  return content;
}

std::string makeRecord(const Chunk& chunk) {
  return {static_cast<const char*>(chunk.record()), chunk.recordSize()};
}

TEST(Chunk, SumsAreThoseOfAPlainMap) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    Reference expected;
    ChunkRef chunk;
    for (int scan = 0; scan < 5; ++scan) {
      const auto increments = randomIncrements(random, 1 + random.upTo(round * 3));
      for (const CountIncrement& i : increments) expected[{i.voxel, i.class_id}] += i.count;
      chunk = Chunk::sum(chunk.get(), increments);
    }
    ASSERT_EQ(contentOf(*chunk), expected);
    for (int voxel = 0; voxel < kVoxelsPerChunk; ++voxel) {
      const bool known = expected.lower_bound({voxel, 0}) != expected.lower_bound({voxel + 1, 0});
      ASSERT_EQ(chunk->at(voxel).size > 0, known);
    }
    const std::string record = makeRecord(*chunk);
    const ChunkRef copy = Chunk::fromRecord(record.data(), record.size(), kClasses);
    ASSERT_EQ(makeRecord(*copy), record);
    ASSERT_EQ(makeRecord(*Chunk::sum(nullptr, chunk->toIncrements())), record)
        << "equal content, other bytes";
  }
}

TEST(Chunk, AddsInPlaceOnlyWhenAloneAndComplete) {
  Random random(2);
  const auto increments = randomIncrements(random, 300);
  ChunkRef chunk = Chunk::sum(nullptr, increments);
  const std::string once = makeRecord(*chunk);
  {
    const ChunkRef shared = chunk;
    EXPECT_FALSE(chunk.addInPlace(increments));
    EXPECT_EQ(makeRecord(*chunk), once);
  }
  EXPECT_TRUE(chunk.addInPlace(increments));
  const ChunkRef base = Chunk::sum(nullptr, increments);
  EXPECT_EQ(makeRecord(*chunk), makeRecord(*Chunk::sum(base.get(), increments)));
  EXPECT_FALSE(Chunk::sum(nullptr, {{5, 1, 10}}).addInPlace({{5, 2, 10}}));
}

TEST(Chunk, HoldsEveryClassOfEveryVoxel) {
  std::vector<CountIncrement> all;
  for (int voxel = 0; voxel < kVoxelsPerChunk; ++voxel)
    for (int k = 0; k < kMaxClasses; ++k)
      all.push_back({static_cast<std::uint16_t>(voxel), static_cast<ClassId>(k),
                     static_cast<std::uint32_t>(voxel * 256 + k + 1)});
  const ChunkRef chunk = Chunk::sum(nullptr, all);
  EXPECT_EQ(chunk->knownVoxels(), kVoxelsPerChunk);
  EXPECT_EQ(chunk->at(511).counts[255], 511U * 256 + 256);
  const std::string record = makeRecord(*chunk);
  EXPECT_EQ(makeRecord(*Chunk::fromRecord(record.data(), record.size(), kMaxClasses)), record);
}

TEST(Chunk, RefusesRecordsThatAreNotValid) {
  Random random(3);
  const std::string good = makeRecord(*Chunk::sum(nullptr, randomIncrements(random, 60)));
  ASSERT_NO_THROW(Chunk::fromRecord(good.data(), good.size(), kClasses));
  EXPECT_THROW(Chunk::fromRecord(good.data(), good.size(), 2), std::runtime_error)
      << "classes beyond K";
  for (std::size_t size = 0; size < good.size(); ++size)
    ASSERT_THROW(Chunk::fromRecord(good.data(), size, kClasses), std::runtime_error)
        << "cut to " << size;
  EXPECT_THROW(Chunk::fromRecord((good + std::string(8, '\0')).data(), good.size() + 8, kClasses),
               std::runtime_error);

  std::size_t refused = 0;
  for (std::size_t byte = 0; byte < good.size(); ++byte) {
    for (int flip = 1; flip < 256; flip *= 2) {
      std::string bad = good;
      bad[byte] = static_cast<char>(bad[byte] ^ flip);
      try {
        // What is accepted must be a record that its own content builds again: canonical.
        const ChunkRef chunk = Chunk::fromRecord(bad.data(), bad.size(), kClasses);
        ASSERT_EQ(makeRecord(*Chunk::sum(nullptr, chunk->toIncrements())), bad);
      } catch (const std::runtime_error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 120U * 8 / 2) << "most damage to the header must be noticed";
}

TEST(ChunkStore, FindsWhatAMapFindsAndListsInOrder) {
  Random random(4);
  ChunkStore store;
  std::map<ChunkIndex, Reference> expected;
  for (int round = 0; round < 2000; ++round) {
    const ChunkIndex index{random.upTo(40) - 20, random.upTo(40) - 20, random.upTo(10) - 5};
    const auto increments = randomIncrements(random, 3);
    store.add({{index, increments}}, 1);
    for (const CountIncrement& i : increments) expected[index][{i.voxel, i.class_id}] += i.count;
  }
  EXPECT_EQ(store.chunkCount(), expected.size());
  auto it = expected.begin();
  for (const auto& [index, chunk] : store.sorted()) {
    ASSERT_EQ(index, it->first);
    ASSERT_EQ(contentOf(*chunk), it->second);
    ASSERT_EQ(store.find(index), chunk);
    ++it;
  }
  EXPECT_EQ(store.find({100, 100, 100}), nullptr);
  EXPECT_EQ(ChunkStore().find({0, 0, 0}), nullptr);
}

TEST(ChunkStore, CopiesShareUntilWritten) {
  Random random(5);
  const auto increments = randomIncrements(random, 20);
  ChunkStore original;
  original.add({{{0, 0, 0}, increments}, {{-1, 2, 3}, increments}}, 1);
  ChunkStore copy = original;
  EXPECT_EQ(copy.find({0, 0, 0}), original.find({0, 0, 0}));
  const std::string before = makeRecord(*original.find({0, 0, 0}));
  copy.add({{{0, 0, 0}, increments}}, 1);
  EXPECT_NE(copy.find({0, 0, 0}), original.find({0, 0, 0}));
  EXPECT_EQ(makeRecord(*original.find({0, 0, 0})), before);
  EXPECT_EQ(copy.find({-1, 2, 3}), original.find({-1, 2, 3})) << "untouched chunks stay shared";
  original.clear();
  EXPECT_EQ(copy.chunkCount(), 2U);
}

TEST(ChunkStore, FreeVoxelsAreIncrementsLikeOthers) {
  Random random(4);
  int in_place = 0;
  for (int round = 0; round < 200; ++round) {
    ChunkStore store;
    ChunkStore expected;
    ChunkStore shared;  // keeps the first sum to itself: nothing may change in place then
    FreeIncrements free;
    for (int step = 0; step < 4; ++step) {
      std::vector<CountIncrement> others;
      if (random.upTo(2) == 0) others = randomIncrements(random, 1 + random.upTo(200));
      // Now and then the same voxels again, so that all are there already.
      if (step == 0 || random.upTo(1) == 0) {
        for (std::uint64_t& word : free.voxels) {
          word = 0;
          const int kind = random.upTo(3);
          for (int bit = 0; bit < 64; ++bit)
            if (kind == 0 || (kind == 1 && random.upTo(1) == 0)) word |= std::uint64_t{1} << bit;
        }
        free.voxels[static_cast<std::size_t>(random.upTo(7))] |= 1;
      }
      free.count = static_cast<std::uint32_t>(1 + random.upTo(9999));
      std::vector<CountIncrement> all;
      for (int voxel = 0; voxel < 512; ++voxel) {
        const bool is_free =
            (free.voxels[static_cast<std::size_t>(voxel / 64)] >> (voxel % 64) & 1U) != 0;
        if (is_free) all.push_back({static_cast<std::uint16_t>(voxel), kFreeClass, free.count});
        for (const CountIncrement& other : others)
          if (other.voxel == voxel && !(is_free && other.class_id == kFreeClass))
            all.push_back(other);
      }
      std::vector<CountIncrement> rest;
      for (const CountIncrement& other : all)
        if (other.class_id != kFreeClass ||
            (free.voxels[other.voxel / 64U] >> (other.voxel % 64U) & 1U) == 0)
          rest.push_back(other);
      const Chunk* const before = store.find({1, 2, 3});
      store.add(ScanIncrements{{{1, 2, 3}, rest, free}}, 1);
      expected.add(ScanIncrements{{{1, 2, 3}, all, {}}}, 1);
      in_place += before != nullptr && store.find({1, 2, 3}) == before ? 1 : 0;
      ASSERT_EQ(makeRecord(*store.find({1, 2, 3})), makeRecord(*expected.find({1, 2, 3})));
      if (shared.chunkCount() == 0 && random.upTo(3) == 0) shared = store;
    }
    EXPECT_EQ(Chunk::fromRecord(makeRecord(*store.find({1, 2, 3})).data(),
                                store.find({1, 2, 3})->recordSize(), kClasses)
                  ->knownVoxels(),
              expected.find({1, 2, 3})->knownVoxels());
  }
  EXPECT_GT(in_place, 20);
}

TEST(ChunkStore, CountsSaturateInsteadOfWrapping) {
  ChunkStore store;
  for (int i = 0; i < 3; ++i) store.add({{{0, 0, 0}, {{7, 1, 0xf0000000U}}}}, 1);
  EXPECT_EQ(store.find({0, 0, 0})->at(7).counts[0], kMaxCount);
}

TEST(ChunkStore, AddingAStoreToItselfDoubles) {
  ChunkStore store;
  for (int x = 0; x < 30; ++x) store.add({{{x, 0, 0}, {{1, 1, 5}}}}, 1);
  store.add(store);
  EXPECT_EQ(store.chunkCount(), 30U);
  store.forEach(
      [](const ChunkIndex&, const Chunk& chunk) { EXPECT_EQ(chunk.at(1).counts[0], 10U); });
}

}  // namespace
}  // namespace csom
