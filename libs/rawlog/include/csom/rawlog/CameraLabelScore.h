// SPDX-License-Identifier: BSD-3-Clause
// How well the labels that points take from camera images agree with a simulated world.
#pragma once

#include <csom/eval/Scenario.h>
#include <csom/vision/PointLabelling.h>

#include <cstddef>
#include <string>
#include <vector>

namespace csom {

/// Points in the image of a camera, by what became of them. Truly visible are those to which a
/// camera in whose image they lie has a free line of sight.
struct CameraLabelTally {
  std::size_t in_view = 0;
  std::size_t visible = 0;         ///< truly
  FateCounts fates{};              ///< of all in view
  FateCounts visible_fates{};      ///< of the truly visible
  std::size_t correct = 0;         ///< labelled with the class of the surface on which they lie
  std::size_t naive_labelled = 0;  ///< without visibility and edges
  std::size_t naive_correct = 0;
  /// Truly visible and rejected as hidden or at an edge, although their pixel has a class.
  std::size_t lost = 0;

  CameraLabelTally& operator+=(const CameraLabelTally& other);

  std::size_t labelled() const { return fates[static_cast<std::size_t>(PointFate::Labelled)]; }

  double correctShare() const;       ///< of the labelled; 1 if there is none
  double naiveCorrectShare() const;  ///< of the labelled without visibility; 1 if there is none
  double lostShare() const;          ///< of the truly visible; 0 if there is none
};

struct CameraLabelScore {
  std::size_t scans = 0;
  std::size_t scans_without_image = 0;  ///< no image and pose of the same time: not scored
  CameraLabelTally all;
  std::vector<CameraLabelTally> by_class;  ///< by class of the surface
};

/// Scores `rawlog`, a simulation of `scenario`: the points of its Velodynes take labels from the
/// class-id images of its cameras of the same time, with the true poses. What a point lies on is
/// what the Velodyne's intensity says. Throws ConfigError if the scenario has no camera, or no
/// Velodyne with `intensity: class` and `sweep: instantaneous`; FileError for a rawlog that cannot
/// be read or has no such scans; OptionError.
CameraLabelScore scoreCameraLabels(const Scenario& scenario, const std::string& rawlog,
                                   const PointLabellingOptions& options = {});

}  // namespace csom
