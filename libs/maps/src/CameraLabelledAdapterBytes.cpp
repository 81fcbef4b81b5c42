// SPDX-License-Identifier: BSD-3-Clause
// Images and scans that wait for each other, as bytes: MRPT's particle filter copies maps by
// streams, between the image and the scan too.
#include <opencv2/core.hpp>

#include "ByteStream.h"
#include "CameraLabelledAdapter.h"
#include "StatisticsBytes.h"

namespace csom {
namespace {

template <class Value>
void writeVector(ByteWriter& out, const std::vector<Value>& values) {
  out.number(static_cast<std::uint64_t>(values.size()));
  out.raw(values.data(), values.size() * sizeof(Value));
}

template <class Value>
std::vector<Value> readVector(ByteReader& in) {
  std::vector<Value> values(in.count(sizeof(Value)));
  if (!values.empty())
    std::memcpy(static_cast<void*>(values.data()), in.raw(values.size() * sizeof(Value)),
                values.size() * sizeof(Value));
  return values;
}

void write(ByteWriter& out, const Eigen::Isometry3d& pose) {
  for (Eigen::Index i = 0; i < 12; ++i) out.number(pose.matrix()(i / 4, i % 4));
}

Eigen::Isometry3d readPose(ByteReader& in) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (Eigen::Index i = 0; i < 12; ++i) pose.matrix()(i / 4, i % 4) = in.number<double>();
  return pose;
}

void write(ByteWriter& out, const cv::Mat& pixels) {
  out.number(static_cast<std::int32_t>(pixels.rows));
  out.number(static_cast<std::int32_t>(pixels.cols));
  out.number(static_cast<std::int32_t>(pixels.type()));
  const std::size_t row = static_cast<std::size_t>(pixels.cols) * pixels.elemSize();
  for (int i = 0; i < pixels.rows; ++i) out.raw(pixels.ptr(i), row);
}

cv::Mat readPixels(ByteReader& in) {
  const auto rows = in.number<std::int32_t>();
  const auto columns = in.number<std::int32_t>();
  const auto type = in.number<std::int32_t>();
  if (rows == 0 && columns == 0) return {};
  const bool known = type == CV_8UC3 || type == CV_8UC1 || type == CV_16UC1;
  constexpr std::int32_t kMaxSide = 1 << 16;
  if (!known || rows <= 0 || columns <= 0 || rows > kMaxSide || columns > kMaxSide)
    throw std::runtime_error("serialised map: an image that cannot be");
  const std::size_t row = static_cast<std::size_t>(columns) * CV_ELEM_SIZE(type);
  const auto* bytes =
      static_cast<const std::uint8_t*>(in.raw(row * static_cast<std::size_t>(rows)));
  cv::Mat pixels(rows, columns, type);
  for (int i = 0; i < rows; ++i)
    std::memcpy(pixels.ptr(i), bytes + static_cast<std::size_t>(i) * row, row);
  return pixels;
}

void write(ByteWriter& out, const CameraCalibration& c) {
  out.number(static_cast<std::int32_t>(c.width));
  out.number(static_cast<std::int32_t>(c.height));
  for (const double value : {c.fx, c.fy, c.cx, c.cy}) out.number(value);
  out.number(static_cast<std::uint8_t>(c.distortion));
  for (const double value : c.coefficients) out.number(value);
}

CameraCalibration readCalibration(ByteReader& in) {
  CameraCalibration c;
  c.width = in.number<std::int32_t>();
  c.height = in.number<std::int32_t>();
  for (double* value : {&c.fx, &c.fy, &c.cx, &c.cy}) *value = in.number<double>();
  const auto distortion = in.number<std::uint8_t>();
  if (distortion > static_cast<std::uint8_t>(LensDistortion::KannalaBrandt))
    throw std::runtime_error("serialised map: an unknown lens distortion");
  c.distortion = static_cast<LensDistortion>(distortion);
  for (double& value : c.coefficients) value = in.number<double>();
  return c;
}

/// Without the photo and the labels: the one is for pictures, the others are asked for again.
void write(ByteWriter& out, const StreamedImage& image) {
  out.number(image.time);
  out.number(static_cast<std::uint64_t>(image.number));
  write(out, image.pixels);
  write(out, image.projection->calibration());
  write(out, image.camera_in_map);
  out.number(static_cast<std::uint8_t>(image.used));
}

StreamedImage readStreamedImage(ByteReader& in) {
  StreamedImage image;
  image.time = in.number<double>();
  image.number = in.number<std::uint64_t>();
  image.pixels = readPixels(in);
  const CameraCalibration calibration = readCalibration(in);
  if (image.pixels.cols != calibration.width || image.pixels.rows != calibration.height)
    throw std::runtime_error("serialised map: an image of another size than its calibration");
  image.projection = std::make_shared<const CameraProjection>(calibration);
  image.camera_in_map = readPose(in);
  image.used = in.flag();
  return image;
}

void write(ByteWriter& out, const RangeImage& image) {
  out.number(image.column_step);
  out.number(image.columns_of_turn);
  out.number(static_cast<std::uint64_t>(image.pixels.size()));
  for (const RangeImage::Pixel& pixel : image.pixels) {
    out.number(pixel.row);
    out.number(pixel.column);
  }
}

RangeImage readImage(ByteReader& in) {
  RangeImage image;
  image.column_step = in.number<std::int32_t>();
  image.columns_of_turn = in.number<std::int32_t>();
  image.pixels.resize(in.count(sizeof(std::uint16_t) + sizeof(std::int32_t)));
  for (RangeImage::Pixel& pixel : image.pixels) {
    pixel.row = in.number<std::uint16_t>();
    pixel.column = in.number<std::int32_t>();
  }
  return image;
}

void write(ByteWriter& out, const std::vector<EmptyBeam>& beams) {
  out.number(static_cast<std::uint64_t>(beams.size()));
  for (const EmptyBeam& beam : beams) {
    for (const float coordinate : beam.farthest) out.number(coordinate);
    out.number(beam.pixel.row);
    out.number(beam.pixel.column);
  }
}

std::vector<EmptyBeam> readEmptyBeams(ByteReader& in) {
  std::vector<EmptyBeam> beams(
      in.count(3 * sizeof(float) + sizeof(std::uint16_t) + sizeof(std::int32_t)));
  for (EmptyBeam& beam : beams) {
    for (float& coordinate : beam.farthest) coordinate = in.number<float>();
    beam.pixel.row = in.number<std::uint16_t>();
    beam.pixel.column = in.number<std::int32_t>();
  }
  return beams;
}

void write(ByteWriter& out, const SensorPoints& points) {
  writeVector(out, points.points);
  out.number(static_cast<std::uint64_t>(points.no_returns));
  out.number(static_cast<std::uint8_t>(points.image_origin));
  write(out, points.image);
  write(out, points.empty_beams);
}

SensorPoints readPoints(ByteReader& in, std::uint8_t version) {
  SensorPoints points;
  points.points = readVector<Eigen::Vector3f>(in);
  if (version >= 4) points.no_returns = in.number<std::uint64_t>();
  if (version < 6) return points;
  const auto origin = in.number<std::uint8_t>();
  if (origin > static_cast<std::uint8_t>(ImageOrigin::Found))
    throw std::runtime_error("serialised map: image origin " + std::to_string(origin));
  points.image_origin = static_cast<ImageOrigin>(origin);
  points.image = readImage(in);
  if (!points.image.empty() && points.image.pixels.size() != points.points.size())
    throw std::runtime_error("serialised map: an image of another size than its scan");
  points.empty_beams = readEmptyBeams(in);
  return points;
}

void write(ByteWriter& out, const WaitingScan& scan) {
  out.number(scan.time);
  out.number(static_cast<std::uint8_t>(scan.late));
  out.text(scan.sensor_label);
  out.text(scan.observation_class);
  write(out, scan.points);
  write(out, scan.sensor_in_map);
}

WaitingScan readWaitingScan(ByteReader& in, std::uint8_t version) {
  WaitingScan scan;
  scan.time = in.number<double>();
  scan.late = in.flag();
  scan.sensor_label = in.text();
  scan.observation_class = in.text();
  scan.points = readPoints(in, version);
  scan.sensor_in_map = readPose(in);
  return scan;
}

/// Before version 5 statistics had no names, but an order.
void readOldStatistics(ByteReader& in, CameraStatistics& s) {
  const auto count = [&](std::size_t& field) { field = in.number<std::uint64_t>(); };
  for (CameraStatistics::Camera& camera : s.cameras) {
    ImageCounts& images = camera.images;
    for (std::size_t* field :
         {&images.read, &images.used, &images.refused, &images.network_runs, &images.from_cache})
      count(*field);
  }
  CameraPointCounts& points = s.points;
  for (std::size_t* field :
       {&s.scans.labelled, &s.scans.without_image, &s.scans.late, &s.clock_restarts,
        &points.labelled, &points.outside_view, &points.hidden, &points.at_edge,
        &points.low_confidence, &points.ignored, &points.unknown, &points.kept_unlabelled})
    count(*field);
  for (double* field : {&s.seconds.image_decoding, &s.seconds.network, &s.seconds.labelling})
    *field = in.number<double>();
}

}  // namespace

