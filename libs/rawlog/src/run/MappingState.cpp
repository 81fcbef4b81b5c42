// SPDX-License-Identifier: BSD-3-Clause
// Where a mapping run stands, as texts and bytes in the file of the map.
#include "run/MappingState.h"

#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/TextParser.h>
#include <csom/vision/SegmentationNetwork.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <array>
#include <cstring>
#include <filesystem>

namespace csom {
namespace detail {
namespace {

namespace fs = std::filesystem;

constexpr char kInputs[] = "input.";

/// Reads fields of a state; what is missing or no number is an error that names the key.
class Fields {
 public:
  Fields(const MapStore::State& state, const std::string& file) : state_(state), file_(file) {}

  bool has(const std::string& key) const { return state_.count(key) > 0; }
  const std::string& text(const std::string& key) const {
    const auto found = state_.find(key);
    if (found == state_.end()) fail(key, "is missing");
    return found->second;
  }
  template <class Number>
  Number number(const std::string& key) const {
    Number value{};
    if (!parseNumber(text(key), value)) fail(key, detail::quoted(text(key)) + " is no number");
    return value;
  }
  std::vector<std::string> list(const std::string& key) const {
    std::vector<std::string> texts;
    for (std::string name; has(name = key + std::to_string(texts.size() + 1));)
      texts.push_back(text(name));
    return texts;
  }
  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw FileError(file_, "table resume, key " + key + ": " + what +
                               "; it cannot be gone on with, map the logs again");
  }

