// SPDX-License-Identifier: BSD-3-Clause
// Camera images of a run, as pictures.
#pragma once

#include <csom/core/types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace csom {

/// One camera image in two pictures, each a JPEG file.
struct CameraPicture {
  enum class Moment { First, Middle, Last };  ///< of the run

  Moment moment = Moment::First;
  std::string sensor_label;
  double timestamp = 0;                    ///< of the image [s since 1970, UTC]
  std::size_t frame = 0;                   ///< number of the image of this camera, from 0
  std::vector<std::uint8_t> segmentation;  ///< the image tinted by class
  std::vector<std::uint8_t> points;        ///< the points over it, in the colours of their classes
  std::vector<ClassId> classes;            ///< those that the pictures show
};
const char* toString(CameraPicture::Moment moment);

}  // namespace csom
