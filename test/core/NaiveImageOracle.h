// SPDX-License-Identifier: BSD-3-Clause
// Surfaces and free space of a scan with an image, written straight from their definitions: all
// pairs, all pixels, all voxels, fractions as they are. It shares no code with the library but its
// types. Decisions are taken on single-precision numbers in the order that the definitions name, so
// that the two agree to the last bit.
#pragma once

#include <csom/core/Grid.h>
#include <csom/core/Options.h>
#include <csom/core/types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace csom::test {

class NaiveImageOracle {
 public:
  using Cell = std::array<std::int64_t, 3>;         // x, y, z
  using Counts = std::map<ClassId, std::uint32_t>;  // quanta
  using Vector = std::array<float, 3>;

  /// All points of the scan must be acceptable.
  NaiveImageOracle(const Options& options, const Scan& scan) : o_(options), scan_(scan) {
    r_ = static_cast<float>(options.resolution);
    const Grid grid(options.resolution);
    const VoxelIndex in = grid.voxelAt(scan.origin);
    base_ = {(in.x >> 3) * 8, (in.y >> 3) * 8, (in.z >> 3) * 8};
    for (std::size_t i = 0; i < scan.points.size(); ++i)
      if (hasPixel(i)) beams_.push_back(i);
    for (const std::size_t i : beams_)
      for (const int side : {-1, 1}) {
        beside_[{static_cast<int>(i), side}] = findBeside(static_cast<int>(i), side);
        across_[{static_cast<int>(i), side}] = findAcross(static_cast<int>(i), side);
      }
    vote();
    if (options.free_space.mode == FreeSpace::Projective) findFree();
  }

  const std::map<Cell, Counts>& increments() const { return out_; }
  std::size_t freeVoxels() const { return free_; }
  std::size_t facetVoxels() const { return facets_.size(); }

 private:
  static constexpr int kNone = -1;

  // ---- neighbours -------------------------------------------------------------------------
  const RangeImage::Pixel& pixel(int point) const {
    return scan_.image.pixels[static_cast<std::size_t>(point)];
  }
  bool hasPixel(std::size_t i) const {
    if (scan_.image.pixels[i].row == RangeImage::kNoRow) return false;
    for (std::size_t j = 0; j < i; ++j)
      if (scan_.image.pixels[j] == scan_.image.pixels[i]) return false;
    return true;
  }
  std::int64_t turn() const { return scan_.image.columns_of_turn; }

  /// The beam that follows in the row, `side` 1, or comes before it, −1.
  int beside(int point, int side) const {
    return point == kNone ? kNone : beside_.at({point, side});
  }
  int findBeside(int point, int side) const {
    int best = kNone;
    std::int64_t best_columns = 0;
    for (const std::size_t j : beams_) {
      const int other = static_cast<int>(j);
      if (other == point || pixel(other).row != pixel(point).row) continue;
      std::int64_t columns =
          side * (std::int64_t{pixel(other).column} - std::int64_t{pixel(point).column});
      if (columns <= 0 && turn() > 0) columns += turn();
      if (columns <= 0) continue;
      if (best == kNone || columns < best_columns) best = other, best_columns = columns;
    }
    return best != kNone && 10 * best_columns < 16 * scan_.image.column_step ? best : kNone;
  }
  /// The beam beside it in the row above, `side` 1, or below, −1.
  int across(int point, int side) const {
    return point == kNone ? kNone : across_.at({point, side});
  }
  int findAcross(int point, int side) const {
    int best = kNone;
    std::int64_t best_columns = 0;
    // In the order of columns, the same turn first: of two as near the first one is taken.
    std::vector<std::pair<std::int64_t, int>> row;
    for (const std::size_t j : beams_) {
      const int other = static_cast<int>(j);
      if (pixel(other).row == pixel(point).row + side) row.push_back({pixel(other).column, other});
    }
    std::sort(row.begin(), row.end());
    for (const std::int64_t shift : {std::int64_t{0}, turn(), -turn()}) {
      for (const auto& [column, other] : row) {
        const std::int64_t columns = std::abs(column + shift - pixel(point).column);
        if (best == kNone || columns < best_columns) best = other, best_columns = columns;
      }
    }
    return best != kNone && 10 * best_columns < 8 * scan_.image.column_step ? best : kNone;
  }

