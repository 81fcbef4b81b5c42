// SPDX-License-Identifier: BSD-3-Clause
// run.json → run record.
#include <csom/io/InputFile.h>
#include <csom/report/RunRecordReader.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <type_traits>
#include <utility>

#include "JsonFields.h"
#include "PictureFiles.h"
#include "StatisticsJson.h"

namespace csom {

namespace {

using Json = JsonFields::Json;

std::vector<Parameter> readParameters(const JsonFields& run) {
  std::vector<Parameter> parameters;
  const JsonFields meanings = run.object("parameter_meanings");
  for (const auto& [name, value] : run.object("parameters").json().items()) {
    Parameter parameter{name, std::string(), "", ""};
    if (value.is_boolean())
      parameter.value = value.get<bool>();
    else if (value.is_number_integer())
      parameter.value = value.get<std::int64_t>();
    else if (value.is_number())
      parameter.value = value.get<double>();
    else if (value.is_string())
      parameter.value = value.get<std::string>();
    else
      run.fail("parameters." + name, "is neither switch, number nor text");
    if (meanings.has(name.c_str())) {
      const JsonFields meaning = meanings.object(name.c_str());
      parameter.unit = meaning.text("unit");
      parameter.help = meaning.text("help");
    }
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

/// The map file has all of a scan but the time that it took as a whole.
std::vector<RunScan> readScans(const JsonFields& run, const std::vector<ScanRecord>& scans) {
  const std::vector<JsonFields> recorded = run.objects("scans");
  if (recorded.size() != scans.size())
    run.fail("scans", "has " + std::to_string(recorded.size()) + " entries, but the map has " +
                          std::to_string(scans.size()) + " scans");
  std::vector<RunScan> result;
  for (std::size_t i = 0; i < scans.size(); ++i)
    result.push_back({scans[i], recorded[i].number("insert_ms")});
  return result;
}

CameraStatistics readCameraLabels(const JsonFields& json) {
  auto labels = statisticsFromJson<CameraStatistics>(json);
  for (const JsonFields& camera : json.objects("cameras"))
    labels.cameras.push_back({camera.text("sensor_label"),
                              camera.text("source"),
                              statisticsFromJson<ImageCounts>(camera.object("images")),
                              {}});
  return labels;
}

ScanReport readReport(const JsonFields& json) {
  ScanReport report;
  visitReport(report, [&](const std::string& name, auto& field) {
    if constexpr (std::is_integral_v<std::decay_t<decltype(field)>>)
      field = json.count(name.c_str());
    else
      field = json.number(name.c_str());
  });
  return report;
}

std::vector<CameraPicture> readPictures(const JsonFields& run) {
  using Moment = CameraPicture::Moment;
  std::vector<CameraPicture> pictures;
  for (const JsonFields& json : run.objects("pictures")) {
    CameraPicture picture;
    const std::string moment = json.text("moment");
    for (const Moment m : {Moment::First, Moment::Middle, Moment::Last})
      if (moment == toString(m)) picture.moment = m;
    picture.sensor_label = json.text("sensor_label");
    picture.timestamp = json.number("timestamp");
    picture.frame = json.count("frame");
    for (const Json& k : json.list("classes")) {
      if (!k.is_number_unsigned() || k.get<std::size_t>() >= kMaxClasses)
        json.fail(json.place() + "classes", "has an entry that is no class id");
      picture.classes.push_back(k.get<ClassId>());
    }
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

MapFigures readFigures(const JsonFields& run, const MapDocument& document) {
  MapFigures figures = computeFigures(document);
  const JsonFields map = run.object("map");
  const std::string recorded = map.text("digest");
  const std::string& found = figures.digest;
  if (recorded != found && recorded != mapDigestOfVersion1(document.map))
    run.failWith("belongs to the map with the digest " + recorded +
                 ", but the digest of the map is " + found + ": take the files of one run");
  // A map that is read takes less memory than one that has grown.
  figures.memory_bytes = map.count("memory_bytes");
  return figures;
}

RunRecord readRecord(const JsonFields& run, const MapDocument& document) {
  RunRecord record;
  record.program_version = run.text("program_version");
  record.command = run.text("command");
  record.inputs = run.texts("inputs");
  record.config_file = run.text("config_file");
  record.parameters = readParameters(run);
  record.pose_source = run.text("pose_source");
  record.label_set = run.text("label_set");
  const Json& up = run.list("up");
  if (up.size() != 3 ||
      !std::all_of(up.begin(), up.end(), [](const Json& c) { return c.is_number(); }))
    run.fail("up", "is no list of three numbers");
  record.up = {up[0].get<double>(), up[1].get<double>(), up[2].get<double>()};
  record.observations_read = run.object("totals").count("observations_read");
  record.scans = readScans(run, document.scans);
  for (const JsonFields& refused : run.objects("refused"))
    record.refused.push_back(
        {refused.text("observation_class"), refused.text("reason"), refused.count("count")});
  if (run.has("camera_labels"))
    record.camera_labels = readCameraLabels(run.object("camera_labels"));
  if (run.has("deskew")) record.deskew = statisticsFromJson<DeskewStatistics>(run.object("deskew"));
  if (run.has("registration"))
    record.registration = statisticsFromJson<RegistrationStatistics>(run.object("registration"));
  record.pictures = readPictures(run);
  record.warnings = run.texts("warnings");
  record.wall_seconds = run.number("wall_seconds");
  record.unused = readReport(run.object("unused"));
  record.labels = statisticsFromJson<LabelCounts>(run.object("labels"));
  record.no_returns = run.object("totals").count("no_returns");
  // Files of version 0.1 do not have it.
  if (run.has("scan_images"))
    record.images = statisticsFromJson<ScanImageCounts>(run.object("scan_images"));
  return record;
}

/// Nothing if it is no regular file: pictures may be missing.
std::vector<std::uint8_t> bytesOf(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

SavedRun runFromJson(const std::string& text, const std::string& file,
                     const MapDocument& document) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    throw FileError(file, std::string("is no JSON: ") + error.what());
  }
  const JsonFields run(json, file);
  MapFigures figures = readFigures(run, document);
  return {readRecord(run, document), std::move(figures)};
}

SavedRun loadRun(const std::string& folder, const MapDocument& document) {
  const std::filesystem::path base(folder);
  const std::string file = (base / "run.json").string();
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw FileError(file, "no such file; csom map writes it");
  const std::string text = detail::readFile(file);  // a pipe or a device would never end
  SavedRun run = runFromJson(text, file, document);
  RunRecord& record = run.record;

  std::vector<CameraPicture> found;
  for (CameraPicture& picture : record.pictures) {
    // Of several cameras, only the first one's pictures are files.
    if (picture.sensor_label != record.pictures.front().sensor_label) continue;
    picture.segmentation = bytesOf(base / pictureFile(picture.moment, "segmentation"));
    picture.points = bytesOf(base / pictureFile(picture.moment, "points"));
    if (!picture.segmentation.empty() && !picture.points.empty()) found.push_back(picture);
  }
  record.pictures = std::move(found);
  return run;
}

}  // namespace csom
