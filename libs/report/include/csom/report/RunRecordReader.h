// SPDX-License-Identifier: BSD-3-Clause
// What a run left behind, read again: for reports that are made later.
#pragma once

#include <csom/io/MapFile.h>
#include <csom/report/RunRecord.h>

#include <string>

namespace csom {

/// The inverse of toJson(), with the help of the scans that the map file keeps. `text` is that of a
/// run.json, `file` names it in errors. Pictures of cameras are described in it but not held: see
/// loadRunRecord(). Throws FileError if it is no run record, or if it belongs to another map than
/// `document`.
RunRecord runRecordFromJson(const std::string& text, const std::string& file,
                            const MapDocument& document);

/// run.json of a folder with the camera pictures beside it. Pictures of which no file is there are
/// left out. Throws FileError.
RunRecord loadRunRecord(const std::string& folder, const MapDocument& document);

}  // namespace csom
