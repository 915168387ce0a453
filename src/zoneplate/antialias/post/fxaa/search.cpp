// SPDX-License-Identifier: Apache-2.0
// The scalar equivalents of FXAA's kernels, and its search if a comparison is tied.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "zoneplate/antialias/post/fxaa/search_lanes.h"

namespace zoneplate {
namespace scalar {
namespace {

void luma_row(const std::uint8_t* rgba, std::uint8_t* luma, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const int r = rgba[4 * i], g = rgba[4 * i + 1], b = rgba[4 * i + 2];
    luma[i] = static_cast<std::uint8_t>((299 * r + 587 * g + 114 * b + 500) / 1000);
  }
}

void green_row(const std::uint8_t* rgba, std::uint8_t* green, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) green[i] = rgba[4 * i + 1];
}

void contrast_row(const std::uint8_t* luma, std::ptrdiff_t stride, FxaaContrast contrast, std::uint8_t* bits,
                  std::size_t n) {
  std::fill_n(bits, (n + 7) / 8, std::uint8_t{0});
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint8_t* m = luma + i;
    const auto [low, high] = std::minmax({m[0], m[-stride], m[stride], m[-1], m[1]});
    const int share = high * contrast.factor >> 16;
    const bool is_seen = high - low > std::max<int>(share, contrast.least);
    bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | is_seen << i % 8);
  }
}

/// The offset at which the line through two ends at these distances leaves the pixel.
float shift_between(int before, int after) {
  return 0.5f - static_cast<float>(std::min(before, after)) / static_cast<float>(before + after);
}

/// code / 255 for every code.
constexpr std::array<double, 256> units = [] {
  std::array<double, 256> out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<double>(i) / 255;
  return out;
}();

/// Follows the border between a pixel and the one across it, in both directions.
class Walk {
 public:
  Walk(const std::uint8_t* pixel, std::ptrdiff_t along, std::ptrdiff_t across)
      : pixel_(pixel),
        along_(along),
        across_(across),
        gradient_(std::abs(pixel[0] - pixel[across])),
        twice_(2 * pair(0)) {}

  /// Four times the luma on the border, `distance` half pixels along it, minus four times that at the pixel.
  int error(int distance) const { return pair(distance >> 1) + pair((distance + 1) >> 1) - twice_; }
  int gradient() const { return gradient_; }

  /// Finds the ends. `is_end(distance, error)` decides whether there is one at this distance.
  template <class IsEnd>
  void find(const int* distances, std::size_t count, int& before, int& after, bool& bends, const IsEnd& is_end) const {
    before = after = distances[0];
    int error_before = error(-before), error_after = error(after);
    bool is_before = is_end(-before, error_before), is_after = is_end(after, error_after);
    if (!is_before) before = distances[1];
    if (!is_after) after = distances[1];
    for (std::size_t i = 2; i < count && !(is_before && is_after); ++i) {
      if (!is_before) {
        error_before = error(-before), is_before = is_end(-before, error_before);
        if (!is_before) before = distances[i];
      }
      if (!is_after) {
        error_after = error(after), is_after = is_end(after, error_after);
        if (!is_after) after = distances[i];
      }
    }
    const int nearer = before < after ? error_before : error_after;
    bends = (nearer < 0) != (pixel_[0] < pixel_[across_]);
  }

  /// Compares `error` with a quarter of the gradient in rounded numbers, to decide ties.
  bool reaches_rounded(int distance) const {
    const double end = std::abs(unit(0) - unit(across_)) * 0.25;
    const double luma = (border(distance >> 1) + border((distance + 1) >> 1)) * 0.5;
    return std::abs(luma - border(0)) >= end;
  }

 private:
  int pair(std::ptrdiff_t i) const { return pixel_[i * along_] + pixel_[i * along_ + across_]; }
  double unit(std::ptrdiff_t offset) const { return units[pixel_[offset]]; }
  double border(std::ptrdiff_t i) const { return (unit(i * along_) + unit(i * along_ + across_)) * 0.5; }

