// SPDX-License-Identifier: BSD-3-Clause
// The part of a page in which one looks at the map from all sides.
#pragma once

#include <csom/io/MapFile.h>
#include <csom/report/RunRecord.h>

#include <string>

namespace csom {

/// A section for an HtmlPage with `viewer`; empty if the map has no occupied voxel.
std::string viewerSection(const MapDocument& document, const RunRecord& record);

}  // namespace csom