 private:
  const MapStore::State& state_;
  const std::string& file_;
};

void putList(const std::vector<std::string>& texts, const std::string& key, MapStore::State& out) {
  for (std::size_t i = 0; i < texts.size(); ++i) out[key + std::to_string(i + 1)] = texts[i];
}

}  // namespace

void write(const MappingState& state, MapStore::State& out) {
  out["position.log"] = std::to_string(state.log);
  out["position.entries"] = std::to_string(state.entries);
  out["observations_read"] = std::to_string(state.observations_read);
  out["observations_refused"] = std::to_string(state.observations_refused);
  out["points_rejected"] = std::to_string(state.points_rejected);
  for (int axis = 0; axis < 3; ++axis)
    out[std::string("up.") + "xyz"[axis]] = toString(state.up[axis]);
  for (int axis = 0; axis < 3; ++axis)
    out[std::string("farthest.") + "xyz"[axis]] = toString(state.farthest[axis]);
  if (state.deskew)
    DeskewStatistics::visit(
        [&](const StatisticInfo& info, const std::size_t& count) {
          out[std::string("deskew.") + info.key] = std::to_string(count);
        },
        *state.deskew);
  std::string& times = out["insert_ms"];
  times.assign(reinterpret_cast<const char*>(state.insert_ms.data()),
               state.insert_ms.size() * sizeof(double));
  std::size_t number = 0;
  for (const auto& [what, count] : state.refused) {
    const std::string key = "refused." + std::to_string(++number);
    out[key + ".class"] = what.first;
    out[key + ".reason"] = what.second;
    out[key + ".count"] = std::to_string(count);
  }
}

MappingState readMappingState(const MapStore::State& in, const std::string& file) {
  const Fields fields(in, file);
  MappingState state;
  state.log = fields.number<std::size_t>("position.log");
  state.entries = fields.number<std::size_t>("position.entries");
  state.observations_read = fields.number<std::size_t>("observations_read");
  state.observations_refused = fields.number<std::size_t>("observations_refused");
  state.points_rejected = fields.number<std::size_t>("points_rejected");
  for (int axis = 0; axis < 3; ++axis)
    state.up[axis] = fields.number<double>(std::string("up.") + "xyz"[axis]);
  for (int axis = 0; axis < 3; ++axis)
    state.farthest[axis] = fields.number<double>(std::string("farthest.") + "xyz"[axis]);
  if (fields.has("deskew.deskewed"))
    DeskewStatistics::visit(
        [&](const StatisticInfo& info, std::size_t& count) {
          count = fields.number<std::size_t>(std::string("deskew.") + info.key);
        },
        state.deskew.emplace());
  const std::string& times = fields.text("insert_ms");
  if (times.size() % sizeof(double) != 0)
    fields.fail("insert_ms", "has " + std::to_string(times.size()) +
                                 " bytes, which is no whole number of times");
  state.insert_ms.resize(times.size() / sizeof(double));
  if (!times.empty())
    std::memcpy(state.insert_ms.data(), times.data(), state.insert_ms.size() * sizeof(double));
  for (std::size_t number = 1;; ++number) {
    const std::string key = "refused." + std::to_string(number);
    if (!fields.has(key + ".count")) break;
    state.refused[{fields.text(key + ".class"), fields.text(key + ".reason")}] =
        fields.number<std::size_t>(key + ".count");
  }
  return state;
}

std::string bytesOf(const CSemanticContinuousMap& map) {
  CSemanticContinuousMap without_content(map);
  without_content.replaceContent(SemanticMap(map.map().options()), {});
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << without_content;
  return {static_cast<const char*>(stream.getRawBufferData()),
          static_cast<std::size_t>(stream.getTotalBytesCount())};
}

CSemanticContinuousMap::Ptr mapFromBytes(const std::string& bytes, const std::string& file) {
  mrpt::io::CMemoryStream stream(bytes.data(), bytes.size());
  auto archive = mrpt::serialization::archiveFrom(stream);
  auto map = std::make_shared<CSemanticContinuousMap>();
  try {
    archive >> *map;
  } catch (const std::exception&) {
    throw FileError(file,
                    "table resume, key map: is no map of this version of the program; map the logs "
                    "again, or with the version that began");
  }
  return map;
}

void write(const MappingRequest& request, MapStore::State& out) {
  std::vector<std::string> logs;
  for (const std::string& log : request.logs) logs.push_back(fs::absolute(log).string());
  putList(logs, "request.log.", out);
  out["request.config"] = fs::absolute(request.config_file).string();
  if (request.poses) {
    PoseChoice poses = *request.poses;
    if (poses.takesFile()) poses.argument = fs::absolute(poses.argument).string();
    out["request.poses"] = poses.toString();
  }
  if (request.threads) out["request.threads"] = std::to_string(*request.threads);
  out["request.deskew"] = toString(request.deskew);
  out["request.keep_key_frames"] = toString(request.keep_key_frames);
}

void writeInputs(const MappingRequest& request, const LabelOptions& labels, MapStore::State& out) {
  std::size_t number = 0;
  const auto add = [&](const char* kind, const std::string& file) {
    const std::string key = kInputs + std::to_string(++number);
    out[key + ".kind"] = kind;
    out[key + ".file"] = file;
    out[key + ".bytes"] = std::to_string(fs::file_size(file));
    out[key + ".xxh3"] = fileHash(file);
  };
  for (const std::string& log : request.logs) add(kLogInput, log);
  add("config", request.config_file);
  if (request.poses && request.poses->takesFile()) add("poses", request.poses->argument);
  for (const LabelSource& source : labels.sources) {
    if (source.kind != LabelSource::Kind::Network) continue;
    add("network", source.network);
    add("model", NetworkDescription::load(source.network, source.model).model);
  }
  out["config.text"] = readFile(request.config_file);
}

void requireSameInputs(const MapStore::State& in, const MapStore::State& now,
                       const std::string& file) {
  const Fields then(in, file);
  for (const auto& [key, value] : now) {
    if (key.rfind(kInputs, 0) != 0 || key.find(".xxh3") == std::string::npos) continue;
    const std::string input = key.substr(0, key.size() - std::strlen(".xxh3"));
    if (!then.has(key))
      throw FileError(now.at(input + ".file"),
                      "was no input when this map was begun; remove " + file + " and begin anew");
    if (then.text(key) != value)
      throw FileError(now.at(input + ".file"),
                      "is not what it was when this map was begun (" + then.text(input + ".bytes") +
                          " bytes with the hash " + then.text(key) +
                          "); put that file back, or remove " + file + " and begin anew");
  }
}

}  // namespace detail

MappingRequest readRequest(const MapStore::State& state, const std::string& file) {
  const detail::Fields fields(state, file);
  MappingRequest request;
  request.logs = fields.list("request.log.");
  if (request.logs.empty()) fields.fail("request.log.1", "is missing");
  request.config_file = fields.text("request.config");
  if (fields.has("request.poses")) request.poses = PoseChoice::parse(fields.text("request.poses"));
  if (fields.has("request.threads")) request.threads = fields.number<int>("request.threads");
  parse("request.deskew", fields.text("request.deskew"), request.deskew);
  parse("request.keep_key_frames", fields.text("request.keep_key_frames"), request.keep_key_frames);
  return request;
}

}  // namespace csom
