// SPDX-License-Identifier: BSD-3-Clause
// The map as ini files define it.
#include <csom/core/Error.h>
#include <csom/io/TextParser.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/config/CConfigFile.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <type_traits>

#include "IniSection.h"
#include "MapNames.h"

namespace csom {
namespace {

using mrpt::config::CConfigFileBase;

/// Keys that MRPT itself reads from the section of creation options.
constexpr const char* kGenericKeys[] = {"enableSaveAs3DObject", "enableObservationLikelihood",
                                        "enableObservationInsertion"};

template <class OptionsLike>
void readOptions(IniSection& section, OptionsLike& options) {
  visitOptions(options, [&](const OptionInfo& option, auto& field) {
    // The label set says it, by a name.
    if (std::strcmp(option.key, "unlabelled_class_id") != 0) section.read(option.key, field);
  });
}

void readLikelihood(IniSection& section, CSemanticContinuousMap::TLikelihoodOptions& options) {
  readOptions(section, options);
  try {
    options.validate();
  } catch (const OptionError& error) {
    throw ConfigError(section.place() + ": " + error.what());
  }
}

template <class Value>
void dump(std::ostream& out, const std::string& key, const Value& value) {
  out << key << std::string(key.size() < 40 ? 40 - key.size() : 1, ' ') << "= " << value << "\n";
}

template <class OptionsLike>
void dumpOptions(std::ostream& out, const OptionsLike& options) {
  visitOptions(options, [&](const OptionInfo& option, const auto& field) {
    dump(out, option.key, toString(field));
  });
}

/// A file of the ini, relative to its folder or else to the working folder, as an absolute path.
/// Throws ConfigError if it does not exist.
std::string existingFile(const std::string& path, const IniSection& section,
                         const CConfigFileBase& source, const std::string& key) {
  namespace fs = std::filesystem;
  const fs::path beside = fs::path(fileOf(source)).parent_path() / path;
  for (const fs::path& candidate : {beside, fs::path(path)}) {
    std::error_code error;
    if (fs::is_regular_file(candidate, error)) return fs::absolute(candidate).lexically_normal();
  }
  throw ConfigError(section.place() + ": " + key + " = " + path + ": no such file; looked for " +
                    beside.string() + " and " + path);
}

LabelSource readLabelSource(IniSection& section, const CConfigFileBase& source) {
  LabelSource label_source;
  readOptions(section, label_source);
  if (label_source.kind == LabelSource::Kind::Network) {
    if (!label_source.network.empty())
      label_source.network = existingFile(label_source.network, section, source, "network");
    if (!label_source.model.empty())
      label_source.model = existingFile(label_source.model, section, source, "model");
  }
  return label_source;
}

/// Reads the sections of one map and collects what nothing has read.
class DefinitionReader {
 public:
  DefinitionReader(const CConfigFileBase& source, const std::string& prefix)
      : source_(source), prefix_(prefix) {}

  /// `read(IniSection&)` for each spelling of a section, whether it is there or not.
  template <class Read>
  void section(const std::vector<std::string>& suffixes, Read&& read) {
    for (const std::string& suffix : suffixes) {
      IniSection section(source_, prefix_ + suffix);
      read(section);
      known_.insert(detail::lowerCase(prefix_ + suffix));
      const std::vector<std::string> unread = section.unreadKeys();
      unknown_.insert(unknown_.end(), unread.begin(), unread.end());
    }
  }

  std::vector<std::string> unknown() const {
    std::vector<std::string> all = unknown_;
    std::vector<std::string> sections;
    source_.getAllSections(sections);
    const std::string start = detail::lowerCase(prefix_ + "_");
    for (const std::string& name : sections) {
      const std::string lower = detail::lowerCase(name);
      if (lower.compare(0, start.size(), start) != 0 || known_.count(lower) != 0) continue;
      std::vector<std::string> keys;
      source_.getAllKeys(name, keys);
      for (const std::string& key : keys)
        all.push_back(IniSection(source_, name).place() + " " + key);
    }
    return all;
  }

