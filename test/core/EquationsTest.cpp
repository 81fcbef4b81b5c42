// SPDX-License-Identifier: BSD-3-Clause
// Single equations against numbers worked out by hand.
#include <csom/core/ClassEntropy.h>
#include <csom/core/ContextEntropy.h>
#include <csom/core/DirichletVoxel.h>
#include <csom/core/Kernel.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

namespace csom {
namespace {

TEST(ContextEntropy, DefaultsMeanObservedOrTwoFaces) {
  const Options options;
  EXPECT_NEAR(contextEntropy({false, 0, 0, 0}, options), 0.0196, 1e-4);
  EXPECT_NEAR(contextEntropy({false, 1, 0, 0}, options), 0.0502, 1e-4);
  EXPECT_NEAR(contextEntropy({false, 2, 0, 0}, options), 0.1224, 1e-4);
  EXPECT_NEAR(contextEntropy({true, 0, 0, 0}, options), 0.1288, 1e-4);
}

TEST(ContextEntropy, FilledBlocksFollowTheRule) {
  Options options;
  options.method = Method::SeeCsom;
  // Two observed blocks two apart along x share the neighbour between them: it alone is added.
  const std::vector<BlockIndex> observed{{-1, 0, 0}, {1, 0, 0}};
  const auto filled = filledBlocks(observed, options);
  ASSERT_EQ(filled.size(), 3U);
  EXPECT_EQ(filled[0].index, (BlockIndex{-1, 0, 0}));
  EXPECT_EQ(filled[0].observed, 0);
  EXPECT_EQ(filled[1].index, (BlockIndex{0, 0, 0}));
  EXPECT_EQ(filled[1].observed, -1);
  EXPECT_EQ(filled[2].observed, 1);
  options.see_csom.rvfm = false;
  EXPECT_EQ(filledBlocks(observed, options).size(), 13U);
  options.see_csom.context_neighbours = 26;
  EXPECT_EQ(filledBlocks(observed, options).size(), 45U);
}

TEST(ClassEntropy, MatchesTheWorkedExample) {
  std::vector<double> mass(20, 0.0);
  mass[3] = 8;
  mass[7] = 2;
  const float entropy = classEntropy(mass);
  EXPECT_NEAR(entropy, 0.21157, 1e-5);
  Options options;
  options.resolution = 0.3;
  EXPECT_NEAR(kernelLength(entropy, options), 1.02694, 1e-5);
}

TEST(ClassEntropy, Limits) {
  EXPECT_EQ(classEntropy(std::vector<double>(5, 0.0)), 1.0F);
  EXPECT_EQ(classEntropy({0, 4, 0}), 0.0F);
  EXPECT_EQ(classEntropy({1, 1}), 1.0F);  // 1/2 + 1/2, two classes in all
  Options options;
  options.kernel.aklm = false;
  options.kernel.length = 0.7;
  EXPECT_FLOAT_EQ(kernelLength(1.0F, options), 0.7F);
}

TEST(Kernel, SparseKernelIsTheClosedForm) {
  EXPECT_NEAR(sparseKernel(0.0F), 1.0, 2e-7);
  EXPECT_NEAR(sparseKernel(0.25F), 0.659155, 1e-6);
  EXPECT_NEAR(sparseKernel(0.5F), 0.166667, 1e-6);
  EXPECT_NEAR(sparseKernel(0.75F), 0.007512, 1e-6);
  for (int i = 0; i <= 10000; ++i) {
    const float t = static_cast<float>(i) / 10000.0F;
    const double x = static_cast<double>(t);
    const double exact =
        (2 + std::cos(2 * M_PI * x)) / 3 * (1 - x) + std::sin(2 * M_PI * x) / (2 * M_PI);
    ASSERT_NEAR(static_cast<double>(sparseKernel(t)), exact, 3e-7) << t;
    ASSERT_GE(sparseKernel(t), 0.0F);
  }
  EXPECT_FLOAT_EQ(linearKernel(0.25F), 0.75F);
  for (const float beyond : {1.0F, 1.5F, 100.0F}) {
    EXPECT_EQ(sparseKernel(beyond), 0.0F);
    EXPECT_EQ(linearKernel(beyond), 0.0F);
  }
}

TEST(DirichletVoxel, FollowsEquation22) {
  const std::array<std::uint8_t, 3> classes{0, 2, 5};
  const std::array<std::uint32_t, 3> counts{4096, 3 * 4096, 2048};
  const double prior = 0.001;
  const DirichletVoxel voxel(8, prior, 0, classes.data(), counts.data(), 3);
  const double total = 4.5 + 8 * prior;
  EXPECT_EQ(voxel.state(), VoxelState::Occupied);
  EXPECT_EQ(voxel.mostLikelyClass(), 2);
  EXPECT_DOUBLE_EQ(voxel.evidence(), 4.5);
  EXPECT_DOUBLE_EQ(voxel.evidence(2), 3.0);
  EXPECT_DOUBLE_EQ(voxel.evidence(1), 0.0);
  EXPECT_DOUBLE_EQ(voxel.probability(2), (3 + prior) / total);
  EXPECT_DOUBLE_EQ(voxel.probability(7), prior / total);
  EXPECT_DOUBLE_EQ(voxel.occupancy(), 1 - (1 + prior) / total);
  const double lambda = voxel.probability(2);
  EXPECT_DOUBLE_EQ(voxel.variance(2), lambda * (1 - lambda) / (total + 1));
  double entropy = 0;
  for (const double l : voxel.probabilities()) entropy -= l * std::log(l);
  EXPECT_NEAR(voxel.entropy(), entropy / std::log(8.0), 1e-12);
  EXPECT_EQ(voxel.probability(8), 0.0);  // no such class
}

TEST(DirichletVoxel, TiesGoToTheLowerClassAndUnknownIsUniform) {
  const std::array<std::uint8_t, 2> classes{0, 1};
  const std::array<std::uint32_t, 2> counts{7, 7};
  EXPECT_EQ(DirichletVoxel(2, 0.001, 0, classes.data(), counts.data(), 2).state(),
            VoxelState::Free);
  const DirichletVoxel unknown(4, 0.001, 0);
  EXPECT_FALSE(unknown.known());
  EXPECT_EQ(unknown.state(), VoxelState::Unknown);
  EXPECT_DOUBLE_EQ(unknown.probability(3), 0.25);
  EXPECT_NEAR(unknown.entropy(), 1.0, 1e-12);
}

TEST(Equations, AnyLabelOutvotesTheClassOfUnlabelledPoints) {
  constexpr ClassId kUnlabelled = 3;
  const auto classOf = [&](std::array<std::uint32_t, 4> counts) {
    const std::array<std::uint8_t, 4> classes{0, 1, 2, kUnlabelled};
    return DirichletVoxel(4, 0.001, kUnlabelled, classes.data(), counts.data(), 4)
        .mostLikelyClass();
  };
  EXPECT_EQ(classOf({0, 0, 1, 1000}), 2);
  EXPECT_EQ(classOf({0, 5, 6, 1000}), 2);
  EXPECT_EQ(classOf({0, 6, 6, 1000}), 1) << "ties: the lower id";
  EXPECT_EQ(classOf({0, 0, 0, 1000}), kUnlabelled);
  // What was hit but not recognised says as much against free space as a label.
  EXPECT_EQ(classOf({700, 0, 1, 1000}), 2);
  EXPECT_EQ(classOf({1001, 0, 1, 1000}), kFreeClass);
  EXPECT_EQ(classOf({1000, 0, 0, 1000}), kFreeClass);
}

TEST(Counts, SumsSaturate) {
  EXPECT_EQ(addCounts(kMaxCount - 1, 1), kMaxCount);
  EXPECT_EQ(addCounts(kMaxCount, 5), kMaxCount);
  EXPECT_EQ(addCounts(3, 4), 7U);
}

}  // namespace
}  // namespace csom
