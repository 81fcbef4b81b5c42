// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "rows/Rows.h"

namespace csom::detail {

namespace {

// All in columns, hundredths of a degree.
constexpr std::int32_t kSmallStep = 500;  ///< from one beam of a row to the next, with some lost
constexpr std::int32_t kFarBack = 3000;   ///< no beam of a row is so far behind the one before
constexpr std::int32_t kBack = 20;        ///< behind by more than what is not quite in order
constexpr std::int32_t kBeside = 200;     ///< of the seam: where a row may begin

/// The azimuth of a cloud, counted on from turn to turn.
class Helix {
 public:
  /// `sense`: 1 counter-clockwise, −1 clockwise.
  Helix(const Directions& beams, int sense) : beams_(beams), sense_(sense) {
    at_.reserve(beams.size());
    std::int64_t at = sense_ > 0 ? beams.azimuth.front() : -beams.azimuth.front();
    at_.push_back(at);
    for (std::size_t i = 1; i < beams.size(); ++i) at_.push_back(at += step(i));
  }

  /// From the beam before, as the sensor turns: −kFarBack … 36000 − kFarBack. What is farther back
  /// is one turn later, in the next row.
  std::int32_t step(std::size_t i) const {
    const std::int32_t step = sense_ * turnFrom(beams_.azimuth[i - 1], beams_.azimuth[i]);
    return step < -kFarBack ? step + kColumnsOfTurn : step;
  }
  float elevationStep(std::size_t i) const {
    return std::abs(beams_.elevation[i] - beams_.elevation[i - 1]);
  }
  const std::vector<std::int64_t>& at() const { return at_; }

 private:
  const Directions& beams_;
  int sense_;
  std::vector<std::int64_t> at_;
};

std::int64_t remainder(std::int64_t at, std::int64_t of) {
  return (at % of + of) % of;
}

/// Where rows begin, if all do at the same azimuth.
///
/// Just behind that place the sensor looks where it looked a turn later just before it: the same
/// row begins and ends there. Everywhere else what follows in the cloud is beside what was before.
class Seam {
 public:
  Seam(const Directions& beams, const Helix& helix) : beams_(beams), helix_(helix) {}

  /// In 0 … 35999 as the sensor turns. Nothing if it does not turn so often that there are rows.
  std::optional<std::int32_t> find() const {
    const auto [lowest, highest] = std::minmax_element(helix_.at().begin(), helix_.at().end());
    const std::int64_t turns = (*highest - *lowest) / kColumnsOfTurn;
    if (turns < 2 || turns > static_cast<std::int64_t>(kMostRows)) return std::nullopt;
    const std::int64_t base = *lowest - remainder(*lowest, kColumnsOfTurn);
    std::vector<float> elevation(static_cast<std::size_t>(turns + 3) * kBins, kNone);
    for (std::size_t i = beams_.size(); i-- > 0;)
      elevation[static_cast<std::size_t>((helix_.at()[i] - base) / kBin)] = beams_.elevation[i];

    // Where there is no beam that tells, in the middle of where none is.
    std::int64_t best = (firstBin() + lastBin()) / 2 % kBins;
    float most = 0;
    for (std::int64_t bin = firstBin(); bin <= lastBin(); ++bin) {
      const float score = scoreOf(elevation, bin % kBins);
      if (score <= most) continue;
      most = score;
      best = bin % kBins;
    }
    return refined(static_cast<std::int32_t>(best) * kBin);
  }

 private:
  static constexpr std::int32_t kBin = 50;
  static constexpr std::int32_t kBins = kColumnsOfTurn / kBin;
  static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

  // The last row ends before the seam and the first one begins behind it, wherever those beams are
  // that came back.
  std::int64_t firstBin() const {
    return remainder(helix_.at().back(), kColumnsOfTurn) / kBin + kBins - kBeside / kBin;
  }
  std::int64_t lastBin() const {
    const std::int64_t between =
        remainder(helix_.at().front() - helix_.at().back(), kColumnsOfTurn);
    const bool overlap = between > kColumnsOfTurn - kBeside;
    return firstBin() + (2 * kBeside + (overlap ? 0 : between)) / kBin;
  }

  /// By how much what comes a turn later fits better than what comes next.
  static float scoreOf(const std::vector<float>& elevation, std::int64_t bin) {
    constexpr float kMost = 60;  // farther apart says no more
    float sum = 0;
    for (std::size_t n = static_cast<std::size_t>(bin) + kBins; n + kBins < elevation.size();
         n += kBins) {
      const float behind = elevation[n + 1];
      const float next = std::abs(behind - elevation[n - 1]);
      const float later = std::abs(behind - elevation[n - 1 + kBins]);
      if (!std::isnan(next) && !std::isnan(later))
        sum += std::min(next, kMost) - std::min(later, kMost);
    }
    return sum;
  }

