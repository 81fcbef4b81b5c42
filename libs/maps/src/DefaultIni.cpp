// SPDX-License-Identifier: BSD-3-Clause
// All keys of an ini file with their defaults and what they mean.
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/DefaultIni.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>

namespace csom {
namespace {

/// Writes sections of one map.
class IniText {
 public:
  void section(const std::string& suffix) {
    text_ += "\n[MappingApplication_semanticContinuousMap_00" + suffix + "]\n";
  }
  /// A section that is not there by default.
  void commentedSection(const std::string& suffix, const std::string& help) {
    text_ += "\n; " + help + "\n;[MappingApplication_semanticContinuousMap_00" + suffix + "]\n";
  }

  void key(const std::string& key, const std::string& value, const std::string& help) {
    // An empty value cannot be told from one that is missing.
    write(key, value, help, value.empty());
  }
  void commentedKey(const std::string& key, const std::string& value, const std::string& help) {
    write(key, value, help, true);
  }

  /// For the visitors of options.
  template <class Field>
  void operator()(const OptionInfo& option, const Field& field) {
    const std::string unit = option.unit;
    key(option.key, toString(field),
        fullHelp(option, field) + (unit.empty() ? "" : " [" + unit + "]"));
  }

  const std::string& text() const { return text_; }

 private:
  void write(const std::string& key, const std::string& value, const std::string& comment,
             bool commented_out) {
    text_ += "; " + comment + "\n" + (commented_out ? ";" : "") + key + " = " + value + "\n";
  }

  std::string text_ =
      "; Every key of a semantic map with its default (docs/ini-reference.md).\n\n"
      "[MappingApplication]\n; one semantic map\nsemanticContinuousMap_count = 1\n";
};

bool isIn(const char* key, std::initializer_list<const char*> keys) {
  return std::any_of(keys.begin(), keys.end(),
                     [&](const char* one) { return std::strcmp(key, one) == 0; });
}

void writeCreation(IniText& ini) {
  const Options options;
  const mrpt::maps::TMapGenericParams generic;
  ini.section("_creationOpts");
  ini.key(
      "label_set", "",
      "classes of the map: a path (relative to the ini file, or to the working folder where the "
      "application does not tell the file, as rbpf-slam and icp-slam do), or the name of one of "
      "the label sets that are installed; without it the map has two classes, free and "
      "occupied");
  visitOptions(options, [&](const OptionInfo& option, const auto& field) {
    if (isIn(option.key, {"resolution"})) ini(option, field);
  });
  // MRPT reads these itself, and does not know our words.
  const auto word = [](bool value) { return value ? "true" : "false"; };
  ini.key("enableObservationInsertion", word(generic.enableObservationInsertion),
          "MRPT: observations are inserted");
  ini.key("enableObservationLikelihood", word(generic.enableObservationLikelihood),
          "MRPT: the likelihood of observations is computed");
  ini.key("enableSaveAs3DObject", word(generic.enableSaveAs3DObject),
          "MRPT: the map is shown in 3-D views");
}

void writeInsertion(IniText& ini) {
  const CSemanticContinuousMap::TInsertionOptions insertion;
  const Options options;
  ini.section("_insertOpts");
  visitOptions(insertion, ini);
  visitOptions(options, [&](const OptionInfo& option, const auto& field) {
    // Those of the creation, and those that the label set says.
    if (!isIn(option.key, {"resolution", "number_of_classes", "unlabelled_class_id"}))
      ini(option, field);
  });
}

void writeLabelSource(IniText& ini) {
  const LabelSource source;
  ini.commentedSection("_labelSource_00",
                       "a camera that labels the points of scans, or a sensor that needs none; the "
                       "next one is _labelSource_01, without a gap");
  visitOptions(source, [&](const OptionInfo& option, const auto& field) {
    ini.commentedKey(option.key, toString(field), fullHelp(option, field));
  });
}

}  // namespace

std::string defaultIni() {
  const LabelOptions labels;
  const LikelihoodOptions likelihood;
  const RenderingOptions rendering;

  IniText ini;
  writeCreation(ini);
  writeInsertion(ini);
  ini.section("_labelOpts");
  visitOptions(labels, ini);
  ini.section("_likelihoodOpts");
  visitOptions(likelihood, ini);
  ini.section("_renderOpts");
  visitOptions(rendering, ini);
  writeLabelSource(ini);  // last: what is commented out ends no section
  return ini.text();
}

}  // namespace csom
