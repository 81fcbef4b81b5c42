// SPDX-License-Identifier: BSD-3-Clause
// Will a program of MRPT find the semantic map in its ini file?
#include <csom/core/Error.h>
#include <csom/io/TextParser.h>
#include <csom/maps/ApplicationIni.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <mrpt/config/CConfigFile.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "IniSection.h"
#include "MapNames.h"

namespace csom {
namespace {

using mrpt::config::CConfigFile;

/// More of one kind are a slip of the pen, and would take a while to be read.
constexpr int kMaxMaps = 99;

/// MRPT's own maps that icp-slam and rbpf-slam's optimal proposal can align scans to.
constexpr const char* kAlignable[] = {
    "pointsMap",     "mrpt::maps::CSimplePointsMap",    "CSimplePointsMap",
    "occupancyGrid", "mrpt::maps::COccupancyGridMap2D", "COccupancyGridMap2D"};

const std::vector<MrptApplication>& applications() {
  static const std::vector<MrptApplication> all{
      {"observations2map", "MappingApplication", "", true},
      {"icp-slam", "MappingApplication", "", true},
      {"rbpf-slam", "MappingApplication", "", true},
      {"pf-localization", "MetricMap", "", true},
      {"map-partition", "PARAMS.metricmap", "MAP-PARTITION_CONFIG.ini", false},
      {"grid-matching", "metric_maps", "", false},
      {"rawlog-edit", "", "", false},
      {"RawLogViewer", "", "", false},
      {"SceneViewer3D", "", "", false}};
  return all;
}

/// `semanticContinuousMap_count = 1` and the like.
struct Definition {
  std::string section;
  std::string name;
  bool is_points_map = false;
  int count = 0;
};

/// The ini file, asked for maps.
class MapsOfIni {
 public:
  explicit MapsOfIni(const std::string& file) : file_(file) {
    openIni(file, ini_);
    ini_.getAllSections(sections_);
    for (const std::string& section : sections_) readSection(section);
  }

  const std::string& file() const { return file_; }
  const CConfigFile& ini() const { return ini_; }
  const std::vector<std::string>& sections() const { return sections_; }
  const std::vector<Definition>& definitions() const { return definitions_; }
  /// "FILE [section] key" of keys that look as if they should define a semantic map, but do not.
  const std::vector<std::string>& misspelt() const { return misspelt_; }

  int number(const std::string& section, const std::string& key) const {
    IniSection reader(ini_, section);
    int value = 0;
    reader.read(key, value);
    return value;
  }

 private:
  void readSection(const std::string& section) {
    std::vector<std::string> keys;
    ini_.getAllKeys(section, keys);
    for (const std::string& key : keys) {
      const std::string lower = detail::lowerCase(key);
      const auto name =
          std::find_if(std::begin(kMapNames), std::end(kMapNames), [&](const MapName& candidate) {
            return lower == detail::lowerCase(candidate.name) + "_count";
          });
      if (name != std::end(kMapNames)) {
        const int count = number(section, key);
        if (count > kMaxMaps)
          throw ConfigError(IniSection(ini_, section).place() + " " + key + " = " +
                            toString(count) + " must be " + toString(kMaxMaps) + " at most");
        definitions_.push_back({section, name->name, name->is_points_map, count});
      } else if (lower.find("semantic") != std::string::npos &&
                 lower.find("count") != std::string::npos) {
        misspelt_.push_back(IniSection(ini_, section).place() + " " + key);
      }
    }
  }

