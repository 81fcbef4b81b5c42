// SPDX-License-Identifier: BSD-3-Clause
// The report page, section by section.
#include <csom/report/Format.h>
#include <csom/report/Html.h>
#include <csom/report/HtmlPage.h>
#include <csom/report/HtmlReport.h>

#include <algorithm>
#include <sstream>

#include "CameraSections.h"
#include "TimingSection.h"
#include "Viewer.h"

namespace csom {

namespace {

constexpr std::size_t kMaxWarnings = 200;

std::string fileName(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

std::string titleOf(const RunRecord& record) {
  if (record.inputs.empty()) return "Semantic map";
  std::string title = "Semantic map of " + fileName(record.inputs.front());
  if (record.inputs.size() > 1)
    title += " and " + formatCount(record.inputs.size() - 1, "more file");
  return title;
}

/// "63 × 41 × 8 m", with spaces at which no line breaks.
std::string extentOf(const MapFigures& figures) {
  const Eigen::Vector3d size = figures.bounds.sizes();
  return formatNumber(size.x()) + "\u00a0×\u00a0" + formatNumber(size.y()) + "\u00a0×\u00a0" +
         formatNumber(size.z()) + "\u00a0m";
}

std::size_t refusedTotal(const RunRecord& record) {
  std::size_t count = 0;
  for (const RefusedObservations& refused : record.refused) count += refused.count;
  return count;
}

/// "Method: see-csom. ", or nothing for a record that does not say.
std::string methodInWords(const RunRecord& record) {
  for (const Parameter& parameter : record.parameters)
    if (parameter.name == "method") return "Method: " + escapeHtml(toText(parameter)) + ". ";
  return "";
}

/// What happened, in two or three sentences.
void writeSummary(std::ostream& page, const RunRecord& record, const MapFigures& figures) {
  const std::size_t points = totals(record).points;
  page << "<p class=\"lead\">" << formatCount(record.scans.size(), "observation") << " with "
       << formatCount(points, "point") << " went into the map in "
       << formatDuration(record.wall_seconds);
  if (record.wall_seconds > 0)
    page << ", " << formatNumber(static_cast<double>(record.scans.size()) / record.wall_seconds)
         << " observations a second";
  page << ". ";
  if (figures.known_voxels == 0) {
    page << "The map is empty: no point was accepted. The section “What was left out” says why.";
  } else {
    page << "It covers " << extentOf(figures) << " with voxels of "
         << formatLength(figures.resolution) << "; "
         << formatCount(figures.occupied_voxels, "voxel") << " are occupied and "
         << formatCount(figures.free_voxels) << " are known to be free.";
  }
  page << "</p>\n<p class=\"soft\">" << methodInWords(record)
       << "Poses: " << escapeHtml(record.pose_source) << ". " << motionInWords(record)
       << "Label set: " << escapeHtml(record.label_set) << ". Made by csom "
       << escapeHtml(record.program_version) << ".</p>\n";
}

void writeFigure(std::ostream& page, const std::string& name, const std::string& value) {
  page << "<div><dt>" << name << "</dt><dd>" << value << "</dd></div>\n";
}

void writeFigures(std::ostream& page, const RunRecord& record, const MapFigures& figures) {
  page << "<dl class=\"figures\">\n";
  writeFigure(page, "Observations", formatCount(record.scans.size()));
  writeFigure(page, "Points", formatCount(pointsRead(record)));
  writeFigure(page, "Points rejected", formatCount(pointsRejected(record)));
  writeFigure(page, "Occupied voxels", formatCount(figures.occupied_voxels));
  writeFigure(page, "Free voxels", formatCount(figures.free_voxels));
  writeFigure(page, "Map in memory", formatBytes(figures.memory_bytes));
  page << "</dl>\n";
}

const char* viewInWords(MapView view) {
  switch (view) {
    case MapView::Top:
      return "From above";
    case MapView::Front:
      return "From the front";
    case MapView::Side:
      return "From the side";
    case MapView::Isometric:
      return "From obliquely above";
  }
  return "";
}

void writeMapPictures(std::ostream& page, const MapFigures& figures,
                      const std::vector<MapPicture>& pictures) {
  if (pictures.empty() || figures.known_voxels == 0) return;
  page << "<h2>Pictures of the map</h2>\n<div class=\"gallery\">\n";
  for (const MapPicture& picture : pictures) {
    const std::string words = viewInWords(picture.view);
    page << "<figure><img alt=\"The map f" << words.substr(1) << ", coloured by class, "
         << extentOf(figures)
         << ". The class table below gives the same in figures.\" src=\"data:image/png;base64,"
         << encodeBase64(picture.png) << "\">\n<figcaption>" << words
         << ".</figcaption></figure>\n";
  }
  page << "</div>\n<p class=\"soft\">One sees the nearest occupied voxel; nearer ones are lighter. "
          "Where "
       << "there is none, gray is known to be free, white was never seen.</p>\n";
}

void writeClassRow(std::ostream& page, const ClassFigures& c) {
  page << "<tr><td>" << c.id
       << "</td><td class=\"text\"><span class=\"swatch\" style=\"background:" << cssColor(c.color)
       << "\"></span>" << escapeHtml(c.name) << "</td><td>" << formatCount(c.voxels) << "</td><td>"
       << formatNumber(c.volume) << "</td><td>" << (c.id == kFreeClass ? "–" : formatShare(c.share))
       << "</td><td>" << formatNumber(c.mean_probability) << "</td></tr>\n";
}

void writeClasses(std::ostream& page, const MapFigures& figures) {
  std::vector<ClassFigures> present;
  std::string absent;
  for (const ClassFigures& c : figures.classes) {
    if (c.voxels > 0)
      present.push_back(c);
    else
      absent += (absent.empty() ? "" : ", ") + c.name;
  }
  // The largest first, free space last.
  std::stable_sort(present.begin(), present.end(), [](const auto& a, const auto& b) {
    if ((a.id == kFreeClass) != (b.id == kFreeClass)) return b.id == kFreeClass;
    return a.voxels > b.voxels;
  });
  page << "<h2>Classes</h2>\n";
  if (!present.empty()) {
    page << "<div class=\"wide\"><table><thead><tr><th>id</th><th class=\"text\">class</th>"
         << "<th>voxels</th><th>volume, m³</th><th>share of occupied</th><th>mean probability</th>"
         << "</tr></thead><tbody>\n";
    for (const ClassFigures& c : present) writeClassRow(page, c);
    page << "</tbody></table></div>\n";
  }
  if (!absent.empty())
    page << "<p class=\"soft\">Not in this map: " << escapeHtml(absent) << ".</p>\n";
}

const char* inWords(RejectReason reason) {
  switch (reason) {
    case RejectReason::NonFinite:
      return "had coordinates that are not numbers or infinite";
    case RejectReason::TooNear:
      return "were nearer to the sensor than <code>min_range</code>";
    case RejectReason::TooFar:
      return "were farther from the sensor than <code>max_range</code>";
    case RejectReason::ClassOutOfRange:
      return "had a class id that the label set does not have";
    case RejectReason::InvalidScores:
      return "had class scores that do not sum to 1";
    case RejectReason::OutsideIndexRange:
      return "were too far from the map’s origin to be stored";
    case RejectReason::BeamTooLong:
      return "were so far away that free space along the beam would take more than 8192 steps";
  }
  return "";
}

void writeRejects(std::ostream& page, const RunRecord& record) {
  const std::size_t rejected = pointsRejected(record);
  if (rejected == 0) {
    page << "<p>No point was rejected.</p>\n";
    return;
  }
  page << "<p>" << formatCount(rejected, "point") << " ("
       << formatShare(static_cast<double>(rejected) /
                      static_cast<double>(std::max<std::size_t>(pointsRead(record), 1)))
       << ") did not go into the map:</p>\n<ul>\n";
  const auto list = [&](std::size_t count, const char* reason) {
    if (count > 0) page << "<li>" << formatCount(count) << " " << reason << "</li>\n";
  };
  const ScanReport total = totals(record);
  for (std::size_t i = 0; i < kRejectReasons; ++i)
    list(total.rejected[i], inWords(static_cast<RejectReason>(i)));
  const CameraPointCounts cameras =
      record.camera_labels ? record.camera_labels->points : CameraPointCounts{};
  list(cameras.unseenAndDropped(), "were hidden from the camera, or at a label border");
  list(cameras.low_confidence, "had a class that is less sure than <code>min_confidence</code>");
  list(record.labels.ignored + cameras.ignoredAndDropped(),
       "had a label that the label set ignores");
  list(record.labels.unknown + cameras.unknownAndDropped(),
       "had a label that the label set does not know, or that means free");
  list(record.labels.missing, "had no label");
  list(record.labels.ambiguous, "had several labels");
  page << "</ul>\n";
}

void writeKept(std::ostream& page, const RunRecord& record) {
  const std::size_t outside =
      record.camera_labels ? record.camera_labels->points.outsideAndDropped() : 0;
  if (outside > 0)
    page << "<p>" << formatCount(outside, "point") << " outside of the view of all cameras "
         << (outside == 1 ? "was" : "were")
         << " left out, as <code>outside_view = drop</code> has it: what lies there is missing in "
            "the map.</p>\n";
  if (record.labels.keptUnlabelled() > 0)
    page << "<p>" << formatCount(record.labels.keptUnlabelled(), "point")
         << " without a usable label of " << (record.labels.keptUnlabelled() == 1 ? "its" : "their")
         << " own went into the map as the class of unlabelled points.</p>\n";
  if (record.no_returns > 0)
    page << "<p>" << formatCount(record.no_returns, "beam")
         << " hit nothing (range 0, or beyond what the sensor measures).</p>\n";
  if (const std::string images = describeImages(record.images); !images.empty())
    page << "<p>Which beams are next to each other: " << images << ".</p>\n";
}

void writeRefused(std::ostream& page, const RunRecord& record) {
  if (record.refused.empty()) {
    page << "<p>Every observation was used.</p>\n";
    return;
  }
  page << "<p>" << formatCount(refusedTotal(record), "observation") << " of "
       << formatCount(record.observations_read) << " did not reach the map:</p>\n<ul>\n";
  for (const RefusedObservations& refused : record.refused)
    page << "<li>" << formatCount(refused.count) << " × <code>"
         << escapeHtml(refused.observation_class) << "</code>: " << escapeHtml(refused.reason)
         << "</li>\n";
  page << "</ul>\n";
}

void writeWarnings(std::ostream& page, const std::vector<std::string>& warnings) {
  if (warnings.empty()) {
    page << "<p>There were no warnings.</p>\n";
    return;
  }
  page << "<p>" << formatCount(warnings.size(), "warning") << ":</p>\n<ul class=\"warnings\">\n";
  for (std::size_t i = 0; i < std::min(warnings.size(), kMaxWarnings); ++i)
    page << "<li>" << escapeHtml(warnings[i]) << "</li>\n";
  page << "</ul>\n";
  if (warnings.size() > kMaxWarnings)
    page << "<p>" << formatCount(warnings.size() - kMaxWarnings)
         << " more are in <code>run.json</code>.</p>\n";
}

void writeOrigin(std::ostream& page, const RunRecord& record, const MapFigures& figures) {
  page << "<h2>How to make it again</h2>\n<pre>" << escapeHtml(record.command)
       << "</pre>\n<p class=\"soft\">Configuration: "
       << (record.config_file.empty() ? "the defaults" : escapeHtml(record.config_file))
       << ". Digest of the map: <code>" << escapeHtml(figures.digest)
       << "</code>; equal maps have equal digests.</p>\n";
}

void writeParameters(std::ostream& page, const std::vector<Parameter>& parameters) {
  page << "<details><summary>All " << formatCount(parameters.size(), "parameter")
       << "</summary>\n<div class=\"wide\"><table><thead><tr><th class=\"text\">name</th>"
       << "<th class=\"text\">value</th><th class=\"text\">meaning</th></tr></thead><tbody>\n";
  for (const Parameter& parameter : parameters)
    page << "<tr><td class=\"text\"><code>" << escapeHtml(parameter.name)
         << "</code></td><td class=\"text\">" << escapeHtml(toText(parameter)) << " "
         << escapeHtml(parameter.unit) << "</td><td class=\"text\">" << escapeHtml(parameter.help)
         << "</td></tr>\n";
  page << "</tbody></table></div></details>\n";
}

}  // namespace

std::string htmlReport(const RunRecord& record, const MapDocument& document,
                       const MapFigures& figures, const std::vector<MapPicture>& pictures) {
  const std::string viewer = viewerSection(document, record);
  std::ostringstream page;
  writeSummary(page, record, figures);
  writeFigures(page, record, figures);
  page << viewer;
  writeMapPictures(page, figures, pictures);
  writeCameraPictures(page, record, figures);
  writeClasses(page, figures);
  writeCameraLabels(page, record);
  writeTiming(page, record);
  page << "<h2>What was left out</h2>\n";
  writeRejects(page, record);
  writeKept(page, record);
  writeRefused(page, record);
  writeWarnings(page, record.warnings);
  writeOrigin(page, record, figures);
  writeParameters(page, record.parameters);
  HtmlPage html{titleOf(record), page.str()};
  html.viewer = !viewer.empty();
  html.charts = !record.scans.empty();
  return toHtml(html);
}

}  // namespace csom
