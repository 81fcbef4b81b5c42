// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/Random.h>
#include <gtest/gtest.h>

#include <cmath>

namespace csom {
namespace {

TEST(Random, SameSeedAndStreamGiveTheSameNumbers) {
  Random a(7, 1);
  Random b(7, 1);
  Random other_seed(8, 1);
  Random other_stream(7, 2);
  int equal_to_seed = 0;
  int equal_to_stream = 0;
  for (int i = 0; i < 1000; ++i) {
    const double number = a.uniform();
    EXPECT_EQ(number, b.uniform());
    equal_to_seed += number == other_seed.uniform();
    equal_to_stream += number == other_stream.uniform();
  }
  EXPECT_EQ(equal_to_seed, 0);
  EXPECT_EQ(equal_to_stream, 0);
}

TEST(Random, NumbersNeverChange) {
  // Rawlogs under rawlogs/ depend on them.
  Random random(1, 0);
  EXPECT_DOUBLE_EQ(random.uniform(), 0.44149167444625148);
  EXPECT_DOUBLE_EQ(random.gaussian(), -0.031158163168689919);
}

TEST(Random, UniformFillsTheUnitInterval) {
  Random random(2, 0);
  constexpr int kCount = 200000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kCount; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / kCount, 0.5, 0.003);
  EXPECT_NEAR(squares / kCount, 1.0 / 3, 0.003);
}

TEST(Random, GaussianIsStandardNormal) {
  Random random(3, 0);
  constexpr int kCount = 200000;
  double sum = 0;
  double squares = 0;
  int beyond_one = 0;
  int beyond_two = 0;
  for (int i = 0; i < kCount; ++i) {
    const double g = random.gaussian();
    ASSERT_TRUE(std::isfinite(g));
    sum += g;
    squares += g * g;
    beyond_one += std::abs(g) > 1;
    beyond_two += std::abs(g) > 2;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.01);
  EXPECT_NEAR(squares / kCount, 1, 0.015);
  EXPECT_NEAR(beyond_one / double{kCount}, 0.3173, 0.005);
  EXPECT_NEAR(beyond_two / double{kCount}, 0.0455, 0.003);
}

}  // namespace
}  // namespace csom