 private:
  const CConfigFileBase& source_;
  std::string prefix_;
  std::set<std::string> known_;  ///< in lower case
  std::vector<std::string> unknown_;
};

LabelSet loadLabels(const std::string& name, const CConfigFileBase& source,
                    const std::string& place) {
  const std::string file = fileOf(source);
  const std::string folder =
      file.empty() ? std::string() : std::filesystem::path(file).parent_path().string();
  try {
    return LabelSet::load(LabelSet::find(name, folder));
  } catch (const ConfigError& error) {
    throw ConfigError(place + ": label_set = " + name + ": " + error.what());
  }
}

/// Throws ConfigError in the terms of the ini file for options that cannot be.
void check(const CSemanticContinuousMap::TMapDefinition& definition, const std::string& place) {
  try {
    definition.options.validate();
    definition.labelOpts.validate();
    LabelRules(definition.labels, definition.insertionOpts.point_labels,
               definition.insertionOpts.unlabelled_class, definition.insertionOpts.scan_2d_class);
  } catch (const ConfigError& error) {  // OptionErrors too
    throw ConfigError(place + ": " + error.what());
  }
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

}  // namespace

CSemanticContinuousMap::TMapDefinition::TMapDefinition() = default;

void CSemanticContinuousMap::TMapDefinition::load(const CConfigFileBase& source,
                                                  const std::string& section_prefix) {
  if (const std::string file = fileOf(source); !file.empty())
    requireGivenOnce(file, section_prefix);
  DefinitionReader reader(source, section_prefix);
  std::string label_set;
  bool number_of_classes_given = false;
  reader.section({"_creationOpts"}, [&](IniSection& section) {
    genericMapParams.loadFromConfigFile(source, section_prefix + "_creationOpts");
    for (const char* key : kGenericKeys) section.has(key);
    section.read("label_set", label_set);
    number_of_classes_given |= section.has("number_of_classes");
    readOptions(section, options);
  });
  reader.section({"_insertOpts", "_insertionOpts"}, [&](IniSection& section) {
    number_of_classes_given |= section.has("number_of_classes");
    readOptions(section, options);
    readOptions(section, insertionOpts);
  });
  reader.section({"_likelihoodOpts"},
                 [&](IniSection& section) { readLikelihood(section, likelihoodOpts); });
  reader.section({"_renderOpts"}, [&](IniSection& section) { readOptions(section, renderOpts); });
  reader.section({"_labelOpts"}, [&](IniSection& section) { readOptions(section, labelOpts); });
  labelOpts.sources.clear();
  for (int number = 0; number < 100; ++number) {
    const std::string suffix =
        std::string("_labelSource_") + (number < 10 ? "0" : "") + std::to_string(number);
    if (!source.sectionExists(section_prefix + suffix)) break;
    reader.section({suffix}, [&](IniSection& section) {
      labelOpts.sources.push_back(readLabelSource(section, source));
    });
  }
  unknown_keys_ = reader.unknown();

  const std::string place = IniSection(source, section_prefix + "_*").place();
  if (!label_set.empty()) labels = loadLabels(label_set, source, place);
  if (labelOpts.usesCameras() && labelOpts.outside_view == OutsideView::Unlabelled)
    labels = labels.withUnlabelledClass();
  for (const std::string& name : {insertionOpts.unlabelled_class, insertionOpts.scan_2d_class})
    if (name == kUnlabelledClass) labels = labels.withUnlabelledClass();
  if (number_of_classes_given && options.number_of_classes != labels.numberOfClasses()) {
    throw ConfigError(place + ": number_of_classes = " + toString(options.number_of_classes) +
                      ", but label set '" + labels.name() + "' has " +
                      toString(labels.numberOfClasses()) + "; leave the key out");
  }
  options.number_of_classes = labels.numberOfClasses();
  options.unlabelled_class_id = labels.unlabelledClass();
  check(*this, place);
}

void CSemanticContinuousMap::TMapDefinition::loadFromConfigFile_map_specific(
    const CConfigFileBase& source, const std::string& section_prefix) {
  load(source, section_prefix);
  // MRPT's applications have no other way to tell their user.
  for (const std::string& key : unknown_keys_)
    std::cerr << "csom: warning: " << key << ": unknown key, ignored\n";
}

void CSemanticContinuousMap::TMapDefinition::dumpToTextStream_map_specific(
    std::ostream& out) const {
  dump(out, "label_set", labels.name());
  dumpOptions(out, options);
  dumpOptions(out, insertionOpts);
  dumpOptions(out, likelihoodOpts);
  dumpOptions(out, renderOpts);
  dumpOptions(out, labelOpts);
  for (const LabelSource& source : labelOpts.sources) dumpOptions(out, source);
}

CreatedMap CSemanticContinuousMap::internal_CreateFromMapDefinition(
    const mrpt::maps::TMetricMapInitializer& definition) {
  return CreatedMap(new CSemanticContinuousMap(dynamic_cast<const TMapDefinition&>(definition)));
}

CSemanticContinuousMap::CSemanticContinuousMap(const TMapDefinition& definition)
    : CSemanticContinuousMap(definition.options, definition.labels) {
  genericMapParams = definition.genericMapParams;
  insertionOptions = definition.insertionOpts;
  likelihoodOptions = definition.likelihoodOpts;
  renderingOptions = definition.renderOpts;
  labelOptions = definition.labelOpts;
  labelRules();  // throws for classes that are not in the label set
}

CSemanticContinuousMap::TMapDefinition CSemanticContinuousMap::definitionFromIni(
    const std::string& file, const std::string& application_section) {
  mrpt::config::CConfigFile ini;
  openIni(file, ini);
  requireGivenOnce(file, application_section);

  IniSection section(ini, application_section);
  std::int64_t maps = 0;
  std::string defined;
  std::vector<std::string> count_keys;
  for (const auto& [name, is_points_map] : kMapNames) {
    if (is_points_map) continue;
    const std::string key = std::string(name) + "_count";
    count_keys.push_back(key);
    int count = 0;
    section.read(key, count);
    if (count < 0)
      throw ConfigError(section.place() + ": " + key + " = " + toString(count) +
                        " must not be negative");
    if (count > 0) defined = name;
    maps += count;
  }
  if (maps != 1) {
    throw ConfigError(section.place() + " defines " + std::to_string(maps) +
                      " semantic maps; set exactly one of these keys to 1: " + joined(count_keys));
  }
  TMapDefinition definition;
  definition.load(ini, application_section + "_" + defined + "_00");
  return definition;
}

void CSemanticContinuousMap::TInsertionOptions::loadFromConfigFile(const CConfigFileBase& source,
                                                                   const std::string& section) {
  IniSection ini(source, section);
  readOptions(ini, *this);
}

void CSemanticContinuousMap::TInsertionOptions::dumpToTextStream(std::ostream& out) const {
  dumpOptions(out, *this);
}

void CSemanticContinuousMap::TLikelihoodOptions::loadFromConfigFile(const CConfigFileBase& source,
                                                                    const std::string& section) {
  IniSection ini(source, section);
  readLikelihood(ini, *this);
}

void CSemanticContinuousMap::TLikelihoodOptions::dumpToTextStream(std::ostream& out) const {
  dumpOptions(out, *this);
}

void CSemanticContinuousMap::TRenderingOptions::loadFromConfigFile(const CConfigFileBase& source,
                                                                   const std::string& section) {
  IniSection ini(source, section);
  readOptions(ini, *this);
}

void CSemanticContinuousMap::TRenderingOptions::dumpToTextStream(std::ostream& out) const {
  dumpOptions(out, *this);
}

}  // namespace csom
