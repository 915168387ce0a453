// SPDX-License-Identifier: Apache-2.0
#include "appetite_gltf.h"

#include <cstring>

#include "zoneplate/formats/gltf/maker_for_test.h"

namespace zoneplate::appetite {

using Json = Gltf::Json;

std::size_t Gltf::view(const Bytes& bytes) {
  while (binary.size() % 4 != 0) binary.push_back(0);
  const std::size_t offset = binary.size();
  binary.insert(binary.end(), bytes.begin(), bytes.end());
  return append("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
}

std::size_t Gltf::floats(const char* type, std::size_t components, const std::vector<float>& values) {
  Bytes bytes(values.size() * sizeof(float));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return append(
      "accessors",
      {{"bufferView", view(bytes)}, {"componentType", 5126}, {"count", values.size() / components}, {"type", type}});
}

std::size_t Gltf::mesh(Json attributes, const Json& more) {
  Json primitive = more;
  primitive["attributes"] = std::move(attributes);
  return append("meshes", {{"primitives", Json::array({std::move(primitive)})}});
}

std::size_t Gltf::square(Json attributes, const Json& more) {
  attributes["POSITION"] = floats("VEC3", 3, {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0});
  Json members = more;
  members["mode"] = 5;  // a strip of triangles
  return mesh(std::move(attributes), members);
}

std::size_t Gltf::add_root(Json node) {
  const std::size_t number = append("nodes", std::move(node));
  root["scenes"][0]["nodes"].push_back(number);
  return number;
}

void Gltf::place(std::size_t mesh, std::size_t translation) {
  root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  add_root({{"mesh", mesh},
            {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", translation}}}}}}}});
}

Bytes Gltf::glb() const {
  Json whole = root;
  if (!binary.empty()) whole["buffers"] = {{{"byteLength", binary.size()}}};
  return GltfMaker::glb(whole.dump(), binary);
}

}  // namespace zoneplate::appetite
