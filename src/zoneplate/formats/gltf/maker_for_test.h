// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace zoneplate {

/// A temporary folder for a test's files, which the destructor removes.
class TestFolder {
 public:
  TestFolder() {
    static int number = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("zoneplate_gltf_" + std::to_string(getpid()) + "_" + std::to_string(number++));
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::string path(const std::string& name) const { return (path_ / name).string(); }
  template <class Bytes>
  std::string write(const std::string& name, const Bytes& bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path(name);
  }

 private:
  std::filesystem::path path_;
};

/// Builds small glTF files: values are stored in one buffer, the rest is given as JSON text.
class GltfMaker {
 public:
  std::vector<std::uint8_t> binary;
  std::string views, accessors;          ///< elements, separated by commas
  std::string meshes, nodes, materials;  ///< elements, separated by commas; without nodes there is one for mesh 0
  std::string rest;                      ///< further members of the root, each with a comma in front
  std::string scene_nodes = "0";

  template <class T>
  static int component_type() {
    if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
    if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
    if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
    return 5126;
  }

  /// Adds a buffer view and returns its index as text.
  template <class T>
  std::string view(const std::vector<T>& values, int stride = 0) {
    while (binary.size() % 4 != 0) binary.push_back(0);
    const std::size_t at = binary.size(), size = values.size() * sizeof(T);
    binary.resize(at + size);
    std::memcpy(binary.data() + at, values.data(), size);
    return add(views,
               R"({"buffer":0,"byteOffset":)" + std::to_string(at) + R"(,"byteLength":)" + std::to_string(size) +
                   (stride ? R"(,"byteStride":)" + std::to_string(stride) : "") + "}",
               view_count_);
  }

  /// Adds an accessor given as JSON and returns its index as text.
  std::string accessor(const std::string& json) { return add(accessors, json, accessor_count_); }

  /// Adds values with their own accessor, tightly packed; `more` has further members of the accessor.
  template <class T>
  std::string values(const std::string& type, const std::vector<T>& list, const std::string& more = "") {
    const std::size_t components = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<std::size_t>(type[3] - '0');
    return accessor(R"({"bufferView":)" + view(list) + R"(,"componentType":)" + std::to_string(component_type<T>()) +
                    R"(,"count":)" + std::to_string(list.size() / components) + R"(,"type":")" + type + "\"" + more +
                    "}");
  }
  std::string floats(const std::string& type, const std::vector<float>& list) { return values<float>(type, list); }

  /// Adds a mesh of one primitive with the given attributes, `"POSITION":0,"NORMAL":1`, and further members.
  void mesh(const std::string& attributes, const std::string& more = "") {
    meshes += (meshes.empty() ? "" : ",") + (R"({"primitives":[{"attributes":{)" + attributes + "}" + more + "}]}");
  }

  /// The JSON of the file; `buffer` has the members of buffer 0 except its length.
  std::string json(const std::string& buffer = "") const {
    const auto list = [](const char* name, const std::string& items) {
      return items.empty() ? std::string() : std::string(",\"") + name + "\":[" + items + "]";
    };
    const std::string all_nodes = nodes.empty() ? R"({"mesh":0})" : nodes;
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + scene_nodes + "]}]" +
           list("nodes", all_nodes) + list("meshes", meshes) + list("materials", materials) +
           list("accessors", accessors) + list("bufferViews", views) +
           (binary.empty() ? "" : R"(,"buffers":[{"byteLength":)" + std::to_string(binary.size()) + buffer + "}]") +
           rest + "}";
  }

  std::vector<std::uint8_t> glb() const { return glb(json(), binary); }

  static std::vector<std::uint8_t> glb(std::string json, std::vector<std::uint8_t> binary) {
    while (json.size() % 4 != 0) json += ' ';
    while (binary.size() % 4 != 0) binary.push_back(0);
    std::vector<std::uint8_t> out;
    const auto add_u32 = [&](std::size_t v) {
      for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
    };
    add_u32(0x46546c67), add_u32(2), add_u32(20 + json.size() + (binary.empty() ? 0 : 8 + binary.size()));
    add_u32(json.size()), add_u32(0x4e4f534a);
    out.insert(out.end(), json.begin(), json.end());
    if (binary.empty()) return out;
    add_u32(binary.size()), add_u32(0x004e4942);
    out.insert(out.end(), binary.begin(), binary.end());
    return out;
  }

 private:
  static std::string add(std::string& list, const std::string& item, int& count) {
    list += (list.empty() ? "" : ",") + item;
    return std::to_string(count++);
  }
  int view_count_ = 0, accessor_count_ = 0;
};

/// A triangle (0,0,0) (1,0,0) (0,1,0).
inline GltfMaker triangle_maker() {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}));
  return m;
}

/// A glTF file: a white triangle that a point light of 100,000 cd makes far brighter than white.
inline std::string bright_gltf() {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
"extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 100000}]}},
"nodes": [{"mesh": 0}, {"translation": [0, 0, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
"materials": [{"pbrMetallicRoughness": {"metallicFactor": 0}}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]})";
}

}  // namespace zoneplate
