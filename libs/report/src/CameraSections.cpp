// SPDX-License-Identifier: BSD-3-Clause
// Pictures of cameras, and figures about what they gave.
#include "CameraSections.h"

#include <csom/report/Format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "Html.h"

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

void writeCameras(std::ostream& page, const std::vector<CameraSource>& cameras) {
  page << "<div class=\"wide\"><table><thead><tr><th class=\"text\">camera</th>"
       << "<th class=\"text\">labels from</th><th>images</th><th>used</th>"
       << "<th>through the network</th><th>from the cache</th><th>not needed</th><th>refused</th>"
       << "</tr></thead><tbody>\n";
  for (const CameraSource& camera : cameras) {
    const ImageCounts& images = camera.images;
    page << "<tr><td class=\"text\"><code>" << escapeHtml(camera.sensor_label)
         << "</code></td><td class=\"text\">" << escapeHtml(camera.source) << "</td><td>"
         << formatCount(images.read) << "</td><td>" << formatCount(images.used) << "</td><td>"
         << formatCount(images.network_runs) << "</td><td>" << formatCount(images.from_cache)
         << "</td><td>" << formatCount(images.unused) << "</td><td>" << formatCount(images.refused)
         << "</td></tr>\n";
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
  const auto row = [&](const char* fate, std::size_t count) {
    if (count == 0) return;
    page << "<tr><td class=\"text\">" << fate << "</td><td>" << formatCount(count) << "</td><td>"
         << shareOf(count, points.inView()) << "</td></tr>\n";
  };
  row("got a label", points.labelled);
  row("hidden from the camera by something nearer", points.hidden);
  row("at a label border where the depth jumps", points.at_edge);
  row("less sure of its class than <code>min_confidence</code>", points.low_confidence);
  row("on something that the label set ignores", points.ignored);
  row("on something that the label set does not know", points.unknown);
  page << "</tbody></table></div>\n";
  const std::size_t all = points.inView() + points.outside_view;
  page << "<p>" << formatCount(points.outside_view, "point") << " of " << formatCount(all) << " ("
       << shareOf(points.outside_view, all) << ") lay in the view of no camera. ";
  if (points.kept_unlabelled > 0)
    page << "Of the points that no camera sees, or not properly, "
         << formatCount(points.kept_unlabelled) << " went into the map as unlabelled.";
  page << "</p>\n";
}

void writeScans(std::ostream& page, const CameraLabels& labels) {
  page << "<p>" << formatCount(labels.scans.labelled, "scan") << " got labels from images. ";
  if (labels.scans.without_image > 0)
    page << formatCount(labels.scans.without_image, "scan")
         << " had no image near enough in time (<code>max_time_offset</code>). ";
  if (labels.scans.late > 0)
    page << formatCount(labels.scans.late)
         << " of these came when the images of their time had been given up already. ";
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
  const CameraLabels& labels = *record.camera_labels;
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
  if (const auto& deskew = record.deskew) {
    text += "Scans de-skewed: " + formatCount(deskew->deskewed) +
            ", not needed: " + formatCount(deskew->not_needed) +
            ", not possible: " + formatCount(deskew->not_possible) + ". ";
  }
  return text;
}

}  // namespace csom
