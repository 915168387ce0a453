// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>

#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/os/file.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;

Rgba8Image rendered(const fs::path& folder, const std::vector<std::string>& more) {
  const std::string path = (folder / "out.png").string();
  std::vector<std::string> words{"teapot:divisions=6", "-o", path, "--size", "120,90", "--progress", "none", "-q"};
  words.insert(words.end(), more.begin(), more.end());
  run_render(words);
  return decode_png(FileBytes(path).bytes(), path).pixels;
}

TEST(Crop, HasTheWholesBitsAfterMethodsThatLookAround) {
  std::string name = (fs::temp_directory_path() / "zoneplate_crop_XXXXXX").string();
  ASSERT_NE(::mkdtemp(name.data()), nullptr);
  const fs::path folder(name);
  for (const std::string method : {"none", "fxaa", "smaa", "smaa:mode=s2x", "mlaa:kind=reshetov", "cmaa2", "dlaa"}) {
    const Rgba8Image whole = rendered(folder, {"--aa", method});
    // Through the spout; and at the image's corner, where the apron is clipped.
    for (const auto& [x, y, w, h] : {std::array{75, 28, 31, 26}, {0, 0, 40, 50}, {100, 60, 20, 30}}) {
      const std::string crop = fmt::format("{},{},{},{}", x, y, w, h);
      const Rgba8Image part = rendered(folder, {"--aa", method, "--crop", crop, "--aov", "depth"});
      ASSERT_EQ(part.width(), w);
      ASSERT_EQ(part.height(), h);
      for (int j = 0; j < h; ++j)
        for (int i = 0; i < w; ++i) ASSERT_EQ(part(i, j), whole(x + i, y + j)) << method << ": " << i << "," << j;
      const fs::path depth = folder / "out.depth.png";
      EXPECT_EQ(decode_png(FileBytes(depth.string()).bytes(), "depth").pixels.width(), w) << method;
    }
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace zoneplate::cli