  const std::uint8_t* pixel_;
  std::ptrdiff_t along_, across_;
  int gradient_, twice_;
};

void ends_of(const std::uint8_t* p, std::ptrdiff_t stride, const FxaaSearch& search, const FxaaEnds& ends,
             std::size_t i) {
  const int m = p[0], n = p[-stride], s = p[stride], w = p[-1], e = p[1];
  const int nw = p[-stride - 1], ne = p[-stride + 1], sw = p[stride - 1], se = p[stride + 1];
  const int h = std::abs(nw + sw - 2 * w) + 2 * std::abs(n + s - 2 * m) + std::abs(ne + se - 2 * e);
  const int v = std::abs(nw + ne - 2 * n) + 2 * std::abs(w + e - 2 * m) + std::abs(sw + se - 2 * s);
  const bool is_level = h >= v;
  const bool is_second = std::abs((is_level ? s : e) - m) > std::abs((is_level ? n : w) - m);

  const Walk walk(p, is_level ? 1 : stride, (is_second ? 1 : -1) * (is_level ? stride : 1));
  int before = 0, after = 0;
  bool bends = false, is_tied = false;
  walk.find(search.distances, search.count, before, after, bends, [&](int, int error) {
    is_tied |= std::abs(error) == walk.gradient();
    return std::abs(error) >= walk.gradient();
  });
  const float line = bends && !is_tied ? shift_between(before, after) : 0.0f;

  // A pixel that differs from the mean of its neighbours is moved towards them.
  const int range = std::max({m, n, s, w, e}) - std::min({m, n, s, w, e});
  const int unlikeness = std::abs(2 * (n + s + w + e) + nw + ne + sw + se - 12 * m);
  const float c = std::min(1.0f, static_cast<float>(unlikeness) / static_cast<float>(12 * range));
  const float smooth = (3 - 2 * c) * c * c;
  ends.shift[i] = std::max(line, smooth * smooth * search.subpixel);
  ends.flags[i] = static_cast<std::uint8_t>((is_level ? FxaaEnds::level : 0) | (is_second ? FxaaEnds::second_side : 0));
  if (is_tied) ends.tied_bits[i / 8] = static_cast<std::uint8_t>(ends.tied_bits[i / 8] | 1 << i % 8);
}

void ends_row(const std::uint8_t* luma, std::ptrdiff_t stride, const FxaaSearch& search, const std::uint8_t* bits,
              const FxaaEnds& ends, std::size_t n) {
  std::fill_n(ends.tied_bits, (n + 7) / 8, std::uint8_t{0});
  for (std::size_t i = 0; i < n; ++i)
    if (bits[i / 8] >> i % 8 & 1) ends_of(luma + i, stride, search, ends, i);
}

void mix_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, const std::uint8_t* bits,
             const FxaaEnds& ends, std::uint8_t* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    if (bits[i / 8] >> i % 8 & 1) stages::fxaa_mix_pixel(above, here, below, ends, out, i, n);
}

}  // namespace

}  // namespace scalar

template <>
const FxaaKernels PerIsa<FxaaKernels>::scalar = {.luma_row = scalar::luma_row,
                                                 .green_row = scalar::green_row,
                                                 .contrast_row = scalar::contrast_row,
                                                 .ends_row = scalar::ends_row,
                                                 .mix_row = scalar::mix_row};

namespace antialias {

float fxaa_tied_shift(const std::uint8_t* pixel, std::ptrdiff_t along, std::ptrdiff_t across, const int* distances,
                      std::size_t count) {
  const scalar::Walk walk(pixel, along, across);
  int before = 0, after = 0;
  bool bends = false;
  walk.find(distances, count, before, after, bends, [&](int distance, int error) {
    return std::abs(error) == walk.gradient() ? walk.reaches_rounded(distance) : std::abs(error) > walk.gradient();
  });
  return bends ? scalar::shift_between(before, after) : 0;
}

}  // namespace antialias
}  // namespace zoneplate
