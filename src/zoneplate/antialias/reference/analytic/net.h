// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace zoneplate::antialias {

/// The sample positions of a crowded pixel: a scrambled Sobol sequence in rounds, each of which quadruples the number
/// of samples.
///
/// Round r ends at `ends[r]` samples. A round is sorted along a Z-order curve, so that the samples of a square of the
/// pixel's quadtree are consecutive; all squares of a level have the same number. `Shift` is combined with the
/// positions of a pixel by exclusive or, which keeps the stratification and makes the errors of neighbouring pixels
/// independent.
///
/// Units     pixels from the pixel's top-left corner; all coordinates are odd multiples of 2^-33, so that no sample is
///           on a vertex or on a vertical or horizontal edge.
/// Source    Owen, Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences, 1995; digital shifts: Kollig and Keller,
///           Efficient Multidimensional Sampling, Eurographics 2002, section 3.
class SampleNet {
 public:
  static constexpr std::array<std::size_t, 3> ends = {256, 1024, 4096};
  /// Groups of the samples up to the end of a round, each of which is stratified.
  static constexpr std::size_t groups = 4;
  static constexpr int deepest = 4;  ///< the level whose squares have 1 sample of the first round

  struct Shift {
    std::uint32_t x = 0, y = 0;
  };
  struct Sample {
    double x, y;
    std::uint32_t group;
  };

  SampleNet();

  std::size_t size(std::size_t round) const { return rounds_[round].size(); }
  /// The samples of the square in row `row` and column `column` of the 2^level × 2^level squares of a pixel.
  /// Requires  level <= deepest.
  template <class Use>
  void for_square(std::size_t round, int level, std::uint32_t column, std::uint32_t row, Shift shift, Use use) const {
    for (const Place& p : square(round, level, column, row, shift))
      use(Sample{unit(p.x ^ shift.x), unit(p.y ^ shift.y), p.group});
  }

 private:
  struct Place {
    std::uint32_t x, y, group;
  };
  std::span<const Place> square(std::size_t round, int level, std::uint32_t column, std::uint32_t row,
                                Shift shift) const;
  static double unit(std::uint32_t v) { return (static_cast<double>(v) + 0.5) * 0x1p-32; }

  std::array<std::vector<Place>, ends.size()> rounds_;
};

}  // namespace zoneplate::antialias
