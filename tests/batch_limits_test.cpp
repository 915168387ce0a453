// SPDX-License-Identifier: Apache-2.0
// What a batch takes, and what ends it: programs that hang. Runs the built program.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/cli/program_for_test.h"

namespace {

namespace fs = std::filesystem;
using zoneplate::contains;
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