  // ---- surfaces ---------------------------------------------------------------------------
  Vector at(int point) const {
    const Eigen::Vector3f& p = scan_.points[static_cast<std::size_t>(point)];
    return {p.x(), p.y(), p.z()};
  }
  ClassId label(int point) const {
    const auto i = static_cast<std::size_t>(point);
    if (!scan_.isSoft()) return scan_.labels[i];
    const auto classes = static_cast<std::size_t>(o_.number_of_classes);
    ClassId best = 0;
    for (std::size_t k = 1; k < classes; ++k)
      if (scan_.scores[i * classes + k] > scan_.scores[i * classes + best])
        best = static_cast<ClassId>(k);
    return best;
  }
  static Vector minus(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  static float dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  static Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }

  /// No surface; surface with the class of the nearer end; with that of a or of b.
  enum class Facet { None, Nearer, First, Second };
  Facet facet(int a, int b, int before, int after, bool across_rows) const {
    if (a == kNone || b == kNone || label(a) == kFreeClass || label(b) == kFreeClass)
      return Facet::None;
    const Vector d = minus(at(b), at(a));
    const float dd = dot(d, d);
    const float short_length = 1.5F * r_;
    if (dd < short_length * short_length) return Facet::Nearer;
    if (dd > 400.0F) return Facet::None;
    const bool same = label(a) == label(b);
    const bool flat = across_rows && d[2] * d[2] < 0.08F * 0.08F * dd;
    if (!same && !flat) return Facet::None;
    const Vector c = cross(at(a), at(b));
    const float sine = dot(c, c);  // squared, × dd × the square of the farther range
    const float far = std::max(dot(at(a), at(a)), dot(at(b), at(b)));
    const auto continues = [&](int from, int to) {
      if (from == kNone || to == kNone) return false;
      if (label(from) == kFreeClass || label(to) == kFreeClass) return false;
      const Vector e = minus(at(to), at(from));
      const float ee = dot(e, e);
      const float cosine = dot(e, d);
      if (!(cosine > 0) || !(cosine * cosine > 0.75F * dd * ee)) return false;
      const Vector de = cross(d, e);
      const float deviation = dot(de, de);  // squared, × ee
      const float exact_from = 5.0F * r_;
      if (dd >= exact_from * exact_from && !(deviation * (far * dd) < 0.2F * 0.2F * sine * ee))
        return false;
      const float flat_deviation = 0.4F * r_;
      return same || deviation < flat_deviation * flat_deviation * ee;
    };
    if (!continues(before, a) && !continues(b, after)) return Facet::None;
    const auto is_steep = [&](int from, int to) {
      if (from == kNone || to == kNone) return false;
      if (label(from) == kFreeClass || label(to) == kFreeClass) return false;
      const Vector e = minus(at(to), at(from));
      return e[2] * e[2] > 0.5F * 0.5F * dot(e, e);
    };
    if (same || is_steep(before, a) == is_steep(b, after)) return Facet::Nearer;
    return is_steep(b, after) ? Facet::First : Facet::Second;
  }
  Facet toNext(int a) const {
    const int b = beside(a, 1);
    return facet(a, b, beside(a, -1), beside(b, 1), false);
  }
  Facet toAbove(int a) const {
    const int b = across(a, 1);
    return facet(a, b, across(a, -1), across(b, 1), true);
  }

  /// Odd multiples of 1/256 of a voxel, from the base.
  std::array<std::int64_t, 3> position(const Eigen::Vector3d& in_map) const {
    const auto axis = [&](double x, std::int32_t base) {
      return 2 * static_cast<std::int64_t>(std::floor((x / o_.resolution - base) * 128)) + 1;
    };
    return {axis(in_map.x(), base_.x), axis(in_map.y(), base_.y), axis(in_map.z(), base_.z)};
  }
  std::array<std::int64_t, 3> positionOf(int point) const {
    return position(scan_.origin + scan_.points[static_cast<std::size_t>(point)].cast<double>());
  }
  static std::int64_t floorOf(std::int64_t numerator, std::int64_t denominator) {
    const std::int64_t quotient = numerator / denominator;
    return quotient * denominator > numerator ? quotient - 1 : quotient;
  }

