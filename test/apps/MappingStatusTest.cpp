// SPDX-License-Identifier: BSD-3-Clause
// What a running csom map says about itself, as text and on a terminal.
#include "../../apps/csom/MappingStatus.h"

#include <algorithm>

#include "apps/RunCsom.h"
#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

SemanticMap mapOfOneVoxel() {
  Options options;
  options.method = Method::SCsm;
  SemanticMap map(options);
  Scan scan;
  scan.points = {{1.1F, 0.1F, 0.1F}};
  scan.labels = {1};
  map.insert(scan);
  return map;
}

TEST(MappingStatus, TellsSpeedSizeAndRejects) {
  const SemanticMap map = mapOfOneVoxel();
  const std::string log = "a.rawlog";
  EXPECT_THAT(mappingStatus({log, 10, 20, 2000, 12345, 1, map}, 40),
              AllOf(HasSubstr("2,000 scans (50/s), 1 voxel in "),
                    HasSubstr(" bytes, 12,345 points rejected, 1 observation refused")));
  EXPECT_THAT(mappingStatus({log, 10, 20, 1, 0, 0, map}, 0),
              AllOf(HasSubstr("1 scan, "), Not(HasSubstr("rejected")), Not(HasSubstr("refused"))));
  EXPECT_THAT(mappingStatus({log, 10, 20, 1, 0, 0, map, 4321}, 0),
              HasSubstr(" bytes and 4,321 chunks on the disk"));
}

TEST(MappingStatus, OnATerminalKeepsToOneLineAndIsWiped) {
  const TempFolder folder;
  const std::string source = CSOM_SOURCE_DIR;
  const auto draw = [&](int columns) {
    // The size of the terminal is that of its standard error.
    const ProgramResult run = runProgram(
        folder.path(), "/usr/bin/python3",
        {"-c",
         "import fcntl, os, pty, struct, subprocess, sys, termios\n"
         "ours, theirs = pty.openpty()\n"
         "fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack('HHHH', 24, int(sys.argv[1]), 0, "
         "0))\n"
         "run = subprocess.Popen(sys.argv[2:], stdout=subprocess.DEVNULL, stderr=theirs)\n"
         "os.close(theirs)\n"
         "while True:\n"
         "    try:\n"
         "        sys.stdout.buffer.write(os.read(ours, 4096))\n"
         "    except OSError:\n"
         "        break\n"
         "sys.exit(run.wait())\n",
         std::to_string(columns), CSOM_PROGRAM, "map", source + "/rawlogs/campus.rawlog", "-c",
         source + "/config/campus.ini", "-o", folder / "out", "--no-html"});
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return run.output;
  };
  const std::string wipe = "\r\033[K";
  const auto linesOf = [&](const std::string& output) {
    std::vector<std::string> lines;
    for (std::size_t at = output.find(wipe); at != std::string::npos;) {
      at += wipe.size();
      const std::size_t next = output.find(wipe, at);
      lines.push_back(output.substr(at, next - at));
      at = next;
    }
    return lines;
  };
  const auto wide = linesOf(draw(200));
  ASSERT_GE(wide.size(), 2u);
  EXPECT_THAT(
      wide[wide.size() - 2],
      ContainsRegex("^mapping \\[#+\\.*\\] +[0-9]+ %  [0-9,]+/[0-9,]+  ETA .*  [0-9,]+ scans "
                    "\\([0-9.]+/s\\), [0-9,]+ voxels in [0-9.]+ [kM]B"));
  EXPECT_EQ(wide.back(), "") << "wiped";
  for (const std::string& line : linesOf(draw(50))) EXPECT_LT(line.size(), 50u) << line;
}

}  // namespace
}  // namespace csom::test
