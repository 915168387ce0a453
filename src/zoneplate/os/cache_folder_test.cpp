// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/cache_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

class Cached : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "zoneplate_cache_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    place = name;
    folder = place / "above" / "cache";
  }
  void TearDown() override { fs::remove_all(place); }

  static void write(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }
  static std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void store(const std::string& name, const std::string& text) const {
    if (const auto cache = CacheFolder::make(folder))
      cache->store(name, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  std::string read(const std::string& name, std::uint64_t limit = 100) const {
    const auto cache = CacheFolder::open(folder);
    const auto bytes = cache ? cache->read(name, limit) : std::nullopt;
    return bytes ? std::string(bytes->bytes().begin(), bytes->bytes().end()) : "(nothing)";
  }

  fs::path place, folder;
};

TEST_F(Cached, FilesAreStoredAndReadAgain) {
  EXPECT_EQ(read("a"), "(nothing)");
  store("a", "first");
  store("a", "second");
  EXPECT_EQ(read("a"), "second");
  EXPECT_EQ(read("a", 5), "(nothing)");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
  fs::permissions(folder / "a", fs::perms::none);
  EXPECT_TRUE(::geteuid() == 0 || read("a") == "(nothing)");
}

// What has the name of a file is neither followed nor waited for, and is itself replaced.
TEST_F(Cached, PipesLinksAndSocketsAreReplaced) {
  store("other", "x");
  write(place / "target", "mine");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0666), 0);
  fs::create_symlink(place / "target", folder / "link");
  fs::create_symlink(place / "missing", folder / "dangling");
  fs::create_symlink("/dev/zero", folder / "device");
  const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT((folder / "socket").string().size(), sizeof address.sun_path);
  (folder / "socket").string().copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  for (const char* name : {"pipe", "link", "dangling", "device", "socket"}) {
    EXPECT_EQ(read(name), "(nothing)") << name;
    store(name, "new");
    EXPECT_EQ(read(name), "new") << name;
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder / name))) << name;
  }
  ::close(listener);
  EXPECT_EQ(text_of(place / "target"), "mine");
  EXPECT_FALSE(fs::exists(place / "missing"));

  fs::create_directory(folder / "directory");
  store("directory", "new");
  EXPECT_EQ(read("directory"), "(nothing)");
  EXPECT_TRUE(fs::is_directory(folder / "directory"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 7);  // without temporary files
}

TEST_F(Cached, AFolderThatIsALinkIsNotUsedButOneBelowALinkIs) {
  fs::create_directories(place / "elsewhere");
  fs::create_symlink(place / "elsewhere", place / "above");
  store("a", "text");
  EXPECT_EQ(text_of(place / "elsewhere/cache/a"), "text");
  fs::remove_all(folder);
  fs::create_directories(place / "victim");
  write(place / "victim/a", "mine");
  fs::create_directory_symlink(place / "victim", folder);
  store("a", "text");
  EXPECT_EQ(read("a"), "(nothing)");
  EXPECT_EQ(text_of(place / "victim/a"), "mine");
}

TEST_F(Cached, FilesAndFoldersOfOthersAreNotUsed) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can make files of another user";
  store("a", "text");
  ASSERT_EQ(::chown((folder / "a").c_str(), 12345, 12345), 0);
  EXPECT_EQ(read("a"), "(nothing)");
  ASSERT_EQ(::chown(folder.c_str(), 12345, 12345), 0);
  EXPECT_FALSE(CacheFolder::open(folder).has_value());
}

TEST_F(Cached, TrimmingFollowsNoLinksAndRemovesOldTemporaries) {
  store("a.env", std::string(100, 'a'));
  store("b.env", std::string(100, 'b'));
  write(place / "target.env", std::string(1000, 't'));
  fs::create_symlink(place / "target.env", folder / "c.env");
  write(folder / ".d.env.1.tmp", "left");
  write(folder / ".e.env.2.tmp", "being written");
  const timespec old[2] = {{1000, 0}, {1000, 0}};
  for (const char* name : {"a.env", ".d.env.1.tmp"})
    ASSERT_EQ(::utimensat(AT_FDCWD, (folder / name).c_str(), old, 0), 0);
  CacheFolder::open(folder)->trim(".env", 150);
  EXPECT_FALSE(fs::exists(folder / "a.env"));
  EXPECT_TRUE(fs::exists(folder / "b.env"));
  EXPECT_TRUE(fs::exists(place / "target.env"));
  EXPECT_FALSE(fs::exists(folder / ".d.env.1.tmp"));
  EXPECT_TRUE(fs::exists(folder / ".e.env.2.tmp"));
}

}  // namespace
}  // namespace zoneplate
