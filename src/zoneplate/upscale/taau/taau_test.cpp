// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/fit.h"
#include "zoneplate/upscale/taau/taau_core.h"
#include "zoneplate/upscale/taau/taau_frames_for_test.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

using namespace taau_frames;

TEST(Taau, OneColourStaysThatColour) {
  const LinearImage image = after<Taau>(5, [](double, double, int) { return 0.3; }, {0.3f, -1.7f});
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
  const LightAt edge = [](double x, double y, int) { return x + 0.3 * y > 24 ? 0.8 : 0.1; };
  EXPECT_LT(error(after<Taau>(256, edge)), 0.5 * error(after<Taau>(1, edge)));
}

TEST(Taau, SameBitsOnEveryInstructionSet) {
  const LightAt lines = [](double x, double y, int) { return std::sin(2 * x + 0.9 * y) > 0.6 ? 2.0 : 0.1; };
  const LinearImage expected = with_isa(Isa::Scalar, [&] { return after<Taau>(4, lines, {0.4f, -0.3f}); });
  for (const Isa isa : supported_isas())
    with_isa(isa, [&] {
      with_threads(3, [&] { EXPECT_EQ(after<Taau>(4, lines, {0.4f, -0.3f}), expected) << name_of(isa); });
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
