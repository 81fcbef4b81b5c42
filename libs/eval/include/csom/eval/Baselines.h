// SPDX-License-Identifier: BSD-3-Clause
// The methods of others that the map is compared with, by name.
#pragma once

#include <csom/core/Options.h>
#include <csom/eval/AkiMapMapper.h>
#include <csom/eval/BgkOctoMapMapper.h>
#include <csom/eval/GpOctoMapMapper.h>
#include <csom/eval/Mapper.h>
#include <csom/eval/OctoMapMapper.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace csom {

enum class Baseline { OctoMap, BgkOctoMapL, GpOctoMap, AkiMap };
constexpr std::array<Baseline, 4> kBaselines{Baseline::OctoMap, Baseline::BgkOctoMapL,
                                             Baseline::GpOctoMap, Baseline::AkiMap};

/// "octomap", "bgkoctomap-l", "gpoctomap", "akimap".
const char* toString(Baseline baseline);
/// Nothing if no baseline has that name.
std::optional<Baseline> baselineNamed(const std::string& name);

struct BaselineOptions {
  /// What the map of this library would be made with: every baseline is trained on the same points.
  /// Its method, kernels, filter and prior do not matter.
  Options input;
  OctoMapParameters octomap;
  BgkOctoMapParameters bgkoctomap_l;
  GpOctoMapParameters gpoctomap;
  AkiMapParameters akimap;
};

/// An empty map. Throws OptionError.
std::unique_ptr<Mapper> makeBaseline(Baseline kind, const BaselineOptions& options);

}  // namespace csom
