// SPDX-License-Identifier: BSD-3-Clause
// Points of a scan take the labels of the pixels that show them.
#pragma once

#include <csom/core/EnumWords.h>
#include <csom/core/OptionInfo.h>
#include <csom/core/types.h>
#include <csom/vision/CameraProjection.h>
#include <csom/vision/SemanticImage.h>

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace csom {

struct PointLabellingOptions {
  /// Hard: the best class. Soft: the distribution over the classes.
  enum class LabelMode { Hard, Soft };
  /// Of several cameras that see a point: the one in which it is nearest to the image centre (as a
  /// share of the half diagonal), or all of them: their distributions are averaged.
  enum class SeveralCameras { NearestToCentre, Vote };
  /// What becomes of points whose best score is under min_confidence: dropped, or kept with their
  /// distribution, even if the mode is Hard.
  enum class LowConfidence { Drop, Soft };

  LabelMode label_mode = LabelMode::Hard;
  double temperature = 1;     ///< of the softmax
  double min_confidence = 0;  ///< of the best class
  LowConfidence low_confidence = LowConfidence::Drop;
  SeveralCameras several_cameras = SeveralCameras::NearestToCentre;

  /// Reject points that something nearer hides from the camera.
  bool visibility = true;
  /// A point is only hidden by what is nearer to the camera by more than this [m].
  double visibility_margin = 0.8;
  /// Labels may bleed so many pixels over jumps of the depth (see pointsAtEdges()); points whose
  /// label may have are rejected. 0 keeps them all.
  double edge_margin = 2;

  /// Throws OptionError that names the key.
  void validate() const;

  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    visitor(OptionInfo{"label_mode", "",
                       "a point takes the best class (hard), or the distribution over the classes "
                       "(soft)"},
            o.label_mode);
    visitor(OptionInfo{"temperature",
                       "",
                       "of the softmax; above 1 is less sure of the best class",
                       {1e-6, 1e6}},
            o.temperature);
    visitor(OptionInfo{"min_confidence",
                       "",
                       "points whose best class is less sure are treated as low_confidence says",
                       {0, 1}},
            o.min_confidence);
    visitor(OptionInfo{"low_confidence", "",
                       "such points are left out (drop) or keep their distribution (soft)"},
            o.low_confidence);
    visitor(OptionInfo{"visibility", "",
                       "points that something nearer hides from the camera are rejected"},
            o.visibility);
    visitor(OptionInfo{"visibility_margin", "m", "what is nearer by less does not hide", {0, 1e7}},
            o.visibility_margin);
    visitor(OptionInfo{"edge_margin",
                       "pixels",
                       "points so near to a label border are rejected if the depth jumps there; 0 "
                       "keeps them",
                       {0, 100}},
            o.edge_margin);
    visitor(OptionInfo{"several_cameras", "",
                       "of several cameras that see a point the one counts in whose image it is "
                       "nearest to the centre (nearest-to-centre), or all (vote)"},
            o.several_cameras);
  }
};

template <>
inline constexpr EnumWords<PointLabellingOptions::LabelMode, 2>
    kWords<PointLabellingOptions::LabelMode>{{{PointLabellingOptions::LabelMode::Hard, "hard"},
                                              {PointLabellingOptions::LabelMode::Soft, "soft"}}};
template <>
inline constexpr EnumWords<PointLabellingOptions::SeveralCameras, 2>
    kWords<PointLabellingOptions::SeveralCameras>{
        {{PointLabellingOptions::SeveralCameras::NearestToCentre, "nearest-to-centre"},
         {PointLabellingOptions::SeveralCameras::Vote, "vote"}}};
template <>
inline constexpr EnumWords<PointLabellingOptions::LowConfidence, 2>
    kWords<PointLabellingOptions::LowConfidence>{
        {{PointLabellingOptions::LowConfidence::Drop, "drop"},
         {PointLabellingOptions::LowConfidence::Soft, "soft"}}};

/// What became of a point.
enum class PointFate : std::uint8_t {
  Labelled,
  OutsideView,    ///< in no camera's image
  Hidden,         ///< something nearer hides it from the camera
  AtEdge,         ///< its label may be that of something beside it
  LowConfidence,  ///< below min_confidence, and dropped
  Ignored,        ///< the label set ignores what the pixel shows, or it shows free space (sky)
  Unknown,        ///< the label set does not know what the pixel shows
};
constexpr std::size_t kPointFates = 7;
const char* toString(PointFate fate);
using FateCounts = std::array<std::size_t, kPointFates>;

/// A camera at the moment of its image.
struct CameraView {
  const CameraProjection* projection = nullptr;
  Eigen::Isometry3d camera_from_points = Eigen::Isometry3d::Identity();  ///< to the optical frame
  const SemanticImage* image = nullptr;
};

struct LabelledPoints {
  std::vector<PointFate> fates;  ///< one a point
  std::vector<int> views;        ///< one a point: the view that decided; −1 outside of all views
  std::vector<ClassId> classes;  ///< one a point; the best class where the fate is Labelled
  /// Empty if every labelled point is sure of its class, else points × number_of_classes,
  /// row-major: a distribution for every labelled point, 0 for the others.
  std::vector<float> scores;

  FateCounts counts() const;
};

/// Labels `points` (any frame) from what the views show. A point that one camera does not see
/// properly (hidden, at an edge, ignored …) takes the label of the next best one; its fate is that
/// of the best view if none has a label. Points that are not finite are OutsideView. Throws
/// OptionError; std::invalid_argument if a projection and its image differ in size.
LabelledPoints labelPoints(const std::vector<Eigen::Vector3f>& points,
                           const std::vector<CameraView>& views, int number_of_classes,
                           const PointLabellingOptions& options);

}  // namespace csom
