// SPDX-License-Identifier: Apache-2.0
// Morphological antialiasing: interprets borders between different pixels as steps of straight lines, and blends each
// pixel with the other side by the area cut off by the line through the midpoints of the steps.
//
// The predecessor of SMAA, in both published forms. Weaknesses: it rounds corners, and noise interrupts the borders.
//
// Source: Jimenez, Masia, Echevarria, Navarro, Gutierrez, Practical Morphological Anti-Aliasing, GPU Pro 2, 2011 (code
// 2.0); Reshetov, Morphological Antialiasing, HPG 2009 (see reshetov.cpp).
#include "zoneplate/antialias/post/mlaa/mlaa.h"

#include <cmath>
#include <cstring>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/mlaa/edge_detection.h"
#include "zoneplate/antialias/post/post_process.h"
#include "zoneplate/antialias/post/rows.h"
#include "zoneplate/antialias/post/smaa/tables.h"

namespace zoneplate::antialias {
namespace {

/// Areas for every pair of distances and every pair of crossing edges, in 1/255; without the smoothing that SMAA added.
class MlaaAreas {
 public:
  explicit MlaaAreas(int greatest) : size_(greatest + 1), codes_(16 * static_cast<std::size_t>(size_ * size_)) {
    for (int pattern = 0; pattern < 16; ++pattern)
      for (int right = 0; right < size_; ++right)
        for (int left = 0; left < size_; ++left) {
          const AreaPair area = orthogonal_area(pattern, left, right, 0, false);
          codes_[index(pattern, left, right)] = {static_cast<std::uint8_t>(255 * area.below + 0.5),
                                                 static_cast<std::uint8_t>(255 * area.above + 0.5)};
        }
  }
  struct Codes {
    std::uint8_t below, above;
  };
  Codes at(int pattern, int left, int right) const { return codes_[index(pattern, left, right)]; }

 private:
  std::size_t index(int pattern, int left, int right) const {
    return static_cast<std::size_t>((pattern * size_ + right) * size_ + left);
  }
  int size_;
  std::vector<Codes> codes_;
};

EdgePlane find_edges(const Rgba8Image& image, const MlaaOptions& options, int border) {
  constexpr float white = 255 * 10000;
  const float threshold = std::round(static_cast<float>(options.threshold) * white);
  const auto width = static_cast<std::size_t>(image.width());
  const RowKernels& kernels = RowKernels::of();
  const MlaaKernels& edge_kernels = MlaaKernels::of();
  EdgePlane edges(image.width(), image.height(), border);
  detect_edges<float>(
      edges, [&](int y, float* row) { kernels.luma(&image.row(y)[0].r, row, width); },
      [&](const EdgeRows<float>& rows, std::uint8_t* out) { edge_kernels.luma_edges(rows, threshold, out, width); });
  edges.extend();
  return edges;
}

/// The edges along a line, relative to one of its pixels; the shader fetches two of them at a time.
struct Line {
  const std::uint8_t* pixel;
  std::ptrdiff_t along, across;
  std::uint8_t own, cross;

  int is(int i, int j, std::uint8_t edge) const { return pixel[i * along + j * across] & edge ? 1 : 0; }

  /// The length of the line; the fetch does not distinguish which one of the last two pixels is an edge.
  int distance(int direction, int steps) const {
    for (int i = 0; i < steps; ++i) {
      const int both = is(direction * (2 * i + 1), 0, own) + is(direction * (2 * i + 2), 0, own);
      if (both < 2) return 2 * i + both;
    }
    return 2 * steps;
  }

