// SPDX-License-Identifier: BSD-3-Clause
// Makes the maps known to MRPT when the library is loaded.
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/CSemanticPointsMap.h>
#include <mrpt/maps/TMetricMapTypesRegistry.h>

// The fully qualified name is what CMultiMetricMap looks a class up by; the short ones are for ini
// files.
MAP_DEFINITION_REGISTER("csom::CSemanticContinuousMap,CSemanticContinuousMap,semanticContinuousMap",
                        csom::CSemanticContinuousMap)

MAP_DEFINITION_REGISTER("csom::CSemanticPointsMap,CSemanticPointsMap,semanticPointsMap",
                        csom::CSemanticPointsMap)

IMPLEMENTS_SERIALIZABLE(CSemanticContinuousMap, mrpt::maps::CMetricMap, csom)
IMPLEMENTS_SERIALIZABLE(CSemanticPointsMap, mrpt::maps::CSimplePointsMap, csom)

namespace {

// De-serialising looks the class up by its name. No MRPT_INITIALIZER: with clang that runs before
// the class ids above are there.
[[maybe_unused]] const bool registered = [] {
  mrpt::rtti::registerClass(CLASS_ID(csom::CSemanticContinuousMap));
  mrpt::rtti::registerClass(CLASS_ID(csom::CSemanticPointsMap));
  return true;
}();

}  // namespace
