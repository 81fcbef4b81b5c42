// SPDX-License-Identifier: BSD-3-Clause
// Style sheet and scripts of pages: files of libs/report/web and of Debian's packages, which the
// build puts into the library, so that a program that is copied elsewhere has them with it.
#pragma once

#include <string>
#include <string_view>

namespace csom {

struct WebAsset {
  std::string_view text;
  std::string_view sha256;  ///< of the text, 64 hexadecimal digits
};

extern const WebAsset kReportStyle;
extern const WebAsset kChartLibrary;  ///< chart.js
extern const WebAsset kChartScript;
extern const WebAsset kThreeLibrary;  ///< three.js
extern const WebAsset kOrbitControls;
extern const WebAsset kLicences;  ///< of the libraries
extern const WebAsset kViewerMarkup;
extern const WebAsset kVoxelsScript;
extern const WebAsset kSceneScript;
extern const WebAsset kViewerScript;

/// <script>…</script>
std::string scriptElement(const WebAsset& script);

/// A source of a Content-Security-Policy: 'sha256-…' lets the page run this script and no other.
std::string policySource(const WebAsset& script);

}  // namespace csom
