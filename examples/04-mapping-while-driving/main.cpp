// SPDX-License-Identifier: BSD-3-Clause
// One thread inserts scans, another plans on the latest map. A copy of a map costs a pointer a
// chunk and shares all voxels until they change, so the planner never waits for an insertion to
// end, and what it sees does not change under it.
#include <csom/core/SemanticMap.h>

#include <atomic>
#include <cstdio>
#include <memory>
#include <mutex>
#include <thread>

namespace {

/// The latest map, handed from the mapper to whoever asks.
class LatestMap {
 public:
  void set(const csom::SemanticMap& map) {
    auto copy = std::make_shared<const csom::SemanticMap>(map);
    const std::lock_guard<std::mutex> lock(mutex_);
    latest_.swap(copy);
  }
  std::shared_ptr<const csom::SemanticMap> get() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return latest_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const csom::SemanticMap> latest_ = std::make_shared<csom::SemanticMap>();
};

/// What a sensor at x sees of a corridor that ends at 20 m.
csom::Scan corridor(double x) {
  csom::Scan scan;
  scan.origin = {x, 0, 1};
  for (float z = -1; z <= 1; z += 0.1F)
    for (float across = -2; across <= 2; across += 0.1F) {
      scan.points.emplace_back(static_cast<float>(20 - x), across, z);  // the end
      scan.points.emplace_back(across + 3, 2.F, z);                     // the left wall
      scan.points.emplace_back(across + 3, -2.F, z);                    // the right wall
    }
  scan.labels.assign(scan.points.size(), 1);
  return scan;
}

}  // namespace

int main() {
  constexpr int kScans = 15;
  csom::Options options;
  options.free_space.mode = csom::FreeSpace::Raycast;
  LatestMap latest;
  std::atomic<bool> driving{true};

  std::thread mapper([&] {
    csom::SemanticMap map(options);
    for (int i = 0; i < kScans; ++i) {
      map.insert(corridor(i));
      latest.set(map);
    }
    driving = false;
  });

  int plans = 0;
  while (driving) {
    const std::shared_ptr<const csom::SemanticMap> map = latest.get();
    map->castRay({0, 0, 1}, {1, 0, 0}, 50);  // any number of questions to one unchanging map
    ++plans;
  }
  mapper.join();

  const auto end = latest.get()->castRay({0, 0, 1}, {1, 0, 0}, 50);
  std::printf("%d plans while %d scans were inserted; the corridor ends after %.1f m\n", plans,
              kScans, end ? end->distance : -1);
  return end && end->distance > 19 ? 0 : 1;
}
