// SPDX-License-Identifier: BSD-3-Clause
// What the colours of a picture mean.
#pragma once

#include <csom/io/LabelSet.h>

#include <string>
#include <vector>

#include "Canvas.h"
#include "DrawnMap.h"

namespace csom {

/// The classes that a picture shows, the most frequent first, then free and unknown space and the
/// classes that were left out of it. Sizes are pixels.
class Legend {
 public:
  /// `colors`: by class id.
  Legend(const DrawnMap& drawn, const LabelSet& labels, const std::vector<Color>& colors);

  int width() const;
  int height() const;
  void draw(Canvas& canvas, cv::Point corner) const;

 private:
  struct Entry {
    std::string name;
    Color color;
  };

  void addClasses(const DrawnMap& drawn, const LabelSet& labels, const std::vector<Color>& colors);

  std::vector<Entry> entries_;
};

}  // namespace csom
