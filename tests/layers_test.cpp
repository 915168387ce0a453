// SPDX-License-Identifier: Apache-2.0
// The structure of the source tree: which room may include which, how many files a folder holds, and one meaning for
// each type name. src/zoneplate/layers.txt lists the rooms from the bottom up. A room's public headers are in
// include/zoneplate, everything else of it in src/zoneplate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/paths_for_test.h"

namespace {

namespace fs = std::filesystem;
const fs::path source = fs::path(zoneplate::source_root) / "src/zoneplate";
const fs::path public_headers = fs::path(zoneplate::source_root) / "include/zoneplate";
constexpr std::size_t max_files_per_folder = 40;

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> rooms() {
  std::vector<std::string> out;
  for (const std::string& line : lines_of(source / "layers.txt"))
    if (!line.empty() && line[0] != '#' && line[0] != '!') out.push_back(line);
  return out;
}

/// Whether a folder is a room or in one.
bool is_within(const std::string& folder, const std::string& room) {
  return folder == room || folder.starts_with(room + '/');
}

/// The lines `! room: ...` of layers.txt: rooms of which a room includes nothing itself.
std::map<std::string, std::vector<std::string>> forbidden_rooms() {
  std::map<std::string, std::vector<std::string>> out;
  for (const std::string& line : lines_of(source / "layers.txt")) {
    if (!line.starts_with("! ")) continue;
    const std::size_t colon = line.find(':');
    std::stringstream words(line.substr(colon + 1));
    std::vector<std::string>& of_room = out[line.substr(2, colon - 2)];
    for (std::string word; words >> word;) of_room.push_back(word);
  }
  return out;
}

/// The headers and sources below a folder, as paths relative to it.
std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (extension == ".h" || extension == ".cpp") out.push_back(fs::relative(entry.path(), folder));
  }
  return out;
}

bool is_public(const fs::path& file) { return fs::exists(public_headers / file); }

/// The full path of a file that is given by its room and name.
fs::path path_of(const fs::path& file) { return (is_public(file) ? public_headers : source) / file; }

/// All headers and sources by their rooms and names, sorted.
std::vector<fs::path> source_files() {
  std::vector<fs::path> out = files_of(source);
  const std::vector<fs::path> headers = files_of(public_headers);
  out.insert(out.end(), headers.begin(), headers.end());
  std::sort(out.begin(), out.end());
  return out;
}

bool is_test(const fs::path& file) {
  return file.stem().string().ends_with("_test") || file.stem().string().ends_with("_for_test");
}

std::string layer_of(const std::string& room) { return room.substr(0, room.find('/')); }

/// The headers that a file includes from this project, by their rooms and names.
std::vector<std::string> includes_of(const fs::path& file) {
  const std::string include = "#include \"zoneplate/";
  std::vector<std::string> out;
  for (const std::string& line : lines_of(path_of(file)))
    if (line.starts_with(include)) out.push_back(line.substr(include.size(), line.rfind('"') - include.size()));
  return out;
}

/// The end of the comment, literal or preprocessor line that begins at a character of C++; `at` if none begins there.
std::size_t end_of_noise(const std::string& text, std::size_t at) {
  const auto after = [&](std::string_view end, std::size_t from) {
    const std::size_t found = text.find(end, from);
    return found == std::string::npos ? text.size() : found + end.size();
  };
  const char before = at > 0 ? text[at - 1] : '\n';
  if (text.compare(at, 2, "//") == 0) return std::min(text.find('\n', at), text.size());
  if (text.compare(at, 2, "/*") == 0) return after("*/", at + 2);
  if (text[at] == '#' && before == '\n') {
    std::size_t end = at;
    do end = after("\n", end);
    while (end >= 2 && end < text.size() && text[end - 2] == '\\');
    return end;
  }
  if (text[at] == '"' && before == 'R') return after(")" + text.substr(at + 1, text.find('(', at) - at - 1) + "\"", at);
  const bool is_digit_separator = text[at] == '\'' && std::isxdigit(static_cast<unsigned char>(before));
  if ((text[at] != '"' && text[at] != '\'') || is_digit_separator) return at;
  std::size_t end = at + 1;
  while (end < text.size() && text[end] != text[at]) end += text[end] == '\\' ? 2 : 1;
  return std::min(end + 1, text.size());
}

/// Removes comments, literals and preprocessor lines.
std::string code_of(const fs::path& file) {
  std::ifstream stream(path_of(file));
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::string code;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = end_of_noise(text, at);
    code += end == at ? text[at++] : ' ';
    at = std::max(at, end);
  }
  return code;
}

