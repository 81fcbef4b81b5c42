// SPDX-License-Identifier: BSD-3-Clause
// The points of an observation by which it is compared with a map.
#include <csom/maps/ObservedPoints.h>
#include <csom/maps/PointExtractor.h>
#include <mrpt/serialization/CArchive.h>
#include <xxhash.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace csom {
namespace {

/// An archive that keeps a checksum of what is written to it, and nothing else.
class ChecksumArchive : public mrpt::serialization::CArchive {
 public:
  ChecksumArchive() { XXH3_64bits_reset(&state_); }
  std::uint64_t checksum() const { return XXH3_64bits_digest(&state_); }

 protected:
  std::size_t write(const void* data, std::size_t size) override {
    XXH3_64bits_update(&state_, data, size);
    return size;
  }
  std::size_t read(void* /*data*/, std::size_t /*size*/) override { return 0; }

 private:
  XXH3_state_t state_;
};

std::uint64_t computeChecksum(const mrpt::obs::CObservation& observation) {
  ChecksumArchive archive;
  archive.WriteObject(observation);
  return archive.checksum();
}

ClassId classOf(const PointLabel& label, ClassId unlabelled) {
  const bool says_a_class = label.kind == PointLabel::Kind::Class && label.id != unlabelled;
  return says_a_class ? label.id : kFreeClass;
}

}  // namespace

ObservedPoints observedPoints(const mrpt::obs::CObservation& observation, const LabelRules& rules,
                              int decimation, ClassId unlabelled) {
  const PointExtractor* const extractor = findPointExtractor(observation);
  if (extractor == nullptr) throw std::runtime_error("it is of a kind that has no points");
  const SensorPoints seen = extractor->extract(observation, rules);
  ObservedPoints out;
  out.sensor_pose = seen.sensor_pose;
  const auto step = static_cast<std::size_t>(std::max(1, decimation));
  for (std::size_t i = 0; i < seen.points.size(); i += step) {
    if (!seen.points[i].allFinite()) continue;
    out.points.push_back(seen.points[i].cast<double>());
    out.labels.push_back(classOf(seen.labels[i], unlabelled));
  }
  return out;
}

bool ObservedPointsCache::Key::operator==(const Key& other) const {
  return std::tie(checksum, decimation, source, scan_2d) ==
         std::tie(other.checksum, other.decimation, other.source, other.scan_2d);
}

ObservedPointsCache& ObservedPointsCache::operator=(const ObservedPointsCache& other) {
  if (this != &other) invalidate();
  return *this;
}

std::shared_ptr<const ObservedPoints> ObservedPointsCache::get(
    const mrpt::obs::CObservation& observation, const LabelRules& rules, int decimation,
    ClassId unlabelled) const {
  constexpr std::size_t kRemembered = 8;  // observations of one moment
  const Key key{computeChecksum(observation), decimation, rules.source(), rules.ofScan2D().id};
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [candidate, points] : known_) {
      if (candidate == key) return points;
    }
  }
  auto points = std::make_shared<const ObservedPoints>(
      observedPoints(observation, rules, decimation, unlabelled));
  const std::lock_guard lock(mutex_);
  known_.insert(known_.begin(), {key, points});
  if (known_.size() > kRemembered) known_.pop_back();
  return points;
}

void ObservedPointsCache::invalidate() {
  const std::lock_guard lock(mutex_);
  known_.clear();
}

}  // namespace csom
