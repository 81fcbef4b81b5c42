// SPDX-License-Identifier: BSD-3-Clause
// Puts a page together and says which scripts may run in it.
#include <csom/report/Html.h>
#include <csom/report/HtmlPage.h>

#include <vector>

#include "WebAsset.h"

namespace csom {

std::string toHtml(const HtmlPage& page) {
  std::vector<const WebAsset*> scripts;
  if (page.charts) scripts.insert(scripts.end(), {&kChartLibrary, &kChartScript});
  if (page.viewer)
    scripts.insert(scripts.end(), {&kThreeLibrary, &kOrbitControls, &kVoxelsScript, &kSceneScript,
                                   &kViewerScript});

  std::string policy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";
  for (std::size_t i = 0; i < scripts.size(); ++i)
    policy += (i == 0 ? "; script-src " : " ") + policySource(*scripts[i]);

  const std::string title = escapeHtml(page.title);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
      policy + "\">\n<title>" + title + "</title>\n<style>" + std::string(kReportStyle.text) +
      "</style>\n</head>\n<body>\n<h1>" + title + "</h1>\n" + page.body;
  if (!scripts.empty()) html += kLicences.text;
  for (const WebAsset* script : scripts) html += scriptElement(*script);
  return html + "</body>\n</html>\n";
}

}  // namespace csom
