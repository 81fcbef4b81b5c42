// SPDX-License-Identifier: BSD-3-Clause
// NumPy archives, read back by NumPy.
#include <csom/exports/PointFiles.h>

#include <cstdio>
#include <sstream>

#include "apps/RunCsom.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

/// Prints all arrays of an archive, exactly.
constexpr char kPrintArchive[] = R"(
import sys, numpy
with numpy.load(sys.argv[1]) as archive:
    print(float(archive['resolution']).hex())
    print(*[name.decode().encode().hex() for name in archive['class_name']])
    assert archive['center'].dtype == numpy.float64 and archive['class_id'].dtype == numpy.uint8
    columns = [archive[name] for name in ('class_id', 'probability', 'variance', 'evidence')]
    for center, *rest in zip(archive['center'], *columns, strict=True):
        print(*[float(number).hex() for number in [*center, *rest]])
)";

TEST(Numpy, ReadsArchives) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  const VoxelSelection voxels(map);
  ASSERT_EQ(writeNpz(voxels, sampleLabels(), folder / "map.npz"), voxels.count());

  // Debian's NumPy is that of Debian's Python, which need not be the first in PATH.
  const ProgramResult python =
      runProgram(folder.path(), "/usr/bin/python3", {"-c", kPrintArchive, folder / "map.npz"});
  ASSERT_EQ(python.exit_code, 0) << python.errors;
  std::istringstream lines(python.output);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(std::strtod(line.c_str(), nullptr), 0.25);
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line, "66726565 726f6164 77616c6c2c20627269636b");
  voxels.forEach([&](const VoxelIndex&, const ExportedVoxel& v) {
    ASSERT_TRUE(std::getline(lines, line));
    double n[7];
    ASSERT_EQ(std::sscanf(line.c_str(), "%la %la %la %la %la %la %la", n, n + 1, n + 2, n + 3,
                          n + 4, n + 5, n + 6),
              7);
    EXPECT_EQ(Eigen::Vector3d(n[0], n[1], n[2]), v.center);
    EXPECT_EQ(n[3], v.class_id);
    EXPECT_EQ(n[4], v.probability);
    EXPECT_EQ(n[5], v.variance);
    EXPECT_EQ(n[6], v.evidence);
  });
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(Numpy, EqualMapsMakeEqualBytes) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  writeNpz(VoxelSelection(map), sampleLabels(), folder / "a.npz");
  writeNpz(VoxelSelection(map), sampleLabels(), folder / "b.npz");
  EXPECT_EQ(readBytes(folder / "a.npz"), readBytes(folder / "b.npz"));
}

TEST(Numpy, FailuresLeaveNothing) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  EXPECT_THAT(fileErrorOf([&] { writeNpz(VoxelSelection(map), sampleLabels(), "/nowhere/a.npz"); }),
              testing::HasSubstr("/nowhere/a.npz: cannot be written"));
  EXPECT_THAT(fileErrorOf([&] { writeNpz(VoxelSelection(map), sampleLabels(), "/dev/null"); }),
              testing::HasSubstr("/dev/null: is no regular file"));
  EXPECT_THAT(folder.fileNames(), testing::IsEmpty());
}

}  // namespace
}  // namespace csom::test
