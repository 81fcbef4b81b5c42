// SPDX-License-Identifier: BSD-3-Clause
// The commented ini that the program prints is one that it reads.
#include <csom/maps/DefaultIni.h>
#include <gmock/gmock.h>

#include "apps/RunCsom.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

TEST(PrintConfig, PrintsEveryKeyAndNothingElse) {
  const TempFolder folder;
  const ProgramResult run = runCsom(folder.path(), {"map", "--print-config"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.output, defaultIni());
  EXPECT_EQ(run.errors, "");
}

TEST(PrintConfig, MakesTheMapOfAnEmptyIni) {
  const TempFolder folder;
  writeBytes(folder / "full.ini", runCsom(folder.path(), {"map", "--print-config"}).output);
  writeBytes(folder / "short.ini", "[MappingApplication]\nsemanticContinuousMap_count = 1\n");
  std::vector<std::string> digests;
  for (const std::string name : {"full", "short"}) {
    const ProgramResult run =
        runCsom(folder.path(), {"map", CSOM_SOURCE_DIR "/rawlogs/room.rawlog", "-c",
                                folder / (name + ".ini"), "-o", folder / name, "--no-html"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    digests.push_back(mapDigest(loadMap(folder / (name + "/map.csom")).map));
  }
  EXPECT_EQ(digests[0], digests[1]);
}

}  // namespace
}  // namespace csom::test
