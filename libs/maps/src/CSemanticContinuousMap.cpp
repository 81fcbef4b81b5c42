// SPDX-License-Identifier: BSD-3-Clause
// Creation, copies and insertion.
#include <csom/core/Error.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/MrptMessage.h>
#include <csom/maps/PoseRounding.h>

#include <algorithm>
#include <charconv>
#include <iostream>
#include <new>
#include <optional>
#include <utility>

#include "ObservationName.h"

namespace csom {
namespace {

Options withClassesOf(Options options, const LabelSet& labels) {
  options.number_of_classes = labels.numberOfClasses();
  options.unlabelled_class_id = labels.unlabelledClass();
  return options;
}

std::string listOf(const std::map<std::string, std::size_t>& counts) {
  std::string list;
  for (const auto& [name, count] : counts)
    list += (list.empty() ? "" : ", ") + name + (name.empty() ? "" : " ") + std::to_string(count);
  return list;
}

/// The inverse of listOf(); a bare number is the count of no name. Nothing if it is neither.
std::optional<std::map<std::string, std::size_t>> parseList(const std::string& list) {
  std::map<std::string, std::size_t> counts;
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(", ", begin), list.size());
    const std::string item = list.substr(begin, end - begin);
    const std::size_t blank = item.rfind(' ');
    const std::string name = blank == std::string::npos ? "" : item.substr(0, blank);
    const char* const digits = item.data() + (blank == std::string::npos ? 0 : blank + 1);
    std::size_t count = 0;
    const auto parsed = std::from_chars(digits, item.data() + item.size(), count);
    if (parsed.ec != std::errc() || parsed.ptr != item.data() + item.size()) return std::nullopt;
    counts[name] += count;
    begin = end + 2;
  }
  return counts;
}

/// Two values of describe() as one. A text that describe() has not written stays in front.
std::string addCounts(const std::string& noted, const std::string& more) {
  auto sum = parseList(noted);
  const auto added = parseList(more);
  if (!sum || !added) return noted + ", " + more;
  for (const auto& [name, count] : *added) (*sum)[name] += count;
  return listOf(*sum);
}

void count(ScanImageCounts& counts, ImageOrigin origin) {
  switch (origin) {
    case ImageOrigin::Sensor:
      ++counts.of_sensor;
      break;
    case ImageOrigin::Found:
      ++counts.found;
      break;
    case ImageOrigin::Unknown:
    case ImageOrigin::None:
      ++counts.none;
      break;
  }
}

/// What a file says of the points and observations that are not in the map.
std::map<std::string, std::string> describe(const InsertionStatistics& statistics,
                                            const std::optional<CameraStatistics>& cameras) {
  std::map<std::string, std::string> meta;
  const auto note = [&](const char* key, std::size_t count) {
    if (count > 0) meta[key] = std::to_string(count);
  };
  note("points_without_label_dropped",
       statistics.labels.missing + (cameras ? cameras->points.dropped() : 0));
  note("points_with_unknown_label_dropped", statistics.labels.unknown);
  note("points_with_unknown_label_kept_unlabelled", statistics.labels.kept_unknown);
  note("points_with_ignored_label_dropped", statistics.labels.ignored);
  note("points_with_several_labels_dropped", statistics.labels.ambiguous);
  note("beams_without_return", statistics.no_returns);
  note("scans_with_image_of_sensor", statistics.images.of_sensor);
  note("scans_with_image_found", statistics.images.found);
  note("scans_without_image", statistics.images.none);
  note("observations_without_usable_points", statistics.without_points);
  if (!statistics.not_taken.empty()) meta["observations_not_taken"] = listOf(statistics.not_taken);
  if (!statistics.damaged.empty()) meta["observations_damaged"] = listOf(statistics.damaged);
  return meta;
}

}  // namespace

CSemanticContinuousMap::CSemanticContinuousMap() : CSemanticContinuousMap(Options{}) {}

CSemanticContinuousMap::CSemanticContinuousMap(const Options& options, const LabelSet& labels)
    : map_(withClassesOf(options, labels)), labels_(std::make_shared<const SharedLabels>(labels)) {}

// The base class is not copied: observers subscribe to one map, not to its copies.
CSemanticContinuousMap::CSemanticContinuousMap(const CSemanticContinuousMap& other)
    : mrpt::maps::CMetricMap(),
      insertionOptions(other.insertionOptions),
      likelihoodOptions(other.likelihoodOptions),
      renderingOptions(other.renderingOptions),
      labelOptions(other.labelOptions),
      warn_of_damaged(other.warn_of_damaged),
      map_(other.map_),
      labels_(other.labels_),
      scans_(other.scans_),
      statistics_(other.statistics_),
      last_insertion_(other.last_insertion_),
      meta_(other.meta_),
      adapter_(other.adapter_ ? other.adapter_->clone() : nullptr) {
  genericMapParams = other.genericMapParams;
}

