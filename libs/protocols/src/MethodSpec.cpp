// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/eval/Baselines.h>
#include <csom/eval/CsomMapper.h>
#include <csom/protocols/MethodSpec.h>

#include <algorithm>
#include <sstream>

namespace csom {
namespace {

bool isEngineMethod(const std::string& name) {
  Method method;
  try {
    parse("method", name, method);
  } catch (const OptionError&) {
    return false;
  }
  return true;
}

/// What a trial fixes for all methods.
bool isFixed(const std::string& key) {
  return key == "resolution" || key == "number_of_classes" || key == "unlabelled_class_id" ||
         key == "method" || key == "threads";
}

}  // namespace

std::vector<std::string> defaultMethods() {
  std::vector<std::string> names;
  for (const detail::MethodEntry& entry : detail::kMethods) names.emplace_back(entry.word);
  for (const Baseline baseline : kBaselines) names.push_back(toString(baseline));
  return names;
}

MethodSpec MethodSpec::parse(const std::string& text) {
  MethodSpec spec;
  spec.text = text;
  std::istringstream parts(text);
  std::getline(parts, spec.name, ':');
  const bool is_baseline = baselineNamed(spec.name).has_value();
  if (!is_baseline && !isEngineMethod(spec.name)) {
    std::string known;
    for (const std::string& name : defaultMethods()) known += (known.empty() ? "" : ", ") + name;
    throw ConfigError("no method '" + spec.name + "'; there are " + known);
  }
  Options options;
  for (std::string setting; std::getline(parts, setting, ':');) {
    if (is_baseline) throw ConfigError("method '" + text + "': " + spec.name + " has no options");
    const std::size_t equals = setting.find('=');
    const std::string key = setting.substr(0, equals);
    if (equals == std::string::npos)
      throw ConfigError("method '" + text + "': '" + setting + "' must be KEY=VALUE");
    const std::string value = setting.substr(equals + 1);
    if (isFixed(key))
      throw ConfigError("method '" + text + "': the protocol says what " + key + " is");
    if (!setOption(options, key, value))
      throw ConfigError("method '" + text + "': there is no option '" + key + "'");
    if (!spec.settings.emplace(key, value).second)
      throw ConfigError("method '" + text + "': " + key + " is given twice");
  }
  return spec;
}

std::unique_ptr<Mapper> makeMapper(const MethodSpec& spec, const Options& given) {
  if (const auto baseline = baselineNamed(spec.name)) {
    BaselineOptions input;
    input.input = given;
    return makeBaseline(*baseline, input);
  }
  Options options = given;
  parse("method", spec.name, options.method);
  // What a method makes of beams is its own: that of the configurations for the default one.
  if (given.free_space.mode != FreeSpace::None && options.method == Options{}.method)
    options.free_space.mode = FreeSpace::Projective;
  for (const auto& [key, value] : spec.settings) setOption(options, key, value);
  if (given.free_space.mode == FreeSpace::None) options.free_space.mode = FreeSpace::None;
  return std::make_unique<CsomMapper>(options);
}

}  // namespace csom
