// SPDX-License-Identifier: BSD-3-Clause
// Point clouds in PCD files become a rawlog.
#include <csom/core/Error.h>
#include <csom/io/TextParser.h>
#include <csom/rawlog/ImportPcd.h>
#include <csom/rawlog/RawlogWriter.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "import/DataSetFiles.h"
#include "logs/FrameNumbers.h"
#include "logs/LoggedScan.h"

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

/// Points relative to the sensor, and their labels.
struct Cloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> points;
  std::vector<float> labels;  ///< one a point; empty if label_field is
  std::string label_field;    ///< as the file spells it; empty: it has none
  std::vector<std::string> fields;
};

constexpr char kLabel[] = "cloud";  ///< of the sensor
constexpr char kDefaultField[] = "label";

/// Names under which others write classes.
bool looksLikeLabels(const std::string& name) {
  const std::string field = detail::lowerCase(name);
  for (const char* word : {"label", "class", "semantic", "categor", "segment"})
    if (field.find(word) != std::string::npos) return true;
  return false;
}

/// "none; the fields are x, y, z, classification; another one than label can be taken for them".
void noteNoLabels(const std::vector<std::string>& fields, ImportSummary& summary) {
  const auto labels = std::find_if(fields.begin(), fields.end(), looksLikeLabels);
  summary.labels = "none; the fields are " + detail::joined(fields) +
                   "; another one than label can be taken for them";
  summary.options = {"labels " + (labels == fields.end() ? std::string("FIELD") : *labels)};
}

class PcdFiles {
 public:
  PcdFiles(const PcdImport& request, ImportSummary& summary)
      : request_(request), summary_(summary) {}

  Cloud read(const std::string& file) {
    const std::string& field = request_.label_field;
    const PcdCloud raw = readPcd(file, request_.row_policy, field.empty() ? kDefaultField : field);
    if (!field.empty() && raw.label_field.empty())
      throw FileError(file, "has no field " + detail::quoted(field) +
                                " with one value a point; there are " + detail::joined(raw.fields));
    requireSameLabels(raw, file);
    requireNearViewpoint(raw, file);
    report(raw, file);
    Cloud cloud;
    cloud.origin = raw.viewpoint;
    cloud.points.reserve(raw.points.size());
    for (const Eigen::Vector3d& point : raw.points) {
      const bool no_return = point.isZero(0);
      no_returns_ += no_return ? 1 : 0;
      const Eigen::Vector3d& end = no_return ? cloud.origin : point;
      cloud.points.emplace_back((end - cloud.origin).cast<float>());
    }
    cloud.labels = detail::labelsAsIntensities(raw.labels);
    cloud.label_field = raw.label_field;
    cloud.fields = raw.fields;
    return cloud;
  }

  /// One line for each kind of fault, however many files have it.
  void addWarnings() const {
    if (label_field_.empty())
      noteNoLabels(fields_, summary_);
    else
      summary_.labels = "the field " + detail::quoted(label_field_);
    if (no_returns_ > 0)
      summary_.warnings.push_back(std::to_string(no_returns_) +
                                  " points lie at exactly 0, 0, 0: they are taken for beams "
                                  "without a return");
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

  /// Points of a scan are floats relative to the sensor. Coordinates of a country's grid lie so far
  /// from a VIEWPOINT of 0 that none could hold them.
  static void requireNearViewpoint(const PcdCloud& raw, const std::string& file) {
    constexpr double kFarthest = 1 << 17;  // [m], to which floats are 16 mm apart
    std::size_t far = 0;
    std::size_t finite = 0;
    for (const Eigen::Vector3d& point : raw.points) {
      if (!point.allFinite()) continue;
      ++finite;
      far += (point - raw.viewpoint).norm() > kFarthest ? 1 : 0;
    }
    if (2 * far <= finite) return;
    throw FileError(file, std::to_string(far) + " of its " + std::to_string(finite) +
                              " points lie more than 131 km from its VIEWPOINT, where the sensor "
                              "should have been. If they are coordinates such as UTM, write the "
                              "sensor's position into VIEWPOINT, or subtract one offset from the "
                              "points of all files");
  }

  /// Which points have labels must not depend on the file that they are in.
  void requireSameLabels(const PcdCloud& raw, const std::string& file) {
    if (first_file_.empty()) {
      first_file_ = file;
      label_field_ = raw.label_field;
      fields_ = raw.fields;
    }
    if (raw.label_field == label_field_) return;
    const auto named = [](const std::string& field) {
      return field.empty() ? "no labels" : "the field " + detail::quoted(field);
    };
    throw FileError(file, "has " + named(raw.label_field) + ", but " + first_file_ + " has " +
                              named(label_field_) + "; import them apart");
  }

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
  std::size_t no_returns_ = 0;
  std::string first_file_;
  std::string label_field_;          ///< of all files
  std::vector<std::string> fields_;  ///< of the first one
  const PcdImport& request_;
  ImportSummary& summary_;
};

void append(Cloud& all, const Cloud& part, const std::string& file, const std::string& first) {
  if (part.origin != all.origin)
    throw ConfigError(file + ": its VIEWPOINT is not that of " + first +
                          ", so they cannot be one scan; import one scan a file",
                      {"single-scan"});
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  all.labels.insert(all.labels.end(), part.labels.begin(), part.labels.end());
}

double timeOf(std::size_t position) {
  return static_cast<double>(position) * detail::kScanPeriod;
}

void write(RawlogWriter& log, const Cloud& cloud, std::size_t position, ImportSummary& summary) {
  const double time = timeOf(position);
  const mrpt::poses::CPose3D pose(cloud.origin.x(), cloud.origin.y(), cloud.origin.z(), 0, 0, 0);
  log.write(detail::poseObservation(pose, time));
  log.write(detail::cloudObservation(cloud.points, cloud.labels, time, kLabel));
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
  if (!request.single_scan) {
    detail::FrameNumbers frames;
    for (const std::size_t position : chosen) frames.add(kLabel, timeOf(position), position);
    log.write(frames.toComment());
  }
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
