// SPDX-License-Identifier: Apache-2.0
// DDAA: for nearly horizontal or vertical edges, an edge search as in FXAA, but at every pixel; for nearly diagonal
// ones, a short blur along the edge.
//
// It treats different angles more uniformly than FXAA. Weakness: the blur thins diagonals that are one pixel wide.
//
// Source: Klein, Directional Diffusion Anti-Aliasing 2.4, 2025; gradients after Scharr.
#include "zoneplate/antialias/post/ddaa/ddaa.h"

#include <algorithm>
#include <array>
#include <vector>

#include "zoneplate/antialias/post/ddaa/pixels.h"
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/post_process.h"
#include "zoneplate/antialias/post/result_row.h"
#include "zoneplate/antialias/post/rolling_rows.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

constexpr int radius = DdaaConstants::search + 2;

}  // namespace

Rgba8Image apply_ddaa(const Rgba8Image& image, const DdaaOptions& options, Rgba8Image memory) {
  if (image.empty()) return image;
  const DdaaKernels& kernels = DdaaKernels::of();
  Rgba8Image out = sized_like(image, std::move(memory));
  const auto width = static_cast<std::size_t>(image.width()), room = (width + 63) / 64 * 64;
  // Blocks are large, because two neighbouring blocks both compute the power along their common border.
  constexpr std::size_t rows = 128;
  parallel_ranges(static_cast<std::size_t>(image.height()), rows, [&](std::size_t begin, std::size_t end) {
    RollingRows<float> power(image.width(), image.height(), radius, static_cast<int>(begin));
    ResultRow result(image, out);
    std::vector<std::uint8_t> seen(room);
    std::vector<float> taps(4 * room);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      power.make_around(y, [&](int row, float* to) { kernels.power_row(&image.row(row)[0].r, to, width); });
      kernels.seen_row(power.at(0, y), power.stride(), options.threshold, options.least, seen.data(), width);
      std::fill(seen.begin() + image.width(), seen.end(), std::uint8_t{0});
      kernels.taps_row(power.at(0, y), power.stride(), options.strength, seen.data(), taps.data(), width);
      std::array<const std::uint8_t*, 5> codes;
      for (int j = 0; j < 5; ++j)
        codes[static_cast<std::size_t>(j)] = &image.row(std::clamp(y + j - 2, 0, image.height() - 1))[0].r;
      kernels.fetch_row(codes.data(), taps.data(), seen.data(), &result.begin(y)[0].r, width);
      result.end();
    }
  });
  return out;
}

namespace {

struct Threshold {
  std::string_view name;
  float share, least;
};
constexpr Threshold thresholds[] = {{"low", 0.25f, 0.0833f}, {"medium", 0.166f, 0.0625f}, {"extreme", 0.031f, 0.0078f}};
constexpr std::string_view threshold_names[] = {"low", "medium", "extreme"};
constexpr Param params[] = {
    {.name = "threshold", .meaning = "minimum contrast of edges", .value = 1, .names = threshold_names},
    {.name = "strength", .meaning = "strength of the blur along edges", .value = 3, .low = 0, .high = 9},
};

std::unique_ptr<Resolver> make(const Settings& s) {
  const Threshold& t = thresholds[s.integer("threshold")];
  const DdaaOptions options{
      .threshold = t.share, .least = t.least, .strength = static_cast<float>(s.integer("strength"))};
  return make_post_process(radius, Mixing::Encoded, [options](const Rgba8Image& i) { return apply_ddaa(i, options); });
}

}  // namespace

Method ddaa() {
  return {.name = "ddaa",
          .summary = "edge search for edges near the axes, blur along edges near the diagonals",
          .source = "Klein 2025, DDAA 2.4",
          .params = params,
          .make = make,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
