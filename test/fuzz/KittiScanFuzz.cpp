// SPDX-License-Identifier: BSD-3-Clause
// KITTI scans and labels: the first byte is the number of points that the labels are for.
#include <csom/io/KittiReader.h>

#include "FuzzTarget.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  csom::fuzz::readAsFile(data + 1, size - 1, "input.bin",
                         [](const std::string& file) { csom::readKittiScan(file); });
  csom::fuzz::readAsFile(data + 1, size - 1, "input.label", [=](const std::string& file) {
    csom::readKittiLabels(file, std::size_t{data[0]});
  });
  return 0;
}
