// SPDX-License-Identifier: BSD-3-Clause
// Scores as JSON.
#pragma once

#include <csom/protocols/Evaluation.h>

#include <nlohmann/json.hpp>

namespace csom {

/// w_average_iou, iou by class, geometric_iou, …: what docs/evaluation.md lists.
nlohmann::ordered_json toJson(const TrialResult& result, const LabelSet& labels);
nlohmann::ordered_json toJson(const VoxelScore& score, const LabelSet& labels);
nlohmann::ordered_json toJson(const PointScore& score, const LabelSet& labels);
nlohmann::ordered_json toJson(const Evaluation& evaluation);

}  // namespace csom
