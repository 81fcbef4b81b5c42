// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/protocols/MethodSpec.h>
#include <gmock/gmock.h>

namespace csom {
namespace {

using testing::HasSubstr;

std::string parseErrorOf(const std::string& text) {
  try {
    MethodSpec::parse(text);
  } catch (const std::exception& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

TEST(MethodSpec, IsANameWithSettings) {
  const MethodSpec spec = MethodSpec::parse("see-csom:rvfm=off:block_depth=3");
  EXPECT_EQ(spec.text, "see-csom:rvfm=off:block_depth=3");
  EXPECT_EQ(spec.name, "see-csom");
  ASSERT_EQ(spec.settings.size(), 2U);
  EXPECT_EQ(spec.settings.at("block_depth"), "3");
}

TEST(MethodSpec, ErrorsNameWhatIsWrong) {
  EXPECT_THAT(parseErrorOf("best"), HasSubstr("no method 'best'; there are surface-csom"));
  EXPECT_THAT(parseErrorOf("s-bki:kernel_length"), HasSubstr("'kernel_length' must be KEY=VALUE"));
  EXPECT_THAT(parseErrorOf("s-bki:magic=1"), HasSubstr("there is no option 'magic'"));
  EXPECT_THAT(parseErrorOf("s-bki:kernel_length=long"), HasSubstr("kernel_length"));
  EXPECT_THAT(parseErrorOf("octomap:kernel=linear"), HasSubstr("octomap has no options"));
  EXPECT_THAT(parseErrorOf("s-bki:resolution=1"), HasSubstr("the protocol says"));
}

TEST(MethodSpec, EveryDefaultMethodMakesAMap) {
  Options options;
  options.number_of_classes = 3;
  for (const std::string& name : defaultMethods()) {
    const auto map = makeMapper(MethodSpec::parse(name), options);
    Scan scan;
    scan.points = {{1.1f, 0.1f, 0.1f}, {1.12f, 0.1f, 0.1f}, {1.1f, 0.12f, 0.1f}};
    scan.labels = {2, 2, 2};
    map->insert(scan);
    const VoxelEstimate hit = map->at({1.1, 0.1, 0.1});
    EXPECT_TRUE(hit.known) << name;
    EXPECT_GT(hit.occupancy, 0.5) << name;
    EXPECT_EQ(hit.class_id, map->hasClasses() ? 2 : 1) << name;
    EXPECT_FALSE(map->at({9.1, 9.1, 9.1}).known) << name;
  }
}

TEST(MethodSpec, SettingsGoBeforeThoseOfTheTrialButForFreeSpaceThatItHasNot) {
  Options options;
  options.resolution = 1;
  const MethodSpec spec = MethodSpec::parse("s-csm:free_space=raycast");
  Scan scan;
  scan.points = {{3.5f, 0.5f, 0.5f}};
  scan.labels = {1};

  auto map = makeMapper(spec, options);
  map->insert(scan);
  EXPECT_FALSE(map->at({1.5, 0.5, 0.5}).known);

  options.free_space.mode = FreeSpace::Sampled;
  options.free_space.resolution = 100;  // no sample would fit
  map = makeMapper(spec, options);
  map->insert(scan);
  EXPECT_TRUE(map->at({1.5, 0.5, 0.5}).known);
  EXPECT_EQ(map->at({1.5, 0.5, 0.5}).class_id, kFreeClass);
}

}  // namespace
}  // namespace csom
