// SPDX-License-Identifier: BSD-3-Clause
// What the SEE-CSOM paper reports, and what its published code reaches on our protocols.
#pragma once

#include <array>

namespace csom::detail {

struct PublishedFigure {
  const char* protocol;
  const char* variant;  ///< "" where it does not matter
  const char* method;
  const char* metric;  ///< key of the JSON
  double value;        ///< share, or milliseconds
};

/// Deng et al. 2024. Its room is the conference room at a density that it does not state, its
/// street SemanticKITTI 08, its structured room the one of la3dm, its robot one of their own.
inline constexpr std::array<PublishedFigure, 23> kPaper{{
    {"P2", "", "s-csm", "w_average_iou", 0.280},
    {"P2", "", "s-bki", "w_average_iou", 0.349},
    {"P2", "", "see-csom", "w_average_iou", 0.527},
    {"P3", "", "s-csm", "w_average_iou", 0.185},
    {"P3", "", "s-bki", "w_average_iou", 0.334},
    {"P3", "", "see-csom", "w_average_iou", 0.589},
    {"P4", "", "s-csm", "auc", 0.640},
    {"P4", "", "s-bki", "auc", 0.754},
    {"P4", "", "see-csom", "auc", 0.806},
    {"P4", "", "octomap", "auc", 0.626},
    {"P4", "", "bgkoctomap-l", "auc", 0.739},
    {"P4", "", "gpoctomap", "auc", 0.741},
    {"P4", "", "akimap", "auc", 0.622},
    {"P4", "", "s-csm", "tpr_at_fpr_0.2", 0.425},
    {"P4", "", "s-bki", "tpr_at_fpr_0.2", 0.606},
    {"P4", "", "see-csom", "tpr_at_fpr_0.2", 0.754},
    {"P4", "", "octomap", "tpr_at_fpr_0.2", 0.415},
    {"P4", "", "bgkoctomap-l", "tpr_at_fpr_0.2", 0.587},
    {"P4", "", "gpoctomap", "tpr_at_fpr_0.2", 0.659},
    {"P4", "", "akimap", "tpr_at_fpr_0.2", 0.416},
    {"P5", "", "see-csom", "macro_f1", 0.77},
    {"P5", "", "see-csom", "free_iou", 0.83},
    {"P5", "", "see-csom", "geometric_iou", 0.62},
}};

/// Their code and OctoMap, compiled with optimisation: P2 on its own half-voxel grid, P3 on ten
/// scans; the middle of the range of medians in milliseconds.
inline constexpr std::array<PublishedFigure, 21> kTheirCode{{
    {"P2", "ds 0.05", "s-csm", "w_average_iou", 0.649},
    {"P2", "ds 0.05", "s-bki", "w_average_iou", 0.167},
    {"P2", "ds 0.05", "see-csom", "w_average_iou", 0.386},
    {"P2", "ds 0.10", "s-csm", "w_average_iou", 0.270},
    {"P2", "ds 0.10", "s-bki", "w_average_iou", 0.216},
    {"P2", "ds 0.10", "see-csom", "w_average_iou", 0.438},
    {"P3", "", "s-csm", "w_average_iou", 0.640},
    {"P3", "", "s-bki", "w_average_iou", 0.376},
    {"P3", "", "see-csom", "w_average_iou", 0.234},
    {"P2", "", "s-csm", "ms_per_scan", 140},
    {"P2", "", "s-bki", "ms_per_scan", 30},
    {"P2", "", "see-csom", "ms_per_scan", 23},
    {"P3", "", "s-csm", "ms_per_scan", 8850},
    {"P3", "", "s-bki", "ms_per_scan", 1700},
    {"P3", "", "see-csom", "ms_per_scan", 1485},
    {"P4", "", "s-csm", "ms_per_scan", 33},
    {"P4", "", "s-bki", "ms_per_scan", 20},
    {"P4", "", "see-csom", "ms_per_scan", 16},
    {"P2", "", "octomap", "ms_per_scan", 10.5},
    {"P3", "", "octomap", "ms_per_scan", 550},
    {"P4", "", "octomap", "ms_per_scan", 15},
}};

}  // namespace csom::detail
