// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/stream.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/import/stream_for_test.h"
#include "zoneplate/formats/obj/obj.h"

namespace zoneplate {
namespace {

struct FileKind {
  const char* name;
  bool has_normals = false, is_turned = false, has_uvs = false, has_colors = false, has_quads = false;
  bool counts_back = false, has_groups = false, has_smoothing = false;
};

/// Rough terrain of `side` × `side` squares, whose faces are in a scattered order.
std::string terrain(const FileKind& kind, std::uint32_t side) {
  std::string out = "mtllib missing.mtl\n";
  const std::uint32_t row = side + 1, vertices = row * row;
  for (std::uint32_t i = 0; i < vertices; ++i) {
    const float y = (i % row < side / 2 ? 0.1f : 2.0f) * unit_float(hash(i));
    out += fmt::format("v {} {} {}", i % row, y, i / row);
    out += kind.has_colors && i % 3 != 0 ? fmt::format(" {} 0.5 0.25\n", unit_float(hash(i, 1))) : "\n";
    if (kind.has_uvs) out += fmt::format("vt {} {}\n", unit_float(hash(i, 2)), unit_float(hash(i, 3)));
  }
  for (std::uint32_t i = 0; kind.has_normals && i < 100; ++i)
    out += fmt::format("vn {} {} 0.2\n", unit_float(hash(i, 4)), kind.is_turned ? -2 : 2);
  for (std::uint32_t k = 0; k < side * side; ++k) {
    if (kind.has_groups && k % 50 == 0) out += fmt::format("o part{}\nusemtl {}\n", k / 50 % 5, k / 100 % 3);
    if (kind.has_smoothing && k % 70 == 0) out += fmt::format("s {}\n", k / 70 % 3);
    const std::uint32_t square = k * 1009 % (side * side), a = square / side * row + square % side;
    const auto corner = [&](std::uint32_t v) {
      const auto number = [&](std::uint32_t i, std::uint32_t all) {
        return kind.counts_back ? static_cast<std::int64_t>(i) - all : std::int64_t{i} + 1;
      };
      std::string text = fmt::format(" {}", number(v, vertices));
      const bool has_uv = kind.has_uvs && k % 5 != 0;
      if (has_uv) text += fmt::format("/{}", number(v, vertices));
      if (kind.has_normals) text += fmt::format("{}/{}", has_uv ? "" : "/", number(v % 100, 100));
      return text;
    };
    const std::string p = corner(a), q = corner(a + row), r = corner(a + row + 1), s = corner(a + 1);
    if (kind.has_quads && k % 2 == 0)
      out += "f" + p + q + r + s + "\n";
    else
      out += "f" + p + q + s + "\nf" + s + q + r + "\n";
  }
  return out;
}

std::vector<std::uint8_t> stream_bytes(const std::string& text) { return {text.begin(), text.end()}; }

TEST(ObjStream, HasTheSceneOfTheLoader) {
  for (const FileKind& kind :
       {FileKind{"plain"}, FileKind{.name = "normals", .has_normals = true, .has_quads = true},
        FileKind{.name = "turned", .has_normals = true, .is_turned = true, .has_uvs = true},
        FileKind{.name = "colors", .has_uvs = true, .has_colors = true, .counts_back = true, .has_groups = true},
        FileKind{.name = "smoothing", .has_quads = true, .has_groups = true, .has_smoothing = true}}) {
    SCOPED_TRACE(kind.name);
    const MemoryFile file;
    const std::string text = terrain(kind, 150);
    ASSERT_GT(text.size(), std::size_t{1} << 20);  // of more than one part
    const std::string path = file.write(stream_bytes(text));
    const Scene whole = load_obj(path);
    const std::unique_ptr<FileStream> stream = open_obj_stream(path, {});
    ASSERT_TRUE(stream);
    expect_scene_of(*stream, path, whole, 0.05f);
    EXPECT_EQ(stream->head().warnings, whole.warnings);
  }
}

// Little memory: each part is read again and again.
TEST(ObjStream, NeedsNoPartForLong) {
  const MemoryFile file;
  const std::string path = file.write(stream_bytes(terrain({.name = "large", .has_groups = true}, 250)));
  const std::unique_ptr<FileStream> stream = open_obj_stream(path, {.memory = 1 << 20});
  ASSERT_TRUE(stream);
  EXPECT_GT(stream->bytes_in_memory(), std::uint64_t{1} << 20);
  const Scene whole = load_obj(path);
  const StreamOutline outline(*stream, path, {});
  EXPECT_EQ(outline.bounds().high, whole.bounds().high);
  std::vector<float3> corners(3 * 100);
  stream->read(stream->count() - 100, 100, corners.data());
  const Mesh& last = whole.meshes.back();
  EXPECT_EQ(corners.back(), last.position[last.index.back()]);
}

TEST(ObjStream, SamplesSayWhetherItMayFit) {
  const MemoryFile file;
  const std::string path = file.write(stream_bytes(terrain({"plain"}, 100)));
  EXPECT_FALSE(obj_may_exceed_memory(path, {.memory = 20'000'000}));
  EXPECT_TRUE(obj_may_exceed_memory(path, {.memory = 2'000'000}));
}

TEST(ObjStream, RefusesByNameWhatDependsOnTheWhole) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const auto& [text, cause] : std::initializer_list<std::pair<const char*, const char*>>{
           {"f 1 2 3\n", ""},
           {"f 1 2 3\nl 1 2\n", "lines or points"},
           {"vn 0 0 1\nf 1//1 2//1 3//1\nf 1 2 3\n", "without normals"},
           {"vn 0 0 0\nf 1//1 2//1 3//1\n", "without normals"}}) {
    const MemoryFile file;
    const std::unique_ptr<FileStream> stream = open_obj_stream(file.write(stream_bytes(vertices + text)), {});
    ASSERT_TRUE(stream);
    std::string found;
    try {
      stream->check();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      found = error.what();
    }
    EXPECT_EQ(found.empty(), *cause == 0) << found;
    EXPECT_NE(found.find(cause), found.npos) << found;
  }
  const MemoryFile points;
  EXPECT_EQ(open_obj_stream(points.write(stream_bytes(vertices)), {}), nullptr);
}

