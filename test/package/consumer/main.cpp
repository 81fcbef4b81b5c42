// SPDX-License-Identifier: BSD-3-Clause
// Touches every layer of an installed mrpt_csom: core, io, the MRPT plug-in and report.
#include <csom/core/SemanticMap.h>
#include <csom/io/LabelSet.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/report/MapFigures.h>

#include <cstdio>

int main() {
  const csom::LabelSet labels = csom::LabelSet::load(LABELS_DIR "/semantickitti.yaml");
  csom::Options options;
  options.number_of_classes = labels.numberOfClasses();

  csom::SemanticMap map(options);
  csom::Scan scan;
  scan.points = {{1, 2, 3}};
  scan.labels = {1};
  map.insert(scan);
  const csom::MapFigures figures = csom::computeFigures({map, labels, {}, {}});
  if (figures.occupied_voxels == 0) {
    std::fprintf(stderr, "a point was inserted, but no voxel is occupied\n");
    return 1;
  }

  const csom::CSemanticContinuousMap mrpt_map;
  return mrpt_map.isEmpty() ? 0 : 1;
}
