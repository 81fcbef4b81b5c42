// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/eval/Scenario.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace csom {
namespace {

using testing::HasSubstr;

/// Line by line, so that tests can replace one and know its number.
std::vector<std::string> validLines() {
  return {"label_set: " CSOM_SOURCE_DIR "/config/labels/simulator.yaml",                      // 1
          "seed: 5",                                                                          // 2
          "truth: {resolution: 0.2, min: [-1, -2, 0], max: [1, 2, 3]}",                       // 3
          "robot:",                                                                           // 4
          "  waypoints: [[0, 0], [10, 0]]",                                                   // 5
          "  turn_radius: 1",                                                                 // 6
          "  speed: 2",                                                                       // 7
          "  odometry: {rotation_per_metre: 0.5}",                                            // 8
          "sensors:",                                                                         // 9
          "  - {type: velodyne_vlp16, pose: [0, 0, 2, 90, 0, 0], rate: 10, range: [1, 50]}",  // 10
          "  - {type: camera, pose: [0, 0, 1, 0, 0, 0], rate: 1, width: 64, height: 48,"
          " horizontal_fov_deg: 90}",                                                       // 11
          "solids:",                                                                        // 12
          "  - {shape: ground, class: road, center: [0, 0, 0], size: [9, 4]}",              // 13
          "  - {shape: box, class: car, center: [3, 3, 1], size: [4, 2, 1], yaw_deg: 30}",  // 14
          "  - {shape: sphere, class: person, center: [3, 3, 5], radius: 1, color: [1, 2, 3]}"};
}

class ScenarioFile {
 public:
  explicit ScenarioFile(const std::vector<std::string>& lines) {
    folder_ =
        std::filesystem::path(testing::TempDir()) / ("csom_scenario_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    std::ofstream out(path());
    for (const std::string& line : lines) out << line << "\n";
  }
  ~ScenarioFile() { std::filesystem::remove_all(folder_); }
  ScenarioFile(const ScenarioFile&) = delete;
  ScenarioFile& operator=(const ScenarioFile&) = delete;

  std::string path() const { return (folder_ / "world.yaml").string(); }

 private:
  std::filesystem::path folder_;
};

/// The message of the ConfigError that a file with one line replaced causes.
std::string errorWith(std::size_t line, const std::string& text) {
  std::vector<std::string> lines = validLines();
  lines.at(line - 1) = text;
  const ScenarioFile file(lines);
  try {
    loadScenario(file.path());
  } catch (const ConfigError& error) {
    const std::string message = error.what();
    EXPECT_THAT(message, HasSubstr(file.path() + ":"));
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one line";
    return message;
  }
  ADD_FAILURE() << "accepted: " << text;
  return "";
}

std::string atLine(std::size_t line) {
  return "world.yaml:" + std::to_string(line) + ": ";
}

TEST(Scenario, ReadsEverything) {
  const ScenarioFile file(validLines());
  const Scenario scenario = loadScenario(file.path());
  EXPECT_EQ(scenario.seed, 5U);
  EXPECT_EQ(scenario.truth.resolution, 0.2);
  EXPECT_EQ(scenario.truth.region.max(), Eigen::Vector3d(1, 2, 3));
  EXPECT_DOUBLE_EQ(scenario.path.duration(), 5);
  EXPECT_EQ(scenario.odometry.rotation_per_metre, 0.5);
  EXPECT_EQ(scenario.odometry.translation_per_metre, 0);

  ASSERT_EQ(scenario.sensors.size(), 2U);
  const auto& lidar = std::get<VelodyneModel>(scenario.sensors[0]);
  EXPECT_EQ(lidar.mount.label, "velodyne");
  EXPECT_NEAR(lidar.mount.yaw, 1.5707963, 1e-6);
  EXPECT_EQ(lidar.range.max, 50);
  EXPECT_EQ(lidar.intensity, VelodyneModel::Intensity::Class);
  const auto& camera = std::get<CameraModel>(scenario.sensors[1]);
  EXPECT_NEAR(camera.focalLength(), 32, 1e-9);

  ASSERT_EQ(scenario.world.solids().size(), 3U);
  EXPECT_EQ(scenario.world.classAt({0, 0, -0.05}), 1);
  EXPECT_EQ(scenario.world.classAt({0, 0, 0.01}), kFreeClass) << "a ground's surface is its top";
  EXPECT_EQ(scenario.world.solids()[2].color, (Color{1, 2, 3}));
  EXPECT_EQ(scenario.world.solids()[0].color, scenario.world.labels().at(1).color);
}

TEST(Scenario, ShippedWorldsLoad) {
  const Scenario room = loadScenario(CSOM_SOURCE_DIR "/config/worlds/room.yaml");
  EXPECT_EQ(room.sensors.size(), 1U);
  const Scenario campus = loadScenario(CSOM_SOURCE_DIR "/config/worlds/campus.yaml");
  EXPECT_EQ(campus.sensors.size(), 2U);
  EXPECT_GT(campus.path.length(), 60);
}

TEST(Scenario, ErrorsNameFileLineAndReason) {
  const std::string solid = "  - {shape: box, class: car, center: [3, 3, 1], size: [4, 2, 1]";
  const std::string lidar = "  - {type: velodyne_vlp16, pose: [0, 0, 2, 0, 0, 0], rate: 10";
  const struct {
    std::size_t line;
    std::string text;
    std::string reason;
  } cases[] = {
      {2, "seeds: 5", "unknown key 'seeds'"},
      {2, "seed: five", "whole number"},
      {2, "seed: -1", "whole number"},
      {3, "truth: {resolution: 0, min: [0, 0, 0], max: [1, 1, 1]}", "resolution = 0"},
      {3, "truth: {resolution: 0.1, min: [0, 0, 0], max: [1, -1, 1]}", "max must be above min"},
      {3, "truth: {resolution: 0.1, min: [0, 0], max: [1, 1, 1]}", "list of 3 numbers"},
      {5, "  waypoints: [[0, 0], [0, .nan]]", "must be a number"},
      {5, "  waypoints: []", "not empty"},
      {7, "  speed: fast", "not 'fast'"},
      {7, "  speed: -2", "speed = -2: must be above 0"},
      {8, "  odometry: {rotation_per_metre: -0.5}", "at least 0"},
      {8, "  odometry: {rotation: 0.5}", "unknown key 'rotation'"},
      {10, "  - {type: radar, rate: 1}", "must be one of velodyne_vlp16"},
      {10, lidar + ", range: [50, 1]}", "range must be"},
      {10, lidar + ", range: [1, 500]}", "range must be"},
      {10, lidar + ", range: [1, 50], intensity: colour}", "class, reflectivity"},
      {10, lidar + "00000, range: [1, 50]}", "million observations"},
      {13, "  - {shape: cone, class: road, center: [0, 0, 0]}", "box, ground, cylinder, sphere"},
      {13, "  - {shape: ground, class: lava, center: [0, 0, 0], size: [9, 4]}", "'lava' is not in"},
      {13, "  - {shape: ground, class: free, center: [0, 0, 0], size: [9, 4]}", "'free' is not in"},
      {13, "  - {shape: ground, center: [0, 0, 0], size: [9, 4]}", "has no 'class'"},
      {13, "  - {class: road, center: [0, 0, 0], size: [9, 4]}", "has no 'shape'"},
      {13, "  - road", "must be a map"},
      {14, solid + ", color: [256, 0, 0]}", "0 to 255"},
      {14, solid + ", size: [1, 1, 1]}", "'size' stands twice"},
      {14, solid + ", radius: 1}", "unknown key 'radius'"},
      {14, solid + ", moves: [[0, 1, 1]]}", "two places at least"},
      {14, solid + ", moves: [[0, 1, 1], [0, 2, 2]]}", "must ascend"},
      {14, solid + ", moves: [[0, 1, 1], [1, 2]]}", "list of 3 numbers"},
      {14, solid + ", moves: [[0, 1, 1], [1, 2, .inf]]}", "must be a number"},
      {14, "  - {shape: box, class: car, center: [3, 3, 1], size: [4, 0, 1]}", "above 0"},
      {14, "  - {shape: cylinder, class: car, center: [3, 3, 1], radius: 1}", "has no 'height'"},
  };
  for (const auto& c : cases) {
    const std::string message = errorWith(c.line, c.text);
    EXPECT_THAT(message, HasSubstr(atLine(c.line)));
    EXPECT_THAT(message, HasSubstr(c.reason));
  }
}

TEST(Scenario, SolidsMayMove) {
  std::vector<std::string> lines = validLines();
  lines.push_back(
      "  - {shape: cylinder, class: person, center: [1, 2, 0.9], radius: 0.3, height: 1.8, moves: "
      "[[2, 0, 0], [5, 0, 4.5]]}");
  const ScenarioFile file(lines);
  const World world = loadScenario(file.path()).world;
  EXPECT_EQ(world.solids().size(), 3U);
  ASSERT_EQ(world.movingSolids().size(), 1U);
  EXPECT_EQ(world.movingSolids()[0].solid().center(), Eigen::Vector3d(1, 2, 0.9));
  EXPECT_EQ(world.movingSolids()[0].offsetAt(4), Eigen::Vector3d(0, 3, 0));
}

TEST(Scenario, PathThatCannotBeDrivenNamesTheWaypoints) {
  const std::string message = errorWith(5, "  waypoints: [[0, 0], [1, 0], [1, 0.5]]");
  EXPECT_THAT(message, HasSubstr("between waypoints 2 and 3"));
  EXPECT_THAT(errorWith(5, "  stations: [[0, 0, 0]]"), HasSubstr("dwell"));
}

TEST(Scenario, TwoSensorsOfOneLabelAreRefused) {
  EXPECT_THAT(errorWith(10,
                        "  - {type: camera, pose: [0, 0, 1, 0, 0, 0], rate: 1, width: 6, "
                        "height: 4, horizontal_fov_deg: 90}"),
              HasSubstr("two sensors have the label 'camera'"));
}

TEST(Scenario, FileThatIsNoYamlOrNotThere) {
  EXPECT_THAT(errorWith(3, "truth: {resolution: 0.1"), HasSubstr("YAML"));
  EXPECT_THAT(errorWith(1, "label_set: no-such-set"), HasSubstr("no-such-set"));
  EXPECT_THROW(loadScenario("/no/such/world.yaml"), ConfigError);
  EXPECT_THROW(loadScenario(testing::TempDir()), ConfigError) << "a folder";
  EXPECT_THROW(loadScenario(ScenarioFile({}).path()), ConfigError) << "empty";
  EXPECT_THROW(loadScenario(ScenarioFile({"# nothing"}).path()), ConfigError);
  EXPECT_THROW(loadScenario(ScenarioFile({"[1, 2]"}).path()), ConfigError);
}

}  // namespace
}  // namespace csom
