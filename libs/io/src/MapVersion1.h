// SPDX-License-Identifier: BSD-3-Clause
// What is different in map files of format version 1.
#pragma once

#include <csom/io/MapFile.h>

#include <string>

#include "MapHashes.h"

namespace csom::detail::version1 {

/// XXH3 over resolution, classes, prior and all chunks in order. A run.json of that time has it
/// too.
std::string computeDigest(const SemanticMap& map);

/// Over what the document holds beside its chunks; `options` are those that the file has.
std::string computeChecksum(const MapDocument& document, const Texts& options);

}  // namespace csom::detail::version1