// A test may also include the rooms above its own within the same layer, since readers are tested by their files.
TEST(Layers, NoIncludePointsUp) {
  const std::vector<std::string> order = rooms();
  const auto height = [&](const std::string& room) {
    return std::find(order.begin(), order.end(), room) - order.begin();
  };
  int includes = 0;
  for (const fs::path& file : source_files()) {
    const std::string room = file.parent_path();
    if (room.empty()) continue;  // zoneplate.h, the interface for C, and all.h are of no room
    EXPECT_LT(height(room), std::ssize(order)) << file << ": layers.txt does not list its folder";
    for (const std::string& header : includes_of(file)) {
      const std::string included = fs::path(header).parent_path();
      if (included.empty()) continue;  // a header of no room: version.h, zoneplate.h
      ++includes;
      if (is_test(file) && layer_of(included) == layer_of(room)) continue;
      EXPECT_LE(height(included), height(room)) << file << " includes " << header;
    }
  }
  EXPECT_GT(includes, 2000);
}

TEST(Layers, NoIncludeIsForbidden) {
  const auto forbidden = forbidden_rooms();
  EXPECT_TRUE(forbidden.contains("cli"));
  const std::vector<std::string> order = rooms();
  int files = 0;
  for (const auto& [room, others] : forbidden)
    for (const std::string& other : others) {
      EXPECT_GT(std::ranges::count_if(order, [&](auto& listed) { return is_within(listed, other); }), 0) << other;
      for (const fs::path& file : source_files()) {
        if (is_test(file) || !is_within(file.parent_path(), room)) continue;
        ++files;
        for (const std::string& header : includes_of(file))
          EXPECT_FALSE(is_within(fs::path(header).parent_path(), other)) << file << " includes " << header;
      }
    }
  EXPECT_GT(files, 100);
}

TEST(Layers, PublicHeadersIncludePublicHeadersAlone) {
  const std::vector<fs::path> headers = files_of(public_headers);
  EXPECT_LE(headers.size(), 65u);
  for (const fs::path& file : headers) {
    EXPECT_FALSE(fs::exists(source / file)) << file << " exists twice";
    for (const std::string& header : includes_of(file))
      EXPECT_TRUE(is_public(header)) << file << " includes " << header;
  }
}

TEST(Layers, AllHeaderIncludesEveryPublicHeader) {
  const std::vector<std::string> included = includes_of("all.h");
  for (const fs::path& file : files_of(public_headers))
    EXPECT_EQ(std::count(included.begin(), included.end(), file.string()),
              file == "all.h" || file == "zoneplate.h" ? 0 : 1)
        << file;
}

// What a job leaves to the scene is decided in one place, which every caller uses.
TEST(Layers, OnlyResolveKnowsDefaultsThatDependOnTheScene) {
  const std::set<std::string> owners = {"job/resolve.cpp", "scene/default_options.h", "scene/default_options.cpp",
                                        "render/metering/metering.h", "render/metering/metering.cpp"};
  int uses = 0;
  for (const fs::path& file : source_files()) {
    if (is_test(file)) continue;
    const std::string code = code_of(file);
    for (const char* name : {"default_point_size", "default_anisotropy", "dimming_of"}) {
      const bool is_used = code.find(name) != code.npos &&  // regular expressions are slow
                           std::regex_search(code, std::regex(std::string("\\b") + name + "\\b"));
      EXPECT_TRUE(!is_used || owners.contains(file)) << file << ": " << name << " is for job/resolve.cpp";
      uses += is_used;
    }
  }
  EXPECT_GE(uses, 6);
}

// cmake/fmt.cpp defines what static programs need of {fmt}, which is what format.h uses of its library.
TEST(Layers, OnlyTheFormatHeaderOfFmtIsIncluded) {
  for (const fs::path& file : source_files())
    for (const std::string& line : lines_of(path_of(file)))
      EXPECT_TRUE(!line.starts_with("#include <fmt/") || line == "#include <fmt/format.h>") << file << ": " << line;
}

// A static program contains an unwinder of its own. An exception that passes through std::call_once meets the frame of
// the C library's pthread_once, whose personality routine is that of the shared libgcc_s: the program is aborted. A
// static variable of a function, or MadeOnce (base/made_once.h), makes a value once without such a frame.
TEST(Layers, NoExceptionCanPassThroughCallOnce) {
  int files = 0;
  for (const fs::path& file : source_files()) {
    const std::string code = code_of(file);
    for (const char* name : {"call_once", "once_flag", "pthread_once"})
      EXPECT_EQ(code.find(name), std::string::npos) << file << ": " << name << " aborts the program if it throws";
    ++files;
  }
  EXPECT_GT(files, 700);
}

