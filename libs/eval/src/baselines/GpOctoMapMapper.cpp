// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/GpOctoMapMapper.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "baselines/BetaCounts.h"
#include "baselines/SparseVoxels.h"
#include "baselines/TrainingData.h"

namespace csom {
namespace detail {

/// A Gaussian in information form, without its prior: sums of it are a committee's.
struct FusedGaussian {
  double information = 0;       ///< Σ (1/σ_i² − 1/σ_f²)
  double information_mean = 0;  ///< Σ μ_i/σ_i²
};

}  // namespace detail

struct GpOctoMapMapper::BlockPoints {
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> labels;

  void add(const Eigen::Vector3d& position, double label) {
    positions.push_back(position);
    labels.push_back(label);
  }
};

GpOctoMapMapper::GpOctoMapMapper(const Options& input, const GpOctoMapParameters& parameters)
    : input_(detail::validInput(input)),
      parameters_(parameters),
      grid_(input.resolution),
      voxels_(std::make_unique<detail::SparseVoxels<detail::FusedGaussian>>()) {
  detail::checkParameter("kernel_length", parameters_.kernel_length, 1e-6, 1e7);
  detail::checkParameter("signal_variance", parameters_.signal_variance, 1e-6, 1e6);
  // Less would leave the covariance of points that coincide without a Cholesky decomposition.
  detail::checkParameter("noise_variance", parameters_.noise_variance,
                         1e-6 * parameters_.signal_variance, 1e6);
  detail::checkParameter("block_depth", parameters_.block_depth, 1, 4);
  detail::checkParameter("logistic_slope", parameters_.logistic_slope, 1e-6, 1e9);
  detail::checkParameter("min_variance", parameters_.min_variance, 1e-9, 1e6);
  detail::checkParameter("max_known_variance", parameters_.max_known_variance, 0, 1e9);
  detail::checkParameter("occupied_threshold", parameters_.occupied_threshold, 0, 1);
}

GpOctoMapMapper::~GpOctoMapMapper() = default;

void GpOctoMapMapper::insert(const Scan& scan) {
  const detail::TrainingData data = detail::makeTrainingData(scan, input_, input_.free_space.mode);
  const BlockLayout layout(parameters_.block_depth);
  std::map<BlockIndex, BlockPoints> blocks;
  const auto blockAt = [&](const Eigen::Vector3d& point) -> BlockPoints& {
    return blocks[layout.blockOf(grid_.voxelAt(point))];
  };
  for (const Eigen::Vector3d& hit : data.hits) blockAt(hit).add(hit, 1);
  for (const Eigen::Vector3d& point : data.free_points) blockAt(point).add(point, -1);
  for (const auto& [block, training] : blocks) fusePredictionsOf(block, training);
}

void GpOctoMapMapper::fusePredictionsOf(const BlockIndex& block, const BlockPoints& training) {
  const auto points = static_cast<Eigen::Index>(training.positions.size());
  const auto position = [&](Eigen::Index i) -> const Eigen::Vector3d& {
    return training.positions[static_cast<std::size_t>(i)];
  };
  Eigen::MatrixXd among_points(points, points);  // the lower triangle is all that is read
  for (Eigen::Index j = 0; j < points; ++j)
    for (Eigen::Index i = j; i < points; ++i)
      among_points(i, j) = covariance((position(i) - position(j)).norm());
  among_points.diagonal().array() += parameters_.noise_variance;
  const Eigen::LLT<Eigen::MatrixXd> cholesky(among_points);
  const Eigen::VectorXd weights =
      cholesky.solve(Eigen::Map<const Eigen::VectorXd>(training.labels.data(), points));

  const std::vector<VoxelIndex> targets = predictedBy(block);
  Eigen::MatrixXd to_targets(points, static_cast<Eigen::Index>(targets.size()));
  for (Eigen::Index t = 0; t < to_targets.cols(); ++t) {
    const Eigen::Vector3d center = grid_.center(targets[static_cast<std::size_t>(t)]);
    for (Eigen::Index i = 0; i < points; ++i)
      to_targets(i, t) = covariance((position(i) - center).norm());
  }
  const Eigen::VectorXd means = to_targets.transpose() * weights;
  cholesky.matrixL().solveInPlace(to_targets);
  const Eigen::VectorXd explained = to_targets.colwise().squaredNorm();

  const double prior = parameters_.signal_variance;
  for (Eigen::Index t = 0; t < to_targets.cols(); ++t) {
    const double variance = std::max(prior - explained[t], parameters_.min_variance);
    detail::FusedGaussian& voxel = (*voxels_)[targets[static_cast<std::size_t>(t)]];
    voxel.information += std::max(1 / variance - 1 / prior, 0.0);
    voxel.information_mean += means[t] / variance;
  }
}

std::vector<VoxelIndex> GpOctoMapMapper::predictedBy(const BlockIndex& block) const {
  constexpr std::array<std::array<int, 3>, 7> kExtendedBlock{
      {{0, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
  const int side = BlockLayout(parameters_.block_depth).side();
  std::vector<VoxelIndex> voxels;
  for (const auto& [dx, dy, dz] : kExtendedBlock)
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          voxels.push_back(
              {(block.x + dx) * side + x, (block.y + dy) * side + y, (block.z + dz) * side + z});
  return voxels;
}

/// Matérn, ν = 3/2.
double GpOctoMapMapper::covariance(double distance) const {
  const double scaled = std::sqrt(3.0) * distance / parameters_.kernel_length;
  return parameters_.signal_variance * (1 + scaled) * std::exp(-scaled);
}

VoxelEstimate GpOctoMapMapper::at(const Eigen::Vector3d& center) const {
  if (!grid_.contains(center)) return {};
  const detail::FusedGaussian* voxel = voxels_->find(grid_.voxelAt(center));
  if (voxel == nullptr || voxel->information == 0) return {};
  const double variance = 1 / (1 / parameters_.signal_variance + voxel->information);
  if (variance > parameters_.max_known_variance) return {};
  const double log_odds =
      parameters_.logistic_slope * parameters_.min_variance * voxel->information_mean;
  return detail::occupancyEstimate(1 / (1 + std::exp(-log_odds)), parameters_.occupied_threshold);
}

}  // namespace csom
