// SPDX-License-Identifier: BSD-3-Clause
// What the colours of a top view mean.
#pragma once

#include <csom/io/LabelSet.h>

#include <string>
#include <vector>

#include "Canvas.h"
#include "ColumnGrid.h"

namespace csom {

/// The classes that a raster shows, the most frequent first, then free and unknown space and the
/// classes that were left out of it. Sizes are pixels.
class Legend {
 public:
  Legend(const ColumnGrid& grid, const LabelSet& labels);

  int width() const;
  int height() const;
  void draw(Canvas& canvas, cv::Point corner) const;

 private:
  struct Entry {
    std::string name;
    Color color;
  };

  void addClasses(const ColumnGrid& grid, const LabelSet& labels);

  std::vector<Entry> entries_;
};

}  // namespace csom
