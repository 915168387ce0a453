// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/ply/stream.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/ply/ply.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/stream/stream_outline.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct PlyKind {
  const char* name;
  bool has_doubles = false, has_normals = false, is_turned = false, has_colors = false, has_flags = false;
  bool is_big = false;  ///< big-endian
  bool is_text = false;
};

constexpr std::uint32_t large = 70;
constexpr std::uint32_t vertices_of(std::uint32_t side) { return (side + 1) * (side + 1); }
constexpr std::uint32_t faces_of(std::uint32_t side) { return 2 * side * side; }
constexpr std::uint32_t vertex_count = vertices_of(large), face_count = faces_of(large);

template <class T>
void put_as(bool is_big, T value, Bytes& out) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
  if (is_big) std::reverse(out.end() - sizeof value, out.end());
}

/// Terrain, smooth with a rough part, whose faces are in a scattered order.
Bytes terrain(const PlyKind& kind, std::uint8_t alpha = 255, std::uint32_t side = large) {
  const auto put = [&](auto value, Bytes& to) {
    if (!kind.is_text) return put_as(kind.is_big, value, to);
    const std::string word = fmt::format("{} ", value);
    to.insert(to.end(), word.begin(), word.end());
  };
  const auto end_row = [&](Bytes& to) {
    if (kind.is_text) to.push_back('\n');
  };
  std::string head = "ply\nformat ascii 1.0\n";
  if (!kind.is_text) head = fmt::format("ply\nformat binary_{}_endian 1.0\n", kind.is_big ? "big" : "little");
  head += fmt::format("element vertex {}\n", vertices_of(side));
  for (const char* axis : {"x", "y", "z"})
    head += fmt::format("property {} {}\n", kind.has_doubles ? "double" : "float", axis);
  if (kind.has_normals) head += "property float nx\nproperty float ny\nproperty float nz\n";
  if (kind.has_colors) head += "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
  head += fmt::format("element face {}\n", faces_of(side));
  if (kind.has_flags) head += "property ushort flags\n";
  head += "property list uchar int vertex_indices\nend_header\n";
  Bytes out(head.begin(), head.end());
  for (std::uint32_t i = 0; i < vertices_of(side); ++i) {
    const std::uint32_t x = i % (side + 1), z = i / (side + 1);
    const float rough = x > 20 && x < 50 ? 1.5f : 0.1f;
    const float3 p{static_cast<float>(x), rough * unit_float(hash(i)), static_cast<float>(z)};
    for (const float c : {p.x, p.y, p.z})
      if (kind.has_doubles)
        put(static_cast<double>(c) + 1e-9, out);
      else
        put(c, out);
    if (kind.has_normals)
      for (const float c : {0.1f * unit_float(hash(i, 1)), kind.is_turned ? -2.0f : 2.0f, 0.0f}) put(c, out);
    if (kind.has_colors)
      for (const std::uint32_t c : {x, z, x + z}) put(static_cast<std::uint8_t>(c), out);
    if (kind.has_colors) put(alpha, out);
    end_row(out);
  }
  for (std::uint32_t k = 0; k < side * side; ++k) {
    const std::uint32_t square = k * 1009 % (side * side), a = square / side * (side + 1) + square % side;
    for (const auto& face : {std::array{a, a + side + 1, a + 1}, std::array{a + 1, a + side + 1, a + side + 2}}) {
      if (kind.has_flags) put(std::uint16_t{7}, out);
      put(std::uint8_t{3}, out);
      for (const std::uint32_t v : face) put(v, out);
      end_row(out);
    }
  }
  return out;
}

void examine(FileStream& stream) {
  std::vector<float3> corners(3 * stream.count());
  stream.read(0, stream.count(), corners.data());
  parallel_ranges(stream.count(), 1000,
                  [&](std::size_t begin, std::size_t end) { stream.examine(begin, end - begin, &corners[3 * begin]); });
}

