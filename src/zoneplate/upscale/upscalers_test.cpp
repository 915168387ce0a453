// SPDX-License-Identifier: Apache-2.0
// What all spatial upscalers have in common.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

DisplayImage display_of(const Rgba8Image& codes) {
  DisplayImage out(codes.width(), codes.height());
  for (std::size_t i = 0; i < out.values().size(); ++i) {
    const Rgba8 c = codes.values()[i];
    const auto value = [](std::uint8_t v) { return static_cast<float>(v) / 255; };
    out.values()[i] = {value(c.r), value(c.g), value(c.b), value(c.a)};
  }
  return out;
}

/// Shapes of random colours; without `is_opaque`, of random alpha too.
DisplayImage shapes(int width, int height, bool is_opaque) {
  DisplayImage image = display_of(antialias::random_shapes(width, height, 7));
  if (!is_opaque)
    for (Display& c : image.values()) c.a = c.g < 0.2f ? 0.0f : c.b;
  return image;
}

/// Part `made` of an image upscaled to `to`, from the pixels of the image within the upscaler's radius.
DisplayImage part(const SpatialUpscaler& upscaler, const DisplayImage& image, ImageExtent to, Crop made) {
  const int radius = upscaler.radius() + 1;
  const auto range = [&](int begin, int count, int from, int to_size) {
    const double step = static_cast<double>(from) / to_size;
    const int first = static_cast<int>(std::floor((begin + 0.5) * step - 0.5)) + 1 - radius;
    const int last = static_cast<int>(std::floor((begin + count - 0.5) * step - 0.5)) + radius;
    return std::pair{std::max(0, first), std::min(from, last + 1)};
  };
  const auto [left, right] = range(made.x, made.width, image.width(), to.width);
  const auto [top, bottom] = range(made.y, made.height, image.height(), to.height);
  DisplayImage cut(right - left, bottom - top);
  for (int y = 0; y < cut.height(); ++y)
    for (int x = 0; x < cut.width(); ++x) cut(x, y) = image(left + x, top + y);
  to.crop = made;
  return upscaler.upscale(cut, {image.width(), image.height(), left, top, to});
}

TEST(Upscalers, SameBitsOnEveryInstructionSetThreadCountAndPart) {
  for (const Upscaler& row : upscalers()) {
    if (!row.make_spatial) continue;
    const std::unique_ptr<SpatialUpscaler> upscaler = make_spatial_upscaler(row.name);
    for (const bool is_opaque : {true, false}) {
      const DisplayImage image = shapes(61, 47, is_opaque);
      const ImageExtent to{103, 71, std::nullopt};
      const UpscaleGrid grid{61, 47, 0, 0, to};
      const DisplayImage expected = with_isa(Isa::Scalar, [&] { return upscaler->upscale(image, grid); });
      for (const Isa isa : supported_isas())
        with_isa(isa,
                 [&] { with_threads(3, [&] { EXPECT_EQ(upscaler->upscale(image, grid), expected) << row.name; }); });
      for (const Crop& made : {Crop{0, 0, 20, 9}, Crop{41, 30, 33, 17}, Crop{90, 60, 13, 11}, Crop{50, 0, 1, 71}}) {
        const DisplayImage out = part(*upscaler, image, to, made);
        for (int y = 0; y < made.height; ++y)
          for (int x = 0; x < made.width; ++x)
            ASSERT_EQ(out(x, y), expected(made.x + x, made.y + y)) << row.name << " " << x << " " << y;
      }
    }
  }
}

/// The published taps of nis have the sum 1 within 1e-4, the weights of AMD's RCAS within 3.2e-3.
float tolerance_of_constants(const Upscaler& row) {
  return row.name == "nis" ? 2e-4f : row.name == "fsr1" ? 3.2e-3f : 2e-6f;
}

TEST(Upscalers, ConstantsAndOpacityStay) {
  for (const Upscaler& row : upscalers()) {
    if (!row.make_spatial) continue;
    const std::unique_ptr<SpatialUpscaler> upscaler = make_spatial_upscaler(row.name);
    const float tolerance = tolerance_of_constants(row);
    for (const float alpha : {0.0f, 0.25f, 1.0f}) {
      const Display constant = alpha == 0 ? Display{0, 0, 0, 0} : Display{0.3f, 0.6f, 0.9f, alpha};
      const DisplayImage out = upscaler->upscale(DisplayImage(9, 7, constant), {9, 7, 0, 0, {18, 11, std::nullopt}});
      for (const Display& c : out.values()) {
        EXPECT_NEAR(c.r, constant.r, tolerance) << row.name;
        EXPECT_NEAR(c.g, constant.g, tolerance) << row.name;
        EXPECT_NEAR(c.b, constant.b, tolerance) << row.name;
        EXPECT_NEAR(c.a, constant.a, tolerance) << row.name;
        if (alpha == 1) {
          EXPECT_EQ(c.a, 1) << row.name;
        }
      }
    }
    const DisplayImage seen = upscaler->upscale(shapes(40, 30, true), {40, 30, 0, 0, {80, 60, std::nullopt}});
    for (const Display& c : seen.values()) {
      ASSERT_EQ(c.a, 1) << row.name;
      ASSERT_TRUE(c.r >= 0 && c.r <= 1 && c.g >= 0 && c.g <= 1 && c.b >= 0 && c.b <= 1) << row.name;
    }
  }
}

