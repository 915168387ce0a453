// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/exr_header.h"

#include <cmath>

#include "zoneplate/math/mat.h"
#include "zoneplate/version.h"

namespace zoneplate {
namespace {

// A matrix that multiplies row vectors has our columns as its rows.
ExrMatrix exr_matrix(const float4x4& m) {
  ExrMatrix out{};
  for (std::size_t i = 0; i < 4; ++i) {
    const float4 c = m.column[i];
    const float row[4] = {c.x, c.y, c.z, c.w};
    for (std::size_t j = 0; j < 4; ++j) out[4 * i + j] = row[j];
  }
  return out;
}

// (x, y, z) -> (x, y, -z).
constexpr float4x4 mirrored_z{{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}, {0, 0, 0, 1}}}};

// The transform of the coordinates of a file, from that of a world with this origin.
float4x4 from_file(float4x4 target_from_world, double3 origin) {
  if (origin == double3{}) return target_from_world;
  auto& c = target_from_world.column;
  const auto moved = [&](float x, float y, float z, float w) {
    return static_cast<float>(w - (x * origin.x + y * origin.y + z * origin.z));
  };
  c[3] = {moved(c[0].x, c[1].x, c[2].x, c[3].x), moved(c[0].y, c[1].y, c[2].y, c[3].y),
          moved(c[0].z, c[1].z, c[2].z, c[3].z), moved(c[0].w, c[1].w, c[2].w, c[3].w)};
  return target_from_world;
}

// From clip space to the unit square of a rectangle of the image.
float4x4 ndc_from_clip(const RenderOptions& options) {
  const Crop crop = options.crop.value_or(Crop{0, 0, options.width, options.height});
  const float w = static_cast<float>(options.width) / static_cast<float>(crop.width);
  const float h = static_cast<float>(options.height) / static_cast<float>(crop.height);
  const float x = static_cast<float>(crop.x) / static_cast<float>(crop.width);
  const float y = static_cast<float>(crop.y) / static_cast<float>(crop.height);
  return {{{{0.5f * w, 0, 0, 0}, {0, -0.5f * h, 0, 0}, {0, 0, 1, 0}, {0.5f * w - x, 0.5f * h - y, 0, 1}}}};
}

// The rate as a fraction of integers: 24000/1001 and the like for the rates of NTSC, thousandths for others that are
// not whole.
ExrRational rational(double rate) {
  if (rate == std::floor(rate)) return {static_cast<std::int32_t>(rate), 1};
  const double nominal = std::round(rate * 1.001);
  if (std::abs(rate - nominal / 1.001) < 0.001) return {static_cast<std::int32_t>(nominal) * 1000, 1001};
  return {static_cast<std::int32_t>(std::lround(rate * 1000)), 1000};
}

// Source: SMPTE ST 12-1; OpenEXR, ImfTimeCode.h.
ExrTimeCode time_code(int frame, int per_second) {
  const auto two_digits = [](int value) { return static_cast<std::uint32_t>(value / 10 * 16 + value % 10); };
  const int seconds = frame / per_second;
  return {two_digits(frame % per_second) | two_digits(seconds % 60) << 8 | two_digits(seconds / 60 % 60) << 16 |
          two_digits(seconds / 3600 % 24) << 24};
}

}  // namespace

ExrAttributes exr_header(const Job& job, const Camera& camera, double3 origin, std::optional<int> frame) {
  const float4x4 camera_from_world = inverse(camera.world_from_camera);
  const float aspect = static_cast<float>(job.options.width) / static_cast<float>(job.options.height);
  ExrAttributes out;
  out.emplace_back("software", std::string("Zoneplate ") + version);
  if (!job.display.raw) out.emplace_back("chromaticities", rec709_chromaticities);
  out.emplace_back("worldToCamera", exr_matrix(from_file(mirrored_z * camera_from_world, origin)));
  const float4x4 ndc_from_world = ndc_from_clip(job.options) * camera.clip_from_camera(aspect) * camera_from_world;
  out.emplace_back("worldToNDC", exr_matrix(from_file(ndc_from_world, origin)));
  out.emplace_back("cameraNearClip", camera.near);
  out.emplace_back("cameraFarClip", camera.far);
  if (!job.sequence.is_sequence()) return out;
  out.emplace_back("framesPerSecond", rational(job.sequence.rate));
  const double nominal = std::round(job.sequence.rate);
  if (frame && *frame >= 0 && nominal >= 1 && nominal <= 30)
    out.emplace_back("timeCode", time_code(*frame, static_cast<int>(nominal)));
  return out;
}

}  // namespace zoneplate
