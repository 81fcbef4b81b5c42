// SPDX-License-Identifier: BSD-3-Clause
// The conference room in every format.
#include <cstdlib>
#include <stdexcept>

#include "apps/ExportRun.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

std::string dataFolder(const std::string& name) {
  const char* folder = std::getenv("CSOM_DATA");
  if (folder == nullptr)
    throw std::runtime_error("set the environment variable CSOM_DATA to the folder of real data");
  return std::string(folder) + "/" + name;
}

TEST(ExportRealData, ConferenceRoomReadsBackTheSame) {
  const TempFolder folder;
  const auto run = [&](const std::vector<std::string>& arguments) {
    return runCsom(folder.path(), arguments);
  };
  ASSERT_EQ(run({"import", "pcd", dataFolder("stanford_conference"), "--single-scan", "-o",
                 folder / "room.rawlog"})
                .exit_code,
            0);
  const auto mapWith = [&](const std::string& method) {
    const std::string section = "_00_insertOpts]\n";
    std::string config = readBytes(std::string(CSOM_SOURCE_DIR) + "/config/stanford.ini");
    ASSERT_NE(config.find(section), std::string::npos);
    config.insert(config.find(section) + section.size(), "method = " + method + "\n");
    writeBytes(folder / "room.ini", config);
    ASSERT_EQ(run({"map", folder / "room.rawlog", "-c", folder / "room.ini", "-o", folder / "out",
                   "--no-html"})
                  .exit_code,
              0);
  };
  mapWith("surface-csom");
  expectAllFormatsReadBack(folder.path(), folder / "out/map.csom");

  // Its scans do not say where they were seen from, so this method finds no free space.
  mapWith("see-csom");
  const ProgramResult nav2 = run({"export", folder / "out/map.csom", "--to", "nav2",
                                  "--obstacle-band", "0.1,1", "-o", folder / "room.yaml"});
  EXPECT_EQ(nav2.exit_code, 2);
  EXPECT_THAT(nav2.errorLines(), testing::ElementsAre(HasSubstr("no cell would be free")));
}

}  // namespace
}  // namespace csom::test
