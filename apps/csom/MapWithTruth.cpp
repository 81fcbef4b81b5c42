// SPDX-License-Identifier: BSD-3-Clause
#include "MapWithTruth.h"

#include <csom/core/Error.h>
#include <csom/io/TextParser.h>

namespace csom {

MapWithTruth loadMapWithTruth(const std::string& map, const std::string& truth) {
  MapWithTruth both{loadMap(map), loadMap(truth)};
  if (both.map.labels != both.truth.labels)
    throw ConfigError(map + " and " + truth + " have different label sets (" +
                      detail::quoted(both.map.labels.name()) + ", " +
                      detail::quoted(both.truth.labels.name()) + "): use one for both");
  const double of_map = both.map.map.options().resolution;
  const double of_truth = both.truth.map.options().resolution;
  if (of_map != of_truth)
    throw FileError(map, "scored against " + truth +
                             ": map and truth cannot be compared: resolution " + toString(of_map) +
                             " against " + toString(of_truth) + " m");
  if (both.truth.map.empty()) throw FileError(truth, "the truth is empty");
  return both;
}

}  // namespace csom
