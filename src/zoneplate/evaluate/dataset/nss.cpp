// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/dataset/nss.h"

#include <cmath>
#include <utility>

#include "zoneplate/report/json.h"
#include "zoneplate/version.h"

namespace zoneplate {
namespace {

Json::Object vector(double x, double y) { return {{"X", x}, {"Y", y}}; }

/// A projection to reversed depth as one to depth that increases from 0 to 1.
float4x4 forward_projection(float4x4 clip_from_camera) {
  for (float4& column : clip_from_camera.column) column.z = column.w - column.z;
  return clip_from_camera;
}

Json::Object frame_json(const DatasetSequence& s, const Camera& camera, int frame) {
  const float aspect = s.aspect();
  const float2 jitter = s.jitter(frame);
  const auto x = static_cast<double>(jitter.x), y = static_cast<double>(jitter.y);
  Json::Array jitters;
  for (const double ratio : s.ratios) {
    const ImageExtent low = frame_size({s.size.x, s.size.y, std::nullopt}, ratio);
    jitters.emplace_back(vector(x / low.width, y / low.height));
  }
  const float4x4 clip = camera.clip_from_camera(aspect);
  return {{"Frame", frame},
          {"FovX", static_cast<float>(2 * std::atan(1 / static_cast<double>(clip.column[0].x)))},
          {"FovY", camera.vertical_fov},
          {"CameraNearPlane", camera.near},
          {"CameraFarPlane", std::isinf(camera.far) ? -1.0f : camera.far},
          {"ViewProjection", columns_of(forward_projection(clip) * inverse(camera.world_from_camera))},
          {"Exposure", 1.0},
          {"CameraCut", frame == 0},
          {"Jitter", vector(x, y)},
          {"NormalizedPerRatioJitter", std::move(jitters)}};
}

}  // namespace

Json::Array columns_of(const float4x4& m) {
  Json::Array out;
  for (const float4& column : m.column)
    for (const float value : {column.x, column.y, column.z, column.w}) out.emplace_back(value);
  return out;
}

std::string nss_json(const DatasetSequence& s, Shots& shots) {
  Json::Object indices;
  for (std::size_t i = 0; i < s.ratios.size(); ++i)
    indices.emplace_back(folder_of_ratio(s.ratios[i]) + "_index", static_cast<std::int64_t>(i));
  Json::Array frames;
  for (int frame = 0; frame < s.frames; ++frame) frames.emplace_back(frame_json(s, shots.camera(frame), frame));
  return Json(Json::Object{
                  {"Version", "1.0.1"},
                  {"Source", Json::Object{{"Program", std::string("Zoneplate ") + version},
                                          {"Scene", s.scene},
                                          {"Reference", s.reference},
                                          {"Seed", static_cast<std::int64_t>(s.seed)},
                                          {"Start", shots.start()},
                                          {"Bias", s.bias}}},
                  {"MotionVectorsDilated", false},
                  {"UnjitteredSrcColor_Exported", false},
                  {"OpaqueOnlyColor_Exported", false},
                  {"EmulatedFramerate", s.rate},
                  {"GTColorSpace", "Linear"},
                  {"ReverseZ", false},
                  {"TargetResolution", Json::Object{{"X", s.size.x}, {"Y", s.size.y}}},
                  {"UpscalingRatiosIndices", std::move(indices)},
                  {"Samples", Json::Object{{"Sequence", "Halton"}, {"Count", s.positions}, {"Quantized", true}}},
                  {"Frames", std::move(frames)}})
             .indented() +
         '\n';
}

}  // namespace zoneplate
