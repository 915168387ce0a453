// SPDX-License-Identifier: Apache-2.0
// CMAA2: processes only pixels at a corner of edges. They are blurred slightly; and if the corner is a step of a long,
// nearly symmetric edge (a Z shape), the pixels along the edge are blended as by MLAA.
//
// It preserves text and texture: pixels without a corner do not change. Weakness: uneven or short edges are hardly
// smoothed.
//
// Source: Strugar, Conservative Morphological Anti-Aliasing 2.0, Intel, 2018 (v2.3); without its packing of colours.
#include "zoneplate/antialias/post/cmaa2/cmaa2.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "zoneplate/antialias/post/bordered.h"
#include "zoneplate/antialias/post/cmaa2/edge_detection.h"
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/post_process.h"
#include "zoneplate/antialias/post/row_window.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace antialias {
namespace {

constexpr int longest_line = 86;
/// The greatest distance from its corner at which a Z shape blends pixels: half a line.
constexpr int farthest_item = longest_line / 2 + 1;
constexpr int radius = longest_line + farthest_item + 4;

/// The constants of the original and of its extra-sharp variant.
struct Tuning {
  float contrast, bluriness, dampening, growth, growth_offset;
  float fade_start, fade_step;  ///< of simple shapes, by the number of surrounding edges
  float shortening_round;       ///< the offset before the lengths of a Z's lines are truncated to integers
};
constexpr Tuning usual = {0.10f, 0.10f, 0.15f, 1.25f, 0.25f, 1.30f, 10, 0};
constexpr Tuning sharp = {0.15f, 0.07f, 0.11f, 1.20f, 0.20f, 1.15f, 8, 0.5f};
constexpr float symmetry_correction = 0.22f;

/// The borders of a pixel that are edges, as bits of the output of Cmaa2Kernels::shape_row.
enum : std::uint8_t { right_bit = 1, below_bit = 2, left_bit = 4, above_bit = 8 };
struct Borders {
  float r, g, b, a;  ///< right, below, left, above, as the original names them; 0 or 1
  explicit Borders(std::uint8_t bits) : r(bits & 1), g(bits >> 1 & 1), b(bits >> 2 & 1), a(bits >> 3 & 1) {}
};

/// The borders of the image rotated clockwise by 90 degrees: the border above becomes the one on the right.
std::uint8_t turned(std::uint8_t bits) { return static_cast<std::uint8_t>((bits << 1 | bits >> 3) & 15); }

float saturated(float v) { return std::clamp(v, 0.0f, 1.0f); }

/// The contribution of a shape to one pixel.
struct Item {
  std::uint32_t pixel;
  float weight;
  Linear color;
};
constexpr float simple_weight = 0.8f, complex_weight = 1.8f;

/// The contributions of the corners of one block of rows, by the block of rows that receives them.
struct BlockItems {
  static constexpr int around = farthest_item / static_cast<int>(rows_a_block) + 1;
  std::array<std::vector<Item>, 2 * around + 1> of_block;
};

using Shapes = Bordered<std::uint8_t>;

/// The contribution to luma of each value of each channel.
struct LumaTables {
  std::array<float, 256> r, g, b;
  LumaTables() {
    for (std::size_t i = 0; i < 256; ++i) {
      const float root = std::sqrt(decode_srgb8(static_cast<std::uint8_t>(i)));
      r[i] = 0.299f * root, g[i] = 0.587f * root, b[i] = 0.114f * root;
    }
  }
};

/// Finds the edges around every pixel, and sets bit x of a row of `corners` for pixels with a corner.
Shapes find_shapes(const Rgba8Image& image, const Cmaa2Options& options, Plane<std::uint64_t>& corners) {
  const int width = image.width(), height = image.height();
  const Cmaa2Kernels& kernels = Cmaa2Kernels::of();
  const LumaTables tables;
  const float contrast = options.is_sharp ? sharp.contrast : usual.contrast;
  const auto n = static_cast<std::size_t>(width);
  Shapes shapes(width, height, longest_line + 4);
  shapes.fill_border(0);
  parallel_ranges(static_cast<std::size_t>(height), rows_a_block, [&](std::size_t begin, std::size_t end) {
    RowWindow<float> window(width);
    const auto make = [&](int y) {
      float* row = window.begin_row(y);
      const auto pixels = image.row(std::clamp(y, 0, height - 1));
      for (std::size_t x = 0; x < n; ++x)
        row[x] = tables.r[pixels[x].r] + tables.g[pixels[x].g] + tables.b[pixels[x].b];
      window.end_row(y);
    };
    // Two buffers alternate between the edges of a row and of the row above it.
    constexpr std::size_t before = 32;
    std::vector<std::uint8_t> edges[2];
    for (auto& e : edges) e.assign(n + 2 * before + 32, 0);
    const auto detect = [&](int y) {
      const float* const rows[4] = {window.begin_row(y - 1), window.begin_row(y), window.begin_row(y + 1), nullptr};
      kernels.edge_row(rows, options.threshold, contrast, edges[y & 1].data() + before, n);
    };
    const int first = static_cast<int>(begin), last = static_cast<int>(end);
    for (int y = first - 2; y <= first; ++y) make(y);
    detect(first - 1);
    for (int y = first; y < last; ++y) {
      make(y + 1);
      detect(y);
      kernels.shape_row(edges[y & 1].data() + before, edges[(y - 1) & 1].data() + before, shapes.at(0, y),
                        reinterpret_cast<std::uint8_t*>(corners.row(y).data()), n);
      std::fill_n(shapes.at(width, y), 32, std::uint8_t{0});
    }
  });
  return shapes;
}

/// Converts the corners of one block to items.
class Corners {
 public:
  Corners(const Rgba8Image& image, const Shapes& shapes, const Tuning& tuning, int block, BlockItems& items)
      : image_(image), shapes_(shapes), tuning_(tuning), block_(block), items_(items) {}

