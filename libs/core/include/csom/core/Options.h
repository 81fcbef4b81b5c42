// SPDX-License-Identifier: BSD-3-Clause
// Every parameter of a map, by the component that it belongs to. Numbers in brackets are the
// paper's equations. Lengths in metres.
#pragma once

#include <csom/core/EnumWords.h>
#include <csom/core/Method.h>
#include <csom/core/OptionInfo.h>
#include <csom/core/types.h>

#include <string>

namespace csom {

enum class Kernel { Sparse, Linear };
/// Which training points count for a voxel: all within the kernel length (eq. 21), or only those
/// of its block and (where the block's class entropy exceeds 0.3) of the block's neighbours.
enum class Neighbourhood { Radius, ExtendedBlock };
/// None: voxels are never free. Sampled: points of class 0 along each beam. Raycast: every voxel
/// that a beam crosses receives the same weight once a scan. Projective: every voxel that lies in
/// front of what a scan with an image sees, between its beams too; as Raycast for others.
enum class FreeSpace { None, Sampled, Raycast, Projective };

template <>
inline constexpr EnumWords<Kernel, 2> kWords<Kernel>{
    {{Kernel::Sparse, "sparse"}, {Kernel::Linear, "linear"}}};
template <>
inline constexpr EnumWords<Neighbourhood, 2> kWords<Neighbourhood>{
    {{Neighbourhood::Radius, "radius"}, {Neighbourhood::ExtendedBlock, "extended-block"}}};
template <>
inline constexpr EnumWords<FreeSpace, 4> kWords<FreeSpace>{{{FreeSpace::None, "none"},
                                                            {FreeSpace::Sampled, "sampled"},
                                                            {FreeSpace::Raycast, "raycast"},
                                                            {FreeSpace::Projective, "projective"}}};

/// A length of the map's size, or none.
constexpr Range kAnyLength{0, 1e7};

/// Which points of a scan become training points.
struct ScanOptions {
  double ds_resolution = 0;
  double min_range = 0;
  double max_range = 0;

  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    visitor(OptionInfo{"ds_resolution", "m", "one training point a cell of this edge, 0 keeps all",
                       kAnyLength},
            o.ds_resolution);
    visitor(OptionInfo{"min_range", "m", "nearer points are rejected", kAnyLength}, o.min_range);
    visitor(OptionInfo{"max_range", "m", "farther points are rejected, 0 = no limit", kAnyLength},
            o.max_range);
  }
};

/// How beams make voxels free.
struct FreeSpaceOptions {
  FreeSpace mode = FreeSpace::None;
  double resolution = 0.5;
  double weight = 0.1;
  bool no_return = false;

  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    visitor(OptionInfo{"free_space", "", "how beams make voxels free"}, o.mode);
    visitor(OptionInfo{"free_resolution", "m", "sampled: step between free points along a beam"},
            o.resolution);
    visitor(
        OptionInfo{"free_weight", "", "raycast: evidence of free for a crossed voxel", {1e-3, 1e5}},
        o.weight);
    visitor(
        OptionInfo{"free_no_return", "",
                   "beams that returned nothing are free up to max_range, if the sensor tells "
                   "them (rotating LiDARs do); they may also have hit what is black or too near"},
        o.no_return);
  }
};

/// How much a point weighs for a voxel.
struct KernelOptions {
  Kernel shape = Kernel::Sparse;
  bool aklm = true;
  double length_min = 0;
  double length_max = 0;
  double length = 0;
  double scale = 1;

  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    visitor(OptionInfo{"kernel", "", "how the weight of a point falls with its distance"}, o.shape);
    visitor(
        OptionInfo{"aklm", "",
                   "see-csom, surface-csom: kernel length adapted by class entropy, eqs. 10-15"},
        o.aklm);
    visitor(OptionInfo{"kernel_length_min", "m", "L_min of eq. 15, 0 = 3 x resolution"},
            o.length_min);
    visitor(OptionInfo{"kernel_length_max", "m", "L_max of eq. 15, 0 = 5 x resolution"},
            o.length_max);
    visitor(OptionInfo{"kernel_length", "m",
                       "fixed length of s-bki and aklm = off, 0 = 3 x resolution"},
            o.length);
    visitor(OptionInfo{"kernel_scale", "", "epsilon 0 of eq. 19", {1e-3, 1e5}}, o.scale);
  }
};

/// Method::SeeCsom (and what s-bki has of it).
struct SeeCsomOptions {
  bool rvfm = true;
  Neighbourhood neighbourhood = Neighbourhood::Radius;
  double context_weight_self = 1;
  double context_weight_neighbour = 0.8;
  double context_threshold = 0.1;
  int context_neighbours = 6;

  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    visitor(OptionInfo{"rvfm", "", "see-csom: redundant-voxel filter by context entropy, eqs. 4-9"},
            o.rvfm);
    visitor(OptionInfo{"neighbourhood", "", "see-csom, s-bki: points that count for a voxel"},
            o.neighbourhood);
    visitor(OptionInfo{"context_weight_self", "", "omega 1 of eqs. 6, 7", {0, 100}},
            o.context_weight_self);
    visitor(OptionInfo{"context_weight_neighbour", "", "omega 2 of eqs. 6, 8", {0, 100}},
            o.context_weight_neighbour);
    visitor(OptionInfo{"context_threshold", "", "T_con of eq. 9", {0, 1}}, o.context_threshold);
    visitor(OptionInfo{"context_neighbours", "", "blocks around a block: 6, 18 or 26"},
            o.context_neighbours);
  }
};

