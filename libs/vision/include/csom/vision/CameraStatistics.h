// SPDX-License-Identifier: BSD-3-Clause
// What became of images, scans and points where cameras give the labels.
#pragma once

#include <csom/core/Statistic.h>
#include <csom/vision/PointLabelling.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace csom {

/// What became of the images of one camera, or of all.
struct ImageCounts {
  std::size_t read = 0;  ///< all that the input holds, refused ones included
  std::size_t used = 0;  ///< labelled at least one scan
  std::size_t network_runs = 0;
  std::size_t from_cache = 0;
  std::size_t refused = 0;  ///< damaged, not calibrated, …

  /// No scan needed them.
  std::size_t unused() const { return read - used - refused; }

  template <class Visitor, class... Selves>
  static void visit(Visitor&& visitor, Selves&... s) {
    visitor(StatisticInfo{"read", "images"}, s.read...);
    visitor(StatisticInfo{"used", "used"}, s.used...);
    visitor(StatisticInfo{"network_runs", "through the network"}, s.network_runs...);
    visitor(StatisticInfo{"from_cache", "from the cache"}, s.from_cache...);
    visitor(StatisticInfo{"refused", "refused"}, s.refused...);
  }
};

struct CameraScanCounts {
  std::size_t labelled = 0;       ///< at least one image was near enough in time
  std::size_t without_image = 0;  ///< none was
  std::size_t late = 0;           ///< of the ones without

  template <class Visitor, class... Selves>
  static void visit(Visitor&& visitor, Selves&... s) {
    visitor(StatisticInfo{"labelled", "got labels from images"}, s.labelled...);
    visitor(StatisticInfo{"without_image", "had no image near enough in time (max_time_offset)"},
            s.without_image...);
    visitor(StatisticInfo{"late",
                          "of these came when the images of their time had been given up already"},
            s.late...);
  }
};

/// Points of the scans by their fate; each is counted once, and those that are kept once more.
struct CameraPointCounts {
  std::size_t labelled = 0;
  std::size_t outside_view = 0;
  std::size_t hidden = 0;
  std::size_t at_edge = 0;
  std::size_t low_confidence = 0;  ///< dropped
  std::size_t ignored = 0;
  std::size_t unknown = 0;
  /// Those without a class that are in the map all the same, as unlabelled: all of them (but
  /// low_confidence) or none, as the option outside_view has it.
  std::size_t kept_unlabelled = 0;

  std::size_t inView() const {
    return labelled + hidden + at_edge + low_confidence + ignored + unknown;
  }
  std::size_t outsideAndDropped() const { return dropped(outside_view); }
  std::size_t unseenAndDropped() const { return dropped(hidden + at_edge); }
  std::size_t ignoredAndDropped() const { return dropped(ignored); }
  std::size_t unknownAndDropped() const { return dropped(unknown); }
  /// Points that were looked at and have no label. What lies outside of all views was not: nothing
  /// is wrong with such a point.
  std::size_t rejected() const {
    return unseenAndDropped() + low_confidence + ignoredAndDropped() + unknownAndDropped();
  }
  /// Points that the map never got.
  std::size_t dropped() const { return outsideAndDropped() + rejected(); }

  void add(const FateCounts& fates) {
    const auto count = [&](PointFate fate) { return fates[static_cast<std::size_t>(fate)]; };
    labelled += count(PointFate::Labelled);
    outside_view += count(PointFate::OutsideView);
    hidden += count(PointFate::Hidden);
    at_edge += count(PointFate::AtEdge);
    low_confidence += count(PointFate::LowConfidence);
    ignored += count(PointFate::Ignored);
    unknown += count(PointFate::Unknown);
  }

  template <class Visitor, class... Selves>
  static void visit(Visitor&& visitor, Selves&... s) {
    visitor(StatisticInfo{"labelled", "got a label"}, s.labelled...);
    visitor(StatisticInfo{"outside_view", "in the view of no camera"}, s.outside_view...);
    visitor(StatisticInfo{"hidden", "hidden from the camera by something nearer"}, s.hidden...);
    visitor(StatisticInfo{"at_edge", "at a label border where the depth jumps"}, s.at_edge...);
    visitor(StatisticInfo{"low_confidence", "less sure of its class than min_confidence"},
            s.low_confidence...);
    visitor(StatisticInfo{"ignored", "on something that the label set ignores"}, s.ignored...);
    visitor(StatisticInfo{"unknown", "on something that the label set does not know"},
            s.unknown...);
    visitor(StatisticInfo{"kept_unlabelled", "went into the map as unlabelled"},
            s.kept_unlabelled...);
  }

 private:
  std::size_t dropped(std::size_t without_class) const {
    return kept_unlabelled > 0 ? 0 : without_class;
  }
};

/// Where the time went [s].
struct CameraSeconds {
  double network = 0;         ///< the network alone
  double image_decoding = 0;  ///< files and JPEG to pixels
  double labelling = 0;       ///< projection, visibility, sampling of labels

  template <class Visitor, class... Selves>
  static void visit(Visitor&& visitor, Selves&... s) {
    visitor(StatisticInfo{"network"}, s.network...);
    visitor(StatisticInfo{"image_decoding"}, s.image_decoding...);
    visitor(StatisticInfo{"labelling"}, s.labelling...);
  }
};

struct CameraStatistics {
  struct Camera {
    std::string sensor_label;
    std::string source;  ///< "network", "label_image", …
    ImageCounts images;
    /// Optical axis of the last image, in the frame of the robot; 0 if there was none. In no file.
    std::array<double, 3> looks_along{0, 0, 0};
  };
  std::vector<Camera> cameras;  ///< in the order of the configuration
  CameraScanCounts scans;
  std::size_t clock_restarts = 0;  ///< times at which the time stamps went back
  CameraPointCounts points;
  CameraSeconds seconds;
  /// Why the label cache is no longer written to; empty if it is, or if there is none. In no file.
  std::string cache_fault;

  ImageCounts images() const {
    ImageCounts sum;
    for (const Camera& camera : cameras) addStatistics(sum, camera.images);
    return sum;
  }

  /// All but the cameras one by one.
  template <class Visitor, class... Selves>
  static void visit(Visitor&& visitor, Selves&... s) {
    visitor(StatisticInfo{"scans"}, s.scans...);
    visitor(StatisticInfo{"clock_restarts"}, s.clock_restarts...);
    visitor(StatisticInfo{"points"}, s.points...);
    visitor(StatisticInfo{"seconds"}, s.seconds...);
  }
};

}  // namespace csom
