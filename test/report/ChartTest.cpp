// SPDX-License-Identifier: BSD-3-Clause
// Charts as data for the script and as tables.
#include <csom/report/Chart.h>
#include <csom/report/HtmlPage.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace csom {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

nlohmann::json dataOf(const std::string& html) {
  const std::string open = "<script type=\"application/json\">";
  const std::size_t begin = html.find(open) + open.size();
  return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

XyChart sampleChart() {
  XyChart chart;
  chart.title = "IoU over density";
  chart.summary = "Our map stays above the other one.";
  chart.x = {"density", "points/m²", true, {}, {}};
  chart.y = {"IoU", "", false, 0.0, 1.0};
  chart.series = {{"ours", {{1, 0.5}, {10, 0.75}, {0, 0.9}}},
                  {"chance", {{1, kNan}, {10, 0.25}}, ChartSeries::Marks::Points, true}};
  return chart;
}

TEST(ChartTest, GivesTheScriptItsSeriesAndAxes) {
  const auto data = dataOf(toHtml(sampleChart()));
  EXPECT_EQ(data["type"], "xy");
  EXPECT_EQ(data["x"]["title"], "density");
  EXPECT_EQ(data["x"]["unit"], "points/m²");
  EXPECT_EQ(data["x"]["logarithmic"], true);
  EXPECT_FALSE(data["x"].contains("min"));
  EXPECT_EQ(data["y"]["max"], 1.0);
  EXPECT_EQ(data["series"][1]["name"], "chance");
  EXPECT_EQ(data["series"][1]["marks"], "points");
  EXPECT_EQ(data["series"][1]["dashed"], true);
}

TEST(ChartTest, GapsAreNullAndWhatALogarithmCannotShowIsLeftOut) {
  const auto data = dataOf(toHtml(sampleChart()));
  EXPECT_EQ(data["series"][0]["points"], nlohmann::json::parse("[[1.0, 0.5], [10.0, 0.75]]"));
  EXPECT_EQ(data["series"][1]["points"], nlohmann::json::parse("[[1.0, null], [10.0, 0.25]]"));
}

TEST(ChartTest, HasATextAlternativeAndATable) {
  const std::string html = toHtml(sampleChart());
  EXPECT_THAT(html,
              HasSubstr("aria-label=\"IoU over density: Our map stays above the other one.\""));
  EXPECT_THAT(html, HasSubstr("<th>density, points/m²</th><th>IoU</th>"));
  EXPECT_THAT(html, HasSubstr("<td class=\"text\">ours</td><td>10</td><td>0.75</td>"));
}

TEST(ChartTest, TheTableOfLongSeriesTellsTheirExtent) {
  XyChart chart = sampleChart();
  chart.series = {{"curve", {}}};
  for (int i = 1; i <= 101; ++i) chart.series[0].points.push_back({double(i), double(i) / 4});
  EXPECT_THAT(toHtml(chart), HasSubstr("<td class=\"text\">curve</td><td>101</td><td>1 … 101</td>"
                                       "<td>0.25</td><td>12.8</td><td>25.2</td>"));
  EXPECT_EQ(dataOf(toHtml(chart))["series"][0]["points"].size(), 101u);
}

TEST(ChartTest, BarsNeedAValueForEachCategory) {
  BarChart chart;
  chart.categories = {"prepare", "infer"};
  chart.values = {"time", "ms", false, {}, {}};
  chart.series = {{"median", {1.5, kNan}}};
  const std::string html = toHtml(chart);
  EXPECT_THAT(html, HasSubstr("<td class=\"text\">infer</td><td>–</td>"));
  EXPECT_EQ(dataOf(html)["series"][0]["values"], nlohmann::json::parse("[1.5, null]"));
  chart.series[0].values.pop_back();
  EXPECT_THROW(toHtml(chart), std::invalid_argument);
}

TEST(ChartTest, NoTextBecomesMarkup) {
  const std::string attack = "\"'></script><script>alert(1)</script>";
  XyChart chart = sampleChart();
  chart.title = chart.summary = chart.x.title = chart.y.unit = chart.series[0].name = attack;
  BarChart bars;
  bars.title = bars.summary = bars.values.title = attack;
  bars.categories = {attack};
  bars.series = {{attack, {1}}};
  for (const std::string& html : {toHtml(chart), toHtml(bars)}) {
    EXPECT_THAT(html, Not(HasSubstr("<script>")));
    // The one that ends the data.
    EXPECT_EQ(html.find("</script>"), html.rfind("</script>"));
  }
  EXPECT_EQ(dataOf(toHtml(chart))["series"][0]["name"], attack);
}

TEST(HtmlPageTest, RunsTheScriptsOfItsPartsAndNoOthers) {
  HtmlPage page{"A < B", toHtml(sampleChart()), true};
  const std::string with = toHtml(page);
  EXPECT_THAT(with, HasSubstr("<h1>A &lt; B</h1>"));
  EXPECT_THAT(with, HasSubstr("Chart.js v3"));
  EXPECT_THAT(with, HasSubstr("; script-src 'sha256-"));
  page.charts = false;
  EXPECT_THAT(toHtml(page), Not(HasSubstr("script-src")));
  EXPECT_THAT(toHtml(page), Not(HasSubstr("Chart.js v3")));
}

}  // namespace
}  // namespace csom
