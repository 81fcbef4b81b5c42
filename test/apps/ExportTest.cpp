// SPDX-License-Identifier: BSD-3-Clause
// csom export as a process: the campus in every format, filters, frames, and what cannot be done.
#include <csom/exports/NavigationGrid.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/ExportRun.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::HasSubstr;

const std::string kSource = CSOM_SOURCE_DIR;

// ---- the campus ---------------------------------------------------------------------------------

class CampusExports : public testing::Test {
 protected:
  void SetUp() override {
    const ProgramResult run = runCsom(
        folder_.path(), {"map", kSource + "/rawlogs/campus.rawlog", "-c",
                         kSource + "/config/campus.ini", "-o", folder_ / "out", "--no-html"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
  }

  const TempFolder folder_;
  const std::string map_ = folder_ / "out/map.csom";
};

TEST_F(CampusExports, ReadBackTheSame) {
  expectAllFormatsReadBack(folder_.path(), map_);
}

TEST_F(CampusExports, NavigationMapsReadBackTheSame) {
  const std::vector<std::string> further{"--traversable", "road,sidewalk,terrain",
                                         "--obstacle-band", "-1,2.5"};
  exportTo(folder_.path(), map_, "nav2", folder_ / "map.yaml", further);
  exportTo(folder_.path(), map_, "gridmap", folder_ / "map.gridmap", further);
  const MapDocument document = loadMap(map_);
  NavigationOptions options;
  options.band = {-1, 2.5};
  for (const char* name : {"road", "sidewalk", "terrain"})
    options.traversable.insert(document.labels.classByName(name).value());
  const NavigationGrid grid(VoxelSelection(document.map), options);
  EXPECT_GT(grid.count(NavigationGrid::State::Free), 50000U);
  EXPECT_GT(grid.count(NavigationGrid::State::Occupied), 3000U);

  const auto served = mrpt::maps::COccupancyGridMap2D::FromROSMapServerYAML(folder_ / "map.yaml");
  mrpt::io::CFileGZInputStream stream(folder_ / "map.gridmap");
  const auto own = std::dynamic_pointer_cast<mrpt::maps::COccupancyGridMap2D>(
      mrpt::serialization::archiveFrom(stream).ReadObject());
  ASSERT_TRUE(own);
  for (const mrpt::maps::COccupancyGridMap2D& read : {served, *own}) {
    ASSERT_EQ(read.getSizeX(), static_cast<unsigned>(grid.width()));
    ASSERT_EQ(read.getSizeY(), static_cast<unsigned>(grid.height()));
    EXPECT_NEAR(read.getXMin(), grid.origin().x(), 1e-4);
    EXPECT_NEAR(read.getYMin(), grid.origin().y(), 1e-4);
    std::size_t different = 0;
    for (int y = 0; y < grid.height(); ++y)
      for (int x = 0; x < grid.width(); ++x) {
        const float free = read.getCell(x, y);
        const auto state = free > 0.9F   ? NavigationGrid::State::Free
                           : free < 0.1F ? NavigationGrid::State::Occupied
                                         : NavigationGrid::State::Unknown;
        different += state != grid.state(x, y) ? 1 : 0;
      }
    EXPECT_EQ(different, 0U);
  }
}

// What is written voxel by voxel needs less than the map's memory on top of it.
TEST_F(CampusExports, StreamThroughLittleMemory) {
  const auto peakOf = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(),
                     {"-c",
                      "import resource, subprocess, sys\n"
                      "subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)\n"
                      "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)\n",
                      CSOM_PROGRAM});
    const ProgramResult run = runProgram(folder_.path(), "/usr/bin/python3", arguments,
                                         {"ASAN_OPTIONS=quarantine_size_mb=0"});
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return std::stol(run.output) * 1024;
  };
  const long map_bytes = static_cast<long>(loadMap(map_).map.memoryBytes());
  EXPECT_GT(map_bytes, 10'000'000);
  const long loaded = peakOf({"info", map_});
  for (const char* format : {"ply", "pcd", "csv", "npz", "points"})
    EXPECT_LT(peakOf({"export", map_, "--to", format, "-o", folder_ / "written"}) - loaded,
              map_bytes)
        << format;
}

