// SPDX-License-Identifier: BSD-3-Clause
// The YAML file that describes a segmentation network.
#include <csom/core/Error.h>
#include <csom/vision/SegmentationNetwork.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

namespace csom {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxSide = 16384;
constexpr int kMaxBatch = 256;
constexpr int kMaxChannels = 4096;

/// One map of the file. A key that nobody asked for is an error.
class Section {
 public:
  Section(const YAML::Node& node, std::string file, std::string name)
      : node_(node), file_(std::move(file)), name_(std::move(name)) {
    if (!node_.IsMap()) fail(node_, name_ + " must be a map of keys and values");
    std::set<std::string> keys;
    for (const auto& entry : node_) {
      if (!entry.first.IsScalar()) fail(entry.first, "a key of " + name_ + " must be a word");
      if (!keys.insert(entry.first.Scalar()).second)
        fail(entry.first, "key '" + entry.first.Scalar() + "' stands twice in " + name_);
    }
  }

  /// Nothing if the file does not have the key.
  std::optional<YAML::Node> find(const std::string& key) {
    used_.insert(key);
    const YAML::Node value = node_[key];
    if (!value.IsDefined()) return std::nullopt;
    return value;
  }

  YAML::Node require(const std::string& key) {
    const auto value = find(key);
    if (!value) fail(node_, name_ + " has no '" + key + "'");
    return *value;
  }

  std::string text(const std::string& key) {
    const auto value = find(key);
    if (!value) return {};
    return textOf(*value, key);
  }

  std::string textOf(const YAML::Node& value, const std::string& key) const {
    if (!value.IsScalar() || value.Scalar().empty()) fail(value, key + " must be a text");
    return value.Scalar();
  }

  /// The position of a word in `words`.
  std::size_t choice(const YAML::Node& value, const std::string& key,
                     const std::vector<std::string>& words) const {
    const std::string word = textOf(value, key);
    std::string accepted;
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (words[i] == word) return i;
      accepted += (i == 0 ? "" : ", ") + words[i];
    }
    fail(value, key + " = '" + word + "': must be one of " + accepted);
  }

  int integer(const YAML::Node& value, const std::string& key, int high) const {
    int number = 0;
    if (!value.IsScalar() || !YAML::convert<int>::decode(value, number) || number < 1 ||
        number > high)
      fail(value, key + " must be a whole number from 1 to " + std::to_string(high) + shown(value));
    return number;
  }

  double number(const YAML::Node& value, const std::string& key, bool positive) const {
    double number = 0;
    if (!value.IsScalar() || !YAML::convert<double>::decode(value, number) ||
        !std::isfinite(number) || (positive && !(number > 0)))
      fail(value, key + " must be a number" + (positive ? " above 0" : "") + shown(value));
    return number;
  }

  /// A list of a number a channel of the input.
  void numbers(const std::string& key, std::size_t count, bool positive,
               std::array<double, 3>& numbers) {
    const auto list = find(key);
    if (!list) return;
    if (!list->IsSequence() || list->size() != count)
      fail(*list, key + " must be a list of " + std::to_string(count) +
                      " numbers, one a channel of the input");
    for (std::size_t i = 0; i < count; ++i) numbers[i] = number((*list)[i], key, positive);
  }

  void finish() const {
    for (const auto& entry : node_) {
      if (used_.count(entry.first.Scalar()) == 0)
        fail(entry.first, "unknown key '" + entry.first.Scalar() + "' in " + name_);
    }
  }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& reason) const {
    const int line = node.Mark().line;
    throw ConfigError(file_ + (line >= 0 ? ":" + std::to_string(line + 1) : "") + ": " + reason);
  }

 private:
  static std::string shown(const YAML::Node& value) {
    return value.IsScalar() ? ", not '" + value.Scalar() + "'" : "";
  }

  YAML::Node node_;
  std::string file_;
  std::string name_;
  std::set<std::string> used_;
};

YAML::Node parse(const std::string& file) {
  std::error_code error;
  if (fs::exists(file, error) && !fs::is_regular_file(file, error))
    throw ConfigError(file + ": is no regular file");
  std::ostringstream text;
  std::ifstream stream(file);
  if (!(text << stream.rdbuf()))
    throw ConfigError(file + ": cannot be read, or is empty; give the description of a network");
  try {
    return YAML::Load(text.str());
  } catch (const YAML::Exception& wrong) {
    throw ConfigError(file + ":" + std::to_string(wrong.mark.line + 1) +
                      ": no valid YAML: " + wrong.msg);
  }
}

void readInput(Section input, NetworkDescription& description) {
  using Channels = NetworkDescription::Channels;
  using Resize = NetworkDescription::Resize;
  description.width = input.integer(input.require("width"), "width", kMaxSide);
  description.height = input.integer(input.require("height"), "height", kMaxSide);
  if (const auto resize = input.find("resize")) {
    description.resize =
        std::array{Resize::Stretch,
                   Resize::Letterbox}[input.choice(*resize, "resize", {"stretch", "letterbox"})];
  }
  if (const auto channels = input.find("channels")) {
    description.channels =
        std::array{Channels::Rgb, Channels::Bgr,
                   Channels::Gray}[input.choice(*channels, "channels", {"rgb", "bgr", "gray"})];
  }
  if (const auto scale = input.find("scale"))
    description.scale = input.number(*scale, "scale", true);
  const std::size_t channels = description.channels == Channels::Gray ? 1 : 3;
  input.numbers("mean", channels, false, description.mean);
  input.numbers("deviation", channels, true, description.deviation);
  if (const auto batch = input.find("batch"))
    description.batch = input.integer(*batch, "batch", kMaxBatch);
  input.finish();
}

void readClasses(Section& root, NetworkDescription& description) {
  const auto list = root.find("classes");
  if (!list) return;
  if (!list->IsSequence() || list->size() == 0 || list->size() > kMaxChannels)
    root.fail(*list, "classes must be a list of class names, one a channel of the output");
  for (const auto& item : *list)
    description.classes.push_back(root.textOf(item, "each of classes"));
}

void readOutput(Section output, NetworkDescription& description) {
  using Output = NetworkDescription::Output;
  description.output_name = output.text("name");
  description.output =
      std::array{Output::Logits, Output::Probabilities, Output::Index}[output.choice(
          output.require("layout"), "layout", {"logits", "probabilities", "index"})];
  const auto channels = output.find("channels");
  output.finish();
  if (description.output == Output::Index) {
    if (channels) output.fail(*channels, "channels: an index has none; leave the key out");
    return;
  }
  const int classes = static_cast<int>(description.classes.size());
  if (!channels && classes == 0) output.require("channels");
  description.output_channels =
      channels ? output.integer(*channels, "channels", kMaxChannels) : classes;
  if (classes != 0 && classes != description.output_channels)
    output.fail(*channels, "channels = " + std::to_string(description.output_channels) +
                               ", but classes names " + std::to_string(classes));
}

}  // namespace

NetworkDescription NetworkDescription::load(const std::string& file, const std::string& model) {
  Section root(parse(file), file, "the description of a network");
  NetworkDescription description;
  description.file = file;
  const fs::path folder = fs::path(file).parent_path();
  const std::string named = root.text("model");
  if (model.empty() && named.empty()) root.require("model");
  description.model = model.empty() ? (folder / named).string() : model;
  description.config = root.text("config");
  if (!description.config.empty()) description.config = (folder / description.config).string();
  readInput({root.require("input"), file, "input"}, description);
  readClasses(root, description);
  readOutput({root.require("output"), file, "output"}, description);
  root.finish();
  return description;
}

}  // namespace csom
