// SPDX-License-Identifier: BSD-3-Clause
// The images of one camera that scans may still need.
#include "ImageStream.h"

#include <algorithm>
#include <cmath>

namespace csom {
namespace {

bool isBefore(const StreamedImage& image, double time) {
  return image.time < time;
}

}  // namespace

bool ImageStream::add(StreamedImage image) {
  const auto place = std::lower_bound(images_.begin(), images_.end(), image.time, isBefore);
  if (place != images_.end() && place->time == image.time) return false;
  images_.insert(place, std::move(image));
  if (images_.size() > kCapacity) images_.pop_front();
  return true;
}

StreamedImage* ImageStream::nearest(double time, double max_offset) {
  const auto after = std::lower_bound(images_.begin(), images_.end(), time, isBefore);
  StreamedImage* best = nullptr;
  if (after != images_.begin()) best = &*std::prev(after);
  if (after != images_.end() && (best == nullptr || after->time - time < time - best->time))
    best = &*after;
  return best != nullptr && std::abs(best->time - time) <= max_offset ? best : nullptr;
}

void ImageStream::forgetBefore(double time) {
  while (!images_.empty() && images_.front().time < time) images_.pop_front();
}

}  // namespace csom
