// SPDX-License-Identifier: BSD-3-Clause
// Markup, header and voxels of the viewer.
#include "Viewer.h"

#include <csom/report/Html.h>

#include <string>

#include "ViewerModel.h"
#include "WebAsset.h"

namespace csom {

std::string viewerSection(const MapDocument& document, const RunRecord& record) {
  const ViewerModel model = viewerModel(document, record);
  if (model.cubes == 0) return "";
  // A script of a type that no browser runs: the parser then takes the megabytes as one text.
  return "<h2 class=\"on-screen\">The map from all sides</h2>\n" + std::string(kViewerMarkup.text) +
         dataElement(model.header, "viewer-header") +
         "<script type=\"text/plain\" id=\"viewer-data\">" + encodeBase64(model.data) +
         "</script>\n";
}

}  // namespace csom
