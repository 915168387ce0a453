// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/save.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

struct SaveImage : ::testing::Test {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "save_image";
  SaveImage() { std::filesystem::create_directories(folder); }
  ~SaveImage() override { std::filesystem::remove_all(folder); }
  std::string path(const char* name) const { return (folder / name).string(); }
  FileBytes saved(const char* name) const { return FileBytes(path(name), std::uint64_t{1} << 20); }
};

TEST_F(SaveImage, TheEndingChoosesTheFormat) {
  Rgba8Image image(3, 2, Rgba8{10, 20, 30, 255});
  image(1, 1) = {200, 100, 50, 128};
  save_image(path("a.PNG"), image);
  save_image(path("a.webp"), image);
  EXPECT_EQ(decode_png(saved("a.PNG").bytes(), "a").pixels, image);
  EXPECT_EQ(decode_webp(saved("a.webp").bytes(), "a", 100), image);
  LinearImage linear(3, 2, Linear{0.5f, 2, 4, 1});
  save_image(path("a.pfm"), linear);
  EXPECT_EQ(decode_pfm(saved("a.pfm").bytes(), "a"), linear);
  save_image(path("a.exr"), linear);
  EXPECT_GT(saved("a.exr").bytes().size(), 100u);
}

TEST_F(SaveImage, AnUnknownEndingIsAnErrorAndWritesNothing) {
  EXPECT_THROW(save_image(path("a.bmp"), Rgba8Image(1, 1)), Error);
  EXPECT_THROW(save_image(path("a.png"), LinearImage(1, 1)), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

}  // namespace
}  // namespace zoneplate
