// SPDX-License-Identifier: Apache-2.0
// Reports, lists and help texts that are read slowly or by nobody. Runs the built program.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/os/program_for_test.h"

namespace {

namespace fs = std::filesystem;
using zoneplate::contains;
using zoneplate::text_of;

class BatchReports : public zoneplate::ProgramTest {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(place / name) << text; }
  std::size_t images() const {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(place)) count += entry.path().extension() == ".png" ? 1 : 0;
    return count;
  }
  void write_jobs(int count) const {
    std::string jobs;
    for (int i = 0; i < count; ++i) jobs += R"({"input":"triangles","output":")" + std::to_string(i) + ".png\"}\n";
    write("jobs.jsonl", jobs);
  }
  // Runs a command of the shell in the folder.
  int shell(const std::string& command) const {
    return WEXITSTATUS(
        std::system(("cd '" + place.string() + "' && Z='" + zoneplate::program_file + "' && " + command).c_str()));
  }
  // Runs the program with a non-blocking pipe as stdout, which is read slowly, or not after `most` bytes.
  std::pair<int, std::string> run_slowly(const std::vector<std::string>& words,
                                         std::size_t most = ~std::size_t{0}) const {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    ::fcntl(ends[1], F_SETFL, O_NONBLOCK);
    ::fcntl(ends[1], F_SETPIPE_SZ, 4096);
    std::vector<std::string> all = words;
    all.insert(all.begin(), zoneplate::program_file);
    std::vector<char*> arguments;
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
      ::dup2(ends[1], STDOUT_FILENO);
      ::close(ends[0]), ::close(ends[1]);
      if (::chdir(place.c_str()) == 0) ::execv(zoneplate::program_file, arguments.data());
      ::_exit(127);
    }
    ::close(ends[1]);
    std::string text;
    std::array<char, 1000> part{};
    while (text.size() < most) {
      const ssize_t n = ::read(ends[0], part.data(), part.size());
      if (n <= 0) break;
      text.append(part.data(), static_cast<std::size_t>(n));
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    return {WEXITSTATUS(status), text};
  }
};

TEST_F(BatchReports, ASlowReaderGetsEveryReport) {
  write_jobs(60);
  const auto [code, text] = run_slowly({"--manifest", "jobs.jsonl", "--size", "8x6", "--aa", "none"});
  EXPECT_EQ(code, 0);
  EXPECT_EQ(std::ranges::count(text, '\n'), 60);
  EXPECT_EQ(images(), 60u);
  const auto [list_code, list] = run_slowly({"list", "--json"});
  EXPECT_EQ(list_code, 0);
  EXPECT_EQ(list, run("list --json").out);
}

TEST_F(BatchReports, ImagesAreMadeWithoutAReader) {
  write_jobs(30);
  const auto [code, text] = run_slowly({"--manifest", "jobs.jsonl", "--size", "8x6", "--aa", "none", "-t", "1"}, 1);
  EXPECT_EQ(code, 4);
  EXPECT_EQ(images(), 30u);
  for (const char* stdout_of : {">/dev/full", ">&-", "| true"}) {
    shell("rm -f *.png");
    shell(std::string("(\"$Z\" --manifest jobs.jsonl --size 8x6 2>err; echo $? >code) ") + stdout_of);
    EXPECT_EQ(images(), 30u) << stdout_of;
    const std::string err = text_of(place / "err");
    // A pipe may take the few reports before its reader ends.
    if (std::string(stdout_of) == "| true" && text_of(place / "code") == "0\n") continue;
    EXPECT_EQ(text_of(place / "code"), "4\n") << stdout_of;
    EXPECT_TRUE(contains(err, "the batch goes on without reports")) << err;
    EXPECT_TRUE(contains(err, "not all reports could be printed: stdout: ")) << err;
  }
}

TEST_F(BatchReports, ListsEndWithTheirReader) {
  for (const char* verb : {"list methods", "list --json", "completions bash", "man", "render --help", "info teapot"}) {
    EXPECT_EQ(shell(std::string("(\"$Z\" ") + verb + " 2>err; echo $? >code) | true"), 0);
    EXPECT_EQ(text_of(place / "code"), "0\n") << verb;
    EXPECT_EQ(text_of(place / "err"), "") << verb;
    EXPECT_EQ(shell(std::string("\"$Z\" ") + verb + " >/dev/full 2>err"), 4) << verb;
  }
}

}  // namespace
