// SPDX-License-Identifier: Apache-2.0
// Each option of each verb beside render acts, or is refused (tests/options). Runs the built program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "option_rows_for_test.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/os/program_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

/// An option of tests/options/verb_rows.txt.
struct VerbRow {
  OptionText option;
  std::string arguments = {};  ///< in place of the verb's; empty: those
  bool acts = true;
};

/// A verb with its arguments, and the rows below it.
struct VerbRows {
  std::string verb, arguments;
  std::vector<VerbRow> rows = {};
};

VerbRow verb_row(std::string line) {
  VerbRow row;
  if (line.ends_with(" =")) row.acts = false, line.resize(line.size() - 2);
  if (const std::size_t colon = line.find(" : "); colon != line.npos)
    row.arguments = line.substr(colon + 3), line.resize(colon);
  row.option = split_option(trimmed_text(line), ' ');
  return row;
}

/// The verbs of the file; "*" has the options of all.
std::vector<VerbRows> verb_rows() {
  std::vector<VerbRows> out;
  std::ifstream file(fs::path(source_root) / "tests/options/verb_rows.txt");
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == ' ') {
      out.back().rows.push_back(verb_row(line));
      continue;
    }
    std::size_t end = line.find(' ');
    for (const char* group : {"signal ", "texture ", "sdf "})
      if (line.starts_with(group)) end = line.find(' ', end + 1);
    out.push_back({line.substr(0, end), end == line.npos ? "" : line.substr(end + 1)});
  }
  return out;
}

/// What a run leaves, but for times.
struct Trace {
  int code = 0;
  std::string text;
  std::map<std::string, std::string> files;
  bool operator==(const Trace&) const = default;
};

bool has_times(const std::string& name) {
  return std::ranges::any_of(std::vector{".worst.png", "crops.png", "cost.svg", ".html", ".xml", "compare.json",
                                         "compare.txt", "compare.md", "compare.csv"},
                             [&](const char* ending) { return name.ends_with(ending); });
}

class VerbOptions : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::copy(fs::path(source_root) / "tests/options", place, fs::copy_options::recursive);
    for (const char* folder : {"one", "two", "three", "images/s"}) fs::create_directories(place / folder);
    make("render foliage -o photo.png --size 400 -q");
    make("render foliage -o other.png --size 400 --aa none -q");
    make("render teapot -o alpha.png --size 64 --no-background -q");
    make("render teapot -o c.##.exr --frames 3 --turntable 3 --aov depth,motion,object-id --size 48 --aa none -q");
    for (const char* copy : {"one/a.png", "one/b.png", "two/b.png", "three/a.png", "images/s/a.png"})
      fs::copy(place / "photo.png", place / copy);
    fs::copy(place / "other.png", place / "two/a.png");
    std::ofstream(place / "badge.sdf") << "canvas 400 300 background #ffffff\nfill #d55e00 circle(200, 150, 90)\n"
                                          "fill #000000 text(10, 20, 30, \"a\")\n";
    std::ofstream(place / "scenarios.json") << R"([{"name":"s","model":"model.gltf","environment":"sky.hdr"}])";
    make("sdf field badge.sdf -o field.pfm");
    make("sdf atlas -o atlas.png --metrics atlas.json --characters Ab");
    make("compare triangles --aa none --reference none --turns 1 --size 16 -o kept");
  }
  void make(const std::string& arguments) const {
    const ProgramAnswer answer = run(arguments);
    ASSERT_EQ(answer.code, 0) << arguments << '\n' << answer.out;
  }

  /// The names of the options of a verb, as a shell completes them.
  std::set<std::string> names(const std::string& verb) const {
    static const std::regex option(" -l ([a-z-]+)");
    const std::string text = run(verb + " --help=fish").out;
    std::set<std::string> out;
    for (std::sregex_iterator found(text.begin(), text.end(), option), end; found != end; ++found)
      out.insert((*found)[1]);
    return out;
  }

  Trace trace(const std::string& arguments) const {
    static const std::regex times(R"re([\d.e+-]+ ?ms|"(ms|milliseconds|space|frequency)":[\d.e+-]+)re");
    static const std::regex digits(R"([\d.]+)"), error(R"re("mae": \{\s*"value": ([\d.e-]+))re");
    fs::remove_all(place / "out");
    fs::create_directory(place / "out");
    const ProgramAnswer answer = run(arguments);
    Trace out{.code = answer.code};
    std::smatch found;
    if (std::regex_search(answer.out, found, error))
      out.text = found[1];
    else
      out.text = std::regex_replace(answer.out, arguments.starts_with("compare") ? digits : times, "");
    for (const auto& entry : fs::recursive_directory_iterator(place / "out"))
      if (entry.is_regular_file()) {
        const std::string name = entry.path().lexically_relative(place);
        out.files[name] = has_times(name) ? "" : text_of(entry.path());
      }
    return out;
  }

  static std::string text_with(const OptionText& option) {
    return option.second.empty() ? " --" + option.first : fmt::format(" '--{}={}'", option.first, option.second);
  }
  /// Each option of the verb has a row, and acts as that says. With an `output`, the options of a rendering have those
  /// of rows.txt.
  void expect_each_acts(const std::string& name, const std::string& output = "") {
    SCOPED_TRACE(name);
    const std::vector<VerbRows> verbs = verb_rows();
    ASSERT_EQ(verbs.front().verb, "*");
    const auto found = std::ranges::find(verbs, name, &VerbRows::verb);
    ASSERT_NE(found, verbs.end());
    VerbRows verb = *found;
    const std::set<std::string> known = names(name);
    std::set<std::string> left = known, listed;
    EXPECT_FALSE(left.empty());
    for (const VerbRow& row : verb.rows) EXPECT_TRUE(listed.insert(row.option.first).second) << row.option.first;
    for (const VerbRow& row : verbs.front().rows)
      if (known.contains(row.option.first) && !listed.contains(row.option.first)) verb.rows.push_back(row);
    for (const VerbRow& row : verb.rows) {
      EXPECT_EQ(left.erase(row.option.first), 1u) << row.option.first;
      expect_effect(name + ' ' + (row.arguments.empty() ? verb.arguments : row.arguments), row.option, row.acts);
    }
    for (const OptionRow& row : option_rows()) {
      if (output.empty() || left.erase(row.option.first) == 0) continue;
      std::string arguments = fmt::format("{} {} {}", name, row.model, output);
      if (row.option.first != "resolution") arguments += " --resolution 48,40";
      for (const OptionText& other : row.others)
        if (known.contains(other.first)) arguments += text_with(other);
      expect_effect(arguments, row.option, row.changes_bytes);
    }
    // Those that are spelt in two ways have a row by the other one.
    for (const char* synonym : {"aa", "size", "background"}) left.erase(synonym);
    EXPECT_EQ(left, std::set<std::string>()) << "have no row";
  }

 private:
  void expect_effect(const std::string& arguments, const OptionText& option, bool acts) {
    const auto [found, is_new] = plain_.try_emplace(arguments);
    if (is_new) found->second = trace(arguments);
    const Trace with = trace(arguments + text_with(option));
    EXPECT_EQ(with != found->second, acts) << arguments << text_with(option) << '\n' << with.text;
  }

  std::map<std::string, Trace> plain_;  ///< without the option; many rows share it
};

