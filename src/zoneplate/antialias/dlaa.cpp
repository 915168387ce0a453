// DLAA: blur every pixel a little along the direction in which it changes less, and where long edges run, interpolate
// it anew between its neighbours by a blur of sixteen pixels along them.
//
// Needs no search and no decision, and so never jumps. Weak in that it softens all contrast, text and texture included.
//
// Source: Andreev, Anti-Aliasing from a Different Perspective, GDC 2011 (Star Wars: The Force Unleashed 2).
#include "zoneplate/antialias/dlaa.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "zoneplate/antialias/bordered.h"
#include "zoneplate/antialias/codes.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

constexpr float lambda = 3, epsilon = 0.1f;
constexpr int half_blur = 8;  ///< pixels of the long blur, to either side
constexpr int reach = half_blur + 1;
constexpr float least_unlike = 0.2f;  ///< how unlike the two directions must be for the long blur

float4 values_of(Rgba8 c) {
  return {static_cast<float>(c.r) / 255, static_cast<float>(c.g) / 255, static_cast<float>(c.b) / 255,
          static_cast<float>(c.a) / 255};
}

float luma(const float4& c) { return (c.x + c.y + c.z) / 3; }
float saturated(float v) { return v > 0 ? std::min(v, 1.0f) : 0.0f; }  // what is not a number gives 0
float4 mixed(const float4& a, const float4& b, float t) {
  return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t, a.w + (b.w - a.w) * t};
}
/// The sum of |a + b - 2 c| over the colours' codes.
int bend(Rgba8 a, Rgba8 b, Rgba8 c) {
  return std::abs(a.r + b.r - 2 * c.r) + std::abs(a.g + b.g - 2 * c.g) + std::abs(a.b + b.b - 2 * c.b);
}
/// lambda times the luma of half a bend, less epsilon; not positive up to `unseen_bend`.
float edge_of(int bend) { return lambda * (static_cast<float>(bend) / (3 * 2 * 255)) - epsilon; }
constexpr int unseen_bend = 51;

/// The picture with its border, and the first pass: four times the Laplacian's luma, as a code.
struct Source {
  Bordered<Rgba8> colors;
  Bordered<std::uint8_t> edges;

  explicit Source(const Rgba8Image& image)
      : colors(image.width(), image.height(), reach), edges(image.width(), image.height(), half_blur) {
    for_rows(image.height(), [&](int y) { std::ranges::copy(image.row(y), colors.at(0, y)); });
    colors.extend();
    const std::ptrdiff_t s = colors.stride();
    for_rows(image.height(), [&](int y) {
      for (int x = 0; x < image.width(); ++x) {
        const Rgba8* p = colors.at(x, y);
        const auto off = [&](std::uint8_t Rgba8::*c) {
          return std::abs(p[-1].*c + p[1].*c + (p - s)->*c + p[s].*c - 4 * (p->*c));
        };
        const int sum = 4 * (off(&Rgba8::r) + off(&Rgba8::g) + off(&Rgba8::b));
        *edges.at(x, y) = static_cast<std::uint8_t>(std::min(255, (sum + 1) / 3));
      }
    });
    edges.extend();
  }
  float4 at(int x, int y) const { return values_of(*colors.at(x, y)); }
};

/// Where, between two neighbours at the ends of a line through `c`, the blur along it lies; both are lumas' shares.
float4 between(const float4& first, const float4& c, const float4& last, const float4& blur) {
  const float to_first = luma(c) - luma(first), to_last = luma(c) - luma(last);
  const float a = to_first == 0 ? 1.0f : saturated((luma(blur) - luma(first)) / to_first);
  const float b = to_last == 0 ? 1.0f : saturated(1 + (luma(blur) - luma(c)) / to_last);
  return mixed(last, mixed(first, c, a), b);
}

/// The mean of the sixteen pixels around in one direction, the middle left out.
float4 long_blur(const Source& source, int x, int y, int dx, int dy) {
  int r = 0, g = 0, b = 0, a = 0;
  for (int i = -half_blur; i <= half_blur; ++i) {
    if (i == 0) continue;
    const Rgba8 c = *source.colors.at(x + i * dx, y + i * dy);
    r += c.r, g += c.g, b += c.b, a += c.a;
  }
  constexpr float scale = 255 * 2 * half_blur;
  return {static_cast<float>(r) / scale, static_cast<float>(g) / scale, static_cast<float>(b) / scale,
          static_cast<float>(a) / scale};
}

