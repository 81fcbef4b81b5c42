// SPDX-License-Identifier: BSD-3-Clause
// The rows of clouds that do not tell them: those of the sensor, or none.
#include <csom/core/FindRangeImage.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>

namespace csom {
namespace {

using Eigen::Vector3f;

constexpr double kDegree = M_PI / 180;

/// A spinning sensor 1.8 m above the ground of a yard, with a wall and a car in it.
struct Sensor {
  std::vector<double> elevations;  ///< of the lasers, lowest first [°]
  std::vector<double> asides;      ///< of the lasers' azimuths [°]; empty: none
  std::vector<double> heights;     ///< where the lasers are mounted [m]; empty: in the middle
  int columns = 1800;
  double from = 0;  ///< [°]
  double span = 360;
  bool clockwise = false;
  double lost = 0.02;   ///< of the beams, by chance
  double noise = 0.02;  ///< of ranges [m]
};

Sensor hdl64(unsigned seed) {
  std::mt19937 random(seed);
  Sensor s;
  for (int i = 0; i < 64; ++i)
    s.elevations.push_back(i < 32 ? -24.3 + 0.5 * i : -8.3 + 0.333 * (i - 32));
  for (int i = 0; i < 64; ++i) {
    s.asides.push_back(std::uniform_real_distribution<>(-0.05, 0.05)(random));
    s.heights.push_back(i < 32 ? 0.1 : -0.05);
  }
  s.columns = 2083;
  return s;
}

Sensor evenly(int rows, double lowest, double highest, int columns) {
  Sensor s;
  for (int i = 0; i < rows; ++i)
    s.elevations.push_back(lowest + (highest - lowest) * i / (rows - 1));
  s.columns = columns;
  return s;
}

struct Cloud {
  std::vector<Vector3f> points;
  std::vector<int> row;     ///< −1: nothing came back
  std::vector<int> column;  ///< of the sensor
};

/// How far a beam goes; 0: into the sky.
double rangeOf(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  double range = 1e9;
  if (direction.z() < 0) range = (-1.8 - from.z()) / direction.z();
  if (direction.y() > 0) range = std::min(range, (6 - from.y()) / direction.y());
  const Eigen::AlignedBox3d car(Eigen::Vector3d(4, -4, -1.8), Eigen::Vector3d(8, -2, -0.3));
  double enter = 0;
  double leave = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (car.min()[axis] - from[axis]) / direction[axis];
    const double b = (car.max()[axis] - from[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > 0 && enter < leave) range = std::min(range, enter);
  return range < 80 ? range : 0;
}

/// All beams, row by row from the top, each from the seam on.
Cloud scan(const Sensor& s, unsigned seed = 1, const Eigen::Vector3d& moved = {0, 0, 0}) {
  std::mt19937 random(seed);
  std::normal_distribution<> noise(0, s.noise);
  std::bernoulli_distribution lost(s.lost);
  Cloud cloud;
  for (std::size_t row = s.elevations.size(); row-- > 0;)
    for (int column = 0; column < s.columns; ++column) {
      const double turned = s.from + s.span * (column + 0.3) / s.columns;
      const double aside = s.asides.empty() ? 0 : s.asides[row];
      const double azimuth = (s.clockwise ? -turned : turned) * kDegree + aside * kDegree;
      const double elevation = s.elevations[row] * kDegree;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d from(0, 0, s.heights.empty() ? 0 : s.heights[row]);
      const double range = rangeOf(from + moved, direction);
      const bool returned = range > 0 && !lost(random);
      const double measured = returned ? range + noise(random) : 0;
      cloud.points.push_back((returned * from + direction * measured).cast<float>());
      cloud.row.push_back(returned ? static_cast<int>(row) : -1);
      cloud.column.push_back(column);
    }
  return cloud;
}

/// The beams at `order`.
Cloud picked(const Cloud& cloud, const std::vector<std::size_t>& order) {
  Cloud out;
  for (const std::size_t i : order) {
    out.points.push_back(cloud.points[i]);
    out.row.push_back(cloud.row[i]);
    out.column.push_back(cloud.column[i]);
  }
  return out;
}

Cloud withoutLost(const Cloud& cloud) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (cloud.row[i] >= 0) kept.push_back(i);
  return picked(cloud, kept);
}

/// Column after column, as drivers of Velodynes and Ousters have it.
Cloud inFirings(const Cloud& cloud) {
  std::vector<std::size_t> order(cloud.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cloud.column[a] < cloud.column[b]; });
  return picked(cloud, order);
}

Cloud shuffled(const Cloud& cloud) {
  std::vector<std::size_t> order(cloud.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  return picked(cloud, order);
}

/// Share of the returns in rows of the sensor: those of one row are in one, and rows are in order.
double shareOfRight(const Cloud& cloud, const RangeImage& image) {
  std::map<int, std::map<int, std::size_t>> found_of;  // of each row of the sensor
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (cloud.row[i] >= 0 && image.pixels[i].row != RangeImage::kNoRow)
      ++found_of[cloud.row[i]][image.pixels[i].row];
  std::size_t right = 0;
  int before = -1;
  for (const auto& [row, found] : found_of) {
    const auto most =
        std::max_element(found.begin(), found.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most->first <= before) continue;  // two rows in one, or not in order
    before = most->first;
    right += most->second;
  }
  const auto returns =
      std::count_if(cloud.row.begin(), cloud.row.end(), [](int row) { return row >= 0; });
  return static_cast<double>(right) / static_cast<double>(returns);
}

void expectFound(const Cloud& cloud, int step, double least = 0.995) {
  const auto image = findRangeImage(cloud.points);
  ASSERT_TRUE(image);
  ASSERT_EQ(image->pixels.size(), cloud.points.size());
  EXPECT_EQ(image->columns_of_turn, 36000);
  EXPECT_NEAR(image->column_step, step, 1);
  EXPECT_GT(shareOfRight(cloud, *image), least);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const bool is_measured = cloud.points[i].allFinite() && !cloud.points[i].isZero();
    if (!is_measured) {
      EXPECT_EQ(image->pixels[i].row, RangeImage::kNoRow);
      continue;
    }
    const double azimuth = std::atan2(cloud.points[i].y(), cloud.points[i].x()) / kDegree * 100;
    EXPECT_LT(std::abs(std::remainder(azimuth - image->pixels[i].column - 0.5, 36000.0)), 0.53);
  }
}

TEST(FindRangeImage, RowAfterRowWhereverRowsBegin) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Sensor sensor = hdl64(seed);
    sensor.from = seed % 4 == 0 ? 0 : 9.0 * seed;
    sensor.clockwise = seed % 3 == 0;
    expectFound(withoutLost(scan(sensor, seed)), 17);
  }
}

