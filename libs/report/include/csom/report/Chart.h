// SPDX-License-Identifier: BSD-3-Clause
// Charts as parts of a page: drawn by a script, readable as a table where there is none.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace csom {

struct ChartAxis {
  std::string title;
  std::string unit;          ///< "ms", "m³", … or empty
  bool logarithmic = false;  ///< values that are not positive are then left out
  std::optional<double> min;
  std::optional<double> max;
};

/// A value that is not finite leaves a gap.
struct ChartPoint {
  double x = 0;
  double y = 0;
};

struct ChartSeries {
  enum class Marks { Line, Points, LineAndPoints };

  std::string name;
  std::vector<ChartPoint> points;
  Marks marks = Marks::Line;
  bool dashed = false;  ///< for references, as "chance" or "published"
};

/// Curves or clouds of points over a numeric axis.
struct XyChart {
  std::string title;
  std::string summary;  ///< what it shows, in a sentence: the text alternative
  ChartAxis x;
  ChartAxis y;
  std::vector<ChartSeries> series;
};

struct BarSeries {
  std::string name;
  std::vector<double> values;  ///< one a category; not finite: no bar
};

struct BarChart {
  std::string title;
  std::string summary;
  std::vector<std::string> categories;
  ChartAxis values;
  std::vector<BarSeries> series;
  bool stacked = false;
  bool horizontal = false;  ///< for categories with long names
};

/// A <figure> for an HtmlPage with charts: the canvas, its text alternative, and the figures as a
/// table that can be unfolded (of long series their extent only). Every text is escaped. Throws
/// std::invalid_argument if a series of bars has not as many values as there are categories.
std::string toHtml(const XyChart& chart);
std::string toHtml(const BarChart& chart);

}  // namespace csom
