// SPDX-License-Identifier: BSD-3-Clause
// What a run counts beside its scans (csom::ScanReport) and its cameras.
#pragma once

#include <csom/core/Statistic.h>

#include <cstddef>

namespace csom {

/// Points by what became of the labels that they carry. Something is there, whatever it may be: a
/// point without a class of its own receives the class for unlabelled points if there is one,
/// unless the label set says that it is not to be used. All others are dropped. Points that cameras
/// label are counted by CameraPointCounts and not here.
struct LabelCounts {
  std::size_t labelled = 0;      ///< had a class of their own
  std::size_t unlabelled = 0;    ///< had no label and received the class for unlabelled points
  std::size_t kept_unknown = 0;  ///< had a label of no use and received the same class
  std::size_t missing = 0;       ///< had none and were dropped
  std::size_t unknown = 0;       ///< had one that is no class of a point and were dropped
  std::size_t ignored = 0;       ///< the label set says so
  std::size_t ambiguous = 0;     ///< had several and were dropped

  std::size_t dropped() const { return missing + unknown + ignored + ambiguous; }
  std::size_t keptUnlabelled() const { return unlabelled + kept_unknown; }

  template <class Visitor, class... Selves>
  static void visit(Visitor&& visitor, Selves&... s) {
    visitor(StatisticInfo{"labelled"}, s.labelled...);
    visitor(StatisticInfo{"unlabelled"}, s.unlabelled...);
    visitor(StatisticInfo{"kept_unknown"}, s.kept_unknown...);
    visitor(StatisticInfo{"missing"}, s.missing...);
    visitor(StatisticInfo{"unknown"}, s.unknown...);
    visitor(StatisticInfo{"ignored"}, s.ignored...);
    visitor(StatisticInfo{"ambiguous"}, s.ambiguous...);
  }
};

/// How it was told which points of a scan lie beside each other (csom::RangeImage), for methods
/// that want to know.
struct ScanImageCounts {
  std::size_t of_sensor = 0;  ///< the observation says it
  std::size_t found = 0;      ///< by the order or the elevations of its points
  std::size_t none = 0;       ///< not at all: neighbours in space are taken

  template <class Visitor, class... Selves>
  static void visit(Visitor&& visitor, Selves&... s) {
    visitor(StatisticInfo{"of_sensor", "Range images of the sensor"}, s.of_sensor...);
    visitor(StatisticInfo{"found", "found in the order of the points"}, s.found...);
    visitor(StatisticInfo{"none", "none"}, s.none...);
  }
};

/// What became of the scans that consist of packets with times.
struct DeskewStatistics {
  std::size_t deskewed = 0;
  std::size_t not_needed = 0;    ///< all packets carry the same time
  std::size_t not_possible = 0;  ///< the poses do not span the turn

  template <class Visitor, class... Selves>
  static void visit(Visitor&& visitor, Selves&... s) {
    visitor(StatisticInfo{"deskewed", "Scans de-skewed"}, s.deskewed...);
    visitor(StatisticInfo{"not_needed", "not needed"}, s.not_needed...);
    visitor(StatisticInfo{"not_possible", "not possible"}, s.not_possible...);
  }
};

/// How the scans of a log were registered.
struct RegistrationStatistics {
  std::size_t scans = 0;     ///< registered, doubtful ones included
  std::size_t doubtful = 0;  ///< have the pose that was expected, as what fitted cannot be trusted
  double seconds = 0;        ///< of computing

  template <class Visitor, class... Selves>
  static void visit(Visitor&& visitor, Selves&... s) {
    visitor(StatisticInfo{"scans"}, s.scans...);
    visitor(StatisticInfo{"doubtful"}, s.doubtful...);
    visitor(StatisticInfo{"seconds"}, s.seconds...);
  }
};

}  // namespace csom
