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
#include <cstring>
#include <vector>

#include "zoneplate/antialias/bordered.h"
#include "zoneplate/antialias/codes.h"
#include "zoneplate/antialias/dlaa_kernels.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/render/method.h"

namespace zoneplate {
namespace scalar {
namespace {

int bend(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c) {
  return std::abs(a[0] + b[0] - 2 * c[0]) + std::abs(a[1] + b[1] - 2 * c[1]) + std::abs(a[2] + b[2] - 2 * c[2]);
}

void edge_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, std::uint8_t* edges,
              std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    int sum = 0;
    for (std::size_t at = 4 * i; at < 4 * i + 3; ++at)
      sum += std::abs(*(here + at - 4) + here[at + 4] + above[at] + below[at] - 4 * here[at]);
    edges[i] = static_cast<std::uint8_t>(std::min(255, (4 * sum + 1) / 3));
  }
}

void sum_row(const std::uint8_t* edges, std::int16_t* sums, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    int sum = 0;
    for (std::ptrdiff_t k = -8; k <= 8; ++k) sum += *(edges + i + k);
    sums[i] = static_cast<std::int16_t>(sum);
  }
}

void slide_row(const std::uint8_t* added, const std::uint8_t* removed, std::int16_t* sums, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) sums[i] = static_cast<std::int16_t>(sums[i] + added[i] - removed[i]);
}

void seen_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, const std::int16_t* level,
              const std::int16_t* upright, int least_bend, int least_sum, std::uint8_t* seen, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint8_t* c = here + 4 * i;
    const int most = std::max(bend(c - 4, c + 4, c), bend(above + 4 * i, below + 4 * i, c));
    seen[i] = most > least_bend || std::max(level[i], upright[i]) > least_sum ? 1 : 0;
  }
}

}  // namespace

const DlaaKernels dlaa_kernels = {
    .edge_row = edge_row, .sum_row = sum_row, .slide_row = slide_row, .seen_row = seen_row};

}  // namespace scalar

namespace antialias {
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

  Source(const Rgba8Image& image, const DlaaKernels& kernels)
      : colors(image.width(), image.height(), reach), edges(image.width(), image.height(), half_blur) {
    for_rows(image.height(),
             [&](int y) { std::memcpy(colors.at(0, y), image.row(y).data(), image.row(y).size_bytes()); });
    colors.extend();
    for_rows(image.height(), [&](int y) {
      kernels.edge_row(codes(y - 1), codes(y), codes(y + 1), edges.at(0, y), static_cast<std::size_t>(image.width()));
    });
    edges.extend();
  }
  const std::uint8_t* codes(int y) const { return &colors.at(0, y)->r; }
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

constexpr int whole = 255 * 2 * half_blur;  ///< of sixteen edge codes

/// How much of a long edge runs through a pixel, from the sum of the sixteen edge codes around.
float mask_of(int sum) { return 2 * sum <= whole ? 0 : static_cast<float>(2 * sum) / whole - 1; }

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

Rgba8Image apply_dlaa(const Rgba8Image& image, Rgba8Image memory, Isa isa) {
  if (image.empty()) return image;
  const DlaaKernels& kernels = pick(isa, scalar::dlaa_kernels);
  const Source source(image, kernels);
  Rgba8Image out = sized_like(image, std::move(memory));
  const auto width = static_cast<std::size_t>(image.width()), room = (width + 63) / 64 * 64;
  parallel_ranges(static_cast<std::size_t>(image.height()), rows_a_block, [&](std::size_t begin, std::size_t end) {
    // The sums of the edge codes of eight rows above and below move down with the rows.
    std::vector<std::int16_t> level(room), upright(room);
    std::vector<std::uint8_t> seen(room), nothing(room);
    const int first = static_cast<int>(begin);
    for (int y = first - half_blur; y < first + half_blur; ++y)
      kernels.slide_row(source.edges.at(0, y), nothing.data(), upright.data(), width);
    for (int y = first; y < static_cast<int>(end); ++y) {
      const std::uint8_t* before = y == first ? nothing.data() : source.edges.at(0, y - half_blur - 1);
      kernels.slide_row(source.edges.at(0, y + half_blur), before, upright.data(), width);
      kernels.sum_row(source.edges.at(0, y), level.data(), width);
      kernels.seen_row(source.codes(y - 1), source.codes(y), source.codes(y + 1), level.data(), upright.data(),
                       unseen_bend, whole / 2, seen.data(), width);
      copy_row(image, out, y);
      for (std::size_t block = 0; block < width; block += 8) {
        std::uint64_t any = 0;
        std::memcpy(&any, &seen[block], sizeof any);
        if (any == 0) continue;
        for (std::size_t x = block; x < std::min(block + 8, width); ++x) {
          if (!seen[x]) continue;
          const int i = static_cast<int>(x), own = *source.edges.at(i, y);
          out(i, y) = filtered(source, i, y, mask_of(level[x] - own), mask_of(upright[x] - own));
        }
      }
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

}  // namespace antialias
}  // namespace zoneplate
