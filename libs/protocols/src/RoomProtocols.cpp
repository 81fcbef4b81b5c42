// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Error.h>
#include <csom/eval/Random.h>
#include <csom/io/PcdReader.h>
#include <csom/protocols/RoomProtocols.h>
#include <csom/rawlog/Import.h>

#include <cstdio>
#include <filesystem>

namespace csom {
namespace {

std::string inMetres(const char* what, double value) {
  char text[48];
  std::snprintf(text, sizeof text, "%s %.2f", what, value);
  return text;
}

Trial roomTrial(const std::string& protocol, const Room& room, double resolution) {
  Trial trial;
  trial.protocol = protocol;
  trial.labels = room.labels;
  trial.options.number_of_classes = room.labels.numberOfClasses();
  trial.options.resolution = resolution;
  trial.options.free_space.mode = FreeSpace::None;
  const auto all = std::make_shared<LabelledCloud>(labelledPoints(room));
  trial.points = all;
  trial.truth =
      std::make_shared<VoxelTruth>(computeTruth(*all, resolution, trial.options.number_of_classes));
  return trial;
}

std::vector<Trial> atDensities(const Trial& trial, const std::vector<double>& densities) {
  std::vector<Trial> trials;
  for (const double density : densities) {
    trials.push_back(trial);
    trials.back().variant = inMetres("ds", density);
    trials.back().options.scan.ds_resolution = density;
  }
  return trials;
}

}  // namespace

bool isRoom(const std::string& folder) {
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error))
    if (at->path().extension() == ".pcd") return true;
  return false;
}

Room readRoom(const std::string& folder, const LabelSet& labels) {
  Room room;
  room.labels = labels;
  std::size_t unknown = 0;
  std::size_t rows = 0;
  std::size_t surplus = 0;
  for (const std::string& file : detail::filesIn(folder, ".pcd")) {
    const PcdCloud cloud = readPcd(file, PcdRowPolicy::IgnoreExtra);
    if (cloud.label_field.empty())
      throw FileError(file, "has no field 'label', so it cannot be scored");
    rows += cloud.skipped_rows;
    surplus += cloud.irregular_rows - cloud.skipped_rows;
    LabelledCloud& kept = room.clouds.emplace_back();
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      if (!cloud.points[i].allFinite()) {
        ++rows;
        continue;
      }
      const LabelSet::Raw raw = labels.classOfRaw(cloud.labels[i]);
      if (raw.kind == LabelSet::RawKind::Unknown) ++unknown;
      kept.add(cloud.points[i], raw.kind == LabelSet::RawKind::Class ? raw.id : kFreeClass);
    }
  }
  if (rows > 0)
    room.warnings.push_back(folder + ": left out " + std::to_string(rows) +
                            " rows that are no points");
  if (surplus > 0)
    room.warnings.push_back(folder + ": ignored surplus columns of " + std::to_string(surplus) +
                            " rows");
  if (unknown > 0)
    room.warnings.push_back(folder + ": left out " + std::to_string(unknown) +
                            " points with labels that the label set '" + labels.name() +
                            "' does not know");
  return room;
}

LabelledCloud labelledPoints(const Room& room) {
  LabelledCloud all;
  for (const LabelledCloud& cloud : room.clouds) all.append(cloud);
  return all;
}

std::vector<Trial> roomDensityTrials(const Room& room, const std::vector<double>& densities,
                                     double resolution) {
  Trial trial = roomTrial("P1", room, resolution);
  trial.scans = std::make_shared<std::vector<Scan>>(
      std::vector<Scan>{scanOf(*trial.points, Eigen::Vector3d::Zero())});
  return atDensities(trial, densities);
}

std::vector<Trial> roomObjectTrials(const Room& room, const std::vector<double>& densities,
                                    double resolution) {
  Trial trial = roomTrial("P2", room, resolution);
  std::vector<Scan> scans;
  for (const LabelledCloud& cloud : room.clouds)
    scans.push_back(scanOf(cloud, Eigen::Vector3d::Zero()));
  trial.scans = std::make_shared<std::vector<Scan>>(std::move(scans));
  return atDensities(trial, densities);
}

std::vector<Trial> roomRepetitionTrials(const Room& room, double density, double resolution,
                                        const RepetitionOptions& options) {
  Trial trial = roomTrial("P6", room, resolution);
  trial.options.scan.ds_resolution = density;
  trial.checkpoints = options.checkpoints;
  const Scan all = scanOf(*trial.points, Eigen::Vector3d::Zero());
  std::vector<Scan> scans(options.scans);
  for (std::size_t s = 0; s < scans.size(); ++s) {
    Random random(options.seed, s);
    for (std::size_t i = 0; i < all.points.size(); ++i) {
      if (random.uniform() >= options.share) continue;
      Eigen::Vector3d noise;
      for (double& value : noise) value = options.sigma * random.gaussian();
      scans[s].points.push_back(all.points[i] + noise.cast<float>());
      scans[s].labels.push_back(all.labels[i]);
    }
  }
  trial.scans = std::make_shared<std::vector<Scan>>(std::move(scans));
  return {trial};
}

}  // namespace csom
