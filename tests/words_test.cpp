// SPDX-License-Identifier: Apache-2.0
// The vocabulary of CONVENTIONS.md: identifiers that were replaced by the field's terms do not come back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <string_view>

#include "zoneplate/base/paths_for_test.h"

namespace {

namespace fs = std::filesystem;
const fs::path root = zoneplate::source_root;

/// Identifiers that no source may contain as whole words.
const std::set<std::string_view> retired = {
    "PointShader",     "PointBatcher",   "PointRow",        "PointList",       "PointListKernels",
    "PointData",       "told_group",     "after_run",       "one_triangle",    "repeats_slopes",
    "wants_slopes",    "most_lanes",     "SampleFragments", "FragmentSink",    "TileFragments",
    "FrontKernels",    "FrontResult",    "FrontRun",        "block_far",       "open_block",
    "block_owner",     "many_triangles", "RowLayer",        "Layers8",         "put_under",
    "VertexRecords",   "Surroundings",   "LevelPlace",      "Trouble",         "find_flaw",
    "Presenter",       "LostBytesWatch", "ShownLight",      "works_on_shown",  "is_local",
    "ask_again",       "ObjFolder",      "filter_codes",    "CodeFilter",      "SampleGather",
    "Gathering",       "gathering_of",   "GatherKernels",   "SmaaWeigher",     "smaa_edges",
    "SinCos",          "SpecParam",      "BuiltinParam",    "shown_value",     "display_shown_light",
    "PointsArray",     "RecordsByPoint", "SpecularShare",   "WrappedPoint",    "GeometryPoints",
    "ShaderPoints",    "ScenePoints",    "ShadedPlaces",    "UsualFiltering",  "AnyIllumination",
    "RasterRoom",      "find_corners",   "make_placements", "place_positions", "place_normals",
    "place_tangents",  "place_levels",   "put_planes",      "put_triangle",    "know_clipped",
    "brightest_point", "ambient_share",  "codes15",         "mean_place",      "lists_kept",
    "ask_for",         "ask_for_index",  "is_asked",        "is_asked_for",    "is_wanted",
    "is_presented",    "wants_data",     "wants_json",      "wants_sandbox",   "want_coordinates",
    "ms_by_stage",     "show_gathered"};

/// What no identifier may begin with: min_, max_ and default_ are the words. A report of `texture` has a "least_z".
constexpr std::string_view retired_prefixes[] = {"most_", "least_", "greatest_", "usual_"};

/// Phrases that no comment, string or document may contain: each personifies data or omits its noun.
constexpr const char* retired_phrases =
    "told|tells?|asked for|wants?|nobody|[Ww]hat is (shown|seen|said|asked|drawn)|the truth|last word|"
    "points? shaded|shaded points?|in its own way|so many of them|as it came";

/// The comments and the strings of a line of C++; a line of a document as it is.
std::string prose_of(const std::string& line, bool is_source) {
  if (!is_source) return line;
  if (line.starts_with("#include")) return {};
  std::string prose;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line.compare(at, 2, "//") == 0) return prose + line.substr(at);
    if (line[at] == '\'' && at + 2 < line.size()) {  // a character; a digit separator has no quote two or three ahead
      if (line[at + 1] == '\\' && line.size() > at + 3 && line[at + 3] == '\'')
        at += 3;
      else if (line[at + 2] == '\'')
        at += 2;
    } else if (line[at] == '"') {
      const std::size_t first = ++at;
      while (at < line.size() && line[at] != '"') at += line[at] == '\\' ? 2 : 1;
      prose += line.substr(first, at - first) + ' ';
    }
  }
  return prose;
}

TEST(Words, RetiredIdentifiersDoNotComeBack) {
  const auto is_word_character = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  int files = 0;
  for (const char* folder : {"include", "src", "tests", "bench", "fuzz", "docs"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension();
      if ((extension != ".h" && extension != ".cpp" && extension != ".md") || entry.path().stem() == "words_test")
        continue;
      ++files;
      std::ifstream stream(entry.path());
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      for (auto end = text.begin(), begin = end;;) {
        begin = std::find_if(end, text.end(), is_word_character);
        if (begin == text.end()) break;
        end = std::find_if_not(begin, text.end(), is_word_character);
        const std::string_view word(begin, end);
        EXPECT_FALSE(retired.contains(word)) << entry.path() << ": " << word;
        for (const std::string_view prefix : retired_prefixes)
          EXPECT_FALSE(word.starts_with(prefix) && word != "least_z") << entry.path() << ": " << word;
      }
    }
  }
  EXPECT_GT(files, 700);
}

// `find` is for what may return nothing; what fills in a value computes, evaluates, fetches or collects.
TEST(Words, FunctionsWithoutAResultDoNotFind) {
  const std::regex declaration("\\bvoid (\\w+::)*find_\\w+\\(");
  int files = 0;
  for (const char* folder : {"include", "src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      ++files;
      std::ifstream stream(entry.path());
      for (std::string line; std::getline(stream, line);) {
        const bool finds = line.find("find_") != std::string::npos && std::regex_search(line, declaration);
        EXPECT_FALSE(finds) << entry.path() << ": " << line;
      }
    }
  }
  EXPECT_GT(files, 600);
}

TEST(Words, RetiredPhrasesAreNotInComments) {
  const std::regex phrase(std::string("\\b(") + retired_phrases + ")\\b");
  int files = 0;
  const auto check = [&](const fs::path& path) {
    const std::string extension = path.extension();
    const bool is_source = extension == ".h" || extension == ".cpp";
    if (!is_source && extension != ".md") return;
    ++files;
    std::ifstream stream(path);
    std::string line;
    std::smatch match;
    for (int number = 1; std::getline(stream, line); ++number) {
      const std::string prose = prose_of(line, is_source);
      EXPECT_FALSE(std::regex_search(prose, match, phrase))
          << path.string() << ':' << number << ": " << match.str() << '\n'
          << line;
    }
  };
  for (const char* folder : {"include", "src", "examples", "docs"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) check(entry.path());
  for (const char* document : {"README.md", "CONTRIBUTING.md"}) check(root / document);
  EXPECT_GT(files, 600);
}

}  // namespace
