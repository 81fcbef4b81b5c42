// SPDX-License-Identifier: BSD-3-Clause
// What one run of `csom map` was to do and what became of it: the source of every figure that
// a report shows.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/ScanReport.h>
#include <csom/io/MapFile.h>
#include <csom/io/RunStatistics.h>
#include <csom/report/CameraPicture.h>
#include <csom/report/MapFigures.h>
#include <csom/vision/CameraStatistics.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace csom {

/// A parameter of the run as it was in force, defaults included.
struct Parameter {
  std::string name;
  std::variant<bool, std::int64_t, double, std::string> value;
  std::string unit;  ///< "m", … or empty
  std::string help;  ///< what it means, in a few words; may be empty
};

/// All fields of a struct of options under their ini names (see OptionInfo).
template <class OptionsLike>
std::vector<Parameter> toParameters(const OptionsLike& options) {
  std::vector<Parameter> parameters;
  visitOptions(options, [&](const OptionInfo& option, const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    Parameter parameter{option.key, std::string(), option.unit, fullHelp(option, field)};
    if constexpr (std::is_same_v<Field, bool> || std::is_same_v<Field, double> ||
                  std::is_same_v<Field, std::string>)
      parameter.value = field;
    else if constexpr (std::is_integral_v<Field>)
      parameter.value = static_cast<std::int64_t>(field);
    else
      parameter.value = toString(field);
    parameters.push_back(std::move(parameter));
  });
  return parameters;
}
/// "0.2", "on", "see-csom": as it would stand in an ini file.
std::string toText(const Parameter& parameter);

/// One inserted observation.
struct RunScan {
  ScanRecord record;
  double insert_ms = 0;  ///< wall time from the observation to the updated map [ms]
};

/// Observations that were read but did not reach the map.
struct RefusedObservations {
  std::string observation_class;  ///< "CObservationGPS", …
  std::string reason;             ///< in plain words: "no range data"
  std::size_t count = 0;
};

/// Filled by the one who runs; no invariants, nothing is computed behind one's back.
struct RunRecord {
  std::string program_version;
  std::string command;              ///< the command line, quoted for a shell
  std::vector<std::string> inputs;  ///< rawlogs or simplemaps
  std::string config_file;          ///< empty: the defaults
  std::vector<Parameter> parameters;
  std::string pose_source;  ///< "robot-pose:GT", "odometry", …
  std::string label_set;    ///< its name
  /// Mean direction of the robot's z axis in the map frame: what pictures take for up.
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::size_t observations_read = 0;  ///< inserted and refused ones
  std::vector<RunScan> scans;
  ScanReport unused;           ///< sum over the observations of which no point could be used
  LabelCounts labels;          ///< over all observations
  std::size_t no_returns = 0;  ///< beams that hit nothing; no points, and not among the rejected
  ScanImageCounts images;      ///< all 0 if the method does not look at them
  std::vector<RefusedObservations> refused;
  std::optional<CameraStatistics> camera_labels;       ///< nothing if no camera is configured
  std::optional<DeskewStatistics> deskew;              ///< nothing if it is switched off
  std::optional<RegistrationStatistics> registration;  ///< nothing if the poses were given
  std::vector<CameraPicture> pictures;                 ///< in the order of the page
  std::vector<std::string> warnings;
  double wall_seconds = 0;
};

/// Sum over the scans, and over the observations of which no point could be used.
ScanReport totals(const RunRecord& record);
/// All points of the observations that the map takes, and those of them that were rejected. Points
/// outside of all cameras' views may be left out without being rejected.
std::size_t pointsRead(const RunRecord& record);
std::size_t pointsRejected(const RunRecord& record);

/// Where the range images of the scans come from: "68 scans with the range image of the sensor",
/// with more parts behind commas if there are several ways. Empty if images were not used.
std::string describeImages(const ScanImageCounts& images);

/// Time of the run beyond that of the network, as a share of the latter; nothing if no network ran.
std::optional<double> addedShare(const RunRecord& record);

/// The text of run.json (docs/report.md lists its keys). Numbers are the shortest that read back to
/// the same value; what is not finite becomes null, bytes that are not UTF-8 become U+FFFD.
std::string toJson(const RunRecord& record, const MapFigures& figures);

}  // namespace csom
