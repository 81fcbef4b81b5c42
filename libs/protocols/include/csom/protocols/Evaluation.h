// SPDX-License-Identifier: BSD-3-Clause
// All protocols with all methods in one run.
#pragma once

#include <csom/protocols/Trial.h>

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace csom {

/// A protocol as people know it.
struct ProtocolInfo {
  std::string name;   ///< "P1"
  std::string title;  ///< "Room, density sweep"
  std::string input;  ///< a sentence
  std::string truth;  ///< a sentence
};

/// P1 … P8, and the study of block depth and context threshold.
const std::vector<ProtocolInfo>& allProtocols();
constexpr const char* kParameterStudy = "parameters";

struct EvaluationRequest {
  std::vector<std::string> protocols;  ///< names of allProtocols()
  std::vector<MethodSpec> methods;
  /// Holds stanford_conference/ and semantickitti_08/, or is itself a room (*.pcd) or a street
  /// (velodyne/); empty: there is none.
  std::string data;
  std::string room_world;    ///< world file of P4; empty: the structured room that is installed
  std::string robot_world;   ///< world file of P5; empty: the campus that is installed
  std::string moving_world;  ///< world file of P8; empty: the crossing that is installed
  int threads = 1;           ///< trials that run at a time; does not change a score
};

struct LeftOutProtocol {
  std::string name;
  std::string reason;
};

struct Evaluation {
  /// By protocol, then as its trials come, then by method, then by number of scans.
  std::vector<TrialResult> results;
  std::map<std::string, LabelSet> labels;      ///< by protocol
  std::map<std::string, std::string> sources;  ///< by protocol: folder or world file
  std::optional<PointScore> predictions;       ///< of P3: the input labels themselves
  std::vector<LeftOutProtocol> left_out;       ///< their data are missing or cannot be read
  std::vector<std::string> warnings;           ///< one line each
};

/// Called from one thread at a time: runs of a method done, of all, and which one is done now.
using EvaluationProgress =
    std::function<void(std::size_t done, std::size_t total, const std::string& what)>;

/// Throws ConfigError for a protocol or world that does not exist, OptionError for settings that do
/// not go together.
Evaluation runEvaluation(const EvaluationRequest& request, const EvaluationProgress& progress = {});

}  // namespace csom
