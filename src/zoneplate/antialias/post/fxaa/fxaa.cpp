// SPDX-License-Identifier: Apache-2.0
// FXAA 3.11: determines the direction of an edge by luma, follows it to its ends, and fetches each pixel's colour from
// up to half a pixel across it.
//
// It smooths all visible edges, of geometry and of shading, at the lowest cost of all methods. Weaknesses: nearly
// horizontal or vertical edges, because the search ends after a dozen pixels; and it blurs fine text and single pixels.
//
// Source: Lottes, FXAA, NVIDIA whitepaper, 2009, and FXAA 3.11, 2011: the quality path with its presets and the console
// path. Encoded values are blended, as in the original, unless mix=light selects linear light.
#include "zoneplate/antialias/post/fxaa/fxaa.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/fxaa/console.h"
#include "zoneplate/antialias/post/fxaa/search.h"
#include "zoneplate/antialias/post/post_process.h"
#include "zoneplate/antialias/post/result_row.h"
#include "zoneplate/antialias/post/rolling_rows.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace antialias {
namespace {

/// The search of a preset: the distances from the pixel at which luma is tested, in half pixels. The last distance is
/// used without a test.
///
/// Source    the cumulative steps of FXAA 3.11, FXAA_QUALITY__P0 and so on.
struct Search {
  int preset;
  std::array<int, 12> distance;  ///< in half pixels; zeros after the last
};

constexpr Search searches[] = {
    {10, {3, 9, 33}},
    {11, {2, 5, 11, 35}},
    {12, {2, 5, 9, 17, 41}},
    {13, {2, 5, 9, 13, 21, 45}},
    {14, {2, 5, 9, 13, 17, 25, 49}},
    {15, {2, 5, 9, 13, 17, 21, 29, 53}},
    {20, {3, 7, 23}},
    {21, {2, 5, 9, 25}},
    {22, {2, 5, 9, 13, 29}},
    {23, {2, 5, 9, 13, 17, 33}},
    {24, {2, 5, 9, 13, 17, 23, 39}},
    {25, {2, 5, 9, 13, 17, 21, 29, 45}},
    {26, {2, 5, 9, 13, 17, 21, 25, 33, 49}},
    {27, {2, 5, 9, 13, 17, 21, 25, 29, 37, 53}},
    {28, {2, 5, 9, 13, 17, 21, 25, 29, 33, 41, 57}},
    {29, {2, 5, 9, 13, 17, 21, 25, 29, 33, 37, 45, 61}},
    {39, {2, 4, 6, 8, 10, 13, 17, 21, 25, 29, 37, 53}},
};

std::span<const int> distances_of(int preset) {
  const auto search = std::ranges::find(searches, preset, &Search::preset);
  assert(search != std::end(searches));
  const auto end = std::ranges::find(search->distance, 0);
  return {search->distance.begin(), end};
}

/// The threshold max(`share` × greatest, `least`), as the greatest integer contrast below it.
FxaaContrast contrast_of(const FxaaOptions& options) {
  const auto below = [](double v) { return static_cast<int>(std::ceil(v)) - 1; };
  const auto is_right = [&](int factor) {
    for (int greatest = 1; greatest < 256; ++greatest)
      if ((greatest * factor >> 16) != below(greatest * options.threshold)) return false;
    return true;
  };
  const int near = static_cast<int>(options.threshold * 65536);
  const int factor = is_right(near) ? near : is_right(near + 1) ? near + 1 : near - 1;
  assert(is_right(factor));
  return {static_cast<std::uint8_t>(below(options.least * 255)), static_cast<std::uint16_t>(factor)};
}

Rgba8 pixel_at(const Rgba8Image& image, int x, int y) {
  return image(std::clamp(x, 0, image.width() - 1), std::clamp(y, 0, image.height() - 1));
}

/// The luma of the rows within the radius of the current row.
class Luma {
 public:
  Luma(const Rgba8Image& image, const FxaaOptions& options, int first)
      : image_(image),
        row_of_(options.is_green_luma ? FxaaKernels::of().green_row : FxaaKernels::of().luma_row),
        rows_(image.width(), image.height(), fxaa_radius(options), first) {}

  std::ptrdiff_t stride() const { return rows_.stride(); }
  const std::uint8_t* at(int x, int y) const { return rows_.at(x, y); }
  void make_around(int y) {
    rows_.make_around(y, [&](int row, std::uint8_t* luma) {
      row_of_(&image_.row(row)[0].r, luma, static_cast<std::size_t>(image_.width()));
    });
  }

