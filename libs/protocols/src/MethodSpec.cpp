// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/eval/BgkOctoMapMapper.h>
#include <csom/eval/CsomMapper.h>
#include <csom/eval/OctoMapMapper.h>
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

template <class Baseline>
std::unique_ptr<Mapper> make(const Options& options) {
  return std::make_unique<Baseline>(options);
}

struct BaselineFactory {
  const char* name;
  std::unique_ptr<Mapper> (*make)(const Options&);
};

constexpr BaselineFactory kBaselines[] = {
    {"octomap", make<OctoMapMapper>},
    {"bgkoctomap-l", make<BgkOctoMapMapper>},
};

const BaselineFactory* findBaseline(const std::string& name) {
  for (const BaselineFactory& baseline : kBaselines)
    if (name == baseline.name) return &baseline;
  return nullptr;
}

/// What a trial fixes for all methods.
bool isFixed(const std::string& key) {
  return key == "resolution" || key == "number_of_classes" || key == "unlabelled_class_id" ||
         key == "method" || key == "threads";
}

}  // namespace

std::vector<std::string> defaultMethods() {
  std::vector<std::string> names{"s-csm", "s-bki", "see-csom"};
  for (const BaselineFactory& baseline : kBaselines) names.push_back(baseline.name);
  return names;
}

MethodSpec MethodSpec::parse(const std::string& text) {
  MethodSpec spec;
  spec.text = text;
  std::istringstream parts(text);
  std::getline(parts, spec.name, ':');
  const bool is_baseline = findBaseline(spec.name) != nullptr;
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
    spec.settings.emplace_back(key, value);
  }
  return spec;
}

std::unique_ptr<Mapper> makeMapper(const MethodSpec& spec, const Options& given) {
  if (const BaselineFactory* baseline = findBaseline(spec.name)) return baseline->make(given);
  Options options = given;
  parse("method", spec.name, options.method);
  for (const auto& [key, value] : spec.settings) setOption(options, key, value);
  if (given.free_space == FreeSpace::None) options.free_space = FreeSpace::None;
  return std::make_unique<CsomMapper>(options);
}

}  // namespace csom
