// The vocabulary of CONVENTIONS.md: identifiers that were replaced by the field's terms do not come back.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace {

namespace fs = std::filesystem;
const fs::path root = ZONEPLATE_SOURCE_DIR;

/// Identifiers that no source may contain as whole words.
constexpr const char* retired =
    "PointShader|PointBatcher|PointRow|PointList|PointListKernels|PointData|told_group|after_run|one_triangle|"
    "repeats_slopes|wants_slopes|most_lanes|SampleFragments|FragmentSink|TileFragments|FrontKernels|FrontResult|"
    "FrontRun|"
    "block_far|open_block|block_owner|many_triangles|RowLayer|Layers8|put_under|VertexRecords|"
    "Surroundings|"
    "LevelPlace|Trouble|find_flaw|Presenter|LostBytesWatch|ShownLight|works_on_shown|is_local|ask_again|"
    "ObjFolder|filter_codes|CodeFilter|SampleGather|Gathering|gathering_of|GatherKernels|SmaaWeigher|smaa_edges|"
    "SinCos|SpecParam|BuiltinParam|shown_value|display_shown_light";

TEST(Words, RetiredIdentifiersDoNotComeBack) {
  const std::regex word(std::string("\\b(") + retired + ")\\b");
  int files = 0;
  for (const char* folder : {"include", "src", "tests", "bench", "fuzz", "docs"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension();
      if ((extension != ".h" && extension != ".cpp" && extension != ".md") || entry.path().stem() == "words_test")
        continue;
      ++files;
      std::ifstream stream(entry.path());
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      std::smatch match;
      EXPECT_FALSE(std::regex_search(text, match, word)) << entry.path() << ": " << match.str();
    }
  }
  EXPECT_GT(files, 700);
}

}  // namespace
