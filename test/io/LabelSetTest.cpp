// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

/// A good label set of three lines of classes; tests spoil one line each.
std::string labelSet(const std::string& class1 = "{id: 1, name: car, color: [1, 2, 3]}",
                     const std::string& rest = "") {
  return "name: test\nclasses:\n  - {id: 0, name: free, color: [255, 255, 255]}\n  - " + class1 +
         "\n  - {id: 2, name: tree, color: [0, 200, 0]}\n" + rest;
}

LabelSet shipped(const std::string& name) {
  return LabelSet::load(CSOM_SOURCE_DIR "/config/labels/" + name + ".yaml");
}

TEST(LabelSet, ReadsClassesAndRawIds) {
  const LabelSet set =
      LabelSet::fromYaml(labelSet("{id: 1, name: car, color: [1, 2, 3]}",
                                  "raw:\n  10: 1\n  4000000000: 2\n  7: 0\n  0: ignore\n"),
                         "here");
  EXPECT_EQ(set.name(), "test");
  ASSERT_EQ(set.numberOfClasses(), 3);
  EXPECT_EQ(set.at(1).name, "car");
  EXPECT_EQ(set.at(1).color, (Color{1, 2, 3}));
  EXPECT_EQ(set.classOfRaw(10), (LabelSet::Raw{LabelSet::RawKind::Class, 1}));
  EXPECT_EQ(set.classOfRaw(4000000000U), (LabelSet::Raw{LabelSet::RawKind::Class, 2}));
  EXPECT_EQ(set.classOfRaw(7), (LabelSet::Raw{LabelSet::RawKind::Class, kFreeClass}));
  EXPECT_EQ(set.classOfRaw(0).kind, LabelSet::RawKind::Ignored);
  EXPECT_EQ(set.classOfRaw(1).kind, LabelSet::RawKind::Unknown);
}

TEST(LabelSet, WithoutRawTableIdsAreClasses) {
  const LabelSet set = LabelSet::fromYaml(labelSet(), "here");
  EXPECT_EQ(set.classOfRaw(2), (LabelSet::Raw{LabelSet::RawKind::Class, 2}));
  EXPECT_EQ(set.classOfRaw(3).kind, LabelSet::RawKind::Unknown);
  EXPECT_EQ(set.classOfRaw(65536 + 1).kind, LabelSet::RawKind::Unknown);
}

TEST(LabelSet, FindsClassesByNameAndColor) {
  const LabelSet set = LabelSet::fromYaml(labelSet(), "here");
  EXPECT_EQ(set.classByName("tree"), ClassId{2});
  EXPECT_EQ(set.classByName("Tree"), std::nullopt);
  EXPECT_EQ(set.classByColor({0, 200, 0}), ClassId{2});
  EXPECT_EQ(set.classByColor({0, 200, 1}), std::nullopt);
  EXPECT_EQ(set.classByColor({255, 255, 255}), std::nullopt) << "free has no points";
}

TEST(LabelSet, OccupancyHasTwoClasses) {
  const LabelSet set = LabelSet::occupancy();
  ASSERT_EQ(set.numberOfClasses(), 2);
  EXPECT_EQ(set.at(0).name, "free");
  EXPECT_EQ(set.at(1).name, "occupied");
}

TEST(LabelSet, YamlRoundTrip) {
  for (const char* name : {"semantickitti", "cityscapes", "stanford", "simulator"}) {
    const LabelSet set = shipped(name);
    EXPECT_EQ(LabelSet::fromYaml(set.toYaml(), "again"), set) << name;
  }
  const LabelSet odd = LabelSet::fromYaml(
      labelSet("{id: 1, name: \"a: 'b', #c \\\"d\\\"\", color: [1, 2, 3]}"), "odd");
  EXPECT_EQ(LabelSet::fromYaml(odd.toYaml(), "again"), odd);
  for (const char* word : {"null", "true", "12", "~", "ä ö", "道路", " "}) {
    const LabelSet set = LabelSet::fromYaml(
        labelSet("{id: 1, name: \"" + std::string(word) + "\", color: [1, 2, 3]}"), "word");
    EXPECT_EQ(LabelSet::fromYaml(set.toYaml(), "again").at(1).name, word);
  }
}

