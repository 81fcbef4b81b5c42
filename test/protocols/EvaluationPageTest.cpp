// SPDX-License-Identifier: BSD-3-Clause
#include <csom/protocols/EvaluationPage.h>
#include <gmock/gmock.h>

#include "SmallInputs.h"

namespace csom {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(EvaluationPage, ShowsWhatTheEvaluationHas) {
  const test::TempFolder folder;
  test::writeBytes(folder / "1.pcd",
                   test::pcdFile("0.01 0.01 0.01 1\n0.06 0.01 0.01 1\n0.11 0.01 0.01 3\n", 3));
  EvaluationRequest request;
  request.data = folder.path();
  request.room_world = test::smallWorld(folder, test::kPointSampler);
  request.methods = {MethodSpec::parse("s-csm"), MethodSpec::parse("octomap")};
  request.protocols = {"P1", "P3", "P4"};
  const std::string page = evaluationPage(runEvaluation(request));
  EXPECT_THAT(page, HasSubstr("P1: the room at four densities"));
  EXPECT_THAT(page, HasSubstr("ROC curves of occupancy"));
  EXPECT_THAT(page, HasSubstr("octomap (AUC 0."));
  EXPECT_THAT(page, HasSubstr("<summary>P1 ds 0.10 s-csm</summary>"));
  EXPECT_THAT(page, Not(HasSubstr("<summary>P1 ds 0.10 octomap</summary>")));
  EXPECT_THAT(page, Not(HasSubstr("P6: the room")));
  EXPECT_THAT(page, HasSubstr("<li>P3: "));  // left out: there is no street
}

TEST(EvaluationPage, ConfusionMatrixHasSharesOfTheTruthAndF1) {
  TrialResult result;
  result.protocol = "P3";
  result.method = "a<b";
  ConfusionMatrix matrix(11);
  matrix.add(1, 1, 3);
  matrix.add(1, 3, 1);
  matrix.add(3, 3, 5);
  result.voxels.score = VoxelScore(matrix);
  Evaluation evaluation;
  evaluation.labels.emplace("P3", test::labelsOf("stanford"));
  evaluation.results = {result};
  const std::string page = evaluationPage(evaluation);
  EXPECT_THAT(page, HasSubstr("a&lt;b"));
  EXPECT_THAT(page, HasSubstr("<th>wall</th><th>table</th><th>precision</th>"));
  EXPECT_THAT(page, HasSubstr(">75.0</td>"));
  // Of the table: precision 5/6, recall 1, F1 10/11.
  EXPECT_THAT(page, HasSubstr("<td>83.3</td><td>100.0</td><td>90.9</td>"));
}

}  // namespace
}  // namespace csom
