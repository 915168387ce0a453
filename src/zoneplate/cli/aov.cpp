#include "zoneplate/cli/aov.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "zoneplate/image/png.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/random.h"

namespace zoneplate::cli {
namespace {

constexpr Rgba8 nothing{0, 0, 0, 0};

// A unit value as an integer code, rounded; what is outside is clamped.
float code(float value, float top) { return std::floor(std::clamp(value, 0.0f, 1.0f) * top + 0.5f); }
std::uint8_t code8(float value) { return static_cast<std::uint8_t>(code(value, 255)); }

// The picture of a plane, pixel by pixel; transparent where depth says that nothing is there.
template <class T, class Colour>
std::vector<std::uint8_t> data_picture(const Frame& frame, const Plane<T>& plane, bool is_srgb, Colour colour) {
  Rgba8Image image(plane.width(), plane.height(), nothing);
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x)
      if (std::isfinite(frame.depth(x, y))) image(x, y) = colour(plane(x, y));
  return encode_png(image, {.is_srgb = is_srgb});
}

std::vector<std::uint8_t> depth_picture(const Frame& frame) {
  float near = std::numeric_limits<float>::infinity(), far = -near;
  for (const float depth : frame.depth.values()) {
    if (!std::isfinite(depth)) continue;
    near = std::min(near, depth);
    far = std::max(far, depth);
  }
  PngOptions options{.has_alpha = false, .is_srgb = false};
  if (near <= far) options.text = {{"near", fmt::format("{}", near)}, {"far", fmt::format("{}", far)}};

  Plane<std::uint16_t> image(frame.depth.width(), frame.depth.height(), 65535);
  const float range = far > near ? far - near : 1.0f;
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    const float depth = frame.depth.values()[i];
    if (std::isfinite(depth)) image.values()[i] = static_cast<std::uint16_t>(code((depth - near) / range, 65534));
  }
  return encode_png(image, options);
}

std::vector<std::uint8_t> normal_picture(const Frame& frame) {
  return data_picture(frame, frame.normal, false, [](float3 n) {
    return Rgba8{code8(0.5f + 0.5f * n.x), code8(0.5f + 0.5f * n.y), code8(0.5f + 0.5f * n.z), 255};
  });
}

std::vector<std::uint8_t> albedo_picture(const Frame& frame) {
  return data_picture(frame, frame.albedo, true, [](float3 c) {
    return Rgba8{encode_srgb8(c.x), encode_srgb8(c.y), encode_srgb8(c.z), 255};
  });
}

std::vector<std::uint8_t> uv_picture(const Frame& frame) {
  return data_picture(frame, frame.uv, false, [](float2 uv) {
    return Rgba8{code8(uv.x - std::floor(uv.x)), code8(uv.y - std::floor(uv.y)), 0, 255};
  });
}

template <Plane<std::uint32_t> Frame::*ids>
std::vector<std::uint8_t> id_picture(const Frame& frame) {
  // Channels stay above 64, so that no surface is taken for the black of nothing.
  const auto channel = [](std::uint32_t word) { return static_cast<std::uint8_t>(64 + (word & 255) * 191 / 255); };
  return data_picture(frame, frame.*ids, false, [&](std::uint32_t id) {
    const std::uint32_t word = hash(id);
    return id == Frame::no_id ? nothing : Rgba8{channel(word), channel(word >> 8), channel(word >> 16), 255};
  });
}

std::vector<std::uint8_t> coverage_picture(const Frame& frame) {
  Plane<std::uint16_t> image(frame.coverage.width(), frame.coverage.height());
  for (std::size_t i = 0; i < image.values().size(); ++i)
    image.values()[i] = static_cast<std::uint16_t>(code(frame.coverage.values()[i], 65535));
  return encode_png(image, {.has_alpha = false, .is_srgb = false});
}

std::vector<std::uint8_t> error_picture(const Frame& frame) {
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

constexpr Aov all[] = {
    {"depth", "distance along the view axis, near black, far white", &Planes::depth, depth_picture},
    {"normal", "world-space normal as colour", &Planes::normal, normal_picture},
    {"albedo", "base colour without light", &Planes::albedo, albedo_picture},
    {"uv", "texture coordinates as red and green", &Planes::uv, uv_picture},
    {"object-id", "a false colour for each object", &Planes::object_id, id_picture<&Frame::object_id>},
    {"material-id", "a false colour for each material", &Planes::material_id, id_picture<&Frame::material_id>},
    {"primitive-id", "a false colour for each triangle of a mesh", &Planes::primitive_id,
     id_picture<&Frame::primitive_id>},
    {"coverage", "share of the pixel that surfaces own", &Planes::coverage, coverage_picture},
    {"error", "estimated standard error of the colour, from methods that have one", &Planes::error, error_picture}};

}  // namespace

std::span<const Aov> aovs() { return all; }

}  // namespace zoneplate::cli
