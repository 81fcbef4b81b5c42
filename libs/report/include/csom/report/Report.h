// SPDX-License-Identifier: BSD-3-Clause
// The files that a run leaves for people and for scripts.
#pragma once

#include <csom/io/MapFile.h>
#include <csom/report/MapFigures.h>
#include <csom/report/MapPicture.h>
#include <csom/report/RunRecord.h>

#include <string>
#include <vector>

namespace csom {

struct ReportOptions {
  bool json = true;               ///< run.json
  bool png = true;                ///< top.png, front.png, side.png, isometric.png
  bool html = true;               ///< report.html
  bool pictures = true;           ///< camera-….jpg
  MapPictureOptions map_picture;  ///< its `up` is that of the record
};

/// Names of all files that writeReport() may write with these options.
std::vector<std::string> reportFiles(const ReportOptions& options = {});

/// `figures` are those of the document, see computeFigures(). Writes the files into `folder`, which
/// is created if missing. Of several cameras, the first one's pictures become files. Each file is
/// complete or absent: it is written beside its place and then renamed. Throws FileError.
void writeReport(const RunRecord& record, const MapDocument& document, const MapFigures& figures,
                 const std::string& folder, const ReportOptions& options = {});

}  // namespace csom