/// How much of a long edge runs through a pixel, from the sum of the sixteen edge codes around.
float mask_of(int sum) {
  constexpr int whole = 255 * 2 * half_blur;
  return 2 * sum <= whole ? 0 : static_cast<float>(2 * sum) / whole - 1;
}

Rgba8 filtered(const Source& source, int x, int y, float level_mask, float upright_mask) {
  const Rgba8* p = source.colors.at(x, y);
  const std::ptrdiff_t s = source.colors.stride();
  const int level_bend = bend(p[-1], p[1], *p), upright_bend = bend(*(p - s), p[s], *p);
  const bool has_long = std::abs(level_mask - upright_mask) > least_unlike;
  if (level_bend <= unseen_bend && upright_bend <= unseen_bend && !has_long) return *p;
  const float level = edge_of(level_bend), upright = edge_of(upright_bend);
  const float4 c = source.at(x, y), l = source.at(x - 1, y), r = source.at(x + 1, y), t = source.at(x, y - 1),
               b = source.at(x, y + 1);

  // Short edges: six pixels along the direction that changes less.
  const auto blurred = [&](const float4& two, const float4& one, const float4& next, const float4& after) {
    return (two + one + next + after + c * 2) * (1.0f / 6);
  };
  const float4 along = blurred(source.at(x - 2, y), l, r, source.at(x + 2, y));
  const float4 down = blurred(source.at(x, y - 2), t, b, source.at(x, y + 2));
  float4 out = mixed(c, along, saturated(upright / luma(along)));
  out = mixed(out, down, 0.5f * saturated(level / luma(down)));

  if (has_long) {
    out = mixed(out, between(l, c, r, long_blur(source, x, y, 0, 1)), upright_mask);
    out = mixed(out, between(t, c, b, long_blur(source, x, y, 1, 0)), level_mask);
  }
  return {rounded_code(out.x * 255), rounded_code(out.y * 255), rounded_code(out.z * 255), rounded_code(out.w * 255)};
}

}  // namespace

Rgba8Image apply_dlaa(const Rgba8Image& image, Rgba8Image memory) {
  if (image.empty()) return image;
  const Source source(image);
  Rgba8Image out = sized_like(image, std::move(memory));
  parallel_ranges(static_cast<std::size_t>(image.height()), rows_a_block, [&](std::size_t begin, std::size_t end) {
    // The sums of the edge codes of eight rows above and below move down with the rows.
    std::vector<int> columns(static_cast<std::size_t>(image.width()));
    const int first = static_cast<int>(begin);
    const auto add = [&](int y, int sign) {
      const std::uint8_t* row = source.edges.at(0, y);
      for (std::size_t x = 0; x < columns.size(); ++x) columns[x] += sign * row[x];
    };
    for (int y = first - half_blur; y <= first + half_blur; ++y) add(y, 1);
    for (int y = first; y < static_cast<int>(end); ++y) {
      const std::uint8_t* row = source.edges.at(0, y);
      int level = 0;
      for (int x = -half_blur; x <= half_blur; ++x) level += *(row + x);
      for (int x = 0; x < image.width(); ++x) {
        const int own = row[x];
        out(x, y) = filtered(source, x, y, mask_of(level - own), mask_of(columns[static_cast<std::size_t>(x)] - own));
        level += row[x + half_blur + 1] - *(row + x - half_blur);
      }
      if (y + 1 == static_cast<int>(end)) break;
      add(y - half_blur, -1);
      add(y + half_blur + 1, 1);
    }
  });
  return out;
}

namespace {

class Dlaa : public Resolver {
 public:
  Request ask(int) override {
    Request request;
    request.halo = reach;
    request.works_on_shown = true;
    return request;
  }
  DisplayImage finish(DisplayImage image, const Frame&) override {
    return filter_codes(std::move(image), Mixing::Codes, [](const Rgba8Image& i) { return apply_dlaa(i); });
  }
};

}  // namespace

Method dlaa();

Method dlaa() {
  return {.name = "dlaa",
          .summary = "short and long blurs along edges, without a search",
          .source = "Andreev 2011",
          .make = [](const Settings&) -> std::unique_ptr<Resolver> { return std::make_unique<Dlaa>(); },
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