  void vote() {
    std::map<Cell, std::map<ClassId, std::uint64_t>> hits;
    const auto classes = static_cast<std::size_t>(o_.number_of_classes);
    for (std::size_t i = 0; i < scan_.points.size(); ++i) {
      Cell cell{};
      const auto p = positionOf(static_cast<int>(i));
      for (std::size_t a = 0; a < 3; ++a) cell[a] = floorOf(p[a], 256);
      if (!scan_.isSoft()) {
        ++hits[cell][scan_.labels[i]];
        continue;
      }
      for (std::size_t k = 0; k < classes; ++k) {
        const auto share =
            static_cast<std::uint64_t>(scan_.scores[i * classes + k] * 65536.0F + 0.5F);
        if (share > 0) hits[cell][static_cast<ClassId>(k)] += share;
      }
    }
    for (const std::size_t i : beams_) {
      const int a = static_cast<int>(i);
      draw(a, beside(a, 1), toNext(a));
      draw(a, across(a, 1), toAbove(a));
    }
    for (const auto& [cell, shares] : hits) {
      std::uint64_t all = 0;
      for (const auto& share : shares) all += share.second;
      Counts counts;
      for (const auto& [k, share] : shares) {
        const auto count = static_cast<std::uint32_t>(
            std::floor(4096.0 * static_cast<double>(share) / static_cast<double>(all) + 0.5));
        if (count > 0) counts[k] = count;
      }
      out_[inMap(cell)] = counts;
    }
    for (const auto& [cell, best] : facets_)
      if (hits.count(cell) == 0) out_[inMap(cell)] = {{best.second, best.first}};
  }
  void draw(int a, int b, Facet facet) {
    if (facet == Facet::None) return;
    const Vector d = minus(at(b), at(a));
    const float length = std::sqrt(dot(d, d));
    std::int64_t pieces =
        static_cast<std::int64_t>(std::min(std::ceil(length * (1 / (0.4F * r_))), 2047.0F));
    if (pieces % 2 == 0) ++pieces;
    const auto from = positionOf(a);
    const auto to = positionOf(b);
    for (std::int64_t i = 1; i < pieces; ++i) {
      Cell cell{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        cell[axis] = floorOf(from[axis] * pieces + (to[axis] - from[axis]) * i, 256 * pieces);
      const bool near_a = 2 * i < pieces;
      const auto steps = static_cast<float>(near_a ? i : pieces - i);
      const std::uint32_t weight = weightAt(length / static_cast<float>(pieces) * steps);
      const bool of_a = facet == Facet::First || (facet == Facet::Nearer && near_a);
      const ClassId k = label(of_a ? a : b);
      const auto found = facets_.find(cell);
      if (found == facets_.end() || weight > found->second.first ||
          (weight == found->second.first && k < found->second.second))
        facets_[cell] = {weight, k};
    }
  }
  static std::uint32_t weightAt(float distance) {
    return static_cast<std::uint32_t>(0.4F * 4096.0F / (1 + distance * distance) + 0.5F);
  }
  Cell inMap(const Cell& from_base) const {
    return {from_base[0] + base_.x, from_base[1] + base_.y, from_base[2] + base_.z};
  }

  // ---- free space -------------------------------------------------------------------------
  struct Face {
    std::vector<float> inverse;
    double spacings = 0;
    int drawings = 0;
  };
  float& pixelOf(std::vector<float>& image, int u, int v) const {
    return image[static_cast<std::size_t>(v * side_ + u)];
  }
  /// The coordinates as a face has them: depth, u, v.
  static Vector turned(int face, const Vector& p) {
    const auto axis = static_cast<std::size_t>(face / 2);
    return {face % 2 == 0 ? p[axis] : -p[axis], axis == 0 ? p[1] : p[0], axis == 2 ? p[1] : p[2]};
  }
  static int faceOf(const Vector& p) {
    const Vector a{std::abs(p[0]), std::abs(p[1]), std::abs(p[2])};
    const int axis = a[0] >= a[1] && a[0] >= a[2] ? 0 : a[1] >= a[2] ? 1 : 2;
    return 2 * axis + (p[static_cast<std::size_t>(axis)] >= 0 ? 0 : 1);
  }
  float half() const { return static_cast<float>(side_ / 2); }
  int first(float u) const {
    const int pixel = static_cast<int>(std::ceil(u * half())) - 1 + side_ / 2;
    return std::min(side_ - 1, std::max(0, pixel));
  }
  int last(float u) const {
    const int pixel = static_cast<int>(std::floor(u * half())) + side_ / 2;
    return std::min(side_ - 1, std::max(0, pixel));
  }
  std::vector<int> inOrderOfImage() const {
    std::vector<int> order(beams_.begin(), beams_.end());
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return std::tie(pixel(a).row, pixel(a).column) < std::tie(pixel(b).row, pixel(b).column);
    });
    return order;
  }
  /// Pixels no wider than beams of a row are apart, root mean square, or than a voxel at 25 m; 16
  /// to 512, a power of two.
  int sideFor() const {
    double sum = 0;
    double count = 0;
    for (const int a : inOrderOfImage()) {  // as sums of rounded numbers depend on it
      const int b = beside(a, 1);
      if (b == kNone) continue;
      const Vector p = at(a);
      const Vector q = at(b);
      if (!(dot(p, p) * dot(q, q) > 0)) continue;
      sum += dot(cross(p, q), cross(p, q)) / (dot(p, p) * dot(q, q));
      ++count;
    }
    const double sine = std::max(count > 0 ? std::sqrt(sum / count) : 0, o_.resolution / 25);
    int side = 16;
    while (side < 512 && sine * side < 2) side *= 2;
    return side;
  }

  void paint(int face, Face& out) {
    for (const int a : inOrderOfImage()) {
      const int b = beside(a, 1);
      const int c = across(a, 1);
      const int d = beside(c, 1);
      if (b == kNone || c == kNone || d == kNone) continue;
      const std::array<int, 4> corners{a, b, c, d};
      if (std::none_of(corners.begin(), corners.end(),
                       [&](int p) { return faceOf(at(p)) == face; }))
        continue;
      paintQuad(face, corners, out);
    }
    std::vector<float> closed = out.inverse;
    for (int v = 0; v < side_; ++v)
      for (int u = 0; u < side_; ++u) {
        if (pixelOf(out.inverse, u, v) != -1) continue;
        const float along_u = bridge(out, u, v, 1, 0);
        const float along_v = bridge(out, u, v, 0, 1);
        pixelOf(closed, u, v) = std::max(along_u, along_v);
      }
    out.inverse = closed;
  }
  /// The nearer of what was drawn on both sides of a gap of at most four pixels, or −1.
  float bridge(Face& face, int u, int v, int du, int dv) {
    const auto reach = [&](int sign) {
      for (int steps = 1; steps <= 4; ++steps) {
        const int at_u = u + sign * steps * du;
        const int at_v = v + sign * steps * dv;
        if (at_u < 0 || at_v < 0 || at_u >= side_ || at_v >= side_) break;
        if (pixelOf(face.inverse, at_u, at_v) != -1)
          return std::make_pair(steps, pixelOf(face.inverse, at_u, at_v));
      }
      return std::make_pair(1000, -1.0F);
    };
    const auto [before, inverse_before] = reach(-1);
    const auto [after, inverse_after] = reach(1);
    return before + after - 1 <= 4 ? std::max(inverse_before, inverse_after) : -1.0F;
  }

  void paintQuad(int face, const std::array<int, 4>& corners, Face& out) {
    std::array<float, 4> u{};
    std::array<float, 4> v{};
    std::array<float, 4> inverse{};
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector p = turned(face, at(corners[i]));
      if (!(p[0] > 0)) return;
      u[i] = p[1] / p[0];
      v[i] = p[2] / p[0];
      inverse[i] = 1 / p[0];
    }
    const auto [min_u, max_u] = std::minmax_element(u.begin(), u.end());
    const auto [min_v, max_v] = std::minmax_element(v.begin(), v.end());
    const float nearest = *std::max_element(inverse.begin(), inverse.end());
    const float spacing = std::max(*max_u - *min_u, *max_v - *min_v);
    const float off_centre =
        std::max({*min_u * *min_u, *max_u * *max_u, *min_v * *min_v, *max_v * *max_v});
    if (!(spacing < 0.25F * (1 + off_centre))) return;
    if (*max_u < -1 || *min_u > 1 || *max_v < -1 || *min_v > 1) return;
    const int u0 = first(*min_u), u1 = last(*max_u), v0 = first(*min_v), v1 = last(*max_v);
    out.spacings += spacing;
    ++out.drawings;
    const bool surface = toNext(corners[0]) != Facet::None && toNext(corners[2]) != Facet::None &&
                         toAbove(corners[0]) != Facet::None && toAbove(corners[1]) != Facet::None &&
                         across(corners[1], 1) == corners[3];
    const bool small = u1 - u0 < 8 && v1 - v0 < 8;
    for (const std::array<std::size_t, 3>& t :
         {std::array<std::size_t, 3>{0, 1, 2}, std::array<std::size_t, 3>{1, 3, 2}}) {
      const float area =
          (u[t[1]] - u[t[0]]) * (v[t[2]] - v[t[0]]) - (u[t[2]] - u[t[0]]) * (v[t[1]] - v[t[0]]);
      for (int y = v0; y <= v1; ++y)
        for (int x = u0; x <= u1; ++x) {
          const float at_u = (static_cast<float>(x - side_ / 2) + 0.5F) / half();
          const float at_v = (static_cast<float>(y - side_ / 2) + 0.5F) / half();
          bool inside = true;  // small ones fill their box
          for (std::size_t e = 0; e < 3; ++e) {
            const std::size_t from = t[e];
            const std::size_t to = t[(e + 1) % 3];
            const float side =
                (u[to] - u[from]) * (at_v - v[from]) - (v[to] - v[from]) * (at_u - u[from]);
            inside = inside && (small || (area > 0 ? side >= 0 : -side >= 0));
          }
          if (!inside) continue;
          float value = nearest;
          if (surface)
            value = onPlane({u[t[0]], u[t[1]], u[t[2]]}, {v[t[0]], v[t[1]], v[t[2]]},
                            {inverse[t[0]], inverse[t[1]], inverse[t[2]]}, at_u, at_v);
          pixelOf(out.inverse, x, y) = std::max(pixelOf(out.inverse, x, y), value);
        }
    }
  }
  /// The plane through three corners at its nearest within half a pixel, between their own depths.
  float onPlane(const std::array<float, 3>& u, const std::array<float, 3>& v,
                const std::array<float, 3>& q, float at_u, float at_v) const {
    const float nearest = std::max({q[0], q[1], q[2]});
    const float farthest = std::min({q[0], q[1], q[2]});
    const float area = (u[1] - u[0]) * (v[2] - v[0]) - (u[2] - u[0]) * (v[1] - v[0]);
    if (area == 0) return nearest;
    const float along_u = ((q[1] - q[0]) * (v[2] - v[0]) - (q[2] - q[0]) * (v[1] - v[0])) / area;
    const float along_v = ((q[2] - q[0]) * (u[1] - u[0]) - (q[1] - q[0]) * (u[2] - u[0])) / area;
    const float margin = (std::abs(along_u) + std::abs(along_v)) / static_cast<float>(side_);
    const float value = q[0] + (along_u * (at_u - u[0]) + along_v * (at_v - v[0])) + margin;
    return std::min(std::max(value, farthest), nearest);
  }

  struct Box {
    Vector min, max;
  };
  Box boxOf(const Cell& low, const Cell& high) const {
    const auto sensor = position(scan_.origin);
    Box box{};
    for (std::size_t a = 0; a < 3; ++a) {
      const float s = static_cast<float>(sensor[a]) / 256;
      box.min[a] = (static_cast<float>(low[a]) + (0.5F - 0.4F) - s) * r_;
      box.max[a] = (static_cast<float>(high[a]) + (0.5F + 0.4F) - s) * r_;
    }
    return box;
  }
  static Vector middle(const Box& b) {
    return {b.min[0] + b.max[0], b.min[1] + b.max[1], b.min[2] + b.max[2]};
  }
  struct Window {
    int face, u0, u1, v0, v1;
    float near, far, min_u, max_u, min_v, max_v;
  };
  /// Those of all faces that are as near to the centre.
  std::vector<Window> windowsOf(const Box& box) const {
    std::vector<Window> windows;
    const Vector m = middle(box);
    const float largest = std::max({std::abs(m[0]), std::abs(m[1]), std::abs(m[2])});
    for (int face = 0; face < 6; ++face) {
      if (turned(face, m)[0] != largest) continue;
      const auto window = windowOf(face, box);
      if (!window) return {};
      windows.push_back(*window);
    }
    return windows;
  }
  std::optional<Window> windowOf(int face, const Box& box) const {
    Window w{};
    w.face = face;
    const Vector a = turned(w.face, box.min);
    const Vector b = turned(w.face, box.max);
    w.near = std::min(a[0], b[0]);
    w.far = std::max(a[0], b[0]);
    w.min_u = a[1], w.max_u = b[1], w.min_v = a[2], w.max_v = b[2];
    if (!(w.near > 0)) return std::nullopt;
    w.u0 = first(w.min_u * (1 / (w.min_u < 0 ? w.near : w.far)));
    w.u1 = last(w.max_u * (1 / (w.max_u > 0 ? w.near : w.far)));
    w.v0 = first(w.min_v * (1 / (w.min_v < 0 ? w.near : w.far)));
    w.v1 = last(w.max_v * (1 / (w.max_v > 0 ? w.near : w.far)));
    return w;
  }
  void findFree() {
    side_ = sideFor();
    for (Face& face : faces_) face.inverse.assign(static_cast<std::size_t>(side_ * side_), -1.0F);
    for (int face = 0; face < 6; ++face) paint(face, faces_[static_cast<std::size_t>(face)]);
    float reach = 0;
    for (const std::size_t i : beams_)
      for (const float x : at(static_cast<int>(i))) reach = std::max(reach, std::abs(x));
    const auto chunks = static_cast<std::int64_t>(reach / r_ / 8) + 3;
    for (std::int64_t z = -chunks; z <= chunks; ++z)
      for (std::int64_t y = -chunks; y <= chunks; ++y)
        for (std::int64_t x = -chunks; x <= chunks; ++x) searchChunk({8 * x, 8 * y, 8 * z});
  }
  void searchChunk(const Cell& low) {
    const Box all = boxOf(low, {low[0] + 7, low[1] + 7, low[2] + 7});
    float beams = 0;
    for (int f = 0; f < 6; ++f) {
      const Vector a = turned(f, all.min);
      const Vector b = turned(f, all.max);
      float near = std::min(a[0], b[0]);
      const float far = std::max(a[0], b[0]);
      for (const std::size_t axis : {1U, 2U}) near = std::max({near, 0.0F, a[axis], -b[axis]});
      const Face& face = faces_[static_cast<std::size_t>(f)];
      if (far < near || face.drawings == 0) continue;
      beams = std::max(beams,
                       static_cast<float>(face.spacings / face.drawings) * (0.5F * (near + far)));
    }
    const float covered = beams > r_ ? r_ / beams : 1;
    if (0.2F * 4096.0F * covered * covered < 0.5F) return;
    for (std::int64_t i = 0; i < 512; ++i) {
      const Cell voxel{low[0] + i % 8, low[1] + i / 8 % 8, low[2] + i / 64};
      const std::vector<Window> own = windowsOf(boxOf(voxel, voxel));
      const auto anyIs = [&](Sight sight) {
        return std::any_of(own.begin(), own.end(),
                           [&](const Window& w) { return sightOf(w) == sight; });
      };
      if (own.empty() || anyIs(Sight::Blocked) || out_.count(inMap(voxel)) > 0) continue;
      const float word = anyIs(Sight::InPart) ? 0.2F * 4096.0F : 16.0F * 4096.0F;
      const auto count = static_cast<std::uint32_t>(word * covered * covered + 0.5F);
      out_[inMap(voxel)] = {{kFreeClass, count}};
      ++free_;
    }
  }
  /// Through a window one sees a voxel as a whole, in part, or not.
  enum class Sight { Whole, InPart, Blocked };
  Sight sightOf(const Window& w) {
    Face& face = faces_[static_cast<std::size_t>(w.face)];
    bool whole = true;
    bool any = false;
    // Squares of a power of two, no longer than the longer side, from each corner inwards.
    int edge = 1;
    while (2 * edge <= std::max(w.u1 - w.u0, w.v1 - w.v0) + 1 && 4 * edge <= side_) edge *= 2;
    for (const int v0 : {w.v0, std::max(0, w.v1 + 1 - edge)})
      for (const int u0 : {w.u0, std::max(0, w.u1 + 1 - edge)})
        for (int v = v0; v < std::min(v0 + edge, side_); ++v)
          for (int u = u0; u < std::min(u0 + edge, side_); ++u) {
            const float inverse = pixelOf(face.inverse, u, v);
            if (inverse > 1 / w.far) return Sight::Blocked;
            (inverse == -1 ? whole : any) = inverse != -1;
          }
    if (!any) return Sight::Blocked;
    return whole ? Sight::Whole : Sight::InPart;
  }

  const Options& o_;
  const Scan& scan_;
  float r_;
  VoxelIndex base_;
  int side_ = 0;  ///< pixels of a face along an axis
  std::vector<std::size_t> beams_;
  std::map<std::pair<int, int>, int> beside_, across_;        ///< by point and side
  std::map<Cell, std::pair<std::uint32_t, ClassId>> facets_;  ///< weight and class, from the base
  std::array<Face, 6> faces_;
  std::map<Cell, Counts> out_;  ///< in the map
  std::size_t free_ = 0;
};

}  // namespace csom::test