  std::string file_;
  CConfigFile ini_;
  std::vector<std::string> sections_;
  std::vector<Definition> definitions_;
  std::vector<std::string> misspelt_;
};

std::string wanted(const std::string& section) {
  return "'semanticContinuousMap_count = 1' in [" + section + "]";
}

/// Why no semantic map comes from the section that the program reads.
[[noreturn]] void throwNoMap(const MapsOfIni& maps, const MrptApplication* application) {
  const std::string section = application == nullptr ? "MappingApplication" : application->section;
  if (!maps.misspelt().empty())
    throw ConfigError(maps.misspelt().front() +
                      ": MRPT knows no such map and would pass over it; write " + wanted(section));
  for (const Definition& definition : maps.definitions()) {
    const std::string place = maps.file() + " [" + definition.section + "] " + definition.name +
                              "_count = " + toString(definition.count);
    if (definition.count > 0 && application != nullptr)
      throw ConfigError(place + ": " + application->program + " reads [" + section +
                        "] and would pass over it; write it there");
    throw ConfigError(place + " makes no map; set it to 1");
  }
  throw ConfigError(maps.file() + ": defines no semantic map; write " + wanted(section));
}

/// icp-slam always aligns scans to a map, rbpf-slam if its particles are drawn that way.
bool alignsScans(const MapsOfIni& maps, const MrptApplication& application) {
  constexpr int kOptimalProposal = 2;
  if (application.program == "icp-slam") return true;
  return application.program == "rbpf-slam" &&
         maps.number(application.section, "PF_algorithm") == kOptimalProposal;
}

void requireSomethingToAlignTo(const MapsOfIni& maps, const MrptApplication& application,
                               const std::vector<Definition>& used) {
  if (!alignsScans(maps, application)) return;
  for (const Definition& definition : used)
    if (definition.is_points_map) return;
  for (const char* name : kAlignable)
    if (maps.number(application.section, std::string(name) + "_count") > 0) return;
  throw ConfigError(maps.file() + " [" + application.section + "] " + used.front().name +
                    "_count: " + application.program +
                    " aligns scans to points maps and grid maps alone; name the map "
                    "semanticPointsMap, here and in its sections");
}

/// Reads the sections of one map as MRPT will; returns what is not read.
std::vector<std::string> readDefinition(const CConfigFile& ini, const std::string& prefix) {
  CSemanticContinuousMap::TMapDefinition definition;
  definition.load(ini, prefix);
  return definition.unknownKeys();
}

std::string numbered(const Definition& definition, int number) {
  return definition.section + "_" + definition.name + (number < 10 ? "_0" : "_") +
         std::to_string(number);
}

}  // namespace

const MrptApplication* findApplication(const std::string& program) {
  const std::string name = std::filesystem::path(program).filename();
  for (const MrptApplication& application : applications())
    if (application.program == name) return &application;
  return nullptr;
}

std::vector<std::string> checkApplicationIni(const std::string& file,
                                             const MrptApplication* application) {
  const MapsOfIni maps(file);
  std::vector<Definition> used;
  for (const Definition& definition : maps.definitions()) {
    const bool is_read = application == nullptr || detail::lowerCase(definition.section) ==
                                                       detail::lowerCase(application->section);
    if (is_read && definition.count > 0) used.push_back(definition);
  }
  if (used.empty()) throwNoMap(maps, application);
  for (const Definition& definition : used) requireGivenOnce(file, definition.section);
  if (application != nullptr) requireSomethingToAlignTo(maps, *application, used);

  std::vector<std::string> unread;
  std::set<std::string> prefixes;  // of sections that are read, in lower case
  for (const Definition& definition : used) {
    for (int number = 0; number < definition.count; ++number) {
      const std::string prefix = numbered(definition, number);
      for (const std::string& key : readDefinition(maps.ini(), prefix))
        unread.push_back(key + ": unknown key, ignored");
      prefixes.insert(detail::lowerCase(prefix) + "_");
    }
  }
  const std::string start =
      application == nullptr ? "" : detail::lowerCase(application->section) + "_";
  for (const std::string& section : maps.sections()) {
    const std::string lower = detail::lowerCase(section);
    if (lower.compare(0, start.size(), start) != 0) continue;
    if (lower.find("semantic") == std::string::npos) continue;
    const bool is_read = std::any_of(prefixes.begin(), prefixes.end(), [&](const auto& prefix) {
      return lower.compare(0, prefix.size(), prefix) == 0;
    });
    if (!is_read)
      unread.push_back(file + " [" + section + "]: no map of that name and number, ignored");
  }
  return unread;
}

std::vector<std::string> listOutputFolders(const std::string& ini_file) {
  constexpr char kKey[] = "logOutput_dir";
  CConfigFile ini;
  openIni(ini_file, ini);
  std::vector<std::string> sections;
  ini.getAllSections(sections);
  std::vector<std::string> folders;
  for (const std::string& name : sections) {
    IniSection section(ini, name);
    if (!section.has(kKey)) continue;
    const std::string folder = section.text(kKey);
    if (!folder.empty()) folders.push_back(folder);
  }
  return folders;
}

}  // namespace csom
