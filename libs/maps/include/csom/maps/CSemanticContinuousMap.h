// SPDX-License-Identifier: BSD-3-Clause
// The semantic map as a metric map of MRPT.
#pragma once

#include <csom/core/SemanticMap.h>
#include <csom/io/LabelSet.h>
#include <csom/io/MapFile.h>
#include <csom/maps/LabelOptions.h>
#include <csom/maps/LabelRules.h>
#include <csom/maps/LabelledScan.h>
#include <csom/maps/LikelihoodOptions.h>
#include <csom/maps/MrptCompatibility.h>
#include <csom/maps/NearestVoxelField.h>
#include <csom/maps/ObservationAdapter.h>
#include <csom/maps/ObservedPoints.h>
#include <csom/maps/OccupiedPoints.h>
#include <csom/maps/RenderingOptions.h>
#include <csom/maps/SharedLabels.h>
#include <csom/maps/SurfacePoints.h>
#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/maps/CMetricMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/math/TBoundingBox.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace csom {

/// What became of the observations that were offered to a map.
struct InsertionStatistics {
  std::size_t inserted = 0;                        ///< observations
  std::size_t without_points = 0;                  ///< taken, but no point of them could be used
  std::map<std::string, std::size_t> not_taken;    ///< by class name: kinds that carry no points
  std::map<std::string, std::size_t> damaged;      ///< by class name
  std::map<std::string, std::string> why_damaged;  ///< by class name: reason of the first one
  LabelCounts labels;                              ///< sum over all observations
  std::size_t no_returns = 0;                      ///< beams that hit nothing (see SensorPoints)
  ScanImageCounts images;                          ///< sum over all scans, if images are used
  ScanReport unused;                               ///< sum over the scans without_points counts
};

/// What became of the observation that was offered last.
struct LastInsertion {
  enum class Outcome {
    Inserted,
    Kept,      ///< an image, or a scan that waits for its images
    NotTaken,  ///< of a kind that carries no points; also before the first insertion
    Damaged,
    NoPoints,  ///< taken, but no point of it, or of what it completed, could be used
    Disabled,  ///< by enableObservationInsertion = false; nothing is inserted then
  };
  Outcome outcome = Outcome::NotTaken;
  std::string reason;  ///< of Damaged: what is wrong with it, one line
  /// Classes of the scans that were complete now, this one or earlier ones, and had no point that
  /// could be used.
  std::vector<std::string> without_points;
};

/// A continuous semantic occupancy map (see csom::SemanticMap) that MRPT's applications fill, save
/// and query like any other metric map. docs/mrpt.md lists the keys of its ini sections.
///
/// Takes CObservationVelodyneScan, CObservationPointCloud, CObservation3DRangeScan,
/// CObservationRotatingScan and CObservation2DRangeScan, and where cameras give the labels
/// (labelOptions) their images too; insertObservation() returns false for any other kind and for
/// damaged or empty observations. Scans that wait for images are not in the map yet, but in what is
/// saved: see flush().
///
/// Thread-safety: as SemanticMap; the likelihood and all other const members may be called from
/// several threads at a time.
class CSemanticContinuousMap : public mrpt::maps::CMetricMap {
  DEFINE_SERIALIZABLE(CSemanticContinuousMap, csom)

 public:
  /// Where the labels of points come from.
  struct TInsertionOptions : public mrpt::config::CLoadableOptions {
    PointLabels point_labels = PointLabels::None;
    /// Class of points without a label, `drop`, or empty for the default (see LabelRules).
    std::string unlabelled_class;
    /// Class of all rays of 2-D scans, `drop`, or empty for unlabelled_class.
    std::string scan_2d_class;

    template <class Self, class Visitor>
    static void visit(Self& o, Visitor&& visitor) {
      visitor(
          OptionInfo{"point_labels", "",
                     "where the labels of points are: nowhere (none); the intensity of a point "
                     "is a raw id of the label set (intensity); its colour is exactly that of a "
                     "class (color). Labels of pixels are used whenever an observation has them"},
          o.point_labels);
      visitor(
          OptionInfo{"unlabelled_class", "",
                     "class of points without a label, or with one that is no class of a point, "
                     "or drop; unlabelled is added to a label set that lacks it; without this "
                     "key the class `occupied` or else `unlabelled`, if the label set has it, "
                     "else drop"},
          o.unlabelled_class);
      visitor(OptionInfo{"scan_2d_class", "",
                         "class of all rays of 2-D laser scans, or drop; without this key as "
                         "unlabelled_class"},
              o.scan_2d_class);
    }

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void dumpToTextStream(std::ostream& out) const override;
  };