TEST(LabelSet, DifferentSetsAreNotEqual) {
  const LabelSet base = LabelSet::fromYaml(labelSet(), "a");
  EXPECT_NE(base, LabelSet::fromYaml(labelSet("{id: 1, name: cat, color: [1, 2, 3]}"), "b"));
  EXPECT_NE(base, LabelSet::fromYaml(labelSet("{id: 1, name: car, color: [1, 2, 4]}"), "b"));
  EXPECT_NE(base, LabelSet::fromYaml(
                      labelSet("{id: 1, name: car, color: [1, 2, 3]}", "raw: {1: 1}\n"), "b"));
}

TEST(ShippedLabelSets, SemanticKitti) {
  const LabelSet set = shipped("semantickitti");
  EXPECT_EQ(set.numberOfClasses(), 20);
  const auto nameOf = [&](std::uint32_t raw) {
    const LabelSet::Raw r = set.classOfRaw(raw);
    return r.kind == LabelSet::RawKind::Class ? set.at(r.id).name : "-";
  };
  EXPECT_EQ(nameOf(10), "car");
  EXPECT_EQ(nameOf(252), "car") << "moving objects count as their static class";
  EXPECT_EQ(nameOf(253), "bicyclist");
  EXPECT_EQ(nameOf(254), "person");
  EXPECT_EQ(nameOf(255), "motorcyclist");
  EXPECT_EQ(nameOf(257), "other-vehicle");
  EXPECT_EQ(nameOf(258), "truck");
  EXPECT_EQ(nameOf(40), "road");
  EXPECT_EQ(nameOf(60), "road");
  EXPECT_EQ(nameOf(48), "sidewalk");
  EXPECT_EQ(nameOf(70), "vegetation");
  EXPECT_EQ(nameOf(81), "traffic-sign");
  for (const std::uint32_t raw : {0U, 1U, 52U, 99U})
    EXPECT_EQ(set.classOfRaw(raw).kind, LabelSet::RawKind::Ignored) << raw;
  EXPECT_EQ(set.classOfRaw(2).kind, LabelSet::RawKind::Unknown);
  EXPECT_EQ(set.at(1).color, (Color{100, 150, 245})) << "the data set's own table is in BGR";
}

TEST(ShippedLabelSets, Cityscapes) {
  const LabelSet set = shipped("cityscapes");
  EXPECT_EQ(set.numberOfClasses(), 20);
  EXPECT_EQ(set.at(set.classOfRaw(0).id).name, "road");
  EXPECT_EQ(set.at(set.classOfRaw(13).id).name, "car");
  EXPECT_EQ(set.at(set.classOfRaw(18).id).name, "bicycle");
  for (const std::uint32_t raw : {10U, 19U, 255U})
    EXPECT_EQ(set.classOfRaw(raw).kind, LabelSet::RawKind::Ignored) << raw;
}

TEST(ShippedLabelSets, StanfordAndSimulator) {
  const LabelSet stanford = shipped("stanford");
  EXPECT_EQ(stanford.numberOfClasses(), 11);
  EXPECT_EQ(stanford.at(stanford.classOfRaw(1).id).name, "wall");
  EXPECT_EQ(stanford.at(stanford.classOfRaw(9).id).name, "clutter");
  EXPECT_EQ(stanford.at(stanford.classOfRaw(10).id).name, "ceiling");
  const LabelSet simulator = shipped("simulator");
  for (const char* name : {"road", "building", "vegetation", "car", "wall", "floor", "ceiling"})
    EXPECT_TRUE(simulator.classByName(name).has_value()) << name;
}

struct BadLabelSet {
  const char* description;
  std::string yaml;
  const char* line;
  const char* reason;
};

/// How GoogleTest shows the parameter.
void PrintTo(const BadLabelSet& value, std::ostream* out) {
  *out << value.description;
}

class BadLabelSets : public testing::TestWithParam<BadLabelSet> {};

TEST_P(BadLabelSets, AreRefusedWithFileLineAndReason) {
  const std::string message =
      fileErrorOf([] { LabelSet::fromYaml(GetParam().yaml, "dir/bad.yaml"); });
  EXPECT_THAT(message, HasSubstr(std::string("dir/bad.yaml: line ") + GetParam().line + ":"));
  EXPECT_THAT(message, HasSubstr(GetParam().reason));
  EXPECT_THAT(message, testing::Not(HasSubstr("\n")));
}

