// SPDX-License-Identifier: Apache-2.0
// What a batch takes, and what ends it: manifests of strangers, programs that hang. Runs the built program.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "measured_run.h"
#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/os/program_for_test.h"

namespace {

namespace fs = std::filesystem;
using zoneplate::contains;
using zoneplate::MeasuredRun;
using zoneplate::ProgramAnswer;
using zoneplate::text_of;

class BatchLimits : public zoneplate::ProgramTest {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(place / name) << text; }
  // Runs a command of the shell in the folder.
  int shell(const std::string& command) const {
    return WEXITSTATUS(
        std::system(("cd '" + place.string() + "' && Z='" + zoneplate::program_file + "' && " + command).c_str()));
  }
};

TEST_F(BatchLimits, AManifestTakesBoundedMemory) {
  const std::vector<std::string> limits = {"--max-memory", "200M", "--max-import-seconds", "2", "--max-seconds", "10"};
  const auto run_limited = [&](const std::string& manifest) {
    std::vector<std::string> words = {"render", "--manifest", manifest, "--size", "8"};
    words.insert(words.end(), limits.begin(), limits.end());
    const MeasuredRun run = zoneplate::run_measured(words, place, 20);
    EXPECT_LT(run.seconds, 15) << manifest;
    EXPECT_EQ(run.code, 3) << manifest << run.err;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    EXPECT_LT(run.resident_bytes, std::uint64_t{260} << 20) << manifest;
#endif
    return run.err;
  };
  {
    std::ofstream lines(place / "lines.jsonl"), one(place / "one.jsonl");
    const std::string some(1 << 20, 'a');
    std::string pairs;
    for (int i = 0; i < 1 << 19; ++i) pairs += "a\n";
    for (int i = 0; i < 40; ++i) lines << pairs, one << some;
  }
  EXPECT_TRUE(contains(run_limited("lines.jsonl"), "a manifest of more than 1000000 jobs: split it"));
  EXPECT_TRUE(contains(run_limited("one.jsonl"), "one.jsonl: line 1: longer than 65536 bytes"));
  EXPECT_TRUE(contains(run_limited("/dev/zero"), "/dev/zero: is a device, not a file"));
  EXPECT_EQ(shell("yes '' | \"$Z\" --manifest - --max-memory 20M 2>err"), 3);
  EXPECT_TRUE(contains(text_of(place / "err"), "standard input: a manifest of more than 10485760 bytes"));
}

TEST_F(BatchLimits, ALineRaisesNoLimit) {
  const auto error = [&](const std::string& options) {
    write("jobs.jsonl", R"({"input":"triangles","output":"a.png",)" + options + "}\n");
    const ProgramAnswer answer = run("--manifest jobs.jsonl --size 8 --max-memory 512M --max-seconds 60");
    EXPECT_TRUE(answer.code == 0 || answer.code == 5) << answer.out;
    return answer.code == 0 ? "" : answer.out;
  };
  for (const char* lower : {R"("max-memory":"256M")", R"("max-seconds":30,"max-pixels":"1M")",
                            R"("max-import-seconds":5)", R"("sandbox":true)"})
    EXPECT_EQ(error(lower), "");
  EXPECT_TRUE(contains(error(R"("max-memory":"1G")"), "max-memory can only be lowered by a line"));
  EXPECT_TRUE(contains(error(R"("max-seconds":61)"), "max-seconds can only be lowered by a line, and is 60"));
  EXPECT_TRUE(contains(error(R"("max-import-seconds":61)"), "max-import-seconds can only be lowered by a line"));
  EXPECT_TRUE(contains(error(R"("max-pixels":"257M")"), "max-pixels can only be lowered by a line"));
  EXPECT_TRUE(contains(error(R"("no-sandbox":true)"), "no-sandbox is for the command line alone"));
  EXPECT_TRUE(contains(error(R"("allow-path":"/")"), "allow-path is for the command line alone"));
}

// An ffmpeg that reads nothing, or that reads all and writes nothing, and starts a program that outlives it.
TEST_F(BatchLimits, AProgramThatHangsIsEnded) {
  fs::create_directory(place / "bin");
  for (const char* script : {"#!/bin/sh\nsleep 1000\n", "#!/bin/sh\ncat >/dev/null\nsleep 1000\n"}) {
    write("bin/ffmpeg", script);
    fs::permissions(place / "bin/ffmpeg", fs::perms::owner_all);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(shell("PATH=\"$PWD/bin:$PATH\" \"$Z\" teapot -o f.mp4 --turntable 40 --size 64x48 --aa none "
                    "--max-seconds 1 2>err"),
              1);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    const std::string err = text_of(place / "err");
    EXPECT_TRUE(contains(err, "teapot: waits for ffmpeg longer than the limit of 1 s (--max-seconds)")) << err;
    EXPECT_FALSE(fs::exists(place / "f.mp4"));
  }
}

}  // namespace
