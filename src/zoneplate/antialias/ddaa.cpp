// DDAA: near the axes an edge search as FXAA's, but at every pixel; near the diagonals a short blur along the edge.
//
// Treats all angles more alike than FXAA does. Weak at diagonals of one pixel, which the blur thins.
//
// Source: Klein, Directional Diffusion Anti-Aliasing 2.4, 2025; gradients after Scharr.
#include "zoneplate/antialias/ddaa.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/bordered.h"
#include "zoneplate/antialias/codes.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

constexpr int search = 15;  ///< pixels to either side
constexpr float diffusion_step = 0.51f;
constexpr float scharr_middle = 162.0f / 256, scharr_corner = 47.0f / 256;
constexpr int reach = search + 2;

/// Sums of weighed codes in [0, 1], of which luma is the root: what a fetch between two pixels averages.
using Power = Bordered<float>;

/// The lumas around a pixel and what follows from them.
struct Around {
  float m, n, s, w, e, nw, ne, sw, se;
  Around(const float* p, std::ptrdiff_t stride)
      : m(std::sqrt(p[0])),
        n(std::sqrt(*(p - stride))),
        s(std::sqrt(p[stride])),
        w(std::sqrt(p[-1])),
        e(std::sqrt(p[1])),
        nw(std::sqrt(*(p - stride - 1))),
        ne(std::sqrt(*(p - stride + 1))),
        sw(std::sqrt(p[stride - 1])),
        se(std::sqrt(p[stride + 1])) {}

  bool is_horizontal() const {
    const float h = std::abs((nw + sw) - 2 * w) + 2 * std::abs((n + s) - 2 * m) + std::abs((ne + se) - 2 * e);
    const float v = std::abs((nw + ne) - 2 * n) + 2 * std::abs((w + e) - 2 * m) + std::abs((sw + se) - 2 * s);
    return h >= v;
  }
  /// The direction of the edge, across the gradient.
  float2 direction() const {
    const float gx = scharr_middle * (w - e) + scharr_corner * ((sw + nw) - (se + ne));
    const float gy = scharr_middle * (n - s) + scharr_corner * ((nw + ne) - (sw + se));
    return {-gy, gx};
  }
};

/// How far towards the pixel across the nearer edge the line through its ends lies.
float search_offset(const float* pixel, std::ptrdiff_t along, std::ptrdiff_t across, float here, float there) {
  const float average = (here + there) / 2, end = 0.25f * std::abs(there - here);
  struct End {
    int distance = search + 1;
    float off = 0;
  };
  const auto find_end = [&](std::ptrdiff_t step) {
    End found;
    for (int i = 1; i <= search; ++i) {
      const float *p = pixel + i * step, *q = p + across;
      const float luma = i == 1 ? (std::sqrt(*p) + std::sqrt(*q)) / 2 : std::sqrt((*p + *q) / 2);
      found.off = luma - average;
      if (std::abs(found.off) >= end) {
        found.distance = i;
        break;
      }
    }
    return found;
  };
  const End before = find_end(-along), after = find_end(along);
  const End& nearer = before.distance < after.distance ? before : after;
  if ((nearer.off < 0) == (here < average)) return 0;
  return 0.5f - static_cast<float>(nearer.distance) / static_cast<float>(before.distance + after.distance);
}

/// Where a pixel's colour comes from: the mean of two points around its own, moved.
struct Taps {
  float2 offset{0, 0}, spread{0, 0};
};

Taps taps_of(const float* pixel, std::ptrdiff_t stride, const DdaaOptions& options) {
  const Around a(pixel, stride);
  float2 direction = a.direction();
  const float length = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  float strength = std::min(1.0f, options.strength * std::sqrt(length));
  direction = strength < 1e-6f ? float2{0, 0} : float2{direction.x / length, direction.y / length};

  const bool is_horizontal = a.is_horizontal();
  const float first = (is_horizontal ? a.n : a.w) - a.m, second = (is_horizontal ? a.s : a.e) - a.m;
  // A line of one pixel is a ridge: it is not blurred.
  if ((first > 0) == (second > 0) && (first < 0) == (second < 0))
    strength *= 1 - std::min(1.0f, 10 * std::min(std::abs(first), std::abs(second)));

  const bool is_second = std::abs(second) > std::abs(first);
  const int side = is_second ? 1 : -1;
  const std::ptrdiff_t along = is_horizontal ? 1 : stride, across = side * (is_horizontal ? stride : 1);
  const float offset = search_offset(pixel, along, across, a.m, a.m + (is_second ? second : first));
  strength *= 1 - std::min(1.0f, std::abs(2 * offset));
  const float moved = offset * static_cast<float>(side), spread = diffusion_step * strength;
  return {is_horizontal ? float2{0, moved} : float2{moved, 0}, {direction.x * spread, direction.y * spread}};
}

