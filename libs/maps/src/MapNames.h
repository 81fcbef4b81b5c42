// SPDX-License-Identifier: BSD-3-Clause
// What our maps are called in ini files.
#pragma once

#include <array>

namespace csom {

struct MapName {
  const char* name;
  bool is_points_map;  ///< MRPT takes it for a points map
};

/// As Registration.cpp makes them known to MRPT.
constexpr std::array<MapName, 6> kMapNames{{{"csom::CSemanticContinuousMap", false},
                                            {"CSemanticContinuousMap", false},
                                            {"semanticContinuousMap", false},
                                            {"csom::CSemanticPointsMap", true},
                                            {"CSemanticPointsMap", true},
                                            {"semanticPointsMap", true}}};

}  // namespace csom