// csom query answers for one point what the distance field says of its voxel.
TEST_F(CampusExports, DistancesAreThoseOfQueries) {
  exportTo(folder_.path(), map_, "esdf", folder_ / "map.npz",
           {"--box", "20,-4,0,22,-2,1", "--classes", "pole,car", "--max-distance", "10"});
  const ProgramResult python = runProgram(
      folder_.path(), "/usr/bin/python3",
      {"-c",
       "import sys, numpy\n"
       "with numpy.load(sys.argv[1]) as a:\n"
       "    o, r, d = a['origin'], a['resolution'], a['distance']\n"
       "    print(*d.shape)\n"
       "    for z, y, x in [(0, 0, 0), (4, 9, 9), (2, 5, 1)]:\n"
       "        print(','.join(str(v) for v in o + r * numpy.array([x, y, z])), d[z, y, x])\n",
       folder_ / "map.npz"});
  ASSERT_EQ(python.exit_code, 0) << python.errors;
  std::istringstream lines(python.output);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "5 10 10");
  int checked = 0;
  while (std::getline(lines, line)) {
    const std::size_t space = line.find(' ');
    const ProgramResult query = runCsom(
        folder_.path(),
        {"query", map_, "--nearest", line.substr(0, space), "--classes", "pole,car", "--json"});
    ASSERT_EQ(query.exit_code, 0) << query.errors;
    const auto answer = nlohmann::json::parse(query.output);
    EXPECT_NEAR(answer["distance"].get<double>(), std::stod(line.substr(space + 1)), 1e-5);
    EXPECT_TRUE(answer["class_name"] == "pole" || answer["class_name"] == "car");
    ++checked;
  }
  EXPECT_EQ(checked, 3);
}

// ---- filters, frames, errors --------------------------------------------------------------------

class ExportCommand : public testing::Test {
 protected:
  void SetUp() override { saveMap(document_, map_); }

  std::size_t linesOf(const std::vector<std::string>& further) const {
    exportTo(folder_.path(), map_, "csv", folder_ / "map.csv", further);
    const std::string text = readBytes(folder_ / "map.csv");
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) - 1;
  }
  template <class Condition>
  std::size_t occupiedVoxels(Condition&& holds) const {
    std::size_t count = 0;
    document_.map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
      count += voxel.state() == VoxelState::Occupied && holds(v, voxel) ? 1 : 0;
    });
    return count;
  }

  const MapDocument document_ = sampleDocument();
  const TempFolder folder_;
  const std::string map_ = folder_ / "map.csom";
};

TEST_F(ExportCommand, Filters) {
  const std::size_t road = occupiedVoxels(
      [](const VoxelIndex&, const DirichletVoxel& v) { return v.mostLikelyClass() == 1; });
  EXPECT_GT(road, 0U);
  EXPECT_EQ(linesOf({"--classes", "road"}), road);
  EXPECT_EQ(linesOf({"--classes", "1"}), road);
  EXPECT_EQ(linesOf({"--classes", "road,2"}), linesOf({}));
  EXPECT_EQ(linesOf({"--min-probability", "0.7"}),
            occupiedVoxels([](const VoxelIndex&, const DirichletVoxel& v) {
              return v.probability(v.mostLikelyClass()) >= 0.7;
            }));
  EXPECT_EQ(
      linesOf({"--min-evidence", "1"}),
      occupiedVoxels([](const VoxelIndex&, const DirichletVoxel& v) { return v.evidence() >= 1; }));
  EXPECT_EQ(linesOf({"--box", "-100,0,-100,100,100,100"}),
            occupiedVoxels([](const VoxelIndex& i, const DirichletVoxel&) { return i.y >= 0; }));
}

TEST_F(ExportCommand, FramesMovePoints) {
  linesOf({});
  std::istringstream here(readBytes(folder_ / "map.csv"));
  linesOf({"--frame", "10,20,30,90,0,0"});
  std::istringstream there(readBytes(folder_ / "map.csv"));
  std::string a, b;
  std::getline(here, a);
  std::getline(there, b);
  while (std::getline(here, a) && std::getline(there, b)) {
    double p[3], q[3];
    ASSERT_EQ(std::sscanf(a.c_str(), "%lf,%lf,%lf", p, p + 1, p + 2), 3);
    ASSERT_EQ(std::sscanf(b.c_str(), "%lf,%lf,%lf", q, q + 1, q + 2), 3);
    EXPECT_NEAR(q[0], 10 - p[1], 1e-9);
    EXPECT_NEAR(q[1], 20 + p[0], 1e-9);
    EXPECT_NEAR(q[2], 30 + p[2], 1e-9);
  }
  EXPECT_TRUE(here.eof());
}

