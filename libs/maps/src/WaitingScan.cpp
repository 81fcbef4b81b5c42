// SPDX-License-Identifier: BSD-3-Clause
// A scan before and after it has its labels.
#include "WaitingScan.h"

#include "ImageOfKept.h"

namespace csom {
namespace {

/// True for points that hit something of which no camera tells what it is. Less sure than
/// min_confidence is another matter, for which there is an option.
bool hasNoClass(PointFate fate) {
  return fate != PointFate::Labelled && fate != PointFate::LowConfidence;
}

/// Those of a point that surely is of a class.
void appendScores(std::vector<float>& scores, std::size_t classes, ClassId class_id) {
  scores.resize(scores.size() + classes, 0.0F);
  scores[scores.size() - classes + class_id] = 1;
}

}  // namespace

AdaptedScan scanOf(const WaitingScan& waiting, const LabelledPoints& labelled,
                   int number_of_classes, ClassId unlabelled, double free_range,
                   std::size_t& kept_unlabelled) {
  AdaptedScan adapted;
  adapted.timestamp = waiting.time;
  adapted.sensor_label = waiting.sensor_label;
  adapted.observation_class = waiting.observation_class;
  adapted.no_returns = waiting.points.no_returns;
  adapted.scan.origin = waiting.sensor_in_map.translation();
  const Eigen::Matrix3d rotation = waiting.sensor_in_map.linear();
  const auto classes = static_cast<std::size_t>(number_of_classes);
  const bool soft = !labelled.scores.empty();
  ImageOfKept image(waiting.points, adapted);
  for (std::size_t i = 0; i < waiting.points.points.size(); ++i) {
    const bool keep = unlabelled != kFreeClass && hasNoClass(labelled.fates[i]);
    if (labelled.fates[i] != PointFate::Labelled && !keep) continue;
    if (keep) ++kept_unlabelled;
    const Eigen::Vector3d point = rotation * waiting.points.points[i].cast<double>();
    adapted.scan.points.push_back(point.cast<float>());
    image.keep(i);
    if (!soft) {
      adapted.scan.labels.push_back(keep ? unlabelled : labelled.classes[i]);
      continue;
    }
    std::vector<float>& scores = adapted.scan.scores;
    if (keep) {
      appendScores(scores, classes, unlabelled);
    } else {
      const auto row = labelled.scores.begin() + static_cast<std::ptrdiff_t>(i * classes);
      scores.insert(scores.end(), row, row + static_cast<std::ptrdiff_t>(classes));
    }
  }
  image.keepEmpty(rotation, free_range, [&] {
    if (soft)
      appendScores(adapted.scan.scores, classes, kFreeClass);
    else
      adapted.scan.labels.push_back(kFreeClass);
  });
  return adapted;
}

}  // namespace csom