void CameraLabelledAdapter::writeTo(ByteWriter& out) const {
  writeStatistics(out, statistics_);
  for (const CameraStatistics::Camera& camera : statistics_.cameras) {
    writeStatistics(out, camera.images);
    for (const double coordinate : camera.looks_along) out.number(coordinate);
  }
  out.number(static_cast<std::uint8_t>(clock_.has_value()));
  out.number(clock_.value_or(0));
  for (const Camera& camera : cameras_) {
    out.number(static_cast<std::uint64_t>(camera.image_count));
    out.number(static_cast<std::uint64_t>(camera.images.images().size()));
    for (const StreamedImage& image : camera.images.images()) write(out, image);
  }
  out.number(static_cast<std::uint64_t>(waiting_.size()));
  for (const WaitingScan& scan : waiting_) write(out, scan);
}

void CameraLabelledAdapter::readFrom(ByteReader& in, std::uint8_t version) {
  if (version < 5)
    readOldStatistics(in, statistics_);
  else
    readStatistics(in, statistics_);
  for (CameraStatistics::Camera& camera : statistics_.cameras) {
    if (version >= 5) readStatistics(in, camera.images);
    for (double& coordinate : camera.looks_along)
      if (version >= 4) coordinate = in.number<double>();
  }
  const bool has_clock = in.flag();
  const auto clock = in.number<double>();
  clock_ = has_clock ? std::make_optional(clock) : std::nullopt;
  for (Camera& camera : cameras_) {
    camera.image_count = in.number<std::uint64_t>();
    camera.images.clear();
    for (std::size_t left = in.count(1); left > 0; --left) camera.images.add(readStreamedImage(in));
  }
  waiting_.clear();
  for (std::size_t left = in.count(1); left > 0; --left)
    waiting_.push_back(readWaitingScan(in, version));
}

}  // namespace csom
