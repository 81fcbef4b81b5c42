// SPDX-License-Identifier: BSD-3-Clause
// SEE-CSOM written straight from the equations: double precision, all pairs, no shortcuts. It
// shares no code with the library but its types.
#pragma once

#include <csom/core/Options.h>
#include <csom/core/types.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "core/NaiveSurfaceOracle.h"

namespace csom::test {

class NaiveOracle {
 public:
  using Cell = std::array<std::int64_t, 3>;  // x, y, z
  using Vector = std::vector<double>;

  explicit NaiveOracle(const Options& options)
      : o_(options), classes_(static_cast<std::size_t>(o_.number_of_classes)) {}

  /// Kernel mass by voxel and class that one scan of valid points adds.
  std::map<Cell, Vector> increments(const Scan& scan) {
    mass_.clear();
    undecided_.clear();
    std::vector<Point> raw;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      Vector c(classes_, 0.0);
      if (scan.isSoft()) {
        for (std::size_t k = 0; k < classes_; ++k)
          c[k] = static_cast<double>(scan.scores[i * classes_ + k]);
      } else {
        c[scan.labels[i]] = 1;
      }
      raw.push_back({scan.origin + scan.points[i].cast<double>(), c});
    }
    const std::vector<Point> hits = downSample(raw, scan.isSoft());
    std::vector<Point> training = hits;
    if (o_.free_space.mode == FreeSpace::Sampled) {
      for (const Point& p : downSample(freeSamples(hits, scan.origin), scan.isSoft()))
        training.push_back(p);
    }
    if (o_.method == Method::SCsm) {
      for (const Point& p : training) add(cellOf(p.xyz, o_.resolution), p.c, 1.0);
    } else if (o_.method == Method::SurfaceCsom) {
      inferSurfaces(training);
    } else {
      infer(training);
    }
    if (o_.free_space.mode == FreeSpace::Raycast)
      castRays(raw, hits, scan.origin, o_.free_space.weight);
    if (o_.free_space.mode == FreeSpace::Projective) {
      boundWords();
      castRays(raw, hits, scan.origin, 1638.0 / 4096);
    }
    return mass_;
  }

  /// True if the last scan's increments of the voxel depend on a decision that rounding may turn
  /// round; surface-csom alone takes such.
  bool isUndecided(const Cell& voxel) const { return undecided_.count(voxel) > 0; }

 private:
  struct Point {
    Eigen::Vector3d xyz;
    Vector c;
  };

  static Cell cellOf(const Eigen::Vector3d& p, double edge) {
    return {static_cast<std::int64_t>(std::floor(p.x() / edge)),
            static_cast<std::int64_t>(std::floor(p.y() / edge)),
            static_cast<std::int64_t>(std::floor(p.z() / edge))};
  }

  void add(const Cell& voxel, const Vector& c, double weight) {
    Vector& sum = mass_.try_emplace(voxel, classes_, 0.0).first->second;
    for (std::size_t k = 0; k < classes_; ++k) sum[k] += weight * c[k];
  }

  std::vector<Point> downSample(const std::vector<Point>& in, bool soft) const {
    if (o_.scan.ds_resolution == 0) return in;
    std::map<Cell, std::vector<Point>> cells;
    for (const Point& p : in) cells[cellOf(p.xyz, o_.scan.ds_resolution)].push_back(p);
    std::vector<Point> out;
    for (const auto& [cell, members] : cells) {
      Point mean{Eigen::Vector3d::Zero(), Vector(classes_, 0.0)};
      const auto n = static_cast<double>(members.size());
      for (const Point& p : members) {
        mean.xyz += p.xyz / n;
        for (std::size_t k = 0; k < classes_; ++k) mean.c[k] += p.c[k] / n;
      }
      if (!soft) {
        const auto best = static_cast<std::size_t>(firstMaximum(mean.c));
        std::fill(mean.c.begin(), mean.c.end(), 0.0);
        mean.c[best] = 1;
      }
      out.push_back(mean);
    }
    return out;
  }

