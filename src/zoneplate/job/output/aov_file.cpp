// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/output/aov_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/job/output/false_color.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"
#include "zoneplate/render/cryptomatte.h"

namespace zoneplate {
namespace {

constexpr Rgba8 nothing{0, 0, 0, 0};
const PngOptions data{.is_srgb = false};

// Quantizes a value in [0, 1] to an integer code, rounded; values outside are clamped, and NaN gives 0.
float code(float value, float top) {
  const float unit = value > 0 ? std::min(value, 1.0f) : 0.0f;
  return std::floor(unit * top + 0.5f);
}
std::uint8_t code8(float value) { return static_cast<std::uint8_t>(code(value, 255)); }

// The image of a plane, pixel by pixel; transparent where the depth is infinite.
template <class T, class Colour>
std::vector<std::uint8_t> data_picture(const Frame& frame, const Plane<T>& plane, const PngOptions& options,
                                       Colour colour) {
  Rgba8Image image(plane.width(), plane.height(), nothing);
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x)
      if (std::isfinite(frame.depth(x, y))) image(x, y) = colour(plane(x, y));
  return encode_png(image, options);
}

std::vector<std::uint8_t> depth_picture(const Frame& frame, const Scene&) {
  const auto [image, near, far] = depth_codes(frame.depth);
  PngOptions options{.has_alpha = false, .is_srgb = false};
  if (near <= far) options.text = {{"near", fmt::format("{}", near)}, {"far", fmt::format("{}", far)}};
  return encode_png(image, options);
}

std::vector<std::uint8_t> normal_picture(const Frame& frame, const Scene&) {
  return data_picture(frame, frame.normal, data, [](float3 n) {
    return Rgba8{code8(0.5f + 0.5f * n.x), code8(0.5f + 0.5f * n.y), code8(0.5f + 0.5f * n.z), 255};
  });
}

std::vector<std::uint8_t> albedo_picture(const Frame& frame, const Scene&) {
  return data_picture(frame, frame.albedo, {}, [](float3 c) {
    return Rgba8{encode_srgb8(c.x), encode_srgb8(c.y), encode_srgb8(c.z), 255};
  });
}

// Over black, so that the passes of an image add up in linear light.
template <std::size_t component>
std::vector<std::uint8_t> light_picture(const Frame& frame, const Scene&) {
  const Plane<float3>& plane = frame.light[component];
  Rgba8Image image(plane.width(), plane.height());
  std::ranges::transform(plane.values(), image.values().begin(), [](float3 c) {
    return Rgba8{encode_srgb8(c.x), encode_srgb8(c.y), encode_srgb8(c.z), 255};
  });
  return encode_png(image, {.has_alpha = false});
}

std::vector<std::uint8_t> uv_picture(const Frame& frame, const Scene&) {
  return data_picture(frame, frame.uv, data, [](float2 uv) {
    return Rgba8{code8(uv.x - std::floor(uv.x)), code8(uv.y - std::floor(uv.y)), 0, 255};
  });
}

// Channels are at least 64, so that no surface has the black of empty pixels.
Rgba8 id_color(std::uint32_t id) {
  const auto channel = [](std::uint32_t word) { return static_cast<std::uint8_t>(64 + (word & 255) * 191 / 255); };
  const std::uint32_t word = hash(id);
  return {channel(word), channel(word >> 8), channel(word >> 16), 255};
}

template <Plane<std::uint32_t> Frame::*ids>
std::vector<std::uint8_t> id_picture(const Frame& frame, const Scene&) {
  return data_picture(frame, frame.*ids, data,
                      [&](std::uint32_t id) { return id == Frame::no_id ? nothing : id_color(id); });
}

// The colour of an id is a hash of the name, and therefore the same in all images of all scenes.
template <MatteKind kind>
std::vector<std::uint8_t> matte_picture(const Frame& frame, const Scene& scene) {
  const Cryptomatte matte = make_cryptomatte(frame, scene, kind);
  const Plane<float4>& first = matte.ranks.front();
  Rgba8Image image(first.width(), first.height(), nothing);
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    float4 sum{0, 0, 0, 0};
    const auto add = [&](float id, float share) {
      const Rgba8 c = id_color(std::bit_cast<std::uint32_t>(id));
      sum = sum + float4{decode_srgb8(c.r), decode_srgb8(c.g), decode_srgb8(c.b), 1} * share;
    };
    for (const Plane<float4>& plane : matte.ranks) {
      const float4 pair = plane.values()[i];
      add(pair.x, pair.y);
      add(pair.z, pair.w);
    }
    if (sum.w > 0)
      image.values()[i] = {encode_srgb8(sum.x / sum.w), encode_srgb8(sum.y / sum.w), encode_srgb8(sum.z / sum.w),
                           code8(sum.w)};
  }
  return encode_png(image);
}

std::vector<std::uint8_t> position_picture(const Frame& frame, const Scene& scene) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  float3 least{infinity, infinity, infinity}, greatest = -least;
  for (std::size_t i = 0; i < frame.position.values().size(); ++i) {
    if (!std::isfinite(frame.depth.values()[i])) continue;
    const float3 p = frame.position.values()[i];
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    greatest = {std::max(greatest.x, p.x), std::max(greatest.y, p.y), std::max(greatest.z, p.z)};
  }
  PngOptions options{.is_srgb = false};
  const auto text = [&](float3 p) {
    if (scene.origin == double3{}) return fmt::format("{} {} {}", p.x, p.y, p.z);
    const double3 q = scene.in_file(p);
    return fmt::format("{:.10g} {:.10g} {:.10g}", q.x, q.y, q.z);
  };
  if (least.x <= greatest.x) options.text = {{"least", text(least)}, {"greatest", text(greatest)}};
  const auto part = [](float value, float low, float high) {
    return code8(high > low ? (value - low) / (high - low) : 0.5f);
  };
  return data_picture(frame, frame.position, options, [&](float3 p) {
    return Rgba8{part(p.x, least.x, greatest.x), part(p.y, least.y, greatest.y), part(p.z, least.z, greatest.z), 255};
  });
}

