// SPDX-License-Identifier: BSD-3-Clause
// Joins scans and images by time, and labels the one from the other.
#include "CameraLabelledAdapter.h"

#include <csom/maps/PoseRounding.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "ObservationName.h"

namespace csom {
namespace {

class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(&seconds) {}
  ~Stopwatch() {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    *seconds_ += elapsed.count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double* seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

double timeOf(const mrpt::obs::CObservation& observation) {
  if (observation.timestamp == INVALID_TIMESTAMP)
    throw std::runtime_error("it has no time stamp, by which images and scans are joined");
  return secondsSince1970(observation);
}

}  // namespace

CameraLabelledAdapter::CameraLabelledAdapter(const LabelOptions& options, const LabelSet& labels,
                                             const BeamRequest& beams)
    : ObservationAdapter(beams),
      options_(options),
      raw_to_class_(rawToClass(labels)),
      number_of_classes_(labels.numberOfClasses()) {
  if (options.outside_view == OutsideView::Unlabelled) unlabelled_ = labels.unlabelledClass();
  for (const LabelSource& source : options.sources) {
    if (!source.isCamera()) continue;
    cameras_.push_back({source, makeLabeller(source, labels), {}, {}, {}, 0});
    statistics_.cameras.push_back({source.sensor_label, toString(source.kind), {}, {0, 0, 0}});
  }
}

void CameraLabelledAdapter::loadNetworks() {
  for (Camera& camera : cameras_) {
    if (camera.labeller) camera.labeller->loadNetwork();
  }
}

std::unique_ptr<ObservationAdapter> CameraLabelledAdapter::clone() const {
  auto copy = std::make_unique<CameraLabelledAdapter>(*this);
  copy->observer_ = {};
  return copy;
}

void CameraLabelledAdapter::takeNetworksOf(const ObservationAdapter& adapter) {
  const auto* const given = dynamic_cast<const CameraLabelledAdapter*>(&adapter);
  if (given == nullptr) throw std::invalid_argument("the other map has no cameras");
  const CameraLabelledAdapter& other = *given;
  const bool same = std::equal(cameras_.begin(), cameras_.end(), other.cameras_.begin(),
                               other.cameras_.end(), [](const Camera& a, const Camera& b) {
                                 return a.source.sensor_label == b.source.sensor_label &&
                                        a.source.kind == b.source.kind &&
                                        a.source.network == b.source.network &&
                                        a.source.model == b.source.model &&
                                        a.source.label_image == b.source.label_image;
                               });
  if (!same) throw std::invalid_argument("the label sources of two maps are not the same");
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    cameras_[i].labeller = other.cameras_[i].labeller;
  options_.label_cache = other.options_.label_cache;
}

std::shared_ptr<ImageLabeller> CameraLabelledAdapter::makeLabeller(const LabelSource& source,
                                                                   const LabelSet& labels) const {
  if (source.kind != LabelSource::Kind::Network) return nullptr;
  for (const Camera& other : cameras_) {
    if (other.labeller && other.source.network == source.network &&
        other.source.model == source.model)
      return other.labeller;
  }
  return std::make_shared<ImageLabeller>(source, options_.label_cache, labels);
}

std::optional<std::vector<AdaptedScan>> CameraLabelledAdapter::adapt(
    const mrpt::obs::CObservation& observation, const Eigen::Isometry3d& robot_pose,
    const LabelRules& rules) {
  const auto camera = static_cast<std::size_t>(
      std::find_if(cameras_.begin(), cameras_.end(),
                   [&](const Camera& c) { return c.imageLabel() == observation.sensorLabel; }) -
      cameras_.begin());
  const PointExtractor* extractor = findPointExtractor(observation);
  std::optional<CameraImage> image;
  if (camera < cameras_.size()) image = readImage(camera, observation);
  if (!image && extractor == nullptr) {
    if (!takePhoto(observation)) return std::nullopt;
    return std::exchange(finished_, {});
  }

  WaitingScan scan;
  if (extractor != nullptr) {
    const bool self = labelsItself(observation.sensorLabel);
    scan.points =
        extractor->extract(observation, self ? rules : rules.withSource(PointLabels::None));
    searchForImage(beams(), scan.points);
    scan.sensor_label = observation.sensorLabel;
    scan.observation_class = observationName(observation);
    if (self || labelsItself(scan.points, rules)) {
      AdaptedScan adapted = makeScan(scan.points, robot_pose, rules, beams());
      adapted.timestamp = secondsSince1970(observation);
      adapted.sensor_label = scan.sensor_label;
      adapted.observation_class = scan.observation_class;
      finished_.push_back(std::move(adapted));
      extractor = nullptr;
    }
  }
  if (image || extractor != nullptr) {
    const double time = timeOf(observation);
    advanceClock(time);
    if (image) addImage(camera, *image, time, robot_pose);
    if (extractor != nullptr) {
      scan.time = time;
      scan.late = time + options_.max_time_offset < *clock_;
      scan.sensor_in_map = sensorPoseInMap(robot_pose, scan.points.sensor_pose);
      waiting_.push_back(std::move(scan));
    }
    finishReady();
    forgetImages();
  }
  return std::exchange(finished_, {});
}

bool CameraLabelledAdapter::labelsItself(const std::string& sensor_label) const {
  return std::any_of(options_.sources.begin(), options_.sources.end(), [&](const LabelSource& s) {
    return !s.isCamera() && s.sensor_label == sensor_label;
  });
}

/// Labels of pixels are in the observation itself, the class of 2-D scans is in the options. That
/// of unlabelled points says nothing.
bool CameraLabelledAdapter::labelsItself(const SensorPoints& points,
                                         const LabelRules& rules) const {
  return std::any_of(points.labels.begin(), points.labels.end(), [&](const PointLabel& label) {
    if (label.kind == PointLabel::Kind::Missing) return false;
    return label.kind != PointLabel::Kind::Class || label.id != rules.labels().unlabelledClass();
  });
}

std::optional<CameraImage> CameraLabelledAdapter::readImage(
    std::size_t camera, const mrpt::obs::CObservation& observation) {
  ImageCounts& counts = statistics_.cameras[camera].images;
  const Stopwatch watch(statistics_.seconds.image_decoding);
  try {
    std::optional<CameraImage> image = toCameraImage(observation);
    if (!image) return image;
    const bool color = image->pixels.type() == CV_8UC3;
    if (cameras_[camera].labeller) {
      if (image->pixels.type() == CV_16UC1)
        throw std::runtime_error("its image has 16 bits, a network takes 8");
    } else if (color) {
      throw std::runtime_error("its image has colours, not the gray values that are raw ids");
    }
    timeOf(observation);
    ++counts.read;
    return image;
  } catch (...) {
    ++counts.read;
    ++counts.refused;
    throw;
  }
}

/// What a camera saw whose labels come as other images: only pictures need it.
bool CameraLabelledAdapter::takePhoto(const mrpt::obs::CObservation& observation) {
  for (Camera& camera : cameras_) {
    if (camera.labeller || camera.source.sensor_label != observation.sensorLabel) continue;
    if (!observer_) return true;
    const std::optional<CameraImage> image = toCameraImage(observation);
    if (!image) return false;
    camera.last_photo.time = timeOf(observation);
    camera.last_photo.pixels = image->pixels;
    if (StreamedImage* labels = camera.images.nearest(camera.last_photo.time, 0))
      labels->photo = image->pixels;
    return true;
  }
  return false;
}

void CameraLabelledAdapter::addImage(std::size_t camera, const CameraImage& image, double time,
                                     const Eigen::Isometry3d& robot_pose) {
  Camera& to = cameras_[camera];
  if (!to.projection || !(to.projection->calibration() == image.calibration))
    to.projection = std::make_shared<const CameraProjection>(image.calibration);
  StreamedImage streamed;
  streamed.time = time;
  streamed.number = to.image_count++;
  streamed.pixels = image.pixels;
  if (to.labeller)
    streamed.photo = image.pixels;
  else if (to.last_photo.time == time)
    streamed.photo = to.last_photo.pixels;
  streamed.projection = to.projection;
  streamed.camera_in_map = sensorPoseInMap(robot_pose, image.pose_on_robot);
  const auto axes = image.pose_on_robot.getRotationMatrix();
  statistics_.cameras[camera].looks_along = {axes(0, 2), axes(1, 2), axes(2, 2)};
  if (to.images.add(std::move(streamed))) return;
  ++statistics_.cameras[camera].images.refused;
  throw std::runtime_error(
      "there is another image of this sensor label and this time; cameras need "
      "sensor labels of their own");
}

void CameraLabelledAdapter::advanceClock(double time) {
  if (clock_ && time < *clock_ - restart()) {
    ++statistics_.clock_restarts;
    clock_ = time;
    while (!waiting_.empty()) {
      const WaitingScan scan = std::move(waiting_.front());
      waiting_.pop_front();
      finish(scan);
    }
    for (Camera& camera : cameras_) camera.images.clear();
  }
  clock_ = std::max(clock_.value_or(time), time);
}

bool CameraLabelledAdapter::isReady(const WaitingScan& scan) const {
  return *clock_ > scan.time + options_.max_time_offset ||
         std::all_of(cameras_.begin(), cameras_.end(),
                     [&](const Camera& camera) { return camera.images.reaches(scan.time); });
}

void CameraLabelledAdapter::finishReady() {
  for (std::size_t i = 0; i < waiting_.size();) {
    const bool crowded = i == 0 && waiting_.size() > kMaxWaiting;
    if (!crowded && !isReady(waiting_[i])) {
      ++i;
      continue;
    }
    // Taken out first: a scan whose labelling fails must not be tried again and again.
    const WaitingScan scan = std::move(waiting_[i]);
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
    finish(scan);
  }
}

std::vector<AdaptedScan> CameraLabelledAdapter::flush() {
  while (!waiting_.empty()) {
    const WaitingScan scan = std::move(waiting_.front());
    waiting_.pop_front();
    finish(scan);
  }
  for (Camera& camera : cameras_) camera.images.clear();
  clock_.reset();
  return std::exchange(finished_, {});
}

/// Makes sure that the images have labels. Those of one network go through it together.
void CameraLabelledAdapter::evaluate(
    const std::vector<std::pair<std::size_t, StreamedImage*>>& images) {
  for (const auto& [first_camera, first] : images) {
    if (first->labels) continue;
    const std::shared_ptr<ImageLabeller>& labeller = cameras_[first_camera].labeller;
    if (!labeller) {
      first->labels = std::make_shared<const LabelImage>(first->pixels, raw_to_class_);
      continue;
    }
    std::vector<cv::Mat> pixels;
    std::vector<std::pair<std::size_t, StreamedImage*>> together;
    for (const auto& [camera, image] : images) {
      if (image->labels || cameras_[camera].labeller != labeller) continue;
      pixels.push_back(image->pixels);
      together.emplace_back(camera, image);
    }
    const auto labels = labeller->label(pixels);
    for (std::size_t i = 0; i < together.size(); ++i) {
      together[i].second->labels = labels.images[i];
      ImageCounts& counts = statistics_.cameras[together[i].first].images;
      ++(labels.from_cache[i] ? counts.from_cache : counts.network_runs);
    }
    statistics_.seconds.network += labels.network_seconds;
    if (statistics_.cache_fault.empty()) statistics_.cache_fault = labels.cache_fault;
  }
}

void CameraLabelledAdapter::finish(const WaitingScan& scan) {
  std::vector<std::pair<std::size_t, StreamedImage*>> images;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    StreamedImage* image = cameras_[i].images.nearest(scan.time, options_.max_time_offset);
    if (image == nullptr) continue;
    if (!image->used) ++statistics_.cameras[i].images.used;
    image->used = true;
    images.emplace_back(i, image);
  }
  evaluate(images);