/// Method::SurfaceCsom; docs/algorithm.md and src/surface/SurfaceCsom.cpp have the equations.
struct SurfaceOptions {
  bool planes = true;
  int neighbours = 8;
  double reach = 1.8;
  double gap = 5;
  double thickness = 0.97;
  double support = 0.55;
  double hit_weight = 0.6;
  double free_limit = 0.4;
  double counter_evidence = 1;

  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    visitor(OptionInfo{"surface_planes", "", "surface-csom: kernels lie along the local surface"},
            o.planes);
    visitor(OptionInfo{"surface_neighbours",
                       "",
                       "surface-csom: hits that tell the local surface of a hit",
                       {3, 64}},
            o.neighbours);
    visitor(OptionInfo{"surface_reach",
                       "",
                       "surface-csom: kernel length, in units of the spacing of hits",
                       {0.5, 4}},
            o.reach);
    visitor(OptionInfo{"surface_gap",
                       "",
                       "surface-csom: widest spacing that a plane spans, in units of "
                       "max(ds_resolution, resolution)",
                       {1, 8}},
            o.gap);
    visitor(OptionInfo{"surface_thickness",
                       "",
                       "surface-csom: of a plane, in voxels measured along its normal",
                       {0.1, 10}},
            o.thickness);
    visitor(OptionInfo{"surface_support",
                       "",
                       "surface-csom: kernel mass that makes a voxel occupied by itself",
                       {1e-3, 100}},
            o.support);
    visitor(OptionInfo{"surface_hit_weight",
                       "",
                       "surface-csom: additional mass for the voxel that a hit lies in",
                       {0, 100}},
            o.hit_weight);
    visitor(OptionInfo{"surface_free_limit",
                       "",
                       "surface-csom, sampled: most evidence of free for a voxel by a scan",
                       {0, 1000}},
            o.free_limit);
    visitor(OptionInfo{"counter_evidence",
                       "",
                       "surface-csom: weight of the evidence against a voxel beside a surface",
                       {0, 100}},
            o.counter_evidence);
  }
};

/// All parameters with their defaults.
struct Options {
  int number_of_classes = 2;  ///< K, class 0 = free included
  /// Class of what was hit but not recognised: its evidence counts for whichever other class the
  /// voxel has, so that any label outvotes it.
  int unlabelled_class_id = 0;
  double resolution = 0.2;  ///< r, edge of a voxel
  int block_depth = 2;      ///< D_b
  Method method = Method::SurfaceCsom;
  ScanOptions scan;
  FreeSpaceOptions free_space;
  KernelOptions kernel;
  SeeCsomOptions see_csom;
  SurfaceOptions surface;
  double prior = 0.001;  ///< σ0 of eq. 22, evidence that every class has beforehand
  int threads = 1;       ///< does not change the map

  template <class Self, class Visitor>
  static void visit(Self& o, Visitor&& visitor) {
    visitor(OptionInfo{"resolution", "m", "edge of a voxel", {1e-4, 1e3}}, o.resolution);
    visitor(OptionInfo{"number_of_classes",
                       "",
                       "classes, free included; taken from the label set",
                       {2, kMaxClasses}},
            o.number_of_classes);
    visitor(OptionInfo{"unlabelled_class_id", "",
                       "class that any label outvotes, 0 = none; taken from the label set"},
            o.unlabelled_class_id);
    visitor(OptionInfo{"block_depth", "", "a block is 2^(block_depth-1) voxels a side", {1, 4}},
            o.block_depth);
    visitor(OptionInfo{"method", "", "how a scan becomes counts"}, o.method);
    ScanOptions::visit(o.scan, visitor);
    FreeSpaceOptions::visit(o.free_space, visitor);
    KernelOptions::visit(o.kernel, visitor);
    SeeCsomOptions::visit(o.see_csom, visitor);
    SurfaceOptions::visit(o.surface, visitor);
    visitor(OptionInfo{"prior", "", "sigma 0 of eq. 22", {1e-9, 1e5}}, o.prior);
    visitor(OptionInfo{"threads", "", "threads of one insertion, 0 = all processors", {0, 1024}},
            o.threads);
  }

  /// Throws OptionError if a value is outside its range, or does not go with another one.
  void validate() const;

  // Kernel lengths, with their defaults filled in [m].
  double kernelLengthMin() const {
    return kernel.length_min > 0 ? kernel.length_min : 3 * resolution;
  }
  double kernelLengthMax() const {
    return kernel.length_max > 0 ? kernel.length_max : 5 * resolution;
  }
  double kernelLengthFixed() const { return kernel.length > 0 ? kernel.length : 3 * resolution; }
  /// Projective free space is that of rays where a scan has no image.
  bool castsRays() const {
    return free_space.mode == FreeSpace::Raycast || free_space.mode == FreeSpace::Projective;
  }
  /// Whether scans that have an image are taken as such.
  bool usesImages() const;
  bool usesContextEntropy() const { return method == Method::SeeCsom && see_csom.rvfm; }
  bool usesClassEntropy() const {
    return (method == Method::SeeCsom || method == Method::SurfaceCsom) && kernel.aklm;
  }
};

/// Calls visitor(OptionInfo, field) for every field. `OptionsLike` is a struct of options, const or
/// not.
template <class OptionsLike, class Visitor>
void visitOptions(OptionsLike& options, Visitor&& visitor) {
  OptionsLike::visit(options, visitor);
}

/// Sets the field called `key` from its text. Returns false if no field has that name; throws
/// OptionError if the text is no valid value for it.
bool setOption(Options& options, const std::string& key, const std::string& text);

/// True if two maps with these options can be merged: all that fixes the meaning of counts and
/// indices is equal (resolution, number_of_classes, unlabelled_class_id, prior).
bool mergeable(const Options& a, const Options& b);

}  // namespace csom
