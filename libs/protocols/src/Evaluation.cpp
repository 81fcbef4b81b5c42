// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/protocols/Evaluation.h>
#include <csom/protocols/RoomProtocols.h>
#include <csom/protocols/SimulatedProtocols.h>
#include <csom/protocols/StreetProtocol.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

namespace csom {
namespace {

namespace fs = std::filesystem;

constexpr double kRoomResolution = 0.05;
constexpr double kRoomDensity = 0.10;  // where a protocol has only one
constexpr double kStreetResolution = 0.3;
constexpr double kStreetDensity = 0.2;
constexpr std::size_t kStreetEvery = 2;

/// A method on a trial.
struct Run {
  Trial trial;
  MethodSpec method;
};

/// The room or street of a data folder: itself, or the one of the usual name in it.
std::string folderOf(const std::string& data, bool (*is_it)(const std::string&), const char* name) {
  if (data.empty()) throw FileError(name, "no folder of data is given", {"data"});
  for (const fs::path& folder : {fs::path(data), fs::path(data) / name})
    if (is_it(folder.string())) return folder.string();
  throw FileError(data, std::string("is no such data, and neither is ") + name + " in it");
}

/// Worlds are installed beside the label sets.
std::string worldFile(const std::string& given, const char* name) {
  if (!given.empty()) return given;
  const fs::path labels = LabelSet::find("simulator");
  const fs::path file = labels.parent_path().parent_path() / "worlds" / name;
  if (!fs::exists(file)) throw ConfigError(file.string() + ": no such world; name one", {"world"});
  return file.lexically_normal().string();
}

LabelSet labelSet(const char* name) {
  return LabelSet::load(LabelSet::find(name));
}

std::vector<MethodSpec> parameterStudyMethods() {
  std::vector<MethodSpec> methods;
  for (const char* depth : {"1", "2", "3", "4"})
    for (const char* threshold : {"0.05", "0.1", "0.2", "0.4", "0.6", "0.8"})
      methods.push_back(MethodSpec::parse(std::string("see-csom:block_depth=") + depth +
                                          ":context_threshold=" + threshold));
  return methods;
}

/// Reads inputs once, however many protocols use them.
class Inputs {
 public:
  Inputs(const EvaluationRequest& request, Evaluation& evaluation)
      : request_(request), evaluation_(evaluation) {}

  std::vector<Trial> makeTrials(const std::string& protocol) {
    std::vector<Trial> trials;
    if (protocol == "P1") trials = roomDensityTrials(room(protocol), densities(), kRoomResolution);
    if (protocol == "P2")
      trials = roomObjectTrials(room(protocol), {0.05, kRoomDensity}, kRoomResolution);
    if (protocol == "P3") {
      trials = streetTrials(street(protocol), kStreetEvery, kStreetDensity, kStreetResolution);
      evaluation_.predictions = scoreOfPredictions(street(protocol));
    }
    if (protocol == "P7")
      trials = knownStreetTrials(street(protocol), kStreetDensity, kStreetResolution);
    if (protocol == "P4")
      trials = structuredRoomTrials(world(request_.room_world, "room.yaml", protocol));
    if (protocol == "P5")
      trials = robotTrials(world(request_.robot_world, "campus.yaml", protocol));
    if (protocol == "P8")
      trials = movingTrials(world(request_.moving_world, "crossing.yaml", protocol));
    if (protocol == "P6")
      trials = roomRepetitionTrials(room(protocol), kRoomDensity, kRoomResolution);
    if (protocol == kParameterStudy)
      trials = roomDensityTrials(room(protocol), {kRoomDensity}, kRoomResolution);
    for (Trial& trial : trials) {
      trial.protocol = protocol;
      evaluation_.labels.insert_or_assign(protocol, trial.labels);
    }
    return trials;
  }

 private:
  static std::vector<double> densities() { return {0.05, 0.10, 0.15, 0.20}; }

  const Room& room(const std::string& protocol) {
    const std::string folder = folderOf(request_.data, isRoom, "stanford_conference");
    evaluation_.sources[protocol] = folder;
    if (!room_) {
      room_ = readRoom(folder, labelSet("stanford"));
      warn(room_->warnings);
    }
    return *room_;
  }

  const Street& street(const std::string& protocol) {
    const std::string folder = folderOf(request_.data, isStreet, "semantickitti_08");
    evaluation_.sources[protocol] = folder;
    if (!street_) {
      street_ = readStreet(folder, labelSet("semantickitti"));
      warn(street_->warnings);
    }
    return *street_;
  }

