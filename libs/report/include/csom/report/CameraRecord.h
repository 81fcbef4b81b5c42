// SPDX-License-Identifier: BSD-3-Clause
// What cameras gave to a run: the part of the run record about labels that come from images.
#pragma once

#include <csom/core/types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// What became of the images of one camera, or of all.
struct ImageCounts {
  std::size_t read = 0;          ///< all that the input holds
  std::size_t used = 0;          ///< near enough in time to a scan
  std::size_t network_runs = 0;  ///< went through the network
  std::size_t from_cache = 0;    ///< had their labels in the label cache
  std::size_t unused = 0;        ///< no scan needed them
  std::size_t refused = 0;       ///< could not be used: damaged, not calibrated, …
};

/// One label source of the configuration.
struct CameraSource {
  std::string sensor_label;
  std::string source;  ///< "network", "label_image", …
  ImageCounts images;
};

struct CameraScanCounts {
  std::size_t labelled = 0;
  std::size_t without_image = 0;  ///< no image was near enough in time
  /// Of the ones without: came when the images of their time had been given up already.
  std::size_t late = 0;
};

/// Points of the scans by what became of them; each is in one field, kept_unlabelled apart.
struct CameraPointCounts {
  std::size_t labelled = 0;
  std::size_t outside_view = 0;    ///< in no camera's image
  std::size_t hidden = 0;          ///< something nearer hides them from the camera
  std::size_t at_edge = 0;         ///< near a label border where the depth jumps
  std::size_t low_confidence = 0;  ///< dropped: the best class is not sure enough
  std::size_t ignored = 0;         ///< the label set ignores what the pixel shows
  std::size_t unknown = 0;         ///< the label set does not know what the pixel shows
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

 private:
  std::size_t dropped(std::size_t without_class) const {
    return kept_unlabelled > 0 ? 0 : without_class;
  }
};

/// Where the time went [s].
struct CameraSeconds {
  double network = 0;         ///< the network alone
  double image_decoding = 0;  ///< files and JPEG to pixels
  double labelling = 0;       ///< projection, visibility and edges
};

struct CameraLabels {
  std::vector<CameraSource> cameras;
  CameraScanCounts scans;
  std::size_t clock_restarts = 0;  ///< times at which the time stamps went back
  CameraPointCounts points;
  CameraSeconds seconds;
};

/// Sum over the cameras.
ImageCounts totalImages(const CameraLabels& labels);

/// Scans whose points were moved to where they were at one time, although the sensor itself moved.
struct DeskewCounts {
  std::size_t deskewed = 0;
  std::size_t not_needed = 0;    ///< all points have the same time, or the sensor stood still
  std::size_t not_possible = 0;  ///< the poses do not span the scan, or the points carry no times
};

/// Poses found by laying scans over one another.
struct RegistrationRecord {
  std::size_t scans = 0;
  std::size_t doubtful = 0;  ///< did not fit well; their pose was extrapolated or is poor
  double seconds = 0;
};

/// One camera image in two pictures, each a JPEG file.
struct CameraPicture {
  enum class Moment { First, Middle, Last };  ///< of the run

  Moment moment = Moment::First;
  std::string sensor_label;
  double timestamp = 0;                    ///< of the image [s since 1970, UTC]
  std::size_t frame = 0;                   ///< number of the image of this camera, from 0
  std::vector<std::uint8_t> segmentation;  ///< the image tinted by class
  std::vector<std::uint8_t> points;        ///< the points over it, in the colours of their classes
  std::vector<ClassId> classes;            ///< those that the pictures show
};
const char* toString(CameraPicture::Moment moment);

}  // namespace csom
