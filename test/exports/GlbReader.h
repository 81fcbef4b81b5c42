// SPDX-License-Identifier: BSD-3-Clause
// Meshes of voxels, read by tinygltf.
#pragma once

#include <csom/core/SemanticMap.h>
#include <csom/io/LabelSet.h>
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace csom::test {

/// A face of a voxel, by the voxel that it belongs to.
using Face = std::tuple<int, int, int, int, int>;  ///< x, y, z, axis, sign
using Faces = std::map<Face, std::string>;         ///< and its class

struct MeshFaces {
  Faces faces;
  std::size_t triangles = 0;
};

inline std::vector<double> numbersOf(const tinygltf::Model& model, int accessor_index) {
  const tinygltf::Accessor& accessor = model.accessors.at(static_cast<std::size_t>(accessor_index));
  const tinygltf::BufferView& view =
      model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
  const unsigned char* bytes = model.buffers.at(static_cast<std::size_t>(view.buffer)).data.data() +
                               view.byteOffset + accessor.byteOffset;
  const bool vectors = accessor.type == TINYGLTF_TYPE_VEC3;
  std::vector<double> numbers;
  const int stride = accessor.ByteStride(view);
  for (std::size_t i = 0; i < accessor.count; ++i)
    for (int k = 0; k < (vectors ? 3 : 1); ++k) {
      const unsigned char* at = bytes + i * static_cast<std::size_t>(stride) + 4 * k;
      if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) {
        float number = 0;
        std::memcpy(&number, at, sizeof number);
        numbers.push_back(number);
      } else if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        std::uint32_t number = 0;
        std::memcpy(&number, at, sizeof number);
        numbers.push_back(number);
      } else {
        ADD_FAILURE() << "component type " << accessor.componentType;
      }
    }
  return numbers;
}

/// The faces that a rectangle of two triangles covers; `corners` in glTF's axes.
inline void addFaces(const std::vector<Eigen::Vector3d>& corners, double resolution,
                     const std::string& name, Faces& faces) {
  std::vector<Eigen::Vector3d> c;
  for (const Eigen::Vector3d& v : corners)  // y up to z up
    c.push_back(Eigen::Vector3d(v.x(), -v.z(), v.y()) / resolution);
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  EXPECT_NEAR(normal.cwiseAbs().sum(), std::abs(normal[axis]), 1e-6);
  const int sign = normal[axis] > 0 ? 1 : -1;
  Eigen::Vector3d min = c[0], max = c[0];
  for (const Eigen::Vector3d& v : c) {
    min = min.cwiseMin(v);
    max = max.cwiseMax(v);
    EXPECT_NEAR((v - v.array().round().matrix()).norm(), 0, 1e-4) << "a corner of the grid";
  }
  const Eigen::Array3i first = min.array().round().cast<int>();
  Eigen::Array3i last = max.array().round().cast<int>() - 1;
  last[axis] = first[axis];
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) {
        Eigen::Array3i voxel(x, y, z);
        if (sign > 0) --voxel[axis];
        EXPECT_TRUE(faces.emplace(Face(voxel.x(), voxel.y(), voxel.z(), axis, sign), name).second)
            << "a face twice";
      }
}

inline MeshFaces readGlb(const std::string& file, double resolution, const LabelSet& labels) {
  tinygltf::Model model;
  tinygltf::TinyGLTF reader;
  std::string errors, warnings;
  EXPECT_TRUE(reader.LoadBinaryFromFile(&model, &errors, &warnings, file)) << errors;
  EXPECT_EQ(errors + warnings, "");
  MeshFaces read;
  const auto& root = model.nodes.at(static_cast<std::size_t>(
      model.scenes.at(static_cast<std::size_t>(model.defaultScene)).nodes.at(0)));
  EXPECT_EQ(root.matrix, (std::vector<double>{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}));
  for (const int child : root.children) {
    const tinygltf::Node& node = model.nodes.at(static_cast<std::size_t>(child));
    const tinygltf::Mesh& mesh = model.meshes.at(static_cast<std::size_t>(node.mesh));
    const tinygltf::Primitive& part = mesh.primitives.at(0);
    const tinygltf::Material& material =
        model.materials.at(static_cast<std::size_t>(part.material));
    EXPECT_EQ(node.name, material.name);
    const auto class_id = labels.classByName(material.name);
    EXPECT_TRUE(class_id);
    for (std::size_t k = 0; k < 3; ++k) {
      const double light = material.pbrMetallicRoughness.baseColorFactor.at(k);
      const double srgb =
          light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
      EXPECT_NEAR(srgb * 255, labels.at(*class_id).color[k], 0.01);
    }
    const std::vector<double> positions = numbersOf(model, part.attributes.at("POSITION"));
    const std::vector<double> indices = numbersOf(model, part.indices);
    read.triangles += indices.size() / 3;
    for (std::size_t i = 0; i < indices.size(); i += 6) {
      std::vector<Eigen::Vector3d> corners;
      for (const std::size_t k : {0U, 1U, 2U, 5U}) {
        const auto at = static_cast<std::size_t>(indices[i + k]) * 3;
        // The root's turn: (x, y, z) becomes (x, z, -y).
        corners.emplace_back(positions.at(at), positions.at(at + 2), -positions.at(at + 1));
      }
      EXPECT_EQ(indices[i], indices[i + 3]);
      EXPECT_EQ(indices[i + 2], indices[i + 4]);
      addFaces(corners, resolution, material.name, read.faces);
    }
  }
  return read;
}

/// Those that the mesh of a map must have.
inline Faces makeFaces(const SemanticMap& map, const LabelSet& labels) {
  Faces faces;
  map.forEachVoxel([&](const VoxelIndex& v, const DirichletVoxel& voxel) {
    if (voxel.state() != VoxelState::Occupied) return;
    for (int axis = 0; axis < 3; ++axis)
      for (const int sign : {-1, 1}) {
        VoxelIndex beside = v;
        (axis == 0 ? beside.x : axis == 1 ? beside.y : beside.z) += sign;
        if (map.voxel(beside).state() != VoxelState::Occupied)
          faces[Face(v.x, v.y, v.z, axis, sign)] = labels.at(voxel.mostLikelyClass()).name;
      }
  });
  return faces;
}

}  // namespace csom::test