  struct TLikelihoodOptions : public mrpt::config::CLoadableOptions, public LikelihoodOptions {
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void dumpToTextStream(std::ostream& out) const override;
  };

  struct TRenderingOptions : public mrpt::config::CLoadableOptions, public RenderingOptions {
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void dumpToTextStream(std::ostream& out) const override;
  };

  TInsertionOptions insertionOptions;
  TLikelihoodOptions likelihoodOptions;
  TRenderingOptions renderingOptions;
  /// Cameras that label points. To be set before the first insertion.
  LabelOptions labelOptions;
  /// Tell on stderr of the first damaged observation of each class: MRPT's applications have no
  /// other way to learn of it than statistics(), which they do not know.
  bool warn_of_damaged = true;

  CSemanticContinuousMap();
  /// What `options` say of classes is taken from the label set. Throws OptionError.
  explicit CSemanticContinuousMap(const Options& options,
                                  const LabelSet& labels = LabelSet::occupancy());
  /// Copies share the voxels until one of them is written to, and observations that wait.
  CSemanticContinuousMap(const CSemanticContinuousMap& other);
  /// Keeps the observer of labelled scans that this map has; see setLabelledScanObserver().
  CSemanticContinuousMap& operator=(const CSemanticContinuousMap& other);

  const SemanticMap& map() const { return map_; }
  const LabelSet& labels() const { return labels_->set(); }
  /// One record for each inserted observation, in order.
  const std::vector<ScanRecord>& scans() const { return scans_; }
  const InsertionStatistics& statistics() const { return statistics_; }
  LastInsertion lastInsertion() const;
  /// Nothing if no camera gives labels.
  std::optional<CameraStatistics> cameraStatistics() const;

  /// Loads the networks of labelOptions now instead of at the first image. Throws ConfigError or
  /// FileError for what is wrong with them.
  void openLabelSources();
  /// Uses the networks, and the label cache, of a map that has the same label sources: what has
  /// been loaded there is not loaded again. Throws std::invalid_argument if they are not the same.
  void takeLabelSourcesOf(const CSemanticContinuousMap& other);
  /// Called for every scan that cameras have labelled, from now on; not by copies.
  void setLabelledScanObserver(LabelledScanObserver observer);
  /// Inserts the scans that still wait for images, with what labels there are. To be called when no
  /// more observations will come; document() and saving do so on a copy. Throws FileError if a
  /// network cannot be used.
  void flush();

  /// The map as it goes to a file, and back. setDocument() keeps the MRPT-side options.
  /// What document() says of observations and points that are not in the map is counted on from
  /// what the document said that was set.
  MapDocument document() const;
  void setDocument(MapDocument document);
  /// For who keeps voxels and records of scans elsewhere while this map goes on: other ones, or
  /// none. Everything else stays, observations that wait for others included. Throws
  /// std::invalid_argument if the voxels are of other options than these.
  void replaceContent(SemanticMap voxels, std::vector<ScanRecord> scans);

  MAP_DEFINITION_START(CSemanticContinuousMap)
  Options options;
  LabelSet labels = LabelSet::occupancy();
  TInsertionOptions insertionOpts;
  TLikelihoodOptions likelihoodOpts;
  TRenderingOptions renderOpts;
  LabelOptions labelOpts;

  /// The same as loadFromConfigFile(), without warnings: unknown keys are only listed. Throws
  /// ConfigError that names section, key, value and what is accepted.
  void load(const mrpt::config::CConfigFileBase& source, const std::string& section_prefix);
  /// Keys and sections that nothing reads, a line each: "FILE [section] key".
  std::vector<std::string> unknownKeys() const { return unknown_keys_; }

 private:
  std::vector<std::string> unknown_keys_;

 public:
  MAP_DEFINITION_END(CSemanticContinuousMap)

  /// The one map that `[application_section]` of an ini file defines by a `…_count` key under any
  /// of the registered names. Throws ConfigError if the file cannot be read, or if it
  /// defines no map of ours or more than one.
  static TMapDefinition definitionFromIni(
      const std::string& file, const std::string& application_section = "MappingApplication");
  /// Same checks as CreateFromMapDefinition().
  explicit CSemanticContinuousMap(const TMapDefinition& definition);

