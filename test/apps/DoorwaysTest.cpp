// SPDX-License-Identifier: BSD-3-Clause
// What navigation maps are for: a planner of its own finds its way through the doorways of
// config/worlds/doorways.yaml, and through no wall.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <queue>
#include <sstream>

#include "apps/RunCsom.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

/// A position on the floor [m].
struct Place {
  double x, y;
};

/// Reads what map_server reads, and nothing else.
class ServedMap {
 public:
  explicit ServedMap(const std::string& yaml) {
    std::map<std::string, std::string> values;
    std::istringstream lines(readBytes(yaml));
    for (std::string line; std::getline(lines, line);) {
      const std::size_t colon = line.find(": ");
      values[line.substr(0, colon)] = line.substr(colon + 2);
    }
    resolution_ = std::stod(values.at("resolution"));
    double yaw = 1;
    EXPECT_EQ(
        std::sscanf(values.at("origin").c_str(), "[%lf, %lf, %lf]", &origin_.x, &origin_.y, &yaw),
        3);
    EXPECT_EQ(yaw, 0);
    EXPECT_EQ(values.at("negate"), "0");
    const double occupied = std::stod(values.at("occupied_thresh"));
    const double free = std::stod(values.at("free_thresh"));

    std::string image = values.at("image");
    image = image.substr(1, image.size() - 2);
    std::istringstream pgm(readBytes((std::filesystem::path(yaml).parent_path() / image).string()));
    std::string magic;
    int highest = 0;
    pgm >> magic >> width_ >> height_ >> highest;
    EXPECT_EQ(magic, "P5");
    EXPECT_EQ(highest, 255);
    pgm.get();
    cells_.resize(static_cast<std::size_t>(width_ * height_));
    for (int row = height_ - 1; row >= 0; --row)
      for (int x = 0; x < width_; ++x) {
        const double darkness = (255 - pgm.get()) / 255.0;
        at(x, row) = darkness > occupied ? 'o' : darkness < free ? 'f' : 'u';
      }
    EXPECT_TRUE(pgm.good());
  }

  int width() const { return width_; }
  int height() const { return height_; }
  double resolution() const { return resolution_; }
  bool inside(int x, int y) const { return x >= 0 && x < width_ && y >= 0 && y < height_; }
  bool isFree(int x, int y) const { return inside(x, y) && at(x, y) == 'f'; }
  bool isOccupied(int x, int y) const { return inside(x, y) && at(x, y) == 'o'; }
  int columnOf(double x) const {
    return static_cast<int>(std::floor((x - origin_.x) / resolution_));
  }
  int rowOf(double y) const { return static_cast<int>(std::floor((y - origin_.y) / resolution_)); }
  Place center(int x, int y) const {
    return {origin_.x + (x + 0.5) * resolution_, origin_.y + (y + 0.5) * resolution_};
  }
  std::size_t occupiedCells() const {
    return static_cast<std::size_t>(std::count(cells_.begin(), cells_.end(), 'o'));
  }

  /// Makes the cells of a box impassable.
  void close(const Place& min, const Place& max) {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const Place c = center(x, y);
        if (c.x > min.x && c.x < max.x && c.y > min.y && c.y < max.y) at(x, y) = 'o';
      }
  }

 private:
  char& at(int x, int y) { return cells_[static_cast<std::size_t>(y * width_ + x)]; }
  char at(int x, int y) const { return cells_[static_cast<std::size_t>(y * width_ + x)]; }

  int width_ = 0, height_ = 0;
  double resolution_ = 0;
  Place origin_{};
  std::vector<char> cells_;
};

/// A* for a round robot on the centres of cells, four steps from each: none squeezes through
/// between two cells that touch at a corner. The robot may touch nothing but free cells.
class Planner {
 public:
  Planner(const ServedMap& map, double radius) : map_(map) {
    const int reach = static_cast<int>(std::ceil(radius / map.resolution()));
    for (int y = 0; y < map.height(); ++y)
      for (int x = 0; x < map.width(); ++x) fits_.push_back(fits(x, y, radius, reach) ? 1 : 0);
  }

  bool finds(const Place& from, const Place& to) const {
    const int start = cellOf(from), goal = cellOf(to);
    if (fits_[static_cast<std::size_t>(start)] == 0 || fits_[static_cast<std::size_t>(goal)] == 0)
      return false;
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    std::vector<double> cost(fits_.size(), INFINITY);
    const auto push = [&](int cell, double new_cost) {
      if (new_cost >= cost[static_cast<std::size_t>(cell)]) return;
      cost[static_cast<std::size_t>(cell)] = new_cost;
      open.emplace(new_cost + distance(cell, goal), cell);
    };
    push(start, 0);
    while (!open.empty()) {
      const int cell = open.top().second;
      open.pop();
      if (cell == goal) return true;
      const int x = cell % map_.width(), y = cell / map_.width();
      const double next = cost[static_cast<std::size_t>(cell)] + 1;
      for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
        if (map_.inside(x + dx, y + dy) && fitsAt(x + dx, y + dy))
          push(cell + dy * map_.width() + dx, next);
    }
    return false;
  }

