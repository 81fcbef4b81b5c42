// SPDX-License-Identifier: BSD-3-Clause
// Uniform and normal numbers from the standard's one fully specified engine.
#include <csom/eval/Random.h>

#include <cmath>

namespace csom {
namespace {

/// The output function of SplitMix64: spreads neighbouring seeds over all 64 bits.
std::uint64_t spread(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : engine_(spread(spread(seed) ^ stream)) {}

double Random::uniform() {
  return static_cast<double>(engine_() >> 11) * 0x1.0p-53;
}

double Random::gaussian() {
  constexpr double kTwoPi = 6.283185307179586;
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(kTwoPi * uniform());
}

}  // namespace csom