TEST(Upscalers, ColoursOfTransparentPixelsDoNotBleed) {
  // Red at alpha 1 before transparent green: no output pixel has any green.
  for (const Upscaler& row : upscalers()) {
    if (!row.make_spatial) continue;
    DisplayImage image(16, 12, Display{1, 0, 0, 1});
    for (int y = 0; y < 12; ++y)
      for (int x = 8; x < 16; ++x) image(x, y) = {0, 1, 0, 0};
    const DisplayImage out = make_spatial_upscaler(row.name)->upscale(image, {16, 12, 0, 0, {32, 24, std::nullopt}});
    for (const Display& c : out.values()) ASSERT_TRUE(c.g <= 1e-6f && c.b <= 1e-6f) << row.name;
    EXPECT_NEAR(out(4, 12).r, 1, tolerance_of_constants(row)) << row.name;
    EXPECT_EQ(out(4, 12).a, 1) << row.name;
    EXPECT_EQ(out(30, 12), (Display{0, 0, 0, 0})) << row.name;
  }
}

TEST(Upscalers, AFlatShapeHasNoRim) {
  // A disc of one colour, with a border of partial alpha, before hidden green.
  const Display color{220 / 255.0f, 30 / 255.0f, 40 / 255.0f, 1};
  DisplayImage image(48, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const float inside =
          std::clamp(18.5f - std::hypot(static_cast<float>(x) - 23.5f, static_cast<float>(y) - 23.5f), 0.0f, 1.0f);
      image(x, y) = inside > 0 ? Display{color.r, color.g, color.b, inside} : Display{0, 1, 0, 0};
    }
  for (const Upscaler& row : upscalers()) {
    if (!row.make_spatial) continue;
    const DisplayImage out = make_spatial_upscaler(row.name)->upscale(image, {48, 48, 0, 0, {96, 96, std::nullopt}});
    int partial = 0;
    for (const Display& c : out.values()) {
      if (c.a < 4 / 255.0f) continue;
      partial += c.a < 1;
      ASSERT_NEAR(c.r, color.r, 1 / 255.0f) << row.name;
      ASSERT_NEAR(c.g, color.g, 1 / 255.0f) << row.name;
      ASSERT_NEAR(c.b, color.b, 1 / 255.0f) << row.name;
    }
    EXPECT_GT(partial, 100) << row.name;
  }
}

// A shape of random colours: where it becomes transparent, no upscaler makes colours that it does not have beside.
TEST(Upscalers, ColoursOfAnOutlineAreThoseBesideIt) {
  for (const Upscaler& row : upscalers()) {
    if (!row.make_spatial) continue;
    DisplayImage image(40, 30, Display{0, 1, 0, 0});
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x) {
        const auto value = [&](std::uint32_t channel) {
          return static_cast<float>(hash(static_cast<std::uint32_t>(40 * y + x), channel) % 256) / 255;
        };
        const float inside =
            std::clamp(12.5f - std::hypot(static_cast<float>(x) - 19.5f, static_cast<float>(y) - 15.5f), 0.0f, 1.0f);
        if (inside > 0) image(x, y) = {0.4f + 0.5f * value(1), 0.25f * value(2), 0.3f, inside};
      }
    const auto upscaler = make_spatial_upscaler(row.name);
    const DisplayImage out = upscaler->upscale(image, {40, 30, 0, 0, {80, 60, std::nullopt}});
    int partial = 0;
    for (const Display& c : out.values()) {
      if (!(c.a > 0 && c.a < 1)) continue;
      ++partial;
      ASSERT_TRUE(c.r >= 0.4f && c.r <= 0.9f && c.g >= 0 && c.g <= 0.25f && c.b == 0.3f)
          << row.name << ' ' << c.r << ' ' << c.g << ' ' << c.b << ' ' << c.a;
    }
    EXPECT_GT(partial, 100) << row.name;
  }
}

std::vector<std::string> all_methods() {
  std::vector<std::string> out;
  for (const Method& row : antialias::methods()) {
    out.emplace_back(row.name);
    for (const std::string_view variant : row.variants)
      out.push_back(std::string(row.name) + ':' + std::string(variant));
  }
  for (const Upscaler& row : upscalers()) out.emplace_back(row.name);
  for (const char* text :
       {"fsr2:scale=1", "fsr3:scale=1", "fsr2:scale=4", "taa+fsr1", "smaa:mode=t2x+nis", "msaa+fsr1"})
    out.emplace_back(text);
  return out;
}

