// SPDX-License-Identifier: BSD-3-Clause
// What cameras saw at the beginning, in the middle and at the end of a run, for its report.
#pragma once

#include <csom/io/LabelSet.h>
#include <csom/maps/LabelledScan.h>
#include <csom/report/CameraPicture.h>

#include <vector>

namespace csom {

/// Two pictures for each view of the scan.
std::vector<CameraPicture> cameraPictures(const LabelledScan& scan, CameraPicture::Moment moment,
                                          const LabelSet& labels);

}  // namespace csom
