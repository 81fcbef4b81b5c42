// SPDX-License-Identifier: BSD-3-Clause
// How the likelihood of an observation is computed.
#include <csom/core/EnumWords.h>
#include <csom/maps/LikelihoodOptions.h>

#include <cmath>

namespace csom {
namespace {

constexpr detail::EnumWords<LikelihoodMethod, 2> kMethods{
    {{LikelihoodMethod::Field, "field"}, {LikelihoodMethod::Beam, "beam"}}};

void requirePositive(const std::string& key, double value) {
  if (!(value > 0) || !std::isfinite(value))
    throw OptionError(key + " = " + toString(value) + " must be finite and greater than 0");
}

}  // namespace

std::string toString(LikelihoodMethod value) {
  return detail::wordOf(kMethods, value);
}

void parse(const std::string& key, const std::string& text, LikelihoodMethod& value) {
  detail::parseWord(kMethods, key, text, value);
}

void LikelihoodOptions::validate() const {
  requirePositive("decimation", decimation);
  requirePositive("max_distance", max_distance);
  requirePositive("sigma", sigma);
  if (!(semantic_weight >= 0) || !std::isfinite(semantic_weight))
    throw OptionError("semantic_weight = " + toString(semantic_weight) +
                      " must be finite and not negative");
  if (!(label_error > 0 && label_error <= 1))
    throw OptionError("label_error = " + toString(label_error) +
                      " must be greater than 0 and at most 1");
}

}  // namespace csom
