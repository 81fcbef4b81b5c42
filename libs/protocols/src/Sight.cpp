// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/core/Grid.h>
#include <csom/eval/GroundTruth.h>
#include <csom/protocols/Sight.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace csom {
namespace {

/// Between the outermost lasers of a VLP-16 [rad].
constexpr double kMaxElevation = 15 * 3.14159265358979323846 / 180;

struct Watched {
  bool moved = false;
  std::size_t began = 0;     ///< the scan since which time counts
  double seen = 0;           ///< time of clear sight [s]
  std::size_t interval = 0;  ///< the next one of kSightSeconds
};

/// The sensor at the time of one scan.
class Viewpoint {
 public:
  Viewpoint(const Scenario& scenario, const VelodyneModel& model, double time)
      : world_(scenario.world),
        range_(model.range),
        time_(time),
        map_from_sensor_(scenario.path.at(time).isometry() * model.mount.pose()) {}

  /// What the beam through a point ends on.
  std::optional<SurfaceHit> surfaceTowards(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d beam = point - origin();
    return world_.castRay(origin(), beam.normalized(), range_.max + 1, time_);
  }

  /// `depth`: how deep in a solid the point may lie [m].
  bool sees(const Eigen::Vector3d& point, double depth) const {
    const Eigen::Vector3d in_sensor = map_from_sensor_.inverse() * point;
    const double distance = in_sensor.norm();
    if (distance < range_.min || distance > range_.max) return false;
    if (std::abs(std::asin(in_sensor.z() / distance)) > kMaxElevation) return false;
    return !world_.castRay(origin(), (point - origin()) / distance, distance - depth, time_);
  }

  bool isTouchedByMovers(const Eigen::AlignedBox3d& voxel) const {
    return std::any_of(world_.movingSolids().begin(), world_.movingSolids().end(),
                       [&](const MovingSolid& mover) {
                         const Eigen::Vector3d offset = mover.offsetAt(time_);
                         return mover.solid().touches({voxel.min() - offset, voxel.max() - offset});
                       });
  }

 private:
  Eigen::Vector3d origin() const { return map_from_sensor_.translation(); }

  const World& world_;
  RangeModel range_;
  double time_;
  Eigen::Isometry3d map_from_sensor_;
};

class SightPlan {
 public:
  SightPlan(const Scenario& scenario, double resolution)
      : world_(scenario.world), truth_(scenario.world, resolution) {}

  /// `number` of the scan: 1 is the first one. `period`: from scan to scan [s].
  void add(const Viewpoint& viewpoint, const Scan& scan, std::size_t number, double period) {
    for (const Eigen::Vector3f& point : scan.points)
      watch(viewpoint, scan.origin + point.cast<double>(), number);
    for (auto& [place, watched] : voxels_) look(viewpoint, place, watched, number, period);
  }

  std::vector<SightCheck> takeChecks() { return std::move(checks_); }

 private:
  using Place = std::tuple<std::int32_t, std::int32_t, std::int32_t>;

  void watch(const Viewpoint& viewpoint, const Eigen::Vector3d& point, std::size_t number) {
    if (!truth_.grid().contains(point)) return;
    const auto hit = viewpoint.surfaceTowards(point);
    if (!hit) return;
    const VoxelIndex voxel = truth_.grid().voxelAt(point);
    const Place place{voxel.x, voxel.y, voxel.z};
    const bool moved = hit->solid >= static_cast<int>(world_.solids().size());
    const auto known = voxels_.find(place);
    if (known != voxels_.end()) {
      if (moved && known->second.moved) known->second = {true, number};
      return;
    }
    if (truth_.at(voxel).state == (moved ? TruthState::Free : TruthState::Occupied))
      voxels_.emplace(place, Watched{moved, number});
  }

  void look(const Viewpoint& viewpoint, const Place& place, Watched& watched, std::size_t number,
            double period) {
    const bool done = watched.interval == kSightSeconds.size();
    if (watched.began == number || (done && !watched.moved)) return;
    const Grid& grid = truth_.grid();
    const auto [x, y, z] = place;
    const Eigen::Vector3d corner = grid.lowerCorner({x, y, z});
    const Eigen::AlignedBox3d cube(corner, corner + Eigen::Vector3d::Constant(grid.resolution()));
    if (viewpoint.isTouchedByMovers(cube)) {
      if (watched.moved) watched = {true, number};
      return;
    }
    const double depth = watched.moved ? 0 : grid.resolution() * std::sqrt(3.0) / 2;
    if (done || !viewpoint.sees(cube.center(), depth)) return;
    watched.seen += period;
    // Sums of tenths are not exact.
    for (; watched.interval < kSightSeconds.size() &&
           watched.seen > kSightSeconds[watched.interval] - 1e-6;
         ++watched.interval)
      checks_.push_back({number, watched.interval, watched.moved, cube.center()});
  }

  const World& world_;
  GroundTruth truth_;
  std::map<Place, Watched> voxels_;
  std::vector<SightCheck> checks_;
};

const VelodyneModel& lidarOf(const Scenario& scenario) {
  const VelodyneModel* lidar = nullptr;
  for (const SensorModel& sensor : scenario.sensors) {
    const auto* found = std::get_if<VelodyneModel>(&sensor);
    if (found == nullptr && std::holds_alternative<CameraModel>(sensor)) continue;
    if (found == nullptr || lidar != nullptr || found->sweep != VelodyneModel::Sweep::Instantaneous)
      throw ConfigError(scenario.file + ": sensor '" + mountOf(sensor).label +
                        "': the protocol needs one velodyne_vlp16 with `sweep: instantaneous`, "
                        "and no other range sensor");
    lidar = found;
  }
  if (lidar == nullptr) throw ConfigError(scenario.file + ": has no velodyne_vlp16");
  return *lidar;
}

}  // namespace

std::vector<SightCheck> planSightChecks(const Scenario& scenario, const std::vector<Scan>& scans,
                                        double resolution) {
  const VelodyneModel& lidar = lidarOf(scenario);
  const double period = 1 / lidar.mount.rate;
  const auto turns = static_cast<std::size_t>(std::ceil(scenario.path.duration() / period - 1e-6));
  if (turns != scans.size())
    throw ConfigError(scenario.file + ": of " + std::to_string(turns) + " turns of sensor '" +
                      lidar.mount.label + "' only " + std::to_string(scans.size()) +
                      " have returns; the protocol needs all");
  SightPlan plan(scenario, resolution);
  for (std::size_t i = 0; i < scans.size(); ++i)
    plan.add({scenario, lidar, static_cast<double>(i) * period}, scans[i], i + 1, period);
  return plan.takeChecks();
}

}  // namespace csom