  Scenario world(const std::string& given, const char* name, const std::string& protocol) {
    const std::string file = worldFile(given, name);
    evaluation_.sources[protocol] = file;
    return loadScenario(file);
  }

  void warn(const std::vector<std::string>& warnings) {
    evaluation_.warnings.insert(evaluation_.warnings.end(), warnings.begin(), warnings.end());
  }

  const EvaluationRequest& request_;
  Evaluation& evaluation_;
  std::optional<Room> room_;
  std::optional<Street> street_;
};

std::string titleOf(const Run& run) {
  return run.trial.protocol + (run.trial.variant.empty() ? "" : " " + run.trial.variant) + " " +
         run.method.text;
}

/// Does all runs on some threads; results in the order of the runs.
std::vector<TrialResult> resultsOf(const std::vector<Run>& runs, int threads,
                                   const EvaluationProgress& progress) {
  std::vector<std::vector<TrialResult>> results(runs.size());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // guards `done`, `failure` and the caller's progress
  std::size_t done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < runs.size(); i = next++) {
      try {
        results[i] = runTrial(runs[i].trial, runs[i].method);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
        next = runs.size();
        return;
      }
      const std::lock_guard<std::mutex> lock(mutex);
      if (progress) progress(++done, runs.size(), titleOf(runs[i]));
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);

  std::vector<TrialResult> all;
  for (std::vector<TrialResult>& of_run : results)
    std::move(of_run.begin(), of_run.end(), std::back_inserter(all));
  return all;
}

void requireKnown(const std::vector<std::string>& protocols) {
  std::string names;
  for (const ProtocolInfo& info : allProtocols()) names += (names.empty() ? "" : ", ") + info.name;
  for (const std::string& protocol : protocols) {
    const auto& all = allProtocols();
    if (std::none_of(all.begin(), all.end(),
                     [&](const ProtocolInfo& info) { return info.name == protocol; }))
      throw ConfigError("no protocol '" + protocol + "'; there are " + names);
  }
}

}  // namespace

const std::vector<ProtocolInfo>& allProtocols() {
  static const std::vector<ProtocolInfo> all{
      {"P1", "Room, density sweep",
       "all clouds of the room as one scan, one training point a cell of edge ds; no free space",
       "majority class of all points in each voxel of 0.05 m"},
      {"P2", "Room, by object",
       "one scan a cloud, one training point a cell of edge ds; no free space",
       "majority class of all points in each voxel of 0.05 m"},
      {"P3", "Street",
       "every second scan with the labels that a network predicted, ds 0.2 m; no free space",
       "majority class of the labelled points of all scans in each voxel of 0.3 m"},
      {"P4", "Structured room", "simulated: sparse scans of a closed room that label themselves",
       "exact"},
      {"P5", "Robot",
       "simulated: a drive with LiDAR and camera, labels only through the camera's images",
       "exact"},
      {"P6", "Room, repetition",
       "50 scans, each a random tenth of the room's points with 1 cm of noise, ds 0.10 m",
       "majority class of all points in each voxel of 0.05 m"},
      {"P7", "Known street",
       "the first and the last scan with the labels that a network predicted, ds 0.2 m; beams to "
       "all ranges",
       "of all scans within 50 m: voxels of 0.3 m with points have the majority class of the "
       "labelled ones, those without that two samples of beams cross are free, no others count"},
      {"P8", "What moved",
       "simulated: a LiDAR that labels its points passes a crossing where people and cars go, stop "
       "and go on; ds 0.2 m",
       "exact, of what stays"},
      {kParameterStudy, "Block depth and context threshold", "P1 at ds 0.10 m with see-csom",
       "as P1"}};
  return all;
}

Evaluation runEvaluation(const EvaluationRequest& request, const EvaluationProgress& progress) {
  requireKnown(request.protocols);
  Evaluation evaluation;
  Inputs inputs(request, evaluation);
  std::vector<Run> runs;
  for (const std::string& protocol : request.protocols) {
    try {
      const std::vector<MethodSpec> methods =
          protocol == kParameterStudy ? parameterStudyMethods() : request.methods;
      for (const Trial& trial : inputs.makeTrials(protocol))
        for (const MethodSpec& method : methods) runs.push_back({trial, method});
    } catch (const FileError& error) {
      evaluation.left_out.push_back({protocol, error.what()});
    }
  }
  evaluation.results = resultsOf(runs, request.threads, progress);
  return evaluation;
}

}  // namespace csom
