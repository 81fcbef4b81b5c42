// SPDX-License-Identifier: BSD-3-Clause
// The example of the README.
#include <csom/core/SemanticMap.h>

int main() {
  csom::Options options;
  options.resolution = 0.2;        // metres
  options.number_of_classes = 20;  // class 0 is free space
  csom::SemanticMap map(options);

  csom::Scan scan;
  scan.origin = {1.0, 2.0, 0.5};       // the sensor, in the map frame
  scan.points = {{4.0F, 0.0F, 0.1F}};  // relative to the sensor, axes of the map
  scan.labels = {7};
  map.insert(scan);
  const bool likely = map.at({5.0, 2.0, 0.6}).probability(7) > 0.5;
  return likely && map.castRay({1.0, 2.0, 0.5}, {1.0, 0.0, 0.0}, 30.0) ? 0 : 1;
}
