// SPDX-License-Identifier: BSD-3-Clause
// World files (docs/simulator.md) → Scenario.
#include <csom/core/Error.h>
#include <csom/eval/Scenario.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

#include "world/YamlReader.h"

namespace csom {
namespace {

using detail::YamlReader;
using Eigen::Vector3d;

/// A world file that asks for more is taken for a slip of the pen.
constexpr double kMaxObservations = 1e6;

constexpr double kDegree = 3.14159265358979323846 / 180;
/// A `ground` is a slab of this thickness below its surface [m].
constexpr double kGroundThickness = 0.2;

YAML::Node parseFile(const std::string& file) {
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    throw ConfigError(file + ": is no regular file");
  std::ostringstream text;
  std::ifstream stream(file);
  if (!(text << stream.rdbuf()))
    throw ConfigError(file +
                      ": cannot be read, or is empty; give a world file (see config/worlds)");
  try {
    return YAML::Load(text.str());
  } catch (const YAML::Exception& wrong) {
    throw ConfigError(file + ":" + std::to_string(wrong.mark.line + 1) +
                      ": no valid YAML: " + wrong.msg);
  }
}

// --- solids --------------------------------------------------------------------------------------

Solid readShape(YamlReader& reader) {
  const std::vector<std::string> shapes{"box", "ground", "cylinder", "sphere"};
  if (!reader.has("shape")) reader.fail("solid has no 'shape' (box, ground, cylinder, sphere)");
  const std::size_t shape = reader.choice("shape", shapes);
  const Vector3d center = reader.vector3("center");
  if (shape == 0) {
    const Vector3d size = reader.vector3("size");
    if (!(size.minCoeff() > 0)) reader.failAtKey("size", "must be above 0 along each axis");
    return Solid::box(center, size, reader.number("yaw_deg", 0) * kDegree);
  }
  if (shape == 1) {
    const std::vector<double> size = reader.numbers("size", 2);
    if (!(size[0] > 0 && size[1] > 0)) reader.failAtKey("size", "must be above 0 along each axis");
    return Solid::box(center - Vector3d(0, 0, kGroundThickness / 2),
                      {size[0], size[1], kGroundThickness}, reader.number("yaw_deg", 0) * kDegree);
  }
  const double radius = reader.above("radius", 0);
  return shape == 2 ? Solid::cylinder(center, radius, reader.above("height", 0))
                    : Solid::sphere(center, radius);
}

Color readColor(YamlReader& reader) {
  Color color{};
  const std::vector<double> values = reader.numbers("color", 3);
  for (std::size_t i = 0; i < 3; ++i) {
    if (values[i] < 0 || values[i] > 255 || values[i] != std::floor(values[i]))
      reader.failAtKey("color", "must be three whole numbers from 0 to 255: red, green, blue");
    color[i] = static_cast<std::uint8_t>(values[i]);
  }
  return color;
}

/// Lines of [seconds, metres along x, metres along y].
std::vector<TimedOffset> readMoves(YamlReader& reader) {
  std::vector<TimedOffset> places;
  for (const YAML::Node& node : reader.list("moves")) {
    const std::vector<double> values = reader.numbersOf(node, 3);
    places.push_back({values[0], {values[1], values[2]}});
    if (places.size() > 1 && places.back().time <= places[places.size() - 2].time)
      reader.failAt(node, "the times of 'moves' must ascend");
  }
  if (places.size() < 2) reader.failAtKey("moves", "must have two places at least: [s, m, m]");
  return places;
}

/// Into one of the lists.
void readSolid(const YAML::Node& node, const std::string& file, const LabelSet& labels,
               std::vector<Solid>& standing, std::vector<MovingSolid>& moving) {
  YamlReader reader(node, file, "solid");
  Solid solid = readShape(reader);
  const std::string name = reader.text("class");
  const auto id = labels.classByName(name);
  if (!id || *id == kFreeClass) {
    std::string known;
    for (const LabelClass& c : labels.classes()) {
      if (c.id != kFreeClass) known += (known.empty() ? "" : ", ") + c.name;
    }
    reader.failAtKey(
        "class", "'" + name + "' is not in label set '" + labels.name() + "', which has: " + known);
  }
  solid.class_id = *id;
  solid.color = reader.has("color") ? readColor(reader) : labels.at(*id).color;
  if (reader.has("moves"))
    moving.emplace_back(solid, readMoves(reader));
  else
    standing.push_back(solid);
  reader.finish();
}

// --- robot ---------------------------------------------------------------------------------------

RobotPath readDrive(YamlReader& reader) {
  std::vector<Eigen::Vector2d> waypoints;
  for (const YAML::Node& node : reader.list("waypoints")) {
    const std::vector<double> point = reader.numbersOf(node, 2);
    waypoints.emplace_back(point[0], point[1]);
  }
  const double speed = reader.above("speed", 0);
  return RobotPath::drive(waypoints, reader.above("turn_radius", 0), speed);
}

RobotPath readStations(YamlReader& reader) {
  std::vector<PlanarPose> poses;
  for (const YAML::Node& node : reader.list("stations")) {
    const std::vector<double> pose = reader.numbersOf(node, 3);
    poses.push_back({pose[0], pose[1], pose[2] * kDegree});
  }
  return RobotPath::stations(poses, reader.above("dwell", 0));
}

RobotPath readPath(YamlReader& reader) {
  if (reader.has("waypoints") == reader.has("stations"))
    reader.fail("robot needs either 'waypoints' (a drive) or 'stations'");
  try {
    return reader.has("waypoints") ? readDrive(reader) : readStations(reader);
  } catch (const std::invalid_argument& error) {
    reader.fail(std::string("robot: ") + error.what());
  }
}

OdometryNoise readOdometry(YamlReader reader) {
  OdometryNoise noise;
  noise.translation_per_metre = reader.atLeast("translation_per_metre", 0, 0);
  noise.translation_per_degree = reader.atLeast("translation_per_degree", 0, 0);
  noise.rotation_per_metre = reader.atLeast("rotation_per_metre", 0, 0);
  noise.rotation_per_degree = reader.atLeast("rotation_per_degree", 0, 0);
  reader.finish();
  return noise;
}

// --- sensors -------------------------------------------------------------------------------------

SensorMount readMount(YamlReader& reader, const std::string& default_label) {
  SensorMount mount;
  mount.label = reader.text("label", default_label);
  const std::vector<double> pose = reader.numbers("pose", 6);
  mount.position = {pose[0], pose[1], pose[2]};
  mount.yaw = pose[3] * kDegree;
  mount.pitch = pose[4] * kDegree;
  mount.roll = pose[5] * kDegree;
  mount.rate = reader.above("rate", 0);
  return mount;
}

/// `nearest`, `farthest`: what the sensor can report at all.
RangeModel readRange(YamlReader& reader, double nearest, double farthest) {
  RangeModel range;
  const std::vector<double> limits = reader.numbers("range", 2);
  range.min = limits[0];
  range.max = limits[1];
  if (range.min < nearest || range.max > farthest || !(range.min < range.max))
    reader.failAtKey("range", "must be [nearest, farthest] within " + std::to_string(nearest) +
                                  " … " + std::to_string(farthest) + " m");
  range.sigma = reader.atLeast("range_sigma", 0, 0);
  return range;
}

VelodyneModel readVelodyne(YamlReader& reader) {
  VelodyneModel model;
  model.mount = readMount(reader, "velodyne");
  // 65535 units of 2 mm; a distance of 0 means "no return".
  model.range = readRange(reader, 0.01, 131.0);
  model.intensity =
      static_cast<VelodyneModel::Intensity>(reader.choice("intensity", {"class", "reflectivity"}));
  model.sweep =
      static_cast<VelodyneModel::Sweep>(reader.choice("sweep", {"instantaneous", "moving"}));
  return model;
}

CameraModel readCamera(YamlReader& reader) {
  CameraModel model;
  model.mount = readMount(reader, "camera");
  model.width = static_cast<int>(reader.integer("width", 1, 8192));
  model.height = static_cast<int>(reader.integer("height", 1, 8192));
  const double fov = reader.above("horizontal_fov_deg", 0);
  if (fov >= 180) reader.failAtKey("horizontal_fov_deg", "must be below 180");
  model.horizontal_fov = fov * kDegree;
  model.max_range = reader.above("max_range", 0, model.max_range);
  return model;
}

PointSamplerModel readPointSampler(YamlReader& reader) {
  PointSamplerModel model;
  model.mount = readMount(reader, "points");
  model.range = readRange(reader, 0, 1e4);
  model.points = static_cast<int>(reader.integer("points", 1, 10'000'000));
  if (reader.has("elevation_deg")) {
    const std::vector<double> limits = reader.numbers("elevation_deg", 2);
    if (limits[0] < -90 || limits[1] > 90 || limits[0] > limits[1])
      reader.failAtKey("elevation_deg", "must be [lowest, highest] within -90 … 90");
    model.min_elevation = limits[0] * kDegree;
    model.max_elevation = limits[1] * kDegree;
  }
  return model;
}

SensorModel readSensor(const YAML::Node& node, const std::string& file) {
  YamlReader reader(node, file, "sensor");
  const std::vector<std::string> types{"velodyne_vlp16", "camera", "point_sampler"};
  if (!reader.has("type"))
    reader.fail("sensor has no 'type' (velodyne_vlp16, camera, point_sampler)");
  SensorModel model;
  switch (reader.choice("type", types)) {
    case 0:
      model = readVelodyne(reader);
      break;
    case 1:
      model = readCamera(reader);
      break;
    default:
      model = readPointSampler(reader);
  }
  reader.finish();
  return model;
}

std::vector<SensorModel> readSensors(YamlReader& reader, const std::string& file, double duration) {
  std::vector<SensorModel> sensors;
  std::set<std::string> labels;
  for (const YAML::Node& node : reader.list("sensors")) {
    sensors.push_back(readSensor(node, file));
    const std::string& label = mountOf(sensors.back()).label;
    if (!labels.insert(label).second)
      reader.failAt(node, "two sensors have the label '" + label + "'");
    if (mountOf(sensors.back()).rate * duration > kMaxObservations)
      reader.failAt(node, "sensor '" + label + "': its rate and the " + std::to_string(duration) +
                              " s of the robot's path make more than a million observations; "
                              "lower the rate or shorten the path");
  }
  return sensors;
}

TruthRegion readTruth(YamlReader reader) {
  TruthRegion truth;
  truth.resolution = reader.above("resolution", 0);
  truth.region = {reader.vector3("min"), reader.vector3("max")};
  if (truth.region.isEmpty()) reader.failAtKey("max", "must be above min along each axis");
  reader.finish();
  return truth;
}

LabelSet readLabels(YamlReader& reader, const std::string& file) {
  const std::string name = reader.text("label_set");
  const std::string folder = std::filesystem::path(file).parent_path().string();
  try {
    return LabelSet::load(LabelSet::find(name, folder));
  } catch (const ConfigError& error) {
    reader.failAtKey("label_set", std::string(": ") + error.what());
  }
}

}  // namespace

Eigen::Isometry3d SensorMount::pose() const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(position);
  pose.rotate(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) *
              Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
              Eigen::AngleAxisd(roll, Vector3d::UnitX()));
  return pose;
}

double CameraModel::focalLength() const {
  return width / 2.0 / std::tan(horizontal_fov / 2);
}

const SensorMount& mountOf(const SensorModel& sensor) {
  return std::visit([](const auto& model) -> const SensorMount& { return model.mount; }, sensor);
}

Scenario loadScenario(const std::string& file) {
  YamlReader reader(parseFile(file), file, "the world file");
  const LabelSet labels = readLabels(reader, file);
  std::vector<Solid> solids;
  std::vector<MovingSolid> moving;
  for (const YAML::Node& node : reader.list("solids"))
    readSolid(node, file, labels, solids, moving);

  YamlReader robot = reader.map("robot");
  const RobotPath path = readPath(robot);
  const OdometryNoise odometry =
      robot.has("odometry") ? readOdometry(robot.map("odometry")) : OdometryNoise{};
  robot.finish();

  const auto seed = static_cast<std::uint64_t>(
      reader.integer("seed", 0, std::numeric_limits<long long>::max(), 1));
  Scenario scenario{file,     World(labels, std::move(solids), std::move(moving)),
                    path,     readSensors(reader, file, path.duration()),
                    odometry, readTruth(reader.map("truth")),
                    seed};
  reader.finish();
  return scenario;
}

}  // namespace csom