 private:
  bool fits(int x, int y, double radius, int reach) const {
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        const double nearest =
            std::hypot(std::max(0.0, std::abs(dx) - 0.5), std::max(0.0, std::abs(dy) - 0.5)) *
            map_.resolution();
        if ((nearest == 0 || nearest < radius - 1e-9) && !map_.isFree(x + dx, y + dy)) return false;
      }
    return true;
  }
  bool fitsAt(int x, int y) const {
    return fits_[static_cast<std::size_t>(y * map_.width() + x)] != 0;
  }
  int cellOf(const Place& p) const { return map_.rowOf(p.y) * map_.width() + map_.columnOf(p.x); }
  double distance(int a, int b) const {
    return std::hypot(a % map_.width() - b % map_.width(), a / map_.width() - b / map_.width());
  }

  const ServedMap& map_;
  std::vector<char> fits_;
};

/// The rooms and the doorways of the world.
const std::map<std::string, Place> kRooms{{"southwest", {-3, -1.5}},
                                          {"southeast", {3, -1.5}},
                                          {"northwest", {-1, 1.5}},
                                          {"northeast", {1.5, 1.5}}};
struct Doorway {
  std::string from, to;
  Place min, max;  ///< of the opening, and the whole thickness of the wall
};
const std::vector<Doorway> kDoorways{{"southwest",
                                      "southeast",
                                      {
                                          -0.1,
                                          -2,
                                      },
                                      {0.2, -1}},
                                     {"southwest", "northwest", {-3, -0.1}, {-2, 0.2}},
                                     {"southeast", "northeast", {2, -0.1}, {3, 0.2}}};
constexpr double kRobotRadius = 0.3;

class Doorways : public testing::Test {
 protected:
  void SetUp() override {
    run({"simulate", std::string(CSOM_SOURCE_DIR) + "/config/worlds/doorways.yaml", "-o",
         folder_ / "drive.rawlog", "--truth", folder_ / "truth.csom"});
  }
  void run(const std::vector<std::string>& arguments) const {
    const ProgramResult result = runCsom(folder_.path(), arguments);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }
  ServedMap served(const std::string& map) const {
    run({"export", map, "--to", "nav2", "--traversable", "floor", "--robot-height", "1.5", "-o",
         folder_ / "nav.yaml"});
    return ServedMap(folder_ / "nav.yaml");
  }
  ServedMap mappedBy(const std::string& method) const {
    const std::string section = "_00_insertOpts]\n";
    std::string config = readBytes(std::string(CSOM_SOURCE_DIR) + "/config/room.ini");
    config.insert(config.find(section) + section.size(), "method = " + method + "\n");
    writeBytes(folder_ / "room.ini", config);
    run({"map", folder_ / "drive.rawlog", "-c", folder_ / "room.ini", "-o", folder_ / "out",
         "--no-html"});
    return served(folder_ / "out/map.csom");
  }

  /// Doorways that the robot gets through, all others being closed.
  static std::size_t passable(const ServedMap& map) {
    std::size_t count = 0;
    for (const Doorway& doorway : kDoorways) {
      ServedMap only = map;
      for (const Doorway& other : kDoorways)
        if (&other != &doorway) only.close(other.min, other.max);
      count += Planner(only, kRobotRadius).finds(kRooms.at(doorway.from), kRooms.at(doorway.to));
    }
    return count;
  }

  /// Cells across the opening that are free through the whole thickness of the wall, summed over
  /// the doorways.
  static int clearCells(const ServedMap& map) {
    int clear = 0;
    for (const Doorway& d : kDoorways) {
      const int x0 = map.columnOf(d.min.x + 0.01), x1 = map.columnOf(d.max.x - 0.01);
      const int y0 = map.rowOf(d.min.y + 0.01), y1 = map.rowOf(d.max.y - 0.01);
      const bool along_x = x1 - x0 > y1 - y0;
      for (int i = along_x ? x0 : y0; i <= (along_x ? x1 : y1); ++i) {
        bool free = true;
        for (int j = along_x ? y0 : x0; j <= (along_x ? y1 : x1); ++j)
          free = free && (along_x ? map.isFree(i, j) : map.isFree(j, i));
        clear += free ? 1 : 0;
      }
    }
    return clear;
  }

  /// Even a robot without extent must not find a way when the doorways are closed.
  static void expectWallsAreTight(ServedMap map) {
    for (const Doorway& d : kDoorways) map.close(d.min, d.max);
    const Planner planner(map, 0);
    for (const auto& [from, start] : kRooms)
      for (const auto& [to, goal] : kRooms)
        EXPECT_EQ(planner.finds(start, goal), from == to) << from << " to " << to;
  }

  TempFolder folder_;
};

TEST_F(Doorways, OfTheTruthAreOpen) {
  const ServedMap map = served(folder_ / "truth.csom");
  EXPECT_EQ(passable(map), 3U);
  EXPECT_EQ(clearCells(map), 3 * 8);
  expectWallsAreTight(map);
}

TEST_F(Doorways, AreOpenToARobotWithASharpMap) {
  const ServedMap map = mappedBy("surface-csom");
  EXPECT_EQ(passable(map), 3U);
  EXPECT_GE(clearCells(map), 3 * 8 - 1);
  expectWallsAreTight(map);
}

// The overinflation of which docs/exports.md gives the figures.
TEST_F(Doorways, AreNarrowedByAFixedKernel) {
  const std::size_t truth = served(folder_ / "truth.csom").occupiedCells();
  const ServedMap map = mappedBy("s-bki");
  EXPECT_LE(passable(map), 1U);
  EXPECT_LE(clearCells(map), 3 * 8 - 4);
  EXPECT_GT(map.occupiedCells(), 2 * truth);
  EXPECT_LT(mappedBy("surface-csom").occupiedCells(), truth * 5 / 4);
  expectWallsAreTight(map);
}

}  // namespace
}  // namespace csom::test
