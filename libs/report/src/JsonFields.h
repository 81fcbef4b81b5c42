// SPDX-License-Identifier: BSD-3-Clause
// Fields of JSON that somebody may have edited.
#pragma once

#include <csom/core/Error.h>

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace csom {

/// An object of a JSON file, which knows its place in it: what is wrong with a field is a FileError
/// that names file and field.
class JsonFields {
 public:
  using Json = nlohmann::ordered_json;

  /// `place`: "" at the top, "scans[3]." inside. Keeps a reference.
  JsonFields(const Json& json, std::string file, std::string place = "")
      : json_(json), file_(std::move(file)), place_(std::move(place)) {
    if (!json_.is_object()) fail(place_.empty() ? "it" : place_, "is no JSON object");
  }

  bool has(const char* key) const { return json_.contains(key) && !json_.at(key).is_null(); }
  const Json& at(const char* key) const {
    if (!json_.contains(key)) fail(place_ + key, "is missing");
    return json_.at(key);
  }

  JsonFields object(const char* key) const { return {at(key), file_, place_ + key + "."}; }

  std::string text(const char* key) const {
    if (!at(key).is_string()) fail(place_ + key, "is no text");
    return at(key).get<std::string>();
  }
  std::size_t count(const char* key) const {
    if (!at(key).is_number_unsigned()) fail(place_ + key, "is no count");
    return at(key).get<std::size_t>();
  }
  /// `null` stands for what is not finite.
  double number(const char* key) const {
    if (at(key).is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (!at(key).is_number()) fail(place_ + key, "is no number");
    return at(key).get<double>();
  }
  std::vector<std::string> texts(const char* key) const {
    std::vector<std::string> values;
    for (const Json& element : list(key)) {
      if (!element.is_string()) fail(place_ + key, "is no list of texts");
      values.push_back(element.get<std::string>());
    }
    return values;
  }
  std::vector<JsonFields> objects(const char* key) const {
    std::vector<JsonFields> values;
    for (const Json& element : list(key))
      values.push_back({element, file_, place_ + key + "[" + std::to_string(values.size()) + "]."});
    return values;
  }
  const Json& list(const char* key) const {
    if (!at(key).is_array()) fail(place_ + key, "is no list");
    return at(key);
  }

  [[noreturn]] void fail(const std::string& place, const std::string& problem) const {
    failWith("is no run record of this version: " + place + " " + problem + "; run csom map again");
  }
  [[noreturn]] void failWith(const std::string& problem) const { throw FileError(file_, problem); }
  const Json& json() const { return json_; }
  const std::string& place() const { return place_; }

 private:
  const Json& json_;
  std::string file_;
  std::string place_;
};

}  // namespace csom
