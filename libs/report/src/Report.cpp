// SPDX-License-Identifier: BSD-3-Clause
// Writes what a run leaves behind.
#include <csom/core/Error.h>
#include <csom/io/OutputFile.h>
#include <csom/report/HtmlReport.h>
#include <csom/report/Report.h>

#include <filesystem>
#include <system_error>

#include "PictureFiles.h"

namespace csom {

namespace {

void writeFile(const std::filesystem::path& path, const void* bytes, std::size_t size) {
  OutputFile file(path.string());
  file.write(bytes, size);
  file.commit();
}

void writePictures(const std::vector<CameraPicture>& pictures, const std::filesystem::path& base) {
  for (const CameraPicture& picture : pictures) {
    if (picture.sensor_label != pictures.front().sensor_label) continue;
    writeFile(base / pictureFile(picture.moment, "segmentation"), picture.segmentation.data(),
              picture.segmentation.size());
    writeFile(base / pictureFile(picture.moment, "points"), picture.points.data(),
              picture.points.size());
  }
}

}  // namespace

std::vector<std::string> reportFiles(const ReportOptions& options) {
  std::vector<std::string> names;
  if (options.json) names.push_back("run.json");
  if (options.html) names.push_back("report.html");
  if (options.png)
    for (const MapView view : kMapViews) names.push_back(pictureFile(view));
  if (!options.pictures) return names;
  using Moment = CameraPicture::Moment;
  for (const Moment moment : {Moment::First, Moment::Middle, Moment::Last}) {
    for (const char* what : {"segmentation", "points"}) names.push_back(pictureFile(moment, what));
  }
  return names;
}

void writeReport(const RunRecord& record, const MapDocument& document, const MapFigures& figures,
                 const std::string& folder, const ReportOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder, "cannot create this folder: " + error.message());

  const std::filesystem::path base(folder);
  if (options.json) {
    const std::string json = toJson(record, figures);
    writeFile(base / "run.json", json.data(), json.size());
  }
  if (options.pictures) writePictures(record.pictures, base);
  if (!options.png && !options.html) return;

  MapPictureOptions picture_options = options.map_picture;
  picture_options.up = record.up;
  std::vector<MapPicture> pictures;
  for (const MapView view : kMapViews)
    pictures.push_back({view, mapPicturePng(document, view, picture_options)});
  if (options.png)
    for (const MapPicture& picture : pictures)
      writeFile(base / pictureFile(picture.view), picture.png.data(), picture.png.size());
  if (options.html) {
    const std::string page = htmlReport(record, document, figures, pictures);
    writeFile(base / "report.html", page.data(), page.size());
  }
}

}  // namespace csom
