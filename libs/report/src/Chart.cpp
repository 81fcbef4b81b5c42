// SPDX-License-Identifier: BSD-3-Clause
// The data of charts as JSON for the script, and as tables for everybody else.
#include <csom/report/Chart.h>
#include <csom/report/Format.h>
#include <csom/report/Html.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace csom {

namespace {

using Json = nlohmann::ordered_json;

/// Longer series are told in the table by their extent.
constexpr std::size_t kMaxRows = 60;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json toJson(const ChartAxis& axis) {
  Json json = {{"title", axis.title}, {"unit", axis.unit}, {"logarithmic", axis.logarithmic}};
  if (axis.min) json["min"] = *axis.min;
  if (axis.max) json["max"] = *axis.max;
  return json;
}

const char* toString(ChartSeries::Marks marks) {
  switch (marks) {
    case ChartSeries::Marks::Line:
      return "line";
    case ChartSeries::Marks::Points:
      return "points";
    case ChartSeries::Marks::LineAndPoints:
      return "line-and-points";
  }
  return "";
}

bool isDrawn(double value, const ChartAxis& axis) {
  return std::isfinite(value) && (!axis.logarithmic || value > 0);
}

Json toJson(const ChartSeries& series, const ChartAxis& x, const ChartAxis& y) {
  Json points = Json::array();
  for (const ChartPoint& point : series.points) {
    if (isDrawn(point.x, x))
      points.push_back({point.x, isDrawn(point.y, y) ? Json(point.y) : Json()});
  }
  return {{"name", series.name},
          {"marks", toString(series.marks)},
          {"dashed", series.dashed},
          {"points", points}};
}

std::string head(const ChartAxis& axis) {
  return escapeHtml(axis.title + (axis.unit.empty() ? "" : ", " + axis.unit));
}

std::string cell(double value) {
  return "<td>" + formatNumber(value) + "</td>";
}

std::string textCell(const std::string& text) {
  return "<td class=\"text\">" + escapeHtml(text) + "</td>";
}

std::string tableOfPoints(const XyChart& chart) {
  std::string html = "<thead><tr><th class=\"text\">series</th><th>" + head(chart.x) + "</th><th>" +
                     head(chart.y) + "</th></tr></thead><tbody>\n";
  for (const ChartSeries& series : chart.series)
    for (const ChartPoint& point : series.points)
      html += "<tr>" + textCell(series.name) + cell(point.x) + cell(point.y) + "</tr>\n";
  return html + "</tbody>";
}

std::string tableOfExtents(const XyChart& chart) {
  std::string html =
      "<thead><tr><th class=\"text\">series</th><th>points</th><th>" + head(chart.x) + "</th>";
  for (const char* what : {"least", "median", "greatest"})
    html += "<th>" + std::string(what) + " " + head(chart.y) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (const ChartSeries& series : chart.series) {
    std::vector<double> x, y;
    for (const ChartPoint& point : series.points) {
      if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
      x.push_back(point.x);
      y.push_back(point.y);
    }
    if (x.empty()) continue;
    std::sort(x.begin(), x.end());
    std::sort(y.begin(), y.end());
    html += "<tr>" + textCell(series.name) + "<td>" + formatCount(x.size()) + "</td><td>" +
            formatNumber(x.front()) + " … " + formatNumber(x.back()) + "</td>" + cell(y.front()) +
            cell(y[y.size() / 2]) + cell(y.back()) + "</tr>\n";
  }
  return html + "</tbody>";
}

std::string makeTable(const XyChart& chart) {
  std::size_t rows = 0;
  for (const ChartSeries& series : chart.series) rows += series.points.size();
  return rows <= kMaxRows ? tableOfPoints(chart) : tableOfExtents(chart);
}

std::string makeTable(const BarChart& chart) {
  std::string html = "<thead><tr><th class=\"text\">" + head(chart.values) + "</th>";
  for (const BarSeries& series : chart.series) html += "<th>" + escapeHtml(series.name) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < chart.categories.size(); ++i) {
    html += "<tr>" + textCell(chart.categories[i]);
    for (const BarSeries& series : chart.series) html += cell(series.values[i]);
    html += "</tr>\n";
  }
  return html + "</tbody>";
}

std::string figure(const std::string& title, const std::string& summary, const Json& data,
                   const std::string& table, double height_rem) {
  std::ostringstream html;
  html << "<figure class=\"chart\"><h3>" << escapeHtml(title)
       << "</h3>\n<div class=\"plot\" style=\"height:" << height_rem
       << "rem\"><canvas role=\"img\" aria-label=\"" << escapeHtml(title + ": " + summary)
       << "\"></canvas></div>\n<figcaption>" << escapeHtml(summary)
       << "</figcaption>\n<details><summary>The figures of this chart</summary><div "
          "class=\"wide\"><table>"
       << table << "</table></div></details>\n"
       << dataElement(data.dump(-1, ' ', false, Json::error_handler_t::replace)) << "</figure>\n";
  return html.str();
}

}  // namespace

std::string toHtml(const XyChart& chart) {
  Json series = Json::array();
  for (const ChartSeries& s : chart.series) series.push_back(toJson(s, chart.x, chart.y));
  const Json data = {
      {"type", "xy"}, {"x", toJson(chart.x)}, {"y", toJson(chart.y)}, {"series", series}};
  return figure(chart.title, chart.summary, data, makeTable(chart), 20);
}

std::string toHtml(const BarChart& chart) {
  Json series = Json::array();
  for (const BarSeries& s : chart.series) {
    if (s.values.size() != chart.categories.size())
      throw std::invalid_argument("the series '" + s.name + "' of the chart '" + chart.title +
                                  "' has " + std::to_string(s.values.size()) + " values for " +
                                  std::to_string(chart.categories.size()) + " categories");
    Json values = Json::array();
    for (const double value : s.values) values.push_back(number(value));
    series.push_back({{"name", s.name}, {"values", values}});
  }
  const Json data = {
      {"type", "bar"},    {"categories", chart.categories}, {"values", toJson(chart.values)},
      {"series", series}, {"stacked", chart.stacked},       {"horizontal", chart.horizontal}};
  // Every bar that lies needs a line of its own.
  const double bars =
      static_cast<double>(chart.categories.size() *
                          (chart.stacked ? 1 : std::max<std::size_t>(1, chart.series.size())));
  return figure(chart.title, chart.summary, data, makeTable(chart),
                chart.horizontal ? std::min(5 + 1.7 * bars, 60.0) : 20);
}

}  // namespace csom
