// SPDX-License-Identifier: Apache-2.0
// Environments as the command reads, keeps and draws them.
#include <fcntl.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/os/cache_folder.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/program_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

class EnvironmentImages : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    LinearImage sky(64, 32);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 64; ++x) {
        const float light = x > 40 && x < 46 && y > 8 && y < 12 ? 20.0f : 0.1f + 0.01f * static_cast<float>(y);
        sky(x, y) = {light, light * 0.8f, 0.02f * static_cast<float>(x), 1};
      }
    save_bytes((place / "sky.exr").string(), encode_exr(64, 32, rgba_channels(sky), {}));
  }

  /// Renders with its own cache.
  ProgramAnswer render(const std::string& options) const {
    return ProgramTest::run("teapot --size 80x60 --quiet --hdri-file sky.exr " + options);
  }
  std::vector<fs::path> cached() const {
    std::vector<fs::path> files;
    if (fs::exists(place / "cache"))
      for (const auto& entry : fs::recursive_directory_iterator(place / "cache"))
        if (entry.is_regular_file()) files.push_back(entry.path());
    return files;
  }
};

/// The variable holds for the programs that the test starts.
class Cache {
 public:
  explicit Cache(const fs::path& folder) : before_(std::getenv("XDG_CACHE_HOME")) {
    if (before_) kept_ = before_;
    ::setenv("XDG_CACHE_HOME", folder.c_str(), 1);
  }
  ~Cache() { before_ ? ::setenv("XDG_CACHE_HOME", kept_.c_str(), 1) : ::unsetenv("XDG_CACHE_HOME"); }
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;

 private:
  const char* before_;
  std::string kept_;
};

TEST_F(EnvironmentImages, AreRemovedByTheTimeOfTheirLastReading) {
  const auto write = [&](const char* name, int seconds) {
    std::ofstream(place / name, std::ios::binary) << std::string(1000, 'x');
    const timespec times[2] = {{seconds, 0}, {1000, 0}};  // of reading and of writing
    ASSERT_EQ(::utimensat(AT_FDCWD, (place / name).c_str(), times, 0), 0);
  };
  write("a.env", 5000), write("b.env", 3000), write("c.env", 4000), write("d.png", 2000);
  const auto trim = [&](std::uint64_t most) { CacheFolder::open(place.string())->trim(".env", most); };
  trim(3000);
  EXPECT_TRUE(fs::exists(place / "b.env"));
  trim(2999);
  EXPECT_FALSE(fs::exists(place / "b.env"));
  trim(1999);
  EXPECT_FALSE(fs::exists(place / "c.env"));
  EXPECT_TRUE(fs::exists(place / "a.env"));
  EXPECT_TRUE(fs::exists(place / "d.png"));
}

TEST_F(EnvironmentImages, AreFilteredOnceAndKept) {
  const Cache cache(place / "cache");
  ASSERT_EQ(render("-o none.png --no-cache").code, 0);
  EXPECT_TRUE(cached().empty());
  ASSERT_EQ(render("-o a.png").code, 0);
  ASSERT_EQ(cached().size(), 1u);
  const std::string bytes = text_of(cached()[0]);
  ASSERT_EQ(render("-o b.png").code, 0);
  EXPECT_EQ(text_of(place / "a.png"), text_of(place / "none.png"));
  EXPECT_EQ(text_of(place / "b.png"), text_of(place / "none.png"));

  // A damaged file is made anew, a cut one too.
  for (const std::size_t size : {bytes.size(), bytes.size() / 2}) {
    std::string damaged = bytes.substr(0, size);
    damaged[size / 2] = static_cast<char>(damaged[size / 2] ^ 1);
    std::ofstream(cached()[0], std::ios::binary) << damaged;
    ASSERT_EQ(render("-o c.png").code, 0);
    EXPECT_EQ(text_of(place / "c.png"), text_of(place / "none.png"));
    EXPECT_EQ(text_of(cached()[0]), bytes);
  }

  // Processes that race for it leave one whole file.
  fs::remove_all(place / "cache");
  std::string all = "cd '" + place.string() + "'";
  for (const char* name : {"r1.png", "r2.png", "r3.png"})
    all += std::string(name[1] == '1' ? " && {" : " &") + " '" + std::string(program_file) +
           "' teapot --size 80x60 --quiet --hdri-file sky.exr -o " + name;
  ASSERT_EQ(std::system((all + " & wait; }").c_str()), 0);
  for (const char* name : {"r1.png", "r2.png", "r3.png"})
    EXPECT_EQ(text_of(place / name), text_of(place / "none.png")) << name;
  ASSERT_EQ(cached().size(), 1u);
  EXPECT_EQ(text_of(cached()[0]), bytes);

  // A cache that cannot be written does not matter.
  const Cache blocked("/dev/null");
  ASSERT_EQ(render("-o d.png").code, 0);
  EXPECT_EQ(text_of(place / "d.png"), text_of(place / "none.png"));
}