// An index that another program changes after it has been examined does not lead out of the file's vertices.
TEST(PlyStream, ReportsAFileThatIsChanged) {
  const MemoryFile file;
  Bytes bytes = terrain({"plain"});
  const std::string path = file.write(bytes);
  const std::unique_ptr<FileStream> stream = open_ply_stream(path, {});
  ASSERT_TRUE(stream);
  examine(*stream);
  const std::uint32_t some[] = {0, face_count - 1};
  EXPECT_EQ(stream->mesh(some).primitives(), 2u);
  std::fill_n(bytes.end() - 4, 4, std::uint8_t{0x7f});
  file.write(bytes);
  try {
    stream->mesh(some);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    EXPECT_NE(std::string(error.what()).find("was changed while it was read"), std::string::npos) << error.what();
  }
}

TEST(PlyStream, HasTheMeshOfTheLoader) {
  for (const PlyKind& kind : {PlyKind{"plain"}, PlyKind{.name = "doubles", .has_doubles = true},
                              PlyKind{.name = "normals", .has_normals = true},
                              PlyKind{.name = "turned", .has_normals = true, .is_turned = true},
                              PlyKind{.name = "colors", .has_colors = true, .has_flags = true},
                              PlyKind{.name = "big", .has_normals = true, .has_colors = true, .is_big = true},
                              PlyKind{.name = "text", .is_text = true},
                              PlyKind{.name = "text of all",
                              .has_doubles = true,
                              .has_normals = true,
                              .is_turned = true,
                              .has_colors = true,
                              .has_flags = true,
                              .is_text = true}}) {
    SCOPED_TRACE(kind.name);
    const MemoryFile file;
    const std::string path = file.write(terrain(kind));
    const Scene whole = load_ply(path);
    const Mesh& mesh = whole.meshes.at(0);
    const std::unique_ptr<FileStream> stream = open_ply_stream(path, {});
    ASSERT_TRUE(stream);
    ASSERT_EQ(stream->count(), face_count);
    stream->check();
    examine(*stream);
    std::vector<float3> corners(3 * face_count);
    stream->read(0, face_count, corners.data());
    std::vector<std::uint32_t> some;
    for (std::uint32_t t = 0; t < face_count; ++t)
      if (unit_float(hash(t, 5)) < 0.1f) some.push_back(t);
    const Mesh part = stream->mesh(some);
    ASSERT_EQ(part.primitives(), some.size());
    std::size_t turned = 0;
    for (std::size_t i = 0; i < 3 * some.size(); ++i) {
      const std::uint32_t v = mesh.index[3 * some[i / 3] + i % 3], w = part.index[i];
      ASSERT_EQ(part.position[w], mesh.position[v]) << i;
      ASSERT_EQ(part.normal[w], mesh.normal[v]) << i;
      if (kind.has_colors) {
        ASSERT_EQ(part.color[w], mesh.color[v]) << i;
      }
      if (corners[3 * some[i / 3] + i % 3] != mesh.position[v]) ++turned;
    }
    EXPECT_EQ(turned > 0, kind.is_turned);
    EXPECT_EQ(part.color.empty(), mesh.color.empty());
    const Scene head = stream->head();
    EXPECT_EQ(head.materials[0].base_color, whole.materials[0].base_color);
    EXPECT_EQ(head.materials[0].alpha_mode, whole.materials[0].alpha_mode);
  }
}

TEST(PlyStream, RefusesWhatDependsOnTheWhole) {
  const MemoryFile file;
  const PlyKind colors{.name = "colors", .has_colors = true};
  EXPECT_NO_THROW(open_ply_stream(file.write(terrain(colors)), {})->check());
  EXPECT_THROW(open_ply_stream(file.write(terrain(colors, 254)), {})->check(), Error);

  Bytes lacks = terrain({.name = "normals", .has_normals = true});
  const std::size_t header = lacks.size() - face_count * 13 - vertex_count * 24;
  std::memset(&lacks[header + 24 * 100 + 12], 0, 12);
  const std::unique_ptr<FileStream> stream = open_ply_stream(file.write(lacks), {});
  examine(*stream);
  EXPECT_THROW(stream->head(), Error);
}

