// SPDX-License-Identifier: BSD-3-Clause
// One self-contained page about one run.
#pragma once

#include <csom/io/MapFile.h>
#include <csom/report/MapFigures.h>
#include <csom/report/MapPicture.h>
#include <csom/report/RunRecord.h>

#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// A picture of the map for the page: a PNG file.
struct MapPicture {
  MapView view = MapView::Top;
  std::vector<std::uint8_t> png;
};

/// HTML 5 text that needs nothing else: no network, and the pictures, the voxels and the scripts
/// that show them inside. `figures` are those of the document. Every text of the record is escaped.
std::string htmlReport(const RunRecord& record, const MapDocument& document,
                       const MapFigures& figures, const std::vector<MapPicture>& pictures);

}  // namespace csom
