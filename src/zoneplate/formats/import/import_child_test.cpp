// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/import_child.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/import/mesh_samples_for_test.h"
#include "zoneplate/formats/import/scene_bytes.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

std::vector<std::uint8_t> fields_of(const Scene& scene) {
  std::vector<std::uint8_t> out;
  write_scene(scene, [&](const void* data, std::size_t size) {
    const auto* at = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), at, at + size);
  });
  return out;
}

TEST(Sandbox, GivesTheSameScenesAndErrors) {
  const MemoryFile file;
  for (const auto& [format, bytes] :
       std::vector<std::pair<const char*, mesh_samples::Bytes>>{{"ply", mesh_samples::binary_ply(true)},
                                                                {"stl", mesh_samples::binary_stl()},
                                                                {"obj", mesh_samples::bytes_of(mesh_samples::obj)}}) {
    const std::string path = file.write(bytes);
    const LoadOptions plain{.limits = {}, .format = format, .choice = {}};
    LoadOptions boxed = plain;
    boxed.is_sandboxed = true;
    EXPECT_EQ(fields_of(load_scene(path, boxed)), fields_of(load_scene(path, plain))) << format;
    const std::string broken = file.write({bytes.begin(), bytes.begin() + 20});
    std::string said[2];
    for (const LoadOptions& options : {plain, boxed}) try {
        load_scene(broken, options);
      } catch (const Error& error) {
        said[options.is_sandboxed] = error.what();
      }
    EXPECT_EQ(said[0], said[1]);
  }
}

TEST(Sandbox, KeepsToTheLimitsOfTheImport) {
  const MemoryFile file;
  const std::string path = file.write(mesh_samples::binary_ply(true));
  const LoadOptions hurried{.limits = {.seconds = -1}, .format = "ply", .choice = {}, .is_sandboxed = true};
  try {
    load_scene(path, hurried);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("takes longer to load than the limit"), std::string::npos);
  }
}

/// Loads a square whose texture is a file in the same folder.
TEST(Sandbox, ReadsExrTextures) {
  const std::filesystem::path folder = testing::TempDir() + "zoneplate_boxed_" + std::to_string(::getpid());
  std::filesystem::create_directory(folder);
  const auto write = [&](const char* name, std::span<const std::uint8_t> bytes) {
    save_bytes((folder / name).string(), bytes);
  };
  const auto write_text = [&](const char* name, std::string_view text) {
    write(name, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  const std::vector<float> values = {0.25f, 0.5f, 0.75f, 1};
  write("a.exr", encode_exr(2, 2, {{"Y", ExrType::Float, values.data()}}));
  write_text("a.mtl", "newmtl m\nmap_Kd a.exr\n");
  write_text("a.obj", "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
  const std::string model = (folder / "a.obj").string();
  const Scene plain = load_scene(model), boxed = load_scene(model, {.is_sandboxed = true});
  ASSERT_EQ(boxed.images.size(), 1u);
  EXPECT_EQ(fields_of(boxed), fields_of(plain));
  EXPECT_EQ(boxed.warnings, std::vector<std::string>{});
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace zoneplate
