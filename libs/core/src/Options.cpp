// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Options.h>

namespace csom {

using detail::rejectOption;

namespace {

/// Checks a length that has its range from the resolution; 0 stands for a default.
void requireLength(const char* key, double value, double resolution, double longest) {
  if (value != 0) detail::requireInRange({key, "m", "", {resolution / 64, longest}}, value);
}

}  // namespace

void Options::validate() const {
  requireInRanges([&](auto&& visitor) { visitOptions(*this, visitor); });
  if (unlabelled_class_id < 0 || unlabelled_class_id >= number_of_classes)
    rejectOption("unlabelled_class_id", toString(unlabelled_class_id),
                 "0 to " + std::to_string(number_of_classes - 1));
  requireLength("ds_resolution", scan.ds_resolution, resolution, kAnyLength.max);
  if (scan.max_range > 0 && scan.max_range <= scan.min_range)
    rejectOption("max_range", toString(scan.max_range),
                 "0 (no limit) or more than min_range = " + toString(scan.min_range));
  if (free_space.mode == FreeSpace::Sampled)
    detail::requireInRange({"free_resolution", "m", "", {resolution / 64, kAnyLength.max}},
                           free_space.resolution);
  if (free_space.no_return && scan.max_range <= 0)
    rejectOption("free_no_return", toString(free_space.no_return),
                 "false, or a max_range up to which these beams are free");
  if (see_csom.context_neighbours != 6 && see_csom.context_neighbours != 18 &&
      see_csom.context_neighbours != 26)
    rejectOption("context_neighbours", toString(see_csom.context_neighbours), "6, 18 or 26");
  // A kernel of more than 64 voxels would look at millions of points for each voxel.
  const double longest = 64 * resolution;
  requireLength("kernel_length_min", kernel.length_min, resolution, longest);
  requireLength("kernel_length_max", kernel.length_max, resolution, longest);
  requireLength("kernel_length", kernel.length, resolution, longest);
  if (kernelLengthMax() < kernelLengthMin())
    rejectOption("kernel_length_max", toString(kernelLengthMax()),
                 "at least kernel_length_min = " + toString(kernelLengthMin()));
}

bool Options::usesImages() const {
  return detail::entryOf(method).uses_image && free_space.mode != FreeSpace::Sampled;
}

bool setOption(Options& options, const std::string& key, const std::string& text) {
  bool found = false;
  visitOptions(options, [&](const OptionInfo& option, auto& field) {
    if (key != option.key) return;
    found = true;
    parse(key, text, field);
  });
  return found;
}

bool mergeable(const Options& a, const Options& b) {
  return a.resolution == b.resolution && a.number_of_classes == b.number_of_classes &&
         a.unlabelled_class_id == b.unlabelled_class_id && a.prior == b.prior;
}

}  // namespace csom
