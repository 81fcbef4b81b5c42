// SPDX-License-Identifier: BSD-3-Clause
// Every parameter of a map, in one plain struct. Numbers in brackets are the paper's equations.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace csom {

/// How a scan becomes counts; see docs/algorithm.md.
enum class Method { SurfaceCsom, SeeCsom, SBki, SCsm };
enum class Kernel { Sparse, Linear };
/// Which training points a voxel listens to: all within the kernel length (eq. 21), or only those
/// of its block and (where the block's class entropy exceeds 0.3) of the block's neighbours.
enum class Neighbourhood { Radius, ExtendedBlock };
/// None: voxels are never free. Sampled: points of class 0 along each beam. Raycast: every voxel
/// that a beam crosses receives `free_weight` once a scan.
enum class FreeSpace { None, Sampled, Raycast };

/// Thrown for an option that cannot be; the message names the key, the value and the valid range.
class OptionError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// All parameters with their defaults. Lengths in metres. `visitOptions` lists them by name: that
/// list is what ini files, reports, map files and streams read and write.
struct Options {
  int number_of_classes = 2;  ///< K, class 0 = free included; 2 … 256
  /// Class of what was hit but not recognised: its evidence counts for whichever other class the
  /// voxel has, so that any label outvotes it. 0 = there is no such class.
  int unlabelled_class_id = 0;
  double resolution = 0.2;  ///< r, edge of a voxel [m]
  int block_depth = 2;      ///< D_b; a block is 2^(D_b−1) voxels a side; 1 … 4

  Method method = Method::SurfaceCsom;
  bool rvfm = true;  ///< see-csom: redundant-voxel filter by context entropy (eqs. 4–9)
  bool aklm = true;  ///< see-csom, surface-csom: length adapted by class entropy (eqs. 10–15)
  Kernel kernel = Kernel::Sparse;
  Neighbourhood neighbourhood = Neighbourhood::Radius;

  double ds_resolution = 0.0;  ///< one training point a cell of this edge [m]; 0 keeps all
  double min_range = 0.0;      ///< nearer points are rejected [m]
  double max_range = 0.0;      ///< farther points are rejected [m]; 0 = no limit

  FreeSpace free_space = FreeSpace::None;
  double free_resolution = 0.5;  ///< sampled: step between free points along a beam [m]
  double free_weight = 0.1;      ///< raycast: evidence of class 0 for a crossed voxel

  double context_weight_self = 1.0;       ///< ω1 of eqs. 6, 7
  double context_weight_neighbour = 0.8;  ///< ω2 of eqs. 6, 8
  double context_threshold = 0.1;         ///< T_con of eq. 9
  int context_neighbours = 6;             ///< neighbours in an extended block: 6, 18 or 26

  double kernel_length_min = 0.0;  ///< L_min of eq. 15 [m]; 0 = 3 r
  double kernel_length_max = 0.0;  ///< L_max of eq. 15 [m]; 0 = 5 r
  double kernel_length = 0.0;      ///< fixed L of s-bki and of aklm = off [m]; 0 = 3 r
  double kernel_scale = 1.0;       ///< ε0 of eq. 19

  bool surface_planes = true;       ///< surface-csom: kernels lie along the local surface
  int surface_neighbours = 8;       ///< hits that tell the local surface of a hit
  double surface_reach = 1.8;       ///< kernel length, in units of the spacing of hits
  double surface_gap = 5;           ///< widest spacing that a plane spans, in max(ds, r)
  double surface_thickness = 0.97;  ///< of a plane, in voxels measured along its normal
  double surface_support = 0.55;    ///< τ, kernel mass that makes a voxel occupied by itself
  double surface_hit_weight = 0.6;  ///< additional mass for the voxel that a hit lies in
  double surface_free_limit = 0.4;  ///< sampled: most evidence of free for a voxel by a scan
  double counter_evidence = 1;      ///< weight of what speaks against a voxel beside a surface

  double prior = 0.001;  ///< σ0 of eq. 22, evidence that every class has beforehand

  int threads = 1;  ///< threads of one insertion; 0 = all processors. Does not change the map

  /// Throws OptionError if any value is outside its range.
  void validate() const;

  double kernelLengthMin() const {
    return kernel_length_min > 0 ? kernel_length_min : 3 * resolution;
  }
  double kernelLengthMax() const {
    return kernel_length_max > 0 ? kernel_length_max : 5 * resolution;
  }
  double kernelLengthFixed() const { return kernel_length > 0 ? kernel_length : 3 * resolution; }
  bool usesContextEntropy() const { return method == Method::SeeCsom && rvfm; }
  bool usesClassEntropy() const {
    return (method == Method::SeeCsom || method == Method::SurfaceCsom) && aklm;
  }
};

