// SPDX-License-Identifier: BSD-3-Clause
// A drive of the KITTI raw data becomes a rawlog.
#include <csom/core/Error.h>
#include <csom/core/TemporaryPath.h>
#include <csom/io/KittiReader.h>
#include <csom/io/TextParser.h>
#include <csom/rawlog/ImportKittiRaw.h>
#include <csom/rawlog/RawlogWriter.h>
#include <mrpt/obs/CObservationImage.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <map>
#include <memory>
#include <string_view>
#include <system_error>

#include "import/DataSetFiles.h"
#include "logs/FrameNumbers.h"
#include "logs/LoggedScan.h"
#include "poses/EigenPose.h"

namespace csom {
namespace {

namespace fs = std::filesystem;

constexpr char kScanner[] = "velodyne";  ///< sensor label

struct Camera {
  std::string name;  ///< "image_02"
  fs::path folder;
  KittiCamera calibration;
  std::map<std::size_t, std::string> images;  ///< files by frame
  detail::FrameTimes times;
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

/// What cv::imread() reads and data sets are published as.
bool isImageFile(const fs::path& file) {
  const std::string extension = detail::lowerCase(file.extension().string());
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg";
}

std::map<std::size_t, std::string> imagesIn(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!isImageFile(entry.path())) continue;
    detail::requireReadable(entry);
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end(), naturalLess);
  const std::vector<std::size_t> frames = detail::numbersOfFiles(files);
  std::map<std::size_t, std::string> images;
  for (std::size_t i = 0; i < files.size(); ++i) images[frames[i]] = files[i];
  return images;
}

std::vector<Camera> camerasOf(const KittiRawImport& request) {
  std::vector<Camera> cameras;
  for (int number = 0; number < 4; ++number) {
    const std::string name = "image_0" + std::to_string(number);
    const fs::path folder = fs::path(request.folder) / name;
    if (!fs::is_directory(folder / "data")) continue;
    const auto calibration = readKittiRawCamera(calibrationFolder(request).string(), number);
    cameras.push_back({name, folder, calibration, imagesIn(folder / "data"),
                       detail::FrameTimes((folder / "timestamps.txt").string())});
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
    unfinished_ = target_.string() + kEnding + std::to_string(::getpid());
    removeAbandoned();
    temporary_ = std::make_unique<TemporaryPath>(unfinished_.string());
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
    // Until the log is there too.
    moved_target_ = std::make_unique<TemporaryPath>(target_.string());
    std::error_code error;
    fs::rename(unfinished_, target_, error);
    if (error) throw FileError(target_.string(), error.message());
    moved_ = true;
  }
  /// To be called once the log is in its place.
  void keep() {
    kept_ = true;
    moved_target_.reset();
  }

 private:
  /// What killed imports left.
  void removeAbandoned() const {
    const std::string start = target_.filename().string() + kEnding;
    const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
    std::vector<fs::path> abandoned;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
      const std::string name = at->path().filename().string();
      if (name.rfind(start, 0) != 0) continue;
      int owner = 0;
      const bool is_ours = detail::parseNumber(std::string_view(name).substr(start.size()), owner);
      const bool is_dead = is_ours && owner > 0 && ::kill(owner, 0) != 0 && errno == ESRCH;
      if (is_dead || owner == ::getpid()) abandoned.push_back(at->path());
    }
    for (const fs::path& path : abandoned) fs::remove_all(path, error);
  }

  static constexpr char kEnding[] = ".tmp";  ///< and the number of the process
  fs::path target_;
  fs::path unfinished_;
  std::unique_ptr<TemporaryPath> temporary_;
  std::unique_ptr<TemporaryPath> moved_target_;
  bool moved_ = false;
  bool kept_ = false;
};

/// One observation that is to be written.
struct Shot {
  double time = 0;
  std::size_t frame = 0;
  const Camera* camera = nullptr;  ///< null: the scan
  std::string file;
};

class Drive {
 public:
  Drive(const KittiRawImport& request, ImageFolder* image_folder)
      : velodyne_(fs::path(request.folder) / "velodyne_points"),
        files_(detail::filesIn((velodyne_ / "data").string(), ".bin")),
        frames_(detail::numbersOfFiles(files_)),
        times_((velodyne_ / "timestamps.txt").string()),
        cameras_(camerasOf(request)),
        image_folder_(image_folder) {}

  std::size_t size() const { return files_.size(); }

