// SPDX-License-Identifier: BSD-3-Clause
// Localisation by meaning: MRPT's pf-localization in rooms that differ in nothing but classes.
//
// A filter that cannot tell the rooms apart keeps several of them, and the mean of its particles
// lies between them. So it is judged by the room that holds the most weight, and the mean inside of
// that room.
//
// CSOM_LOCALISATION_RUNS=40 makes as many runs with labels and without; five are usual.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/RunMrpt.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

const std::string kConfigs = CSOM_SOURCE_DIR "/config/mrpt/";
constexpr int kRooms = 5;
constexpr double kRoomPitch = 6.4;  // along x [m]; the first room is around x = 0
constexpr int kFirstSeed = 10000;

int numberOfRuns() {
  const char* const asked = std::getenv("CSOM_LOCALISATION_RUNS");
  return asked == nullptr ? kRooms : std::stoi(asked);
}

/// Replaces `from`, which must be there.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("not found: " + from);
  return text.replace(at, from.size(), to);
}

/// Where the particles are in the end.
struct Belief {
  int room = 0;                                    ///< that with the most weight
  double share = 0;                                ///< of all weight
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  ///< of the particles in it
};

/// Reads particles as pf-localization writes them: x, y, yaw and log-weight.
Belief beliefOf(const std::string& file) {
  std::ifstream particles(file);
  std::string comment;
  std::getline(particles, comment);
  std::vector<double> weights(kRooms);
  std::vector<Eigen::Vector2d> sums(kRooms, Eigen::Vector2d::Zero());
  double yaw = 0;
  double log_weight = 0;
  for (Eigen::Vector2d at; particles >> at.x() >> at.y() >> yaw >> log_weight;) {
    const double number = std::floor(at.x() / kRoomPitch + 0.5);
    const auto room = static_cast<std::size_t>(std::clamp(number, 0.0, kRooms - 1.0));
    weights[room] += std::exp(log_weight);
    sums[room] += std::exp(log_weight) * at;
  }
  const auto most = std::max_element(weights.begin(), weights.end());
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(all > 0)) throw std::runtime_error("no particles in " + file);
  const auto room = most - weights.begin();
  return {static_cast<int>(room), *most / all, sums[static_cast<std::size_t>(room)] / *most};
}

class Localisation : public testing::Test {
 protected:
  /// The rooms, mapped from two places in each.
  void SetUp() override {
    writeBytes(folder_ / "rooms-world.yaml", readBytes(kConfigs + "rooms-world.yaml"));
    succeed({"simulate", "rooms-world.yaml", "-o", "rooms.rawlog"});
    succeed({"map", "rooms.rawlog", "-c", kConfigs + "pf-localization.ini", "-o", "rooms",
             "--no-html", "--write-simplemap", "rooms.simplemap"});
  }

  /// How many of the runs end in the right place, each in another room than the one before.
  int successes(double semantic_weight) {
    int count = 0;
    int elsewhere = 0;  // at the right place of a wrong room
    for (int run = 0; run < numberOfRuns(); ++run) {
      const Drive truth = drive(run);
      const Belief belief = localise(semantic_weight, truth);
      const int room = run % kRooms;
      const Eigen::Vector2d in_that_room(kRoomPitch * (belief.room - room), 0);
      const double error = (belief.mean - in_that_room - truth.end).norm();
      std::cout << "weight " << semantic_weight << ", run " << run << ": in room " << room
                << ", believes " << belief.room << " by " << belief.share << ", " << error
                << " m from the place in it\n";
      if (error > 0.5) continue;
      ++(belief.room == room ? count : elsewhere);
    }
    std::cout << count << " of " << numberOfRuns() << " runs found the true room and the place in "
              << "it, " << elsewhere << " the place in another room\n";
    return count;
  }

 private:
  std::string succeed(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"-C", folder_.path(), CSOM_PROGRAM};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramResult result = runProgram(folder_.path(), "env", all);
    if (result.exit_code != 0) throw std::runtime_error(result.errors);
    return result.output;
  }

  struct Drive {
    int frames = 0;
    Eigen::Vector2d end;
  };

  /// Simulates a drive through one of the rooms.
  Drive drive(int run) {
    const double x = kRoomPitch * (run % kRooms);
    const auto at = [&](double dx, double y) {
      return "[" + std::to_string(x + dx) + ", " + std::to_string(y) + "]";
    };
    std::string world = readBytes(kConfigs + "rooms-world.yaml");
    const std::size_t stations = world.find("  stations:");
    const std::size_t odometry = world.find("  odometry:");
    world.replace(stations, odometry - stations,
                  "  waypoints: [" + at(-1, -0.8) + ", " + at(1.8, -0.8) + ", " + at(1.8, 1.2) +
                      ", " + at(-1, 1.2) + ", " + at(-1, -0.2) +
                      "]\n  turn_radius: 0.3\n  speed: 0.4\n");
    writeBytes(folder_ / "drive.yaml", replaced(world, "rate: 2", "rate: 1"));
    // The ini was tuned on drives of other seeds.
    const std::string summary =
        succeed({"simulate", "drive.yaml", "-o", "drive.rawlog", "--seed",
                 std::to_string(kFirstSeed + run), "--trajectory", "drive.tum", "--json"});
    Drive drive;
    drive.frames = nlohmann::json::parse(summary).at("frames");
    std::ifstream poses(folder_ / "drive.tum");
    for (std::string line; std::getline(poses, line);) {
      std::istringstream numbers(line);
      double time = 0;
      numbers >> time >> drive.end.x() >> drive.end.y();
    }
    return drive;
  }

  Belief localise(double semantic_weight, const Drive& drive) {
    std::string ini =
        replaced(readBytes(kConfigs + "pf-localization.ini"), "\nsemantic_weight = 5\n",
                 "\nsemantic_weight = " + std::to_string(semantic_weight) + "\n");
    // Particles are written together with scenes: at the last frame.
    ini = replaced(ini, "3DSceneFrequency = -1",
                   "3DSceneFrequency = " + std::to_string(drive.frames));
    writeBytes(folder_ / "pf.ini", ini);
    const ProgramResult result =
        runMrpt(folder_.path(), {"pf-localization", "pf.ini", "drive.rawlog"});
    if (result.exit_code != 0) throw std::runtime_error(result.output + result.errors);
    std::string number = std::to_string(drive.frames - 1);
    number.insert(0, 5 - number.size(), '0');
    return beliefOf(folder_ / ("LOCALIZATION_000_0020000/particles/particles_" + number + ".txt"));
  }

  const TempFolder folder_;
};

/// The largest number of successes of runs that choose a room at random which 99.9 % of such
/// experiments do not exceed.
int chanceLimit(int runs) {
  const double p = 1.0 / kRooms;
  double probability = std::pow(1 - p, runs);
  double sum = probability;
  int successes = 0;
  while (sum < 0.999) {
    probability *= p / (1 - p) * (runs - successes) / (successes + 1);
    ++successes;
    sum += probability;
  }
  return successes;
}

TEST_F(Localisation, LabelsTellRoomsOfTheSameShapeApart) {
  EXPECT_GE(successes(5), static_cast<int>(std::ceil(0.95 * numberOfRuns())));
}

TEST_F(Localisation, WithoutLabelsItIsChance) {
  EXPECT_LE(successes(0), chanceLimit(numberOfRuns()));
}

}  // namespace
}  // namespace csom::test
