// SPDX-License-Identifier: BSD-3-Clause
// Which camera decides about a point, and what it says.
#include <csom/core/Options.h>
#include <csom/vision/PointLabelling.h>
#include <csom/vision/Visibility.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace csom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Mode = PointLabellingOptions::LabelMode;
using LowConfidence = PointLabellingOptions::LowConfidence;
using SeveralCameras = PointLabellingOptions::SeveralCameras;

/// Those of the points that lie in the image of one camera.
class PointsInView {
 public:
  PointsInView(const std::vector<Vector3f>& points, const CameraView& view,
               const PointLabellingOptions& options)
      : view_(view), slots_(points.size(), kOutside) {
    if (view.projection == nullptr || view.image == nullptr)
      throw std::invalid_argument("a view needs a projection and an image");
    const CameraCalibration& calibration = view.projection->calibration();
    const cv::Size size(calibration.width, calibration.height);
    if (view.image->size() != size)
      throw std::invalid_argument("the labels of a view are of another size than its calibration");
    for (std::size_t i = 0; i < points.size(); ++i) project(i, points[i]);
    if (options.visibility) hidden_ = hiddenPoints(seen_, size, options.visibility_margin);
    if (options.edge_margin > 0)
      at_edge_ = pointsAtEdges(seen_, view.image->classes(), options.edge_margin,
                               options.visibility_margin);
  }

  const SemanticImage& image() const { return *view_.image; }
  bool contains(std::size_t point) const { return slots_[point] != kOutside; }
  /// The others require contains(point).
  Vector2d pixel(std::size_t point) const { return seen_[slot(point)].pixel.cast<double>(); }
  bool isHidden(std::size_t point) const { return !hidden_.empty() && hidden_[slot(point)]; }
  bool isAtEdge(std::size_t point) const { return !at_edge_.empty() && at_edge_[slot(point)]; }
  /// 0 at the image centre, 1 in its corners.
  double offCentre(std::size_t point) const {
    const CameraCalibration& c = view_.projection->calibration();
    const Vector2d centre((c.width - 1) / 2.0, (c.height - 1) / 2.0);
    return 2 * (pixel(point) - centre).norm() / std::hypot(c.width, c.height);
  }

 private:
  static constexpr int kOutside = -1;

  std::size_t slot(std::size_t point) const { return static_cast<std::size_t>(slots_[point]); }

  void project(std::size_t i, const Vector3f& point) {
    const Vector3d in_camera = view_.camera_from_points * point.cast<double>();
    const auto exact = view_.projection->project(in_camera);
    if (!exact) return;
    const Eigen::Vector2f pixel = exact->cast<float>();
    if (!view_.projection->contains(pixel.cast<double>())) return;
    slots_[i] = static_cast<int>(seen_.size());
    seen_.push_back({pixel, static_cast<float>(in_camera.norm())});
  }

  const CameraView& view_;
  std::vector<int> slots_;  ///< by point: its place in the others
  std::vector<ProjectedPoint> seen_;
  std::vector<bool> hidden_;   ///< empty: none is
  std::vector<bool> at_edge_;  ///< empty: none is
};

class Labeller {
 public:
  Labeller(const std::vector<Vector3f>& points, const std::vector<CameraView>& views,
           int number_of_classes, const PointLabellingOptions& options)
      : options_(options),
        scores_(static_cast<std::size_t>(number_of_classes)),
        sum_(static_cast<std::size_t>(number_of_classes)) {
    views_.reserve(views.size());
    for (const CameraView& view : views) views_.emplace_back(points, view, options);
    out_.fates.assign(points.size(), PointFate::OutsideView);
    out_.views.assign(points.size(), -1);
    out_.classes.assign(points.size(), kFreeClass);
    if (mayBeUnsure()) out_.scores.assign(points.size() * sum_.size(), 0);
  }

  LabelledPoints labelAll() {
    for (std::size_t i = 0; i < out_.fates.size(); ++i) label(i);
    if (!any_unsure_) out_.scores.clear();
    return std::move(out_);
  }

 private:
  bool mayBeUnsure() const {
    return options_.label_mode == Mode::Soft ||
           (options_.low_confidence == LowConfidence::Soft && options_.min_confidence > 0);
  }
  void label(std::size_t point);
  void sortViewsOf(std::size_t point);
  PointFate look(const PointsInView& view, std::size_t point);
  PointFate decide(std::size_t point, float votes);

