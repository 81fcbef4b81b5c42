// SPDX-License-Identifier: BSD-3-Clause
// A drive of the KITTI raw data becomes a rawlog.
#include <csom/core/Error.h>
#include <csom/io/KittiReader.h>
#include <csom/rawlog/ImportKittiRaw.h>
#include <csom/rawlog/RawlogWriter.h>
#include <mrpt/obs/CObservationImage.h>

#include <filesystem>
#include <system_error>

#include "DataSetFiles.h"
#include "EigenPose.h"
#include "LoggedScan.h"

namespace csom {
namespace {

namespace fs = std::filesystem;

struct Camera {
  std::string name;  ///< "image_02"
  fs::path images;
  KittiCamera calibration;
};

fs::path calibrationFolder(const KittiRawImport& request) {
  if (!request.calibration.empty()) return request.calibration;
  const fs::path folder = fs::absolute(request.folder).lexically_normal();
  for (const fs::path& place :
       {folder / "calib", folder, folder.parent_path(), folder.parent_path().parent_path()}) {
    if (fs::exists(place / "calib_cam_to_cam.txt")) return place;
  }
  throw FileError(request.folder,
                  "has images but no calib_cam_to_cam.txt in calib/ or beside it; name its folder");
}

std::vector<Camera> camerasOf(const KittiRawImport& request) {
  std::vector<Camera> cameras;
  for (int number = 0; number < 4; ++number) {
    const std::string name = "image_0" + std::to_string(number);
    const fs::path images = fs::path(request.folder) / name / "data";
    if (!fs::is_directory(images)) continue;
    const auto calibration = readKittiRawCamera(calibrationFolder(request).string(), number);
    cameras.push_back({name, images, calibration});
  }
  return cameras;
}

mrpt::img::TCamera pinhole(const KittiCamera& camera) {
  mrpt::img::TCamera parameters;
  parameters.ncols = static_cast<std::uint32_t>(camera.width);
  parameters.nrows = static_cast<std::uint32_t>(camera.height);
  parameters.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
  return parameters;
}

/// RAWLOG_Images, filled beside its place, moved there when complete, and gone again if the log
/// then cannot be put beside it.
class ImageFolder {
 public:
  explicit ImageFolder(const std::string& rawlog) {
    const fs::path log(rawlog);
    std::string stem = log.filename().string();
    if (log.extension() == ".gz") stem = log.stem().string();
    target_ = log.parent_path() / (fs::path(stem).stem().string() + "_Images");
    if (fs::exists(target_))
      throw FileError(target_.string(), "exists already; remove it, or choose another rawlog name");
    unfinished_ = target_.string() + ".tmp";
    removeUnfinished();  // what a killed run left must not be moved along
  }
  ~ImageFolder() {
    std::error_code ignored;
    fs::remove_all(unfinished_, ignored);
    if (moved_ && !kept_) fs::remove_all(target_, ignored);
  }
  ImageFolder(const ImageFolder&) = delete;
  ImageFolder& operator=(const ImageFolder&) = delete;

  void add(const fs::path& image, const std::string& name) const {
    std::error_code error;
    fs::create_directories(unfinished_, error);
    fs::copy_file(image, unfinished_ / name, fs::copy_options::overwrite_existing, error);
    if (error) throw FileError((unfinished_ / name).string(), error.message());
  }
  void moveToPlace() {
    if (!fs::exists(unfinished_)) return;
    std::error_code error;
    fs::rename(unfinished_, target_, error);
    if (error) throw FileError(target_.string(), error.message());
    moved_ = true;
  }
  /// To be called once the log is in its place.
  void keep() { kept_ = true; }

 private:
  void removeUnfinished() const {
    std::error_code error;
    fs::remove_all(unfinished_, error);
    if (error) throw FileError(unfinished_.string(), "cannot be removed: " + error.message());
  }

  fs::path target_;
  fs::path unfinished_;
  bool moved_ = false;
  bool kept_ = false;
};

class Drive {
 public:
  Drive(const KittiRawImport& request, ImageFolder* image_folder, ImportSummary& summary)
      : velodyne_(fs::path(request.folder) / "velodyne_points"),
        files_(detail::filesIn((velodyne_ / "data").string(), ".bin")),
        times_((velodyne_ / "timestamps.txt").string()),
        cameras_(camerasOf(request)),
        image_folder_(image_folder),
        summary_(summary) {}

  std::size_t size() const { return files_.size(); }

  void write(std::size_t position, RawlogWriter& log) {
    const std::string& file = files_[position];
    const std::size_t number = detail::numberOfFile(file).value_or(position);
    const double time = times_.of(number, file);
    for (const Camera& camera : cameras_) {
      const fs::path image = camera.images / (fs::path(file).stem().string() + ".png");
      if (fs::exists(image)) {
        writeImage(camera, image, time, log);
        ++summary_.images;
      } else {
        summary_.warnings.push_back(image.string() + ": missing, its frame has no such image");
      }
    }
    const KittiScan scan = readKittiScan(file);
    log.write(detail::cloudObservation(scan.points, scan.intensities, time, "velodyne"));
    ++summary_.scans;
    summary_.points += scan.points.size();
  }

 private:
  void writeImage(const Camera& camera, const fs::path& image, double time, RawlogWriter& log) {
    mrpt::obs::CObservationImage observation;
    observation.timestamp = mrpt::Clock::fromDouble(time);
    observation.sensorLabel = camera.name;
    observation.cameraParams = pinhole(camera.calibration);
    observation.cameraPose = detail::toMrpt(camera.calibration.camera_from_velodyne.inverse());
    if (image_folder_ != nullptr) {
      const std::string name = camera.name + "_" + image.filename().string();
      image_folder_->add(image, name);
      observation.image.setExternalStorage(name);
    } else if (!observation.image.loadFromFile(image.string())) {
      throw FileError(image.string(), "is no image");
    }
    log.write(observation);
  }

  fs::path velodyne_;
  std::vector<std::string> files_;
  detail::ScanTimes times_;
  std::vector<Camera> cameras_;
  ImageFolder* image_folder_;
  ImportSummary& summary_;
};

}  // namespace

ImportSummary importKittiRaw(const KittiRawImport& request, const std::string& rawlog,
                             const ImportProgress& progress) {
  ImportSummary summary;
  std::optional<ImageFolder> images;
  if (!request.embed_images) images.emplace(rawlog);
  Drive drive(request, images ? &*images : nullptr, summary);
  const auto chosen = detail::choose(request.selection, request.folder, drive.size());
  RawlogWriter log(rawlog);
  for (const std::size_t position : chosen) {
    drive.write(position, log);
    if (progress) progress(summary.scans, chosen.size());
  }
  if (images) images->moveToPlace();
  log.commit();
  if (images) images->keep();
  return summary;
}

}  // namespace csom
