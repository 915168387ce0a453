// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/load.h"

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/gltf/maker_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

GltfMaker triangle(const std::string& more = "") {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}), more);
  return m;
}

/// How often all processes together open a file from the construction on.
class Openings {
 public:
  // The system joins equal events in a row: the end of each opening is between them.
  explicit Openings(const std::string& path) : queue_(inotify_init1(IN_NONBLOCK)) {
    EXPECT_GE(inotify_add_watch(queue_, path.c_str(), IN_OPEN | IN_CLOSE), 0);
  }
  ~Openings() { close(queue_); }
  Openings(const Openings&) = delete;
  Openings& operator=(const Openings&) = delete;

  /// Those since the last call.
  int count() const {
    std::array<inotify_event, 64> events{};  // without names, as a file is watched and not a folder
    const ssize_t size = std::max<ssize_t>(read(queue_, events.data(), sizeof events), 0);
    return static_cast<int>(std::count_if(events.begin(), events.begin() + size / ssize_t{sizeof(inotify_event)},
                                          [](const inotify_event& e) { return e.mask == IN_OPEN; }));
  }

 private:
  int queue_;
};

/// The working directory is that of the test's files.
class InFolder : public testing::Test {
 protected:
  InFolder() { fs::current_path(fs::path(folder.path("x")).parent_path()); }
  ~InFolder() override { fs::current_path(before_); }

 private:
  fs::path before_ = fs::current_path();

 protected:
  TestFolder folder;
};

// A version in the asset's extras is not the version of the file: our reader alone has scenes to choose from.
TEST(Load, GltfIsKnownByItsOwnVersion) {
  const TestFolder folder;
  std::string json = triangle().json(R"(,"uri":"b.bin")");
  const std::string asset = R"("asset":{)";
  json.insert(json.find(asset) + asset.size(), R"("extras":{"version":"1.3"},)");
  folder.write("b.bin", triangle().binary);
  const std::string path = folder.write("extras.gltf", json);
  for (const bool is_sandboxed : {false, true}) {
    LoadOptions options{.is_sandboxed = is_sandboxed};
    options.choice.scene = 0;
    EXPECT_EQ(load_scene(path, options).instances.size(), 1u);
  }
}

// The process that asks for a sandboxed file does not open it, and no process reads a file of a known ending twice.
TEST(Load, OpensAFileOnce) {
  const TestFolder folder;
  const std::string path = folder.write("a.glb", triangle().glb());
  for (const bool is_sandboxed : {false, true}) {
    const Openings openings(path);
    load_scene(path, {.is_sandboxed = is_sandboxed});
    EXPECT_EQ(openings.count(), 1) << is_sandboxed;
  }
  const Openings openings(path);
  SceneSource source(path, {.is_sandboxed = true});
  EXPECT_EQ(openings.count(), 0);
  source.load({});
  EXPECT_EQ(openings.count(), 1);
}

// The first reader of a stream has consumed it.
TEST(Load, RefusesGltf1OfAStream) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const std::string json = R"({"asset":{"version":"1.0"}})";
  ASSERT_EQ(write(ends[1], json.data(), json.size()), static_cast<ssize_t>(json.size()));
  close(ends[1]);
  try {
    load_scene("/dev/fd/" + std::to_string(ends[0]), {.format = "gltf"});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("asset: version is '1.0', expected 2.0"), std::string::npos)
        << error.what();
  }
  close(ends[0]);
}

TEST_F(InFolder, ABuiltInSceneComesBeforeAFileOfItsName) {
  folder.write("teapot", triangle().glb());
  const std::size_t corners = load_scene("teapot").meshes.at(0).index.size();
  EXPECT_GT(corners, 3u);
  for (const bool is_sandboxed : {false, true}) {
    SceneSource source("teapot", {.is_sandboxed = is_sandboxed});
    EXPECT_EQ(source.load({}).meshes.at(0).index.size(), corners);
    EXPECT_EQ(source.load_shape({}).meshes.at(0).index.size(), corners);
  }
  SceneSource file("./teapot", {});
  EXPECT_EQ(file.load({}).meshes.at(0).index.size(), 3u);
  SceneSource by_format("teapot", {.format = "glb"});
  EXPECT_EQ(by_format.load({}).meshes.at(0).index.size(), 3u);
}

}  // namespace
}  // namespace zoneplate
