// SPDX-License-Identifier: BSD-3-Clause
// The surface of a map as a mesh.
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <csom/core/Error.h>
#include <csom/exports/ExportChecks.h>
#include <csom/exports/GltfFile.h>
#include <csom/io/OutputFile.h>

#include <assimp/Exporter.hpp>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "VoxelSurface.h"

namespace csom {
namespace {

using detail::SurfaceRectangle;
using RectanglesOfClass = std::map<ClassId, std::vector<SurfaceRectangle>>;

/// sRGB, as label sets have it, to linear light, as glTF has it.
float linear(std::uint8_t part) {
  const double c = part / 255.0;
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

std::unique_ptr<aiMaterial> materialOf(const LabelClass& c) {
  auto material = std::make_unique<aiMaterial>();
  const aiString name(c.name);
  const aiColor4D color(linear(c.color[0]), linear(c.color[1]), linear(c.color[2]), 1);
  const float metallic = 0;
  const float roughness = 1;
  material->AddProperty(&name, AI_MATKEY_NAME);
  material->AddProperty(&color, 1, AI_MATKEY_BASE_COLOR);
  material->AddProperty(&metallic, 1, AI_MATKEY_METALLIC_FACTOR);
  material->AddProperty(&roughness, 1, AI_MATKEY_ROUGHNESS_FACTOR);
  return material;
}

std::unique_ptr<aiMesh> makeMesh(const std::vector<SurfaceRectangle>& rectangles,
                                 const std::string& name, unsigned material, double resolution) {
  auto mesh = std::make_unique<aiMesh>();
  mesh->mName = aiString(name);
  mesh->mMaterialIndex = material;
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mNumVertices = static_cast<unsigned>(4 * rectangles.size());
  mesh->mVertices = new aiVector3D[mesh->mNumVertices];
  mesh->mNumFaces = static_cast<unsigned>(2 * rectangles.size());
  mesh->mFaces = new aiFace[mesh->mNumFaces];
  unsigned vertex = 0;
  unsigned face = 0;
  for (const SurfaceRectangle& rectangle : rectangles) {
    for (const std::array<unsigned, 3>& triangle : {std::array{0U, 1U, 2U}, {0U, 2U, 3U}}) {
      aiFace& f = mesh->mFaces[face++];
      f.mNumIndices = 3;
      f.mIndices =
          new unsigned[3]{vertex + triangle[0], vertex + triangle[1], vertex + triangle[2]};
    }
    for (const VoxelIndex& c : rectangle.corners())
      mesh->mVertices[vertex++] =
          aiVector3D(static_cast<float>(c.x * resolution), static_cast<float>(c.y * resolution),
                     static_cast<float>(c.z * resolution));
  }
  return mesh;
}

std::unique_ptr<aiScene> makeScene(const RectanglesOfClass& rectangles, const LabelSet& labels,
                                   double resolution) {
  auto scene = std::make_unique<aiScene>();
  const auto count = static_cast<unsigned>(rectangles.size());
  scene->mNumMeshes = scene->mNumMaterials = count;
  scene->mMeshes = new aiMesh* [count] {};
  scene->mMaterials = new aiMaterial* [count] {};
  scene->mRootNode = new aiNode("map");
  // z up to y up.
  scene->mRootNode->mTransformation = aiMatrix4x4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
  std::vector<aiNode*> nodes;
  unsigned i = 0;
  for (const auto& [class_id, of_class] : rectangles) {
    const LabelClass& c = labels.at(class_id);
    scene->mMaterials[i] = materialOf(c).release();
    scene->mMeshes[i] = makeMesh(of_class, c.name, i, resolution).release();
    nodes.push_back(new aiNode(c.name));
    nodes.back()->mNumMeshes = 1;
    nodes.back()->mMeshes = new unsigned[1]{i};
    ++i;
  }
  scene->mRootNode->addChildren(count, nodes.data());
  return scene;
}

}  // namespace

std::size_t writeGlb(const VoxelSelection& voxels, const LabelSet& labels,
                     const std::string& file) {
  detail::checkExport(voxels.withFreeVoxels(false), labels);
  voxels.withFreeVoxels(false).requireResampledVoxels();
  OutputFile out(file);
  RectanglesOfClass rectangles;
  std::size_t triangles = 0;
  for (const SurfaceRectangle& rectangle : detail::voxelSurface(voxels)) {
    for (const VoxelIndex& c : rectangle.corners())
      detail::checkSinglePrecision(Eigen::Vector3d(c.x, c.y, c.z) * voxels.resolution(),
                                   voxels.resolution());
    rectangles[rectangle.class_id].push_back(rectangle);
    triangles += 2;
  }
  // In memory, as Assimp does not tell when a file cannot be written.
  Assimp::Exporter exporter;
  const auto scene = makeScene(rectangles, labels, voxels.resolution());
  const aiExportDataBlob* blob = exporter.ExportToBlob(scene.get(), "glb2");
  if (blob == nullptr)
    throw FileError(file, std::string("cannot be made: ") + exporter.GetErrorString());
  out.write(blob->data, blob->size);
  out.commit();
  return triangles;
}

}  // namespace csom
