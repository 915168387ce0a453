// SPDX-License-Identifier: Apache-2.0
// FSR 1 against a transcription of AMD's shader, pixel by pixel and step by step.
//
// Source: AMD, FidelityFX Super Resolution 1.0, ffx_fsr1.h: FsrEasuF and FsrRcasF; ffx_a.h: the approximations.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/upscale/fsr1/fsr1.h"

namespace zoneplate::upscale {
namespace {

float low_reciprocal(float a) { return std::bit_cast<float>(0x7ef07ebbu - std::bit_cast<std::uint32_t>(a)); }
float low_reciprocal_root(float a) {
  return std::bit_cast<float>(0x5f347d74u - (std::bit_cast<std::uint32_t>(a) >> 1));
}
float medium_reciprocal(float a) {
  const float b = std::bit_cast<float>(0x7ef19fffu - std::bit_cast<std::uint32_t>(a));
  return b * (-b * a + 2);
}

/// The first pass at one pixel of the output.
class AmdEasu {
 public:
  AmdEasu(const DisplayImage& image, float2 place)
      : image_(image), x_(static_cast<int>(std::floor(place.x))), y_(static_cast<int>(std::floor(place.y))) {
    at_ = place - float2{static_cast<float>(x_), static_cast<float>(y_)};
  }

  float3 color() const {
    float2 direction{0, 0};
    float length = 0;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) add_edge(i, j, (i ? at_.x : 1 - at_.x) * (j ? at_.y : 1 - at_.y), direction, length);
    const float square = direction.x * direction.x + direction.y * direction.y;
    const bool is_flat = square < 1.0f / 32768;
    if (is_flat) direction.x = 1;
    direction = direction * (is_flat ? 1.0f : low_reciprocal_root(square));
    length = length * 0.5f * (length * 0.5f);
    const float stretch = (direction.x * direction.x + direction.y * direction.y) *
                          low_reciprocal(std::max(std::abs(direction.x), std::abs(direction.y)));
    const float2 scale{1 + (stretch - 1) * length, 1 - 0.5f * length};
    const float lobe = 0.5f + (0.25f - 0.04f - 0.5f) * length, end = low_reciprocal(lobe);

    float3 sum{0, 0, 0}, least = pixel(0, 0), most = least;
    float weights = 0;
    for (int j = -1; j < 3; ++j)
      for (int i = -1; i < 3; ++i) {
        const bool is_inner = (i == 0 || i == 1) && (j == 0 || j == 1);
        if ((i == -1 || i == 2) && (j == -1 || j == 2)) continue;
        const float3 c = pixel(i, j);
        const float2 off = float2{static_cast<float>(i), static_cast<float>(j)} - at_;
        const float u = (off.x * direction.x + off.y * direction.y) * scale.x,
                    v = (-off.x * direction.y + off.y * direction.x) * scale.y;
        const float d2 = std::min(u * u + v * v, end), base = 0.4f * d2 - 1, window = lobe * d2 - 1;
        const float weight = (25.0f / 16 * (base * base) - 9.0f / 16) * (window * window);
        sum = sum + c * weight, weights += weight;
        if (!is_inner) continue;
        least = {std::min(least.x, c.x), std::min(least.y, c.y), std::min(least.z, c.z)};
        most = {std::max(most.x, c.x), std::max(most.y, c.y), std::max(most.z, c.z)};
      }
    const float3 mean = sum * (1 / weights);
    return {std::clamp(mean.x, least.x, most.x), std::clamp(mean.y, least.y, most.y),
            std::clamp(mean.z, least.z, most.z)};
  }

 private:
  float3 pixel(int i, int j) const {
    const Display& c = image_(std::clamp(x_ + i, 0, image_.width() - 1), std::clamp(y_ + j, 0, image_.height() - 1));
    return {c.r, c.g, c.b};
  }
  float luma(int i, int j) const {
    const float3 c = pixel(i, j);
    return c.z * 0.5f + (c.x * 0.5f + c.y);
  }
  void add_edge(int i, int j, float weight, float2& direction, float& length) const {
    const float c = luma(i, j), left = luma(i - 1, j), right = luma(i + 1, j), up = luma(i, j - 1),
                down = luma(i, j + 1);
    const auto part = [&](float before, float after) {
      const float steepest = std::max(std::abs(after - c), std::abs(c - before));
      const float share = std::min(std::abs(after - before) * low_reciprocal(steepest), 1.0f);
      return share * share * weight;
    };
    direction = direction + float2{right - left, down - up} * weight;
    length += part(left, right) + part(up, down);
  }