CSemanticContinuousMap& CSemanticContinuousMap::operator=(const CSemanticContinuousMap& other) {
  if (this == &other) return *this;
  genericMapParams = other.genericMapParams;
  insertionOptions = other.insertionOptions;
  likelihoodOptions = other.likelihoodOptions;
  renderingOptions = other.renderingOptions;
  labelOptions = other.labelOptions;
  warn_of_damaged = other.warn_of_damaged;
  map_ = other.map_;
  labels_ = other.labels_;
  scans_ = other.scans_;
  statistics_ = other.statistics_;
  last_insertion_ = other.last_insertion_;
  meta_ = other.meta_;
  adapter_ = other.adapter_ ? other.adapter_->clone() : nullptr;
  // Who observes this map goes on to do so; who observes the other one has nothing to do with it.
  setLabelledScanObserver(labelled_scan_observer_);
  observed_points_.invalidate();
  invalidateCaches();
  return *this;
}

MapDocument CSemanticContinuousMap::document() const {
  CSemanticContinuousMap complete(*this);
  complete.flush();
  MapDocument document{std::move(complete.map_), labels(), std::move(complete.scans_),
                       std::move(complete.meta_)};
  for (const auto& [key, value] : describe(complete.statistics_, complete.cameraStatistics())) {
    std::string& noted = document.meta[key];
    noted = noted.empty() ? value : addCounts(noted, value);
  }
  return document;
}

void CSemanticContinuousMap::setDocument(MapDocument document) {
  setContent(std::move(document.map),
             std::make_shared<const SharedLabels>(std::move(document.labels)),
             std::move(document.scans), std::move(document.meta));
}

void CSemanticContinuousMap::setContent(SemanticMap map, std::shared_ptr<const SharedLabels> labels,
                                        std::vector<ScanRecord> scans,
                                        std::map<std::string, std::string> meta) {
  if (map.options().number_of_classes != labels->set().numberOfClasses())
    throw std::invalid_argument("the map and its label set differ in their number of classes");
  map_ = std::move(map);
  labels_ = std::move(labels);
  scans_ = std::move(scans);
  meta_ = std::move(meta);
  statistics_ = {};
  statistics_.inserted = scans_.size();
  last_insertion_ = {};
  adapter_.reset();
  observed_points_.invalidate();
  invalidateCaches();
}

void CSemanticContinuousMap::replaceContent(SemanticMap voxels, std::vector<ScanRecord> scans) {
  if (!mergeable(voxels.options(), map_.options()))
    throw std::invalid_argument("replaceContent: voxels of another kind of map");
  SemanticMap with_own_options(map_.options());
  with_own_options.merge(voxels);
  map_ = std::move(with_own_options);
  scans_ = std::move(scans);
  invalidateCaches();
}

mrpt::math::TBoundingBoxf CSemanticContinuousMap::boundingBox() const {
  const std::optional<VoxelBox> box = map_.boundingBox();
  if (!box) return {{0, 0, 0}, {0, 0, 0}};
  const Eigen::Vector3f min = map_.grid().lowerCorner(box->min).cast<float>();
  const VoxelIndex& last = box->max;
  const Eigen::Vector3f max =
      map_.grid().lowerCorner({last.x + 1, last.y + 1, last.z + 1}).cast<float>();
  return {{min.x(), min.y(), min.z()}, {max.x(), max.y(), max.z()}};
}

std::string CSemanticContinuousMap::asString() const {
  return "csom::CSemanticContinuousMap: " + std::to_string(map_.knownVoxelCount()) +
         " known voxels of " + toString(map_.options().resolution) + " m, " +
         std::to_string(labels().numberOfClasses()) + " classes (" + labels().name() + "), " +
         std::to_string(scans_.size()) + " observations";
}

void CSemanticContinuousMap::saveMetricMapRepresentationToFile(const std::string& prefix) const {
  saveMap(document(), prefix + ".csom");
  if (renderingOptions.save_scene) saveScene(prefix + ".3Dscene");
}

void CSemanticContinuousMap::auxParticleFilterCleanUp() {
  invalidateCaches();
}

void CSemanticContinuousMap::internal_clear() {
  map_.clear();
  scans_.clear();
  statistics_ = {};
  last_insertion_ = {};
  meta_.clear();
  adapter_.reset();
  invalidateCaches();
}

LastInsertion CSemanticContinuousMap::lastInsertion() const {
  // MRPT's insertObservation() does not even ask a map that is switched off.
  if (!genericMapParams.enableObservationInsertion)
    return {LastInsertion::Outcome::Disabled, {}, {}};
  return last_insertion_;
}

void CSemanticContinuousMap::invalidateCaches() {
  occupied_points_.invalidate();
  surfaces_for_2d_.invalidate();
  surfaces_for_3d_.invalidate();
  nearest_voxels_.invalidate();
}

