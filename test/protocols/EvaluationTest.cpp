// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/protocols/Evaluation.h>
#include <csom/protocols/EvaluationJson.h>
#include <csom/protocols/EvaluationTables.h>
#include <gmock/gmock.h>

#include "protocols/SmallInputs.h"

namespace csom {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A room of four voxels in a folder of data, and a world.
class EvaluationTest : public testing::Test {
 protected:
  EvaluationTest() {
    test::writeBytes(folder_ / "1.pcd",
                     test::pcdFile("0.01 0.01 0.01 1\n0.06 0.01 0.01 1\n0.11 0.01 0.01 3\n", 3));
    test::writeBytes(folder_ / "2.pcd", test::pcdFile("0.16 0.01 0.01 3\n", 1));
    request_.data = folder_.path();
    request_.room_world = test::smallWorld(folder_, test::kPointSampler);
    for (const char* method : {"s-csm", "s-bki"})
      request_.methods.push_back(MethodSpec::parse(method));
  }

  Evaluation run(const std::vector<std::string>& protocols, int threads = 1) {
    request_.protocols = protocols;
    request_.threads = threads;
    return runEvaluation(request_);
  }

  test::TempFolder folder_;
  EvaluationRequest request_;
};

TEST_F(EvaluationTest, RunsEveryMethodOnEveryTrialInOrder) {
  std::size_t calls = 0;
  request_.protocols = {"P2", "P4"};
  const Evaluation evaluation =
      runEvaluation(request_, [&](std::size_t done, std::size_t total, const std::string&) {
        EXPECT_EQ(done, ++calls);
        EXPECT_EQ(total, 6U);
      });
  EXPECT_EQ(calls, 6U);
  std::vector<std::string> rows;
  for (const TrialResult& result : evaluation.results)
    rows.push_back(result.protocol + " " + result.variant + " " + result.method);
  EXPECT_THAT(rows, ElementsAre("P2 ds 0.05 s-csm", "P2 ds 0.05 s-bki", "P2 ds 0.10 s-csm",
                                "P2 ds 0.10 s-bki", "P4  s-csm", "P4  s-bki"));
  EXPECT_EQ(evaluation.results[0].scans, 2U);
  EXPECT_DOUBLE_EQ(evaluation.results[0].voxels.score.weightedAverageIou(), 1);
  EXPECT_EQ(evaluation.labels.at("P4").name(), "simulator");
  EXPECT_EQ(evaluation.sources.at("P2"), folder_.path());
}

/// All but the time.
std::string scoresOf(const Evaluation& evaluation) {
  nlohmann::ordered_json json = toJson(evaluation);
  for (auto& [name, protocol] : json["protocols"].items())
    for (auto& result : protocol["results"]) result.erase("ms_per_scan");
  return json.dump();
}

TEST_F(EvaluationTest, ThreadsChangeNothing) {
  EXPECT_EQ(scoresOf(run({"P1", "P4", "P6"}, 1)), scoresOf(run({"P1", "P4", "P6"}, 3)));
}

TEST_F(EvaluationTest, ProtocolsWithoutDataAreLeftOutAndNamed) {
  const Evaluation evaluation = run({"P3", "P1"});
  ASSERT_EQ(evaluation.left_out.size(), 1U);
  EXPECT_EQ(evaluation.left_out[0].name, "P3");
  EXPECT_THAT(evaluation.left_out[0].reason, HasSubstr(folder_.path()));
  EXPECT_EQ(evaluation.results.size(), 8U);
  EXPECT_THAT(toMarkdown(evaluation), HasSubstr("**P3 is left out**"));

  request_.data = "";
  EXPECT_EQ(run({"P1"}).left_out.size(), 1U);
}

TEST_F(EvaluationTest, UnknownProtocolsAndWorldsAreErrors) {
  EXPECT_THROW(run({"P9"}), ConfigError);
  request_.room_world = folder_ / "none.yaml";
  EXPECT_THROW(run({"P4"}), ConfigError);
}

TEST_F(EvaluationTest, AFailingRunFailsAll) {
  request_.methods.push_back(
      MethodSpec::parse("see-csom:kernel_length_min=1:kernel_length_max=0.5"));
  EXPECT_THROW(run({"P1"}, 2), OptionError);
}

TEST_F(EvaluationTest, JsonHasTheKeysOfTheDocs) {
  const auto json = toJson(run({"P1", "P4"}));
  const auto& room = json["protocols"]["P1"]["results"][0];
  for (const char* key : {"variant",   "method",    "scans",        "w_average_iou",
                          "iou",       "f1",        "macro_f1",     "geometric_iou",
                          "precision", "recall",    "accurateness", "accurateness_box",
                          "free_iou",  "confusion", "miou_points",  "accuracy_points",
                          "coverage",  "brier",     "ece",          "ms_per_scan"})
    EXPECT_TRUE(room.contains(key)) << key;
  EXPECT_FALSE(room.contains("auc"));
  EXPECT_EQ(room["iou"]["wall"], 1.0);
  EXPECT_EQ(room["confusion"]["classes"], nlohmann::ordered_json({"free", "wall", "table"}));
  EXPECT_EQ(room["confusion"]["counts"][1], nlohmann::ordered_json({0, 2, 0}));

  const auto& world = json["protocols"]["P4"]["results"][1];
  for (const char* key : {"auc", "tpr_at_fpr_0.2", "roc", "auc_unknown_zero", "brier", "ece",
                          "occupancy_ece", "known_voxels", "known_free_iou"})
    EXPECT_TRUE(world.contains(key)) << key;
  EXPECT_FALSE(world.contains("miou_points"));
}

TEST_F(EvaluationTest, TablesHaveARowAMethod) {
  const std::string text = toMarkdown(run({"P1", "P2", "P4", "P6", "parameters"}));
  EXPECT_THAT(text, HasSubstr("## P1: Room, density sweep"));
  EXPECT_THAT(text, HasSubstr("| method | ds 0.05 | ds 0.10 | ds 0.15 | ds 0.20 |\n"
                              "| ------ | ------: | ------: | ------: | ------: |\n"
                              "| s-csm  |   100.0 |"));
  EXPECT_THAT(text, HasSubstr("| 50 scans |"));
  EXPECT_THAT(text, HasSubstr("| D_b | T_con 0.05 |"));
  EXPECT_THAT(text, HasSubstr("## Runtime"));
  EXPECT_THAT(text, Not(HasSubstr("## P5")));
}

}  // namespace
}  // namespace csom
