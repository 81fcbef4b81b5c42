// SPDX-License-Identifier: BSD-3-Clause
#include <csom/exports/PointFiles.h>
#include <sys/resource.h>

#include <csignal>
#include <map>
#include <set>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// What an exported voxel must say, straight from the map.
struct Expected {
  Eigen::Vector3d center;
  ClassId class_id;
  double probability, variance, evidence;
};

std::vector<Expected> expectedVoxels(const SemanticMap& map, bool all) {
  std::vector<Expected> voxels;
  map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& v) {
    if (!all && v.state() != VoxelState::Occupied) return;
    const ClassId k = v.mostLikelyClass();
    voxels.push_back({map.grid().center(index), k, v.probability(k), v.variance(k), v.evidence()});
  });
  return voxels;
}

/// Splits off the first line, without its end.
std::string takeLine(std::string& text) {
  const std::size_t end = text.find('\n');
  const std::string line = text.substr(0, end);
  text.erase(0, end == std::string::npos ? text.size() : end + 1);
  return line;
}

template <class Number>
Number take(std::string& bytes) {
  Number number{};
  EXPECT_GE(bytes.size(), sizeof number);
  if (bytes.size() < sizeof number) return number;
  std::memcpy(&number, bytes.data(), sizeof number);
  bytes.erase(0, sizeof number);
  return number;
}

using Writer = std::size_t (*)(const VoxelSelection&, const LabelSet&, const std::string&);

class PointFilesTest : public testing::TestWithParam<bool> {
 protected:
  std::string exported(Writer write) {
    const std::string file = folder_ / "out";
    const VoxelSelection selection = VoxelSelection(map_).withFreeVoxels(all_);
    EXPECT_EQ(write(selection, labels_, file), voxels_.size());
    return readBytes(file);
  }

  const bool all_ = GetParam();
  const SemanticMap map_ = sampleMap();
  const LabelSet labels_ = sampleLabels();
  const std::vector<Expected> voxels_ = expectedVoxels(map_, all_);
  TempFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(OccupiedAndAll, PointFilesTest, testing::Bool());

TEST_P(PointFilesTest, SampleHasAllKindsOfVoxels) {
  std::set<ClassId> classes;
  for (const Expected& v : voxels_) classes.insert(v.class_id);
  EXPECT_EQ(classes, all_ ? (std::set<ClassId>{0, 1, 2}) : (std::set<ClassId>{1, 2}));
}

TEST_P(PointFilesTest, CsvReadsBackExactly) {
  std::string text = exported(writeCsv);
  EXPECT_EQ(takeLine(text), "x,y,z,class_id,class_name,probability,variance,evidence");
  for (const Expected& v : voxels_) {
    std::string line = takeLine(text);
    double n[3];
    int used = 0;
    int id = -1;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%d,%n", n, n + 1, n + 2, &id, &used), 4);
    EXPECT_EQ(Eigen::Vector3d(n[0], n[1], n[2]), v.center);
    EXPECT_EQ(id, v.class_id);
    line.erase(0, static_cast<std::size_t>(used));
    const std::string name =
        std::vector<std::string>{"free", "road", "\"wall, brick\""}[v.class_id];
    ASSERT_EQ(line.substr(0, name.size()), name);
    ASSERT_EQ(std::sscanf(line.c_str() + name.size(), ",%lf,%lf,%lf%n", n, n + 1, n + 2, &used), 3);
    EXPECT_EQ(line.size(), name.size() + static_cast<std::size_t>(used));
    EXPECT_EQ(n[0], v.probability);
    EXPECT_EQ(n[1], v.variance);
    EXPECT_EQ(n[2], v.evidence);
  }
  EXPECT_EQ(text, "");
}

TEST_P(PointFilesTest, PlyReadsBack) {
  std::string bytes = exported(writePly);
  std::vector<std::string> header;
  do header.push_back(takeLine(bytes));
  while (header.back() != "end_header" && header.size() < 30);
  EXPECT_THAT(header,
              ElementsAre("ply", "format binary_little_endian 1.0",
                          "element vertex " + std::to_string(voxels_.size()), "property double x",
                          "property double y", "property double z", "property uchar red",
                          "property uchar green", "property uchar blue", "property uchar class",
                          "property float probability", "property float variance", "end_header"));
  for (const Expected& v : voxels_) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(take<double>(bytes), v.center[axis]);
    for (const std::uint8_t part : labels_.at(v.class_id).color)
      EXPECT_EQ(take<std::uint8_t>(bytes), part);
    EXPECT_EQ(take<std::uint8_t>(bytes), v.class_id);
    EXPECT_EQ(take<float>(bytes), static_cast<float>(v.probability));
    EXPECT_EQ(take<float>(bytes), static_cast<float>(v.variance));
  }
  EXPECT_EQ(bytes, "");
}