template <Plane<float2> Frame::*steps>
std::vector<std::uint8_t> motion_picture(const Frame& frame, const Scene&) {
  constexpr float two_pi = 6.2831853f;
  float greatest = 0;
  for (const float2 m : (frame.*steps).values())
    if (std::isfinite(length(m))) greatest = std::max(greatest, length(m));
  const float scale = greatest > 0 ? 1 / greatest : 0.0f;
  const PngOptions options{.is_srgb = false, .text = {{"greatest", fmt::format("{}", greatest)}}};
  return data_picture(frame, frame.*steps, options,
                      [&](float2 m) { return circle_color(atan2(m.y, m.x) / two_pi, length(m) * scale); });
}

std::vector<std::uint8_t> mip_level_picture(const Frame& frame, const Scene&) {
  return data_picture(frame, frame.mip_level, data, mip_level_color);
}

std::vector<std::uint8_t> anisotropy_picture(const Frame& frame, const Scene&) {
  return data_picture(frame, frame.anisotropy, data, anisotropy_color);
}

std::vector<std::uint8_t> coverage_picture(const Frame& frame, const Scene&) {
  Plane<std::uint16_t> image(frame.coverage.width(), frame.coverage.height());
  for (std::size_t i = 0; i < image.values().size(); ++i)
    image.values()[i] = static_cast<std::uint16_t>(code(frame.coverage.values()[i], 65535));
  return encode_png(image, {.has_alpha = false, .is_srgb = false});
}

std::vector<std::uint8_t> error_picture(const Frame& frame, const Scene&) {
  float greatest = 0;
  double squares = 0;
  for (const float e : frame.error.values()) greatest = std::max(greatest, e), squares += static_cast<double>(e) * e;
  const double rms = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, frame.error.values().size())));
  Plane<std::uint16_t> image(frame.error.width(), frame.error.height());
  for (std::size_t i = 0; i < image.values().size() && greatest > 0; ++i)
    image.values()[i] = static_cast<std::uint16_t>(code(frame.error.values()[i] / greatest, 65535));
  return encode_png(image, {.has_alpha = false,
                            .is_srgb = false,
                            .text = {{"greatest", fmt::format("{}", greatest)}, {"rms", fmt::format("{}", rms)}}});
}

struct Encoder {
  std::string_view name;
  std::vector<std::uint8_t> (*encode)(const Frame&, const Scene&);
};

constexpr Encoder encoders[] = {{"depth", depth_picture},
                                {"normal", normal_picture},
                                {"position", position_picture},
                                {"albedo", albedo_picture},
                                {"uv", uv_picture},
                                {"motion", motion_picture<&Frame::motion>},
                                {"flow", motion_picture<&Frame::flow>},
                                {"object-id", id_picture<&Frame::object_id>},
                                {"material-id", id_picture<&Frame::material_id>},
                                {"primitive-id", id_picture<&Frame::primitive_id>},
                                {"crypto-object", matte_picture<MatteKind::Object>},
                                {"crypto-material", matte_picture<MatteKind::Material>},
                                {"mip-level", mip_level_picture},
                                {"anisotropy", anisotropy_picture},
                                {"diffuse", light_picture<0>},
                                {"specular", light_picture<1>},
                                {"transmission", light_picture<2>},
                                {"emission", light_picture<3>},
                                {"coverage", coverage_picture},
                                {"error", error_picture}};

}  // namespace

std::vector<std::uint8_t> encode_data_png(const Aov& aov, const Frame& frame, const Scene& scene) {
  return std::ranges::find(encoders, aov.name, &Encoder::name)->encode(frame, scene);
}

void add_exr_channels(const DataChannels& channels, std::vector<ExrChannel>& out) {
  for (const DataChannel& c : channels.list) {
    const ExrType type = c.precision == ChannelPrecision::Number ? ExrType::Number
                         : c.precision == ChannelPrecision::Half ? ExrType::Half
                                                                 : ExrType::Float;
    out.push_back({c.name, type, c.value, c.number, c.step});
  }
}

std::optional<std::vector<std::uint8_t>> encode_data_pfm(const Aov& aov, const Frame& frame, const Scene& scene) {
  DataChannels channels;
  aov.add_channels(frame, scene, channels);
  if (channels.list.size() > 3) return std::nullopt;
  const auto value = [&](std::size_t channel, std::size_t pixel) {
    const DataChannel& c = channels.list[channel];
    return c.value ? c.value[pixel * c.step] : static_cast<float>(c.number[pixel * c.step]);
  };
  const int width = frame.depth.width(), height = frame.depth.height();
  if (channels.list.size() == 1) {
    Plane<float> grey(width, height);
    for (std::size_t i = 0; i < grey.values().size(); ++i) grey.values()[i] = value(0, i);
    return encode_pfm(grey);
  }
  LinearImage color(width, height);
  for (std::size_t i = 0; i < color.values().size(); ++i)
    color.values()[i] = {value(0, i), value(1, i), channels.list.size() > 2 ? value(2, i) : 0.0f, 1};
  return encode_pfm(color);
}

}  // namespace zoneplate