  MlaaAreas::Codes areas(const MlaaAreas& table, int steps) const {
    const int left = distance(-1, steps), right = distance(1, steps);
    const int pattern = is(-left, 0, cross) * left_down | is(-left, -1, cross) * left_up |
                        is(right + 1, 0, cross) * right_down | is(right + 1, -1, cross) * right_up;
    return table.at(pattern, left, right);
  }
};

/// Each blended colour is weighted by its blending weight.
Rgba8 mixed_pixel(const Rgba8Image& image, int x, int y, const TakenWeights& taken, bool mixes_light) {
  const auto at = [&](int i, int j) {
    const Rgba8 c = image(std::clamp(i, 0, image.width() - 1), std::clamp(j, 0, image.height() - 1));
    if (mixes_light) return decode_pixel(c);
    return Linear{static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b), static_cast<float>(c.a)};
  };
  const Linear here = at(x, y), others[4] = {at(x, y - 1), at(x, y + 1), at(x - 1, y), at(x + 1, y)};
  const std::uint8_t weights[4] = {taken.above, taken.below, taken.left, taken.right};
  Linear sum{0, 0, 0, 0};
  float total = 0;
  for (int i = 0; i < 4; ++i) {
    const float a = unorm8_value[weights[i]];
    sum = sum + (here * (1 - a) + others[i] * a) * a;
    total += a;
  }
  const Linear out{sum.r / total, sum.g / total, sum.b / total, sum.a / total};
  if (mixes_light) return encode_pixel(out);
  return {round_unorm8(out.r), round_unorm8(out.g), round_unorm8(out.b), round_unorm8(out.a)};
}

int reach_of(const MlaaOptions& options) {
  constexpr int whole_picture = 32768;
  return options.kind == MlaaOptions::Kind::Reshetov ? whole_picture : 2 * options.steps + 4;
}

/// The second pass for one row: weights from the distances to the ends of edges.
void weigh(const EdgePlane& edges, const MlaaAreas& table, int steps, int y, WeightRow& out) {
  for (int block = 0; block < edges.width(); block += 8) {
    std::uint64_t any = 0;
    std::memcpy(&any, edges.at(block, y), sizeof any);
    if (any == 0) continue;
    for (int x = block; x < std::min(block + 8, edges.width()); ++x) {
      const std::uint8_t* pixel = edges.at(x, y);
      EdgeWeights w;
      if (*pixel & top_edge) {
        const auto codes = Line{pixel, 1, edges.stride(), top_edge, left_edge}.areas(table, steps);
        w.from_above = codes.below, w.to_above = codes.above;
      }
      if (*pixel & left_edge) {
        const auto codes = Line{pixel, edges.stride(), 1, left_edge, top_edge}.areas(table, steps);
        w.from_left = codes.below, w.to_left = codes.above;
      }
      if (*pixel != 0) out.set(x, w);
    }
  }
}

}  // namespace

Rgba8Image apply_mlaa(const Rgba8Image& image, const MlaaOptions& options, Rgba8Image memory) {
  if (image.empty()) return image;
  Rgba8Image out = sized_like(image, std::move(memory));
  const auto mix = [&](int x, int y, const TakenWeights& taken) {
    return mixed_pixel(image, x, y, taken, options.mixes_light);
  };
  if (options.kind == MlaaOptions::Kind::Reshetov) {
    const WeightPlane weights = mlaa_reshetov_weights(image);
    mix_by_weights(
        image, out, [&](int y, WeightRow& row) { row.assign(weights.at(0, y)); }, mix);
    return out;
  }
  const MlaaAreas table(2 * options.steps);
  const EdgePlane edges = find_edges(image, options, reach_of(options));
  mix_by_weights(
      image, out, [&](int y, WeightRow& row) { weigh(edges, table, options.steps, y, row); }, mix);
  return out;
}

namespace {

constexpr std::string_view kinds[] = {"jimenez", "reshetov"};
constexpr std::string_view mixings[] = {"light", "codes"};
constexpr int step_choices[] = {4, 8, 16, 32, 64};
constexpr Param params[] = {
    {.name = "kind",
     .meaning = "jimenez: limited length, with an area table; reshetov: the original, any length",
     .value = 0,
     .names = kinds},
    {.name = "steps",
     .meaning = "jimenez: length of the edge search, in steps of two pixels",
     .value = 16,
     .choices = step_choices},
    {.name = "mix",
     .meaning = "blending in linear light or in sRGB-encoded values (codes)",
     .value = 0,
     .names = mixings},
};

std::unique_ptr<Resolver> make(const Settings& s) {
  const MlaaOptions options{.kind = static_cast<MlaaOptions::Kind>(s.integer("kind")),
                            .steps = s.integer("steps"),
                            .mixes_light = s.chosen("mix") == "light"};
  return make_post_process(reach_of(options), options.mixes_light ? Mixing::Linear : Mixing::Encoded,
                           [options](const Rgba8Image& i) { return apply_mlaa(i, options); });
}

constexpr std::string_view variants[] = {"kind=reshetov"};

}  // namespace

Method mlaa() {
  return {.name = "mlaa",
          .summary = "borders between pixels interpreted as straight lines, pixels blended by area",
          .source = "Reshetov 2009, Jimenez 2011",
          .params = params,
          .make = make,
          .variants = variants,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
