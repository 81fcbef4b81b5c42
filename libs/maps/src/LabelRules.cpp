// SPDX-License-Identifier: BSD-3-Clause
// How the labels that observations carry become classes of a map.
#include <csom/core/Error.h>
#include <csom/core/Options.h>
#include <csom/maps/LabelRules.h>

#include <cmath>

namespace csom {
namespace {

constexpr char kDrop[] = "drop";

std::string listOfClasses(const LabelSet& labels) {
  std::string list;
  for (const LabelClass& c : labels.classes()) {
    if (c.id != kFreeClass) list += c.name + ", ";
  }
  return list + kDrop;
}

std::optional<ClassId> classOrDrop(const LabelSet& labels, const std::string& key,
                                   const std::string& name) {
  if (name == kDrop) return std::nullopt;
  const std::optional<ClassId> id = labels.classByName(name);
  if (!id || *id == kFreeClass) {
    throw ConfigError(key + " = " + name + " is no class of label set '" + labels.name() +
                      "' that a point can have; accepted: " + listOfClasses(labels));
  }
  return id;
}

std::optional<ClassId> defaultUnlabelled(const LabelSet& labels) {
  for (const char* name : {"occupied", "unlabelled"}) {
    const std::optional<ClassId> id = labels.classByName(name);
    if (id && *id != kFreeClass) return id;
  }
  return std::nullopt;
}

/// A return is never evidence of free space: a label that means free is one that nobody can use.
PointLabel found(ClassId id) {
  if (id == kFreeClass) return {PointLabel::Kind::Unknown};
  return {PointLabel::Kind::Class, id};
}

}  // namespace

LabelRules::LabelRules(const LabelSet& labels, PointLabels source,
                       const std::string& unlabelled_class, const std::string& scan_2d_class)
    : labels_(&labels), source_(source) {
  unlabelled_ = unlabelled_class.empty()
                    ? defaultUnlabelled(labels)
                    : classOrDrop(labels, "unlabelled_class", unlabelled_class);
  scan_2d_ =
      scan_2d_class.empty() ? unlabelled_ : classOrDrop(labels, "scan_2d_class", scan_2d_class);
}

PointLabel LabelRules::fromRaw(std::uint32_t raw_id) const {
  const LabelSet::Raw raw = labels_->classOfRaw(raw_id);
  switch (raw.kind) {
    case LabelSet::RawKind::Class:
      return found(raw.id);
    case LabelSet::RawKind::Ignored:
      return {PointLabel::Kind::Ignored};
    case LabelSet::RawKind::Unknown:
      break;
  }
  return {PointLabel::Kind::Unknown};
}

PointLabel LabelRules::fromIntensity(float intensity) const {
  constexpr float kMaxExactInteger = 16777216.0f;
  const bool is_id = std::isfinite(intensity) && intensity >= 0 && intensity < kMaxExactInteger &&
                     intensity == std::floor(intensity);
  return is_id ? fromRaw(static_cast<std::uint32_t>(intensity))
               : PointLabel{PointLabel::Kind::Unknown};
}

PointLabel LabelRules::fromColor(const Color& color) const {
  const std::optional<ClassId> id = labels_->classByColor(color);
  return id ? found(*id) : PointLabel{PointLabel::Kind::Unknown};
}

PointLabel LabelRules::fromName(const std::string& name) const {
  const std::optional<ClassId> id = labels_->classByName(name);
  return id ? found(*id) : PointLabel{PointLabel::Kind::Unknown};
}

PointLabel LabelRules::ofScan2D() const {
  return scan_2d_ ? found(*scan_2d_) : PointLabel{PointLabel::Kind::Missing};
}

}  // namespace csom