TEST(PlyStream, FacesThatAreNoTrianglesHaveNoCorners) {
  const Bytes good = terrain({"plain"});
  const std::size_t last = good.size() - 13;
  for (const std::size_t at : {last, last + 4}) {  // the number of corners, the high byte of an index
    Bytes bad = good;
    bad[at] = 200;
    const MemoryFile file;
    const std::unique_ptr<FileStream> stream = open_ply_stream(file.write(bad), {});
    std::vector<float3> corners(3);
    stream->read(face_count - 2, 1, corners.data());
    EXPECT_TRUE(is_finite(corners[0]));
    stream->read(face_count - 1, 1, corners.data());
    EXPECT_FALSE(is_finite(corners[0]));
  }
}

TEST(PlyStream, IsMadeOfPlainTrianglesAlone) {
  const MemoryFile file;
  const auto opens = [&](const std::string& body) {
    const std::string text = "ply\n" + body;
    return open_ply_stream(file.write({text.begin(), text.end()}), {}) != nullptr;
  };
  EXPECT_FALSE(
      opens("format binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
            "property float z\nend_header\n0123456789ab"));
  const std::string text =
      "format ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\n";
  EXPECT_TRUE(opens(text + "end_header\n0 0 0\n3 0 0 0\n3 0 0 0"));
  EXPECT_FALSE(opens(text + "end_header\n0 0 0\n3 0 0 0\n4 0 0 0 0\n"));
  EXPECT_FALSE(opens(text + "end_header\n0 0 0\n3 0 0 0\n"));
  EXPECT_FALSE(opens(text + "element edge 1\nproperty int vertex1\nend_header\n0 0 0\n3 0 0 0\n3 0 0 0\n0\n"));
}

TEST(PlyStream, AgreesWithTheLoaderAboutDamagedFiles) {
  int agreed = 0, refused = 0;
  for (std::uint32_t seed = 0; seed < 1500; ++seed) {
    const PlyKind kind{.name = "damaged",
                       .has_doubles = seed % 5 == 0,
                       .has_normals = seed % 3 == 0,
                       .has_colors = seed % 4 == 0,
                       .has_flags = seed % 7 == 0,
                       .is_big = seed % 6 == 0,
                       .is_text = seed % 2 == 1};
    Bytes bytes = terrain(kind, 255, 8);
    for (std::uint32_t k = 0; k <= seed % 3; ++k)
      bytes[hash(seed, k) % bytes.size()] =
          static_cast<std::uint8_t>(kind.is_text ? '/' + hash(seed, k, 1) % 12 : hash(seed, k, 1));
    const MemoryFile file;
    const std::string path = file.write(bytes);
    Mesh part;
    std::size_t count = 0;
    try {
      const std::unique_ptr<FileStream> stream = open_ply_stream(path, {});
      if (!stream) continue;
      stream->check();
      const StreamOutline outline(*stream, path, {});
      static_cast<void>(stream->head());
      count = stream->count();
      std::vector<std::uint32_t> all(count);
      std::iota(all.begin(), all.end(), 0u);
      part = stream->mesh(all);
    } catch (const Error&) {
      ++refused;
      continue;
    }
    ++agreed;
    const Scene whole = load_ply(path);
    const Mesh& mesh = whole.meshes.at(0);
    ASSERT_EQ(mesh.primitives(), count) << seed;
    ASSERT_EQ(whole.materials[0].alpha_mode, AlphaMode::Opaque) << seed;
    ASSERT_EQ(whole.origin, double3{}) << seed;
    for (std::size_t i = 0; i < mesh.index.size(); ++i) {
      ASSERT_EQ(part.position[part.index[i]], mesh.position[mesh.index[i]]) << seed;
      ASSERT_EQ(part.normal[part.index[i]], mesh.normal[mesh.index[i]]) << seed;
      if (!mesh.color.empty()) {
        ASSERT_EQ(part.color[part.index[i]], mesh.color[mesh.index[i]]) << seed;
      }
    }
  }
  EXPECT_GT(agreed, 300);
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace zoneplate