  /// The scans at these positions and the images of their frames, as they were taken one after the
  /// other. What has no counterpart is told in `summary`.
  std::vector<Shot> makeShots(const std::vector<std::size_t>& positions,
                              ImportSummary& summary) const {
    std::vector<Shot> shots;
    for (const std::size_t position : positions) {
      const std::size_t frame = frames_[position];
      shots.push_back({times_.of(frame, files_[position]), frame, nullptr, files_[position]});
      for (const Camera& camera : cameras_) {
        const auto image = camera.images.find(frame);
        if (image == camera.images.end()) continue;
        // An image is taken when the scanner looks ahead; without a time of its own it is taken for
        // one of the scan's moment.
        const double time =
            camera.times.areGiven() ? camera.times.of(frame, image->second) : shots.back().time;
        shots.push_back({time, frame, &camera, image->second});
      }
    }
    for (const Camera& camera : cameras_) tellUnpaired(camera, positions, summary);
    std::stable_sort(shots.begin(), shots.end(), [](const Shot& a, const Shot& b) {
      if (a.time != b.time) return a.time < b.time;
      return a.camera != nullptr && b.camera == nullptr;
    });
    return shots;
  }

  void write(const Shot& shot, RawlogWriter& log, ImportSummary& summary) const {
    if (shot.camera != nullptr) {
      writeImage(shot, log);
      ++summary.images;
      return;
    }
    const KittiScan scan = readKittiScan(shot.file);
    log.write(detail::cloudObservation(scan.points, scan.intensities, shot.time, kScanner));
    ++summary.scans;
    summary.points += scan.points.size();
  }

 private:
  void tellUnpaired(const Camera& camera, const std::vector<std::size_t>& positions,
                    ImportSummary& summary) const {
    const auto tell = [&](const std::vector<std::size_t>& frames, const std::string& what) {
      if (frames.empty()) return;
      summary.warnings.push_back(camera.name + ": " + std::to_string(frames.size()) + " " + what +
                                 "; the first is frame " + std::to_string(frames.front()));
    };
    std::vector<std::size_t> without_image;
    for (const std::size_t position : positions)
      if (camera.images.count(frames_[position]) == 0) without_image.push_back(frames_[position]);
    tell(without_image,
         "scans have no image in " + (camera.folder / "data").string() + " (*.png, *.jpg)");
    // With a selection: between the first and the last scan that were chosen.
    const bool all = positions.size() == files_.size();
    std::vector<std::size_t> without_scan;
    for (const auto& [frame, file] : camera.images) {
      const bool asked_for =
          all || (frame >= frames_[positions.front()] && frame <= frames_[positions.back()]);
      const bool scanned = std::binary_search(frames_.begin(), frames_.end(), frame);
      if (asked_for && !scanned) without_scan.push_back(frame);
    }
    tell(without_scan, "images belong to frames without a scan and were left out");
  }

  void writeImage(const Shot& shot, RawlogWriter& log) const {
    const Camera& camera = *shot.camera;
    mrpt::obs::CObservationImage observation;
    observation.timestamp = mrpt::Clock::fromDouble(shot.time);
    observation.sensorLabel = camera.name;
    observation.cameraParams = pinhole(camera.calibration);
    observation.cameraPose = detail::toMrpt(camera.calibration.camera_from_velodyne.inverse());
    if (image_folder_ != nullptr) {
      const std::string name = camera.name + "_" + fs::path(shot.file).filename().string();
      image_folder_->add(shot.file, name);
      observation.image.setExternalStorage(name);
    } else if (!observation.image.loadFromFile(shot.file)) {
      throw FileError(shot.file, "is no image");
    }
    log.write(observation);
  }

  fs::path velodyne_;
  std::vector<std::string> files_;
  std::vector<std::size_t> frames_;  ///< of the files, ascending
  detail::FrameTimes times_;
  std::vector<Camera> cameras_;
  ImageFolder* image_folder_;
};

}  // namespace

ImportSummary importKittiRaw(const KittiRawImport& request, const std::string& rawlog,
                             const ImportProgress& progress) {
  ImportSummary summary;
  std::optional<ImageFolder> images;
  if (!request.embed_images) images.emplace(rawlog);
  const Drive drive(request, images ? &*images : nullptr);
  const auto chosen = detail::choose(request.selection, request.folder, drive.size());
  const std::vector<Shot> shots = drive.makeShots(chosen, summary);
  summary.labels = "none; points carry their reflectance, which is no label";
  detail::FrameNumbers frames;
  for (const Shot& shot : shots)
    frames.add(shot.camera != nullptr ? shot.camera->name : kScanner, shot.time, shot.frame);
  RawlogWriter log(rawlog);
  log.write(frames.toComment());
  for (const Shot& shot : shots) {
    drive.write(shot, log, summary);
    if (progress && shot.camera == nullptr) progress(summary.scans, chosen.size());
  }
  if (images) images->moveToPlace();
  log.commit();
  if (images) images->keep();
  return summary;
}

}  // namespace csom