  static std::ptrdiff_t firstMaximum(const Vector& v) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < v.size(); ++k) {
      if (v[k] > v[best] + 1e-9) best = k;
    }
    return static_cast<std::ptrdiff_t>(best);
  }

  std::vector<Point> freeSamples(const std::vector<Point>& hits,
                                 const Eigen::Vector3d& origin) const {
    Vector free(classes_, 0.0);
    free[0] = 1;
    std::vector<Point> out;
    for (const Point& hit : hits) {
      const Eigen::Vector3d beam = hit.xyz - origin;
      const double range = beam.norm();
      for (int n = 1; range - n * o_.free_space.resolution > 0; ++n)
        out.push_back({origin + beam / range * (range - n * o_.free_space.resolution), free});
    }
    return out;
  }

  double kernel(double distance, double length) const {
    const double t = distance / length;
    if (t >= 1) return 0;
    if (o_.kernel.shape == Kernel::Linear) return o_.kernel.scale * (1 - t);
    const double turn = 2 * M_PI * t;
    return o_.kernel.scale * ((2 + std::cos(turn)) / 3 * (1 - t) + std::sin(turn) / (2 * M_PI));
  }

  double classEntropy(const std::vector<const Point*>& inside) const {
    if (inside.empty()) return 1;
    Vector n(classes_, 0.0);
    for (const Point* p : inside)
      for (std::size_t k = 0; k < classes_; ++k) n[k] += p->c[k];
    double all = 0;
    double max = 0;
    int present = 0;
    for (const double mass : n) {
      all += mass;
      max = std::max(max, mass);
      present += mass > 0 ? 1 : 0;
    }
    const double spread = std::log(present) / std::log(static_cast<double>(classes_));
    return std::clamp((all - max) / all + spread / static_cast<double>(classes_), 0.0, 1.0);
  }

  using PointsByBlock = std::map<Cell, std::vector<const Point*>>;

  Cell blockOf(Cell voxel) const {
    const double side = 1 << (o_.block_depth - 1);
    for (auto& i : voxel) i = static_cast<std::int64_t>(std::floor(static_cast<double>(i) / side));
    return voxel;
  }

  PointsByBlock byBlock(const std::vector<Point>& training) const {
    PointsByBlock observed;
    for (const Point& p : training) observed[blockOf(cellOf(p.xyz, o_.resolution))].push_back(&p);
    return observed;
  }

  double kernelLength(double entropy, bool adaptive) const {
    return adaptive ? o_.kernelLengthMin() + entropy * (o_.kernelLengthMax() - o_.kernelLengthMin())
                    : o_.kernelLengthFixed();
  }

  void inferSurfaces(const std::vector<Point>& training) {
    std::vector<NaiveSurfaceOracle::Point> points;
    for (const Point& p : training) points.push_back({p.xyz / o_.resolution, p.c});
    const PointsByBlock observed = byBlock(training);
    NaiveSurfaceOracle surfaces(o_, std::move(points));
    mass_ = surfaces.increments([&](const Cell& voxel) {
      const auto own = observed.find(blockOf(voxel));
      const double entropy =
          classEntropy(own == observed.end() ? std::vector<const Point*>{} : own->second);
      return kernelLength(entropy, o_.kernel.aklm) / o_.resolution;
    });
    for (const auto& [voxel, mass] : mass_)
      if (surfaces.isUndecided(voxel)) undecided_.insert(voxel);
  }

  void infer(const std::vector<Point>& training) {
    const int side = 1 << (o_.block_depth - 1);
    const double s = side * o_.resolution;
    const PointsByBlock observed = byBlock(training);
    const int kinds = o_.see_csom.context_neighbours == 6    ? 1
                      : o_.see_csom.context_neighbours == 18 ? 2
                                                             : 3;
    std::set<Cell> candidates;
    const auto forExtended = [&](const Cell& b, auto&& visit) {
      for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
          for (int x = -1; x <= 1; ++x) {
            const int kind = std::abs(x) + std::abs(y) + std::abs(z);
            if (kind <= kinds) visit(Cell{b[0] + x, b[1] + y, b[2] + z}, kind);
          }
    };
    for (const auto& [b, points] : observed)
      forExtended(b, [&](const Cell& c, int) { candidates.insert(c); });

    for (const Cell& b : candidates) {
      if (o_.method == Method::SeeCsom && o_.see_csom.rvfm) {
        double e1 = 0;
        double e0 = 0;
        forExtended(b, [&](const Cell& x, int kind) {
          const double psi = kind == 0 ? o_.see_csom.context_weight_self
                                       : o_.see_csom.context_weight_neighbour *
                                             std::exp(-kind * s * s / (2 * s * s));
          (observed.count(x) > 0 ? e1 : e0) += psi;
        });
        if (std::exp(e1) / (std::exp(e1) + std::exp(e0)) < o_.see_csom.context_threshold) continue;
      }
      const auto own = observed.find(b);
      const double entropy =
          classEntropy(own == observed.end() ? std::vector<const Point*>{} : own->second);
      const double length = kernelLength(entropy, o_.method == Method::SeeCsom && o_.kernel.aklm);
      std::vector<const Point*> neighbourhood;
      if (o_.see_csom.neighbourhood == Neighbourhood::Radius) {
        for (const Point& p : training) neighbourhood.push_back(&p);
      } else {
        forExtended(b, [&](const Cell& x, int kind) {
          if (kind > 0 && entropy <= 0.3) return;
          const auto found = observed.find(x);
          if (found != observed.end())
            neighbourhood.insert(neighbourhood.end(), found->second.begin(), found->second.end());
        });
      }
      for (int z = 0; z < side; ++z)
        for (int y = 0; y < side; ++y)
          for (int x = 0; x < side; ++x) {
            const Cell v{b[0] * side + x, b[1] * side + y, b[2] * side + z};
            const Eigen::Vector3d center((static_cast<double>(v[0]) + 0.5) * o_.resolution,
                                         (static_cast<double>(v[1]) + 0.5) * o_.resolution,
                                         (static_cast<double>(v[2]) + 0.5) * o_.resolution);
            for (const Point* p : neighbourhood) {
              const double k = kernel((center - p->xyz).norm(), length);
              if (k > 0) add(v, p->c, k);
            }
          }
    }
  }

  /// No voxel has more than 1 of one scan; the library does it with rounded counts.
  void boundWords() {
    for (auto& [voxel, mass] : mass_) {
      double all = 0;
      for (const double m : mass) all += m;
      if (all > 1)
        for (double& m : mass) m /= all;
    }
  }
  /// Whether the scan itself sees more surface than free space there, with projective free space.
  bool isSurface(const Cell& voxel) {
    const auto found = mass_.find(voxel);
    if (o_.free_space.mode != FreeSpace::Projective || found == mass_.end()) return false;
    // It compares counts: what is rounded the other way there may decide.
    double difference = 0;
    double doubtful = 0;
    double all = 0;
    for (std::size_t k = 0; k < classes_; ++k) {
      const double quanta = found->second[k] * 4096;
      all += quanta;
      difference += (k == 0 ? -1 : 1) * std::floor(quanta + 0.5);
      const double from_border = std::abs(quanta - std::floor(quanta) - 0.5);
      doubtful += from_border < 0.01 + 2e-5 * quanta ? 1 : 0;
    }
    const bool was_bounded = all > 4095.9;  // and rounded twice
    if (std::abs(difference) <= doubtful + (was_bounded ? static_cast<double>(classes_) : 0) &&
        (doubtful > 0 || was_bounded))
      undecided_.insert(voxel);
    return difference > 0;
  }

  /// Voxels between consecutive crossings of grid planes, found at the middle of each piece.
  void castRays(const std::vector<Point>& raw, const std::vector<Point>& hits,
                const Eigen::Vector3d& origin, double weight) {
    std::set<Cell> hit_voxels;
    for (const Point& p : raw) hit_voxels.insert(cellOf(p.xyz, o_.resolution));
    std::set<Cell> crossed;
    for (const Point& hit : hits) {
      const Eigen::Vector3d beam = hit.xyz - origin;
      std::vector<double> cuts{0.0, 1.0};
      for (int a = 0; a < 3; ++a) {
        const double lo = std::min(origin[a], hit.xyz[a]);
        const double hi = std::max(origin[a], hit.xyz[a]);
        for (double plane = std::ceil(lo / o_.resolution); plane * o_.resolution < hi; ++plane)
          cuts.push_back((plane * o_.resolution - origin[a]) / beam[a]);
      }
      std::sort(cuts.begin(), cuts.end());
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double middle = (cuts[i] + cuts[i + 1]) / 2;
        if (middle >= 0 && middle <= 1)
          crossed.insert(cellOf(origin + middle * beam, o_.resolution));
      }
      hit_voxels.insert(cellOf(hit.xyz, o_.resolution));
    }
    Vector free(classes_, 0.0);
    free[0] = 1;
    for (const Cell& voxel : crossed) {
      if (hit_voxels.count(voxel) == 0 && !isSurface(voxel)) add(voxel, free, weight);
    }
  }

  Options o_;
  std::size_t classes_;
  std::map<Cell, Vector> mass_;
  std::set<Cell> undecided_;
};

}  // namespace csom::test
