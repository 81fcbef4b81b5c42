// SPDX-License-Identifier: BSD-3-Clause
// What became of images, scans and points where cameras give the labels.
#pragma once

#include <csom/maps/LabelOptions.h>
#include <csom/vision/PointLabelling.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace csom {

struct CameraStatistics {
  struct Source {
    std::string sensor_label;
    LabelSource::Kind kind = LabelSource::Kind::Network;
    std::size_t images_read = 0;  ///< refused ones included
    std::size_t images_used = 0;  ///< labelled at least one scan
    std::size_t images_refused = 0;
    std::size_t network_runs = 0;
    std::size_t from_cache = 0;
    /// Optical axis of the last image, in the frame of the robot; 0 if there was none.
    std::array<double, 3> looks_along{0, 0, 0};
  };
  std::vector<Source> sources;  ///< the cameras, in the order of the configuration

  std::size_t scans_labelled = 0;       ///< at least one image was near enough in time
  std::size_t scans_without_image = 0;  ///< none was
  /// Of the ones without: came when images of their time had been given up already.
  std::size_t scans_late = 0;
  std::size_t restarts = 0;  ///< times at which the clock of the observations went back

  FateCounts points{};              ///< of the scans, by PointFate
  std::size_t kept_unlabelled = 0;  ///< points without a label that are in the map as unlabelled

  double image_seconds = 0;      ///< reading and decoding images
  double network_seconds = 0;    ///< networks alone
  double labelling_seconds = 0;  ///< projection, visibility, sampling of labels

  /// Why the label cache is no longer written to; empty if it is, or if there is none. Not carried
  /// by streams.
  std::string cache_fault;

  /// Points that the map never got.
  std::size_t pointsDropped() const;
  /// Those of them that some camera has in its view.
  std::size_t pointsRejected() const;
};

}  // namespace csom
