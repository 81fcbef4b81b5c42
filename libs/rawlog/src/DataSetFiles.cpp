// SPDX-License-Identifier: BSD-3-Clause
// Finding and timing the files of a data set.
#include "DataSetFiles.h"

#include <csom/core/Error.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace csom::detail {

namespace fs = std::filesystem;

std::vector<std::string> filesIn(const std::string& folder, const std::string& extension) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw FileError(folder, "no such folder");
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file(error) && entry.path().extension() == extension)
      files.push_back(entry.path().string());
  }
  if (files.empty()) throw FileError(folder, "holds no *" + extension + " file");
  std::sort(files.begin(), files.end(), naturalLess);
  return files;
}

std::vector<std::size_t> choose(const ScanSelection& selection, const std::string& folder,
                                std::size_t count) {
  auto positions = selection.positions(count);
  if (positions.empty())
    throw FileError(folder, "has " + std::to_string(count) + " scans (0 to " +
                                std::to_string(count - 1) + "), none of which --scans selects");
  return positions;
}

std::optional<std::size_t> numberOfFile(const std::string& file) {
  const std::string stem = fs::path(file).stem().string();
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (error != std::errc() || end != stem.data() + stem.size()) return std::nullopt;
  return number;
}

namespace {

/// NaN if the line is no time.
double timeOf(const std::string& line) {
  std::istringstream text(line);
  double seconds = std::nan("");
  if (line.find('-') == std::string::npos) {
    text >> seconds;
    return text.fail() ? std::nan("") : seconds;
  }
  std::tm date{};
  text >> std::get_time(&date, "%Y-%m-%d %H:%M:%S");
  if (text.fail()) return std::nan("");
  double fraction = 0;
  if (text.peek() == '.') text >> fraction;
  return static_cast<double>(timegm(&date)) + fraction;
}

}  // namespace

std::vector<double> readTimes(const std::string& file) {
  std::vector<double> times;
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line)) {
    times.push_back(timeOf(line));
    if (!std::isfinite(times.back()))
      throw FileError(file, "line " + std::to_string(times.size()) + ": '" + line.substr(0, 40) +
                                "' is no time");
  }
  return times;
}

}  // namespace csom::detail
