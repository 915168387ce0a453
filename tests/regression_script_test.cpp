// SPDX-License-Identifier: Apache-2.0
// The script of action.yml and of examples/ci, with the built program: what a regression test must not pass.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/html_page_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

class RegressionScript : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::create_directories(place / "bin");
    fs::create_symlink(fs::absolute(program_file), place / "bin/zoneplate");
    triangle("a/x.obj", 1), triangle("a/y.obj", 0.5);
    ASSERT_EQ(check("a/*.obj", "--update"), 0) << said_;
    ASSERT_EQ(check("a/*.obj"), 0) << said_;
  }
  void triangle(const std::string& name, double top) const {
    fs::create_directories((place / name).parent_path());
    std::ofstream(place / name) << fmt::format("v 0 0 0\nv 1 0 0\nv 0 {} 0\nv 1 1 0\nf 1 2 3\nf 1 2 4\n", top);
  }
  /// The exit code of the script for these models.
  int check(const std::string& models, const std::string& arguments = "") {
    const std::string command = fmt::format(
        "cd '{}' && PATH=\"$PWD/bin:$PATH\" OPTIONS='--size 32x32' METRIC=mae '{}/packaging/regression.sh' --models "
        "'{}' "
        "--references refs --output out --threshold 0.001 --junit j.xml --report r.html {} > said 2>&1",
        place.string(), source_root, models, arguments);
    const int status = std::system(command.c_str());
    said_ = text_of(place / "said");
    return WEXITSTATUS(status);
  }
  void expect_case(const std::string& name, std::string_view kind, std::string_view message) const {
    const std::string junit = text_of(place / "j.xml");
    const std::size_t begin = junit.find("<testcase name=\"" + name + "\"");
    ASSERT_NE(begin, std::string::npos) << junit;
    const std::string found = junit.substr(begin, junit.find("</testcase>", begin) - begin);
    EXPECT_TRUE(contains(found, fmt::format("type=\"{}\"", kind)) && contains(found, message)) << found;
  }
  std::string said_;
};

TEST_F(RegressionScript, ChangedModelsFail) {
  triangle("a/x.obj", 0.1);
  EXPECT_EQ(check("a/*.obj"), 1) << said_;
  expect_case("x.png", "failed", "mae is ");
}

TEST_F(RegressionScript, ModelsOfOneNameAreRefusedOrNamedByFolder) {
  triangle("b/x.obj", 1), triangle("a/x.obj", 0.1);
  EXPECT_EQ(check("a/x.obj b/x.obj a/y.obj"), 1) << said_;
  EXPECT_TRUE(contains(said_, "would both be written to") && contains(said_, "--name '{dir}_{model}.png'")) << said_;
  EXPECT_EQ(check("a/x.obj b/x.obj", "--name '{dir}_{model}.png'"), 1) << said_;  // new, and x and y missing
  EXPECT_TRUE(fs::exists(place / "out/a_x.png") && fs::exists(place / "out/b_x.png"));
  expect_case("a_x.png", "new", "there is no reference");
}

TEST_F(RegressionScript, ImagesOfEarlierRunsDoNotPass) {
  fs::remove(place / "a/y.obj");  // its image is still in the output
  EXPECT_EQ(check("a/*.obj"), 1) << said_;
  expect_case("y.png", "missing", "there is no test image of this name");
  std::ofstream(place / "a/y.obj") << "no model";
  EXPECT_EQ(check("a/*.obj"), 1) << said_;
  expect_case("y.png", "not rendered", "a/y.obj: ");
  EXPECT_TRUE(contains(text_of(place / "j.xml"), "errors=\"1\""));
}

TEST_F(RegressionScript, ModelsThatDoNotRenderAreInTheReports) {
  std::ofstream(place / "a/z.glb") << "no model";  // without a reference
  EXPECT_EQ(check("a/*"), 1) << said_;
  expect_case("z.png", "not rendered", "a/z.glb: not JSON");
  EXPECT_TRUE(contains(content_of_page(text_of(place / "r.html")), "a/z.glb: not JSON"));
  EXPECT_FALSE(fs::exists(place / "out/z.png"));
  EXPECT_EQ(check("a/z.glb"), 1) << said_;  // none renders
  expect_case("z.png", "not rendered", "a/z.glb: not JSON");
  expect_case("x.png", "missing", "");
}

TEST_F(RegressionScript, AFirstRunFailsAndSaysHowToAcceptImages) {
  fs::remove_all(place / "refs");
  EXPECT_EQ(check("a/*.obj"), 1) << said_;
  EXPECT_TRUE(contains(said_, "refs: has no images yet. Look at those in out; accept them with --update")) << said_;
  expect_case("x.png", "new", "there is no reference");
  EXPECT_TRUE(contains(text_of(place / "r.html"), "class=\"picture\""));  // the new images can be viewed
  EXPECT_FALSE(fs::exists(place / "refs"));
  std::ofstream(place / "a/z.glb") << "no model";
  EXPECT_EQ(check("a/*", "--update"), 1) << said_;
  EXPECT_FALSE(fs::exists(place / "refs")) << "images of a run that fails are not accepted";
  fs::remove(place / "a/z.glb");
  EXPECT_EQ(check("a/*", "--update"), 0) << said_;
  EXPECT_EQ(check("a/*"), 0) << said_;
}

