// SPDX-License-Identifier: Apache-2.0
// Every source names its licence, as SPDX reads it, in its first line, or in the second one of a script.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "zoneplate/base/paths_for_test.h"

namespace {

namespace fs = std::filesystem;

TEST(Licence, EverySourceNamesItInItsFirstLine) {
  const auto check = [](const fs::path& path) {
    const std::string name = path.filename();
    const auto ends_with = [&](const char* ending) { return name.ends_with(ending); };
    const bool is_cpp =
        ends_with(".h") || ends_with(".cpp") || ends_with(".c") || ends_with(".h.in") || ends_with(".cpp.in");
    if (!is_cpp && !ends_with(".cmake") && !ends_with(".sh") && !ends_with(".py") && name != "CMakeLists.txt") return 0;
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    if (line.starts_with("#!")) std::getline(file, line);
    // REUSE-IgnoreStart
    EXPECT_EQ(line, std::string(is_cpp ? "//" : "#") + " SPDX-License-Identifier: Apache-2.0") << path;
    // REUSE-IgnoreEnd
    return 1;
  };
  const fs::path root = zoneplate::source_root;
  int files = check(root / "CMakeLists.txt");
  for (const char* folder : {"bench", "cmake", "examples", "fuzz", "include", "packaging", "python", "src", "tests"})
    if (fs::exists(root / folder))
      for (const auto& entry : fs::recursive_directory_iterator(root / folder)) files += check(entry.path());
  EXPECT_GT(files, 900);
}

// REUSE.toml: each file that it names exists, and LICENSES has the text of each licence and of no other.
TEST(Licence, EachLicenceHasItsText) {
  const fs::path root = zoneplate::source_root;
  std::ifstream stream(root / "REUSE.toml");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::set<std::string> named, present;
  const std::regex licences(R"re(SPDX-License-Identifier = "([^"]+)")re"), word(R"([A-Za-z][\w.-]+)"),
      path(R"re(path = "([^"*]+)[*]*")re");
  for (std::sregex_iterator i(text.begin(), text.end(), licences), end; i != end; ++i) {
    const std::string expression = (*i)[1];
    for (std::sregex_iterator k(expression.begin(), expression.end(), word); k != end; ++k)
      if (k->str() != "AND") named.insert(k->str() + ".txt");
  }
  for (const auto& entry : fs::directory_iterator(root / "LICENSES")) present.insert(entry.path().filename());
  EXPECT_EQ(named, present);
  EXPECT_GT(named.size(), 3u);
  for (std::sregex_iterator i(text.begin(), text.end(), path), end; i != end; ++i)
    EXPECT_TRUE(fs::exists(root / (*i)[1].str())) << (*i)[1];
}

}  // namespace
