// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/maps/ObservationAdapter.h>
#include <csom/maps/PoseRounding.h>
#include <csom/protocols/LoggedScans.h>
#include <csom/rawlog/Deskew.h>
#include <csom/rawlog/RawlogSurvey.h>

namespace csom {
namespace {

class LogAsScans {
 public:
  LogAsScans(const std::string& rawlog, const LabelSet& labels, const LogReading& reading)
      : survey_(surveyRawlog(rawlog)),
        poses_(reading.poses, survey_),
        rules_(labels, reading.point_labels, "drop", "drop"),
        adapter_(makeAdapter(reading.label_options, labels, {true, 0})) {
    if (!survey_.end.complete) throw FileError(rawlog, survey_.end.reason);
  }

  std::vector<Scan> read() {
    RawlogReader reader(survey_.file, RawlogReader::Soundness::Known);
    while (const auto entry = reader.next()) {
      poses_.advance(*entry);
      for (const auto& observation : entry->observations) add(*entry, *observation);
    }
    take(adapter_->flush());
    if (scans_.empty()) throw FileError(survey_.file, "holds no scan with labelled points");
    return std::move(scans_);
  }

 private:
  void add(const RawlogEntry& entry, const mrpt::obs::CObservation& observation) {
    const auto pose = poses_.poseOf(entry, observation);
    if (!pose) return;
    mrpt::obs::CObservationVelodyneScan::Ptr still;
    if (const auto* scan = dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(&observation)) {
      DeskewStatistics statistics;
      still = deskewed(
          *scan, [this](double time) { return poses_.at(time); }, statistics);
    }
    auto adapted = adapter_->adapt(still ? *still : observation, roundedPose(*pose), rules_);
    if (adapted) take(*adapted);
  }

  void take(const std::vector<AdaptedScan>& adapted) {
    for (const AdaptedScan& given : adapted) {
      Scan scan;
      scan.origin = given.scan.origin;
      scan.image = given.scan.image;
      scan.image.pixels.clear();
      for (std::size_t i = 0; i < given.scan.points.size(); ++i) {
        // A pixel that shows nothing says nothing of a point: what was hit is not free.
        if (given.scan.labels[i] == kFreeClass) continue;
        scan.points.push_back(given.scan.points[i]);
        scan.labels.push_back(given.scan.labels[i]);
        if (!given.scan.image.empty()) scan.image.pixels.push_back(given.scan.image.pixels[i]);
      }
      if (!scan.points.empty()) scans_.push_back(std::move(scan));
    }
  }

  RawlogSurvey survey_;
  PoseSource poses_;
  LabelRules rules_;
  std::unique_ptr<ObservationAdapter> adapter_;
  std::vector<Scan> scans_;
};

}  // namespace

std::vector<Scan> readLoggedScans(const std::string& rawlog, const LabelSet& labels,
                                  const LogReading& reading) {
  return LogAsScans(rawlog, labels, reading).read();
}

}  // namespace csom
