// SPDX-License-Identifier: BSD-3-Clause
// csom import as a process.
#include "apps/RunCsom.h"
#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

constexpr char kHeader[] =
    "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\n"
    "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n";

TEST(Import, PcdFilesThatBecomeAMap) {
  const TempFolder folder;
  writeBytes(folder / "1.pcd", std::string(kHeader) + "1 0 0 1\n1 0.5 0 1\n");
  writeBytes(folder / "2.pcd", std::string(kHeader) + "1 1 0 2\n1 1.5 0 2\n");
  const auto run = runCsom(folder.path(), {"import", "pcd", folder / "1.pcd", folder / "2.pcd",
                                           "-o", folder / "a.rawlog"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("a.rawlog: 2 scans, 4 points"));
  EXPECT_THAT(run.errorLines(), testing::IsEmpty());
  ASSERT_EQ(runCsom(folder.path(),
                    {"map", folder / "a.rawlog", "-c", writeConfig(folder), "-o", folder / "out"})
                .exit_code,
            0);
  const auto document = loadMap(folder / "out/map.csom");
  EXPECT_EQ(document.map.at({1.0, 0.5, 0.0}).mostLikelyClass(), 1);
  EXPECT_EQ(document.map.at({1.0, 1.5, 0.0}).mostLikelyClass(), 2);
}

TEST(Import, AsksWhatToDoWithIrregularRows) {
  const TempFolder folder;
  writeBytes(folder / "1.pcd", std::string(kHeader) + "1 0 0 1 -1\n1 0.5 0 1\n");
  const std::vector<std::string> command{"import", "pcd", folder / "1.pcd", "-o",
                                         folder / "a.rawlog"};
  auto refusing = command;
  refusing.insert(refusing.end(), {"--irregular-rows", "refuse"});
  const auto refused = runCsom(folder.path(), refusing);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errorLines(), testing::ElementsAre(HasSubstr("1.pcd: line 11")));
  EXPECT_THAT(folder.fileNames(), testing::ElementsAre("1.pcd"));
  const auto by_default = runCsom(folder.path(), command);
  EXPECT_EQ(by_default.exit_code, 0) << by_default.errors;
  EXPECT_THAT(by_default.output, HasSubstr("2 points"));
  EXPECT_THAT(by_default.errorLines(), testing::ElementsAre(HasSubstr("line 11")));
  for (const auto& [policy, points] :
       {std::pair{"skip", "1 point"}, {"ignore-extra", "2 points"}}) {
    auto with_policy = command;
    with_policy.insert(with_policy.end(), {"--irregular-rows", policy});
    const auto run = runCsom(folder.path(), with_policy);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_THAT(run.output, HasSubstr(points));
    EXPECT_THAT(run.errorLines(), testing::ElementsAre(HasSubstr("warning: ")));
  }
}

TEST(Import, RefusesWrongUsage) {
  const TempFolder folder;
  const std::string log = folder / "a.rawlog";
  EXPECT_EQ(runCsom(folder.path(), {"import"}).exit_code, 2);
  EXPECT_EQ(runCsom(folder.path(), {"import", "pcd", "x.pcd"}).exit_code, 2) << "no -o";
  EXPECT_EQ(runCsom(folder.path(), {"import", "pcd", "x.pcd", "-o", log, "--scans", "5"}).exit_code,
            2);
  EXPECT_EQ(runCsom(folder.path(), {"import", "pcd", "x.pcd", "-o", log, "--every", "0"}).exit_code,
            2);
  EXPECT_EQ(runCsom(folder.path(), {"import", "pcd", "x.pcd", "-o", log, "--irregular-rows", "eat"})
                .exit_code,
            2);
  EXPECT_EQ(runCsom(folder.path(), {"import", "pcd", folder / "x.pcd", "-o", log}).exit_code, 1);
  EXPECT_EQ(runCsom(folder.path(), {"import", "semantickitti", folder / "x", "-o", log}).exit_code,
            1);
  EXPECT_EQ(runCsom(folder.path(), {"import", "kitti-raw", folder / "x", "-o", log}).exit_code, 1);
  EXPECT_THAT(folder.fileNames(), testing::IsEmpty());
}

}  // namespace
}  // namespace csom::test
