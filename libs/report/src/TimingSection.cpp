// SPDX-License-Identifier: BSD-3-Clause
// Charts and table of the stages of insertion.
#include "TimingSection.h"

#include <csom/report/Chart.h>
#include <csom/report/Format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "TimingSummary.h"

namespace csom {

namespace {

constexpr std::size_t kMaxPoints = 1500;

struct Stage {
  const char* name;
  double (*milliseconds)(const RunScan&);
};
constexpr std::array<Stage, 4> kStages{
    {{"whole insertion", [](const RunScan& s) { return s.insert_ms; }},
     {"preparing", [](const RunScan& s) { return s.record.report.prepare_ms; }},
     {"kernel inference", [](const RunScan& s) { return s.record.report.infer_ms; }},
     {"adding to the map", [](const RunScan& s) { return s.record.report.commit_ms; }}}};

/// Of a long run the slowest one of several observations in succession.
ChartSeries makeSeries(const Stage& stage, const std::vector<RunScan>& scans,
                       std::size_t together) {
  ChartSeries series{stage.name, {}, ChartSeries::Marks::Line, false};
  for (std::size_t i = 0; i < scans.size(); i += together) {
    double slowest = 0;
    for (std::size_t j = i; j < std::min(i + together, scans.size()); ++j)
      slowest = std::max(slowest, stage.milliseconds(scans[j]));
    series.points.push_back({static_cast<double>(i + 1), slowest});
  }
  return series;
}

std::string timeOfEachScan(const std::vector<RunScan>& scans) {
  const std::size_t together = (scans.size() + kMaxPoints - 1) / kMaxPoints;
  XyChart chart;
  chart.title = "Time of each observation";
  chart.summary = together == 1
                      ? "How long each observation took to become part of the map, and its stages."
                      : "How long observations took to become part of the map, and their stages: "
                        "the slowest of each " +
                            formatCount(together) + " in succession.";
  chart.x = {"observation", "", false, 1.0, std::nullopt};
  chart.y = {"time", "ms", false, 0.0, std::nullopt};
  for (const Stage& stage : kStages) chart.series.push_back(makeSeries(stage, scans, together));
  return toHtml(chart);
}

/// Where the time of the whole run went, as far as it was measured.
std::string timeOfTheRun(const RunRecord& record) {
  BarChart chart;
  chart.title = "Time of the run";
  chart.summary = "Where " + formatDuration(record.wall_seconds) +
                  " went. Parts that run at the same time may add up to more.";
  chart.values = {"time", "s", false, 0.0, std::nullopt};
  chart.horizontal = true;
  BarSeries series{"time", {}};
  double rest = record.wall_seconds;
  const auto add = [&](const char* name, double seconds) {
    if (!(seconds > 0)) return;
    chart.categories.emplace_back(name);
    series.values.push_back(seconds);
    rest -= seconds;
  };
  if (const auto& cameras = record.camera_labels) {
    add("network", cameras->seconds.network);
    add("decoding images", cameras->seconds.image_decoding);
    add("labelling points", cameras->seconds.labelling);
  }
  if (record.registration) add("registering scans", record.registration->seconds);
  ScanReport sum;
  for (const RunScan& scan : record.scans) sum += scan.record.report;
  add("preparing scans", sum.prepare_ms / 1000);
  add("kernel inference", sum.infer_ms / 1000);
  add("adding to the map", sum.commit_ms / 1000);
  add("reading and the rest", rest);
  chart.series = {series};
  return toHtml(chart);
}

void writeStages(std::ostream& page, const std::vector<StageTiming>& stages) {
  const double longest = std::max(stages.front().total, 1e-9);
  page << "<div class=\"wide\"><table><thead><tr>"
       << "<th class=\"text\">stage</th><th>total</th><th class=\"text bar\">share</th>"
       << "<th>min, ms</th><th>median, ms</th><th>95 %, ms</th><th>max, "
          "ms</th></tr></thead><tbody>\n";
  for (const StageTiming& stage : stages) {
    const double share = std::clamp(stage.total / longest, 0.0, 1.0);
    page << "<tr><td class=\"text\">" << stage.name << "</td><td>"
         << formatDuration(stage.total / 1000)
         << "</td><td class=\"bar\"><span style=\"width:" << static_cast<int>(share * 100 + 0.5)
         << "%\"></span></td><td>" << formatNumber(stage.min) << "</td><td>"
         << formatNumber(stage.median) << "</td><td>" << formatNumber(stage.p95) << "</td><td>"
         << formatNumber(stage.max) << "</td></tr>\n";
  }
  page << "</tbody></table></div>\n";
}

}  // namespace

void writeTiming(std::ostream& page, const RunRecord& record) {
  const std::vector<StageTiming> stages = summarizeTiming(record.scans);
  if (stages.empty()) return;
  page << "<h2>Time per observation</h2>\n" << timeOfEachScan(record.scans) << timeOfTheRun(record);
  writeStages(page, stages);
}

}  // namespace csom
