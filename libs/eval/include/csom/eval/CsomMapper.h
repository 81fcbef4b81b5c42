// SPDX-License-Identifier: BSD-3-Clause
// The map of this library as one of the methods that are compared.
#pragma once

#include <csom/core/SemanticMap.h>
#include <csom/eval/Mapper.h>

#include <utility>

namespace csom {

class CsomMapper : public Mapper {
 public:
  /// Throws OptionError.
  explicit CsomMapper(const Options& options) : map_(options) {}
  explicit CsomMapper(SemanticMap map) : map_(std::move(map)) {}

  void insert(const Scan& scan) override { map_.insert(scan); }
  VoxelEstimate at(const Eigen::Vector3d& center) const override;
  bool hasClasses() const override { return true; }

  const SemanticMap& map() const { return map_; }

 private:
  SemanticMap map_;
};

}  // namespace csom
