// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/fit.h"
#include "zoneplate/upscale/taau/taau_core.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

constexpr int width = 40, height = 30;
using Light = std::function<float(float x, float y)>;  // of positions in frame pixels

/// A frame of a plane that moves by `motion` frame pixels a frame.
TaauInput frame_of(const Light& light, int index, float2 motion = {0, 0}) {
  static const SamplePattern halton = halton_sequence(32);
  const SamplePosition at = halton[static_cast<std::size_t>(index) % halton.size()];
  TaauInput frame{.color = LinearImage(width, height),
                  .nearness = Plane<float>(width, height, 0.5f),
                  .motion_x = Plane<float>(width, height, motion.x),
                  .motion_y = Plane<float>(width, height, motion.y),
                  .jitter = {(128 - at.x) / 256.0f, (128 - at.y) / 256.0f},
                  .is_first = index == 0};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float v = light(static_cast<float>(x) + 0.5f - frame.jitter.x - static_cast<float>(index) * motion.x,
                            static_cast<float>(y) + 0.5f - frame.jitter.y - static_cast<float>(index) * motion.y);
      frame.color(x, y) = {v, 0.5f * v, 0.25f * v, 1};
    }
  return frame;
}

LinearImage after(int frames, const Light& light, float2 motion = {0, 0}) {
  Taau taau(2 * width, 2 * height);
  LinearImage image;
  for (int i = 0; i < frames; ++i) image = taau.accumulate(frame_of(light, i, motion));
  return image;
}

TEST(Taau, OneColourStaysThatColour) {
  const LinearImage image = after(5, [](float, float) { return 0.3f; }, {0.3f, -1.7f});
  for (const Linear& c : image.values()) ASSERT_EQ(c, (Linear{0.3f, 0.15f, 0.075f, 1}));
}

// Each output row of a tilted edge has the light of the edge's place there, not that of two rows' samples.
TEST(Taau, AnEdgeGetsTheResolutionOfTheOutput) {
  const auto error = [](const LinearImage& image) {
    double sum = 0;
    for (int y = 8; y < 2 * height - 8; ++y) {
      double lit = 0;
      for (int x = 0; x < 2 * width; ++x) lit += (double{image(x, y).r} - 0.1) / 0.7;
      sum += std::abs(lit - (2 * width - 2 * (24 - 0.3 * (y + 0.5) / 2))) / (2 * height - 16);
    }
    return sum;
  };
  const Light edge = [](float x, float y) { return x + 0.3f * y > 24 ? 0.8f : 0.1f; };
  EXPECT_LT(error(after(256, edge)), 0.5 * error(after(1, edge)));
}

TEST(Taau, SameBitsOnEveryInstructionSet) {
  const Light lines = [](float x, float y) { return std::sin(2 * x + 0.9f * y) > 0.6f ? 2.0f : 0.1f; };
  const LinearImage expected = with_isa(Isa::Scalar, [&] { return after(4, lines, {0.4f, -0.3f}); });
  for (const Isa isa : supported_isas())
    with_isa(isa, [&] {
      with_threads(3, [&] { EXPECT_EQ(after(4, lines, {0.4f, -0.3f}), expected) << name_of(isa); });
    });
}

Rgba8Image still(const char* method, int frames, std::optional<Crop> crop = {}) {
  Scene scene = *make_builtin_scene("wires");
  light_unlit(scene);
  const PreparedScene prepared(std::move(scene));
  const RenderSettings settings{.options = {.width = 121, .height = 81, .crop = crop}};
  const Camera camera = prepared.scene().cameras.at(0);
  Renderer renderer(prepared, make_method(method));
  Rgba8Image image;
  for (int i = 0; i < frames; ++i) image = renderer.render(camera, settings).display;
  return image;
}

double rms(const Rgba8Image& a, const Rgba8Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    const double d = int{a.values()[i].g} - int{b.values()[i].g};
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(a.values().size()));
}

TEST(OracleTaau, BoundsTheOthers) {
  const Rgba8Image reference = still("ssaa:n=8", 1);
  const double oracle = rms(still("oracle-taau:scale=2", 24), reference);
  for (const char* method : {"taau:scale=2", "sgsr2:scale=2", "fsr2:scale=2", "fsr3:scale=2"})
    EXPECT_LT(oracle, 0.6 * rms(still(method, 24), reference)) << method;
  EXPECT_LT(rms(still("oracle-taau:scale=1.6", 24), reference), 1.1 * oracle);
}

TEST(OracleTaau, ACropHasTheBitsOfTheWholeImage) {
  for (const char* method :
       {"oracle-taau:scale=2", "oracle-taau:scale=1", "taau:scale=1.7", "sgsr2:scale=2", "fsr3:scale=1.7"}) {
    const Rgba8Image whole = still(method, 3), part = still(method, 3, Crop{30, 20, 41, 27});
    ASSERT_EQ(part.width(), 41);
    for (int y = 0; y < part.height(); ++y)
      for (int x = 0; x < part.width(); ++x) ASSERT_EQ(part(x, y), whole(30 + x, 20 + y)) << method;
  }
}

}  // namespace
}  // namespace zoneplate::upscale