TEST(VerbRows, AreThoseOfEachVerb) {
  std::set<std::string> verbs, listed;
  for (const cli::Verb& verb : cli::all_verbs()) {
    if (verb.subcommands == nullptr) verbs.insert(std::string(verb.name));
    if (verb.subcommands != nullptr)
      for (const cli::Verb& own : verb.subcommands()) verbs.insert(fmt::format("{} {}", verb.name, own.name));
  }
  for (const VerbRows& verb : verb_rows()) EXPECT_TRUE(listed.insert(verb.verb).second) << verb.verb;
  // The first three have the options of rows.txt, bench prints times alone, and the last two have no options.
  listed.insert({"render", "plan", "verify", "bench", "completions", "man"});
  verbs.insert("*");
  EXPECT_EQ(listed, verbs);
}

TEST_F(VerbOptions, EachOfCompareActsOrIsRefused) {
  expect_each_acts("compare", "--html out/page.html --json --aa none --reference ssaa:n=2 --turns 1 --metric mae");
}

TEST_F(VerbOptions, EachOfContactSheetActsOrIsRefused) { expect_each_acts("contact-sheet", "-o out/a.png"); }

TEST_F(VerbOptions, EachOfTheOthersActsOrIsRefused) {
  for (const VerbRows& verb : verb_rows())
    if (verb.verb != "*" && verb.verb != "compare" && verb.verb != "contact-sheet") expect_each_acts(verb.verb);
}

// The options of render are those of the items that plan and verify are about: each but those of the run determines the
// images, so that files made without it are not those of the batch.
TEST_F(VerbOptions, EachOptionOfAnImageIsPartOfABatch) {
  const std::set<std::string> render = names("render");
  const auto with = [&](std::set<std::string> more) {
    more.insert(render.begin(), render.end());
    return more;
  };
  EXPECT_EQ(names("verify"), with({"remove-leftovers"}));
  EXPECT_EQ(names("plan"), with({"sample", "task-seconds", "shards"}));
  const std::set<std::string> of_the_run = {"threads", "isa", "max-memory", "max-pixels", "max-import-seconds",
                                            "sandbox"};
  const std::string batch = "model.gltf -o 'out/{model}.png' --ledger out/ledger --resolution 48,40";
  fs::create_directory(place / "out");
  make(batch);
  ASSERT_EQ(run("verify " + batch).code, 0);
  for (const OptionRow& row : option_rows()) {
    const ProgramAnswer answer = run("verify " + batch + text_with(row.option));
    EXPECT_EQ(answer.code == 0, of_the_run.contains(row.option.first)) << row.option.first << '\n' << answer.out;
  }
}

}  // namespace
}  // namespace zoneplate