  bool isEmpty() const override { return map_.empty(); }
  /// Of all known voxels, from corner to corner [m]; from 0 to 0 if there are none.
  mrpt::math::TBoundingBoxf boundingBox() const CSOM_OVERRIDE_SINCE_2_11_3;
  std::string asString() const override;
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& scene) const override;
  /// What 3-D views show, as a .3Dscene of MRPT. Throws FileError.
  void saveScene(const std::string& file) const;
  /// Writes PREFIX.csom, and with save_scene PREFIX.3Dscene. Throws FileError.
  void saveMetricMapRepresentationToFile(const std::string& prefix) const override;
  void auxParticleFilterCleanUp() override;

  // Pairs of this map's surfaces (see SurfacePoints) with the points of a points map, or of one
  // that getAsSimplePointsMap() makes; std::invalid_argument for others. If both sides know classes
  // (the other is a semantic map of the same label set, or an XYZI cloud and point_labels =
  // intensity), pairs of different classes are left out.
  void determineMatching2D(const mrpt::maps::CMetricMap* other,
                           const mrpt::poses::CPose2D& other_pose,
                           mrpt::tfest::TMatchingPairList& correspondences,
                           const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& results) const override;
  void determineMatching3D(const mrpt::maps::CMetricMap* other,
                           const mrpt::poses::CPose3D& other_pose,
                           mrpt::tfest::TMatchingPairList& correspondences,
                           const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& results) const override;
  float compute3DMatchingRatio(const mrpt::maps::CMetricMap* other,
                               const mrpt::poses::CPose3D& other_pose,
                               const mrpt::maps::TMatchingRatioParams& params) const override;
  float squareDistanceToClosestCorrespondence(float x0, float y0) const override;
  /// What others are matched with. Valid until the map is modified or destroyed.
  const SurfacePoints& surfaces() const { return surfaces_for_3d_.get(map_); }
  /// Centres of the occupied voxels. Valid until the map is modified or destroyed.
  const mrpt::maps::CSimplePointsMap* getAsSimplePointsMap() const override;

 private:
  void internal_clear() override;
  bool internal_insertObservation(
      const mrpt::obs::CObservation& observation,
      const std::optional<const mrpt::poses::CPose3D>& robot_pose = std::nullopt) override;
  double internal_computeObservationLikelihood(
      const mrpt::obs::CObservation& observation,
      const mrpt::poses::CPose3D& taken_from) const override;
  bool internal_canComputeObservationLikelihood(
      const mrpt::obs::CObservation& observation) const override;

  LabelRules labelRules() const;
  ObservationAdapter& adapter();
  /// To be called when voxels change.
  void invalidateCaches();
  /// Replaces all but the MRPT-side options. Throws before it changes anything.
  void setContent(SemanticMap map, std::shared_ptr<const SharedLabels> labels,
                  std::vector<ScanRecord> scans, std::map<std::string, std::string> meta);
  /// Both return true if any point was used, and note in last_insertion_ where none was.
  bool insertScans(const std::vector<AdaptedScan>& adapted);
  bool insertScan(const AdaptedScan& adapted);
  void insertFinished(const mrpt::obs::CObservation& observation);
  void noteDamaged(const mrpt::obs::CObservation& observation, const std::string& why);

  SemanticMap map_;
  std::shared_ptr<const SharedLabels> labels_;  ///< never null; shared between copies
  std::vector<ScanRecord> scans_;
  InsertionStatistics statistics_;
  LastInsertion last_insertion_;
  std::map<std::string, std::string> meta_;      ///< of the document that was set
  std::unique_ptr<ObservationAdapter> adapter_;  ///< made at the first insertion
  LabelledScanObserver labelled_scan_observer_;
  OccupiedPoints occupied_points_;  ///< what getAsSimplePointsMap() hands out
  // MRPT's points maps fail when they are searched in 2-D and then in 3-D: one for each.
  SurfacePointsCache surfaces_for_2d_;
  SurfacePointsCache surfaces_for_3d_;
  NearestVoxelField nearest_voxels_;     ///< of the likelihood
  ObservedPointsCache observed_points_;  ///< of the likelihood
};

}  // namespace csom
