// SPDX-License-Identifier: BSD-3-Clause
// How the likelihood of an observation is computed.
#pragma once

#include <csom/core/EnumWords.h>
#include <csom/core/OptionInfo.h>

namespace csom {

/// What a point is compared with. Field: the occupied voxel that is nearest to it. Beam: the first
/// occupied voxels on the way from the sensor to it, and a bit farther.
enum class LikelihoodMethod { Field, Beam };

template <>
inline constexpr EnumWords<LikelihoodMethod, 2> kWords<LikelihoodMethod>{
    {{LikelihoodMethod::Field, "field"}, {LikelihoodMethod::Beam, "beam"}}};

/// log p = −½ · mean over the points of min(d, max_distance)²/sigma²
///         + semantic_weight · mean over the labelled points of ln p(label).
///
/// d of `field`: the distance to the nearest occupied voxel; of `beam`: the distance along the beam
/// from its end to the first stretch of occupied voxels on it. p(label) is what that voxel
/// gives to the point's class, free space and the class of unlabelled points left out, mixed with a
/// share of label_error of all classes alike; a point without a voxel within max_distance has all
/// classes alike.
struct LikelihoodOptions {
  LikelihoodMethod method = LikelihoodMethod::Field;
  int decimation = 10;         ///< uses one point out of so many
  double max_distance = 1.0;   ///< [m]
  double sigma = 0.25;         ///< [m]
  double semantic_weight = 0;  ///< 0: labels do not count
  double label_error = 0.1;    ///< share of wrong labels, in (0, 1]

  /// Throws OptionError that names the key, the value and what is accepted.
  void validate() const;

  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    visitor(
        OptionInfo{
            "method", "",
            "a point is compared with the nearest occupied voxel (field), or with the first one on "
            "its beam (beam)"},
        o.method);
    visitor(OptionInfo{"decimation", "", "uses one point out of so many", {1, 1e9}}, o.decimation);
    visitor(OptionInfo{"max_distance", "m", "distances beyond count as this one", {1e-9, 1e9}},
            o.max_distance);
    visitor(OptionInfo{"sigma", "m", "standard deviation of the distance", {1e-9, 1e9}}, o.sigma);
    visitor(OptionInfo{"semantic_weight",
                       "",
                       "how much the labels of the points count, 0 = not at all. Points that carry "
                       "no label, and "
                       "those that cameras label, do not take part",
                       {0, 1e9}},
            o.semantic_weight);
    visitor(OptionInfo{"label_error",
                       "",
                       "share of labels that are wrong: smaller punishes a wrong label more",
                       {1e-9, 1}},
            o.label_error);
  }
};

}  // namespace csom