LabelRules CSemanticContinuousMap::labelRules() const {
  return LabelRules(labels(), insertionOptions.point_labels, insertionOptions.unlabelled_class,
                    insertionOptions.scan_2d_class);
}

bool CSemanticContinuousMap::internal_insertObservation(
    const mrpt::obs::CObservation& observation,
    const std::optional<const mrpt::poses::CPose3D>& robot_pose) {
  const LabelRules rules = labelRules();
  last_insertion_ = {};
  bool used = false;
  bool kept = false;
  try {
    const Eigen::Isometry3d pose = roundedPose(robot_pose.value_or(mrpt::poses::CPose3D()));
    const auto adapted = adapter().adapt(observation, pose, rules);
    if (!adapted) {
      last_insertion_.outcome = LastInsertion::Outcome::NotTaken;
      ++statistics_.not_taken[observationName(observation)];
      return false;
    }
    kept = adapted->empty();
    used = insertScans(*adapted);
  } catch (const std::bad_alloc&) {
    throw;  // that is not the observation's fault
  } catch (const std::exception& error) {
    // An application must not stop because of one damaged observation.
    noteDamaged(observation, detail::messageOf(error));
    if (adapter_) insertFinished(observation);
    return false;
  }
  if (kept)
    last_insertion_.outcome = LastInsertion::Outcome::Kept;
  else
    last_insertion_.outcome =
        used ? LastInsertion::Outcome::Inserted : LastInsertion::Outcome::NoPoints;
  return used || kept;
}

/// The scans that were complete before the adapter threw because of `observation`.
void CSemanticContinuousMap::insertFinished(const mrpt::obs::CObservation& observation) {
  try {
    insertScans(adapter_->takeFinished());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    noteDamaged(observation, detail::messageOf(error));
  }
}

ObservationAdapter& CSemanticContinuousMap::adapter() {
  if (adapter_) return *adapter_;
  adapter_ = makeAdapter(labelOptions, labels(), beamsOf(map_.options()));
  setLabelledScanObserver(labelled_scan_observer_);
  return *adapter_;
}

void CSemanticContinuousMap::openLabelSources() {
  adapter().loadNetworks();
}

void CSemanticContinuousMap::takeLabelSourcesOf(const CSemanticContinuousMap& other) {
  labelOptions.label_cache = other.labelOptions.label_cache;
  if (adapter_ && other.adapter_) adapter_->takeNetworksOf(*other.adapter_);
}

void CSemanticContinuousMap::setLabelledScanObserver(LabelledScanObserver observer) {
  labelled_scan_observer_ = std::move(observer);
  if (adapter_) adapter_->setObserver(labelled_scan_observer_);
}

void CSemanticContinuousMap::flush() {
  last_insertion_ = {};
  if (adapter_) insertScans(adapter_->flush());
}

std::optional<CameraStatistics> CSemanticContinuousMap::cameraStatistics() const {
  const CameraStatistics* statistics = adapter_ ? adapter_->cameraStatistics() : nullptr;
  return statistics == nullptr ? std::nullopt : std::make_optional(*statistics);
}

bool CSemanticContinuousMap::insertScans(const std::vector<AdaptedScan>& adapted) {
  bool used = false;
  for (const AdaptedScan& scan : adapted) used |= insertScan(scan);
  return used;
}

bool CSemanticContinuousMap::insertScan(const AdaptedScan& adapted) {
  addStatistics(statistics_.labels, adapted.labels);
  statistics_.no_returns += adapted.no_returns;
  if (map_.options().usesImages()) count(statistics_.images, adapted.image_origin);
  ScanReport report = map_.insert(adapted.scan);
  if (report.points == report.rejectedTotal()) {
    ++statistics_.without_points;
    statistics_.unused += report;
    last_insertion_.without_points.push_back(adapted.observation_class);
    return false;
  }
  ++statistics_.inserted;
  invalidateCaches();
  const Eigen::Vector3d& origin = adapted.scan.origin;
  scans_.push_back({adapted.timestamp,
                    adapted.sensor_label,
                    adapted.observation_class,
                    {origin.x(), origin.y(), origin.z()},
                    report});
  return true;
}

void CSemanticContinuousMap::noteDamaged(const mrpt::obs::CObservation& observation,
                                         const std::string& why) {
  last_insertion_.outcome = LastInsertion::Outcome::Damaged;
  last_insertion_.reason = why;
  const std::string name = observationName(observation);
  if (statistics_.damaged[name]++ > 0) return;
  statistics_.why_damaged[name] = why;
  if (!warn_of_damaged) return;
  std::cerr << "csom: warning: " << name << " '" << observation.sensorLabel
            << "' is not inserted: " << why << " (further ones are only counted)\n";
}

}  // namespace csom
