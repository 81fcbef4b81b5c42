// SPDX-License-Identifier: BSD-3-Clause
// What a run left behind, read again: for reports that are made later.
#pragma once

#include <csom/io/MapFile.h>
#include <csom/report/RunRecord.h>

#include <string>

namespace csom {

/// What toJson() writes.
struct SavedRun {
  RunRecord record;
  MapFigures figures;  ///< of the document; `memory_bytes` as it was in the run
};

/// The inverse of toJson(), with the help of the scans that the map file keeps. `text` is that of a
/// run.json, `file` names it in errors. Pictures of cameras are described in it but not held: see
/// loadRun(). Throws FileError if it is no run record, or if it belongs to another map than
/// `document`.
SavedRun runFromJson(const std::string& text, const std::string& file, const MapDocument& document);

/// run.json of a folder with the camera pictures beside it. Pictures of which no file is there are
/// left out. Throws FileError.
SavedRun loadRun(const std::string& folder, const MapDocument& document);

}  // namespace csom
