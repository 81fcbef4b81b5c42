// SPDX-License-Identifier: BSD-3-Clause
// The voxels of a map as PLY, PCD and CSV files.
#include <csom/exports/PointFiles.h>
#include <csom/io/OutputFile.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

#include <csom/exports/ExportChecks.h>
#include "BinaryNumbers.h"

namespace csom {
namespace {

/// The shortest text that reads back to the same number.
std::string_view shortest(double value, std::array<char, 32>& buffer) {
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), static_cast<std::size_t>(result.ptr - buffer.data())};
}

/// Spreadsheets take what begins like a formula for one, and would run it.
bool looksLikeFormula(const std::string& text) {
  return !text.empty() && std::string("=+-@\t\r").find(text.front()) != std::string::npos;
}

/// A CSV field, quoted if it must be (RFC 4180), that is no formula.
std::string csvField(const std::string& name) {
  const std::string text = looksLikeFormula(name) ? "'" + name : name;
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::size_t writePly(const VoxelSelection& voxels, const LabelSet& labels,
                     const std::string& file) {
  detail::checkExport(voxels, labels);
  OutputFile out(file);
  // PLY and PCD announce their number of points before the first one.
  const std::size_t count = voxels.count();
  out.write("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) +
            "\nproperty double x\nproperty double y\nproperty double z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property uchar class\nproperty float probability\nproperty float variance\n"
            "end_header\n");
  voxels.forEach([&](const VoxelIndex&, const ExportedVoxel& v) {
    const Color& color = labels.at(v.class_id).color;
    detail::writeBinary(out, v.center.x(), v.center.y(), v.center.z(), color[0], color[1], color[2],
                        static_cast<std::uint8_t>(v.class_id), static_cast<float>(v.probability),
                        static_cast<float>(v.variance));
  });
  out.commit();
  return count;
}

std::size_t writePcd(const VoxelSelection& voxels, const LabelSet& labels,
                     const std::string& file) {
  detail::checkExport(voxels, labels);
  OutputFile out(file);
  const std::size_t count = voxels.count();
  const std::string points = std::to_string(count);
  // TYPE F for rgb: PCL reads colours from a float that holds the bytes 0, red, green, blue.
  out.write(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb label\n"
      "SIZE 4 4 4 4 4\nTYPE F F F F U\nCOUNT 1 1 1 1 1\nWIDTH " +
      points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA binary\n");
  voxels.forEach([&](const VoxelIndex&, const ExportedVoxel& v) {
    detail::checkSinglePrecision(v.center, voxels.resolution());
    const Color& color = labels.at(v.class_id).color;
    const Eigen::Vector3f center = v.center.cast<float>();
    detail::writeBinary(out, center.x(), center.y(), center.z(), color[2], color[1], color[0],
                        std::uint8_t{0}, static_cast<std::uint32_t>(v.class_id));
  });
  out.commit();
  return count;
}

std::size_t writeCsv(const VoxelSelection& voxels, const LabelSet& labels,
                     const std::string& file) {
  detail::checkExport(voxels, labels);
  OutputFile out(file);
  out.write("x,y,z,class_id,class_name,probability,variance,evidence\n");
  std::array<char, 32> buffer{};
  std::string line;
  std::size_t count = 0;
  voxels.forEach([&](const VoxelIndex&, const ExportedVoxel& v) {
    line.clear();
    for (int axis = 0; axis < 3; ++axis) line.append(shortest(v.center[axis], buffer)) += ',';
    line += std::to_string(v.class_id) + ',' + csvField(labels.at(v.class_id).name) + ',';
    line.append(shortest(v.probability, buffer)) += ',';
    line.append(shortest(v.variance, buffer)) += ',';
    line.append(shortest(v.evidence, buffer)) += '\n';
    out.write(line);
    ++count;
  });
  out.commit();
  return count;
}

}  // namespace csom
