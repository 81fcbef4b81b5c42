// SPDX-License-Identifier: BSD-3-Clause
// How the likelihood of an observation is computed.
#pragma once

#include <string>

namespace csom {

/// What a point is compared with. Field: the occupied voxel that is nearest to it. Beam: the first
/// occupied voxels on the way from the sensor to it, and a bit farther.
enum class LikelihoodMethod { Field, Beam };

std::string toString(LikelihoodMethod value);
/// Throws OptionError with the accepted words.
void parse(const std::string& key, const std::string& text, LikelihoodMethod& value);

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
};

/// Calls `visitor(key, field, unit, help)` for every field, in order.
template <class LikelihoodOptionsLike, class Visitor>
void visitLikelihoodOptions(LikelihoodOptionsLike& o, Visitor&& visitor) {
  visitor("method", o.method, "",
          "a point is compared with the nearest occupied voxel (field), or with the first one on "
          "its beam (beam)");
  visitor("decimation", o.decimation, "", "uses one point out of so many");
  visitor("max_distance", o.max_distance, "m", "distances beyond count as this one");
  visitor("sigma", o.sigma, "m", "standard deviation of the distance");
  visitor(
      "semantic_weight", o.semantic_weight, "",
      "how much the labels of the points count, 0 = not at all. Points that carry no label, and "
      "those that cameras label, do not take part");
  visitor("label_error", o.label_error, "",
          "share of labels that are wrong, above 0 to 1: smaller punishes a wrong label more");
}

}  // namespace csom
