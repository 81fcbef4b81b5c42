// SPDX-License-Identifier: BSD-3-Clause
// How well labelled points fit to a map.
#include <csom/maps/ObservationLikelihood.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace csom {
namespace {

/// The voxel that a point is compared with.
struct Match {
  VoxelIndex voxel;
  double distance = 0;  ///< at most max_distance [m]
};

/// Compares the points of one observation, seen from one pose, with a map.
class Comparison {
 public:
  Comparison(const SemanticMap& map, const NearestVoxelField& field,
             const LikelihoodOptions& options, const Eigen::Isometry3d& sensor)
      : map_(map),
        options_(options),
        sensor_(sensor),
        nearest_(field, map, options.max_distance),
        unlabelled_(static_cast<ClassId>(map.options().unlabelled_class_id)) {
    const int without = unlabelled_ == kFreeClass ? 1 : 2;  // free space, and the unlabelled
    classes_ = std::max(1, map.options().number_of_classes - without);
  }

  void add(const Eigen::Vector3d& point, ClassId label) {
    const std::optional<Match> match =
        options_.method == LikelihoodMethod::Beam ? onBeam(point) : nearTo(sensor_ * point);
    const double distance = match ? match->distance : options_.max_distance;
    squares_ += distance * distance;
    ++points_;
    if (options_.semantic_weight == 0 || label == kFreeClass) return;
    const double share = match ? shareOf(label, match->voxel) : 1.0 / classes_;
    label_logs_ += std::log((1 - options_.label_error) * share + options_.label_error / classes_);
    ++labelled_;
  }

  double logLikelihood() const {
    if (points_ == 0) return 0;
    const double squares = squares_ / static_cast<double>(points_);
    const double geometry = -0.5 * squares / (options_.sigma * options_.sigma);
    if (labelled_ == 0) return geometry;
    return geometry + options_.semantic_weight * label_logs_ / static_cast<double>(labelled_);
  }

 private:
  std::optional<Match> nearTo(const Eigen::Vector3d& point) {
    const auto found = nearest_.nearest(point);
    if (!found) return std::nullopt;
    return Match{found->voxel, found->distance};
  }

  /// The first stretch of occupied voxels on the beam. Surfaces of a map are as thick as its
  /// kernels are long: a beam that ends anywhere in that stretch fits.
  std::optional<Match> onBeam(const Eigen::Vector3d& point) const {
    const double range = point.norm();
    if (!(range > 0)) return std::nullopt;
    const Eigen::Vector3d origin = sensor_.translation();
    const Eigen::Vector3d direction = sensor_.linear() * (point / range);
    const auto hit = map_.castRay(origin, direction, range + options_.max_distance);
    if (!hit) return std::nullopt;
    VoxelIndex voxel = hit->voxel;
    double at = hit->distance;
    while (at < range) {
      const double next = std::min(at + 0.5 * map_.grid().resolution(), range);
      const Eigen::Vector3d point_there = origin + next * direction;
      if (map_.at(point_there).state() != VoxelState::Occupied) break;
      voxel = map_.grid().voxelAt(point_there);
      at = next;
    }
    const double distance = std::abs(at - range);
    if (distance > options_.max_distance) return std::nullopt;
    return Match{voxel, distance};
  }

  /// What a voxel gives to a class, of all that it gives to known ones.
  double shareOf(ClassId label, const VoxelIndex& index) const {
    const DirichletVoxel voxel = map_.voxel(index);
    double others = voxel.evidence() - voxel.evidence(kFreeClass);
    if (unlabelled_ != kFreeClass) others -= voxel.evidence(unlabelled_);
    const double prior = map_.options().prior;
    return (prior + voxel.evidence(label)) / (classes_ * prior + others);
  }

  const SemanticMap& map_;
  const LikelihoodOptions& options_;
  Eigen::Isometry3d sensor_;
  NearestVoxelReader nearest_;
  ClassId unlabelled_;
  int classes_ = 1;  ///< that a label can say
  double squares_ = 0;
  double label_logs_ = 0;
  std::size_t points_ = 0;
  std::size_t labelled_ = 0;
};

}  // namespace

double logLikelihood(const SemanticMap& map, const NearestVoxelField& field,
                     const LikelihoodOptions& options, const std::vector<Eigen::Vector3d>& points,
                     const std::vector<ClassId>& labels, const Eigen::Isometry3d& sensor) {
  Comparison comparison(map, field, options, sensor);
  for (std::size_t i = 0; i < points.size(); ++i) comparison.add(points[i], labels[i]);
  return comparison.logLikelihood();
}

}  // namespace csom