TEST(ObjStream, ReportsAFileThatIsChanged) {
  const std::string text = terrain({.name = "plain", .has_quads = true}, 150);
  for (const char letter : {'x', 'v', '\n', '9'}) {
    const MemoryFile file;
    const std::string path = file.write(stream_bytes(text));
    const std::unique_ptr<FileStream> stream = open_obj_stream(path, {.memory = 1 << 16});
    const StreamOutline outline(*stream, path, {});
    file.write(stream_bytes(std::string(text.size(), letter)));
    std::vector<std::uint32_t> all;
    for (std::uint32_t t = 0; t < stream->count(); ++t) all.push_back(t);
    EXPECT_THROW(stream->mesh(all), Error);
  }
}

TEST(ObjStream, AgreesWithTheLoaderAboutDamagedFiles) {
  DamagedFiles files;
  for (std::uint32_t seed = 0; seed < 900; ++seed) {
    SCOPED_TRACE(seed);
    std::string text = terrain({.name = "damaged",
                                .has_normals = seed % 3 == 0,
                                .has_uvs = seed % 2 == 0,
                                .has_colors = seed % 5 == 0,
                                .has_quads = seed % 7 < 3,
                                .counts_back = seed % 11 == 0,
                                .has_groups = seed % 4 == 0,
                                .has_smoothing = seed % 13 == 0},
                               12);
    for (std::uint32_t k = 0; k <= seed % 4; ++k)
      text[hash(seed, k) % text.size()] = "0123456789 /-.\nvfntexlpso"[hash(seed, k, 1) % 25];
    if (seed % 50 == 7) text.resize(hash(seed, 9) % text.size());
    const MemoryFile file;
    const std::string path = file.write(stream_bytes(text));
    files.add(
        path, [](const std::string& of) { return open_obj_stream(of, {.memory = 1 << 24}); },
        [](const std::string& of) { return load_obj(of); }, 0.2f);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(files.agreed, 300);
  EXPECT_GT(files.refused, 50);
}

}  // namespace
}  // namespace zoneplate
