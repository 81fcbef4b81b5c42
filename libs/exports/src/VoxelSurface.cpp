// SPDX-License-Identifier: BSD-3-Clause
// The surface of occupied voxels as rectangles.
#include "VoxelSurface.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace csom::detail {
namespace {

/// Classes of voxels; kFreeClass where there is none.
class ClassGrid {
 public:
  explicit ClassGrid(const VoxelSelection& voxels) {
    voxels.forEachResampled([&](const VoxelIndex& v, const ExportedVoxel& voxel) {
      chunks_[chunkOf(v)][static_cast<std::size_t>(indexInChunk(v))] =
          static_cast<std::uint8_t>(voxel.class_id);
    });
  }

  ClassId at(const VoxelIndex& v) const {
    const auto chunk = chunks_.find(chunkOf(v));
    return chunk == chunks_.end() ? kFreeClass
                                  : chunk->second[static_cast<std::size_t>(indexInChunk(v))];
  }

  template <class Visitor>
  void forEach(Visitor&& visit) const {
    for (const auto& [index, classes] : chunks_)
      for (int i = 0; i < kVoxelsPerChunk; ++i)
        if (const ClassId k = classes[static_cast<std::size_t>(i)]; k != kFreeClass)
          visit(voxelOfChunk(index, i), k);
  }

 private:
  std::map<ChunkIndex, std::array<std::uint8_t, kVoxelsPerChunk>> chunks_;
};

/// A face, or a row of faces: `column` … `end`.
struct Row {
  std::int32_t plane, row, column, end;
  ClassId class_id;
};

std::int32_t& component(VoxelIndex& v, int axis) {
  return axis % 3 == 0 ? v.x : axis % 3 == 1 ? v.y : v.z;
}

std::vector<Row> makeFaces(const ClassGrid& grid, int axis, bool positive) {
  std::vector<Row> faces;
  grid.forEach([&](VoxelIndex v, ClassId k) {
    VoxelIndex neighbour = v;
    component(neighbour, axis) += positive ? 1 : -1;
    if (grid.at(neighbour) != kFreeClass) return;
    const std::int32_t column = component(v, axis + 1);
    faces.push_back(
        {component(v, axis) + (positive ? 1 : 0), component(v, axis + 2), column, column + 1, k});
  });
  std::sort(faces.begin(), faces.end(), [](const Row& a, const Row& b) {
    return std::tie(a.plane, a.row, a.column) < std::tie(b.plane, b.row, b.column);
  });
  return faces;
}

std::vector<Row> mergedAlongRows(const std::vector<Row>& faces) {
  std::vector<Row> rows;
  for (const Row& face : faces) {
    const bool continues = !rows.empty() && rows.back().plane == face.plane &&
                           rows.back().row == face.row && rows.back().end == face.column &&
                           rows.back().class_id == face.class_id;
    if (continues)
      rows.back().end = face.end;
    else
      rows.push_back(face);
  }
  return rows;
}

void mergeRows(const std::vector<Row>& rows, int axis, bool positive,
               std::vector<SurfaceRectangle>& rectangles) {
  // Rectangles that end at the row before, and at this one, in ascending order of their columns.
  std::vector<std::size_t> above, current;
  std::size_t next_above = 0;
  const Row* last = nullptr;
  for (const Row& row : rows) {
    if (last == nullptr || last->plane != row.plane || last->row != row.row) {
      const bool adjacent = last != nullptr && last->plane == row.plane && last->row + 1 == row.row;
      above.clear();
      if (adjacent) above.swap(current);
      current.clear();
      next_above = 0;
    }
    last = &row;
    while (next_above < above.size() && rectangles[above[next_above]].min[0] < row.column)
      ++next_above;
    SurfaceRectangle* match = next_above < above.size() ? &rectangles[above[next_above]] : nullptr;
    if (match != nullptr && match->min[0] == row.column && match->max[0] == row.end &&
        match->class_id == row.class_id) {
      match->max[1] = row.row + 1;
      current.push_back(above[next_above]);
      continue;
    }
    current.push_back(rectangles.size());
    rectangles.push_back(
        {row.class_id, axis, positive, row.plane, {row.column, row.row}, {row.end, row.row + 1}});
  }
}

}  // namespace

std::array<VoxelIndex, 4> SurfaceRectangle::corners() const {
  const auto corner = [&](std::int32_t u, std::int32_t v) {
    VoxelIndex position;
    component(position, axis) = plane;
    component(position, axis + 1) = u;
    component(position, axis + 2) = v;
    return position;
  };
  std::array<VoxelIndex, 4> loop{corner(min[0], min[1]), corner(max[0], min[1]),
                                 corner(max[0], max[1]), corner(min[0], max[1])};
  if (!positive) std::reverse(loop.begin(), loop.end());
  return loop;
}

std::vector<SurfaceRectangle> voxelSurface(const VoxelSelection& voxels) {
  const ClassGrid grid(voxels.withFreeVoxels(false));
  std::vector<SurfaceRectangle> rectangles;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool positive : {false, true})
      mergeRows(mergedAlongRows(makeFaces(grid, axis, positive)), axis, positive, rectangles);
  return rectangles;
}

}  // namespace csom::detail