  void treat(int x, int y) {
    soften(x, y);
    const Z z = find_z(x, y);
    if (z.score > 0) mix_z(x, y, z);
  }

 private:
  /// A step between two lines, which run along x, or along -y if vertical.
  struct Z {
    float score = 0;
    bool is_inverted = false, is_vertical = false;
  };

  Linear color(int x, int y) const {
    return decode_pixel(image_(std::clamp(x, 0, image_.width() - 1), std::clamp(y, 0, image_.height() - 1)));
  }
  void emit(int x, int y, float weight, const Linear& c) {
    const int at = y / static_cast<int>(rows_a_block) - block_ + BlockItems::around;
    items_.of_block[static_cast<std::size_t>(at)].push_back(
        {static_cast<std::uint32_t>(y * image_.width() + x), weight, c});
  }

  /// Blends a corner slightly with the neighbours across its edges.
  void soften(int x, int y) {
    const std::uint8_t* p = shapes_.at(x, y);
    const Borders e(*p), l(p[-1]), r(p[1]), t(*(p - shapes_.stride())), b(*(p + shapes_.stride()));
    const float count = e.r + e.g + e.b + e.a;
    const float around = (l.b + l.g + l.a) + (r.r + r.g + r.a) + (t.r + t.b + t.a) + (b.r + b.g + b.b);
    float from_right = e.r, from_below = e.g, from_left = e.b, from_above = e.a, weight = tuning_.bluriness;
    if (count == 2) {
      constexpr float k = 0.9f;
      weight *= 0.75f;
      from_right += k * (e.g * t.r * (1 - l.g) + e.a * b.r * (1 - l.a));
      from_below += k * (e.b * r.g * (1 - t.b) + e.r * l.g * (1 - t.r));
      from_left += k * (e.a * b.b * (1 - r.a) + e.g * t.b * (1 - r.g));
      from_above += k * (e.r * l.a * (1 - b.r) + e.b * r.a * (1 - b.b));
    }
    weight *= saturated(tuning_.fade_start - around / tuning_.fade_step);
    const float sum = weight * ((from_right + from_left) + (from_below + from_above));
    const Linear here = color(x, y), cr = color(x + 1, y), cl = color(x - 1, y), cb = color(x, y + 1),
                 ct = color(x, y - 1);
    const auto mix = [&](float c, float fr, float fl, float fb, float ft) {
      return c * (1 - sum) + weight * ((from_right * fr + from_left * fl) + (from_below * fb + from_above * ft));
    };
    emit(x, y, simple_weight,
         {mix(here.r, cr.r, cl.r, cb.r, ct.r), mix(here.g, cr.g, cl.g, cb.g, ct.g), mix(here.b, cr.b, cl.b, cb.b, ct.b),
          mix(here.a, cr.a, cl.a, cb.a, ct.a)});
  }