// The results of methods with history take the memory of the frame before.
TEST(Upscalers, CodesOfMethodsThatEndInLightAreThoseOfTheirLight) {
  int ends_in_light = 0;
  std::vector<std::string> texts = all_methods();
  for (const char* text : {"taau:preset=karis", "fsr3:sharpness=0.5", "learned:scale=1"}) texts.emplace_back(text);
  for (const std::string& text : texts) {
    Renderer codes(PreparedScene(*make_builtin_scene("panning-wires")), make_method(text));
    Renderer light(PreparedScene(*make_builtin_scene("panning-wires")), make_method(text));
    if (!make_method(text)->request({.image = {66, 44, std::nullopt}}).ends_in_light) continue;
    ++ends_in_light;
    const Camera camera = choose_camera(codes.scene().scene(), {.index = 0}, 1.5f);
    for (const bool is_cropped : {false, true}) {
      codes.begin_sequence(), light.begin_sequence();
      for (int i = 0; i < 3; ++i) {
        Camera moved = camera;
        moved.world_from_camera = camera.world_from_camera * translation(float3{0.01f * static_cast<float>(i), 0, 0});
        RenderSettings settings{.options = {.width = 66, .height = 44}};
        if (is_cropped) settings.options.crop = Crop{9, 5, 31, 30};
        const Rgba8Image image = codes.render(moved, settings).display;
        settings.form = ImageForm::Linear;
        EXPECT_EQ(image, quantize8(make_display(light.render(moved, settings).linear, settings.options.display)))
            << text << ' ' << i;
      }
    }
  }
  EXPECT_GT(ends_in_light, 30);
}

// Whoever asks has no frame yet: the answer is that of every frame.
TEST(Upscalers, HistoryDependsOnNoFrame) {
  int with_history = 0;
  for (const std::string& text : all_methods()) {
    const std::unique_ptr<Resolver> method = make_method(text);
    const bool has_history = method->has_history();
    with_history += has_history;
    for (const auto& [width, height] : {std::pair(64, 64), {300, 200}, {101, 43}, {1, 1}}) {
      const Request request = method->request({.image = {width, height, std::nullopt}});
      EXPECT_TRUE(width == 1 || (request.settling_frames > 1) == has_history) << text << ' ' << width;
      EXPECT_EQ(method->has_history(), has_history) << text;
    }
  }
  EXPECT_GE(with_history, 12);
  for (const char* text : {"fsr2", "fsr3", "sgsr2", "taau", "oracle-taau", "taa", "smaa:mode=t2x", "taa+fsr1"})
    EXPECT_TRUE(make_method(text)->has_history()) << text;
  for (const char* text : {"none", "smaa", "msaa", "fsr1", "converged"})
    EXPECT_FALSE(make_method(text)->has_history()) << text;
}

TEST(Upscalers, FramesHaveWholeQuotients) {
  for (const auto& [side, scale, frame] : {std::tuple(1100, 1.1, 1000),
                                           {110, 1.1, 100},
                                           {121, 1.1, 110},
                                           {1300, 1.3, 1000},
                                           {1920, 1.5, 1280},
                                           {1000, 3.0, 333},
                                           {201, 2.0, 100},
                                           {1, 4.0, 1},
                                           {32768, 1.7, 19275}}) {
    const ImageExtent found = frame_size(ImageExtent{side, side, std::nullopt}, scale);
    EXPECT_EQ(found.width, frame) << side << " / " << scale;
    EXPECT_EQ(found.height, frame) << side << " / " << scale;
    const std::string text = fmt::format("oracle-taau:scale={}", scale);
    const std::optional<ImageExtent> asked = make_method(text)->request({.image = {side, side, std::nullopt}}).frame;
    ASSERT_TRUE(asked);
    EXPECT_EQ(asked->width, frame) << text;
  }
}

TEST(Upscalers, TextsMakeMethods) {
  const auto request = [](std::string_view text) {
    return make_method(text)->request({.image = {300, 200, std::nullopt}});
  };
  const Request smaa = request("smaa+fsr1:scale=2,sharpness=0.5");
  ASSERT_TRUE(smaa.frame);
  EXPECT_EQ(smaa.frame->width, 150);
  EXPECT_EQ(smaa.frame->height, 100);
  EXPECT_EQ(smaa.footprint, 0.5f);
  EXPECT_TRUE(smaa.is_display_referred);
  EXPECT_EQ(request("ssaa:n=2+bilinear:scale=4").footprint, 0.125f);
  EXPECT_EQ(request("bicubic:kernel=mitchell").frame->width, 200);
  EXPECT_FALSE(request("smaa").frame);
  const auto refusal = [](std::string_view text) {
    try {
      make_method(text);
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::Usage);
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refusal("smaa+fsr").find("did you mean 'fsr1'"), std::string::npos);
  EXPECT_NE(refusal("fsr1:scale=5").find("1 to 4"), std::string::npos);
  EXPECT_NE(refusal("fsr1+smaa").find("fsr1"), std::string::npos);
}

}  // namespace
}  // namespace zoneplate::upscale
