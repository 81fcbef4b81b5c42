// SPDX-License-Identifier: BSD-3-Clause
// Makes the map known to MRPT when the library is loaded.
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/core/initializer.h>
#include <mrpt/maps/TMetricMapTypesRegistry.h>

// The fully qualified name is what CMultiMetricMap looks a class up by; the short ones are for ini
// files.
MAP_DEFINITION_REGISTER("csom::CSemanticContinuousMap,CSemanticContinuousMap,semanticContinuousMap",
                        csom::CSemanticContinuousMap)

IMPLEMENTS_SERIALIZABLE(CSemanticContinuousMap, mrpt::maps::CMetricMap, csom)

// De-serialising looks the class up by its name.
MRPT_INITIALIZER(registerSemanticContinuousMap) {
  mrpt::rtti::registerClass(CLASS_ID(csom::CSemanticContinuousMap));
}