  static Z score_of(std::uint8_t here, std::uint8_t before, std::uint8_t after, std::uint8_t after2) {
    const Borders e(here), m1(before), p1(after), p2(after2);
    const float inverted =
        e.r * e.g * p1.a * (2 + (m1.g + p2.a) - (e.a + p1.g) - 0.7f * ((p2.g + m1.a) + (e.b + p1.r)));
    const float normal = e.r * e.a * p1.g * (2 + (m1.a + p2.g) - (e.g + p1.a) - 0.7f * ((p2.a + m1.g) + (e.b + p1.r)));
    return {std::max(inverted, normal), inverted > normal, false};
  }

  Z find_z(int x, int y) const {
    const std::uint8_t* p = shapes_.at(x, y);
    const std::ptrdiff_t s = shapes_.stride();
    const Z level = score_of(*p, p[-1], p[1], p[2]);
    Z upright = score_of(turned(*p), turned(p[s]), turned(*(p - s)), turned(*(p - 2 * s)));
    upright.is_vertical = true;
    return upright.score > level.score ? upright : level;
  }

  /// The lengths of the lines on both sides of a step. Both are followed in parallel, so that the lengths differ only
  /// slightly.
  struct Lengths {
    int left = 1, right = 1;
  };
  Lengths follow(const std::uint8_t* p, std::ptrdiff_t step, const Z& z) const {
    std::uint8_t left_edge = z.is_vertical ? left_bit : above_bit, right_edge = z.is_vertical ? right_bit : below_bit;
    if (z.is_inverted) std::swap(left_edge, right_edge);
    Lengths n;
    for (bool left = true, right = true;;) {
      left = left && *(p - step * n.left) & left_edge;
      right = right && *(p + step * (n.right + 1)) & right_edge;
      n.left += left, n.right += right;
      const int longer = left || right ? std::max(n.left, n.right) : longest_line;
      const float limit = tuning_.growth * static_cast<float>(std::min(n.left, n.right)) - tuning_.growth_offset;
      if (static_cast<float>(longer) >= std::min(static_cast<float>(longest_line), limit)) return n;
    }
  }

  void mix_z(int x, int y, const Z& z) {
    const int dx = z.is_vertical ? 0 : 1, dy = z.is_vertical ? -1 : 0;
    const int shortening = static_cast<int>(std::clamp(4 - z.score, 0.0f, 3.0f) + tuning_.shortening_round);
    Lengths n = follow(shapes_.at(x, y), dx + dy * shapes_.stride(), z);
    n.left -= shortening, n.right -= shortening;
    if (n.left + n.right < 5) return;

    const int across = z.is_inverted ? 1 : -1;
    const int across_x = z.is_vertical ? across : 0, across_y = z.is_vertical ? 0 : across;
    const float odd_left = symmetry_correction * static_cast<float>(n.left & 1);
    const float odd_right = symmetry_correction * static_cast<float>(n.right & 1);
    const float damp = saturated(static_cast<float>(n.left + n.right - shortening) * tuning_.dampening);
    const int from = 1 - ((n.left + 1) >> 1), to = (n.right + 1) >> 1;
    const float s = 1 / (static_cast<float>(to - from + 1) - odd_left - odd_right);
    const float k0 = (0.5f - odd_left - static_cast<float>(from)) * s;
    for (int i = from; i <= to; ++i) {
      const bool is_second = i > 0;
      const int side = is_second ? -1 : 1;
      const float k = ((s * static_cast<float>(i) + k0) * static_cast<float>(side) + (is_second ? 1.0f : 0.0f)) * damp;
      const int px = x + dx * i, py = y + dy * i;
      const Linear a = color(px, py), b = color(px + across_x * side, py + across_y * side);
      emit(px, py, complex_weight,
           {a.r + (b.r - a.r) * k, a.g + (b.g - a.g) * k, a.b + (b.b - a.b) * k, a.a + (b.a - a.a) * k});
    }
  }

