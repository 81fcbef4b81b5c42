// SPDX-License-Identifier: BSD-3-Clause
// The classes of a map: names, colours, and how raw ids of a data set become them.
#pragma once

#include <csom/core/types.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace csom {

using Color = std::array<std::uint8_t, 3>;  ///< red, green, blue

struct LabelClass {
  ClassId id = 0;
  std::string name;
  Color color{128, 128, 128};
};

/// A label set (config/labels/*.yaml). Class 0 is free; the ids run from 0 to K−1 without a gap.
///
///     name: semantickitti
///     classes:
///       - {id: 0, name: free, color: [255, 255, 255]}
///       - {id: 1, name: car, color: [245, 150, 100]}
///     raw:            # raw id of the data set → class id or `ignore`; without this key raw ids are
///       0: ignore     # class ids
///       10: 1
class LabelSet {
 public:
  /// What a raw id of a data set stands for.
  enum class RawKind { Class, Ignored, Unknown };
  struct Raw {
    RawKind kind = RawKind::Unknown;
    ClassId id = kFreeClass;
  };

  /// Free and occupied: the label set of a map that was given none.
  static LabelSet occupancy();
  /// Throws FileError naming the file and line.
  static LabelSet load(const std::string& file);
  /// The inverse of toYaml(); `origin` names the text in errors.
  static LabelSet fromYaml(const std::string& text, const std::string& origin);

  /// The file of a label set given as a path or as a bare name ("semantickitti"): the path itself
  /// (relative to `base_folder`, then to the working folder), else NAME.yaml in the folders of
  /// $CSOM_LABELS_PATH (separated by ':'), else in ../share/mrpt_csom/labels beside the folder of the program
  /// or library that holds this code. Throws ConfigError that lists where it looked.
  static std::string find(const std::string& name_or_path, const std::string& base_folder = "");

  const std::string& name() const { return name_; }
  int numberOfClasses() const { return static_cast<int>(classes_.size()); }
  const std::vector<LabelClass>& classes() const { return classes_; }
  /// Requires id < numberOfClasses().
  const LabelClass& at(ClassId id) const { return classes_[id]; }

  Raw classOfRaw(std::uint32_t raw_id) const;
  std::optional<ClassId> classByName(const std::string& name) const;
  /// Exact match; the free class never matches.
  std::optional<ClassId> classByColor(const Color& color) const;

  /// Canonical text, complete and readable by fromYaml().
  std::string toYaml() const;

 private:
  std::string name_;
  std::vector<LabelClass> classes_;
  std::map<std::uint32_t, Raw> raw_;  ///< empty: raw ids are class ids
};

}  // namespace csom
