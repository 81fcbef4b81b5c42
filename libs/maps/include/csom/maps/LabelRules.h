// SPDX-License-Identifier: BSD-3-Clause
// How the labels that observations carry become classes of a map.
#pragma once

#include <csom/core/EnumWords.h>
#include <csom/io/LabelSet.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace csom {

/// Where a point's label comes from. None: points carry no label. ByIntensity: the intensity is a
/// raw id of the label set. ByColor: the colour is exactly that of a class. Labels of pixels
/// (CObservation3DRangeScan::pixelLabels) are used whenever they are there.
enum class PointLabels { None, ByIntensity, ByColor };

template <>
inline constexpr EnumWords<PointLabels, 3> kWords<PointLabels>{
    {{PointLabels::None, "none"},
     {PointLabels::ByIntensity, "intensity"},
     {PointLabels::ByColor, "color"}}};

/// A label as found: the class of a point, or why it has none. A point is where a beam was thrown
/// back, so the class is never kFreeClass: a label that means free says nothing about it.
struct PointLabel {
  enum class Kind : std::uint8_t {
    Class,
    Missing,    ///< the point carries no label
    Unknown,    ///< a raw id, colour or name that is no class of the label set, or means free
    Ignored,    ///< a raw id that the label set ignores
    Ambiguous,  ///< a pixel with several labels
  };
  Kind kind = Kind::Missing;
  ClassId id = kFreeClass;
};

/// The rules of one map. Copies of `labels` are not made: the label set must outlive the rules.
class LabelRules {
 public:
  /// `unlabelled_class` and `scan_2d_class` are names of classes or `drop`; empty means the
  /// default: the class named `occupied` or else `unlabelled`, if the label set has one, else drop.
  /// Throws ConfigError that names the key and lists the classes.
  LabelRules(const LabelSet& labels, PointLabels source, const std::string& unlabelled_class,
             const std::string& scan_2d_class);

  const LabelSet& labels() const { return *labels_; }
  PointLabels source() const { return source_; }
  /// The same rules for points whose own labels come from elsewhere.
  LabelRules withSource(PointLabels source) const {
    LabelRules rules = *this;
    rules.source_ = source;
    return rules;
  }
  /// Class of points without a label; nothing = drop them.
  std::optional<ClassId> unlabelledClass() const { return unlabelled_; }

  PointLabel fromRaw(std::uint32_t raw_id) const;
  /// An intensity is a raw id only if it is a whole number.
  PointLabel fromIntensity(float intensity) const;
  PointLabel fromColor(const Color& color) const;
  PointLabel fromName(const std::string& name) const;
  /// Label of every ray of a 2-D scan.
  PointLabel ofScan2D() const;

 private:
  const LabelSet* labels_;
  PointLabels source_;
  std::optional<ClassId> unlabelled_;
  std::optional<ClassId> scan_2d_;
};

}  // namespace csom
