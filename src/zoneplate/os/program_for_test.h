// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/os/file.h"

namespace zoneplate {

/// The bytes of a file; empty if it does not exist.
inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

inline bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

/// The output and exit code of a run of the built program.
struct ProgramAnswer {
  int code = -1;
  std::string out;  ///< stdout and stderr combined
};

/// Fixture for tests of the built program, with an empty temporary folder.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "zoneplate_program_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    place = name;
    ::setenv("XDG_CONFIG_HOME", (place / "config").c_str(), 1);  // not the configuration of the user
  }
  void TearDown() override { std::filesystem::remove_all(place); }

  bool exists(const std::string& name) const { return std::filesystem::exists(place / name); }
  /// Writes a file of that folder, and makes the folder of its name.
  void save(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    std::filesystem::create_directories((place / name).parent_path());
    save_bytes((place / name).string(), bytes);
  }

  /// Runs the program in that folder, with arguments in shell syntax. `before` precedes the program in its command: a
  /// command that runs it, as `timeout 60`.
  ProgramAnswer run(const std::string& arguments, const std::string& before = "") const {
    const std::string command =
        "cd '" + place.string() + "' && " + before + " '" + program_file + "' " + arguments + " 2>&1";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    ProgramAnswer answer;
    std::array<char, 4096> part{};
    while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe)) answer.out.append(part.data(), n);
    answer.code = WEXITSTATUS(::pclose(pipe));
    return answer;
  }

  std::filesystem::path place;
};

}  // namespace zoneplate
