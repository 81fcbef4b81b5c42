// SPDX-License-Identifier: BSD-3-Clause
#include <csom/protocols/Trial.h>
#include <time.h>

#include <algorithm>

namespace csom {
namespace {

constexpr std::size_t kCurvePoints = 200;

/// Processor time of this thread [ms].
double threadMilliseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

std::optional<RocFigures> computeRoc(const RocSamples& samples, double score_of_unknown) {
  const auto curve = samples.curve(score_of_unknown);
  if (!curve) return std::nullopt;
  return RocFigures{curve->auc(), curve->truePositiveRateAt(0.2), curve->thinned(kCurvePoints)};
}

VoxelFigures computeFigures(const Mapper& map, const VoxelTruth& truth) {
  const VoxelEvaluation voxels = evaluateVoxels(map, truth);
  VoxelFigures figures;
  figures.score = voxels.score;
  if (voxels.score.voxels() > 0)
    figures.known_share =
        static_cast<double>(voxels.known) / static_cast<double>(voxels.score.voxels());
  figures.known_free_iou = voxels.known_free_iou;
  if (!truth.knowsFree()) return figures;
  figures.roc_unknown_half = computeRoc(voxels.occupancy, 0.5);
  figures.roc_unknown_zero = computeRoc(voxels.occupancy, 0);
  figures.calibration = voxels.calibration;
  figures.occupancy_calibration = voxels.occupancy_calibration;
  return figures;
}

/// Asks a map what the trial wants to know while its scans come.
class SightInterview {
 public:
  explicit SightInterview(const std::vector<SightCheck>& checks)
      : checks_(checks), next_(checks.begin()) {}

  void ask(const Mapper& map, std::size_t scans) {
    for (; next_ != checks_.end() && next_->scans <= scans; ++next_) {
      const VoxelEstimate voxel = map.at(next_->center);
      const bool occupied = voxel.known && voxel.class_id != kFreeClass;
      SightFigures& figures = figures_[next_->interval];
      if (next_->moved) {
        ++figures.left_by_movers;
        if (occupied) ++figures.ghosts;
      } else {
        ++figures.stays;
        if (!occupied) ++figures.lost;
      }
    }
  }
  const std::array<SightFigures, kSightSeconds.size()>& figures() const { return figures_; }

 private:
  const std::vector<SightCheck>& checks_;
  std::vector<SightCheck>::const_iterator next_;
  std::array<SightFigures, kSightSeconds.size()> figures_{};
};

TrialResult scored(const Mapper& map, const Trial& trial) {
  TrialResult result;
  result.protocol = trial.protocol;
  result.variant = trial.variant;
  result.classes = map.hasClasses();
  result.voxels = computeFigures(map, *trial.truth);
  if (trial.seen_truth) result.seen = computeFigures(map, *trial.seen_truth);
  if (trial.points && map.hasClasses())
    result.points = scorePoints(map, *trial.points, trial.options.number_of_classes);
  return result;
}

}  // namespace

std::vector<TrialResult> runTrial(const Trial& trial, const MethodSpec& method) {
  const std::unique_ptr<Mapper> map = makeMapper(method, trial.options);
  std::vector<TrialResult> results;
  std::vector<double> times;
  std::optional<SightInterview> sight;
  if (trial.sight) sight.emplace(*trial.sight);
  for (const Scan& scan : *trial.scans) {
    const double before = threadMilliseconds();
    map->insert(scan);
    times.push_back(threadMilliseconds() - before);
    if (sight) sight->ask(*map, times.size());
    const bool last = times.size() == trial.scans->size();
    const bool checked = std::find(trial.checkpoints.begin(), trial.checkpoints.end(),
                                   times.size()) != trial.checkpoints.end();
    if (!checked && !(last && trial.checkpoints.empty())) continue;
    results.push_back(scored(*map, trial));
    results.back().method = method.text;
    results.back().settings = method.settings;
    results.back().scans = times.size();
    if (sight) results.back().sight = sight->figures();
    results.back().ms_per_scan = median(times);
  }
  return results;
}

}  // namespace csom