  /// Between the two beams of each turn whose elevations differ most, near to `seam`: the median.
  std::int32_t refined(std::int32_t seam) const {
    std::vector<std::int32_t> places;
    std::int64_t turn = std::numeric_limits<std::int64_t>::min();
    float most = 0;
    for (std::size_t i = 1; i < beams_.size(); ++i) {
      const std::int64_t from_window = helix_.at()[i] - seam + 2 * kBin;
      if (remainder(from_window, kColumnsOfTurn) > 4 * kBin) continue;
      const std::int64_t this_turn = from_window / kColumnsOfTurn;
      if (this_turn != turn) {
        turn = this_turn;
        most = -1;
        places.push_back(0);
      }
      if (helix_.elevationStep(i) <= most) continue;
      most = helix_.elevationStep(i);
      const std::int64_t middle = (helix_.at()[i - 1] + helix_.at()[i] + 1) / 2;
      places.back() =
          static_cast<std::int32_t>(remainder(middle - seam + kColumnsOfTurn / 2, kColumnsOfTurn));
    }
    if (places.empty()) return seam;
    const auto median = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
    std::nth_element(places.begin(), median, places.end());
    return static_cast<std::int32_t>(
        remainder(std::int64_t{seam} + *median - kColumnsOfTurn / 2, kColumnsOfTurn));
  }

  const Directions& beams_;
  const Helix& helix_;
};

/// 1 or −1; 0 if the sensor does not turn.
int senseOf(const Directions& beams) {
  std::size_t small = 0;
  std::size_t forward = 0;
  std::size_t backward = 0;
  for (std::size_t i = 1; i < beams.size(); ++i) {
    const std::int32_t step = turnFrom(beams.azimuth[i - 1], beams.azimuth[i]);
    if (std::abs(step) > kSmallStep) continue;
    ++small;
    forward += step > 0 ? 1 : 0;
    backward += step < 0 ? 1 : 0;
  }
  const std::size_t most = std::max(forward, backward);
  if (10 * small < 7 * beams.size() || 10 * most < 9 * (forward + backward)) return 0;
  return forward > backward ? 1 : -1;
}

/// The first beams of all rows but the first: those behind the seam. Not all rows of some sensors
/// begin at quite the same place: the azimuth goes back there, or the elevation jumps.
std::vector<std::size_t> findCrossings(const Helix& helix, std::int32_t seam) {
  const std::vector<std::int64_t>& at = helix.at();
  std::vector<std::size_t> begins;
  for (std::size_t i = 1; i < at.size(); ++i) {
    const std::int64_t turn = at[i] - remainder(at[i] - seam, kColumnsOfTurn);
    if (at[i - 1] >= turn) continue;
    std::size_t back = i;
    std::size_t jump = i;
    const auto look = [&](std::size_t k) {
      if (helix.step(k) < helix.step(back)) back = k;
      const bool is_next = std::abs(at[k] - turn) <= kBack;
      if (is_next && helix.elevationStep(k) > helix.elevationStep(jump)) jump = k;
    };
    for (std::size_t k = i - 1; k > 0 && at[k] >= turn - kBeside; --k) look(k);
    for (std::size_t k = i; k < at.size() && at[k] <= turn + kBeside; ++k) look(k);
    const std::size_t begin = helix.step(back) < -kBack ? back : jump;
    if (begins.empty() || begin > begins.back()) begins.push_back(begin);
  }
  return begins;
}

}  // namespace

std::optional<Rows> findRowsInOrder(const Directions& beams) {
  if (beams.size() < kFewestRows * kFewestBeamsOfRow) return std::nullopt;
  const int sense = senseOf(beams);
  if (sense == 0) return std::nullopt;
  const Helix helix(beams, sense);
  const std::optional<std::int32_t> seam = Seam(beams, helix).find();
  if (!seam) return std::nullopt;
  std::vector<std::size_t> begins = findCrossings(helix, *seam);
  if (begins.size() + 1 > kMostRows) return std::nullopt;
  Rows rows;
  rows.count = begins.size() + 1;
  rows.of_beam.resize(beams.size());
  begins.push_back(beams.size());
  std::size_t first = 0;
  for (std::size_t row = 0; row < begins.size(); ++row) {
    std::fill(rows.of_beam.begin() + static_cast<std::ptrdiff_t>(first),
              rows.of_beam.begin() + static_cast<std::ptrdiff_t>(begins[row]),
              static_cast<std::uint16_t>(row));
    first = begins[row];
  }
  return rows;
}

}  // namespace csom::detail