TEST_P(PointFilesTest, PcdReadsBack) {
  std::string bytes = exported(writePcd);
  std::map<std::string, std::string> header;
  for (std::string line; line != "DATA binary";) {
    ASSERT_FALSE(bytes.empty());
    line = takeLine(bytes);
    const std::size_t space = line.find(' ');
    header[line.substr(0, space)] = line.substr(space + 1);
  }
  const std::string count = std::to_string(voxels_.size());
  EXPECT_EQ(header["VERSION"], "0.7");
  EXPECT_EQ(header["FIELDS"], "x y z rgb label");
  EXPECT_EQ(header["SIZE"], "4 4 4 4 4");
  EXPECT_EQ(header["TYPE"], "F F F F U");
  EXPECT_EQ(header["WIDTH"], count);
  EXPECT_EQ(header["POINTS"], count);
  for (const Expected& v : voxels_) {
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(take<float>(bytes), static_cast<float>(v.center[axis]));
    const Color& color = labels_.at(v.class_id).color;
    EXPECT_EQ(take<std::uint32_t>(bytes),
              (std::uint32_t{color[0]} << 16U) | (std::uint32_t{color[1]} << 8U) | color[2]);
    EXPECT_EQ(take<std::uint32_t>(bytes), v.class_id);
  }
  EXPECT_EQ(bytes, "");
}

const Writer kWriters[] = {writePly, writePcd, writeCsv, writeNpz};

TEST(PointFiles, NothingToExportIsAnError) {
  const TempFolder folder;
  const SemanticMap empty;
  for (const Writer write : kWriters) {
    EXPECT_THROW(write(VoxelSelection(empty), LabelSet::occupancy(), folder / "empty"),
                 ConfigError);
  }
  EXPECT_THAT(folder.fileNames(), testing::IsEmpty());
}

TEST(PointFiles, LabelsMustFitTheMap) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  EXPECT_THROW(writePly(VoxelSelection(map), LabelSet::occupancy(), folder / "a"),
               std::invalid_argument);
}

TEST(PointFiles, SinglePrecisionIsRefusedWhereItMovesVoxels) {
  const TempFolder folder;
  const SemanticMap map = sampleMap();
  const Eigen::Isometry3d far(Eigen::Translation3d(4e6, 0, 0));
  EXPECT_THROW(writePcd(VoxelSelection(map, {}, far), sampleLabels(), folder / "a"), ConfigError);
  EXPECT_THAT(folder.fileNames(), testing::IsEmpty());
  EXPECT_GT(writePly(VoxelSelection(map, {}, far), sampleLabels(), folder / "a"), 0U);
}

TEST(PointFiles, FullDiskLeavesNothing) {
  const TempFolder folder;
  struct rlimit limit {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const struct rlimit small { 1000, limit.rlim_max };
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const SemanticMap map = sampleMap();
  const VoxelSelection voxels = VoxelSelection(map).withFreeVoxels(true);
  for (const Writer write : {writePly, writePcd, writeCsv}) {
    EXPECT_THAT(fileErrorOf([&] { write(voxels, sampleLabels(), "/dev/full"); }),
                HasSubstr("/dev/full: cannot be written: No space left on device"));
    ::setrlimit(RLIMIT_FSIZE, &small);
    const std::string message = fileErrorOf([&] { write(voxels, sampleLabels(), folder / "out"); });
    ::setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_THAT(message, HasSubstr("/out: cannot be written: File too large"));
    EXPECT_THAT(folder.fileNames(), testing::IsEmpty());
  }
  std::signal(SIGXFSZ, old_handler);
}

}  // namespace
}  // namespace csom::test
