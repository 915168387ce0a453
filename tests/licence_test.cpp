// SPDX-License-Identifier: Apache-2.0
// Every source names its licence, as SPDX reads it, in its first line, or in the second one of a script.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace {

namespace fs = std::filesystem;

TEST(Licence, EverySourceNamesItInItsFirstLine) {
  const auto check = [](const fs::path& path) {
    const std::string name = path.filename();
    const auto ends_with = [&](const char* ending) { return name.ends_with(ending); };
    const bool is_cpp = ends_with(".h") || ends_with(".cpp") || ends_with(".h.in") || ends_with(".cpp.in");
    if (!is_cpp && !ends_with(".cmake") && !ends_with(".sh") && name != "CMakeLists.txt") return 0;
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    if (line.starts_with("#!")) std::getline(file, line);
    EXPECT_EQ(line, std::string(is_cpp ? "//" : "#") + " SPDX-License-Identifier: Apache-2.0") << path;
    return 1;
  };
  const fs::path root = ZONEPLATE_SOURCE_DIR;
  int files = check(root / "CMakeLists.txt");
  for (const char* folder : {"bench", "cmake", "examples", "fuzz", "include", "src", "tests"})
    if (fs::exists(root / folder))
      for (const auto& entry : fs::recursive_directory_iterator(root / folder)) files += check(entry.path());
  EXPECT_GT(files, 900);
}

}  // namespace
