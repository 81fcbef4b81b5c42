// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/core/Options.h>
#include <csom/maps/LabelRules.h>
#include <gmock/gmock.h>

#include <limits>

#include "SampleObservations.h"

namespace csom {

static bool operator==(const PointLabel& a, const PointLabel& b) {
  return a.kind == b.kind && a.id == b.id;
}

namespace {

using Kind = PointLabel::Kind;

TEST(LabelRules, RawIdsBecomeClasses) {
  const LabelSet labels = sample::sampleLabels();
  const LabelRules rules(labels, PointLabels::ByIntensity, "", "");
  EXPECT_EQ(rules.fromRaw(40), (PointLabel{Kind::Class, 1}));
  EXPECT_EQ(rules.fromRaw(0), PointLabel{Kind::Ignored});
  EXPECT_EQ(rules.fromRaw(41), PointLabel{Kind::Unknown});
}

TEST(LabelRules, IntensitiesMustBeWholeNumbers) {
  const LabelSet labels = sample::sampleLabels();
  const LabelRules rules(labels, PointLabels::ByIntensity, "", "");
  EXPECT_EQ(rules.fromIntensity(50.0f), (PointLabel{Kind::Class, 2}));
  for (const float bad : {50.5f, -40.0f, 1e30f, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity()})
    EXPECT_EQ(rules.fromIntensity(bad), PointLabel{Kind::Unknown}) << bad;
}

TEST(LabelRules, ColoursAndNamesMustMatchExactly) {
  const LabelSet labels = sample::sampleLabels();
  const LabelRules rules(labels, PointLabels::ByColor, "", "");
  EXPECT_EQ(rules.fromColor({0, 200, 0}), (PointLabel{Kind::Class, 2}));
  EXPECT_EQ(rules.fromColor({0, 201, 0}), PointLabel{Kind::Unknown});
  EXPECT_EQ(rules.fromName("road"), (PointLabel{Kind::Class, 1}));
  EXPECT_EQ(rules.fromName("Road"), PointLabel{Kind::Unknown});
}

TEST(LabelRules, A1_noLabelOfAPointMeansFree) {
  // Raw ids without a table are class ids, and 0 is the class free.
  const LabelSet labels = LabelSet::occupancy();
  const LabelRules rules(labels, PointLabels::ByIntensity, "", "");
  EXPECT_EQ(rules.fromRaw(0), PointLabel{Kind::Unknown});
  EXPECT_EQ(rules.fromIntensity(0), PointLabel{Kind::Unknown});
  EXPECT_EQ(rules.fromName("free"), PointLabel{Kind::Unknown});
  EXPECT_EQ(rules.fromColor({255, 255, 255}), PointLabel{Kind::Unknown});
  EXPECT_EQ(rules.fromRaw(1), (PointLabel{Kind::Class, 1}));
  const LabelSet mapped = LabelSet::fromYaml(
      "name: mapped\nclasses:\n  - {id: 0, name: free, color: [255, 255, 255]}\n"
      "  - {id: 1, name: road, color: [1, 2, 3]}\nraw:\n  7: 0\n  8: 1\n",
      "test");
  EXPECT_EQ(LabelRules(mapped, PointLabels::ByIntensity, "", "").fromRaw(7),
            PointLabel{Kind::Unknown});
}

TEST(LabelRules, UnlabelledPointsHaveADefaultClass) {
  const LabelSet sample = sample::sampleLabels();
  EXPECT_EQ(LabelRules(sample, PointLabels::None, "", "").unlabelledClass(), ClassId{3});
  const LabelSet occupancy = LabelSet::occupancy();
  EXPECT_EQ(LabelRules(occupancy, PointLabels::None, "", "").unlabelledClass(), ClassId{1});
}

TEST(LabelRules, UnlabelledPointsMayBeDroppedOrNamed) {
  const LabelSet labels = sample::sampleLabels();
  EXPECT_FALSE(LabelRules(labels, PointLabels::None, "drop", "").unlabelledClass());
  EXPECT_EQ(LabelRules(labels, PointLabels::None, "wall", "").unlabelledClass(), ClassId{2});
}

TEST(LabelRules, ScansOf2DFollowTheirOwnKey) {
  const LabelSet labels = sample::sampleLabels();
  EXPECT_EQ(LabelRules(labels, PointLabels::None, "", "wall").ofScan2D(),
            (PointLabel{Kind::Class, 2}));
  EXPECT_EQ(LabelRules(labels, PointLabels::None, "road", "").ofScan2D(),
            (PointLabel{Kind::Class, 1}));
  EXPECT_EQ(LabelRules(labels, PointLabels::None, "drop", "").ofScan2D(), PointLabel{});
}

TEST(LabelRules, UnknownClassNamesAreNamedInTheError) {
  const LabelSet labels = sample::sampleLabels();
  try {
    LabelRules(labels, PointLabels::None, "lawn", "");
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("unlabelled_class = lawn"),
                                             testing::HasSubstr("road, wall")));
  }
  EXPECT_THROW(LabelRules(labels, PointLabels::None, "free", ""), ConfigError);
  EXPECT_THROW(LabelRules(labels, PointLabels::None, "", "lawn"), ConfigError);
}

TEST(LabelRules, PointLabelsParse) {
  for (const PointLabels value :
       {PointLabels::None, PointLabels::ByIntensity, PointLabels::ByColor}) {
    PointLabels parsed = PointLabels::None;
    parse("point_labels", toString(value), parsed);
    EXPECT_EQ(parsed, value);
  }
  PointLabels parsed = PointLabels::None;
  EXPECT_THROW(parse("point_labels", "colour", parsed), OptionError);
}

}  // namespace
}  // namespace csom