TEST(FindRangeImage, RowsThatDoNotBeginAtTheSamePlace) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Sensor sensor = hdl64(seed);
    for (double& aside : sensor.asides) aside = std::uniform_real_distribution<>(-1.5, 1.5)(random);
    expectFound(withoutLost(scan(sensor, seed)), 17, 0.99);
  }
}

TEST(FindRangeImage, BeamsWithoutReturnMayBeThere) {
  Cloud cloud = scan(evenly(64, -22.5, 22.5, 2048));
  expectFound(cloud, 18);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (cloud.row[i] < 0)
      cloud.points[i] = Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  expectFound(cloud, 18);
}

TEST(FindRangeImage, AnyOrderWhereElevationsTellTheRows) {
  const Cloud vlp16 = scan(evenly(16, -15, 15, 1800));
  expectFound(vlp16, 20);
  expectFound(inFirings(vlp16), 20);
  expectFound(withoutLost(inFirings(vlp16)), 20);
  expectFound(shuffled(vlp16), 20);
  const Cloud hdl32 = scan(evenly(32, -30.67, 10.67, 2170));
  expectFound(withoutLost(inFirings(hdl32)), 16);
  const Cloud ouster = scan(evenly(128, -22.5, 22.5, 1024));
  expectFound(withoutLost(inFirings(ouster)), 35);
}

TEST(FindRangeImage, SensorsThatDoNotSeeAllAround) {
  Sensor sensor = evenly(40, -25, 15, 600);
  sensor.from = -60;
  sensor.span = 120;
  expectFound(withoutLost(scan(sensor)), 20);
}

/// A wall seen through a grid of directions, a pole before it; each line goes up, or aside. The
/// grid is turned by 20°, so that neither azimuths nor elevations tell its rows.
std::vector<Vector3f> gridOf(int rows, int columns, bool upwards) {
  std::vector<Vector3f> points;
  const int lines = upwards ? columns : rows;
  const int length = upwards ? rows : columns;
  for (int line = 0; line < lines; ++line)
    for (int i = 0; i < length; ++i) {
      const int row = upwards ? i : line;
      const int column = upwards ? line : i;
      const double aside = 0.005 * (column - 0.5 * columns);
      const double up = 0.005 * (row - 0.5 * rows);
      const double y = aside * std::cos(0.35) - up * std::sin(0.35);
      const double z = aside * std::sin(0.35) + up * std::cos(0.35);
      const double depth = std::abs(y - 0.05) < 0.015 ? 3 : 8 + y;
      points.push_back(Eigen::Vector3d(depth, depth * y, depth * z).cast<float>());
    }
  return points;
}