// The verbs beside render keep them too: the studio, which a data set and a sheet prepare once, and an image.
TEST_F(EnvironmentImages, AreKeptByEveryVerbThatRenders) {
  const Cache cache(place / "cache");
  const auto run_with = [&](const std::string& words) { EXPECT_EQ(ProgramTest::run(words).code, 0) << words; };
  const std::string sheet = "contact-sheet teapot -o a.png --size 40x30 --quiet ";
  run_with(sheet + "--no-cache");
  EXPECT_TRUE(cached().empty());
  run_with("dataset teapot --layout npy -o data --sequences 1 --frames 2 --size 32x24 --reference none");
  EXPECT_EQ(cached().size(), 1u);
  run_with(sheet);
  EXPECT_EQ(cached().size(), 1u);
  run_with(sheet + "--hdri-file sky.exr");
  EXPECT_EQ(cached().size(), 2u);
}

// Whatever has the name of a file of the cache, or of the cache, the image is the same at once, and no other file is
// written.
TEST_F(EnvironmentImages, NothingInTheCacheIsFollowedOrWaitedFor) {
  const Cache cache(place / "cache");
  const auto expect_same_image = [&] {
    fs::remove(place / "b.png");
    ASSERT_EQ(ProgramTest::run("teapot --size 80x60 --quiet --hdri-file sky.exr -o b.png", "timeout 60").code, 0);
    EXPECT_EQ(text_of(place / "b.png"), text_of(place / "a.png"));
  };
  ASSERT_EQ(render("-o a.png").code, 0);
  ASSERT_EQ(cached().size(), 1u);
  const fs::path entry = cached()[0];
  const std::string bytes = text_of(entry);
  std::ofstream(place / "mine") << "mine";

  fs::remove(entry);
  ASSERT_EQ(::mkfifo(entry.c_str(), 0666), 0);
  expect_same_image();
  EXPECT_EQ(text_of(entry), bytes);
  fs::remove(entry);
  fs::create_symlink(place / "mine", entry);
  expect_same_image();
  EXPECT_EQ(text_of(entry), bytes);
  EXPECT_FALSE(fs::is_symlink(entry));
  fs::remove(entry);
  fs::create_directory(entry);
  expect_same_image();
  EXPECT_TRUE(fs::is_empty(entry));

  fs::remove_all(place / "cache/zoneplate");
  fs::create_directory(place / "victim");
  fs::create_directory_symlink(place / "victim", place / "cache/zoneplate");
  expect_same_image();
  EXPECT_TRUE(fs::is_empty(place / "victim"));
  EXPECT_EQ(text_of(place / "mine"), "mine");
}

