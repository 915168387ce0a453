// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/stl/stream.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "zoneplate/formats/import/damage_for_test.h"
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

TEST(StlStream, IsNotMadeOfText) {
  const MemoryFile file;
  const std::string text =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
      "endloop\nendfacet\nendsolid\n";
  EXPECT_EQ(open_stl_stream(file.write({text.begin(), text.end()}), {}), nullptr);
}

}  // namespace
}  // namespace zoneplate
