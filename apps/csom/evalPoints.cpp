// SPDX-License-Identifier: BSD-3-Clause
// csom eval points: what a map says of labelled points.
#include <csom/core/Error.h>
#include <csom/eval/CsomMapper.h>
#include <csom/io/MapFile.h>
#include <csom/io/TextParser.h>
#include <csom/protocols/EvaluationJson.h>
#include <csom/protocols/RoomProtocols.h>
#include <csom/protocols/StreetProtocol.h>

#include <cstdio>
#include <memory>
#include <utility>

#include "Output.h"
#include "commands.h"

namespace csom {
namespace {

struct EvalPointsArguments {
  std::string map;
  std::string scans;
  bool json = false;
};

struct LabelledScans {
  LabelledCloud points;
  std::vector<std::string> warnings;
};

LabelledScans readScans(const std::string& folder, const LabelSet& labels) {
  if (isStreet(folder)) {
    const Street street = readStreet(folder, labels, false);
    return {labelledPoints(street), street.warnings};
  }
  if (isRoom(folder)) {
    const Room room = readRoom(folder, labels);
    return {labelledPoints(room), room.warnings};
  }
  throw FileError(folder, "holds neither velodyne/ (layout of SemanticKITTI) nor *.pcd files");
}

void printAsText(const PointScore& score, const LabelSet& labels) {
  const auto percent = [](double share) { return 100 * share; };
  std::printf("mIoU                  %6.2f %%  over the classes of the %zu points\n",
              percent(score.meanIou()), score.points());
  std::printf("accuracy              %6.2f %%\n", percent(score.accuracy()));
  std::printf("                                if a point in a voxel held to be free is wrong:\n");
  std::printf("                                mIoU %.2f %%, accuracy %.2f %%\n",
              percent(score.occupiedMeanIou()), percent(score.occupiedAccuracy()));
  std::printf("coverage              %6.2f %%  of the points lie in a known voxel; over these\n",
              percent(score.coverage()));
  std::printf("                                mIoU %.2f %%, accuracy %.2f %%\n",
              percent(score.coveredMeanIou()), percent(score.coveredAccuracy()));
  std::printf("Brier score           %6.4f\n", score.calibration().brier());
  std::printf("calibration error     %6.4f\n\n", score.calibration().expectedCalibrationError());
  std::printf("  %-20s %10s %8s %10s %8s\n", "class", "points", "IoU", "precision", "recall");
  for (const ClassId k : score.matrix().classesInTruth())
    std::printf("  %-20s %10zu %8.2f %10.2f %8.2f\n", detail::printable(labels.at(k).name).c_str(),
                score.matrix().truthCount(k), percent(score.matrix().iou(k)),
                percent(score.matrix().precision(k)), percent(score.matrix().recall(k)));
}

void runEvalPoints(const EvalPointsArguments& arguments) {
  MapDocument document = loadMap(arguments.map);
  const LabelledScans scans = readScans(arguments.scans, document.labels);
  for (const std::string& warning : scans.warnings)
    std::fprintf(stderr, "csom: warning: %s\n", detail::printable(warning).c_str());
  const CsomMapper map(std::move(document.map));
  const PointScore score = scorePoints(map, scans.points, document.labels.numberOfClasses());
  if (score.points() == 0)
    throw FileError(arguments.scans, "holds no point with a label of the label set " +
                                         detail::quoted(document.labels.name()));
  if (arguments.json)
    printJson(toJson(score, document.labels));
  else
    printAsText(score, document.labels);
}

}  // namespace

void addEvalPointsCommand(CLI::App& eval) {
  auto arguments = std::make_shared<EvalPointsArguments>();
  CLI::App* points = eval.add_subcommand("points", "Point by point, against labelled scans");
  points->description(
      "Compares the class of the voxel at each labelled point with the point's own. A voxel that\n"
      "is unknown or free is never right. The points are those of a folder in the layout of\n"
      "SemanticKITTI (velodyne/, labels/, poses.txt, calib.txt) or of its *.pcd files with a "
      "field\n"
      "'label'; their labels are raw ids of the map's label set.");
  points->add_option("--map", arguments->map, "map to score (.csom)")->required();
  points->add_option("--scans", arguments->scans, "folder of labelled scans, in the map's frame")
      ->required();
  points->add_flag("--json", arguments->json, "print JSON");
  points->footer(
      "Example:\n"
      "  csom import semantickitti sequences/08 --labels predictions --every 2 -o k.rawlog\n"
      "  csom map k.rawlog -c config/semantickitti.ini -o out\n"
      "  csom eval points --map out/map.csom --scans sequences/08");
  points->callback([arguments] { runEvalPoints(*arguments); });
}

}  // namespace csom
