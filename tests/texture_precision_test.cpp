// SPDX-License-Identifier: Apache-2.0
// What a texture holds beyond 8 bits and above white, in the image that the command writes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <utility>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/image/half.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

class TexturePrecision : public testing::Test {
 protected:
  TexturePrecision() : place_(fs::temp_directory_path() / ("zoneplate_textures_" + std::to_string(::getpid()))) {
    fs::create_directories(place_);
  }
  ~TexturePrecision() override { fs::remove_all(place_); }

  void write(const std::string& name, const std::string& text) const {
    save_bytes((place_ / name).string(), std::vector<std::uint8_t>(text.begin(), text.end()));
  }
  void write(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    save_bytes((place_ / name).string(), bytes);
  }
  /// Writes a strip, 8 by 1, with this material; gives its path.
  std::string write_strip(const std::string& material) const {
    write("m.mtl", "newmtl m\n" + material);
    write("m.obj",
          "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 8 0 0\nv 8 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
          "f 1/1 2/2 3/3 4/4\n");
    return (place_ / "m.obj").string();
  }
  /// The red values of a picture of the strip.
  std::vector<float> reds(const std::string& material) const {
    write_strip(material);
    const std::string command = "cd " + place_.string() + " && " + program_file +
                                " m.obj -o a.pfm --size 1280x160 --camera-azimuth-angle 0 --camera-elevation-angle 0";
    EXPECT_EQ(std::system(command.c_str()), 0);
    const FileBytes file((place_ / "a.pfm").string());
    const std::string head = "PF\n1280 160\n-1.0\n";
    EXPECT_EQ(file.bytes().size(), head.size() + 1280 * 160 * 12);
    std::vector<float> red(1280 * 160);
    for (std::size_t i = 0; i < red.size(); ++i)
      std::memcpy(&red[i], file.bytes().data() + head.size() + 12 * i, sizeof(float));
    return red;
  }

 private:
  fs::path place_;
};

TEST_F(TexturePrecision, EmissionOfTenThousandReachesThePicture) {
  const std::vector<float> light(16, 1e4f);
  write("sun.exr", encode_exr(4, 4, {{"Y", ExrType::Half, light.data(), nullptr, 1}}));
  EXPECT_EQ(std::ranges::max(reds("Kd 0 0 0\nmap_Ke sun.exr\n")), 1e4f);
  write("sun.hdr", "#?RADIANCE\n\n-Y 1 +X 1\n\x80\x80\x80\x96");
  EXPECT_EQ(std::ranges::max(reds("Kd 0 0 0\nmap_Ke sun.hdr\n")), 0x1p21f);
}

// An EXR file of half floats is an emissive texture; each pixel is compared with the bilinear mean, in double, of the
// file's texels at the pixel's texture coordinates.
TEST_F(TexturePrecision, HalfFloatsAgreeWithDoublePrecision) {
  constexpr int columns = 32, rows = 4;
  std::vector<float> light(columns * rows);
  for (std::size_t i = 0; i < light.size(); ++i)
    light[i] = half_value(half_bits(static_cast<float>(std::exp2(static_cast<double>(i * 37 % 128) / 8 - 0.1))));
  write("hdr.exr", encode_exr(columns, rows, {{"Y", ExrType::Half, light.data(), nullptr, 1}}));
  Scene scene = load_scene(write_strip("Kd 0 0 0\nmap_Ke hdr.exr\n"));
  const Camera camera = choose_camera(scene, {.azimuth = 0, .elevation = 0}, 8);
  Renderer renderer(PreparedScene(std::move(scene)), make_resolver(antialias::methods(), "none"));
  const RenderedImage image = renderer.render(
      camera,
      {.options = {.width = 800, .height = 100}, .planes = {.uv = true, .coverage = true}, .form = ImageForm::Linear});

  const auto wrapped = [](double i, int n) { return (static_cast<int>(i) % n + n) % n; };
  const auto texel = [&](double x, double y) -> double {
    return light[static_cast<std::size_t>(wrapped(y, rows) * columns + wrapped(x, columns))];
  };
  int count = 0;
  double most = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 800; ++x) {
      if (!(image.data.coverage(x, y) > 0)) continue;
      const float2 uv = image.data.uv(x, y);
      const double s = static_cast<double>(uv.x) * columns - 0.5, t = static_cast<double>(uv.y) * rows - 0.5;
      const double s0 = std::floor(s), t0 = std::floor(t), fs = s - s0, ft = t - t0;
      const double expected = (texel(s0, t0) * (1 - fs) + texel(s0 + 1, t0) * fs) * (1 - ft) +
                              (texel(s0, t0 + 1) * (1 - fs) + texel(s0 + 1, t0 + 1) * fs) * ft;
      // Half a unit of a half float, and the weights' 15 bits along two axes: 2^-15 of differences of at most 2^16.
      ASSERT_NEAR(image.linear(x, y).r, expected, expected * 0x1p-11 + 4) << x << " " << y;
      most = std::max(most, expected);
      ++count;
    }
  EXPECT_GT(count, 40000);
  EXPECT_GT(most, 50000);
}

TEST_F(TexturePrecision, AGradientOfSixteenBitsKeepsItsLevels) {
  Rgba16Image ramp(512, 1);
  for (int x = 0; x < 512; ++x) ramp(x, 0).r = static_cast<std::uint16_t>(30000 + x);  // less than three of 8 bits
  write("ramp.png", encode_png(ramp));
  const std::vector<float> red = reds("illum 0\nmap_Kd ramp.png\n");
  EXPECT_GT(std::set<float>(red.begin(), red.end()).size(), 400u);
}

}  // namespace
}  // namespace zoneplate
