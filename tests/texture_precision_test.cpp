// What a texture holds beyond 8 bits and above white, in the image that the command writes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>

#include "zoneplate/codec/exr_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/os/file.h"

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
  /// The red values of an image of a strip, 8 by 1, with this material.
  std::vector<float> reds(const std::string& material) const {
    write("m.mtl", "newmtl m\n" + material);
    write("m.obj",
          "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 8 0 0\nv 8 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
          "f 1/1 2/2 3/3 4/4\n");
    const std::string command = "cd " + place_.string() +
                                " && " ZONEPLATE_PROGRAM
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

TEST_F(TexturePrecision, AGradientOfSixteenBitsKeepsItsLevels) {
  Rgba16Image ramp(512, 1);
  for (int x = 0; x < 512; ++x) ramp(x, 0).r = static_cast<std::uint16_t>(30000 + x);  // less than three of 8 bits
  write("ramp.png", encode_png(ramp));
  const std::vector<float> red = reds("illum 0\nmap_Kd ramp.png\n");
  EXPECT_GT(std::set<float>(red.begin(), red.end()).size(), 400u);
}

}  // namespace
}  // namespace zoneplate
