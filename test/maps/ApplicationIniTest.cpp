// SPDX-License-Identifier: BSD-3-Clause
// What is said of ini files in which MRPT's programs would not find the semantic map.
#include <csom/core/Error.h>
#include <csom/maps/ApplicationIni.h>
#include <gmock/gmock.h>

#include <filesystem>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ApplicationIni : public testing::Test {
 protected:
  std::vector<std::string> check(const std::string& program, const std::string& ini) {
    writeBytes(folder_ / "map.ini", ini);
    return checkApplicationIni(folder_ / "map.ini", findApplication(program));
  }
  void expectError(const std::string& program, const std::string& ini, const std::string& message) {
    try {
      check(program, ini);
      FAIL() << ini;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
      EXPECT_THAT(error.what(), HasSubstr(folder_ / "map.ini"));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  TempFolder folder_;
};

TEST_F(ApplicationIni, ProgramsAreKnownByNameAndPath) {
  ASSERT_NE(findApplication("icp-slam"), nullptr);
  EXPECT_EQ(findApplication("/usr/bin/icp-slam"), findApplication("icp-slam"));
  EXPECT_EQ(findApplication("icp-slam")->section, "MappingApplication");
  EXPECT_EQ(findApplication("icp"), nullptr);
}

TEST_F(ApplicationIni, TheInisOfTheProjectAreFound) {
  const std::string configs = CSOM_SOURCE_DIR "/config/mrpt/";
  const std::vector<std::pair<std::string, std::string>> pairs{
      {"icp-slam", "icp-slam.ini"},
      {"rbpf-slam", "rbpf-slam.ini"},
      {"rbpf-slam", "rbpf-slam-campus.ini"},
      {"rbpf-slam", "rbpf-slam-optimal.ini"},
      {"pf-localization", "pf-localization.ini"},
      {"pf-localization", "pf-localization-demo.ini"},
      {"map-partition", "MAP-PARTITION_CONFIG.ini"},
      {"observations2map", "observations2map.ini"}};
  for (const auto& [program, ini] : pairs)
    EXPECT_THAT(checkApplicationIni(configs + ini, findApplication(program)), IsEmpty()) << ini;
}

TEST_F(ApplicationIni, AMapThatIsNotDefined) {
  expectError("rbpf-slam", "[MappingApplication]\n",
              "map.ini: defines no semantic map; write 'semanticContinuousMap_count = 1' in "
              "[MappingApplication]");
  expectError("rbpf-slam", "[MappingApplication]\nsemanticContinuousMap_count = 0\n",
              "[MappingApplication] semanticContinuousMap_count = 0 makes no map; set it to 1");
  expectError("pf-localization", "[MappingApplication]\nsemanticContinuousMap_count = 1\n",
              "[MappingApplication] semanticContinuousMap_count = 1: pf-localization reads "
              "[MetricMap] and would pass over it");
}

TEST_F(ApplicationIni, AMisspeltName) {
  expectError("observations2map", "[MappingApplication]\nsemanticContinousMap_count = 1\n",
              "[MappingApplication] semanticContinousMap_count: MRPT knows no such map");
}

TEST_F(ApplicationIni, AMapThatScansCannotBeAlignedTo) {
  const std::string alone = "[MappingApplication]\nsemanticContinuousMap_count = 1\n";
  expectError("icp-slam", alone, "name the map semanticPointsMap");
  expectError("rbpf-slam", alone + "PF_algorithm = 2\n", "name the map semanticPointsMap");
  EXPECT_THAT(check("rbpf-slam", alone + "PF_algorithm = 0\n"), IsEmpty());
  EXPECT_THAT(check("icp-slam", alone + "pointsMap_count = 1\n"), IsEmpty());
  EXPECT_THAT(check("icp-slam", "[MappingApplication]\nsemanticPointsMap_count = 1\n"), IsEmpty());
}

TEST_F(ApplicationIni, WrongValues) {
  expectError("observations2map",
              "[MappingApplication]\nsemanticContinuousMap_count = 1\n"
              "[MappingApplication_semanticContinuousMap_00_creationOpts]\nresolution = fine\n",
              "[MappingApplication_semanticContinuousMap_00_creationOpts]: resolution = fine");
  expectError("observations2map", "[MappingApplication]\nsemanticContinuousMap_count = many\n",
              "semanticContinuousMap_count = many");
  expectError("icp-slam", "[MappingApplication]\nsemanticPointsMap_count = 2000000000\n",
              "semanticPointsMap_count = 2000000000 must be 99 at most");
}

TEST_F(ApplicationIni, WhatNothingReads) {
  EXPECT_THAT(check("rbpf-slam",
                    "[MappingApplication]\nsemanticContinuousMap_count = 1\n"
                    "[MappingApplication_semanticContinuousMap_00_insertOpts]\nmax_rage = 9\n"
                    "[MappingApplication_semanticContinuousMap_01_insertOpts]\nmax_range = 9\n"
                    "[MappingApplication_semanticContinuousMap_insertOpts]\nmax_range = 9\n"
                    "[MetricMap_semanticContinuousMap_00_insertOpts]\nmax_range = 9\n"),
              ElementsAre(HasSubstr("max_rage: unknown key"),
                          HasSubstr("_semanticContinuousMap_01_insertOpts]: no map of that name"),
                          HasSubstr("_semanticContinuousMap_insertOpts]: no map of that name")));
}

TEST_F(ApplicationIni, OfAnUnknownProgramAnySectionWillDo) {
  EXPECT_THAT(check("my-slam", "[Mine]\nsemanticContinuousMap_count = 1\n"), IsEmpty());
  expectError("my-slam", "[Mine]\npointsMap_count = 1\n", "defines no semantic map");
}

TEST_F(ApplicationIni, CaseDoesNotMatter) {
  EXPECT_THAT(check("rbpf-slam", "[mappingapplication]\nSEMANTICCONTINUOUSMAP_COUNT = 1\n"),
              IsEmpty());
}

TEST_F(ApplicationIni, AFileThatIsMissing) {
  EXPECT_THROW(checkApplicationIni(folder_ / "none.ini", nullptr), ConfigError);
}

TEST_F(ApplicationIni, TellsWhereResultsGo) {
  writeBytes(folder_ / "a.ini", "[A]\nlogOutput_dir = out ; here\n[B]\nlogoutput_dir = there\n");
  EXPECT_THAT(listOutputFolders(folder_ / "a.ini"), testing::UnorderedElementsAre("out", "there"));
}

}  // namespace
}  // namespace csom::test
