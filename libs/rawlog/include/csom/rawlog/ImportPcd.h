// SPDX-License-Identifier: BSD-3-Clause
// Point clouds in PCD files become a rawlog.
#pragma once

#include <csom/io/PcdReader.h>
#include <csom/rawlog/Import.h>

#include <string>
#include <vector>

namespace csom {

struct PcdImport {
  std::vector<std::string> files;  ///< files, or folders of *.pcd; taken in natural order
  bool single_scan = false;        ///< all files are one scan
  /// Field that becomes the intensity of the points, where maps look for labels, in whatever case.
  /// Empty: `label` if the files have it, else none; points then have no intensity at all.
  std::string label_field;
  PcdRowPolicy row_policy = PcdRowPolicy::IgnoreExtra;
  ScanSelection selection;  ///< of the files
};

/// Writes, for each scan, a CObservationRobotPose (label "poses": at the VIEWPOINT's position, axes
/// parallel to the map's) and a CObservationPointCloud (label "cloud") relative to it. Scans are
/// 0.1 s apart, the first at 0. Throws FileError, ConfigError if files of a single scan have
/// different sensor positions, FileError too if a field that is named is not there, or if some
/// files have labels and others have none.
ImportSummary importPcd(const PcdImport& request, const std::string& rawlog,
                        const ImportProgress& progress = {});

}  // namespace csom
