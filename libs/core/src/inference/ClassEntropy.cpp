// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/ClassEntropy.h>

#include <algorithm>
#include <cmath>

namespace csom {

float classEntropy(const std::vector<double>& class_mass) {
  double all = 0;
  double max = 0;
  int present = 0;
  for (const double mass : class_mass) {
    all += mass;
    max = std::max(max, mass);
    if (mass > 0) ++present;
  }
  if (present == 0) return 1.0F;
  if (present == 1) return 0.0F;  // as the equations say, without their logarithms
  const auto classes = static_cast<double>(class_mass.size());
  const double proportion = (all - max) / all;
  const double spread = std::log(present) / std::log(classes);
  return std::clamp(static_cast<float>(proportion + spread / classes), 0.0F, 1.0F);
}

float kernelLength(float class_entropy, const Options& options) {
  if (!options.usesClassEntropy()) return static_cast<float>(options.kernelLengthFixed());
  const auto min = static_cast<float>(options.kernelLengthMin());
  const auto max = static_cast<float>(options.kernelLengthMax());
  return min + class_entropy * (max - min);
}

}  // namespace csom
