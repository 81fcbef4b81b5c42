// SPDX-License-Identifier: BSD-3-Clause
// Names of observation classes as reports show them.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <string>

namespace csom {

/// "CObservationVelodyneScan", without namespaces.
inline std::string observationName(const mrpt::obs::CObservation& observation) {
  const std::string name = observation.GetRuntimeClass()->className;
  return name.substr(name.rfind(':') + 1);
}

}  // namespace csom
