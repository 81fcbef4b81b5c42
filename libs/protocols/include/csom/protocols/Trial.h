// SPDX-License-Identifier: BSD-3-Clause
// One input with its truth, and how a method does on it.
#pragma once

#include <csom/core/Options.h>
#include <csom/eval/PointScore.h>
#include <csom/eval/VoxelEvaluation.h>
#include <csom/io/LabelSet.h>
#include <csom/protocols/LabelledCloud.h>
#include <csom/protocols/MethodSpec.h>
#include <csom/protocols/Sight.h>

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace csom {

/// What every method gets, and is scored by. Inputs and truths are shared between trials.
struct Trial {
  std::string protocol;  ///< "P1"
  std::string variant;   ///< "ds 0.05"; empty if the protocol has only one
  LabelSet labels = LabelSet::occupancy();
  /// Resolution, classes, density, free space. The method is that of whom it is given to.
  Options options;
  std::shared_ptr<const std::vector<Scan>> scans;
  std::shared_ptr<const VoxelTruth> truth;
  /// The same without the voxels that no beam of the input reached; null: not scored apart.
  std::shared_ptr<const VoxelTruth> seen_truth;
  std::shared_ptr<const LabelledCloud> points;  ///< with true labels; null: points are not scored
  /// What movers leave and what stays, asked while scans come; null: not asked.
  std::shared_ptr<const std::vector<SightCheck>> sight;
  /// Numbers of scans after which the map is scored, ascending; empty: after the last one.
  std::vector<std::size_t> checkpoints;
};

struct RocFigures {
  double auc = 0;
  double tpr_at_fpr_02 = 0;
  std::vector<RocPoint> curve;  ///< thinned for plots
};

/// Scores over the voxels of one truth.
struct VoxelFigures {
  VoxelScore score{ConfusionMatrix(2)};
  double known_share = 0;     ///< of the voxels of the truth
  double known_free_iou = 0;  ///< see VoxelEvaluation
  // Only where the truth knows free voxels:
  std::optional<RocFigures> roc_unknown_half;  ///< unknown voxels score 0.5
  std::optional<RocFigures> roc_unknown_zero;  ///< unknown voxels score 0
  Calibration calibration;
  Calibration occupancy_calibration;
};

/// Scores of one method after some of the scans of a trial.
struct TrialResult {
  std::string protocol;
  std::string variant;
  std::string method;                           ///< MethodSpec::text
  std::map<std::string, std::string> settings;  ///< of the method
  bool classes = true;                          ///< false: the method knows occupancy alone
  std::size_t scans = 0;                        ///< inserted so far
  VoxelFigures voxels;
  std::optional<VoxelFigures> seen;  ///< over the trial's seen_truth
  std::optional<PointScore> points;  ///< of a method with classes, where points are scored
  /// Of each of kSightSeconds, where the trial asks: up to now.
  std::optional<std::array<SightFigures, kSightSeconds.size()>> sight;
  /// Median time of an insertion so far [ms]: of one thread's processor, so that what else runs
  /// does not count.
  double ms_per_scan = 0;
};

/// One result for each checkpoint. Throws what insertions throw.
std::vector<TrialResult> runTrial(const Trial& trial, const MethodSpec& method);

}  // namespace csom
