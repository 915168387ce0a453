// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/codec/png.h"
#include "zoneplate/formats/gltf/maker_for_test.h"

namespace zoneplate {

/// A small model that uses most features.
inline GltfMaker everything() {
  GltfMaker m;
  const std::string normalized = R"(,"normalized":true)";
  const std::string interleaved =
      m.view<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1}, 24);
  const std::string head = R"({"bufferView":)" + interleaved + R"(,"componentType":5126,"count":4,"type":"VEC3")";
  const std::string position = m.accessor(head + "}"), normal = m.accessor(head + R"(,"byteOffset":12})");
  const std::string uv0 = m.floats("VEC2", {0, 1, 1, 1, 1, 0, 0, 0});
  const std::string uv1 = m.values<std::uint8_t>("VEC2", {0, 255, 255, 255, 255, 0, 0, 0}, normalized);
  const std::string color = m.values<std::uint16_t>("VEC3", std::vector<std::uint16_t>(12, 50000), normalized);
  const std::string indices = m.values<std::uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
  const std::string places = m.view<std::uint8_t>({1, 3}), values = m.view<float>({0, 0, 1, 0, 0, 2});
  const std::string sparse =
      m.accessor(R"({"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":)" +
                 places + R"(,"componentType":5121},"values":{"bufferView":)" + values + "}}}");
  const std::string joints = m.values<std::uint8_t>("VEC4", {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
  const std::string weights = m.floats("VEC4", {0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const std::string image = m.view(encode_png(Rgba8Image(2, 2, {1, 2, 3, 4})));
  const std::string corners = R"("POSITION":)" + position + R"(,"NORMAL":)" + normal;
  m.mesh(corners + R"(,"TEXCOORD_0":)" + uv0 + R"(,"TEXCOORD_1":)" + uv1 + R"(,"COLOR_0":)" + color,
         R"(,"material":0,"mode":4,"indices":)" + indices + R"(,"targets":[{"POSITION":)" + sparse + "}]");
  m.mesh(R"("POSITION":)" + position + R"(,"JOINTS_0":)" + joints + R"(,"WEIGHTS_0":)" + weights, R"(,"mode":5)");
  m.mesh(corners, R"(,"mode":2)");
  m.nodes = R"({"mesh":0,"weights":[0.5],"translation":[1,2,3],"rotation":[0,0,0,1],"scale":[1,-1,1],"children":[1,3]},
      {"mesh":1,"skin":0},{"mesh":2,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},
      {"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}})";
  m.scene_nodes = "0,2";
  m.materials = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":
      {"offset":[0.5,0],"rotation":1,"texCoord":1}}},"metallicFactor":0.5},"normalTexture":{"index":0},
      "alphaMode":"MASK","emissiveFactor":[0,1,0]})";
  const std::string times = m.floats("SCALAR", {0, 1}), turns = m.floats("VEC4", {0, 0, 0, 1, 0, 1, 0, 0});
  const std::string moves = m.floats("VEC3", std::vector<float>(18, 1)), shares = m.floats("SCALAR", {0, 1});
  const auto channel = [](int sampler, const char* path) {
    return R"({"sampler":)" + std::to_string(sampler) + R"(,"target":{"node":0,"path":")" + path + "\"}}";
  };
  const auto sampler = [&](const std::string& output, const char* kind) {
    return R"({"input":)" + times + R"(,"output":)" + output + R"(,"interpolation":")" + kind + "\"}";
  };
  const std::string animation = R"(,"animations":[{"channels":[)" + channel(0, "rotation") + "," +
                                channel(1, "translation") + "," + channel(2, "weights") + R"(],"samplers":[)" +
                                sampler(turns, "LINEAR") + "," + sampler(moves, "CUBICSPLINE") + "," +
                                sampler(shares, "STEP") + "]}]";
  m.rest = animation + R"(,"textures":[{"source":0,"sampler":0}],"samplers":[{"minFilter":9987,"wrapS":33071}],
      "images":[{"bufferView":)" +
           image + R"(}],"skins":[{"joints":[0,3]}],
      "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1,"zfar":10}}],
      "extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":5,"spot":{"outerConeAngle":0.5}}]}})";
  return m;
}

}  // namespace zoneplate
