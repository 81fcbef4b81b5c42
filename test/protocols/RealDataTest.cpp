// SPDX-License-Identifier: BSD-3-Clause
// The room and the street of the evaluation, as docs/evaluation.md has them.
#include <csom/protocols/Evaluation.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace csom {
namespace {

Evaluation run(const std::string& protocol, const std::vector<std::string>& methods) {
  const char* data = std::getenv("CSOM_DATA");
  if (data == nullptr) throw std::runtime_error("CSOM_DATA is not set");
  EvaluationRequest request;
  request.protocols = {protocol};
  request.data = data;
  for (const std::string& method : methods) request.methods.push_back(MethodSpec::parse(method));
  return runEvaluation(request);
}

TEST(ProtocolsOnRealData, CountingTheRoomAtItsOwnDensityIsTheTruth) {
  const Evaluation evaluation = run("P1", {"s-csm", "see-csom"});
  ASSERT_EQ(evaluation.results.size(), 8U);
  EXPECT_DOUBLE_EQ(evaluation.results[0].voxels.score.weightedAverageIou(), 1);
  // As the paper has it, see-csom fills whole blocks.
  const VoxelScore& see_csom = evaluation.results[1].voxels.score;
  EXPECT_DOUBLE_EQ(see_csom.geometricRecall(), 1);
  EXPECT_NEAR(see_csom.weightedAverageIou(), 0.362, 0.005);
  EXPECT_TRUE(evaluation.warnings.empty());
}

TEST(ProtocolsOnRealData, AMapOfTheStreetBeatsItsInput) {
  const Evaluation evaluation = run("P3", {"see-csom"});
  ASSERT_TRUE(evaluation.predictions);
  EXPECT_NEAR(evaluation.predictions->accuracy(), 0.85, 0.01);
  const TrialResult& result = evaluation.results.at(0);
  EXPECT_EQ(result.scans, 3U);
  EXPECT_NEAR(result.voxels.score.weightedAverageIou(), 0.223, 0.005);
  EXPECT_GT(result.points->accuracy(), evaluation.predictions->accuracy());
  EXPECT_GT(result.points->meanIou(), evaluation.predictions->meanIou());
}

TEST(ProtocolsOnRealData, P7IsWhatAnIndependentProgramComputes) {
  const Evaluation evaluation = run("P7", {"s-csm", "see-csom", "s-bki"});
  // By a script of NumPy that shares no code with this one.
  const std::vector<std::array<double, 2>> computed{{0.463, 0.651}, {0.351, 0.443}, {0.322, 0.404}};
  ASSERT_EQ(evaluation.results.size(), computed.size());
  for (std::size_t i = 0; i < computed.size(); ++i) {
    const VoxelScore& score = evaluation.results[i].voxels.score;
    EXPECT_NEAR(score.weightedAverageIou(), computed[i][0], 6e-4);
    EXPECT_NEAR(score.geometricIou(), computed[i][1], 6e-4);
  }
  EXPECT_EQ(evaluation.results[0].scans, 2U);
}

}  // namespace
}  // namespace csom
