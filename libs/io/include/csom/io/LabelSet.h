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

/// Name of the class of points that hit something of which nobody tells what it is.
constexpr char kUnlabelledClass[] = "unlabelled";

struct LabelClass {
  ClassId id = 0;
  std::string name;
  Color color{128, 128, 128};

  friend bool operator==(const LabelClass& a, const LabelClass& b) {
    return a.id == b.id && a.name == b.name && a.color == b.color;
  }
};

/// A label set (config/labels/*.yaml, described in docs/labels.md). Class 0 is free; the ids run
/// from 0 to K−1 without a gap, 2 ≤ K ≤ 256; names and colours are unique.
///
///     name: semantickitti
///     classes:
///       - {id: 0, name: free, color: [255, 255, 255], free: true}
///       - {id: 1, name: car, color: [100, 150, 245]}
///     raw:
///       0: ignore
///       10: 1
///
/// `raw` gives each raw id of the data set its class id, or `ignore`; without it raw ids are class
/// ids.
class LabelSet {
 public:
  /// What a raw id of a data set stands for. Ignored: the label set says that such points are not
  /// to be used. Unknown: the label set does not know the id, which callers count and report.
  enum class RawKind { Class, Ignored, Unknown };
  struct Raw {
    RawKind kind = RawKind::Unknown;
    ClassId id = kFreeClass;

    friend bool operator==(const Raw& a, const Raw& b) { return a.kind == b.kind && a.id == b.id; }
  };

  /// Free and occupied: the label set of a map that was given none.
  static LabelSet occupancy();
  /// Throws FileError naming the file and line.
  static LabelSet load(const std::string& file);
  /// The inverse of toYaml(); `origin` names the text in errors. Throws FileError.
  static LabelSet fromYaml(const std::string& text, const std::string& origin);

  /// The file of a label set given as a path or as a bare name ("semantickitti"): the path itself
  /// (relative to `base_folder`, then to the working folder), else NAME.yaml in the folders of
  /// $CSOM_LABELS_PATH (separated by ':'), else in share/mrpt_csom/labels of the prefix that holds
  /// this code (the folder of the library or program, or one of the two above it, + /share/…).
  /// Throws ConfigError that lists where it looked.
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

  /// This label set with a class named `unlabelled` behind the others, for points that hit
  /// something of which no label is known; the same label set if it has one. Throws ConfigError if
  /// there is no room for it.
  LabelSet withUnlabelledClass() const;
  /// The class named `unlabelled`, which any label outvotes (see Options::unlabelled_class_id); 0
  /// if there is none.
  ClassId unlabelledClass() const;

  /// Canonical text, complete and readable by fromYaml().
  std::string toYaml() const;

  /// Same name, classes and mapping of raw ids.
  friend bool operator==(const LabelSet& a, const LabelSet& b) {
    return a.name_ == b.name_ && a.classes_ == b.classes_ && a.raw_ == b.raw_;
  }
  friend bool operator!=(const LabelSet& a, const LabelSet& b) { return !(a == b); }

 private:
  friend class LabelSetReader;
  LabelSet() = default;

  std::string name_;
  std::vector<LabelClass> classes_;
  std::map<std::uint32_t, Raw> raw_;  ///< empty: raw ids are class ids
};

}  // namespace csom