  const PointLabellingOptions& options_;
  std::vector<PointsInView> views_;
  LabelledPoints out_;
  bool any_unsure_ = false;
  // Of the point at hand.
  std::vector<std::pair<double, int>> order_;  ///< the views that contain it, best first
  PixelClass seen_;                            ///< what one view says
  std::vector<float> scores_;                  ///< its distribution
  std::vector<float> sum_;                     ///< of scores_ over the views that count
};

void Labeller::sortViewsOf(std::size_t point) {
  order_.clear();
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (views_[v].contains(point))
      order_.emplace_back(views_[v].offCentre(point), static_cast<int>(v));
  }
  std::sort(order_.begin(), order_.end());
}

/// Labelled if the view shows the point and says something of it: then that is in seen_ and
/// scores_.
PointFate Labeller::look(const PointsInView& view, std::size_t point) {
  if (view.isHidden(point)) return PointFate::Hidden;
  if (view.isAtEdge(point)) return PointFate::AtEdge;
  const PixelClass pixel = view.image().scoresAt(view.pixel(point), options_.temperature, scores_);
  if (pixel.id == kUnknownPixel) return PointFate::Unknown;
  // There is a surface where the point lies, so a pixel of free space (the sky) cannot be its own.
  if (pixel.id == kIgnoredPixel || pixel.id == kFreeClass) return PointFate::Ignored;
  seen_ = pixel;
  return PointFate::Labelled;
}

/// Makes a label of the sum of `votes` distributions, unless it is not sure enough.
PointFate Labeller::decide(std::size_t point, float votes) {
  PixelClass best = seen_;
  if (votes > 1) {
    const auto largest = std::max_element(sum_.begin(), sum_.end());
    best = {static_cast<ClassId>(largest - sum_.begin()), *largest / votes};
  }
  const bool unsure = best.confidence < static_cast<float>(options_.min_confidence);
  if (unsure && options_.low_confidence == LowConfidence::Drop) return PointFate::LowConfidence;
  out_.classes[point] = best.id;
  if (!mayBeUnsure()) return PointFate::Labelled;
  float* row = &out_.scores[point * sum_.size()];
  if (unsure || options_.label_mode == Mode::Soft) {
    any_unsure_ |= best.confidence < 1;
    for (std::size_t k = 0; k < sum_.size(); ++k) row[k] = sum_[k] / votes;
  } else {
    row[best.id] = 1;
  }
  return PointFate::Labelled;
}

void Labeller::label(std::size_t point) {
  sortViewsOf(point);
  std::fill(sum_.begin(), sum_.end(), 0.0F);
  float votes = 0;
  PointFate& fate = out_.fates[point];
  int& deciding_view = out_.views[point];
  for (const auto& [off_centre, v] : order_) {
    PointFate seen = look(views_[static_cast<std::size_t>(v)], point);
    if (seen == PointFate::Labelled) {
      for (std::size_t k = 0; k < sum_.size(); ++k) sum_[k] += scores_[k];
      votes += 1;
      if (options_.several_cameras == SeveralCameras::NearestToCentre) {
        seen = decide(point, votes);
        std::fill(sum_.begin(), sum_.end(), 0.0F);
        votes = 0;
      }
    }
    if (deciding_view < 0 || (seen == PointFate::Labelled && fate != PointFate::Labelled)) {
      deciding_view = v;
      fate = seen;
    }
    if (fate == PointFate::Labelled && votes == 0) return;
  }
  if (votes > 0) fate = decide(point, votes);
}

}  // namespace

void PointLabellingOptions::validate() const {
  requireInRanges([&](auto&& visitor) { visit(*this, visitor); });
}

const char* toString(PointFate fate) {
  switch (fate) {
    case PointFate::Labelled:
      return "labelled";
    case PointFate::OutsideView:
      return "outside_view";
    case PointFate::Hidden:
      return "hidden";
    case PointFate::AtEdge:
      return "at_edge";
    case PointFate::LowConfidence:
      return "low_confidence";
    case PointFate::Ignored:
      return "ignored";
    case PointFate::Unknown:
      return "unknown";
  }
  return "";
}

FateCounts LabelledPoints::counts() const {
  FateCounts counts{};
  for (const PointFate fate : fates) ++counts[static_cast<std::size_t>(fate)];
  return counts;
}

LabelledPoints labelPoints(const std::vector<Vector3f>& points,
                           const std::vector<CameraView>& views, int number_of_classes,
                           const PointLabellingOptions& options) {
  options.validate();
  if (number_of_classes < 1) throw std::invalid_argument("a label set has at least one class");
  return Labeller(points, views, number_of_classes, options).labelAll();
}

}  // namespace csom
