// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/stl/stream.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string_view>

#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/import/stream_for_test.h"
#include "zoneplate/formats/stl/stl.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr std::uint32_t facets = 5000;

std::vector<std::uint8_t> random_file(const std::string& header, std::uint16_t (*attribute)(std::uint32_t)) {
  std::vector<std::uint8_t> out(84 + 50 * facets);
  std::memcpy(out.data(), header.data(), header.size());
  std::memcpy(&out[80], &facets, 4);
  for (std::uint32_t f = 0; f < facets; ++f) {
    float corners[9];
    for (std::uint32_t i = 0; i < 9; ++i) corners[i] = unit_float(hash(f, i));
    if (f % 100 == 0) std::memset(corners, 0, sizeof corners);  // without area
    const std::uint16_t own = attribute(f);
    std::memcpy(&out[84 + 50 * f + 12], corners, sizeof corners);
    std::memcpy(&out[84 + 50 * f + 48], &own, sizeof own);
  }
  return out;
}

TEST(StlStream, HasTheMeshOfTheLoader) {
  const auto none = [](std::uint32_t) -> std::uint16_t { return 0; };
  const auto late = [](std::uint32_t f) -> std::uint16_t {
    return f == 4999 ? 0x8123 : f == 4998 ? 0x0123 : std::uint16_t{0};
  };
  const std::string magics = std::string("made by hand COLOR=") + "\x20\x40\x60\xff";
  for (const std::string& header : {std::string("by hand"), magics})
    for (const auto attribute : {+none, +late}) {
      const MemoryFile file;
      const std::string path = file.write(random_file(header, attribute));
      const Scene whole = load_stl(path);
      const Mesh& mesh = whole.meshes.at(0);
      const std::unique_ptr<FileStream> stream = open_stl_stream(path, {});
      ASSERT_TRUE(stream);
      ASSERT_EQ(stream->count(), facets);
      std::vector<float3> corners(3 * facets);
      stream->read(0, 1000, corners.data());
      stream->read(1000, facets - 1000, &corners[3000]);
      EXPECT_EQ(corners, mesh.position);
      stream->examine(0, 2000, corners.data());
      stream->examine(2000, facets - 2000, corners.data());

      std::vector<std::uint32_t> some;  // without the two that have colours
      for (std::uint32_t t = 5; t < facets - 2; t += 7) some.push_back(t);
      const Mesh part = stream->mesh(some);
      ASSERT_EQ(part.primitives(), some.size());
      EXPECT_EQ(part.color.empty(), mesh.color.empty());
      for (std::size_t i = 0; i < 3 * some.size(); ++i) {
        const std::size_t v = 3 * some[i / 3] + i % 3;
        ASSERT_EQ(part.position[part.index[i]], mesh.position[v]);
        ASSERT_EQ(part.normal[part.index[i]], mesh.normal[v]);
        if (!mesh.color.empty()) {
          ASSERT_EQ(part.color[part.index[i]], mesh.color[v]);
        }
      }
      const Scene head = stream->head();
      EXPECT_EQ(head.materials[0].base_color, whole.materials[0].base_color);
      EXPECT_EQ(head.up, whole.up);
      EXPECT_EQ(head.instances.size(), 1u);
      EXPECT_EQ(head.meshes[0].primitives(), 0u);
    }
}

/// Solids of triangles and polygons, without a name and with one, of which two have no triangle.
std::vector<std::uint8_t> random_text(std::uint32_t loops) {
  std::string out = "; by hand\n";
  for (std::uint32_t l = 0; l < loops; ++l) {
    if (l % 1000 == 0) out += l == 1000 ? "endsolid\nsolid\n" : fmt::format("endsolid\nsolid part {}\n", l);
    if (l == 2000)
      out += "endsolid\nsolid empty\nendsolid\nsolid short\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\n";
    if (l == 2000) out += "endloop\nendfacet\nendsolid\nsolid after\n";
    out += "  facet normal 0 0 1\n    outer loop\n";
    const std::uint32_t corners = l % 7 == 0 ? 5 : 3;
    for (std::uint32_t k = 0; k < corners; ++k) {
      const float angle = 6.283f * static_cast<float>(k) / static_cast<float>(corners);
      const float x = unit_float(hash(l, 1)), y = unit_float(hash(l, 2)), z = unit_float(hash(l, 3));
      out += fmt::format("      vertex {} {:e} {}\n", x + 0.1f * std::cos(angle), y + 0.1f * std::sin(angle), z);
    }
    out += "    endloop\n  endfacet\n";
  }
  out += "endsolid\n";
  out.erase(out.find("endsolid\n"), 9);
  return {out.begin(), out.end()};
}

// The text has some four parts.
TEST(StlStream, HasTheMeshesOfText) {
  const MemoryFile file;
  const std::string path = file.write(random_text(20000));
  const Scene whole = load_stl(path);
  ASSERT_EQ(whole.meshes.size(), 20u);
  const std::unique_ptr<FileStream> stream = open_stl_stream(path, {});
  ASSERT_TRUE(stream);
  expect_scene_of(*stream, path, whole, 0.1f);
  EXPECT_EQ(stream->head().warnings, whole.warnings);
}

TEST(StlStream, AgreesWithTheLoaderAboutDamagedText) {
  DamagedFiles files;
  constexpr std::string_view damage = "0123456789 .-e\nx";
  const std::vector<std::uint8_t> good = random_text(12);
  for (std::uint32_t seed = 0; seed < 1500; ++seed) {
    std::vector<std::uint8_t> bytes = good;
    for (std::uint32_t k = 0; k <= seed % 3; ++k)
      if (std::uint8_t& byte = bytes[hash(seed, k) % bytes.size()]; byte < 'a')
        byte = static_cast<std::uint8_t>(damage[hash(seed, k, 1) % damage.size()]);
    const MemoryFile file;
    files.add(
        file.write(bytes), [](const std::string& path) { return open_stl_stream(path, {}); },
        [](const std::string& path) { return load_stl(path); }, 1);
    if (testing::Test::HasFatalFailure()) FAIL() << seed;
  }
  EXPECT_GT(files.agreed, 300);
  EXPECT_GT(files.refused, 300);
}

// A facet that another program adds after the text has been read is none of the stream's.
TEST(StlStream, ReportsATextThatIsChanged) {
  const MemoryFile file;
  std::vector<std::uint8_t> bytes = random_text(12);
  const std::string path = file.write(bytes);
  const std::unique_ptr<FileStream> stream = open_stl_stream(path, {});
  ASSERT_TRUE(stream);
  const std::string_view vertex = "vertex";
  const auto found = std::search(bytes.begin(), bytes.end(), vertex.begin(), vertex.end());
  std::fill(found, std::find(found, bytes.end(), '\n'), std::uint8_t{' '});
  file.write(bytes);
  const std::uint32_t some[] = {0};
  try {
    stream->mesh(some);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("was changed while it was read"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace zoneplate