/// Names as they stand in ini files: "see-csom", "radius", "on" … Parsing throws OptionError with
/// the accepted words.
std::string toString(Method value);
std::string toString(Kernel value);
std::string toString(Neighbourhood value);
std::string toString(FreeSpace value);
std::string toString(bool value);
std::string toString(int value);
std::string toString(double value);
void parse(const std::string& key, const std::string& text, Method& value);
void parse(const std::string& key, const std::string& text, Kernel& value);
void parse(const std::string& key, const std::string& text, Neighbourhood& value);
void parse(const std::string& key, const std::string& text, FreeSpace& value);
void parse(const std::string& key, const std::string& text, bool& value);
void parse(const std::string& key, const std::string& text, int& value);
void parse(const std::string& key, const std::string& text, double& value);

/// Calls `visitor(name, field, unit, help)` for every field, in order. `OptionsLike` is `Options&`
/// or `const Options&`; names are the keys of ini files.
template <class OptionsLike, class Visitor>
void visitOptions(OptionsLike& o, Visitor&& visitor) {
  visitor("resolution", o.resolution, "m", "edge of a voxel");
  visitor("number_of_classes", o.number_of_classes, "",
          "classes, free included; taken from the label set");
  visitor("unlabelled_class_id", o.unlabelled_class_id, "",
          "class that any label outvotes, 0 = none; taken from the label set");
  visitor("block_depth", o.block_depth, "", "a block is 2^(block_depth-1) voxels a side (1..4)");
  visitor("method", o.method, "", "surface-csom | see-csom | s-bki | s-csm");
  visitor("rvfm", o.rvfm, "", "see-csom: redundant-voxel filter by context entropy");
  visitor("aklm", o.aklm, "", "see-csom, surface-csom: kernel length adapted by class entropy");
  visitor("kernel", o.kernel, "", "sparse | linear");
  visitor("neighbourhood", o.neighbourhood, "", "radius | extended-block");
  visitor("ds_resolution", o.ds_resolution, "m",
          "one training point a cell of this edge, 0 keeps all");
  visitor("min_range", o.min_range, "m", "nearer points are rejected");
  visitor("max_range", o.max_range, "m", "farther points are rejected, 0 = no limit");
  visitor("free_space", o.free_space, "", "none | sampled | raycast");
  visitor("free_resolution", o.free_resolution, "m",
          "sampled: step between free points along a beam");
  visitor("free_weight", o.free_weight, "", "raycast: evidence of free for a crossed voxel");
  visitor("context_weight_self", o.context_weight_self, "", "omega 1 of eqs. 6, 7");
  visitor("context_weight_neighbour", o.context_weight_neighbour, "", "omega 2 of eqs. 6, 8");
  visitor("context_threshold", o.context_threshold, "", "T_con of eq. 9");
  visitor("context_neighbours", o.context_neighbours, "", "blocks around a block: 6, 18 or 26");
  visitor("kernel_length_min", o.kernel_length_min, "m", "L_min of eq. 15, 0 = 3 x resolution");
  visitor("kernel_length_max", o.kernel_length_max, "m", "L_max of eq. 15, 0 = 5 x resolution");
  visitor("kernel_length", o.kernel_length, "m",
          "fixed length of s-bki and aklm = off, 0 = 3 x resolution");
  visitor("kernel_scale", o.kernel_scale, "", "epsilon 0 of eq. 19");
  visitor("surface_planes", o.surface_planes, "",
          "surface-csom: kernels lie along the local surface");
  visitor("surface_neighbours", o.surface_neighbours, "",
          "surface-csom: hits that tell the local surface of a hit");
  visitor("surface_reach", o.surface_reach, "",
          "surface-csom: kernel length, in units of the spacing of hits");
  visitor("surface_gap", o.surface_gap, "",
          "surface-csom: widest spacing that a plane spans, in units of max(ds_resolution, "
          "resolution)");
  visitor("surface_thickness", o.surface_thickness, "",
          "surface-csom: of a plane, in voxels measured along its normal");
  visitor("surface_support", o.surface_support, "",
          "surface-csom: kernel mass that makes a voxel occupied by itself");
  visitor("surface_hit_weight", o.surface_hit_weight, "",
          "surface-csom: additional mass for the voxel that a hit lies in");
  visitor("surface_free_limit", o.surface_free_limit, "",
          "surface-csom, sampled: most evidence of free for a voxel by a scan");
  visitor("counter_evidence", o.counter_evidence, "",
          "surface-csom: weight of what speaks against a voxel beside a surface");
  visitor("prior", o.prior, "", "sigma 0 of eq. 22");
  visitor("threads", o.threads, "", "threads of one insertion, 0 = all processors");
}

/// Sets the field called `key` from its text. Returns false if no field has that name; throws
/// OptionError if the text is no valid value for it.
bool setOption(Options& options, const std::string& key, const std::string& text);

/// True if two maps with these options can be merged: all that fixes the meaning of counts and
/// indices is equal (resolution, number_of_classes, unlabelled_class_id, prior).
bool mergeable(const Options& a, const Options& b);

}  // namespace csom
