// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/EnumWords.h>
#include <csom/core/Options.h>
#include <csom/core/types.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

namespace csom {

using detail::EnumWords;
using detail::parseWord;
using detail::wordOf;

namespace {

constexpr EnumWords<Method, 4> kMethods{{{Method::SurfaceCsom, "surface-csom"},
                                         {Method::SeeCsom, "see-csom"},
                                         {Method::SBki, "s-bki"},
                                         {Method::SCsm, "s-csm"}}};
constexpr EnumWords<Kernel, 2> kKernels{{{Kernel::Sparse, "sparse"}, {Kernel::Linear, "linear"}}};
constexpr EnumWords<Neighbourhood, 2> kNeighbourhoods{
    {{Neighbourhood::Radius, "radius"}, {Neighbourhood::ExtendedBlock, "extended-block"}}};
constexpr EnumWords<FreeSpace, 3> kFreeSpaces{
    {{FreeSpace::None, "none"}, {FreeSpace::Sampled, "sampled"}, {FreeSpace::Raycast, "raycast"}}};

[[noreturn]] void reject(const std::string& key, const std::string& value,
                         const std::string& accepted) {
  throw OptionError(key + " = " + value + ": expected " + accepted);
}

/// Nothing if the text is no number, or an infinite one.
std::optional<double> finiteNumber(const std::string& text) {
  const char* const end = text.data() + text.size();
  double number = 0;
  const auto result = std::from_chars(text.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

void checkRange(const char* key, double value, double min, double max) {
  if (!(value >= min && value <= max))
    reject(key, toString(value), "a number from " + toString(min) + " to " + toString(max));
}

}  // namespace

std::string toString(Method value) {
  return wordOf(kMethods, value);
}
std::string toString(Kernel value) {
  return wordOf(kKernels, value);
}
std::string toString(Neighbourhood value) {
  return wordOf(kNeighbourhoods, value);
}
std::string toString(FreeSpace value) {
  return wordOf(kFreeSpaces, value);
}
std::string toString(bool value) {
  return value ? "on" : "off";
}
std::string toString(int value) {
  return std::to_string(value);
}
std::string toString(double value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

void parse(const std::string& key, const std::string& text, Method& value) {
  parseWord(kMethods, key, text, value);
}
void parse(const std::string& key, const std::string& text, Kernel& value) {
  parseWord(kKernels, key, text, value);
}
void parse(const std::string& key, const std::string& text, Neighbourhood& value) {
  parseWord(kNeighbourhoods, key, text, value);
}
void parse(const std::string& key, const std::string& text, FreeSpace& value) {
  parseWord(kFreeSpaces, key, text, value);
}
void parse(const std::string& key, const std::string& text, bool& value) {
  // The words of MRPT's ini files in any case, and ours; formulas give 1.000000e+00.
  std::string word = text;
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::optional<double> number = finiteNumber(word);
  if (word == "on" || word == "true" || word == "yes" || number == 1.0) {
    value = true;
  } else if (word == "off" || word == "false" || word == "no" || number == 0.0) {
    value = false;
  } else {
    reject(key, text, "on | off");
  }
}
void parse(const std::string& key, const std::string& text, int& value) {
  const std::optional<double> number = finiteNumber(text);
  constexpr double kLargest = std::numeric_limits<int>::max();
  if (!number || *number != std::floor(*number) || std::abs(*number) > kLargest)
    reject(key, text, "a whole number");
  value = static_cast<int>(*number);
}
void parse(const std::string& key, const std::string& text, double& value) {
  const std::optional<double> number = finiteNumber(text);
  if (!number) reject(key, text, "a finite number");
  value = *number;
}

void Options::validate() const {
  constexpr double kFar = 1e7;
  if (number_of_classes < 2 || number_of_classes > kMaxClasses)
    reject("number_of_classes", toString(number_of_classes), "2 to " + std::to_string(kMaxClasses));
  if (unlabelled_class_id < 0 || unlabelled_class_id >= number_of_classes)
    reject("unlabelled_class_id", toString(unlabelled_class_id),
           "0 to " + std::to_string(number_of_classes - 1));
  checkRange("resolution", resolution, 1e-4, 1e3);
  if (block_depth < 1 || block_depth > 4) reject("block_depth", toString(block_depth), "1 to 4");
  checkRange("ds_resolution", ds_resolution, 0, kFar);
  if (ds_resolution > 0) checkRange("ds_resolution", ds_resolution, resolution / 64, kFar);
  checkRange("min_range", min_range, 0, kFar);
  checkRange("max_range", max_range, 0, kFar);
  if (max_range > 0 && max_range <= min_range)
    reject("max_range", toString(max_range),
           "0 (no limit) or more than min_range = " + toString(min_range));
  if (free_space == FreeSpace::Sampled)
    checkRange("free_resolution", free_resolution, resolution / 64, kFar);
  checkRange("free_weight", free_weight, 1e-3, 1e5);
  checkRange("context_weight_self", context_weight_self, 0, 100);
  checkRange("context_weight_neighbour", context_weight_neighbour, 0, 100);
  checkRange("context_threshold", context_threshold, 0, 1);
  if (context_neighbours != 6 && context_neighbours != 18 && context_neighbours != 26)
    reject("context_neighbours", toString(context_neighbours), "6, 18 or 26");
  // A kernel of more than 64 voxels would look at millions of points for each voxel.
  const double longest = 64 * resolution;
  if (kernel_length_min != 0)
    checkRange("kernel_length_min", kernel_length_min, resolution / 64, longest);
  if (kernel_length_max != 0)
    checkRange("kernel_length_max", kernel_length_max, resolution / 64, longest);
  if (kernel_length != 0) checkRange("kernel_length", kernel_length, resolution / 64, longest);
  if (kernelLengthMax() < kernelLengthMin())
    reject("kernel_length_max", toString(kernelLengthMax()),
           "at least kernel_length_min = " + toString(kernelLengthMin()));
  checkRange("kernel_scale", kernel_scale, 1e-3, 1e5);
  if (surface_neighbours < 3 || surface_neighbours > 64)
    reject("surface_neighbours", toString(surface_neighbours), "3 to 64");
  checkRange("surface_reach", surface_reach, 0.5, 4);
  checkRange("surface_gap", surface_gap, 1, 8);
  checkRange("surface_thickness", surface_thickness, 0.1, 10);
  checkRange("surface_support", surface_support, 1e-3, 100);
  checkRange("surface_hit_weight", surface_hit_weight, 0, 100);
  checkRange("surface_free_limit", surface_free_limit, 0, 1000);
  checkRange("counter_evidence", counter_evidence, 0, 100);
  checkRange("prior", prior, 1e-9, 1e5);
  if (threads < 0 || threads > 1024)
    reject("threads", toString(threads), "0 (all processors) to 1024");
}

bool setOption(Options& options, const std::string& key, const std::string& text) {
  bool found = false;
  visitOptions(options, [&](const char* name, auto& field, const char*, const char*) {
    if (key != name) return;
    found = true;
    parse(key, text, field);
  });
  return found;
}

bool mergeable(const Options& a, const Options& b) {
  return a.resolution == b.resolution && a.number_of_classes == b.number_of_classes &&
         a.unlabelled_class_id == b.unlabelled_class_id && a.prior == b.prior;
}

}  // namespace csom
