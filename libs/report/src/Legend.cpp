// SPDX-License-Identifier: BSD-3-Clause
// One swatch and one name a line.
#include "Legend.h"

#include <algorithm>
#include <map>
#include <utility>

#include "Palette.h"

namespace csom {

namespace {

constexpr int kLine = 22;
constexpr int kSwatch = 14;
constexpr int kGap = 8;
constexpr std::size_t kMostClasses = 30;
constexpr std::size_t kLongestName = 26;

std::string shorten(const std::string& name) {
  return name.size() <= kLongestName ? name : name.substr(0, kLongestName - 3) + "...";
}

}  // namespace

Legend::Legend(const ColumnGrid& grid, const LabelSet& labels) {
  addClasses(grid, labels);
  const auto& columns = grid.columns();
  if (std::any_of(columns.begin(), columns.end(),
                  [](const Column& column) { return column.state == VoxelState::Free; }))
    entries_.push_back({"free space", kFreeSpace});
  entries_.push_back({"unknown", kUnknown});
  for (const ClassId k : grid.leftOut()) {
    const LabelClass label = classOf(labels, k);
    entries_.push_back({shorten(label.name) + " (not drawn)", label.color});
  }
}

void Legend::addClasses(const ColumnGrid& grid, const LabelSet& labels) {
  std::map<ClassId, std::size_t> columns_of;
  for (const Column& column : grid.columns())
    if (column.state == VoxelState::Occupied) ++columns_of[column.top_class];
  std::vector<std::pair<ClassId, std::size_t>> sorted(columns_of.begin(), columns_of.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });

  const std::size_t shown = std::min(sorted.size(), kMostClasses);
  for (std::size_t i = 0; i < shown; ++i) {
    const LabelClass label = classOf(labels, sorted[i].first);
    entries_.push_back({shorten(label.name), label.color});
  }
  if (shown < sorted.size())
    entries_.push_back({"and " + std::to_string(sorted.size() - shown) + " more", kUnknown});
}

int Legend::width() const {
  int longest = 0;
  for (const Entry& entry : entries_) longest = std::max(longest, Canvas::textWidth(entry.name));
  return kSwatch + kGap + longest;
}

int Legend::height() const {
  return static_cast<int>(entries_.size()) * kLine;
}

void Legend::draw(Canvas& canvas, cv::Point corner) const {
  for (const Entry& entry : entries_) {
    const cv::Rect swatch(corner, cv::Size(kSwatch, kSwatch));
    canvas.rectangle(swatch, entry.color);
    canvas.frame(swatch, kFrame);
    canvas.text(entry.name, corner + cv::Point(kSwatch + kGap, kSwatch - 2), kInk);
    corner.y += kLine;
  }
}

}  // namespace csom
