// SPDX-License-Identifier: Apache-2.0
// The script of action.yml, with the built program: what a regression test must not pass.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/cli/program_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

class RegressionScript : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::create_directories(place / "bin");
    fs::create_symlink(fs::absolute(program_file), place / "bin/zoneplate");
    fs::create_directories(place / "refs");
    triangle("a/x.obj", 1), triangle("a/y.obj", 0.5);
    ASSERT_EQ(check("a/*.obj", ""), 3) << said_;  // no references yet
    fs::copy(place / "out", place / "refs");
    ASSERT_EQ(check("a/*.obj", ""), 0) << said_;
  }
  void triangle(const std::string& name, double top) const {
    fs::create_directories((place / name).parent_path());
    std::ofstream(place / name) << fmt::format("v 0 0 0\nv 1 0 0\nv 0 {} 0\nv 1 1 0\nf 1 2 3\nf 1 2 4\n", top);
  }
  /// The exit code of the script for these models, with more variables.
  int check(const std::string& models, const std::string& variables) {
    const std::string command = fmt::format(
        "cd '{}' && PATH=\"$PWD/bin:$PATH\" MODELS='{}' REFERENCES=refs OUTPUT=out OPTIONS='--size 32x32' METRIC=mae "
        "THRESHOLD=0.001 JUNIT=j.xml {} '{}/packaging/regression.sh' > said 2>&1",
        place.string(), models, variables, source_root);
    const int status = std::system(command.c_str());
    said_ = text_of(place / "said");
    return WEXITSTATUS(status);
  }
  std::string said_;
};

TEST_F(RegressionScript, ChangedModelsFail) {
  triangle("a/x.obj", 0.1);
  EXPECT_EQ(check("a/*.obj", "REPORT=r.html"), 1) << said_;
  EXPECT_TRUE(fs::exists(place / "r.html"));
}

TEST_F(RegressionScript, ModelsOfOneNameAreRefusedOrNamedByFolder) {
  triangle("b/x.obj", 1), triangle("a/x.obj", 0.1);
  EXPECT_EQ(check("a/x.obj b/x.obj a/y.obj", ""), 2) << said_;
  EXPECT_TRUE(contains(said_, "would both be written to")) << said_;
  fs::remove_all(place / "out");
  EXPECT_EQ(check("a/x.obj b/x.obj", "NAME='{dir}_{model}.png'"), 1) << said_;  // new, and x and y missing
  EXPECT_TRUE(fs::exists(place / "out/a_x.png") && fs::exists(place / "out/b_x.png"));
}

TEST_F(RegressionScript, ImagesOfEarlierRunsDoNotPass) {
  fs::remove(place / "a/y.obj");  // its image is still in the output
  EXPECT_EQ(check("a/*.obj", ""), 1) << said_;
  EXPECT_TRUE(contains(said_, "there is no test image of this name")) << said_;
  std::ofstream(place / "a/y.obj") << "no model";
  EXPECT_EQ(check("a/*.obj", ""), 1) << said_;
  EXPECT_TRUE(contains(text_of(place / "j.xml"), "<testcase name=\"y.png\"")) << said_;
  EXPECT_TRUE(contains(text_of(place / "j.xml"), "errors=\"1\"")) << text_of(place / "j.xml");
}

TEST_F(RegressionScript, AModelThatIsNotRenderedIsInTheReport) {
  std::ofstream(place / "a/z.glb") << "no model";  // without a reference
  EXPECT_EQ(check("a/*", ""), 1) << said_;
  EXPECT_TRUE(contains(text_of(place / "j.xml"), "<testcase name=\"z.png\"")) << said_;
  EXPECT_FALSE(fs::exists(place / "out/z.png"));
}

}  // namespace
}  // namespace zoneplate
