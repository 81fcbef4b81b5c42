// SPDX-License-Identifier: BSD-3-Clause
// One swatch and one name a line.
#include "Legend.h"

#include <algorithm>
#include <utility>

#include "Palette.h"

namespace csom {

namespace {

constexpr int kLine = 22;
constexpr int kSwatch = 14;
constexpr int kGap = 8;
constexpr std::size_t kMaxShownClasses = 30;
constexpr std::size_t kLongestName = 26;

std::string shorten(const std::string& name) {
  return name.size() <= kLongestName ? name : name.substr(0, kLongestName - 3) + "...";
}

}  // namespace

Legend::Legend(const DrawnMap& drawn, const LabelSet& labels, const std::vector<Color>& colors) {
  addClasses(drawn, labels, colors);
  if (drawn.free_space) entries_.push_back({"free space", kFreeSpace});
  entries_.push_back({"unknown", kUnknown});
  for (const ClassId k : drawn.left_out)
    entries_.push_back({shorten(classOf(labels, k).name) + " (not drawn)", colors[k]});
}

void Legend::addClasses(const DrawnMap& drawn, const LabelSet& labels,
                        const std::vector<Color>& colors) {
  std::vector<std::pair<ClassId, std::size_t>> sorted(drawn.seen.begin(), drawn.seen.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });

  const std::size_t shown = std::min(sorted.size(), kMaxShownClasses);
  for (std::size_t i = 0; i < shown; ++i)
    entries_.push_back({shorten(classOf(labels, sorted[i].first).name), colors[sorted[i].first]});
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
