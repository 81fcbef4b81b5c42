// SPDX-License-Identifier: BSD-3-Clause
// Pictures of cameras, and figures about what they gave.
#include "CameraSections.h"

#include <csom/report/Format.h>
#include <csom/report/Html.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace csom {

namespace {

/// Seconds as in run.json, to the millisecond.
std::string timeInWords(double timestamp) {
  if (!std::isfinite(timestamp)) return "unknown";
  char text[400];  // the largest double has 309 digits before the point
  std::snprintf(text, sizeof text, "%.3f s", timestamp);
  return text;
}

void writePicture(std::ostream& page, const char* what, const std::string& camera,
                  const std::vector<std::uint8_t>& jpeg) {
  page << "<div><img alt=\"" << what << ", " << camera << "\" src=\"data:image/jpeg;base64,"
       << encodeBase64(jpeg) << "\"></div>\n";
}

void writePair(std::ostream& page, const CameraPicture& picture) {
  const std::string camera = escapeHtml(picture.sensor_label);
  page << "<figure class=\"pair\">\n";
  writePicture(page, "Segmented image", camera, picture.segmentation);
  writePicture(page, "Points coloured by class", camera, picture.points);
  page << "<figcaption>The " << toString(picture.moment) << " image of <code>" << camera
       << "</code>: number " << formatCount(picture.frame) << ", time "
       << timeInWords(picture.timestamp) << "</figcaption></figure>\n";
}

void writeLegend(std::ostream& page, const std::set<ClassId>& classes, const MapFigures& figures) {
  page << "<ul class=\"legend\">\n";
  for (const ClassFigures& c : figures.classes) {
    if (classes.count(c.id) == 0) continue;
    page << "<li><span class=\"swatch\" style=\"background:" << cssColor(c.color) << "\"></span>"
         << escapeHtml(c.name) << "</li>\n";
  }
  page << "</ul>\n";
}

void writeCameras(std::ostream& page, const std::vector<CameraStatistics::Camera>& cameras) {
  page << "<div class=\"wide\"><table><thead><tr><th class=\"text\">camera</th>"
       << "<th class=\"text\">labels from</th>";
  ImageCounts::visit(
      [&](const StatisticInfo& info) { page << "<th>" << escapeHtml(info.words) << "</th>"; });
  page << "<th>not needed</th></tr></thead><tbody>\n";
  for (const CameraStatistics::Camera& camera : cameras) {
    page << "<tr><td class=\"text\"><code>" << escapeHtml(camera.sensor_label)
         << "</code></td><td class=\"text\">" << escapeHtml(camera.source) << "</td>";
    ImageCounts::visit([&](const StatisticInfo&,
                           std::size_t count) { page << "<td>" << formatCount(count) << "</td>"; },
                       camera.images);
    page << "<td>" << formatCount(camera.images.unused()) << "</td></tr>\n";
  }
  page << "</tbody></table></div>\n";
}

std::string shareOf(std::size_t part, std::size_t whole) {
  return formatShare(static_cast<double>(part) /
                     static_cast<double>(std::max<std::size_t>(whole, 1)));
}

void writePoints(std::ostream& page, const CameraPointCounts& points) {
  page << "<div class=\"wide\"><table><thead><tr><th class=\"text\">point</th><th>count</th>"
       << "<th>share of those in view</th></tr></thead><tbody>\n";
  CameraPointCounts::visit(
      [&](const StatisticInfo& info, const std::size_t& count) {
        const bool in_view = &count != &points.outside_view && &count != &points.kept_unlabelled;
        if (count == 0) return;
        page << "<tr><td class=\"text\">" << escapeHtml(info.words) << "</td><td>"
             << formatCount(count) << "</td><td>"
             << (in_view ? shareOf(count, points.inView()) : "") << "</td></tr>\n";
      },
      points);
  page << "</tbody></table></div>\n";
  const std::size_t all = points.inView() + points.outside_view;
  page << "<p>" << formatCount(points.outside_view, "point") << " of " << formatCount(all) << " ("
       << shareOf(points.outside_view, all) << ") lay in the view of no camera. ";
  if (points.kept_unlabelled > 0)
    page << "Of the points that no camera sees, or not properly, "
         << formatCount(points.kept_unlabelled) << " went into the map as unlabelled.";
  page << "</p>\n";
}

void writeScans(std::ostream& page, const CameraStatistics& labels) {
  page << "<p>";
  CameraScanCounts::visit(
      [&](const StatisticInfo& info, const std::size_t& count) {
        if (count == 0 && &count != &labels.scans.labelled) return;
        const bool of_these = &count == &labels.scans.late;
        page << (of_these ? formatCount(count) : formatCount(count, "scan")) << " "
             << escapeHtml(info.words) << ". ";
      },
      labels.scans);
  if (labels.clock_restarts > 0)
    page << "The time stamps went back " << formatCount(labels.clock_restarts, "time") << ".";
  page << "</p>\n";
}

void writeSeconds(std::ostream& page, const RunRecord& record) {
  const CameraSeconds& seconds = record.camera_labels->seconds;
  page << "<p>Decoding images took " << formatDuration(seconds.image_decoding)
       << ", projecting points and judging what is visible " << formatDuration(seconds.labelling)
       << ". ";
  if (const auto added = addedShare(record))
    page << "The network alone took " << formatDuration(seconds.network)
         << "; the rest of the run added " << formatShare(*added) << " to that.";
  page << "</p>\n";
}

}  // namespace

const char* toString(CameraPicture::Moment moment) {
  switch (moment) {
    case CameraPicture::Moment::First:
      return "first";
    case CameraPicture::Moment::Middle:
      return "middle";
    case CameraPicture::Moment::Last:
      return "last";
  }
  return "";
}

void writeCameraPictures(std::ostream& page, const RunRecord& record, const MapFigures& figures) {
  if (record.pictures.empty()) return;
  page
      << "<h2>What the camera saw</h2>\n"
      << "<p class=\"soft\">Images tinted by the class of their pixels, and the points of the scan "
      << "over them. Small gray points got no label here: something hides them from the camera, "
      << "they are at a border, or their pixel has no class.</p>\n";
  std::set<ClassId> classes;
  for (const CameraPicture& picture : record.pictures)
    classes.insert(picture.classes.begin(), picture.classes.end());
  writeLegend(page, classes, figures);
  for (const CameraPicture& picture : record.pictures) writePair(page, picture);
}

void writeCameraLabels(std::ostream& page, const RunRecord& record) {
  if (!record.camera_labels) return;
  const CameraStatistics& labels = *record.camera_labels;
  page << "<h2>What became of the points in view</h2>\n";
  writePoints(page, labels.points);
  writeScans(page, labels);
  writeCameras(page, labels.cameras);
  writeSeconds(page, record);
}

std::string motionInWords(const RunRecord& record) {
  std::string text;
  if (const auto& registration = record.registration) {
    text += formatCount(registration->scans, "scan") + " registered in " +
            formatDuration(registration->seconds);
    if (registration->doubtful > 0)
      text += ", of which " + formatCount(registration->doubtful) + " fit poorly";
    text += ". ";
  }
  if (record.deskew) {
    std::string counts;
    DeskewStatistics::visit(
        [&](const StatisticInfo& info, std::size_t count) {
          counts +=
              (counts.empty() ? "" : ", ") + std::string(info.words) + ": " + formatCount(count);
        },
        *record.deskew);
    text += counts + ". ";
  }
  return text;
}

}  // namespace csom
