// SPDX-License-Identifier: BSD-3-Clause
#include <csom/io/Exporters.h>
#include <csom/io/OutputFile.h>

#include <array>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace csom {

namespace {

/// What every format says about a voxel.
struct ExportedVoxel {
  Eigen::Vector3d center;
  ClassId class_id;
  double probability;
  double variance;
  double evidence;
};

template <class Visitor>
void forEachExported(const SemanticMap& map, ExportVoxels voxels, Visitor&& visit) {
  map.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    const ClassId k = voxel.mostLikelyClass();
    if (voxels == ExportVoxels::Occupied && voxel.state() != VoxelState::Occupied) return;
    visit(ExportedVoxel{map.grid().center(index), k, voxel.probability(k), voxel.variance(k),
                        voxel.evidence()});
  });
}

/// PLY and PCD announce their number of points before the first one.
std::size_t countExported(const SemanticMap& map, ExportVoxels voxels) {
  std::size_t count = 0;
  forEachExported(map, voxels, [&](const ExportedVoxel&) { ++count; });
  return count;
}

/// Numbers one after the other, little-endian.
template <class... Numbers>
void writeBinary(OutputFile& out, Numbers... numbers) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the formats are little-endian");
  std::array<char, (sizeof(Numbers) + ...)> bytes;
  std::size_t at = 0;
  ((std::memcpy(bytes.data() + at, &numbers, sizeof numbers), at += sizeof numbers), ...);
  out.write(bytes.data(), bytes.size());
}

std::size_t writePly(const SemanticMap& map, const LabelSet& labels, ExportVoxels voxels,
                     OutputFile& out) {
  const std::size_t count = countExported(map, voxels);
  out.write("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) +
            "\nproperty double x\nproperty double y\nproperty double z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property uchar class\nproperty float probability\nproperty float variance\n"
            "end_header\n");
  forEachExported(map, voxels, [&](const ExportedVoxel& v) {
    const Color& color = labels.at(v.class_id).color;
    writeBinary(out, v.center.x(), v.center.y(), v.center.z(), color[0], color[1], color[2],
                static_cast<std::uint8_t>(v.class_id), static_cast<float>(v.probability),
                static_cast<float>(v.variance));
  });
  return count;
}

std::size_t writePcd(const SemanticMap& map, const LabelSet& labels, ExportVoxels voxels,
                     OutputFile& out) {
  const std::size_t count = countExported(map, voxels);
  const std::string points = std::to_string(count);
  // TYPE F for rgb: PCL reads colours from a float that holds the bytes 0, red, green, blue.
  out.write(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb label\n"
      "SIZE 4 4 4 4 4\nTYPE F F F F U\nCOUNT 1 1 1 1 1\nWIDTH " +
      points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA binary\n");
  forEachExported(map, voxels, [&](const ExportedVoxel& v) {
    const Color& color = labels.at(v.class_id).color;
    const Eigen::Vector3f center = v.center.cast<float>();
    writeBinary(out, center.x(), center.y(), center.z(), color[2], color[1], color[0],
                std::uint8_t{0}, static_cast<std::uint32_t>(v.class_id));
  });
  return count;
}

/// The shortest text that reads back to the same number.
std::string_view shortest(double value, std::array<char, 32>& buffer) {
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), static_cast<std::size_t>(result.ptr - buffer.data())};
}

/// A CSV field, quoted if it must be (RFC 4180).
std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::size_t writeCsv(const SemanticMap& map, const LabelSet& labels, ExportVoxels voxels,
                     OutputFile& out) {
  out.write("x,y,z,class_id,class_name,probability,variance,evidence\n");
  std::array<char, 32> buffer{};
  std::string line;
  std::size_t count = 0;
  forEachExported(map, voxels, [&](const ExportedVoxel& v) {
    line.clear();
    for (int axis = 0; axis < 3; ++axis) line.append(shortest(v.center[axis], buffer)) += ',';
    line += std::to_string(v.class_id) + ',' + csvField(labels.at(v.class_id).name) + ',';
    line.append(shortest(v.probability, buffer)) += ',';
    line.append(shortest(v.variance, buffer)) += ',';
    line.append(shortest(v.evidence, buffer)) += '\n';
    out.write(line);
    ++count;
  });
  return count;
}

}  // namespace

std::size_t exportMap(const SemanticMap& map, const LabelSet& labels, ExportFormat format,
                      ExportVoxels voxels, const std::string& file) {
  if (map.options().number_of_classes != labels.numberOfClasses())
    throw std::invalid_argument("exportMap: the map and the label set differ in classes");
  OutputFile out(file);
  const auto write = [&] {
    switch (format) {
      case ExportFormat::Ply:
        return writePly(map, labels, voxels, out);
      case ExportFormat::Pcd:
        return writePcd(map, labels, voxels, out);
      case ExportFormat::Csv:
        return writeCsv(map, labels, voxels, out);
    }
    throw std::invalid_argument("exportMap: unknown format");
  };
  const std::size_t count = write();
  out.commit();
  return count;
}

}  // namespace csom
