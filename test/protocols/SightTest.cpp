// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/protocols/EvaluationJson.h>
#include <csom/protocols/EvaluationPage.h>
#include <csom/protocols/EvaluationTables.h>
#include <csom/protocols/SimulatedProtocols.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "TestFiles.h"

namespace csom {
namespace {

using testing::HasSubstr;

constexpr char kLidar[] =
    "  - {type: velodyne_vlp16, label: lidar, pose: [0, 0, 1.1, 0, 0, 0], rate: 2, "
    "range: [0.5, 20]}\n";

/// The robot stands before a wall; a box stands between them for two seconds, then goes to the
/// right behind another wall within half a second.
class Street {
 public:
  explicit Street(const std::string& sensors = kLidar,
                  const std::string& moves = ", moves: [[2, 0, 0], [2.5, 0, -9]]") {
    test::writeBytes(file(),
                     "label_set: " CSOM_SOURCE_DIR
                     "/config/labels/simulator.yaml\n"
                     "truth: {resolution: 0.2, min: [0, -4, -0.2], max: [8.2, 4, 3]}\n"
                     "robot: {stations: [[0, 0, 0]], dwell: 6}\n"
                     "sensors:\n" +
                         sensors +
                         "solids:\n"
                         "  - {shape: ground, class: road, center: [5, 0, -0.1], size: [30, 30]}\n"
                         "  - {shape: box, class: wall, center: [8.2, 0, 1.5], size: [0.2, 8, 3]}\n"
                         "  - {shape: box, class: wall, center: [3, -7, 2], size: [0.2, 5, 4]}\n"
                         "  - {shape: box, class: car, center: [5, 0, 0.7], size: [1, 1, 1.4]" +
                         moves + "}\n");
  }
  std::string file() const { return folder_ / "street.yaml"; }
  Scenario scenario() const { return loadScenario(file()); }

 private:
  test::TempFolder folder_;
};

TEST(Sight, AsksOnceAfterEachTimeOfClearSight) {
  const Street street;
  const Trial trial = movingTrials(street.scenario()).front();
  ASSERT_EQ(trial.scans->size(), 12U);
  std::size_t last = 0;
  std::set<std::pair<double, double>> left;
  for (const SightCheck& check : *trial.sight) {
    EXPECT_LE(last, check.scans);
    last = check.scans;
    if (!check.moved) continue;
    ASSERT_LT(check.interval, 2U) << "it is gone for three and a half seconds";
    // The front of the box, which was at 4.5 m. It was there up to the fifth scan (at 2 s), is gone
    // in the sixth.
    left.insert({check.center.y(), check.center.z()});
    EXPECT_NEAR(check.center.x(), 4.5, 0.11);
    EXPECT_LT(std::abs(check.center.y()), 0.61);
    EXPECT_EQ(check.scans, check.interval == 0 ? 7U : 9U);
  }
  EXPECT_GT(left.size(), 15U);  // 5 × 6 voxels, rings 0.16 m apart
}

TEST(Sight, WhatStaysIsAskedAboutSinceItsFirstHit) {
  const Street street;
  const Trial trial = movingTrials(street.scenario()).front();
  const auto first = std::find_if(trial.sight->begin(), trial.sight->end(),
                                  [](const SightCheck& check) { return !check.moved; });
  ASSERT_NE(first, trial.sight->end());
  EXPECT_EQ(first->scans, 3U);  // hit by the first scan; a second later there are two more
  // The wall behind the box is hit from the sixth scan on.
  int behind_the_box = 0;
  for (const SightCheck& check : *trial.sight) {
    const bool behind = check.center.x() > 8 && std::abs(check.center.y()) < 0.5 &&
                        check.center.z() > 0.2 && check.center.z() < 1.3;
    if (check.moved || !behind) continue;
    EXPECT_EQ(check.scans, check.interval == 0 ? 8U : 10U);
    ++behind_the_box;
  }
  EXPECT_GT(behind_the_box, 10);
}

TEST(Sight, HitsAloneKeepEveryGhostAndTheDefaultNone) {
  const Street street;
  const Trial trial = movingTrials(street.scenario()).front();
  const auto figuresOf = [&](const char* method) {
    return runTrial(trial, MethodSpec::parse(method)).front().sight.value()[1];
  };
  const SightFigures hits = figuresOf("s-csm:free_space=none");
  EXPECT_GT(hits.left_by_movers, 15U);
  EXPECT_EQ(hits.ghosts, hits.left_by_movers);
  EXPECT_EQ(hits.lost, 0U);
  const SightFigures beams = figuresOf("surface-csom");
  EXPECT_EQ(beams.left_by_movers, hits.left_by_movers);
  EXPECT_EQ(beams.ghosts, 0U);
  EXPECT_LE(beams.lost, beams.stays / 200);
}

TEST(Sight, TablesJsonAndPageShowIt) {
  const Street street;
  const Scenario scenario = street.scenario();
  Evaluation evaluation;
  evaluation.labels.emplace("P8", scenario.world.labels());
  evaluation.sources["P8"] = scenario.file;
  evaluation.results =
      runTrial(movingTrials(scenario).front(), MethodSpec::parse("s-csm:free_space=none"));
  const SightFigures& figures = evaluation.results.front().sight.value()[1];
  EXPECT_THAT(toMarkdown(evaluation), HasSubstr("| s-csm:free_space=none |     100.00 |"));
  EXPECT_THAT(toMarkdown(evaluation), HasSubstr(std::to_string(figures.left_by_movers) + " and " +
                                                std::to_string(figures.stays) + " after 2 s"));
  const auto json = toJson(evaluation)["protocols"]["P8"]["results"][0]["clear_sight"];
  ASSERT_EQ(json.size(), 4U);
  EXPECT_EQ(json[1]["seconds"], 2);
  EXPECT_EQ(json[1]["ghosts"], figures.ghosts);
  EXPECT_EQ(json[3]["left_by_movers"], 0);
  EXPECT_THAT(evaluationPage(evaluation), HasSubstr("P8: what moved, and what stays"));
}

std::string refusalOf(const Street& street) {
  try {
    movingTrials(street.scenario());
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "was taken";
}

TEST(Sight, OtherScenariosAreRefused) {
  EXPECT_THAT(refusalOf(Street(kLidar, "")), HasSubstr("street.yaml: nothing moves"));
  const std::string second =
      "  - {type: point_sampler, label: dots, pose: [0, 0, 1, 0, 0, 0], rate: 1, points: 10, "
      "range: [0.1, 5]}\n";
  EXPECT_THAT(refusalOf(Street(kLidar + second)), HasSubstr("'dots'"));
  EXPECT_THAT(refusalOf(Street(second)), HasSubstr("'dots'"));
  EXPECT_THAT(refusalOf(Street("  - {type: velodyne_vlp16, label: lidar, pose: [0, 0, 1.1, 0, 0, "
                               "0], rate: 2, range: [0.5, 20], sweep: moving}\n")),
              HasSubstr("instantaneous"));
}

}  // namespace
}  // namespace csom
