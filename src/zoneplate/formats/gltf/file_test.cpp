// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/file.h"

#include <gtest/gtest.h>

#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/maker_for_test.h"

namespace zoneplate {
namespace {

std::string error_of(const std::string& path, LoadLimits limits = {}) {
  limits.is_strict = true;
  try {
    load_gltf(path, limits);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Input);
    EXPECT_EQ(std::string(e.what()).rfind(path, 0), 0u) << e.what();
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    return e.what();
  }
  return "no error";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A copy of the bytes with the 32-bit number at `at` replaced.
std::vector<std::uint8_t> with_u32(std::vector<std::uint8_t> bytes, std::size_t at, std::uint32_t v) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(v >> (8 * i));
  return bytes;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t v = 0;
    for (std::size_t k = 0; k < 3; ++k) v = v << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[v >> (18 - 6 * k) & 63];
  }
  return out;
}

void expect_triangle(const Scene& s) {
  ASSERT_EQ(s.meshes.size(), 1u);
  EXPECT_EQ(s.meshes[0].position, (std::vector<float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(GltfFile, BuffersFromTheBinaryChunkAFileAndTheText) {
  const TestFolder folder;
  const GltfMaker m = triangle_maker();
  expect_triangle(load_gltf(folder.write("a.glb", m.glb())));

  folder.write("sub dir/\xe2\x9d\xa4.bin", m.binary);
  expect_triangle(load_gltf(folder.write("b.gltf", m.json(R"(,"uri":"sub%20dir/%E2%9D%A4.bin")"))));
  expect_triangle(load_gltf(folder.write("b2.gltf", m.json(",\"uri\":\"sub dir/\xe2\x9d\xa4.bin\""))));
  expect_triangle(load_gltf(
      folder.write("c.gltf", m.json(R"(,"uri":"data:application/octet-stream;base64,)" + base64(m.binary) + "\""))));

  std::string percent;
  for (const std::uint8_t b : m.binary) {
    const char* digits = "0123456789abcdef";
    percent += {'%', digits[b >> 4], digits[b & 15]};
  }
  expect_triangle(load_gltf(folder.write("d.gltf", m.json(R"(,"uri":"data:,)" + percent + "\""))));
}

TEST(GltfFile, BufferErrors) {
  const TestFolder folder;
  const GltfMaker m = triangle_maker();
  const auto error = [&](const std::string& uri) {
    return error_of(folder.write("m/f.gltf", m.json(",\"uri\":\"" + uri + "\"")));
  };
  folder.write("out.bin", m.binary);
  folder.write("m/short.bin", std::string(35, 'x'));
  EXPECT_TRUE(has(error("none.bin"), "buffer 0: ")) << error("none.bin");
  EXPECT_TRUE(has(error("short.bin"), "buffer 0: holds 35 bytes, expected 36"));
  EXPECT_TRUE(has(error("../out.bin"), "--allow-path"));
  EXPECT_TRUE(has(error("http://localhost/x.bin"), "expected a relative path or a data: URI"));
  EXPECT_TRUE(has(error("file:///etc/passwd"), "expected a relative path or a data: URI"));
  EXPECT_TRUE(has(error("data:application/octet-stream;base64"), "no comma"));
  EXPECT_TRUE(has(error("data:application/octet-stream;base64,*"), "not base64"));
  EXPECT_TRUE(has(error("data:;base64,AAAA"), "holds 3 bytes, expected 36"));
  EXPECT_TRUE(has(error("."), "leads out of"));
  EXPECT_TRUE(has(error_of(folder.write("m/g.gltf", m.json())), "uri is missing"));
  expect_triangle(load_gltf(folder.write("m/f.gltf", m.json(R"(,"uri":"../out.bin")")), {.allowed_paths = {"/"}}));
}

TEST(GltfFile, ChunksAreChecked) {
  const TestFolder folder;
  const std::vector<std::uint8_t> good = triangle_maker().glb();
  const auto error = [&](std::vector<std::uint8_t> bytes) { return error_of(folder.write("f.glb", bytes)); };
  EXPECT_EQ(error(good), "no error");
  EXPECT_TRUE(has(error(with_u32(good, 4, 1)), "GLB version 1, expected 2"));
  EXPECT_TRUE(has(error(with_u32(good, 8, 0x7fffffff)), "GLB header states 2147483647 bytes"));
  EXPECT_TRUE(has(error(with_u32(good, 12, 0xfffffff0)), "GLB chunk at byte 12"));
  EXPECT_TRUE(has(error(with_u32(good, 16, 5)), "the first GLB chunk is not JSON"));
  EXPECT_TRUE(has(error(with_u32(good, 8, 12)), "without a JSON chunk"));
  EXPECT_TRUE(has(error({'g', 'l', 'T', 'F', 2, 0, 0, 0}), "GLB of 8 bytes"));
  EXPECT_TRUE(has(error({}), "not JSON"));
  for (std::size_t n = 0; n < good.size(); n += n < 32 ? 4 : 41)
    EXPECT_NE(error({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n)}), "no error") << n;
}

