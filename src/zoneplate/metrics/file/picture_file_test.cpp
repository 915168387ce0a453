// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/file/picture_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/os/file.h"

namespace zoneplate::metrics {
namespace {

namespace fs = std::filesystem;

/// A temporary directory, which the destructor removes.
class Folder : public testing::Test {
 protected:
  Folder() : path_(fs::temp_directory_path() / ("zoneplate_picture_file_test_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() override { fs::remove_all(path_); }

  std::string save(const std::string& name, std::uint8_t code = 0) const {
    fs::create_directories((path_ / name).parent_path());
    const std::string path = (path_ / name).string();
    save_bytes(path, encode_png(Rgba8Image(4, 3, {code, code, code, 255})));
    return path;
  }
  std::string at(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

std::vector<std::string> names(std::vector<std::string> paths) {
  for (std::string& path : paths) path = fs::path(path).filename().string();
  return paths;
}

using PictureFile = Folder;

TEST_F(PictureFile, IsReadAsCodesAndLight) {
  const Picture picture = load_picture(save("a.png", 128));
  EXPECT_EQ(picture.width(), 4);
  EXPECT_EQ(picture.height(), 3);
  EXPECT_EQ(picture.display(1, 1), (Display{128 / 255.0f, 128 / 255.0f, 128 / 255.0f, 1}));
  EXPECT_NEAR(picture.linear(1, 1).r, 0.21586, 1e-5);
}

TEST_F(PictureFile, OfSixteenBitsKeepsThem) {
  const std::string path = at("deep.png");
  save_bytes(path, encode_png(Rgba16Image(1, 1, {1, 2, 3, 65535})));
  EXPECT_EQ(load_picture(path).display(0, 0), (Display{1 / 65535.0f, 2 / 65535.0f, 3 / 65535.0f, 1}));
}

TEST_F(PictureFile, AWebpHasTheCodesOfItsPng) {
  const std::string png = save("a.png", 77), webp = at("a.webp");
  save_bytes(webp, encode_webp(Rgba8Image(4, 3, {77, 77, 77, 255}), false));
  EXPECT_EQ(load_picture(webp).display, load_picture(png).display);
  save_bytes(webp, std::vector<std::uint8_t>{'R', 'I', 'F', 'F', 9, 0, 0, 0, 'W', 'E', 'B', 'P', 'V', 'P', '8', ' '});
  try {
    load_picture(webp);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), webp + ": not a sound WebP file");
  }
}

TEST_F(PictureFile, OfLightIsUnboundedAndItsCodesAreClamped) {
  const LinearImage light(2, 1, {4, 0.25f, 0, 1});
  const Linear& first = light.values()[0];
  save_bytes(at("a.exr"), encode_exr(2, 1,
                                     {{"R", ExrType::Half, &first.r, nullptr, 4},
                                      {"G", ExrType::Half, &first.g, nullptr, 4},
                                      {"B", ExrType::Half, &first.b, nullptr, 4}}));
  const std::string bytes("#?RADIANCE\n\n-Y 1 +X 2\n\x80\x08\x00\x83\x80\x08\x00\x83", 30);
  save_bytes(at("a.hdr"), std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
  save_bytes(at("a.pfm"), encode_pfm(light));
  for (const char* name : {"a.exr", "a.hdr", "a.pfm"}) {
    const Picture picture = load_picture(at(name));
    EXPECT_EQ(picture.linear, light) << name;
    EXPECT_EQ(picture.display(1, 0).r, 1) << name;
    EXPECT_NEAR(picture.display(1, 0).g, 0.5370987, 1e-5) << name;
  }
}

TEST_F(PictureFile, DirectoriesListPicturesInTheOrderOfNumbers) {
  for (const char* name : {"d/f10.png", "d/f9.PNG", "d/f011.jpg", "d/e.png", "d/notes.txt", "d/inner/f1.png"})
    save(name);
  EXPECT_EQ(names(list_pictures(at("d")).paths), (std::vector<std::string>{"e.png", "f9.PNG", "f10.png", "f011.jpg"}));
  fs::create_directories(at("empty"));
  EXPECT_THROW(static_cast<void>(list_pictures(at("empty"))), Error);
  for (const char* name : {"all/a.webp", "all/b.pfm", "all/c.hdr"}) save(name);
  EXPECT_EQ(list_pictures(at("all")).paths.size(), 3u);
}

TEST_F(PictureFile, PatternsFindFrames) {
  for (const char* name : {"f.0001.png", "f.0002.png", "f.10000.png", "f.3.png", "f.0001.jpg", "g.0001.png"})
    save(name);
  const std::vector<std::string> frames = {"f.0001.png", "f.0002.png", "f.10000.png"};
  EXPECT_EQ(names(list_pictures(at("f.####.png")).paths), frames);
  EXPECT_EQ(names(list_pictures(at("f.%04d.png")).paths), frames);
  EXPECT_EQ(names(list_pictures(at("f.%d.png")).paths), (std::vector<std::string>{"f.3.png", "f.10000.png"}));
  EXPECT_TRUE(are_frames(list_pictures(at("f.####.png")).paths));
  EXPECT_FALSE(are_frames({"a1.png", "b1.png"}));
  EXPECT_FALSE(are_frames({"a1.png"}));
  EXPECT_THROW(static_cast<void>(list_pictures(at("h.####.png"))), Error);
  EXPECT_EQ(list_pictures(at("missing.png")).paths.size(), 1u);
  EXPECT_THROW(load_picture(at("missing.png")), Error);
}

// Images of other renderers, if they are present in the shared data: the lowest and the highest decibels between two
// rasterisers' images of a scene, as published.
struct PublishedDistance {
  const char* scene;
  double best, worst;
};
class SharedRenderings : public testing::TestWithParam<PublishedDistance> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedRenderings);

const std::string renderings = "data/goldens-calibration/images";

std::vector<PublishedDistance> published_distances() {
  std::vector<PublishedDistance> out = {{"khronos-Suzanne", -26.67, -19.31},
                                        {"khronos-MetalRoughSpheresNoTextures", -26.87, -16.32},
                                        {"khronos-AlphaBlendModeTest", -31.83, -24.63}};
  std::erase_if(out, [](const PublishedDistance& d) { return shared_files(renderings, {d.scene}).empty(); });
  return out;
}

TEST_P(SharedRenderings, AreAsFarApartAsPublished) {
  const auto [scene, best, worst] = GetParam();
  std::vector<Picture> pictures;
  for (const char* renderer : {"babylon", "filament", "gltf-sample-viewer", "model-viewer"})
    for (const std::string& path : shared_files(renderings, {std::string(scene) + "/" + renderer + ".png"}))
      pictures.push_back(load_picture(path));
  ASSERT_EQ(pictures.size(), 4u);
  const Choice choice = choose_metric(metrics(), "yiq_rms:empty=1");
  std::vector<double> decibels;
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (std::size_t j = 0; j < pictures.size(); ++j)
      if (i != j)
        decibels.push_back(choice.metric->measure({&pictures[i], 1}, {&pictures[j], 1}, choice.settings)->value);
  EXPECT_NEAR(std::ranges::min(decibels), best, 0.01);
  EXPECT_NEAR(std::ranges::max(decibels), worst, 0.01);
}
INSTANTIATE_TEST_SUITE_P(YiqRms, SharedRenderings, testing::ValuesIn(published_distances()),
                         [](const auto& tested) { return std::string(tested.param.scene).substr(8); });

}  // namespace
}  // namespace zoneplate::metrics
