// SPDX-License-Identifier: BSD-3-Clause
// Localisation by meaning: MRPT's pf-localization in rooms that differ in nothing but classes.
//
// CSOM_LOCALISATION_RUNS=40 makes as many runs with labels and without; five are usual.

#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <regex>

#include "apps/RunCsom.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

const std::string kConfigs = CSOM_SOURCE_DIR "/config/mrpt/";
constexpr int kRooms = 5;
constexpr double kRoomPitch = 6.4;  // along x [m]

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

/// What pf-localization prints last: mean of the particles, and how far they are spread.
struct Estimate {
  double x = 0;
  double y = 0;
  double spread = 0;
};

class Localisation : public ::testing::Test {
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
    for (int run = 0; run < numberOfRuns(); ++run) {
      const Eigen::Vector2d truth = drive(run);
      const Estimate estimate = localise(semantic_weight);
      const double error = std::hypot(estimate.x - truth.x(), estimate.y - truth.y());
      const bool converged = error < 0.5 && estimate.spread < 0.5;
      std::cout << "weight " << semantic_weight << ", run " << run << ", room " << run % kRooms
                << ": error " << error << " m, spread " << estimate.spread << " m\n";
      if (converged) ++count;
    }
    std::cout << count << " of " << numberOfRuns() << " runs converged to the true place\n";
    return count;
  }

 private:
  void succeed(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"-C", folder_.path(), CSOM_PROGRAM};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramResult result = runProgram(folder_.path(), "env", all);
    if (result.exit_code != 0) throw std::runtime_error(result.errors);
  }

  /// Simulates a drive through one of the rooms; returns where it ends.
  Eigen::Vector2d drive(int run) {
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
    succeed({"simulate", "drive.yaml", "-o", "drive.rawlog", "--seed", std::to_string(100 + run),
             "--trajectory", "drive.tum"});
    std::ifstream poses(folder_ / "drive.tum");
    Eigen::Vector2d last = Eigen::Vector2d::Zero();
    for (std::string line; std::getline(poses, line);) {
      std::istringstream numbers(line);
      double time = 0;
      numbers >> time >> last.x() >> last.y();
    }
    return last;
  }

  Estimate localise(double semantic_weight) {
    const std::string ini =
        replaced(readBytes(kConfigs + "pf-localization.ini"), "\nsemantic_weight = 5\n",
                 "\nsemantic_weight = " + std::to_string(semantic_weight) + "\n");
    writeBytes(folder_ / "pf.ini", ini);
    const ProgramResult result = runProgram(
        folder_.path(), "env",
        {"-C", folder_.path(), "timeout", "120", "pf-localization", "pf.ini", "drive.rawlog"},
        {"LD_PRELOAD=" CSOM_PLUGIN});
    if (result.exit_code != 0) throw std::runtime_error(result.output + result.errors);
    const std::regex line(
        R"(PDF estimation: \(([-\d.]+),([-\d.]+),[-\d.]+deg\).*tr\(cov\): ([-\d.e+]+))");
    Estimate last;
    int lines = 0;
    for (std::sregex_iterator it(result.output.begin(), result.output.end(), line), end; it != end;
         ++it, ++lines)
      last = {std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3])};
    if (lines < 15) throw std::runtime_error("it stopped too early: " + result.output);
    return last;
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

TEST_F(Localisation, labelsTellRoomsOfTheSameShapeApart) {
  EXPECT_GE(successes(5), static_cast<int>(std::ceil(0.95 * numberOfRuns())));
}

TEST_F(Localisation, withoutLabelsItIsChance) {
  EXPECT_LE(successes(0), chanceLimit(numberOfRuns()));
}

}  // namespace
}  // namespace csom::test