std::string tooManyClasses() {
  std::string yaml = "name: big\nclasses:\n  - {id: 0, name: free, color: [255, 255, 255]}\n";
  for (int i = 1; i <= 256; ++i)
    yaml += "  - {id: " + std::to_string(i) + ", name: c" + std::to_string(i) + ", color: [" +
            std::to_string(i % 256) + ", " + std::to_string(i / 256) + ", 0]}\n";
  return yaml;
}

const std::string kCar = "{id: 1, name: car, color: [1, 2, 3]}";

INSTANTIATE_TEST_SUITE_P(
    All, BadLabelSets,
    testing::Values(
        BadLabelSet{"empty", "", "1", "must be a map"},
        BadLabelSet{"not yaml", "name: [1, 2\nx", "2", "no valid YAML"},
        BadLabelSet{"deeply nested", std::string(100000, '['), "1", "no valid YAML"},
        BadLabelSet{"a list", "- a\n- b\n", "1", "must be a map"},
        BadLabelSet{"no name", "classes: []\n", "1", "lacks the key 'name'"},
        BadLabelSet{"no classes", "name: a\n", "1", "lacks the key 'classes'"},
        BadLabelSet{"unknown key", labelSet(kCar, "rawl: {}\n"), "6", "unknown key 'rawl'"},
        BadLabelSet{"double key", labelSet(kCar, "name: again\n"), "6", "occurs twice"},
        BadLabelSet{"one class", "name: a\nclasses:\n  - {id: 0, name: free, color: [1, 1, 1]}\n",
                    "3", "at least two"},
        BadLabelSet{"257 classes", tooManyClasses(), "3", "257 classes, at most 256"},
        BadLabelSet{"class 0 missing",
                    "name: a\nclasses:\n  - {id: 1, name: b, color: [1, 1, 1]}\n"
                    "  - {id: 2, name: c, color: [1, 1, 2]}\n",
                    "3", "class id 1, expected 0"},
        BadLabelSet{"class 0 not free",
                    "name: a\nclasses:\n  - {id: 0, name: none, color: [1, 1, 1]}\n"
                    "  - {id: 1, name: c, color: [1, 1, 2]}\n",
                    "3", "must be named 'free'"},
        BadLabelSet{"duplicate id", labelSet("{id: 0, name: car, color: [1, 2, 3]}"), "4",
                    "class id 0, expected 1"},
        BadLabelSet{"gap", labelSet("{id: 3, name: car, color: [1, 2, 3]}"), "4",
                    "class id 3, expected 1"},
        BadLabelSet{"negative id", labelSet("{id: -1, name: car, color: [1, 2, 3]}"), "4",
                    "id is '-1'"},
        BadLabelSet{"id no number", labelSet("{id: one, name: car, color: [1, 2, 3]}"), "4",
                    "id is 'one'"},
        BadLabelSet{"huge id", labelSet("{id: 99999999999999, name: car, color: [1, 2, 3]}"), "4",
                    "from 0 to 255"},
        BadLabelSet{"same name", labelSet("{id: 1, name: tree, color: [1, 2, 3]}"), "5",
                    "same name 'tree'"},
        BadLabelSet{"same color", labelSet("{id: 1, name: car, color: [0, 200, 0]}"), "5",
                    "same color"},
        BadLabelSet{"empty name", labelSet("{id: 1, name: \"\", color: [1, 2, 3]}"), "4",
                    "non-empty"},
        BadLabelSet{"newline in name", labelSet("{id: 1, name: \"a\\nb\", color: [1, 2, 3]}"), "4",
                    "control character"},
        // Found by fuzzing: it was read, but was another name when it came out of a map file.
        BadLabelSet{"name of stray bytes", labelSet("{id: 1, name: ca\xff, color: [1, 2, 3]}"), "4",
                    "not UTF-8"},
        BadLabelSet{"two colors", labelSet("{id: 1, name: car, color: [1, 2]}"), "4",
                    "three integers"},
        BadLabelSet{"color word", labelSet("{id: 1, name: car, color: red}"), "4",
                    "three integers"},
        BadLabelSet{"color 256", labelSet("{id: 1, name: car, color: [1, 2, 256]}"), "4",
                    "'256', must be an integer from 0 to 255"},
        BadLabelSet{"color 1.5", labelSet("{id: 1, name: car, color: [1, 2, 1.5]}"), "4", "'1.5'"},
        BadLabelSet{"unknown class key", labelSet("{id: 1, name: a, color: [1, 2, 3], x: 1}"), "4",
                    "unknown key 'x' in a class"},
        BadLabelSet{"class without color", labelSet("{id: 1, name: a}"), "4",
                    "lacks the key 'color'"},
        BadLabelSet{"free class 1", labelSet("{id: 1, name: a, color: [1, 2, 3], free: true}"), "4",
                    "class 0 is free and no other"},
        BadLabelSet{"free maybe", labelSet("{id: 1, name: a, color: [1, 2, 3], free: maybe}"), "4",
                    "true or false"},
        BadLabelSet{"raw empty", labelSet(kCar, "raw: {}\n"), "6", "raw must map"},
        BadLabelSet{"raw list", labelSet(kCar, "raw: [1]\n"), "6", "raw must map"},
        BadLabelSet{"raw to unknown class", labelSet(kCar, "raw:\n  10: 3\n"), "7",
                    "'3', must be an integer from 0 to 2"},
        BadLabelSet{"raw to word", labelSet(kCar, "raw:\n  10: skip\n"), "7", "'skip'"},
        BadLabelSet{"raw key word", labelSet(kCar, "raw:\n  car: 1\n"), "7", "'car'"},
        BadLabelSet{"raw key too large", labelSet(kCar, "raw:\n  4294967296: 1\n"), "7",
                    "'4294967296'"},
        BadLabelSet{"raw twice", labelSet(kCar, "raw:\n  10: 1\n  10: 2\n"), "8",
                    "raw id 10 occurs twice"}),
    [](const auto& test) {
      std::string name = test.param.description;
      for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
      return name;
    });

