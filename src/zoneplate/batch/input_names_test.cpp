// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/input_names.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

/// As another user than root, who may read every folder.
class AsNobody {
 public:
  AsNobody() {
    if (::geteuid() == 0) is_changed_ = ::seteuid(65534) == 0;
  }
  ~AsNobody() {
    if (is_changed_) static_cast<void>(::seteuid(0));
  }

 private:
  bool is_changed_ = false;
};

TEST(InputNames, AFolderThatCannotBeReadIsLeftOutWithAWarning) {
  std::string name = (fs::temp_directory_path() / "zoneplate_inputs_XXXXXX").string();
  ASSERT_NE(::mkdtemp(name.data()), nullptr);
  const fs::path place = name;
  fs::permissions(place, fs::perms::all);
  for (const char* folder : {"a", "b", "c/d"}) {
    fs::create_directories(place / folder);
    std::ofstream(place / folder / "x.obj") << "v 0 0 0\n";
  }
  std::ofstream(place / "c/note.txt") << "none";
  fs::create_symlink("nowhere.obj", place / "c/lost.obj");
  fs::create_symlink("..", place / "c/up");
  fs::permissions(place / "b", fs::perms::none);
  {
    const AsNobody nobody;
    std::vector<std::string> warnings;
    const auto warn = [&](const std::string& warning) { warnings.push_back(warning); };
    const std::vector<std::string> found = with_folders_listed({"teapot", name}, warn);
    EXPECT_EQ(found,
              (std::vector<std::string>{"teapot", name + "/a/x.obj", name + "/c/d/x.obj", name + "/c/lost.obj"}));
    EXPECT_EQ(warnings, std::vector{name + "/b: Permission denied; its models are left out"});
    EXPECT_THROW(with_folders_listed({name + "/b"}, warn), Error);
  }
  fs::permissions(place / "b", fs::perms::all);
  fs::remove_all(place);
}

}  // namespace
}  // namespace zoneplate