 private:
  const Rgba8Image& image_;
  decltype(FxaaKernels::luma_row) row_of_;
  RollingRows<std::uint8_t> rows_;
};

/// Calls `body(luma, begin, end)` in parallel for blocks of rows. Blocks are large, because two neighbouring blocks
/// both compute the luma along their common border.
template <class Body>
void for_luma_blocks(const Rgba8Image& image, const FxaaOptions& options, const Body& body) {
  constexpr std::size_t rows = 128;
  parallel_ranges(static_cast<std::size_t>(image.height()), rows, [&](std::size_t begin, std::size_t end) {
    const int first = static_cast<int>(begin), last = static_cast<int>(end);
    Luma luma(image, options, first);
    body(luma, first, last);
  });
}

/// The buffers for the results of the kernels in one row.
struct RowMemory {
  std::vector<std::uint8_t> bits, tied_bits, flags;
  std::vector<float> shift;
  explicit RowMemory(int width) {
    const std::size_t n = (static_cast<std::size_t>(width) + 63) / 64 * 64;
    bits.resize(n / 8), tied_bits.resize(n / 8), flags.resize(n), shift.resize(n);
  }
  FxaaEnds ends() { return {flags.data(), shift.data(), tied_bits.data()}; }
};

/// Calls `body(x)` for every set bit.
template <class Body>
void for_bits(const std::vector<std::uint8_t>& bits, const Body& body) {
  for (std::size_t byte = 0; byte < bits.size(); byte += 8) {
    std::uint64_t left = 0;
    for (std::memcpy(&left, bits.data() + byte, sizeof left); left != 0; left &= left - 1)
      body(8 * byte + static_cast<std::size_t>(std::countr_zero(left)));
  }
}

/// Clears the bits of pixels outside the image.
void clear_beyond(std::vector<std::uint8_t>& bits, std::size_t width) {
  if (width % 8 != 0) bits[width / 8] = static_cast<std::uint8_t>(bits[width / 8] & ((1 << width % 8) - 1));
  std::fill(bits.begin() + static_cast<std::ptrdiff_t>((width + 7) / 8), bits.end(), std::uint8_t{0});
}

/// Fetches the colours of one row's pixels.
void mix_row(const Rgba8Image& image, const Luma& luma, const FxaaOptions& options, std::span<const int> distances,
             const FxaaKernels& kernels, int y, RowMemory& row, std::span<Rgba8> out) {
  for_bits(row.tied_bits, [&](std::size_t x) {
    if (!(row.bits[x / 8] >> x % 8 & 1)) return;
    const std::ptrdiff_t side = row.flags[x] & FxaaEnds::second_side ? 1 : -1, stride = luma.stride();
    const bool is_level = row.flags[x] & FxaaEnds::level;
    const float shift = fxaa_tied_shift(luma.at(static_cast<int>(x), y), is_level ? 1 : stride,
                                        side * (is_level ? stride : 1), distances.data(), distances.size());
    row.shift[x] = std::max(row.shift[x], shift);
  });
  if (!options.mixes_light) {
    const auto codes = [&](int j) { return &image.row(std::clamp(j, 0, image.height() - 1))[0].r; };
    kernels.mix_row(codes(y - 1), codes(y), codes(y + 1), row.bits.data(), row.ends(), &out[0].r, out.size());
    return;
  }
  for_bits(row.bits, [&](std::size_t i) {
    const int x = static_cast<int>(i), side = row.flags[i] & FxaaEnds::second_side ? 1 : -1;
    const bool is_level = row.flags[i] & FxaaEnds::level;
    const Rgba8 there = pixel_at(image, x + (is_level ? 0 : side), y + (is_level ? side : 0));
    out[i] = mix_linear(image(x, y), there, row.shift[i]);
  });
}

/// The console path, which does not search for the ends of edges.
Rgba8Image apply_console(const Rgba8Image& image, const FxaaOptions& options, Rgba8Image out) {
  const FxaaConsoleKernels& kernels = FxaaConsoleKernels::of();
  const auto width = static_cast<std::size_t>(image.width());
  const auto threshold = static_cast<float>(options.threshold), least = static_cast<float>(options.least) * 255;
  for_luma_blocks(image, options, [&](Luma& luma, int begin, int end) {
    ResultRow result(image, out);
    std::vector<std::uint8_t> seen((width + 63) / 64 * 64);
    for (int y = begin; y < end; ++y) {
      luma.make_around(y);
      FxaaConsoleRows rows{luma.at(0, y), luma.stride(), {}};
      for (int j = -rows.radius; j <= rows.radius; ++j)
        rows.codes[rows.radius + j] = &image.row(std::clamp(y + j, 0, image.height() - 1))[0].r;
      kernels.seen_row(rows, threshold, least, seen.data(), width);
      kernels.mix_row(rows, options.sharpness, seen.data(), &result.begin(y)[0].r, width);
      result.end();
    }
  });
  return out;
}

}  // namespace

