// SPDX-License-Identifier: BSD-3-Clause
#include <csom/protocols/EvaluationPage.h>
#include <csom/report/Chart.h>
#include <csom/report/Html.h>
#include <csom/report/HtmlPage.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>
#include <sstream>

#include "ConfusionTable.h"

namespace csom {
namespace {

using Value = std::function<double(const TrialResult&)>;
using Results = std::vector<const TrialResult*>;

Results select(const Evaluation& evaluation,
               const std::function<bool(const TrialResult&)>& wanted) {
  Results found;
  for (const TrialResult& result : evaluation.results)
    if (wanted(result)) found.push_back(&result);
  return found;
}

/// A line for each name, its points in the order of the results.
std::vector<ChartSeries> lines(const Results& results,
                               const std::function<std::string(const TrialResult&)>& name,
                               const Value& x, const Value& y) {
  std::vector<ChartSeries> all;
  for (const TrialResult* result : results) {
    const std::string of = name(*result);
    auto line =
        std::find_if(all.begin(), all.end(), [&](const ChartSeries& l) { return l.name == of; });
    if (line == all.end())
      line = all.insert(all.end(), {of, {}, ChartSeries::Marks::LineAndPoints, false});
    line->points.push_back({x(*result), y(*result)});
  }
  return all;
}

ChartAxis percentAxis(const std::string& title) {
  return {title, "%", false, 0, 100};
}

std::string methodOf(const TrialResult& result) {
  return result.method;
}
double weightedIou(const TrialResult& result) {
  return 100 * result.voxels.score.weightedAverageIou();
}
double geometricIou(const TrialResult& result) {
  return 100 * result.voxels.score.geometricIou();
}
/// "ds 0.05" → 0.05.
double densityOf(const TrialResult& result) {
  return std::stod(result.variant.substr(3));
}

/// Two plots over the same x axis: classes of those that have them, occupancy of all.
void writeIouPlots(std::ostream& page, const Results& results, const std::string& heading,
                   const ChartAxis& x_axis, const Value& x) {
  if (results.empty()) return;
  Results with_classes;
  for (const TrialResult* result : results)
    if (result->classes) with_classes.push_back(result);
  page << "<h2>" << heading << "</h2>\n";
  if (!with_classes.empty())
    page << toHtml(XyChart{"Classes", "w-average IoU of each method with classes", x_axis,
                           percentAxis("w-average IoU"),
                           lines(with_classes, methodOf, x, weightedIou)});
  page << toHtml(XyChart{"Occupied or not", "Geometric IoU of each method", x_axis,
                         percentAxis("geometric IoU"), lines(results, methodOf, x, geometricIou)});
}

void writeRoc(std::ostream& page, const Results& results, const std::string& title,
              const std::function<const std::optional<RocFigures>&(const TrialResult&)>& roc) {
  const auto rate = [](const char* name) { return ChartAxis{name, "", false, 0, 1}; };
  XyChart chart{title,
                "True positive rate over false positive rate of each method",
                rate("false positive rate"),
                rate("true positive rate"),
                {{"chance", {{0, 0}, {1, 1}}, ChartSeries::Marks::Line, true}}};
  for (const TrialResult* result : results) {
    const std::optional<RocFigures>& figures = roc(*result);
    if (!figures) continue;
    char auc[32];
    std::snprintf(auc, sizeof auc, " (AUC %.3f)", figures->auc);
    ChartSeries& line = chart.series.emplace_back();
    line.name = result->method + auc;
    for (const RocPoint& point : figures->curve)
      line.points.push_back({point.false_positive_rate, point.true_positive_rate});
  }
  page << toHtml(chart);
}

void writeRocs(std::ostream& page, const Evaluation& evaluation) {
  const Results room = select(evaluation, [](const auto& r) { return r.protocol == "P4"; });
  const Results robot = select(evaluation, [](const auto& r) {
    return r.protocol == "P5" && r.variant == "true poses" && r.seen;
  });
  if (room.empty() && robot.empty()) return;
  page << "<h2>ROC curves of occupancy</h2>\n";
  if (!room.empty()) {
    writeRoc(
        page, room, "P4, structured room; unknown voxels score 0.5",
        [](const TrialResult& r) -> const auto& { return r.voxels.roc_unknown_half; });
    writeRoc(
        page, room, "P4, structured room; unknown voxels score 0",
        [](const TrialResult& r) -> const auto& { return r.voxels.roc_unknown_zero; });
  }
  if (!robot.empty())
    writeRoc(
        page, robot, "P5, robot with true poses; voxels that a beam reached",
        [](const TrialResult& r) -> const auto& { return r.seen->roc_unknown_half; });
}

void writeParameters(std::ostream& page, const Evaluation& evaluation) {
  const Results results =
      select(evaluation, [](const auto& r) { return r.protocol == kParameterStudy; });
  if (results.empty()) return;
  const auto depth = [](const TrialResult& r) {
    return "block depth " + r.settings.at("block_depth");
  };
  const Value threshold = [](const TrialResult& r) {
    return std::stod(r.settings.at("context_threshold"));
  };
  const ChartAxis x_axis{"T_con", "", false, 0, std::nullopt};
  page << "<h2>Block depth and context threshold of see-csom</h2>\n"
       << toHtml(XyChart{"Classes", "w-average IoU over the context threshold for each block depth",
                         x_axis, percentAxis("w-average IoU"),
                         lines(results, depth, threshold, weightedIou)})
       << toHtml(XyChart{"Time", "Time of an insertion over the context threshold for each depth",
                         x_axis, ChartAxis{"time of an insertion", "ms", false, 0, std::nullopt},
                         lines(results, depth, threshold,
                               [](const TrialResult& r) { return r.ms_per_scan; })});
}

/// Lines over seconds of clear sight.
ChartSeries lineOfSight(const TrialResult& result,
                        std::optional<double> (SightFigures::*share)() const) {
  ChartSeries line{result.method, {}, ChartSeries::Marks::LineAndPoints, false};
  for (std::size_t i = 0; i < kSightSeconds.size(); ++i)
    if (const auto here = ((*result.sight)[i].*share)())
      line.points.push_back({kSightSeconds[i], 100 * *here});
  return line;
}

void writeSight(std::ostream& page, const Evaluation& evaluation) {
  const Results results =
      select(evaluation, [](const auto& r) { return r.protocol == "P8" && r.sight; });
  if (results.empty()) return;
  const ChartAxis seconds{"time of clear sight", "s", false, 0, std::nullopt};
  XyChart ghosts{"Ghosts",
                 "Voxels that something left and that are still occupied",
                 seconds,
                 percentAxis("of the voxels left"),
                 {}};
  XyChart lost{"Lost",
               "Voxels in which something stays and that are free or unknown",
               seconds,
               {"of the voxels that stay", "%", false, 0, std::nullopt},
               {}};
  for (const TrialResult* result : results) {
    ghosts.series.push_back(lineOfSight(*result, &SightFigures::ghostShare));
    lost.series.push_back(lineOfSight(*result, &SightFigures::lostShare));
  }
  page << "<h2>P8: what moved, and what stays</h2>\n" << toHtml(ghosts) << toHtml(lost);
}

std::string titleOf(const TrialResult& result) {
  return result.protocol + " " + (result.variant.empty() ? "" : result.variant + " ") +
         result.method;
}

void writeConfusions(std::ostream& page, const Evaluation& evaluation) {
  const Results results = select(evaluation, [](const auto& r) {
    return r.classes && (r.protocol == "P3" || r.protocol == "P4" || r.protocol == "P7" ||
                         r.protocol == "P8" || (r.protocol == "P1" && r.variant == "ds 0.10") ||
                         (r.protocol == "P5" && r.variant == "true poses"));
  });
  if (results.empty()) return;
  page
      << "<h2>Confusion matrices</h2>\n<p>Of the voxels of each true class, the share [%] that the "
         "map gives each class; free is whatever is not occupied.</p>\n";
  for (const TrialResult* r : results) {
    const VoxelFigures& voxels = r->seen ? *r->seen : r->voxels;
    page << "<details><summary>" << escapeHtml(titleOf(*r))
         << (r->seen ? ", voxels that a beam reached" : "") << "</summary>\n"
         << confusionTable(voxels.score.matrix(), evaluation.labels.at(r->protocol))
         << "</details>\n";
  }
}

void writeLeftOut(std::ostream& page, const Evaluation& evaluation) {
  if (evaluation.left_out.empty() && evaluation.warnings.empty()) return;
  page << "<h2>What was left out</h2>\n<ul class=\"warnings\">\n";
  for (const LeftOutProtocol& left : evaluation.left_out)
    page << "<li>" << escapeHtml(left.name + ": " + left.reason) << "</li>\n";
  for (const std::string& warning : evaluation.warnings)
    page << "<li>" << escapeHtml(warning) << "</li>\n";
  page << "</ul>\n";
}

}  // namespace

std::string evaluationPage(const Evaluation& evaluation) {
  std::ostringstream page;
  page
      << "<p class=\"lead\">All methods on the same inputs, scored by the same truths. The figures "
         "are in evaluation.md and evaluation.json.</p>\n";
  writeIouPlots(page, select(evaluation, [](const auto& r) { return r.protocol == "P1"; }),
                "P1: the room at four densities",
                {"one training point a cell of this edge", "m", false, 0, std::nullopt}, densityOf);
  writeIouPlots(page, select(evaluation, [](const auto& r) { return r.protocol == "P6"; }),
                "P6: the room again and again", {"scans", "", false, 0, std::nullopt},
                [](const TrialResult& r) { return static_cast<double>(r.scans); });
  writeRocs(page, evaluation);
  writeSight(page, evaluation);
  writeParameters(page, evaluation);
  writeConfusions(page, evaluation);
  writeLeftOut(page, evaluation);
  return toHtml(HtmlPage{"Methods compared", page.str(), true});
}

}  // namespace csom
