// SPDX-License-Identifier: BSD-3-Clause
// The voxels of a map as NumPy arrays.
#include <csom/exports/PointFiles.h>

#include <algorithm>
#include <cstdint>

#include <csom/exports/ExportChecks.h>
#include "BinaryNumbers.h"
#include "NumpyArchive.h"

namespace csom {

std::size_t writeNpz(const VoxelSelection& voxels, const LabelSet& labels,
                     const std::string& file) {
  detail::checkExport(voxels, labels);
  const std::size_t count = voxels.count();
  const std::string rows = std::to_string(count);

  detail::NumpyArchive archive;
  detail::NumpyArray& center = archive.add("center", "<f8", "(" + rows + ", 3)");
  detail::NumpyArray& class_id = archive.add("class_id", "|u1", "(" + rows + ",)");
  detail::NumpyArray& probability = archive.add("probability", "<f8", "(" + rows + ",)");
  detail::NumpyArray& variance = archive.add("variance", "<f8", "(" + rows + ",)");
  detail::NumpyArray& evidence = archive.add("evidence", "<f8", "(" + rows + ",)");
  voxels.forEach([&](const VoxelIndex&, const ExportedVoxel& v) {
    detail::writeBinary(center, v.center.x(), v.center.y(), v.center.z());
    detail::writeBinary(class_id, static_cast<std::uint8_t>(v.class_id));
    detail::writeBinary(probability, v.probability);
    detail::writeBinary(variance, v.variance);
    detail::writeBinary(evidence, v.evidence);
  });

  std::size_t longest = 1;
  for (const LabelClass& c : labels.classes()) longest = std::max(longest, c.name.size());
  detail::NumpyArray& names = archive.add("class_name", "|S" + std::to_string(longest),
                                          "(" + std::to_string(labels.numberOfClasses()) + ",)");
  for (const LabelClass& c : labels.classes()) {
    std::string padded = c.name;
    padded.resize(longest, '\0');
    names.write(padded.data(), padded.size());
  }
  detail::NumpyArray& resolution = archive.add("resolution", "<f8", "()");
  detail::writeBinary(resolution, voxels.resolution());
  archive.write(file);
  return count;
}

}  // namespace csom