float4 fetch(const Rgba8Image& image, int x, int y, float dx, float dy) {
  const float left = std::floor(dx), top = std::floor(dy), u = dx - left, v = dy - top;
  x += static_cast<int>(left), y += static_cast<int>(top);
  const auto at = [&](int i, int j) {
    const Rgba8 c = image(std::clamp(i, 0, image.width() - 1), std::clamp(j, 0, image.height() - 1));
    return float4{static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b), static_cast<float>(c.a)};
  };
  const float4 upper = at(x, y) * (1 - u) + at(x + 1, y) * u, lower = at(x, y + 1) * (1 - u) + at(x + 1, y + 1) * u;
  return upper * (1 - v) + lower * v;
}

bool has_contrast(const float* p, std::ptrdiff_t stride, const DdaaOptions& options) {
  // Roots keep order, so that the greatest and the least luma are those of the sums.
  const auto [low, high] = std::minmax({p[0], *(p - stride), p[stride], p[-1], p[1]});
  if (low == high) return false;
  const float greatest = std::sqrt(high), range = greatest - std::sqrt(low);
  return range >= std::max(options.least, greatest * options.threshold);
}

Power make_power(const Rgba8Image& image) {
  Power power(image.width(), image.height(), reach);
  for_rows(image.height(), [&](int y) {
    const auto row = image.row(y);
    float* out = power.at(0, y);
    for (std::size_t x = 0; x < row.size(); ++x)
      out[x] = static_cast<float>(299 * row[x].r + 587 * row[x].g + 114 * row[x].b) / 255000;
  });
  power.extend();
  return power;
}

}  // namespace

Rgba8Image apply_ddaa(const Rgba8Image& image, const DdaaOptions& options, Rgba8Image memory) {
  if (image.empty()) return image;
  const Power power = make_power(image);
  Rgba8Image out = sized_like(image, std::move(memory));
  for_rows(image.height(), [&](int y) {
    copy_row(image, out, y);
    for (int x = 0; x < image.width(); ++x) {
      const float* pixel = power.at(x, y);
      if (!has_contrast(pixel, power.stride(), options)) continue;
      const Taps taps = taps_of(pixel, power.stride(), options);
      const float4 c = (fetch(image, x, y, taps.offset.x - taps.spread.x, taps.offset.y - taps.spread.y) +
                        fetch(image, x, y, taps.offset.x + taps.spread.x, taps.offset.y + taps.spread.y)) *
                       0.5f;
      out(x, y) = {rounded_code(c.x), rounded_code(c.y), rounded_code(c.z), rounded_code(c.w)};
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
    {.name = "threshold", .meaning = "what contrast is treated", .value = 1, .names = threshold_names},
    {.name = "strength", .meaning = "of the blur along edges", .value = 3, .low = 0, .high = 9},
};

class Ddaa : public Resolver {
 public:
  explicit Ddaa(const DdaaOptions& options) : options_(options) {}
  Request ask(int) override {
    Request request;
    request.halo = reach;
    request.works_on_shown = true;
    return request;
  }
  DisplayImage finish(DisplayImage image, const Frame&) override {
    return filter_codes(std::move(image), Mixing::Codes, [&](const Rgba8Image& i) { return apply_ddaa(i, options_); });
  }

 private:
  DdaaOptions options_;
};

std::unique_ptr<Resolver> make(const Settings& s) {
  const Threshold& t = thresholds[s.integer("threshold")];
  return std::make_unique<Ddaa>(
      DdaaOptions{.threshold = t.share, .least = t.least, .strength = static_cast<float>(s.integer("strength"))});
}

}  // namespace

Method ddaa();

Method ddaa() {
  return {.name = "ddaa",
          .summary = "an edge search near the axes, a blur along edges near the diagonals",
          .source = "Klein 2025, DDAA 2.4",
          .params = params,
          .make = make,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