  const DisplayImage& image_;
  int x_, y_;
  float2 at_;
};

/// The second pass at one pixel of the first one's output.
float3 amd_rcas(const DisplayImage& image, int x, int y, float sharpness) {
  const Display* const p[] = {&image(x, y - 1), &image(x - 1, y), &image(x, y + 1), &image(x + 1, y), &image(x, y)};
  constexpr float Display::*channels[] = {&Display::r, &Display::g, &Display::b};
  float lobe = -1;
  for (const auto c : channels) {
    const float least = std::min({p[0]->*c, p[1]->*c, p[2]->*c, p[3]->*c}),
                most = std::max({p[0]->*c, p[1]->*c, p[2]->*c, p[3]->*c}), own = p[4]->*c;
    const float to_black = std::min(least, own) * (1 / (4 * most)),
                to_white = (1 - std::max(most, own)) * (1 / (4 * least - 4));
    lobe = std::max(lobe, std::max(-to_black, to_white));
  }
  lobe = std::max(-(0.25f - 1.0f / 16), std::min(lobe, 0.0f)) * sharpness;
  const float scale = medium_reciprocal(4 * lobe + 1);
  const auto value = [&](float Display::*c) {
    return (lobe * (p[0]->*c) + lobe * (p[1]->*c) + lobe * (p[2]->*c) + lobe * (p[3]->*c) + p[4]->*c) * scale;
  };
  return {value(&Display::r), value(&Display::g), value(&Display::b)};
}

/// Shapes whose colours are neither black nor white, where RCAS divides by 0.
DisplayImage chart() {
  const Rgba8Image codes = antialias::random_shapes(61, 47, 7);
  DisplayImage out(61, 47);
  std::ranges::transform(codes.values(), out.values().begin(), [](Rgba8 c) {
    const auto value = [](std::uint8_t v) { return 0.02f + 0.96f * static_cast<float>(v) / 255; };
    return Display{value(c.r), value(c.g), value(c.b), 1};
  });
  return out;
}

void expect_color(const Display& found, float3 expected, int x, int y) {
  // The sums have another order here.
  ASSERT_NEAR(found.r, expected.x, 1e-5f) << x << " " << y;
  ASSERT_NEAR(found.g, expected.y, 1e-5f) << x << " " << y;
  ASSERT_NEAR(found.b, expected.z, 1e-5f) << x << " " << y;
}

TEST(Fsr1Amd, BothPassesAreThoseOfTheShader) {
  const DisplayImage image = chart();
  for (const auto& [width, height] : {std::pair(122, 94), std::pair(91, 71), std::pair(79, 61)}) {
    const UpscaleGrid grid{61, 47, 0, 0, {width, height, std::nullopt}};
    const DisplayImage easu = upscale_fsr1(image, grid, {.sharpens = false});
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const float2 place{(static_cast<float>(x) + 0.5f) * 61 / static_cast<float>(width) - 0.5f,
                           (static_cast<float>(y) + 0.5f) * 47 / static_cast<float>(height) - 0.5f};
        expect_color(easu(x, y), AmdEasu(image, place).color(), x, y);
      }
    for (const float sharpness : {1.0f, 0.87f, 0.25f}) {
      const DisplayImage sharp = upscale_fsr1(image, grid, {.rcas = {.sharpness = sharpness}});
      for (int y = 1; y + 1 < height; ++y)
        for (int x = 1; x + 1 < width; ++x) {
          const float3 c = amd_rcas(easu, x, y, sharpness);
          expect_color(sharp(x, y),
                       {std::clamp(c.x, 0.0f, 1.0f), std::clamp(c.y, 0.0f, 1.0f), std::clamp(c.z, 0.0f, 1.0f)}, x, y);
        }
    }
  }
}

}  // namespace
}  // namespace zoneplate::upscale
