// SPDX-License-Identifier: BSD-3-Clause
// csom info --verify and csom repair as processes.
#include <nlohmann/json.hpp>

#include "apps/RunCsom.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

class Repair : public testing::Test {
 protected:
  Repair() { saveMap(sampleDocument(), map); }
  void damageAChunk() const {
    std::string bytes = readBytes(map);
    bytes[bytes.find("\x28\xb5\x2f\xfd") + 20] ^= 1;
    writeBytes(map, bytes);
  }
  const TempFolder folder;
  const std::string map = folder / "map.csom";
};

TEST_F(Repair, AnIntactMapIsVerifiedAndNothingOfItIsLost) {
  const auto verified = runCsom(folder.path(), {"info", map, "--verify"});
  EXPECT_EQ(verified.exit_code, 0) << verified.errors;
  EXPECT_THAT(verified.output, HasSubstr("intact, "));
  const auto repaired = runCsom(folder.path(), {"repair", map, folder / "again.csom"});
  EXPECT_EQ(repaired.exit_code, 0) << repaired.errors;
  EXPECT_THAT(repaired.output, HasSubstr("no voxel is lost"));
  EXPECT_EQ(mapDigest(loadMap(folder / "again.csom").map), mapDigest(sampleMap()));
}

TEST_F(Repair, DamageIsFoundAndTheRestIsSaved) {
  damageAChunk();
  const auto info = runCsom(folder.path(), {"info", map});
  EXPECT_EQ(info.exit_code, 1);
  EXPECT_THAT(info.errors, HasSubstr("csom repair saves what is intact"));

  const auto verified = runCsom(folder.path(), {"info", map, "--verify"});
  EXPECT_EQ(verified.exit_code, 1);
  EXPECT_EQ(verified.output, "");
  EXPECT_THAT(verified.errors, HasSubstr("table chunks, row"));
  EXPECT_THAT(verified.errors, HasSubstr("is damaged; 'csom repair' saves "));
  const auto json =
      nlohmann::json::parse(runCsom(folder.path(), {"info", map, "--verify", "--json"}).output);
  EXPECT_EQ(json.at("intact"), false);
  EXPECT_EQ(json.at("chunks"), sampleMap().chunks().chunkCount() - 1);

  const auto repaired = runCsom(folder.path(), {"repair", map, folder / "saved.csom"});
  EXPECT_EQ(repaired.exit_code, 0) << repaired.errors;
  EXPECT_THAT(repaired.output, HasSubstr("lost: 1 of "));
  const MapDocument saved = loadMap(folder / "saved.csom");
  EXPECT_EQ(saved.map.chunks().chunkCount(), sampleMap().chunks().chunkCount() - 1);
  EXPECT_EQ(saved.scans.size(), 3U);
  EXPECT_THAT(saved.meta.at("lost_1"), HasSubstr("1 of "));
  EXPECT_EQ(runCsom(folder.path(), {"info", folder / "saved.csom", "--verify"}).exit_code, 0);
}

TEST_F(Repair, WhatIsNoMapIsRefusedAndTheInputIsNeverTheOutput) {
  writeBytes(folder / "text", std::string(9000, 'x'));
  const auto run = runCsom(folder.path(), {"repair", folder / "text", folder / "out.csom"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.errors, HasSubstr("holds no options of a map"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.csom"));
  EXPECT_EQ(runCsom(folder.path(), {"repair", map, map}).exit_code, 2);
}

}  // namespace
}  // namespace csom::test
