// SPDX-License-Identifier: BSD-3-Clause
// KITTI calibrations and poses.
#include <csom/io/KittiReader.h>
#include <csom/io/TrajectoryFile.h>

#include "FuzzTarget.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  csom::fuzz::readAsFile(data, size, "calib.txt",
                         [](const std::string& file) { csom::readKittiOdometryCalibration(file); });
  csom::fuzz::readAsFile(data, size, "poses.txt",
                         [](const std::string& file) { csom::readKittiPoses(file); });
  return 0;
}
