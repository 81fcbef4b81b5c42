// SPDX-License-Identifier: BSD-3-Clause
// The map that is measured, unless a benchmark says otherwise.
#pragma once

#include <csom/core/Options.h>

#include "Scans.h"

namespace csom::bench {

inline Options mapOptions() {
  Options options;
  options.number_of_classes = kClasses;
  options.method = Method::SeeCsom;
  options.resolution = 0.3;
  options.scan.ds_resolution = 0.2;
  return options;
}

}  // namespace csom::bench