int fxaa_radius(const FxaaOptions& options) {
  if (options.preset == FxaaOptions::console) return FxaaConsoleRows::radius;
  // The last distance is used without a test.
  const std::span<const int> distances = distances_of(options.preset);
  return (distances[distances.size() - 2] + 1) / 2 + 1;
}

Rgba8Image apply_fxaa(const Rgba8Image& image, const FxaaOptions& options, Rgba8Image memory) {
  if (image.empty()) return image;
  const FxaaKernels& kernels = FxaaKernels::of();
  Rgba8Image out = sized_like(image, std::move(memory));
  if (options.preset == FxaaOptions::console) return apply_console(image, options, std::move(out));

  const FxaaContrast contrast = contrast_of(options);
  const std::span<const int> distances = distances_of(options.preset);
  const FxaaSearch search{distances.data(), distances.size(), options.subpixel};
  const auto width = static_cast<std::size_t>(image.width());
  for_luma_blocks(image, options, [&](Luma& luma, int begin, int end) {
    RowMemory row(image.width());
    ResultRow result(image, out);
    for (int y = begin; y < end; ++y) {
      luma.make_around(y);
      kernels.contrast_row(luma.at(0, y), luma.stride(), contrast, row.bits.data(), width);
      clear_beyond(row.bits, width);
      kernels.ends_row(luma.at(0, y), luma.stride(), search, row.bits.data(), row.ends(), width);
      mix_row(image, luma, options, distances, kernels, y, row, result.begin(y));
      result.end();
    }
  });
  return out;
}

namespace {

constexpr std::string_view presets[] = {"10", "11", "12", "13", "14", "15", "20", "21", "22",
                                        "23", "24", "25", "26", "27", "28", "29", "39", "console"};

/// Contrast thresholds, by the names and values of the comments in the original.
struct Threshold {
  std::string_view name;
  double share, least;
};
constexpr Threshold thresholds[] = {{"fastest", 0.333, 0.0833},
                                    {"low", 0.25, 0.0833},
                                    {"medium", 0.166, 0.0833},
                                    {"high", 0.125, 0.0625},
                                    {"overkill", 0.063, 0.0312}};
constexpr std::string_view threshold_names[] = {"fastest", "low", "medium", "high", "overkill"};
constexpr std::string_view lumas[] = {"rec601", "green"};
constexpr std::string_view mixings[] = {"codes", "light"};
constexpr Param params[] = {
    {.name = "preset",
     .meaning = "length and step size of the edge search, as FXAA_QUALITY__PRESET, or the console path",
     .value = 2,
     .names = presets},
    {.name = "threshold", .meaning = "minimum contrast of edges", .value = 2, .names = threshold_names},
    {.name = "subpixel", .meaning = "sub-pixel smoothing, in percent", .value = 75, .low = 0, .high = 100},
    {.name = "luma", .meaning = "luma that measures contrast", .value = 0, .names = lumas},
    {.name = "mix",
     .meaning = "blending in sRGB-encoded values (codes) or in linear light",
     .value = 0,
     .names = mixings},
};

FxaaOptions options_of(const Settings& s) {
  FxaaOptions o;
  const std::string preset(s.chosen("preset"));
  o.preset = preset == "console" ? FxaaOptions::console : std::stoi(preset);
  if (o.preset == FxaaOptions::console && !s.is_given("threshold"))
    o.threshold = 0.125, o.least = 0.05;  // the console path's own defaults
  else
    for (const Threshold& t : thresholds)
      if (t.name == s.chosen("threshold")) o.threshold = t.share, o.least = t.least;
  o.subpixel = static_cast<float>(s.integer("subpixel")) / 100;
  o.is_green_luma = s.chosen("luma") == "green";
  o.mixes_light = s.chosen("mix") == "light";
  return o;
}

std::unique_ptr<Resolver> make(const Settings& s) {
  const FxaaOptions options = options_of(s);
  return make_post_process(fxaa_radius(options), options.mixes_light ? Mixing::Linear : Mixing::Encoded,
                           [options](const Rgba8Image& i) { return apply_fxaa(i, options); });
}

constexpr std::string_view variants[] = {"preset=39", "preset=console"};

}  // namespace

Method fxaa() {
  return {.name = "fxaa",
          .summary = "one fetch across each edge, shifted by the distance to the edge's ends",
          .source = "Lottes 2011, FXAA 3.11",
          .params = params,
          .make = make,
          .variants = variants};
}

}  // namespace antialias
}  // namespace zoneplate
