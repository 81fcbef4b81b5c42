// SPDX-License-Identifier: BSD-3-Clause
// csom-bench-replay: whether a map keeps up with its sensor while a network works beside it.
// A scan comes every 0.1 s, those of csom-bench in turn, the drive going on and on. Of each its
// rows are found and it is inserted by the default method with free space to 50 m, on all
// processors. Its latency is the time from when it comes to when the map has it; it is late if the
// next one has come by then. The clock starts behind the first scan, whose time is told apart: a
// process touches its memory for the first time with it. The network labels the image over and
// over, with what processor time is left. Prints JSON.
#include <csom/core/SemanticMap.h>
#include <csom/vision/SegmentationNetwork.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <future>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "MapOptions.h"
#include "Scans.h"

namespace {

using namespace csom::bench;
using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr std::chrono::milliseconds kPeriod{100};

struct Arguments {
  bool quick = false;
  double seconds = 60;
  std::string network, model, image;
};

void declare(CLI::App& app, Arguments& arguments) {
  app.add_flag("--quick", arguments.quick, "Half a second of a small part of the campus");
  app.add_option("--seconds", arguments.seconds, "How long scans come")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  CLI::Option* network =
      app.add_option("--network", arguments.network, "Description of a network that works beside");
  CLI::Option* image = app.add_option("--image", arguments.image, "What it labels");
  app.add_option("--model", arguments.model, "In place of the model of the description")
      ->needs(network);
  network->needs(image);
  image->needs(network);
}

/// Labels one image again and again in a thread of the lowest priority.
class NetworkBeside {
 public:
  /// Throws what the network throws.
  NetworkBeside(const csom::NetworkDescription& description, const cv::Mat& image) {
    std::promise<void> loaded;
    auto is_loaded = loaded.get_future();
    finished_ = std::async(std::launch::async,
                           [this, description, image, loaded = std::move(loaded)]() mutable {
                             run(description, image, loaded);
                           });
    is_loaded.get();
  }
  ~NetworkBeside() { end_ = true; }  // `finished_` waits

  std::size_t images() const { return images_; }
  /// Throws what the network threw since.
  void finish() {
    end_ = true;
    finished_.get();
  }

 private:
  void run(const csom::NetworkDescription& description, const cv::Mat& image,
           std::promise<void>& loaded) {
    // Of this thread, and of those that OpenCV starts from it.
    constexpr int kLowest = 19;
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLowest);
    const auto class_of = [](std::uint32_t) { return csom::kFreeClass; };  // not looked at
    std::unique_ptr<csom::SegmentationNetwork> network;
    try {
      network = std::make_unique<csom::SegmentationNetwork>(description);
      network->segment({image}, class_of);
    } catch (...) {
      loaded.set_exception(std::current_exception());
      return;
    }
    loaded.set_value();
    for (; !end_; ++images_) network->segment({image}, class_of);
  }

  std::atomic<bool> end_{false};
  std::atomic<std::size_t> images_{0};
  std::future<void> finished_;
};

/// Null if none is asked for.
std::unique_ptr<NetworkBeside> startNetwork(const Arguments& arguments) {
  if (arguments.network.empty()) return nullptr;
  const cv::Mat image = cv::imread(arguments.image);
  if (image.empty()) throw std::runtime_error(arguments.image + ": is no image");
  return std::make_unique<NetworkBeside>(
      csom::NetworkDescription::load(arguments.network, arguments.model), image);
}

/// What the sensor would send: points in its frame, where it was.
class EndlessDrive {
 public:
  explicit EndlessDrive(const Drive& drive) {
    for (std::size_t i = 0; i < drive.scans; ++i) scans_.push_back(drive.scan(i));
    const Eigen::Vector3d driven =
        scans_.back().pose.translation() - scans_.front().pose.translation();
    const auto steps = static_cast<double>(std::max<std::size_t>(scans_.size() - 1, 1));
    lap_ = driven * static_cast<double>(scans_.size()) / steps;
  }
  SensorScan scan(std::size_t i) const {
    SensorScan scan = scans_[i % scans_.size()];
    scan.pose.pretranslate(static_cast<double>(i / scans_.size()) * lap_);
    return scan;
  }

 private:
  std::vector<SensorScan> scans_;
  Eigen::Vector3d lap_;
};

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Tells whether a map keeps up with its sensor");
  Arguments arguments;
  declare(app, arguments);
  CLI11_PARSE(app, argc, argv);
  if (arguments.quick) arguments.seconds = 0.5;
  const EndlessDrive drive(chooseDrive(arguments.quick));
  csom::Options options = mapOptions();
  options.method = csom::Options{}.method;
  options.free_space.mode = csom::FreeSpace::Projective;
  options.scan.max_range = 50;
  options.threads = 0;
  csom::SemanticMap map(options);
  const auto network = startNetwork(arguments);

  const auto insert = [&](SensorScan scan) {
    findImage(scan);
    map.insert(inMap(scan));
  };
  const Clock::time_point before_first = Clock::now();
  insert(drive.scan(0));
  const double first = Milliseconds(Clock::now() - before_first).count();

  std::vector<double> latencies;
  const std::size_t images_before = network ? network->images() : 0;
  const Clock::time_point start = Clock::now();
  Clock::time_point comes = start;
  for (std::size_t i = 1; Milliseconds(comes - start).count() < 1e3 * arguments.seconds; ++i) {
    SensorScan scan = drive.scan(i);
    std::this_thread::sleep_until(comes);
    insert(std::move(scan));
    latencies.push_back(Milliseconds(Clock::now() - comes).count());
    comes += kPeriod;
  }
  const double seconds = Milliseconds(Clock::now() - start).count() / 1e3;
  const std::size_t images = (network ? network->images() : 0) - images_before;
  if (network) network->finish();
  std::sort(latencies.begin(), latencies.end());
  const auto late = latencies.end() - std::upper_bound(latencies.begin(), latencies.end(),
                                                       Milliseconds(kPeriod).count());
  std::printf(
      "{\"scans\": %zu, \"late\": %td, \"latency_ms\": {\"median\": %.1f, \"p90\": %.1f, \"p99\": "
      "%.1f, \"max\": %.1f}, \"first_ms\": %.1f, \"images_per_second\": %.2f, \"known_voxels\": "
      "%zu, \"map_mb\": %.1f}\n",
      latencies.size(), late, quantile(latencies, 0.5), quantile(latencies, 0.9),
      quantile(latencies, 0.99), latencies.back(), first, static_cast<double>(images) / seconds,
      map.knownVoxelCount(), static_cast<double>(map.memoryBytes()) / 1e6);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "csom-bench-replay: %s\n", error.what());
  return 1;
}