  const Rgba8Image& image_;
  const Shapes& shapes_;
  const Tuning& tuning_;
  int block_;
  BlockItems& items_;
};

std::vector<BlockItems> make_items(const Rgba8Image& image, const Shapes& shapes, const Plane<std::uint64_t>& corners,
                                   const Tuning& tuning) {
  std::vector<BlockItems> blocks((static_cast<std::size_t>(image.height()) + rows_a_block - 1) / rows_a_block);
  parallel_for(blocks.size(), [&](std::size_t block) {
    Corners treat(image, shapes, tuning, static_cast<int>(block), blocks[block]);
    const int first = static_cast<int>(block * rows_a_block);
    for (int y = first; y < std::min(image.height(), first + static_cast<int>(rows_a_block)); ++y)
      for (int word = 0; word < corners.width(); ++word) {
        std::uint64_t left = corners(word, y);
        if (image.width() - 64 * word < 64) left &= (std::uint64_t{1} << (image.width() - 64 * word)) - 1;
        for (; left != 0; left &= left - 1) treat.treat(64 * word + std::countr_zero(left), y);
      }
  });
  return blocks;
}

/// Adds up the contributions to one block of rows, in the order of the blocks that they come from.
void apply_items(const std::vector<BlockItems>& blocks, int block, std::span<Rgba8> out, std::size_t first_pixel,
                 std::size_t pixels) {
  struct Sum {
    std::uint32_t pixel;
    float weight;
    Linear color;
  };
  std::vector<Sum> sums;
  std::vector<std::uint32_t> place(pixels);  // one more than the index of the pixel's sum
  for (int source = std::max(0, block - BlockItems::around);
       source <= std::min(static_cast<int>(blocks.size()) - 1, block + BlockItems::around); ++source)
    for (const Item& item : blocks[static_cast<std::size_t>(source)]
                                .of_block[static_cast<std::size_t>(block - source + BlockItems::around)]) {
      std::uint32_t& at = place[item.pixel - first_pixel];
      if (at == 0) {
        sums.push_back({item.pixel, 0, {0, 0, 0, 0}});
        at = static_cast<std::uint32_t>(sums.size());
      }
      Sum& sum = sums[at - 1];
      sum.weight += item.weight;
      sum.color = sum.color + item.color * item.weight;
    }
  for (const Sum& s : sums)
    out[s.pixel] =
        encode_pixel({s.color.r / s.weight, s.color.g / s.weight, s.color.b / s.weight, s.color.a / s.weight});
}

}  // namespace

Rgba8Image apply_cmaa2(const Rgba8Image& image, const Cmaa2Options& options, Rgba8Image memory) {
  if (image.empty()) return image;
  Plane<std::uint64_t> corners((image.width() + 63) / 64, image.height());
  const Shapes shapes = find_shapes(image, options, corners);
  const std::vector<BlockItems> blocks = make_items(image, shapes, corners, options.is_sharp ? sharp : usual);
  Rgba8Image out = sized_like(image, std::move(memory));
  const std::size_t width = static_cast<std::size_t>(image.width());
  parallel_for(blocks.size(), [&](std::size_t block) {
    const std::size_t first = block * rows_a_block * width;
    const std::size_t pixels = std::min(rows_a_block * width, image.values().size() - first);
    std::memcpy(&out.values()[first], &image.values()[first], pixels * sizeof(Rgba8));
    apply_items(blocks, static_cast<int>(block), out.values(), first, pixels);
  });
  return out;
}

namespace {

constexpr std::string_view presets[] = {"low", "medium", "high", "ultra"};
constexpr float thresholds[] = {0.15f, 0.10f, 0.07f, 0.05f};
constexpr Param params[] = {
    {.name = "preset", .meaning = "sensitivity of edge detection", .value = 2, .names = presets},
    {.name = "sharp", .meaning = "1: the extra sharpness of the original", .value = 0, .low = 0, .high = 1},
};

std::unique_ptr<Resolver> make(const Settings& s) {
  const Cmaa2Options options{.threshold = thresholds[s.integer("preset")], .is_sharp = s.integer("sharp") == 1};
  return make_post_process(radius, Mixing::Linear, [options](const Rgba8Image& i) { return apply_cmaa2(i, options); });
}

}  // namespace

Method cmaa2() {
  return {.name = "cmaa2",
          .summary = "slight blur at corners, blending along long symmetric steps",
          .source = "Strugar 2018, CMAA2 2.3",
          .params = params,
          .make = make,
          .is_specification_only = true};
}

}  // namespace antialias
}  // namespace zoneplate
