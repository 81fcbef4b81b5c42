// SPDX-License-Identifier: BSD-3-Clause
// Finding and timing the files of a data set.
#include "import/DataSetFiles.h"

#include <csom/core/Error.h>
#include <csom/io/InputFile.h>
#include <csom/io/TextParser.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <map>
#include <string_view>

namespace csom::detail {

namespace fs = std::filesystem;

void requireReadable(const fs::directory_entry& entry) {
  std::error_code error;
  if (!entry.exists(error))
    throw FileError(entry.path().string(), "is a link to a file that is not there");
  if (!entry.is_regular_file(error)) throw FileError(entry.path().string(), "is no regular file");
}

std::vector<std::string> filesIn(const std::string& folder, const std::string& extension) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw FileError(folder, "no such folder");
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (lowerCase(entry.path().extension().string()) != extension) continue;
    requireReadable(entry);
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
    throw FileError(folder,
                    "has " + std::to_string(count) + " scans (0 to " + std::to_string(count - 1) +
                        "), none of which is selected",
                    {"scans"});
  return positions;
}

std::vector<std::size_t> numbersOfFiles(const std::vector<std::string>& files) {
  std::vector<std::size_t> numbers;
  std::map<std::size_t, std::string> file_of;
  for (const std::string& file : files) {
    const std::string stem = fs::path(file).stem().string();
    std::size_t number = 0;
    if (!parseNumber(stem, number))
      throw FileError(file, "its name is no number, so it is not known which frame it is");
    const auto [other, is_new] = file_of.emplace(number, file);
    if (!is_new)
      throw FileError(file, "is frame " + std::to_string(number) + ", and so is " + other->second);
    numbers.push_back(number);
  }
  return numbers;
}

namespace {

/// The three numbers of "2011-09-26" or "13:02:25.96".
bool parseParts(std::string_view text, char separator, std::array<double, 3>& parts) {
  for (double& part : parts) {
    const std::size_t end = std::min(text.find(separator), text.size());
    const bool is_last = &part == &parts.back();
    if (is_last != (end == text.size())) return false;
    if (!parseNumber(text.substr(0, end), part) || !(part >= 0 && part < 10000)) return false;
    text.remove_prefix(is_last ? end : end + 1);
  }
  return true;
}

/// Seconds since 1970 of a date and a time of day, UTC.
std::optional<double> secondsOfDate(std::string_view day, std::string_view time_of_day) {
  std::array<double, 3> date{};
  std::array<double, 3> time{};
  if (!parseParts(day, '-', date) || !parseParts(time_of_day, ':', time)) return std::nullopt;
  for (const double whole : {date[0], date[1], date[2], time[0], time[1]}) {
    if (whole != std::floor(whole)) return std::nullopt;
  }
  if (time[0] > 23 || time[1] > 59 || time[2] >= 61) return std::nullopt;
  std::tm calendar{};
  calendar.tm_year = static_cast<int>(date[0]) - 1900;
  calendar.tm_mon = static_cast<int>(date[1]) - 1;
  calendar.tm_mday = static_cast<int>(date[2]);
  const std::tm given = calendar;
  const auto midnight = static_cast<double>(timegm(&calendar));
  // timegm() makes 3 March of 31 February.
  if (calendar.tm_mon != given.tm_mon || calendar.tm_mday != given.tm_mday) return std::nullopt;
  return midnight + 3600 * time[0] + 60 * time[1] + time[2];
}

std::optional<double> timeOf(const std::vector<std::string_view>& columns) {
  double seconds = 0;
  if (columns.size() == 1 && parseNumber(columns[0], seconds) && std::isfinite(seconds))
    return seconds;
  if (columns.size() == 2) return secondsOfDate(columns[0], columns[1]);
  return std::nullopt;
}

std::vector<std::optional<double>> readTimes(const std::string& file) {
  std::vector<std::optional<double>> times;
  const std::string text = readFile(file);
  LineReader lines(text);
  std::string_view line;
  std::vector<std::string_view> columns;
  while (lines.next(line)) {
    splitColumns(line, columns);
    times.emplace_back();
    if (columns.empty()) continue;
    const auto time = timeOf(columns);
    if (!time)
      throw FileError(
          file, "line " + std::to_string(lines.lineNumber()) + ": " + quoted(line) + " is no time");
    times.back() = time;
  }
  return times;
}

}  // namespace

FrameTimes::FrameTimes(const std::string& file) : file_(file) {
  std::error_code error;
  if (fs::symlink_status(file, error).type() != fs::file_type::not_found) times_ = readTimes(file);
}

double FrameTimes::of(std::size_t number, const std::string& scan) const {
  if (!times_) return static_cast<double>(number) * kScanPeriod;
  if (number >= times_->size())
    throw FileError(file_,
                    "has " + std::to_string(times_->size()) + " lines, so no time for " + scan);
  const std::optional<double>& time = (*times_)[number];
  if (!time)
    throw FileError(file_,
                    "line " + std::to_string(number + 1) + " is blank, so there is no time for " +
                        scan + "; leave that one out",
                    {"scans"});
  return *time;
}

}  // namespace csom::detail