TEST_F(EnvironmentImages, StandBehindTheSceneInCropsToo) {
  const Cache cache(place / "cache");
  const auto picture = [&](const std::string& options) {
    const ProgramAnswer answer = render("--background environment -o p.png " + options);
    EXPECT_EQ(answer.code, 0) << answer.out;
    const std::string bytes = text_of(place / "p.png");
    return decode_png({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "p.png").pixels;
  };
  for (const std::string method : {"msaa:n=4", "ssaa:n=2,mix=codes", "smaa", "adaptive"}) {
    const Rgba8Image whole = picture("--aa " + method), part = picture("--aa " + method + " --crop 13,7,40,33");
    ASSERT_EQ(part.width(), 40);
    for (int y = 0; y < 33; ++y)
      for (int x = 0; x < 40; ++x) ASSERT_EQ(part(x, y), whole(x + 13, y + 7)) << method << ' ' << x << ' ' << y;
    // The corners show the sky, not the usual grey.
    EXPECT_NE(whole(0, 0), whole(79, 0)) << method;
    EXPECT_EQ(whole(0, 0).a, 255);
  }
  const Rgba8Image sharp = picture(""), blurred = picture("--background-blur 1");
  EXPECT_NE(sharp, blurred);
}

TEST_F(EnvironmentImages, NameWhatIsWrong) {
  const auto complaint = [&](const std::string& options) {
    const ProgramAnswer answer = ProgramTest::run("teapot -o x.png --size 20x20 --no-cache " + options);
    return std::to_string(answer.code) + " " + answer.out;
  };
  EXPECT_TRUE(contains(complaint("--hdri-file none.hdr"), "3 zoneplate: error: none.hdr"));
  save_bytes((place / "bad.hdr").string(), std::vector<std::uint8_t>(100, 7));
  EXPECT_TRUE(contains(complaint("--hdri-file bad.hdr"), "3 zoneplate: error: bad.hdr: is no known image"));
  EXPECT_TRUE(contains(complaint("--hdri-rotation 5"), "2 zoneplate: error: --hdri-rotation"));
  EXPECT_TRUE(contains(complaint("--hdri-file sky.exr --environment red"), "2 zoneplate: error: --environment"));
  EXPECT_TRUE(contains(complaint("--background-blur 0.5"), "2 zoneplate: error: --background-blur requires"));
  EXPECT_TRUE(contains(complaint("--hdri-file sky.exr --background environment --no-background"),
                       "2 zoneplate: error: --back"));
  EXPECT_TRUE(contains(complaint("--hdri-file 'sky_{face}.png'"), "3 zoneplate: error: sky_px.png"));
}

TEST_F(EnvironmentImages, FidelityComparesWithOtherRenderers) {
  std::ofstream(place / "one.stl") << "solid one\nfacet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 -1 0\n"
                                      "vertex 0 1 0\nendloop\nendfacet\nendsolid\n";
  std::ofstream(place / "scenarios.json")
      << R"([{"name": "one", "model": "one.stl", "environment": "sky.exr", "orbit": {"theta": 20, "phi": 80, "radius": 4},
             "target": {"x": 0, "y": 0, "z": 0}, "verticalFoV": 45, "renderSkybox": false}])";
  fs::create_directories(place / "images/one");
  const Rgba8Image blank(48, 32, {0, 0, 0, 255});
  save_bytes((place / "images/one/filament.png").string(), encode_png(blank, {.has_alpha = true}));
  const ProgramAnswer differs = ProgramTest::run("fidelity scenarios.json -o made");
  EXPECT_EQ(differs.code, 1) << differs.out;
  EXPECT_TRUE(contains(differs.out, "1 of 1 scenarios miss their bounds")) << differs.out;
  fs::copy_file(place / "made/one.png", place / "images/one/filament.png", fs::copy_options::overwrite_existing);
  const ProgramAnswer same = ProgramTest::run("fidelity scenarios.json -o made");
  EXPECT_EQ(same.code, 0) << same.out;
  EXPECT_TRUE(contains(same.out, "pass")) << same.out;
}

}  // namespace
}  // namespace zoneplate