  const Stopwatch watch(statistics_.seconds.labelling);
  std::vector<CameraView> views;
  for (const auto& [camera, image] : images)
    views.push_back({image->projection.get(), image->camera_in_map.inverse() * scan.sensor_in_map,
                     image->labels.get()});
  const LabelledPoints labelled =
      labelPoints(scan.points.points, views, number_of_classes_, options_.points);

  if (images.empty()) {
    ++statistics_.scans.without_image;
    if (scan.late) ++statistics_.scans.late;
  } else {
    ++statistics_.scans.labelled;
  }
  statistics_.points.add(labelled.counts());
  finished_.push_back(scanOf(scan, labelled, number_of_classes_, unlabelled_, beams().free_range,
                             statistics_.points.kept_unlabelled));

  if (!observer_ || images.empty()) return;
  LabelledScan seen{scan.points.points, labelled, {}};
  for (std::size_t i = 0; i < images.size(); ++i) {
    const StreamedImage& image = *images[i].second;
    seen.views.push_back({cameras_[images[i].first].source.sensor_label, image.time, image.number,
                          image.photo, image.projection, views[i].camera_from_points,
                          image.labels});
  }
  observer_(seen);
}

/// Images that no scan can need any more: scans may come late by as much as restart().
void CameraLabelledAdapter::forgetImages() {
  double oldest = *clock_;
  for (const WaitingScan& scan : waiting_) oldest = std::min(oldest, scan.time);
  for (Camera& camera : cameras_)
    camera.images.forgetBefore(oldest - options_.max_time_offset - restart());
}

std::unique_ptr<ObservationAdapter> makeAdapter(const LabelOptions& options, const LabelSet& labels,
                                                const BeamRequest& beams) {
  if (!options.usesCameras()) return std::make_unique<SelfLabelledAdapter>(beams);
  return std::make_unique<CameraLabelledAdapter>(options, labels, beams);
}

}  // namespace csom
