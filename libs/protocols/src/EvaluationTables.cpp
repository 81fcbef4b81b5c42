// SPDX-License-Identifier: BSD-3-Clause
#include <csom/protocols/EvaluationTables.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>

#include "MarkdownTable.h"
#include "PublishedFigures.h"

namespace csom {
namespace {

using detail::fixed;
using detail::MarkdownTable;
using detail::percent;

constexpr char kNone[] = "–";

using Results = std::vector<const TrialResult*>;

Results resultsOf(const Evaluation& evaluation, std::string_view protocol) {
  Results found;
  for (const TrialResult& result : evaluation.results)
    if (result.protocol == protocol) found.push_back(&result);
  return found;
}

/// Those of methods that know classes.
Results withClasses(const Results& results) {
  Results found;
  std::copy_if(results.begin(), results.end(), std::back_inserter(found),
               [](const TrialResult* r) { return r->classes; });
  return found;
}

/// Distinct values in the order in which they come.
template <class Key>
std::vector<std::string> distinct(const Results& results, Key&& key) {
  std::vector<std::string> values;
  for (const TrialResult* result : results) {
    const std::string value = key(*result);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

template <std::size_t N>
std::string published(const std::array<detail::PublishedFigure, N>& figures,
                      std::string_view protocol, std::string_view variant, std::string_view method,
                      std::string_view metric, std::string (*show)(double)) {
  for (const auto& figure : figures) {
    const std::string_view of_variant = figure.variant;
    if (figure.protocol == protocol && (of_variant.empty() || of_variant == variant) &&
        figure.method == method && figure.metric == metric)
      return show(figure.value);
  }
  return kNone;
}

std::string three(double value) {
  return fixed(value, 3);
}
std::string milliseconds(double value) {
  return fixed(value, value < 100 ? 1 : 0);
}

std::string weightedIou(const TrialResult& result) {
  return result.classes ? percent(result.voxels.score.weightedAverageIou()) : kNone;
}

/// A row a method, a column for each value of `column`; nothing without results.
template <class Column, class Cell>
std::string pivot(const std::string& title, const Results& results, Column&& column, Cell&& cell) {
  if (results.empty()) return "";
  std::vector<std::string> header{"method"};
  const auto columns = distinct(results, column);
  header.insert(header.end(), columns.begin(), columns.end());
  MarkdownTable table(header);
  for (const std::string& method :
       distinct(results, [](const TrialResult& r) { return r.method; })) {
    std::vector<std::string> row{method};
    for (const std::string& value : columns) {
      const auto found = std::find_if(results.begin(), results.end(), [&](const TrialResult* r) {
        return r->method == method && column(*r) == value;
      });
      row.push_back(found == results.end() ? kNone : cell(**found));
    }
    table.add(row);
  }
  return title + ":\n\n" + table.text();
}

/// Everything that labelled points tell of each result; `variant` names what it varies, if
/// anything.
std::string pointCloudDetails(const Results& results, std::string (*variant)(const TrialResult&)) {
  std::vector<std::string> header{"method"};
  if (variant != nullptr) header.push_back("variant");
  for (const char* name :
       {"w-avg IoU", "geom. IoU", "precision", "recall", "accurateness", "of the box",
        "mIoU points", "acc. points", "coverage", "Brier", "ECE", "ms/scan"})
    header.push_back(name);
  MarkdownTable table(header);
  for (const TrialResult* r : results) {
    std::vector<std::string> row{r->method};
    if (variant != nullptr) row.push_back(variant(*r));
    const auto add = [&](bool there, const std::string& text) {
      row.push_back(there ? text : kNone);
    };
    add(true, weightedIou(*r));
    add(true, percent(r->voxels.score.geometricIou()));
    add(true, percent(r->voxels.score.geometricPrecision()));
    add(true, percent(r->voxels.score.geometricRecall()));
    add(r->classes, percent(r->voxels.score.accuratenessOccupied()));
    add(true, percent(r->voxels.score.accuratenessBox()));
    const bool points = r->points.has_value();
    add(points, points ? percent(r->points->meanIou()) : "");
    add(points, points ? percent(r->points->accuracy()) : "");
    add(points, points ? percent(r->points->coverage()) : "");
    add(points, points ? three(r->points->calibration().brier()) : "");
    add(points, points ? three(r->points->calibration().expectedCalibrationError()) : "");
    add(true, milliseconds(r->ms_per_scan));
    table.add(row);
  }
  return table.text();
}

/// Scores against an exact truth: of all its voxels or of those that were seen.
std::string exactDetails(const Results& results, bool with_variant,
                         const VoxelFigures& (*of)(const TrialResult&)) {
  std::vector<std::string> header{"method"};
  if (with_variant) header.push_back("variant");
  for (const char* name :
       {"AUC", "TPR@0.2", "AUC unkn. 0", "TPR@0.2 unkn. 0", "ECE", "Brier", "occ. ECE", "w-avg IoU",
        "F1", "occ. F1", "accuracy", "free IoU", "known free IoU", "occ. IoU", "known", "ms/scan"})
    header.push_back(name);
  MarkdownTable table(header);
  for (const TrialResult* r : results) {
    const VoxelFigures& voxels = of(*r);
    std::vector<std::string> row{r->method};
    if (with_variant) row.push_back(r->variant);
    for (const auto* roc : {&voxels.roc_unknown_half, &voxels.roc_unknown_zero}) {
      row.push_back(*roc ? three((*roc)->auc) : kNone);
      row.push_back(*roc ? three((*roc)->tpr_at_fpr_02) : kNone);
    }
    row.push_back(three(voxels.calibration.expectedCalibrationError()));
    row.push_back(three(voxels.calibration.brier()));
    row.push_back(three(voxels.occupancy_calibration.expectedCalibrationError()));
    row.push_back(r->classes ? percent(voxels.score.weightedAverageIou()) : kNone);
    row.push_back(r->classes ? percent(voxels.score.macroF1()) : kNone);
    row.push_back(percent(voxels.score.geometricF1()));
    row.push_back(percent(voxels.score.accuratenessBox()));
    row.push_back(percent(voxels.score.freeIou()));
    row.push_back(percent(voxels.known_free_iou));
    row.push_back(percent(voxels.score.geometricIou()));
    row.push_back(percent(voxels.known_share));
    row.push_back(milliseconds(r->ms_per_scan));
    table.add(row);
  }
  return table.text();
}

const VoxelFigures& allVoxels(const TrialResult& result) {
  return result.voxels;
}
const VoxelFigures& seenVoxels(const TrialResult& result) {
  return result.seen ? *result.seen : result.voxels;
}

std::string variantOf(const TrialResult& result) {
  return result.variant;
}

std::string densitySweep(const Results& results) {
  return pivot("w-average IoU [%] by density", withClasses(results), variantOf, weightedIou) +
         "All scores [%; Brier and ECE as they are]:\n\n" + pointCloudDetails(results, variantOf);
}

std::string byObject(const Results& results) {
  MarkdownTable table({"method", "variant", "w-avg IoU", "their code", "paper"});
  for (const TrialResult* r : withClasses(results))
    table.add({r->method, r->variant, weightedIou(*r),
               published(detail::kTheirCode, "P2", r->variant, r->method, "w_average_iou", percent),
               published(detail::kPaper, "P2", r->variant, r->method, "w_average_iou", percent)});
  return "w-average IoU [%]; the paper does not state its density:\n\n" + table.text() +
         "All scores:\n\n" + pointCloudDetails(results, variantOf);
}

std::string street(const Results& results, const std::optional<PointScore>& predictions) {
  MarkdownTable table({"method", "w-avg IoU", "their code", "paper", "mIoU points", "acc. points"});
  for (const TrialResult* r : withClasses(results))
    table.add({r->method, weightedIou(*r),
               published(detail::kTheirCode, "P3", "", r->method, "w_average_iou", percent),
               published(detail::kPaper, "P3", "", r->method, "w_average_iou", percent),
               r->points ? percent(r->points->meanIou()) : kNone,
               r->points ? percent(r->points->accuracy()) : kNone});
  if (predictions)
    table.add({"input labels", kNone, kNone, kNone, percent(predictions->meanIou()),
               percent(predictions->accuracy())});
  return table.text() + "All scores:\n\n" + pointCloudDetails(results, nullptr);
}

std::string knownStreet(const Results& results) {
  return pointCloudDetails(results, nullptr) + "Occupancy, free space among it:\n\n" +
         exactDetails(results, false, allVoxels);
}

std::string hundredths(const std::optional<double>& share) {
  return share ? fixed(100 * *share, 2) : kNone;
}

std::string whatMoved(const Results& results) {
  std::vector<std::string> header{"method"};
  for (const char* what : {"ghosts", "lost"})
    for (const double seconds : kSightSeconds)
      header.push_back(what + (" " + fixed(seconds, 0)) + " s");
  for (const char* name : {"w-avg IoU", "geom. IoU", "ms/scan"}) header.push_back(name);
  MarkdownTable table(header);
  for (const TrialResult* r : results) {
    std::vector<std::string> row{r->method};
    for (const SightFigures& f : *r->sight) row.push_back(hundredths(f.ghostShare()));
    for (const SightFigures& f : *r->sight) row.push_back(hundredths(f.lostShare()));
    row.push_back(weightedIou(*r));
    row.push_back(percent(r->voxels.score.geometricIou()));
    row.push_back(milliseconds(r->ms_per_scan));
    table.add(row);
  }
  std::string asked;
  for (std::size_t i = 0; i < kSightSeconds.size(); ++i) {
    const SightFigures& figures = (*results.front()->sight)[i];
    asked += (i == 0 ? "" : ", ") + std::to_string(figures.left_by_movers) + " and " +
             std::to_string(figures.stays) + " after " + fixed(kSightSeconds[i], 0) + " s";
  }
  return "Of the voxels that movers left, those still occupied; of those in which something stays, "
         "those free or unknown, after so many seconds of clear sight [%]. Voxels asked about: " +
         asked + ".\n\n" + table.text();
}

std::string structuredRoom(const Results& results) {
  MarkdownTable table({"method", "AUC", "paper", "TPR@0.2", "paper"});
  for (const TrialResult* r : results) {
    const auto& roc = r->voxels.roc_unknown_half;
    table.add({r->method, roc ? three(roc->auc) : kNone,
               published(detail::kPaper, "P4", "", r->method, "auc", three),
               roc ? three(roc->tpr_at_fpr_02) : kNone,
               published(detail::kPaper, "P4", "", r->method, "tpr_at_fpr_0.2", three)});
  }
  return "Unknown voxels score 0.5:\n\n" + table.text() + "All scores:\n\n" +
         exactDetails(results, false, allVoxels);
}

std::string robot(const Results& results) {
  MarkdownTable table(
      {"method", "variant", "F1", "occ. F1", "accuracy", "known free IoU", "occ. IoU", "ms/scan"});
  for (const TrialResult* r : results) {
    const VoxelFigures& voxels = seenVoxels(*r);
    table.add({r->method, r->variant, r->classes ? percent(voxels.score.macroF1()) : kNone,
               percent(voxels.score.geometricF1()), percent(voxels.score.accuratenessBox()),
               percent(voxels.known_free_iou), percent(voxels.score.geometricIou()),
               milliseconds(r->ms_per_scan)});
  }
  const auto paper = [](const char* metric) {
    return published(detail::kPaper, "P5", "", "see-csom", metric, percent);
  };
  table.add({"see-csom, paper", "its robot", paper("macro_f1"), kNone, kNone, paper("free_iou"),
             paper("geometric_iou"), kNone});
  return "Over the voxels that a beam of the input reaches, with true poses:\n\n" + table.text() +
         "All scores over these voxels:\n\n" + exactDetails(results, true, seenVoxels) +
         "All scores over all voxels of the world:\n\n" + exactDetails(results, true, allVoxels);
}

std::string scansOf(const TrialResult& result) {
  return std::to_string(result.scans) + (result.scans == 1 ? " scan" : " scans");
}

std::string repetition(const Results& results) {
  return pivot("w-average IoU [%] after so many scans", withClasses(results), scansOf,
               weightedIou) +
         "All scores:\n\n" + pointCloudDetails(results, scansOf);
}

std::string settingOf(const TrialResult& result, const std::string& key) {
  const auto setting = result.settings.find(key);
  return setting == result.settings.end() ? kNone : setting->second;
}

std::string parameterStudy(const Results& results) {
  const auto depths =
      distinct(results, [](const TrialResult& r) { return settingOf(r, "block_depth"); });
  const auto thresholds =
      distinct(results, [](const TrialResult& r) { return settingOf(r, "context_threshold"); });
  const auto table = [&](std::string (*cell)(const TrialResult&)) {
    std::vector<std::string> header{"D_b"};
    for (const std::string& threshold : thresholds) header.push_back("T_con " + threshold);
    MarkdownTable text(header);
    for (const std::string& depth : depths) {
      std::vector<std::string> row{depth};
      for (const TrialResult* r : results)
        if (settingOf(*r, "block_depth") == depth) row.push_back(cell(*r));
      text.add(row);
    }
    return text.text();
  };
  return "w-average IoU [%]:\n\n" + table(weightedIou) + "Milliseconds a scan:\n\n" +
         table([](const TrialResult& r) { return milliseconds(r.ms_per_scan); });
}

/// The paper's Table IV.
std::string runtimes(const Evaluation& evaluation) {
  Results chosen;
  for (const TrialResult& r : evaluation.results)
    if (((r.protocol == "P1" || r.protocol == "P2") && r.variant == "ds 0.10") ||
        r.protocol == "P3" || r.protocol == "P4")
      chosen.push_back(&r);
  if (chosen.empty()) return "";
  const auto column = [](const TrialResult& r) {
    if (r.protocol == "P3") return std::string("street (P3)");
    if (r.protocol == "P4") return std::string("structured room (P4)");
    return std::string(r.protocol == "P1" ? "room, one scan (P1)" : "room by object (P2)");
  };
  MarkdownTable theirs({"method", "room", "street", "structured room"});
  for (const char* method : {"s-csm", "s-bki", "see-csom", "octomap"}) {
    const auto of = [&](const char* protocol) {
      return published(detail::kTheirCode, protocol, "", method, "ms_per_scan", milliseconds);
    };
    theirs.add({method, of("P2"), of("P3"), of("P4")});
  }
  return "## Runtime\n\n" +
         pivot("Median time of an insertion [ms], one thread", chosen, column,
               [](const TrialResult& r) { return milliseconds(r.ms_per_scan); }) +
         "The published code and OctoMap, measured on another machine:\n\n" + theirs.text();
}

std::string makeTables(const std::string& protocol, const Results& results,
                       const Evaluation& evaluation) {
  if (protocol == "P1") return densitySweep(results);
  if (protocol == "P2") return byObject(results);
  if (protocol == "P3") return street(results, evaluation.predictions);
  if (protocol == "P4") return structuredRoom(results);
  if (protocol == "P5") return robot(results);
  if (protocol == "P6") return repetition(results);
  if (protocol == "P7") return knownStreet(results);
  if (protocol == "P8") return whatMoved(results);
  return parameterStudy(results);
}

}  // namespace

std::string toMarkdown(const Evaluation& evaluation) {
  std::string text;
  for (const ProtocolInfo& info : allProtocols()) {
    const Results results = resultsOf(evaluation, info.name);
    if (results.empty()) continue;
    text += "## " + info.name + ": " + info.title + "\n\nInput: " + info.input +
            ". Truth: " + info.truth + ".\n\n" + makeTables(info.name, results, evaluation);
  }
  text += runtimes(evaluation);
  for (const LeftOutProtocol& left : evaluation.left_out)
    text += "**" + left.name + " is left out**: " + left.reason + "\n\n";
  return text;
}

}  // namespace csom