TEST(GltfFile, UnknownChunksAndTrailingBytesArePassedOver) {
  const TestFolder folder;
  std::vector<std::uint8_t> bytes = triangle_maker().glb();
  for (const int b : {4, 0, 0, 0, int{'X'}, int{'X'}, int{'X'}, int{'X'}, 1, 2, 3, 4})
    bytes.push_back(static_cast<std::uint8_t>(b));
  const auto size = static_cast<std::uint32_t>(bytes.size());
  expect_triangle(load_gltf(folder.write("f.glb", with_u32(bytes, 8, size))));
  bytes.push_back(0);
  const Scene s = load_gltf(folder.write("f.glb", with_u32(bytes, 8, size)));
  expect_triangle(s);
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_TRUE(has(s.warnings[0], "bytes after the end"));
}

TEST(GltfFile, AnEmptyBinaryChunkHoldsNothing) {
  const TestFolder folder;
  const GltfMaker m = triangle_maker();
  std::vector<std::uint8_t> bytes = GltfMaker::glb(m.json(), {});
  for (const int b : {0, 0, 0, 0, int{'B'}, int{'I'}, int{'N'}, 0}) bytes.push_back(static_cast<std::uint8_t>(b));
  bytes = with_u32(bytes, 8, static_cast<std::uint32_t>(bytes.size()));
  EXPECT_TRUE(has(error_of(folder.write("f.glb", bytes)), "buffer 0: holds 0 bytes, expected 36"));
}

TEST(GltfFile, VersionMustBeTwo) {
  const TestFolder folder;
  const auto error = [&](const std::string& json) { return error_of(folder.write("f.gltf", json)); };
  EXPECT_EQ(error(R"({"asset":{"version":"2.0"}})"), "no error");
  EXPECT_EQ(error(R"({"asset":{"version":"2.1"}})"), "no error");
  EXPECT_TRUE(has(error(R"({"asset":{"version":"1.0"}})"), "asset: version is '1.0', expected 2.0"));
  EXPECT_TRUE(has(error(R"({"asset":{"version":2}})"), "asset: version is a number, expected a string"));
  const auto is_first = [&](const std::string& text, bool is_strict) {
    try {
      load_gltf(folder.write("f.gltf", text), {.is_strict = is_strict});
    } catch (const Gltf1Error&) {
      return true;
    } catch (const Error&) {
    }
    return false;
  };
  for (const bool is_strict : {false, true}) {
    for (const char* text :
         {R"({"asset":{"version":"1.0"}})", R"({"n":"asset","asset" : {"generator":"g", "version" : 1.0}})",
          R"({"asset":{"profile":{"api":"WebGL"},"version":"1.0.1"}})"})
      EXPECT_TRUE(is_first(text, is_strict)) << text;
    for (const char* text :
         {R"({"asset":{"version":"2.1"}})", R"({"asset":{},"version":"1.0"})", R"({"asset":)", "\"asset\"",
          R"({"nodes":[{"name":"asset"}],"asset":{"version":"2.0","minVersion":"1.0"}})", "",
          R"({"asset":{"extras":{"version":"1.3"},"version":"2.0"}})",
          R"({"extras":{"asset":{"version":"1.0"}},"asset":{"version":"2.0"}})", R"({"asset":{"version":1)"})
      EXPECT_FALSE(is_first(text, is_strict)) << text;
  }
  EXPECT_TRUE(has(error(R"({"asset":{"version":"2.1","minVersion":"2.1"}})"), "minVersion is '2.1'"));
  EXPECT_TRUE(has(error(R"({"asset":{}})"), "version is missing"));
  EXPECT_TRUE(has(error(R"({})"), "version is missing"));
  EXPECT_TRUE(has(error(R"([])"), "is an array, expected an object"));
  EXPECT_TRUE(has(error(R"({"asset":[]})"), "asset is an array, expected an object"));
}

TEST(GltfFile, TimeIsLimited) {
  const TestFolder folder;
  EXPECT_TRUE(has(error_of(folder.write("f.glb", triangle_maker().glb()), {.seconds = 0}), "takes longer"));
}

}  // namespace
}  // namespace zoneplate
