// The folders of src/zoneplate are layers: a file includes its own folder and those listed before it in layers.txt.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

namespace {

namespace fs = std::filesystem;
const fs::path source = fs::path(ZONEPLATE_SOURCE_DIR) / "src/zoneplate";

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

TEST(Layers, NoIncludePointsUp) {
  const std::vector<std::string> layers = lines_of(source / "layers.txt");
  const auto height = [&](const std::string& folder) {
    return std::find(layers.begin(), layers.end(), folder) - layers.begin();
  };
  const std::string include = "#include \"zoneplate/";
  int includes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source)) {
    const std::string extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    const std::string folder = *fs::relative(entry.path(), source).begin();
    EXPECT_LT(height(folder), std::ssize(layers)) << entry.path() << ": layers.txt does not list its folder";
    for (const std::string& line : lines_of(entry.path())) {
      if (!line.starts_with(include)) continue;
      const std::size_t end = line.find('/', include.size());
      if (end == std::string::npos) continue;  // a header of no folder: version.h
      ++includes;
      EXPECT_LE(height(line.substr(include.size(), end - include.size())), height(folder))
          << entry.path() << ": " << line;
    }
  }
  EXPECT_GT(includes, 50);
}

}  // namespace
