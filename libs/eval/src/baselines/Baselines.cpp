// SPDX-License-Identifier: BSD-3-Clause
#include <csom/eval/Baselines.h>

#include <stdexcept>

namespace csom {

const char* toString(Baseline baseline) {
  switch (baseline) {
    case Baseline::OctoMap:
      return "octomap";
    case Baseline::BgkOctoMapL:
      return "bgkoctomap-l";
    case Baseline::GpOctoMap:
      return "gpoctomap";
    case Baseline::AkiMap:
      return "akimap";
  }
  throw std::invalid_argument("no such baseline");
}

std::optional<Baseline> baselineNamed(const std::string& name) {
  for (const Baseline baseline : kBaselines)
    if (name == toString(baseline)) return baseline;
  return std::nullopt;
}

std::unique_ptr<Mapper> makeBaseline(Baseline kind, const BaselineOptions& options) {
  switch (kind) {
    case Baseline::OctoMap:
      return std::make_unique<OctoMapMapper>(options.input, options.octomap);
    case Baseline::BgkOctoMapL:
      return std::make_unique<BgkOctoMapMapper>(options.input, options.bgkoctomap_l);
    case Baseline::GpOctoMap:
      return std::make_unique<GpOctoMapMapper>(options.input, options.gpoctomap);
    case Baseline::AkiMap:
      return std::make_unique<AkiMapMapper>(options.input, options.akimap);
  }
  throw std::invalid_argument("no such baseline");
}

}  // namespace csom