struct Format {
  std::string name, extension;
  std::vector<std::string> further;  ///< what the format needs besides
};

std::vector<Format> allFormats() {
  const std::vector<std::string> ground{"--traversable", "road"};
  std::vector<Format> formats{{"gridmap", "gridmap", ground},
                              {"nav2", "yaml", ground},
                              {"glb", "glb", {}},
                              {"esdf", "npz", {}}};
  for (const VoxelFormat& format : voxelFormats())
    formats.push_back({format.name, format.extension, {}});
  return formats;
}

TEST_F(ExportCommand, ImpossibleOnesSayWhyAndLeaveNothing) {
  saveMap(MapDocument{}, folder_ / "empty.csom");
  const auto before = folder_.fileNames();
  const auto expectRefusal = [&](const std::string& map, const Format& format,
                                 const std::string& file, const std::vector<std::string>& further,
                                 const std::string& why) {
    SCOPED_TRACE(format.name + " to " + file);
    std::vector<std::string> arguments{"export", map, "--to", format.name, "-o", file};
    arguments.insert(arguments.end(), format.further.begin(), format.further.end());
    arguments.insert(arguments.end(), further.begin(), further.end());
    const ProgramResult run = runCsom(folder_.path(), arguments);
    EXPECT_THAT(run.exit_code, testing::AnyOf(1, 2)) << run.errors;
    EXPECT_EQ(run.output, "");
    EXPECT_EQ(run.errorLines().size(), 1U) << run.errors;
    EXPECT_THAT(run.errors, HasSubstr(why));
    EXPECT_EQ(folder_.fileNames(), before);
  };
  for (const Format& format : allFormats()) {
    const std::string file = folder_ / ("out." + format.extension);
    expectRefusal(map_, format, file, {"--min-evidence", "1e9"}, "no voxel of the map passes");
    expectRefusal(map_, format, file, {"--classes", "lava"}, "no class 'lava'; the map has road");
    expectRefusal(map_, format, "/nowhere/out." + format.extension, {}, "cannot be written");
    expectRefusal(map_, format, "/proc/out." + format.extension, {}, "cannot be written");
    expectRefusal(map_, format, map_, {}, "");
    if (format.further.empty())
      expectRefusal(folder_ / "empty.csom", format, file, {}, "the map is empty");
  }
  expectRefusal(map_, {"obj", "", {}}, folder_ / "out.obj", {},
                "--to: no format 'obj'; there are ply, pcd, csv,");
  const std::string yaml = folder_ / "out.yaml";
  expectRefusal(map_, {"nav2", "", {}}, yaml, {}, "--traversable");
  expectRefusal(map_, {"nav2", "", {}}, yaml,
                {"--obstacle-band", "-5,5", "--min-probability", "0.999"}, "no cell would be free");
  expectRefusal(map_, {"nav2", "", {}}, folder_ / "out.pgm", {"--traversable", "road"}, ".yaml");
  expectRefusal(map_, {"octomap", "", {}}, folder_ / "out.oct", {}, ".bt");
  expectRefusal(map_, {"glb", "", {}}, folder_ / "out.glb", {"--frame", "1e8,0,0,0,0,0"}, "");
}

TEST_F(ExportCommand, WrongOptionsEndWithUsage) {
  const std::vector<std::vector<std::string>> wrong{
      {"--to", "ply", "--traversable", "road"},    {"--to", "ply", "--max-distance", "3"},
      {"--to", "esdf", "--robot-height", "3"},     {"--to", "esdf", "--max-distance", "0"},
      {"--to", "nav2", "--robot-height", "-1"},    {"--to", "nav2", "--obstacle-band", "2,1"},
      {"--to", "nav2", "--obstacle-band", "1"},    {"--to", "ply", "--box", "0,0,0,1,0,1"},
      {"--to", "ply", "--min-probability", "1.5"}, {"--to", "ply", "--min-evidence", "-1"},
      {"--to", "ply", "--frame", "1,2,3"},
  };
  for (std::vector<std::string> arguments : wrong) {
    arguments.insert(arguments.begin(), {"export", map_, "-o", folder_ / "out.yaml"});
    const ProgramResult run = runCsom(folder_.path(), arguments);
    EXPECT_EQ(run.exit_code, 2) << testing::PrintToString(arguments) << run.errors;
    EXPECT_NE(run.errors, "");
  }
  EXPECT_THAT(folder_.fileNames(), testing::ElementsAre("map.csom"));
}

}  // namespace
}  // namespace csom::test