// tests/bit_tests.txt has the tests that other processors run.
TEST(Layers, TestsOfInstructionSetsRunOnOtherProcessors) {
  std::set<std::string> listed;
  for (const std::string& line : lines_of(source / "../../tests/bit_tests.txt")) {
    if (line.starts_with('#')) continue;
    EXPECT_TRUE(listed.insert(line.substr(line.starts_with("- ") ? 2 : 0)).second) << line;
  }
  for (const std::string& test : listed)
    EXPECT_TRUE(fs::exists(source / "../.." / test)) << test << " is listed and does not exist";
  const std::vector<std::string> order = rooms();
  const auto core_end = std::find(order.begin(), order.end(), "os");
  int tests = 0;
  for (const fs::path& file : source_files()) {
    const bool is_core = std::find(order.begin(), core_end, file.parent_path()) != core_end;
    if (!is_core || !file.stem().string().ends_with("_test")) continue;
    if (code_of(file).find("supported_isas") == std::string::npos) continue;
    ++tests;
    EXPECT_TRUE(listed.contains("src/zoneplate/" + file.string())) << file << ": tests/bit_tests.txt does not list it";
  }
  EXPECT_GT(tests, 20);
}

TEST(Layers, NoFolderIsCrowded) {
  std::map<fs::path, std::size_t> files;
  for (const auto& entry : fs::recursive_directory_iterator(source))
    if (entry.is_regular_file()) ++files[entry.path().parent_path()];
  for (const auto& [folder, count] : files)
    EXPECT_LE(count, max_files_per_folder) << folder << ": divide this folder into rooms";
  for (const std::string& room : rooms()) EXPECT_TRUE(files.contains(source / room)) << room << " is listed and empty";
}

/// The qualified names of the classes, structures and enumerations that a file defines outside functions and unnamed
/// namespaces.
std::vector<std::string> types_of(const fs::path& file) {
  const std::string code = code_of(file);
  static const std::regex opening(
      R"(namespace\s*([\w:]*)\s*\{|(?:class|struct|enum(?:\s+class)?)\s+(?:alignas\([^)]*\)\s*)?(\w+(?:::\w+)*)(?:\s+final)?\s*(?::[^;{(]*)?\{)");
  const auto is_of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  std::vector<std::string> scopes, out;  // a scope that defines nothing is "(body)"
  for (auto at = code.begin(); at != code.end(); ++at) {
    if (*at == '}' && !scopes.empty()) scopes.pop_back();
    if (*at == '{') scopes.push_back("(body)");
    // The expression is tried only where a keyword may begin.
    if (std::string_view("nsce").find(*at) == std::string_view::npos || (at != code.begin() && is_of_word(at[-1])))
      continue;
    std::smatch found;
    if (!std::regex_search(at, code.end(), found, opening, std::regex_constants::match_continuous)) continue;
    at = found[0].second - 1;
    if (!found[2].matched) {
      scopes.push_back(found[1].length() == 0 ? "(unnamed)" : found[1].str());
      continue;
    }
    std::string name;
    bool is_shared = true;
    for (const std::string& scope : scopes) name += scope + "::", is_shared &= scope[0] != '(';
    scopes.push_back(found[2]);
    if (is_shared) out.push_back(name + found[2].str());
  }
  EXPECT_TRUE(scopes.empty()) << file << ": braces that do not match";
  return out;
}

// Two definitions of one qualified name in one program are undefined behaviour that no compiler reports.
TEST(Layers, EachTypeNameIsDefinedOnce) {
  std::map<std::string, std::set<fs::path>> files;
  for (const fs::path& file : source_files())
    for (const std::string& type : types_of(file)) files[type].insert(file);
  EXPECT_GT(files.size(), 300u);
  for (const auto& [type, where] : files) {
    std::string list;
    for (const fs::path& file : where) list += " " + file.string();
    EXPECT_EQ(where.size(), 1u) << type << " is defined in" << list;
  }
}

// A table of kernels is `foo.h`; `foo.cpp` defines its scalar member and `foo_simd.cpp` those of the instruction sets.
// A kernel written once for both is a template in a `*_lanes.h`, which knows no vectors but its lane type.
TEST(Layers, KernelsHaveOneLayout) {
  const auto read = [](const fs::path& file) {
    std::ifstream stream(source / file);
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  static const std::regex table(R"(struct (\w+) : PerIsa<\1>)");
  int tables = 0;
  for (const fs::path& file : source_files()) {
    const std::string stem = file.stem(), text = read(file);
    EXPECT_FALSE(stem.ends_with("_kernels") || stem.ends_with("_stages")) << file << ": name what the kernels do";
    EXPECT_TRUE(!stem.ends_with("_lanes") || text.find("hwy") == std::string::npos) << file;
    std::smatch found;
    if (is_test(file) || !std::regex_search(text, found, table)) continue;
    ++tables;
    EXPECT_EQ(file.extension(), ".h") << file;
    const auto defines = [&](const char* suffix, const std::string& member) {
      const std::regex definition("PerIsa<(\\w+::)?" + found[1].str() + ">::" + member + " =");
      const fs::path other = file.parent_path() / (stem + suffix);
      EXPECT_TRUE(std::regex_search(read(other), definition))
          << other << " does not define " << member << " of " << file;
    };
    defines(".cpp", "scalar");
    defines("_simd.cpp", "HWY_NAMESPACE");
  }
  EXPECT_GT(tables, 20);
}

}  // namespace
