// SPDX-License-Identifier: BSD-3-Clause
// Strict reading of YAML maps: every key is used or reported, and every error has its line.
#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <set>
#include <string>
#include <vector>

namespace csom::detail {

/// One map of a YAML file. All errors are ConfigErrors "FILE:LINE: …". Call finish() when all keys
/// have been asked for.
class YamlReader {
 public:
  /// `what` names the map in messages ("box", "sensor").
  YamlReader(const YAML::Node& node, const std::string& file, const std::string& what);

  bool has(const std::string& key) const { return node_[key].IsDefined(); }
  std::string text(const std::string& key);
  std::string text(const std::string& key, const std::string& fallback);
  /// One of `words`; returns its index.
  std::size_t choice(const std::string& key, const std::vector<std::string>& words);
  double number(const std::string& key);
  double number(const std::string& key, double fallback);
  /// A number of at least / above `low`.
  double atLeast(const std::string& key, double low, double fallback);
  double above(const std::string& key, double low);
  double above(const std::string& key, double low, double fallback);
  long long integer(const std::string& key, long long low, long long high);
  long long integer(const std::string& key, long long low, long long high, long long fallback);
  /// A list of exactly `size` numbers.
  std::vector<double> numbers(const std::string& key, std::size_t size);
  Eigen::Vector3d vector3(const std::string& key);
  /// The list of nodes, not empty.
  std::vector<YAML::Node> list(const std::string& key);
  std::vector<double> numbersOf(const YAML::Node& node, std::size_t size) const;
  /// The map under `key`.
  YamlReader map(const std::string& key);

  /// Reports a key that nobody asked for.
  void finish() const;

  [[noreturn]] void fail(const std::string& reason) const { failAt(node_, reason); }
  [[noreturn]] void failAtKey(const std::string& key, const std::string& reason) const;
  [[noreturn]] void failAt(const YAML::Node& node, const std::string& reason) const;

 private:
  YAML::Node required(const std::string& key);
  double numberOf(const YAML::Node& node, const std::string& key) const;

  YAML::Node node_;
  std::string file_;
  std::string what_;
  std::set<std::string> used_;
};

}  // namespace csom::detail
