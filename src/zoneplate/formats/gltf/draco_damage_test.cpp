// SPDX-License-Identifier: Apache-2.0
// Damaged Draco meshes: decoding any bytes gives a mesh or an error message of one line, within the limits.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/formats/gltf/draco.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int cells = 12;  // cells per side of a bent sheet

struct Packed {
  Bytes bytes;
  std::uint64_t indices = 0;
  std::uint32_t points = 0, position = 0;
};

Packed packed_sheet(int speed, draco::MeshEncoderMethod method) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2 * cells * cells);
  const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const auto corner = [](int x, int y) {
    return std::array<float, 3>{static_cast<float>(x), static_cast<float>(y), 0.1f * static_cast<float>(x * y)};
  };
  int face = 0;
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x)
      for (const bool is_upper : {false, true}) {
        const auto a = corner(x, y), b = is_upper ? corner(x + 1, y + 1) : corner(x + 1, y),
                   c = is_upper ? corner(x, y + 1) : corner(x + 1, y + 1);
        builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(static_cast<std::uint32_t>(face++)), a.data(),
                                          b.data(), c.data());
      }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetSpeedOptions(speed, speed);
  encoder.SetEncodingMethod(method);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  Packed out;
  out.bytes.assign(buffer.data(), buffer.data() + buffer.size());
  out.indices = 6 * cells * cells;
  out.points = mesh->num_points();
  out.position = mesh->GetNamedAttribute(draco::GeometryAttribute::POSITION)->unique_id();
  return out;
}

DracoMesh decode(const Packed& sheet, const Bytes& bytes) {
  ImportBudget budget("a.glb", {.memory = 1 << 26, .seconds = 3});
  const DracoWish wish{.attribute = sheet.position, .count = sheet.points};
  return decode_draco(bytes, sheet.indices, std::span(&wish, 1), "a.glb: mesh 0", budget);
}

// True if the bytes give a mesh; an error must be one line that names the file.
bool is_mesh(const Packed& sheet, const Bytes& bytes) {
  const Stopwatch watch;
  bool is_good = false;
  try {
    const DracoMesh mesh = decode(sheet, bytes);
    EXPECT_EQ(mesh.indices.size(), sheet.indices * 4);
    EXPECT_EQ(mesh.attributes.at(0).size(), sheet.points * std::size_t{12});
    is_good = true;
  } catch (const Error& error) {
    const std::string line = error.what();
    EXPECT_EQ(error.kind(), ErrorKind::Input) << line;
    EXPECT_EQ(line.find("a.glb"), 0u) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
  EXPECT_LT(watch.ms(), 5000);
  return is_good;
}

class DracoDamage : public testing::TestWithParam<draco::MeshEncoderMethod> {};

TEST_P(DracoDamage, TheSoundMeshIsRead) {
  const Packed sheet = packed_sheet(5, GetParam());
  const DracoMesh mesh = decode(sheet, sheet.bytes);
  // The farthest corner is preserved, except for quantization to 14 bits.
  float farthest = 0;
  for (std::size_t i = 0; i < sheet.points; ++i) {
    float p[3];
    std::memcpy(p, &mesh.attributes[0][12 * i], sizeof p);
    farthest = std::max(farthest, p[2]);
  }
  EXPECT_NEAR(farthest, 0.1f * cells * cells, 0.01f);
}

TEST_P(DracoDamage, CutOffAnywhere) {
  const Packed sheet = packed_sheet(5, GetParam());
  int meshes = 0;
  const std::size_t step = std::max<std::size_t>(1, sheet.bytes.size() / 60);
  for (std::size_t n = 0; n < sheet.bytes.size(); n += step)
    meshes += is_mesh(sheet, Bytes(sheet.bytes.begin(), sheet.bytes.begin() + static_cast<std::ptrdiff_t>(n)));
  EXPECT_LT(meshes, 5);  // the last bytes may be padding
}

TEST_P(DracoDamage, FlippedBits) {
  const Packed sheet = packed_sheet(3, GetParam());
  int refused = 0;
  for (std::uint32_t i = 0; i < 150; ++i) {
    Bytes bad = sheet.bytes;
    // Half of them modify the header, which contains counts and methods.
    const std::size_t reach = i % 2 ? bad.size() : std::min<std::size_t>(bad.size(), 64);
    for (std::uint32_t k = 0; k <= i % 3; ++k)
      bad[hash(i, k) % reach] ^= static_cast<std::uint8_t>(1u << hash(i, k, 1) % 8);
    refused += !is_mesh(sheet, bad);
  }
  EXPECT_GT(refused, 50);
}

INSTANTIATE_TEST_SUITE_P(Methods, DracoDamage,
                         testing::Values(draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING),
                         [](const auto& tested) {
                           return tested.param == draco::MESH_SEQUENTIAL_ENCODING ? "Sequential" : "Edgebreaker";
                         });

}  // namespace
}  // namespace zoneplate
