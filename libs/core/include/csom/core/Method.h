// SPDX-License-Identifier: BSD-3-Clause
// The methods by which a scan becomes counts: the one list of them.
#pragma once

#include <csom/core/CountIncrements.h>
#include <csom/core/EnumWords.h>

#include <array>
#include <cstddef>
#include <utility>

namespace csom {

struct Options;
struct PreparedScan;
struct ScanReport;

/// See docs/algorithm.md.
enum class Method { SurfaceCsom, SeeCsom, SBki, SCsm };

namespace detail {

/// One scan and the options → counts for voxels; adds what it did to the report. Depends on nothing
/// else: not on the map, on other scans, on threads. Equations: src/inference, src/surface and
/// src/image.
using InferenceFunction = ScanIncrements(const PreparedScan&, const Options&, ScanReport&);
InferenceFunction inferSurfaceCsom;
InferenceFunction inferSeeCsom;
InferenceFunction inferSCsm;

struct MethodEntry {
  Method method;
  const char* word;     ///< in ini files
  bool block_is_voxel;  ///< whatever block_depth says
  bool uses_image;      ///< of scans that have one
  InferenceFunction* infer;
};

constexpr std::array kMethods{
    MethodEntry{Method::SurfaceCsom, "surface-csom", false, true, inferSurfaceCsom},
    MethodEntry{Method::SeeCsom, "see-csom", false, false, inferSeeCsom},
    // Without both entropies, see Options.
    MethodEntry{Method::SBki, "s-bki", false, false, inferSeeCsom},
    MethodEntry{Method::SCsm, "s-csm", true, false, inferSCsm},
};

const MethodEntry& entryOf(Method method);

template <std::size_t... I>
constexpr EnumWords<Method, sizeof...(I)> methodWords(std::index_sequence<I...>) {
  return {{{kMethods[I].method, kMethods[I].word}...}};
}

}  // namespace detail

template <>
inline constexpr EnumWords<Method, detail::kMethods.size()> kWords<Method> =
    detail::methodWords(std::make_index_sequence<detail::kMethods.size()>());

}  // namespace csom