TEST(LabelSetFile, MissingFileIsNamed) {
  EXPECT_THAT(fileErrorOf([] { LabelSet::load("/nowhere/labels.yaml"); }),
              HasSubstr("/nowhere/labels.yaml: no such file"));
  const TempFolder folder;
  EXPECT_THAT(fileErrorOf([&] { LabelSet::load(folder.path()); }), HasSubstr("is a folder"));
}

TEST(LabelSetFind, BareNameComesFromTheBuildTree) {
  const std::string file = LabelSet::find("semantickitti");
  EXPECT_THAT(file, HasSubstr("share/mrpt_csom/labels/semantickitti.yaml"));
  EXPECT_EQ(LabelSet::load(file), shipped("semantickitti"));
}

TEST(LabelSetFind, PathsAreRelativeToTheBaseFolderFirst) {
  const TempFolder folder;
  writeBytes(folder / "mine.yaml", labelSet());
  EXPECT_EQ(LabelSet::find("mine.yaml", folder.path()), folder / "mine.yaml");
  EXPECT_EQ(LabelSet::find(folder / "mine.yaml"), folder / "mine.yaml");
}

TEST(LabelSetFind, EnvironmentComesBeforeThePrefix) {
  const TempFolder folder;
  writeBytes(folder / "stanford.yaml", labelSet());
  ::setenv("CSOM_LABELS_PATH", ("/nowhere:" + folder.path()).c_str(), 1);
  const std::string file = LabelSet::find("stanford");
  ::unsetenv("CSOM_LABELS_PATH");
  EXPECT_EQ(file, folder / "stanford.yaml");
}

TEST(LabelSetFind, UnknownNameListsWhereItLooked) {
  try {
    LabelSet::find("no-such-set", "/base");
    FAIL() << "found";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("label set 'no-such-set' not found"));
    EXPECT_THAT(error.what(), HasSubstr("/base/no-such-set"));
    EXPECT_THAT(error.what(), HasSubstr("share/mrpt_csom/labels/no-such-set.yaml"));
  }
  EXPECT_THROW(LabelSet::find(""), ConfigError);
}

}  // namespace
}  // namespace csom::test
