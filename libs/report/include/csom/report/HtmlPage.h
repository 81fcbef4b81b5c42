// SPDX-License-Identifier: BSD-3-Clause
// A page that needs nothing else.
#pragma once

#include <string>

namespace csom {

struct HtmlPage {
  std::string title;
  std::string body;     ///< HTML behind the heading; whoever writes it escapes
  bool charts = false;  ///< the body has charts (see Chart.h)
  bool viewer = false;  ///< the body has a map to look at from all sides
};

/// HTML 5 text with the style sheet of all pages, and the scripts that its parts need. The page
/// loads nothing and forbids the browser to: should a text slip through the escaping, it can
/// neither run nor load anything.
std::string toHtml(const HtmlPage& page);

}  // namespace csom
