// SPDX-License-Identifier: BSD-3-Clause
// How well labelled points fit to a map.
#pragma once

#include <csom/core/SemanticMap.h>
#include <csom/maps/LikelihoodOptions.h>
#include <csom/maps/NearestVoxelField.h>

#include <Eigen/Geometry>
#include <vector>

namespace csom {

/// log p of LikelihoodOptions; 0 if there are no points. `points`: in the frame of the sensor [m],
/// finite; `labels`: as many, kFreeClass = none; `sensor`: its pose in the map frame. `field` must
/// be that of `map` as it is. May be called from several threads with one map and one field; the
/// result depends on nothing but the arguments.
double logLikelihood(const SemanticMap& map, const NearestVoxelField& field,
                     const LikelihoodOptions& options, const std::vector<Eigen::Vector3d>& points,
                     const std::vector<ClassId>& labels, const Eigen::Isometry3d& sensor);

}  // namespace csom
