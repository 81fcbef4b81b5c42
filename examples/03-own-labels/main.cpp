// SPDX-License-Identifier: BSD-3-Clause
// Classes of one's own, labelled by a classifier of one's own.
#include <csom/core/SemanticMap.h>
#include <csom/io/LabelSet.h>
#include <csom/io/MapFile.h>

#include <cstdio>
#include <vector>

namespace {

/// Names and colours of the classes; docs/labels.md tells what else a label set can say.
constexpr char kLabels[] = R"(
name: orchard
classes:
  - {id: 0, name: free, color: [255, 255, 255]}
  - {id: 1, name: ground, color: [140, 110, 80]}
  - {id: 2, name: trunk, color: [110, 60, 20]}
  - {id: 3, name: leaves, color: [60, 160, 60]}
)";

/// Stands for a network: a distribution over the classes for one point, by its height.
std::vector<float> classify(const Eigen::Vector3f& point) {
  if (point.z() < -0.95F) return {0, 1, 0, 0};
  if (point.z() < 0.5F) return {0, 0.1F, 0.8F, 0.1F};
  return {0, 0, 0.2F, 0.8F};
}

}  // namespace

int main() {
  csom::MapDocument document;
  document.labels = csom::LabelSet::fromYaml(kLabels, "the classes of this program");
  csom::Options options;
  options.number_of_classes = document.labels.numberOfClasses();
  options.resolution = 0.1;
  document.map = csom::SemanticMap(options);

  // Soft labels: a row of one score a class for each point. (Hard ones go into scan.labels.)
  csom::Scan scan;
  scan.origin = {0, 0, 1};
  for (float z = -1; z < 2; z += 0.05F)
    for (float y = -0.2F; y < 0.2F; y += 0.05F) scan.points.emplace_back(3.F, y, z);
  for (const Eigen::Vector3f& point : scan.points) {
    const std::vector<float> scores = classify(point);
    scan.scores.insert(scan.scores.end(), scores.begin(), scores.end());
  }
  document.map.insert(scan);

  for (const double height : {0.05, 1.0, 2.5}) {
    const csom::DirichletVoxel voxel = document.map.at({3.02, 0.02, height});
    std::printf("%.1f m up: %s (%.2f)\n", height,
                document.labels.at(voxel.mostLikelyClass()).name.c_str(),
                voxel.probability(voxel.mostLikelyClass()));
  }
  document.meta["created_by"] = "example 03";
  csom::saveMap(document, "orchard.csom");
  std::printf("wrote orchard.csom; csom export orchard.csom --to ply -o orchard.ply\n");
  const bool as_expected = document.map.at({3.02, 0.02, 1.0}).mostLikelyClass() == 2 &&
                           document.map.at({3.02, 0.02, 2.5}).mostLikelyClass() == 3;
  return as_expected ? 0 : 1;
}