TEST_F(RegressionScript, ATestOfNothingFails) {
  EXPECT_EQ(check("a/*.obj b/*.glb"), 1) << said_;
  EXPECT_TRUE(contains(said_, "no model matches b/*.glb")) << said_;
  EXPECT_EQ(check("a/w.obj"), 1) << said_;
  EXPECT_EQ(check("a/*.obj", "--junti x"), 2) << said_;
}

/// The lines of a file.
std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// The text after `key` in the last line that begins with it.
std::string value_after(const std::vector<std::string>& lines, const std::string& key) {
  std::string value;
  for (const std::string& line : lines)
    if (line.starts_with(key)) value = line.substr(key.size());
  return value;
}

// What the recipes run, with the variables that they set.
class RegressionRecipes : public RegressionScript {
 protected:
  int run_recipe(const std::string& variables, const std::string& command) {
    std::ofstream(place / "recipe.sh") << variables << command << '\n';
    const int status = std::system(fmt::format("cd '{}' && sh -e recipe.sh > said 2>&1", place.string()).c_str());
    said_ = text_of(place / "said");
    return WEXITSTATUS(status);
  }
  void expect_judges(const std::string& variables, const std::string& command) {
    EXPECT_EQ(run_recipe(variables, command), 0) << said_;
    triangle("a/x.obj", 0.1);
    EXPECT_EQ(run_recipe(variables, command), 1) << said_;
    expect_case("x.png", "failed", " is ");
    EXPECT_TRUE(fs::exists(place / "r.html"));
  }
};

TEST_F(RegressionRecipes, OfGitHub) {
  const std::vector<std::string> lines = lines_of(fs::path(source_root) / "action.yml");
  fs::create_directories(place / ".cache/zoneplate-program");
  fs::create_symlink(fs::absolute(program_file), place / ".cache/zoneplate-program/zoneplate");
  const std::map<std::string, std::string> given = {{"models", "a/*.obj"},
                                                    {"references", "refs"},
                                                    {"junit", "j.xml"},
                                                    {"report", "r.html"},
                                                    {"options", "--size 32x32"}};
  // The defaults of the inputs, then what they set.
  std::map<std::string, std::string> inputs;
  std::string input, variables = fmt::format("export HOME='{}' GITHUB_ACTION_PATH='{}'\n", place.string(), source_root);
  for (const std::string& line : lines) {
    if (line.starts_with("  ") && line[2] != ' ' && line.ends_with(':')) input = line.substr(2, line.size() - 3);
    if (line.starts_with("    default: ")) inputs[input] = line.substr(13);
    const std::size_t at = line.find(": ${{ inputs.");
    if (at == std::string::npos || line.find("PACKAGES") != std::string::npos) continue;
    const std::string name = line.substr(8, at - 8), key = line.substr(at + 13, line.find(" }}") - at - 13);
    const auto value = given.contains(key) ? given.at(key) : inputs[key];
    variables += fmt::format("export {}={}\n", name, value.starts_with('"') ? value : '\'' + value + '\'');
  }
  expect_judges(variables, value_after(lines, "      run: PATH=").insert(0, "PATH="));
}

TEST_F(RegressionRecipes, OfGitLab) {
  const std::vector<std::string> lines = lines_of(fs::path(source_root) / "examples/ci/gitlab.yml");
  fs::create_directories(place / ".zoneplate/build/release");
  fs::create_directory_symlink(fs::path(source_root) / "packaging", place / ".zoneplate/packaging");
  fs::create_symlink(fs::absolute(program_file), place / ".zoneplate/build/release/zoneplate");
  const std::string command = value_after(lines, "    - PATH=").insert(0, "PATH=");
  expect_judges("export MODELS='a/*.obj' REFERENCES=refs OPTIONS='--size 32x32' OUTPUT=out JUNIT=j.xml REPORT=r.html\n",
                command);
}

TEST_F(RegressionRecipes, OfPreCommit) {
  const std::vector<std::string> lines = lines_of(fs::path(source_root) / ".pre-commit-hooks.yaml");
  const std::string entry = value_after(lines, "  entry: "), given = value_after(lines, "#           args: ");
  ASSERT_TRUE(given.starts_with('[') && given.ends_with(']')) << given;
  std::string arguments = given.substr(1, given.size() - 2);
  std::erase(arguments, ',');
  for (const auto& [from, to] : {std::pair("models/*.glb", "a/*.obj"), std::pair("golden", "refs"),
                                 std::pair("regression.html", "r.html --junit j.xml")})
    arguments.replace(arguments.find(from), std::strlen(from), to);
  expect_judges("export PATH=\"$PWD/bin:$PATH\" OPTIONS='--size 32x32'\n",
                fmt::format("'{}/{}' {}", source_root, entry, arguments));
}

}  // namespace
}  // namespace zoneplate
