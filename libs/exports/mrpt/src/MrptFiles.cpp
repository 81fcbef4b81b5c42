// SPDX-License-Identifier: BSD-3-Clause
// Maps as files of MRPT's own map types.
#include <csom/core/Error.h>
#include <csom/exports/ExportChecks.h>
#include <csom/io/OutputFile.h>
#include <csom/mrpt_exports/MrptFiles.h>
#include <mrpt/io/CStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <stdexcept>

namespace csom {
namespace {

/// MRPT's own file streams do not tell when the disk is full.
class OutputFileStream : public mrpt::io::CStream {
 public:
  explicit OutputFileStream(OutputFile& file) : file_(file) {}

  size_t Write(const void* bytes, size_t size) override {
    file_.write(bytes, size);
    written_ += size;
    return size;
  }
  uint64_t getPosition() const override { return written_; }
  uint64_t getTotalBytesCount() const override { return written_; }
  size_t Read(void*, size_t) override { throw std::logic_error("a stream for writing"); }
  uint64_t Seek(int64_t, TSeekOrigin) override { throw std::logic_error("a stream for writing"); }

 private:
  OutputFile& file_;
  uint64_t written_ = 0;
};

void write(const mrpt::serialization::CSerializable& object, const std::string& file) {
  OutputFile out(file);
  OutputFileStream stream(out);
  mrpt::serialization::archiveFrom(stream) << object;
  out.commit();
}

float probabilityFree(NavigationGrid::State state) {
  switch (state) {
    case NavigationGrid::State::Free:
      return 0.99F;
    case NavigationGrid::State::Occupied:
      return 0.01F;
    case NavigationGrid::State::Unknown:
      break;
  }
  return 0.5F;
}

}  // namespace

void writeGridmap(const NavigationGrid& grid, const std::string& file) {
  const double r = grid.resolution();
  const Eigen::Vector2d origin = grid.origin();
  mrpt::maps::COccupancyGridMap2D map;
  map.setSize(static_cast<float>(origin.x()), static_cast<float>(origin.x() + grid.width() * r),
              static_cast<float>(origin.y()), static_cast<float>(origin.y() + grid.height() * r),
              static_cast<float>(r), 0.5F);
  const auto holds = [&](unsigned cells, int wanted, float min, double wanted_min) {
    return cells == static_cast<unsigned>(wanted) && std::abs(min - wanted_min) < r / 4;
  };
  if (!holds(map.getSizeX(), grid.width(), map.getXMin(), origin.x()) ||
      !holds(map.getSizeY(), grid.height(), map.getYMin(), origin.y()))
    throw ConfigError(
        "a grid map of MRPT has single precision, too little for a grid that begins at " +
            toString(origin.x()) + ", " + toString(origin.y()) +
            " m; move it nearer, or export to nav2",
        {"frame"});
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) map.setCell(x, y, probabilityFree(grid.state(x, y)));
  write(map, file);
}

std::size_t writePointMap(const VoxelSelection& voxels, const LabelSet& labels,
                          const std::string& file) {
  detail::checkExport(voxels, labels);
  const std::size_t count = voxels.count();
  mrpt::maps::CPointsMapXYZI map;
  map.reserve(count);
  voxels.forEach([&](const VoxelIndex&, const ExportedVoxel& v) {
    detail::checkSinglePrecision(v.center, voxels.resolution());
    map.insertPoint(v.center.cast<float>().x(), v.center.cast<float>().y(),
                    v.center.cast<float>().z());
    map.setPointIntensity(map.size() - 1, v.class_id);
  });
  write(map, file);
  return count;
}

}  // namespace csom
