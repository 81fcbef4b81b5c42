// SPDX-License-Identifier: BSD-3-Clause
// Seeded random options and scans for property tests.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/SemanticMap.h>
#include <csom/core/types.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace csom::test {

/// A random case is a function of its seed alone.
class RandomCase {
 public:
  explicit RandomCase(std::uint64_t seed) : random_(seed) {}

  int integer(int min, int max) { return std::uniform_int_distribution<int>(min, max)(random_); }
  double real(double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(random_);
  }
  template <class T>
  T oneOf(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(integer(0, static_cast<int>(choices.size()) - 1))];
  }
  std::mt19937_64& engine() { return random_; }

  Options options(Method method) {
    Options o;
    o.method = method;
    o.number_of_classes = integer(2, 12);
    o.resolution = oneOf<double>({0.1, 0.2, 0.25, 0.3});
    o.block_depth = oneOf<int>({1, 2, 2, 2, 3, 4});
    o.see_csom.rvfm = integer(0, 3) > 0;
    o.kernel.aklm = integer(0, 3) > 0;
    o.kernel.shape = oneOf<Kernel>({Kernel::Sparse, Kernel::Sparse, Kernel::Linear});
    o.see_csom.neighbourhood =
        oneOf<Neighbourhood>({Neighbourhood::Radius, Neighbourhood::ExtendedBlock});
    o.scan.ds_resolution = oneOf<double>({0, 0.1, 0.17});
    o.see_csom.context_neighbours = oneOf<int>({6, 18, 26});
    // With more neighbours a lone block's context entropy is smaller by orders of magnitude.
    o.see_csom.context_threshold =
        o.see_csom.context_neighbours == 6 ? real(0.0, 0.125) : std::pow(10.0, real(-6, -2));
    o.kernel.scale = oneOf<double>({1.0, 0.1, 2.5});
    o.free_space.mode = oneOf<FreeSpace>({FreeSpace::None, FreeSpace::Sampled, FreeSpace::Raycast});
    o.free_space.resolution = real(0.2, 0.6);
    o.free_space.weight = real(0.05, 1.0);
    if (method == Method::SurfaceCsom) {
      randomizeSurfaces(o);
      if (integer(0, 3) == 0) o.free_space.mode = FreeSpace::Projective;
    }
    if (integer(0, 2) == 0) o.kernel.length = o.resolution * real(0.5, 6);
    if (integer(0, 2) == 0) o.kernel.length_min = o.resolution * real(0.5, 4);
    return o;
  }

  /// Clusters of points within a few metres of an origin that may be far from the map's.
  Scan scan(const Options& o, int max_points) {
    Scan s;
    s.origin = {real(-3, 3), real(-3, 3), real(-2, 2)};
    if (integer(0, 4) == 0)
      s.origin += Eigen::Vector3d(real(-1e5, 1e5), real(-1e5, 1e5), real(-1e3, 1e3));
    const bool soft = integer(0, 3) == 0;
    const int points = integer(1, max_points);
    const double spread = real(0.3, 2.0);
    Eigen::Vector3f center = Eigen::Vector3f::Zero();
    for (int i = 0; i < points; ++i) {
      if (i % 20 == 0)
        center = Eigen::Vector3d(real(-2.5, 2.5), real(-2.5, 2.5), real(-1.5, 1.5)).cast<float>();
      const Eigen::Vector3d offset(real(-spread, spread), real(-spread, spread), real(-0.1, 0.1));
      s.points.push_back(center + offset.cast<float>());
      if (soft) {
        addScores(s, o.number_of_classes);
      } else {
        s.labels.push_back(static_cast<ClassId>(integer(0, 9) == 0
                                                    ? integer(0, o.number_of_classes - 1)
                                                    : (i / 20) % o.number_of_classes));
      }
    }
    return s;
  }

  /// Random scores of one more point.
  void addScores(Scan& s, int classes) {
    std::vector<double> raw(static_cast<std::size_t>(classes));
    double sum = 0;
    for (double& score : raw) {
      score = integer(0, 1) == 0 ? 0 : real(0, 1);
      sum += score;
    }
    if (sum == 0) raw[0] = sum = 1;
    for (const double score : raw) s.scores.push_back(static_cast<float>(score / sum));
  }

 private:
  void randomizeSurfaces(Options& o) {
    o.surface.planes = integer(0, 3) > 0;
    o.surface.neighbours = integer(3, 16);
    o.surface.reach = real(0.8, 2.2);
    o.surface.gap = real(1, 6);
    o.surface.thickness = real(0.6, 1.2);
    o.surface.support = real(0.2, 1);
    o.surface.hit_weight = real(0, 1);
    o.surface.free_limit = real(0.1, 2);
    o.surface.counter_evidence = real(0, 1.5);
  }
  std::mt19937_64 random_;
};

/// The whole content of a map: chunk indices and records in order.
inline std::string bytesOf(const SemanticMap& map) {
  std::string bytes;
  for (const auto& [index, chunk] : map.chunks().sorted()) {
    bytes.append(reinterpret_cast<const char*>(&index), sizeof index);
    bytes.append(static_cast<const char*>(chunk->record()), chunk->recordSize());
  }
  return bytes;
}

constexpr int kRandomCases = 200;

/// Name of a test that runs once a method.
inline std::string methodName(const testing::TestParamInfo<Method>& method) {
  switch (method.param) {
    case Method::SurfaceCsom:
      return "SurfaceCsom";
    case Method::SeeCsom:
      return "SeeCsom";
    case Method::SBki:
      return "SBki";
    case Method::SCsm:
      return "SCsm";
  }
  return "unknown";
}

}  // namespace csom::test
