// SPDX-License-Identifier: BSD-3-Clause
// What docs/architecture.md allows beside each other, for ThreadSanitizer to watch: questions to
// one map, copies that go their own ways, and the threads of an insertion.
#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "core/RandomImages.h"
#include "core/RandomScans.h"

namespace csom::test {
namespace {

constexpr int kThreads = 8;

/// Calls work(i) for i = 0 … kThreads − 1, each on a thread of its own.
void onThreads(const std::function<void(int)>& work) {
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) threads.emplace_back(work, i);
  for (std::thread& thread : threads) thread.join();
}

Options someOptions() {
  Options options;
  options.number_of_classes = 6;
  options.resolution = 0.25;
  options.free_space.mode = FreeSpace::Raycast;
  return options;
}

Scan someScan(std::uint64_t seed) {
  RandomCase random(seed);
  Scan scan;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point(random.real(-8, 8), random.real(-8, 8), random.real(-2, 2));
    scan.points.push_back(point.cast<float>());
    scan.labels.push_back(static_cast<ClassId>(random.integer(1, 5)));
  }
  return scan;
}

SemanticMap someMap() {
  SemanticMap map(someOptions());
  map.insert(someScan(1));
  return map;
}

/// Answers to one of each kind of question, as text.
std::string answersOf(const SemanticMap& map, const Eigen::Vector3d& point) {
  std::string answers = std::to_string(map.at(point).occupancy());
  const auto note = [&answers](const VoxelIndex& v, double number) {
    answers += " (" + std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z) +
               ") " + std::to_string(number);
  };
  if (const auto hit = map.castRay({0, 0, 0}, point, 20)) note(hit->voxel, hit->distance);
  if (const auto near = map.nearestOccupied(point, 2)) note(near->voxel, near->distance);
  if (const auto near = map.nearestOccupied(point, 2, ClassId{3}))
    note(near->voxel, near->distance);
  const auto visit = [&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    if (voxel.state() == VoxelState::Occupied) note(v, voxel.entropy());
  };
  const VoxelIndex center = map.grid().voxelAt(point);
  map.forEachVoxelInBox(
      {{center.x - 2, center.y - 2, center.z - 2}, {center.x + 2, center.y + 2, center.z + 2}},
      visit);
  std::size_t known = 0;
  map.forEachVoxel([&](const VoxelIndex&, const DirichletVoxel&) { ++known; });
  note(map.boundingBox()->max, static_cast<double>(known + map.knownVoxelCount()));
  return answers + " " + std::to_string(map.memoryBytes());
}

TEST(Threads, MayAskOneMapAtATime) {
  const SemanticMap map = someMap();
  RandomCase random(2);
  std::vector<Eigen::Vector3d> points;
  std::vector<std::string> expected;
  for (int i = 0; i < 5; ++i) {
    points.emplace_back(random.real(-8, 8), random.real(-8, 8), random.real(-2, 2));
    expected.push_back(answersOf(map, points.back()));
  }
  onThreads([&](int) {
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_EQ(answersOf(map, points[i]), expected[i]);
  });
}

TEST(Threads, MayCopyOneMapAtATimeAndChangeTheCopies) {
  const SemanticMap map = someMap();
  const std::string before = bytesOf(map);
  SemanticMap both = map;
  both.insert(someScan(3));
  onThreads([&](int i) {
    SemanticMap copy(map);
    if (i % 2 == 0) {
      copy.insert(someScan(3));
      EXPECT_EQ(bytesOf(copy), bytesOf(both));
    } else {
      copy.merge(map);
      EXPECT_NE(bytesOf(copy), before);
    }
  });
  EXPECT_EQ(bytesOf(map), before);
}

TEST(Threads, MayEachHaveACopyOfAMapThatIsGone) {
  // The last thread to let go of a chunk changes it in place or frees it.
  std::vector<SemanticMap> copies(kThreads, someMap());
  onThreads([&](int i) {
    SemanticMap& copy = copies[static_cast<std::size_t>(i)];
    if (i % 2 == 0) copy.clear();
    copy.insert(someScan(1));
  });
  EXPECT_EQ(bytesOf(copies[0]), bytesOf(someMap()));
  EXPECT_EQ(bytesOf(copies[1]), bytesOf(copies[3]));
}

class ThreadsOfAnInsertion : public testing::TestWithParam<Method> {};

TEST_P(ThreadsOfAnInsertion, DoNotMeet) {
  for (const FreeSpace free_space :
       {FreeSpace::None, FreeSpace::Sampled, FreeSpace::Raycast, FreeSpace::Projective}) {
    Options options = someOptions();
    options.method = GetParam();
    options.free_space.mode = free_space;
    options.scan.ds_resolution = 0.1;
    SemanticMap one(options);
    options.threads = kThreads;
    SemanticMap many(options);
    for (const std::uint64_t seed : {1U, 2U}) {
      one.insert(someScan(seed));
      many.insert(someScan(seed));
    }
    EXPECT_EQ(bytesOf(many), bytesOf(one)) << toString(free_space);
  }
}

TEST(ThreadsOfAnInsertionWithAnImage, DoNotMeet) {
  RandomImage random(5);
  Options options = random.imageOptions();
  const Scan scan = random.image(options, 64, 400);
  ASSERT_GT(scan.points.size(), 8192U) << "too few to be cut into parts";
  for (const FreeSpace free_space : {FreeSpace::None, FreeSpace::Projective, FreeSpace::Raycast}) {
    options.free_space.mode = free_space;
    options.threads = 1;
    SemanticMap one(options);
    options.threads = kThreads;
    SemanticMap many(options);
    one.insert(scan);
    many.insert(scan);
    EXPECT_EQ(bytesOf(many), bytesOf(one)) << toString(free_space);
  }
}

INSTANTIATE_TEST_SUITE_P(, ThreadsOfAnInsertion,
                         testing::Values(Method::SurfaceCsom, Method::SeeCsom, Method::SBki,
                                         Method::SCsm),
                         methodName);

}  // namespace
}  // namespace csom::test
