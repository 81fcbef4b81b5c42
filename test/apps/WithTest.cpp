// SPDX-License-Identifier: BSD-3-Clause
// csom with: MRPT's own programs, started by csom.
#include <gmock/gmock.h>

#include <filesystem>
#include <regex>

#include "apps/RunMrpt.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kConfigs = CSOM_SOURCE_DIR "/config/mrpt/";
const std::string kDataSets = "/usr/share/mrpt/datasets/";  // of the package mrpt-common

class With : public testing::Test {
 protected:
  ProgramResult with(std::vector<std::string> command, std::vector<std::string> environment = {}) {
    const std::vector<std::string> accepting = acceptingPlugin();
    environment.insert(environment.begin(), accepting.begin(), accepting.end());
    // A shell cannot trap what those who started the test have chosen to ignore.
    command.insert(command.begin(), {"--default-signal=TERM,HUP,INT", "-C", folder_.path(),
                                     "timeout", "200", CSOM_PROGRAM, "with", "--"});
    return runProgram(folder_.path(), "env", command, environment);
  }
  /// A small shell program, instead of one of MRPT's.
  ProgramResult withShell(const std::string& script,
                          const std::vector<std::string>& environment = {}) {
    return with({"sh", "-c", script}, environment);
  }
  const TempFolder folder_;
};

TEST_F(With, IcpSlamLeavesAMapThatIsNamed) {
  const ProgramResult run =
      with({"icp-slam", kConfigs + "icp-slam.ini",
            kDataSets + "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  std::smatch told;
  const std::regex line("csom: wrote (\\S+): (\\d+) observations, [\\d,]+ known voxels\n");
  ASSERT_TRUE(std::regex_search(run.errors, told, line)) << run.errors;
  const MapDocument document = loadMap(folder_ / told[1].str());
  EXPECT_EQ(document.scans.size(), std::stoul(told[2]));
  EXPECT_GT(document.scans.size(), 20u);
}

TEST_F(With, APrefixMayNameWhereMapsGo) {
  std::filesystem::create_directory(folder_ / "maps");
  const ProgramResult run = with({"observations2map", kConfigs + "observations2map.ini",
                                  kDataSets + "localization_demo.simplemap.gz", "maps/demo"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors,
              HasSubstr("csom: wrote maps/demo_csom__CSemanticContinuousMap_00.csom: "));
}

TEST_F(With, MapsThatWereThereBeforeAreNotTold) {
  writeBytes(folder_ / "old.csom", "");
  const ProgramResult run = withShell("true");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.errors, HasSubstr("csom: warning: sh left no map (.csom)"));
  EXPECT_THAT(run.errors, Not(HasSubstr("old.csom")));
}

TEST_F(With, ADamagedMapIsSaidToBe) {
  const ProgramResult run = withShell("echo nonsense >new.csom");
  EXPECT_THAT(run.errors, HasSubstr("csom: warning: wrote a map that is damaged: new.csom: "));
}

TEST_F(With, PreloadsThePluginBesideWhatIsPreloadedAnyway) {
  const std::string plugin = std::filesystem::canonical(CSOM_PLUGIN).string();
  const std::string sanitizer = CSOM_ADDRESS_SANITIZER;
  const std::string behind = sanitizer.empty() ? "" : ":" + sanitizer;
  EXPECT_EQ(withShell("echo \"$LD_PRELOAD\"").output, plugin + behind + "\n");
  const std::string others = "libm.so.6" + behind;
  const ProgramResult both = withShell("echo \"$LD_PRELOAD\"", {"LD_PRELOAD=" + others});
  EXPECT_EQ(both.output, plugin + ":" + others + "\n");
}

TEST_F(With, ExitCodesAndSignalsArePassedThrough) {
  EXPECT_EQ(withShell("exit 7").exit_code, 7);
  const ProgramResult crashed = withShell("kill -KILL $$");
  EXPECT_EQ(crashed.exit_code, 128 + 9);
  EXPECT_THAT(crashed.errors, HasSubstr("csom: sh was ended by signal 9 (Killed)"));
}

TEST_F(With, PassesSignalsOnToTheProgram) {
  for (const std::string name : {"TERM", "HUP", "INT"}) {
    const ProgramResult run = withShell("trap 'exit 5' " + name + "; kill -" + name +
                                        " $PPID; while :; do sleep 0.02; done");
    EXPECT_EQ(run.exit_code, 5) << name << run.errors;
  }
}

TEST_F(With, AProgramThatCannotBeStarted) {
  const ProgramResult run = with({"no-such-slam", "a"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.errors,
              HasSubstr("csom: 'no-such-slam' cannot be started: No such file or directory"));
}

TEST_F(With, AnIniInWhichMrptFindsNoMapIsNotRun) {
  writeBytes(folder_ / "my.ini", "[MappingApplication]\nsemanticContinousMap_count = 1\n");
  const ProgramResult run = with({"observations2map", "my.ini", "x.simplemap", "out"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.output, "") << "observations2map was not started";
  EXPECT_EQ(run.errors,
            "csom: my.ini [MappingApplication] semanticContinousMap_count: MRPT knows no such map "
            "and would pass over it; write 'semanticContinuousMap_count = 1' in "
            "[MappingApplication]\n");
}

TEST_F(With, OfSeveralInisOneMustDefineTheMap) {
  writeBytes(folder_ / "other.ini", "[Camera]\nrate = 5\n");
  writeBytes(folder_ / "maps.ini", "[Mine]\nsemanticContinuousMap_count = 1\n");
  EXPECT_EQ(with({"sh", "-c", "exit 3", "other.ini", "maps.ini"}).exit_code, 3);
  const ProgramResult without = with({"sh", "-c", "exit 3", "other.ini"});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.errors, HasSubstr("other.ini: defines no semantic map"));
}

TEST_F(With, MapPartitionReadsItsIniFromTheWorkingFolder) {
  const ProgramResult run = with({"map-partition", "x.simplemap"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.errors, HasSubstr("MAP-PARTITION_CONFIG.ini: no such file"));
}

TEST_F(With, SaysThatThereWasNothingToCheck) {
  EXPECT_THAT(withShell("true").errors, HasSubstr("sh: no .ini among its arguments"));
  const ProgramResult edit = with({"rawlog-edit", "--version"});
  EXPECT_THAT(edit.errors, HasSubstr("rawlog-edit has ended; it saves no maps"));
  EXPECT_THAT(edit.errors, Not(HasSubstr("no .ini")));
}

}  // namespace
}  // namespace csom::test
