// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/run_program.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(Child, GivesInputAnswersAndCode) {
  const std::string text(3000000, 'x');
  const ProgramResult answer = run_child("cat", {}, text);
  EXPECT_EQ(answer.code, 0);
  EXPECT_EQ(std::string(answer.out.begin(), answer.out.end()), text);
  const ProgramResult failed = run_child("ls", {"/no/such/file"}, "");
  EXPECT_NE(failed.code, 0);
  EXPECT_TRUE(contains(failed.complaint, "No such file")) << failed.complaint;
  // The child does not inherit the environment.
  ::setenv("ZONEPLATE_CHILD_TEST", "seen", 1);
  const ProgramResult variables = run_child("env", {}, "");
  EXPECT_FALSE(contains(std::string(variables.out.begin(), variables.out.end()), "ZONEPLATE_CHILD_TEST"));
}

TEST(RunningProgram, AnswersWhileItsInputIsWritten) {
  RunningProgram cat("cat", {});
  std::string text;
  for (int part = 0; part < 40; ++part) {
    const std::string bytes(200'000, static_cast<char>('a' + part % 26));
    cat.write({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    text += bytes;
  }
  const ProgramResult answer = cat.finish();
  EXPECT_EQ(answer.code, 0);
  EXPECT_EQ(std::string(answer.out.begin(), answer.out.end()), text);
}

TEST(RunningProgram, MayEndBeforeItsInput) {
  const std::vector<std::uint8_t> bytes(5'000'000);
  RunningProgram ended("ls", {"/no/such/file"});
  ended.write(bytes);
  EXPECT_NE(ended.finish().code, 0);
  RunningProgram waiting("sleep", {"60"}, {.milliseconds = 100});
  EXPECT_THROW(waiting.write(bytes), Error);
}

/// A fixture with a folder that contains a program which prints its own name; it restores PATH.
class ChildInPath : public testing::Test {
 protected:
  ChildInPath() : before_(std::getenv("PATH") ? std::getenv("PATH") : "") {
    std::string name = (std::filesystem::temp_directory_path() / "zoneplate_path_XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    const std::string program = folder_ + "/zoneplate-test-program";
    std::ofstream(program) << "#!/bin/sh\necho \"$0\"\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  }
  ~ChildInPath() override {
    ::setenv("PATH", before_.c_str(), 1);
    std::filesystem::remove_all(folder_);
  }
  std::string before_, folder_;
};

TEST_F(ChildInPath, IsFoundThereAndNeverByAFolderThatIsNotAbsolute) {
  ::setenv("PATH", ("/no/such/folder:" + folder_).c_str(), 1);
  const ProgramResult answer = run_child("zoneplate-test-program", {}, "");
  EXPECT_EQ(std::string(answer.out.begin(), answer.out.end()), folder_ + "/zoneplate-test-program\n");
  const std::string relative = std::filesystem::relative(folder_).string();
  for (const std::string& path : {relative, std::string("."), std::string()}) {
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_THROW(run_child("zoneplate-test-program", {}, ""), Error) << path;
  }
  ::unsetenv("PATH");
  EXPECT_EQ(run_child("true", {}, "").code, 0);  // found in the default folders
}

TEST(Child, EndsWhatDoesNotEnd) {
  const Stopwatch watch;
  EXPECT_THROW(run_child("sleep", {"60"}, "", {.milliseconds = 100}), Error);
  EXPECT_THROW(run_child("yes", {}, "", {.bytes = 100000}), Error);
  EXPECT_LT(watch.ms(), 10000);
  EXPECT_THROW(run_child("no-such-program-of-zoneplate", {}, ""), Error);
}

}  // namespace
}  // namespace zoneplate
