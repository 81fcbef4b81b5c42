// SPDX-License-Identifier: BSD-3-Clause
// The methods by which a scan becomes counts: the one list of them.
#pragma once

#include <csom/core/CountIncrements.h>

#include <array>
#include <string>

namespace csom {

struct Options;
struct PreparedScan;
struct ScanReport;

/// See docs/algorithm.md.
enum class Method { SurfaceCsom, SeeCsom, SBki, SCsm };

namespace detail {

/// One scan and the options → counts for voxels; adds what it did to the report. Depends on nothing
/// else: not on the map, on other scans, on threads. Equations: src/inference and src/surface.
using InferenceFunction = ScanIncrements(const PreparedScan&, const Options&, ScanReport&);
InferenceFunction inferSurfaceCsom;
InferenceFunction inferSeeCsom;
InferenceFunction inferSCsm;

struct MethodEntry {
  Method method;
  const char* word;     ///< in ini files
  bool block_is_voxel;  ///< whatever block_depth says
  InferenceFunction* infer;
};

constexpr std::array<MethodEntry, 4> kMethods{{
    {Method::SurfaceCsom, "surface-csom", false, inferSurfaceCsom},
    {Method::SeeCsom, "see-csom", false, inferSeeCsom},
    {Method::SBki, "s-bki", false, inferSeeCsom},  // without both entropies, see Options
    {Method::SCsm, "s-csm", true, inferSCsm},
}};

const MethodEntry& entryOf(Method method);

}  // namespace detail

/// "surface-csom", "see-csom" … Parsing throws OptionError with the accepted words.
std::string toString(Method value);
std::string acceptedWords(Method any);
void parse(const std::string& key, const std::string& text, Method& value);

}  // namespace csom
