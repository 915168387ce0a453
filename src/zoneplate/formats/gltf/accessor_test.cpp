// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/accessor.h"

#include <gtest/gtest.h>

#include "zoneplate/formats/gltf/maker_for_test.h"

namespace zoneplate {
namespace {

/// Reads the last added accessor with `read(file, owner, "X")`.
template <class Read>
auto read_last(const GltfMaker& maker, const std::string& number, Read read, const LoadLimits& limits = {}) {
  const TestFolder folder;
  GltfMaker m = maker;
  m.rest += R"(,"test":{"X":)" + number + "}";
  GltfFile file(folder.write("f.glb", m.glb()), limits);
  return read(file, file.root().object("test").renamed("f.glb: mesh 3"), "X", ElementRange{});
}

template <class Read>
std::string error_of(const GltfMaker& m, const std::string& number, Read read, LoadLimits limits = {}) {
  limits.is_strict = true;
  try {
    read_last(m, number, read, limits);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Input);
    return e.what();
  }
  return "no error";
}

const auto indices = [](GltfFile& file, const JsonView& owner, const char* key, ElementRange) {
  return read_indices(file, owner, key);
};
const auto matrices = [](GltfFile& file, const JsonView& owner, const char* key, ElementRange) {
  return read_float4x4(file, owner, key);
};

TEST(GltfAccessor, FloatsTightAndInterleaved) {
  GltfMaker m;
  const std::string tight = m.floats("VEC3", {1, 2, 3, 4, 5, 6});
  const std::string view = m.view<float>({1, 2, 3, 10, 20, 4, 5, 6, 30, 40}, 20);
  const std::string head = R"({"bufferView":)" + view + R"(,"componentType":5126,"count":2,"type":)";
  const std::string first = m.accessor(head + R"("VEC3"})");
  const std::string second = m.accessor(head + R"("VEC2","byteOffset":12})");
  const std::vector<float3> wanted{{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(read_last(m, tight, read_float3), wanted);
  EXPECT_EQ(read_last(m, first, read_float3), wanted);
  EXPECT_EQ(read_last(m, second, read_float2), (std::vector<float2>{{10, 20}, {30, 40}}));
}

TEST(GltfAccessor, NormalisedIntegers) {
  const std::string normalized = R"(,"normalized":true)";
  GltfMaker m;
  const std::string u8 = m.values<std::uint8_t>("VEC2", {0, 255, 51, 128}, normalized);
  const std::string i8 = m.values<std::int8_t>("VEC2", {-128, -127, 127, 0}, normalized);
  const std::string u16 = m.values<std::uint16_t>("VEC2", {0, 65535, 13107, 32768}, normalized);
  const std::string i16 = m.values<std::int16_t>("VEC2", {-32768, -32767, 32767, 0}, normalized);
  EXPECT_EQ(read_last(m, u8, read_float2), (std::vector<float2>{{0, 1}, {0.2f, 128 / 255.0f}}));
  EXPECT_EQ(read_last(m, i8, read_float2), (std::vector<float2>{{-1, -1}, {1, 0}}));
  EXPECT_EQ(read_last(m, u16, read_float2), (std::vector<float2>{{0, 1}, {0.2f, 32768 / 65535.0f}}));
  EXPECT_EQ(read_last(m, i16, read_float2), (std::vector<float2>{{-1, -1}, {1, 0}}));
}

TEST(GltfAccessor, PlainIntegersKeepTheirValue) {
  GltfMaker m;
  EXPECT_EQ(read_last(m, m.values<std::int8_t>("VEC3", {-128, 5, 127}), read_float3)[0], (float3{-128, 5, 127}));
  EXPECT_EQ(read_last(m, m.values<std::uint16_t>("VEC4", {1, 2, 3, 65535}), read_float4)[0], (float4{1, 2, 3, 65535}));
}

TEST(GltfAccessor, ColorsOfThreeAndFour) {
  GltfMaker m;
  EXPECT_EQ(read_last(m, m.floats("VEC3", {1, 2, 3}), read_color)[0], (float4{1, 2, 3, 1}));
  EXPECT_EQ(read_last(m, m.floats("VEC4", {1, 2, 3, 0.5f}), read_color)[0], (float4{1, 2, 3, 0.5f}));
  EXPECT_EQ(read_last(m, m.values<std::uint8_t>("VEC3", {255, 0, 51}, R"(,"normalized":true)"), read_color)[0],
            (float4{1, 0, 0.2f, 1}));
}

TEST(GltfAccessor, IndicesOfEverySize) {
  const std::vector<std::uint32_t> wanted{0, 200, 3};
  GltfMaker m;
  EXPECT_EQ(read_last(m, m.values<std::uint8_t>("SCALAR", {0, 200, 3}), indices), wanted);
  EXPECT_EQ(read_last(m, m.values<std::uint16_t>("SCALAR", {0, 200, 3}), indices), wanted);
  EXPECT_EQ(read_last(m, m.values<std::uint32_t>("SCALAR", {0, 200, 3}), indices), wanted);
  EXPECT_NE(error_of(m, m.values<std::int16_t>("SCALAR", {0, 2, 3}), indices).find("5122"), std::string::npos);
  EXPECT_NE(error_of(m, m.floats("SCALAR", {0, 2, 3}), indices).find("5126"), std::string::npos);
}

TEST(GltfAccessor, SparseOverABaseAndOverNothing) {
  GltfMaker m;
  const std::string base = m.view<float>({1, 1, 2, 2, 3, 3, 4, 4});
  const std::string places = m.view<std::uint16_t>({1, 3}), values = m.view<float>({20, 21, 40, 41});
  const std::string sparse =
      R"("componentType":5126,"count":4,"type":"VEC2","sparse":{"count":2,"indices":{"bufferView":)" + places +
      R"(,"componentType":5123},"values":{"bufferView":)" + values + "}}}";
  const std::string over = m.accessor(R"({"bufferView":)" + base + "," + sparse), alone = m.accessor("{" + sparse);
  EXPECT_EQ(read_last(m, over, read_float2), (std::vector<float2>{{1, 1}, {20, 21}, {3, 3}, {40, 41}}));
  EXPECT_EQ(read_last(m, alone, read_float2), (std::vector<float2>{{0, 0}, {20, 21}, {0, 0}, {40, 41}}));

  const auto part = [](GltfFile& file, const JsonView& owner, const char* key, ElementRange) {
    return read_float2(file, owner, key, {.first = 1, .count = 2});
  };
  EXPECT_EQ(read_last(m, over, part), (std::vector<float2>{{20, 21}, {3, 3}}));
}

TEST(GltfAccessor, SparseIndices) {
  GltfMaker m;
  const std::string places = m.view<std::uint8_t>({2}), values = m.view<std::uint16_t>({700});
  const std::string number =
      m.accessor(R"({"componentType":5123,"count":3,"type":"SCALAR","sparse":{"count":1,"indices":{"bufferView":)" +
                 places + R"(,"componentType":5121},"values":{"bufferView":)" + values + "}}}");
  EXPECT_EQ(read_last(m, number, indices), (std::vector<std::uint32_t>{0, 0, 700}));
}

TEST(GltfAccessor, SparseErrors) {
  const auto error = [](const std::vector<std::uint8_t>& places, int count) {
    GltfMaker m;
    const std::string views[] = {m.view(places), m.view<float>({1, 2, 3, 4})};
    return error_of(m,
                    m.accessor(R"({"componentType":5126,"count":4,"type":"VEC2","sparse":{"count":)" +
                               std::to_string(count) + R"(,"indices":{"bufferView":)" + views[0] +
                               R"(,"componentType":5121},"values":{"bufferView":)" + views[1] + "}}}"),
                    read_float2);
  };
  EXPECT_EQ(error({1, 3}, 2), "no error");
  EXPECT_NE(error({1, 4}, 2).find("entry 1 is 4, expected growing numbers below 4"), std::string::npos);
  EXPECT_NE(error({2, 1}, 2).find("entry 1 is 1, expected growing"), std::string::npos);
  EXPECT_NE(error({1, 1}, 2).find("entry 1 is 1, expected growing"), std::string::npos);
  EXPECT_NE(error({0, 1, 2, 3, 4}, 5).find("count is 5 of 4"), std::string::npos);
  EXPECT_NE(error({0, 1, 2}, 3).find("holds 16 bytes, expected 24"), std::string::npos);
  EXPECT_NE(error({0}, 2).find("holds 1 bytes, expected 2"), std::string::npos);
}

TEST(GltfAccessor, Matrices) {
  GltfMaker m;
  std::vector<float> v;
  for (int i = 0; i < 16; ++i) v.push_back(static_cast<float>(i));
  EXPECT_EQ(read_last(m, m.floats("MAT4", v), matrices)[0].column[1], (float4{4, 5, 6, 7}));
}

TEST(GltfAccessor, ElementsMustFit) {
  GltfMaker m;
  const std::string view = m.view<float>({1, 2, 3}), wide = m.view<float>({1, 2, 3, 4, 5, 6}, 12);
  const auto error = [&](const std::string& members) {
    GltfMaker copy = m;
    return error_of(copy, copy.accessor(R"({"componentType":5126,"type":"VEC3",)" + members + "}"), read_float3);
  };
  const auto at = [](const std::string& v) { return R"("bufferView":)" + v; };
  EXPECT_EQ(error(at(view) + R"(,"count":1)"), "no error");
  EXPECT_EQ(error(at(view) + R"(,"count":3)"),
            "f.glb: mesh 3: X (accessor 0): it holds 12 bytes, expected 36 (3 elements)");
  EXPECT_EQ(error(at(view) + R"(,"count":1,"byteOffset":4)"),
            "f.glb: mesh 3: X (accessor 0): it holds 8 bytes, expected 12 (1 elements)");
  EXPECT_NE(error(at(view) + R"(,"count":1,"byteOffset":9007199254740992)"), "no error");
  EXPECT_NE(error(at(view) + R"(,"count":9007199254740992)"), "no error");
  EXPECT_EQ(error(at(wide) + R"(,"count":2)"), "no error");
  EXPECT_NE(error(at(wide) + R"(,"count":2,"byteOffset":4)"), "no error");
  EXPECT_NE(error(at("7") + R"(,"count":1)").find("bufferView is 7, expected an index below 2"), std::string::npos);
  EXPECT_NE(error(at(view) + R"(,"count":-1)"), "no error");
  EXPECT_NE(error(at(view)).find("count is missing"), std::string::npos);
}

TEST(GltfAccessor, TypesMustBeThoseWanted) {
  GltfMaker m;
  const std::string vec2 = m.floats("VEC2", {1, 2});
  EXPECT_EQ(error_of(m, vec2, read_float3), "f.glb: mesh 3: X (accessor 0): type is VEC2, expected VEC3");
  EXPECT_NE(error_of(m, vec2, indices).find("expected SCALAR"), std::string::npos);
  EXPECT_NE(error_of(m, "9", read_float2).find("X is 9, expected an index below 1"), std::string::npos);
  EXPECT_NE(error_of(m, m.values<std::uint32_t>("VEC2", {1, 2}), read_float2).find("5125"), std::string::npos);
  for (const char* type : {"VEC5", "", "scalar"})
    EXPECT_NE(
        error_of(m, m.accessor(R"({"componentType":5126,"count":1,"type":")" + std::string(type) + "\"}"), read_float2)
            .find("expected SCALAR, VEC2"),
        std::string::npos);
  for (const char* number : {"5119", "5124", "5127", "0"})
    EXPECT_NE(error_of(m, m.accessor(R"({"componentType":)" + std::string(number) + R"(,"count":1,"type":"VEC2"})"),
                       read_float2)
                  .find("componentType is " + std::string(number)),
              std::string::npos);
}

TEST(GltfAccessor, StridesMustHoldAnElement) {
  for (const int stride : {1, 3, 8, 253}) {
    GltfMaker m;
    const std::string view = m.view<float>({1, 2, 3}, stride);
    const std::string e = error_of(
        m, m.accessor(R"({"bufferView":)" + view + R"(,"componentType":5126,"count":1,"type":"VEC3"})"), read_float3);
    EXPECT_NE(e.find("byteStride is " + std::to_string(stride)), std::string::npos) << e;
  }
}

TEST(GltfAccessor, MemoryIsCountedBeforeItIsTaken) {
  GltfMaker m;
  const std::string huge = m.accessor(R"({"componentType":5126,"count":9007199254740992,"type":"VEC4"})");
  EXPECT_NE(error_of(m, huge, read_float4).find("has no bufferView for 9007199254740992 elements"), std::string::npos);
  const std::string some = m.accessor(R"({"componentType":5126,"count":10000,"type":"VEC4"})");
  EXPECT_EQ(read_last(m, some, read_float4, {.memory = 200000}).size(), 10000u);
  EXPECT_NE(error_of(m, some, read_float4, {.memory = 100000}).find("--max-memory"), std::string::npos);
}

TEST(GltfAccessor, BufferViewsMustLieInTheirBuffer) {
  const auto error = [](const std::string& view) {
    GltfMaker m;
    m.binary.resize(64);
    m.views = view;
    return error_of(m, m.accessor(R"({"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"})"), read_float3);
  };
  EXPECT_EQ(error(R"({"buffer":0,"byteOffset":52,"byteLength":12})"), "no error");
  EXPECT_NE(error(R"({"buffer":0,"byteOffset":53,"byteLength":12})").find("bufferView 0: ends at byte 65"),
            std::string::npos);
  EXPECT_NE(error(R"({"buffer":0,"byteOffset":9007199254740992,"byteLength":9007199254740992})"), "no error");
  EXPECT_NE(error(R"({"buffer":1,"byteLength":12})").find("buffer is 1, expected an index below 1"), std::string::npos);
  EXPECT_NE(error(R"({"buffer":0})").find("byteLength is missing"), std::string::npos);
}

}  // namespace
}  // namespace zoneplate
