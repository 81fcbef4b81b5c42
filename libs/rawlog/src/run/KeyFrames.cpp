// SPDX-License-Identifier: BSD-3-Clause
#include "run/KeyFrames.h"

#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <memory>

#include "logs/ExternalFiles.h"

namespace csom::detail {

void KeyFrames::add(const mrpt::obs::CObservation::Ptr& observation,
                    const mrpt::poses::CPose3D& pose) {
  if (!open_ || !(pose_ == pose)) {
    open_ = std::make_shared<mrpt::obs::CSensoryFrame>();
    pose_ = pose;
    const mrpt::poses::CPose3DPDF::Ptr exact =
        std::make_shared<mrpt::poses::CPose3DPDFGaussian>(pose);
    frames_.insert(exact, open_);
  }
  open_->insert(withAbsoluteImagePaths(observation));
}

}  // namespace csom::detail
