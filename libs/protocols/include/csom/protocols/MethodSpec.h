// SPDX-License-Identifier: BSD-3-Clause
// A method by name, with settings of its own.
#pragma once

#include <csom/core/Options.h>
#include <csom/eval/Mapper.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace csom {

/// "see-csom", "octomap", or "see-csom:rvfm=off:block_depth=1": a method of the engine with options
/// by their names in ini files.
struct MethodSpec {
  std::string text;  ///< as given
  std::string name;
  std::map<std::string, std::string> settings;

  /// Throws ConfigError for a name that is no method, or for an option that is none of the
  /// engine's; baselines take no settings.
  static MethodSpec parse(const std::string& text);
};

/// All that are compared if nothing else is asked for.
std::vector<std::string> defaultMethods();

/// An empty map of this method. `options` are those of the trial; settings go before them, but for
/// free space where the trial has none. Where it has some, that of the default method is
/// projective, as in the configurations. Throws OptionError.
std::unique_ptr<Mapper> makeMapper(const MethodSpec& spec, const Options& options);

}  // namespace csom
