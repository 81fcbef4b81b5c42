// SPDX-License-Identifier: BSD-3-Clause
#include "ConfusionTable.h"

#include <csom/report/Html.h>

#include <cstdio>
#include <vector>

namespace csom {
namespace {

/// Names stay in one line: a table of many classes scrolls.
constexpr char kRowHeader[] =
    "<th class=\"text\" style=\"white-space:nowrap;overflow-wrap:normal\">";

std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", 100 * share);
  return text;
}

std::string name(const LabelSet& labels, ClassId k) {
  return escapeHtml(labels.at(k).name);
}

/// The accent colour as strong as the share.
std::string cell(double share) {
  char style[96];
  std::snprintf(style, sizeof style,
                "<td style=\"background:color-mix(in srgb, var(--accent) %.0f%%, transparent)\">",
                75 * share);
  return style + percent(share) + "</td>";
}

}  // namespace

std::string confusionTable(const ConfusionMatrix& matrix, const LabelSet& labels) {
  std::vector<ClassId> classes;
  for (int i = 0; i < matrix.numberOfClasses(); ++i) {
    const auto k = static_cast<ClassId>(i);
    if (matrix.truthCount(k) + matrix.predictedCount(k) > 0) classes.push_back(k);
  }
  std::string html =
      std::string("<div class=\"wide\"><table>\n<thead><tr>") + kRowHeader + "truth ↓ map →</th>";
  for (const ClassId k : classes) html += "<th>" + name(labels, k) + "</th>";
  html += "<th>precision</th><th>recall</th><th>F1</th></tr></thead>\n<tbody>\n";
  for (const ClassId truth : classes) {
    const auto all = static_cast<double>(matrix.truthCount(truth));
    html += std::string("<tr>") + kRowHeader + name(labels, truth) + "</th>";
    for (const ClassId predicted : classes)
      html += cell(all > 0 ? static_cast<double>(matrix.count(truth, predicted)) / all : 0);
    html += "<td>" + percent(matrix.precision(truth)) + "</td><td>" +
            percent(matrix.recall(truth)) + "</td><td>" + percent(matrix.f1(truth)) +
            "</td></tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace csom
