// SPDX-License-Identifier: BSD-3-Clause
// All keys of an ini file with their defaults and what they mean.
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/DefaultIni.h>

#include <cstring>

namespace csom {
namespace {

/// Writes sections of one map.
class IniText {
 public:
  void section(const std::string& suffix) {
    text_ += "\n[MappingApplication_semanticContinuousMap_00" + suffix + "]\n";
  }

  void key(const std::string& key, const std::string& value, const std::string& unit,
           const std::string& help) {
    text_ += "; " + help + (unit.empty() ? "" : " [" + unit + "]") + "\n";
    // An empty value cannot be told from one that is missing.
    text_ += (value.empty() ? ";" : "") + key + " = " + value + "\n";
  }

  /// For the visitors of options.
  template <class Field>
  void operator()(const char* name, const Field& field, const char* unit, const char* help) {
    key(name, toString(field), unit, help);
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_ =
      "; Every key of a semantic map with its default (docs/ini-reference.md).\n\n"
      "[MappingApplication]\n; one semantic map\nsemanticContinuousMap_count = 1\n";
};

bool comesFromLabelSet(const char* key) {
  return std::strcmp(key, "number_of_classes") == 0 || std::strcmp(key, "unlabelled_class_id") == 0;
}

}  // namespace

std::string defaultIni() {
  const CSemanticContinuousMap::TInsertionOptions insertion;
  const Options options;
  const LabelOptions labels;
  const LikelihoodOptions likelihood;
  const CSemanticContinuousMap::TRenderingOptions rendering;

  IniText ini;
  ini.section("_creationOpts");
  ini.key("label_set", "", "",
          "classes of the map: a name or a path; without it free and occupied");
  ini.section("_insertOpts");
  visitInsertionOptions(insertion, ini);
  visitOptions(options,
               [&](const char* key, const auto& field, const char* unit, const char* help) {
                 if (!comesFromLabelSet(key)) ini(key, field, unit, help);
               });
  ini.section("_labelOpts");
  visitLabelOptions(labels, ini);
  ini.section("_likelihoodOpts");
  visitLikelihoodOptions(likelihood, ini);
  ini.section("_renderOpts");
  visitRenderingOptions(rendering, ini);
  return ini.text();
}

}  // namespace csom
