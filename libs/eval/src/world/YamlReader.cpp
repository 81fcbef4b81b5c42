// SPDX-License-Identifier: BSD-3-Clause
// Values of a YAML map, checked one by one.
#include "world/YamlReader.h"

#include <csom/core/Error.h>

#include <cmath>
#include <sstream>

namespace csom::detail {
namespace {

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

YamlReader::YamlReader(const YAML::Node& node, const std::string& file, const std::string& what)
    : node_(node), file_(file), what_(what) {
  if (!node.IsMap()) failAt(node, what + " must be a map of keys and values");
  std::set<std::string> keys;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) failAt(entry.first, "a key of " + what + " must be a word");
    if (!keys.insert(entry.first.Scalar()).second)
      failAt(entry.first, "key '" + entry.first.Scalar() + "' stands twice in " + what);
  }
}

void YamlReader::failAt(const YAML::Node& node, const std::string& reason) const {
  const int line = node.Mark().line;
  throw ConfigError(file_ + (line >= 0 ? ":" + std::to_string(line + 1) : "") + ": " + reason);
}

void YamlReader::failAtKey(const std::string& key, const std::string& reason) const {
  failAt(has(key) ? node_[key] : node_, what_ + ": " + key + " " + reason);
}

YAML::Node YamlReader::required(const std::string& key) {
  used_.insert(key);
  if (!has(key)) fail(what_ + " has no '" + key + "'");
  return node_[key];
}

std::string YamlReader::text(const std::string& key) {
  const YAML::Node node = required(key);
  if (!node.IsScalar() || node.Scalar().empty()) failAtKey(key, "must be a word");
  return node.Scalar();
}

std::string YamlReader::text(const std::string& key, const std::string& fallback) {
  return has(key) ? text(key) : fallback;
}

std::size_t YamlReader::choice(const std::string& key, const std::vector<std::string>& words) {
  if (!has(key)) {
    used_.insert(key);
    return 0;
  }
  const std::string word = text(key);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == word) return i;
  }
  failAtKey(key, "= " + word + ": must be one of " + joined(words));
}

double YamlReader::numberOf(const YAML::Node& node, const std::string& key) const {
  double value = 0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value))
    failAt(node, what_ + ": " + key + " must be a number" +
                     (node.IsScalar() ? ", not '" + node.Scalar() + "'" : ""));
  return value;
}

double YamlReader::number(const std::string& key) {
  return numberOf(required(key), key);
}

double YamlReader::number(const std::string& key, double fallback) {
  return has(key) ? number(key) : fallback;
}

double YamlReader::atLeast(const std::string& key, double low, double fallback) {
  const double value = number(key, fallback);
  if (value < low) failAtKey(key, "= " + shown(value) + ": must be at least " + shown(low));
  return value;
}

double YamlReader::above(const std::string& key, double low) {
  const double value = number(key);
  if (!(value > low)) failAtKey(key, "= " + shown(value) + ": must be above " + shown(low));
  return value;
}

double YamlReader::above(const std::string& key, double low, double fallback) {
  return has(key) ? above(key, low) : fallback;
}

long long YamlReader::integer(const std::string& key, long long low, long long high) {
  const YAML::Node node = required(key);
  long long value = 0;
  if (!node.IsScalar() || !YAML::convert<long long>::decode(node, value) || value < low ||
      value > high)
    failAtKey(key, "must be a whole number from " + std::to_string(low) + " to " +
                       std::to_string(high) +
                       (node.IsScalar() ? ", not '" + node.Scalar() + "'" : ""));
  return value;
}

long long YamlReader::integer(const std::string& key, long long low, long long high,
                              long long fallback) {
  return has(key) ? integer(key, low, high) : fallback;
}

std::vector<double> YamlReader::numbersOf(const YAML::Node& node, std::size_t size) const {
  if (!node.IsSequence() || node.size() != size)
    failAt(node, what_ + ": expected a list of " + std::to_string(size) + " numbers");
  std::vector<double> values;
  for (const auto& item : node) values.push_back(numberOf(item, "each item"));
  return values;
}

std::vector<double> YamlReader::numbers(const std::string& key, std::size_t size) {
  const YAML::Node node = required(key);
  if (!node.IsSequence() || node.size() != size)
    failAtKey(key, "must be a list of " + std::to_string(size) + " numbers");
  return numbersOf(node, size);
}

Eigen::Vector3d YamlReader::vector3(const std::string& key) {
  const std::vector<double> v = numbers(key, 3);
  return {v[0], v[1], v[2]};
}

std::vector<YAML::Node> YamlReader::list(const std::string& key) {
  const YAML::Node node = required(key);
  if (!node.IsSequence() || node.size() == 0) failAtKey(key, "must be a list that is not empty");
  return {node.begin(), node.end()};
}

YamlReader YamlReader::map(const std::string& key) {
  return YamlReader(required(key), file_, key);
}

void YamlReader::finish() const {
  for (const auto& entry : node_) {
    if (used_.count(entry.first.Scalar()) == 0)
      failAt(entry.first, "unknown key '" + entry.first.Scalar() + "' in " + what_);
  }
}

}  // namespace csom::detail
