#include "zoneplate/os/run_program.h"

#include <gtest/gtest.h>

#include <cstdlib>

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
  // Nothing of the environment comes along.
  ::setenv("ZONEPLATE_CHILD_TEST", "seen", 1);
  const ProgramResult variables = run_child("env", {}, "");
  EXPECT_FALSE(contains(std::string(variables.out.begin(), variables.out.end()), "ZONEPLATE_CHILD_TEST"));
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