TEST(FindRangeImage, GridsOfDirections) {
  for (const bool upwards : {false, true})
    for (const bool lost : {false, true}) {
      std::vector<Vector3f> points = gridOf(30, 60, upwards);
      if (lost)
        for (std::size_t i = 0; i < points.size(); i += 7)  // the end of some lines among them
          points[i] = i % 2 == 0 ? Vector3f(0, 0, 0) : Vector3f(NAN, NAN, NAN);
      const auto image = findRangeImage(points);
      ASSERT_TRUE(image) << upwards << lost;
      EXPECT_EQ(image->columns_of_turn, 0);
      EXPECT_EQ(image->column_step, 1);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto line = static_cast<int>(i) / (upwards ? 30 : 60);
        const auto in_line = static_cast<int>(i) % (upwards ? 30 : 60);
        if (lost && i % 7 == 0) {
          EXPECT_EQ(image->pixels[i].row, RangeImage::kNoRow);
          continue;
        }
        EXPECT_EQ(image->pixels[i].row, upwards ? in_line : line);
        EXPECT_EQ(image->pixels[i].column, upwards ? line : in_line);
      }
    }
  std::vector<Vector3f> points = gridOf(30, 60, false);
  points[59] = points[60] = points[119] = Vector3f(0, 0, 0);
  ASSERT_TRUE(findRangeImage(points)) << "the ends of the first lines did not return";
  points.erase(points.begin() + 100);
  EXPECT_FALSE(findRangeImage(points)) << "lines of two lengths";
  EXPECT_FALSE(findRangeImage(gridOf(3, 60, false))) << "three lines";
}

TEST(FindRangeImage, NothingIsFoundInWhatIsNoScan) {
  const auto none = [](const Cloud& cloud) { return !findRangeImage(cloud.points); };
  const Cloud full = withoutLost(scan(hdl64(1)));
  EXPECT_TRUE(none(shuffled(full))) << "neither order nor elevations";

  Cloud twice = full;
  const Cloud later = withoutLost(scan(hdl64(1), 2, {1.3, 0, 0}));
  for (const Vector3f& p : later.points) twice.points.push_back(p + Vector3f(1.3F, 0, 0));
  EXPECT_TRUE(none(twice)) << "two scans from two places";
  Cloud again = full;
  again.points.insert(again.points.end(), full.points.begin(), full.points.end());
  EXPECT_TRUE(none(again)) << "the same twice";

  Cloud elsewhere = inFirings(scan(evenly(16, -15, 15, 1800)));
  for (Vector3f& p : elsewhere.points) p += Vector3f(3, 2, 1);
  EXPECT_TRUE(none(elsewhere)) << "not relative to the sensor";

  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-20, 20);
  Cloud cloud;
  for (int i = 0; i < 50000; ++i) cloud.points.emplace_back(any(random), any(random), any(random));
  EXPECT_TRUE(none(cloud));
  Cloud grid;
  for (int i = 0; i < 20 * 40 * 40; ++i)
    grid.points.push_back(
        Eigen::Vector3d(0.1 * (i % 40) - 2.03, 0.1 * (i / 40 % 40) - 1.07, 0.1 * (i / 1600) - 1.02)
            .cast<float>());
  EXPECT_TRUE(none(grid)) << "voxels of a map";
  EXPECT_TRUE(none(scan(evenly(3, -2, 2, 1800)))) << "too few rows";
  EXPECT_TRUE(none({}));
  Cloud nothing;
  nothing.points.assign(1000, Vector3f::Zero());
  EXPECT_TRUE(none(nothing));
  nothing.points.assign(1000, Vector3f(0, 0, 3));
  EXPECT_TRUE(none(nothing)) << "straight above";
  nothing.points.assign(1000, Vector3f(1e30F, 1e30F, 3));
  EXPECT_TRUE(none(nothing));
}

TEST(FindRangeImage, RowsThatAreKnownNeedNoSearch) {
  const Cloud cloud = shuffled(scan(hdl64(1)));
  std::vector<std::uint16_t> rows;
  for (const int row : cloud.row)
    rows.push_back(row < 0 ? RangeImage::kNoRow : static_cast<std::uint16_t>(row));
  const RangeImage image = makeRangeImage(cloud.points, rows);
  EXPECT_EQ(shareOfRight(cloud, image), 1);
  EXPECT_NEAR(image.column_step, 17, 1);
  rows.pop_back();
  EXPECT_THROW(makeRangeImage(cloud.points, rows), std::invalid_argument);
}

}  // namespace
}  // namespace csom
