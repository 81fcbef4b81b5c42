// SPDX-License-Identifier: BSD-3-Clause
// Point clouds in PCD files become a rawlog.
#include <csom/core/Error.h>
#include <csom/rawlog/ImportPcd.h>
#include <csom/rawlog/RawlogWriter.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>

#include "DataSetFiles.h"
#include "LoggedScan.h"

namespace csom {
namespace {

std::vector<std::string> expand(const std::vector<std::string>& given) {
  std::vector<std::string> files;
  for (const std::string& name : given) {
    std::error_code error;
    if (std::filesystem::is_directory(name, error)) {
      for (std::string& file : detail::filesIn(name, ".pcd")) files.push_back(std::move(file));
    } else {
      files.push_back(name);
    }
  }
  std::sort(files.begin(), files.end(), naturalLess);
  return files;
}

/// Points relative to the sensor, and what their intensity carries.
struct Cloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> points;
  std::vector<float> carried;
  const char* field = nullptr;  ///< name of the field that they come from; null for none
};

/// Name of the field that is carried along, null for none.
const char* fieldOf(const PcdCloud& cloud, PcdField wanted, const std::string& file) {
  if (wanted == PcdField::Label && !cloud.has_labels) throw FileError(file, "has no field 'label'");
  if (wanted == PcdField::Intensity && !cloud.has_intensities)
    throw FileError(file, "has no field 'intensity'");
  if (wanted != PcdField::Intensity && cloud.has_labels) return "label";
  return cloud.has_intensities ? "intensity" : nullptr;
}

class PcdFiles {
 public:
  PcdFiles(const PcdImport& request, ImportSummary& summary)
      : request_(request), summary_(summary) {}

  Cloud read(const std::string& file) {
    const PcdCloud raw = readPcd(file, request_.row_policy);
    report(raw, file);
    Cloud cloud;
    cloud.origin = raw.viewpoint;
    cloud.points.reserve(raw.points.size());
    for (const Eigen::Vector3d& point : raw.points)
      cloud.points.push_back((point - cloud.origin).cast<float>());
    cloud.field = fieldOf(raw, request_.field, file);
    const bool carries_labels = cloud.field != nullptr && cloud.field == std::string_view("label");
    cloud.carried = carries_labels ? detail::labelsAsIntensities(raw.labels) : raw.intensities;
    return cloud;
  }

  /// One line for each kind of fault, however many files have it.
  void addWarnings() const {
    for (const auto& [what, fault] : faults_) {
      std::string text = fault.first + ": " + std::to_string(fault.count) + " " + what;
      if (fault.files > 1)
        text += ", in this and " + std::to_string(fault.files - 1) + " more files";
      summary_.warnings.push_back(text);
    }
  }

 private:
  struct Fault {
    std::size_t count = 0;
    std::size_t files = 0;
    std::string first;  ///< file, and line if known
  };

  void report(const PcdCloud& raw, const std::string& file) {
    const std::string line = ", line " + std::to_string(raw.first_irregular_line);
    note("rows with a wrong number of columns, left out", raw.skipped_rows, file + line);
    note("rows with surplus columns, which were ignored", raw.irregular_rows - raw.skipped_rows,
         file + line);
    note("points whose label is no whole number", raw.invalid_labels, file);
    note("bytes after the last point, not read", raw.trailing_bytes, file);
    const auto too_large = std::count_if(raw.labels.begin(), raw.labels.end(), [](auto label) {
      return label > detail::kLargestLabelInFloat && label != kNoPcdLabel;
    });
    note("points whose label is above 2^24, too large to keep", static_cast<std::size_t>(too_large),
         file);
  }

  void note(const std::string& what, std::size_t count, const std::string& place) {
    if (count == 0) return;
    Fault& fault = faults_[what];
    fault.count += count;
    if (fault.files++ == 0) fault.first = place;
  }

  std::map<std::string, Fault> faults_;
  const PcdImport& request_;
  ImportSummary& summary_;
};

std::string fieldName(const Cloud& cloud) {
  return cloud.field == nullptr ? "neither labels nor intensities"
                                : "the field '" + std::string(cloud.field) + "'";
}

void append(Cloud& all, const Cloud& part, const std::string& file, const std::string& first) {
  if (part.origin != all.origin)
    throw ConfigError(file + ": its VIEWPOINT is not that of " + first +
                      ", so --single-scan cannot take both; import one scan a file");
  if (fieldName(part) != fieldName(all))
    throw FileError(file, "has " + fieldName(part) + ", but " + first + " has " + fieldName(all) +
                              ", so --single-scan cannot take both");
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  all.carried.insert(all.carried.end(), part.carried.begin(), part.carried.end());
}

void write(RawlogWriter& log, const Cloud& cloud, std::size_t position, ImportSummary& summary) {
  const double time = static_cast<double>(position) * detail::kScanPeriod;
  const mrpt::poses::CPose3D pose(cloud.origin.x(), cloud.origin.y(), cloud.origin.z(), 0, 0, 0);
  log.write(detail::poseObservation(pose, time));
  log.write(detail::cloudObservation(cloud.points, cloud.carried, time, "cloud"));
  ++summary.scans;
  summary.points += cloud.points.size();
}

}  // namespace

ImportSummary importPcd(const PcdImport& request, const std::string& rawlog,
                        const ImportProgress& progress) {
  const auto files = expand(request.files);
  if (files.empty()) throw ConfigError("no PCD file given");
  const auto chosen = detail::choose(request.selection, files.front(), files.size());
  RawlogWriter log(rawlog);
  ImportSummary summary;
  PcdFiles reader(request, summary);
  std::optional<Cloud> all;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const std::string& file = files[chosen[i]];
    Cloud cloud = reader.read(file);
    if (!request.single_scan)
      write(log, cloud, chosen[i], summary);
    else if (!all)
      all = std::move(cloud);
    else
      append(*all, cloud, file, files[chosen.front()]);
    if (progress) progress(i + 1, chosen.size());
  }
  if (all) write(log, *all, 0, summary);
  log.commit();
  reader.addWarnings();
  return summary;
}

}  // namespace csom
